#include "record_tally.h"

#include "log_write.h"
#include "wire.h"

/* Queries are read to the end to know whether they are whole; what they ask nobody wants to know.
 */
static const char *note_query(struct tally *tally, const char *wrong, const char *wrong_header,
                              const struct query_header *header)
{
    if (!wrong_header && query_id_ok(header->client_id) && query_id_ok(header->sequence_number))
        gaps_note(&tally->gaps, header->client_id, header->sequence_number);
    return wrong;
}

static const char *note_pair_query(struct tally *tally, const void *data, uint32_t size)
{
    static struct pair_query query;
    struct query_header header;
    return note_query(tally, wire_read_pair_query(data, size, &query),
                      wire_read_pair_header(data, size, &header), &header);
}

static const char *note_scene_query(struct tally *tally, const void *data, uint32_t size)
{
    static struct scene_query query;
    struct query_header header;
    return note_query(tally, wire_read_scene_query(data, size, &query),
                      wire_read_scene_header(data, size, &header), &header);
}

static const char *note_pair_result(struct tally *tally, const void *data, uint32_t size)
{
    static struct pair_result result;
    const char *wrong = wire_read_pair_result(data, size, &result);
    if (!wrong)
        answered_result(&tally->answered, result.server_id);
    return wrong;
}

static const char *note_scene_result(struct tally *tally, const void *data, uint32_t size)
{
    static struct scene_result result;
    const char *wrong = wire_read_scene_result(data, size, &result);
    if (!wrong)
        answered_result(&tally->answered, result.server_id);
    return wrong;
}

static const char *note_status(struct tally *tally, const void *data, uint32_t size)
{
    struct wire_status status;
    const char *wrong = wire_read_status(data, size, &status);
    if (!wrong)
        answered_heartbeat(&tally->answered, status.server_id, status.answered);
    return wrong;
}

static const struct {
    const char *name;
    const char *(*note)(struct tally *tally, const void *data, uint32_t size); /* what is wrong */
} kinds[LOG_KINDS] = {
    [LOG_PAIR_QUERY] = {"pair_queries", note_pair_query},
    [LOG_PAIR_RESULT] = {"pair_results", note_pair_result},
    [LOG_SCENE_QUERY] = {"scene_queries", note_scene_query},
    [LOG_SCENE_RESULT] = {"scene_results", note_scene_result},
    [LOG_STATUS] = {"heartbeats", note_status},
    [LOG_OTHER] = {"others", NULL},
};

void tally_note(struct tally *tally, enum log_kind kind, size_t channel_length, const void *data,
                uint32_t size)
{
    tally->heard[kind]++;
    tally->bytes += log_event_bytes(channel_length, size);
    if (kinds[kind].note && kinds[kind].note(tally, data, size))
        tally->malformed++;
}

int64_t tally_heard(const struct tally *tally)
{
    int64_t heard = 0;
    for (int kind = 0; kind < LOG_KINDS; kind++)
        heard += tally->heard[kind];
    return heard;
}

const char *tally_kind_name(enum log_kind kind)
{
    return kinds[kind].name;
}
