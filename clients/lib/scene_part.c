/* Map.
 *
 * In: a part with its placements and pairs (division_next()), and its results (request.h).
 * Out: queries; and part->answers, complete when part->done is set, which scene_run.c delivers.
 *
 * Steps:
 *   1. part_begin() writes the first query and sends it. write_query() sends a body by handle if
 *      the service holds it.
 *   2. part_take() is called with each result. Of a service that does not hold a body, the same
 *      query is written again with frames.
 *   3. take_answers() checks that the result fits the query (fits_pair(), fits_scene()), adds its
 *      answers, and writes a query for the pairs that are left.
 *
 * Not here: which pairs a part has (division.c), how many parts are under way (scene_run.c), loss
 * and repetition (request.c). Tested by test_client_query.c and test_client_bad.c. */
#include "scene_part.h"

#include "client_scene.h"
#include "clock.h"
#include "scene_run.h"
#include "wire.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    /* Bytes of the result of a pair with a certificate of usual length. */
    SINGLE_RESULT_BYTES = 1400,
    /* Limits of the number of pairs listed in a query: the least, and the factor of growth. */
    PAIRS_LEAST = 16,
    PAIRS_GROWTH = 4,
    /* After this many results that name bodies not held, a part sends all its bodies whole. */
    UNKNOWN_MAX = 2
};

void part_answers_clear(struct part_answers *answers)
{
    free(answers->answer);
    free(answers->certificate);
    memset(answers, 0, sizeof *answers);
}

/* Ends a part: its remaining pairs have this status. text: NULL or "": that of the status. */
static void end_part(struct part *part, int status, const char *text)
{
    struct part_answers *answers = &part->answers;
    answers->status = status;
    snprintf(answers->text, sizeof answers->text, "%s",
             text && *text ? text : fmb_client_status_text(status));
    part->done = true;
}

static bool wants_gaps(const struct fmb_scene *scene)
{
    return scene->want & FMB_WANT_GAP || scene->margin > 0;
}

size_t part_result_bytes(const struct part *part, const struct fmb_scene *scene)
{
    if (part->single)
        return SINGLE_RESULT_BYTES;
    const size_t numbers = (scene->want & FMB_WANT_TIMES ? 2 : 0) +
                           (scene->want & FMB_WANT_BOX ? 2 * FMB_DIM_MAX : 0) +
                           (scene->want & FMB_WANT_POINT ? 1 + FMB_DIM_MAX : 0);
    const size_t contact = 1 + sizeof(double) * numbers +
                           (part->which == FMB_PAIRS_LISTED ? 0 : WIRE_PAIR_BYTES) +
                           (wants_gaps(scene) ? (size_t) wire_gap_bytes(FMB_DIM_MAX, true) : 0);
    const size_t bytes = WIRE_SCENE_RESULT_BYTES + HANDLE_BYTES * (size_t) part->placement_count +
                         (size_t) part->total * contact;
    return bytes < QUERY_BYTES_MAX ? bytes : QUERY_BYTES_MAX;
}

static const struct fmb_placement *placement_of(const struct part *part, unsigned i)
{
    return &part->run->scene->placements[part->placement[i]];
}

/* Returns the entry of the i-th placement in the table of bodies; NULL: it has none. */
static struct held_body *entry_of(const struct part *part, int32_t i)
{
    return part->run->division.body[part->placement[i]].entry;
}

/* ---- Queries ---- */

/* Converts the i-th placement. In a scene at an instant nothing moves, so the end is left out. */
static void convert(const struct part *part, unsigned i, const struct handle *handle,
                    unsigned char *bytes, struct query_placement *out)
{
    client_scene_placement(placement_of(part, i), handle, bytes, out);
    if (part->run->scene->instant)
        out->placed.end_count = 0;
}

/* Converts the placements: by handle if the service holds the body, else with frames. Returns their
 * bytes; a number above max means that not all of them were converted. */
