/* What a live service says to a query of a log: parts that have to be joined, and lies. */
#include "wire.h"
#include "world.h"

#include "fmb_msgs_scene_result_t.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* More contacts than a result has room for, in more parts than a query is asked without an answer;
 * by key, whole, and by key where it goes whole. */
static void test_parts_make_the_result_that_one_would_be(void **state)
{
    static const int wants[] = {0, QUERY_WANT_BOX, QUERY_WANT_TIMES,
                                QUERY_WANT_BOX | QUERY_WANT_TIMES};
    static struct scene_query scene;
    (void) state;
    for (int i = 0; i < 4 * 3; i++) {
        const bool whole = i % 3 == 0;
        world_tell_throng_at(&scene, 700, 0.3);
        if (whole)
            world_throng_at(&scene, 700, 0.3);
        if (i % 3 == 1)
            world_use_service(1);
        scene.frame[1].velocity = (struct query_numbers){2, {0.25, 0}};
        scene.want = wants[i / 3];
        world_record_scene(&scene);
        const int32_t end = world_result.scene.end_pair;
        assert_true(end < 700 * 699 / 2);
        world.live_service.cuts = true;
        world_assert_as_then();
        assert_true(world.parts > 10);
        if (i / 3 == 0)
            assert_true(world.parts > 64);
        assert_int_equal(world.asked.answered.pairs, end);
    }
}

/* The first parts have no contacts, and so do not tell what contacts would have. */
static void test_parts_without_contacts(void **state)
{
    static struct scene_query scene;
    (void) state;
    world_throng(&scene, 300);
    scene.which = QUERY_PAIRS_LISTED;
    scene.want = QUERY_WANT_BOX | QUERY_WANT_TIMES;
    scene.frame[250].velocity = (struct query_numbers){2, {0.25, 0}};
    for (int i = 0; i < 500; i++) {
        scene.pair[i][0] = (unsigned) (i % 250);
        scene.pair[i][1] = (unsigned) (i % 250 + (i < 300 ? 2 : 1));
    }
    scene.index_count = 1000;
    world_record_scene(&scene);
    world.live_service.cuts = true;
    world_assert_as_then();
    assert_true(world.parts > 4);
    assert_true(world_result.scene.has_boxes && world_result.scene.has_times);
}
static struct scene_result lie;

static void no_lie(void)
{
}

static void lie_status(void)
{
    lie.status = -1;
    lie.verdict_count = lie.contact_count = 0;
    lie.names_pairs = lie.has_boxes = false;
}

static void lie_keys(void)
{
    lie.key_count--;
}

static void lie_end_beyond(void)
{
    lie.end_pair = 1000;
}

static void lie_end_before(void)
{
    lie.end_pair = 0;
}

static void lie_of_pairs(void)
{
    lie.names_pairs = !lie.names_pairs;
    for (int32_t i = 0; i < lie.verdict_count; i++) {
        lie.pair[i][0] = (unsigned) i;
        lie.pair[i][1] = (unsigned) i + 1;
        lie.verdict[i] = FMB_TOUCHING;
    }
    lie.contact_count = lie.names_pairs ? lie.verdict_count : lie.contact_count;
}

static void lie_of_fewer(void)
{
    const int32_t last = --lie.verdict_count;
    lie.contact_count -= lie.verdict[last] != FMB_SEPARATED;
}

/* Of more bytes than a result may have, though all that it says could be. */
static uint32_t write_long_result(unsigned char *out, size_t room)
{
    enum { CONTACTS = 4000 };
    static double times[2 * CONTACTS];
    static uint8_t verdicts[CONTACTS];
    static char nothing[1];
    memset(verdicts, FMB_TOUCHING, sizeof verdicts);
    const fmb_msgs_scene_result_t message = {.utime = world.asked.ids.utime,
                                             .client_id = world.asked.ids.client_id,
                                             .sequence_number = world.asked.ids.sequence_number,
                                             .detail = nothing,
                                             .end_pair = CONTACTS,
                                             .num_verdicts = CONTACTS,
                                             .verdicts = verdicts,
                                             .num_times = 2 * CONTACTS,
                                             .times = times};
    const int size = fmb_msgs_scene_result_t_encode(out, 0, (int) room, &message);
    assert_true(size > QUERY_BYTES_MAX);
    assert_null(wire_read_scene_result(out, (uint32_t) size, &lie));
    return (uint32_t) size;
}

static void assert_not_taken(struct scene_query *scene, void (*change)(void), bool good)
{
    static unsigned char bytes[LOG_DATA_MAX];
    world_record_scene(scene);
    world_begin();
    live_next(world.live, &world.asked);
    world_serve(&world.live_service, LOG_SCENE_QUERY, world.asked.asked, world.asked.size, bytes);
    lie = world_result.scene;
    change();
    const uint32_t size = (uint32_t) wire_write_scene_result(&lie, bytes);
    const enum live_taken taken = live_take(world.live, &world.asked, bytes, size, true);
    assert_int_equal(taken, good ? LIVE_DONE : LIVE_NONSENSE);
}

