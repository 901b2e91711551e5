/* Any bytes, read as a heartbeat: as pair_query.c has it of pairs; but of long lists the first
 * numbers are kept and of missing ones 0, so that what is written may be another message, which
 * says the same. */
#include "fuzz.h"
#include "layout.h"
#include "same.h"
#include "wire.h"

#include "fmb_msgs_status_t.h"

#include <stdlib.h>

/* What list i of count numbers says; what it does not say is 0. */
static int64_t said(const int64_t *list, int32_t count, int32_t i)
{
    return i < count ? list[i] : 0;
}

static bool same_lists(const struct wire_status *status, const fmb_msgs_status_t *message)
{
    bool same = true;
    int32_t i = 0;
    for (int32_t s = 0; s < FMB_STATUS_COUNT; s++)
        same = same && status->results[s] == said(message->results, message->num_results, s);
#define X(name) same = same && status->name == said(message->more, message->num_more, i++);
    WIRE_COUNTERS_MORE(X)
#undef X
    return same;
}

static bool same_status(const struct wire_status *status, const fmb_msgs_status_t *message)
{
    bool whole, same = status->utime == message->utime && status->server_id == message->server_id &&
                       same_text(status->version, sizeof status->version, message->version, &whole);
#define X(name) same = same && status->name == message->name;
    WIRE_COUNTERS_BEFORE(X)
    WIRE_COUNTERS_AFTER(X)
#undef X
    return same && same_lists(status, message);
}

/* Whether the message has just what this version writes. */
static bool is_ours(const struct wire_status *status, const fmb_msgs_status_t *message)
{
    int32_t more = 0;
    bool whole;
    same_text(status->version, sizeof status->version, message->version, &whole);
#define X(name) more++;
    WIRE_COUNTERS_MORE(X)
#undef X
    return whole && message->num_results == FMB_STATUS_COUNT && message->num_more == more;
}

static bool check_decoder(const struct wire_status *status, const uint8_t *bytes, size_t size)
{
    fmb_msgs_status_t message;
    FUZZ_CHECK(fmb_msgs_status_t_decode(bytes, 0, (int) size, &message) == (int) size);
    FUZZ_CHECK(same_status(status, &message));
    const bool ours = is_ours(status, &message);
    SAME_ENCODED(fmb_msgs_status_t, message, bytes, size);
    return ours;
}

static void check_writer(const struct wire_status *status, bool ours, const uint8_t *bytes,
                         size_t size)
{
    unsigned char written[WIRE_BYTES_MAX], again[WIRE_BYTES_MAX];
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
    const char *error = wire_read_status(bytes, (uint32_t) size, &status);
    FUZZ_CHECK(!error == layout_fits(LAYOUT_STATUS, __fmb_msgs_status_t_get_hash(), bytes, size));
    if (!error)
        check_writer(&status, check_decoder(&status, bytes, size), bytes, size);
    free(bytes);
    return 0;
}