static size_t write_placements(struct part *part, size_t max, struct query_placement *out)
{
    unsigned char *at = part->run->geometry;
    size_t bytes = 0;
    for (int32_t i = 0; i < part->placement_count && bytes <= max; i++) {
        const struct held_body *body = part->unknown < UNKNOWN_MAX ? entry_of(part, i) : NULL;
        part->whole[i] = !body || !body->held;
        convert(part, (unsigned) i, part->whole[i] ? NULL : &body->handle, at, &out[i]);
        at += part->whole[i] ? out[i].body.size : 0;
        bytes += wire_placement_bytes(&out[i]);
    }
    return bytes;
}

static int32_t method_of(const struct fmb_scene *scene)
{
    return scene->method ? scene->method->number : 0;
}

/* Writes a pair query. Returns its size, or 0 if it is too large. */
static size_t write_pair(struct part *part, unsigned char *out)
{
    const struct fmb_scene *scene = part->run->scene;
    struct pair_query query = {.utime = clock_utime(),
                               .duration = scene->duration,
                               .method = method_of(scene),
                               .want = (int32_t) scene->want & ~FMB_WANT_TIMES};
    if (scene->margin > 0)
        query.want |= FMB_WANT_GAP;
    const size_t max = QUERY_BYTES_MAX - WIRE_PAIR_QUERY_BYTES;
    return write_placements(part, max, query.placement) <= max ? wire_write_pair_query(&query, out)
                                                               : 0;
}

/* Begins a scene query. Returns the bytes that placements and pairs may have. */
static size_t begin_query(const struct part *part)
{
    const struct fmb_scene *scene = part->run->scene;
    struct scene_query *query = &part->run->query;
    query->utime = clock_utime();
    query->label = scene->label;
    query->duration = scene->duration;
    query->method = method_of(scene);
    query->want = (int32_t) scene->want;
    query->margin = scene->margin;
    query->which = FMB_PAIRS_LISTED;
    query->split = query->first_pair = 0;
    query->placement_count = query->index_count = query->ignored_count = 0;
    return QUERY_BYTES_MAX - WIRE_SCENE_QUERY_BYTES - wire_text_bytes(query->label);
}

/* Writes a scene query without pairs, with bodies that the service does not hold, as many as fit.
 * Returns its size, or 0 if there are none. */
static size_t write_definitions(struct part *part, unsigned char *out)
{
    struct scene_query *query = &part->run->query;
    unsigned char *at = part->run->geometry;
    size_t left = begin_query(part);
    const bool may = part->unknown < UNKNOWN_MAX && part->definitions < part->placement_count;
    memset(part->whole, 0, sizeof part->whole);
    for (int32_t i = 0; i < part->placement_count && may; i++) {
        const struct held_body *body = entry_of(part, i);
        if (!body || body->held)
            continue;
        struct query_placement *placement = &query->placement[query->placement_count];
        convert(part, (unsigned) i, NULL, at, placement);
        if (wire_placement_bytes(placement) > left)
            break;
        left -= wire_placement_bytes(placement);
        at += placement->body.size;
        part->whole[i] = true;
        query->placement_count++;
    }
    part->defining = query->placement_count > 0;
    part->definitions += part->defining;
    return part->defining ? wire_write_scene_query(query, out) : 0;
}

static size_t write_scene(struct part *part, unsigned char *out)
{
    const bool listed = part->which == FMB_PAIRS_LISTED;
    struct scene_query *query = &part->run->query;
    const size_t pairs = listed ? (size_t) part->total : 0;
    const size_t max = begin_query(part) - WIRE_PAIR_BYTES * pairs;
    const size_t bytes = write_placements(part, max, query->placement);
    if (bytes > max)
        return write_definitions(part, out);
    query->which = part->which;
    query->split = part->split;
    query->first_pair = part->answers.answered;
    query->placement_count = part->placement_count;
    query->index_count = 2 * (int32_t) pairs;
    for (size_t i = 0; i < 2 * pairs; i++)
        query->pair[i / 2][i % 2] = part->pair[i / 2][i % 2];
    /* If there is no space for all of them, scene_run.c drops their answers. */
    query->ignored_count =
        2 * division_ignored(&part->run->division, part,
                             (int32_t) ((max - bytes) / WIRE_PAIR_BYTES), query->ignored);
    return wire_write_scene_query(query, out);
}

