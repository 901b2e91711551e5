#include "answerer.h"

#include "check.h"
#include "wire.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What one step does at most. */
enum {
    STEP_PLACEMENTS = 32, /* found or kept: tens of microseconds */
    STEP_FRAMES = 64      /* made, after the last body */
};

enum stage { IDLE, CHECKING, FINDING, KEEPING, PREPARED, DECIDING, COMPLETE };

struct scene_job {
    enum stage stage;
    struct answerer *answerer; /* of the query in progress */
    int32_t next;              /* placement to be found or kept */
    int64_t frames;            /* of all bodies found, and of all that come whole */
    long capacity;             /* bytes that are left for answers */
    struct fmb_scene scene;
    struct fmb_scene_state *state; /* in memory */
    void *memory;                  /* owned: fmb_scene_bytes(&limits) */
    struct used_body used[QUERY_PLACEMENTS_MAX];
    struct fmb_placement placement[QUERY_PLACEMENTS_MAX];
    /* [lower * QUERY_PLACEMENTS_MAX + upper]: bits of the pairs that are ignored; meaningful for
     * pairs that are listed. */
    unsigned char ignored[QUERY_PLACEMENTS_MAX * QUERY_PLACEMENTS_MAX / 8 + 1];
    struct scene_result result;
    struct scene_query query;
    struct query_bodies bodies;
    unsigned char bytes[QUERY_BYTES_MAX]; /* the message, where the geometries are */
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

/* Ends a query in progress: the cache gets its bodies back. */
static void release(struct scene_job *job)
{
    for (int32_t i = 0; job->answerer && i < job->query.placement_count; i++)
        answerer_release(job->answerer, &job->used[i]);
    job->answerer = NULL;
}

/* The arrays of the result stay as they are. */
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
}

void answer_scene_refused(const struct answerer *answerer, const struct query_header *query,
                          enum fmb_status status, struct scene_result *result)
{
    begin_result(answerer, query, result);
    result->status = (int32_t) status;
    snprintf(result->detail, sizeof result->detail, "%s", fmb_status_text(result->status));
}

/* ---- Checking ---- */

static bool check_placements(struct checking *checking, const struct scene_query *query)
{
    checking->part = "placements";
    for (int32_t i = 0; i < query->placement_count; i++) {
        const struct placement *placement = &query->placement[i];
        checking->index = i;
        if (!check_placement(checking, placement))
            return false;
        if (placement->dim != query->placement[0].dim)
            return check_refuse(checking, FMB_DIMENSIONS_DIFFER, "dim", NULL);
    }
    checking->part = NULL;
    return true;
}

/* Whether all of so many pairs are good: a loop that compilers vectorize, where it is not inlined.
 */
enum { GOOD_PAIRS = 16 };

static bool __attribute__((noinline))
are_good(const unsigned (*restrict pair)[2], unsigned placements)
{
    unsigned bad = 0;
    for (int i = 0; i < GOOD_PAIRS; i++)
        bad |= (unsigned) (pair[i][0] >= placements) | (unsigned) (pair[i][1] >= placements) |
               (unsigned) (pair[i][0] == pair[i][1]);
    return !bad;
}

static bool refuse_pair(struct checking *checking, const char *field, int32_t index,
                        const char *reason)
{
    char place[32];
    snprintf(place, sizeof place, "%s[%d]", field, (int) index);
    return check_refuse(checking, FMB_BAD_PAIR, place, reason);
}

static bool check_pair_at(struct checking *checking, const char *field, const unsigned pair[2],
                          int32_t i, unsigned placements)
{
    const bool inside = pair[0] < placements && pair[1] < placements;
    return (inside && pair[0] != pair[1]) ||
           refuse_pair(checking, field, 2 * i + (pair[0] < placements),
                       inside ? "a placement against itself" : "no placement has this index");
}

