/* Queries of a log asked of a live service, without a bus: whatever the service holds or forgets,
 * the result is the one that answer_now() gives, to the bit. */
#include "compare.h"
#include "wire.h"
#include "world.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { IDS = 60 };

/* ---- Bodies and queries that are drawn ---- */

static uint32_t drawn;

static int draw(int below)
{
    drawn = drawn * 1664525u + 1013904223u;
    return (int) ((drawn >> 8) % (uint32_t) below);
}

/* A client's bodies, and the keys that it was told for them. */
static struct {
    struct query_frame frame;
    int64_t key;
} bodies[IDS];

/* On a coarse grid, so that all verdicts occur. */
static struct query_numbers draw_numbers(int count)
{
    struct query_numbers numbers = {.count = count};
    for (int i = 0; i < count; i++)
        numbers.number[i] = 0.5 * (draw(7) - 3);
    return numbers;
}

static struct query_frame draw_body(int64_t id, int dim)
{
    struct query_frame frame = {.body_id = id, .shape = 1 + draw(dim), .dim = dim};
    frame.components = draw_numbers(frame.shape == FMB_FACE ? 2 * dim : dim * dim);
    return frame;
}

static void draw_bodies(int dim)
{
    for (int i = 0; i < IDS; i++) {
        bodies[i].frame = draw_body(i + 1, dim);
        bodies[i].key = 0;
    }
}

/* Somewhere, moving or not, by key if there is one: mostly. */
static struct query_frame draw_frame(int body, bool moves)
{
    struct query_frame frame = bodies[body].frame;
    frame.origin = draw_numbers(frame.dim);
    if (moves && draw(2))
        frame.velocity = draw_numbers(frame.dim);
    if (draw(20) == 0)
        frame.body_id = 0;
    else if (bodies[body].key && draw(5))
        frame.components.count = 0;
    frame.key = frame.components.count == 0 ? bodies[body].key : 0;
    return frame;
}

/* Sometimes the client gives a body other components under the same id. */
static void draw_change(int dim)
{
    const int body = draw(IDS);
    if (draw(4))
        return;
    bodies[body].frame = draw_body(body + 1, dim);
    bodies[body].key = 0;
}

static void note_key(const struct query_frame *frame, int64_t key)
{
    if (frame->body_id && key)
        bodies[frame->body_id - 1].key = key;
}

static void draw_pair(void)
{
    struct pair_query pair = {.duration = 1, .want = draw(4), .method = 0};
    const int first = draw(IDS);
    pair.frame[0] = draw_frame(first, true);
    pair.frame[1] = draw_frame((first + 1 + draw(IDS - 1)) % IDS, true);
    world_record_pair(&pair);
    for (int f = 0; f < 2; f++)
        note_key(&pair.frame[f], world_result.pair.key[f]);
}

static void draw_scene(int frames)
{
    static struct scene_query scene;
    scene = (struct scene_query){.duration = 1,
                                 .want = draw(2) * QUERY_WANT_BOX + draw(2) * QUERY_WANT_TIMES,
                                 .which = draw(3),
                                 .frame_count = frames};
    const bool moves = draw(2);
    const int first = draw(IDS);
    for (int i = 0; i < frames; i++)
        scene.frame[i] = draw_frame((first + i) % IDS, moves);
    scene.split = scene.which == QUERY_PAIRS_ACROSS ? draw(frames + 1) : 0;
    scene.index_count = scene.which == QUERY_PAIRS_LISTED ? 2 * draw(500) : 0;
    for (int i = 0; i < scene.index_count / 2; i++) {
        scene.pair[i][0] = (unsigned) draw(frames);
        scene.pair[i][1] = (scene.pair[i][0] + 1 + (unsigned) draw(frames - 1)) % (unsigned) frames;
    }
    world_record_scene(&scene);
    for (int i = 0; i < frames && i < world_result.scene.key_count; i++)
        note_key(&scene.frame[i], world_result.scene.key[i]);
}

