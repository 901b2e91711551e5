#include "pending.h"

#include <stdlib.h>

struct waiting {
    struct handle handle;
    struct match_item *first, **end;
    UT_hash_handle hh;
};

struct pending {
    struct waiting *handles;
};

struct pending *pending_open(void)
{
    return allocate(1, sizeof(struct pending));
}

void pending_free_list(struct match_item *first)
{
    for (struct match_item *item = first, *next; item; item = next) {
        next = item->pending;
        if (!item->waits)
            match_free(item);
    }
}

void pending_close(struct pending *pending)
{
    while (pending && !pending_is_empty(pending))
        pending_free_list(pending_take(pending, NULL));
    free(pending);
}

bool pending_is_empty(const struct pending *pending)
{
    return !pending->handles;
}

void pending_add(struct pending *pending, const struct handle *handle, struct match_item *item)
{
    struct waiting *waiting;
    HASH_FIND(hh, pending->handles, handle, sizeof *handle, waiting);
    if (!waiting) {
        waiting = allocate(1, sizeof *waiting);
        waiting->handle = *handle;
        waiting->end = &waiting->first;
        HASH_ADD(hh, pending->handles, handle, sizeof *handle, waiting);
    }
    item->pending = NULL;
    *waiting->end = item;
    waiting->end = &item->pending;
}

struct match_item *pending_take(struct pending *pending, const struct handle *handle)
{
    struct waiting *waiting = pending->handles;
    if (handle)
        HASH_FIND(hh, pending->handles, handle, sizeof *handle, waiting);
    if (!waiting)
        return NULL;
    struct match_item *first = waiting->first;
    HASH_DELETE(hh, pending->handles, waiting);
    free(waiting);
    return first;
}
