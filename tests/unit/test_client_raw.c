/* Encoded queries through the client library's engine, as fmb replay and fmb record send them. */
#include "unit.h"

#include "fmb_client_raw.h"
#include "geometry_write.h"
#include "leap_clock.h"
#include "relay.h"
#include "wire.h"

#include <sys/ioctl.h>
#include <unistd.h>

enum { BODIES = 30, PATIENCE_S = 60 };

static const int64_t s = 1000000000; /* nanoseconds */

/* A cube of its own size for each id. */
static struct query_placement cube_of(int64_t id, unsigned char geometry[GEOMETRY_FRAME_BYTES_MAX])
{
    const double size = 1 + 0.01 * (double) id;
    const struct plain_frame frame = {.shape = FMB_CUBOID,
                                      .components = {size, 0, 0, 0, 1, 0, 0, 0, 1}};
    struct query_placement out = {.placed.id = id, .body.dim = 3, .body.frame_count = 1};
    out.body = geometry_write(3, &frame, geometry);
    return out;
}

static size_t pair_query(int64_t a, int64_t b, unsigned char out[QUERY_BYTES_MAX])
{
    unsigned char geometry[2][GEOMETRY_FRAME_BYTES_MAX];
    const struct pair_query query = {
        .utime = 77,
        .client_id = 5,
        .sequence_number = 6,
        .duration = 1,
        .placement = {cube_of(a, geometry[0]), cube_of(b, geometry[1])}};
    return wire_write_pair_query(&query, out);
}

static size_t definition_query(int64_t first, const struct handle *handle, int32_t count,
                               unsigned char out[QUERY_BYTES_MAX])
{
    struct definition_query query = {.first = first, .handle_count = count};
    if (count > 0)
        memcpy(query.handle, handle, sizeof *handle * (size_t) count);
    return wire_write_definition_query(&query, out);
}

static void finish(struct fmb_client *client)
{
    int under_way;
    while ((under_way = fmb_client_raw_step(client, -1, PATIENCE_S)) > 0)
        continue;
    assert_int_equal(under_way, 0);
}

/* ---- Pairs ---- */

struct pair {
    int called, status;
    struct pair_result result;
};

static void take_pair(void *user, const struct fmb_client_raw_result *result)
{
    struct pair *pair = user;
    pair->called++;
    pair->status = result->status;
    if (result->status < 0)
        assert_null(result->bytes);
    else
        assert_null(wire_read_pair_result(result->bytes, (uint32_t) result->size, &pair->result));
}

static void send_pair(struct fmb_client *client, int64_t a, int64_t b, struct pair *out)
{
    unsigned char message[QUERY_BYTES_MAX];
    const size_t size = pair_query(a, b, message);
    while (!fmb_client_raw_ready(client, size))
        fmb_client_raw_step(client, -1, PATIENCE_S);
    assert_int_equal(
        fmb_client_raw_send(client, FMB_CLIENT_PAIR, message, size, size, take_pair, out), FMB_OK);
}

static void many_pairs_are_answered_over_a_bad_bus(void **state)
{
    enum { COUNT = 300 };
    static struct pair pair[COUNT];
    test.relay->lose_query = 7;
    test.relay->lose_result = 5;
    test.relay->double_result = 3;
    memset(pair, 0, sizeof pair);
    relay_start(1000, 0.05, 1000);
    for (int i = 0; i < COUNT; i++)
        send_pair(test.client, 1 + i % BODIES, 1 + (i + 7) % BODIES, &pair[i]);
    finish(test.client);
    for (int i = 0; i < COUNT; i++) {
        assert_int_equal(pair[i].called, 1);
        assert_int_equal(pair[i].status, FMB_OK);
        assert_int_equal(pair[i].result.body_id[0], 1 + i % BODIES);
        assert_int_equal(pair[i].result.utime, 77);
        assert_int_equal(pair[i].result.answer.verdict, FMB_OVERLAPPING);
        assert_int_not_equal(pair[i].result.client_id, 5);
        assert_int_equal(pair[i].result.client_id, pair[0].result.client_id);
    }
    assert_true(relay_counts(test.client).repeated > 10);
    assert_int_equal(relay_counts(test.client).queries, COUNT);
}

