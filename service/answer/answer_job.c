/* Answers pair and scene queries in stages: CHECKING the fields, FINDING bodies by handle, ADDING
 * bodies that have frames, DECIDING, CERTIFYING, COMPLETE. answer_job_step() does a part of one
 * stage; a refused query is COMPLETE at once. A pair query becomes a scene of one listed pair if a
 * body has several frames, a hull or a radius, if the decision may take long, or if the method is
 * not the default. All other pairs are decided at once. */
#include "answerer.h"

#include "body.h"
#include "check.h"
#include "fmb_batch.h"
#include "pair_number.h"
#include "wire.h"

#include <assert.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The largest number of bodies found in one step: tens of microseconds. A step makes at most
 * BODY_PORTION frames. */
enum { STEP_PLACEMENTS = 32 };

enum answer_stage { IDLE, CHECKING, FINDING, ADDING, DECIDING, CERTIFYING, COMPLETE };

/* The body of a placement. */
struct used_body {
    const struct fmb_body *body;
    const struct cached *cached; /* pinned, to be released; NULL: made for this query only */
};

struct answer_job {
    enum answer_stage stage;
    bool is_pair;
    struct answerer *answerer; /* NULL: no body is in use */
    struct check_context context;
    struct query_placement *placements; /* of the query */
    int32_t placement_count;
    int32_t next;        /* the next placement in FINDING and ADDING */
    int64_t frames;      /* of the placements before next in FINDING, then of all */
    bool several_frames; /* of a body */
    bool in_steps;       /* a pair that may take long: a body is large (see is_large()) */
    long capacity;       /* bytes of the result of a scene that are left for answers */
    struct fmb_scene scene;
    struct fmb_scene_state *state; /* in memory */
    void *memory;                  /* owned; of the state, else of sets of ignored pairs */
    struct used_body used[QUERY_PLACEMENTS_MAX];
    struct fmb_placement placed[QUERY_PLACEMENTS_MAX];
    struct pair_query pair;
    struct pair_result pair_result;
    struct fmb_certificate_state *certificate; /* of the pair result, or NULL */
    struct scene_result result;
    struct scene_query query;
    struct query_bodies bodies;
    unsigned char bytes[ANSWER_MESSAGE_MAX]; /* the message; the geometries point into it */
};

static const struct fmb_scene_limits limits = {.placements = QUERY_PLACEMENTS_MAX,
                                               .frames = FMB_FRAMES_MAX,
                                               .ignored = QUERY_PAIRS_MAX,
                                               .slots = FMB_SCENE_SLOTS};

struct answer_job *answer_job_create(void)
{
    assert(fmb_scene_bytes(&limits) >= 2 * QUERY_IGNORED_CAPACITY * sizeof(unsigned));
    struct answer_job *job = aligned_alloc(_Alignof(struct answer_job), sizeof *job);
    if (!job)
        return NULL;
    job->stage = IDLE;
    job->is_pair = false;
    job->certificate = NULL;
    job->answerer = NULL;
    job->memory = malloc(fmb_scene_bytes(&limits));
    if (!job->memory) {
        free(job);
        return NULL;
    }
    return job;
}

void answer_job_destroy(struct answer_job *job)
{
    if (!job)
        return;
    fmb_certificate_end(job->certificate);
    free(job->memory);
    free(job);
}

/* Releases the bodies of a query in progress, which ends it. */
static void release(struct answer_job *job)
{
    for (int32_t i = 0; job->answerer && i < job->placement_count; i++)
        if (job->used[i].cached)
            cache_release(job->answerer->cache, job->used[i].cached);
    job->answerer = NULL;
}

static enum answer_stage complete(struct answer_job *job)
{
    release(job);
    return COMPLETE;
}

/* The context of a check of placement i; of the whole query if i is -1. */
static struct check_context *at(struct answer_job *job, int32_t i)
{
    job->context.index = i;
    return &job->context;
}

