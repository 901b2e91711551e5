#include "runs.h"

#include <assert.h>
#include <stdlib.h>

/* Most runs that are examined in the list that contains the requested length. Any run of a later
 * list is long enough. */
enum { SEARCHES_MAX = 8 };

static int list_of(int32_t length)
{
    return 31 - __builtin_clz((unsigned) length);
}

static void set_length(struct runs *runs, int32_t first, int32_t length, int sign)
{
    runs->slot[first].length = runs->slot[first + length - 1].length = sign * length;
}

static void link_free(struct runs *runs, int32_t first, int32_t length)
{
    int32_t *list = &runs->list[list_of(length)];
    set_length(runs, first, length, -1);
    runs->slot[first].next = *list;
    runs->slot[first].previous = -1;
    if (*list >= 0)
        runs->slot[*list].previous = first;
    *list = first;
}

static void unlink_free(struct runs *runs, int32_t first)
{
    const struct run_slot *slot = &runs->slot[first];
    if (slot->previous >= 0)
        runs->slot[slot->previous].next = slot->next;
    else
        runs->list[list_of(-slot->length)] = slot->next;
    if (slot->next >= 0)
        runs->slot[slot->next].previous = slot->previous;
}

void runs_init(struct runs *runs, struct run_slot *slot, int32_t count)
{
    assert(count >= 1);
    runs->count = count;
    runs->slot = slot;
    for (int c = 0; c < RUNS_LISTS; c++)
        runs->list[c] = -1;
    link_free(runs, 0, count);
}

static int32_t find_free(const struct runs *runs, int32_t length)
{
    int c = list_of(length);
    int32_t first = runs->list[c];
    for (int i = 0; first >= 0 && i < SEARCHES_MAX; i++, first = runs->slot[first].next)
        if (-runs->slot[first].length >= length)
            return first;
    for (c++; c < RUNS_LISTS; c++)
        if (runs->list[c] >= 0)
            return runs->list[c];
    return -1;
}

int32_t runs_allocate(struct runs *runs, int32_t length)
{
    assert(length >= 1);
    const int32_t first = find_free(runs, length);
    if (first < 0)
        return -1;
    const int32_t left = -runs->slot[first].length - length;
    unlink_free(runs, first);
    set_length(runs, first, length, 1);
    if (left > 0)
        link_free(runs, first + length, left);
    return first;
}

int32_t runs_free(struct runs *runs, int32_t first)
{
    int32_t length = runs->slot[first].length;
    const int32_t end = first + length;
    assert(length > 0);
    if (end < runs->count && runs->slot[end].length < 0) {
        length -= runs->slot[end].length;
        unlink_free(runs, end);
    }
    if (first > 0 && runs->slot[first - 1].length < 0) {
        const int32_t before = -runs->slot[first - 1].length;
        first -= before;
        length += before;
        unlink_free(runs, first);
    }
    link_free(runs, first, length);
    return first;
}

int32_t runs_length(const struct runs *runs, int32_t first)
{
    return abs(runs->slot[first].length);
}

int32_t runs_after(const struct runs *runs, int32_t first)
{
    const int32_t end = first + runs_length(runs, first);
    return end < runs->count ? end : -1;
}

int32_t runs_before(const struct runs *runs, int32_t first)
{
    return first > 0 ? first - runs->slot[first - 1].length : -1;
}