static void let_all_time_pass(struct relay *relay)
{
    (void) relay;
    clock_leap(100 * s);
}

static void a_window_of_64_is_under_way(void **state)
{
    static struct pair pair[FMB_CLIENT_RAW_WINDOW];
    test.relay->deaf = true;
    test.relay->before = let_all_time_pass;
    memset(pair, 0, sizeof pair);
    relay_start(1000, 30, 2);
    for (int i = 0; i < FMB_CLIENT_RAW_WINDOW; i++) {
        assert_true(fmb_client_raw_ready(test.client, 400));
        send_pair(test.client, 1, 2, &pair[i]);
    }
    assert_false(fmb_client_raw_ready(test.client, 400));
    finish(test.client);
    for (int i = 0; i < FMB_CLIENT_RAW_WINDOW; i++) {
        assert_int_equal(pair[i].called, 1);
        assert_int_equal(pair[i].status, FMB_CLIENT_NO_SERVICE);
    }
    /* Known to be silent, it gets one query at a time. */
    relay_wait(test.relay, FMB_CLIENT_RAW_WINDOW);
    test.relay->before = NULL;
    send_pair(test.client, 1, 2, &pair[0]);
    assert_false(fmb_client_raw_ready(test.client, 400));
    test.relay->deaf = false;
    finish(test.client);
    assert_int_equal(pair[0].status, FMB_OK);
    assert_true(fmb_client_raw_ready(test.client, 400));
}

/* A query is lost, and its caller comes back only when the time for all its repeats is over. */
static void a_caller_that_was_away_repeats_its_query(void **state)
{
    struct pair pair = {0};
    test.relay->lose_query = 1;
    relay_start(10, 30, 2);
    send_pair(test.client, 1, 2, &pair);
    relay_wait(test.relay, 1);
    clock_leap(90 * s);
    test.relay->lose_query = 0;
    finish(test.client);
    assert_int_equal(pair.called, 1);
    assert_int_equal(pair.status, FMB_OK);
}

/* No more bytes than a stock receive buffer holds: two of the largest datagrams. */
static void large_queries_are_few_at_a_time(void **state)
{
    static struct pair pair;
    test.relay->deaf = true;
    unsigned char message[QUERY_BYTES_MAX];
    relay_start(1000, 0.02, 1);
    const size_t size = pair_query(1, 2, message);
    int sent = 0;
    for (; fmb_client_raw_ready(test.client, QUERY_BYTES_MAX); sent++)
        assert_int_equal(fmb_client_raw_send(test.client, FMB_CLIENT_PAIR, message, size,
                                             QUERY_BYTES_MAX, take_pair, &pair),
                         FMB_OK);
    assert_int_equal(sent, 2);
    finish(test.client);
}

static void messages_that_are_none_are_refused(void **state)
{
    static unsigned char message[QUERY_BYTES_MAX + 1];
    relay_start(1000, 1, 1);
    assert_int_equal(
        fmb_client_raw_send(test.client, FMB_CLIENT_PAIR, message, 31, 31, take_pair, NULL),
        FMB_WRONG_COUNT);
    assert_int_equal(fmb_client_raw_send(test.client, FMB_CLIENT_PAIR, message, sizeof message, 31,
                                         take_pair, NULL),
                     FMB_OVER_LIMIT);
    assert_int_equal(fmb_client_raw_step(test.client, -1, 0), 0);
}

/* Other clients' results fill the buffer of a client that is idle: before a query is sent, all of
 * them are read, so that its result has space. */
