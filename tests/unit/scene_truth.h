/* Scenes for tests, and what the answers must be: pair by pair, by fmb_decide(). */
#ifndef SCENE_TRUTH_H
#define SCENE_TRUTH_H

#include "answer.h"
#include "draw.h"
#include "question.h"

/* Most bytes of the geometry of a solid. */
enum { SCENE_GEOMETRY_MAX = SOLID_FRAMES_MAX * GEOMETRY_FRAME_BYTES_MAX };

/* A query, and the geometries of the placements that come whole. */
struct scene {
    struct scene_query query;
    unsigned char geometry[QUERY_PLACEMENTS_MAX][SCENE_GEOMETRY_MAX];
};

/* A placement that comes whole, its geometry in bytes: GEOMETRY_FRAME_BYTES_MAX for each frame.
 * body_id 0: anonymous. */
void scene_set_placement(const struct solid *solid, int64_t body_id, unsigned char *bytes,
                         struct query_placement *out);

/* Placement i of the scene. */
void scene_set(struct scene *scene, int32_t i, const struct solid *solid, int64_t body_id);

/* Number k of the geometry of a placement of one frame that comes whole. */
void scene_put_number(struct scene *scene, int32_t i, int k, double value);

/* The handle in place of the frames. */
void scene_name(struct query_placement *placement, const struct handle *handle);

/* Bodies of hard pairs (pair_draw.h), all of this dimension: 2 i and 2 i + 1 are of one. Some are
 * turned or have several frames. Anonymous; the remainder of the query is unchanged. moving: -1
 * some, 0 none, 1 only such pairs. */
void scene_draw_placements(struct draw *draw, int dim, int moving, int32_t count,
                           struct scene *out);

/* Any pairs of two different placements of the query, half of them 2 i and 2 i + 1. */
void scene_draw_pairs(struct draw *draw, int32_t count, struct scene_query *out);

/* All pairs of a query, ignored ones included, in their order. Returns the count; *out is valid
 * until the next call. */
int32_t scene_list(const struct scene_query *query, const unsigned (**out)[2]);

/* The truth of a pair of placements that come whole. */
enum fmb_status scene_decide(const struct scene_query *query, const unsigned pair[2],
                             struct fmb_answer *answer);

/* Begins with the query as a message; it must fit. */
void scene_begin(struct answer_job *job, const struct scene_query *query);

/* The result of a query that is not interrupted. */
void scene_answer(struct answer_job *job, struct answerer *answerer,
                  const struct scene_query *query, struct scene_result *out);

/* Fails the running test where the result is not, to the bit, the answer to the pairs from
 * first_pair to end_pair. whole: the query with every placement whole. */
void scene_assert(const struct scene_query *whole, const struct scene_result *result);

#endif
