/* What a query gets: the right answer, or the status that says what is wrong and where. */
#include "answer.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static struct answerer answerer;

static int set_up(void **state)
{
    (void) state;
    answerer = (struct answerer){.cache = cache_create(2, 500), .server_id = 99};
    return answerer.cache ? 0 : -1;
}

static int tear_down(void **state)
{
    (void) state;
    cache_destroy(answerer.cache);
    return 0;
}

/* Two unit cubes, bodies 1 and 2, the second moved by half an edge. */
static struct pair_query cubes(void)
{
    struct pair_query query = {.utime = 3, .client_id = 4, .sequence_number = 5, .duration = 1};
    for (int f = 0; f < 2; f++) {
        struct query_frame *frame = &query.frame[f];
        *frame = (struct query_frame){.body_id = f + 1, .shape = FMB_CUBOID, .dim = 3};
        frame->origin.count = 3;
        frame->components.count = 9;
        for (int i = 0; i < 3; i++)
            frame->components.number[4 * i] = 1;
    }
    query.frame[1].origin.number[0] = 0.5;
    return query;
}

static struct pair_result ask(const struct pair_query *query)
{
    struct pair_result result;
    answer_pair(&answerer, query, &result);
    return result;
}

static void expect(const struct pair_query *query, enum fmb_status status, const char *detail)
{
    struct pair_result result = ask(query);
    assert_string_equal(result.detail, detail);
    assert_int_equal(result.status, status);
    assert_int_equal(result.answer.verdict, 0);
    assert_int_equal(result.method, 0);
    assert_int_equal(result.client_id, query->client_id);
    assert_int_equal(result.sequence_number, query->sequence_number);
    assert_int_equal(result.utime, query->utime);
    assert_int_equal(result.server_id, 99);
}

static void test_answer_and_echo(void **state)
{
    (void) state;
    struct pair_query query = cubes();
    query.want = QUERY_WANT_BOX;
    struct pair_result result = ask(&query);
    assert_int_equal(result.status, FMB_OK);
    assert_string_equal(result.detail, "");
    assert_int_equal(result.utime, 3);
    assert_int_equal(result.client_id, 4);
    assert_int_equal(result.sequence_number, 5);
    assert_int_equal(result.server_id, 99);
    assert_int_equal(result.body_id[0], 1);
    assert_int_equal(result.body_id[1], 2);
    assert_int_equal(result.key[0], 500);
    assert_int_equal(result.key[1], 501);
    assert_int_equal(result.method, fmb_method_default()->number);
    assert_int_equal(result.answer.verdict, FMB_OVERLAPPING);
    assert_false(result.answer.has_contact);
    assert_int_equal(result.dim, 3);
    assert_true(result.answer.box[0][0] == 0.5 && result.answer.box[1][0] == 1);
}

static void test_keys_stand_for_components(void **state)
{
    (void) state;
    struct pair_query query = cubes();
    struct pair_result first = ask(&query);
    for (int f = 0; f < 2; f++) {
        query.frame[f].key = first.key[f];
        query.frame[f].components = (struct query_numbers){0};
    }
    query.frame[1].origin.number[0] = 1;
    struct pair_result result = ask(&query);
    assert_int_equal(result.status, FMB_OK);
    assert_int_equal(result.answer.verdict, FMB_TOUCHING);
    assert_int_equal(result.key[0], first.key[0]);
}

static void test_dead_keys(void **state)
{
    (void) state;
    struct pair_query query = cubes(), other = cubes();
    struct pair_result first = ask(&query);
    query.frame[1].key = first.key[1];
    query.frame[1].components = (struct query_numbers){0};

    struct pair_query turned = query;
    turned.frame[1].shape = FMB_TETRAHEDRON;
    expect(&turned, FMB_UNKNOWN_BODY, "b.key: not held; send the components");
    struct pair_query flat = query;
    for (int f = 0; f < 2; f++) {
        flat.frame[f].dim = flat.frame[f].origin.count = 2;
        flat.frame[f].components.count = f ? 0 : 4;
    }
    expect(&flat, FMB_UNKNOWN_BODY, "b.key: not held; send the components");
    struct pair_query anonymous = query;
    anonymous.frame[1].body_id = 0;
    expect(&anonymous, FMB_UNKNOWN_BODY, "b.key: not held; send the components");

    other.frame[1].components.number[0] = 2; /* replaces body 2 */
    ask(&other);
    expect(&query, FMB_UNKNOWN_BODY, "b.key: not held; send the components");
    assert_int_equal(ask(&query).key[0], 0);
}

