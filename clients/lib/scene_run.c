#include "scene_run.h"

#include "clock.h"
#include "order.h"
#include "wire.h"

#include <string.h>

enum {
    /* Pairs listed in a query: before it is known how long they take; at least; and the factor by
     * which the number grows at most. */
    PAIRS_FIRST = 256,
    PAIRS_LEAST = 16,
    PAIRS_GROWTH = 4,
    /* After this many results that name bodies not held, a part sends all its bodies whole. */
    UNKNOWN_MAX = 2
};

static struct part_run *part_of(struct scene_run *run, uint64_t part)
{
    return &run->part[part % FMB_CLIENT_RAW_WINDOW];
}

/* ---- Queries ---- */

/* Converts the i-th placement of the part, with its frames in geometry. */
static void whole_placement(const struct part_run *part, int32_t i, unsigned char *geometry,
                            struct placement *out)
{
    client_scene_placement(&part->run->scene->placements[part->part.placement[i]], geometry, out);
}

/* Returns the entry of the i-th placement of the part in the table of bodies; NULL: it is
 * anonymous. */
static struct held_body *entry_of(const struct part_run *part, int32_t i)
{
    struct scene_run *run = part->run;
    const struct division_body *body = &run->division->body[part->part.placement[i]];
    struct placement placement;
    if (!body->entry || body->entry->serial == body->serial)
        return body->entry;
    unsigned char *scratch = run->geometry + QUERY_BYTES_MAX;
    whole_placement(part, i, scratch, &placement);
    return held_find(run->held, &placement.geometry);
}

/* Converts the placements: by handle if the service holds the body, else with frames. Returns their
 * bytes; a number above max means that not all of them were converted. */
static size_t write_placements(struct part_run *part, size_t max, struct placement *out)
{
    unsigned char *geometry = part->run->geometry;
    size_t bytes = 0;
    for (int32_t i = 0; i < part->part.placement_count && bytes <= max; i++) {
        const struct held_body *body = part->unknown < UNKNOWN_MAX ? entry_of(part, i) : NULL;
        part->whole[i] = !body || !body->held;
        whole_placement(part, i, geometry, &out[i]);
        if (part->whole[i])
            geometry += out[i].geometry.size;
        else
            client_scene_use_handle(&out[i], &body->handle, part->run->none);
        bytes += wire_placement_bytes(&out[i]);
    }
    return bytes;
}

static int32_t method_of(const struct fmb_scene *scene)
{
    return scene->method ? scene->method->number : 0;
}

/* Writes a pair query. Returns its size, or 0 if it is too large. */
static size_t write_pair(struct part_run *part, unsigned char *out)
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

static struct scene_query *begin_query(const struct part_run *part)
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
    return query;
}

/* Writes a scene query without pairs, with bodies that the service does not hold, as many as fit.
 * Returns its size, or 0 if there are none. */
static size_t write_definitions(struct part_run *part, unsigned char *out)
{
    struct scene_query *query = begin_query(part);
    unsigned char *geometry = part->run->geometry;
    size_t left = QUERY_BYTES_MAX - WIRE_SCENE_QUERY_BYTES - wire_text_bytes(query->label);
    const bool may = part->unknown < UNKNOWN_MAX && part->definitions < part->part.placement_count;
    memset(part->whole, 0, sizeof part->whole);
    for (int32_t i = 0; i < part->part.placement_count && may; i++) {
        const struct held_body *body = entry_of(part, i);
        if (!body || body->held)
            continue;
        struct placement *placement = &query->placement[query->placement_count];
        whole_placement(part, i, geometry, placement);
        if (wire_placement_bytes(placement) > left)
            break;
        left -= wire_placement_bytes(placement);
        geometry += placement->geometry.size;
        part->whole[i] = true;
        query->placement_count++;
    }
    part->defining = query->placement_count > 0;
    part->definitions += part->defining;
    return part->defining ? wire_write_scene_query(query, out) : 0;
}

