/* Header, handles, geometry and placement, which several message types share. */
#include "wire_placement.h"

#include <string.h>

const char *wire_read_header(const void *bytes, uint32_t size, int64_t fingerprint,
                             struct query_header *out)
{
    struct cursor cursor = cursor_begin(bytes, size, fingerprint);
    wire_read_ids(&cursor, out);
    return cursor.error;
}

void wire_read_handle(struct cursor *cursor, struct handle *out)
{
    const unsigned char *bytes = cursor_take(cursor, HANDLE_BYTES);
    if (bytes)
        memcpy(out->bytes, bytes, HANDLE_BYTES);
    else
        memset(out, 0, sizeof *out);
}

void wire_write_handle(struct writer *writer, const struct handle *handle)
{
    memcpy(writer_take(writer, HANDLE_BYTES), handle->bytes, HANDLE_BYTES);
}

int32_t wire_read_handles(struct cursor *cursor, struct handle *out, int max)
{
    const unsigned char *bytes;
    const int32_t size = cursor_list(cursor, 1, &bytes), count = size / HANDLE_BYTES;
    if (size % HANDLE_BYTES != 0)
        cursor_fail(cursor, "handles of other than 16 bytes");
    else if (count > 0)
        memcpy(out, bytes, HANDLE_BYTES * (size_t) (count < max ? count : max));
    return count;
}

void wire_write_handles(struct writer *writer, const struct handle *handles, int32_t count)
{
    const size_t size = HANDLE_BYTES * (size_t) count;
    writer_int32(writer, (int32_t) size);
    if (count > 0)
        memcpy(writer_take(writer, size), handles, size);
}

void wire_read_body(struct cursor *cursor, struct body_view *out)
{
    const unsigned char *list;
    wire_read_handle(cursor, &out->handle);
    out->bytes = cursor->at;
    out->dim = cursor_int32(cursor);
    out->frame_count = cursor_list(cursor, 1, &list);
    out->count_count = cursor_list(cursor, 4, &list);
    out->number_count = cursor_list(cursor, 8, &list);
    out->size = (size_t) (cursor->at - out->bytes);
}

void wire_write_body(struct writer *writer, const struct body_view *body)
{
    wire_write_handle(writer, &body->handle);
    memcpy(writer_take(writer, body->size), body->bytes, body->size);
}

/* Reads count numbers. The first max are stored; if there are fewer, the remainder of out is 0. */
static void read_numbers(struct cursor *cursor, int32_t count, double *out, int max)
{
    const unsigned char *bytes = count > 0 ? cursor_take(cursor, 8 * (uint64_t) count) : NULL;
    if (!bytes) {
        memset(out, 0, (size_t) max * sizeof *out);
        return;
    }
    for (int i = 0; i < max; i++)
        out[i] = i < count ? cursor_double_at(bytes + 8 * i) : 0;
}

/* The position, as many numbers as the body has dimensions, then the orientation. */
static void read_end(struct cursor *cursor, struct query_placement *out)
{
    struct fmb_placement *placed = &out->placed;
    const int32_t count = cursor_count(cursor, 8), dim = out->body.dim > 0 ? out->body.dim : 0;
    const int32_t turned = count > dim ? count - dim : 0;
    placed->end_count = count;
    read_numbers(cursor, count - turned, placed->end_position, FMB_DIM_MAX);
    read_numbers(cursor, turned, placed->end_orientation, QUERY_ORIENTATION_MAX);
}

void wire_read_placement(struct cursor *cursor, struct query_placement *out)
{
    struct cursor local = *cursor;
    struct fmb_placement *placed = &out->placed;
    placed->body = NULL;
    placed->id = cursor_int64(&local);
    wire_read_body(&local, &out->body);
    if (out->body.dim < 0)
        cursor_fail(&local, "negative count");
    placed->name = cursor_take_string(&local);
    placed->group = cursor_int64(&local);
    read_numbers(&local, out->body.dim, placed->position, FMB_DIM_MAX);
    placed->orientation_count = cursor_count(&local, 8);
    read_numbers(&local, placed->orientation_count, placed->orientation, QUERY_ORIENTATION_MAX);
    out->velocity_count = cursor_count(&local, 8);
    read_numbers(&local, out->velocity_count, placed->velocity, FMB_DIM_MAX);
    read_end(&local, out);
    *cursor = local;
}

void wire_write_placement(struct writer *writer, const struct query_placement *placement)
{
    const struct fmb_placement *placed = &placement->placed;
    writer_int64(writer, placed->id);
    wire_write_body(writer, &placement->body);
    wire_write_text(writer, placed->name);
    writer_int64(writer, placed->group);
    for (int axis = 0; axis < placement->body.dim; axis++)
        writer_double(writer, placed->position[axis]);
    writer_doubles(writer, placed->orientation, placed->orientation_count);
    writer_doubles(writer, placed->velocity, placement->velocity_count);
    writer_int32(writer, placed->end_count);
    for (int i = 0; i < placed->end_count; i++)
        writer_double(writer, i < placement->body.dim
                                  ? placed->end_position[i]
                                  : placed->end_orientation[i - placement->body.dim]);
}

size_t wire_placement_bytes(const struct query_placement *placement)
{
    const size_t numbers = (size_t) (placement->body.dim + placement->placed.orientation_count +
                                     placement->velocity_count + placement->placed.end_count);
    return 8 + HANDLE_BYTES + placement->body.size + 4 + wire_text_bytes(placement->placed.name) +
           1 + 8 + 3 * 4 + sizeof(double) * numbers;
}
