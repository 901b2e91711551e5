/* Extracts one query from logs, with the bodies of its handles. */
#ifndef LOG_QUERY_H
#define LOG_QUERY_H

#include "body_names.h"
#include "definitions.h"
#include "match.h"

struct log_query_options {
    /* Read as one log, in this order. The last one contains the query or its result; the others
     * are read for definitions. */
    char *const *log; /* [log_count] */
    int log_count;
    const char *prefix; /* of the channels; "": none */
    int64_t event;      /* number of the event, a query or its result, in the last log */
};

struct log_query {
    int64_t number, offset; /* of its event, in the last log */
    struct match_key key;
    size_t size; /* bytes in the log */
    unsigned char bytes[LOG_DATA_MAX];
    /* Handles are replaced by their bodies, from anywhere in the logs. A placement without a name
     * has the last one of its body in the logs. */
    struct logged_query query;
    struct definitions *definitions; /* owned */
    struct body_names *names;        /* owned */
};

enum log_query_outcome {
    LOG_QUERY_FOUND,
    LOG_QUERY_NONE,  /* there is no such query, or several, or a handle is not defined */
    LOG_QUERY_FAILED /* a file cannot be opened or read */
};

/* If not FOUND, the reason was reported on stderr. Clear *out in any case. */
enum log_query_outcome log_query(const struct log_query_options *options, struct log_query *out);
void log_query_clear(struct log_query *query);

#endif
