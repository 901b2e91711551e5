/* Placed frames as arrays of vertices, and the support function of their swept difference. */
#include "support_pair.h"

#include <math.h>

static const double unit_roundoff = 0x1p-53;

/* ---- Views ---- */

/* Sets the vertices of a frame that is not a hull: o plus each sum of components, or o and o plus
 * each component. A coordinate passes at most 3 roundings, each of half a unit in the last place of
 * a number of magnitude at most |o| + sum |c_i|. */
static void set_small(const struct fmb_frame *frame, struct support_view *out)
{
    const unsigned count = frame_vertex_count(frame);
    double sum = 0;
    for (int axis = 0; axis < frame->dim; axis++) {
        double *to = out->small + axis * SUPPORT_SMALL;
        sum += fabs(frame->origin[axis]);
        for (unsigned k = 0; k < SUPPORT_SMALL; k++) {
            to[k] = frame->origin[axis];
            for (int i = 0; i < frame->count && k < count; i++)
                if (frame_vertex_has(frame, k, i))
                    to[k] += frame->component[i][axis];
        }
        for (int i = 0; i < frame->count; i++)
            sum += fabs(frame->component[i][axis]);
    }
    out->vertices = (struct support_vertices){out->small, count, SUPPORT_SMALL, frame->dim};
    out->slack = frame->slack + 3.1 * unit_roundoff * sum;
    for (int axis = 0; axis < frame->dim; axis++) {
        double all = 0;
        for (int i = 0; i < frame->count; i++)
            all += frame->component[i][axis];
        out->centre[axis] =
            frame->origin[axis] + all / (frame_is_simplex(frame) ? frame->count + 1 : 2);
    }
}

/* The centre is the mean of the vertices that span the hull. Quarters do not overflow. */
static void set_hull(const struct fmb_frame *frame, struct support_view *out)
{
    out->vertices = hull_frame_vertices(frame);
    out->slack = 0;
    for (int axis = 0; axis < frame->dim; axis++) {
        const double *x = frame->vertices + (size_t) axis * frame->vertex_stride;
        const unsigned *at = frame->spanning;
        out->centre[axis] = frame->dim == 3 ? (0.25 * x[at[0]] + 0.25 * x[at[1]]) +
                                                  (0.25 * x[at[2]] + 0.25 * x[at[3]])
                                            : 0.25 * x[at[0]] + (0.25 * x[at[1]] + 0.5 * x[at[2]]);
    }
}

static void set_view(struct placed_frame placed, struct support_view *out)
{
    const struct fmb_frame *frame = placed.frame;
    out->placed = placed;
    out->solid = !frame->flat;
    out->centre[2] = 0;
    if (frame->shape == FMB_HULL)
        set_hull(frame, out);
    else
        set_small(frame, out);
    out->reach = frame->core_reach + out->slack;
    rotation_of(placed.placement, frame->dim, &out->rotation);
}

void support_place(const struct support_view *view, unsigned vertex, double out[FMB_DIM_MAX])
{
    const struct support_vertices *vertices = &view->vertices;
    double v[FMB_DIM_MAX] = {0};
    for (int axis = 0; axis < vertices->dim; axis++)
        v[axis] = vertices->at[(size_t) axis * vertices->stride + vertex];
    rotation_apply(&view->rotation, v, out);
}

/* The direction in body coordinates is the transposed matrix times n: its rows are the columns of
 * R.
 */
struct support support_view_farthest(const struct support_view *view, const double n[FMB_DIM_MAX])
{
    const struct rotation_matrix *rotation = &view->rotation;
    double direction[FMB_DIM_MAX];
    if (!rotation->turned)
        return support_max(&view->vertices, n);
    for (int j = 0; j < FMB_DIM_MAX; j++) {
        const double xy =
            rotation_entry(rotation, 0, j) * n[0] + rotation_entry(rotation, 1, j) * n[1];
        direction[j] = xy + rotation_entry(rotation, 2, j) * n[2];
    }
    return support_max(&view->vertices, direction);
}

/* Vertices whose values differ by more than this many times the bound on the error of a value are
 * ordered as their exact values are: twice the error, and the rounding of the difference, which is
 * below u |v| / 9. */
#define SUPPORT_ORDERED 2.1

