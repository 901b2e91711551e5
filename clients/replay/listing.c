#include "listing.h"

#include "allocate.h"

#include <glib.h>
#include <stdlib.h>
#include <string.h>

struct entry {
    struct difference difference;
    int64_t number; /* of its arrival */
    char certificate[2][LISTING_CERTIFICATE_MAX];
    char detail[COMPARE_DETAIL_MAX];
};

struct listing {
    GPtrArray *entries; /* of struct entry; less than twice the limit */
    int64_t limit, put;
};

struct listing *listing_open(int64_t limit)
{
    struct listing *list = allocate(1, sizeof *list);
    list->entries = g_ptr_array_new_with_free_func(free);
    list->limit = limit;
    return list;
}

void listing_close(struct listing *list)
{
    if (!list)
        return;
    g_ptr_array_free(list->entries, TRUE);
    free(list);
}

static bool is_number(enum difference_kind kind)
{
    return kind != DIFFERENT_SCENE && kind != DIFFERENT_STATUS && kind != DIFFERENT_VERDICT;
}

static int compare(const void *left, const void *right)
{
    const struct entry *a = *(struct entry *const *) left, *b = *(struct entry *const *) right;
    const struct match_place *at = &a->difference.place, *other = &b->difference.place;
    const int rank = is_number(a->difference.kind) - is_number(b->difference.kind);
    if (rank != 0)
        return rank;
    if (at->log != other->log)
        return at->log < other->log ? -1 : 1;
    if (at->offset != other->offset)
        return at->offset < other->offset ? -1 : 1;
    return a->number < b->number ? -1 : 1;
}

/* Sorts the entries, and drops those beyond the limit. */
static void sort(const struct listing *list)
{
    g_ptr_array_sort(list->entries, compare);
    if (list->entries->len > list->limit)
        g_ptr_array_set_size(list->entries, (int) list->limit);
}

static const char *copy_text(const char *text, char *copy, size_t size)
{
    if (text)
        g_strlcpy(copy, text, size);
    return text ? copy : NULL;
}

void listing_put(struct listing *list, const struct difference *difference)
{
    struct entry *entry = allocate(1, sizeof *entry);
    struct difference *own = &entry->difference;
    *own = *difference;
    own->then.certificate =
        copy_text(own->then.certificate, entry->certificate[0], LISTING_CERTIFICATE_MAX);
    own->now.certificate =
        copy_text(own->now.certificate, entry->certificate[1], LISTING_CERTIFICATE_MAX);
    own->detail = copy_text(own->detail, entry->detail, sizeof entry->detail);
    entry->number = list->put++;
    g_ptr_array_add(list->entries, entry);
    if (list->entries->len >= 2 * list->limit)
        sort(list);
}

int64_t listing_beyond(const struct listing *list)
{
    return list->put > list->limit ? list->put - list->limit : 0;
}

void listing_each(const struct listing *list, difference_sink *sink, void *user)
{
    sort(list);
    for (size_t i = 0; i < list->entries->len; i++)
        sink(user, &((struct entry *) list->entries->pdata[i])->difference);
}
