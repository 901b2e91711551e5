/* Weights of few digits for the common point of a proof (programs.h). */
#ifndef FMB_CERTIFICATE_WEIGHTS_H
#define FMB_CERTIFICATE_WEIGHTS_H

#include "programs.h"

enum {
    WEIGHTS_MAX = 2 * PROGRAMS_PROOF_MAX, /* vertices with a weight, of both frames */
    WEIGHTS_ROWS = 2 + FMB_DIM_MAX,
    WEIGHTS_COLUMNS = WEIGHTS_MAX + 2
};

/* A vertex of frame f with its weight. */
struct certificate_weight {
    int f, row; /* row: the equation from which the weight follows; -1: it is stated */
    unsigned vertex;
    mpz_t proven; /* times the total of the proof */
    mpz_t stated; /* times 2^bits */
};

/* Weights in progress. Not to be copied. */
struct certificate_weights {
    const struct programs_proof *proof;
    double duration;
    unsigned count, next;
    bool rounded;   /* a frame has a radius */
    bool unrounded; /* the weights are stated as proven, over the total of the proof */
    int dim, rows, rank;
    unsigned long bits;
    mpq_t time;                                    /* of the point, seconds */
    struct certificate_weight weight[WEIGHTS_MAX]; /* the greatest first */
    mpz_t row[WEIGHTS_ROWS][WEIGHTS_COLUMNS];      /* last two: sum, and the term of the drift */
    mpz_t det, scratch, sum;
};

/* Begins to shorten the weights of a complete proof of a pair that meets.
 * certificate_weights_end() frees what is allocated.
 *
 * In:  proof     must outlive the weights
 *      duration  of the window, seconds */
void certificate_weights_begin(const struct programs_proof *proof, int dim, double duration,
                               struct certificate_weights *out);

/* Performs a step. Returns whether it was the last: bits, time and the stated weights are set. */
bool certificate_weights_step(struct certificate_weights *weights);

void certificate_weights_end(struct certificate_weights *weights);

#endif
