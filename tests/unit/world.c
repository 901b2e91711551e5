#include "world.h"

#include "compare.h"
#include "learn.h"
#include "wire.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { CLIENT = 5, KNOWN = 10000, ASKED_MAX = 1000 };

struct world world;
union world_result world_result;

/* ---- Services ---- */

static union {
    struct pair_query pair;
    struct scene_query scene;
} query_read;

static bool cut(void *user)
{
    (void) user;
    return false;
}

static void open_service(struct world_service *service, size_t bodies, int64_t first_key)
{
    memset(service, 0, sizeof *service);
    service->bodies = bodies;
    service->answerer.server_id = first_key + 1;
    service->answerer.cache = cache_create(bodies, first_key);
    assert_non_null(service->answerer.cache);
    assert_true(answer_prepare(&service->answerer));
}

static void close_service(struct world_service *service)
{
    cache_destroy(service->answerer.cache);
    answer_release(&service->answerer);
}

void world_forget(struct world_service *service)
{
    static int64_t key = INT64_C(1) << 40;
    cache_destroy(service->answerer.cache);
    service->answerer.cache = cache_create(service->bodies, key += 100000);
}

static size_t serve_pair(struct world_service *service, const unsigned char *bytes, size_t size,
                         unsigned char *out)
{
    struct pair_result *result = &world_result.pair;
    assert_null(wire_read_pair_query(bytes, (uint32_t) size, &query_read.pair));
    if (size > QUERY_BYTES_MAX || service->busy > 0)
        answer_pair_refused(&service->answerer, &query_read.pair,
                            size > QUERY_BYTES_MAX ? FMB_OVER_LIMIT : FMB_BUSY, result);
    else
        answer_pair(&service->answerer, &query_read.pair, result);
    if (service->silent)
        result->key[0] = result->key[1] = 0;
    result->compute_ns = 1000;
    return wire_write_pair_result(result, out);
}

static size_t serve_scene(struct world_service *service, const unsigned char *bytes, size_t size,
                          unsigned char *out)
{
    struct scene_result *result = &world_result.scene;
    assert_null(wire_read_scene_query(bytes, (uint32_t) size, &query_read.scene));
    const struct query_header ids = {query_read.scene.utime, query_read.scene.client_id,
                                     query_read.scene.sequence_number};
    if (size > QUERY_BYTES_MAX || service->busy > 0)
        answer_scene_refused(&service->answerer, &ids,
                             size > QUERY_BYTES_MAX ? FMB_OVER_LIMIT : FMB_BUSY, result);
    else
        answer_scene(&service->answerer, &query_read.scene, result);
    if (service->silent)
        result->key_count = 0;
    result->compute_ns = 1000;
    result->lost = 3;
    return wire_write_scene_result(result, out);
}

int32_t world_status(enum log_kind kind)
{
    return kind == LOG_PAIR_QUERY ? world_result.pair.status : world_result.scene.status;
}

size_t world_serve(struct world_service *service, enum log_kind kind, const unsigned char *bytes,
                   size_t size, unsigned char *out)
{
    service->answerer.between = service->cuts ? cut : NULL;
    if (service->forgets)
        world_forget(service);
    const size_t result =
        (kind == LOG_PAIR_QUERY ? serve_pair : serve_scene)(service, bytes, size, out);
    service->busy -= service->busy > 0;
    return result;
}

/* ---- A log: what was asked, and what was said then ---- */

int world_open(void **state)
{
    (void) state;
    memset(&world, 0, sizeof world);
    open_service(&world.then, 1000, WORLD_THEN_FIRST_KEY);
    open_service(&world.live_service, 10000, WORLD_LIVE_FIRST_KEY);
    world.known_live = known_bodies_create(KNOWN);
    world.known_now = known_bodies_create(KNOWN);
    world.learner_live = learner_open(world.known_live);
    world.learner_now = learner_open(world.known_now);
    world.live = live_open(world.known_live, WORLD_CLIENT);
    world.now = answer_now_open(10000, world.known_now);
    return 0;
}

int world_close(void **state)
{
    (void) state;
    answer_now_close(world.now);
    live_close(world.live);
    learner_close(world.learner_live);
    learner_close(world.learner_now);
    known_bodies_destroy(world.known_live);
    known_bodies_destroy(world.known_now);
    close_service(&world.then);
    close_service(&world.live_service);
    return 0;
}

void world_use_service(size_t bodies)
{
    static int64_t key = WORLD_LIVE_FIRST_KEY;
    close_service(&world.live_service);
    open_service(&world.live_service, bodies, key += 100000);
}

static struct match_item item_of(enum log_kind kind, const struct query_header *ids, size_t size,
                                 const unsigned char *bytes)
{
    return (struct match_item){.kind = kind, .ids = *ids, .size = (uint32_t) size, .bytes = bytes};
}

void world_record_bytes(enum log_kind kind, const struct query_header *ids, size_t size)
{
    world.query = item_of(kind, ids, size, world.query_bytes);
    const size_t result =
        world_serve(&world.then, kind, world.query_bytes, size, world.result_bytes);
    world.result = item_of(kind, ids, result, world.result_bytes);
}

void world_record_pair(struct pair_query *pair)
{
    const struct query_header ids = {1000 + world.number, CLIENT, ++world.number};
    pair->utime = ids.utime;
    pair->client_id = ids.client_id;
    pair->sequence_number = ids.sequence_number;
    world_record_bytes(LOG_PAIR_QUERY, &ids, wire_write_pair_query(pair, world.query_bytes));
}

