/* The server, by bytes and a callback: results, counts, hostile bytes. */
#include "unit.h"

#include "geometry_write.h"
#include "hostile.h"
#include "leap_clock.h"
#include "service.h"

#include <unistd.h>

static void a_query_gets_one_result(void **state)
{
    struct pair_query query = service_pair(21, 1);
    query.want = FMB_WANT_BOX;
    query.placement[1].placed.position[0] = 0.25;
    service.tick_ns = 100;
    service_send_pair(&query);
    service_settle();
    assert_int_equal(service.count, 1);
    assert_int_equal(service.pair.sequence_number, 1);
    assert_int_equal(service.pair.client_id, 21);
    assert_int_equal(service.pair.server_id, 11);
    assert_int_equal(service.pair.answer.verdict, FMB_OVERLAPPING);
    assert_int_equal(service.pair.dim, 2);
    assert_true(service.pair.answer.box[0][0] == 0.25);
    assert_int_equal(service.pair.compute_ns, 100);
}

static void certificates_are_given_where_wanted(void **state)
{
    const double distance[] = {0.25, 1, 3};
    const char *const begin[] = {"overlapping", "touching", "separated"};
    struct pair_query query = service_pair(21, 1);
    for (int i = 0; i < 3; i++) {
        query.placement[1].placed.position[0] = distance[i];
        query.want = FMB_WANT_BOX;
        service_send_pair(&query);
        service_settle();
        assert_string_equal(service.certificate, "");
        query.want = FMB_WANT_CERTIFICATE;
        service_send_pair(&query);
        service_settle();
        assert_memory_equal(service.certificate, begin[i], strlen(begin[i]));
    }
    assert_int_equal(service.count, 6);
    assert_int_equal(service_status()->pairs, 6);
}

static void definitions_are_given(void **state)
{
    struct pair_query query = service_pair(21, 1);
    query.placement[0].placed.id = 1;
    query.placement[1].placed.id = 2; /* of the same geometry */
    service_send_pair(&query);
    service_query_definitions(22, 5);
    service_settle();
    assert_int_equal(service.count, 2);
    assert_int_equal(service.result[1].kind, SERVER_DEFINITIONS);
    assert_int_equal(service.result[1].sequence_number, 5);
    assert_int_equal(service.result[1].status, FMB_OK);
    assert_int_equal(service.definition_bodies, 1);
}

static void the_heartbeat_counts_the_work(void **state)
{
    struct pair_query query = service_pair(21, 1);
    query.placement[0].placed.id = 1;
    query.placement[1].placed.id = 2;
    service.tick_ns = 10;
    service_send_pair(&query);
    service_send_pair(&query);
    query.want = 1 << 20;
    service_send_pair(&query);
    service_query_scene(22, 1, 5);
    service_query_definitions(22, 2);
    assert_int_equal(service_status()->waiting, 5);
    assert_int_equal(service.status.received, 0);
    service_settle();
    const struct wire_status *status = service_status();
    assert_int_equal(status->server_id, 11);
    assert_string_equal(status->version, fmb_version());
    assert_int_equal(status->received, 5);
    assert_int_equal(status->answered, 5);
    assert_int_equal(status->unsent, 0);
    assert_int_equal(status->scenes, 1);
    assert_int_equal(status->definitions, 1);
    assert_int_equal(status->pairs, 2 + 10);
    assert_int_equal(status->results[FMB_OK], 4);
    assert_int_equal(status->results[FMB_UNKNOWN_WANT], 1);
    assert_int_equal(status->foreign, 3 + 4);
    assert_int_equal(status->malformed, 0);
    assert_int_equal(status->dropped, 5);
    assert_int_equal(status->receive_buffer, 6);
    assert_int_equal(status->waiting, 0);
    assert_int_equal(status->most_waiting, 5);
    assert_int_equal(status->bodies, 1);
    assert_int_equal(status->frames, 1);
    assert_int_equal(status->frame_capacity, 2000);
    assert_int_equal(status->ids, 2);
    assert_true(status->hits >= 3);
    assert_true(status->compute_p50_ns > 0);
    assert_true(status->compute_p99_ns <= status->compute_max_ns);
    assert_true(status->utime > 1600000000000000);
}

/* Times of refusals are not counted. */
static void quantiles_are_of_answered_queries(void **state)
{
    struct pair_query query = service_pair(21, 0);
    for (int i = 1; i <= 22; i++) {
        service.tick_ns = i == 22 ? 100000 : i == 21 ? 1000 : 10;
        query.sequence_number = i;
        query.want = i == 22 ? 1 << 20 : 0;
        service_send_pair(&query);
        service_settle();
    }
    const struct wire_status *status = service_status();
    assert_int_equal(status->results[FMB_UNKNOWN_WANT], 1);
    assert_true(status->compute_p50_ns < 1000 && status->compute_p99_ns >= 1000);
    assert_true(status->compute_max_ns < 100000);
}