/* ---- Checking ---- */

static bool check_placements(struct answer_job *job, double duration)
{
    for (int32_t i = 0; i < job->placement_count; i++) {
        const struct query_placement *placement = &job->placements[i];
        if (!check_placement(at(job, i), placement))
            return false;
        if (!job->is_pair && placement->body.dim != job->placements[0].body.dim)
            return check_refuse(at(job, i), FMB_DIMENSIONS_DIFFER, "dim", NULL);
        if (placement->placed.end_count > 0 && duration == 0)
            return check_refuse(at(job, i), FMB_BAD_DURATION, "num_end_pose", "the duration is 0");
        job->placed[i] = placement->placed;
        if (job->is_pair) /* groups are of scenes */
            job->placed[i].group = 0;
    }
    return true;
}

static bool check_pair(struct answer_job *job)
{
    const struct pair_query *query = &job->pair;
    struct check_context *context = at(job, -1);
    return check_ids(context, query->client_id, query->sequence_number) &&
           check_request(context, query->duration, query->method, query->want,
                         FMB_WANT_BOX | FMB_WANT_CERTIFICATE | FMB_WANT_GAP | FMB_WANT_POINT) &&
           check_placements(job, query->duration) &&
           (query->placement[0].body.dim == query->placement[1].body.dim ||
            check_refuse(at(job, -1), FMB_DIMENSIONS_DIFFER, "dim", NULL));
}

static bool check_indices(struct check_context *context, const char *field,
                          const unsigned (*pair)[2], int32_t count, int32_t placements)
{
    const size_t i = pairs_first_invalid(pair, (size_t) count, (size_t) placements);
    if (i == (size_t) count)
        return true;
    const bool first = pair[i][0] < (unsigned) placements;
    const bool both = first && pair[i][1] < (unsigned) placements;
    return check_refuse_at(context, FMB_BAD_PAIR, field, 2 * (int) i + first,
                           both ? "a placement against itself" : "no placement has this index");
}

/* No listed pair may be ignored. The listed pairs of each lower index are looked up together, which
 * takes O(placements + pairs) in all; the first one in the list that is ignored is named. */
static bool check_ignored(struct check_context *context, struct answer_job *job)
{
    const struct scene_query *query = &job->query;
    unsigned *memory = job->memory, first = UINT_MAX;
    struct ignored ignored, listed;
    if (query->ignored_count == 0 || query->index_count == 0)
        return true;
    const struct fmb_scene pairs = {.placement_count = (size_t) query->placement_count,
                                    .ignored = query->pair,
                                    .ignored_count = (size_t) query->index_count / 2};
    query_ignored(query, memory, &ignored);
    ignored_begin(&pairs, memory + QUERY_IGNORED_CAPACITY, &listed);
    for (unsigned a = 0; a < (unsigned) query->placement_count; a++)
        for (unsigned at = ignored_has_any(&ignored, a) ? listed.head[a] : 0; at;
             at = listed.link[at - 1]) {
            const unsigned b = query->pair[at - 1][0] + query->pair[at - 1][1] - a;
            if (at <= first && ignored_has(&ignored, a, b))
                first = at - 1;
        }
    return first == UINT_MAX ||
           check_refuse_at(context, FMB_BAD_PAIR, "indices", 2 * (int) first, "a pair to ignore");
}

/* The arrays of scene_query hold all pairs that a message of QUERY_BYTES_MAX can have; but a
 * message can have more placements, of dimension 0, than the array holds. */