void world_record_scene(struct scene_query *scene)
{
    const struct query_header ids = {1000 + world.number, CLIENT, ++world.number};
    scene->utime = ids.utime;
    scene->client_id = ids.client_id;
    scene->sequence_number = ids.sequence_number;
    world_record_bytes(LOG_SCENE_QUERY, &ids, wire_write_scene_query(scene, world.query_bytes));
}

void world_learn(void)
{
    learn(world.learner_live, &world.query, &world.result);
    learn(world.learner_now, &world.query, &world.result);
}

/* ---- Asking ---- */

enum answer_now_outcome world_begin(void)
{
    const char *error;
    const enum answer_now_outcome outcome =
        live_begin(world.live, &world.query, &world.asked, &error);
    assert_true((outcome == ANSWER_NOW_UNREADABLE) == (error != NULL));
    world.asks = world.parts = 0;
    return outcome;
}

/* What is asked next goes to the service and back. */
enum live_taken world_ask_once(bool patient)
{
    static unsigned char bytes[LOG_DATA_MAX];
    struct live_query *asked = &world.asked;
    live_next(world.live, asked);
    assert_true(asked->size <= QUERY_BYTES_MAX || asked->size == world.query.size);
    assert_true(++world.asks < ASKED_MAX);
    const size_t size =
        world_serve(&world.live_service, asked->kind, asked->asked, asked->size, bytes);
    world.parts += !asked->teaches && world_status(asked->kind) == FMB_OK;
    return live_take(world.live, asked, bytes, (uint32_t) size, patient);
}

void world_ask(void)
{
    enum live_taken taken;
    do
        taken = world_ask_once(false);
    while (taken == LIVE_MORE);
    assert_int_equal(taken, LIVE_DONE);
}

void world_assert_as_now(void)
{
    struct answered_now now;
    answer_now(world.now, world.query.kind, world.query.bytes, world.query.size, &now);
    world_begin();
    world_ask();
    const struct answered_now *answered = &world.asked.answered;
    assert_int_equal(answered->status, now.status);
    assert_int_equal(answered->pairs, now.pairs);
    if (now.status == FMB_OK)
        assert_true(compare_bytes_same(world.query.kind, answered->bytes, answered->size, now.bytes,
                                       now.size));
    assert_int_equal(answered->compute_ns, now.status == FMB_OK ? 1000 * world.parts : 1000);
}

void world_assert_as_then(void)
{
    const int32_t status = world_status(world.query.kind);
    assert_int_equal(world_begin(), ANSWER_NOW_DONE);
    world_assert_as_now();
    if (status == FMB_OK)
        assert_true(compare_bytes_same(world.query.kind, world.result.bytes, world.result.size,
                                       world.asked.answered.bytes, world.asked.answered.size));
    world_learn();
}

/* ---- Queries ---- */

void world_throng_at(struct scene_query *scene, int frames, double distance)
{
    memset(scene, 0, sizeof *scene);
    scene->which = QUERY_PAIRS_ALL;
    scene->duration = 1;
    scene->frame_count = frames;
    for (int i = 0; i < frames; i++) {
        struct query_frame *frame = &scene->frame[i];
        *frame = (struct query_frame){.body_id = i + 1, .shape = FMB_CUBOID, .dim = 2};
        frame->origin = (struct query_numbers){2, {distance * (i % 40), distance * (i / 40)}};
        frame->components = (struct query_numbers){4, {1.5 + i % 2 * 0.25, 0, 0, 1.5}};
    }
}

void world_throng(struct scene_query *scene, int frames)
{
    world_throng_at(scene, frames, 1.5);
}

void world_tell_throng_at(struct scene_query *scene, int frames, double distance)
{
    static struct scene_query part;
    world_use_service(10000);
    close_service(&world.then);
    open_service(&world.then, 10000, WORLD_THEN_FIRST_KEY);
    world_throng_at(scene, frames, distance);
    for (int begin = 0; begin < frames; begin += 500) {
        part = *scene;
        part.which = QUERY_PAIRS_LISTED;
        part.frame_count = frames - begin < 500 ? frames - begin : 500;
        memcpy(part.frame, scene->frame + begin, (size_t) part.frame_count * sizeof *part.frame);
        world_record_scene(&part);
        for (int i = 0; i < part.frame_count; i++)
            scene->frame[begin + i].key = world_result.scene.key[i];
        world_learn();
    }
    for (int i = 0; i < frames; i++)
        scene->frame[i].components.count = 0;
}

void world_tell_throng(struct scene_query *scene, int frames)
{
    world_tell_throng_at(scene, frames, 1.5);
}
struct pair_query world_pair(void)
{
    struct pair_query pair = {.duration = 1, .want = QUERY_WANT_BOX};
    for (int f = 0; f < 2; f++) {
        pair.frame[f] = (struct query_frame){.body_id = 10 + f, .shape = FMB_CUBOID, .dim = 2};
        pair.frame[f].origin = (struct query_numbers){2, {0.5 * f, 0}};
        pair.frame[f].components = (struct query_numbers){4, {1, 0, 0, 1}};
    }
    return pair;
}

struct pair_query world_keyed_pair(void)
{
    struct pair_query pair = world_pair();
    world_record_pair(&pair);
    world_learn();
    for (int f = 0; f < 2; f++) {
        pair.frame[f].key = world_result.pair.key[f];
        pair.frame[f].components.count = 0;
        assert_true(pair.frame[f].key >= WORLD_THEN_FIRST_KEY);
    }
    return pair;
}