/* Of pairs that a method cannot decide. */
static void undecided_pairs_are_not_counted(void **state)
{
    static struct scene_query scene;
    static unsigned char bytes[QUERY_BYTES_MAX];
    const struct pair_query pair = service_pair(21, 1);
    const struct plain_frame flat = {.shape = FMB_CUBOID, .components = {1, 0, 0, 0}};
    unsigned char geometry[GEOMETRY_FRAME_BYTES_MAX];
    scene = (struct scene_query){.client_id = 21,
                                 .duration = 1,
                                 .method = fmb_method_by_name("fmb")->number,
                                 .which = FMB_PAIRS_LISTED,
                                 .placement_count = 3,
                                 .placement = {pair.placement[0], pair.placement[1]},
                                 .index_count = 4,
                                 .pair = {{0, 1}, {1, 2}}};
    scene.placement[2] = pair.placement[1];
    scene.placement[2].body = geometry_write(2, &flat, geometry);
    service_receive(SERVER_SCENES, bytes, wire_write_scene_query(&scene, bytes));
    service_settle();
    assert_int_equal(service.result[0].end_pair, 2);
    assert_int_equal(service_status()->pairs, 1);
}

/* A query of a grid of `placements` squares that are separated. split: for pairs across. */
static struct scene_query *squares(int32_t which, int32_t placements, int32_t split)
{
    static struct scene_query scene;
    const struct pair_query pair = service_pair(21, 1);
    scene = (struct scene_query){.client_id = 21,
                                 .duration = 1,
                                 .which = which,
                                 .placement_count = placements,
                                 .split = split};
    for (int32_t i = 0; i < placements; i++) {
        scene.placement[i] = pair.placement[0];
        scene.placement[i].placed.position[0] = 3 * (i % 10);
        scene.placement[i].placed.position[1] = 3 * (i / 10);
    }
    return &scene;
}

static void ignore(struct scene_query *scene, unsigned a, unsigned b)
{
    scene->ignored[scene->ignored_count / 2][0] = a;
    scene->ignored[scene->ignored_count / 2][1] = b;
    scene->ignored_count += 2;
}

/* Returns the number of pairs that a scene adds to the status. */
static int64_t pairs_counted(const struct scene_query *scene)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    const int64_t before = service_status()->pairs;
    service_receive(SERVER_SCENES, bytes, wire_write_scene_query(scene, bytes));
    service_settle();
    assert_int_equal(service.result[service.count - 1].status, FMB_OK);
    return service_status()->pairs - before;
}

static void ignored_pairs_are_not_counted(void **state)
{
    struct scene_query *scene = squares(FMB_PAIRS_ALL, 3, 0);
    ignore(scene, 0, 1);
    ignore(scene, 2, 1);
    assert_int_equal(pairs_counted(scene), 1);
    ignore(scene, 1, 0); /* a repetition */
    ignore(scene, 0, 1);
    assert_int_equal(pairs_counted(scene), 1);
    scene->first_pair = 1; /* (0, 1) comes before it */
    assert_int_equal(pairs_counted(scene), 1);
    scene->first_pair = 3;
    assert_int_equal(pairs_counted(scene), 0);
    scene->first_pair = 0;
    scene->placement[0].placed.group = scene->placement[2].placed.group = 5;
    assert_int_equal(pairs_counted(scene), 0);
    scene->placement[2].placed.group = -5;
    ignore(scene, 0, 2);
    assert_int_equal(pairs_counted(scene), 0);

    scene = squares(FMB_PAIRS_ACROSS, 139, 50);
    for (unsigned a = 0; a < 50; a++)
        for (unsigned b = 0; b < a; b++)
            ignore(scene, b, a); /* not pairs of the scene */
    assert_int_equal(pairs_counted(scene), 50 * 89);
    for (unsigned a = 0; a < 50; a++)
        ignore(scene, 138, a);
    assert_int_equal(pairs_counted(scene), 50 * 88);
    scene->first_pair = 89 * 49 + 80;
    assert_int_equal(pairs_counted(scene), 8);

    /* A listed pair cannot be ignored: all are counted. */
    scene = squares(FMB_PAIRS_LISTED, 4, 0);
    scene->index_count = 4;
    scene->pair[0][1] = 1;
    scene->pair[1][1] = 2;
    ignore(scene, 2, 3);
    assert_int_equal(pairs_counted(scene), 2);
}

static void pairs_before_the_first_are_not_counted(void **state)
{
    struct scene_query *scene = squares(FMB_PAIRS_ALL, 10, 0);
    scene->first_pair = 40;
    assert_int_equal(pairs_counted(scene), 5);
}

