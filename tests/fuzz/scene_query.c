/* Any bytes, read as a scene query: the checks of pair_query.c. Of more placements or pairs than
 * the struct holds, the first are kept. */
#include "fuzz.h"
#include "layout.h"
#include "same.h"
#include "wire.h"

#include "fmb_msgs_scene_query_t.h"

#include <stdlib.h>
#include <string.h>

static int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static bool same_placements(const struct scene_query *query, const fmb_msgs_scene_query_t *message)
{
    bool same = query->placement_count == message->num_placements;
    for (int32_t i = 0; i < least(message->num_placements, QUERY_PLACEMENTS_MAX) && same; i++)
        same = same_placement(&query->placement[i], &message->placements[i]);
    return same;
}

/* pair: [pair][a, b]; indices: of the message, two a pair. */
static bool same_pairs(const unsigned (*pair)[2], const int16_t *indices, int32_t count)
{
    bool same = true;
    for (int32_t i = 0; i < least(count, 2 * QUERY_PAIRS_MAX) && same; i++)
        same = (int) pair[i / 2][i % 2] == indices[i];
    return same;
}

static bool same_query(const struct scene_query *query, const fmb_msgs_scene_query_t *message)
{
    return query->utime == message->utime && query->client_id == message->client_id &&
           query->sequence_number == message->sequence_number &&
           strcmp(query->label, message->label) == 0 &&
           same_doubles(&query->duration, &message->duration, 1) &&
           query->method == message->method && query->want == message->want &&
           same_doubles(&query->margin, &message->margin, 1) && query->which == message->which &&
           query->split == message->split && query->first_pair == message->first_pair &&
           same_placements(query, message) && query->index_count == message->num_indices &&
           query->ignored_count == message->num_ignored &&
           same_pairs((const unsigned(*)[2]) query->pair, message->indices, message->num_indices) &&
           same_pairs((const unsigned(*)[2]) query->ignored, message->ignored,
                      message->num_ignored);
}

static void check_decoder(const struct scene_query *query, const uint8_t *bytes, size_t size)
{
    fmb_msgs_scene_query_t message;
    FUZZ_CHECK(fmb_msgs_scene_query_t_decode(bytes, 0, (int) size, &message) == (int) size);
    FUZZ_CHECK(same_query(query, &message));
    SAME_ENCODED(fmb_msgs_scene_query_t, message, bytes, size);
}

/* Whether a client can write it: one datagram, all of it in the struct, pairs of two indices. */
static bool can_write(const struct scene_query *query, size_t size)
{
    bool can = size <= QUERY_BYTES_MAX && query->placement_count <= QUERY_PLACEMENTS_MAX &&
               query->index_count % 2 == 0 && query->ignored_count % 2 == 0;
    for (int32_t i = 0; can && i < query->placement_count; i++)
        can = same_can_hold(&query->placement[i]);
    return can;
}

static void check_writer(const struct scene_query *query, const uint8_t *bytes, size_t size)
{
    static unsigned char written[QUERY_BYTES_MAX];
    const int32_t pairs = (query->index_count + query->ignored_count) / 2;
    if (!can_write(query, size))
        return;
    same_bytes(written, wire_write_scene_query(query, written), bytes, size);
    size_t counted =
        WIRE_SCENE_QUERY_BYTES + wire_text_bytes(query->label) + (size_t) pairs * WIRE_PAIR_BYTES;
    for (int32_t i = 0; i < query->placement_count; i++)
        counted += wire_placement_bytes(&query->placement[i]);
    FUZZ_CHECK(counted == size);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct scene_query query;
    const int64_t fingerprint = __fmb_msgs_scene_query_t_get_hash();
    uint8_t *bytes = fuzz_copy(data, size);
    const bool accepted = !wire_read_scene_query(bytes, (uint32_t) size, &query);
    FUZZ_CHECK(accepted == layout_fits(LAYOUT_SCENE_QUERY, fingerprint, bytes, size));
    same_header(wire_read_scene_header, fingerprint, bytes, size);
    if (accepted) {
        check_decoder(&query, bytes, size);
        check_writer(&query, bytes, size);
    }
    free(bytes);
    return 0;
}
