#include "log_world.h"

#include "answer_now.h"
#include "geometry_write.h"
#include "log_write.h"
#include "wire.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { BODIES = 10, CLIENTS = 2, LIVES = 3, PLACEMENTS_MAX = 6, RECORDER = 99 };

/* What is under way. */
struct making {
    const struct world_options *options;
    struct log_world *world;
    struct answerer *answerer;
    struct answer_job *job;
    double now;
    int64_t sequence;
    struct handle handle[CLIENTS][BODIES + 1]; /* [client][body]: of a result; all 0: none */
    int form[BODIES + 1];                      /* [body]: which frame it has */
};

static struct scene_query scene;
static unsigned char bytes[QUERY_BYTES_MAX];

/* ---- What is drawn ---- */

int world_draw(struct log_world *world, int n)
{
    world->state = world->state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (int) ((world->state >> 33) % (uint64_t) n);
}

/* Once in n times. */
static bool happens(struct log_world *world, int n)
{
    return world_draw(world, n) == 0;
}

/* ---- Events ---- */

static void put(struct log_world *world, double at, const char *channel, const void *data,
                size_t size)
{
    if (world->count == world->capacity) {
        world->capacity = world->capacity ? 2 * world->capacity : 64;
        world->event = realloc(world->event, world->capacity * sizeof *world->event);
        assert_non_null(world->event);
    }
    struct world_event *event = &world->event[world->count++];
    *event = (struct world_event){.at = at, .channel = channel, .size = size};
    event->bytes = malloc(size ? size : 1);
    assert_non_null(event->bytes);
    memcpy(event->bytes, data, size);
}

static int64_t utime_of(size_t place)
{
    return LOG_WORLD_BEGIN + (int64_t) place * LOG_WORLD_STEP;
}

void world_add(struct log_world *world, const char *channel, const void *data, size_t size)
{
    put(world, 0, channel, data, size);
    world->event[world->count - 1].utime = utime_of(world->count - 1);
}

static int compare(const void *left, const void *right)
{
    const struct world_event *a = left, *b = right;
    return (a->at > b->at) - (a->at < b->at);
}

/* No two places are drawn alike. */
static void put_in_order(struct log_world *world)
{
    qsort(world->event, world->count, sizeof *world->event, compare);
    for (size_t i = 0; i < world->count; i++)
        world->event[i].utime = utime_of(i);
}

void log_world_clear(struct log_world *world)
{
    for (size_t i = 0; i < world->count; i++)
        free(world->event[i].bytes);
    free(world->event);
    *world = (struct log_world){.event = NULL};
}

void world_write(const struct log_world *world, const char *path)
{
    struct log_writer *writer = log_begin(output_open_in_place(path, true));
    assert_non_null(writer);
    for (size_t i = 0; i < world->count; i++) {
        const struct world_event *event = &world->event[i];
        assert_true(log_append(writer, event->utime, event->channel, strlen(event->channel),
                               event->bytes, event->size));
    }
    assert_int_equal(log_finish(writer), 0);
}

/* ---- Services ---- */

static void start_service(struct making *making, int life, size_t frames)
{
    const struct answerer_options options = {
        .frames = frames, .server_id = 50 + life, .secret = {3, 4}};
    answerer_destroy(making->answerer);
    making->answerer = answerer_create(&options);
    assert_non_null(making->answerer);
}

static void open_making(struct making *making, size_t frames)
{
    making->job = answer_job_create();
    assert_non_null(making->job);
    start_service(making, 0, frames);
}

static void close_making(struct making *making)
{
    answerer_destroy(making->answerer);
    answer_job_destroy(making->job);
}

/* In: the query, in bytes. */
static const struct scene_result *answer_scene(struct making *making, size_t size)
{
    assert_null(answer_job_begin(making->job, ANSWER_SCENE, bytes, size));
    while (!answer_job_step(making->job, making->answerer))
        continue;
    return answer_job_scene_result(making->job);
}

