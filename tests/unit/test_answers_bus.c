/* fmb query on the bus, where no service answers. */
#include "unit.h"

#include "allocate.h"
#include "answers.h"
#include "relay.h"
#include "wire.h"

static void send_heartbeat(struct relay *relay)
{
    const struct wire_status status = {.server_id = 1};
    unsigned char bytes[WIRE_STATUS_BYTES_MAX];
    relay_publish(relay, WIRE_STATUS, bytes, wire_write_status(&status, bytes));
}

static void count(void *user, const struct scene *scene, const struct outcome *outcome)
{
    (void) scene;
    assert_non_null(outcome->error);
    ++*(int *) user;
}

/* A service that sends heartbeats, even if it does not answer in time, is queried for later scenes.
 */
static void later_scenes_are_queried_if_there_is_a_heartbeat(void **state)
{
    for (int alive = 0; alive < 2; alive++) {
        int pairs = 0;
        struct scene_body body[2] = {{.id = 1}, {.id = 2}};
        for (int i = 0; i < 2; i++) {
            size_t bad;
            body[i].given = allocate(1, sizeof *body[i].given);
            *body[i].given = (struct geometry_frame){.shape = FMB_BOX, .components = {1, 1, 1}};
            assert_int_equal(scene_body_make(3, 1, &body[i], &bad), FMB_OK);
        }
        const struct scene scene = {
            .dim = 3, .duration = 1, .body = body, .body_count = 2, .all_pairs = true};
        const struct answers_options options = {.method = NULL};
        struct relay *relay = relay_new();
        relay->deaf = true;
        relay->before = alive ? send_heartbeat : NULL;
        relay_open(relay, 10);
        const struct args_bus bus = {.url = relay->url, .prefix = ""};
        struct answers_bus *answers = answers_bus_open(&bus, &options, 0.1, 0);
        assert_int_equal(answers_bus_scene(answers, &scene, count, &pairs), alive);
        assert_int_equal(pairs, 1);
        answers_bus_close(answers);
        relay_close(relay);
        for (int i = 0; i < 2; i++)
            scene_body_clear(&body[i]);
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(later_scenes_are_queried_if_there_is_a_heartbeat),
    };
    (void) argc;
    relay_enter(argv);
    return cmocka_run_group_tests_name("answers_bus", tests, NULL, NULL);
}
