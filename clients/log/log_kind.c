#include "log_kind.h"

#include "bus.h"
#include "wire.h"

#include <string.h>

_Static_assert(sizeof((struct log_channels *) 0)->name[0] == BUS_CHANNEL_MAX, "LCM's limit");

const struct log_kind_name log_kind_name[LOG_KINDS] = {
    [LOG_PAIR_QUERY] = {"pair_queries", "pair queries"},
    [LOG_PAIR_RESULT] = {"pair_results", "pair results"},
    [LOG_SCENE_QUERY] = {"scene_queries", "scene queries"},
    [LOG_SCENE_RESULT] = {"scene_results", "scene results"},
    [LOG_STATUS] = {"heartbeats", "heartbeats"},
    [LOG_DEFINITION_QUERY] = {"definition_queries", "definition queries"},
    [LOG_DEFINITION] = {"definitions", "definitions"},
    [LOG_NAMES] = {"names", "names"},
    [LOG_OTHER] = {"others", "others"},
};

struct log_channels log_channels(const char *prefix)
{
    static const char *const name[LOG_OTHER] = {
        [LOG_PAIR_QUERY] = WIRE_PAIR_QUERY,   [LOG_PAIR_RESULT] = WIRE_PAIR_RESULT,
        [LOG_SCENE_QUERY] = WIRE_SCENE_QUERY, [LOG_SCENE_RESULT] = WIRE_SCENE_RESULT,
        [LOG_STATUS] = WIRE_STATUS,           [LOG_DEFINITION_QUERY] = WIRE_DEFINITION_QUERY,
        [LOG_DEFINITION] = WIRE_DEFINITION,   [LOG_NAMES] = WIRE_NAMES,
    };
    struct log_channels channels;
    for (int kind = 0; kind < LOG_OTHER; kind++) {
        bus_channel(channels.name[kind], prefix, name[kind]);
        channels.length[kind] = strlen(channels.name[kind]);
    }
    return channels;
}

enum log_kind log_kind_of(const struct log_channels *channels, const struct log_event *event)
{
    for (int kind = 0; kind < LOG_OTHER; kind++)
        if (event->channel_length == channels->length[kind] &&
            memcmp(event->channel, channels->name[kind], event->channel_length) == 0)
            return (enum log_kind) kind;
    return LOG_OTHER;
}