/* With room for two: asking for a third body kills the key of the one not used longest. */
static void test_eviction_kills_the_key(void **state)
{
    (void) state;
    struct pair_query query = cubes();
    struct pair_result first = ask(&query);
    struct pair_query third = cubes();
    third.frame[0].body_id = 2;
    third.frame[1].body_id = 3;
    ask(&third);
    query.frame[0].key = first.key[0];
    query.frame[0].components = (struct query_numbers){0};
    expect(&query, FMB_UNKNOWN_BODY, "a.key: not held; send the components");
}

/* Components count, whatever key comes with them. */
static void test_components_beside_a_key(void **state)
{
    (void) state;
    struct pair_query query = cubes();
    query.frame[0].key = 12345;
    assert_int_equal(ask(&query).status, FMB_OK);
}

/* One id with two sets of components in one pair: each frame is what it says. */
static void test_one_id_two_bodies(void **state)
{
    (void) state;
    struct pair_query query = cubes();
    query.frame[1].body_id = 1;
    query.frame[1].origin.number[0] = 1.5;
    assert_int_equal(ask(&query).answer.verdict, FMB_SEPARATED);
    query.frame[0].components.number[0] = 2;
    struct pair_result result = ask(&query);
    assert_int_equal(result.answer.verdict, FMB_OVERLAPPING);
    assert_int_not_equal(result.key[0], result.key[1]);
}

static void test_anonymous_bodies_are_not_kept(void **state)
{
    (void) state;
    struct pair_query query = cubes();
    query.frame[0].body_id = query.frame[1].body_id = 0;
    struct pair_result result = ask(&query);
    assert_int_equal(result.status, FMB_OK);
    assert_int_equal(result.key[0], 0);
    assert_int_equal(cache_counts(answerer.cache).bodies, 0);
}

static void test_bad_numbers(void **state)
{
    (void) state;
    struct pair_query query = cubes();
    query.frame[1].components.number[4] = NAN;
    expect(&query, FMB_NOT_FINITE, "b.components[4]: not a finite number");
    query = cubes();
    query.frame[0].origin.number[2] = -INFINITY;
    expect(&query, FMB_NOT_FINITE, "a.origin[2]: not a finite number");
    query = cubes();
    query.frame[0].velocity = (struct query_numbers){.count = 3, .number = {0, INFINITY, 0}};
    expect(&query, FMB_NOT_FINITE, "a.velocity[1]: not a finite number");
    assert_int_equal(cache_counts(answerer.cache).bodies, 0);
}

static void test_bad_counts(void **state)
{
    (void) state;
    struct pair_query query = cubes();
    query.frame[0].components.count = 6;
    expect(&query, FMB_WRONG_COUNT, "a.components: expected 9 numbers, found 6");
    query = cubes();
    query.frame[1].components.count = 0;
    expect(&query, FMB_WRONG_COUNT, "b.components: expected 9 numbers, found 0");
    query = cubes();
    query.frame[1].components.count = 1000;
    expect(&query, FMB_WRONG_COUNT, "b.components: expected 9 numbers, found 1000");
    query = cubes();
    query.frame[1].velocity.count = 2;
    expect(&query, FMB_WRONG_COUNT, "b.velocity: expected 3 numbers, found 2");
}

static void test_bad_shapes_and_dimensions(void **state)
{
    (void) state;
    struct pair_query query = cubes();
    query.frame[0].shape = 4;
    expect(&query, FMB_UNKNOWN_SHAPE, "a.shape: unknown shape");
    query = cubes();
    query.frame[0].dim = query.frame[0].origin.count = 4;
    expect(&query, FMB_WRONG_DIMENSION, "a.dim: neither 2 nor 3");
    query = cubes();
    query.frame[0].dim = query.frame[0].origin.count = 2;
    query.frame[0].shape = FMB_FACE;
    expect(&query, FMB_WRONG_DIMENSION, "a.dim: a face is in 3D");
    query = cubes();
    query.frame[0].dim = query.frame[0].origin.count = 2;
    query.frame[0].components.count = 4;
    expect(&query, FMB_DIMENSIONS_DIFFER, "dim: a 2D frame against a 3D one");
}

