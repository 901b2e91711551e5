#include "pending.h"

#include "allocate.h"
#include "keyed_hash.h"

#include <stdlib.h>

struct waiting {
    struct handle handle;
    struct match_item *first, **end;
    UT_hash_handle hh;
};

struct pending {
    struct waiting *handles;
    struct keyed_hash hash;
};

struct pending *pending_open(void)
{
    struct pending *pending = allocate(1, sizeof *pending);
    pending->hash = keyed_hash_make();
    return pending;
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

static struct waiting *find(const struct pending *pending, const struct handle *handle,
                            unsigned *hash)
{
    struct waiting *waiting;
    *hash = keyed_hash_of(&pending->hash, handle, sizeof *handle);
    HASH_FIND_BYHASHVALUE(hh, pending->handles, handle, sizeof *handle, *hash, waiting);
    return waiting;
}

void pending_add(struct pending *pending, const struct handle *handle, struct match_item *item)
{
    unsigned hash;
    struct waiting *waiting = find(pending, handle, &hash);
    if (!waiting) {
        waiting = allocate(1, sizeof *waiting);
        waiting->handle = *handle;
        waiting->end = &waiting->first;
        HASH_ADD_BYHASHVALUE(hh, pending->handles, handle, sizeof *handle, hash, waiting);
    }
    item->pending = NULL;
    *waiting->end = item;
    waiting->end = &item->pending;
}

struct match_item *pending_take(struct pending *pending, const struct handle *handle)
{
    unsigned hash;
    struct waiting *waiting = handle ? find(pending, handle, &hash) : pending->handles;
    if (!waiting)
        return NULL;
    struct match_item *first = waiting->first;
    HASH_DELETE(hh, pending->handles, waiting);
    free(waiting);
    return first;
}
