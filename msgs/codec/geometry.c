#include "geometry.h"

#include "cursor.h"

#include "fmb_msgs_placement_t.h"

#include <assert.h>

/* The offset of the shapes in an encoded body: after dim and the count of frames. */
enum { SHAPES_AT = 8 };

/* ---- Shapes ---- */

static_assert((int) FMB_CUBOID == FMB_MSGS_PLACEMENT_T_SHAPE_CUBOID &&
                  (int) FMB_TETRAHEDRON == FMB_MSGS_PLACEMENT_T_SHAPE_TETRAHEDRON &&
                  (int) FMB_FACE == FMB_MSGS_PLACEMENT_T_SHAPE_FACE &&
                  (int) FMB_BOX == FMB_MSGS_PLACEMENT_T_SHAPE_BOX &&
                  (int) FMB_HULL == FMB_MSGS_PLACEMENT_T_SHAPE_HULL,
              "shapes");

struct geometry_shape geometry_shape(int code)
{
    const bool has_radius = code >= FMB_MSGS_PLACEMENT_T_SHAPE_RADIUS;
    const int core = has_radius ? code - FMB_MSGS_PLACEMENT_T_SHAPE_RADIUS : code;
    switch (core) {
    case FMB_MSGS_PLACEMENT_T_SHAPE_TETRAHEDRON_VERTICES:
        return (struct geometry_shape){FMB_TETRAHEDRON, true, has_radius};
    case FMB_MSGS_PLACEMENT_T_SHAPE_FACE_VERTICES:
        return (struct geometry_shape){FMB_FACE, true, has_radius};
    default:
        return (struct geometry_shape){fmb_shape_name(core) ? core : 0, core == FMB_HULL,
                                       has_radius};
    }
}

int geometry_code(struct geometry_shape shape)
{
    const int vertices = shape.shape == FMB_FACE ? FMB_MSGS_PLACEMENT_T_SHAPE_FACE_VERTICES
                                                 : FMB_MSGS_PLACEMENT_T_SHAPE_TETRAHEDRON_VERTICES;
    return (shape.by_vertices && shape.shape != FMB_HULL ? vertices : shape.shape) +
           (shape.has_radius ? FMB_MSGS_PLACEMENT_T_SHAPE_RADIUS : 0);
}

/* The numbers of a frame without its radius. */
static int64_t core_numbers(int dim, int shape, int32_t vertices)
{
    const int components = fmb_component_count(dim, shape);
    if (shape == FMB_HULL)
        return (dim == 2 || dim == 3) && vertices > 0 ? (int64_t) dim * vertices : 0;
    const int count = shape == FMB_BOX ? components : dim * components;
    return count > 0 ? dim + count : 0;
}

int64_t geometry_number_count(int dim, int code, int32_t vertices)
{
    const struct geometry_shape shape = geometry_shape(code);
    const int64_t count = core_numbers(dim, shape.shape, vertices);
    return count > 0 ? count + shape.has_radius : 0;
}

struct body_view geometry_named(int dim, const struct handle *handle)
{
    static const unsigned char bytes[FMB_DIM_MAX + 1][GEOMETRY_NONE_BYTES] = {
        [1][3] = 1, [2][3] = 2, [3][3] = 3}; /* dim is big-endian; no frames */
    return (struct body_view){
        .handle = *handle, .dim = dim, .bytes = bytes[dim], .size = GEOMETRY_NONE_BYTES};
}

/* ---- Reading ---- */

void geometry_numbers(const struct geometry_frame *frame, double *out)
{
    for (size_t i = 0; i < frame->count; i++)
        out[i] = cursor_double_at(frame->number + 8 * i);
}

struct geometry_reader geometry_begin(const struct body_view *body)
{
    const unsigned char *shape = body->bytes + SHAPES_AT;
    const unsigned char *count = shape + body->frame_count + 4;
    return (struct geometry_reader){.dim = body->dim,
                                    .frames_left = body->frame_count,
                                    .counts_left = body->count_count,
                                    .numbers_left = body->number_count,
                                    .shape = shape,
                                    .count = count,
                                    .number = count + 4 * (size_t) body->count_count + 4};
}

bool geometry_next(struct geometry_reader *reader, struct geometry_frame *out)
{
    const int dim = reader->dim;
    if (reader->frames_left == 0)
        return false;
    const struct geometry_shape shape = geometry_shape(*reader->shape);
    if (shape.by_vertices && reader->counts_left == 0)
        return false;
    const int32_t vertices = shape.by_vertices ? (int32_t) big_endian_32(reader->count) : 0;
    const int64_t core = core_numbers(dim, shape.shape, vertices), count = core + shape.has_radius;
    if (core == 0 || reader->numbers_left < count ||
        (shape.by_vertices && core != (int64_t) dim * vertices))
        return false;
    *out = (struct geometry_frame){shape.shape, shape.by_vertices,
                                   shape.has_radius ? cursor_double_at(reader->number) : 0,
                                   (size_t) core, reader->number + (shape.has_radius ? 8 : 0)};
    reader->shape++;
    reader->frames_left--;
    reader->count += shape.by_vertices ? 4 : 0;
    reader->counts_left -= shape.by_vertices;
    reader->number += 8 * count;
    reader->numbers_left -= (int32_t) count;
    return true;
}