/* ---- Bodies ---- */

/* A box or a corner of its own for each body and form, so that all verdicts come. The geometry is
 * valid until some more are made. */
static void set_body(int body, int form, struct query_placement *out)
{
    enum { KEPT = 2048 };
    static unsigned char kept[KEPT][GEOMETRY_FRAME_BYTES_MAX];
    static int next;
    const double size = 0.5 * (1 + (body + form) % 3);
    struct plain_frame frame = {.shape = body % 2 ? FMB_CUBOID : FMB_TETRAHEDRON};
    for (int i = 0; i < 3; i++)
        frame.components[4 * i] = size;
    frame.components[1] = 0.25 * form;
    unsigned char *to = kept[next++ % KEPT];
    out->body = geometry_write(3, &frame, to);
}

static void set_handle(const struct handle *handle, struct query_placement *out)
{
    out->body = geometry_named(3, handle);
}

static struct query_placement draw_placement(struct making *making, int client)
{
    struct log_world *world = making->world;
    const int body = happens(world, 8) ? 0 : 1 + world_draw(world, BODIES);
    struct query_placement placement = {.placed.id = body};
    for (int axis = 0; axis < 3; axis++)
        placement.placed.position[axis] = 0.5 * world_draw(world, 5);
    if (happens(world, 3)) {
        placement.velocity_count = 3;
        placement.placed.velocity[world_draw(world, 3)] = 0.5 * (world_draw(world, 7) - 3);
    }
    set_body(body, making->form[body], &placement);
    if (!handle_is_none(&making->handle[client][body]) && !happens(world, 6))
        set_handle(&making->handle[client][body], &placement);
    if (happens(world, 40))
        placement.placed.position[0] = 1.0 / 0.0;
    return placement;
}

/* A client whose handle is not held sends the body whole, but not always at once. */
static void take_handle(struct making *making, int client, int64_t body, int32_t status,
                        const struct handle *handle)
{
    struct handle *known = &making->handle[client][body];
    if (body != 0 && !handle_is_none(handle))
        *known = *handle;
    else if (status == FMB_UNKNOWN_BODY && !happens(making->world, 3))
        *known = (struct handle){{0}};
}

/* ---- Where queries and results stand ---- */

static double some(struct making *making)
{
    return 1e-6 * (1 + world_draw(making->world, 900000));
}

static double place_of_result(struct making *making, double query)
{
    switch (world_draw(making->world, 8)) {
    case 0: return query - 3 * some(making);  /* before it, and before others */
    case 1: return query + 12 * some(making); /* others come meanwhile */
    default: return query + 0.5 * some(making);
    }
}

/* Both are of one datagram each. */
static void put_query(struct making *making, const char *channel, size_t size)
{
    if (!happens(making->world, 25))
        put(making->world, making->now, channel, bytes, size);
}

static void put_result(struct making *making, const char *channel, size_t size)
{
    if (!happens(making->world, 25))
        put(making->world, place_of_result(making, making->now), channel, bytes, size);
}

/* ---- Queries ---- */

static void send_pair_once(struct making *making, const struct pair_query *query, int client)
{
    struct pair_result result;
    put_query(making, WIRE_PAIR_QUERY, wire_write_pair_query(query, bytes));
    if (happens(making->world, 30))
        answer_pair_refused(making->answerer, query, FMB_BUSY, &result);
    else
        answer_pair(making->answerer, query, &result);
    put_result(making, WIRE_PAIR_RESULT, wire_write_pair_result(&result, bytes));
    for (int p = 0; p < 2; p++)
        take_handle(making, client, query->placement[p].placed.id, result.status,
                    &result.handle[p]);
}

