/* One pair alone. It lies in all lanes, of two: an instruction does as much for two doubles as for
 * one, and the set has minima and maxima besides. */
#include "run_lanes.h"

#if defined(RUN_TIMES) || defined(RUN_BOXES)

INLINE void put_first(lanes x, double *out)
{
    memcpy(out, &x, sizeof *out);
}

#endif

INLINE enum slabs_outcome run_one(const struct walk_kind kind, const struct fmb_prepared *a,
                                  const struct fmb_prepared *b, double duration, double *out)
{
    const double *const frame[2][LANES] = {{(const double *) a}, {(const double *) b}};
    struct run_frame of_a, of_b;
    struct walk_pair pair;
    gather(kind, frame[0], &of_a);
    gather(kind, frame[1], &of_b);
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
    return outcome_at(outcomes_of(&pair, &found), 0);
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
