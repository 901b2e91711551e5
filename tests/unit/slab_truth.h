/* The slabs of a pair in integers, a second implementation of the definition in slabs.h. Slabs in
 * doubles and in limbs are compared with these. */
#ifndef SLAB_TRUTH_H
#define SLAB_TRUTH_H

#include <gmp.h>
#include <stdbool.h>

#include "placed_pair.h"
#include "prepared.h"
#include "slabs.h"

struct slab_truth {
    int dim;
    enum fmb_shape shape[2];
    mpz_t component[2][FMB_DIM_MAX][FMB_DIM_MAX]; /* [frame][component][axis] */
    mpz_t offset[FMB_DIM_MAX], drift[FMB_DIM_MAX];
    mpz_t shift[FMB_DIM_MAX]; /* what the reference points add to the offset (slabs_evaluate.h) */
    long unit; /* all of the above are times 2^-unit; what follows is times 2^(-dim unit) */
    mpz_t low, high, start, slope, gap;
    /* As struct slab_value has them, but in the lengths of the pair: those times 2^factor are the
     * slab's. low and high of A - B with the reference points at 0. */
    mpz_t seen_low, seen_high, middle, swing;
    int factor;
    mpz_t side[2], rise[2]; /* start - low and high - start, and what tau adds to them */
    bool zero;              /* the normal is */
    mpz_t normal[FMB_DIM_MAX], edge[2][FMB_DIM_MAX], scratch[2];
};

void slab_truth_init(struct slab_truth *truth);
void slab_truth_clear(struct slab_truth *truth);

/* slabs_prepare() of a checked pair. */
bool slab_truth_prepare(const struct pair *pair, struct slabs_pair *out);

/* On input: a checked pair of cuboids, tetrahedra and faces that are not turned. The origin of each
 * frame is the origin of its body. */
void slab_truth_set(struct slab_truth *truth, const struct pair *pair);

/* On output: low to zero, of this slab of the pair that is set. */
void slab_truth_compute(struct slab_truth *truth, struct slab_normal normal);

/* Returns the largest |value - exact| / bound, 0 if the value is exact, of all numbers of a slab,
 * its gap, and the inequalities made from it. Computes the exact slab of the same normal. */
double slab_truth_worst(struct slab_truth *truth, const struct slab_value *slab);

#endif
