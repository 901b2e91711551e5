/* What boxes.c and the boxes in fixed-width integers have in common: pairs of prepared frames in
 * lanes. */
#ifndef FMB_KERNEL_BOX_H
#define FMB_KERNEL_BOX_H

#include "box_clip.h"
#include "kernel_exact.h"

/* The kind as traits of a pair. KERNEL_DRIFTS: a frame moves. */
INLINE struct kernel_traits traits_of(enum kernel_kind kind)
{
    const bool face = kind & KERNEL_FACE, same = kind & KERNEL_SAME_SHAPE,
               tetrahedron = kind & KERNEL_TETRAHEDRON;
    return (struct kernel_traits){.dim = kind & KERNEL_3D ? 3 : 2,
                                  .simplex = {same || (face && tetrahedron), tetrahedron || face},
                                  .face = {face && same, face},
                                  .drifts = kind & KERNEL_DRIFTS,
                                  .box = true};
}

INLINE void gather_pairs(const struct fmb_prepared *const pairs[][2],
                         const struct kernel_traits traits, struct frame_lanes pair[2])
{
    for (int which = 0; which < 2; which++) {
        const double *frame[LANES];
        for (size_t lane = 0; lane < LANES; lane++)
            frame[lane] = (const double *) pairs[lane][which];
        gather(traits, frame, &pair[which]);
    }
}

INLINE void set_places(const struct kernel_traits traits, const struct frame_lanes frame[2],
                       double duration, struct pair_lanes *pair, struct box_places *out)
{
    set_pair(traits, &frame[0], &frame[1], duration, pair);
    out->duration = duration;
    out->exact = nothing_rounds(traits, &frame[0], &frame[1], duration, pair);
    for (int which = 0; which < 2; which++) {
        out->summary[which] = frame[which].summary;
        out->error[which] = frame[which].error;
        memcpy(out->origin[which], frame[which].origin, sizeof out->origin[which]);
        if (traits.drifts)
            memcpy(out->velocity[which], frame[which].velocity, sizeof out->velocity[which]);
    }
}

#endif