static void an_idle_client_is_drained_before_a_query(void **state)
{
    static struct pair pair;
    test.relay->deaf = true;
    static const unsigned char other[1000];
    int waiting;
    relay_start(1000, 0.02, 1);
    send_pair(test.client, 1, 2, &pair);
    finish(test.client);
    for (int i = 0; i < 100; i++)
        relay_publish(test.relay, "OTHER", other, sizeof other);
    assert_int_equal(ioctl(fmb_client_fileno(test.client), FIONREAD, &waiting), 0);
    assert_true(waiting > (int) sizeof other); /* the first datagram */
    send_pair(test.client, 1, 2, &pair);
    assert_int_equal(ioctl(fmb_client_fileno(test.client), FIONREAD, &waiting), 0);
    assert_true(waiting < (int) sizeof other); /* its own query, or nothing */
    finish(test.client);
}

/* ---- Scenes, definitions ---- */

static void take_scene(void *user, const struct fmb_client_raw_result *result)
{
    assert_int_equal(result->status, FMB_OK);
    assert_null(wire_read_scene_result(result->bytes, (uint32_t) result->size, user));
}

static void query_scene(struct fmb_client *client, struct scene_result *out)
{
    static struct scene_query query;
    static unsigned char geometry[BODIES][GEOMETRY_FRAME_BYTES_MAX];
    unsigned char message[QUERY_BYTES_MAX];
    query.which = FMB_PAIRS_ALL;
    query.placement_count = BODIES;
    for (int i = 0; i < BODIES; i++)
        query.placement[i] = cube_of(1 + i, geometry[i]);
    const size_t size = wire_write_scene_query(&query, message);
    assert_int_equal(fmb_client_raw_send(client, FMB_CLIENT_SCENE, message, size, QUERY_BYTES_MAX,
                                         take_scene, out),
                     FMB_OK);
    finish(client);
}

static void take_definition(void *user, const struct fmb_client_raw_result *result)
{
    assert_int_equal(result->status, FMB_OK);
    assert_null(wire_read_definition(result->bytes, (uint32_t) result->size, user));
}

static void query_definition(struct fmb_client *client, int64_t first, const struct handle *handle,
                             int32_t count, struct definition *out)
{
    unsigned char message[QUERY_BYTES_MAX];
    const size_t size = definition_query(first, handle, count, message);
    assert_int_equal(fmb_client_raw_send(client, FMB_CLIENT_DEFINITION, message, size,
                                         QUERY_BYTES_MAX, take_definition, out),
                     FMB_OK);
    finish(client);
}

static void scenes_and_definitions_are_answered(void **state)
{
    static struct scene_result scene;
    static struct definition definition;
    test.relay->lose_query = 3;
    relay_start(1000, 0.1, 600);
    query_scene(test.client, &scene);
    assert_int_equal(scene.verdict_count, BODIES * (BODIES - 1) / 2);
    assert_int_equal(scene.handle_count, BODIES);
    query_definition(test.client, 0, &scene.handle[3], 5, &definition);
    assert_int_equal(definition.body_count, 5);
    assert_int_equal(definition.next, 0);
    int64_t first = 0, count = 0;
    do { /* all, in pages */
        query_definition(test.client, first, NULL, 0, &definition);
        count += definition.body_count;
        first = definition.next;
    } while (first != 0);
    assert_int_equal(count, BODIES);
}

/* ---- The loop ---- */

static void a_step_ends_with_another_descriptor(void **state)
{
    static struct pair pair;
    test.relay->deaf = true;
    relay_start(1000, 1000, 1);
    send_pair(test.client, 1, 2, &pair);
    int fd[2];
    assert_int_equal(pipe(fd), 0);
    assert_int_equal(write(fd[1], "", 1), 1);
    assert_int_equal(fmb_client_raw_step(test.client, fd[0], 1e6), 1);
    assert_int_equal(pair.called, 0);
    close(fd[0]);
    close(fd[1]);
}

