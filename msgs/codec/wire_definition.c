/* Definition queries and definitions. */
#include "wire.h"

#include "wire_placement.h"

#include "fmb_msgs_definition_query_t.h"
#include "fmb_msgs_definition_t.h"

const char *wire_read_definition_header(const void *bytes, uint32_t size, struct query_header *out)
{
    return wire_read_header(bytes, size, __fmb_msgs_definition_query_t_get_hash(), out);
}

const char *wire_read_definition_query(const void *bytes, uint32_t size,
                                       struct definition_query *out)
{
    struct cursor cursor = cursor_begin(bytes, size, __fmb_msgs_definition_query_t_get_hash());
    wire_read_ids(&cursor, &out->header);
    out->first = cursor_int64(&cursor);
    out->handle_count = wire_read_handles(&cursor, out->handle, QUERY_HANDLES_MAX);
    return cursor_end(&cursor);
}

size_t wire_write_definition_query(const struct definition_query *query,
                                   unsigned char out[QUERY_BYTES_MAX])
{
    struct writer writer =
        writer_begin(out, QUERY_BYTES_MAX, __fmb_msgs_definition_query_t_get_hash());
    wire_write_ids(&writer, &query->header);
    writer_int64(&writer, query->first);
    wire_write_handles(&writer, query->handle, query->handle_count);
    return writer_end(&writer, out);
}

/* A body without frames, or that does not match its handle, is an error. Its frames are not
 * checked. */
static void read_body(struct cursor *cursor, struct body_view *out)
{
    struct cursor local = *cursor;
    wire_read_body(&local, out);
    if (!local.error) {
        const struct handle handle = handle_of(out->bytes, out->size);
        if (out->frame_count == 0)
            cursor_fail(&local, "a body without frames");
        if (!handle_equal(&handle, &out->handle))
            cursor_fail(&local, "a body that does not match its handle");
    }
    *cursor = local;
}

const char *wire_read_definition(const void *bytes, uint32_t size, struct definition *out)
{
    struct cursor cursor = cursor_begin(bytes, size, __fmb_msgs_definition_t_get_hash());
    wire_read_ids(&cursor, &out->header);
    out->server_id = cursor_int64(&cursor);
    out->status = cursor_int32(&cursor);
    cursor_string(&cursor, out->detail, sizeof out->detail);
    out->next = cursor_int64(&cursor);
    out->body_count = cursor_count(&cursor, HANDLE_BYTES + GEOMETRY_NONE_BYTES);
    if (out->body_count > QUERY_BODIES_MAX)
        cursor_fail(&cursor, "more bodies than a message holds");
    if (out->body_count > 0 && out->status != FMB_OK)
        cursor_fail(&cursor, "bodies and status do not go together");
    for (int32_t i = 0; i < out->body_count && !cursor.error; i++)
        read_body(&cursor, &out->body[i]);
    return cursor_end(&cursor);
}

size_t wire_write_definition(const struct definition *definition,
                             unsigned char out[QUERY_BYTES_MAX])
{
    struct writer writer = writer_begin(out, QUERY_BYTES_MAX, __fmb_msgs_definition_t_get_hash());
    wire_write_ids(&writer, &definition->header);
    writer_int64(&writer, definition->server_id);
    writer_int32(&writer, definition->status);
    writer_string(&writer, definition->detail);
    writer_int64(&writer, definition->next);
    writer_int32(&writer, definition->body_count);
    for (int32_t i = 0; i < definition->body_count; i++)
        wire_write_body(&writer, &definition->body[i]);
    return writer_end(&writer, out);
}
