/* Answers pair queries: at once for bodies of one frame, otherwise as a scene of one pair, in
 * steps. */
#include "answerer.h"

#include "check.h"
#include "wire.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void set_side(struct check_context *context, int side)
{
    context->part = side == 0 ? "a" : "b";
    context->index = -1;
}

static bool check_pair(struct check_context *context, const struct pair_query *query)
{
    if (!check_ids(context, query->client_id, query->sequence_number) ||
        !check_request(context, query->duration, query->method, query->want,
                       FMB_WANT_BOX | FMB_WANT_CERTIFICATE | FMB_WANT_GAP))
        return false;
    for (int f = 0; f < 2; f++) {
        set_side(context, f);
        if (!check_placement(context, &query->placement[f]))
            return false;
    }
    context->part = NULL;
    return query->placement[0].dim == query->placement[1].dim ||
           check_refuse(context, FMB_DIMENSIONS_DIFFER, "dim", NULL);
}

static bool find_body(struct cache *cache, struct check_context *context,
                      const struct placement *placement, struct used_body *out)
{
    const struct cached *cached = cache_find(cache, &placement->handle);
    if (!cached)
        return check_refuse(context, FMB_UNKNOWN_BODY, "handle", "not held; send the frames");
    *out = (struct used_body){&cached->body, cached};
    return check_body_dim(context, placement, &cached->body);
}

/* If a certificate is wanted, both bodies must have one frame. On input: used: bodies found by
 * handle. */
static bool check_certificate(struct check_context *context, const struct pair_query *query,
                              const struct used_body used[2])
{
    context->part = NULL;
    for (int f = 0; f < 2 && query->want & FMB_WANT_CERTIFICATE; f++)
        if (query->placement[f].frame_count > 1 || (used[f].body && used[f].body->frame_count > 1))
            return check_refuse(context, FMB_CANNOT_DECIDE, "want",
                                "a certificate is for bodies of one frame");
    return true;
}

/* Finds the bodies given by handle. It is complete before any body is added, so that a query that
 * is refused adds nothing to the cache. */
static bool find_bodies(struct answerer *answerer, struct check_context *context,
                        const struct pair_query *query, struct used_body out[2])
{
    for (int f = 0; f < 2; f++) {
        set_side(context, f);
        if (placement_by_handle(&query->placement[f]) &&
            !find_body(answerer->cache, context, &query->placement[f], &out[f]))
            return false;
    }
    return check_certificate(context, query, out);
}

/* Adds the bodies that have frames, at most BODY_PORTION frames a call. On output: used, and the
 * handles of those with an id. Returns whether all bodies are complete. */
static bool add_bodies(struct answerer *answerer, const struct pair_query *query,
                       struct query_bodies *own, struct used_body used[2], struct handle handle[2])
{
    int32_t frames = BODY_PORTION;
    for (int f = 0; f < 2; f++) {
        if (!used[f].body)
            used[f] = answerer_intern(answerer, &query->placement[f], own, &frames, &handle[f]);
        if (!used[f].body)
            return false;
    }
    return true;
}

/* Adds the certificate to the result, if there is one. */
static void certify(struct answerer *answerer, const struct fmb_placement placement[2],
                    double duration, struct pair_result *result)
{
    size_t length;
    const enum fmb_status status =
        fmb_certificate(&placement[0], &placement[1], duration, answerer->certificate,
                        sizeof answerer->certificate, &length);
    assert(status == FMB_OK);
    (void) status;
    result->certificate = length > 0 ? answerer->certificate : NULL;
}

static void refuse_method(const struct fmb_method *method, enum fmb_status status,
                          struct pair_result *result)
{
    result->status = (int32_t) status;
    snprintf(result->detail, sizeof result->detail, "method %s: %s", method->name,
             fmb_status_text(result->status));
}

