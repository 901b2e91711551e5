/* Slabs in integers of fixed width: the step between doubles and GMP.
 *
 * A slab that the filter leaves open is computed here, alone, in two's complement integers of 2 to
 * LIMBS_MAX limbs of 64 bits, without an allocation. Nothing rounds. A pair whose numbers need more
 * bits than that is left to the exact method. */
#ifndef FMB_LIMBS_H
#define FMB_LIMBS_H

#include "limbs_turn.h"
#include "slabs.h"

/* An edge in the coordinates of its frame, in those of the other one, and in the world. */
enum limbs_view { LIMBS_OWN, LIMBS_ACROSS, LIMBS_WORLD, LIMBS_VIEWS };

/* Lengths are integers times 2^unit of the span. It contains pointers into itself: do not copy. */
struct limbs_pair {
    const struct fmb_frame *frame[2];
    int limbs; /* of a number */
    /* Of a box the halves of its components, and its centre as the origin. */
    struct limbs_vector component[2][FMB_DIM_MAX], origin[2];
    struct limbs_vector offset, drift; /* of the positions */
    /* By rows; NULL: the identity. From a frame to the world and back, and to the other frame. */
    const struct limbs_vector *to_world[2], *from_world[2], *across[2];
    const struct limbs_factor *norm[2], *all; /* of these matrices; NULL: 1 */
    const struct limbs_factor *common;        /* of equal orientations; else NULL */
    struct limbs_rotation rotation[2], relative;
    /* Edges, set when they are needed. */
    const struct limbs_vector *view[2][SLABS_EDGES][LIMBS_VIEWS];
    struct limbs_vector room[2][SLABS_EDGES][LIMBS_VIEWS];
};

/* Of all lengths that a pair is given by: components, origins, positions, and displacements v T. */
struct dyadic_span limbs_span_of(const struct frame_pair *pair);

/* Whether no operation of slabs.c on this pair rounds; drift_size and sizes as in slabs_pair. */
bool limbs_never_round(const struct slabs_pair *pair, struct dyadic_span span);

/* False if the numbers of the pair, times those of the orientations, span too many bits. */
bool limbs_prepare(const struct frame_pair *pair, struct dyadic_span span, struct limbs_pair *out);

/* The sign of the gap of a slab; -1 where its normal is zero: it says nothing. Edges are in the
 * order of slabs_list(): of a, of b, the drift. */
int limbs_gap_sign(struct limbs_pair *pair, struct slab_normal normal);

/* Of two faces. */
struct limbs_planes {
    bool parallel; /* their planes are */
    bool shared;   /* and they are one plane at all times of the window */
};

struct limbs_planes limbs_planes_of(struct limbs_pair *pair);

/* The numbers of a slab_value, exactly, times a common positive factor. */
void limbs_slab(struct limbs_pair *pair, struct slab_normal normal, mpz_t low, mpz_t high,
                mpz_t start, mpz_t slope);

#endif
