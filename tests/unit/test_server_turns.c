/* Who is answered when: the queues of the service and its scenes, through memq://, in one thread.
 */
#include "server.h"
#include "wire.h"

#include "fmb_msgs_pair_query_t.h"
#include "fmb_msgs_scene_query_t.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { HEARD_MAX = 40000, LCM_QUEUE = 1 << 20 };

struct heard {
    bool scene;
    int64_t client_id, sequence_number, lost;
    int32_t status, end_pair, found;
};

/* A bus with a service on it, and all results that it sent, in their order. */
static struct {
    lcm_t *lcm;
    struct server *server;
    int count;
    struct heard heard[HEARD_MAX];
    struct wire_status status;
} bus;

static struct heard *next_heard(void)
{
    assert_true(bus.count < HEARD_MAX);
    return &bus.heard[bus.count++];
}

static void on_pair(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    static struct pair_result result;
    (void) channel;
    (void) user;
    assert_null(wire_read_pair_result(buffer->data, buffer->data_size, &result));
    *next_heard() = (struct heard){.client_id = result.client_id,
                                   .sequence_number = result.sequence_number,
                                   .status = result.status};
}

static void on_scene(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    static struct scene_result result;
    (void) channel;
    (void) user;
    assert_null(wire_read_scene_result(buffer->data, buffer->data_size, &result));
    *next_heard() =
        (struct heard){true,          result.client_id, result.sequence_number, result.lost,
                       result.status, result.end_pair,  result.contact_count};
}

static void on_status(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    (void) channel;
    (void) user;
    assert_null(wire_read_status(buffer->data, buffer->data_size, &bus.status));
}

static void listen_to(const char *channel, lcm_msg_handler_t handler)
{
    lcm_subscription_t *subscription = lcm_subscribe(bus.lcm, channel, handler, NULL);
    lcm_subscription_set_queue_capacity(subscription, LCM_QUEUE);
}

static int set_up(void **state)
{
    (void) state;
    memset(&bus, 0, sizeof bus);
    bus.lcm = lcm_create("memq://");
    const struct server_options options = {
        .prefix = "", .bodies = 100, .server_id = 11, .first_key = 1000, .seed = 7};
    bus.server = server_create(bus.lcm, &options);
    listen_to(WIRE_PAIR_RESULT, on_pair);
    listen_to(WIRE_SCENE_RESULT, on_scene);
    listen_to(WIRE_STATUS, on_status);
    return bus.server ? 0 : -1;
}

static int tear_down(void **state)
{
    (void) state;
    server_destroy(bus.server);
    lcm_destroy(bus.lcm);
    return 0;
}

/* Everybody takes what is on the bus; nothing is answered. */
static void drain(void)
{
    while (lcm_handle_timeout(bus.lcm, 0) > 0)
        continue;
}

static void settle(void)
{
    do
        drain();
    while (server_answer(bus.server));
    drain();
}

static const struct wire_status *status_now(void)
{
    server_publish_status(bus.server);
    drain();
    return &bus.status;
}

/* ---- Queries ---- */

static void set_frame(double x, struct query_frame *out)
{
    *out = (struct query_frame){.shape = FMB_CUBOID, .dim = 2};
    out->origin = (struct query_numbers){.count = 2, .number = {x, 0}};
    out->components = (struct query_numbers){.count = 4, .number = {1, 0, 0, 1}};
}

static void ask_pair(int64_t client, int64_t number)
{
    struct pair_query query = {.client_id = client, .sequence_number = number};
    unsigned char bytes[WIRE_BYTES_MAX];
    for (int f = 0; f < 2; f++)
        set_frame(f, &query.frame[f]);
    const size_t size = wire_write_pair_query(&query, bytes);
    lcm_publish(bus.lcm, WIRE_PAIR_QUERY, bytes, (unsigned) size);
}

