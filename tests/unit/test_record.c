/* The bodies of a recording: what is requested, and what each file defines. */
#include "unit.h"

#include "geometry_write.h"
#include "record_bodies.h"

#include "allocate.h"
#include "definitions.h"
#include "log_write.h"
#include "wire.h"

enum { SERVER = 5, CLIENT = 7, RECORDER = 9, SECOND = 1000000000 };

struct body {
    unsigned char bytes[GEOMETRY_FRAME_BYTES_MAX];
    struct body_view view;
};

struct world {
    struct record_bodies *bodies;
    int64_t now_ns;
    uint64_t sequence_number;
    int requests;
    struct definition_query request; /* the last one */
    int definitions, defined;        /* messages and bodies that were written */
    size_t written;                  /* bytes of their events, on the longest channel */
    struct definitions *file;        /* what they define */
    int names;                       /* written at the beginning of the file */
    struct names read_names;         /* points into name_bytes */
    unsigned char name_bytes[QUERY_BYTES_MAX];
    unsigned char bytes[QUERY_BYTES_MAX];
};

static bool on_write(void *user, enum log_kind kind, const void *bytes, size_t size)
{
    static struct definition definition;
    struct world *world = user;
    assert_null(wire_read_definition(bytes, (uint32_t) size, &definition));
    assert_int_equal(definition.client_id, 0);
    assert_int_equal(definition.server_id, 0);
    assert_null(definitions_add_message(world->file, NULL, LOG_DEFINITION, bytes, (uint32_t) size));
    world->definitions++;
    world->written += (size_t) log_event_bytes(BUS_CHANNEL_MAX - 1, size);
    world->defined += definition.body_count;
    return true;
}

static bool on_names(void *user, enum log_kind kind, const void *bytes, size_t size)
{
    struct world *world = user;
    memcpy(world->name_bytes, bytes, size);
    assert_null(wire_read_names(world->name_bytes, (uint32_t) size, &world->read_names));
    world->names += world->read_names.count;
    return true;
}

static int set_up(void **state)
{
    struct world *world = allocate(1, sizeof *world);
    world->bodies = record_bodies_open(RECORDER);
    world->file = definitions_open();
    world->now_ns = SECOND;
    *state = world;
    return 0;
}

static int tear_down(void **state)
{
    struct world *world = *state;
    record_bodies_close(world->bodies);
    definitions_close(world->file);
    free(world);
    return 0;
}

/* ---- Messages ---- */

static struct body make_body(struct world *world, double size)
{
    const struct plain_frame frame = {.shape = FMB_CUBOID,
                                      .components = {size, 0, 0, 0, size, 0, 0, 0, size}};
    struct body body;
    body.view = geometry_write(3, &frame, body.bytes);
    body.view.handle = handle_of(body.bytes, body.view.size);
    return body;
}

/* A struct body may be copied: its view points into it only here. */
static struct body_view view_of(const struct body *body)
{
    struct body_view view = body->view;
    view.bytes = body->bytes;
    return view;
}

static struct query_placement place_whole(const struct body *body)
{
    struct query_placement out = {.placed.id = 1, .body = view_of(body)};
    memset(&out.body.handle, 0, sizeof out.body.handle);
    return out;
}

static struct query_placement place_by_handle(const struct body *body)
{
    return (struct query_placement){.placed.id = 1, .body = geometry_named(3, &body->view.handle)};
}

/* A message that the recorder receives: the definitions that it needs are written before it. */
static void receive(struct world *world, enum log_kind kind, size_t size)
{
    assert_null(record_bodies_read(world->bodies, kind, world->bytes, size));
    const int before = world->definitions;
    const size_t needed = record_bodies_needed(world->bodies);
    const enum record_bodies_owner owner = record_bodies_owner(world->bodies);
    world->written = 0;
    assert_true(record_bodies_define(world->bodies, on_write, world));
    assert_int_equal(needed > 0, world->definitions > before);
    assert_true(world->written <= needed);
    assert_int_equal(record_bodies_needed(world->bodies), 0);
    if (owner == RECORD_OWN)
        return;
    if (kind == LOG_DEFINITION)
        definitions_add_message(world->file, NULL, kind, world->bytes, (uint32_t) size);
    record_bodies_keep(world->bodies);
}

static void receive_query(struct world *world, struct query_placement a, struct query_placement b)
{
    const struct pair_query query = {.client_id = CLIENT,
                                     .sequence_number = (int64_t) ++world->sequence_number,
                                     .duration = 1,
                                     .placement = {a, b}};
    receive(world, LOG_PAIR_QUERY, wire_write_pair_query(&query, world->bytes));
}

