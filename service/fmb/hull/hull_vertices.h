/* The vertices of a pair in integers, a few at a time. */
#ifndef FMB_HULL_VERTICES_H
#define FMB_HULL_VERTICES_H

#include "exact.h"
#include "hull.h"

/* Vertices first to first + count[f] - 1 of frame f. */
struct hull_batch {
    struct exact_pair exact; /* its scale is that of all batches; its unit need not be */
    unsigned first[2], count[2];
    bool small[2]; /* not a hull */
};

typedef void hull_batch_visit(void *context, struct hull_batch *batch);

unsigned hull_vertex_count(const struct fmb_frame *frame);

/* Calls visit for a batch, by its number from 0: together they have every vertex of both frames
 * once. Its exact pair also holds the displacements and the drift. Returns whether there is another
 * one. */
bool hull_vertices_visit(const struct frame_pair *frames, unsigned number, hull_batch_visit *visit,
                         void *context);

/* out := vertex first + k of frame f in the world at time 0, times scale, in units. */
void hull_batch_vertex(struct hull_batch *batch, int f, unsigned k, mpz_t out[3]);

#endif
