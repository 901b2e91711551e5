/* The walker: reads back what is written, here or by the generated encoders, which write the same,
 * and refuses everything else. */
#include "as_lcm.h"
#include "hostile.h"
#include "wire.h"

#include "fmb_msgs_frame_t.h"
#include "fmb_msgs_pair_query_t.h"
#include "fmb_msgs_pair_result_t.h"
#include "fmb_msgs_scene_query_t.h"
#include "fmb_msgs_scene_result_t.h"
#include "fmb_msgs_status_t.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* Reads a message of the type from a copy that ends where it ends, so that a sanitizer sees any
 * byte read beyond it. */
static const char *read_any(const char *type, const unsigned char *bytes, size_t size)
{
    unsigned char *copy = malloc(size ? size : 1);
    static union {
        struct pair_query query;
        struct pair_result result;
        struct scene_query scene_query;
        struct scene_result scene_result;
        struct wire_status status;
    } out;
    const char *error;
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    if (strcmp(type, "pair_query") == 0)
        error = wire_read_pair_query(copy, (uint32_t) size, &out.query);
    else if (strcmp(type, "pair_result") == 0)
        error = wire_read_pair_result(copy, (uint32_t) size, &out.result);
    else if (strcmp(type, "scene_query") == 0)
        error = wire_read_scene_query(copy, (uint32_t) size, &out.scene_query);
    else if (strcmp(type, "scene_result") == 0)
        error = wire_read_scene_result(copy, (uint32_t) size, &out.scene_result);
    else
        error = wire_read_status(copy, (uint32_t) size, &out.status);
    free(copy);
    return error;
}

static const char *const types[] = {"pair_query", "pair_result", "scene_query", "scene_result",
                                    "status"};
enum { TYPES = sizeof types / sizeof *types };

/* A change of any field changes the fingerprint, and with it breaks every old client and log. */
static void test_fingerprints_are_pinned(void **state)
{
    (void) state;
    assert_int_equal(__fmb_msgs_frame_t_get_hash(), 0x9265058e7e235b03u);
    assert_int_equal(__fmb_msgs_pair_query_t_get_hash(), 0x1704231dbc74a72cu);
    assert_int_equal(__fmb_msgs_pair_result_t_get_hash(), 0xeb1e69337997c3dcu);
    assert_int_equal(__fmb_msgs_scene_query_t_get_hash(), 0x52891e4394056640u);
    assert_int_equal(__fmb_msgs_scene_result_t_get_hash(), 0xc3b42b0975213c58u);
    assert_int_equal(__fmb_msgs_status_t_get_hash(), 0x98458447f1c5ee86u);
}

static void expect_refused(void *context, const char *what, const unsigned char *bytes, size_t size)
{
    const char *type = context;
    if (!read_any(type, bytes, size))
        fail_msg("%s was accepted: %s", type, what);
}

static void test_damage_is_refused(void **state)
{
    (void) state;
    for (size_t t = 0; t < TYPES; t++) {
        unsigned char good[HOSTILE_BYTES_MAX];
        assert_null(read_any(types[t], good, hostile_good(types[t], good)));
        assert_true(hostile_each(types[t], expect_refused, (void *) types[t]) > 200);
    }
}

/* LCM hands on a size that is a negative int for some short packets. */
static void test_negative_size_is_refused(void **state)
{
    (void) state;
    unsigned char good[HOSTILE_BYTES_MAX];
    struct pair_query query;
    struct query_header header;
    hostile_good("pair_query", good);
    assert_non_null(wire_read_pair_query(good, (uint32_t) -3, &query));
    assert_non_null(wire_read_pair_query(good, (uint32_t) -1, &query));
    assert_non_null(wire_read_pair_query(NULL, 0, &query));
    assert_null(wire_read_pair_header(good, 32, &header));
    assert_non_null(wire_read_pair_header(good, (uint32_t) -1, &header));
    assert_non_null(wire_read_pair_header(NULL, 0, &header));
}

static uint64_t next_random(uint64_t *seed)
{
    *seed ^= *seed << 13;
    *seed ^= *seed >> 7;
    *seed ^= *seed << 17;
    return *seed;
}

/* Random bytes changed, added and cut: nothing is read out of bounds, whatever the verdict. */
static void test_mutants_are_survived(void **state)
{
    (void) state;
    uint64_t seed = 88172645463325252u;
    size_t accepted = 0, refused = 0;
    for (int round = 0; round < 100000; round++) {
        const char *type = types[round % TYPES];
        unsigned char bytes[HOSTILE_BYTES_MAX] = {0};
        size_t size = hostile_good(type, bytes);
        for (uint64_t n = next_random(&seed) % 4 + 1; n > 0; n--)
            bytes[8 + next_random(&seed) % (size - 8)] = (unsigned char) next_random(&seed);
        if (next_random(&seed) % 8 == 0)
            size = next_random(&seed) % HOSTILE_BYTES_MAX;
        if (read_any(type, bytes, size))
            refused++;
        else
            accepted++;
    }
    assert_true(accepted > 0);
    assert_true(refused > 0);
}