static size_t write_scene(struct part_run *part, unsigned char *out)
{
    const struct part *of = &part->part;
    const bool listed = of->which == FMB_PAIRS_LISTED;
    struct scene_query *query = begin_query(part);
    const size_t max = QUERY_BYTES_MAX - WIRE_SCENE_QUERY_BYTES - wire_text_bytes(query->label) -
                       (listed ? WIRE_PAIR_BYTES * (size_t) of->total : 0);
    const size_t bytes = write_placements(part, max, query->placement);
    if (bytes > max)
        return write_definitions(part, out);
    query->which = of->which;
    query->split = of->split;
    query->first_pair = part->answers.answered;
    query->placement_count = of->placement_count;
    query->index_count = listed ? 2 * of->total : 0;
    for (int32_t i = 0; i < query->index_count; i++)
        query->pair[i / 2][i % 2] = of->pair[i / 2][i % 2];
    /* If there is no space for all of them, order.c drops their answers. */
    query->ignored_count =
        2 * division_ignored(part->run->division, of, (int32_t) ((max - bytes) / WIRE_PAIR_BYTES),
                             query->ignored);
    return wire_write_scene_query(query, out);
}

/* Writes a query for the pairs that have no answers yet. Returns false if that is not possible. */
static bool write_query(struct part_run *part, struct request *request)
{
    struct fmb_client_counts *counts = &part->run->requests->counts;
    memcpy(part->whole_earlier, part->whole, sizeof part->whole);
    part->defining = false;
    request->size = (part->part.single ? write_pair : write_scene)(part, request->query);
    for (int32_t i = 0; i < part->part.placement_count && request->size > 0; i++) {
        counts->whole += part->whole[i];
        counts->by_handle += !part->whole[i] && !part->defining;
    }
    return request->size > 0;
}

/* ---- Handles in results ---- */

/* A result has the handles of the bodies that were sent whole, which the service then holds.
 * Returns false if its handles are others. */
