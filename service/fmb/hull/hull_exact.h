/* Linear programs over the vertices of two frames, in integers: with the exact search for the gap
 * (hull_gap.h), the "programs" of other comments.
 *
 * The state of a decision is advanced in steps, so that a caller can look after other work in
 * between. Each step prices once: it finds the vertex of D that is farthest in one exact direction.
 *
 *     struct hull_exact *exact = hull_exact_begin(pair, want, first, count);
 *     while (!hull_exact_step(exact))
 *         ...
 *     hull_exact_end(exact, answer);
 *
 * No shared state. */
#ifndef FMB_HULL_EXACT_H
#define FMB_HULL_EXACT_H

#include "hull.h"
#include "hull_vertices.h"

struct hull_exact;

/* What proves a verdict. D: hull.h. */
enum { HULL_PROOF_MAX = 2 * (FMB_DIM_MAX + 1) + FMB_DIM_MAX };

struct hull_proof {
    enum fmb_verdict verdict;
    /* SEPARATED: normal . x > 0 for all x of D. TOUCHING: normal . x >= 0, and normal . x is not
     * constant on both frames. */
    mpz_t normal[3];
    /* Not SEPARATED: the sum of weight / total times points of D is the origin. Weights are at
     * least 0, and their sum is total. OVERLAPPING: the vertices of positive weights span both
     * frames. */
    unsigned count;
    struct hull_column column[HULL_PROOF_MAX];
    mpz_t weight[HULL_PROOF_MAX], total;
    struct hull_integers *integers; /* of the pair */
};

/* Begins a decision. It allocates through GMP; hull_exact_end() frees all of it.
 *
 * In:  pair    set; must outlive the decision
 *      want    FMB_WANT_BOX, FMB_WANT_TIMES, or 0 for the verdict alone; or FMB_WANT_CERTIFICATE
 *              alone for the verdict and its proof
 *      first   [count], count at most 4: points of D near which the origin is expected, such as the
 *              last simplex of a search in doubles. They save steps, and change no answer */
struct hull_exact *hull_exact_begin(const struct hull_pair *pair, unsigned want,
                                    const struct hull_column *first, unsigned count);

/* Performs one step. Returns whether the decision is complete. */
bool hull_exact_step(struct hull_exact *exact);

/* Returns the proof, valid until hull_exact_end(). It is set once the decision is complete; its
 * member integers is set from the beginning. */
struct hull_proof *hull_exact_proof(struct hull_exact *exact);

/* Sets the answer of a complete decision: the verdict, and if the frames meet, the contact and the
 * box that are wanted, with ends rounded outward; the rest is unchanged. Ends the decision,
 * complete or not; answer may be NULL. */
void hull_exact_end(struct hull_exact *exact, struct fmb_answer *answer);

#endif
