/* LANES pairs side by side. */
#include "run_box.h"

INLINE void gather_side(const struct kernel_call *run, const struct walk_kind kind, size_t first,
                        int which, struct run_frame *out)
{
    const double *frame[LANES];
    UNROLL(8)
    for (size_t lane = 0; lane < LANES; lane++)
        frame[lane] = (const double *) run->pairs[first + lane][which];
    gather(kind, frame, out);
}

INLINE void gather_pairs(const struct kernel_call *run, const struct walk_kind kind, size_t first,
                         struct run_frame pair[2])
{
    gather_side(run, kind, first, 0, &pair[0]);
    gather_side(run, kind, first, 1, &pair[1]);
}

#if defined(RUN_TIMES) || defined(RUN_BOXES)

/* To every so many doubles. */
INLINE void scatter(lanes x, double *out, int stride)
{
    double at[LANES];
    memcpy(at, &x, sizeof at);
    UNROLL(8)
    for (int lane = 0; lane < LANES; lane++)
        out[lane * stride] = at[lane];
}

#endif

#ifdef RUN_BOXES

INLINE void run_lanes(const struct walk_kind kind, const struct kernel_call *run, size_t first)
{
    struct run_frame frame[2];
    struct walk_pair pair;
    lanes box[2][3];
    gather_pairs(run, kind, first, frame);
    set_pair(kind, &frame[0], &frame[1], run->duration, &pair);
    boxes_of(kind, &pair, frame, run->duration, run->in_contact, box);
    UNROLL(2)
    for (int end = 0; end < 2; end++)
        UNROLL(3)
    for (int axis = 0; axis < 3; axis++)
        scatter(box[end][axis], &run->boxes[first][end][axis], 6);
}

#elif defined(RUN_EXACT)

INLINE void run_lanes(const struct walk_kind kind, const struct kernel_call *run, size_t first)
{
    struct run_frame frame[2];
    struct walk_pair pair;
    gather_pairs(run, kind, first, frame);
    set_pair(kind, &frame[0], &frame[1], run->duration, &pair);
    put_outcomes(exact_outcomes(kind, &frame[0], &frame[1], run->duration, &pair),
                 &run->outcomes[first]);
}

#else

INLINE void run_lanes(const struct walk_kind kind, const struct kernel_call *run, size_t first)
{
    struct run_frame frame[2];
    struct walk_pair pair;
    struct walk_found found;
    gather_pairs(run, kind, first, frame);
    set_pair(kind, &frame[0], &frame[1], run->duration, &pair);
    walk_pair_of(kind, &pair, &found);
    put_outcomes(outcomes_of(&pair, &found), &run->outcomes[first]);
#ifdef RUN_TIMES
    lanes times[2];
    times_of(&pair, &found, run->duration, times);
    scatter(times[0], &run->contacts[first][0], 2);
    scatter(times[1], &run->contacts[first][1], 2);
#endif
}

#endif

#define RUN_FUNCTION(name, kind)                                   \
    static void name(const struct kernel_call *run)                \
    {                                                              \
        for (size_t first = 0; first < run->count; first += LANES) \
            run_lanes(kind, run, first);                           \
    }

RUN_FUNCTIONS(RUN_FUNCTION)

run_function *const RUN_PASTE(run, RUN_NAME)[RUN_KINDS] = RUN_TABLE;
