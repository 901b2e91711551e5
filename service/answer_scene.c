#include "answer.h"

#include "bodies.h"
#include "check.h"
#include "scene_pairs.h"
#include "wire.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Pairs decided at a time: some tens of microseconds' worth as a rule, of boxes of frames that move
 * and of methods that take pairs one by one some hundreds. Hostile ones take milliseconds each, and
 * others wait so long; fewer at a time would make the batch slower by more than a tenth. */
enum { BLOCK = 128, BLOCK_OF_BOXES = 64, BLOCK_OF_SINGLES = 8 };

struct scene_work {
    struct fmb_prepared frame[QUERY_FRAMES_MAX]; /* first: they lie at multiples of 64 bytes */
    struct fmb_body body[QUERY_FRAMES_MAX];      /* for methods that need it */
    struct scene_pairs pairs;
    void *tree; /* owned: fmb_tree_bytes(QUERY_FRAMES_MAX) */
    unsigned pair[BLOCK][2];
    unsigned char verdict[BLOCK];
    double times[BLOCK][2];
    double box[BLOCK][2][FMB_DIM_MAX];
};

bool answer_prepare(struct answerer *answerer)
{
    const size_t line = 64, size = (sizeof *answerer->work + line - 1) / line * line;
    answerer->work = aligned_alloc(line, size);
    if (!answerer->work)
        return false;
    answerer->work->tree = malloc(fmb_tree_bytes(QUERY_FRAMES_MAX));
    return answerer->work->tree != NULL;
}

void answer_release(struct answerer *answerer)
{
    if (answerer->work)
        free(answerer->work->tree);
    free(answerer->work);
}

/* ---- Checking ---- */

static bool check_frames(struct checking *checking, const struct scene_query *query)
{
    checking->part = "frames";
    for (int32_t i = 0; i < query->frame_count; i++) {
        const struct query_frame *frame = &query->frame[i];
        checking->index = i;
        if (!check_frame(checking, frame))
            return false;
        if (frame->dim != query->frame[0].dim)
            return check_refuse(checking, FMB_DIMENSIONS_DIFFER, "dim", NULL);
    }
    checking->part = NULL;
    return true;
}

/* Whether so many pairs are good, all at once, which a compiler makes vectors of. */
enum { GOOD_PAIRS = 16 };

static bool are_good(const unsigned (*restrict pair)[2], unsigned frames)
{
    unsigned bad = 0;
    for (int i = 0; i < GOOD_PAIRS; i++)
        bad |= (unsigned) (pair[i][0] >= frames) | (unsigned) (pair[i][1] >= frames) |
               (unsigned) (pair[i][0] == pair[i][1]);
    return !bad;
}

static bool check_pair_at(struct checking *checking, const struct scene_query *query, int32_t i)
{
    const unsigned *pair = query->pair[i], frames = (unsigned) query->frame_count;
    const bool inside = pair[0] < frames && pair[1] < frames;
    if (inside && pair[0] != pair[1])
        return true;
    char place[32];
    snprintf(place, sizeof place, "indices[%d]", 2 * (int) i + (pair[0] < frames));
    return check_refuse(checking, FMB_BAD_PAIR, place,
                        inside ? "a frame against itself" : "no frame has this index");
}

static bool check_pairs(struct checking *checking, const struct scene_query *query)
{
    const int32_t count = query->index_count / 2;
    for (int32_t i = 0; i < count; i++) {
        const bool many = i % GOOD_PAIRS == 0 && i + GOOD_PAIRS <= count;
        if (many && are_good((const unsigned(*)[2]) query->pair + i, (unsigned) query->frame_count))
            i += GOOD_PAIRS - 1;
        else if (!check_pair_at(checking, query, i))
            return false;
    }
    return true;
}

static bool check_counts(struct checking *checking, const struct scene_query *query)
{
    if (query->frame_count > QUERY_FRAMES_MAX)
        return check_refuse(checking, FMB_OVER_LIMIT, "num_frames", "more than 1400");
    if (query->index_count > 2 * QUERY_PAIRS_MAX)
        return check_refuse(checking, FMB_OVER_LIMIT, "num_indices", "more than 32500");
    const bool odd = query->index_count % 2, listed = query->which == QUERY_PAIRS_LISTED;
    if (odd || (query->index_count > 0 && !listed))
        return check_refuse(checking, FMB_WRONG_COUNT, "num_indices",
                            odd ? "not two for each pair" : "none but where pairs are listed");
    return true;
}

static bool check_which(struct checking *checking, const struct scene_query *query)
{
    const struct fmb_method *method = fmb_method_by_number(query->method);
    const bool across = query->which == QUERY_PAIRS_ACROSS;
    if (query->which < QUERY_PAIRS_LISTED || query->which > QUERY_PAIRS_ACROSS)
        return check_refuse(checking, FMB_UNKNOWN_WANT, "which", NULL);
    if (query->split < 0 || query->split > (across ? query->frame_count : 0))
        return check_refuse(checking, FMB_BAD_PAIR, "split",
                            across ? "not from 0 to num_frames" : "not 0");
    if (query->first_pair < 0 || query->first_pair > scene_pairs_total(query))
        return check_refuse(checking, FMB_BAD_PAIR, "first_pair", "there are not so many");
    if (query->which != QUERY_PAIRS_LISTED && !method->certain)
        return check_refuse(checking, FMB_CANNOT_DECIDE, "method", "listed pairs alone");
    return true;
}

