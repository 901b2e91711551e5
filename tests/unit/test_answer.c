/* What a pair query gets: the right answer, or the status that says what is wrong and where. */
#include "answer.h"
#include "big_endian.h"
#include "scene_truth.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static struct answerer *answerer;

static int set_up_frames(size_t frames)
{
    const struct answerer_options options = {frames, .server_id = 99,
                                             .secret = {0x243f6a8885a308d3, 0x13198a2e03707344}};
    answerer = answerer_create(&options);
    return answerer ? 0 : -1;
}

static int set_up(void **state)
{
    (void) state;
    return set_up_frames(2);
}

static int set_up_one(void **state)
{
    (void) state;
    return set_up_frames(1);
}

static int tear_down(void **state)
{
    (void) state;
    answerer_destroy(answerer);
    return 0;
}

static struct cache_counts counts(void)
{
    return cache_counts(answerer_cache(answerer));
}

/* Where the geometries of the query are: several frames fit. */
static unsigned char bytes[2][1000];

static const struct solid unit_cube = {
    .dim = 3, .shape = FMB_CUBOID, .component = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

static void set(struct pair_query *query, int f, const struct solid *solid)
{
    scene_set_placement(solid, f + 1, bytes[f], &query->placement[f]);
}

/* Two unit cubes, bodies 1 and 2, the second moved by half an edge. */
static struct pair_query cubes(void)
{
    struct pair_query query = {.utime = 3, .client_id = 4, .sequence_number = 5, .duration = 1};
    struct solid cube = unit_cube;
    set(&query, 0, &cube);
    cube.origin[0] = 0.5;
    set(&query, 1, &cube);
    return query;
}

/* The same with another second body. */
static struct pair_query stretched(double length)
{
    struct pair_query query = cubes();
    struct solid cuboid = unit_cube;
    cuboid.component[0][0] = length;
    cuboid.origin[0] = 0.5;
    set(&query, 1, &cuboid);
    return query;
}

/* Number k of the geometry of one frame. */
static void put_number(int f, int k, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    big_endian_put_64(bytes[f] + 4 + 4 + 1 + 4 + 8 * k, bits);
}

/* A geometry of any counts, all numbers 0. */
static void set_geometry(struct pair_query *query, int f, int32_t dim, int32_t frames, int shape,
                         int32_t numbers)
{
    unsigned char *at = bytes[f];
    struct placement *placement = &query->placement[f];
    memset(at, 0, sizeof bytes[f]);
    big_endian_put_32(at, (uint32_t) dim);
    big_endian_put_32(at + 4, (uint32_t) frames);
    memset(at + 8, shape, (size_t) frames);
    big_endian_put_32(at + 8 + frames, (uint32_t) numbers);
    placement->dim = dim;
    placement->frame_count = frames;
    placement->number_count = numbers;
    placement->geometry = (struct geometry){at, (size_t) (12 + frames + 8 * numbers)};
}

static struct pair_result answer_to(const struct pair_query *query)
{
    struct pair_result result;
    answer_pair(answerer, query, &result);
    return result;
}

/* A refusal, which leaves the cache as it was. */
static void expect(const struct pair_query *query, enum fmb_status status, const char *detail)
{
    const struct cache_counts before = counts();
    struct pair_result result = answer_to(query);
    const struct cache_counts after = counts();
    assert_string_equal(result.detail, detail);
    assert_int_equal(result.status, status);
    assert_int_equal(result.answer.verdict, 0);
    assert_int_equal(result.method, 0);
    assert_int_equal(result.client_id, query->client_id);
    assert_int_equal(result.sequence_number, query->sequence_number);
    assert_int_equal(result.utime, query->utime);
    assert_int_equal(result.server_id, 99);
    assert_true(handle_is_none(&result.handle[0]) && handle_is_none(&result.handle[1]));
    assert_int_equal(after.bodies, before.bodies);
    assert_int_equal(after.ids, before.ids);
    assert_int_equal(after.misses, before.misses);
    assert_int_equal(after.evictions, before.evictions);
}

static void test_answer_and_echo(void **state)
{
    (void) state;
    struct hasher *hasher = hasher_create();
    struct pair_query query = cubes();
    query.want = QUERY_WANT_BOX;
    struct pair_result result = answer_to(&query);
    assert_int_equal(result.status, FMB_OK);
    assert_string_equal(result.detail, "");
    assert_int_equal(result.utime, 3);
    assert_int_equal(result.client_id, 4);
    assert_int_equal(result.sequence_number, 5);
    assert_int_equal(result.server_id, 99);
    assert_int_equal(result.body_id[0], 1);
    assert_int_equal(result.body_id[1], 2);
    for (int f = 0; f < 2; f++) {
        const struct geometry *geometry = &query.placement[f].geometry;
        const struct handle handle = hasher_handle(hasher, geometry->bytes, geometry->size);
        assert_true(handle_equal(&result.handle[f], &handle));
    }
    assert_int_equal(result.method, fmb_method_default()->number);
    assert_int_equal(result.answer.verdict, FMB_OVERLAPPING);
    assert_false(result.answer.has_contact);
    assert_int_equal(result.dim, 3);
    assert_true(result.answer.box[0][0] == 0.5 && result.answer.box[1][0] == 1);
    assert_int_equal(counts().bodies, 1); /* both have one geometry */
    hasher_destroy(hasher);
}

/* Also without an id, or with another one. */
static void test_handles_stand_for_frames(void **state)
{
    (void) state;
    struct pair_query query = stretched(2);
    const struct pair_result first = answer_to(&query);
    for (int64_t id = 0; id < 5; id++) {
        for (int f = 0; f < 2; f++) {
            query.placement[f].body_id = id;
            scene_name(&query.placement[f], &first.handle[f]);
        }
        query.placement[1].position[0] = 1;
        const struct pair_result result = answer_to(&query);
        assert_int_equal(result.status, FMB_OK);
        assert_int_equal(result.answer.verdict, FMB_TOUCHING);
        assert_int_equal(result.body_id[0], id);
        assert_true(handle_is_none(&result.handle[0]) && handle_is_none(&result.handle[1]));
    }
    assert_int_equal(counts().hits, 10);
}

static void test_handles_that_are_not_held(void **state)
{
    (void) state;
    struct pair_query query = stretched(2);
    struct handle handle = answer_to(&query).handle[1];
    handle.bytes[15] ^= 1;
    query = stretched(7); /* would be kept */
    scene_name(&query.placement[0], &handle);
    expect(&query, FMB_UNKNOWN_BODY, "a.handle: not held; send the frames");
    query = cubes();
    put_number(0, 3, 7);
    scene_name(&query.placement[1], &handle);
    expect(&query, FMB_UNKNOWN_BODY, "b.handle: not held; send the frames");
}

static void test_handle_of_the_other_dimension(void **state)
{
    (void) state;
    const struct solid square = {.dim = 2, .shape = FMB_CUBOID, .component = {{1, 0}, {0, 1}}};
    struct pair_query query = cubes();
    const struct handle handle = answer_to(&query).handle[0];
    for (int f = 0; f < 2; f++)
        set(&query, f, &square);
    scene_name(&query.placement[1], &handle);
    expect(&query, FMB_WRONG_DIMENSION, "b.dim: not that of the body with this handle");
}

/* With capacity for two: keeping a third body evicts the one not used longest. */
static void test_eviction(void **state)
{
    (void) state;
    struct pair_query query = stretched(2);
    const struct pair_result first = answer_to(&query);
    query = stretched(3);
    answer_to(&query);
    scene_name(&query.placement[0], &first.handle[0]);
    assert_int_equal(answer_to(&query).status, FMB_OK);
    scene_name(&query.placement[1], &first.handle[1]);
    expect(&query, FMB_UNKNOWN_BODY, "b.handle: not held; send the frames");
}

/* With capacity for one: each of the two bodies evicts the other, whole or by handle. */
static void test_capacity_for_one(void **state)
{
    (void) state;
    struct pair_query query = stretched(2);
    query.want = QUERY_WANT_BOX;
    const struct pair_result first = answer_to(&query);
    for (int f = 0; f < 2; f++) {
        assert_int_equal(first.status, FMB_OK);
        query = stretched(2);
        query.want = QUERY_WANT_BOX;
        if (f == 1) /* the second body is held */
            scene_name(&query.placement[1], &first.handle[1]);
        const struct pair_result result = answer_to(&query);
        assert_memory_equal(&result.answer, &first.answer, sizeof result.answer);
    }
    query = stretched(2);
    scene_name(&query.placement[0], &first.handle[0]);
    assert_int_equal(answer_to(&query).status, FMB_OK);
    assert_int_equal(counts().bodies, 1);
}

/* One id with two geometries in one pair: each placement is what it says. */
static void test_one_id_two_bodies(void **state)
{
    (void) state;
    struct pair_query query = stretched(2);
    query.placement[0].body_id = query.placement[1].body_id = 9;
    for (int repeat = 0; repeat < 3; repeat++) {
        query.placement[0].position[0] = repeat;
        const struct pair_result result = answer_to(&query);
        assert_int_equal(result.answer.verdict, FMB_OVERLAPPING);
        assert_false(handle_equal(&result.handle[0], &result.handle[1]));
    }
    query.placement[0].position[0] = 2.75; /* beyond the second, were it a cube */
    assert_int_equal(answer_to(&query).answer.verdict, FMB_SEPARATED);
    assert_int_equal(counts().misses, 2);
}

static void test_anonymous_bodies_are_not_kept(void **state)
{
    (void) state;
    struct pair_query query = cubes();
    query.placement[0].body_id = query.placement[1].body_id = 0;
    const struct pair_result result = answer_to(&query);
    assert_int_equal(result.status, FMB_OK);
    assert_true(handle_is_none(&result.handle[0]) && handle_is_none(&result.handle[1]));
    assert_int_equal(counts().bodies, 0);
    assert_int_equal(counts().misses, 0);
}

static void test_bad_numbers(void **state)
{
    (void) state;
    struct pair_query query = cubes();
    put_number(1, 4, NAN);
    expect(&query, FMB_NOT_FINITE, "b.numbers[4]: not a finite number");
    query = cubes();
    put_number(0, 0, INFINITY);
    expect(&query, FMB_NOT_FINITE, "a.numbers[0]: not a finite number");
    query = cubes();
    query.placement[0].position[2] = -INFINITY;
    expect(&query, FMB_NOT_FINITE, "a.position[2]: not a finite number");
    query = cubes();
    query.placement[0].velocity_count = 3;
    query.placement[0].velocity[1] = INFINITY;
    expect(&query, FMB_NOT_FINITE, "a.velocity[1]: not a finite number");
}

static void test_bad_counts(void **state)
{
    (void) state;
    struct pair_query query = cubes();
    set_geometry(&query, 0, 3, 1, FMB_CUBOID, 9);
    expect(&query, FMB_WRONG_COUNT, "a.num_numbers: expected 12 numbers, found 9");
    query = cubes();
    set_geometry(&query, 1, 3, 1, FMB_FACE, 12);
    expect(&query, FMB_WRONG_COUNT, "b.num_numbers: expected 9 numbers, found 12");
    query = cubes();
    set_geometry(&query, 1, 3, 2, FMB_TETRAHEDRON, 12);
    expect(&query, FMB_WRONG_COUNT, "b.num_numbers: expected 24 numbers, found 12");
    query = cubes();
    set_geometry(&query, 1, 3, 1, 4, 12);
    expect(&query, FMB_WRONG_COUNT, "b.num_numbers: expected 6 numbers, found 12");
    query = cubes();
    query.placement[1].velocity_count = 2;
    expect(&query, FMB_WRONG_COUNT, "b.num_velocity: expected 3 numbers, found 2");
    query = cubes();
    query.placement[0].orientation_count = 3;
    expect(&query, FMB_WRONG_COUNT, "a.num_orientation: expected 4 numbers, found 3");
}

static void test_handle_or_frames(void **state)
{
    (void) state;
    const struct handle handle = {{1}};
    struct pair_query query = cubes();
    query.placement[0].handle = handle;
    expect(&query, FMB_WRONG_COUNT, "a.num_frames: both a handle and frames");
    query = cubes();
    set_geometry(&query, 1, 3, 0, 0, 2);
    query.placement[1].handle = handle;
    expect(&query, FMB_WRONG_COUNT, "b.num_numbers: expected 0 numbers, found 2");
    query = cubes();
    set_geometry(&query, 1, 3, 0, 0, 0);
    expect(&query, FMB_NO_FRAMES, "b.num_frames: neither a handle nor frames");
    set_geometry(&query, 1, 3, 0, 0, 12);
    expect(&query, FMB_NO_FRAMES, "b.num_frames: neither a handle nor frames");
    query = cubes();
    query.placement[0].frame_count = 65537;
    expect(&query, FMB_OVER_LIMIT, "a.num_frames: more than 65536");
}

static void test_bad_shapes_and_dimensions(void **state)
{
    (void) state;
    for (int shape = 0; shape < 256; shape++) {
        if (shape >= FMB_CUBOID && shape <= 4)
            continue;
        struct pair_query query = cubes();
        bytes[0][8] = (unsigned char) shape;
        expect(&query, FMB_UNKNOWN_SHAPE, "a.shapes[0]: unknown shape");
    }
    struct pair_query query = cubes();
    set_geometry(&query, 1, 3, 3, FMB_CUBOID, 36);
    bytes[1][8 + 2] = 9;
    expect(&query, FMB_UNKNOWN_SHAPE, "b.shapes[2]: unknown shape");
    static const int32_t dims[] = {0, 1, 4, INT32_MAX};
    for (int i = 0; i < 4; i++) {
        query = cubes();
        query.placement[0].dim = dims[i];
        expect(&query, FMB_WRONG_DIMENSION, "a.dim: neither 2 nor 3");
    }
    query = cubes();
    set_geometry(&query, 0, 2, 1, FMB_FACE, 6);
    expect(&query, FMB_WRONG_DIMENSION, "a.dim: a face is in 3D");
    query = cubes();
    set_geometry(&query, 0, 2, 1, FMB_CUBOID, 6);
    expect(&query, FMB_DIMENSIONS_DIFFER, "dim: a 2D frame against a 3D one");
}

/* What later versions support. What is wrong besides comes first. */
static void test_not_supported(void **state)
{
    (void) state;
    struct pair_query query = cubes();
    set_geometry(&query, 1, 3, 2, FMB_CUBOID, 24);
    expect(&query, FMB_NOT_SUPPORTED, "b.num_frames: one frame a body in this version");
    query.placement[1].position[0] = NAN;
    expect(&query, FMB_NOT_FINITE, "b.position[0]: not a finite number");
    query = cubes();
    set_geometry(&query, 0, 3, 1, 4, 6);
    expect(&query, FMB_NOT_SUPPORTED, "a.shapes[0]: a box is not in this version");
    for (int axis = 0; axis < 3; axis++) {
        static const char *const details[] = {"a.numbers[0]: the origin is 0 in this version",
                                              "a.numbers[1]: the origin is 0 in this version",
                                              "a.numbers[2]: the origin is 0 in this version"};
        query = cubes();
        put_number(0, axis, -0x1p-1074);
        expect(&query, FMB_NOT_SUPPORTED, details[axis]);
    }
    query = cubes();
    put_number(0, 1, -0.0);
    assert_int_equal(answer_to(&query).status, FMB_OK);
    query = cubes();
    query.placement[1].orientation_count = 4;
    expect(&query, FMB_NOT_SUPPORTED, "b.orientation: not in this version");
    query = cubes();
    scene_name(&query.placement[1], &(struct handle){{1}});
    query.placement[1].orientation_count = 4;
    expect(&query, FMB_NOT_SUPPORTED, "b.orientation: not in this version");
}

static void test_bad_ids(void **state)
{
    (void) state;
    struct pair_query query = cubes();
    query.placement[1].body_id = QUERY_ID_MAX + 1;
    expect(&query, FMB_BAD_ID, "b.body_id: not from 0 to 2^53 - 1");
    query.placement[1].body_id = -1;
    expect(&query, FMB_BAD_ID, "b.body_id: not from 0 to 2^53 - 1");
    query = cubes();
    query.client_id = INT64_MAX;
    expect(&query, FMB_BAD_ID, "client_id: not from 0 to 2^53 - 1");
    query = cubes();
    query.sequence_number = -7;
    expect(&query, FMB_BAD_ID, "sequence_number: not from 0 to 2^53 - 1");
    query = cubes();
    query.placement[0].body_id = QUERY_ID_MAX;
    assert_int_equal(answer_to(&query).status, FMB_OK);
}

static void test_bad_requests(void **state)
{
    (void) state;
    const double durations[] = {-1, NAN, INFINITY, -5e-324};
    for (size_t i = 0; i < sizeof durations / sizeof *durations; i++) {
        struct pair_query query = cubes();
        query.duration = durations[i];
        expect(&query, FMB_BAD_DURATION, "duration: negative or not finite");
    }
    struct pair_query query = cubes();
    query.method = 77;
    expect(&query, FMB_UNKNOWN_METHOD, "method: unknown method");
    query = cubes();
    query.want = QUERY_WANT_BOX | 1 << 20;
    expect(&query, FMB_UNKNOWN_WANT, "want: wants what this version does not give");
    query.want = QUERY_WANT_GAP;
    expect(&query, FMB_UNKNOWN_WANT, "want: wants what this version does not give");
}

static void test_refused_without_being_read(void **state)
{
    (void) state;
    const struct pair_query query = cubes();
    struct pair_result result;
    memset(&result, 0xa5, sizeof result);
    answer_pair_refused(answerer, &query, FMB_BUSY, &result);
    assert_int_equal(result.status, FMB_BUSY);
    assert_string_equal(result.detail, "busy");
    assert_int_equal(result.client_id, 4);
    assert_int_equal(result.server_id, 99);
    assert_int_equal(result.answer.verdict, 0);
    assert_null(result.certificate);
}

/* The pair of a query whose placements come whole. */
static struct fmb_pair pair_of(const struct pair_query *query, struct fmb_body body[2])
{
    struct fmb_pair pair = {.duration = query->duration};
    struct fmb_frame *frames[2] = {&pair.a, &pair.b};
    for (int f = 0; f < 2; f++) {
        const struct placement *from = &query->placement[f];
        cache_make_body(&from->geometry, &body[f]);
        frames[f]->body = &body[f];
        frames[f]->moving = from->velocity_count > 0;
        memcpy(frames[f]->origin, from->position, sizeof frames[f]->origin);
        memcpy(frames[f]->velocity, from->velocity, sizeof frames[f]->velocity);
    }
    return pair;
}

static bool certified(const struct pair_query *query, const struct pair_result *result)
{
    struct fmb_body body[2];
    struct fmb_pair pair = pair_of(query, body);
    char why[200];
    assert_int_equal(result->status, FMB_OK);
    assert_non_null(result->certificate);
    return fmb_certificate_holds(&pair, result->answer.verdict, result->certificate, why,
                                 sizeof why);
}

static void test_certificates(void **state)
{
    (void) state;
    const double apart[] = {0.5, 1, 1.5};
    const enum fmb_verdict verdict[] = {FMB_OVERLAPPING, FMB_TOUCHING, FMB_SEPARATED};
    for (int i = 0; i < 6; i++) {
        struct pair_query query = cubes();
        query.placement[1].position[0] = apart[i % 3];
        query.placement[0].velocity_count = i >= 3 ? 3 : 0;
        query.placement[0].velocity[1] = 0.25;
        query.want = QUERY_WANT_CERTIFICATE;
        struct pair_result result = answer_to(&query);
        assert_int_equal(result.answer.verdict, verdict[i % 3]);
        assert_true(certified(&query, &result));
        assert_false(result.answer.has_box);
        char text[200];
        assert_true(strlen(result.certificate) < sizeof text);
        strcpy(text, result.certificate);
        query.want |= QUERY_WANT_BOX;
        result = answer_to(&query);
        assert_string_equal(result.certificate, text);
        assert_int_equal(result.answer.has_box, verdict[i % 3] != FMB_SEPARATED);
        query.want = QUERY_WANT_BOX;
        assert_null(answer_to(&query).certificate);
        query.want = QUERY_WANT_CERTIFICATE;
        query.placement[0].position[0] = NAN;
        assert_null(answer_to(&query).certificate);
    }
}

/* Of a body that comes by handle too. */
static void test_certificate_by_handle(void **state)
{
    (void) state;
    struct pair_query query = cubes();
    query.want = QUERY_WANT_CERTIFICATE;
    struct pair_query by_handle = query;
    scene_name(&by_handle.placement[1], &answer_to(&query).handle[1]);
    struct pair_result result = answer_to(&by_handle);
    assert_true(certified(&query, &result));
}

/* The body is kept all the same, and its handle known. */
static void test_inexact_methods_on_a_flat_frame(void **state)
{
    (void) state;
    struct pair_query query = cubes();
    put_number(0, 3, 0);
    query.method = fmb_method_by_name("sat")->number;
    struct pair_result result = answer_to(&query);
    assert_int_equal(result.status, FMB_CANNOT_DECIDE);
    assert_non_null(strstr(result.detail, "sat"));
    assert_false(handle_is_none(&result.handle[0]));
    query.method = 0;
    assert_int_equal(answer_to(&query).answer.verdict, FMB_SEPARATED);
    assert_int_equal(counts().hits, 2);
}

static void test_a_repeat_gets_the_same(void **state)
{
    (void) state;
    struct pair_query query = cubes();
    query.want = QUERY_WANT_BOX;
    query.placement[0].velocity_count = 3;
    memcpy(query.placement[0].velocity, (const double[]){0.1, 0.7, 3}, 3 * sizeof(double));
    struct pair_result first = answer_to(&query), second = answer_to(&query);
    assert_memory_equal(&first, &second, sizeof first);
    assert_true(first.answer.has_contact);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_answer_and_echo),
        TEST(test_handles_stand_for_frames),
        TEST(test_handles_that_are_not_held),
        TEST(test_handle_of_the_other_dimension),
        TEST(test_eviction),
        cmocka_unit_test_setup_teardown(test_capacity_for_one, set_up_one, tear_down),
        TEST(test_one_id_two_bodies),
        TEST(test_anonymous_bodies_are_not_kept),
        TEST(test_bad_numbers),
        TEST(test_bad_counts),
        TEST(test_handle_or_frames),
        TEST(test_bad_shapes_and_dimensions),
        TEST(test_not_supported),
        TEST(test_bad_ids),
        TEST(test_bad_requests),
        TEST(test_refused_without_being_read),
        TEST(test_certificates),
        TEST(test_certificate_by_handle),
        TEST(test_inexact_methods_on_a_flat_frame),
        TEST(test_a_repeat_gets_the_same),
    };
    return cmocka_run_group_tests_name("answer", tests, NULL, NULL);
}
