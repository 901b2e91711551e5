/* Bodies of the logs as placements. */
#ifndef PARTS_H
#define PARTS_H

#include "query.h"
#include "question.h"

/* Places the solid as a whole body of one frame. The geometry is valid until PART_BODIES_MAX more
 * bodies are placed. In: a hull has at most 16 vertices. */
enum { PART_BODIES_MAX = 2048 };
void part_place(const struct solid *solid, int64_t body_id, struct query_placement *out);

/* The same place and motion, with the handle in place of the frames. */
void part_by_handle(struct query_placement *placement, const struct handle *handle);

#endif