/* The bytes on stderr when a heartbeat of this server is received. */
static long said_of_heartbeat(int64_t server_id)
{
    unsigned char bytes[WIRE_STATUS_BYTES_MAX];
    struct wire_status status = *service_status();
    FILE *said = tmpfile();
    const int before = dup(STDERR_FILENO);
    assert_true(said && before >= 0);
    fflush(stderr);
    dup2(fileno(said), STDERR_FILENO);
    status.server_id = server_id;
    service_receive(SERVER_STATUS, bytes, wire_write_status(&status, bytes));
    fflush(stderr);
    dup2(before, STDERR_FILENO);
    close(before);
    const long size = lseek(fileno(said), 0, SEEK_END);
    fclose(said);
    return size;
}

static const int64_t ms = 1000000; /* nanoseconds */

/* Another service is reported once; its own heartbeats are not. */
static void another_service_is_reported(void **state)
{
    assert_int_equal(said_of_heartbeat(11), 0);
    assert_true(said_of_heartbeat(12) > 50);
    assert_int_equal(said_of_heartbeat(12), 0);
    clock_leap(1100 * ms); /* after which a report is allowed again */
    assert_int_equal(said_of_heartbeat(12), 0);
    assert_true(said_of_heartbeat(13) > 50);
}

static void uptime_is_in_microseconds(void **state)
{
    clock_leap(20 * ms);
    const int64_t uptime_us = service_status()->uptime_us;
    assert_in_range(uptime_us, 20000, (clock_ns() - service.opened_ns) / 1000);
}

static void results_that_the_bus_does_not_take_are_counted(void **state)
{
    service.refuses = true;
    service_query_pair(21, 1);
    service_settle();
    service.refuses = false;
    assert_int_equal(service_status()->received, 1);
    assert_int_equal(service.status.unsent, 1);
    assert_int_equal(service.status.answered, 0);
}

static void heartbeats_are_due_each_second(void **state)
{
    assert_int_equal(server_heartbeat_due_ms(service.server), 0);
    const int64_t begin = clock_ns();
    service_status();
    const int due_ms = server_heartbeat_due_ms(service.server);
    assert_in_range(due_ms, 1000 - (clock_ns() - begin) / ms, 1000);
    clock_leap(1000 * ms);
    assert_int_equal(server_heartbeat_due_ms(service.server), 0);
}

static void what_is_too_long_is_refused(void **state)
{
    static unsigned char bytes[BUS_PAYLOAD_MAX];
    static const struct scene_query scene = {.client_id = 22};
    wire_write_scene_query(&scene, bytes);
    service_receive(SERVER_SCENES, bytes, QUERY_BYTES_MAX + 1);
    service_receive(SERVER_SCENES, bytes, sizeof bytes);
    assert_int_equal(service.count, 2);
    assert_int_equal(service.result[0].status, FMB_OVER_LIMIT);
    assert_int_equal(service.result[1].client_id, 22);
}

static void send_damage(void *context, const char *what, const unsigned char *bytes, size_t size)
{
    const enum server_kind *kind = context;
    (void) what;
    service_receive(*kind, bytes, size);
    service_settle();
}

/* Damaged messages of every type as queries of every kind: counted, not answered, not fatal. */
static void damage_is_counted(void **state)
{
    static const char *const types[] = {"pair_query",   "pair_result", "scene_query",
                                        "scene_result", "status",      "definition_query",
                                        "definition"};
    size_t sent = 0;
    for (size_t t = 0; t < COUNT(types); t++)
        for (enum server_kind kind = SERVER_PAIRS; kind < SERVER_STATUS; kind++)
            sent += hostile_each(types[t], send_damage, &kind);
    assert_true(sent > 1000);
    assert_int_equal(service.count, 0);
    assert_int_equal(service_status()->malformed, sent);
    assert_int_equal(service.status.received, 0);
    service_query_pair(21, 1);
    service_settle();
    assert_int_equal(service.count, 1);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, service_open, service_close)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_query_gets_one_result),
        TEST(certificates_are_given_where_wanted),
        TEST(definitions_are_given),
        TEST(the_heartbeat_counts_the_work),
        TEST(quantiles_are_of_answered_queries),
        TEST(undecided_pairs_are_not_counted),
        TEST(ignored_pairs_are_not_counted),
        TEST(pairs_before_the_first_are_not_counted),
        TEST(another_service_is_reported),
        TEST(uptime_is_in_microseconds),
        TEST(results_that_the_bus_does_not_take_are_counted),
        TEST(heartbeats_are_due_each_second),
        TEST(what_is_too_long_is_refused),
        TEST(damage_is_counted),
    };
    return cmocka_run_group_tests_name("server", tests, NULL, NULL);
}
