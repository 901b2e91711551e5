/* Any bytes, read as a pair query: accepted if and only if an encoder can have written them; every
 * field is what lcm-gen's decoder reads; and written again they are the same bytes. */
#include "fuzz.h"
#include "layout.h"
#include "same.h"
#include "wire.h"

#include "fmb_msgs_pair_query_t.h"

#include <stdlib.h>

static bool same_query(const struct pair_query *query, const fmb_msgs_pair_query_t *message)
{
    return query->utime == message->utime && query->client_id == message->client_id &&
           query->sequence_number == message->sequence_number &&
           same_doubles(&query->duration, &message->duration, 1) &&
           query->method == message->method && query->want == message->want &&
           same_placement(&query->placement[0], &message->a) &&
           same_placement(&query->placement[1], &message->b);
}

static void check_decoder(const struct pair_query *query, const uint8_t *bytes, size_t size)
{
    fmb_msgs_pair_query_t message;
    FUZZ_CHECK(fmb_msgs_pair_query_t_decode(bytes, 0, (int) size, &message) == (int) size);
    FUZZ_CHECK(same_query(query, &message));
    SAME_ENCODED(fmb_msgs_pair_query_t, message, bytes, size);
}

static void check_writer(const struct pair_query *query, const uint8_t *bytes, size_t size)
{
    static unsigned char written[QUERY_BYTES_MAX];
    const struct query_placement *a = &query->placement[0], *b = &query->placement[1];
    if (size > QUERY_BYTES_MAX || !same_can_hold(a) || !same_can_hold(b))
        return;
    same_bytes(written, wire_write_pair_query(query, written), bytes, size);
    FUZZ_CHECK(WIRE_PAIR_QUERY_BYTES + wire_placement_bytes(a) + wire_placement_bytes(b) == size);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct pair_query query;
    const int64_t fingerprint = __fmb_msgs_pair_query_t_get_hash();
    uint8_t *bytes = fuzz_copy(data, size);
    const bool accepted = !wire_read_pair_query(bytes, (uint32_t) size, &query);
    FUZZ_CHECK(accepted == layout_fits(LAYOUT_PAIR_QUERY, fingerprint, bytes, size));
    same_header(wire_read_pair_header, fingerprint, bytes, size);
    if (accepted) {
        check_decoder(&query, bytes, size);
        check_writer(&query, bytes, size);
    }
    free(bytes);
    return 0;
}
