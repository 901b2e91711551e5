#include "answerer.h"

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
        !check_request(checking, query->duration, query->method, query->want,
                       QUERY_WANT_BOX | QUERY_WANT_CERTIFICATE))
        return false;
    for (int f = 0; f < 2; f++) {
        set_side(checking, f);
        if (!check_placement(checking, &query->placement[f]))
            return false;
    }
    checking->part = NULL;
    return query->placement[0].dim == query->placement[1].dim ||
           check_refuse(checking, FMB_DIMENSIONS_DIFFER, "dim", NULL);
}

/* The bodies of a checked query. */
struct bodies {
    const struct fmb_body *of[2]; /* in the cache, or copy[] */
    struct fmb_body copy[2];
};

static bool find_body(struct cache *cache, struct checking *checking,
                      const struct placement *placement, const struct fmb_body **out)
{
    const struct cached *cached = cache_find(cache, &placement->handle);
    if (!cached)
        return check_refuse(checking, FMB_UNKNOWN_BODY, "handle", "not held; send the frames");
    *out = &cached->body;
    return check_body_dim(checking, placement, &cached->body);
}

/* Keeping one body may evict the other. */
static void copy_body(struct bodies *bodies, int f)
{
    if (bodies->of[f] != &bodies->copy[f])
        bodies->copy[f] = *bodies->of[f];
    bodies->of[f] = &bodies->copy[f];
}

/* Handles come first: a query with one that is not held leaves the cache as it was. */
static bool find_bodies(struct answerer *answerer, struct checking *checking,
                        const struct pair_query *query, struct bodies *out, struct handle handle[2])
{
    const bool named[2] = {placement_by_handle(&query->placement[0]),
                           placement_by_handle(&query->placement[1])};
    const bool keeps = !named[0] || !named[1];
    for (int f = 0; f < 2; f++) {
        set_side(checking, f);
        if (named[f] && !find_body(answerer->cache, checking, &query->placement[f], &out->of[f]))
            return false;
        if (named[f] && keeps)
            copy_body(out, f);
    }
    for (int f = 0; f < 2; f++) {
        if (named[f])
            continue;
        out->of[f] = answerer_keep(answerer, &query->placement[f], &out->copy[f], &handle[f]);
        copy_body(out, f);
    }
    return true;
}

/* A certificate that is too long is left out. */
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
    const struct fmb_pair pair = {.a = answerer_place(&query->placement[0], bodies->of[0]),
                                  .b = answerer_place(&query->placement[1], bodies->of[1]),
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
        result->body_id[f] = query->placement[f].body_id;
}

void answer_pair(struct answerer *answerer, const struct pair_query *query,
                 struct pair_result *result)
{
    for (int f = 0; f < 2; f++) /* arrives while the query is checked */
        cache_prefetch(answerer->cache, &query->placement[f]);
    begin_result(answerer, query, result);
    struct checking checking = {.status = &result->status, .detail = result->detail};
    struct bodies bodies;
    if (check_pair(&checking, query) &&
        find_bodies(answerer, &checking, query, &bodies, result->handle))
        decide(answerer, result, query, &bodies);
}

void answer_pair_refused(const struct answerer *answerer, const struct pair_query *query,
                         enum fmb_status status, struct pair_result *result)
{
    begin_result(answerer, query, result);
    result->status = (int32_t) status;
    snprintf(result->detail, sizeof result->detail, "%s", fmb_status_text(result->status));
}
