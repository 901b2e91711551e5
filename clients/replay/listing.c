#include "listing.h"

#include "allocate.h"

#include <stdlib.h>
#include <string.h>

struct entry {
    struct found found;
    int64_t number;       /* in the order in which they came */
    char *certificate[2]; /* owned; NULL: none */
};

/* A heap, the last one on top: entry[i] is not before entry[2 * i + 1] and entry[2 * i + 2]. */
struct listing {
    struct entry *entry;
    size_t count, capacity, limit;
    int64_t put;
};

struct listing *listing_open(int64_t limit)
{
    struct listing *list = allocate(1, sizeof *list);
    list->limit = (size_t) limit;
    return list;
}

static void free_entry(struct entry *entry)
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
    const struct entry *a = left, *b = right;
    const struct match_place *x = &a->found.place, *y = &b->found.place;
    if (x->log != y->log)
        return x->log < y->log ? -1 : 1;
    if (x->offset != y->offset)
        return x->offset < y->offset ? -1 : 1;
    return a->number < b->number ? -1 : a->number > b->number;
}

static bool is_before(const struct listing *list, size_t a, size_t b)
{
    return compare_entries(&list->entry[a], &list->entry[b]) < 0;
}

static void swap(struct listing *list, size_t a, size_t b)
{
    const struct entry entry = list->entry[a];
    list->entry[a] = list->entry[b];
    list->entry[b] = entry;
}

static void sift_up(struct listing *list, size_t i)
{
    for (size_t above = (i - 1) / 2; i > 0 && is_before(list, above, i); above = (i - 1) / 2) {
        swap(list, above, i);
        i = above;
    }
}

static void sift_down(struct listing *list, size_t i)
{
    for (size_t below; (below = 2 * i + 1) < list->count; i = below) {
        if (below + 1 < list->count && is_before(list, below, below + 1))
            below++;
        if (!is_before(list, i, below))
            return;
        swap(list, i, below);
    }
}

static char *copy_of(const char *certificate)
{
    if (!certificate)
        return NULL;
    char *copy = allocate(FOUND_TEXT_MAX, 1);
    strncpy(copy, certificate, FOUND_TEXT_MAX - 1);
    return copy;
}

static void set(struct entry *entry, const struct found *found, int64_t number)
{
    struct difference *difference = &entry->found.difference;
    entry->found = *found;
    entry->number = number;
    entry->certificate[0] = copy_of(found->difference.then.certificate);
    entry->certificate[1] = copy_of(found->difference.now.certificate);
    difference->then.certificate = entry->certificate[0];
    difference->now.certificate = entry->certificate[1];
}

void listing_put(struct listing *list, const struct found *found)
{
    const struct entry here = {.found = *found, .number = list->put++};
    if (list->count < list->limit) {
        list->entry = allocate_room(list->entry, &list->capacity, list->count + 1, sizeof here);
        set(&list->entry[list->count++], found, here.number);
        sift_up(list, list->count - 1);
    } else if (list->limit > 0 && compare_entries(&here, &list->entry[0]) < 0) {
        free_entry(&list->entry[0]);
        set(&list->entry[0], found, here.number);
        sift_down(list, 0);
    }
}

int64_t listing_beyond(const struct listing *list)
{
    return list->put - (int64_t) list->count;
}

void listing_each(struct listing *list, found_sink *sink, void *user)
{
    if (list->count > 0)
        qsort(list->entry, list->count, sizeof *list->entry, compare_entries);
    for (size_t i = 0; i < list->count; i++)
        sink(user, &list->entry[i].found);
}