static bool take_handles(const struct part_run *part, const bool *whole,
                         const struct request_result *result)
{
    static const struct handle none;
    const bool pair = result->kind == FMB_CLIENT_PAIR;
    const struct handle *handle = pair ? result->pair->handle : result->scene->handle;
    const int32_t count = pair ? 2 : result->scene->handle_count;
    int32_t used = 0;
    for (int32_t i = 0; i < part->part.placement_count; i++) {
        struct held_body *body = whole[i] ? entry_of(part, i) : NULL;
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
static bool forget(const struct part_run *part, int32_t i)
{
    struct held_body *body =
        i < part->part.placement_count && !part->whole[i] ? entry_of(part, i) : NULL;
    if (!body)
        return false;
    body->held = false;
    return true;
}

/* Notes the bodies that the service does not hold. Returns false if the result names a body that
 * was not sent by handle. */
static bool take_unknown(const struct part_run *part, const struct request_result *result)
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

/* ---- Results ---- */

static enum request_taken refuse(struct part_run *part, int status, const char *text)
{
    part_answers_refuse(&part->answers, status, text);
    part->done = true;
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

static enum request_taken write_next(struct part_run *part, struct request *request,
                                     enum request_taken taken)
{
    if (write_query(part, request))
        return taken;
    part->run->divide_again = part->run->division->by_handle;
    return refuse(part, FMB_OVER_LIMIT, "the bodies of a pair do not fit into one datagram");
}

static enum request_taken take_answers(struct part_run *part, struct request *request,
                                       const struct request_result *result)
{
    struct scene_run *run = part->run;
    struct part_answers *answers = &part->answers;
    const bool *whole = result->number == request->number ? part->whole : part->whole_earlier;
    const int32_t before = answers->answered;
    if (!take_handles(part, whole, result))
        return REQUEST_MALFORMED;
    if (part->defining && result->number == request->number) {
        const bool empty = result->scene->end_pair == 0 && result->scene->verdict_count == 0;
        return empty ? write_next(part, request, REQUEST_NEXT) : REQUEST_MALFORMED;
    }
    const enum part_taken taken =
        result->kind == FMB_CLIENT_PAIR
            ? part_take_pair(&part->part, run->scene, result->pair, answers)
            : part_take_scene(&part->part, run->scene, result->scene, answers);
    if (taken == PART_MALFORMED)
        return REQUEST_MALFORMED;
    if (taken == PART_NO_MEMORY)
        return refuse(part, FMB_CLIENT_NO_MEMORY, NULL);
    if (result->kind == FMB_CLIENT_SCENE && part->part.which == FMB_PAIRS_LISTED)
        adapt_pairs(run, answers->answered - before, result->scene->compute_ns);
    part->done = answers->answered == part->part.total;
    if (part->done)
        return REQUEST_COMPLETE;
    return write_next(part, request, REQUEST_NEXT);
}

static enum request_taken take_result(void *user, struct request *request,
                                      const struct request_result *result)
{
    struct part_run *part = user;
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
    return write_next(part, request, REQUEST_WHOLE);
}

/* ---- The window of parts ---- */

static void begin_part(struct scene_run *run, struct part_run *part, size_t bytes)
{
    const enum fmb_client_kind kind = part->part.single ? FMB_CLIENT_PAIR : FMB_CLIENT_SCENE;
    part->run = run;
    part->unknown = part->definitions = 0;
    part->done = part->part.total == 0;
    run->next++;
    if (part->done)
        return;
    if (run->status != FMB_OK) {
        refuse(part, run->status, NULL);
        return;
    }
    struct request *request = request_begin(run->requests, kind, bytes, take_result, part);
    if (write_next(part, request, REQUEST_NEXT) == REQUEST_NEXT)
        request_send(run->requests, request);
    else
        request_end(run->requests, request);
}

/* Begins parts while there is space for their queries. Returns false after the last part. */
static bool fill_window(struct scene_run *run, struct division *division)
{
    while (run->next - run->oldest < FMB_CLIENT_RAW_WINDOW) {
        struct part_run *part = part_of(run, run->next);
        if (!run->has_next && !division_next(division, run->pairs_max, &part->part))
            return false;
        const size_t query = part->part.bytes, result = part_result_bytes(&part->part, run->scene);
        const size_t bytes = query > result ? query : result;
        run->has_next = run->status == FMB_OK && !requests_ready(run->requests, bytes);
        if (run->has_next)
            return true;
        begin_part(run, part, bytes);
    }
    return true;
}

/* Delivers the parts that are complete, up to the first that is not. */
static void deliver(struct scene_run *run, struct order *order)
{
    while (run->oldest < run->next && part_of(run, run->oldest)->done) {
        struct part_run *part = part_of(run, run->oldest++);
        if (run->divide_again)
            part_answers_clear(&part->answers);
        else
            order_take(order, &part->part, &part->answers);
    }
}

static void wait_for_results(struct scene_run *run)
{
    requests_step(run->requests, -1, run->until);
    if (run->status == FMB_OK && run->until < clock_ns())
        run->status = FMB_CLIENT_LATE;
    if (run->status == FMB_CLIENT_LATE)
        requests_give_up(run->requests, FMB_CLIENT_LATE);
}

static void begin(struct scene_run *run, const struct fmb_scene *scene,
                  const struct division *division)
{
    const double most = 1e9; /* seconds: some 30 years are no limit */
    const double within = run->within > 0 && run->within < most ? run->within : most;
    if (run->pairs_max == 0 || run->method != scene->method || run->want != scene->want)
        run->pairs_max = PAIRS_FIRST;
    run->divide_again = false;
    run->division = division;
    run->scene = scene;
    run->method = scene->method;
    run->want = scene->want;
    run->status = FMB_OK;
    run->until = clock_ns() + (int64_t) (within * 1e9);
}

static int run_division(struct scene_run *run, const struct fmb_scene *scene,
                        struct division *division, fmb_client_sink *sink, void *user)
{
    struct order order;
    if (!order_begin(division, sink, user, &order))
        return FMB_CLIENT_NO_MEMORY;
    begin(run, scene, division);
    for (bool more = true; more || run->oldest < run->next;) {
        more = more && fill_window(run, division);
        deliver(run, &order); /* before results are received: sink may take long */
        if (run->requests->count > 0)
            wait_for_results(run);
    }
    order_end(&order);
    return FMB_OK;
}

int scene_run(struct scene_run *run, const struct fmb_scene *scene, bool single,
              fmb_client_sink *sink, void *user)
{
    int status;
    run->divide_again = false;
    do {
        struct division division;
        const bool begun =
            division_begin(scene, single, run->divide_again, run->held, run->geometry, &division);
        status = begun ? run_division(run, scene, &division, sink, user) : FMB_CLIENT_NO_MEMORY;
        division_end(&division);
    } while (run->divide_again && status == FMB_OK);
    return status;
}
