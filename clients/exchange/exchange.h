/* A query and its answers, as a log or the bus holds them: the scene, the answers to its pairs in
 * order, the status, the time, and the ids of client and service.
 *
 *     struct exchange exchange = {.query = &query, .result = &result};
 *     exchange_begin(&exchange);
 *     while (exchange_next(&exchange, true, &answer))
 *         ...
 *
 * A result of all pairs, or of those across, names the pairs that touch, overlap or are near: the
 * others up to its end_pair are separated. exchange_next() is the only code that knows this. For
 * one thread at a time. */
#ifndef EXCHANGE_H
#define EXCHANGE_H

#include "body_names.h"
#include "fmb_client.h"
#include "logged_query.h"
#include "scene.h"

/* How many pairs have each verdict; [0]: not decided. */
struct exchange_counts {
    int64_t verdict[FMB_OVERLAPPING + 1];
};

struct exchange {
    /* Set by the caller, not owned. There are no answers if the query was refused, or if the result
     * belongs to another query. */
    const struct logged_query *query;   /* may be NULL, not known, if the result is of a pair */
    const struct logged_result *result; /* NULL: none */
    const struct body_names *names;     /* of the bodies of the query; NULL: none */
    bool by_order; /* the result was matched by its order: it may belong to another query */
    /* Set by exchange_begin(). */
    const struct result_head *head; /* of the result; all 0 if there is none */
    const char *text;               /* of its status; "": OK */
    bool is_pair;                   /* the result is of a pair */
    int32_t end_pair;               /* of a scene: the answers end before this pair of the query */
    bool fits;                      /* the result has answers to pairs of the query */
    /* Private. */
    int32_t answers, contacts;      /* read of the result */
    struct fmb_client_answer named; /* the next pair that the result names */
    int64_t number;                 /* of this pair in the query; INT64_MAX: there is none */
    struct pair_cursor pair;
    struct owned_scene *all; /* the pairs of the query; NULL until one is needed */
};

/* Begins the iteration, or begins it anew. Call exchange_end() after the last iteration. */
void exchange_begin(struct exchange *exchange);
void exchange_end(struct exchange *exchange);

/* Returns true and the next answer, in the order of the pairs, or false after the last one. a and b
 * are indices of placements; certificate and text are valid as long as the result. separated:
 * whether to include the separated pairs that the result does not name. */
bool exchange_next(struct exchange *exchange, bool separated, struct fmb_client_answer *out);

/* One pair in two results of one query; answered: whether a result has an answer to it. */
struct exchange_pair {
    unsigned a, b;
    bool answered[2];
    struct fmb_client_answer answer[2];
};

/* Merges two results of queries with the same pairs. Returns true and the next pair that one of
 * them names, or false after the last one. */
bool exchange_next_of_both(struct exchange *const both[2], struct exchange_pair *out);

/* Counts the answers, separated ones included. */
struct exchange_counts exchange_count(const struct exchange *exchange);

/* Returns the number of pairs that the result decides. */
int64_t exchange_decided(const struct exchange *exchange);

/* Returns the last name of a body of the query (names), or else its name in the query; NULL: none.
 */
const char *exchange_name(const struct exchange *exchange, int32_t placement);

#endif
