#include "listing.h"

#include "allocate.h"

#include <glib.h>
#include <stdlib.h>
#include <string.h>

struct listing_entry {
    struct difference difference;
    char certificate[2][LISTING_CERTIFICATE_MAX];
    char detail[COMPARE_DETAIL_MAX];
};

enum { RANKS = 2 };

struct listing {
    GPtrArray *entries[RANKS]; /* of struct listing_entry, sorted; each up to the limit */
    size_t limit;
    int64_t put;
};

static int rank_of(enum difference_kind kind)
{
    return kind == DIFFERENT_SCENE || kind == DIFFERENT_STATUS || kind == DIFFERENT_VERDICT ? 0 : 1;
}

struct listing *listing_open(int64_t limit)
{
    struct listing *list = allocate(1, sizeof *list);
    for (int rank = 0; rank < RANKS; rank++)
        list->entries[rank] = g_ptr_array_new_with_free_func(free);
    list->limit = (size_t) limit;
    return list;
}

void listing_close(struct listing *list)
{
    if (!list)
        return;
    for (int rank = 0; rank < RANKS; rank++)
        g_ptr_array_free(list->entries[rank], TRUE);
    free(list);
}

static const struct difference *entry_at(const GPtrArray *entries, size_t at)
{
    const struct listing_entry *entry = entries->pdata[at];
    return &entry->difference;
}

static bool precedes(const struct difference *a, const struct difference *b)
{
    return a->place.log < b->place.log ||
           (a->place.log == b->place.log && a->place.offset < b->place.offset);
}

static void copy_certificate(struct fmb_client_answer *side, char copy[LISTING_CERTIFICATE_MAX])
{
    if (!side->certificate)
        return;
    strncpy(copy, side->certificate, LISTING_CERTIFICATE_MAX - 1);
    side->certificate = copy;
}

static struct listing_entry *copy_of(const struct difference *difference)
{
    struct listing_entry *entry = allocate(1, sizeof *entry);
    entry->difference = *difference;
    copy_certificate(&entry->difference.then, entry->certificate[0]);
    copy_certificate(&entry->difference.now, entry->certificate[1]);
    if (difference->detail) {
        strncpy(entry->detail, difference->detail, sizeof entry->detail - 1);
        entry->difference.detail = entry->detail;
    }
    return entry;
}

/* Differences arrive nearly in order, so the search is short. */
void listing_put(struct listing *list, const struct difference *difference)
{
    GPtrArray *entries = list->entries[rank_of(difference->kind)];
    size_t at = entries->len;
    list->put++;
    while (at > 0 && precedes(difference, entry_at(entries, at - 1)))
        at--;
    if (at == list->limit)
        return;
    g_ptr_array_insert(entries, (int) at, copy_of(difference));
    if (entries->len > list->limit)
        g_ptr_array_set_size(entries, (int) list->limit);
}

int64_t listing_beyond(const struct listing *list)
{
    return list->put > (int64_t) list->limit ? list->put - (int64_t) list->limit : 0;
}

void listing_each(const struct listing *list, difference_sink *sink, void *user)
{
    size_t left = list->limit;
    for (int rank = 0; rank < RANKS; rank++)
        for (size_t i = 0; i < list->entries[rank]->len && left > 0; i++, left--)
            sink(user, entry_at(list->entries[rank], i));
}
