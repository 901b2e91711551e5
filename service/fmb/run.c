/* LANES pairs side by side. */
#include "run_lanes.h"

#ifdef RUN_TIMES

INLINE void put_contacts(const lanes times[2], double (*contacts)[2])
{
    double time[2][LANES];
    memcpy(time, times, sizeof time);
    UNROLL(8)
    for (int lane = 0; lane < LANES; lane++) {
        contacts[lane][0] = time[0][lane];
        contacts[lane][1] = time[1][lane];
    }
}

#endif

INLINE void run_lanes(const struct walk_kind kind, const struct run *run, size_t first)
{
    const double *frame[2][LANES];
    struct walk_pair pair;
    struct walk_found found;
    UNROLL(8)
    for (size_t lane = 0; lane < LANES; lane++) {
        frame[0][lane] = (const double *) run->pairs[first + lane][0];
        frame[1][lane] = (const double *) run->pairs[first + lane][1];
    }
    set_pair(kind, frame[0], frame[1], run->duration, &pair);
    walk_pair_of(kind, &pair, &found);
    const struct outcomes outcomes = outcomes_of(&pair, &found);
    UNROLL(8)
    for (int lane = 0; lane < LANES; lane++)
        run->outcomes[first + (size_t) lane] = (unsigned char) outcome_at(outcomes, lane);
#ifdef RUN_TIMES
    lanes times[2];
    times_of(&pair, &found, run->duration, times);
    put_contacts(times, &run->contacts[first]);
#endif
}

#define RUN_FUNCTION(name, kind)                                        \
    static void name(const struct run *run)                             \
    {                                                                   \
        for (size_t first = 0; first < run->count; first += LANES)      \
            run_lanes(kind, run, first);                                \
    }

RUN_FUNCTIONS(RUN_FUNCTION)

run_function *const RUN_PASTE(run, RUN_NAME)[RUN_KINDS] = RUN_TABLE;