static void receive_definition(struct world *world, const struct definition_query *query,
                               const struct body *body, int count, int64_t next)
{
    static struct definition definition;
    definition = (struct definition){.client_id = query->client_id,
                                     .sequence_number = query->sequence_number,
                                     .server_id = SERVER,
                                     .next = next,
                                     .body_count = count};
    for (int i = 0; i < count; i++)
        definition.body[i] = view_of(&body[i]);
    const size_t size = wire_write_definition(&definition, world->bytes);
    receive(world, LOG_DEFINITION, size);
    if (query->client_id == RECORDER)
        record_bodies_take_result(
            world->bodies,
            &(struct fmb_client_raw_result){.status = FMB_OK, .bytes = world->bytes, .size = size});
}

static void lose_request(struct world *world)
{
    record_bodies_take_result(world->bodies,
                              &(struct fmb_client_raw_result){.status = FMB_CLIENT_NO_SERVICE});
}

static void pass(struct world *world, int64_t ns)
{
    unsigned char bytes[QUERY_BYTES_MAX];
    world->now_ns += ns;
    const bool due = record_bodies_due(world->bodies) <= world->now_ns;
    const size_t size = record_bodies_request(world->bodies, world->now_ns, bytes);
    assert_true(due || size == 0);
    assert_true(record_bodies_due(world->bodies) > world->now_ns);
    if (size == 0)
        return;
    assert_null(wire_read_definition_query(bytes, (uint32_t) size, &world->request));
    world->request.client_id = RECORDER;
    world->requests++;
}

static void assert_file_defines(struct world *world, const struct body *body)
{
    assert_non_null(definitions_find(world->file, &body->view.handle));
}

/* Another file begins, which defines nothing yet. */
static void begin_file(struct world *world)
{
    definitions_close(world->file);
    world->file = definitions_open();
    world->names = 0;
    assert_true(record_bodies_begin_file(world->bodies, 5, on_names, world));
}

/* The request at the start, and its answer: no bodies. */
static void begin(struct world *world)
{
    pass(world, 0);
    assert_int_equal(world->requests, 1);
    assert_int_equal(world->request.handle_count, 0);
    receive_definition(world, &world->request, NULL, 0, 0);
    assert_int_equal(record_bodies_owner(world->bodies), RECORD_OWN);
}

/* ---- Tests ---- */

static void all_are_requested_in_pages(void **state)
{
    struct world *world = *state;
    const struct body body[] = {make_body(world, 1), make_body(world, 2)};
    pass(world, 0);
    assert_int_equal(world->requests, 1);
    receive_definition(world, &world->request, &body[0], 1, 17);
    pass(world, SECOND / 200);
    assert_int_equal(world->requests, 1); /* not at full speed */
    pass(world, SECOND / 200);
    assert_int_equal(world->requests, 2);
    assert_int_equal(world->request.first, 17);
    pass(world, SECOND); /* one at a time */
    assert_int_equal(world->requests, 2);
    receive_definition(world, &world->request, &body[1], 1, 0);
    pass(world, SECOND);
    assert_int_equal(world->requests, 2);
    /* The file has the results as they are, and needs no other definitions. */
    assert_file_defines(world, &body[0]);
    assert_file_defines(world, &body[1]);
    assert_int_equal(record_bodies_counts(world->bodies).defined, 2);
    receive_query(world, place_by_handle(&body[0]), place_by_handle(&body[1]));
    assert_int_equal(world->definitions, 0);
    begin_file(world);
    receive_query(world, place_by_handle(&body[0]), place_by_handle(&body[1]));
    receive_query(world, place_by_handle(&body[0]), place_by_handle(&body[1]));
    assert_int_equal(world->definitions, 2);
    assert_int_equal(world->defined, 2);
    assert_file_defines(world, &body[0]);
    assert_file_defines(world, &body[1]);
}

static void each_file_defines_what_it_names(void **state)
{
    struct world *world = *state;
    const struct body whole = make_body(world, 1), other = make_body(world, 2);
    begin(world);
    receive_query(world, place_whole(&whole), place_whole(&other));
    for (int file = 0; file < 3; file++) {
        begin_file(world);
        receive_query(world, place_by_handle(&whole), place_whole(&other));
        assert_file_defines(world, &whole);
        assert_int_equal(world->definitions, file + 1);
    }
    assert_int_equal(record_bodies_counts(world->bodies).defined, 3);
    assert_int_equal(record_bodies_counts(world->bodies).unresolved, 0);
}