static bool check_scene(struct checking *checking, const struct scene_query *query)
{
    return check_ids(checking, query->client_id, query->sequence_number) &&
           check_question(checking, query->duration, query->method, query->want,
                          QUERY_WANT_BOX | QUERY_WANT_TIMES) &&
           check_counts(checking, query) && check_which(checking, query) &&
           check_frames(checking, query) && check_pairs(checking, query);
}

/* ---- Frames ---- */

/* A query's way through this file. */
struct answering {
    struct answerer *answerer;
    const struct scene_query *query;
    struct scene_result *result;
    const struct fmb_method *method;
    bool batched; /* the method is that of the batch */
};

/* Copies, since the next body may evict this one. */
static void put_frame(const struct answering *answering, int32_t i, const struct fmb_body *body)
{
    struct scene_work *work = answering->answerer->work;
    const struct fmb_frame frame = bodies_place(&answering->query->frame[i], body);
    const enum fmb_status status = fmb_prepare(&frame, &work->frame[i]);
    assert(status == FMB_OK);
    (void) status;
    if (!answering->batched && body != &work->body[i])
        work->body[i] = *body;
}

/* The frames that come by key. False: some keys are not held, and key[] says which are. */
static bool find_frames(const struct answering *answering)
{
    const struct scene_query *query = answering->query;
    struct scene_result *result = answering->result;
    bool all = true;
    for (int32_t i = 0; i < query->frame_count; i++) {
        const struct query_frame *frame = &query->frame[i];
        const struct fmb_body *body;
        result->key[i] = 0;
        if (!check_by_key(frame))
            continue;
        if ((body = bodies_find(answering->answerer->cache, frame))) {
            put_frame(answering, i, body);
            result->key[i] = frame->key;
        }
        all = all && body;
    }
    return all;
}

/* Those that come whole. Keys are told where one of them is new to the client. */
static void keep_frames(const struct answering *answering)
{
    const struct scene_query *query = answering->query;
    struct scene_result *result = answering->result;
    for (int32_t i = 0; i < query->frame_count; i++) {
        const struct query_frame *frame = &query->frame[i];
        if (check_by_key(frame))
            continue;
        put_frame(answering, i,
                  bodies_keep(answering->answerer->cache, frame,
                              &answering->answerer->work->body[i], &result->key[i]));
        if (frame->body_id)
            result->key_count = query->frame_count;
    }
}

/* Keys come first: one that is not held leaves the cache as it was. */
static bool prepare_frames(const struct answering *answering, struct checking *checking)
{
    if (!find_frames(answering)) {
        answering->result->key_count = answering->query->frame_count;
        return check_refuse(checking, FMB_UNKNOWN_BODY, "frames",
                            "keys that are not held; send the components where keys[] is 0");
    }
    keep_frames(answering);
    return true;
}

/* ---- Pairs ---- */

static void decide_batch(const struct answering *answering, const unsigned (*pair)[2], size_t count)
{
    struct scene_work *work = answering->answerer->work;
    const struct fmb_batch batch = {.frames = work->frame,
                                    .frame_count = (size_t) answering->query->frame_count,
                                    .pairs = pair,
                                    .pair_count = count,
                                    .duration = answering->query->duration,
                                    .verdicts = work->verdict,
                                    .contacts = answering->result->has_times ? work->times : NULL,
                                    .boxes = answering->result->has_boxes ? work->box : NULL};
    const enum fmb_status status = fmb_decide_batch(&batch);
    assert(status == FMB_OK);
    (void) status;
}

static void decide_alone(const struct answering *answering, const unsigned pair[2], size_t k)
{
    struct scene_work *work = answering->answerer->work;
    const struct scene_query *query = answering->query;
    struct fmb_answer answer;
    const struct fmb_pair both = {bodies_place(&query->frame[pair[0]], &work->body[pair[0]]),
                                  bodies_place(&query->frame[pair[1]], &work->body[pair[1]]),
                                  query->duration};
    const unsigned want = answering->result->has_boxes ? FMB_WANT_BOX : 0;
    fmb_decide(answering->method, &both, want, &answer); /* where it cannot: no verdict */
    work->verdict[k] = (unsigned char) answer.verdict;
    memcpy(work->box[k], answer.box, sizeof answer.box);
    for (int end = 0; end < 2; end++)
        work->times[k][end] = answer.has_contact ? answer.contact[end] : NAN;
}

