#include "listing.h"

#include "allocate.h"

#include <stdlib.h>
#include <string.h>

struct listing_entry {
    struct difference difference;
    char certificate[2][LISTING_CERTIFICATE_MAX];
};

struct listing {
    struct listing_entry **entry; /* owned, [count], sorted */
    size_t count, capacity, limit;
    int64_t put;
};

struct listing *listing_open(int64_t limit)
{
    struct listing *list = allocate(1, sizeof *list);
    list->limit = (size_t) limit;
    return list;
}

void listing_close(struct listing *list)
{
    if (!list)
        return;
    while (list->count > 0)
        free(list->entry[--list->count]);
    free(list->entry);
    free(list);
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

/* Differences arrive nearly in order, so few are moved. */
void listing_put(struct listing *list, const struct difference *difference)
{
    list->put++;
    if (list->count == list->limit) {
        if (list->limit == 0 || !precedes(difference, &list->entry[list->count - 1]->difference))
            return;
        free(list->entry[--list->count]);
    }
    list->entry = allocate_grow(list->entry, &list->capacity, list->count + 1, sizeof *list->entry);
    size_t at = list->count++;
    for (; at > 0 && precedes(difference, &list->entry[at - 1]->difference); at--)
        list->entry[at] = list->entry[at - 1];
    list->entry[at] = copy_of(difference);
}

int64_t listing_beyond(const struct listing *list)
{
    return list->put > (int64_t) list->limit ? list->put - (int64_t) list->limit : 0;
}

void listing_each(const struct listing *list, difference_sink *sink, void *user)
{
    for (size_t i = 0; i < list->count; i++)
        sink(user, &list->entry[i]->difference);
}
