#include "geometry.h"

#include "cursor.h"
#include "writer.h"

#include "fmb_msgs_placement_t.h"

#include <assert.h>

/* Offsets in an encoded geometry, in bytes. */
enum { DIM_AT = 0, FRAMES_AT = 4, SHAPES_AT = 8 };

/* ---- Shapes ---- */

static_assert((int) FMB_CUBOID == FMB_MSGS_PLACEMENT_T_SHAPE_CUBOID &&
                  (int) FMB_TETRAHEDRON == FMB_MSGS_PLACEMENT_T_SHAPE_TETRAHEDRON &&
                  (int) FMB_FACE == FMB_MSGS_PLACEMENT_T_SHAPE_FACE &&
                  (int) FMB_BOX == FMB_MSGS_PLACEMENT_T_SHAPE_BOX &&
                  (int) FMB_HULL == FMB_MSGS_PLACEMENT_T_SHAPE_HULL,
              "shapes");

struct geometry_shape geometry_shape(int code)
{
    switch (code) {
    case FMB_MSGS_PLACEMENT_T_SHAPE_TETRAHEDRON_VERTICES:
        return (struct geometry_shape){FMB_TETRAHEDRON, true};
    case FMB_MSGS_PLACEMENT_T_SHAPE_FACE_VERTICES: return (struct geometry_shape){FMB_FACE, true};
    default: return (struct geometry_shape){fmb_shape_name(code) ? code : 0, code == FMB_HULL};
    }
}

int geometry_code(int shape, bool by_vertices)
{
    if (!by_vertices || shape == FMB_HULL)
        return shape;
    return shape == FMB_FACE ? FMB_MSGS_PLACEMENT_T_SHAPE_FACE_VERTICES
                             : FMB_MSGS_PLACEMENT_T_SHAPE_TETRAHEDRON_VERTICES;
}

int64_t geometry_number_count(int dim, int code, int32_t vertices)
{
    const int shape = geometry_shape(code).shape, components = fmb_component_count(dim, shape);
    if (shape == FMB_HULL)
        return (dim == 2 || dim == 3) && vertices > 0 ? (int64_t) dim * vertices : 0;
    const int count = shape == FMB_BOX ? components : dim * components;
    return count > 0 ? dim + count : 0;
}

size_t geometry_frame_numbers(int dim, const struct geometry_frame *frame,
                              double out[FMB_FRAME_NUMBERS_MAX])
{
    const int count = (int) geometry_number_count(dim, frame->shape, 0);
    for (int i = 0; i < count; i++)
        out[i] = i < dim ? frame->origin[i] : frame->components[i - dim];
    return (size_t) count;
}

/* ---- Writing ---- */

void geometry_write_none(int dim, unsigned char out[GEOMETRY_NONE_BYTES])
{
    struct writer writer = {.at = out, .end = out + GEOMETRY_NONE_BYTES};
    writer_int32(&writer, dim);
    for (int list = 0; list < 3; list++)
        writer_int32(&writer, 0);
}

/* ---- Reading ---- */

struct geometry_reader geometry_begin(const struct geometry *geometry)
{
    const unsigned char *bytes = geometry->bytes, *shape = bytes + SHAPES_AT;
    const int32_t frames = (int32_t) big_endian_32(bytes + FRAMES_AT);
    const int32_t counts = (int32_t) big_endian_32(shape + frames);
    const unsigned char *count = shape + frames + 4;
    const unsigned char *numbers = count + 4 * (size_t) counts;
    return (struct geometry_reader){.dim = (int) big_endian_32(bytes + DIM_AT),
                                    .frames_left = frames,
                                    .counts_left = counts,
                                    .numbers_left = (int32_t) big_endian_32(numbers),
                                    .shape = shape,
                                    .count = count,
                                    .number = numbers + 4};
}

/* Takes the count of a frame by vertices. Returns false if it is not the one of the shape. */
static bool take_vertices(struct geometry_reader *reader, int64_t numbers)
{
    if (reader->counts_left == 0 ||
        (int64_t) reader->dim * (int32_t) big_endian_32(reader->count) != numbers)
        return false;
    reader->count += 4;
    reader->counts_left--;
    return true;
}

bool geometry_next(struct geometry_reader *reader, struct geometry_frame *out)
{
    const int dim = reader->dim;
    memset(out, 0, sizeof *out);
    if (reader->frames_left == 0)
        return false;
    const struct geometry_shape shape = geometry_shape(*reader->shape);
    const int count = (int) geometry_number_count(dim, *reader->shape, 0);
    if (count == 0 || reader->numbers_left < count ||
        (shape.by_vertices && !take_vertices(reader, count)))
        return false;
    out->shape = shape.shape;
    out->by_vertices = shape.by_vertices;
    for (int axis = 0; axis < dim; axis++)
        out->origin[axis] = cursor_double_at(reader->number + 8 * axis);
    for (int i = dim; i < count; i++)
        out->components[i - dim] = cursor_double_at(reader->number + 8 * i);
    reader->shape++;
    reader->frames_left--;
    reader->number += 8 * count;
    reader->numbers_left -= count;
    return true;
}