/* The bound on the error of a value. n is off by 2 u of each coordinate, and the product with a
 * vertex v by 3.01 u of the magnitudes of its terms (support.h): with |n| < 1/9 by less than 5.01/9
 * u |v| + slack + 2^-1000. |v| is at most the reach, which may be infinite, and less than
 * sqrt(3) 2^1024, since coordinates are finite: 2^972 bounds the first term then. Coordinates of a
 * frame that is not a hull are sums, which may overflow; its slack is then infinite, and all
 * vertices are listed. */
unsigned support_view_list(const struct support_view *view, const double n[FMB_DIM_MAX],
                           const uint16_t *face, unsigned count, uint16_t *out)
{
    const struct support_vertices *vertices = &view->vertices;
    const double error = fmin(unit_roundoff * view->reach, 0x1p972) + view->slack + 0x1p-1000;
    double most = -INFINITY;
    unsigned listed = 0;
    if (count == vertices->count)
        return support_list(vertices, n, support_max(vertices, n).value - SUPPORT_ORDERED * error,
                            out);
    for (unsigned k = 0; k < count; k++)
        most = fmax(most, support_value(vertices, n, face[k]));
    for (unsigned k = 0; k < count; k++) {
        const double value = support_value(vertices, n, face[k]);
        CHECK_BOUND(SUPPORT_ORDERED, false, most - value, SUPPORT_ORDERED * error);
        out[listed] = face[k];
        listed += !(value < most - SUPPORT_ORDERED * error);
    }
    return listed;
}

/* ---- Pairs ---- */

bool support_order(const struct frame_pair *frames, struct frame_pair *out)
{
    const bool swapped = gap_frames_swap(&frames->a, &frames->b);
    *out = (struct frame_pair){swapped ? frames->b : frames->a, swapped ? frames->a : frames->b,
                               frames->duration};
    return swapped;
}

void support_pair_set(const struct frame_pair *frames, struct support_pair *out)
{
    const struct fmb_placement *placed[2] = {frames->a.placement, frames->b.placement};
    out->frames = frames;
    out->dim = frames->a.frame->dim;
    out->drifts = out->posed = false;
    out->at = 0;
    set_view(frames->a, &out->view[0]);
    set_view(frames->b, &out->view[1]);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        const bool used = axis < out->dim;
        for (int f = 0; f < 2; f++) {
            out->position[f][axis] = used ? placed[f]->position[axis] : 0;
            out->path[f][axis] = used ? placed[f]->velocity[axis] * frames->duration : 0;
        }
        const double speed = used ? placed[1]->velocity[axis] - placed[0]->velocity[axis] : 0;
        out->offset[axis] = out->position[1][axis] - out->position[0][axis];
        out->drift[axis] = speed * frames->duration;
        out->drifts = out->drifts || (speed != 0 && frames->duration > 0);
    }
    out->reach = ((out->view[0].reach + out->view[1].reach) +
                  (vec3_sum(out->offset) + vec3_sum(out->drift)));
    out->error =
        32 * unit_roundoff * out->reach + (out->view[0].slack + out->view[1].slack) + 0x1p-1000;
    out->usable = out->reach < 0x1p200 && out->reach > 0x1p-200;
    const double sum = frames->a.frame->radius + frames->b.frame->radius;
    out->rounded = sum != 0;
    out->radius[0] = sum * (1 - 0x1p-52);
    out->radius[1] = sum * (1 + 0x1p-52);
}

double support_farthest(const struct support_pair *pair, const double n[FMB_DIM_MAX],
                        struct support_column *column)
{
    const double against[FMB_DIM_MAX] = {-n[0], -n[1], -n[2]};
    const struct support a = support_view_farthest(&pair->view[0], against);
    const struct support b = support_view_farthest(&pair->view[1], n);
    const double drift = pair->drifts ? vec3_dot(n, pair->drift) : 0;
    column->vertex[0] = a.index;
    column->vertex[1] = b.index;
    column->end = drift > 0;
    return (a.value + b.value) + (vec3_dot(n, pair->offset) + (drift > 0 ? drift : 0));
}

void support_point(const struct support_pair *pair, struct support_column column,
                   double out[FMB_DIM_MAX])
{
    double a[FMB_DIM_MAX], b[FMB_DIM_MAX];
    support_place(&pair->view[0], column.vertex[0], a);
    support_place(&pair->view[1], column.vertex[1], b);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out[axis] =
            (b[axis] - a[axis]) + (pair->offset[axis] + (column.end ? pair->drift[axis] : 0));
}
