#include "query.h"

#include "cursor.h"
#include "writer.h"

size_t geometry_write(int dim, const struct geometry_frame *frame,
                      unsigned char out[GEOMETRY_FRAME_BYTES_MAX])
{
    const unsigned char shape = (unsigned char) frame->shape;
    const int numbers = fmb_component_count(dim, frame->shape) * dim;
    struct writer writer = {.at = out, .end = out + GEOMETRY_FRAME_BYTES_MAX};
    writer_int32(&writer, dim);
    writer_bytes(&writer, &shape, 1);
    writer_int32(&writer, dim + numbers);
    for (int axis = 0; axis < dim; axis++)
        writer_double(&writer, frame->origin[axis]);
    for (int i = 0; i < numbers; i++)
        writer_double(&writer, frame->components[i]);
    return writer_end(&writer, out);
}

void geometry_write_none(int dim, unsigned char out[GEOMETRY_NONE_BYTES])
{
    struct writer writer = {.at = out, .end = out + GEOMETRY_NONE_BYTES};
    writer_int32(&writer, dim);
    writer_int32(&writer, 0);
    writer_int32(&writer, 0);
}

/* Where the parts of a geometry stand. */
enum { DIM_AT = 0, FRAMES_AT = 4, SHAPES_AT = 8 };

int geometry_shape(const struct geometry *geometry)
{
    return big_endian_32(geometry->bytes + FRAMES_AT) > 0 ? geometry->bytes[SHAPES_AT] : 0;
}

bool geometry_read(const struct geometry *geometry, int *dim, struct geometry_frame *out)
{
    const unsigned char *bytes = geometry->bytes;
    const uint32_t frames = big_endian_32(bytes + FRAMES_AT);
    const unsigned char *numbers = bytes + SHAPES_AT + frames;
    *dim = (int) big_endian_32(bytes + DIM_AT);
    memset(out, 0, sizeof *out);
    out->shape = geometry_shape(geometry);
    out->count = fmb_component_count(*dim, out->shape);
    const uint32_t count = (uint32_t) (*dim * (1 + out->count));
    if (out->count == 0 || big_endian_32(numbers) < count)
        return false;
    numbers += 4;
    for (int axis = 0; axis < *dim; axis++)
        out->origin[axis] = cursor_double_at(numbers + 8 * axis);
    for (int i = 0; i < out->count * *dim; i++)
        out->components[i] = cursor_double_at(numbers + 8 * (*dim + i));
    return true;
}
