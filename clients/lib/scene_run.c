#include "scene_run.h"

#include "client.h"
#include "clock.h"
#include "order.h"
#include "wire.h"

#include <stdio.h>
#include <string.h>

enum {
    /* Pairs listed in a query, before it is known how long they take, and at least. */
    PAIRS_FIRST = 256,
    PAIRS_LEAST = 16,
    PAIRS_GROWTH = 4,
    /* After this many results with bodies that were not held, all are sent whole. */
    UNKNOWN_MAX = 2
};

static struct part_run *part_of(struct scene_run *run, uint64_t part)
{
    return &run->part[part % FMB_CLIENT_RAW_WINDOW];
}

/* ---- Queries ---- */

/* The i-th placement of the part, whole, with its geometry in the run. */
static void whole_placement(const struct part_run *part, int32_t i, struct placement *out)
{
    struct scene_run *run = part->run;
    question_placement(&run->scene->placements[part->part.placement[i]], run->geometry[i], out);
}

/* A body that the service holds is sent by handle. */
static void write_placement(struct part_run *part, int32_t i, struct placement *out)
{
    struct fmb_client *client = part->run->client;
    whole_placement(part, i, out);
    part->whole[i] = true;
    if (out->body_id != 0 && part->unknown < UNKNOWN_MAX) {
        const struct held_body *body = held_find(&client->held, &out->geometry);
        part->whole[i] = !body->held;
        out->handle = body->held ? body->handle : out->handle;
    }
    if (!part->whole[i]) {
        unsigned char *geometry = part->run->geometry[i];
        geometry_write_none(out->dim, geometry);
        out->geometry = (struct geometry){geometry, GEOMETRY_NONE_BYTES};
        out->frame_count = 0;
    }
    client->counts.whole += part->whole[i];
    client->counts.by_handle += !part->whole[i];
}

static size_t write_pair(struct part_run *part, unsigned char *out)
{
    const struct fmb_client_scene *scene = part->run->scene;
    struct pair_query query = {.utime = clock_utime(),
                               .duration = scene->duration,
                               .method = scene->method,
                               .want = (int32_t) scene->want & ~QUERY_WANT_TIMES};
    for (int32_t i = 0; i < 2; i++)
        write_placement(part, i, &query.placement[i]);
    return wire_write_pair_query(&query, out);
}

static size_t write_scene(struct part_run *part, unsigned char *out)
{
    const struct fmb_client_scene *scene = part->run->scene;
    const struct part *of = &part->part;
    struct scene_query *query = &part->run->query;
    query->utime = clock_utime();
    query->duration = scene->duration;
    query->method = scene->method;
    query->want = (int32_t) scene->want;
    query->which = of->which;
    query->split = of->split;
    query->first_pair = part->answers.answered;
    query->placement_count = of->placement_count;
    query->index_count = of->which == QUERY_PAIRS_LISTED ? 2 * of->total : 0;
    for (int32_t i = 0; i < of->placement_count; i++)
        write_placement(part, i, &query->placement[i]);
    for (int32_t i = 0; i < query->index_count; i++)
        query->pair[i / 2][i % 2] = of->pair[i / 2][i % 2];
    return wire_write_scene_query(query, out);
}

/* Asks for what the part has no answers to yet. */
static void write_query(struct part_run *part, struct request *request)
{
    memcpy(part->whole_earlier, part->whole, sizeof part->whole);
    request->size = (part->part.single ? write_pair : write_scene)(part, request->query);
}

/* ---- Handles in results ---- */

/* The handle of the i-th placement if it was sent whole with an id, and *body; else none. */
static struct handle handle_of(const struct part_run *part, const bool *whole, int32_t i,
                               struct held_body **body)
{
    static const struct handle none;
    struct placement placement;
    if (!whole[i] || part->run->scene->placements[part->part.placement[i]].body_id == 0)
        return none;
    whole_placement(part, i, &placement);
    *body = held_find(&part->run->client->held, &placement.geometry);
    return (*body)->handle;
}

/* The handles of a result are those of the bodies that were sent whole: the service holds them. On
 * output: false where they are others. */
