#include "listing.h"

#include "allocate.h"

#include <glib.h>
#include <stdlib.h>
#include <string.h>

struct listing_entry {
    struct difference difference;
    char certificate[2][LISTING_CERTIFICATE_MAX];
};

struct listing {
    GPtrArray *entries; /* of struct listing_entry, sorted */
    size_t limit;
    int64_t put;
};

struct listing *listing_open(int64_t limit)
{
    struct listing *list = allocate(1, sizeof *list);
    list->entries = g_ptr_array_new_with_free_func(free);
    list->limit = (size_t) limit;
    return list;
}

void listing_close(struct listing *list)
{
    if (!list)
        return;
    g_ptr_array_free(list->entries, TRUE);
    free(list);
}

static const struct difference *entry_at(const struct listing *list, size_t at)
{
    const struct listing_entry *entry = list->entries->pdata[at];
    return &entry->difference;
}

static bool precedes(const struct difference *a, const struct difference *b)
{
    return a->place.log < b->place.log ||
           (a->place.log == b->place.log && a->place.offset < b->place.offset);
}

static void copy_certificate(struct difference_side *side, char copy[LISTING_CERTIFICATE_MAX])
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
    return entry;
}

/* Differences arrive nearly in order, so the search is short. */
void listing_put(struct listing *list, const struct difference *difference)
{
    size_t at = list->entries->len;
    list->put++;
    while (at > 0 && precedes(difference, entry_at(list, at - 1)))
        at--;
    if (at == list->limit)
        return;
    g_ptr_array_insert(list->entries, (int) at, copy_of(difference));
    if (list->entries->len > list->limit)
        g_ptr_array_set_size(list->entries, (int) list->limit);
}

int64_t listing_beyond(const struct listing *list)
{
    return list->put - (int64_t) list->entries->len;
}

void listing_each(const struct listing *list, difference_sink *sink, void *user)
{
    for (size_t i = 0; i < list->entries->len; i++)
        sink(user, entry_at(list, i));
}
