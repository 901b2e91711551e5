#include "outline.h"

#include <string.h>

/* Corner k of a cuboid: bit i of k tells whether component i is added. */
static const struct outline_face cuboid_3d[] = {
    {4, {0, 2, 6, 4}}, {4, {1, 3, 7, 5}}, {4, {0, 1, 5, 4}},
    {4, {2, 3, 7, 6}}, {4, {0, 1, 3, 2}}, {4, {4, 5, 7, 6}},
};
static const struct outline_face cuboid_2d[] = {{4, {0, 1, 3, 2}}};

/* Corner 0 of a simplex is the origin, corner i + 1 the end of component i. */
static const struct outline_face tetrahedron_3d[] = {
    {3, {0, 1, 2}}, {3, {0, 2, 3}}, {3, {0, 3, 1}}, {3, {1, 2, 3}}};
static const struct outline_face triangle[] = {{3, {0, 1, 2}}};

static bool adds(const struct fmb_body *body, int corner, int component)
{
    if (body->shape == FMB_CUBOID)
        return corner >> component & 1;
    return corner == component + 1;
}

static void set_faces(const struct fmb_body *body, struct outline *out)
{
    bool solid = body->dim == 3 && body->shape != FMB_FACE;
    if (body->shape == FMB_CUBOID) {
        out->face = solid ? cuboid_3d : cuboid_2d;
        out->face_count = solid ? 6 : 1;
    } else {
        out->face = solid ? tetrahedron_3d : triangle;
        out->face_count = solid ? 4 : 1;
    }
}

struct outline outline_make(const struct scene_body *frame, double time)
{
    const struct fmb_body *body = &frame->body;
    struct outline outline;
    memset(&outline, 0, sizeof outline);
    set_faces(body, &outline);
    outline.corner_count = body->shape == FMB_CUBOID ? 1 << body->count : body->count + 1;
    for (int k = 0; k < outline.corner_count; k++) {
        for (int axis = 0; axis < body->dim; axis++) {
            double at = frame->origin[axis];
            for (int i = 0; i < body->count; i++)
                at += adds(body, k, i) ? body->component[i][axis] : 0;
            if (frame->moving && time > 0)
                at += time * frame->velocity[axis];
            outline.corner[k][axis] = at;
            outline.centre[axis] += at / outline.corner_count;
        }
    }
    return outline;
}

struct outline outline_box(int dim, const double low[FMB_DIM_MAX], const double high[FMB_DIM_MAX])
{
    struct outline outline;
    memset(&outline, 0, sizeof outline);
    outline.face = dim == 3 ? cuboid_3d : cuboid_2d;
    outline.face_count = dim == 3 ? 6 : 1;
    outline.corner_count = 1 << dim;
    for (int k = 0; k < outline.corner_count; k++)
        for (int axis = 0; axis < dim; axis++)
            outline.corner[k][axis] = k >> axis & 1 ? high[axis] : low[axis];
    for (int axis = 0; axis < dim; axis++)
        outline.centre[axis] = low[axis] / 2 + high[axis] / 2;
    return outline;
}