static bool check_indices(struct checking *checking, const char *field, const unsigned (*pair)[2],
                          int32_t count, int32_t placements)
{
    const unsigned end = (unsigned) placements;
    for (int32_t i = 0; i < count; i++) {
        const bool many = i % GOOD_PAIRS == 0 && i + GOOD_PAIRS <= count;
        if (many && are_good(pair + i, end))
            i += GOOD_PAIRS - 1;
        else if (!check_pair_at(checking, field, pair[i], i, end))
            return false;
    }
    return true;
}

static size_t bit_of(const unsigned pair[2])
{
    const unsigned lower = pair[0] < pair[1] ? pair[0] : pair[1];
    const unsigned upper = pair[0] < pair[1] ? pair[1] : pair[0];
    return (size_t) lower * QUERY_PLACEMENTS_MAX + upper;
}

/* No listed pair is ignored. The bits of listed pairs are cleared first, so that no others matter.
 */
static bool check_ignored(struct checking *checking, struct scene_job *job)
{
    const struct scene_query *query = &job->query;
    if (query->ignored_count == 0)
        return true;
    for (int32_t i = 0; i < query->index_count / 2; i++)
        job->ignored[bit_of(query->pair[i]) / 8] &=
            (unsigned char) ~(1u << bit_of(query->pair[i]) % 8);
    for (int32_t i = 0; i < query->ignored_count / 2; i++)
        job->ignored[bit_of(query->ignored[i]) / 8] |=
            (unsigned char) (1u << bit_of(query->ignored[i]) % 8);
    for (int32_t i = 0; i < query->index_count / 2; i++)
        if (job->ignored[bit_of(query->pair[i]) / 8] >> bit_of(query->pair[i]) % 8 & 1)
            return refuse_pair(checking, "indices", 2 * i, "a pair to ignore");
    return true;
}

/* Any message of QUERY_BYTES_MAX has space for its pairs. Of placements it may have more than are
 * valid. */
static bool check_counts(struct checking *checking, const struct scene_query *query)
{
    char reason[32];
    assert(query->index_count <= 2 * QUERY_PAIRS_MAX);
    snprintf(reason, sizeof reason, "more than %d", (int) QUERY_PLACEMENTS_MAX);
    if (query->placement_count > QUERY_PLACEMENTS_MAX)
        return check_refuse(checking, FMB_OVER_LIMIT, "num_placements", reason);
    if (query->index_count % 2)
        return check_refuse(checking, FMB_WRONG_COUNT, "num_indices", "not two for each pair");
    if (query->index_count > 0 && query->which != QUERY_PAIRS_LISTED)
        return check_refuse(checking, FMB_WRONG_COUNT, "num_indices",
                            "indices without PAIRS_LISTED");
    if (query->ignored_count % 2)
        return check_refuse(checking, FMB_WRONG_COUNT, "num_ignored", "not two for each pair");
    return true;
}

/* The scene without its placements. On input: counts and which are checked. */
static struct fmb_scene scene_of(const struct scene_query *query)
{
    const bool listed = query->which == QUERY_PAIRS_LISTED;
    return (struct fmb_scene){.placement_count = (size_t) query->placement_count,
                              .duration = query->duration,
                              .method = fmb_method_by_number(query->method),
                              .which = (enum fmb_pairs) query->which,
                              .split = (size_t) query->split,
                              .pairs = query->pair,
                              .pair_count = (size_t) query->index_count / 2,
                              .ignored = query->ignored,
                              .ignored_count = listed ? 0 : (size_t) query->ignored_count / 2,
                              .first_pair = (unsigned long long) query->first_pair};
}

static bool check_which(struct checking *checking, const struct scene_query *query)
{
    const struct fmb_method *method = fmb_method_by_number(query->method);
    const bool across = query->which == QUERY_PAIRS_ACROSS;
    if (query->which < QUERY_PAIRS_LISTED || query->which > QUERY_PAIRS_ACROSS)
        return check_refuse(checking, FMB_UNKNOWN_WANT, "which", NULL);
    if (query->split < 0 || query->split > (across ? query->placement_count : 0))
        return check_refuse(checking, FMB_BAD_PAIR, "split",
                            across ? "not from 0 to num_placements" : "not 0");
    const struct fmb_scene scene = scene_of(query);
    if (query->first_pair < 0 || scene.first_pair > fmb_scene_pair_count(&scene))
        return check_refuse(checking, FMB_BAD_PAIR, "first_pair", "there are not so many");
    if (query->which != QUERY_PAIRS_LISTED && !method->certain)
        return check_refuse(checking, FMB_CANNOT_DECIDE, "method", "listed pairs alone");
    return true;
}