static void send_pair(struct making *making, int client)
{
    struct pair_query query = {.utime = (int64_t) (1e6 * making->now),
                               .client_id = 70 + client,
                               .sequence_number = making->sequence++,
                               .duration = 1,
                               .want = world_draw(making->world, 4)};
    for (int p = 0; p < 2; p++)
        query.placement[p] = draw_placement(making, client);
    send_pair_once(making, &query, client);
    if (making->options->once || !happens(making->world, 10))
        return;
    making->now += some(making);
    send_pair_once(making, &query, client);
}

static void draw_pairs(struct making *making)
{
    const int n = scene.placement_count;
    scene.split = scene.first_pair = scene.index_count = 0;
    static const int32_t which[] = {FMB_PAIRS_LISTED, FMB_PAIRS_ALL, FMB_PAIRS_ACROSS};
    scene.which = which[world_draw(making->world, 3)];
    if (scene.which == FMB_PAIRS_ACROSS)
        scene.split = 1 + world_draw(making->world, n - 1);
    else if (scene.which == FMB_PAIRS_ALL)
        scene.first_pair = world_draw(making->world, 2);
    else
        for (; scene.index_count < 8; scene.index_count += 2) {
            const unsigned a = (unsigned) world_draw(making->world, n);
            unsigned *pair = scene.pair[scene.index_count / 2];
            pair[0] = a;
            pair[1] = (a + 1 + (unsigned) world_draw(making->world, n - 1)) % (unsigned) n;
        }
}

static void send_scene(struct making *making, int client)
{
    struct log_world *world = making->world;
    static struct handle handles[QUERY_PLACEMENTS_MAX];
    scene.utime = (int64_t) (1e6 * making->now);
    scene.client_id = 70 + client;
    scene.sequence_number = making->sequence++;
    scene.duration = 1;
    scene.method = 0;
    scene.want = world_draw(world, 2) * FMB_WANT_BOX + world_draw(world, 2) * FMB_WANT_TIMES;
    scene.placement_count = 2 + world_draw(world, PLACEMENTS_MAX - 1);
    for (int i = 0; i < scene.placement_count; i++)
        scene.placement[i] = draw_placement(making, client);
    draw_pairs(making);
    const size_t size = wire_write_scene_query(&scene, bytes);
    put_query(making, WIRE_SCENE_QUERY, size);
    const struct scene_result *result = answer_scene(making, size);
    const int32_t status = result->status, count = result->handle_count;
    memcpy(handles, result->handle, (size_t) count * sizeof *handles);
    put_result(making, WIRE_SCENE_RESULT, wire_write_scene_result(result, bytes));
    for (int i = 0, next = 0; i < scene.placement_count; i++) {
        const bool whole =
            scene.placement[i].placed.id != 0 && scene.placement[i].body.frame_count > 0;
        const struct handle none = {{0}};
        take_handle(making, client, scene.placement[i].placed.id, status,
                    whole && next < count ? &handles[next++] : &none);
    }
}

/* A recorder requests all bodies. */
static void send_definition_query(struct making *making)
{
    static struct definition_query query;
    static struct definition result;
    query = (struct definition_query){.client_id = RECORDER, .sequence_number = making->sequence++};
    put_query(making, WIRE_DEFINITION_QUERY, wire_write_definition_query(&query, bytes));
    answer_definition(making->answerer, &query, &result);
    put_result(making, WIRE_DEFINITION, wire_write_definition(&result, bytes));
}

static void put_other(struct making *making)
{
    static const char *const channel[] = {WIRE_STATUS, "CAMERA", WIRE_PAIR_QUERY, WIRE_SCENE_RESULT,
                                          WIRE_DEFINITION};
    put(making->world, making->now, channel[world_draw(making->world, 5)], "no message", 10);
}

static void take_step(struct making *making)
{
    struct log_world *world = making->world;
    const int client = world_draw(world, CLIENTS);
    making->now += 1 + some(making);
    if (happens(world, 12))
        making->form[1 + world_draw(world, BODIES)]++;
    if (happens(world, 12))
        put_other(making);
    else if (happens(world, 40))
        send_definition_query(making);
    else if (happens(world, 3))
        send_scene(making, client);
    else
        send_pair(making, client);
}