/* Queries of a client with keys, bodies that change, and the service that was drawn. */
static void ask_drawn(int queries, uint32_t seed)
{
    drawn = seed;
    const int dim = 2 + draw(2);
    draw_bodies(dim);
    for (int i = 0; i < queries; i++) {
        draw_change(dim);
        if (draw(2))
            draw_pair();
        else
            draw_scene(2 + draw(IDS - 2));
        world_assert_as_then();
    }
}
/* ---- Tests ---- */

static void test_as_now_whatever_the_service_holds(void **state)
{
    static const size_t capacity[] = {1, 2, 3, 10, 50, 10000};
    (void) state;
    for (uint32_t i = 0; i < 6; i++) {
        world_use_service(capacity[i]);
        ask_drawn(200, 17 + i);
    }
}

static void test_as_now_where_scenes_are_cut_short(void **state)
{
    static const size_t capacity[] = {1, 10, 10000};
    (void) state;
    for (uint32_t i = 0; i < 3; i++) {
        world_use_service(capacity[i]);
        world.live_service.cuts = true;
        ask_drawn(100, 170 + i);
    }
}

static void test_as_now_where_the_service_is_another_each_time(void **state)
{
    (void) state;
    world.live_service.forgets = true;
    ask_drawn(100, 1);
}
static void test_a_scene_that_is_too_long_whole_is_taught(void **state)
{
    enum { FRAMES = 1350 };
    static struct scene_query scene;
    (void) state;
    world_tell_throng(&scene, FRAMES);
    world_record_scene(&scene);
    assert_true(world.query.size > 64000);
    assert_int_equal(world_result.scene.status, FMB_OK);
    assert_true(world_result.scene.verdict_count > FRAMES);
    world_assert_as_then();
    assert_int_equal(world.asked.lessons, 2);
    assert_int_equal(world.asks, 3);

    world_record_scene(&scene);
    world_assert_as_then();
    assert_int_equal(world.asks, 1);
    assert_int_equal(world.asked.lessons, 0);

    /* Another service: it holds none of them. */
    world_use_service(FRAMES);
    world_record_scene(&scene);
    world_assert_as_then();
    assert_int_equal(world.asked.deaths, 1);
    assert_int_equal(world.asked.lessons, 2);

    /* Bodies of which there are several frames, each in one lesson. */
    for (int i = FRAMES / 2; i < FRAMES; i++) {
        scene.frame[i].body_id = scene.frame[i - FRAMES / 2].body_id;
        scene.frame[i].key = scene.frame[i - FRAMES / 2].key;
    }
    world_use_service(FRAMES);
    world_record_scene(&scene);
    world_assert_as_then();
}

static void test_a_service_that_cannot_hold_the_scene_does_not_know_it(void **state)
{
    enum { FRAMES = 1350 };
    static struct scene_query scene;
    (void) state;
    world_tell_throng(&scene, FRAMES);
    /* There is room for the components of some. */
    world_use_service(FRAMES - 1);
    world_record_scene(&scene);
    world_assert_as_then();
    world_use_service(FRAMES - 100);
    world_record_scene(&scene);
    assert_int_equal(world_begin(), ANSWER_NOW_DONE);
    world_ask();
    assert_int_equal(world.asked.answered.status, FMB_UNKNOWN_BODY);
    assert_true(world.asked.deaths > 1);
    assert_true(world.asks < 64);
    /* Nor one that tells no keys, or always forgets. */
    for (int i = 0; i < 2; i++) {
        world_use_service(10000);
        world.live_service.silent = i == 0;
        world.live_service.forgets = i == 1;
        assert_int_equal(world_begin(), ANSWER_NOW_DONE);
        world_ask();
        assert_int_equal(world.asked.answered.status, FMB_UNKNOWN_BODY);
        assert_true(world.asks < 100);
    }
}
static void read_asked(struct pair_query *out)
{
    assert_null(wire_read_pair_query(world.asked.asked, (uint32_t) world.asked.size, out));
}
static void test_bytes_go_as_recorded_under_ids_of_its_own(void **state)
{
    struct pair_query pair = world_pair();
    (void) state;
    world_record_pair(&pair);
    for (int i = 1; i <= 2; i++) {
        struct query_header ids;
        assert_int_equal(world_begin(), ANSWER_NOW_DONE);
        live_next(world.live, &world.asked);
        assert_int_equal(world.asked.size, world.query.size);
        assert_memory_equal(world.asked.asked, world.query.bytes, 16);
        assert_memory_equal(world.asked.asked + 32, world.query.bytes + 32, world.query.size - 32);
        assert_null(wire_read_pair_header(world.asked.asked, (uint32_t) world.asked.size, &ids));
        assert_int_equal(ids.utime, world.query.ids.utime);
        assert_int_equal(ids.client_id, WORLD_CLIENT);
        assert_int_equal(ids.sequence_number, i);
        assert_memory_equal(&ids, &world.asked.ids, sizeof ids);
    }
}

