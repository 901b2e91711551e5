/* Numbers drawn from a seed: the same on every machine, for ever. */
#ifndef DRAW_H
#define DRAW_H

#include <stdbool.h>
#include <stdint.h>

struct draw {
    uint64_t state;
};

/* Starts from FMB_SEED of the environment, or from a fixed seed, and prints which, so that a
 * failure can be had again: FMB_SEED=... and the name of the test. */
void draw_begin(struct draw *draw, const char *what);

/* How many to draw: usual; an eighth of it where FMB_FAST is set in the environment (and not
 * 0); FMB_SAMPLE times as many where that is set. At least 1. */
long draw_sample(long usual);

/* Returns the step through a list of cases: `fast` if FMB_FAST is set, otherwise 1. */
int draw_step(int fast);

uint64_t draw_bits(struct draw *draw);
bool draw_coin(struct draw *draw);
int draw_int(struct draw *draw, int least, int most); /* both included */
/* A vector of them. */
void draw_integers(struct draw *draw, int dim, int least, int most, double *vector);
double draw_uniform(struct draw *draw, double least, double most);
double draw_log(struct draw *draw, int least, int most); /* +-[1,2) 2^e, e from least to most */
double draw_finite(struct draw *draw); /* any finite double, each pattern as likely */

#endif
