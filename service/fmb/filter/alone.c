/* One pair alone. It lies in both of two lanes: an instruction does as much for two doubles as for
 * one, and the set has minima and maxima besides. Two frames of the same shape lie in the second
 * lane the other way round, so that half of the walk does for all of it. */
#include "run_exact.h"

/* Times promise the bits of a batch, which is not mirrored. */
INLINE bool is_mirrored(const struct walk_kind kind)
{
    return LANES == 2 && !kind.ordered && !kind.exact && kind.simplex[0] == kind.simplex[1] &&
           kind.face[0] == kind.face[1];
}

INLINE lanes side_by_side(double x, double y)
{
#if LANES == 1
    (void) y;
    return x;
#else
    return (lanes){x, y};
#endif
}

INLINE const double *velocity_of(const struct walk_kind kind, const struct fmb_prepared *frame)
{
    return kind.dim == 3 ? frame->placement->velocity
                         : (const double *) frame + PREPARED_VELOCITY_2D;
}

INLINE void gather_mirrored(const struct walk_kind kind, const struct fmb_prepared *a,
                            const struct fmb_prepared *b, struct run_frame *of_a,
                            struct run_frame *of_b)
{
    const double *x = (const double *) a, *y = (const double *) b;
    lanes words[2][WORDS];
    UNROLL(16)
    for (int w = 0; w < word_count(kind); w++) {
        words[0][w] = side_by_side(x[w], y[w]);
        words[1][w] = lanes_swap(words[0][w]);
    }
    set_run_frame(kind, words[0], of_a);
    set_run_frame(kind, words[1], of_b);
    if (!kind.drifts)
        return;
    UNROLL(3)
    for (int axis = 0; axis < kind.dim; axis++) {
        of_a->velocity[axis] = side_by_side(velocity_of(kind, a)[axis], velocity_of(kind, b)[axis]);
        of_b->velocity[axis] = lanes_swap(of_a->velocity[axis]);
    }
}

/* The compiler must not see that the lanes are equal: gcc would then compute in scalars, and copy
 * each of them into a vector where a minimum or a maximum follows. */
INLINE lanes in_all_lanes(double x)
{
    lanes out = side_by_side(x, x);
#if LANES == 2
    __asm__("" : "+x"(out));
#endif
    return out;
}

INLINE void gather_frame(const struct walk_kind kind, const struct fmb_prepared *frame,
                         struct run_frame *out)
{
    lanes words[WORDS];
    UNROLL(16)
    for (int w = 0; w < word_count(kind); w++)
        words[w] = in_all_lanes(((const double *) frame)[w]);
    set_run_frame(kind, words, out);
    if (!kind.drifts)
        return;
    UNROLL(3)
    for (int axis = 0; axis < kind.dim; axis++)
        out->velocity[axis] = in_all_lanes(velocity_of(kind, frame)[axis]);
}

#ifdef RUN_TIMES

INLINE void put_first(lanes x, double *out)
{
    memcpy(out, &x, sizeof *out);
}

#endif

#ifndef RUN_EXACT

/* From lanes that hold the same, or, mirrored, each half of what there is to know. */
INLINE enum slabs_outcome outcome_of(const struct walk_kind kind, struct outcomes outcomes)
{
    if (!kind.mirrored)
        return outcome_at(outcomes, 0);
    return outcomes.separated          ? SLABS_SEPARATED
           : outcomes.overlapping == 3 ? SLABS_OVERLAPPING
                                       : SLABS_UNSURE;
}

#endif

INLINE enum slabs_outcome run_one(struct walk_kind kind, const struct fmb_prepared *a,
                                  const struct fmb_prepared *b, double duration, double *out)
{
    struct run_frame frame[2];
    struct walk_pair pair;
    kind.mirrored = is_mirrored(kind);
    if (kind.mirrored) {
        gather_mirrored(kind, a, b, &frame[0], &frame[1]);
    } else {
        gather_frame(kind, a, &frame[0]);
        gather_frame(kind, b, &frame[1]);
    }
    set_pair(kind, &frame[0], &frame[1], duration, &pair);
#ifdef RUN_EXACT
    (void) out;
    return outcome_at(exact_outcomes(kind, &frame[0], &frame[1], duration, &pair), 0);
#else
    struct walk_found found;
    walk_pair_of(kind, &pair, &found);
#ifdef RUN_TIMES
    lanes times[2];
    times_of(&pair, &found, duration, times);
    put_first(times[0], &out[0]);
    put_first(times[1], &out[1]);
#else
    (void) out;
#endif
    return outcome_of(kind, outcomes_of(&pair, &found));
#endif
}

#define RUN_FUNCTION(name, kind)                                                               \
    static enum slabs_outcome name(const struct fmb_prepared *a, const struct fmb_prepared *b, \
                                   double duration, double *out)                               \
    {                                                                                          \
        return run_one(kind, a, b, duration, out);                                             \
    }

RUN_FUNCTIONS(RUN_FUNCTION)

run_single_function *const RUN_PASTE(run, RUN_NAME)[RUN_KINDS] = RUN_TABLE;
