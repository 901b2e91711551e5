/* Matches queries and results of a log.
 *
 * A result belongs to the query with the same client id, sequence number, time of sending and kind;
 * if there are several, to the first without a result. Unmatched queries and results are kept in
 * memory, at some 250 bytes an item. Matched items are removed. The positions of the last few
 * thousand matches are noted, so that second results are recognised. For one thread at a time. */
#ifndef MATCH_H
#define MATCH_H

#include "keyed_hash.h"
#include "log_kind.h"

struct match_key {
    int64_t kind; /* of the query: LOG_PAIR_QUERY or LOG_SCENE_QUERY */
    int64_t client_id, sequence_number;
    int64_t utime; /* of the query, microseconds since 1970, which results echo */
};

/* Reads the key of a query or result, and nothing else. Returns NULL; or a static text: why it
 * cannot be read. A query may be longer than the kept data of the event: the service refuses such
 * queries. */
const char *match_key_of(enum log_kind kind, const struct log_event *event, struct match_key *out);

static inline bool match_key_equal(const struct match_key *a, const struct match_key *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

/* The position of an event. */
struct match_place {
    int32_t log;   /* index of the log */
    bool in_range; /* the event is in the replayed range of time */
    int64_t number, offset, utime;
};

struct match_item {
    struct match_key key;
    struct match_place place;
    bool is_result; /* otherwise a query; the members below are for the user */
    bool unreadable;
    bool has_recorded; /* the log has a result, at then */
    bool sent_whole;   /* sent with frames, after UNKNOWN_BODY */
    bool left_over;    /* a recording by another client lacks this query */
    struct match_place then;
    size_t index;            /* of the query */
    struct match_item *next; /* the next item with the same key, or of a list; NULL: none */
    /* Private: */
    struct match_item *last; /* in a list: the item before; of the first item, the last one */
    UT_hash_handle hh;
};

struct match;

/* Exits with status 1 if memory is exhausted. */
struct match *match_open(void);
void match_close(struct match *match); /* may be NULL; frees all items in the table */

/* The first item with this key; NULL: none. Items with the same key are all queries or all results.
 */
struct match_item *match_find(const struct match *match, const struct match_key *key);

/* Matches a query or result with the first item of the other kind with its key, which is removed:
 * the caller frees it. Otherwise adds it to the table, and returns NULL. */
struct match_item *match_take(struct match *match, const struct match_key *key,
                              const struct match_place *place, bool is_result);

/* Adds an item to the table. */
struct match_item *match_add(struct match *match, const struct match_key *key,
                             const struct match_place *place, bool is_result);

/* Makes an item outside the table. The caller frees it. */
struct match_item *match_new(const struct match_key *key, const struct match_place *place);

/* Removes the first item with its key from the table. The caller frees it. */
void match_remove(struct match *match, struct match_item *item);

/* Some item in the table that is the first with its key; NULL: the table is empty. */
struct match_item *match_any(const struct match *match);

/* At the end: matches the remaining items without the time of sending, for results that do not echo
 * it. Calls the sink for each result, with its query or NULL; both were removed, and the sink frees
 * them. After that only queries are left. */
typedef void match_sink(void *user, struct match_item *query, struct match_item *result);
void match_finish(struct match *match, match_sink *sink, void *user);

/* ---- Lists of items that are not in the table; NULL: empty ---- */

void match_append(struct match_item **list, struct match_item *item);
struct match_item *match_pop(struct match_item **list); /* the first item; NULL: none is left */

/* ---- Notes of matches ---- */

struct match_note {
    struct match_key key;
    int32_t query_log, result_log;
    int64_t query_offset, result_offset;
};

/* Adds a note, except for an unreadable query. */
void match_note(struct match *match, const struct match_item *query,
                const struct match_place *result);

/* The note of a key; NULL: none, or overwritten by a later one. */
const struct match_note *match_noted(const struct match *match, const struct match_key *key);

#endif