static bool check_counts(struct check_context *context, const struct scene_query *query)
{
    char reason[32];
    assert(query->index_count <= 2 * QUERY_PAIRS_MAX);
    snprintf(reason, sizeof reason, "more than %d", (int) QUERY_PLACEMENTS_MAX);
    if (query->placement_count > QUERY_PLACEMENTS_MAX)
        return check_refuse(context, FMB_OVER_LIMIT, "num_placements", reason);
    if (query->index_count % 2)
        return check_refuse(context, FMB_WRONG_COUNT, "num_indices", "not two for each pair");
    if (query->index_count > 0 && query->which != FMB_PAIRS_LISTED)
        return check_refuse(context, FMB_WRONG_COUNT, "num_indices",
                            "indices without PAIRS_LISTED");
    if (query->ignored_count % 2)
        return check_refuse(context, FMB_WRONG_COUNT, "num_ignored", "not two for each pair");
    return true;
}

/* The engine's scene. On input: a query whose counts, method and which were checked. Ignored pairs
 * of a listed scene are left out, since no listed pair may be ignored. */
static struct fmb_scene scene_of(const struct answer_job *job)
{
    const struct scene_query *query = &job->query;
    const bool listed = query->which == FMB_PAIRS_LISTED;
    return (struct fmb_scene){.placements = job->placed,
                              .placement_count = (size_t) query->placement_count,
                              .duration = query->duration,
                              .instant = query->duration == 0,
                              .method = fmb_method_by_number(query->method),
                              .want = (unsigned) query->want,
                              .margin = query->margin,
                              .which = (enum fmb_pairs) query->which,
                              .split = (size_t) query->split,
                              .pairs = query->pair,
                              .pair_count = (size_t) query->index_count / 2,
                              .ignored = query->ignored,
                              .ignored_count = listed ? 0 : (size_t) query->ignored_count / 2,
                              .first_pair = (unsigned long long) query->first_pair};
}

static bool check_which(struct check_context *context, const struct answer_job *job)
{
    const struct scene_query *query = &job->query;
    const struct fmb_method *method = fmb_method_by_number(query->method);
    const bool across = query->which == FMB_PAIRS_ACROSS;
    if (query->which < FMB_PAIRS_ALL || query->which > FMB_PAIRS_ACROSS)
        return check_refuse(context, FMB_UNKNOWN_WANT, "which", NULL);
    if (query->split < 0 || query->split > (across ? query->placement_count : 0))
        return check_refuse(context, FMB_BAD_PAIR, "split",
                            across ? "not from 0 to num_placements" : "not 0");
    const struct fmb_scene scene = scene_of(job);
    if (query->first_pair < 0 || scene.first_pair > fmb_scene_pair_count(&scene))
        return check_refuse(context, FMB_BAD_PAIR, "first_pair", "there are not so many");
    if (query->which != FMB_PAIRS_LISTED && !method->certain)
        return check_refuse(context, FMB_CANNOT_DECIDE, "method", "listed pairs alone");
    return true;
}

/* No listed pair may be within a group. On input: the placements and the pairs were checked. */
static bool check_groups(struct check_context *context, const struct answer_job *job)
{
    const struct fmb_scene scene = scene_of(job);
    const size_t k = pairs_first_grouped(&scene);
    return k == scene.pair_count ||
           check_refuse_at(context, FMB_BAD_PAIR, "indices", 2 * (int) k, "a pair of one group");
}

static bool check_scene(struct answer_job *job)
{
    const struct scene_query *query = &job->query;
    struct check_context *context = at(job, -1);
    const int32_t want = query->want | (query->margin > 0 ? FMB_WANT_GAP : 0);
    return check_ids(context, query->client_id, query->sequence_number) &&
           ((query->margin >= 0 && isfinite(query->margin)) ||
            check_refuse(context, FMB_BAD_MARGIN, "margin", "negative or not finite")) &&
           check_request(context, query->duration, query->method, want,
                         FMB_WANT_BOX | FMB_WANT_TIMES | FMB_WANT_GAP | FMB_WANT_POINT) &&
           check_counts(context, query) && check_which(context, job) &&
           check_placements(job, query->duration) &&
           check_indices(at(job, -1), "indices", query->pair, query->index_count / 2,
                         query->placement_count) &&
           check_indices(context, "ignored", query->ignored, query->ignored_count / 2,
                         query->placement_count) &&
           check_groups(context, job) && check_ignored(context, job);
}

