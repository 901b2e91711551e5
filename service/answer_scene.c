#include "answerer.h"

#include "check.h"
#include "scene_pairs.h"
#include "wire.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What one step does at most. */
enum {
    STEP_PLACEMENTS = 32, /* found or kept: tens of microseconds */
    /* Pairs in doubles: tens of microseconds. The batch decides few of them in integers. */
    STEP_PAIRS = 128,
    /* After a block with pairs left open, and with boxes, which take longer: as many as the batch
     * decides in integers, so that none is left open for its time. */
    STEP_PAIRS_SLOW = 32
};

enum stage { IDLE, CHECKING, FINDING, KEEPING, PREPARED, DECIDING, COMPLETE };

/* Pairs under decision: those before done are in the result. */
struct block {
    const unsigned (*pair)[2]; /* out[], or those of the query */
    size_t count, done;
    /* Pairs that need exact arithmetic, ascending; those before next_open have been decided. */
    size_t open[STEP_PAIRS], open_count, next_open;
    unsigned out[STEP_PAIRS][2];
    unsigned char verdict[STEP_PAIRS];
    double times[STEP_PAIRS][2];
    double box[STEP_PAIRS][2][FMB_DIM_MAX];
};

struct scene_job {
    struct fmb_prepared prepared[QUERY_PLACEMENTS_MAX]; /* first: at multiples of 64 bytes */
    struct fmb_body body[QUERY_PLACEMENTS_MAX];         /* for methods other than the default */
    enum stage stage;
    int32_t next; /* placement to be found or kept */
    const struct fmb_method *method;
    bool batched;  /* the method is that of the batch */
    bool slow;     /* blocks of STEP_PAIRS_SLOW */
    long capacity; /* bytes that are left for answers */
    struct block block;
    struct scene_pairs pairs;
    void *tree; /* owned: fmb_tree_bytes(QUERY_PLACEMENTS_MAX) */
    struct scene_result result;
    struct scene_query query;
    unsigned char bytes[QUERY_BYTES_MAX]; /* the message, where the geometries are */
};

struct scene_job *scene_job_create(void)
{
    const size_t line = 64, size = (sizeof(struct scene_job) + line - 1) / line * line;
    struct scene_job *job = aligned_alloc(line, size);
    if (!job)
        return NULL;
    job->stage = IDLE;
    job->tree = malloc(fmb_tree_bytes(QUERY_PLACEMENTS_MAX));
    if (!job->tree) {
        free(job);
        return NULL;
    }
    return job;
}