static bool check_margin(struct checking *checking, const struct scene_query *query)
{
    return (query->margin >= 0 && isfinite(query->margin)) ||
           check_refuse(checking, FMB_BAD_MARGIN, "margin", "negative or not finite");
}

static bool check_scene(struct checking *checking, struct scene_job *job)
{
    const struct scene_query *query = &job->query;
    const int32_t want = query->want | (query->margin > 0 ? QUERY_WANT_GAP : 0);
    return check_ids(checking, query->client_id, query->sequence_number) &&
           check_margin(checking, query) &&
           check_request(checking, query->duration, query->method, want,
                         QUERY_WANT_BOX | QUERY_WANT_TIMES | QUERY_WANT_GAP) &&
           check_counts(checking, query) && check_which(checking, query) &&
           check_placements(checking, query) &&
           check_indices(checking, "indices", query->pair, query->index_count / 2,
                         query->placement_count) &&
           check_indices(checking, "ignored", query->ignored, query->ignored_count / 2,
                         query->placement_count) &&
           check_ignored(checking, job);
}

static struct checking checking_of(struct scene_job *job)
{
    return (struct checking){.status = &job->result.status, .detail = job->result.detail};
}

static enum stage check(struct scene_job *job)
{
    const struct scene_query *query = &job->query;
    struct checking checking = checking_of(job);
    begin_result(job->answerer, &query->header, &job->result);
    if (!check_scene(&checking, job)) {
        job->answerer = NULL;
        return COMPLETE;
    }
    memset(job->used, 0, (size_t) query->placement_count * sizeof *job->used);
    job->bodies.used = 0;
    job->next = 0;
    job->frames = 0;
    return FINDING;
}

/* ---- Bodies ---- */

static enum stage complete(struct scene_job *job)
{
    release(job);
    return COMPLETE;
}

/* The end of the placements of this step, which will be looked up. */
static int32_t expect_placements(const struct scene_job *job)
{
    const int32_t left = job->query.placement_count - job->next;
    const int32_t end = job->next + (left < STEP_PLACEMENTS ? left : STEP_PLACEMENTS);
    for (int32_t i = job->next; i < end; i++)
        cache_prefetch(job->answerer->cache, &job->query.placement[i]);
    return end;
}

static enum stage refuse_unknown(struct scene_job *job)
{
    struct checking checking = checking_of(job);
    checking.part = "placements";
    checking.index = (int32_t) job->result.unknown[0];
    check_refuse(&checking, FMB_UNKNOWN_BODY, "handle", "not held; send the frames");
    return complete(job);
}

/* Finds the body of a placement by handle, and counts its frames, or those of one that comes whole.
 * False: the query is refused. */
static bool find_one(struct scene_job *job, int32_t i)
{
    const struct placement *placement = &job->query.placement[i];
    struct checking checking = checking_of(job);
    checking.part = "placements";
    checking.index = i;
    if (!placement_by_handle(placement))
        return check_frames(&checking, placement->frame_count, &job->frames);
    const struct cached *cached = cache_find(job->answerer->cache, &placement->handle);
    if (!cached) {
        job->result.unknown[job->result.unknown_count++] = (unsigned) i;
        return true;
    }
    job->used[i] = (struct used_body){&cached->body, cached};
    return check_body_dim(&checking, placement, &cached->body) &&
           check_frames(&checking, cached->body.frame_count, &job->frames);
}

/* Placements that name their body by handle. All of them come before any body is kept: a query with
 * one that is not held leaves the cache as it was. */