static void bodies_of_queries_are_requested(void **state)
{
    struct world *world = *state;
    const struct body a = make_body(world, 1), b = make_body(world, 2);
    begin(world);
    receive_query(world, place_by_handle(&a), place_by_handle(&b));
    pass(world, SECOND);
    assert_int_equal(world->requests, 2);
    assert_int_equal(world->request.handle_count, 2);
    assert_int_equal(record_bodies_counts(world->bodies).unresolved, 2);
    /* The answer has one: the file gets it at once, since a query in it names the body. */
    receive_definition(world, &world->request, &a, 1, 0);
    assert_int_equal(record_bodies_owner(world->bodies), RECORD_BODIES);
    assert_file_defines(world, &a);
    assert_int_equal(record_bodies_counts(world->bodies).unresolved, 1);
    /* The service does not hold the other one: it is not requested again. */
    receive_query(world, place_by_handle(&a), place_by_handle(&b));
    pass(world, SECOND);
    assert_int_equal(world->requests, 2);
    assert_int_equal(record_bodies_counts(world->bodies).unresolved, 1);
    /* A definition for another client resolves it too, and is in the file as it is. */
    const struct definition_query foreign = {.client_id = CLIENT};
    receive_definition(world, &foreign, &b, 1, 0);
    assert_int_equal(record_bodies_owner(world->bodies), RECORD_OTHERS);
    assert_int_equal(record_bodies_counts(world->bodies).unresolved, 0);
    assert_int_equal(record_bodies_counts(world->bodies).defined, 1);
    const int before = world->definitions;
    receive_query(world, place_by_handle(&a), place_by_handle(&b));
    assert_int_equal(world->definitions, before);
}

/* A definition of all handles takes several pages. */
static void handles_are_requested_in_pages(void **state)
{
    struct world *world = *state;
    const struct body body[] = {make_body(world, 1), make_body(world, 2)};
    begin(world);
    receive_query(world, place_by_handle(&body[0]), place_by_handle(&body[1]));
    pass(world, SECOND);
    receive_definition(world, &world->request, &body[0], 1, 1);
    pass(world, SECOND);
    assert_int_equal(world->requests, 3);
    assert_int_equal(world->request.first, 1);
    assert_int_equal(world->request.handle_count, 2);
    receive_definition(world, &world->request, &body[1], 1, 0);
    pass(world, SECOND);
    assert_int_equal(world->requests, 3);
    assert_int_equal(record_bodies_counts(world->bodies).unresolved, 0);
}

/* A service that does not answer gets a request for each query, not for each interval. */
static void requests_without_a_result_are_repeated(void **state)
{
    struct world *world = *state;
    const struct body a = make_body(world, 1), b = make_body(world, 2);
    pass(world, 0);
    lose_request(world);
    receive_query(world, place_by_handle(&a), place_by_handle(&b));
    pass(world, SECOND);
    assert_int_equal(world->requests, 2);
    assert_int_equal(world->request.handle_count, 2);
    lose_request(world);
    pass(world, SECOND);
    assert_int_equal(world->requests, 2);
    receive_query(world, place_by_handle(&a), place_whole(&b));
    pass(world, SECOND);
    assert_int_equal(world->requests, 3);
    assert_int_equal(world->request.handle_count, 1);
    receive_definition(world, &world->request, &a, 1, 0);
    assert_int_equal(record_bodies_counts(world->bodies).unresolved, 0);
}

/* A body that a query carries whole before its request is sent is not requested. */
static void bodies_that_come_whole_are_not_requested(void **state)
{
    struct world *world = *state;
    const struct body a = make_body(world, 1), b = make_body(world, 2);
    begin(world);
    receive_query(world, place_by_handle(&a), place_by_handle(&b));
    receive_query(world, place_whole(&a), place_whole(&b));
    pass(world, SECOND);
    assert_int_equal(world->requests, 1);
    assert_int_equal(record_bodies_counts(world->bodies).unresolved, 0);
}

/* Handles that no service knows do not fill the memory: at most 65,536 are requested. */
static void wanted_handles_are_limited(void **state)
{
    struct world *world = *state;
    enum { MOST = 1 << 16, MORE = 20 };
    int requested = 0;
    begin(world);
    for (int i = 0; i < MOST + MORE; i += 2) {
        const struct body a = make_body(world, 1 + i), b = make_body(world, 2 + i);
        receive_query(world, place_by_handle(&a), place_by_handle(&b));
    }
    while (record_bodies_due(world->bodies) != INT64_MAX) {
        pass(world, SECOND);
        requested += world->request.handle_count;
        receive_definition(world, &world->request, NULL, 0, 0);
    }
    assert_int_equal(requested, MOST);
    assert_int_equal(record_bodies_counts(world->bodies).unresolved, MOST + MORE);
}

