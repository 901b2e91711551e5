/* The gaps of pairs of frames, compiled with `double` as a number that carries a bound on its
 * error. */
#define INLINED_NOT
#undef __SSE2__ /* vectors are structs here */

#include "checked_gaps.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "number.hpp"

typedef number number_in_place_of_double; /* no variable has this name */
#define double number_in_place_of_double
#define _Static_assert static_assert

#include "gap.c"
#include "gap_axis_aligned.c"
#include "gap_bounds.c"
#include "gap_depth.c"
#include "gap_distance.c"

#undef double

/* Not reached. */
void gap_exact(const struct frame_pair *, enum fmb_verdict, struct fmb_gap *)
{
}

static void set_frame(const struct checked_frame *from, struct fmb_frame *frame,
                      struct fmb_placement *placement, struct fmb_prepared *out)
{
    memset(frame, 0, sizeof *frame);
    memset(placement, 0, sizeof *placement);
    for (int i = 0; i < 3; i++) {
        placement->position[i] = from->position[i];
        placement->velocity[i] = from->velocity[i];
    }
    out->summary = from->summary;
    for (int i = 0; i < 13; i++)
        out->number[i] = from->number[i];
    out->frame = frame;
    out->placement = placement;
}

void check_gap(const struct checked_frame from[2], double duration)
{
    struct fmb_frame frame[2];
    struct fmb_placement placement[2];
    struct fmb_prepared prepared[2];
    struct gap_pair pair;
    struct fmb_gap gap;
    for (int f = 0; f < 2; f++)
        set_frame(&from[f], &frame[f], &placement[f], &prepared[f]);
    memset(&gap, 0, sizeof gap);
    if (gap_pair_set(&prepared[0], &prepared[1], duration, &pair)) {
        gap_distance(&pair, INFINITY, &gap);
        gap_depth(&pair, FMB_OVERLAPPING, &gap);
    }
    arena_clear();
}
