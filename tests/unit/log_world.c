#include "log_world.h"

#include "answer.h"
#include "log_write.h"
#include "wire.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { BODIES = 10, CLIENTS = 2, LIVES = 3, FRAMES_MAX = 6 };

/* What is under way. */
struct making {
    const struct world_options *options;
    struct log_world *world;
    struct answerer answerer;
    double now;
    int64_t sequence;
    int64_t key[CLIENTS][BODIES + 1]; /* [client][body]: as it was told; 0: not */
    int form[BODIES + 1];             /* [body]: which components it has */
};

static struct scene_query scene;
static struct scene_result scene_result;
static unsigned char bytes[QUERY_BYTES_MAX + WIRE_RESULT_BYTES_MAX];

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
    if (world->count == world->room) {
        world->room = world->room ? 2 * world->room : 64;
        world->event = realloc(world->event, world->room * sizeof *world->event);
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

void world_clear(struct log_world *world)
{
    for (size_t i = 0; i < world->count; i++)
        free(world->event[i].bytes);
    free(world->event);
    *world = (struct log_world){.event = NULL};
}

void world_write(const struct log_world *world, const char *path)
{
    struct log_writer *writer = log_create(path, true);
    assert_non_null(writer);
    for (size_t i = 0; i < world->count; i++) {
        const struct world_event *event = &world->event[i];
        assert_true(log_append(writer, event->utime, event->channel, strlen(event->channel),
                               event->bytes, event->size));
    }
    assert_int_equal(log_finish(writer), 0);
}

/* ---- Services ---- */

static void start(struct making *making, int life)
{
    const int64_t first_key = making->options->same_keys ? 7 : 1000 * (life + 1);
    cache_destroy(making->answerer.cache);
    making->answerer.cache = cache_create(BODIES, first_key);
    making->answerer.server_id = 50 + life;
    assert_non_null(making->answerer.cache);
}

static void open_making(struct making *making)
{
    assert_true(answer_prepare(&making->answerer));
    start(making, 0);
}

static void close_making(struct making *making)
{
    cache_destroy(making->answerer.cache);
    answer_release(&making->answerer);
}

/* ---- Frames ---- */

/* A box or a corner of its own for each body and form, on a grid, so that all verdicts come. */
static void set_body(int body, int form, struct query_frame *out)
{
    const double size = 0.5 * (1 + (body + form) % 3);
    out->shape = body % 2 ? FMB_CUBOID : FMB_TETRAHEDRON;
    out->components.count = 9;
    memset(out->components.number, 0, sizeof out->components.number);
    for (int i = 0; i < 3; i++)
        out->components.number[4 * i] = size;
    out->components.number[1] = 0.25 * form;
}

static struct query_frame draw_frame(struct making *making, int client)
{
    struct log_world *world = making->world;
    const int body = happens(world, 8) ? 0 : 1 + world_draw(world, BODIES);
    struct query_frame frame = {.body_id = body, .dim = 3, .origin.count = 3};
    for (int axis = 0; axis < 3; axis++)
        frame.origin.number[axis] = 0.5 * world_draw(world, 5);
    if (happens(world, 3)) {
        frame.velocity.count = 3;
        frame.velocity.number[world_draw(world, 3)] = 0.5 * (world_draw(world, 7) - 3);
    }
    set_body(body, making->form[body], &frame);
    if (making->key[client][body] != 0 && !happens(world, 6)) {
        frame.key = making->key[client][body];
        frame.components = (struct query_numbers){.count = 0};
    }
    if (happens(world, 40))
        frame.origin.number[0] = 1.0 / 0.0;
    return frame;
}

/* A client that has been told to forgets, but not always at once. */
static void take_key(struct making *making, int client, int64_t body, int32_t status, int64_t key)
{
    int64_t *known = &making->key[client][body];
    if (status == FMB_OK && key != 0 && body != 0)
        *known = key;
    else if (status == FMB_UNKNOWN_BODY && !happens(making->world, 3))
        *known = 0;
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
    case 1: return query + 12 * some(making); /* others ask meanwhile, by its keys too */
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

/* ---- Asking ---- */

static void ask_pair_once(struct making *making, const struct pair_query *query, int client)
{
    struct pair_result result;
    put_query(making, WIRE_PAIR_QUERY, wire_write_pair_query(query, bytes));
    if (happens(making->world, 30))
        answer_pair_refused(&making->answerer, query, FMB_BUSY, &result);
    else
        answer_pair(&making->answerer, query, &result);
    put_result(making, WIRE_PAIR_RESULT, wire_write_pair_result(&result, bytes));
    for (int f = 0; f < 2; f++)
        take_key(making, client, query->frame[f].body_id, result.status, result.key[f]);
}

static void ask_pair(struct making *making, int client)
{
    struct pair_query query = {.utime = (int64_t) (1e6 * making->now),
                               .client_id = 70 + client,
                               .sequence_number = making->sequence++,
                               .duration = 1,
                               .want = world_draw(making->world, 4)};
    for (int f = 0; f < 2; f++)
        query.frame[f] = draw_frame(making, client);
    ask_pair_once(making, &query, client);
    if (making->options->once || !happens(making->world, 10))
        return;
    making->now += some(making);
    ask_pair_once(making, &query, client);
}

static void draw_pairs(struct making *making)
{
    const int n = scene.frame_count;
    scene.split = scene.first_pair = scene.index_count = 0;
    scene.which = world_draw(making->world, 3);
    if (scene.which == QUERY_PAIRS_ACROSS)
        scene.split = 1 + world_draw(making->world, n - 1);
    else if (scene.which == QUERY_PAIRS_ALL)
        scene.first_pair = world_draw(making->world, 2);
    else
        for (; scene.index_count < 8; scene.index_count += 2) {
            const unsigned a = (unsigned) world_draw(making->world, n);
            unsigned *pair = scene.pair[scene.index_count / 2];
            pair[0] = a;
            pair[1] = (a + 1 + (unsigned) world_draw(making->world, n - 1)) % (unsigned) n;
        }
}

static void put_scene(struct making *making)
{
    put_query(making, WIRE_SCENE_QUERY, wire_write_scene_query(&scene, bytes));
    answer_scene(&making->answerer, &scene, &scene_result);
    put_result(making, WIRE_SCENE_RESULT, wire_write_scene_result(&scene_result, bytes));
}

static void ask_scene(struct making *making, int client)
{
    struct log_world *world = making->world;
    scene.utime = (int64_t) (1e6 * making->now);
    scene.client_id = 70 + client;
    scene.sequence_number = making->sequence++;
    scene.duration = 1;
    scene.method = 0;
    scene.want = world_draw(world, 2) * QUERY_WANT_BOX + world_draw(world, 2) * QUERY_WANT_TIMES;
    scene.frame_count = 2 + world_draw(world, FRAMES_MAX - 1);
    for (int i = 0; i < scene.frame_count; i++)
        scene.frame[i] = draw_frame(making, client);
    draw_pairs(making);
    put_scene(making);
    for (int i = 0; i < scene.frame_count; i++)
        take_key(making, client, scene.frame[i].body_id, scene_result.status,
                 scene_result.key_count > 0 ? scene_result.key[i] : 0);
}

static void put_other(struct making *making)
{
    static const char *const channel[] = {WIRE_STATUS, "CAMERA", WIRE_PAIR_QUERY,
                                          WIRE_SCENE_RESULT};
    put(making->world, making->now, channel[world_draw(making->world, 4)], "no message", 10);
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
    else if (happens(world, 3))
        ask_scene(making, client);
    else
        ask_pair(making, client);
}

void world_make(const struct world_options *options, struct log_world *out)
{
    struct making making = {.options = options, .world = out};
    *out = (struct log_world){.seed = options->seed, .state = options->seed};
    open_making(&making);
    for (int life = 0; life < LIVES; life++) {
        start(&making, life);
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
        scene.frame[i] =
            (struct query_frame){.body_id = 1 + first + i, .dim = 3, .origin.count = 3};
        set_body(1 + 2 * i, 0, &scene.frame[i]);
        scene.frame[i].origin.number[0] = 0.4 * (first + i);
    }
    scene.frame_count = count;
}

static void add_scene(struct making *making)
{
    scene.sequence_number = making->sequence++;
    world_add(making->world, WIRE_SCENE_QUERY, bytes, wire_write_scene_query(&scene, bytes));
    answer_scene(&making->answerer, &scene, &scene_result);
    world_add(making->world, WIRE_SCENE_RESULT, bytes,
              wire_write_scene_result(&scene_result, bytes));
    assert_int_equal(scene_result.status, FMB_OK);
}

enum { TOLD_AT_ONCE = 300 };

void world_make_large(int bodies, int scenes, struct log_world *out)
{
    const struct world_options options = {.same_keys = false};
    struct making making = {.options = &options, .world = out, .sequence = 1};
    int64_t *key = calloc((size_t) bodies, sizeof *key);
    *out = (struct log_world){.state = 1};
    assert_non_null(key);
    assert_true(answer_prepare(&making.answerer));
    making.answerer.cache = cache_create((size_t) bodies, 1000);
    scene.utime = scene.client_id = 9;
    scene.duration = 1;
    scene.method = scene.want = scene.split = scene.first_pair = scene.index_count = 0;
    scene.which = QUERY_PAIRS_ALL;
    for (int first = 0, count; first < bodies; first += count) {
        count = first == 0 && bodies % TOLD_AT_ONCE ? bodies % TOLD_AT_ONCE : TOLD_AT_ONCE;
        set_row(first, count);
        add_scene(&making);
        memcpy(key + first, scene_result.key, (size_t) count * sizeof *key);
    }
    for (int i = 0; i < scenes; i++) {
        set_row(0, bodies);
        for (int k = 0; k < bodies; k++) {
            scene.frame[k].key = key[k];
            scene.frame[k].components = (struct query_numbers){.count = 0};
        }
        add_scene(&making);
    }
    free(key);
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
    open_making(&making);
    for (int results = 0; results < 2; results++)
        for (int i = 0; i < pairs; i++) {
            query.sequence_number = i;
            for (int f = 0; f < 2; f++) {
                query.frame[f] = (struct query_frame){
                    .body_id = 1 + (i + f) % BODIES, .dim = 3, .origin.count = 3};
                query.frame[f].origin.number[0] = i % 3;
                set_body(1 + (i + f) % BODIES, 0, &query.frame[f]);
            }
            if (results == 0) {
                world_add(out, WIRE_PAIR_QUERY, bytes, wire_write_pair_query(&query, bytes));
                continue;
            }
            answer_pair(&making.answerer, &query, &result);
            world_add(out, WIRE_PAIR_RESULT, bytes, wire_write_pair_result(&result, bytes));
        }
    close_making(&making);
}
