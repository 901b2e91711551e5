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
    struct geometry geometry;
    struct handle handle;
};

struct world {
    struct record_bodies *bodies;
    struct hasher *hasher;
    int64_t now_ns, sequence_number;
    int requests;
    struct definition_query request; /* the last one */
    int definitions, defined;        /* messages and bodies that were written */
    size_t written;                  /* bytes of their events, on the longest channel */
    struct definitions *file;        /* what they define */
    unsigned char bytes[QUERY_BYTES_MAX];
};

static bool on_write(void *user, const void *bytes, size_t size)
{
    static struct definition definition;
    struct world *world = user;
    assert_null(wire_read_definition(bytes, (uint32_t) size, world->hasher, &definition));
    assert_int_equal(definition.client_id, 0);
    assert_int_equal(definition.server_id, 0);
    assert_null(definitions_add_message(world->file, bytes, (uint32_t) size));
    world->definitions++;
    world->written += (size_t) log_event_bytes(BUS_CHANNEL_MAX - 1, size);
    world->defined += definition.body_count;
    return true;
}

static int set_up(void **state)
{
    struct world *world = allocate(1, sizeof *world);
    world->bodies = record_bodies_open(RECORDER);
    world->hasher = hasher_create();
    world->file = definitions_open();
    world->now_ns = SECOND;
    *state = world;
    return 0;
}

static int tear_down(void **state)
{
    struct world *world = *state;
    record_bodies_close(world->bodies);
    hasher_destroy(world->hasher);
    definitions_close(world->file);
    free(world);
    return 0;
}

/* ---- Messages ---------------------------------------------------------------------------------
 */

static struct body make_body(struct world *world, double size)
{
    const struct geometry_frame frame = {.shape = FMB_CUBOID,
                                         .components = {size, 0, 0, 0, size, 0, 0, 0, size}};
    struct body body;
    const size_t bytes = geometry_write(3, &frame, body.bytes);
    body.geometry.size = bytes;
    body.handle = hasher_handle(world->hasher, body.bytes, bytes);
    return body;
}

static struct placement place_whole(const struct body *body)
{
    return (struct placement){.body_id = 1,
                              .dim = 3,
                              .frame_count = 1,
                              .number_count = 12,
                              .geometry = {body->bytes, body->geometry.size}};
}

static struct placement place_by_handle(const struct body *body)
{
    static unsigned char none[GEOMETRY_NONE_BYTES];
    geometry_write_none(3, none);
    return (struct placement){
        .body_id = 1, .handle = body->handle, .dim = 3, .geometry = {none, sizeof none}};
}

/* A message that the recorder receives: the definitions that it needs are written before it. */
static void receive(struct world *world, enum log_kind kind, size_t size)
{
    assert_null(record_bodies_take(world->bodies, kind, world->bytes, size));
    const int before = world->definitions;
    const size_t needed = record_bodies_needed(world->bodies);
    world->written = 0;
    assert_true(record_bodies_define(world->bodies, on_write, world));
    assert_int_equal(needed > 0, world->definitions > before);
    assert_true(world->written <= needed);
    assert_int_equal(record_bodies_needed(world->bodies), 0);
}

static void receive_query(struct world *world, struct placement a, struct placement b)
{
    const struct pair_query query = {.client_id = CLIENT,
                                     .sequence_number = ++world->sequence_number,
                                     .duration = 1,
                                     .placement = {a, b}};
    receive(world, LOG_PAIR_QUERY, wire_write_pair_query(&query, world->bytes));
}

/* The result of the last query. */
static void receive_result(struct world *world, enum fmb_status status)
{
    struct pair_result result = {.client_id = CLIENT,
                                 .sequence_number = world->sequence_number,
                                 .server_id = SERVER,
                                 .status = status};
    if (status == FMB_OK) {
        result.method = 1;
        result.answer.verdict = FMB_SEPARATED;
    }
    receive(world, LOG_PAIR_RESULT, wire_write_pair_result(&result, world->bytes));
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
        definition.body[i] =
            (struct query_body){body[i].handle, {body[i].bytes, body[i].geometry.size}};
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
    assert_int_equal(size > 0, due);
    if (size == 0)
        return;
    assert_null(wire_read_definition_query(bytes, (uint32_t) size, &world->request));
    world->request.client_id = RECORDER;
    world->requests++;
}