static struct pair_query sample_query(void)
{
    struct pair_query query = {.utime = 1700000000000000,
                               .client_id = QUERY_ID_MAX,
                               .sequence_number = 42,
                               .duration = 0.1,
                               .method = 2,
                               .want = 1};
    for (int f = 0; f < 2; f++) {
        struct query_frame *frame = &query.frame[f];
        *frame = (struct query_frame){.body_id = 5 + f, .key = 77 * f, .shape = 2 + f, .dim = 3};
        frame->origin.count = 3;
        frame->components.count = f ? 6 : 9;
        frame->velocity.count = f ? 0 : 3;
        for (int i = 0; i < 9; i++)
            frame->components.number[i] = i < frame->components.count ? i * 0.1 - 5e-324 : 0;
        for (int i = 0; i < 3; i++) {
            frame->origin.number[i] = -0.0;
            frame->velocity.number[i] = f ? 0 : 1e308;
        }
    }
    return query;
}

static void test_pair_query_round_trip(void **state)
{
    (void) state;
    struct pair_query query = sample_query(), read;
    unsigned char bytes[WIRE_BYTES_MAX];
    size_t size = wire_write_pair_query(&query, bytes);
    assert_null(wire_read_pair_query(bytes, (uint32_t) size, &read));
    assert_memory_equal(&query, &read, sizeof query);
    ASSERT_AS_LCM_WRITES(fmb_msgs_pair_query_t, bytes, size);
}

/* A count that no frame has is an answerable query, not a malformed one: the walker keeps what
 * it can and tells the count. */
static void test_long_lists_are_walked(void **state)
{
    (void) state;
    static double many[500];
    unsigned char bytes[8192];
    fmb_msgs_frame_t frame = {.dim = 500,
                              .origin = many,
                              .num_components = 100,
                              .components = many,
                              .num_velocity = 10,
                              .velocity = many};
    fmb_msgs_pair_query_t message = {.a = frame};
    int size = fmb_msgs_pair_query_t_encode(bytes, 0, sizeof bytes, &message);
    struct pair_query query;
    assert_true(size > 0);
    assert_null(wire_read_pair_query(bytes, (uint32_t) size, &query));
    assert_int_equal(query.frame[0].dim, 500);
    assert_int_equal(query.frame[0].components.count, 100);
    assert_int_equal(query.frame[0].velocity.count, 10);
    assert_int_equal(query.frame[1].dim, 0);
}

/* The certificate is read where it stands. */
static void assert_same_result(const struct pair_result *result, const struct pair_result *read,
                               const unsigned char *bytes, size_t size)
{
    struct pair_result other = *read;
    assert_string_equal(result->certificate, read->certificate);
    assert_true((const unsigned char *) read->certificate > bytes);
    assert_true((const unsigned char *) read->certificate < bytes + size);
    other.certificate = result->certificate;
    assert_memory_equal(result, &other, sizeof other);
}

static void test_pair_result_round_trip(void **state)
{
    (void) state;
    for (int dim = 2; dim <= 3; dim++) {
        struct pair_result result, read;
        memset(&result, 0, sizeof result);
        result.utime = 1;
        result.client_id = 2;
        result.server_id = 4;
        result.body_id[1] = 9;
        result.key[0] = 10;
        result.method = 1;
        result.dim = dim;
        result.answer.verdict = FMB_OVERLAPPING;
        result.answer.has_contact = result.answer.has_box = true;
        result.answer.contact[1] = 0.25;
        for (int axis = 0; axis < dim; axis++)
            result.answer.box[1][axis] = 1.0 / (axis + 3);
        result.answer.box[1][0] = HUGE_VAL;
        result.compute_ns = 1234;
        unsigned char bytes[WIRE_RESULT_BYTES_MAX];
        size_t size = wire_write_pair_result(&result, bytes);
        assert_null(wire_read_pair_result(bytes, (uint32_t) size, &read));
        assert_memory_equal(&result, &read, sizeof result);

        result.certificate = "overlapping at 0 (1/2 1/4)";
        size = wire_write_pair_result(&result, bytes);
        assert_null(wire_read_pair_result(bytes, (uint32_t) size, &read));
        assert_same_result(&result, &read, bytes, size);
        ASSERT_AS_LCM_WRITES(fmb_msgs_pair_result_t, bytes, size);
    }
}

/* A result with this certificate, as no service need have written it. */
static size_t write_certificate(char *certificate, int32_t status, int32_t verdict,
                                unsigned char *out, size_t room)
{
    char detail[] = "";
    fmb_msgs_pair_result_t message = {
        .status = status, .detail = detail, .verdict = verdict, .certificate = certificate};
    int size = fmb_msgs_pair_result_t_encode(out, 0, (int) room, &message);
    assert_true(size > 0);
    return (size_t) size;
}

