/* A scene query is answered in stages: CHECKING its fields, FINDING bodies by handle, ADDING bodies
 * that have frames, PREPARED for the engine, DECIDING, COMPLETE. scene_job_step() does a part of
 * one stage; a refused query is COMPLETE at once. */
#include "answerer.h"

#include "check.h"
#include "wire.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The largest number of bodies found in one step: tens of microseconds. A step makes at most
 * BODY_PORTION frames. */
enum { STEP_PLACEMENTS = 32 };

enum answer_stage { IDLE, CHECKING, FINDING, ADDING, PREPARED, DECIDING, COMPLETE };

struct scene_job {
    enum answer_stage stage;
    struct answerer *answerer; /* of the query in progress */
    int32_t next;              /* the next placement in FINDING and ADDING */
    int64_t frames;            /* of the placements before next in FINDING, then of all */
    bool several_frames;       /* of a body */
    long capacity;             /* bytes of the result that are left for answers */
    struct fmb_scene scene;
    struct fmb_scene_state *state; /* in memory */
    void *memory;                  /* owned; fmb_scene_bytes(&limits) bytes */
    struct used_body used[QUERY_PLACEMENTS_MAX];
    struct fmb_placement placement[QUERY_PLACEMENTS_MAX];
    struct query_marks marks; /* bit_of(pair) in check_ignored(); also of query_pairs_decided() */
    struct scene_result result;
    struct scene_query query;
    struct query_bodies bodies;
    unsigned char bytes[QUERY_BYTES_MAX]; /* the message; the geometries point into it */
};

static const struct fmb_scene_limits limits = {.placements = QUERY_PLACEMENTS_MAX,
                                               .frames = FMB_FRAMES_MAX,
                                               .ignored = QUERY_PAIRS_MAX,
                                               .slots = FMB_SCENE_SLOTS};

struct scene_job *scene_job_create(void)
{
    struct scene_job *job = aligned_alloc(_Alignof(struct scene_job), sizeof *job);
    if (!job)
        return NULL;
    job->stage = IDLE;
    job->memory = malloc(fmb_scene_bytes(&limits));
    if (!job->memory) {
        free(job);
        return NULL;
    }
    return job;
}

void scene_job_destroy(struct scene_job *job)
{
    if (!job)
        return;
    free(job->memory);
    free(job);
}

const struct scene_query *scene_job_query(const struct scene_job *job)
{
    return &job->query;
}

struct scene_result *scene_job_result(struct scene_job *job)
{
    assert(job->stage == COMPLETE);
    return &job->result;
}

/* Index of the bit of a pair, in either order, in scene_job.marks. */
static size_t bit_of(const unsigned pair[2])
{
    const unsigned lower = pair[0] < pair[1] ? pair[0] : pair[1];
    const unsigned upper = pair[0] < pair[1] ? pair[1] : pair[0];
    return (size_t) lower * QUERY_PLACEMENTS_MAX + upper;
}

int32_t scene_job_decided(struct scene_job *job)
{
    const struct scene_result *result = scene_job_result(job);
    if (result->status != FMB_OK)
        return 0;
    int64_t pairs = query_pairs_decided(&job->query, result->end_pair, &job->marks);
    for (int32_t i = 0; i < result->verdict_count; i++)
        pairs -= result->verdict[i] == 0;
    return (int32_t) pairs;
}

/* Releases the bodies of a query in progress, which ends it. */
static void release(struct scene_job *job)
{
    for (int32_t i = 0; job->answerer && i < job->query.placement_count; i++)
        answerer_release(job->answerer, &job->used[i]);
    job->answerer = NULL;
}

/* Sets all fields of the result except the contents of its arrays. */
static void begin_result(const struct answerer *answerer, const struct query_header *query,
                         struct scene_result *result)
{
    result->header = *query;
    result->server_id = answerer->server_id;
    result->status = FMB_OK;
    result->detail[0] = '\0';
    result->method = 0;
    result->end_pair = 0;
    result->compute_ns = 0;
    result->dim = 0;
    result->unknown_count = result->handle_count = 0;
    result->verdict_count = result->contact_count = 0;
    result->names_pairs = result->has_times = result->has_boxes = result->has_gaps = false;
    result->names_frames = false;
}