static void test_ids_that_are_refused_stay(void **state)
{
    static const int64_t bad[][2] = {
        {-1, 4}, {5, -2}, {INT64_MIN, INT64_MAX}, {QUERY_ID_MAX + 1, 7}, {8, QUERY_ID_MAX + 1}};
    (void) state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct pair_query pair = world_pair();
        const struct query_header ids = {3, bad[i][0], bad[i][1]};
        pair.utime = 3;
        pair.client_id = ids.client_id;
        pair.sequence_number = ids.sequence_number;
        world_record_bytes(LOG_PAIR_QUERY, &ids, wire_write_pair_query(&pair, world.query_bytes));
        world_assert_as_now();
        assert_int_equal(world.asked.answered.status, FMB_BAD_ID);
        read_asked(&pair);
        assert_int_equal(pair.client_id, ids.client_id);
        assert_int_equal(pair.sequence_number, ids.sequence_number);
        assert_int_equal(pair.utime, i);
        assert_null(wire_read_pair_result(
            world.asked.answered.bytes, (uint32_t) world.asked.answered.size, &world_result.pair));
        assert_int_equal(world_result.pair.utime, 3);
    }
}

static void test_keys_of_the_service_once_it_has_told_them(void **state)
{
    struct pair_query pair = world_keyed_pair(), asked;
    (void) state;
    world_record_pair(&pair);
    world_assert_as_then();
    read_asked(&asked);
    for (int f = 0; f < 2; f++)
        assert_int_equal(asked.frame[f].components.count, 4);

    world_record_pair(&pair);
    world_assert_as_then();
    read_asked(&asked);
    for (int f = 0; f < 2; f++) {
        assert_int_equal(asked.frame[f].components.count, 0);
        assert_true(asked.frame[f].key >= WORLD_LIVE_FIRST_KEY);
    }
    assert_int_equal(world.asks, 1);

    world_forget(&world.live_service);
    world_record_pair(&pair);
    world_assert_as_then();
    assert_int_equal(world.asked.deaths, 1);
    assert_int_equal(world.asks, 2);
}

/* Also the second time, and whatever they are: no key says what they could be left out for. */
static void test_components_beside_a_key_go_as_they_are(void **state)
{
    struct pair_query pair = world_pair(), asked;
    (void) state;
    pair.frame[0].key = 4711;
    pair.frame[1].key = 4712;
    for (int i = 0; i < 3; i++) {
        pair.frame[0].components.number[0] = i < 2 ? 1 : 3;
        world_record_pair(&pair);
        world_assert_as_now();
        read_asked(&asked);
        for (int f = 0; f < 2; f++)
            assert_int_equal(asked.frame[f].components.count, 4);
        assert_true(asked.frame[0].components.number[0] == pair.frame[0].components.number[0]);
    }
}