/* Sets the fields that describe box and gap. */
static void set_form(const struct pair_query *query, const struct used_body used[2],
                     struct pair_result *result)
{
    const bool has_dim = result->answer.has_box || result->answer.has_gap;
    result->dim = has_dim ? query->placement[0].dim : 0;
    result->names_frames =
        result->answer.has_gap && (used[0].body->frame_count > 1 || used[1].body->frame_count > 1);
}

static void decide(struct answerer *answerer, struct pair_result *result,
                   const struct pair_query *query, const struct used_body used[2])
{
    const struct fmb_method *method = fmb_method_by_number(query->method);
    const struct fmb_placement placement[2] = {answerer_place(&query->placement[0], used[0].body),
                                               answerer_place(&query->placement[1], used[1].body)};
    const unsigned want = (unsigned) query->want & (FMB_WANT_BOX | FMB_WANT_GAP);
    const enum fmb_status status =
        fmb_decide(method, &placement[0], &placement[1], query->duration, want, &result->answer);
    if (status != FMB_OK) {
        refuse_method(method, status, result);
        return;
    }
    result->method = method->number;
    set_form(query, used, result);
    if (query->want & FMB_WANT_CERTIFICATE)
        certify(answerer, placement, query->duration, result);
}

static void begin_result(const struct answerer *answerer, const struct pair_query *query,
                         struct pair_result *result)
{
    memset(result, 0, sizeof *result);
    result->header = query->header;
    result->server_id = answerer->server_id;
    for (int f = 0; f < 2; f++)
        result->body_id[f] = query->placement[f].body_id;
}

static void release_bodies(struct answerer *answerer, const struct used_body used[2])
{
    for (int f = 0; f < 2; f++)
        answerer_release(answerer, &used[f]);
}

/* Whether a body has several frames: in the query, or in the cache if its handle is held. */
static bool has_several_frames(const struct answerer *answerer, const struct pair_query *query)
{
    for (int f = 0; f < 2; f++) {
        const struct placement *placement = &query->placement[f];
        const struct cached *cached =
            placement_by_handle(placement) ? cache_peek(answerer->cache, &placement->handle) : NULL;
        if (placement->frame_count > 1 || (cached && cached->body.frame_count > 1))
            return true;
    }
    return false;
}

bool answer_pair(struct answerer *answerer, const struct pair_query *query,
                 struct pair_result *result)
{
    for (int f = 0; f < 2; f++) /* the memory arrives while the query is checked */
        cache_prefetch(answerer->cache, &query->placement[f]);
    begin_result(answerer, query, result);
    struct check_context context = {.status = &result->status, .detail = result->detail};
    struct used_body used[2] = {0};
    if (!check_pair(&context, query))
        return true;
    if (has_several_frames(answerer, query))
        return false;
    query_bodies_clear(&answerer->bodies);
    if (find_bodies(answerer, &context, query, used) &&
        add_bodies(answerer, query, &answerer->bodies, used, result->handle))
        decide(answerer, result, query, used);
    release_bodies(answerer, used);
    return true;
}

void answer_pair_refused(const struct answerer *answerer, const struct pair_query *query,
                         enum fmb_status status, struct pair_result *result)
{
    begin_result(answerer, query, result);
    result->status = (int32_t) status;
    snprintf(result->detail, sizeof result->detail, "%s", fmb_status_text(result->status));
}

/* ---- In steps ---- */

struct pair_job {
    bool complete;
    struct answerer *answerer; /* of the query in progress */
    struct pair_query query;
    struct pair_result result;
    struct used_body used[2];
    struct fmb_placement placement[2];
    void *memory;                  /* owned; contains the scene */
    struct fmb_scene_state *scene; /* NULL: not begun */
    struct query_bodies bodies;
    unsigned char bytes[QUERY_BYTES_MAX]; /* the message; the geometries point into it */
};

/* Each body was defined in one message. */
static const struct fmb_scene_limits limits = {
    .placements = 2, .frames = 2 * QUERY_FRAMES_MAX, .slots = 2 * QUERY_FRAMES_MAX};

