/* Query in, result out: checks what a query says, finds or keeps its bodies, and decides.
 * Knows no LCM and no clock; given the same queries in the same order it gives the same
 * results. */
#ifndef ANSWER_H
#define ANSWER_H

#include "cache.h"
#include "query.h"

struct scene_work;

/* All 0 but for what the caller sets. */
struct answerer {
    struct cache *cache; /* not owned */
    int64_t server_id;
    /* Called between the parts of a scene, which may take long, so that others need not wait; may
     * answer pairs, not scenes. False: the scene has taken long enough, and its result is of the
     * pairs decided so far. NULL: nobody waits. */
    bool (*between)(void *user);
    void *user;
    struct scene_work *work;                 /* owned: answer_prepare() */
    char certificate[QUERY_CERTIFICATE_MAX]; /* of the last result that has one */
};

/* Takes all memory that answers will need, to be freed with answer_release(). False: there is
 * none. */
bool answer_prepare(struct answerer *answerer);
void answer_release(struct answerer *answerer);

/* On output: the result, complete but for compute_ns (0). A query that cannot be decided gets
 * its status, and detail names the place: "b.components[4]: not a finite number". A query
 * with a wrong field or a dead key leaves the cache as it was. A certificate is there where it is
 * wanted and fits, and holds until the next call. */
void answer_pair(struct answerer *answerer, const struct pair_query *query,
                 struct pair_result *result);

/* Likewise, complete but for compute_ns and lost (0). Of pairs that are not all to be had in one
 * datagram, or before between() says that it is enough, those that are, in their order, and at
 * least one; end_pair tells how many. */
void answer_scene(struct answerer *answerer, const struct scene_query *query,
                  struct scene_result *result);

/* The result of a query that nobody looked at. */
void answer_pair_refused(const struct answerer *answerer, const struct pair_query *query,
                         enum fmb_status status, struct pair_result *result);
void answer_scene_refused(const struct answerer *answerer, const struct query_header *query,
                          enum fmb_status status, struct scene_result *result);

#endif
