/* Runs comparisons: compares the recorded result of a query with the new one, counts the outcomes,
 * and reports differences. For one thread at a time. */
#ifndef COMPARISON_H
#define COMPARISON_H

#include "definitions.h"
#include "located_difference.h"
#include "input.h"
#include "page.h"
#include "tally.h"

/* Callbacks for the progress and the findings of a replay. None may be NULL. */
struct replay_sink {
    void (*difference)(void *user, const struct located_difference *located);
    /* A message that cannot be decoded, and why; or a second result that contradicts the first. */
    void (*unreadable)(void *user, const struct match_place *place, const char *channel,
                       const char *what);
    /* Damage of a log. */
    void (*damage)(void *user, int log, const struct log_damage *damage);
    /* So many bytes of the logs have been read. */
    void (*progress)(void *user, int64_t bytes);
    void *user;
};

struct comparison_options {
    struct compare_options compare;
    char *const *log; /* paths */
    const struct replay_sink *sink;
    struct tally *tally;             /* [log] */
    struct page *page;               /* receives every comparison; NULL: none */
    struct definitions *definitions; /* for the page */
    struct event_reader *rereader;
};

struct comparison;

/* Copies the options; owns nothing of them. Exits with status 1 if memory is exhausted. */
struct comparison *comparison_open(const struct comparison_options *options);
void comparison_close(struct comparison *comparison); /* may be NULL */

/* Quick check of a query with its new result against the bytes of the recorded result. Returns true
 * if they are the same, which was counted; false: not known, or there is a page. */
bool comparison_same_bytes(struct comparison *comparison, const struct match_item *query,
                           const unsigned char *then, size_t size);

/* Decodes a result for one of the functions below. kind: of the query. Returns NULL; or a static
 * text: why it cannot be decoded. */
const char *comparison_read(struct comparison *comparison, enum log_kind kind,
                            const unsigned char *bytes, uint32_t size);

/* compare_status_is_transient() of the status of the decoded result. */
bool comparison_is_transient(const struct comparison *comparison, enum log_kind kind);

/* The next three functions read the query from its log again. They return false if that fails:
 * errno. */

/* Compares the new result of a query with the decoded result. Does nothing if the query is not in
 * the replayed range. */
bool comparison_run(struct comparison *comparison, const struct match_item *query);

/* Counts a query with a new result, but without a recorded one. Does nothing if the query is not in
 * the replayed range. */
bool comparison_unrecorded(struct comparison *comparison, const struct match_item *query);

/* Compares the decoded result, the second of its query, with the first one, whose bytes must stay
 * valid. */
bool comparison_second(struct comparison *comparison, const struct match_note *note,
                       const struct match_place *place, const unsigned char *first, uint32_t size);

#endif
