#include "geometry_write.h"

#include "writer.h"

size_t geometry_frame_numbers(int dim, const struct plain_frame *frame,
                              double out[FMB_FRAME_NUMBERS_MAX])
{
    const int count = (int) geometry_number_count(dim, frame->shape, 0);
    for (int i = 0; i < count; i++)
        out[i] = i < dim ? frame->origin[i] : frame->components[i - dim];
    return (size_t) count;
}

bool geometry_read(struct geometry_reader *reader, struct plain_frame *out)
{
    const size_t dim = (size_t) reader->dim;
    double number[FMB_FRAME_NUMBERS_MAX];
    struct geometry_frame frame;
    if (!geometry_next(reader, &frame) || frame.count > FMB_FRAME_NUMBERS_MAX)
        return false;
    geometry_numbers(&frame, number);
    *out = (struct plain_frame){.shape = frame.shape,
                                .by_vertices = frame.by_vertices,
                                .has_radius = frame.radius != 0,
                                .radius = frame.radius};
    memcpy(out->origin, number, dim * sizeof *number);
    memcpy(out->components, number + dim, (frame.count - dim) * sizeof *number);
    return true;
}

static struct body_view view_of(int dim, const struct plain_frame *frames, int count)
{
    struct body_view out = {.dim = dim, .frame_count = count};
    for (int i = 0; i < count; i++) {
        out.number_count +=
            (int32_t) geometry_number_count(dim, frames[i].shape, 0) + frames[i].has_radius;
        out.count_count += frames[i].by_vertices;
    }
    out.size = GEOMETRY_NONE_BYTES + (size_t) count + 4 * (size_t) out.count_count +
               sizeof(double) * (size_t) out.number_count;
    return out;
}

size_t geometry_size(int dim, const struct plain_frame *frames, int count)
{
    return view_of(dim, frames, count).size;
}

struct body_view geometry_write_frames(int dim, const struct plain_frame *frames, int count,
                                       unsigned char *out)
{
    struct body_view body = view_of(dim, frames, count);
    struct writer writer = {.at = out, .end = out + body.size};
    body.bytes = out;
    writer_int32(&writer, dim);
    writer_int32(&writer, count);
    for (int i = 0; i < count; i++)
        *writer_take(&writer, 1) = (unsigned char) geometry_code(
            (struct geometry_shape){frames[i].shape, frames[i].by_vertices, frames[i].has_radius});
    writer_int32(&writer, body.count_count);
    for (int i = 0; i < count; i++)
        if (frames[i].by_vertices)
            writer_int32(&writer, (int32_t) geometry_number_count(dim, frames[i].shape, 0) / dim);
    writer_int32(&writer, body.number_count);
    for (int i = 0; i < count; i++) {
        double number[FMB_FRAME_NUMBERS_MAX];
        const size_t numbers = geometry_frame_numbers(dim, &frames[i], number);
        if (frames[i].has_radius)
            writer_double(&writer, frames[i].radius);
        for (size_t k = 0; k < numbers; k++)
            writer_double(&writer, number[k]);
    }
    return body;
}

struct body_view geometry_write(int dim, const struct plain_frame *frame,
                                unsigned char out[GEOMETRY_FRAME_BYTES_MAX])
{
    return geometry_write_frames(dim, frame, 1, out);
}

struct body_view geometry_write_hull(int dim, const double *vertices, int count, unsigned char *out)
{
    const int numbers = dim * count;
    struct writer writer = {.at = out,
                            .end = out + GEOMETRY_NONE_BYTES + 1 + 4 + 8 * (size_t) numbers};
    writer_int32(&writer, dim);
    writer_int32(&writer, 1);
    *writer_take(&writer, 1) = FMB_HULL;
    writer_int32(&writer, 1);
    writer_int32(&writer, count);
    writer_doubles(&writer, vertices, numbers);
    return (struct body_view){.dim = dim,
                              .frame_count = 1,
                              .count_count = 1,
                              .number_count = numbers,
                              .bytes = out,
                              .size = writer_end(&writer, out)};
}