/* The end of the placements of this step. If there are several steps, prefetches their bodies. */
static int32_t step_end(const struct answer_job *job)
{
    const int32_t left = job->placement_count - job->next;
    const int32_t end = job->next + (left < STEP_PLACEMENTS ? left : STEP_PLACEMENTS);
    for (int32_t i = job->next; job->placement_count > STEP_PLACEMENTS && i < end; i++)
        cache_prefetch(job->answerer->cache, &job->placements[i]);
    return end;
}

static void begin_result(struct answer_job *job, const struct answerer *answerer,
                         enum fmb_status status)
{
    if (job->is_pair)
        answerer_begin_pair(answerer, &job->pair, status, &job->pair_result);
    else
        answerer_begin(answerer, &job->query.header, status, &job->result.head, SCENE_HEAD_BYTES);
}

/* The stage CHECKING. No bodies are in use yet, so a refused query has none to release. The memory
 * of a few bodies arrives meanwhile. */
static enum answer_stage check(struct answer_job *job, struct answerer *answerer)
{
    for (int32_t i = 0; job->placement_count <= STEP_PLACEMENTS && i < job->placement_count; i++)
        cache_prefetch(answerer->cache, &job->placements[i]);
    begin_result(job, answerer, FMB_OK);
    if (!(job->is_pair ? check_pair(job) : check_scene(job)))
        return COMPLETE;
    memset(job->used, 0, (size_t) job->placement_count * sizeof *job->used);
    job->bodies.used = 0;
    job->bodies.maker.memory = NULL;
    job->answerer = answerer;
    job->next = 0;
    job->frames = 0;
    job->several_frames = job->in_steps = false;
    return FINDING;
}

/* ---- Bodies ---- */

/* Whether a body has several frames, is a hull, or has a radius. */
static bool is_large(const struct fmb_body *body)
{
    return body->frame_count > 1 || body->one.shape == FMB_HULL || body->one.radius != 0;
}

bool answer_job_is_short(const struct answer_job *job)
{
    return job->stage != ADDING && !job->in_steps;
}

static bool refuse_unknown(struct answer_job *job, int32_t i)
{
    return check_refuse(at(job, i), FMB_UNKNOWN_BODY, "handle", "not held; send the frames");
}

/* Adds the frames of a body to the sum over the query. One message cannot define more than the
 * limit, but it may name bodies by handle. */
static bool count_frames(struct answer_job *job, int32_t i, int64_t frames)
{
    job->frames += frames;
    return job->frames <= FMB_FRAMES_MAX || check_refuse(at(job, i), FMB_OVER_LIMIT, "num_frames",
                                                         "more than 65536 frames in the query");
}

/* Finds the body of a placement by handle. Counts its frames, or those of a placement that has
 * frames. Returns false if the query is refused. A handle that is not held is noted in the result
 * of a scene. */
static bool find_one(struct answer_job *job, int32_t i)
{
    const struct query_placement *placement = &job->placements[i];
    if (!query_by_handle(placement))
        return count_frames(job, i, placement->body.frame_count);
    const struct cached *cached = cache_find(job->answerer->cache, &placement->body.handle);
    if (!cached && job->is_pair)
        return refuse_unknown(job, i);
    if (!cached) {
        job->result.unknown[job->result.unknown_count++] = (unsigned) i;
        return true;
    }
    job->used[i] = (struct used_body){&cached->body, cached};
    if (placement->body.dim != cached->body.dim)
        return check_refuse(at(job, i), FMB_WRONG_DIMENSION, "dim",
                            "not that of the body with this handle");
    return count_frames(job, i, cached->body.frame_count);
}

