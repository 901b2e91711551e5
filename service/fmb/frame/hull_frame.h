/* Frames of shape FMB_HULL. No shared state. */
#ifndef FMB_HULL_FRAME_H
#define FMB_HULL_FRAME_H

#include "rotation.h"
#include "support.h"

/* Internal fields of a hull in struct fmb_frame:
 *
 *   spanning    dim + 1 vertices, chosen one after the other: each spans the largest volume with
 *               those before it, as computed in doubles. Vertex 0 again: none adds to the volume
 *   bits        all coordinates are multiples of 2^bits[0] below 2^bits[1]
 *   turn_error  how far the vertices are moved by a rotation that rounds */

struct support_vertices hull_frame_vertices(const struct fmb_frame *frame);

/* Computes the box of a placed hull at time 0. Out: [axis], for the axes of its dimension: the box
 * is from lower to lower + size, expanded by the number returned; that is infinite if the numbers
 * are too large. In: all 0. */
double hull_frame_box(const struct fmb_frame *frame, const struct rotation_matrix *rotation,
                      const double position[FMB_DIM_MAX], double lower[FMB_DIM_MAX],
                      double size[FMB_DIM_MAX]);

#endif
