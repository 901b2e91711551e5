/* Pairs of bodies at a chosen gap, for the races of gaps. */
#ifndef GAP_PAIRS_H
#define GAP_PAIRS_H

#include "bench_scene.h"

struct gap_pairs {
    size_t count;             /* pair i is body i and body count + i */
    struct scene scene;       /* the bodies, at rest */
    unsigned (*pair)[2];      /* [count] */
    struct peer_solid *solid; /* [2 count] */
    double *size;             /* [count]: the largest distance of two vertices of one body */
};

/* Random bodies of two shapes in 3D, boxes with random orientations, shifted until both bounds of
 * the gap are within 1 % of target, which is not 0. Pairs that do not reach it are drawn again. */
void gap_pairs_draw(const struct cell *cell, double target, size_t count, uint64_t seed,
                    struct gap_pairs *out);
void gap_pairs_free(struct gap_pairs *pairs);

#endif