static void assert_file_defines(struct world *world, const struct body *body)
{
    assert_non_null(definitions_find(world->file, &body->handle));
}

/* Another file begins, which defines nothing yet. */
static void begin_file(struct world *world)
{
    definitions_close(world->file);
    world->file = definitions_open();
    record_bodies_begin_file(world->bodies);
}

/* The request at the start, and its answer: no bodies. */
static void begin(struct world *world)
{
    pass(world, 0);
    assert_int_equal(world->requests, 1);
    assert_int_equal(world->request.handle_count, 0);
    receive_definition(world, &world->request, NULL, 0, 0);
    assert_true(record_bodies_is_own(world->bodies));
}

/* ---- Tests ------------------------------------------------------------------------------------
 */

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
    /* They are written when a query names them. */
    assert_int_equal(world->definitions, 0);
    receive_query(world, place_by_handle(&body[0]), place_by_handle(&body[1]));
    assert_int_equal(world->definitions, 1);
    assert_int_equal(world->defined, 2);
    assert_file_defines(world, &body[0]);
    assert_file_defines(world, &body[1]);
    receive_query(world, place_by_handle(&body[0]), place_by_handle(&body[1]));
    assert_int_equal(world->definitions, 1);
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

static void bodies_of_answered_queries_are_requested(void **state)
{
    struct world *world = *state;
    const struct body a = make_body(world, 1), b = make_body(world, 2);
    begin(world);
    receive_query(world, place_by_handle(&a), place_by_handle(&b));
    pass(world, SECOND);
    assert_int_equal(world->requests, 1); /* it is not answered yet */
    receive_result(world, FMB_OK);
    pass(world, SECOND);
    assert_int_equal(world->requests, 2);
    assert_int_equal(world->request.handle_count, 2);
    assert_int_equal(record_bodies_counts(world->bodies).unresolved, 2);
    /* The answer has one: the file gets it at once, since a query in it names the body. */
    receive_definition(world, &world->request, &a, 1, 0);
    assert_true(record_bodies_is_own(world->bodies));
    assert_file_defines(world, &a);
    assert_int_equal(record_bodies_counts(world->bodies).unresolved, 1);
    /* The service does not hold the other one: it is not requested again. */
    receive_query(world, place_by_handle(&a), place_by_handle(&b));
    receive_result(world, FMB_OK);
    pass(world, SECOND);
    assert_int_equal(world->requests, 2);
    assert_int_equal(record_bodies_counts(world->bodies).unresolved, 1);
    /* A definition for another client resolves it too, and is in the file as it is. */
    const struct definition_query foreign = {.client_id = CLIENT};
    receive_definition(world, &foreign, &b, 1, 0);
    assert_false(record_bodies_is_own(world->bodies));
    assert_int_equal(record_bodies_counts(world->bodies).unresolved, 0);
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
    receive_result(world, FMB_OK);
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

/* Nothing is requested of a service that does not answer until it has answered a query. */
static void requests_without_a_result_are_repeated(void **state)
{
    struct world *world = *state;
    const struct body a = make_body(world, 1), b = make_body(world, 2);
    pass(world, 0);
    lose_request(world);
    receive_query(world, place_by_handle(&a), place_by_handle(&b));
    receive_result(world, FMB_OK);
    pass(world, SECOND);
    assert_int_equal(world->requests, 2);
    assert_int_equal(world->request.handle_count, 2);
    lose_request(world);
    pass(world, SECOND);
    assert_int_equal(world->requests, 2);
    receive_query(world, place_by_handle(&a), place_whole(&b));
    receive_result(world, FMB_OK);
    pass(world, SECOND);
    assert_int_equal(world->requests, 3);
    receive_definition(world, &world->request, &a, 1, 0);
    assert_int_equal(record_bodies_counts(world->bodies).unresolved, 0);
}

/* A method that cannot decide a pair had its bodies all the same. */
static void bodies_of_undecided_pairs_are_requested(void **state)
{
    struct world *world = *state;
    const struct body a = make_body(world, 1), b = make_body(world, 2);
    begin(world);
    receive_query(world, place_by_handle(&a), place_by_handle(&b));
    receive_result(world, FMB_CANNOT_DECIDE);
    pass(world, SECOND);
    assert_int_equal(world->request.handle_count, 2);
}

/* The newest queries without a result are kept, and each result is that of one of them. */
static void results_of_many_queries_are_kept(void **state)
{
    struct world *world = *state;
    enum { QUERIES = 300, RECENT = QUERIES - 40, FORGOTTEN = 10 };
    static const struct {
        int64_t number;
        int requests;
    } results[] = {{QUERIES + 1, 1}, {FORGOTTEN, 1}, {RECENT, 2}};
    const struct body whole = make_body(world, 1);
    begin(world);
    for (int i = 1; i <= QUERIES; i++) {
        const struct body body = make_body(world, 1 + i);
        receive_query(world, place_by_handle(&body), place_whole(&whole));
    }
    for (int i = 0; i < 3; i++) {
        world->sequence_number = results[i].number;
        receive_result(world, FMB_OK);
        pass(world, SECOND);
        assert_int_equal(world->requests, results[i].requests);
    }
    const struct body recent = make_body(world, 1 + RECENT);
    assert_int_equal(world->request.handle_count, 1);
    assert_true(handle_equal(&world->request.handle[0], &recent.handle));
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
        receive_result(world, FMB_OK);
    }
    while (record_bodies_due(world->bodies) != INT64_MAX) {
        pass(world, SECOND);
        requested += world->request.handle_count;
        receive_definition(world, &world->request, NULL, 0, 0);
    }
    assert_int_equal(requested, MOST);
    assert_int_equal(record_bodies_counts(world->bodies).unresolved, MOST + MORE);
}

