#include "geometry_write.h"

#include "writer.h"

static int numbers_of(int dim, const struct geometry_frame *frames, int count)
{
    int numbers = 0;
    for (int i = 0; i < count; i++)
        numbers += (int) geometry_number_count(dim, frames[i].shape, 0);
    return numbers;
}

static int counts_of(const struct geometry_frame *frames, int count)
{
    int counts = 0;
    for (int i = 0; i < count; i++)
        counts += frames[i].by_vertices;
    return counts;
}

size_t geometry_size(int dim, const struct geometry_frame *frames, int count)
{
    return GEOMETRY_NONE_BYTES + (size_t) count + 4 * (size_t) counts_of(frames, count) +
           sizeof(double) * (size_t) numbers_of(dim, frames, count);
}

size_t geometry_write_frames(int dim, const struct geometry_frame *frames, int count,
                             unsigned char *out)
{
    struct writer writer = {.at = out, .end = out + geometry_size(dim, frames, count)};
    writer_int32(&writer, dim);
    writer_int32(&writer, count);
    for (int i = 0; i < count; i++)
        *writer_take(&writer, 1) =
            (unsigned char) geometry_code(frames[i].shape, frames[i].by_vertices);
    writer_int32(&writer, counts_of(frames, count));
    for (int i = 0; i < count; i++)
        if (frames[i].by_vertices)
            writer_int32(&writer, (int32_t) numbers_of(dim, &frames[i], 1) / dim);
    writer_int32(&writer, numbers_of(dim, frames, count));
    for (int i = 0; i < count; i++) {
        double number[FMB_FRAME_NUMBERS_MAX];
        const size_t numbers = geometry_frame_numbers(dim, &frames[i], number);
        for (size_t k = 0; k < numbers; k++)
            writer_double(&writer, number[k]);
    }
    return writer_end(&writer, out);
}

size_t geometry_write(int dim, const struct geometry_frame *frame,
                      unsigned char out[GEOMETRY_FRAME_BYTES_MAX])
{
    return geometry_write_frames(dim, frame, 1, out);
}