/* If a certificate is wanted, both bodies must have one frame. */
static bool check_certificate(struct answer_job *job)
{
    return !job->is_pair || !(job->pair.want & FMB_WANT_CERTIFICATE) || job->frames == 2 ||
           check_refuse(at(job, -1), FMB_CANNOT_DECIDE, "want",
                        "a certificate is for bodies of one frame");
}

/* Finds the body of placement i, which has frames; or makes it, at most *frames frames a call, and
 * adds it to the cache unless it is anonymous or the cache has no memory for it. Returns false
 * while it is not complete. A body with an id gets its handle. */
static bool intern(struct answer_job *job, int32_t i, int32_t *frames)
{
    struct cache *cache = job->answerer->cache;
    struct query_bodies *own = &job->bodies;
    struct body_view *view = &job->placements[i].body;
    const int64_t id = job->placements[i].placed.id;
    const struct cached *cached = NULL;
    if (!own->maker.memory) {
        cached = id ? cache_lookup(cache, id, view) : NULL;
        if (cached) {
            job->used[i] = (struct used_body){&cached->body, cached};
            return true;
        }
        body_begin(&own->maker, view, own->memory + own->used);
    }
    const struct fmb_body *body = body_continue(&own->maker, frames);
    if (!body)
        return false;
    own->used += body_bytes(view);
    own->maker.memory = NULL;
    if (id)
        cached = cache_add(cache, id, view, body);
    job->used[i] = (struct used_body){cached ? &cached->body : body, cached};
    return true;
}

/* ---- The answer of a pair ---- */

/* Completes the result of a pair with the status of its answer. */
static enum answer_stage complete_pair(struct answer_job *job, enum fmb_status status)
{
    const struct fmb_method *method = fmb_method_by_number(job->pair.method);
    struct pair_result *result = &job->pair_result;
    const struct fmb_answer *answer = &result->answer;
    if (status != FMB_OK) {
        result->answer = (struct fmb_answer){.has_contact = false};
        result->status = (int32_t) status;
        snprintf(result->detail, sizeof result->detail, "method %s: %s", method->name,
                 fmb_status_text(result->status));
    } else {
        result->method = method->number;
        const bool uses_dim = answer->has_box || answer->has_point || answer->has_gap;
        result->dim = uses_dim ? job->placements[0].body.dim : 0;
        result->names_frames = answer->has_gap && job->several_frames;
    }
    return complete(job);
}

/* Performs a step of the certificate. Once it is complete, adds it to the result, and completes the
 * result. */
static enum answer_stage certify(struct answer_job *job)
{
    const char *text = fmb_certificate_step(job->certificate);
    if (!text)
        return CERTIFYING;
    job->pair_result.certificate = text[0] ? text : NULL;
    return complete_pair(job, FMB_OK);
}

/* Begins the certificate, if it is wanted and there is a verdict; else completes the result. */
static enum answer_stage begin_certificate(struct answer_job *job, enum fmb_status status)
{
    if (status == FMB_OK && job->pair.want & FMB_WANT_CERTIFICATE)
        status = fmb_certificate_begin(&job->placed[0], &job->placed[1], job->pair.duration,
                                       &job->certificate);
    return job->certificate ? certify(job) : complete_pair(job, status);
}

/* Decides a pair by the default method. Returns false if that takes steps, or if another method is
 * requested. */
static bool decide_at_once(struct answer_job *job)
{
    const struct pair_query *query = &job->pair;
    return !job->in_steps && fmb_method_by_number(query->method) == fmb_method_default() &&
           fmb_decide_at_once(&job->placed[0], &job->placed[1], query->duration,
                              (unsigned) query->want & ~(unsigned) FMB_WANT_CERTIFICATE,
                              &job->pair_result.answer);
}

/* ---- Pairs of a scene ---- */

