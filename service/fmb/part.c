#include "part.h"

#include <string.h>

/* Accuracy: places are rounded outward at each step (range.h). A point between vertices,
 * o + sum x_i c_i + tau v T with x and tau in [0,1], is made from a place by at most 5 more
 * roundings of each term, and a place is off by at most 3 u of the sum of the magnitudes for each
 * of its at most 3 sums: 14 u in all, within 2^-49 = 16 u, besides the error of the frame. Where a
 * sum of such numbers is smaller than the smallest normal double, 2^-1070 covers what its products
 * lose. */
static const double point_error = 0x1p-49, point_underflow = 0x1p-1070;

/* Beyond this nothing is said: sums must not overflow. */
static const double largest_place = 0x1p300;

static void add_edge(struct part *part, int direction, int start, int end)
{
    part->edge[part->edges++] = (struct part_edge){direction, start, end};
}

/* Vertex v of a cuboid is the sum of the components whose bits are set in v; of a simplex the
 * origin, then the end of each component. Edges go by direction. */
static void set_cuboid(struct part *part)
{
    part->vertices = 1 << part->dim;
    for (int i = 0; i < part->dim; i++) {
        const int bit = 1 << i;
        part->direction[part->directions++] = part->component[i];
        for (int v = 0; v < part->vertices; v++) {
            if (!(v & bit))
                add_edge(part, i, v, v | bit);
            for (int axis = 0; v & bit && axis < part->dim; axis++)
                part->vertex[v][axis] += part->component[i].at[axis];
        }
    }
}

static void set_simplex(struct part *part)
{
    part->vertices = part->components + 1;
    for (int i = 0; i < part->components; i++) {
        memcpy(part->vertex[i + 1], part->component[i].at, sizeof part->vertex[i + 1]);
        add_edge(part, part->directions, 0, i + 1);
        part->direction[part->directions++] = part->component[i];
        for (int j = i + 1; j < part->components; j++) {
            add_edge(part, part->directions, i + 1, j + 1);
            part->direction[part->directions++] =
                weighed_sum(&part->component[j], -1, &part->component[i]);
        }
    }
}

/* normal[k] . c_k is the volume, normal[k] . c_i is 0 for other i; the face across from the origin
 * of a simplex has their sum. In 2D these are the components turned by a right angle. */
static void set_faces(struct part *part)
{
    const struct weighed *c = part->component;
    if (part->shape == FMB_FACE)
        return;
    part->faces = part->dim;
    if (part->dim == 2) {
        const struct weighed turned = weighed_turn(&c[1]), zero = {{0}, {0}, 0};
        part->normal[0] = weighed_sum(&zero, -1, &turned);
        part->normal[1] = weighed_turn(&c[0]);
    } else {
        for (int k = 0; k < 3; k++)
            part->normal[k] = weighed_cross(&c[(k + 1) % 3], &c[(k + 2) % 3]);
    }
    const double volume = weighed_dot(part->normal[0].at, c[0].at);
    part->low = fmin(0, volume);
    part->high = fmax(0, volume);
    if (part->shape == FMB_CUBOID)
        return;
    part->normal[part->faces] = weighed_sum(&part->normal[0], 1, &part->normal[1]);
    if (part->dim == 3)
        part->normal[part->faces] = weighed_sum(&part->normal[part->faces], 1, &part->normal[2]);
    part->faces++;
}

/* o + sum of components, + v T, each within the error of the frame. */
static void set_vertex_places(const struct world_frame *frame, struct range way, int axis,
                              struct part *part)
{
    const struct range error = {-frame->error, frame->error};
    for (int v = 0; v < part->vertices; v++) {
        struct range at = range_of(frame->origin[axis]);
        for (int i = 0; i < part->components; i++)
            if (part->shape == FMB_CUBOID ? v >> i & 1 : v == i + 1)
                at = range_sum(at, range_of(part->component[i].at[axis]));
        if (frame->error != 0)
            at = range_sum(at, error);
        part->place[0][v][axis] = at;
        part->place[1][v][axis] = range_sum(at, way);
        part->extent[axis] = range_hull(part->extent[axis], at);
        part->extent[axis] = range_hull(part->extent[axis], part->place[1][v][axis]);
    }
}

static bool set_places(const struct world_frame *frame, double duration, struct part *part)
{
    bool near = true;
    for (int axis = 0; axis < part->dim; axis++) {
        part->displacement[axis] = frame->velocity[axis] * duration;
        double magnitude = fabs(frame->origin[axis]) + fabs(part->displacement[axis]);
        near = near && magnitude <= largest_place;
        for (int i = 0; i < part->components; i++)
            magnitude += part->component[i].weight[axis];
        part->slack[axis] = point_error * magnitude + point_underflow + frame->error;
        part->extent[axis] = range_none();
        part->way[axis] = range_product(frame->velocity[axis], duration);
        set_vertex_places(frame, part->way[axis], axis, part);
    }
    return near;
}

bool part_set(const struct world_frame *frame, double duration, struct part *part)
{
    memset(part, 0, sizeof *part);
    part->shape = frame->shape;
    part->dim = frame->dim;
    part->components = frame->count;
    for (int i = 0; i < part->components; i++)
        part->component[i] = weigh(frame->component[i]);
    if (part->shape == FMB_CUBOID)
        set_cuboid(part);
    else
        set_simplex(part);
    set_faces(part);
    return set_places(frame, duration, part);
}
