#include "spill.h"

#include "allocate.h"
#include "temporary.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Of each side so many files, by a hash of the ids: of one at a time the ids are in memory. A part
 * with more queries than these is parted once more, by other bits of the hash, and so on, as far as
 * these go: so memory stays the same, unless that many queries have the same ids. */
#ifndef SPILL_QUERIES_AT_ONCE
#define SPILL_QUERIES_AT_ONCE (1 << 16) /* some 10 MB */
#define SPILL_PART_BITS 6
#endif
enum { PARTS = 1 << SPILL_PART_BITS, LEVELS = 8 };

struct spill {
    int level;                      /* how often what is here has been parted before */
    FILE *file[SPILL_SIDES][PARTS]; /* NULL: nothing there */
    int64_t queries[PARTS];
    int error; /* errno of the first failure; 0: none */
};

static struct spill *open_level(int level)
{
    struct spill *spill = allocate(1, sizeof *spill);
    spill->level = level;
    return spill;
}

struct spill *spill_open(void)
{
    return open_level(0);
}

void spill_close(struct spill *spill)
{
    for (int side = 0; spill && side < SPILL_SIDES; side++)
        for (int part = 0; part < PARTS; part++)
            if (spill->file[side][part])
                fclose(spill->file[side][part]);
    free(spill);
}

/* Keeps the first. Always false. */
static bool fail(struct spill *spill)
{
    if (!spill->error)
        spill->error = errno ? errno : EIO;
    return false;
}

/* Without utime, which may differ. Mixed until all of the upper bits depend on all of the ids. */
static int part_of(const struct match_item *item, int level)
{
    uint64_t mixed = query_id_mix(item->ids.client_id) + item->kind;
    mixed = query_id_mix((int64_t) mixed ^ item->ids.sequence_number);
    mixed = query_id_mix((int64_t) (mixed ^ mixed >> 32));
    return (int) (mixed >> (64 - SPILL_PART_BITS * (level + 1)) & (PARTS - 1));
}

void spill_put(struct spill *spill, enum spill_side side, const struct match_item *item)
{
    const int part = part_of(item, spill->level);
    FILE **file = &spill->file[side][part];
    spill->queries[part] += side == SPILL_QUERIES;
    if (!*file && !(*file = temporary_open())) {
        fail(spill);
        return;
    }
    if (fwrite(item, sizeof *item, 1, *file) != 1 ||
        (item->size > 0 && fwrite(item->bytes, item->size, 1, *file) != 1) ||
        (item->more_size > 0 && fwrite(item->more, item->more_size, 1, *file) != 1))
        fail(spill);
}

/* ---- Joining ---- */

/* Where a query of the part stands in its file. */
struct entry {
    struct query_header ids;
    enum log_kind kind;
    bool matched;
    size_t number; /* in the order of the file */
    size_t next;   /* no entry from here to before that one is not matched; at first itself */
    off_t at;
};

struct joining {
    struct spill *spill;
    const struct match_sink *sink;
    struct entry *entry; /* [count], by kind, client id, sequence number, utime and number */
    size_t count, room;
    unsigned char *buffer[SPILL_SIDES]; /* [2 * LOG_DATA_MAX] */
};

/* The next item of a file; its bytes are in the buffer. False at the end, and after a failure. */
static bool read_item(struct spill *spill, FILE *file, unsigned char *buffer,
                      struct match_item *out)
{
    if (fread(out, sizeof *out, 1, file) != 1)
        return ferror(file) ? fail(spill) : false;
    const size_t size = (size_t) out->size + out->more_size;
    if (size > 0 && fread(buffer, size, 1, file) != 1)
        return fail(spill);
    out->bytes = buffer;
    out->more = buffer + out->size;
    return true;
}

#define COMPARE(a, b) ((a) < (b) ? -1 : (a) > (b))

/* Without utime; with it. */
static int compare_group(const struct entry *a, enum log_kind kind, const struct query_header *ids)
{
    int order = COMPARE(a->kind, kind);
    if (!order)
        order = COMPARE(a->ids.client_id, ids->client_id);
    return order ? order : COMPARE(a->ids.sequence_number, ids->sequence_number);
}

static int compare_ids(const struct entry *a, enum log_kind kind, const struct query_header *ids)
{
    const int order = compare_group(a, kind, ids);
    return order ? order : COMPARE(a->ids.utime, ids->utime);
}

/* The whole group is before what it is asked for. */
static int compare_past(const struct entry *a, enum log_kind kind, const struct query_header *ids)
{
    return compare_group(a, kind, ids) <= 0 ? -1 : 1;
}

static int compare_entries(const void *left, const void *right)
{
    const struct entry *a = left, *b = right;
    const int order = compare_ids(a, b->kind, &b->ids);
    return order ? order : COMPARE(a->number, b->number);
}

static void list_queries(struct joining *joining, FILE *file)
{
    struct match_item item;
    joining->count = 0;
    rewind(file);
    for (off_t at = 0; read_item(joining->spill, file, joining->buffer[SPILL_QUERIES], &item);
         at = ftello(file)) {
        joining->entry = allocate_room(joining->entry, &joining->room, joining->count + 1,
                                       sizeof *joining->entry);
        joining->entry[joining->count] =
            (struct entry){.ids = item.ids, .kind = item.kind, .number = joining->count, .at = at};
        joining->count++;
    }
    if (joining->count > 0)
        qsort(joining->entry, joining->count, sizeof *joining->entry, compare_entries);
    for (size_t i = 0; i < joining->count; i++)
        joining->entry[i].next = i;
}

