/* Slabs in integers of fixed width: the step between doubles and GMP.
 *
 * A slab that the filter leaves open is asked again here, alone, in two's complement integers of
 * 1, 2, 4 or 8 limbs of 64 bits for lengths, without an allocation. Nothing rounds. A pair whose
 * numbers need more bits than that is left to the exact method. */
#ifndef FMB_LIMBS_H
#define FMB_LIMBS_H

#include "integer.h"
#include "slabs.h"

#include <stdint.h>

enum { LIMBS_MAX = 8 };

/* A length: an integer times 2^unit / scale of the pair, least significant limb first. Only the
 * first limbs of the pair are used. */
typedef uint64_t limbs_length[LIMBS_MAX];

struct limbs_pair {
    const struct fmb_frame *frame[2];
    bool drifts;
    int limbs;                                           /* of a length: 1, 2, 4 or 8 */
    limbs_length component[2][FMB_DIM_MAX][FMB_DIM_MAX]; /* [frame][component][axis] */
    limbs_length offset[FMB_DIM_MAX], drift[FMB_DIM_MAX];
};

/* Of all lengths that a pair is given by: components, origins, positions, and displacements v T. */
struct dyadic_span limbs_span_of(const struct frame_pair *pair);

/* Whether no operation of slabs.c on this pair rounds; drift_size and sizes as in slabs_pair. */
bool limbs_never_round(const struct slabs_pair *pair, struct dyadic_span span);

/* False if the numbers of the pair, times those of the orientations, span too many bits. */
bool limbs_prepare(const struct frame_pair *pair, struct dyadic_span span, struct limbs_pair *out);

/* The sign of the gap of a slab; -1 where its normal is zero: it says nothing. */
int limbs_gap_sign(const struct limbs_pair *pair, struct slab_normal normal);

/* Of two faces. */
struct limbs_planes {
    bool parallel; /* their planes are */
    bool shared;   /* and they are one plane at all times of the window */
};

struct limbs_planes limbs_planes_of(const struct limbs_pair *pair);

/* The numbers of a slab_value, exactly, times a common power of two. */
void limbs_slab(const struct limbs_pair *pair, struct slab_normal normal, mpz_t low, mpz_t high,
                mpz_t start, mpz_t slope);

#endif
