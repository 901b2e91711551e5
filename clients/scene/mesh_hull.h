/* The vertices of a convex hull. */
#ifndef MESH_HULL_H
#define MESH_HULL_H

#include "fmb.h"

/* Selects vertices of the hull of points: all others are in the hull of these, exactly, and none of
 * these is in the hull of the others.
 *
 * In:  point   [count][axis], count at least 1
 * Out: vertex  [FMB_HULL_VERTICES_MAX][axis], those selected, in the order of the points
 *      *found  their number; 0: there are more
 * Returns FMB_OK, or a status of fmb_frame_make_hull() or fmb_decide().
 * Cost: O(count) decisions of a point and a hull, and O(count * *found). */
enum fmb_status mesh_hull(const double (*point)[3], size_t count, double (*vertex)[3],
                          size_t *found);

#endif
