/* Any bytes, read as a heartbeat: the checks of pair_query.c. Counters may be in any order, missing
 * or unknown; the reader takes missing ones as 0, and of repeated ones the last. */
#include "fuzz.h"
#include "layout.h"
#include "same.h"
#include "wire.h"

#include "fmb_msgs_status_t.h"

#include <stdlib.h>
#include <string.h>

enum { COUNTERS_MAX = 256 };

static int64_t counter_of(const fmb_msgs_status_t *message, const char *name)
{
    int64_t value = 0;
    for (int32_t i = 0; i < message->num_counters; i++)
        value = strcmp(message->names[i], name) == 0 ? message->values[i] : value;
    return value;
}

/* *whole: the version was not changed. */
static bool same_status(const struct wire_status *status, const fmb_msgs_status_t *message,
                        bool *whole)
{
    bool same = status->utime == message->utime && status->server_id == message->server_id &&
                same_text(status->version, sizeof status->version, message->version, whole);
#define X(name) same = same && status->name == counter_of(message, #name);
    FMB_COUNTERS(X)
#undef X
#define X(name, number, text) \
    same = same && status->results[number] == counter_of(message, "result_" #name);
    FMB_STATUS_MAP(X)
#undef X
    return same;
}

/* What the reader should have returned. */
static bool check_decoder(const struct wire_status *status, bool accepted, const uint8_t *bytes,
                          size_t size)
{
    fmb_msgs_status_t message;
    bool whole;
    if (!layout_fits(LAYOUT_STATUS, __fmb_msgs_status_t_get_hash(), bytes, size))
        return false;
    FUZZ_CHECK(fmb_msgs_status_t_decode(bytes, 0, (int) size, &message) == (int) size);
    const bool good = message.num_counters <= COUNTERS_MAX;
    FUZZ_CHECK(!accepted || same_status(status, &message, &whole));
    SAME_ENCODED(fmb_msgs_status_t, message, bytes, size);
    return good;
}

static void check_writer(const struct wire_status *status)
{
    unsigned char written[WIRE_STATUS_BYTES_MAX], again[WIRE_STATUS_BYTES_MAX];
    struct wire_status read;
    const size_t count = wire_write_status(status, written);
    FUZZ_CHECK(!wire_read_status(written, (uint32_t) count, &read));
    same_bytes(again, wire_write_status(&read, again), written, count);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct wire_status status;
    uint8_t *bytes = fuzz_copy(data, size);
    const bool accepted = !wire_read_status(bytes, (uint32_t) size, &status);
    FUZZ_CHECK(check_decoder(&status, accepted, bytes, size) == accepted);
    if (accepted)
        check_writer(&status);
    free(bytes);
    return 0;
}
