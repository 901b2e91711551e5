/* Converts a query to a scene (scene.h) with the same bodies, and the same pairs in the same order.
 * A scene has no method and no wants. */
#ifndef SCENE_OF_QUERY_H
#define SCENE_OF_QUERY_H

#include "any_query.h"
#include "scene.h"

/* On input: a query that the service accepts, all of whose placements have a geometry. On output:
 * *out, which the caller clears, with the pairs from first_pair on: all pairs of a PAIRS_ALL query
 * as such, others listed. Body i is placement i, and keeps its id, unless it has none or an earlier
 * placement has the same: then it gets the lowest free id. */
void scene_of_query(const struct any_query *query, struct scene *out);

/* Whether a scene can have this body: frames that the engine takes. */
bool scene_takes(const struct geometry *geometry);

#endif
