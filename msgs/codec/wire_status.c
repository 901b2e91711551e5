#include "wire.h"

#include "cursor.h"
#include "writer.h"

#include "fmb_msgs_status_t.h"

const char *wire_read_status(const void *bytes, uint32_t size, struct wire_status *out)
{
    struct cursor cursor = cursor_begin(bytes, size, __fmb_msgs_status_t_get_hash());
    *out = (struct wire_status){.utime = cursor_int64(&cursor)};
    out->server_id = cursor_int64(&cursor);
    cursor_string(&cursor, out->version, sizeof out->version);
#define X(name) out->name = cursor_int64(&cursor);
    WIRE_COUNTERS_BEFORE(X)
    cursor_int64s(&cursor, out->results, FMB_STATUS_COUNT);
    WIRE_COUNTERS_AFTER(X)
#undef X
    return cursor_end(&cursor);
}

size_t wire_write_status(const struct wire_status *status, unsigned char out[WIRE_STATUS_BYTES_MAX])
{
    struct writer writer = writer_begin(out, WIRE_STATUS_BYTES_MAX, __fmb_msgs_status_t_get_hash());
    writer_int64(&writer, status->utime);
    writer_int64(&writer, status->server_id);
    writer_string(&writer, status->version);
#define X(name) writer_int64(&writer, status->name);
    WIRE_COUNTERS_BEFORE(X)
    writer_int64s(&writer, status->results, FMB_STATUS_COUNT);
    WIRE_COUNTERS_AFTER(X)
#undef X
    return writer_end(&writer, out);
}
