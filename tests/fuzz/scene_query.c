/* Any bytes, read as a scene query: as pair_query.c has it of pairs. */
#include "fuzz.h"
#include "layout.h"
#include "same.h"
#include "wire.h"

#include "fmb_msgs_scene_query_t.h"

#include <stdlib.h>

static int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static bool same_frames(const struct scene_query *query, const fmb_msgs_scene_query_t *message)
{
    bool same = query->frame_count == message->num_frames;
    for (int32_t i = 0; i < least(message->num_frames, QUERY_FRAMES_MAX) && same; i++)
        same = same_frame(&query->frame[i], &message->frames[i]);
    return same;
}

static bool same_indices(const struct scene_query *query, const fmb_msgs_scene_query_t *message)
{
    bool same = query->index_count == message->num_indices;
    for (int32_t i = 0; i < least(message->num_indices, 2 * QUERY_PAIRS_MAX) && same; i++)
        same = (int) query->pair[i / 2][i % 2] == message->indices[i];
    return same;
}

static bool same_query(const struct scene_query *query, const fmb_msgs_scene_query_t *message)
{
    return query->utime == message->utime && query->client_id == message->client_id &&
           query->sequence_number == message->sequence_number &&
           same_doubles(&query->duration, &message->duration, 1) &&
           query->method == message->method && query->want == message->want &&
           query->which == message->which && query->split == message->split &&
           query->first_pair == message->first_pair && same_frames(query, message) &&
           same_indices(query, message);
}

static void check_header(const struct scene_query *query, const uint8_t *bytes, size_t size)
{
    struct query_header header;
    FUZZ_CHECK(!wire_read_scene_header(bytes, (uint32_t) size, &header));
    FUZZ_CHECK(header.utime == query->utime && header.client_id == query->client_id &&
               header.sequence_number == query->sequence_number);
}

static void check_decoder(const struct scene_query *query, const uint8_t *bytes, size_t size)
{
    fmb_msgs_scene_query_t message;
    FUZZ_CHECK(fmb_msgs_scene_query_t_decode(bytes, 0, (int) size, &message) == (int) size);
    FUZZ_CHECK(same_query(query, &message));
    SAME_ENCODED(fmb_msgs_scene_query_t, message, bytes, size);
}

/* Whether it is one that clients may write: one datagram, all of it in the struct, pairs whole. */
static bool can_write(const struct scene_query *query, size_t size)
{
    bool can = size <= QUERY_BYTES_MAX && query->frame_count <= QUERY_FRAMES_MAX &&
               query->index_count <= 2 * QUERY_PAIRS_MAX && query->index_count % 2 == 0;
    for (int32_t i = 0; can && i < query->frame_count; i++)
        can = same_can_hold(&query->frame[i]);
    return can;
}

static void check_writer(const struct scene_query *query, const uint8_t *bytes, size_t size)
{
    static unsigned char written[QUERY_BYTES_MAX];
    if (!can_write(query, size))
        return;
    same_bytes(written, wire_write_scene_query(query, written), bytes, size);
    size_t counted = WIRE_SCENE_QUERY_BYTES + (size_t) (query->index_count / 2) * WIRE_PAIR_BYTES;
    for (int32_t i = 0; i < query->frame_count; i++)
        counted += wire_frame_bytes(&query->frame[i]);
    FUZZ_CHECK(counted == size);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct scene_query query;
    uint8_t *bytes = fuzz_copy(data, size);
    const char *error = wire_read_scene_query(bytes, (uint32_t) size, &query);
    FUZZ_CHECK(!error ==
               layout_fits(LAYOUT_SCENE_QUERY, __fmb_msgs_scene_query_t_get_hash(), bytes, size));
    if (!error) {
        check_header(&query, bytes, size);
        check_decoder(&query, bytes, size);
        check_writer(&query, bytes, size);
    }
    free(bytes);
    return 0;
}