/* Writes a query for the pairs that have no answers yet. Returns false if that is not possible. */
static bool write_query(struct part *part, struct request *request)
{
    struct fmb_client_counts *counts = &part->run->requests->counts;
    part->defining = false;
    request->size = (part->single ? write_pair : write_scene)(part, request->query);
    for (int32_t i = 0; i < part->placement_count && request->size > 0; i++) {
        counts->whole += part->whole[i];
        counts->by_handle += !part->whole[i] && !part->defining;
    }
    return request->size > 0;
}

/* ---- Handles in results ---- */

/* A result has the handles of the bodies that were sent whole, which the service then holds.
 * Returns false if its handles are others. */
static bool take_handles(const struct part *part, const struct request_result *result)
{
    static const struct handle none;
    const bool pair = result->kind == FMB_CLIENT_PAIR;
    const struct handle *handle = pair ? result->pair->handle : result->scene->handle;
    const int32_t count = pair ? 2 : result->scene->handle_count;
    int32_t used = 0;
    for (int32_t i = 0; i < part->placement_count; i++) {
        struct held_body *body = part->whole[i] ? entry_of(part, i) : NULL;
        if (!body && !pair) /* results of scenes have no handle for it */
            continue;
        if (used == count || !handle_equal(body ? &body->handle : &none, &handle[used++]))
            return false;
        if (body)
            body->held = true;
    }
    return used == count;
}

/* Notes that the service does not hold the i-th body. Returns false if it was not sent by handle.
 */
static bool forget(const struct part *part, int32_t i)
{
    struct held_body *body =
        i < part->placement_count && !part->whole[i] ? entry_of(part, i) : NULL;
    if (!body)
        return false;
    body->held = false;
    return true;
}

/* Notes the bodies that the service does not hold. Returns false if the result names a body that
 * was not sent by handle. */
static bool take_unknown(const struct part *part, const struct request_result *result)
{
    if (result->kind == FMB_CLIENT_PAIR) { /* it does not say which of the two */
        const bool first = forget(part, 0), second = forget(part, 1);
        return first || second;
    }
    for (int32_t i = 0; i < result->scene->unknown_count; i++)
        if (!forget(part, (int32_t) result->scene->unknown[i]))
            return false;
    return true;
}

/* ---- Contents of results ---- */

static bool fits_frames(const struct part *part, const unsigned pair[2], const struct fmb_gap *gap)
{
    return gap->frame[0] < placement_of(part, pair[0])->body->frame_count &&
           gap->frame[1] < placement_of(part, pair[1])->body->frame_count;
}

/* Whether a result has what was wanted: gaps if and only if there is a verdict, of optional parts
 * (FMB_WANT_BOX, FMB_WANT_POINT) at most those wanted, and names of frames if and only if there are
 * gaps and a body has several frames. */
static bool fits_want(const struct part *part, bool any, bool gaps, unsigned optional, int dim,
                      bool named)
{
    const struct fmb_scene *scene = part->run->scene;
    bool several = false;
    for (int32_t i = 0; i < part->placement_count && gaps; i++)
        several = several || placement_of(part, (unsigned) i)->body->frame_count > 1;
    return gaps == (wants_gaps(scene) && any) && (optional & ~scene->want) == 0 &&
           (dim == 0 || dim == scene->placements[0].body->dim) && named == several;
}

/* Sets the pair of verdict k, indices in the part. Returns its number; -1: the query does not have
 * this pair. */
static int32_t number_of(const struct part *part, const struct scene_result *result, int32_t k,
                         unsigned pair[2])
{
    const int32_t number = part->answers.answered + k;
    const bool listed = part->which == FMB_PAIRS_LISTED;
    for (int f = 0; f < 2; f++)
        pair[f] = listed ? part->pair[number][f] : result->pair[k][f];
    if (listed)
        return number;
    return pair_is_among(part_numbers(part), pair[0], pair[1])
               ? (int32_t) pair_number(part_numbers(part), pair[0], pair[1])
               : -1;
}