static void test_a_key_that_nobody_knows_goes_as_it_is(void **state)
{
    struct pair_query pair = world_pair(), asked;
    (void) state;
    world_record_pair(&pair);
    pair.frame[0].key = world_result.pair.key[0];
    pair.frame[0].components.count = 0;
    world_record_pair(&pair);
    assert_int_equal(world_begin(), ANSWER_NOW_WITHOUT_BODY);
    world_ask();
    assert_int_equal(world.asked.answered.status, FMB_UNKNOWN_BODY);
    read_asked(&asked);
    assert_int_equal(asked.frame[0].key, pair.frame[0].key);
    assert_int_equal(world.asks, 1);
    /* The service that told it holds it. */
    assert_int_equal(world_begin(), ANSWER_NOW_WITHOUT_BODY);
    live_next(world.live, &world.asked);
    static unsigned char bytes[LOG_DATA_MAX];
    const size_t size =
        world_serve(&world.then, LOG_PAIR_QUERY, world.asked.asked, world.asked.size, bytes);
    assert_int_equal(live_take(world.live, &world.asked, bytes, (uint32_t) size, true), LIVE_DONE);
    assert_int_equal(world.asked.answered.status, FMB_OK);
}

static void test_a_key_for_another_shape_names_nothing(void **state)
{
    struct pair_query pair = world_keyed_pair();
    (void) state;
    pair.frame[0].shape = FMB_TETRAHEDRON;
    world_record_pair(&pair);
    assert_int_equal(world_result.pair.status, FMB_UNKNOWN_BODY);
    world_assert_as_now();
    assert_int_equal(world.asked.answered.status, FMB_UNKNOWN_BODY);
}

/* What is refused for something else than keys stays as it is. */
static void test_a_query_that_is_wrong_stays_wrong(void **state)
{
    (void) state;
    for (int i = 0; i < 5; i++) {
        struct pair_query pair = world_keyed_pair();
        switch (i) {
        case 0: pair.frame[1].origin.number[0] = NAN; break;
        case 1: pair.frame[1].shape = 9; break;
        case 2: pair.frame[1].body_id = -1; break;
        case 3: pair.duration = -1; break;
        case 4: pair.method = 99; break;
        }
        world_record_pair(&pair);
        assert_int_not_equal(world_result.pair.status, FMB_OK);
        const int32_t status = world_result.pair.status;
        world_assert_as_now();
        assert_int_equal(world.asked.answered.status, status);
        assert_int_equal(world.asks, 1);
    }
}

/* A frame with a list of zeros that makes the query as long as it is to be. */
static void record_long(struct pair_query pair, size_t size)
{
    const struct query_header ids = {1, 2, 3};
    const size_t begin = wire_write_pair_query(&pair, world.query_bytes);
    unsigned char *count = world.query_bytes + begin - 4; /* of the last list, which is empty */
    const uint32_t numbers = (uint32_t) ((size - begin) / 8);
    memset(world.query_bytes + begin, 0, sizeof world.query_bytes - begin);
    for (int i = 0; i < 4; i++)
        count[i] = (unsigned char) (numbers >> (24 - 8 * i));
    pair.client_id = 2;
    world.query_bytes[23] = 2;
    world.query_bytes[31] = 3;
    world.query_bytes[15] = 1;
    world_record_bytes(LOG_PAIR_QUERY, &ids, begin + 8 * numbers);
}

static void test_a_query_that_is_too_long_is_refused(void **state)
{
    (void) state;
    record_long(world_pair(), QUERY_BYTES_MAX + 100);
    world_assert_as_now();
    assert_int_equal(world.asked.answered.status, FMB_OVER_LIMIT);
    assert_true(world.asked.size > QUERY_BYTES_MAX);
    /* Also where it is not heard. */
    record_long(world_pair(), LOG_DATA_MAX);
    world_begin();
    live_next(world.live, &world.asked);
    live_refuse(world.live, &world.asked);
    struct answered_now now;
    answer_now(world.now, LOG_PAIR_QUERY, world.query.bytes, world.query.size, &now);
    assert_int_equal(world.asked.answered.status, FMB_OVER_LIMIT);
    assert_true(compare_bytes_same(LOG_PAIR_QUERY, now.bytes, now.size, world.asked.answered.bytes,
                                   world.asked.answered.size));
}

