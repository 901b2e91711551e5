/* Frames of shape FMB_HULL: vertices merged and stored, and what is computed from them once.
 *
 * Internal fields of a hull in struct fmb_frame. frame_set_bounds() sets the others, which describe
 * the cuboid that contains the hull.
 *
 *   spanning    dim + 1 vertices, chosen one after the other: each spans the largest volume with
 *               those before it, as computed in doubles. Vertex 0 again: none adds to the volume
 *   bits        all coordinates of vertices, and all components, are multiples of 2^bits[0]; the
 *               coordinates are below 2^bits[1] */
#include "integer.h"
#include "prepared.h"
#include "support.h"
#include "vector.h"

#include <math.h>
#include <string.h>

static size_t stride_of(size_t vertex_count)
{
    return (vertex_count + SUPPORT_BLOCK - 1) / SUPPORT_BLOCK * SUPPORT_BLOCK;
}

/* The memory holds the vertices, and while they are merged one index of 4 bytes for each. */
size_t fmb_hull_doubles(int dim, size_t vertex_count)
{
    if ((dim != 2 && dim != 3) || vertex_count == 0 || vertex_count > FMB_HULL_VERTICES_MAX)
        return 0;
    return (size_t) dim * stride_of(vertex_count) + (vertex_count + 1) / 2;
}

/* ---- Merging ---- */

/* A heap of vertices, by their coordinates and then their indices. */
struct heap {
    const double *vertices; /* [vertex][axis] */
    int dim;
    uint32_t *index;
};

static int compare_coordinates(const struct heap *heap, uint32_t i, uint32_t j)
{
    const double *v = heap->vertices + (size_t) i * (size_t) heap->dim;
    const double *w = heap->vertices + (size_t) j * (size_t) heap->dim;
    for (int axis = 0; axis < heap->dim; axis++)
        if (v[axis] != w[axis])
            return v[axis] < w[axis] ? -1 : 1;
    return 0;
}

static bool is_before(const struct heap *heap, uint32_t i, uint32_t j)
{
    const int order = compare_coordinates(heap, i, j);
    return order ? order < 0 : i < j;
}

static void sift_down(const struct heap *heap, size_t from, size_t end)
{
    uint32_t *index = heap->index;
    for (size_t child = 2 * from + 1; child < end; child = 2 * from + 1) {
        if (child + 1 < end && is_before(heap, index[child], index[child + 1]))
            child++;
        if (!is_before(heap, index[from], index[child]))
            return;
        const uint32_t swapped = index[from];
        index[from] = index[child];
        index[child] = swapped;
        from = child;
    }
}

/* Heapsort: no input takes longer than O(n log n), and it needs no memory. */
static void sort(const struct heap *heap, size_t count)
{
    for (size_t i = count / 2; i-- > 0;)
        sift_down(heap, i, count);
    for (size_t end = count; end-- > 1;) {
        const uint32_t last = heap->index[0];
        heap->index[0] = heap->index[end];
        heap->index[end] = last;
        sift_down(heap, 0, end);
    }
}

/* kept[i] := whether vertex i differs from all before it. Returns how many are kept. */
static size_t find_distinct(const double *vertices, int dim, size_t count, uint32_t *index,
                            bool kept[FMB_HULL_VERTICES_MAX])
{
    const struct heap heap = {vertices, dim, index};
    size_t distinct = 0;
    for (size_t i = 0; i < count; i++)
        index[i] = (uint32_t) i;
    sort(&heap, count);
    for (size_t k = 0; k < count; k++) {
        const bool first = k == 0 || compare_coordinates(&heap, index[k - 1], index[k]) != 0;
        kept[index[k]] = first;
        distinct += first;
    }
    return distinct;
}

/* Stores the distinct vertices. */
static void store(const double *vertices, size_t count, double *memory, struct fmb_frame *out)
{
    bool kept[FMB_HULL_VERTICES_MAX];
    const size_t dim = (size_t) out->dim, largest = stride_of(count);
    const size_t distinct =
        find_distinct(vertices, out->dim, count, (uint32_t *) (memory + dim * largest), kept);
    const size_t stride = stride_of(distinct);
    for (size_t axis = 0; axis < dim; axis++) {
        double *to = memory + axis * stride;
        size_t k = 0;
        for (size_t i = 0; i < count; i++)
            if (kept[i])
                to[k++] = vertices[i * dim + axis] + 0.0; /* never -0 */
        for (; k < stride; k++)
            to[k] = to[0];
    }
    out->vertices = memory;
    out->vertex_count = (unsigned) distinct;
    out->vertex_stride = (unsigned) stride;
}

/* ---- What is computed once ---- */

static void get_vertex(const struct fmb_frame *frame, unsigned i, double out[FMB_DIM_MAX])
{
    out[2] = 0;
    for (int axis = 0; axis < frame->dim; axis++)
        out[axis] = frame->vertices[(size_t) axis * frame->vertex_stride + i];
}

/* Returns a bound of the distances of the vertices from the origin. The sum of squares and its root
 * are off by less than 2^-50 of themselves. Where squares might overflow or underflow, it is the
 * largest sum of magnitudes. */
static double reach_of(const struct fmb_frame *frame)
{
    double square = 0, sum = 0;
    for (unsigned i = 0; i < frame->vertex_count; i++) {
        double v[FMB_DIM_MAX];
        get_vertex(frame, i, v);
        square = fmax(square, vec3_dot(v, v));
        sum = fmax(sum, vec3_sum(v));
    }
    const double reach = sum > 0x1p-400 && sum < 0x1p500 ? sqrt(square) : sum;
    return reach * PREPARED_MARGIN + 0x1p-1000;
}

