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

void wire_read_geometry(struct cursor *cursor, struct placement *out)
{
    const unsigned char *begin = cursor->at, *list;
    out->dim = cursor_int32(cursor);
    out->frame_count = cursor_list(cursor, 1, &list);
    out->count_count = cursor_list(cursor, 4, &list);
    out->number_count = cursor_list(cursor, 8, &list);
    out->geometry = (struct geometry){begin, (size_t) (cursor->at - begin)};
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

void wire_read_placement(struct cursor *cursor, struct placement *out)
{
    struct cursor local = *cursor;
    out->body_id = cursor_int64(&local);
    wire_read_handle(&local, &out->handle);
    wire_read_geometry(&local, out);
    if (out->dim < 0)
        cursor_fail(&local, "negative count");
    out->name = cursor_take_string(&local);
    out->group = cursor_int64(&local);
    read_numbers(&local, out->dim, out->position, FMB_DIM_MAX);
    out->orientation_count = cursor_count(&local, 8);
    read_numbers(&local, out->orientation_count, out->orientation, QUERY_ORIENTATION_MAX);
    out->velocity_count = cursor_count(&local, 8);
    read_numbers(&local, out->velocity_count, out->velocity, FMB_DIM_MAX);
    *cursor = local;
}

void wire_write_placement(struct writer *writer, const struct placement *placement)
{
    const struct geometry *geometry = &placement->geometry;
    writer_int64(writer, placement->body_id);
    wire_write_handle(writer, &placement->handle);
    memcpy(writer_take(writer, geometry->size), geometry->bytes, geometry->size);
    wire_write_text(writer, placement->name);
    writer_int64(writer, placement->group);
    for (int axis = 0; axis < placement->dim; axis++)
        writer_double(writer, placement->position[axis]);
    writer_doubles(writer, placement->orientation, placement->orientation_count);
    writer_doubles(writer, placement->velocity, placement->velocity_count);
}

size_t wire_placement_bytes(const struct placement *placement)
{
    const size_t numbers =
        (size_t) (placement->dim + placement->orientation_count + placement->velocity_count);
    return 8 + HANDLE_BYTES + placement->geometry.size + 4 + wire_text_bytes(placement->name) + 1 +
           8 + 4 + 4 + sizeof(double) * numbers;
}
