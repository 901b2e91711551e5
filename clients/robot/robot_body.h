/* Links of a robot as bodies of the engine. Boxes, spheres and capsules are exact. A cylinder
 * becomes a hull that encloses it; a mesh becomes the hull of the vertices of its faces, or a hull
 * for each object. A hull of too many vertices becomes one of fewer with a radius, which contains
 * the mesh (mesh_hull_cover()). */
#ifndef ROBOT_BODY_H
#define ROBOT_BODY_H

#include "fmb_robot.h"
#include "robot.h"

/* What was done to the meshes of a robot. All 0: nothing. */
struct robot_meshes {
    size_t scaled;          /* number of COLLADA meshes whose unit is not 1 m */
    const char *first_file; /* the first of these, and its unit in metres */
    double first_unit;
    double excess; /* the largest radius of a hull */
};

/* Makes the body of a link that has at least one collision element. If it has only one, the body
 * has the origin of the element, and the numbers of the file. If it has several, the body has the
 * origin of the link, and the numbers of elements with an origin are rounded.
 *
 * In:     options  valid; sides is not 0
 * In/out: scene    of dim 3; owns the body; its `outside` is raised
 *         meshes   of the robot so far
 * Out:    *origin  of the body, in the link
 * Returns NULL after errors, which the robot has. */
const struct fmb_body *robot_body(struct robot *robot, const struct robot_link *link,
                                  const struct fmb_robot_options *options,
                                  struct owned_scene *scene, struct robot_meshes *meshes,
                                  struct pose *origin);

#endif
