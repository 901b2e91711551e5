/* Classifies the events of a log by the service's channels. No shared state. */
#ifndef LOG_KIND_H
#define LOG_KIND_H

#include "log_read.h"
#include "query.h"

/* Queries and results of pairs and scenes come before LOG_STATUS. */
enum log_kind {
    LOG_PAIR_QUERY,
    LOG_PAIR_RESULT,
    LOG_SCENE_QUERY,
    LOG_SCENE_RESULT,
    LOG_STATUS,
    LOG_DEFINITION_QUERY,
    LOG_DEFINITION,
    LOG_NAMES,
    LOG_OTHER, /* of another program, or of a service with another prefix */
    LOG_KINDS
};

/* The names of the kinds in reports: in JSON, and for people. */
struct log_kind_name {
    const char *json, *text;
};
extern const struct log_kind_name log_kind_name[LOG_KINDS];

/* The channels of a service. */
struct log_channels {
    char name[LOG_OTHER][64]; /* [kind] */
    size_t length[LOG_OTHER];
};

/* prefix: valid by bus_prefix_ok(), or "". */
struct log_channels log_channels(const char *prefix);

enum log_kind log_kind_of(const struct log_channels *channels, const struct log_event *event);

/* Returns whether it is a query of a pair or a scene. */
static inline bool log_kind_is_query(enum log_kind kind)
{
    return kind == LOG_PAIR_QUERY || kind == LOG_SCENE_QUERY;
}

/* Returns whether it is a result of a pair or a scene. */
static inline bool log_kind_is_result(enum log_kind kind)
{
    return kind == LOG_PAIR_RESULT || kind == LOG_SCENE_RESULT;
}

/* The kind of query that a query or result belongs to. */
static inline enum log_kind log_kind_query_of(enum log_kind kind)
{
    return kind == LOG_PAIR_QUERY || kind == LOG_PAIR_RESULT ? LOG_PAIR_QUERY : LOG_SCENE_QUERY;
}

/* The kind of its results. */
static inline enum log_kind log_kind_result_of(enum log_kind query)
{
    return query == LOG_PAIR_QUERY ? LOG_PAIR_RESULT : LOG_SCENE_RESULT;
}

/* Writes a message of a kind. Returns false if it failed. */
typedef bool log_sink(void *user, enum log_kind kind, const void *bytes, size_t size);

#endif