/* Whether each pair of the result is in the query, comes once, in order, and, unless all are
 * listed, is a contact or near. */
static bool fits_pairs(const struct part *part, const struct scene_result *result)
{
    int32_t before = part->answers.answered - 1;
    for (int32_t k = 0; k < result->verdict_count; k++) {
        unsigned pair[2];
        const int32_t number = number_of(part, result, k, pair);
        const struct fmb_gap *gap = result->has_gaps ? &result->gap[k] : NULL;
        if (number <= before || number >= result->end_pair)
            return false;
        if (part->which != FMB_PAIRS_LISTED && result->verdict[k] == FMB_SEPARATED &&
            !(gap && part_is_near(part->run->scene, gap)))
            return false;
        if (gap && !fits_frames(part, pair, gap))
            return false;
        before = number;
    }
    return true;
}

static unsigned optional_parts(bool box, bool point)
{
    return (box ? FMB_WANT_BOX : 0) | (point ? FMB_WANT_POINT : 0);
}

static bool fits_scene(const struct part *part, const struct scene_result *result)
{
    const int32_t first = part->answers.answered;
    const bool any = result->verdict_count > 0, listed = part->which == FMB_PAIRS_LISTED;
    if (result->end_pair <= first || result->end_pair > part->total)
        return false;
    if (listed ? result->names_pairs || result->verdict_count != result->end_pair - first
               : result->names_pairs != any)
        return false;
    return result->has_times ==
               (part->run->scene->want & FMB_WANT_TIMES && result->contact_count > 0) &&
           fits_want(part, any, result->has_gaps,
                     optional_parts(result->has_boxes, result->has_points), result->dim,
                     result->names_frames) &&
           fits_pairs(part, result);
}

static bool fits_pair(const struct part *part, const struct pair_result *result)
{
    const struct fmb_answer *answer = &result->answer;
    const unsigned pair[2] = {part->pair[0][0], part->pair[0][1]};
    return fits_want(part, true, answer->has_gap,
                     optional_parts(answer->has_box, answer->has_point), result->dim,
                     result->names_frames) &&
           (!answer->has_box || answer->verdict >= FMB_TOUCHING) &&
           fits_frames(part, pair, &answer->gap) &&
           (!result->certificate || part->run->scene->want & FMB_WANT_CERTIFICATE);
}

/* Makes space for more answers. A part has few results, so that no space for later ones is needed.
 */
static bool reserve(struct part_answers *answers, size_t more)
{
    struct part_answer *answer =
        realloc(answers->answer, (answers->count + more + 1) * sizeof *answer);
    if (answer)
        answers->answer = answer;
    return answer != NULL;
}

/* Whether the answer is kept: it is more than that the pair is separated. */
static bool is_stored(const struct scene_result *result, int32_t k)
{
    return result->verdict[k] != FMB_SEPARATED ||
           (result->has_gaps && query_has_gap(&result->gap[k]));
}

/* Adds the answers of a result that fits. Returns false, and adds none, if out of memory. */
static bool add_scene(struct part *part, const struct scene_result *result)
{
    struct part_answers *answers = &part->answers;
    int32_t contact = 0;
    size_t found = 0;
    unsigned pair[2];
    for (int32_t k = 0; k < result->verdict_count; k++)
        found += is_stored(result, k);
    if (!reserve(answers, found))
        return false;
    for (int32_t k = 0; k < result->verdict_count; k++) {
        if (!is_stored(result, k))
            continue;
        struct part_answer *out = &answers->answer[answers->count++];
        *out = (struct part_answer){.number = number_of(part, result, k, pair)};
        wire_scene_answer(result, k, &contact, &out->answer);
    }
    answers->answered = result->end_pair;
    return true;
}

