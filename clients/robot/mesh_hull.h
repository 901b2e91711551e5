/* The vertices of the convex hull of a mesh, or few of them and a radius. */
#ifndef MESH_HULL_H
#define MESH_HULL_H

#include "fmb.h"

/* Selects the vertices of the convex hull of points, exactly: every other point is in the hull
 * of the selected points, and no selected point is in the hull of the other selected points.
 *
 * In:  point   [count][axis], count at least 1
 * Out: vertex  the selected points, in their order: at most FMB_HULL_VERTICES_MAX, or count
 *      *found  their number; 0: more than FMB_HULL_VERTICES_MAX
 * Returns FMB_OK, or a status of fmb_frame_make_hull() or fmb_decide().
 * Cost: O(count) decisions of a point and a hull, and O(count * *found). */
enum fmb_status mesh_hull(const double (*point)[3], size_t count, double (*vertex)[3],
                          size_t *found);

/* Selects few of the points, and a radius: it is proven that no point is farther than *radius from
 * the hull of the selected points. So the hull with this radius contains the hull of all points,
 * and extends beyond it by at most *radius.
 *
 * In:  point    [count][axis], count at least 1
 *      most     the largest number of selected points, 1 to FMB_HULL_VERTICES_MAX
 *      excess   the largest radius, 0 or more; exceeded only if *found is `most`
 * Out: vertex   the selected points, in their order: [most], or [count] if that is less
 *      *found   their number
 *      *radius
 * Returns as mesh_hull(). Cost: O(count) gaps of a point and a hull, more for each halving of the
 * radius, and O(count * *found). */
enum fmb_status mesh_hull_cover(const double (*point)[3], size_t count, size_t most, double excess,
                                double (*vertex)[3], size_t *found, double *radius);

#endif
