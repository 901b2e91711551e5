/* Pending queries: they name a handle that the log has not defined so far. */
#ifndef PENDING_H
#define PENDING_H

#include "handle.h"
#include "match.h"

/* All 0: empty. */
struct pending_queries {
    struct pending_handle *handles; /* owned: hash table; NULL: empty */
};

/* Frees the items that are no longer in the table of match.h. */
void pending_close(struct pending_queries *pending);

bool pending_is_empty(const struct pending_queries *pending);

/* Adds an item that needs this handle. The item is not copied. Exits with status 1 if memory is
 * exhausted. */
void pending_add(struct pending_queries *pending, const struct handle *handle,
                 struct match_item *item);

/* Frees the items of a list linked by ->pending, as pending_close() does. */
void pending_free_list(struct match_item *first);

/* Removes the items that need this handle (NULL: some handle). Returns a list linked by ->pending;
 * NULL: none. */
struct match_item *pending_take(struct pending_queries *pending, const struct handle *handle);

#endif