/* Sets the fields of the result of a scene that do not depend on the pairs. */
static void begin_answers(struct answer_job *job)
{
    const struct scene_query *query = &job->query;
    const struct fmb_method *method = job->scene.method;
    struct scene_result *result = &job->result;
    result->method = method->number;
    result->names_pairs = query->which != FMB_PAIRS_LISTED;
    result->has_times = query->want & FMB_WANT_TIMES;
    result->has_boxes = query->want & FMB_WANT_BOX && method->boxes;
    result->has_points = query->want & FMB_WANT_POINT && method->certain;
    result->has_gaps = query->want & FMB_WANT_GAP || query->margin > 0;
    result->names_frames = result->has_gaps && job->several_frames;
    const bool uses_dim = result->has_boxes || result->has_points || result->has_gaps;
    result->dim = uses_dim && query->placement_count > 0 ? query->placement[0].body.dim : 0;
    job->capacity = QUERY_BYTES_MAX - WIRE_SCENE_RESULT_BYTES - HANDLE_BYTES * result->handle_count;
}

/* Begins the engine's scene, or decides a pair of frames. */
static enum answer_stage begin_deciding(struct answer_job *job)
{
    if (job->is_pair && decide_at_once(job))
        return begin_certificate(job, FMB_OK);
    const struct pair_query *pair = &job->pair;
    job->scene = job->is_pair ? pair_scene(fmb_method_by_number(pair->method), pair->duration,
                                           (unsigned) pair->want & ~(unsigned) FMB_WANT_CERTIFICATE)
                              : scene_of(job);
    job->scene.placements = job->placed;
    if (!job->is_pair)
        begin_answers(job);
    const enum fmb_status status = fmb_scene_begin(&job->scene, &limits, job->memory, &job->state);
    assert(status == FMB_OK);
    (void) status;
    return DECIDING;
}

/* Notes the handle of a body that came whole with an id in the result. */
static void note_handle(struct answer_job *job, int32_t i)
{
    const struct query_placement *placement = &job->placements[i];
    if (query_by_handle(placement) || placement->placed.id == 0)
        return;
    if (job->is_pair)
        job->pair_result.handle[i] = placement->body.handle;
    else
        job->result.handle[job->result.handle_count++] = placement->body.handle;
}

/* Adds the bodies of placements that have frames, and fills in the engine's placements. Then begins
 * to decide. */
static enum answer_stage add(struct answer_job *job)
{
    int32_t frames = BODY_PORTION;
    for (const int32_t end = step_end(job); job->next < end && frames > 0; job->next++) {
        const int32_t i = job->next;
        if (!job->used[i].body && !intern(job, i, &frames))
            break;
        note_handle(job, i);
        job->placed[i].body = job->used[i].body;
        job->several_frames = job->several_frames || job->used[i].body->frame_count > 1;
        job->in_steps = job->in_steps || is_large(job->used[i].body);
    }
    return job->next < job->placement_count ? ADDING : begin_deciding(job);
}

/* Finds the bodies of all placements that name them by handle. This ends before any body is added,
 * so that a query that is refused adds nothing to the cache. */
static enum answer_stage find(struct answer_job *job)
{
    for (const int32_t end = step_end(job); job->next < end; job->next++)
        if (!find_one(job, job->next)) {
            job->result.unknown_count = 0;
            return complete(job);
        }
    if (job->next < job->placement_count)
        return FINDING;
    if (!job->is_pair && job->result.unknown_count > 0) {
        refuse_unknown(job, (int32_t) job->result.unknown[0]);
        return complete(job);
    }
    if (!check_certificate(job))
        return complete(job);
    job->next = 0;
    return job->is_pair ? add(job) : ADDING; /* a step less for short queries */
}

