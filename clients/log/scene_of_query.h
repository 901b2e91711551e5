/* Converts a query to a scene (scene.h) with the same bodies, and the same pairs in the same order.
 * The scene has no method and no wanted results. No shared state. */
#ifndef SCENE_OF_QUERY_H
#define SCENE_OF_QUERY_H

#include "logged_query.h"
#include "scene.h"

/* In: a query that the service accepts, with a geometry for each placement. On output: *out, which
 * the caller clears, with the pairs from first_pair on: all pairs of a PAIRS_ALL query as such,
 * others listed. Body i is placement i, and keeps its id, unless it has none or an earlier
 * placement has the same id: then it gets the lowest free id. Exits with status 1 if memory is
 * exhausted. */
void scene_of_query(const struct logged_query *query, struct scene *out);

/* Whether the engine accepts the frames of this body, so that a scene can contain it. */
bool scene_takes(const struct geometry *geometry);

#endif
