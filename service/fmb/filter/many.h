/* Kernels of many pairs, LANES of them at a time. The includer defines LANES, KERNEL_NAME and the
 * job (kernel_lanes.h). */
#include "kernel_second.h"

#ifdef KERNEL_TIMES

/* Writes lane i to out[i * stride]. */
INLINE void scatter(lanes x, double *out, int stride)
{
    double at[LANES];
    memcpy(at, &x, sizeof at);
    UNROLL(8)
    for (int lane = 0; lane < LANES; lane++)
        out[lane * stride] = at[lane];
}

#endif

#ifdef KERNEL_SECOND

INLINE void evaluate_lanes(const struct kernel_traits traits, const struct kernel_call *call,
                           size_t first)
{
    struct frame_lanes frame[2];
    struct pair_lanes pair;
    gather_pairs(traits, &call->pairs[first], frame);
    set_pair(traits, &frame[0], &frame[1], call->duration, &pair);
    put_outcomes(second_outcomes(traits, &frame[0], &frame[1], call->duration, &pair),
                 &call->outcomes[first]);
}

#else

INLINE void evaluate_lanes(const struct kernel_traits traits, const struct kernel_call *call,
                           size_t first)
{
    struct frame_lanes frame[2];
    struct pair_lanes pair;
    struct slabs_result result;
    gather_pairs(traits, &call->pairs[first], frame);
    set_pair(traits, &frame[0], &frame[1], call->duration, &pair);
    evaluate_pair(traits, &pair, &result);
    put_outcomes(outcomes_of(&pair, &result), &call->outcomes[first]);
#ifdef KERNEL_TIMES
    lanes times[2];
    times_of(&pair, &result, call->duration, times);
    scatter(times[0], &call->contacts[first][0], 2);
    scatter(times[1], &call->contacts[first][1], 2);
#endif
}

#endif

#define KERNEL_FUNCTION(name, kind)                                 \
    static void name(const struct kernel_call *call)                \
    {                                                               \
        for (size_t first = 0; first < call->count; first += LANES) \
            evaluate_lanes(traits_of(kind), call, first);           \
    }

KERNEL_ALL(KERNEL_FUNCTION, KERNEL_FUNCTION)

kernel_function *const KERNEL_PASTE(kernel, KERNEL_NAME)[KERNEL_KINDS] = KERNEL_TABLE;
