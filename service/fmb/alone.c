/* One pair alone. It lies in both of two lanes: an instruction does as much for two doubles as for
 * one, and the set has minima and maxima besides. Two frames of the same shape in 2D lie in the
 * second lane the other way round, so that half of the walk does for all of it. */
#include "run_lanes.h"

INLINE bool is_mirrored(const struct walk_kind kind)
{
    return LANES == 2 && !kind.ordered && kind.dim == 2 && kind.simplex[0] == kind.simplex[1];
}

INLINE lanes exchanged(lanes x)
{
#if LANES == 1
    return x;
#else
    return __builtin_shufflevector(x, x, 1, 0);
#endif
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

INLINE void gather_mirrored(const struct walk_kind kind, const struct fmb_prepared *a,
                            const struct fmb_prepared *b, struct run_frame *of_a,
                            struct run_frame *of_b)
{
    const double *x = (const double *) a, *y = (const double *) b;
    lanes words[2][WORDS];
    UNROLL(16)
    for (int w = 0; w < word_count(kind); w++) {
        words[0][w] = side_by_side(x[w], y[w]);
        words[1][w] = exchanged(words[0][w]);
    }
    set_run_frame(kind, words[0], of_a);
    set_run_frame(kind, words[1], of_b);
    if (!kind.drifts)
        return;
    UNROLL(2)
    for (int axis = 0; axis < 2; axis++) {
        of_a->velocity[axis] = side_by_side(prepared_velocity(a)[axis], prepared_velocity(b)[axis]);
        of_b->velocity[axis] = exchanged(of_a->velocity[axis]);
    }
}

INLINE void gather_both(const struct walk_kind kind, const struct fmb_prepared *a,
                        const struct fmb_prepared *b, struct run_frame *of_a,
                        struct run_frame *of_b)
{
    const double *const frame[2][LANES] = {{(const double *) a}, {(const double *) b}};
    gather(kind, frame[0], of_a);
    gather(kind, frame[1], of_b);
}

#if defined(RUN_TIMES) || defined(RUN_BOXES)

INLINE void put_first(lanes x, double *out)
{
    memcpy(out, &x, sizeof *out);
}

#endif

#ifndef RUN_BOXES

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
    struct run_frame of_a, of_b;
    struct walk_pair pair;
    kind.mirrored = is_mirrored(kind);
    if (kind.mirrored)
        gather_mirrored(kind, a, b, &of_a, &of_b);
    else
        gather_both(kind, a, b, &of_a, &of_b);
    set_pair(kind, &of_a, &of_b, duration, &pair);
#ifdef RUN_BOXES
    lanes box[2][3];
    boxes_of(kind, &pair, &of_a, &of_b, box);
    for (int i = 0; i < 6; i++)
        put_first(box[i / 3][i % 3], &out[i]);
    return SLABS_UNSURE;
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

run_alone_function *const RUN_PASTE(run, RUN_NAME)[RUN_KINDS] = RUN_TABLE;
