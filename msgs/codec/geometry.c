#include "query.h"

#include "cursor.h"
#include "writer.h"

/* Offsets in an encoded geometry, in bytes. */
enum { DIM_AT = 0, FRAMES_AT = 4, SHAPES_AT = 8 };

int geometry_number_count(int dim, int shape)
{
    const int components = fmb_component_count(dim, shape);
    const int count = shape == FMB_BOX ? components : dim * components;
    return count > 0 ? dim + count : 0;
}

/* ---- Writing ---- */

void geometry_write_none(int dim, unsigned char out[GEOMETRY_NONE_BYTES])
{
    struct writer writer = {.at = out, .end = out + GEOMETRY_NONE_BYTES};
    writer_int32(&writer, dim);
    writer_int32(&writer, 0);
    writer_int32(&writer, 0);
}

/* ---- Reading ---- */

struct geometry_reader geometry_begin(const struct geometry *geometry)
{
    const unsigned char *bytes = geometry->bytes;
    const uint32_t frames = big_endian_32(bytes + FRAMES_AT);
    const unsigned char *numbers = bytes + SHAPES_AT + frames;
    return (struct geometry_reader){.dim = (int) big_endian_32(bytes + DIM_AT),
                                    .frames_left = (int32_t) frames,
                                    .numbers_left = (int32_t) big_endian_32(numbers),
                                    .shape = bytes + SHAPES_AT,
                                    .number = numbers + 4};
}

bool geometry_next(struct geometry_reader *reader, struct geometry_frame *out)
{
    const int dim = reader->dim;
    memset(out, 0, sizeof *out);
    if (reader->frames_left == 0)
        return false;
    out->shape = *reader->shape;
    out->count = fmb_component_count(dim, out->shape);
    const int count = geometry_number_count(dim, out->shape);
    if (count == 0 || reader->numbers_left < count)
        return false;
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
