#include "faces.h"

#include "limbs.h"
#include "prepared.h"
#include "vector.h"

#include <math.h>

/* Returns whether the planes certainly cross, in doubles: some component w of b is certainly not
 * orthogonal to the normal of a. A monomial of [u v w] is rounded at most 6 times, so that the
 * product is off by at most 6.01 u times the sum of their magnitudes, u = 2^-53; 2^-48 = 32 u also
 * covers the rounding of that sum. Underflow: each of less than 2^6 operations adds less than
 * 2^-1074, and is multiplied by at most 2^200 afterwards. */
static bool certainly_cross(const struct world_frame *a, const struct world_frame *b)
{
    const double *u = a->component[0], *v = a->component[1];
    for (int i = 0; i < 2; i++) {
        const double *w = b->component[i];
        double product = 0, magnitudes = 0;
        for (int k = 0; k < 3; k++) {
            const int p = (k + 1) % 3, q = (k + 2) % 3;
            product += (u[p] * v[q] - u[q] * v[p]) * w[k];
            magnitudes += (fabs(u[p] * v[q]) + fabs(u[q] * v[p])) * fabs(w[k]);
        }
        if (fabs(product) > 0x1p-48 * magnitudes + 0x1p-660)
            return true;
    }
    return false;
}

/* Returns the axis along which the projection of a face is largest, up to rounding. */
static int projection_axis_of(const struct world_frame *frame)
{
    double normal[3];
    int axis = 0;
    vec3_cross(frame->component[0], frame->component[1], normal);
    for (int i = 1; i < 3; i++)
        if (fabs(normal[i]) > fabs(normal[axis]))
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
    struct limbs_question question;
    if (!slabs->inexact && certainly_cross(&slabs->a, &slabs->b))
        return FACES_CROSSING;
    limbs_question_set(pair, span, LIMBS_SLABS, &question);
    if (!limbs_suffice(&question))
        return FACES_UNDECIDED;
    const enum limbs_planes planes = limbs_planes(&question);
    if (planes == LIMBS_CROSSING)
        return FACES_CROSSING;
    return planes == LIMBS_SHARED && !slabs->inexact && set_projections(slabs, projection)
               ? FACES_SHARED
               : FACES_UNDECIDED;
}
