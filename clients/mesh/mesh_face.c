#include "mesh_face.h"

#include <math.h>
#include <string.h>

void mesh_face_vertices(const struct mesh *mesh, unsigned face, double vertex[3][3])
{
    for (int corner = 0; corner < 3; corner++)
        memcpy(vertex[corner], mesh->vertex[mesh->face[face][corner]], sizeof vertex[corner]);
}

/* c1 x c0, divided by its length; 0 if that is 0. */
static void unit_normal(const double c0[3], const double c1[3], double out[3])
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = c1[j] * c0[k] - c1[k] * c0[j];
    }
    const double length = sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
    for (int i = 0; i < 3; i++)
        out[i] = length > 0 ? out[i] / length : 0;
}

static void set_components(const double vertex[3][3], double out[3][3])
{
    for (int axis = 0; axis < 3; axis++) {
        out[0][axis] = vertex[1][axis] - vertex[0][axis];
        out[1][axis] = vertex[2][axis] - vertex[0][axis];
    }
    unit_normal(out[0], out[1], out[2]);
}

static enum fmb_status make_tetrahedron(const double vertex[3][3], struct fmb_body *out)
{
    double number[4][3]; /* origin, then components */
    memcpy(number[0], vertex[0], sizeof number[0]);
    set_components(vertex, number + 1);
    return fmb_body_make(3, FMB_TETRAHEDRON, number[0], 12, out);
}

/* A sum is off by at most 2^-53 of itself; a sum that overflows gives an infinite end. If a
 * component of the normal is not finite, the interval of its axis is unbounded, so that the face
 * becomes a candidate and is then refused. */
void mesh_face_tetrahedron_box(const struct mesh *mesh, unsigned face, double box[2][3])
{
    double vertex[3][3], component[3][3];
    mesh_face_vertices(mesh, face, vertex);
    set_components((const double(*)[3]) vertex, component);
    for (int axis = 0; axis < 3; axis++) {
        double low = vertex[0][axis], high = low;
        for (int i = 0; i < 3; i++) {
            const double end = vertex[0][axis] + component[i][axis];
            low = end < low ? end : low;
            high = end > high ? end : high;
        }
        const bool known = isfinite(component[2][axis]);
        box[0][axis] = known ? low - fabs(low) * 0x1p-52 : -INFINITY;
        box[1][axis] = known ? high + fabs(high) * 0x1p-52 : INFINITY;
    }
}

bool mesh_face_place(const struct mesh *mesh, enum mesh_as as, unsigned face,
                     const double *velocity, struct mesh_placed_face *out)
{
    double vertex[3][3];
    mesh_face_vertices(mesh, face, vertex);
    const enum fmb_status status =
        as == MESH_FACES ? fmb_body_make_vertices(3, FMB_FACE, vertex[0], 9, &out->body)
                         : make_tetrahedron((const double(*)[3]) vertex, &out->body);
    out->placement = (struct fmb_placement){.body = &out->body};
    if (velocity)
        memcpy(out->placement.velocity, velocity, sizeof out->placement.velocity);
    return status == FMB_OK;
}