/* Bytes of the result that a pair with this verdict takes. */
static long size_of(const struct scene_result *result, unsigned char verdict)
{
    long size = result->names_pairs ? 1 + WIRE_PAIR_BYTES : 1;
    if (verdict >= FMB_TOUCHING && result->has_times)
        size += 2 * (long) sizeof(double);
    if (verdict >= FMB_TOUCHING && result->has_boxes)
        size += 2 * result->dim * (long) sizeof(double);
    if (verdict >= FMB_TOUCHING && result->has_points)
        size += (1 + result->dim) * (long) sizeof(double);
    if (result->has_gaps)
        size += wire_gap_bytes(result->dim, result->names_frames);
    return size;
}

static void append_contact(struct scene_result *result, const struct fmb_scene_answers *answers,
                           size_t k)
{
    const int32_t contact = result->contact_count++;
    if (result->has_times)
        memcpy(&result->times[2 * contact], answers->contacts[k], sizeof answers->contacts[k]);
    for (int i = 0; i < 2 * result->dim && result->has_boxes; i++)
        result->boxes[2 * result->dim * contact + i] =
            answers->boxes[k][i / result->dim][i % result->dim];
    const int numbers = 1 + result->dim;
    if (result->has_points)
        memcpy(&result->points[numbers * contact], answers->points[k],
               (size_t) numbers * sizeof(double));
}

/* Appends answer k to the result. Returns false, and changes nothing, if it does not fit. */
static bool append(struct answer_job *job, const struct fmb_scene_answers *answers, size_t k)
{
    struct scene_result *result = &job->result;
    const unsigned char verdict = answers->verdicts[k];
    const long size = size_of(result, verdict);
    if (size > job->capacity)
        return false;
    job->capacity -= size;
    const int32_t n = result->verdict_count++;
    result->verdict[n] = verdict;
    if (result->names_pairs)
        memcpy(result->pair[n], answers->pairs[k], sizeof result->pair[n]);
    if (result->has_gaps)
        result->gap[n] = answers->gaps[k];
    if (verdict >= FMB_TOUCHING)
        append_contact(result, answers, k);
    return true;
}

/* append_all() for results that have verdicts only, one byte each, as most scenes request. */
static size_t append_verdicts(struct answer_job *job, const struct fmb_scene_answers *answers)
{
    struct scene_result *result = &job->result;
    const size_t count =
        job->capacity < (long) answers->count ? (size_t) job->capacity : answers->count;
    int32_t contacts = 0;
    if (count > 0)
        memcpy(result->verdict + result->verdict_count, answers->verdicts, count);
    for (size_t k = 0; k < count; k++)
        contacts += answers->verdicts[k] >= FMB_TOUCHING;
    result->contact_count += contacts;
    result->verdict_count += (int32_t) count;
    job->capacity -= (long) count;
    return count;
}

/* Appends as many of the answers as fit. Returns their number. */
static size_t append_all(struct answer_job *job, const struct fmb_scene_answers *answers)
{
    const struct scene_result *result = &job->result;
    size_t k = 0;
    if (!result->names_pairs && !result->has_times && !result->has_boxes && !result->has_points &&
        !result->has_gaps)
        return append_verdicts(job, answers);
    while (k < answers->count && append(job, answers, k))
        k++;
    return k;
}

static enum answer_stage complete_at(struct answer_job *job, unsigned long long end_pair)
{
    job->result.end_pair = (int32_t) end_pair;
    return complete(job);
}

/* Decides the next pairs. Complete after the last pair, or when the result is full. */
static enum answer_stage decide(struct answer_job *job)
{
    struct fmb_scene_answers answers;
    const bool done = fmb_scene_step(job->state, &answers);
    if (job->is_pair && answers.count == 0)
        return DECIDING;
    if (job->is_pair) {
        fmb_scene_answer(&answers, 0, &job->pair_result.answer);
        return begin_certificate(job, answers.verdicts[0] ? FMB_OK : FMB_CANNOT_DECIDE);
    }
    const size_t count = append_all(job, &answers);
    if (count < answers.count) {
        const unsigned long long end = fmb_scene_number(job->state, count);
        fmb_scene_end(job->state);
        return complete_at(job, end);
    }
    return done ? complete_at(job, fmb_scene_next_pair(job->state)) : DECIDING;
}

