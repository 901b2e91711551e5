/* Slabs in integers of at most 512 bits, for what doubles leave open.
 *
 * A question about a pair is answered in integers of as many limbs of 64 bits as the numbers of the
 * pair need. Nothing rounds, and nothing is allocated except for times. */
#ifndef FMB_LIMBS_H
#define FMB_LIMBS_H

#include "fmb_batch.h"
#include "integer.h"
#include "pair.h"

struct slab_normal; /* slabs.h, as are these */
struct slabs_pair;

/* The most limbs. A double holds such a number without overflow. */
enum { LIMBS_MAX = 8 };

/* A quaternion: the smallest integers proportional to an orientation, times 2^unit. */
struct limbs_quaternion {
    bool turned; /* R is not the identity; else the rest is 0 */
    int bits;    /* the magnitudes of all integers are below 2^bits */
    long unit;
    struct dyadic at[4]; /* w, x, y, z */
};

/* Converts the orientation of a placement. */
void limbs_quaternion_set(const struct fmb_placement *placement, struct limbs_quaternion *out);

/* The normals that a question needs. */
enum limbs_use {
    LIMBS_SLABS, /* those of slabs_list() */
    LIMBS_FLAT   /* also those in the planes of faces and of flat frames */
};

/* A question about a checked pair. */
struct limbs_question {
    const struct frame_pair *pair;
    struct dyadic_span span; /* of the pair */
    struct limbs_quaternion q[2];
    bool same; /* both are the same rotation */
    int limbs; /* of a number */
};

/* Returns the span of all lengths of a pair: components, origins, positions, and displacements v T.
 */
struct dyadic_span limbs_span_of(const struct frame_pair *pair);

/* Returns whether no operation of slabs.c on this pair rounds. drift_size and sizes: as in
 * slabs_pair. */
bool limbs_never_round(const struct slabs_pair *pair, struct dyadic_span span);

/* Sets a question. *pair must outlive it. */
void limbs_question_set(const struct frame_pair *pair, struct dyadic_span span, enum limbs_use use,
                        struct limbs_question *out);

/* The planes of two faces. SHARED: they are the same plane at all times of the window. */
enum limbs_planes { LIMBS_CROSSING, LIMBS_PARALLEL, LIMBS_SHARED };

/* Whether this question can be answered. */
static inline bool limbs_suffice(const struct limbs_question *question)
{
    return question->limbs <= LIMBS_MAX;
}

/* The functions below answer questions for which limbs_suffice(). Edges are numbered as in
 * slabs.h. */

/* Decides a pair by all its slabs, flat frames included. If contact is not NULL and the pair is in
 * contact, it is set to [first, last], in seconds, rounded outward; GMP then allocates. In: a
 * question set with LIMBS_FLAT. */
enum fmb_verdict limbs_verdict(const struct limbs_question *question, double contact[2]);

/* Returns the largest sign of the gaps of slabs, up to the first that is 1. A slab whose normal is
 * zero has the sign -1. If contact is not NULL, the pair is in contact, and contact is clipped to
 * each slab: its first time to the time at which the offset enters the slab, its last time to the
 * time at which the offset leaves it, in seconds, rounded outward; GMP then allocates. open:
 * [slab][end], whether the slab clips this end (0: first, 1: last); NULL: every slab clips both. */
int limbs_slabs(const struct limbs_question *question, const struct slab_normal *normal,
                const bool open[][2], int count, double contact[2]);

/* The planes of two faces with areas. */
enum limbs_planes limbs_planes(const struct limbs_question *question);

/* Computes the box of two prepared frames in contact, within the limit of fmb.h. Returns false if
 * the coordinates of points, which are rounded to doubles, are not that close. In: a question about
 * the same pair, in the order of kernel_box_kind(), set with LIMBS_FLAT; no frame is flat, except
 * faces with an area. */
bool limbs_box(const struct limbs_question *question, const struct fmb_prepared *const frame[2],
               double box[2][FMB_DIM_MAX]);

#endif