static void refused_queries_need_no_bodies(void **state)
{
    struct world *world = *state;
    const struct body a = make_body(world, 1), b = make_body(world, 2);
    begin(world);
    receive_query(world, place_by_handle(&a), place_by_handle(&b));
    receive_result(world, FMB_UNKNOWN_BODY);
    pass(world, SECOND);
    assert_int_equal(world->requests, 1);
    assert_int_equal(record_bodies_counts(world->bodies).unresolved, 0);
}

/* More than fit into memory: those that are used stay. */
static void what_is_used_stays(void **state)
{
    struct world *world = *state;
    const struct body used = make_body(world, 1), once = make_body(world, 2);
    begin(world);
    receive_query(world, place_whole(&used), place_whole(&once));
    for (int i = 0; record_bodies_counts(world->bodies).dropped < 200000; i++) {
        const struct body a = make_body(world, 3 + 2 * i), b = make_body(world, 4 + 2 * i);
        receive_query(world, place_whole(&a), place_whole(&b));
        if (i % 1000 == 0)
            receive_query(world, place_by_handle(&used), place_whole(&a));
    }
    begin_file(world);
    receive_query(world, place_by_handle(&used), place_by_handle(&once));
    assert_file_defines(world, &used);
    assert_null(definitions_find(world->file, &once.handle));
}

/* A body of many boxes in 2D. */
struct large_body {
    struct geometry geometry;
    struct handle handle;
};

static struct large_body make_large(struct world *world, int number, int frames)
{
    static struct geometry_frame frame[1800];
    for (int i = 0; i < frames; i++)
        frame[i] =
            (struct geometry_frame){.shape = FMB_BOX, .origin = {number, i}, .components = {1, 1}};
    const size_t size = geometry_size(2, frame, frames);
    unsigned char *bytes = allocate(1, size);
    geometry_write_frames(2, frame, frames, bytes);
    return (struct large_body){{bytes, size}, hasher_handle(world->hasher, bytes, size)};
}

static void free_large(struct large_body *body, int count)
{
    for (int i = 0; i < count; i++)
        free((void *) (uintptr_t) body[i].geometry.bytes);
}