/* Its exponents go from one end of the doubles to the other: it takes milliseconds. */
static void ask_costly_pair(int64_t client, int64_t number)
{
    static const double numbers[2][12] = {
        {7, 0, -7e-310, -0.1, -1e300, 0, 0x1p-1074, -1e300, 0, -3e-300, 3e-300, 3e-160},
        {0.1, 0, 0, -0.1, 7, -1e150, 1e300, -3e-160, 3e-300, -0x1p-1074, 7, 0.1},
    };
    struct pair_query query = {.client_id = client, .sequence_number = number, .duration = 1};
    unsigned char bytes[WIRE_BYTES_MAX];
    query.method = fmb_method_by_name("exact")->number;
    query.want = QUERY_WANT_BOX | QUERY_WANT_CERTIFICATE;
    for (int f = 0; f < 2; f++) {
        struct query_frame *frame = &query.frame[f];
        *frame = (struct query_frame){.shape = FMB_FACE, .dim = 3};
        frame->origin.count = frame->velocity.count = 3;
        frame->components.count = 6;
        memcpy(frame->origin.number, numbers[f], 3 * sizeof(double));
        memcpy(frame->velocity.number, numbers[f] + 3, 3 * sizeof(double));
        memcpy(frame->components.number, numbers[f] + 6, 6 * sizeof(double));
    }
    const size_t size = wire_write_pair_query(&query, bytes);
    lcm_publish(bus.lcm, WIRE_PAIR_QUERY, bytes, (unsigned) size);
}

static struct scene_query scene;

static void publish_scene(int64_t client, int64_t number)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    scene.client_id = client;
    scene.sequence_number = number;
    const size_t size = wire_write_scene_query(&scene, bytes);
    lcm_publish(bus.lcm, WIRE_SCENE_QUERY, bytes, (unsigned) size);
}

/* All pairs of squares in a row. */
static void ask_scene(int64_t client, int64_t number, int32_t frames, const char *method)
{
    memset(&scene, 0, sizeof scene);
    scene.method = fmb_method_by_name(method)->number;
    scene.which = QUERY_PAIRS_ALL;
    scene.frame_count = frames;
    for (int32_t i = 0; i < frames; i++)
        set_frame(i * 0.01, &scene.frame[i]);
    publish_scene(client, number);
}

/* Slanting strips side by side: all their boxes meet, but no two of them do. All are one body, and
 * come by key, so that there is room for many. */
static void ask_long_scene(int64_t client, int64_t number, int32_t frames)
{
    struct query_frame strip;
    set_frame(0, &strip);
    strip.shape = FMB_TETRAHEDRON;
    strip.body_id = 1;
    strip.components.number[0] = strip.components.number[1] = 3000;
    strip.components.number[3] = 0.5;
    memset(&scene, 0, sizeof scene);
    scene.method = fmb_method_by_name("exact")->number;
    scene.which = QUERY_PAIRS_ALL;
    scene.frame_count = 1;
    scene.frame[0] = strip;
    publish_scene(client, number - 1);
    settle();
    bus.count = 0;
    strip.key = 1000;
    strip.components = (struct query_numbers){0};
    scene.frame_count = frames;
    for (int32_t i = 0; i < frames; i++) {
        scene.frame[i] = strip;
        scene.frame[i].origin.number[1] = i;
    }
    publish_scene(client, number);
}

/* ---- Turns ---- */

static void expect(int i, bool of_scene, int64_t client, int64_t number)
{
    assert_true(i < bus.count);
    assert_int_equal(bus.heard[i].scene, of_scene);
    assert_int_equal(bus.heard[i].client_id, client);
    assert_int_equal(bus.heard[i].sequence_number, number);
    assert_int_equal(bus.heard[i].status, FMB_OK);
}

/* One call takes all that the bus has, and answers nothing. */
static void test_all_is_drained_before_anything_is_answered(void **state)
{
    (void) state;
    for (int i = 0; i < 50; i++) {
        ask_pair(1, i);
        ask_scene(2, i, 3, "certified");
    }
    assert_false(server_is_waiting(bus.server));
    assert_true(server_drain(bus.server));
    assert_true(server_is_waiting(bus.server));
    assert_int_equal(status_now()->waiting, 100);
    assert_int_equal(bus.status.most_waiting, 100);
    assert_int_equal(bus.status.received, 0);
    assert_int_equal(bus.count, 0);
    settle();
    assert_false(server_is_waiting(bus.server));
    assert_int_equal(bus.count, 100);
    assert_int_equal(status_now()->waiting, 0);
    assert_int_equal(bus.status.most_waiting, 100);
    assert_int_equal(bus.status.received, 100);
    assert_int_equal(bus.status.scenes, 50);
    assert_int_equal(bus.status.pairs, 50 + 50 * 3);
}