struct pair_job *pair_job_create(void)
{
    struct pair_job *job = aligned_alloc(_Alignof(struct pair_job), sizeof *job);
    if (!job)
        return NULL;
    job->memory = malloc(fmb_scene_bytes(&limits));
    if (!job->memory) {
        free(job);
        return NULL;
    }
    return job;
}

void pair_job_destroy(struct pair_job *job)
{
    if (!job)
        return;
    free(job->memory);
    free(job);
}

/* Begins the engine's scene of the two placements, with one pair. */
static void begin_scene(struct pair_job *job)
{
    static const unsigned pair[1][2] = {{0, 1}};
    const struct pair_query *query = &job->query;
    const struct fmb_method *method = fmb_method_by_number(query->method);
    for (int f = 0; f < 2; f++)
        job->placement[f] = answerer_place(&query->placement[f], job->used[f].body);
    const struct fmb_scene scene = {
        .placements = job->placement,
        .placement_count = 2,
        .duration = query->duration,
        .instant = query->duration == 0,
        .method = method,
        .want = FMB_WANT_TIMES | (query->want & ~(unsigned) FMB_WANT_CERTIFICATE),
        .which = FMB_PAIRS_LISTED,
        .pairs = pair,
        .pair_count = 1};
    const enum fmb_status status = fmb_scene_begin(&scene, &limits, job->memory, &job->scene);
    assert(status == FMB_OK);
    (void) status;
}

const char *pair_job_begin(struct pair_job *job, struct answerer *answerer,
                           const unsigned char *bytes, size_t size)
{
    if (size > sizeof job->bytes)
        return "longer than a query may be";
    memcpy(job->bytes, bytes, size);
    const char *error = wire_read_pair_query(job->bytes, (uint32_t) size, &job->query);
    if (error)
        return error;
    memset(job->used, 0, sizeof job->used);
    begin_result(answerer, &job->query, &job->result);
    struct check_context context = {.status = &job->result.status, .detail = job->result.detail};
    job->complete = !check_pair(&context, &job->query) ||
                    !find_bodies(answerer, &context, &job->query, job->used);
    job->answerer = answerer;
    job->scene = NULL;
    query_bodies_clear(&job->bodies);
    return NULL;
}

static void take_answer(struct pair_job *job, const struct fmb_scene_answers *answers)
{
    const struct fmb_method *method = fmb_method_by_number(job->query.method);
    struct pair_result *result = &job->result;
    struct fmb_answer *answer = &result->answer;
    if (answers->verdicts[0] == 0) {
        refuse_method(method, FMB_CANNOT_DECIDE, result);
        return;
    }
    result->method = method->number;
    answer->verdict = (enum fmb_verdict) answers->verdicts[0];
    answer->has_contact = answer->verdict >= FMB_TOUCHING;
    answer->has_box = answer->has_contact && answers->boxes;
    if (answer->has_contact)
        memcpy(answer->contact, answers->contacts[0], sizeof answer->contact);
    if (answer->has_box)
        memcpy(answer->box, answers->boxes[0], sizeof answer->box);
    answer->has_gap = job->query.want & FMB_WANT_GAP;
    if (answer->has_gap)
        answer->gap = answers->gaps[0];
    set_form(&job->query, job->used, result);
}

bool pair_job_step(struct pair_job *job)
{
    struct fmb_scene_answers answers;
    if (job->complete)
        return true;
    if (!job->scene) {
        if (add_bodies(job->answerer, &job->query, &job->bodies, job->used, job->result.handle))
            begin_scene(job);
        return false;
    }
    job->complete = fmb_scene_step(job->scene, &answers);
    if (answers.count > 0)
        take_answer(job, &answers);
    return job->complete;
}

struct pair_result *pair_job_end(struct pair_job *job, struct answerer *answerer)
{
    release_bodies(answerer, job->used);
    if (!job->complete)
        answer_pair_refused(answerer, &job->query, FMB_BUSY, &job->result);
    return &job->result;
}