static void decide(const struct answering *answering, const unsigned (*pair)[2], size_t count)
{
    if (answering->batched) {
        decide_batch(answering, pair, count);
        return;
    }
    for (size_t k = 0; k < count; k++)
        decide_alone(answering, pair[k], k);
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

static void append_contact(struct scene_result *result, const struct scene_work *work, size_t k)
{
    const int32_t contact = result->contact_count++;
    if (result->has_times)
        memcpy(&result->times[2 * contact], work->times[k], sizeof work->times[k]);
    for (int i = 0; i < 2 * result->dim && result->has_boxes; i++)
        result->boxes[2 * result->dim * contact + i] =
            work->box[k][i / result->dim][i % result->dim];
}

/* As many of the block's answers as there is room for, where a verdict is all that there is of a
 * pair; returns their number. Most scenes ask for no more. */
static size_t append_verdicts(struct scene_result *result, const struct scene_work *work,
                              size_t count, long *room)
{
    const size_t kept = *room < (long) count ? (size_t) (*room > 0 ? *room : 0) : count;
    memcpy(result->verdict + result->verdict_count, work->verdict, kept);
    for (size_t k = 0; k < kept; k++)
        result->contact_count += is_contact(work->verdict[k]);
    result->verdict_count += (int32_t) kept;
    *room -= (long) count;
    return kept;
}

/* As many of the block's answers as there is room for; returns their number. */
static size_t append(struct scene_result *result, const struct scene_work *work,
                     const unsigned (*pair)[2], size_t count, long *room)
{
    if (!result->names_pairs && !result->has_times && !result->has_boxes)
        return append_verdicts(result, work, count, room);
    for (size_t k = 0; k < count; k++) {
        const unsigned char verdict = work->verdict[k];
        if (result->names_pairs && !is_contact(verdict))
            continue;
        *room -= size_of(result, verdict);
        if (*room < 0)
            return k;
        const int32_t n = result->verdict_count++;
        result->verdict[n] = verdict;
        if (result->names_pairs)
            memcpy(result->pair[n], pair[k], sizeof result->pair[n]);
        if (is_contact(verdict))
            append_contact(result, work, k);
    }
    return count;
}

static bool any_moves(const struct scene_query *query)
{
    for (int32_t i = 0; i < query->frame_count; i++)
        if (query->frame[i].velocity.count > 0)
            return true;
    return false;
}

/* What the result has of contacts. */
static void set_form(const struct answering *answering)
{
    const struct scene_query *query = answering->query;
    struct scene_result *result = answering->result;
    result->method = answering->method->number;
    result->names_pairs = query->which != QUERY_PAIRS_LISTED;
    result->has_times = query->want & QUERY_WANT_TIMES && any_moves(query);
    result->has_boxes = query->want & QUERY_WANT_BOX && answering->method->boxes;
    result->dim = result->has_boxes && query->frame_count > 0 ? query->frame[0].dim : 0;
}

static size_t block_of(const struct answering *answering)
{
    if (!answering->batched)
        return BLOCK_OF_SINGLES;
    return answering->result->has_boxes ? BLOCK_OF_BOXES : BLOCK;
}

static bool may_go_on(const struct answerer *answerer)
{
    return !answerer->between || answerer->between(answerer->user);
}

static void answer_pairs(const struct answering *answering)
{
    struct scene_work *work = answering->answerer->work;
    struct scene_result *result = answering->result;
    long room = QUERY_BYTES_MAX - WIRE_SCENE_RESULT_BYTES - 8 * result->key_count;
    const unsigned(*pair)[2];
    size_t count, kept;
    set_form(answering);
    scene_pairs_begin(&work->pairs, answering->query, work->frame, work->tree);
    do {
        count = scene_pairs_next(&work->pairs, work->pair, block_of(answering), &pair);
        decide(answering, pair, count);
        kept = append(result, work, pair, count, &room);
        if (kept < count)
            result->end_pair = scene_pairs_number(answering->query, pair, kept);
        else if (count > 0)
            result->end_pair = scene_pairs_number(answering->query, pair, count - 1) + 1;
        else
            result->end_pair = scene_pairs_total(answering->query);
    } while (count > 0 && kept == count && may_go_on(answering->answerer));
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
    result->lost = result->compute_ns = 0;
    result->end_pair = 0;
    result->dim = 0;
    result->key_count = result->verdict_count = result->contact_count = 0;
    result->names_pairs = result->has_times = result->has_boxes = false;
}

void answer_scene(struct answerer *answerer, const struct scene_query *query,
                  struct scene_result *result)
{
    struct checking checking = {.status = &result->status, .detail = result->detail};
    const struct query_header header = {query->utime, query->client_id, query->sequence_number};
    begin_result(answerer, &header, result);
    if (!check_scene(&checking, query))
        return;
    struct answering answering = {answerer, query, result, fmb_method_by_number(query->method),
                                  .batched = false};
    answering.batched = answering.method == fmb_method_default();
    if (prepare_frames(&answering, &checking))
        answer_pairs(&answering);
}

void answer_scene_refused(const struct answerer *answerer, const struct query_header *query,
                          enum fmb_status status, struct scene_result *result)
{
    begin_result(answerer, query, result);
    result->status = (int32_t) status;
    snprintf(result->detail, sizeof result->detail, "%s", fmb_status_text(result->status));
}
