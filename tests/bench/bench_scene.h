/* Bodies, and pairs of them: distinct ones, so that no branch is predicted from
 * heart. */
#ifndef BENCH_SCENE_H
#define BENCH_SCENE_H

#include <stddef.h>
#include <stdint.h>

#include "cell.h"
#include "fmb_batch.h"
#include "lean_sat.h"
#include "oriented.h"
#include "peers.h"
#include "question.h"

struct scene {
    size_t count;
    struct fmb_prepared *prepared;   /* [count], each in two cache lines */
    struct fmb_placement *placement; /* [count] */
    struct fmb_body *body;           /* the placements' */
    struct lean_frame *lean;         /* [count], placed; faces are no cuboids or tetrahedra */
    struct oriented *oriented;       /* [count], only boxes in 3D */
};

struct pairs {
    size_t count;
    unsigned (*at)[2]; /* [count][a, b], indices of bodies */
};

/* All end the program if there is no memory. */
void *scene_allocate(size_t count, size_t size);

/* Bodies with the article's distribution: the first half of them of A's shape, the rest of B's. */
struct scene scene_draw(const struct cell *cell, size_t bodies, uint64_t seed);
/* The same with random poses, of any shapes; and its frames given by world coordinates, rounded:
 * boxes as cuboids. */
struct scene scene_draw_posed(const struct cell *cell, size_t bodies, uint64_t seed);
struct scene scene_of_corners(const struct scene *posed);
/* Those of the questions: all a, then all b; one frame each. */
struct scene scene_of_questions(const struct question *questions, size_t count);
/* Memory for `count` bodies, not set. */
struct scene scene_empty(size_t count);
/* Its bodies of one frame as other libraries are given them: [count], to be freed. No faces. */
struct peer_solid *scene_solids(const struct scene *scene);
void scene_free(struct scene *scene);

/* One of the first half, and one of the rest; anything. */
struct pairs pairs_draw(const struct scene *scene, size_t count, uint64_t seed);
/* The same, such as are in contact, or such as are not; sorted out by the certified method. */
struct pairs pairs_draw_of(const struct scene *scene, bool in_contact, size_t count, uint64_t seed);
/* Pair i is body i and body count + i. As many other pairs of these bodies follow, for warming up.
 */
struct pairs pairs_side_by_side(size_t count);
struct pairs pairs_copy(const struct pairs *pairs);
void pairs_free(struct pairs *pairs);

#endif
