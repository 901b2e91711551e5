#include "faces.h"

#include "limbs.h"
#include "prepared.h"
#include "weighed.h"

/* In doubles: whether the normal of a surely has an extent along b. */
static bool surely_cross(const struct fmb_body *a, const struct fmb_body *b)
{
    const struct weighed u = weigh(a->component[0]), v = weigh(a->component[1]);
    const struct weighed normal = weighed_cross(&u, &v);
    for (int i = 0; i < 2; i++) {
        const struct weighed w = weigh(b->component[i]);
        if (fabs(weighed_dot(normal.at, w.at)) >
            weighed_error(weighed_dot(normal.weight, w.weight)))
            return true;
    }
    return false;
}

/* The axis along which a face has the largest shadow, or nearly. */
static int axis_of(const struct fmb_body *body)
{
    const struct weighed u = weigh(body->component[0]), v = weigh(body->component[1]);
    const struct weighed normal = weighed_cross(&u, &v);
    int axis = 0;
    for (int i = 1; i < 3; i++)
        if (fabs(normal.at[i]) > fabs(normal.at[axis]))
            axis = i;
    return axis;
}

/* The frame without its coordinate on an axis; false where it has no area then. */
static bool set_shadow(const struct fmb_frame *frame, int axis, struct fmb_body *body,
                       struct fmb_frame *out)
{
    const int x = (axis + 1) % 3, y = (axis + 2) % 3;
    const double(*c)[FMB_DIM_MAX] = frame->body->component;
    const double components[2][2] = {{c[0][x], c[0][y]}, {c[1][x], c[1][y]}};
    *out = (struct fmb_frame){
        .body = body, .origin = {frame->origin[x], frame->origin[y]}, .moving = frame->moving};
    if (frame->moving) {
        out->velocity[0] = frame->velocity[x];
        out->velocity[1] = frame->velocity[y];
    }
    body_set_plane_triangle(components, body);
    return !body->flat;
}

/* The same axis the other way round. */
static bool set_shadows(const struct fmb_pair *pair, struct faces_shadow *out)
{
    const int of_a = axis_of(pair->a.body), of_b = axis_of(pair->b.body);
    const int axis = of_a < of_b ? of_a : of_b;
    out->pair.duration = pair->duration;
    return set_shadow(&pair->a, axis, &out->body[0], &out->pair.a) &&
           set_shadow(&pair->b, axis, &out->body[1], &out->pair.b);
}

enum faces_planes faces_planes_of(const struct fmb_pair *pair, const struct slabs_pair *slabs,
                                  struct dyadic_span span, struct faces_shadow *shadow)
{
    struct limbs_pair limbs;
    if (surely_cross(slabs->a, slabs->b))
        return FACES_CROSSING;
    if (!limbs_prepare(pair, span, &limbs))
        return FACES_ELSE;
    const struct limbs_planes planes = limbs_planes_of(&limbs);
    if (!planes.parallel)
        return FACES_CROSSING;
    const bool rounded = pair->a.body->rounded || pair->b.body->rounded;
    return planes.shared && !rounded && set_shadows(pair, shadow) ? FACES_SHARED : FACES_ELSE;
}