static void test_nonsense_is_not_taken(void **state)
{
    static void (*const lies[])(void) = {lie_status,     lie_keys,     lie_end_beyond,
                                         lie_end_before, lie_of_pairs, lie_of_fewer};
    static unsigned char bytes[2 * QUERY_BYTES_MAX];
    static struct scene_query scene;
    (void) state;
    for (int listed = 0; listed < 2; listed++) {
        world_throng_at(&scene, 12, 0.3);
        scene.want = QUERY_WANT_BOX;
        scene.which = listed ? QUERY_PAIRS_LISTED : QUERY_PAIRS_ALL;
        scene.index_count = listed ? 20 : 0;
        for (unsigned i = 0; i < 10; i++) {
            scene.pair[i][0] = i;
            scene.pair[i][1] = i + 1;
        }
        for (size_t i = 0; i < sizeof lies / sizeof *lies; i++)
            if (listed || lies[i] != lie_of_fewer) /* those not named are separated */
                assert_not_taken(&scene, lies[i], false);
        assert_not_taken(&scene, no_lie, true);
    }
    world_begin();
    live_next(world.live, &world.asked);
    assert_int_equal(live_take(world.live, &world.asked, bytes, 40, true), LIVE_NONSENSE);
    /* As many pairs as it has answers. */
    scene.index_count = 8000;
    for (unsigned i = 10; i < 4000; i++) {
        scene.pair[i][0] = 0;
        scene.pair[i][1] = 1;
    }
    world_record_scene(&scene);
    world_begin();
    live_next(world.live, &world.asked);
    const uint32_t size = write_long_result(bytes, sizeof bytes);
    assert_int_equal(live_take(world.live, &world.asked, bytes, size, true), LIVE_NONSENSE);
}

/* Parts that do not go with those before them. */
static void lie_without_boxes(void)
{
    lie.has_boxes = false;
}

static void lie_without_times(void)
{
    lie.has_times = false;
}

static void assert_not_joined(struct scene_query *scene, void (*change)(void), bool good)
{
    static unsigned char bytes[LOG_DATA_MAX];
    world_record_scene(scene);
    world_begin();
    assert_int_equal(world_ask_once(true), LIVE_MORE);
    live_next(world.live, &world.asked);
    world_serve(&world.live_service, LOG_SCENE_QUERY, world.asked.asked, world.asked.size, bytes);
    lie = world_result.scene;
    assert_true(lie.contact_count > 1);
    change();
    const uint32_t size = (uint32_t) wire_write_scene_result(&lie, bytes);
    const enum live_taken taken = live_take(world.live, &world.asked, bytes, size, true);
    assert_true((taken == LIVE_NONSENSE) == !good);
}

static void test_parts_that_do_not_go_together_are_not_joined(void **state)
{
    static struct scene_query scene;
    (void) state;
    world.live_service.cuts = true;
    world_throng_at(&scene, 100, 0.3);
    scene.frame[1].velocity = (struct query_numbers){2, {0.25, 0}};
    scene.want = QUERY_WANT_BOX | QUERY_WANT_TIMES;
    assert_not_joined(&scene, lie_without_boxes, false);
    assert_not_joined(&scene, lie_without_times, false);
    assert_not_joined(&scene, lie_of_pairs, false);
    assert_not_joined(&scene, lie_end_before, false);
    assert_not_joined(&scene, no_lie, true);
    scene.which = QUERY_PAIRS_LISTED;
    scene.index_count = 1000;
    for (int i = 0; i < 500; i++) {
        scene.pair[i][0] = (unsigned) (i % 90);
        scene.pair[i][1] = (unsigned) (i % 90 + 1 + i / 90);
    }
    assert_not_joined(&scene, lie_of_fewer, false);
    assert_not_joined(&scene, lie_of_pairs, false);
    assert_not_joined(&scene, no_lie, true);
}

/* A query of which no answer can be OK: whoever says so is not believed. */
static void test_numbers_of_pairs_that_are_not_there(void **state)
{
    static unsigned char bytes[LOG_DATA_MAX];
    static struct scene_query scene;
    (void) state;
    for (int i = 0; i < 5; i++) {
        world_throng(&scene, 4);
        switch (i) {
        case 0: scene.first_pair = -3; break;
        case 1: scene.first_pair = 7; break;
        case 2: scene.which = 3; break;
        case 3: scene.split = 1; break;
        case 4:
            scene.which = QUERY_PAIRS_ACROSS;
            scene.split = INT32_MIN;
            break;
        }
        world_record_scene(&scene);
        world_assert_as_now();
        assert_int_not_equal(world.asked.answered.status, FMB_OK);
        world_begin();
        live_next(world.live, &world.asked);
        lie = (struct scene_result){.method = 4, .end_pair = 0};
        const uint32_t size = (uint32_t) wire_write_scene_result(&lie, bytes);
        assert_int_equal(live_take(world.live, &world.asked, bytes, size, true), LIVE_NONSENSE);
    }
}
int main(void)
{
#define TEST(test) cmocka_unit_test_setup_teardown(test, world_open, world_close)
    const struct CMUnitTest tests[] = {
        TEST(test_parts_make_the_result_that_one_would_be),
        TEST(test_parts_without_contacts),
        TEST(test_nonsense_is_not_taken),
        TEST(test_parts_that_do_not_go_together_are_not_joined),
        TEST(test_numbers_of_pairs_that_are_not_there),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
