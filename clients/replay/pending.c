#include "pending.h"

#include <stdlib.h>

struct pending_handle {
    struct handle handle;
    struct match_item *first, **end;
    UT_hash_handle hh;
};

void pending_free_list(struct match_item *first)
{
    for (struct match_item *item = first, *next; item; item = next) {
        next = item->pending;
        match_drop(item);
    }
}

void pending_close(struct pending_queries *pending)
{
    while (!pending_is_empty(pending))
        pending_free_list(pending_take(pending, NULL));
}

bool pending_is_empty(const struct pending_queries *pending)
{
    return !pending->handles;
}

void pending_add(struct pending_queries *pending, const struct handle *handle,
                 struct match_item *item)
{
    struct pending_handle *entry;
    HASH_FIND(hh, pending->handles, handle, sizeof *handle, entry);
    if (!entry) {
        entry = allocate(1, sizeof *entry);
        entry->handle = *handle;
        entry->end = &entry->first;
        HASH_ADD(hh, pending->handles, handle, sizeof *handle, entry);
    }
    item->pending = NULL;
    *entry->end = item;
    entry->end = &item->pending;
}

struct match_item *pending_take(struct pending_queries *pending, const struct handle *handle)
{
    struct pending_handle *entry = pending->handles;
    if (handle)
        HASH_FIND(hh, pending->handles, handle, sizeof *handle, entry);
    if (!entry)
        return NULL;
    struct match_item *first = entry->first;
    HASH_DELETE(hh, pending->handles, entry);
    free(entry);
    return first;
}
