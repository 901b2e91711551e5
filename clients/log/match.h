/* The queries and results of logs, and which belong together.
 *
 * A result belongs to the query with the same kind, client id, sequence number and time of sending;
 * if there are several, to the first without a result. A transient result, whose status depends on
 * the moment, leaves its query open: a later one replaces it, until the query is repeated. Other
 * results of a query that has one are second results. Queries and results that are left are matched
 * without the time of sending, in their order, for results that do not echo it.
 *
 * Memory: some 100 bytes for each query and each result: an item, and 24 bytes while match_all()
 * sorts. The array of items reserves up to twice its size. For one thread at a time. */
#ifndef MATCH_H
#define MATCH_H

#include "log_kind.h"
#include "logged_query.h"

struct match_key {
    int64_t kind; /* of the query: LOG_PAIR_QUERY or LOG_SCENE_QUERY */
    int64_t client_id, sequence_number;
    int64_t utime; /* of the query, microseconds since 1970, which results echo */
};

/* Reads the key of a query or result, and nothing else. Returns NULL; or a static text: why it
 * cannot be read. A query may be longer than the kept data of the event: the service refuses such
 * queries. */
const char *match_key_of(enum log_kind kind, const struct log_event *event, struct match_key *out);

/* The position of an event. */
struct match_place {
    int log; /* its index */
    int64_t number, offset, utime;
};

struct match_item {
    struct match_key key;
    struct match_place place;
    /* The result of a query; the query of a result, even of a second one. NULL: none. */
    struct match_item *other;
    bool is_result; /* otherwise a query */
    bool transient; /* of a result: logged_status_is_transient() */
    bool second;    /* of a result: its query has another one */
    /* For the user: */
    bool chosen;                  /* a query that is copied (log_cut.h) */
    bool unreadable;              /* only the key can be read */
    bool sent_whole;              /* sent with frames, after UNKNOWN_BODY */
    bool defined;                 /* sent_whole: the frames of all bodies are known */
    bool left_over;               /* a recording by another client lacks this query */
    bool by_order;                /* of a golden result: of another client, matched by its order */
    const struct match_item *own; /* of a golden result: its query in the golden log; NULL: none */
};

/* Returns the position of an event of the log with this index. */
struct match_place match_place_of(int log, const struct log_event *event);

/* Reads a query or a result of a log: its key, its place, and whether it is transient. In: memory
 * for a decoded result; NULL: only the key is read. Returns NULL; or a static text: why it cannot
 * be decoded. Of a query only the header is read. */
const char *match_read(struct match_item *out, enum log_kind kind, int log,
                       const struct log_event *event, struct logged_result *memory);

struct match {
    struct match_item *item; /* owned, [count], in the order of match_add() */
    size_t count, capacity;
};

/* Adds a query or result: its key, place, is_result and transient. Items may move until
 * match_all(). Exits with status 1 if memory is exhausted. */
void match_add(struct match *match, const struct match_item *item);

/* Sets other and second of all items. May be called again, after keys were changed. */
void match_all(struct match *match);

void match_clear(struct match *match);

#endif
