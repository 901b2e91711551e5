/* Heartbeats. */
#include "wire.h"

#include "cursor.h"
#include "writer.h"

#include "fmb_msgs_status_t.h"

#include <assert.h>
#include <stddef.h>

/* Most counters of a heartbeat that is read, which bounds the time to find their names. */
enum { COUNTERS_MAX = 256 };

static const struct {
    const char *name;
    size_t at;
} counters[] = {
#define X(name) {#name, offsetof(struct wire_status, name)},
    FMB_COUNTERS(X)
#undef X
#define X(name, number, text) {"result_" #name, offsetof(struct wire_status, results[number])},
        FMB_STATUS_MAP(X)
#undef X
};

static_assert(sizeof counters / sizeof *counters == WIRE_COUNTERS, "a counter without a name");

const char *wire_status_counter(const struct wire_status *status, int i, int64_t *value)
{
    memcpy(value, (const char *) status + counters[i].at, sizeof *value);
    return counters[i].name;
}

/* Sets the counter of this name, if there is one. */
static void set_counter(struct wire_status *status, const char *name, int64_t value)
{
    for (int i = 0; i < WIRE_COUNTERS; i++)
        if (strcmp(counters[i].name, name) == 0)
            memcpy((char *) status + counters[i].at, &value, sizeof value);
}

const char *wire_read_status(const void *bytes, uint32_t size, struct wire_status *out)
{
    struct cursor cursor = cursor_begin(bytes, size, __fmb_msgs_status_t_get_hash());
    *out = (struct wire_status){.utime = cursor_int64(&cursor)};
    out->server_id = cursor_int64(&cursor);
    cursor_string(&cursor, out->version, sizeof out->version);
    const int32_t count = cursor_count(&cursor, 4 + 1 + 8);
    if (count > COUNTERS_MAX)
        cursor_fail(&cursor, "more counters than a heartbeat has");
    struct cursor names = cursor;
    for (int32_t i = 0; i < count && !cursor.error; i++)
        cursor_take_string(&cursor);
    for (int32_t i = 0; i < count && !cursor.error; i++)
        set_counter(out, cursor_take_string(&names), cursor_int64(&cursor));
    return cursor_end(&cursor);
}

size_t wire_write_status(const struct wire_status *status, unsigned char out[WIRE_STATUS_BYTES_MAX])
{
    struct writer writer = writer_begin(out, WIRE_STATUS_BYTES_MAX, __fmb_msgs_status_t_get_hash());
    writer_int64(&writer, status->utime);
    writer_int64(&writer, status->server_id);
    writer_string(&writer, status->version);
    writer_int32(&writer, WIRE_COUNTERS);
    for (int i = 0; i < WIRE_COUNTERS; i++)
        writer_string(&writer, counters[i].name);
    for (int i = 0; i < WIRE_COUNTERS; i++) {
        int64_t value;
        wire_status_counter(status, i, &value);
        writer_int64(&writer, value);
    }
    return writer_end(&writer, out);
}