static bool take_handles(const struct part_run *part, const bool *whole,
                         const struct request_result *result)
{
    const bool pair = result->kind == FMB_CLIENT_PAIR;
    const struct handle *handle = pair ? result->pair->handle : result->scene->handle;
    const int32_t count = pair ? 2 : result->scene->handle_count;
    int32_t used = 0;
    for (int32_t i = 0; i < part->part.placement_count; i++) {
        struct held_body *body = NULL;
        const struct handle own = handle_of(part, whole, i, &body);
        if (!body && !pair) /* results of scenes have no handle for it */
            continue;
        if (used == count || !handle_equal(&own, &handle[used++]))
            return false;
        if (body)
            body->held = true;
    }
    return used == count;
}

/* On output: false where the i-th placement was not sent by handle. */
static bool forget(const struct part_run *part, int32_t i)
{
    struct placement placement;
    if (i >= part->part.placement_count || part->whole[i])
        return false;
    whole_placement(part, i, &placement);
    held_find(&part->run->client->held, &placement.geometry)->held = false;
    return true;
}

/* Bodies that are not held. On output: false where the result names others than were sent by
 * handle. */
static bool take_unknown(const struct part_run *part, const struct request_result *result)
{
    if (result->kind == FMB_CLIENT_PAIR) { /* which of the two is not said */
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

/* All that is under way is to be decided within half a timeout; pairs of this kind take so long. */
static void adapt_pairs(struct scene_run *run, int32_t pairs, int64_t compute_ns)
{
    const double share = (double) run->client->timeout_ns / (2 * FMB_CLIENT_RAW_WINDOW);
    const double each = (double) (compute_ns > 0 ? compute_ns : 1) / pairs;
    int32_t most = PAIRS_GROWTH * run->pairs_max;
    most = most < QUERY_PAIRS_MAX ? most : QUERY_PAIRS_MAX;
    run->pairs_max = share / each < most ? (int32_t) (share / each) : most;
    if (run->pairs_max < PAIRS_LEAST)
        run->pairs_max = PAIRS_LEAST;
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
    const enum part_taken taken =
        result->kind == FMB_CLIENT_PAIR
            ? part_take_pair(&part->part, run->scene, result->pair, answers)
            : part_take_scene(&part->part, run->scene, result->scene, answers);
    if (taken == PART_MALFORMED)
        return REQUEST_MALFORMED;
    if (taken == PART_NO_MEMORY)
        return refuse(part, FMB_CLIENT_NO_MEMORY, NULL);
    if (result->kind == FMB_CLIENT_SCENE && part->part.which == QUERY_PAIRS_LISTED)
        adapt_pairs(run, answers->answered - before, result->scene->compute_ns);
    part->done = answers->answered == part->part.total;
    if (part->done)
        return REQUEST_COMPLETE;
    write_query(part, request);
    return REQUEST_NEXT;
}

static enum request_taken take_result(void *user, struct request *request,
                                      const struct request_result *result)
{
    struct part_run *part = user;
    if (result->status < FMB_OK) {
        if (result->bytes) /* of a message: those numbers are the library's own */
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
    write_query(part, request);
    return REQUEST_WHOLE;
}

/* ---- The window of parts ---- */

static size_t bytes_of(const struct scene_run *run, const struct part *part)
{
    const size_t result = part_result_bytes(part, run->scene);
    return part->bytes > result ? part->bytes : result;
}

static void begin_part(struct scene_run *run, struct part_run *part, size_t bytes)
{
    struct fmb_client *client = run->client;
    const enum fmb_client_kind kind = part->part.single ? FMB_CLIENT_PAIR : FMB_CLIENT_SCENE;
    part->run = run;
    part->unknown = 0;
    part->done = part->part.total == 0;
    run->next++;
    if (part->done)
        return;
    if (run->status != FMB_OK) {
        refuse(part, run->status, NULL);
        return;
    }
    struct request *request = request_begin(client, kind, bytes, take_result, part);
    write_query(part, request);
    request_send(client, request);
}

/* On output: false once there are no more parts. */
static bool fill_window(struct scene_run *run, struct cut *cut)
{
    const struct requests *requests = &run->client->requests;
    while (run->next - run->oldest < FMB_CLIENT_RAW_WINDOW) {
        struct part_run *part = part_of(run, run->next);
        if (!run->cut && !cut_next(cut, run->pairs_max, &part->part))
            return false;
        const size_t bytes = bytes_of(run, &part->part);
        run->cut = run->status == FMB_OK && !requests_ready(requests, bytes);
        if (run->cut)
            return true;
        begin_part(run, part, bytes);
    }
    return true;
}

static void deliver(struct scene_run *run, struct order *order)
{
    while (run->oldest < run->next && part_of(run, run->oldest)->done) {
        struct part_run *part = part_of(run, run->oldest++);
        order_take(order, &part->part, &part->answers);
    }
}

static void wait_for_results(struct scene_run *run)
{
    requests_step(run->client, -1, run->until);
    if (run->status == FMB_OK && run->until < clock_ns())
        run->status = FMB_CLIENT_LATE;
    if (run->status == FMB_CLIENT_LATE)
        requests_give_up(run->client, FMB_CLIENT_LATE);
}

static void begin(struct scene_run *run, const struct fmb_client_scene *scene)
{
    const double most = 1e9; /* seconds: some 30 years are no limit */
    const double within = scene->within > 0 && scene->within < most ? scene->within : most;
    if (run->pairs_max == 0 || run->method != scene->method || run->want != scene->want)
        run->pairs_max = PAIRS_FIRST;
    run->scene = scene;
    run->method = scene->method;
    run->want = scene->want;
    run->status = FMB_OK;
    run->until = clock_ns() + (int64_t) (within * 1e9);
}

/* What is complete is delivered before more is received: the caller may take long over it. */
static void run_parts(struct scene_run *run, struct cut *cut, struct order *order)
{
    bool more = true;
    while (more || run->oldest < run->next) {
        more = more && fill_window(run, cut);
        deliver(run, order);
        if (run->client->requests.count > 0)
            wait_for_results(run);
    }
}

/* ---- The calls ---- */

const char *fmb_client_why(const struct fmb_client *client)
{
    return client->why;
}

/* A status of the whole scene. */
static int fail(struct fmb_client *client, int status)
{
    snprintf(client->why, sizeof client->why, "%s", fmb_client_status_text(status));
    return status;
}

static int query_parts(struct fmb_client *client, const struct fmb_client_scene *scene,
                       struct cut *cut, fmb_client_sink *sink, void *user)
{
    struct order order;
    if (!order_begin(cut, sink, user, &order))
        return fail(client, FMB_CLIENT_NO_MEMORY);
    client->inside = true;
    client->run.client = client;
    begin(&client->run, scene);
    run_parts(&client->run, cut, &order);
    client->inside = false;
    order_end(&order);
    return FMB_OK;
}

/* single: each pair is a query of its own. */
static int query(struct fmb_client *client, const struct fmb_client_scene *scene, bool single,
                 fmb_client_sink *sink, void *user)
{
    struct cut cut;
    if (client->inside)
        return FMB_CLIENT_INSIDE;
    const int status = question_check(scene, client->why);
    if (status != FMB_OK)
        return status;
    if (client->failed || !client_listen(client, single ? FMB_CLIENT_PAIR : FMB_CLIENT_SCENE))
        return fail(client, FMB_CLIENT_NO_BUS);
    if (!cut_begin(scene, single, &cut))
        return fail(client, FMB_CLIENT_NO_MEMORY);
    const int done = query_parts(client, scene, &cut, sink, user);
    cut_end(&cut);
    return done;
}

int fmb_client_query(struct fmb_client *client, const struct fmb_client_scene *scene,
                     fmb_client_sink *sink, void *user)
{
    return query(client, scene, scene->want & FMB_CLIENT_WANT_CERTIFICATE, sink, user);
}

static void keep_answer(void *user, const struct fmb_client_answer *answer)
{
    struct fmb_client *client = user;
    client->answer = *answer;
    snprintf(client->text, sizeof client->text, "%s", answer->text);
    client->answer.text = client->text;
    if (answer->certificate)
        client->answer.certificate = strcpy(client->certificate, answer->certificate);
}

int fmb_client_query_pair(struct fmb_client *client, const struct fmb_client_placement pair[2],
                          double duration, unsigned want, struct fmb_client_answer *out)
{
    static const unsigned both[1][2] = {{0, 1}};
    const struct fmb_client_scene scene = {.placements = pair,
                                           .placement_count = 2,
                                           .which = FMB_CLIENT_LISTED,
                                           .pairs = both,
                                           .pair_count = 1,
                                           .duration = duration,
                                           .want = want};
    *out = (struct fmb_client_answer){.b = 1, .text = ""};
    out->status = query(client, &scene, true, keep_answer, client);
    if (out->status == FMB_OK)
        *out = client->answer;
    else
        out->text =
            out->status == FMB_CLIENT_INSIDE ? fmb_client_status_text(out->status) : client->why;
    return out->status;
}