/* ---- Steps ---- */

unsigned char *answer_job_message(struct answer_job *job)
{
    return job->bytes;
}

const char *answer_job_begin(struct answer_job *job, enum answer_kind kind,
                             const unsigned char *bytes, size_t size)
{
    release(job);
    fmb_certificate_end(job->certificate);
    job->certificate = NULL;
    job->stage = IDLE;
    if (size > QUERY_BYTES_MAX)
        return "longer than a query may be";
    if (size > 0 && bytes != job->bytes) /* without bytes there may be no address */
        memcpy(job->bytes, bytes, size);
    job->is_pair = kind == ANSWER_PAIR;
    const char *error = job->is_pair
                            ? wire_read_pair_query(job->bytes, (uint32_t) size, &job->pair)
                            : wire_read_scene_query(job->bytes, (uint32_t) size, &job->query);
    job->context = (struct check_context){job->is_pair ? &job->pair_result.head : &job->result.head,
                                          job->is_pair, -1};
    job->placements = job->is_pair ? job->pair.placement : job->query.placement;
    job->placement_count = job->is_pair ? 2 : job->query.placement_count;
    if (!error)
        job->stage = CHECKING;
    return error;
}

bool answer_job_step(struct answer_job *job, struct answerer *answerer)
{
    switch (job->stage) {
    case CHECKING: job->stage = check(job, answerer); break;
    case FINDING: job->stage = find(job); break;
    case ADDING: job->stage = add(job); break;
    case DECIDING: job->stage = decide(job); break;
    case CERTIFYING: job->stage = certify(job); break;
    case IDLE: assert(!"a job that was begun"); break;
    case COMPLETE: break;
    }
    return job->stage == COMPLETE;
}

bool answer_job_has_answers(const struct answer_job *job)
{
    return !job->is_pair && job->stage == DECIDING &&
           fmb_scene_next_pair(job->state) > job->scene.first_pair;
}

void answer_job_stop(struct answer_job *job)
{
    assert(job->answerer);
    if (job->stage == DECIDING)
        fmb_scene_end(job->state);
    if (answer_job_has_answers(job))
        job->result.end_pair = (int32_t) fmb_scene_next_pair(job->state);
    else
        begin_result(job, job->answerer, FMB_BUSY);
    job->stage = complete(job);
}

/* ---- The query and its result ---- */

const struct query_placement *answer_job_placements(const struct answer_job *job, int32_t *count)
{
    *count = job->is_pair ? 2 : query_stored_placements(&job->query);
    return job->placements;
}

const struct pair_result *answer_job_pair_result(const struct answer_job *job)
{
    assert(job->stage == COMPLETE && job->is_pair);
    return &job->pair_result;
}

const struct scene_result *answer_job_scene_result(const struct answer_job *job)
{
    assert(job->stage == COMPLETE && !job->is_pair);
    return &job->result;
}

size_t answer_job_write(struct answer_job *job, int64_t compute_ns,
                        unsigned char out[QUERY_BYTES_MAX], int32_t *status)
{
    assert(job->stage == COMPLETE);
    *status = job->context.result->status;
    job->context.result->compute_ns = compute_ns;
    return job->is_pair ? wire_write_pair_result(&job->pair_result, out)
                        : wire_write_scene_result(&job->result, out);
}

int32_t answer_job_decided(struct answer_job *job)
{
    const struct scene_result *result = &job->result;
    assert(job->stage == COMPLETE);
    if (job->is_pair || job->context.result->status != FMB_OK)
        return job->context.result->status == FMB_OK;
    int64_t pairs = query_pairs_decided(&job->query, result->end_pair, job->memory);
    for (int32_t i = 0; i < result->verdict_count; i++)
        pairs -= result->verdict[i] == 0;
    return (int32_t) pairs;
}
