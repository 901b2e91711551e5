/* Compares the recorded result of a query with the new one, counts, and reports differences. */
#ifndef JUDGE_H
#define JUDGE_H

#include "definitions.h"
#include "found.h"
#include "input.h"
#include "page.h"
#include "tally.h"

/* What a replay reports while it runs. */
struct replay_sink {
    void (*found)(void *user, const struct found *found);
    /* A message that cannot be decoded, and why; or a second result that contradicts the first. */
    void (*unreadable)(void *user, const struct match_place *place, const char *channel,
                       const char *what);
    /* Damage of a log. */
    void (*damage)(void *user, int log, const struct log_damage *damage);
    /* So many bytes of the logs have been read so far. */
    void (*progress)(void *user, int64_t bytes);
    void *user;
};

struct judge_options {
    struct compare_options compare;
    char *const *log; /* paths */
    const struct replay_sink *sink;
    struct tally *tally;             /* [log] */
    struct page *page;               /* receives everything judged; NULL: none */
    struct definitions *definitions; /* for the page */
    struct again *again;
};

struct judge;

/* Copies the options; owns nothing of them. Exits with status 1 if memory is exhausted. */
struct judge *judge_open(const struct judge_options *options);
void judge_close(struct judge *judge); /* may be NULL */

/* Quick check of a query with its new result against the bytes of the recorded result. True: they
 * are the same, and were counted. False: not known, or there is a page. */
bool judge_same(struct judge *judge, const struct match_item *query, const unsigned char *then,
                size_t size);

/* Decodes a result for one of the functions below. kind: of the query. Returns NULL; or a static
 * text: why it cannot be decoded. */
const char *judge_read(struct judge *judge, enum log_kind kind, const unsigned char *bytes,
                       uint32_t size);

/* compare_is_of_the_moment() of the status of the decoded result. */
bool judge_of_the_moment(const struct judge *judge, enum log_kind kind);

/* These read the query from its log again. False: errno. */

/* Judges a query with its new result against the decoded result. Only counted if mine. */
bool judge_both(struct judge *judge, const struct match_item *query);

/* Judges a query with its new result, but without a recorded one. */
bool judge_alone(struct judge *judge, const struct match_item *query);

/* Judges the decoded result, the second of its query, against the first, whose bytes must stay
 * valid. */
bool judge_second(struct judge *judge, const struct match_note *note,
                  const struct match_place *place, const unsigned char *first, uint32_t size);

#endif
