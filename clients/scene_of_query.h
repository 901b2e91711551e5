/* A query as the scene that people write (scene.h): the same bodies, and the same pairs in the same
 * order and orientation. What a scene does not say, method and wants, is lost. */
#ifndef SCENE_OF_QUERY_H
#define SCENE_OF_QUERY_H

#include "any_query.h"
#include "scene.h"

/* On input: a query that the service takes, all of whose frames have components. Of pairs those
 * from first_pair on are there: all of all frames as such, others listed. On output: *out, to be
 * cleared by the caller; body i is frame i. A frame keeps its body id, unless it has none or one
 * before it has the same: then it gets the lowest that is free. */
void scene_of_query(const struct any_query *query, struct scene *out);

#endif
