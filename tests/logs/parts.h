/* What the scenes of the logs are made of. All numbers come from sums, products, quotients and
 * square roots, which IEEE rounds in one way: no sine knows two machines that agree on its last
 * bit.
 */
#ifndef PARTS_H
#define PARTS_H

#include "query.h"
#include "question.h"

/* The solid as a body of one frame, whole; its origin is the position. The geometry is valid until
 * PART_BODIES_MAX more are placed. */
enum { PART_BODIES_MAX = 2048 };
void part_place(const struct solid *solid, int64_t body_id, struct query_placement *out);

/* The same place and motion, with the handle in place of the frames. */
void part_by_handle(struct query_placement *placement, const struct handle *handle);

/* A box with its edges along the axes; in 2D z is left out. */
struct solid part_box(int dim, const double origin[3], const double size[3]);

/* The same as a corner: a tetrahedron, in 2D a triangle. */
struct solid part_corner(int dim, const double origin[3], const double size[3]);

/* The middle of its components' sum, which for a box is its middle. */
void part_middle(const struct solid *solid, double out[3]);

/* Cosine and sine of an angle. */
struct turn {
    double cosine, sine;
};

/* By the angle whose half has this tangent. */
struct turn turn_by(double half_tangent);

/* One after the other. */
struct turn turn_and(struct turn one, struct turn other);

#endif