static struct placement place_large(const struct large_body *body, bool whole)
{
    static unsigned char none[GEOMETRY_NONE_BYTES];
    geometry_write_none(2, none);
    struct placement placement = {.body_id = 1, .dim = 2, .geometry = body->geometry};
    if (!whole) {
        placement.handle = body->handle;
        placement.geometry = (struct geometry){none, sizeof none};
    }
    return placement;
}

static void receive_scene(struct world *world, const struct placement *placement, int count)
{
    static struct scene_query query;
    query = (struct scene_query){.client_id = CLIENT, .placement_count = count};
    memcpy(query.placement, placement, (size_t) count * sizeof *placement);
    receive(world, LOG_SCENE_QUERY, wire_write_scene_query(&query, world->bytes));
}

/* Bodies that queries give whole, until one more of so many frames would fill half of the memory.
 * In: the half, of which `filled` are the bodies. Returns their number. */
static int give_large(struct world *world, struct definitions *filled, int frames, int number,
                      struct large_body *out)
{
    int count = 0;
    for (;; count++) {
        out[count] = make_large(world, number + count, frames);
        if (definitions_bytes(filled) + out[count].geometry.size + 1000 >= RECORD_BODIES_BYTES / 2)
            break;
        const struct placement placement = place_large(&out[count], true);
        definitions_add(filled, &out[count].geometry);
        receive_scene(world, &placement, 1);
    }
    free_large(&out[count], 1);
    return count;
}

/* One query names an old body, and then enough to fill half of the memory twice. */
static void what_a_query_names_stays_until_it_is_defined(void **state)
{
    struct world *world = *state;
    enum { MANY = 1800, SOME = 100, FEW = 30, BODIES_MAX = 700 };
    static struct large_body body[BODIES_MAX];
    static struct placement placement[BODIES_MAX];
    struct definitions *filled = definitions_open();
    begin(world);
    body[0] = make_large(world, 0, SOME);
    placement[0] = place_large(&body[0], true);
    receive_scene(world, placement, 1);
    definitions_add(filled, &body[0].geometry);
    int count = give_large(world, filled, MANY, 1, body + 1);
    free_large(body + 1, count);
    struct large_body last = make_large(world, 1 + count, MANY);
    placement[0] = place_large(&last, true);
    receive_scene(world, placement, 1);
    definitions_close(filled);

    filled = definitions_open();
    count = 1 + give_large(world, filled, MANY, 1000, body + 1);
    count += give_large(world, filled, FEW, 2000, body + count);
    struct large_body more = make_large(world, 3000, SOME);
    for (int i = 0; i < count; i++)
        placement[i] = place_large(&body[i], false);
    placement[count] = place_large(&more, true);
    receive_scene(world, placement, count + 1);
    for (int i = 0; i < count; i++)
        assert_non_null(definitions_find(world->file, &body[i].handle));
    free_large(body, count);
    free_large(&last, 1);
    free_large(&more, 1);
    definitions_close(filled);
}

static void unreadable_messages_are_counted(void **state)
{
    struct world *world = *state;
    for (int kind = 0; kind < LOG_OTHER; kind++)
        assert_non_null(record_bodies_take(world->bodies, (enum log_kind) kind, world->bytes, 10));
    assert_null(record_bodies_take(world->bodies, LOG_OTHER, world->bytes, 10));
    assert_int_equal(record_bodies_needed(world->bodies), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(all_are_requested_in_pages, set_up, tear_down),
        cmocka_unit_test_setup_teardown(each_file_defines_what_it_names, set_up, tear_down),
        cmocka_unit_test_setup_teardown(bodies_of_answered_queries_are_requested, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(handles_are_requested_in_pages, set_up, tear_down),
        cmocka_unit_test_setup_teardown(requests_without_a_result_are_repeated, set_up, tear_down),
        cmocka_unit_test_setup_teardown(bodies_of_undecided_pairs_are_requested, set_up, tear_down),
        cmocka_unit_test_setup_teardown(results_of_many_queries_are_kept, set_up, tear_down),
        cmocka_unit_test_setup_teardown(wanted_handles_are_limited, set_up, tear_down),
        cmocka_unit_test_setup_teardown(refused_queries_need_no_bodies, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_is_used_stays, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_a_query_names_stays_until_it_is_defined, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(unreadable_messages_are_counted, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