static void test_bad_ids(void **state)
{
    (void) state;
    struct pair_query query = cubes();
    query.frame[1].body_id = QUERY_ID_MAX + 1;
    expect(&query, FMB_BAD_ID, "b.body_id: not from 0 to 2^53 - 1");
    query.frame[1].body_id = -1;
    expect(&query, FMB_BAD_ID, "b.body_id: not from 0 to 2^53 - 1");
    query = cubes();
    query.frame[0].key = INT64_MIN;
    expect(&query, FMB_BAD_ID, "a.key: not from 0 to 2^53 - 1");
    query = cubes();
    query.client_id = INT64_MAX;
    expect(&query, FMB_BAD_ID, "client_id: not from 0 to 2^53 - 1");
    query = cubes();
    query.sequence_number = -7;
    expect(&query, FMB_BAD_ID, "sequence_number: not from 0 to 2^53 - 1");
    query = cubes();
    query.frame[0].body_id = QUERY_ID_MAX;
    assert_int_equal(ask(&query).status, FMB_OK);
}

static void test_bad_questions(void **state)
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
}

/* The pair of a query whose frames come whole. */
static struct fmb_pair pair_of(const struct pair_query *query, struct fmb_body body[2])
{
    struct fmb_pair pair = {.duration = query->duration};
    struct fmb_frame *frames[2] = {&pair.a, &pair.b};
    for (int f = 0; f < 2; f++) {
        const struct query_frame *from = &query->frame[f];
        assert_int_equal(fmb_body_make(from->dim, from->shape, from->components.number,
                                       (size_t) from->components.count, &body[f]),
                         FMB_OK);
        frames[f]->body = &body[f];
        frames[f]->moving = from->velocity.count > 0;
        memcpy(frames[f]->origin, from->origin.number, sizeof frames[f]->origin);
        memcpy(frames[f]->velocity, from->velocity.number, sizeof frames[f]->velocity);
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
        query.frame[1].origin.number[0] = apart[i % 3];
        if (i >= 3)
            query.frame[0].velocity = (struct query_numbers){.count = 3, .number = {0, 0.25, 0}};
        query.want = QUERY_WANT_CERTIFICATE;
        struct pair_result result = ask(&query);
        assert_int_equal(result.answer.verdict, verdict[i % 3]);
        assert_true(certified(&query, &result));
        assert_false(result.answer.has_box);
        char text[200];
        assert_true(strlen(result.certificate) < sizeof text);
        strcpy(text, result.certificate);
        query.want |= QUERY_WANT_BOX;
        result = ask(&query);
        assert_string_equal(result.certificate, text);
        assert_int_equal(result.answer.has_box, verdict[i % 3] != FMB_SEPARATED);
        query.want = QUERY_WANT_BOX;
        assert_null(ask(&query).certificate);
        query.want = QUERY_WANT_CERTIFICATE;
        query.frame[0].origin.number[0] = NAN;
        assert_null(ask(&query).certificate);
    }
}

/* Of a frame that comes by key too. */
static void test_certificate_by_key(void **state)
{
    (void) state;
    struct pair_query query = cubes();
    query.want = QUERY_WANT_CERTIFICATE;
    struct pair_query by_key = query;
    by_key.frame[1].key = ask(&query).key[1];
    by_key.frame[1].components = (struct query_numbers){0};
    struct pair_result result = ask(&by_key);
    assert_true(certified(&query, &result));
}

static void test_inexact_methods_on_a_flat_frame(void **state)
{
    (void) state;
    struct pair_query query = cubes();
    query.frame[0].components.number[0] = 0;
    query.method = fmb_method_by_name("sat")->number;
    struct pair_result result = ask(&query);
    assert_int_equal(result.status, FMB_CANNOT_DECIDE);
    assert_non_null(strstr(result.detail, "sat"));
    query.method = 0;
    assert_int_equal(ask(&query).answer.verdict, FMB_SEPARATED);
}

static void test_a_repeat_gets_the_same(void **state)
{
    (void) state;
    struct pair_query query = cubes();
    query.want = QUERY_WANT_BOX;
    query.frame[0].velocity = (struct query_numbers){.count = 3, .number = {0.1, 0.7, 3}};
    struct pair_result first = ask(&query), second = ask(&query);
    assert_memory_equal(&first, &second, sizeof first);
    assert_true(first.answer.has_contact);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_answer_and_echo),
        TEST(test_keys_stand_for_components),
        TEST(test_dead_keys),
        TEST(test_eviction_kills_the_key),
        TEST(test_components_beside_a_key),
        TEST(test_one_id_two_bodies),
        TEST(test_anonymous_bodies_are_not_kept),
        TEST(test_bad_numbers),
        TEST(test_bad_counts),
        TEST(test_bad_shapes_and_dimensions),
        TEST(test_bad_ids),
        TEST(test_bad_questions),
        TEST(test_certificates),
        TEST(test_certificate_by_key),
        TEST(test_inexact_methods_on_a_flat_frame),
        TEST(test_a_repeat_gets_the_same),
    };
    return cmocka_run_group_tests_name("answer", tests, NULL, NULL);
}
