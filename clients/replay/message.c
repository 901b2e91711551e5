#include "message.h"

#include "wire.h"

bool message_is_query(enum log_kind kind)
{
    return kind == LOG_PAIR_QUERY || kind == LOG_SCENE_QUERY;
}

bool message_is_result(enum log_kind kind)
{
    return kind == LOG_PAIR_RESULT || kind == LOG_SCENE_RESULT;
}

const char *message_read_ids(enum log_kind kind, const struct log_event *event,
                             struct match_item *out)
{
    out->bytes = event->data;
    out->size = (uint32_t) event->kept;
    out->more = NULL;
    out->more_size = 0;
    out->kind =
        kind == LOG_PAIR_QUERY || kind == LOG_PAIR_RESULT ? LOG_PAIR_QUERY : LOG_SCENE_QUERY;
    if (event->kept < event->size && !message_is_query(kind)) /* those of any length get a result */
        return "longer than any message of this type";
    switch (kind) {
    case LOG_PAIR_QUERY: return wire_read_pair_header(out->bytes, out->size, &out->ids);
    case LOG_PAIR_RESULT: return wire_read_pair_result_header(out->bytes, out->size, &out->ids);
    case LOG_SCENE_QUERY: return wire_read_scene_header(out->bytes, out->size, &out->ids);
    default: return wire_read_scene_result_header(out->bytes, out->size, &out->ids);
    }
}
