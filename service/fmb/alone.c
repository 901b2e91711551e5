/* One pair alone. It lies in all lanes, of two: an instruction does as much for two doubles as for
 * one, and the set has minima and maxima besides. */
#include "run_lanes.h"

INLINE enum slabs_outcome run_one(const struct walk_kind kind, const struct fmb_prepared *a,
                                  const struct fmb_prepared *b, double duration, double contact[2])
{
    const double *const frame_a[LANES] = {(const double *) a};
    const double *const frame_b[LANES] = {(const double *) b};
    struct walk_pair pair;
    struct walk_found found;
    set_pair(kind, frame_a, frame_b, duration, &pair);
    walk_pair_of(kind, &pair, &found);
#ifdef RUN_TIMES
    lanes times[2];
    times_of(&pair, &found, duration, times);
    memcpy(&contact[0], &times[0], sizeof *contact);
    memcpy(&contact[1], &times[1], sizeof *contact);
#else
    (void) contact;
#endif
    return outcome_at(outcomes_of(&pair, &found), 0);
}

#define RUN_FUNCTION(name, kind)                                                                 \
    static enum slabs_outcome name(const struct fmb_prepared *a, const struct fmb_prepared *b,   \
                                   double duration, double contact[2])                           \
    {                                                                                            \
        return run_one(kind, a, b, duration, contact);                                           \
    }

RUN_FUNCTIONS(RUN_FUNCTION)

run_alone_function *const RUN_PASTE(run, RUN_NAME)[RUN_KINDS] = RUN_TABLE;