static void test_certificates_end_somewhere(void **state)
{
    (void) state;
    static char text[3 * QUERY_CERTIFICATE_MAX];
    static unsigned char bytes[4 * QUERY_CERTIFICATE_MAX];
    const size_t longest = QUERY_CERTIFICATE_MAX - 1;
    const size_t lengths[] = {1, longest, longest + 1, sizeof text - 1};
    struct pair_result result;
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
        memset(text, '7', lengths[i]);
        text[lengths[i]] = '\0';
        size_t size = write_certificate(text, FMB_OK, FMB_SEPARATED, bytes, sizeof bytes);
        const char *error = wire_read_pair_result(bytes, (uint32_t) size, &result);
        if (lengths[i] <= longest) {
            assert_null(error);
            assert_string_equal(result.certificate, text);
            assert_true(wire_write_pair_result(&result, bytes + size) < 65000);
        } else {
            assert_non_null(error);
        }
    }
}

static void test_certificates_are_printable(void **state)
{
    (void) state;
    for (int byte = 1; byte < 256; byte++) {
        char text[] = {'a', (char) byte, 'b', '\0'};
        unsigned char bytes[WIRE_BYTES_MAX];
        struct pair_result result;
        size_t size = write_certificate(text, FMB_OK, FMB_TOUCHING, bytes, sizeof bytes);
        const char *error = wire_read_pair_result(bytes, (uint32_t) size, &result);
        assert_int_equal(error == NULL, byte >= ' ' && byte <= '~');
    }
}

static void test_certificates_have_a_verdict(void **state)
{
    (void) state;
    char some[] = "separated + a0", none[] = "";
    unsigned char bytes[WIRE_BYTES_MAX];
    struct pair_result result;
    size_t size = write_certificate(some, FMB_CANNOT_DECIDE, 0, bytes, sizeof bytes);
    assert_non_null(wire_read_pair_result(bytes, (uint32_t) size, &result));
    size = write_certificate(none, FMB_CANNOT_DECIDE, 0, bytes, sizeof bytes);
    assert_null(wire_read_pair_result(bytes, (uint32_t) size, &result));
    assert_null(result.certificate);
}

static void test_refusal_round_trip(void **state)
{
    (void) state;
    struct pair_result result = {.status = FMB_NOT_FINITE, .detail = "a.origin[1]: bad"}, read;
    unsigned char bytes[WIRE_RESULT_BYTES_MAX];
    size_t size = wire_write_pair_result(&result, bytes);
    assert_null(wire_read_pair_result(bytes, (uint32_t) size, &read));
    assert_int_equal(read.status, FMB_NOT_FINITE);
    assert_string_equal(read.detail, "a.origin[1]: bad");
    ASSERT_AS_LCM_WRITES(fmb_msgs_pair_result_t, bytes, size);
}

static void test_status_round_trip(void **state)
{
    (void) state;
    struct wire_status status, read;
    memset(&status, 0, sizeof status);
    strcpy(status.version, "0.1.0");
    int64_t *numbers[] = {&status.utime,     &status.uptime_us, &status.received,
                          &status.malformed, &status.bodies,    &status.compute_max_ns};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        *numbers[i] = (int64_t) i + 100;
    status.results[FMB_CANNOT_DECIDE] = 8;
    unsigned char bytes[WIRE_BYTES_MAX];
    size_t size = wire_write_status(&status, bytes);
    assert_null(wire_read_status(bytes, (uint32_t) size, &read));
    assert_memory_equal(&status, &read, sizeof status);
    ASSERT_AS_LCM_WRITES(fmb_msgs_status_t, bytes, size);
}

/* A newer service may know more statuses, or a longer version. */
static void test_status_of_a_newer_service(void **state)
{
    (void) state;
    char version[] = "10.20.30-with-a-long-name-that-goes-on-and-on";
    int64_t results[40] = {3};
    fmb_msgs_status_t message = {
        .version = version, .num_results = 40, .results = results, .compute_max_ns = 6};
    unsigned char bytes[WIRE_BYTES_MAX];
    struct wire_status status;
    int size = fmb_msgs_status_t_encode(bytes, 0, sizeof bytes, &message);
    assert_true(size > 0);
    assert_null(wire_read_status(bytes, (uint32_t) size, &status));
    assert_int_equal(status.results[0], 3);
    assert_int_equal(status.compute_max_ns, 6);
    assert_memory_equal(status.version, version, sizeof status.version - 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fingerprints_are_pinned),
        cmocka_unit_test(test_damage_is_refused),
        cmocka_unit_test(test_negative_size_is_refused),
        cmocka_unit_test(test_mutants_are_survived),
        cmocka_unit_test(test_pair_query_round_trip),
        cmocka_unit_test(test_long_lists_are_walked),
        cmocka_unit_test(test_pair_result_round_trip),
        cmocka_unit_test(test_certificates_end_somewhere),
        cmocka_unit_test(test_certificates_are_printable),
        cmocka_unit_test(test_certificates_have_a_verdict),
        cmocka_unit_test(test_refusal_round_trip),
        cmocka_unit_test(test_status_round_trip),
        cmocka_unit_test(test_status_of_a_newer_service),
    };
    return cmocka_run_group_tests_name("wire", tests, NULL, NULL);
}