/* Nobody has room for these numbers: they cannot be written again. */
static void test_a_list_that_is_too_long_stays_as_it_is(void **state)
{
    (void) state;
    record_long(world_keyed_pair(), 5000);
    world_assert_as_now();
    assert_int_equal(world.asked.answered.status, FMB_WRONG_COUNT);
    assert_int_equal(world.asked.size, world.query.size);
}

/* Two queries under way, each of which finds a key that the other was told, and that has died by
 * then: in the end they go whole. */
static void test_keys_that_die_again_and_again_are_not_trusted(void **state)
{
    static struct live_query other;
    static unsigned char bytes[LOG_DATA_MAX];
    struct pair_query pair = world_keyed_pair();
    const char *error;
    (void) state;
    world_record_pair(&pair);
    world_assert_as_then();
    world_record_pair(&pair);
    assert_int_equal(world_begin(), ANSWER_NOW_DONE);
    world.live_service.forgets = true;
    enum live_taken taken;
    while ((taken = world_ask_once(true)) == LIVE_MORE) {
        assert_int_equal(live_begin(world.live, &world.query, &other, &error), ANSWER_NOW_DONE);
        live_next(world.live, &other);
        const size_t size =
            world_serve(&world.live_service, LOG_PAIR_QUERY, other.asked, other.size, bytes);
        assert_int_equal(live_take(world.live, &other, bytes, (uint32_t) size, true), LIVE_DONE);
    }
    assert_int_equal(taken, LIVE_DONE);
    assert_int_equal(world.asked.answered.status, FMB_OK);
    assert_int_equal(world.asked.deaths, 2);
}

static void test_a_busy_service_is_asked_again_or_believed(void **state)
{
    struct pair_query pair = world_keyed_pair();
    (void) state;
    world_record_pair(&pair);
    world_begin();
    world.live_service.busy = 2;
    assert_int_equal(world_ask_once(true), LIVE_BUSY);
    assert_int_equal(world_ask_once(false), LIVE_DONE);
    assert_int_equal(world.asked.answered.status, FMB_BUSY);
    /* A lesson that meets with it is no answer. */
    static struct scene_query scene;
    world_tell_throng(&scene, 1350);
    world_record_scene(&scene);
    world_begin();
    world.live_service.busy = 10;
    assert_int_equal(world_ask_once(true), LIVE_BUSY);
    assert_int_equal(world_ask_once(false), LIVE_MORE);
    assert_int_equal(world_ask_once(false), LIVE_DONE);
    assert_int_equal(world.asked.answered.status, FMB_BUSY);
}
int main(void)
{
#define TEST(test) cmocka_unit_test_setup_teardown(test, world_open, world_close)
    const struct CMUnitTest tests[] = {
        TEST(test_as_now_whatever_the_service_holds),
        TEST(test_as_now_where_scenes_are_cut_short),
        TEST(test_as_now_where_the_service_is_another_each_time),
        TEST(test_a_scene_that_is_too_long_whole_is_taught),
        TEST(test_a_service_that_cannot_hold_the_scene_does_not_know_it),
        TEST(test_bytes_go_as_recorded_under_ids_of_its_own),
        TEST(test_ids_that_are_refused_stay),
        TEST(test_keys_of_the_service_once_it_has_told_them),
        TEST(test_components_beside_a_key_go_as_they_are),
        TEST(test_a_key_that_nobody_knows_goes_as_it_is),
        TEST(test_a_key_for_another_shape_names_nothing),
        TEST(test_a_query_that_is_wrong_stays_wrong),
        TEST(test_a_query_that_is_too_long_is_refused),
        TEST(test_a_list_that_is_too_long_stays_as_it_is),
        TEST(test_keys_that_die_again_and_again_are_not_trusted),
        TEST(test_a_busy_service_is_asked_again_or_believed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