void answer_scene_refused(const struct answerer *answerer, const struct query_header *query,
                          enum fmb_status status, struct scene_result *result)
{
    begin_result(answerer, query, result);
    result->status = (int32_t) status;
    snprintf(result->detail, sizeof result->detail, "%s", fmb_status_text(result->status));
}

/* ---- Checking ---- */

static bool check_placements(struct check_context *context, const struct scene_query *query)
{
    context->part = "placements";
    for (int32_t i = 0; i < query->placement_count; i++) {
        const struct placement *placement = &query->placement[i];
        context->index = i;
        if (!check_placement(context, placement))
            return false;
        if (placement->dim != query->placement[0].dim)
            return check_refuse(context, FMB_DIMENSIONS_DIFFER, "dim", NULL);
    }
    context->part = NULL;
    return true;
}

/* Number of pairs that are_valid_pairs() checks at once. */
enum { PAIR_GROUP = 16 };

/* Whether each of PAIR_GROUP pairs has two different indices below placements. Compilers vectorize
 * the loop only if the function is not inlined. */
static bool __attribute__((noinline))
are_valid_pairs(const unsigned (*restrict pair)[2], unsigned placements)
{
    unsigned bad = 0;
    for (int i = 0; i < PAIR_GROUP; i++)
        bad |= (unsigned) (pair[i][0] >= placements) | (unsigned) (pair[i][1] >= placements) |
               (unsigned) (pair[i][0] == pair[i][1]);
    return !bad;
}

static bool check_pair_at(struct check_context *context, const char *field, const unsigned pair[2],
                          int32_t i, unsigned placements)
{
    const bool inside = pair[0] < placements && pair[1] < placements;
    return (inside && pair[0] != pair[1]) ||
           check_refuse_at(context, FMB_BAD_PAIR, field, 2 * i + (pair[0] < placements),
                           inside ? "a placement against itself" : "no placement has this index");
}

/* Checks count pairs: whole groups of PAIR_GROUP at once, the pairs of an invalid group and the
 * remainder one by one. */
static bool check_indices(struct check_context *context, const char *field,
                          const unsigned (*pair)[2], int32_t count, int32_t placements)
{
    const unsigned end = (unsigned) placements;
    for (int32_t i = 0; i < count; i++) {
        const bool many = i % PAIR_GROUP == 0 && i + PAIR_GROUP <= count;
        if (many && are_valid_pairs(pair + i, end))
            i += PAIR_GROUP - 1;
        else if (!check_pair_at(context, field, pair[i], i, end))
            return false;
    }
    return true;
}

/* No listed pair may be ignored. Only the bits of listed pairs are read: they are cleared first, so
 * that the 1.1 million bits need no initialization. */
static bool check_ignored(struct check_context *context, struct scene_job *job)
{
    const struct scene_query *query = &job->query;
    if (query->ignored_count == 0)
        return true;
    for (int32_t i = 0; i < query->index_count / 2; i++)
        job->marks.bit[bit_of(query->pair[i]) / 8] &=
            (unsigned char) ~(1u << bit_of(query->pair[i]) % 8);
    for (int32_t i = 0; i < query->ignored_count / 2; i++)
        job->marks.bit[bit_of(query->ignored[i]) / 8] |=
            (unsigned char) (1u << bit_of(query->ignored[i]) % 8);
    for (int32_t i = 0; i < query->index_count / 2; i++)
        if (job->marks.bit[bit_of(query->pair[i]) / 8] >> bit_of(query->pair[i]) % 8 & 1)
            return check_refuse_at(context, FMB_BAD_PAIR, "indices", 2 * i, "a pair to ignore");
    return true;
}