static void test_clients_take_turns(void **state)
{
    (void) state;
    static const int64_t order[][2] = {{1, 1}, {2, 1}, {3, 1}, {1, 2}, {2, 2}, {1, 3}, {2, 3},
                                       {1, 4}, {1, 5}, {1, 6}, {1, 7}, {1, 8}, {1, 9}};
    enum { ASKED = sizeof order / sizeof *order };
    for (int scenes = 0; scenes < 2; scenes++) {
        bus.count = 0;
        for (int64_t client = 1; client <= 3; client++)
            for (int64_t i = 1; i <= (client == 1 ? 9 : client == 2 ? 3 : 1); i++) {
                if (scenes)
                    ask_scene(client, i, 2, "certified");
                else
                    ask_pair(client, i);
            }
        settle();
        assert_int_equal(bus.count, ASKED);
        for (int i = 0; i < ASKED; i++)
            expect(i, scenes, order[i][0], order[i][1]);
    }
}

/* Pairs that are asked while a scene is answered are answered before it, also when there are more
 * than of one turn. */
static void test_pairs_pass_scenes(void **state)
{
    (void) state;
    enum { ASKED = 20 };
    ask_long_scene(7, 1, 250);
    drain();
    for (int64_t i = 0; i < ASKED; i++)
        ask_pair(8, i);
    assert_true(server_answer(bus.server)); /* which finds only the scene when it begins */
    settle();
    assert_int_equal(bus.count, ASKED + 1);
    for (int i = 0; i < ASKED; i++)
        expect(i, false, 8, i);
    expect(ASKED, true, 7, 1);
    assert_int_equal(bus.heard[ASKED].end_pair, 250 * 249 / 2);
    assert_int_equal(bus.heard[ASKED].found, 0);
}

/* Pairs that take long do not keep the service from the bus until all of them are answered. */
static void test_costly_pairs_are_interrupted(void **state)
{
    (void) state;
    enum { ASKED = 256 };
    for (int64_t i = 0; i < ASKED; i++)
        ask_costly_pair(7, i);
    drain();
    assert_true(server_answer(bus.server));
    drain();
    assert_true(bus.count > 0 && bus.count < ASKED / 2);
    const int answered = bus.count;
    ask_pair(8, 1);
    drain();
    while (bus.count < answered + 2) {
        assert_true(server_answer(bus.server));
        drain();
    }
    expect(answered, false, 7, answered);
    expect(answered + 1, false, 8, 1);
}

/* Scenes that come while one is answered wait for it; but not for minutes. */
static void test_scenes_do_not_wait_for_a_long_one(void **state)
{
    (void) state;
    const int32_t total = 1350 * 1349 / 2;
    ask_long_scene(7, 1, 1350);
    drain();
    ask_scene(8, 5, 10, "certified");
    assert_true(server_answer(bus.server));
    settle();
    assert_int_equal(bus.count, 2);
    expect(0, true, 7, 1);
    assert_true(bus.heard[0].end_pair > 0 && bus.heard[0].end_pair < total);
    expect(1, true, 8, 5);
    assert_int_equal(bus.heard[1].end_pair, 45);
    assert_int_equal(status_now()->pairs, 45 + bus.heard[0].end_pair); /* the first one had none */
}

/* ---- Floods ---- */

enum { FLOODER = 1, MODEST = 2 };

static int of_client(int64_t client, int32_t status)
{
    int count = 0;
    for (int i = 0; i < bus.count; i++)
        count += bus.heard[i].client_id == client && bus.heard[i].status == status;
    return count;
}

/* Each query got one result: numbers from 0 to count - 1. */
static void expect_one_each(int64_t client, bool of_scene, int count)
{
    static bool seen[HEARD_MAX];
    int results = 0;
    memset(seen, 0, sizeof seen);
    for (int i = 0; i < bus.count; i++) {
        const struct heard *heard = &bus.heard[i];
        if (heard->client_id != client || heard->scene != of_scene)
            continue;
        assert_true(heard->sequence_number < count && !seen[heard->sequence_number]);
        seen[heard->sequence_number] = true;
        results++;
    }
    assert_int_equal(results, count);
}

static void expect_counts_add_up(int received)
{
    const struct wire_status *status = status_now();
    int64_t sum = 0;
    for (int i = 0; i < FMB_STATUS_COUNT; i++)
        sum += status->results[i];
    assert_int_equal(status->received, received);
    assert_int_equal(status->answered, received);
    assert_int_equal(status->unsent, 0);
    assert_int_equal(sum, received);
    assert_int_equal(status->results[FMB_BUSY],
                     of_client(FLOODER, FMB_BUSY) + of_client(MODEST, FMB_BUSY));
    assert_int_equal(status->waiting, 0);
    assert_int_equal(status->malformed, 0);
}

