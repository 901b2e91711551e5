/* Judges the queries of a part of a log once their results are there: compares, counts, and hands
 * on what is different. */
#ifndef JUDGE_H
#define JUDGE_H

#include "found.h"
#include "known_bodies.h"
#include "match.h"
#include "page.h"
#include "tally.h"

/* Where it is told what a replay finds. */
struct replay_sink {
    void (*found)(void *user, const struct found *found);
    /* A message that cannot be read, and why. */
    void (*unreadable)(void *user, const struct match_place *place, const char *channel,
                       const char *what);
    /* Bytes that are no event of a log. */
    void (*damage)(void *user, int log, const struct log_damage *damage);
    /* So many bytes of the logs have been gone through. */
    void (*progress)(void *user, int64_t bytes);
    void *user;
};

struct judge_options {
    struct compare_options compare;
    char *const *log; /* paths */
    const struct replay_sink *sink;
    struct tally *tally;        /* [log] */
    struct page *page;          /* takes in all that is judged; NULL: none */
    struct known_bodies *known; /* for the page */
};

struct judge;

/* Copies the options; owns nothing of them. Never NULL: ends the program where there is no memory.
 */
struct judge *judge_open(const struct judge_options *options);
void judge_close(struct judge *judge); /* may be NULL */

/* Whether a result can be read: NULL, or why not. */
const char *judge_read_result(struct judge *judge, const struct match_item *result);

/* Queries have what was answered now in more. What is not mine is not counted. */
void judge_both(struct judge *judge, const struct match_item *query,
                const struct match_item *result);
void judge_query_alone(struct judge *judge, const struct match_item *query);
void judge_result_alone(struct judge *judge, const struct match_item *result);

#endif
