/* Kernels of many pairs, LANES of them at a time. The includer defines LANES, KERNEL_NAME and the
 * job (kernel_lanes.h). */
#include "kernel_second.h"

INLINE void evaluate_lanes(const struct kernel_traits traits, const struct kernel_call *call,
                           size_t first)
{
    struct frame_lanes frame[2];
    struct pair_lanes pair;
    struct slabs_result result;
    struct outcomes outcomes;
    lanes times[2];
    gather_pairs(traits, &call->pairs[first], frame);
    set_pair(traits, &frame[0], &frame[1], call->duration, &pair);
    if (SECOND) {
        outcomes = second_outcomes(traits, &frame[0], &frame[1], call->duration, &pair);
    } else {
        evaluate_pair(traits, &pair, &result);
        outcomes = outcomes_of(&pair, &result);
    }
    put_outcomes(outcomes, &call->outcomes[first]);
    if (!TIMES)
        return;
    times_of(&pair, &result, call->duration, times);
    put_lanes(times[0], &call->contacts[first][0], 2);
    put_lanes(times[1], &call->contacts[first][1], 2);
}

#define KERNEL_FUNCTION(name, kind)                                 \
    static void name(const struct kernel_call *call)                \
    {                                                               \
        for (size_t first = 0; first < call->count; first += LANES) \
            evaluate_lanes(traits_of(kind), call, first);           \
    }

KERNEL_ALL(KERNEL_FUNCTION, KERNEL_FUNCTION)

kernel_function *const KERNEL_PASTE(kernel, KERNEL_NAME)[KERNEL_KINDS] = KERNEL_TABLE;