/* One asks many times what there is room for, the other one thing now and then: it is answered
 * second. */
static void test_a_flood_of_pairs(void **state)
{
    (void) state;
    enum { FLOOD = 30000, EVERY = 1000 };
    for (int i = 0; i < FLOOD; i++) {
        ask_pair(FLOODER, i);
        if (i % EVERY != EVERY - 1)
            continue;
        ask_pair(MODEST, i / EVERY);
        drain();
        server_answer(bus.server);
        server_answer(bus.server); /* where the machine took so long that one was a turn */
        drain();
        assert_int_equal(of_client(MODEST, FMB_OK), i / EVERY + 1);
    }
    settle();
    expect_one_each(FLOODER, false, FLOOD);
    expect_one_each(MODEST, false, FLOOD / EVERY);
    assert_int_equal(of_client(MODEST, FMB_BUSY), 0);
    assert_true(of_client(FLOODER, FMB_BUSY) > FLOOD / 4);
    assert_true(of_client(FLOODER, FMB_OK) >= 4000);
    expect_counts_add_up(FLOOD + FLOOD / EVERY);
    assert_true(bus.status.most_waiting >= 4000 && bus.status.most_waiting <= 4096);
}

/* Of the largest scenes that there are. */
static void test_a_flood_of_scenes(void **state)
{
    (void) state;
    enum { FLOOD = 1000, EVERY = 100 };
    for (int i = 0; i < FLOOD; i++) {
        memset(&scene, 0, sizeof scene);
        scene.frame_count = 2;
        for (int f = 0; f < 2; f++)
            set_frame(f, &scene.frame[f]);
        scene.index_count = 32000;
        for (int p = 0; p < 16000; p++)
            scene.pair[p][1] = 1;
        publish_scene(FLOODER, i);
        if (i % EVERY != EVERY - 1)
            continue;
        ask_scene(MODEST, i / EVERY, 3, "certified");
        drain();
        server_answer(bus.server);
        server_answer(bus.server); /* one turn of each */
        drain();
        assert_int_equal(of_client(MODEST, FMB_OK), i / EVERY + 1);
    }
    settle();
    expect_one_each(FLOODER, true, FLOOD);
    expect_one_each(MODEST, true, FLOOD / EVERY);
    assert_int_equal(of_client(MODEST, FMB_BUSY), 0);
    assert_true(of_client(FLOODER, FMB_BUSY) > FLOOD / 2);
    assert_true(of_client(FLOODER, FMB_OK) >= 256);
    expect_counts_add_up(FLOOD + FLOOD / EVERY);
}

/* Room that one took alone is given to those who come later, down to equal shares. */
static void test_a_full_queue_gives_room_to_others(void **state)
{
    (void) state;
    enum { FLOOD = 5000, OTHERS = 7, EACH = 500 };
    for (int i = 0; i < FLOOD; i++) {
        ask_pair(FLOODER, i);
        if (i % 100 == 99)
            drain();
    }
    for (int i = 0; i < EACH; i++) {
        for (int64_t other = 0; other < OTHERS; other++)
            ask_pair(10 + other, i);
        drain();
    }
    settle();
    for (int64_t other = 0; other < OTHERS; other++)
        assert_int_equal(of_client(10 + other, FMB_OK), EACH);
    expect_one_each(FLOODER, false, FLOOD);
    assert_true(of_client(FLOODER, FMB_OK) >= 4096 / 8);
}

/* ---- What cannot be answered ---- */

static void test_lost_queries_are_told(void **state)
{
    (void) state;
    ask_scene(5, 1, 2, "certified");
    ask_pair(5, 4); /* 2, 3 */
    ask_scene(6, 9, 2, "certified");
    ask_scene(5, 10, 2, "certified"); /* 5 to 9 */
    ask_scene(5, 10, 2, "certified");
    ask_scene(6, 11, 2, "certified");
    settle();
    static const int64_t lost[][2] = {{5, 7}, {5, 7}, {5, 7}, {6, 1}, {6, 1}};
    int seen = 0;
    for (int i = 0; i < bus.count; i++)
        for (size_t k = 0; bus.heard[i].scene && k < sizeof lost / sizeof *lost; k++)
            if (lost[k][0] == bus.heard[i].client_id) {
                assert_int_equal(bus.heard[i].lost, lost[k][1]);
                seen++;
                break;
            }
    assert_int_equal(seen, 5);
    assert_int_equal(status_now()->sequence_gaps, 8);
    assert_int_equal(bus.status.repeated, 1);
}

