/* Any bytes, read as a heartbeat: the checks of pair_query.c. The list of results may be shorter or
 * longer than this version writes; the reader takes missing numbers as 0 and drops further ones. */
#include "fuzz.h"
#include "layout.h"
#include "same.h"
#include "wire.h"

#include "fmb_msgs_status_t.h"

#include <stdlib.h>

static bool same_results(const struct wire_status *status, const fmb_msgs_status_t *message)
{
    bool same = true;
    for (int32_t s = 0; s < FMB_STATUS_COUNT; s++)
        same = same && status->results[s] == (s < message->num_results ? message->results[s] : 0);
    return same;
}

/* *whole: the version was not changed. */
static bool same_status(const struct wire_status *status, const fmb_msgs_status_t *message,
                        bool *whole)
{
    bool same = status->utime == message->utime && status->server_id == message->server_id &&
                same_text(status->version, sizeof status->version, message->version, whole);
#define X(name) same = same && status->name == message->name;
    WIRE_COUNTERS_BEFORE(X)
    WIRE_COUNTERS_AFTER(X)
#undef X
    return same && same_results(status, message);
}

/* Returns whether this version can have written the message. */
static bool check_decoder(const struct wire_status *status, const uint8_t *bytes, size_t size)
{
    fmb_msgs_status_t message;
    bool whole;
    FUZZ_CHECK(fmb_msgs_status_t_decode(bytes, 0, (int) size, &message) == (int) size);
    FUZZ_CHECK(same_status(status, &message, &whole));
    const bool ours = whole && message.num_results == FMB_STATUS_COUNT;
    SAME_ENCODED(fmb_msgs_status_t, message, bytes, size);
    return ours;
}

static void check_writer(const struct wire_status *status, bool ours, const uint8_t *bytes,
                         size_t size)
{
    unsigned char written[WIRE_STATUS_BYTES_MAX], again[WIRE_STATUS_BYTES_MAX];
    struct wire_status read;
    const size_t count = wire_write_status(status, written);
    if (ours)
        same_bytes(written, count, bytes, size);
    FUZZ_CHECK(!wire_read_status(written, (uint32_t) count, &read));
    same_bytes(again, wire_write_status(&read, again), written, count);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct wire_status status;
    uint8_t *bytes = fuzz_copy(data, size);
    const bool accepted = !wire_read_status(bytes, (uint32_t) size, &status);
    FUZZ_CHECK(accepted == layout_fits(LAYOUT_STATUS, __fmb_msgs_status_t_get_hash(), bytes, size));
    if (accepted)
        check_writer(&status, check_decoder(&status, bytes, size), bytes, size);
    free(bytes);
    return 0;
}
