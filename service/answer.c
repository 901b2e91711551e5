#include "answer.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const side_name[2] = {"a", "b"};

/* A query on its way: the first thing that is wrong with it ends it. */
struct checking {
    struct pair_result *result;
    const char *side; /* "a", "b", or NULL for the query itself */
};

/* Says what is wrong and where; always false. reason NULL: the text of the status. */
static bool refuse(struct checking *checking, enum fmb_status status, const char *field,
                   const char *reason)
{
    checking->result->status = status;
    snprintf(checking->result->detail, sizeof checking->result->detail, "%s%s%s: %s",
             checking->side ? checking->side : "", checking->side ? "." : "", field,
             reason ? reason : fmb_status_text(status));
    return false;
}

static bool check_id(struct checking *checking, const char *field, int64_t id)
{
    return query_id_ok(id) || refuse(checking, FMB_BAD_ID, field, "not from 0 to 2^53 - 1");
}

static bool check_count(struct checking *checking, const char *field, int expected,
                        const struct query_numbers *numbers)
{
    if (numbers->count == expected)
        return true;
    char reason[64];
    snprintf(reason, sizeof reason, "expected %d numbers, found %d", expected,
             (int) numbers->count);
    return refuse(checking, FMB_WRONG_COUNT, field, reason);
}

static bool check_finite(struct checking *checking, const char *field,
                         const struct query_numbers *numbers)
{
    for (int i = 0; i < numbers->count; i++)
        if (!isfinite(numbers->number[i])) {
            char place[32];
            snprintf(place, sizeof place, "%s[%d]", field, i);
            return refuse(checking, FMB_NOT_FINITE, place, NULL);
        }
    return true;
}

static bool by_key(const struct query_frame *frame)
{
    return frame->components.count == 0 && frame->key != 0;
}

static bool check_frame(struct checking *checking, const struct query_frame *frame)
{
    if (!check_id(checking, "body_id", frame->body_id) || !check_id(checking, "key", frame->key))
        return false;
    if (!fmb_shape_name(frame->shape))
        return refuse(checking, FMB_UNKNOWN_SHAPE, "shape", NULL);
    int vectors = fmb_component_count(frame->dim, frame->shape);
    if (vectors == 0)
        return refuse(checking, FMB_WRONG_DIMENSION, "dim",
                      frame->dim == 2 ? "a face is in 3D" : "neither 2 nor 3");
    return check_count(checking, "origin", frame->dim, &frame->origin) &&
           (by_key(frame) ||
            check_count(checking, "components", vectors * frame->dim, &frame->components)) &&
           (frame->velocity.count == 0 ||
            check_count(checking, "velocity", frame->dim, &frame->velocity)) &&
           check_finite(checking, "origin", &frame->origin) &&
           check_finite(checking, "components", &frame->components) &&
           check_finite(checking, "velocity", &frame->velocity);
}

static bool check_query(struct checking *checking, const struct pair_query *query)
{
    if (!check_id(checking, "client_id", query->client_id) ||
        !check_id(checking, "sequence_number", query->sequence_number))
        return false;
    if (!(query->duration >= 0 && isfinite(query->duration)))
        return refuse(checking, FMB_BAD_DURATION, "duration", "negative or not finite");
    if (!fmb_method_by_number(query->method))
        return refuse(checking, FMB_UNKNOWN_METHOD, "method", NULL);
    if (query->want & ~(QUERY_WANT_BOX | QUERY_WANT_CERTIFICATE))
        return refuse(checking, FMB_UNKNOWN_WANT, "want", NULL);
    for (int f = 0; f < 2; f++) {
        checking->side = side_name[f];
        if (!check_frame(checking, &query->frame[f]))
            return false;
    }
    checking->side = NULL;
    if (query->frame[0].dim != query->frame[1].dim)
        return refuse(checking, FMB_DIMENSIONS_DIFFER, "dim", NULL);
    return true;
}

/* Puts the components of a checked frame that has them into *body, and keeps them by id.
 * Returns the key; 0 for an anonymous body. */
static int64_t keep_body(struct answerer *answerer, const struct query_frame *frame,
                         struct fmb_body *body)
{
    const double *components = frame->components.number;
    if (frame->body_id)
        return cache_keep(answerer->cache, frame->body_id, frame->dim, frame->shape, components,
                          body);
    enum fmb_status status =
        fmb_body_make(frame->dim, frame->shape, components, (size_t) frame->components.count, body);
    assert(status == FMB_OK);
    (void) status;
    return 0;
}

/* The bodies of a checked query. Copies, not pointers into the cache: the second body may evict
 * the first. Keys come first: one that is not held leaves the cache as it was. */
static bool find_bodies(struct answerer *answerer, struct checking *checking,
                        const struct pair_query *query, struct fmb_body body[2])
{
    int64_t *key = checking->result->key;
    for (int f = 0; f < 2; f++) {
        const struct query_frame *frame = &query->frame[f];
        checking->side = side_name[f];
        if (by_key(frame) && !cache_find(answerer->cache, frame->body_id, frame->key, frame->dim,
                                         frame->shape, &body[f]))
            return refuse(checking, FMB_UNKNOWN_BODY, "key", "not held; send the components");
    }
    for (int f = 0; f < 2; f++) {
        const struct query_frame *frame = &query->frame[f];
        key[f] = by_key(frame) ? frame->key : keep_body(answerer, frame, &body[f]);
    }
    return true;
}

static void place(struct fmb_frame *out, const struct query_frame *frame,
                  const struct fmb_body *body)
{
    *out = (struct fmb_frame){.body = body, .moving = frame->velocity.count > 0};
    memcpy(out->origin, frame->origin.number, sizeof out->origin);
    memcpy(out->velocity, frame->velocity.number, sizeof out->velocity);
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
                   const struct pair_query *query, const struct fmb_body body[2])
{
    const struct fmb_method *method = fmb_method_by_number(query->method);
    struct fmb_pair pair = {.duration = query->duration};
    place(&pair.a, &query->frame[0], &body[0]);
    place(&pair.b, &query->frame[1], &body[1]);
    unsigned want = query->want & QUERY_WANT_BOX ? FMB_WANT_BOX : 0;
    result->status = (int32_t) fmb_decide(method, &pair, want, &result->answer);
    if (result->status != FMB_OK) {
        memset(result->key, 0, sizeof result->key);
        snprintf(result->detail, sizeof result->detail, "method %s: %s", method->name,
                 fmb_status_text(result->status));
        return;
    }
    result->method = method->number;
    result->dim = result->answer.has_box ? body[0].dim : 0;
    if (query->want & QUERY_WANT_CERTIFICATE)
        certify(answerer, &pair, result);
}

void answer_pair(struct answerer *answerer, const struct pair_query *query,
                 struct pair_result *result)
{
    memset(result, 0, sizeof *result);
    result->utime = query->utime;
    result->client_id = query->client_id;
    result->sequence_number = query->sequence_number;
    result->server_id = answerer->server_id;
    for (int f = 0; f < 2; f++)
        result->body_id[f] = query->frame[f].body_id;

    struct checking checking = {.result = result};
    if (!check_query(&checking, query))
        return;
    struct fmb_body body[2];
    if (find_bodies(answerer, &checking, query, body))
        decide(answerer, result, query, body);
}