void scene_job_destroy(struct scene_job *job)
{
    if (!job)
        return;
    free(job->tree);
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

/* The arrays of the result stay as they are. */
static void begin_result(const struct answerer *answerer, const struct query_header *query,
                         struct scene_result *result)
{
    result->utime = query->utime;
    result->client_id = query->client_id;
    result->sequence_number = query->sequence_number;
    result->server_id = answerer->server_id;
    result->status = FMB_OK;
    result->detail[0] = '\0';
    result->method = 0;
    result->end_pair = 0;
    result->compute_ns = 0;
    result->dim = 0;
    result->unknown_count = result->handle_count = 0;
    result->verdict_count = result->contact_count = 0;
    result->names_pairs = result->has_times = result->has_boxes = false;
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

static bool check_pair_at(struct checking *checking, const struct scene_query *query, int32_t i)
{
    const unsigned *pair = query->pair[i], placements = (unsigned) query->placement_count;
    const bool inside = pair[0] < placements && pair[1] < placements;
    if (inside && pair[0] != pair[1])
        return true;
    char place[32];
    snprintf(place, sizeof place, "indices[%d]", 2 * (int) i + (pair[0] < placements));
    return check_refuse(checking, FMB_BAD_PAIR, place,
                        inside ? "a placement against itself" : "no placement has this index");
}

static bool check_pairs(struct checking *checking, const struct scene_query *query)
{
    const int32_t count = query->index_count / 2;
    for (int32_t i = 0; i < count; i++) {
        const bool many = i % GOOD_PAIRS == 0 && i + GOOD_PAIRS <= count;
        if (many &&
            are_good((const unsigned(*)[2]) query->pair + i, (unsigned) query->placement_count))
            i += GOOD_PAIRS - 1;
        else if (!check_pair_at(checking, query, i))
            return false;
    }
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

static bool check_which(struct checking *checking, const struct scene_query *query)
{
    const struct fmb_method *method = fmb_method_by_number(query->method);
    const bool across = query->which == QUERY_PAIRS_ACROSS;
    if (query->which < QUERY_PAIRS_LISTED || query->which > QUERY_PAIRS_ACROSS)
        return check_refuse(checking, FMB_UNKNOWN_WANT, "which", NULL);
    if (query->split < 0 || query->split > (across ? query->placement_count : 0))
        return check_refuse(checking, FMB_BAD_PAIR, "split",
                            across ? "not from 0 to num_placements" : "not 0");
    if (query->first_pair < 0 || query->first_pair > scene_pairs_total(query))
        return check_refuse(checking, FMB_BAD_PAIR, "first_pair", "there are not so many");
    if (query->which != QUERY_PAIRS_LISTED && !method->certain)
        return check_refuse(checking, FMB_CANNOT_DECIDE, "method", "listed pairs alone");
    return true;
}

static bool check_margin(struct checking *checking, const struct scene_query *query)
{
    return (query->margin >= 0 && isfinite(query->margin)) ||
           check_refuse(checking, FMB_NOT_FINITE, "margin", "negative or not finite");
}

/* What later versions support. */
static bool check_support(struct checking *checking, const struct scene_query *query)
{
    if (query->margin != 0)
        return check_refuse(checking, FMB_NOT_SUPPORTED, "margin", "not in this version");
    if (query->ignored_count > 0)
        return check_refuse(checking, FMB_NOT_SUPPORTED, "num_ignored", "not in this version");
    return true;
}

static bool check_scene(struct checking *checking, const struct scene_query *query)
{
    return check_ids(checking, query->client_id, query->sequence_number) &&
           check_request(checking, query->duration, query->method, query->want,
                         QUERY_WANT_BOX | QUERY_WANT_TIMES) &&
           check_margin(checking, query) && check_counts(checking, query) &&
           check_which(checking, query) && check_placements(checking, query) &&
           check_pairs(checking, query) && check_support(checking, query);
}

static struct checking checking_of(struct scene_job *job)
{
    return (struct checking){.status = &job->result.status, .detail = job->result.detail};
}

static enum stage check(struct scene_job *job, const struct answerer *answerer)
{
    const struct scene_query *query = &job->query;
    const struct query_header header = {query->utime, query->client_id, query->sequence_number};
    struct checking checking = checking_of(job);
    begin_result(answerer, &header, &job->result);
    if (!check_scene(&checking, query))
        return COMPLETE;
    job->method = fmb_method_by_number(query->method);
    job->batched = job->method == fmb_method_default();
    job->next = 0;
    return FINDING;
}

/* ---- Bodies ---- */

/* Copies, since the next body may evict this one. */
static void prepare(struct scene_job *job, int32_t i, const struct fmb_body *body)
{
    const struct fmb_frame frame = answerer_place(&job->query.placement[i], body);
    const enum fmb_status status = fmb_prepare(&frame, &job->prepared[i]);
    assert(status == FMB_OK);
    (void) status;
    if (!job->batched)
        job->body[i] = *body;
}

/* The end of the placements of this step, which will be looked up. */
static int32_t expect_placements(const struct scene_job *job, const struct answerer *answerer)
{
    const int32_t left = job->query.placement_count - job->next;
    const int32_t end = job->next + (left < STEP_PLACEMENTS ? left : STEP_PLACEMENTS);
    for (int32_t i = job->next; i < end; i++)
        cache_prefetch(answerer->cache, &job->query.placement[i]);
    return end;
}

static enum stage refuse_unknown(struct scene_job *job)
{
    struct checking checking = checking_of(job);
    checking.part = "placements";
    checking.index = (int32_t) job->result.unknown[0];
    check_refuse(&checking, FMB_UNKNOWN_BODY, "handle", "not held; send the frames");
    return COMPLETE;
}

/* Placements that name their body by handle. All of them come before any body is kept: a query with
 * one that is not held leaves the cache as it was. */
static enum stage find(struct scene_job *job, struct answerer *answerer)
{
    const int32_t end = expect_placements(job, answerer);
    struct scene_result *result = &job->result;
    for (; job->next < end; job->next++) {
        const struct placement *placement = &job->query.placement[job->next];
        if (!placement_by_handle(placement))
            continue;
        const struct cached *cached = cache_find(answerer->cache, &placement->handle);
        struct checking checking = checking_of(job);
        checking.part = "placements";
        checking.index = job->next;
        if (!cached) {
            result->unknown[result->unknown_count++] = (unsigned) job->next;
        } else if (check_body_dim(&checking, placement, &cached->body)) {
            prepare(job, job->next, &cached->body);
        } else {
            result->unknown_count = 0;
            return COMPLETE;
        }
    }
    if (job->next < job->query.placement_count)
        return FINDING;
    if (result->unknown_count > 0)
        return refuse_unknown(job);
    job->next = 0;
    return KEEPING;
}

/* Placements that come whole. */
static enum stage keep(struct scene_job *job, struct answerer *answerer)
{
    const int32_t end = expect_placements(job, answerer);
    struct scene_result *result = &job->result;
    for (; job->next < end; job->next++) {
        const struct placement *placement = &job->query.placement[job->next];
        struct handle *handle = &result->handle[result->handle_count];
        struct fmb_body anonymous;
        if (placement_by_handle(placement))
            continue;
        prepare(job, job->next, answerer_keep(answerer, placement, &anonymous, handle));
        result->handle_count += placement->body_id != 0;
    }
    return job->next < job->query.placement_count ? KEEPING : PREPARED;
}

/* ---- Pairs ---- */

static bool any_moves(const struct scene_query *query)
{
    for (int32_t i = 0; i < query->placement_count; i++)
        if (query->placement[i].velocity_count > 0)
            return true;
    return false;
}

static enum stage begin_pairs(struct scene_job *job)
{
    const struct scene_query *query = &job->query;
    struct scene_result *result = &job->result;
    result->method = job->method->number;
    result->names_pairs = query->which != QUERY_PAIRS_LISTED;
    result->has_times = query->want & QUERY_WANT_TIMES && any_moves(query);
    result->has_boxes = query->want & QUERY_WANT_BOX && job->method->boxes;
    result->dim = result->has_boxes && query->placement_count > 0 ? query->placement[0].dim : 0;
    job->capacity = QUERY_BYTES_MAX - WIRE_SCENE_RESULT_BYTES - HANDLE_BYTES * result->handle_count;
    job->slow = result->has_boxes;
    job->block.count = job->block.done = job->block.open_count = job->block.next_open = 0;
    scene_pairs_begin(&job->pairs, query, job->prepared, job->tree);
    return DECIDING;
}

/* Decides count pairs of the block from first on. *open: positions from first on of those that need
 * exact arithmetic; NULL: those are decided too. */
static void decide_batch(struct scene_job *job, size_t first, size_t count, size_t *open,
                         size_t *open_count)
{
    struct block *block = &job->block;
    const struct fmb_batch batch = {.frames = job->prepared,
                                    .frame_count = (size_t) job->query.placement_count,
                                    .pairs = block->pair + first,
                                    .pair_count = count,
                                    .duration = job->query.duration,
                                    .verdicts = block->verdict + first,
                                    .contacts = job->result.has_times ? block->times + first : NULL,
                                    .boxes = job->result.has_boxes ? block->box + first : NULL,
                                    .open = open,
                                    .open_count = open_count};
    const enum fmb_status status = fmb_decide_batch(&batch);
    assert(status == FMB_OK);
    (void) status;
}

/* The only pair of the block, by a method that has no batch. */
static void decide_single(struct scene_job *job)
{
    struct block *block = &job->block;
    const unsigned a = block->pair[0][0], b = block->pair[0][1];
    struct fmb_answer answer;
    const struct fmb_pair pair = {answerer_place(&job->query.placement[a], &job->body[a]),
                                  answerer_place(&job->query.placement[b], &job->body[b]),
                                  job->query.duration};
    const unsigned want = job->result.has_boxes ? FMB_WANT_BOX : 0;
    fmb_decide(job->method, &pair, want, &answer); /* no verdict if it cannot */
    block->verdict[0] = (unsigned char) answer.verdict;
    memcpy(block->box[0], answer.box, sizeof answer.box);
    for (int end = 0; end < 2; end++)
        block->times[0][end] = answer.has_contact ? answer.contact[end] : NAN;
}

static size_t block_size(const struct scene_job *job)
{
    if (!job->batched)
        return 1;
    return job->slow ? STEP_PAIRS_SLOW : STEP_PAIRS;
}

static void begin_block(struct scene_job *job)
{
    struct block *block = &job->block;
    block->count = scene_pairs_next(&job->pairs, block->out, block_size(job), &block->pair);
    block->done = block->next_open = block->open_count = 0;
    if (job->batched)
        decide_batch(job, 0, block->count, block->open, &block->open_count);
    else if (block->count > 0)
        decide_single(job);
    if (block->open_count > 0)
        job->slow = true;
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
    return size;
}

static void append_contact(struct scene_result *result, const struct block *block)
{
    const int32_t contact = result->contact_count++;
    const size_t k = block->done;
    if (result->has_times)
        memcpy(&result->times[2 * contact], block->times[k], sizeof block->times[k]);
    for (int i = 0; i < 2 * result->dim && result->has_boxes; i++)
        result->boxes[2 * result->dim * contact + i] =
            block->box[k][i / result->dim][i % result->dim];
}

/* Appends the next pair. False: there is no space for it. */
static bool append(struct scene_job *job)
{
    struct scene_result *result = &job->result;
    const struct block *block = &job->block;
    const unsigned char verdict = block->verdict[block->done];
    if (result->names_pairs && !is_contact(verdict))
        return true;
    const long size = size_of(result, verdict);
    if (size > job->capacity)
        return false;
    job->capacity -= size;
    const int32_t n = result->verdict_count++;
    result->verdict[n] = verdict;
    if (result->names_pairs)
        memcpy(result->pair[n], block->pair[block->done], sizeof result->pair[n]);
    if (is_contact(verdict))
        append_contact(result, block);
    return true;
}

/* The first pair that is not in the result. */
static int32_t next_pair(const struct scene_job *job)
{
    const struct block *block = &job->block;
    return block->done < block->count ? scene_pairs_number(&job->query, block->pair, block->done)
                                      : scene_pairs_position(&job->pairs);
}

static enum stage complete(struct scene_job *job)
{
    job->result.end_pair = next_pair(job);
    return COMPLETE;
}

/* Appends the pairs before end, each of which takes one byte: most scenes want verdicts alone. */
static void append_verdicts(struct scene_job *job, size_t end)
{
    struct scene_result *result = &job->result;
    struct block *block = &job->block;
    const size_t left = end - block->done;
    const size_t count = job->capacity < (long) left ? (size_t) job->capacity : left;
    const unsigned char *verdict = block->verdict + block->done;
    int32_t contacts = 0;
    memcpy(result->verdict + result->verdict_count, verdict, count);
    for (size_t k = 0; k < count; k++)
        contacts += is_contact(verdict[k]);
    result->contact_count += contacts;
    result->verdict_count += (int32_t) count;
    job->capacity -= (long) count;
    block->done += count;
}

/* Appends the pairs before end. False: there is no space for all of them. */
static bool append_until(struct scene_job *job, size_t end)
{
    const struct scene_result *result = &job->result;
    struct block *block = &job->block;
    if (!result->names_pairs && !result->has_times && !result->has_boxes)
        append_verdicts(job, end);
    else
        while (block->done < end && append(job))
            block->done++;
    return block->done == end;
}

/* Appends all up to the first pair that is open. */
static enum stage append_decided(struct scene_job *job)
{
    const struct block *block = &job->block;
    const size_t end =
        block->next_open < block->open_count ? block->open[block->next_open] : block->count;
    if (!append_until(job, end))
        return complete(job);
    return next_pair(job) == scene_pairs_total(&job->query) ? complete(job) : DECIDING;
}

/* One pair that is open, or a block. */
static enum stage decide(struct scene_job *job)
{
    struct block *block = &job->block;
    if (block->next_open < block->open_count)
        decide_batch(job, block->open[block->next_open++], 1, NULL, NULL);
    else
        begin_block(job);
    return append_decided(job);
}

/* ---- Steps ---- */

const char *scene_job_begin(struct scene_job *job, const unsigned char *bytes, size_t size)
{
    job->stage = IDLE;
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
    case CHECKING: job->stage = check(job, answerer); break;
    case FINDING: job->stage = find(job, answerer); break;
    case KEEPING: job->stage = keep(job, answerer); break;
    case PREPARED: job->stage = begin_pairs(job); break;
    case DECIDING: job->stage = decide(job); break;
    case IDLE: assert(!"a job that was begun"); break;
    case COMPLETE: break;
    }
    return job->stage == COMPLETE;
}

bool scene_job_can_stop(const struct scene_job *job)
{
    return job->stage == DECIDING && next_pair(job) > job->query.first_pair;
}

void scene_job_stop(struct scene_job *job)
{
    assert(scene_job_can_stop(job));
    job->stage = complete(job);
}
