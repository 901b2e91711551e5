/* Any bytes, read as a definition query: the checks of pair_query.c; handles have 16 bytes each. */
#include "fuzz.h"
#include "layout.h"
#include "same.h"
#include "wire.h"

#include "fmb_msgs_definition_query_t.h"

#include <stdlib.h>

static bool same_query(const struct definition_query *query,
                       const fmb_msgs_definition_query_t *message)
{
    return query->utime == message->utime && query->client_id == message->client_id &&
           query->sequence_number == message->sequence_number && query->first == message->first &&
           same_handles(query->handle, query->handle_count, QUERY_HANDLES_MAX, message->handles,
                        message->num_handle_bytes);
}

static bool check_decoder(const struct definition_query *query, bool accepted, const uint8_t *bytes,
                          size_t size)
{
    fmb_msgs_definition_query_t message;
    if (!layout_fits(LAYOUT_DEFINITION_QUERY, __fmb_msgs_definition_query_t_get_hash(), bytes,
                     size))
        return false;
    FUZZ_CHECK(fmb_msgs_definition_query_t_decode(bytes, 0, (int) size, &message) == (int) size);
    const bool good = message.num_handle_bytes % HANDLE_BYTES == 0;
    FUZZ_CHECK(!accepted || same_query(query, &message));
    SAME_ENCODED(fmb_msgs_definition_query_t, message, bytes, size);
    return good;
}

static void check_writer(const struct definition_query *query, const uint8_t *bytes, size_t size)
{
    static unsigned char written[QUERY_BYTES_MAX];
    if (size <= QUERY_BYTES_MAX)
        same_bytes(written, wire_write_definition_query(query, written), bytes, size);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct definition_query query;
    uint8_t *bytes = fuzz_copy(data, size);
    const bool accepted = !wire_read_definition_query(bytes, (uint32_t) size, &query);
    FUZZ_CHECK(check_decoder(&query, accepted, bytes, size) == accepted);
    same_header(wire_read_definition_header, __fmb_msgs_definition_query_t_get_hash(), bytes, size);
    if (accepted)
        check_writer(&query, bytes, size);
    free(bytes);
    return 0;
}
