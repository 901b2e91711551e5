/* The vertices of the convex hull of a mesh. */
#ifndef MESH_HULL_H
#define MESH_HULL_H

#include "fmb.h"

/* Selects the vertices of the convex hull of points, exactly: each other point is in the hull of
 * the selected ones, and no selected one is in the hull of the others.
 *
 * In:  point   [count][axis], count at least 1
 * Out: vertex  the selected points, in their order: at most FMB_HULL_VERTICES_MAX, or count
 *      *found  their number; 0: more than FMB_HULL_VERTICES_MAX
 * Returns FMB_OK, or a status of fmb_frame_make_hull() or fmb_decide().
 * Cost: O(count) decisions of a point and a hull, and O(count * *found). */
enum fmb_status mesh_hull(const double (*point)[3], size_t count, double (*vertex)[3],
                          size_t *found);

#endif
