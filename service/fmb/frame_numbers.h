/* Makes a frame of its shape, numbers and radius, whatever the shape.
 *
 * Inline: other folders use it, and libfmb shows the names of fmb.h only. */
#ifndef FMB_FRAME_NUMBERS_H
#define FMB_FRAME_NUMBERS_H

#include "fmb.h"

/* In:  numbers  of fmb_frame_make(); if by_vertices, of fmb_frame_make_vertices(); of a hull, of
 *               fmb_frame_make_hull()
 *      *memory  of hulls: has space for fmb_hull_doubles() of this one; otherwise not used
 * Out: *memory  after the memory of a hull that was made
 * Returns the status of these functions, or of fmb_frame_inflate(). */
static inline enum fmb_status frame_of_numbers(int dim, int shape, bool by_vertices, double radius,
                                               const double *numbers, size_t count, double **memory,
                                               struct fmb_frame *out)
{
    const enum fmb_status status =
        shape == FMB_HULL ? fmb_frame_make_hull(dim, numbers, count, *memory, out)
        : by_vertices     ? fmb_frame_make_vertices(dim, shape, numbers, count, out)
                          : fmb_frame_make(dim, shape, numbers, count, out);
    if (status == FMB_OK && shape == FMB_HULL)
        *memory += fmb_hull_doubles(dim, count / (size_t) dim);
    return status == FMB_OK && radius != 0 ? fmb_frame_inflate(out, radius) : status;
}

#endif