static bool add_pair(struct part *part, const struct pair_result *result)
{
    struct part_answers *answers = &part->answers;
    const struct fmb_scene *scene = part->run->scene;
    if (!reserve(answers, 1) ||
        (result->certificate && !(answers->certificate = strdup(result->certificate))))
        return false;
    struct part_answer *out = &answers->answer[answers->count++];
    *out = (struct part_answer){.answer = result->answer};
    if (!(scene->want & FMB_WANT_GAP))
        query_remove_far_gap(scene->margin, &out->answer);
    answers->answered = 1;
    return true;
}

/* ---- Results ---- */

static enum request_taken refuse(struct part *part, int status, const char *text)
{
    end_part(part, status, text);
    return REQUEST_COMPLETE;
}

/* Adapts the number of pairs in a query to the time that pairs take, so that all queries under way
 * are decided within half a timeout. */
static void adapt_pairs(struct scene_run *run, int32_t pairs, int64_t compute_ns)
{
    const double share = (double) run->requests->timeout_ns / (2 * FMB_CLIENT_RAW_WINDOW);
    const double each = (double) (compute_ns > 0 ? compute_ns : 1) / pairs;
    int32_t most = PAIRS_GROWTH * run->pairs_max;
    most = most < QUERY_PAIRS_MAX ? most : QUERY_PAIRS_MAX;
    run->pairs_max = share / each < most ? (int32_t) (share / each) : most;
    if (run->pairs_max < PAIRS_LEAST)
        run->pairs_max = PAIRS_LEAST;
}

static enum request_taken write_next(struct part *part, struct request *request)
{
    if (write_query(part, request))
        return REQUEST_NEXT;
    part->run->divide_again = part->run->division.by_handle;
    return refuse(part, FMB_OVER_LIMIT, "the bodies of a pair do not fit into one datagram");
}

static enum request_taken take_answers(struct part *part, struct request *request,
                                       const struct request_result *result)
{
    struct scene_run *run = part->run;
    struct part_answers *answers = &part->answers;
    const int32_t before = answers->answered;
    if (!take_handles(part, result))
        return REQUEST_MALFORMED;
    if (part->defining) {
        const bool empty = result->scene->end_pair == 0 && result->scene->verdict_count == 0;
        return empty ? write_next(part, request) : REQUEST_MALFORMED;
    }
    const bool pair = result->kind == FMB_CLIENT_PAIR;
    if (!(pair ? fits_pair(part, result->pair) : fits_scene(part, result->scene)))
        return REQUEST_MALFORMED;
    if (!(pair ? add_pair(part, result->pair) : add_scene(part, result->scene)))
        return refuse(part, FMB_CLIENT_NO_MEMORY, NULL);
    if (!pair && part->which == FMB_PAIRS_LISTED)
        adapt_pairs(run, answers->answered - before, result->scene->compute_ns);
    part->done = answers->answered == part->total;
    if (part->done)
        return REQUEST_COMPLETE;
    return write_next(part, request);
}

enum request_taken part_take(void *user, struct request *request,
                             const struct request_result *result)
{
    struct part *part = user;
    if (result->status < FMB_OK) {
        if (result->bytes) /* no service sends the status numbers of this library */
            return REQUEST_MALFORMED;
        if (result->status != FMB_CLIENT_NO_ANSWER)
            part->run->status = result->status;
        return refuse(part, result->status, NULL);
    }
    if (result->status == FMB_OK)
        return take_answers(part, request, result);
    if (result->status != FMB_UNKNOWN_BODY)
        return refuse(part, result->status, result->detail);
    if (!take_unknown(part, result))
        return REQUEST_MALFORMED;
    part->unknown++;
    return write_next(part, request);
}

void part_begin(struct scene_run *run, struct part *part, size_t bytes)
{
    part->run = run;
    part->unknown = part->definitions = 0;
    part->done = part->total == 0;
    if (run->status != FMB_OK)
        end_part(part, run->status, NULL);
    if (part->done)
        return;
    struct request *request = request_begin(
        run->requests, part->single ? FMB_CLIENT_PAIR : FMB_CLIENT_SCENE, bytes, part_take, part);
    if (write_next(part, request) == REQUEST_NEXT)
        request_send(run->requests, request);
    else
        request_end(run->requests, request);
}
