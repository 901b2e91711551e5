#include "faces.h"

#include "limbs.h"
#include "prepared.h"
#include "running_error.h"

/* Returns whether the planes certainly cross, in doubles: some component of b is certainly not
 * orthogonal to the normal of a. */
static bool certainly_cross(const struct world_frame *a, const struct world_frame *b)
{
    const struct running_error u = running_error_of(a->component[0]),
                               v = running_error_of(a->component[1]);
    const struct running_error normal = running_error_cross(&u, &v);
    for (int i = 0; i < 2; i++) {
        const struct running_error w = running_error_of(b->component[i]);
        if (fabs(running_error_dot(normal.at, w.at)) >
            running_error_bound(running_error_dot(normal.weight, w.weight)))
            return true;
    }
    return false;
}

/* Returns the axis along which the projection of a face is largest, up to rounding. */
static int projection_axis_of(const struct world_frame *frame)
{
    const struct running_error u = running_error_of(frame->component[0]),
                               v = running_error_of(frame->component[1]);
    const struct running_error normal = running_error_cross(&u, &v);
    int axis = 0;
    for (int i = 1; i < 3; i++)
        if (fabs(normal.at[i]) > fabs(normal.at[axis]))
            axis = i;
    return axis;
}

/* Projects a frame along an axis: drops that coordinate. Returns false if the projection has no
 * area. */
static bool set_projection(const struct world_frame *frame, int axis, struct fmb_frame *out,
                           struct fmb_placement *placement)
{
    const int x = (axis + 1) % 3, y = (axis + 2) % 3;
    const double(*c)[FMB_DIM_MAX] = frame->component;
    const double components[2][2] = {{c[0][x], c[0][y]}, {c[1][x], c[1][y]}};
    *placement = (struct fmb_placement){.position = {frame->origin[x], frame->origin[y]},
                                        .velocity = {frame->velocity[x], frame->velocity[y]}};
    frame_set_plane_triangle(components, out);
    return !out->flat;
}

/* Projects both faces along the same axis, which does not depend on their order. Returns false if a
 * projection has no area. */
static bool set_projections(const struct slabs_pair *slabs, struct faces_projection *out)
{
    const int of_a = projection_axis_of(&slabs->a), of_b = projection_axis_of(&slabs->b);
    const int axis = of_a < of_b ? of_a : of_b;
    out->pair = (struct frame_pair){{&out->frame[0], &out->placement[0]},
                                    {&out->frame[1], &out->placement[1]},
                                    slabs->duration};
    return set_projection(&slabs->a, axis, &out->frame[0], &out->placement[0]) &&
           set_projection(&slabs->b, axis, &out->frame[1], &out->placement[1]);
}

enum faces_planes faces_planes_of(const struct frame_pair *pair, const struct slabs_pair *slabs,
                                  struct dyadic_span span, struct faces_projection *projection)
{
    struct limbs_pair limbs;
    if (!slabs->inexact && certainly_cross(&slabs->a, &slabs->b))
        return FACES_CROSSING;
    if (!limbs_prepare(pair, span, &limbs))
        return FACES_UNDECIDED;
    const struct limbs_planes planes = limbs_planes_of(&limbs);
    if (!planes.parallel)
        return FACES_CROSSING;
    return planes.shared && !slabs->inexact && set_projections(slabs, projection) ? FACES_SHARED
                                                                                  : FACES_UNDECIDED;
}
