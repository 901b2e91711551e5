/* Linear programs over the vertices of two frames, in integers, and the point of D nearest to the
 * origin. Other comments call these, and the search for the gap in integers (support_gap.h), "the
 * programs".
 *
 * The state of a decision is advanced in steps, so that a caller can look after other work in
 * between. Each step prices once: it finds the vertex of D that is farthest in one direction,
 * exactly.
 *
 *     struct programs *programs = programs_begin(pair, want, first, count);
 *     while (!programs_step(programs))
 *         ...
 *     programs_end(programs, answer);
 *
 * No shared state. */
#ifndef FMB_PROGRAMS_H
#define FMB_PROGRAMS_H

#include "support_integers.h"
#include "support_pair.h"

struct programs;

/* What proves a verdict. D: support_pair.h. The members are documented for frames without radii. Of
 * frames with radii, R their sum, the weights give the point x of D nearest to the origin instead
 * of the origin itself, and normal is a multiple of x: normal . y > |normal| R for all y of D if
 * the frames are SEPARATED, >= if they are TOUCHING. */
enum { PROGRAMS_PROOF_MAX = 2 * (FMB_DIM_MAX + 1) + FMB_DIM_MAX };

struct programs_proof {
    enum fmb_verdict verdict;
    struct support_integers *integers; /* of the pair */
    unsigned count;
    struct support_column column[PROGRAMS_PROOF_MAX]; /* the points that have weights */
    /* SEPARATED: normal . x > 0 for all x of D. TOUCHING: normal . x >= 0, and normal . x is not
     * constant on both frames. */
    mpz_t normal[3];
    /* Not SEPARATED: the sum of weight / total times points of D is the origin. Weights are at
     * least 0, and their sum is total. OVERLAPPING: the vertices of positive weights span both
     * frames. */
    mpz_t weight[PROGRAMS_PROOF_MAX], total;
};

/* Begins a decision. It allocates through GMP; programs_end() frees all of it.
 *
 * In:  pair    set; must outlive the decision
 *      want    FMB_WANT_BOX, FMB_WANT_TIMES, or 0 for the verdict alone; or FMB_WANT_CERTIFICATE
 *              alone for the verdict and its proof
 *      first   [count], count at most 4: points of D near which the origin is expected, such as the
 *              last simplex of a search in doubles. They save steps, and change no answer */
struct programs *programs_begin(const struct support_pair *pair, unsigned want,
                                const struct support_column *first, unsigned count);

/* Begins a decision by the point of D nearest to the origin, in the same kind of steps. It gives no
 * contact and no box; its verdict is that of the pair if a frame has a radius.
 *
 * In:  pair  set; must outlive the decision
 *      late  D is restricted to the end of the window
 *      first [count], count at most 4: points of D, or of D at the end of the window, in whose hull
 *            the nearest point is expected */
struct programs *programs_begin_nearest(const struct support_pair *pair, bool late,
                                        const struct support_column *first, unsigned count);

/* Performs one step. Returns whether the decision is complete. */
bool programs_step(struct programs *programs);

/* Returns the proof, valid until programs_end(). It is set once the decision is complete; its
 * member integers is set from the beginning. */
struct programs_proof *programs_proof(struct programs *programs);

/* Sets the time of the nearest point of a complete decision by it, in seconds, rounded down and up.
 */
void programs_nearest_time(struct programs *programs, double time[2]);

/* Sets point, as fmb_answer.point, of a complete decision by the nearest point, of frames in
 * contact: the exact time and coordinates, each rounded down. */
void programs_nearest_point(struct programs *programs, double point[1 + FMB_DIM_MAX]);

/* Sets the answer of a complete decision: the verdict, and if the frames meet, the contact and the
 * box that are wanted, with ends rounded outward; the rest is unchanged. Ends the decision,
 * complete or not; answer may be NULL. */
void programs_end(struct programs *programs, struct fmb_answer *answer);

#endif
