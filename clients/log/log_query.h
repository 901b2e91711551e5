/* One query out of logs, with what its keys stand for. */
#ifndef LOG_QUERY_H
#define LOG_QUERY_H

#include "any_query.h"
#include "match.h"

struct log_query_options {
    /* Taken as one, in this order. The query stands in the last one, or its result does; those
     * before it are read for what they tell of keys. */
    char *const *log; /* [log_count] */
    int log_count;
    const char *prefix; /* of the channels, "" for none */
    /* What is wanted: the event of this number, as the log says; or the one at this place, bytes
     * from the beginning of the log; or the query with these ids. An event that is a result stands
     * for its query. */
    enum { LOG_QUERY_NUMBER, LOG_QUERY_OFFSET, LOG_QUERY_IDS } by;
    int64_t number, offset;
    int64_t client_id, sequence_number;
    /* So many bytes of so many have been gone through. */
    void (*progress)(void *user, int64_t bytes, int64_t of);
    void *user;
};

struct log_query {
    struct match_place place;
    struct query_header ids;
    size_t size; /* bytes, as it stands in the log */
    /* Frames that came by key have their components, and their key, as fmb replay finds them
     * (told.h). */
    struct any_query query;
};

enum log_query_outcome {
    LOG_QUERY_FOUND,
    LOG_QUERY_NONE,  /* there is none, or several, or a key is not told */
    LOG_QUERY_FAILED /* a file cannot be opened or read */
};

/* What is not FOUND has been said on stderr. */
enum log_query_outcome log_query(const struct log_query_options *options, struct log_query *out);

#endif
