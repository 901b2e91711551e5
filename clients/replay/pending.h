/* Queries that wait for the definition of a handle that the log has not defined so far. */
#ifndef PENDING_H
#define PENDING_H

#include "handle.h"
#include "match.h"

struct pending;

/* Exits with status 1 if memory is exhausted. */
struct pending *pending_open(void);
/* pending may be NULL. Frees the items that are no longer in the table of match.h. */
void pending_close(struct pending *pending);

bool pending_is_empty(const struct pending *pending);

/* Adds an item that waits for this handle. Not copied. */
void pending_add(struct pending *pending, const struct handle *handle, struct match_item *item);

/* Frees the items of a list linked by ->pending, as pending_close() does. */
void pending_free_list(struct match_item *first);

/* Removes the items that wait for this handle (NULL: for any one handle). Returns a list linked by
 * ->pending; NULL: none. */
struct match_item *pending_take(struct pending *pending, const struct handle *handle);

#endif
