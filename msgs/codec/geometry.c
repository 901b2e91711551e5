#include "query.h"

#include "cursor.h"
#include "writer.h"

/* Offsets in an encoded geometry, in bytes. */
enum { DIM_AT = 0, FRAMES_AT = 4, SHAPES_AT = 8 };

/* Numbers after the origin. */
static int number_count_without_origin(int dim, int shape)
{
    const int components = fmb_component_count(dim, shape);
    return shape == FMB_BOX ? components : dim * components;
}

int geometry_number_count(int dim, int shape)
{
    const int count = number_count_without_origin(dim, shape);
    return count > 0 ? dim + count : 0;
}

/* ---- Writing ---- */

static int numbers_of(int dim, const struct geometry_frame *frames, int count)
{
    int numbers = 0;
    for (int i = 0; i < count; i++)
        numbers += geometry_number_count(dim, frames[i].shape);
    return numbers;
}

size_t geometry_size(int dim, const struct geometry_frame *frames, int count)
{
    return GEOMETRY_NONE_BYTES + (size_t) count +
           sizeof(double) * (size_t) numbers_of(dim, frames, count);
}

size_t geometry_write_frames(int dim, const struct geometry_frame *frames, int count,
                             unsigned char *out)
{
    struct writer writer = {.at = out, .end = out + geometry_size(dim, frames, count)};
    writer_int32(&writer, dim);
    writer_int32(&writer, count);
    for (int i = 0; i < count; i++)
        *writer_take(&writer, 1) = (unsigned char) frames[i].shape;
    writer_int32(&writer, numbers_of(dim, frames, count));
    for (int i = 0; i < count; i++) {
        for (int axis = 0; axis < dim; axis++)
            writer_double(&writer, frames[i].origin[axis]);
        for (int k = 0; k < number_count_without_origin(dim, frames[i].shape); k++)
            writer_double(&writer, frames[i].components[k]);
    }
    return writer_end(&writer, out);
}

size_t geometry_write(int dim, const struct geometry_frame *frame,
                      unsigned char out[GEOMETRY_FRAME_BYTES_MAX])
{
    return geometry_write_frames(dim, frame, 1, out);
}

void geometry_write_none(int dim, unsigned char out[GEOMETRY_NONE_BYTES])
{
    geometry_write_frames(dim, NULL, 0, out);
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
