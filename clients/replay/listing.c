#include "listing.h"

#include "allocate.h"

#include <stdlib.h>
#include <string.h>

struct listing_entry {
    struct difference difference;
    int64_t number;       /* order of arrival */
    char *certificate[2]; /* owned; NULL: none */
};

/* At most twice the limit, unsorted. */
struct listing {
    struct listing_entry *entry;
    size_t count, capacity, limit;
    int64_t put;
};

struct listing *listing_open(int64_t limit)
{
    struct listing *list = allocate(1, sizeof *list);
    list->limit = (size_t) limit;
    return list;
}

static void free_entry(struct listing_entry *entry)
{
    free(entry->certificate[0]);
    free(entry->certificate[1]);
}

void listing_close(struct listing *list)
{
    if (!list)
        return;
    for (size_t i = 0; i < list->count; i++)
        free_entry(&list->entry[i]);
    free(list->entry);
    free(list);
}

static int compare_entries(const void *left, const void *right)
{
    const struct listing_entry *a = left, *b = right;
    const struct match_place *x = &a->difference.place, *y = &b->difference.place;
    if (x->log != y->log)
        return x->log < y->log ? -1 : 1;
    if (x->offset != y->offset)
        return x->offset < y->offset ? -1 : 1;
    return a->number < b->number ? -1 : a->number > b->number;
}

static char *copy_of(const char *certificate)
{
    if (!certificate)
        return NULL;
    char *copy = allocate(LISTING_CERTIFICATE_MAX, 1);
    strncpy(copy, certificate, LISTING_CERTIFICATE_MAX - 1);
    return copy;
}

static void set(struct listing_entry *entry, const struct difference *difference, int64_t number)
{
    entry->difference = *difference;
    entry->number = number;
    entry->certificate[0] = copy_of(difference->then.certificate);
    entry->certificate[1] = copy_of(difference->now.certificate);
    entry->difference.then.certificate = entry->certificate[0];
    entry->difference.now.certificate = entry->certificate[1];
}

/* Sorts, and removes the differences beyond the limit. */
static void shorten(struct listing *list)
{
    if (list->count > 0)
        qsort(list->entry, list->count, sizeof *list->entry, compare_entries);
    while (list->count > list->limit)
        free_entry(&list->entry[--list->count]);
}

void listing_put(struct listing *list, const struct difference *difference)
{
    const int64_t number = list->put++;
    if (list->limit == 0)
        return;
    if (list->count == 2 * list->limit)
        shorten(list);
    list->entry = allocate_grow(list->entry, &list->capacity, list->count + 1, sizeof *list->entry);
    set(&list->entry[list->count++], difference, number);
}

int64_t listing_beyond(const struct listing *list)
{
    return list->put > (int64_t) list->limit ? list->put - (int64_t) list->limit : 0;
}

void listing_each(struct listing *list, difference_sink *sink, void *user)
{
    shorten(list);
    for (size_t i = 0; i < list->count; i++)
        sink(user, &list->entry[i].difference);
}