/* The first entry that is not before the ids, as compare has them. */
static size_t lower_bound(const struct joining *joining, const struct match_item *item,
                          int (*compare)(const struct entry *, enum log_kind,
                                         const struct query_header *))
{
    size_t low = 0, high = joining->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (compare(&joining->entry[middle], item->kind, &item->ids) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* The first entry from there on that is not matched, or the count. Each search shortens the way of
 * those that come after it, so that many with the same ids take no longer than others. */
static size_t next_unmatched(struct joining *joining, size_t i)
{
    struct entry *entry = joining->entry;
    while (i < joining->count && entry[i].matched) {
        const size_t next = entry[i].next;
        if (next < joining->count)
            entry[i].next = entry[next].next;
        i = next;
    }
    return i;
}

static struct entry *choose(struct joining *joining, const struct match_item *result)
{
    struct entry *entry = joining->entry;
    const size_t first = lower_bound(joining, result, compare_group);
    if (first == joining->count || compare_group(&entry[first], result->kind, &result->ids) != 0)
        return NULL;
    size_t i = next_unmatched(joining, lower_bound(joining, result, compare_ids));
    if (i < joining->count && compare_ids(&entry[i], result->kind, &result->ids) == 0)
        return &entry[i];
    i = next_unmatched(joining, first);
    if (i < joining->count && compare_group(&entry[i], result->kind, &result->ids) == 0)
        return &entry[i];
    return &entry[lower_bound(joining, result, compare_past) - 1];
}

static void match_entry(struct joining *joining, struct entry *entry)
{
    entry->matched = true;
    entry->next = (size_t) (entry - joining->entry) + 1;
}

static void join_results(struct joining *joining, FILE *queries, FILE *results)
{
    struct match_item query, result;
    rewind(results);
    while (read_item(joining->spill, results, joining->buffer[SPILL_RESULTS], &result)) {
        struct entry *entry = choose(joining, &result);
        if (!entry) {
            joining->sink->result_alone(joining->sink->user, &result);
        } else if (fseeko(queries, entry->at, SEEK_SET) == 0 &&
                   read_item(joining->spill, queries, joining->buffer[SPILL_QUERIES], &query)) {
            match_entry(joining, entry);
            joining->sink->both(joining->sink->user, &query, &result);
        } else {
            fail(joining->spill);
        }
    }
}

static int compare_numbers(const void *left, const void *right)
{
    const struct entry *a = left, *b = right;
    return COMPARE(a->number, b->number);
}

static void tell_alone(struct joining *joining, FILE *queries)
{
    struct match_item query;
    if (joining->count > 0)
        qsort(joining->entry, joining->count, sizeof *joining->entry, compare_numbers);
    rewind(queries);
    for (size_t i = 0; i < joining->count; i++)
        if (!read_item(joining->spill, queries, joining->buffer[SPILL_QUERIES], &query))
            return;
        else if (!joining->entry[i].matched)
            joining->sink->query_alone(joining->sink->user, &query);
}

/* Where there are no results, it takes no memory to tell that. */
static void tell_all_alone(struct joining *joining, FILE *queries)
{
    struct match_item query;
    rewind(queries);
    while (read_item(joining->spill, queries, joining->buffer[SPILL_QUERIES], &query))
        joining->sink->query_alone(joining->sink->user, &query);
}

/* What a file holds goes to another spill, and the file is gone. */
static void pass_on(struct joining *joining, enum spill_side side, int part, struct spill *to)
{
    FILE **file = &joining->spill->file[side][part];
    struct match_item item;
    rewind(*file);
    while (read_item(joining->spill, *file, joining->buffer[side], &item))
        spill_put(to, side, &item);
    fclose(*file);
    *file = NULL;
}

/* What is in memory goes first: each level has its own. */
static void join_again(struct joining *joining, int part)
{
    struct spill *next = open_level(joining->spill->level + 1);
    for (int side = 0; side < SPILL_SIDES; side++)
        pass_on(joining, (enum spill_side) side, part, next);
    free(joining->entry);
    joining->entry = NULL;
    joining->room = 0;
    if (!joining->spill->error && !spill_join(next, joining->sink))
        fail(joining->spill);
    spill_close(next);
}

static void join_part(struct joining *joining, int part)
{
    FILE *queries = joining->spill->file[SPILL_QUERIES][part];
    FILE *results = joining->spill->file[SPILL_RESULTS][part];
    joining->count = 0;
    if (queries && !results) {
        tell_all_alone(joining, queries);
        return;
    }
    if (queries && joining->spill->queries[part] > SPILL_QUERIES_AT_ONCE &&
        joining->spill->level + 1 < LEVELS) {
        join_again(joining, part);
        return;
    }
    if (queries)
        list_queries(joining, queries);
    if (results)
        join_results(joining, queries, results);
    if (queries)
        tell_alone(joining, queries);
}

bool spill_join(struct spill *spill, const struct match_sink *sink)
{
    struct joining joining = {.spill = spill, .sink = sink};
    for (int side = 0; side < SPILL_SIDES; side++)
        joining.buffer[side] = allocate(2 * LOG_DATA_MAX, 1);
    for (int part = 0; part < PARTS && !spill->error; part++)
        join_part(&joining, part);
    for (int side = 0; side < SPILL_SIDES; side++)
        free(joining.buffer[side]);
    free(joining.entry);
    errno = spill->error;
    return !spill->error;
}
