#include "answer.h"

#include "bodies.h"
#include "check.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

static void set_side(struct checking *checking, int side)
{
    checking->part = side == 0 ? "a" : "b";
    checking->index = -1;
}

static bool check_pair(struct checking *checking, const struct pair_query *query)
{
    if (!check_ids(checking, query->client_id, query->sequence_number) ||
        !check_question(checking, query->duration, query->method, query->want,
                        QUERY_WANT_BOX | QUERY_WANT_CERTIFICATE))
        return false;
    for (int f = 0; f < 2; f++) {
        set_side(checking, f);
        if (!check_frame(checking, &query->frame[f]))
            return false;
    }
    checking->part = NULL;
    return query->frame[0].dim == query->frame[1].dim ||
           check_refuse(checking, FMB_DIMENSIONS_DIFFER, "dim", NULL);
}

/* The bodies of a checked query, in the cache or in room. */
struct bodies {
    const struct fmb_body *of[2];
    struct fmb_body room[2];
};

/* One that the other frame may drive out of the cache is copied: that of the same id, which other
 * components may replace; and any, where there is room for one alone. */
static void take_body(const struct cache *cache, const struct pair_query *query, int f,
                      const struct fmb_body *found, struct bodies *out)
{
    const bool may_go =
        query->frame[0].body_id == query->frame[1].body_id || cache_capacity(cache) == 1;
    if (may_go && found != &out->room[f])
        out->room[f] = *found;
    out->of[f] = may_go ? &out->room[f] : found;
}

/* Keys come first: one that is not held leaves the cache as it was. */
static bool find_bodies(struct cache *cache, struct checking *checking,
                        const struct pair_query *query, struct bodies *out, int64_t key[2])
{
    const struct fmb_body *found;
    for (int f = 0; f < 2; f++)
        cache_expect(cache, query->frame[f].body_id);
    for (int f = 0; f < 2; f++) {
        if (!check_by_key(&query->frame[f]))
            continue;
        set_side(checking, f);
        if (!(found = bodies_find(cache, &query->frame[f])))
            return check_refuse(checking, FMB_UNKNOWN_BODY, "key", "not held; send the components");
        take_body(cache, query, f, found, out);
    }
    for (int f = 0; f < 2; f++) {
        key[f] = query->frame[f].key;
        if (!check_by_key(&query->frame[f]))
            take_body(cache, query, f, bodies_keep(cache, &query->frame[f], &out->room[f], &key[f]),
                      out);
    }
    return true;
}

/* One that is too long is left out. */
static void certify(struct answerer *answerer, const struct fmb_pair *pair,
                    struct pair_result *result)
{
    size_t length;
    enum fmb_status status =
        fmb_certificate(pair, answerer->certificate, sizeof answerer->certificate, &length);
    assert(status == FMB_OK || status == FMB_OVER_LIMIT);
    if (status == FMB_OK)
        result->certificate = answerer->certificate;
}

static void decide(struct answerer *answerer, struct pair_result *result,
                   const struct pair_query *query, const struct bodies *bodies)
{
    const struct fmb_method *method = fmb_method_by_number(query->method);
    const struct fmb_pair pair = {.a = bodies_place(&query->frame[0], bodies->of[0]),
                                  .b = bodies_place(&query->frame[1], bodies->of[1]),
                                  .duration = query->duration};
    unsigned want = query->want & QUERY_WANT_BOX ? FMB_WANT_BOX : 0;
    result->status = (int32_t) fmb_decide(method, &pair, want, &result->answer);
    if (result->status != FMB_OK) {
        snprintf(result->detail, sizeof result->detail, "method %s: %s", method->name,
                 fmb_status_text(result->status));
        return;
    }
    result->method = method->number;
    result->dim = result->answer.has_box ? bodies->of[0]->dim : 0;
    if (query->want & QUERY_WANT_CERTIFICATE)
        certify(answerer, &pair, result);
}

static void begin_result(const struct answerer *answerer, const struct pair_query *query,
                         struct pair_result *result)
{
    memset(result, 0, sizeof *result);
    result->utime = query->utime;
    result->client_id = query->client_id;
    result->sequence_number = query->sequence_number;
    result->server_id = answerer->server_id;
    for (int f = 0; f < 2; f++)
        result->body_id[f] = query->frame[f].body_id;
}

void answer_pair(struct answerer *answerer, const struct pair_query *query,
                 struct pair_result *result)
{
    begin_result(answerer, query, result);
    struct checking checking = {.status = &result->status, .detail = result->detail};
    struct bodies bodies;
    if (check_pair(&checking, query) &&
        find_bodies(answerer->cache, &checking, query, &bodies, result->key))
        decide(answerer, result, query, &bodies);
    if (result->status != FMB_OK)
        memset(result->key, 0, sizeof result->key);
}

void answer_pair_refused(const struct answerer *answerer, const struct pair_query *query,
                         enum fmb_status status, struct pair_result *result)
{
    begin_result(answerer, query, result);
    result->status = (int32_t) status;
    snprintf(result->detail, sizeof result->detail, "%s", fmb_status_text(result->status));
}
