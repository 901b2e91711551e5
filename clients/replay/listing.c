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
    size_t count, room, limit;
    int64_t put;
};

struct listing *listing_open(int64_t limit)
{
    struct listing *told = allocate(1, sizeof *told);
    told->limit = (size_t) limit;
    return told;
}

static void free_entry(struct entry *entry)
{
    free(entry->certificate[0]);
    free(entry->certificate[1]);
}

void listing_close(struct listing *told)
{
    if (!told)
        return;
    for (size_t i = 0; i < told->count; i++)
        free_entry(&told->entry[i]);
    free(told->entry);
    free(told);
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

static bool is_before(const struct listing *told, size_t a, size_t b)
{
    return compare_entries(&told->entry[a], &told->entry[b]) < 0;
}

static void swap(struct listing *told, size_t a, size_t b)
{
    const struct entry entry = told->entry[a];
    told->entry[a] = told->entry[b];
    told->entry[b] = entry;
}

static void sift_up(struct listing *told, size_t i)
{
    for (size_t above = (i - 1) / 2; i > 0 && is_before(told, above, i); above = (i - 1) / 2) {
        swap(told, above, i);
        i = above;
    }
}

static void sift_down(struct listing *told, size_t i)
{
    for (size_t below; (below = 2 * i + 1) < told->count; i = below) {
        if (below + 1 < told->count && is_before(told, below, below + 1))
            below++;
        if (!is_before(told, i, below))
            return;
        swap(told, i, below);
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

void listing_put(struct listing *told, const struct found *found)
{
    const struct entry here = {.found = *found, .number = told->put++};
    if (told->count < told->limit) {
        told->entry = allocate_room(told->entry, &told->room, told->count + 1, sizeof here);
        set(&told->entry[told->count++], found, here.number);
        sift_up(told, told->count - 1);
    } else if (told->limit > 0 && compare_entries(&here, &told->entry[0]) < 0) {
        free_entry(&told->entry[0]);
        set(&told->entry[0], found, here.number);
        sift_down(told, 0);
    }
}

int64_t listing_beyond(const struct listing *told)
{
    return told->put - (int64_t) told->count;
}

void listing_each(struct listing *told, found_sink *sink, void *user)
{
    if (told->count > 0)
        qsort(told->entry, told->count, sizeof *told->entry, compare_entries);
    for (size_t i = 0; i < told->count; i++)
        sink(user, &told->entry[i].found);
}
