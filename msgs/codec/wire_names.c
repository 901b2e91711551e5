/* Names of bodies. */
#include "wire.h"

#include "cursor.h"
#include "wire_placement.h"
#include "writer.h"

#include "fmb_msgs_names_t.h"

const char *wire_read_names(const void *bytes, uint32_t size, struct names *out)
{
    struct cursor cursor = cursor_begin(bytes, size, __fmb_msgs_names_t_get_hash());
    out->utime = cursor_int64(&cursor);
    out->count = cursor_count(&cursor, 8 + 8 + 4 + 1);
    if (out->count > QUERY_NAMES_MAX)
        cursor_fail(&cursor, "more names than a message holds");
    for (int32_t i = 0; i < out->count && !cursor.error; i++)
        out->client_id[i] = cursor_int64(&cursor);
    for (int32_t i = 0; i < out->count && !cursor.error; i++)
        out->body_id[i] = cursor_int64(&cursor);
    for (int32_t i = 0; i < out->count && !cursor.error; i++)
        out->name[i] = cursor_take_string(&cursor);
    return cursor_end(&cursor);
}

size_t wire_write_names(const struct names *names, unsigned char out[QUERY_BYTES_MAX])
{
    struct writer writer = writer_begin(out, QUERY_BYTES_MAX, __fmb_msgs_names_t_get_hash());
    writer_int64(&writer, names->utime);
    writer_int32(&writer, names->count);
    for (int32_t i = 0; i < names->count; i++)
        writer_int64(&writer, names->client_id[i]);
    for (int32_t i = 0; i < names->count; i++)
        writer_int64(&writer, names->body_id[i]);
    for (int32_t i = 0; i < names->count; i++)
        wire_write_text(&writer, names->name[i]);
    return writer_end(&writer, out);
}