static void step_within(void *user, const struct fmb_client_raw_result *result)
{
    unsigned char message[QUERY_BYTES_MAX];
    struct fmb_client *client = user;
    const size_t size = pair_query(1, 2, message);
    assert_int_equal(result->status, FMB_OK);
    assert_int_equal(fmb_client_raw_step(client, -1, 0), FMB_CLIENT_INSIDE);
    assert_int_equal(
        fmb_client_raw_send(client, FMB_CLIENT_PAIR, message, size, size, step_within, client),
        FMB_CLIENT_INSIDE);
}

static void no_call_within_a_callback(void **state)
{
    unsigned char message[QUERY_BYTES_MAX];
    relay_start(1000, 10, 6);
    const size_t size = pair_query(1, 2, message);
    assert_int_equal(fmb_client_raw_send(test.client, FMB_CLIENT_PAIR, message, size, size,
                                         step_within, test.client),
                     FMB_OK);
    finish(test.client);
}

/* ---- A listener ---- */

struct tapped {
    const struct pair *pair;
    int64_t client_id;
    int others, queries, results;
};

static void tap(void *user, const struct bus_message *message)
{
    static struct pair_query query;
    static struct pair_result result;
    struct tapped *tapped = user;
    const uint32_t size = (uint32_t) message->size;
    /* The engine reads it later. Second messages of a repeated query come after its result. */
    assert_true(tapped->pair->called == 0 || tapped->results > 0);
    if (!wire_read_pair_query(message->bytes, size, &query)) {
        assert_string_equal(message->channel, WIRE_PAIR_QUERY);
        assert_int_equal(query.client_id, tapped->client_id);
        tapped->queries++;
    } else if (!wire_read_pair_result(message->bytes, size, &result)) {
        assert_string_equal(message->channel, WIRE_PAIR_RESULT);
        assert_int_equal(result.client_id, tapped->client_id);
        tapped->results++;
    } else {
        assert_string_equal(message->channel, "OTHER");
        tapped->others++;
    }
}

static void a_tap_gets_all_messages_first(void **state)
{
    struct relay *relay = relay_new();
    relay_open(relay, 1000);
    for (int every = 0; every < 2; every++) {
        struct pair pair = {.called = 0};
        struct fmb_client *client = relay_client(relay, 10, 1);
        struct tapped tapped = {.pair = &pair, .client_id = fmb_client_raw_id(client)};
        assert_true(fmb_client_raw_listen(client, every, tap, &tapped));
        for (int i = 0; i < 3; i++)
            relay_publish(relay, "OTHER", "other", 5);
        send_pair(client, 1, 2, &pair); /* which reads what is pending */
        assert_int_equal(tapped.others, every ? 3 : 0);
        finish(client);
        assert_int_equal(pair.called, 1);
        assert_int_equal(pair.status, FMB_OK);
        const struct fmb_client_counts counts = relay_counts(client);
        assert_in_range(tapped.queries, 1, 1 + counts.repeated);
        assert_in_range(tapped.results, 1, tapped.queries);
        assert_int_equal(counts.malformed, 0);
        assert_int_equal(fmb_client_raw_bus_counts(client).received,
                         tapped.others + tapped.queries + tapped.results);
        fmb_client_close(client);
    }
    relay_close(relay);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        RELAY_TEST(many_pairs_are_answered_over_a_bad_bus),
        RELAY_TEST(a_window_of_64_is_under_way),
        RELAY_TEST(a_caller_that_was_away_repeats_its_query),
        RELAY_TEST(large_queries_are_few_at_a_time),
        RELAY_TEST(messages_that_are_none_are_refused),
        RELAY_TEST(an_idle_client_is_drained_before_a_query),
        RELAY_TEST(scenes_and_definitions_are_answered),
        RELAY_TEST(a_step_ends_with_another_descriptor),
        RELAY_TEST(no_call_within_a_callback),
        cmocka_unit_test(a_tap_gets_all_messages_first),
    };
    (void) argc;
    relay_enter(argv);
    return cmocka_run_group_tests_name("client_raw", tests, NULL, NULL);
}
