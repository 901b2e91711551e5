/* The service through memq://: one process, one thread, no network. */
#include "hostile.h"
#include "server.h"
#include "wire.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* A bus with a service on it, and the last messages that the service sent. */
static struct {
    lcm_t *lcm;
    struct server *server;
    int results, statuses;
    struct pair_result result;
    char certificate[QUERY_CERTIFICATE_MAX]; /* of the result; "" where it has none */
    uint32_t size;                           /* of the result, in bytes */
    struct wire_status status;
} bus;

static void on_result(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    (void) channel;
    (void) user;
    assert_null(wire_read_pair_result(buffer->data, buffer->data_size, &bus.result));
    strcpy(bus.certificate, bus.result.certificate ? bus.result.certificate : "");
    bus.size = buffer->data_size;
    bus.results++;
}

static void on_status(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    (void) channel;
    (void) user;
    assert_null(wire_read_status(buffer->data, buffer->data_size, &bus.status));
    bus.statuses++;
}

static int set_up(void **state)
{
    (void) state;
    memset(&bus, 0, sizeof bus);
    bus.lcm = lcm_create("memq://");
    const struct server_options options = {
        .prefix = "T_", .bodies = 100, .server_id = 11, .first_key = 1000, .seed = 7};
    bus.server = server_create(bus.lcm, &options);
    lcm_subscribe(bus.lcm, "T_" WIRE_PAIR_RESULT, on_result, NULL);
    lcm_subscribe(bus.lcm, "T_" WIRE_STATUS, on_status, NULL);
    return bus.server ? 0 : -1;
}

static int tear_down(void **state)
{
    (void) state;
    server_destroy(bus.server);
    lcm_destroy(bus.lcm);
    return 0;
}

static void settle(void)
{
    while (lcm_handle_timeout(bus.lcm, 0) > 0 || server_answer(bus.server))
        continue;
}

static void publish(const void *bytes, size_t size)
{
    lcm_publish(bus.lcm, "T_" WIRE_PAIR_QUERY, bytes, (unsigned) size);
}

static struct pair_query sample(int64_t sequence_number)
{
    struct pair_query query = {
        .client_id = 21, .sequence_number = sequence_number, .duration = 1, .want = QUERY_WANT_BOX};
    for (int f = 0; f < 2; f++) {
        struct query_frame *frame = &query.frame[f];
        *frame = (struct query_frame){.body_id = f + 1, .shape = FMB_TETRAHEDRON, .dim = 2};
        frame->origin.count = 2;
        frame->components = (struct query_numbers){.count = 4, .number = {1, 0, 0, 1}};
    }
    query.frame[1].origin.number[0] = 0.25;
    return query;
}

static void publish_query(const struct pair_query *query)
{
    unsigned char bytes[WIRE_BYTES_MAX];
    publish(bytes, wire_write_pair_query(query, bytes));
}

static struct wire_status status_now(void)
{
    server_publish_status(bus.server);
    settle();
    return bus.status;
}

static void test_a_query_gets_one_result(void **state)
{
    (void) state;
    struct pair_query query = sample(1);
    publish_query(&query);
    settle();
    assert_int_equal(bus.results, 1);
    assert_int_equal(bus.result.sequence_number, 1);
    assert_int_equal(bus.result.client_id, 21);
    assert_int_equal(bus.result.server_id, 11);
    assert_int_equal(bus.result.answer.verdict, FMB_OVERLAPPING);
    assert_int_equal(bus.result.dim, 2);
    assert_true(bus.result.answer.box[0][0] == 0.25);
    assert_true(bus.result.compute_ns > 0);
}

static void test_certificates_are_given_where_wanted(void **state)
{
    (void) state;
    const double apart[] = {0.25, 1, 3};
    const char *const begin[] = {"overlapping", "touching", "separated"};
    struct pair_query query = sample(1);
    for (int i = 0; i < 3; i++) {
        query.frame[1].origin.number[0] = apart[i];
        query.want = QUERY_WANT_BOX;
        publish_query(&query);
        settle();
        assert_string_equal(bus.certificate, "");
        query.want = QUERY_WANT_CERTIFICATE;
        publish_query(&query);
        settle();
        assert_memory_equal(bus.certificate, begin[i], strlen(begin[i]));
    }
    assert_int_equal(bus.results, 6);
    query.frame[1].shape = 9;
    publish_query(&query);
    settle();
    assert_int_equal(bus.result.status, FMB_UNKNOWN_SHAPE);
    assert_string_equal(bus.certificate, "");
    assert_int_equal(status_now().pairs, 6);
}

static void test_status_counts(void **state)
{
    (void) state;
    struct pair_query query = sample(1), bad = sample(5);
    publish_query(&query);
    publish_query(&query);
    bad.frame[0].shape = 9;
    publish_query(&bad);
    settle();
    struct wire_status status = status_now();
    assert_int_equal(status.server_id, 11);
    assert_string_equal(status.version, fmb_version());
    assert_int_equal(status.received, 3);
    assert_int_equal(status.answered, 3);
    assert_int_equal(status.pairs, 2);
    assert_int_equal(status.results[FMB_OK], 2);
    assert_int_equal(status.results[FMB_UNKNOWN_SHAPE], 1);
    assert_int_equal(status.repeated, 1);
    assert_int_equal(status.sequence_gaps, 3);
    assert_int_equal(status.hits, 2);
    assert_int_equal(status.misses, 2);
    assert_int_equal(status.bodies, 2);
    assert_int_equal(status.capacity, 100);
    assert_true(status.compute_p50_ns > 0);
    assert_true(status.compute_p99_ns <= status.compute_max_ns);
    assert_true(status.utime > 1600000000000000);
}

static void publish_damage(void *context, const char *what, const unsigned char *bytes, size_t size)
{
    const char *channel = context;
    (void) what;
    lcm_publish(bus.lcm, channel, bytes, (unsigned) size);
    settle();
}

/* Damaged messages of every type on the query channels: counted, not answered, not fatal. */
static void test_damage_is_counted(void **state)
{
    (void) state;
    static const char *const types[] = {"pair_query", "pair_result", "scene_query", "scene_result",
                                        "status"};
    static char channels[][32] = {"T_" WIRE_PAIR_QUERY, "T_" WIRE_SCENE_QUERY};
    size_t sent = 0;
    for (size_t t = 0; t < sizeof types / sizeof *types; t++)
        for (size_t c = 0; c < sizeof channels / sizeof *channels; c++)
            sent += hostile_each(types[t], publish_damage, channels[c]);
    assert_int_equal(bus.results, 0);
    assert_int_equal(status_now().malformed, sent);
    assert_int_equal(status_now().received, 0);
    struct pair_query query = sample(1);
    publish_query(&query);
    settle();
    assert_int_equal(bus.results, 1);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_a_query_gets_one_result),
        TEST(test_certificates_are_given_where_wanted),
        TEST(test_status_counts),
        TEST(test_damage_is_counted),
    };
    return cmocka_run_group_tests_name("server", tests, NULL, NULL);
}
