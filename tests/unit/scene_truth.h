/* Scenes for tests, and what must be answered to them: pair by pair, by fmb_decide(). */
#ifndef SCENE_TRUTH_H
#define SCENE_TRUTH_H

#include "draw.h"
#include "query.h"
#include "question.h"

/* A frame of a query that comes whole. body_id 0: anonymous. */
void scene_set_frame(const struct solid *solid, int64_t body_id, struct query_frame *out);

/* Frames of hard pairs (pair_draw.h), all of this dimension: 2 i and 2 i + 1 are of one. Anonymous;
 * the rest of the query is left alone. moving: -1 some, 0 none, 1 such pairs alone. */
void scene_draw_frames(struct draw *draw, int dim, int moving, int32_t count,
                       struct scene_query *out);

/* Any pairs of two different frames of the query, half of them of frames 2 i and 2 i + 1. */
void scene_draw_pairs(struct draw *draw, int32_t count, struct scene_query *out);

/* All pairs that a query asks for, in their order. Returns the count; *out is good until the next
 * call. */
int32_t scene_list(const struct scene_query *query, const unsigned (**out)[2]);

/* The truth of a pair of frames that came whole. */
enum fmb_status scene_decide(const struct scene_query *query, const unsigned pair[2],
                             struct fmb_answer *answer);

/* Fails the running test where the result is not, to the bit, the answer to the pairs from
 * first_pair to end_pair. whole: the query with every frame whole. */
void scene_assert(const struct scene_query *whole, const struct scene_result *result);

#endif
