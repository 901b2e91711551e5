/* The oracle: the right answer to any pair of placed bodies, in rational numbers, by a method of
 * its own.
 *
 * It shares fmb.h's types with the engine, and neither code nor idea: a pair of frames is a linear
 * programme in the parameters of both and the time (lp.h), its coefficients rational functions of
 * the pose, where the engine cuts with slabs and clips edges. It is slow and short, and it is what
 * the engine's tests believe.
 *
 * Every finite double is read exactly; flat frames, T = 0, quaternions of any length and subnormals
 * are nothing special to it. A pair is taken to have passed pair_check(). Of a frame only dim,
 * shape, count, radius, origin, component and rest are read, and centre of a box. */
#ifndef ORACLE_H
#define ORACLE_H

#include <gmp.h>
#include <stdbool.h>
#include <stddef.h>

#include "fmb.h"
#include "placed_pair.h"

/* The truth. Unlike the answer of the engine, nothing in it is rounded. */
struct oracle_answer {
    enum fmb_verdict verdict;
    bool has_contact; /* in contact */
    bool has_box;     /* wanted, and in contact */
    /* Frames that have a radius are in contact: its times are roots of quadratics, and ends of its
     * box of worse. The numbers here are unspecified; oracle_agrees() decides without them. */
    bool rounded;
    mpq_t contact[2];
    mpq_t box[2][FMB_DIM_MAX];
};

void oracle_init(struct oracle_answer *truth);
void oracle_clear(struct oracle_answer *truth);

/* On input: a checked pair; FMB_WANT_ values; an initialised answer.
 * On output: the truth; the numbers that it does not have are unspecified. */
void oracle_decide(const struct pair *pair, unsigned want, struct oracle_answer *truth);

/* How close an answer has to be.
 *   DESIGN    intervals and boxes contain the true ones; an end of an interval is at most
 *             1e-12 T beyond the true one, an end of a box at most 1e-12 of the largest
 *             absolute coordinate of any vertex of either body over the window. Where doubles
 *             are too coarse for that, the next double is good enough.
 *   TIGHTEST  each end is the double next to the true one, on its outer side, or the true
 *             one. What fmb.h promises of the exact method.
 * Where frames with a radius meet, both are what rounded.h says. */
enum oracle_limit { ORACLE_DESIGN, ORACLE_TIGHTEST };

/* Whether an answer to the pair is right: verdict, what is there, limits, no end of an interval
 * out of [0,T], an infinite end exactly where the true one is beyond the largest double, no -0,
 * axes beyond dim 0. If not, why says what is wrong, in one line. */
bool oracle_agrees(const struct oracle_answer *truth, const struct pair *pair,
                   const struct fmb_answer *answer, enum oracle_limit limit, char *why,
                   size_t size);

/* oracle_decide and oracle_agrees in one, to ORACLE_DESIGN and to ORACLE_TIGHTEST. */
bool oracle_check(const struct pair *pair, unsigned want, const struct fmb_answer *answer,
                  char *why, size_t size);
bool oracle_check_tightest(const struct pair *pair, unsigned want, const struct fmb_answer *answer,
                           char *why, size_t size);

/* How far the interval and the box of an answer lie from the true ones: for statistics, of answers
 * of any method. */
struct oracle_excess {
    bool has;    /* both the truth, not rounded, and the answer have one; else the rest is 0 */
    bool misses; /* does not contain the true one: some end is too far in, or not a number */
    /* How far out its worst end is, and how far in; 0: none is. Relative to T, of an interval, and
     * to the largest absolute coordinate of any vertex of either body over the window, of a box.
     * Rounded. Infinite where an end is and should not be, or the other way round. */
    double out, in;
};

void oracle_measure(const struct oracle_answer *truth, const struct pair *pair,
                    const struct fmb_answer *answer, struct oracle_excess *contact,
                    struct oracle_excess *box);

#endif
