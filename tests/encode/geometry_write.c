#include "geometry_write.h"

#include "writer.h"

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
        for (int k = 0; k < geometry_number_count(dim, frames[i].shape) - dim; k++)
            writer_double(&writer, frames[i].components[k]);
    }
    return writer_end(&writer, out);
}

size_t geometry_write(int dim, const struct geometry_frame *frame,
                      unsigned char out[GEOMETRY_FRAME_BYTES_MAX])
{
    return geometry_write_frames(dim, frame, 1, out);
}