/* No listed pair may be within a group. */
static bool check_groups(struct check_context *context, const struct scene_query *query)
{
    const struct placement *placement = query->placement;
    bool groups = false;
    for (int32_t i = 0; i < query->placement_count; i++)
        groups = groups || placement[i].group;
    for (int32_t i = 0; groups && i < query->index_count / 2; i++) {
        const int64_t group = placement[query->pair[i][0]].group;
        if (group && group == placement[query->pair[i][1]].group)
            return check_refuse_at(context, FMB_BAD_PAIR, "indices", 2 * i, "a pair of one group");
    }
    return true;
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

/* The engine's scene, without its placements. On input: a query whose counts, method and which were
 * checked. Ignored pairs of a listed scene are left out, since no listed pair may be ignored. */
static struct fmb_scene scene_of(const struct scene_query *query)
{
    const bool listed = query->which == FMB_PAIRS_LISTED;
    return (struct fmb_scene){.placement_count = (size_t) query->placement_count,
                              .duration = query->duration,
                              .instant = query->duration == 0,
                              .method = fmb_method_by_number(query->method),
                              .which = (enum fmb_pairs) query->which,
                              .split = (size_t) query->split,
                              .pairs = query->pair,
                              .pair_count = (size_t) query->index_count / 2,
                              .ignored = query->ignored,
                              .ignored_count = listed ? 0 : (size_t) query->ignored_count / 2,
                              .first_pair = (unsigned long long) query->first_pair};
}

static bool check_which(struct check_context *context, const struct scene_query *query)
{
    const struct fmb_method *method = fmb_method_by_number(query->method);
    const bool across = query->which == FMB_PAIRS_ACROSS;
    if (query->which < FMB_PAIRS_ALL || query->which > FMB_PAIRS_ACROSS)
        return check_refuse(context, FMB_UNKNOWN_WANT, "which", NULL);
    if (query->split < 0 || query->split > (across ? query->placement_count : 0))
        return check_refuse(context, FMB_BAD_PAIR, "split",
                            across ? "not from 0 to num_placements" : "not 0");
    const struct fmb_scene scene = scene_of(query);
    if (query->first_pair < 0 || scene.first_pair > fmb_scene_pair_count(&scene))
        return check_refuse(context, FMB_BAD_PAIR, "first_pair", "there are not so many");
    if (query->which != FMB_PAIRS_LISTED && !method->certain)
        return check_refuse(context, FMB_CANNOT_DECIDE, "method", "listed pairs alone");
    return true;
}

static bool check_margin(struct check_context *context, const struct scene_query *query)
{
    return (query->margin >= 0 && isfinite(query->margin)) ||
           check_refuse(context, FMB_BAD_MARGIN, "margin", "negative or not finite");
}

static bool check_scene(struct check_context *context, struct scene_job *job)
{
    const struct scene_query *query = &job->query;
    const int32_t want = query->want | (query->margin > 0 ? FMB_WANT_GAP : 0);
    return check_ids(context, query->client_id, query->sequence_number) &&
           check_margin(context, query) &&
           check_request(context, query->duration, query->method, want,
                         FMB_WANT_BOX | FMB_WANT_TIMES | FMB_WANT_GAP) &&
           check_counts(context, query) && check_which(context, query) &&
           check_placements(context, query) &&
           check_indices(context, "indices", query->pair, query->index_count / 2,
                         query->placement_count) &&
           check_indices(context, "ignored", query->ignored, query->ignored_count / 2,
                         query->placement_count) &&
           check_groups(context, query) && check_ignored(context, job);
}

static struct check_context context_of(struct scene_job *job)
{
    return (struct check_context){.status = &job->result.status, .detail = job->result.detail};
}

/* The stage CHECKING. No bodies are in use yet, so a refused query has none to release. */
static enum answer_stage check(struct scene_job *job)
{
    const struct scene_query *query = &job->query;
    struct check_context context = context_of(job);
    begin_result(job->answerer, &query->header, &job->result);
    if (!check_scene(&context, job)) {
        job->answerer = NULL;
        return COMPLETE;
    }
    memset(job->used, 0, (size_t) query->placement_count * sizeof *job->used);
    query_bodies_clear(&job->bodies);
    job->next = 0;
    job->frames = 0;
    job->several_frames = false;
    return FINDING;
}

/* ---- Bodies ---- */

static enum answer_stage complete(struct scene_job *job)
{
    release(job);
    return COMPLETE;
}

/* Prefetches the bodies of the placements of this step. Returns the end of these placements. */
static int32_t prefetch_placements(const struct scene_job *job)
{
    const int32_t left = job->query.placement_count - job->next;
    const int32_t end = job->next + (left < STEP_PLACEMENTS ? left : STEP_PLACEMENTS);
    for (int32_t i = job->next; i < end; i++)
        cache_prefetch(job->answerer->cache, &job->query.placement[i]);
    return end;
}

static enum answer_stage refuse_unknown(struct scene_job *job)
{
    struct check_context context = context_of(job);
    context.part = "placements";
    context.index = (int32_t) job->result.unknown[0];
    check_refuse(&context, FMB_UNKNOWN_BODY, "handle", "not held; send the frames");
    return complete(job);
}

/* Finds the body of a placement by handle. Counts its frames, or those of a placement that has
 * frames. Returns false if the query is refused. A handle that is not held is noted in the result.
 */
static bool find_one(struct scene_job *job, int32_t i)
{
    const struct placement *placement = &job->query.placement[i];
    struct check_context context = context_of(job);
    context.part = "placements";
    context.index = i;
    if (!placement_by_handle(placement))
        return check_frames(&context, placement->frame_count, &job->frames);
    const struct cached *cached = cache_find(job->answerer->cache, &placement->handle);
    if (!cached) {
        job->result.unknown[job->result.unknown_count++] = (unsigned) i;
        return true;
    }
    job->used[i] = (struct used_body){&cached->body, cached};
    return check_body_dim(&context, placement, &cached->body) &&
           check_frames(&context, cached->body.frame_count, &job->frames);
}

/* Finds the bodies of all placements that name them by handle. This ends before any body is added,
 * so that a query with a handle that is not held adds nothing to the cache. */
static enum answer_stage find(struct scene_job *job)
{
    const int32_t end = prefetch_placements(job);
    for (; job->next < end; job->next++)
        if (!find_one(job, job->next)) {
            job->result.unknown_count = 0;
            return complete(job);
        }
    if (job->next < job->query.placement_count)
        return FINDING;
    if (job->result.unknown_count > 0)
        return refuse_unknown(job);
    job->next = 0;
    return ADDING;
}

/* Adds the bodies of placements that have frames, and fills in the engine's placements. */
static enum answer_stage add(struct scene_job *job)
{
    const int32_t end = prefetch_placements(job);
    struct scene_result *result = &job->result;
    for (int32_t frames = BODY_PORTION; job->next < end && frames > 0; job->next++) {
        const int32_t i = job->next;
        const struct placement *placement = &job->query.placement[i];
        if (!placement_by_handle(placement)) {
            job->used[i] = answerer_intern(job->answerer, placement, &job->bodies, &frames,
                                           &result->handle[result->handle_count]);
            if (!job->used[i].body)
                break;
            result->handle_count += placement->body_id != 0;
        }
        job->placement[i] = answerer_place(placement, job->used[i].body);
        job->placement[i].group = placement->group;
        job->several_frames = job->several_frames || job->used[i].body->frame_count > 1;
    }
    return job->next < job->query.placement_count ? ADDING : PREPARED;
}

/* ---- Pairs ---- */

/* Begins the engine's scene, and sets the fields of the result that do not depend on the pairs. */
static enum answer_stage begin_pairs(struct scene_job *job)
{
    const struct scene_query *query = &job->query;
    struct scene_result *result = &job->result;
    struct fmb_scene *scene = &job->scene;
    *scene = scene_of(query);
    scene->placements = job->placement;
    scene->want = query->want;
    scene->margin = query->margin;
    result->method = scene->method->number;
    result->names_pairs = query->which != FMB_PAIRS_LISTED;
    result->has_times = query->want & FMB_WANT_TIMES;
    result->has_boxes = query->want & FMB_WANT_BOX && scene->method->boxes;
    result->has_gaps = query->want & FMB_WANT_GAP || query->margin > 0;
    result->names_frames = result->has_gaps && job->several_frames;
    const bool uses_dim = result->has_boxes || result->has_gaps;
    result->dim = uses_dim && query->placement_count > 0 ? query->placement[0].dim : 0;
    job->capacity = QUERY_BYTES_MAX - WIRE_SCENE_RESULT_BYTES - HANDLE_BYTES * result->handle_count;
    const enum fmb_status status = fmb_scene_begin(scene, &limits, job->memory, &job->state);
    assert(status == FMB_OK);
    (void) status;
    return DECIDING;
}

/* ---- Result ---- */

/* Bytes of the result that a pair with this verdict takes. */
static long size_of(const struct scene_result *result, unsigned char verdict)
{
    long size = result->names_pairs ? 1 + WIRE_PAIR_BYTES : 1;
    if (verdict >= FMB_TOUCHING && result->has_times)
        size += 2 * (long) sizeof(double);
    if (verdict >= FMB_TOUCHING && result->has_boxes)
        size += 2 * result->dim * (long) sizeof(double);
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
}

/* Appends answer k to the result. Returns false, and changes nothing, if it does not fit. */
static bool append(struct scene_job *job, const struct fmb_scene_answers *answers, size_t k)
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
static size_t append_verdicts(struct scene_job *job, const struct fmb_scene_answers *answers)
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
static size_t append_all(struct scene_job *job, const struct fmb_scene_answers *answers)
{
    const struct scene_result *result = &job->result;
    size_t k = 0;
    if (!result->names_pairs && !result->has_times && !result->has_boxes && !result->has_gaps)
        return append_verdicts(job, answers);
    while (k < answers->count && append(job, answers, k))
        k++;
    return k;
}

static enum answer_stage complete_at(struct scene_job *job, unsigned long long end_pair)
{
    job->result.end_pair = (int32_t) end_pair;
    return complete(job);
}

/* Decides the next pairs. Complete after the last pair, or when the result is full. */
static enum answer_stage decide(struct scene_job *job)
{
    struct fmb_scene_answers answers;
    const bool done = fmb_scene_step(job->state, &answers);
    const size_t count = append_all(job, &answers);
    if (count < answers.count)
        return complete_at(job, fmb_scene_number(job->state, count));
    return done ? complete_at(job, fmb_scene_next_pair(job->state)) : DECIDING;
}

/* ---- Steps ---- */

const char *scene_job_begin(struct scene_job *job, const unsigned char *bytes, size_t size)
{
    if (job->stage != IDLE && job->stage != COMPLETE)
        release(job);
    job->stage = IDLE;
    job->answerer = NULL;
    if (size > sizeof job->bytes)
        return "longer than a query may be";
    if (size > 0) /* else there may be no address */
        memcpy(job->bytes, bytes, size);
    const char *error = wire_read_scene_query(job->bytes, (uint32_t) size, &job->query);
    if (!error)
        job->stage = CHECKING;
    return error;
}

bool scene_job_step(struct scene_job *job, struct answerer *answerer)
{
    switch (job->stage) {
    case CHECKING:
        job->answerer = answerer;
        job->stage = check(job);
        break;
    case FINDING: job->stage = find(job); break;
    case ADDING: job->stage = add(job); break;
    case PREPARED: job->stage = begin_pairs(job); break;
    case DECIDING: job->stage = decide(job); break;
    case IDLE: assert(!"a job that was begun"); break;
    case COMPLETE: break;
    }
    return job->stage == COMPLETE;
}

bool scene_job_has_answers(const struct scene_job *job)
{
    return job->stage == DECIDING && fmb_scene_next_pair(job->state) > job->scene.first_pair;
}

void scene_job_stop(struct scene_job *job)
{
    assert(job->answerer);
    if (scene_job_has_answers(job)) {
        job->stage = complete_at(job, fmb_scene_next_pair(job->state));
        return;
    }
    answer_scene_refused(job->answerer, &job->query.header, FMB_BUSY, &job->result);
    job->stage = complete(job);
}
