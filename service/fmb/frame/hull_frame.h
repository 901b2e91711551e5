/* Frames of shape FMB_HULL. No shared state. */
#ifndef FMB_HULL_FRAME_H
#define FMB_HULL_FRAME_H

#include "support.h"

/* Internal fields of a hull in struct fmb_frame. frame_set_bounds() sets the others, which describe
 * the cuboid that contains the hull.
 *
 *   spanning    dim + 1 vertices, chosen one after the other: each spans the largest volume with
 *               those before it, as computed in doubles. Vertex 0 again: none adds to the volume
 *   bits        all coordinates of vertices, and all components, are multiples of 2^bits[0]; the
 *               coordinates are below 2^bits[1] */

struct support_vertices hull_frame_vertices(const struct fmb_frame *frame);

#endif