static enum stage find(struct scene_job *job)
{
    const int32_t end = expect_placements(job);
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
    return KEEPING;
}

/* Placements that come whole. */
static enum stage keep(struct scene_job *job)
{
    const int32_t end = expect_placements(job);
    struct scene_result *result = &job->result;
    for (int32_t frames = 0; job->next < end && frames < STEP_FRAMES; job->next++) {
        const int32_t i = job->next;
        const struct placement *placement = &job->query.placement[i];
        if (!placement_by_handle(placement)) {
            job->used[i] = answerer_keep(job->answerer, placement, &job->bodies,
                                         &result->handle[result->handle_count]);
            result->handle_count += placement->body_id != 0;
            frames += placement->frame_count;
        }
        job->placement[i] = answerer_place(placement, job->used[i].body);
    }
    return job->next < job->query.placement_count ? KEEPING : PREPARED;
}

/* ---- Pairs ---- */

static enum stage begin_pairs(struct scene_job *job)
{
    const struct scene_query *query = &job->query;
    struct scene_result *result = &job->result;
    struct fmb_scene *scene = &job->scene;
    *scene = scene_of(query);
    scene->placements = job->placement;
    scene->contacts = query->want & QUERY_WANT_TIMES;
    scene->boxes = query->want & QUERY_WANT_BOX && scene->method->boxes;
    scene->gaps = query->want & QUERY_WANT_GAP;
    scene->margin = query->margin;
    result->method = scene->method->number;
    result->names_pairs = query->which != QUERY_PAIRS_LISTED;
    result->has_times = scene->contacts;
    result->has_boxes = scene->boxes;
    result->has_gaps = scene->gaps || scene->margin > 0;
    const bool uses_dim = result->has_boxes || result->has_gaps;
    result->dim = uses_dim && query->placement_count > 0 ? query->placement[0].dim : 0;
    job->capacity = QUERY_BYTES_MAX - WIRE_SCENE_RESULT_BYTES - HANDLE_BYTES * result->handle_count;
    const enum fmb_status status = fmb_scene_begin(scene, &limits, job->memory, &job->state);
    assert(status == FMB_OK);
    (void) status;
    return DECIDING;
}

/* ---- Result ---- */

static bool is_contact(unsigned char verdict)
{
    return verdict == FMB_TOUCHING || verdict == FMB_OVERLAPPING;
}

/* Bytes of the result that a pair takes. */
static long size_of(const struct scene_result *result, unsigned char verdict)
{
    long size = result->names_pairs ? 1 + WIRE_PAIR_BYTES : 1;
    if (is_contact(verdict) && result->has_times)
        size += 2 * (long) sizeof(double);
    if (is_contact(verdict) && result->has_boxes)
        size += 2 * result->dim * (long) sizeof(double);
    if (result->has_gaps)
        size += wire_gap_bytes(result->dim);
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

/* False: there is no space. */
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
    if (is_contact(verdict))
        append_contact(result, answers, k);
    return true;
}

/* Appends answers of one byte each: most scenes want verdicts alone. */
static size_t append_verdicts(struct scene_job *job, const struct fmb_scene_answers *answers)
{
    struct scene_result *result = &job->result;
    const size_t count =
        job->capacity < (long) answers->count ? (size_t) job->capacity : answers->count;
    int32_t contacts = 0;
    if (count > 0)
        memcpy(result->verdict + result->verdict_count, answers->verdicts, count);
    for (size_t k = 0; k < count; k++)
        contacts += is_contact(answers->verdicts[k]);
    result->contact_count += contacts;
    result->verdict_count += (int32_t) count;
    job->capacity -= (long) count;
    return count;
}

/* Returns how many of the answers there was space for. */
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

static enum stage complete_at(struct scene_job *job, unsigned long long end_pair)
{
    job->result.end_pair = (int32_t) end_pair;
    return complete(job);
}

static enum stage decide(struct scene_job *job)
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
    case KEEPING: job->stage = keep(job); break;
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
