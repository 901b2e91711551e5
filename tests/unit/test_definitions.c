/* The bodies of a log by handle: from queries and from definitions, each once. */
#include "unit.h"

#include "definitions.h"
#include "geometry_write.h"

#include "allocate.h"
#include "wire.h"

struct body {
    unsigned char bytes[GEOMETRY_FRAME_BYTES_MAX];
    struct body_view view;
};

struct world {
    struct definitions *definitions;
    unsigned char bytes[QUERY_BYTES_MAX];
};

static void make_body(struct world *world, double size, struct body *out)
{
    const struct plain_frame frame = {.shape = FMB_CUBOID,
                                      .components = {size, 0, 0, 0, size, 0, 0, 0, size}};
    out->view = geometry_write(3, &frame, out->bytes);
    out->view.handle = handle_of(out->bytes, out->view.size);
}

static struct query_placement place(const struct body *body)
{
    struct query_placement out = {.placed.id = 1, .body = body->view};
    memset(&out.body.handle, 0, sizeof out.body.handle);
    return out;
}

static void assert_found(struct world *world, const struct body *body)
{
    const struct body_view *found = definitions_find(world->definitions, &body->view.handle);
    assert_non_null(found);
    assert_int_equal(found->size, body->view.size);
    assert_memory_equal(found->bytes, body->bytes, found->size);
}

static int set_up(void **state)
{
    struct world *world = allocate(1, sizeof *world);
    world->definitions = definitions_open();
    *state = world;
    return 0;
}

static int tear_down(void **state)
{
    struct world *world = *state;
    definitions_close(world->definitions);
    free(world);
    return 0;
}

/* More than the first buckets of a table, every other one twice. */
static void many_bodies_are_defined(void **state)
{
    enum { COUNT = 3000 };
    struct world *world = *state;
    struct body body;
    for (int i = 0; i < COUNT; i++) {
        make_body(world, i + 1, &body);
        assert_null(definitions_find(world->definitions, &body.view.handle));
        definitions_add(world->definitions, &body.view);
        if (i % 2 == 0)
            definitions_add(world->definitions, &body.view);
        assert_found(world, &body);
    }
    const struct body_view *first, *again;
    make_body(world, 1, &body);
    first = definitions_find(world->definitions, &body.view.handle);
    definitions_add(world->definitions, &body.view);
    again = definitions_find(world->definitions, &body.view.handle);
    assert_ptr_equal(first, again);
    for (int i = 0; i < COUNT; i++) {
        make_body(world, i + 1, &body);
        assert_found(world, &body);
    }
}

static void bodies_of_a_pair_are_defined(void **state)
{
    struct world *world = *state;
    struct body whole, named;
    make_body(world, 1, &whole);
    make_body(world, 2, &named);
    const struct pair_query query = {
        .duration = 1,
        .placement = {place(&whole), {.body = geometry_named(3, &named.view.handle)}}};
    const uint32_t size = (uint32_t) wire_write_pair_query(&query, world->bytes);
    assert_null(
        definitions_add_message(world->definitions, NULL, LOG_PAIR_QUERY, world->bytes, size));
    assert_found(world, &whole);
    assert_null(definitions_find(world->definitions, &named.view.handle));
    static struct logged_query anonymous = {
        .kind = LOG_PAIR_QUERY, .placement = anonymous.pair.placement, .placement_count = 2};
    anonymous.pair.placement[0] = anonymous.pair.placement[1] = place(&named);
    anonymous.pair.placement[0].placed.id = anonymous.pair.placement[1].placed.id = 0;
    definitions_add_query(world->definitions, &anonymous);
    assert_null(definitions_find(world->definitions, &named.view.handle));
    assert_non_null(
        definitions_add_message(world->definitions, NULL, LOG_PAIR_QUERY, world->bytes, size - 1));
    assert_non_null(
        definitions_add_message(world->definitions, NULL, LOG_DEFINITION, world->bytes, size));
}

static void bodies_of_a_scene_are_defined(void **state)
{
    struct world *world = *state;
    struct scene_query *query = allocate(1, sizeof *query);
    struct body body[2];
    for (int i = 0; i < 2; i++) {
        make_body(world, i + 1, &body[i]);
        query->placement[i] = place(&body[i]);
    }
    query->placement_count = 2;
    query->which = FMB_PAIRS_ALL;
    const uint32_t size = (uint32_t) wire_write_scene_query(query, world->bytes);
    assert_null(
        definitions_add_message(world->definitions, NULL, LOG_SCENE_QUERY, world->bytes, size));
    assert_found(world, &body[0]);
    assert_found(world, &body[1]);
    free(query);
}

static void bodies_of_a_definition_are_defined(void **state)
{
    struct world *world = *state;
    struct definition *definition = allocate(1, sizeof *definition);
    struct body body;
    make_body(world, 1, &body);
    definition->body_count = 1;
    definition->body[0] = body.view;
    const uint32_t size = (uint32_t) wire_write_definition(definition, world->bytes);
    world->bytes[size - 1] ^= 1;
    assert_non_null(
        definitions_add_message(world->definitions, NULL, LOG_DEFINITION, world->bytes, size));
    assert_null(definitions_find(world->definitions, &body.view.handle));
    world->bytes[size - 1] ^= 1;
    assert_null(
        definitions_add_message(world->definitions, NULL, LOG_DEFINITION, world->bytes, size));
    assert_found(world, &body);
    free(definition);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(many_bodies_are_defined, set_up, tear_down),
        cmocka_unit_test_setup_teardown(bodies_of_a_pair_are_defined, set_up, tear_down),
        cmocka_unit_test_setup_teardown(bodies_of_a_scene_are_defined, set_up, tear_down),
        cmocka_unit_test_setup_teardown(bodies_of_a_definition_are_defined, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