void world_make(const struct world_options *options, struct log_world *out)
{
    struct making making = {.options = options, .world = out};
    *out = (struct log_world){.seed = options->seed, .state = options->seed};
    open_making(&making, BODIES);
    for (int life = 0; life < LIVES; life++) {
        start_service(&making, life, BODIES);
        for (int step = 0; step < options->steps; step++)
            take_step(&making);
    }
    put_in_order(out);
    close_making(&making);
}

/* ---- Large scenes ---- */

/* In a row, each overlaps the next. */
static void set_row(int first, int count)
{
    for (int i = 0; i < count; i++) {
        scene.placement[i] = (struct query_placement){.placed.id = 1 + first + i};
        set_body(1 + 2 * i, first + i, &scene.placement[i]);
        scene.placement[i].placed.position[0] = 0.4 * (first + i);
    }
    scene.placement_count = count;
}

static const struct scene_result *add_scene(struct making *making)
{
    scene.sequence_number = making->sequence++;
    const size_t size = wire_write_scene_query(&scene, bytes);
    world_add(making->world, WIRE_SCENE_QUERY, bytes, size);
    const struct scene_result *result = answer_scene(making, size);
    assert_int_equal(result->status, FMB_OK);
    world_add(making->world, WIRE_SCENE_RESULT, bytes, wire_write_scene_result(result, bytes));
    return result;
}

enum { WHOLE_AT_ONCE = 300 };

void world_make_large(int bodies, int scenes, struct log_world *out)
{
    const struct world_options options = {.once = true};
    struct making making = {.options = &options, .world = out, .sequence = 1};
    struct handle *handle = calloc((size_t) bodies, sizeof *handle);
    *out = (struct log_world){.state = 1};
    assert_non_null(handle);
    open_making(&making, (size_t) bodies);
    scene.utime = scene.client_id = 9;
    scene.duration = 1;
    scene.method = scene.want = scene.split = scene.first_pair = scene.index_count = 0;
    scene.which = FMB_PAIRS_ALL;
    for (int first = 0, count; first < bodies; first += count) {
        count = first == 0 && bodies % WHOLE_AT_ONCE ? bodies % WHOLE_AT_ONCE : WHOLE_AT_ONCE;
        set_row(first, count);
        memcpy(handle + first, add_scene(&making)->handle, (size_t) count * sizeof *handle);
    }
    for (int i = 0; i < scenes; i++) {
        set_row(0, bodies);
        for (int k = 0; k < bodies; k++)
            set_handle(&handle[k], &scene.placement[k]);
        add_scene(&making);
    }
    free(handle);
    close_making(&making);
}

/* ---- Far apart ---- */

void world_make_apart(int pairs, struct log_world *out)
{
    const struct world_options options = {.seed = 5};
    struct making making = {.options = &options, .world = out};
    struct pair_query query = {.client_id = 8, .duration = 1};
    struct pair_result result;
    *out = (struct log_world){.state = 5};
    open_making(&making, BODIES);
    for (int results = 0; results < 2; results++)
        for (int i = 0; i < pairs; i++) {
            query.sequence_number = i;
            for (int p = 0; p < 2; p++) {
                query.placement[p] = (struct query_placement){.placed.id = 1 + (i + p) % BODIES};
                query.placement[p].placed.position[0] = i % 3;
                set_body(1 + (i + p) % BODIES, 0, &query.placement[p]);
            }
            if (results == 0) {
                world_add(out, WIRE_PAIR_QUERY, bytes, wire_write_pair_query(&query, bytes));
                continue;
            }
            answer_pair(making.answerer, &query, &result);
            world_add(out, WIRE_PAIR_RESULT, bytes, wire_write_pair_result(&result, bytes));
        }
    close_making(&making);
}
