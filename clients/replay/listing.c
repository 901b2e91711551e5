#include "listing.h"

#include "allocate.h"

#include <glib.h>
#include <stdlib.h>

struct entry {
    struct difference difference; /* owns its texts */
    int64_t number;               /* of its arrival */
};

struct listing {
    GSequence *entries; /* of struct entry, sorted, at most limit */
    int64_t limit, put;
};

static void free_entry(void *entry)
{
    struct difference *own = &((struct entry *) entry)->difference;
    g_free((char *) own->then.certificate);
    g_free((char *) own->now.certificate);
    g_free((char *) own->detail);
    free(entry);
}

struct listing *listing_open(int64_t limit)
{
    struct listing *list = allocate(1, sizeof *list);
    list->entries = g_sequence_new(free_entry);
    list->limit = limit;
    return list;
}

void listing_close(struct listing *list)
{
    if (list)
        g_sequence_free(list->entries);
    free(list);
}

static bool is_number(enum difference_kind kind)
{
    return kind != DIFFERENT_SCENE && kind != DIFFERENT_STATUS && kind != DIFFERENT_VERDICT;
}

static int compare(const void *left, const void *right, void *user)
{
    const struct entry *a = left, *b = right;
    const struct match_place *at = &a->difference.place, *other = &b->difference.place;
    (void) user;
    const int rank = is_number(a->difference.kind) - is_number(b->difference.kind);
    if (rank != 0)
        return rank;
    if (at->log != other->log)
        return at->log < other->log ? -1 : 1;
    if (at->offset != other->offset)
        return at->offset < other->offset ? -1 : 1;
    return a->number < b->number ? -1 : 1;
}

void listing_put(struct listing *list, const struct difference *difference)
{
    struct entry *entry = allocate(1, sizeof *entry);
    struct difference *own = &entry->difference;
    *own = *difference;
    own->then.certificate = g_strndup(own->then.certificate, LISTING_CERTIFICATE_MAX);
    own->now.certificate = g_strndup(own->now.certificate, LISTING_CERTIFICATE_MAX);
    own->detail = g_strdup(own->detail);
    entry->number = list->put++;
    g_sequence_insert_sorted(list->entries, entry, compare, NULL);
    if (g_sequence_get_length(list->entries) > list->limit)
        g_sequence_remove(g_sequence_iter_prev(g_sequence_get_end_iter(list->entries)));
}

int64_t listing_beyond(const struct listing *list)
{
    return list->put > list->limit ? list->put - list->limit : 0;
}

void listing_each(const struct listing *list, difference_sink *sink, void *user)
{
    GSequenceIter *at = g_sequence_get_begin_iter(list->entries);
    for (; !g_sequence_iter_is_end(at); at = g_sequence_iter_next(at))
        sink(user, &((struct entry *) g_sequence_get(at))->difference);
}
