/* Any bytes, read as a pair query: what is accepted is just what encoders write; every field is
 * what lcm-gen's decoder says; and written again it is the same bytes. */
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
           same_frame(&query->frame[0], &message->a) && same_frame(&query->frame[1], &message->b);
}

static void check_header(const struct pair_query *query, const uint8_t *bytes, size_t size)
{
    struct query_header header;
    FUZZ_CHECK(!wire_read_pair_header(bytes, (uint32_t) size, &header));
    FUZZ_CHECK(header.utime == query->utime && header.client_id == query->client_id &&
               header.sequence_number == query->sequence_number);
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
    unsigned char written[WIRE_BYTES_MAX];
    if (same_can_hold(&query->frame[0]) && same_can_hold(&query->frame[1]))
        same_bytes(written, wire_write_pair_query(query, written), bytes, size);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct pair_query query;
    uint8_t *bytes = fuzz_copy(data, size);
    const char *error = wire_read_pair_query(bytes, (uint32_t) size, &query);
    FUZZ_CHECK(!error ==
               layout_fits(LAYOUT_PAIR_QUERY, __fmb_msgs_pair_query_t_get_hash(), bytes, size));
    if (!error) {
        check_header(&query, bytes, size);
        check_decoder(&query, bytes, size);
        check_writer(&query, bytes, size);
    }
    free(bytes);
    return 0;
}