/* Sets the box of the vertices, and the fields that are derived from it as from a cuboid. */
static void set_box(struct fmb_frame *frame)
{
    double box[2][FMB_DIM_MAX];
    get_vertex(frame, 0, box[0]);
    get_vertex(frame, 0, box[1]);
    for (unsigned i = 1; i < frame->vertex_count; i++) {
        double v[FMB_DIM_MAX];
        get_vertex(frame, i, v);
        for (int axis = 0; axis < frame->dim; axis++) {
            box[0][axis] = v[axis] < box[0][axis] ? v[axis] : box[0][axis];
            box[1][axis] = v[axis] > box[1][axis] ? v[axis] : box[1][axis];
        }
    }
    frame_set_bounds((const double(*)[FMB_DIM_MAX]) box, frame);
}

/* Sets bits: those that the coordinates span. */
static void set_bits(struct fmb_frame *frame)
{
    struct dyadic_span span = dyadic_span_begin();
    for (size_t i = 0; i < (size_t) frame->dim * frame->vertex_stride; i++)
        dyadic_span_add(&span, dyadic_of(frame->vertices[i]));
    frame->bits[0] = (int) span.unit;
    frame->bits[1] = (int) span.top;
}

/* Vectors from the first vertex to others, scaled to a largest coordinate near 1. */
struct scaled {
    const struct fmb_frame *frame;
    double part; /* 1/2 if differences of the vertices may overflow, else 1 */
    double first[FMB_DIM_MAX], scale[2];
};

/* The difference of two doubles has a relative error of at most u = 2^-53, the scaling none, except
 * for underflow. */
static void get_scaled(const struct scaled *scaled, unsigned i, double out[FMB_DIM_MAX])
{
    get_vertex(scaled->frame, i, out);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out[axis] = (scaled->part * out[axis] - scaled->part * scaled->first[axis]) *
                    scaled->scale[0] * scaled->scale[1];
}

static void set_scale(const struct fmb_frame *frame, struct scaled *out)
{
    double largest = 0;
    int exponent;
    *out = (struct scaled){.frame = frame, .part = 1, .scale = {1, 1}};
    for (int axis = 0; axis < frame->dim; axis++)
        if (frame->component[axis][axis] >= 0x1p1023) /* the size of its box */
            out->part = 0.5;
    get_vertex(frame, 0, out->first);
    for (unsigned i = 1; i < frame->vertex_count; i++) {
        double v[FMB_DIM_MAX];
        get_scaled(out, i, v);
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            largest = fmax(largest, fabs(v[axis]));
    }
    frexp(largest, &exponent);
    out->scale[0] = ldexp(1, -exponent / 2);
    out->scale[1] = ldexp(1, -exponent - -exponent / 2);
}

/* Returns the volume (2D: the area) spanned by 1 to dim vectors, their last one v: a length, an
 * area, or a volume, squared unless it is of dim vectors. */
static double span_of(int dim, int count, const double basis[2][FMB_DIM_MAX],
                      const double v[FMB_DIM_MAX])
{
    double normal[FMB_DIM_MAX];
    if (count == 1)
        return vec3_dot(v, v);
    vec3_cross(basis[0], count == 2 ? v : basis[1], normal);
    if (count == 2)
        return dim == 2 ? fabs(normal[2]) : vec3_dot(normal, normal);
    return fabs(vec3_dot(normal, v));
}

/* The least volume of the chosen simplex, times dim!, relative to the cube of its longest
 * coordinate difference, that proves that a hull is not flat. The vectors have relative errors of u
 * in each coordinate, at most 1; the volume is a sum of at most 6 products of 3 coordinates, each
 * with at most 8 further roundings: off by less than 6 * 11.1 u < 2^-46, and by 2^-1000 for
 * underflow. */
static const double least_volume = 0x1p-44;

/* Chooses vertices that span the hull, one after the other: each spans the largest volume with
 * those before it, as computed. Sets spanning and flat. */
static void choose_spanning(struct fmb_frame *frame)
{
    struct scaled scaled;
    double basis[FMB_DIM_MAX][FMB_DIM_MAX] = {{0}}, most = 0;
    set_scale(frame, &scaled);
    for (int count = 1; count <= frame->dim; count++) {
        unsigned best = 0;
        most = 0;
        for (unsigned i = 1; i < frame->vertex_count; i++) {
            double v[FMB_DIM_MAX];
            get_scaled(&scaled, i, v);
            const double span = span_of(frame->dim, count, (const double(*)[FMB_DIM_MAX]) basis, v);
            if (span > most) {
                most = span;
                best = i;
            }
        }
        frame->spanning[count] = best;
        get_scaled(&scaled, best, basis[count - 1]);
    }
    frame->flat = !(most > least_volume);
}

enum fmb_status fmb_frame_make_hull(int dim, const double *vertices, size_t count, double *memory,
                                    struct fmb_frame *out)
{
    if (dim != 2 && dim != 3)
        return FMB_WRONG_DIMENSION;
    if (count == 0 || count % (size_t) dim != 0)
        return FMB_WRONG_COUNT;
    if (count / (size_t) dim > FMB_HULL_VERTICES_MAX)
        return FMB_OVER_LIMIT;
    for (size_t i = 0; i < count; i++)
        if (!isfinite(vertices[i]))
            return FMB_NOT_FINITE;
    memset(out, 0, sizeof *out);
    out->dim = dim;
    out->shape = FMB_HULL;
    store(vertices, count / (size_t) dim, memory, out);
    set_box(out);
    set_bits(out);
    out->reach = out->core_reach = reach_of(out);
    choose_spanning(out);
    return FMB_OK;
}
