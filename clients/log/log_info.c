#include "log_info.h"

#include "allocate.h"
#include "big_endian.h"

#include <stdlib.h>
#include <string.h>

enum { SLOTS = 2 * LOG_INFO_ROWS_MAX };

struct log_info *log_info_open(void)
{
    struct log_info *info = allocate(1, sizeof *info);
    info->utime = INT64_MIN;
    return info;
}

void log_info_close(struct log_info *info)
{
    for (unsigned i = 0; i < info->row_count; i++)
        free(info->row[i].channel);
    free(info);
}

/* ---- Tallies --------------------------------------------------------------------------------- */

static void count_event(struct log_tally *tally, const struct log_event *event)
{
    if (tally->events == 0)
        *tally = (struct log_tally){
            .least = event->size, .most = event->size, .begin = event->utime, .end = event->utime};
    tally->events++;
    tally->bytes += (int64_t) event->size;
    if (event->size < tally->least)
        tally->least = event->size;
    if (event->size > tally->most)
        tally->most = event->size;
    if (event->utime < tally->begin)
        tally->begin = event->utime;
    if (event->utime > tally->end)
        tally->end = event->utime;
}

static void add(struct log_tally *sum, const struct log_tally *tally)
{
    if (tally->events == 0)
        return;
    if (sum->events == 0)
        *sum = (struct log_tally){
            .least = tally->least, .most = tally->most, .begin = tally->begin, .end = tally->end};
    sum->events += tally->events;
    sum->bytes += tally->bytes;
    sum->least = tally->least < sum->least ? tally->least : sum->least;
    sum->most = tally->most > sum->most ? tally->most : sum->most;
    sum->begin = tally->begin < sum->begin ? tally->begin : sum->begin;
    sum->end = tally->end > sum->end ? tally->end : sum->end;
}

/* ---- Rows ------------------------------------------------------------------------------------ */

static struct log_type type_of(const struct log_event *event)
{
    if (event->kept < 8)
        return (struct log_type){.known = false};
    return (struct log_type){true, (int64_t) big_endian_64(event->data)};
}

static bool is_row_of(const struct log_row *row, const struct log_event *event,
                      struct log_type type)
{
    return row->type.fingerprint == type.fingerprint && row->type.known == type.known &&
           row->channel_length == event->channel_length &&
           memcmp(row->channel, event->channel, event->channel_length) == 0;
}

/* FNV-1a. Who makes names that meet makes a search of a few thousand steps. */
static unsigned hash(const struct log_event *event, struct log_type type)
{
    uint64_t sum = UINT64_C(0xcbf29ce484222325) ^ (uint64_t) type.fingerprint;
    for (size_t i = 0; i < event->channel_length; i++)
        sum = (sum ^ (unsigned char) event->channel[i]) * UINT64_C(0x100000001b3);
    return (unsigned) (sum ^ sum >> 32) % SLOTS;
}

static unsigned add_row(struct log_info *info, const struct log_event *event, struct log_type type)
{
    struct log_row *row = &info->row[info->row_count];
    row->channel = allocate(event->channel_length, 1);
    memcpy(row->channel, event->channel, event->channel_length);
    row->channel_length = event->channel_length;
    row->type = type;
    return info->row_count++;
}

/* LOG_INFO_ROWS_MAX: there is none, and no room for one. At least half of the slots are empty. */
static unsigned find_row(struct log_info *info, const struct log_event *event, struct log_type type)
{
    unsigned slot = hash(event, type);
    for (; info->slot[slot] != 0; slot = (slot + 1) % SLOTS)
        if (is_row_of(&info->row[info->slot[slot] - 1], event, type))
            return info->slot[slot] - 1u;
    if (info->row_count == LOG_INFO_ROWS_MAX)
        return LOG_INFO_ROWS_MAX;
    const unsigned row = add_row(info, event, type);
    info->slot[slot] = (unsigned short) (row + 1);
    return row;
}

/* Messages alternate: mostly the row is the one that came after the last row before. */
static struct log_tally *tally_of(struct log_info *info, const struct log_event *event)
{
    const struct log_type type = type_of(event);
    const unsigned guess = info->row[info->last].next;
    if (is_row_of(&info->row[guess], event, type)) {
        info->last = guess;
        return &info->row[guess].tally;
    }
    const unsigned row = find_row(info, event, type);
    if (row == LOG_INFO_ROWS_MAX)
        return &info->others;
    info->row[info->last].next = row;
    info->last = row;
    return &info->row[row].tally;
}

/* ---- One after the other --------------------------------------------------------------------- */

void log_info_event(struct log_info *info, const struct log_event *event)
{
    struct log_tally *tally = tally_of(info, event);
    info->backward += event->utime < info->utime;
    info->utime = event->utime;
    count_event(tally, event);
}

void log_info_damage(struct log_info *info, const struct log_damage *damage)
{
    if (info->damages < LOG_INFO_DAMAGES_MAX)
        info->damage[info->damages] = *damage;
    info->damages++;
    info->damaged += damage->length;
}

static int compare_rows(const void *a, const void *b)
{
    const struct log_row *left = a, *right = b;
    const bool shorter = left->channel_length < right->channel_length;
    const size_t both = shorter ? left->channel_length : right->channel_length;
    const int order = memcmp(left->channel, right->channel, both);
    if (order != 0)
        return order;
    if (left->channel_length != right->channel_length)
        return shorter ? -1 : 1;
    if (left->type.known != right->type.known)
        return left->type.known ? 1 : -1;
    return (left->type.fingerprint > right->type.fingerprint) -
           (left->type.fingerprint < right->type.fingerprint);
}

void log_info_end(struct log_info *info)
{
    qsort(info->row, info->row_count, sizeof *info->row, compare_rows);
    info->all = info->others;
    for (unsigned i = 0; i < info->row_count; i++)
        add(&info->all, &info->row[i].tally);
}