/* A pair that the method says nothing of got no verdict. */
static void test_pairs_without_a_verdict_do_not_count(void **state)
{
    (void) state;
    memset(&scene, 0, sizeof scene);
    scene.method = fmb_method_by_name("sat")->number;
    scene.frame_count = 3;
    for (int i = 0; i < 3; i++)
        set_frame(i, &scene.frame[i]);
    scene.frame[2].components.number[3] = 0; /* flat */
    scene.index_count = 6;
    scene.pair[0][1] = scene.pair[2][0] = 1;
    scene.pair[1][1] = scene.pair[2][1] = 2;
    publish_scene(1, 1);
    settle();
    assert_int_equal(bus.count, 1);
    assert_int_equal(bus.heard[0].end_pair, 3);
    assert_int_equal(status_now()->pairs, 1);
}

static void publish(const char *channel, const unsigned char *bytes, int size)
{
    assert_true(size > 0);
    lcm_publish(bus.lcm, channel, bytes, (unsigned) size);
    settle();
}

/* Of a size, made of a velocity that goes on and on. */
static int encode_pair(unsigned char *bytes, int room, int size)
{
    static double many[30000];
    fmb_msgs_pair_query_t query = {.client_id = 3};
    const int rest = fmb_msgs_pair_query_t_encoded_size(&query);
    query.a.num_velocity = (size - rest) / 8;
    query.a.velocity = many;
    return fmb_msgs_pair_query_t_encode(bytes, 0, room, &query);
}

static int encode_scene(unsigned char *bytes, int room, int size)
{
    static int16_t many[120000];
    fmb_msgs_scene_query_t query = {.client_id = 3, .indices = many};
    query.num_indices = (size - WIRE_SCENE_QUERY_BYTES) / 2;
    return fmb_msgs_scene_query_t_encode(bytes, 0, room, &query);
}

static void test_datagrams_beyond_the_limit(void **state)
{
    (void) state;
    static const int sizes[] = {65000, 65002, 65008, 65536, 65544, 200000};
    static unsigned char bytes[240000];
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (int scenes = 0; scenes < 2; scenes++) {
            const int size = (scenes ? encode_scene : encode_pair)(bytes, sizeof bytes, sizes[i]);
            const bool over = size > 65000;
            publish(scenes ? WIRE_SCENE_QUERY : WIRE_PAIR_QUERY, bytes, size);
            assert_int_equal(bus.count, 1);
            assert_int_equal(bus.heard[0].scene, scenes);
            assert_int_equal(bus.heard[0].client_id, 3);
            assert_int_equal(bus.heard[0].status, over     ? FMB_OVER_LIMIT
                                                  : scenes ? FMB_BAD_PAIR
                                                           : FMB_UNKNOWN_SHAPE);
            bus.count = 0;
        }
    assert_int_equal(status_now()->malformed, 0);
}

/* What is found malformed only when its turn comes is counted too, and not answered. */
static void test_malformed_behind_a_good_header(void **state)
{
    (void) state;
    static unsigned char bytes[QUERY_BYTES_MAX];
    for (int size = 32; size < 68; size++) {
        memset(&scene, 0, sizeof scene);
        wire_write_scene_query(&scene, bytes);
        publish(WIRE_SCENE_QUERY, bytes, size);
        struct pair_query query = {.client_id = 3};
        wire_write_pair_query(&query, bytes);
        publish(WIRE_PAIR_QUERY, bytes, size);
    }
    assert_int_equal(bus.count, 0);
    assert_int_equal(status_now()->malformed, 72);
    assert_int_equal(bus.status.received, 0);
    assert_false(server_is_waiting(bus.server));
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_all_is_drained_before_anything_is_answered),
        TEST(test_clients_take_turns),
        TEST(test_pairs_pass_scenes),
        TEST(test_costly_pairs_are_interrupted),
        TEST(test_scenes_do_not_wait_for_a_long_one),
        TEST(test_a_flood_of_pairs),
        TEST(test_a_flood_of_scenes),
        TEST(test_a_full_queue_gives_room_to_others),
        TEST(test_lost_queries_are_told),
        TEST(test_pairs_without_a_verdict_do_not_count),
        TEST(test_datagrams_beyond_the_limit),
        TEST(test_malformed_behind_a_good_header),
    };
    return cmocka_run_group_tests_name("server_turns", tests, NULL, NULL);
}
