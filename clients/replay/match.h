/* Brings together the queries and the results of a log, wherever they stand in it.
 *
 * A result belongs to the query with the same client id and sequence number, and of several such,
 * to one with the same utime too (the service echoes it) that has no result yet. Most stand near
 * each other: the latest megabyte of both is in memory, and up to four of what waits. What finds no
 * partner there goes into temporary files, by a hash of its ids, and is brought together at the
 * end, piece by piece. So memory stays the same whatever the size of the log, and nothing is lost.
 *
 * A result that comes again, when all such queries have one, is given again with the one that got
 * one last; if that is no longer in memory, the result is alone. */
#ifndef MATCH_H
#define MATCH_H

#include "log_kind.h"
#include "query.h"

/* Where an event stands. */
struct match_place {
    int32_t log; /* index of the log */
    bool mine;   /* for the user of this */
    int64_t number, offset, utime;
};

/* A query or a result. */
struct match_item {
    enum log_kind kind; /* of the query: PAIR or SCENE_QUERY */
    struct query_header ids;
    struct match_place place;
    /* As they stand in the log; of a query, behind them, what the user gave besides. */
    uint32_t size, more_size;
    const unsigned char *bytes, *more;
};

/* Called for each result that found its query, as soon as both are there; a result that comes again
 * is given again. And at the end for what is alone. Items are good until the call returns. */
struct match_sink {
    void (*both)(void *user, const struct match_item *query, const struct match_item *result);
    void (*query_alone)(void *user, const struct match_item *query);
    void (*result_alone)(void *user, const struct match_item *result);
    void *user;
};

struct match;

/* Never NULL: ends the program where there is no memory. */
struct match *match_open(const struct match_sink *sink);
void match_close(struct match *match); /* may be NULL */

/* The bytes are copied. size and more_size at most LOG_DATA_MAX each. */
void match_query(struct match *match, const struct match_item *query);
void match_result(struct match *match, const struct match_item *result);

/* Of how many of the user's own (place.mine) something may still be told before the end: those that
 * have found no partner, and queries in memory, since results may come again. */
int64_t match_open_count(const struct match *match);

/* The end of the log. False: a temporary file could not be written or read, errno says why, and not
 * all could be brought together. */
bool match_finish(struct match *match);

#endif
