#include "log_info.h"

#include "big_endian.h"
#include "wire_type.h"

#include <stdlib.h>
#include <string.h>

/* Bytes of a key before the channel: fingerprint, known. */
enum { TYPE_BYTES = sizeof(int64_t) + 1 };

struct log_info *log_info_open(void)
{
    struct log_info *info = allocate(1, sizeof *info);
    info->utime = INT64_MIN;
    info->names = body_names_open();
    return info;
}

void log_info_close(struct log_info *info)
{
    struct log_row *row, *next;
    HASH_ITER(hh, info->rows, row, next)
    {
        HASH_DELETE(hh, info->rows, row);
        free(row);
    }
    body_names_close(info->names);
    free(info);
}

/* ---- Tallies --------------------------------------------------------------------------------- */

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

/* Returns the bytes of the key. */
static size_t key_of(const struct log_event *event, struct log_type type,
                     unsigned char out[TYPE_BYTES + LOG_CHANNEL_MAX])
{
    memcpy(out, &type.fingerprint, sizeof type.fingerprint);
    out[TYPE_BYTES - 1] = type.known;
    memcpy(out + TYPE_BYTES, event->channel, event->channel_length);
    return TYPE_BYTES + event->channel_length;
}

static enum log_kind kind_of(struct log_type type)
{
    static const struct {
        const char *name;
        enum log_kind kind;
    } kinds[] = {{"fmb_msgs.pair_query_t", LOG_PAIR_QUERY},
                 {"fmb_msgs.scene_query_t", LOG_SCENE_QUERY},
                 {"fmb_msgs.names_t", LOG_NAMES}};
    const char *name = type.known ? wire_type_name(type.fingerprint) : NULL;
    for (size_t i = 0; name && i < sizeof kinds / sizeof *kinds; i++)
        if (strcmp(name, kinds[i].name) == 0)
            return kinds[i].kind;
    return LOG_OTHER;
}

static struct log_row *row_of(struct log_info *info, const struct log_event *event)
{
    unsigned char key[TYPE_BYTES + LOG_CHANNEL_MAX];
    const struct log_type type = type_of(event);
    const size_t size = key_of(event, type, key);
    struct log_row *row = NULL;
    HASH_FIND(hh, info->rows, key, size, row);
    if (row)
        return row;
    row = allocate(1, sizeof *row + size);
    memcpy(row->key, key, size);
    row->channel = (const char *) row->key + TYPE_BYTES;
    row->channel_length = event->channel_length;
    row->type = type;
    row->kind = kind_of(type);
    HASH_ADD_KEYPTR(hh, info->rows, row->key, size, row);
    return row;
}

/* ---- Events ---------------------------------------------------------------------------------- */

void log_info_event(struct log_info *info, const struct log_event *event)
{
    struct log_row *row = row_of(info, event);
    info->backward += event->utime < info->utime;
    info->utime = event->utime;
    add(&row->tally, &(struct log_tally){.events = 1,
                                         .bytes = (int64_t) event->size,
                                         .least = event->size,
                                         .most = event->size,
                                         .begin = event->utime,
                                         .end = event->utime});
    if (row->kind != LOG_OTHER)
        body_names_take_message(info->names, row->kind, event->data, (uint32_t) event->kept);
}

void log_info_damage(struct log_info *info, const struct log_damage *damage)
{
    if (info->damages < LOG_INFO_DAMAGES_MAX)
        info->damage[info->damages] = *damage;
    info->damages++;
    info->damaged += damage->length;
}

static int compare_rows(const struct log_row *left, const struct log_row *right)
{
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
    HASH_SORT(info->rows, compare_rows);
    for (const struct log_row *row = info->rows; row; row = row->hh.next)
        add(&info->all, &row->tally);
}