/* More than fit into memory: all are dropped, and those that are used are requested again. A body
 * that was wanted before stays unresolved. */
static void dropped_bodies_are_requested_again(void **state)
{
    struct world *world = *state;
    const struct body used = make_body(world, 1), wanted = make_body(world, 2);
    begin(world);
    receive_query(world, place_whole(&used), place_by_handle(&wanted));
    for (int i = 0; record_bodies_counts(world->bodies).dropped == 0; i++) {
        const struct body a = make_body(world, 3 + 2 * i), b = make_body(world, 4 + 2 * i);
        receive_query(world, place_whole(&a), place_whole(&b));
    }
    assert_true(record_bodies_counts(world->bodies).dropped > 190000);
    receive_query(world, place_by_handle(&used), place_by_handle(&used));
    pass(world, SECOND);
    assert_int_equal(world->request.handle_count, 1);
    receive_definition(world, &world->request, &used, 1, 0);
    assert_file_defines(world, &used);
    assert_int_equal(record_bodies_counts(world->bodies).unresolved, 1);
}

/* ---- Names ---- */

static void each_file_has_the_names(void **state)
{
    struct world *world = *state;
    const struct body body = make_body(world, 1);
    struct query_placement first = place_whole(&body), second = place_whole(&body);
    begin(world);
    begin_file(world);
    assert_int_equal(world->names, 0);
    first.placed.name = "table";
    second.placed.id = 2;
    receive_query(world, first, second);
    for (int file = 0; file < 2; file++) {
        begin_file(world);
        assert_int_equal(world->names, 1);
        assert_int_equal(world->read_names.utime, 5);
        assert_int_equal(world->read_names.client_id[0], CLIENT);
        assert_int_equal(world->read_names.body_id[0], 1);
        assert_string_equal(world->read_names.name[0], "table");
    }
    /* The last name counts; a query without one changes none. */
    first.placed.name = "desk";
    second.placed.name = "\xff\n";
    receive_query(world, first, second);
    receive_query(world, place_whole(&body), place_by_handle(&body));
    begin_file(world);
    assert_int_equal(world->names, 2);
    assert_string_equal(world->read_names.name[0], "desk");
    assert_string_equal(world->read_names.name[1], "\xff\n");
}

/* ---- Sequence numbers ---- */

static void skipped_sequence_numbers_are_counted(void **state)
{
    struct world *world = *state;
    const struct body body = make_body(world, 1);
    static const struct {
        int64_t number, skipped;
    } steps[] = {{10, 0},        {11, 0},      {11, 0},      {14, 2}, {13, 2},
                 {15, 2},        {1000000, 2}, {1000001, 2}, {5, 2},  {INT64_MIN, 2},
                 {INT64_MAX, 2}, {1, 2},       {3, 3}};
    for (size_t i = 0; i < COUNT(steps); i++) {
        world->sequence_number = (uint64_t) steps[i].number - 1;
        receive_query(world, place_whole(&body), place_whole(&body));
        assert_int_equal(record_bodies_counts(world->bodies).skipped, steps[i].skipped);
    }
}

static void unreadable_messages_are_counted(void **state)
{
    struct world *world = *state;
    for (int kind = 0; kind < LOG_OTHER; kind++)
        assert_non_null(record_bodies_read(world->bodies, (enum log_kind) kind, world->bytes, 10));
    assert_null(record_bodies_read(world->bodies, LOG_OTHER, world->bytes, 10));
    record_bodies_keep(world->bodies);
    assert_int_equal(record_bodies_needed(world->bodies), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(all_are_requested_in_pages, set_up, tear_down),
        cmocka_unit_test_setup_teardown(each_file_defines_what_it_names, set_up, tear_down),
        cmocka_unit_test_setup_teardown(bodies_of_queries_are_requested, set_up, tear_down),
        cmocka_unit_test_setup_teardown(handles_are_requested_in_pages, set_up, tear_down),
        cmocka_unit_test_setup_teardown(requests_without_a_result_are_repeated, set_up, tear_down),
        cmocka_unit_test_setup_teardown(bodies_that_come_whole_are_not_requested, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(wanted_handles_are_limited, set_up, tear_down),
        cmocka_unit_test_setup_teardown(dropped_bodies_are_requested_again, set_up, tear_down),
        cmocka_unit_test_setup_teardown(each_file_has_the_names, set_up, tear_down),
        cmocka_unit_test_setup_teardown(skipped_sequence_numbers_are_counted, set_up, tear_down),
        cmocka_unit_test_setup_teardown(unreadable_messages_are_counted, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
