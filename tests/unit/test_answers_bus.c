/* fmb query on the bus, where no service answers. */
#include "unit.h"

#include "answers.h"
#include "relay.h"
#include "wire.h"

static void send_heartbeat(struct relay *relay)
{
    const struct wire_status status = {.server_id = 1};
    unsigned char bytes[WIRE_STATUS_BYTES_MAX];
    relay_publish(relay, WIRE_STATUS, bytes, wire_write_status(&status, bytes));
}

static void count(void *user, const struct fmb_client_answer *answer)
{
    assert_int_not_equal(answer->status, FMB_OK);
    ++*(int *) user;
}

/* A service that sends heartbeats, even if it does not answer in time, is queried for later scenes.
 */
static void later_scenes_are_queried_if_there_is_a_heartbeat(void **state)
{
    for (int alive = 0; alive < 2; alive++) {
        int pairs = 0;
        const double size[] = {1, 1, 1};
        struct fmb_body body;
        assert_int_equal(fmb_body_make(3, FMB_BOX, size, 3, &body), FMB_OK);
        const struct fmb_placement placement[] = {{.body = &body, .id = 1},
                                                  {.body = &body, .id = 2}};
        struct owned_scene scene = {
            .dim = 3, .scene = {.placements = placement, .placement_count = 2, .duration = 1}};
        struct relay *relay = relay_new();
        relay->deaf = true;
        relay->before = alive ? send_heartbeat : NULL;
        relay_open(relay, 10);
        const struct args_bus bus = {.url = relay->url, .prefix = ""};
        struct answers_bus *answers = answers_bus_open(&bus, 0.1, 0);
        assert_int_equal(answers_bus_scene(answers, &scene, count, &pairs), alive);
        assert_int_equal(pairs, 1);
        answers_bus_close(answers);
        relay_close(relay);
    }
}

/* Pairs with a certificate and pairs without one, of a body of several frames, are separate
 * queries. The others are not sent, because nothing answers the first ones, and have no verdict. */
static void all_pairs_fail_where_certificates_are_wanted_and_nothing_answers(void **state)
{
    int pairs = 0;
    const double size[] = {1, 1, 1};
    struct fmb_frame frame[2];
    struct fmb_body one, two;
    for (int i = 0; i < 2; i++)
        assert_int_equal(fmb_frame_make(3, FMB_BOX, size, 3, &frame[i]), FMB_OK);
    assert_int_equal(fmb_body_make_frames(frame, 1, &one), FMB_OK);
    assert_int_equal(fmb_body_make_frames(frame, 2, &two), FMB_OK);
    const struct fmb_placement placement[] = {
        {.body = &one, .id = 1}, {.body = &one, .id = 2}, {.body = &two, .id = 3}};
    struct owned_scene scene = {.dim = 3,
                                .scene = {.placements = placement,
                                          .placement_count = 3,
                                          .duration = 1,
                                          .want = FMB_WANT_CERTIFICATE}};
    size_t queries[2], bytes[2];
    for (int both = 0; both < 2; both++) {
        struct relay *relay = relay_new();
        relay->deaf = true;
        relay_open(relay, 10);
        const struct args_bus bus = {.url = relay->url, .prefix = ""};
        struct answers_bus *answers = answers_bus_open(&bus, 0.1, 0);
        scene.scene.placement_count = both ? 3 : 2;
        pairs = 0;
        assert_false(answers_bus_scene(answers, &scene, count, &pairs));
        assert_int_equal(pairs, both ? 3 : 1);
        queries[both] = (size_t) relay->queries;
        bytes[both] = relay->bytes;
        answers_bus_close(answers);
        relay_close(relay);
    }
    /* However often it was repeated, it is one query. */
    assert_true(queries[0] > 0 && queries[1] > 0);
    assert_int_equal(bytes[0] * queries[1], bytes[1] * queries[0]);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(later_scenes_are_queried_if_there_is_a_heartbeat),
        cmocka_unit_test(all_pairs_fail_where_certificates_are_wanted_and_nothing_answers),
    };
    (void) argc;
    relay_enter(argv);
    return cmocka_run_group_tests_name("answers_bus", tests, NULL, NULL);
}
