#include "faces.h"

#include "limbs.h"
#include "prepared.h"
#include "running_error.h"

/* In doubles: whether the normal of a surely has an extent along b. */
static bool surely_cross(const struct world_frame *a, const struct world_frame *b)
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

/* The axis along which a face has the largest projection, or nearly. */
static int axis_of(const struct world_frame *frame)
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

/* The frame without its coordinate on an axis; false where it has no area then. */
static bool set_shadow(const struct world_frame *frame, int axis, struct fmb_frame *out,
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

/* The same axis the other way round. */
static bool set_shadows(const struct slabs_pair *slabs, struct faces_projection *out)
{
    const int of_a = axis_of(&slabs->a), of_b = axis_of(&slabs->b);
    const int axis = of_a < of_b ? of_a : of_b;
    out->pair = (struct frame_pair){{&out->frame[0], &out->placement[0]},
                                    {&out->frame[1], &out->placement[1]},
                                    slabs->duration};
    return set_shadow(&slabs->a, axis, &out->frame[0], &out->placement[0]) &&
           set_shadow(&slabs->b, axis, &out->frame[1], &out->placement[1]);
}

enum faces_planes faces_planes_of(const struct frame_pair *pair, const struct slabs_pair *slabs,
                                  struct dyadic_span span, struct faces_projection *projection)
{
    struct limbs_pair limbs;
    if (!slabs->inexact && surely_cross(&slabs->a, &slabs->b))
        return FACES_CROSSING;
    if (!limbs_prepare(pair, span, &limbs))
        return FACES_UNDECIDED;
    const struct limbs_planes planes = limbs_planes_of(&limbs);
    if (!planes.parallel)
        return FACES_CROSSING;
    return planes.shared && !slabs->inexact && set_shadows(slabs, projection) ? FACES_SHARED
                                                                              : FACES_UNDECIDED;
}
