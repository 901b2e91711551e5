/* The codec reads back what it writes, writes what lcm-gen's encoders write, and refuses everything
 * else. */
#include "as_lcm.h"
#include "big_endian.h"
#include "geometry_write.h"
#include "hostile.h"
#include "sample_placement.h"
#include "wire.h"
#include "wire_type.h"

#include "fmb_msgs_body_t.h"
#include "fmb_msgs_definition_query_t.h"
#include "fmb_msgs_definition_t.h"
#include "fmb_msgs_names_t.h"
#include "fmb_msgs_pair_query_t.h"
#include "fmb_msgs_pair_result_t.h"
#include "fmb_msgs_placement_t.h"
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

static struct hasher *hasher;

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
        struct definition_query definition_query;
        struct definition definition;
        struct wire_status status;
        struct names names;
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
    else if (strcmp(type, "definition_query") == 0)
        error = wire_read_definition_query(copy, (uint32_t) size, &out.definition_query);
    else if (strcmp(type, "definition") == 0)
        error = wire_read_definition(copy, (uint32_t) size, hasher, &out.definition);
    else if (strcmp(type, "names") == 0)
        error = wire_read_names(copy, (uint32_t) size, &out.names);
    else
        error = wire_read_status(copy, (uint32_t) size, &out.status);
    free(copy);
    return error;
}

static const char *const types[] = {
    "pair_query",       "pair_result", "scene_query", "scene_result",
    "definition_query", "definition",  "status",      "names"};
enum { TYPES = sizeof types / sizeof *types };

/* A change of any field changes the fingerprint, and with it breaks every old client and log. */
static void test_fingerprints_are_pinned(void **state)
{
    (void) state;
    assert_int_equal(__fmb_msgs_body_t_get_hash(), 0x18fc974de94f47b6u);
    assert_int_equal(__fmb_msgs_definition_query_t_get_hash(), 0xe2c4e2ab0ebcd9d9u);
    assert_int_equal(__fmb_msgs_definition_t_get_hash(), 0xef476d61362c5fbau);
    assert_int_equal(__fmb_msgs_names_t_get_hash(), 0xc5646e8cb4490b7cu);
    assert_int_equal(__fmb_msgs_pair_query_t_get_hash(), 0xfcf896d1538fd1a4u);
    assert_int_equal(__fmb_msgs_pair_result_t_get_hash(), 0x9dd6a8c2afceabd8u);
    assert_int_equal(__fmb_msgs_placement_t_get_hash(), 0xcbe2227b63ea25a1u);
    assert_int_equal(__fmb_msgs_scene_query_t_get_hash(), 0xabbd2c17d3792717u);
    assert_int_equal(__fmb_msgs_scene_result_t_get_hash(), 0x54e9a70f5ddb21bbu);
    assert_int_equal(__fmb_msgs_status_t_get_hash(), 0x15fcba856d637fcau);
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
        assert_true(hostile_each(types[t], expect_refused, (void *) types[t]) > 150);
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

/* Fingerprint and ids are 32 bytes: where one is missing there is no header. */
static void test_short_headers_are_refused(void **state)
{
    (void) state;
    static const struct {
        const char *type;
        const char *(*read)(const void *bytes, uint32_t size, struct query_header *out);
    } kinds[] = {{"pair_query", wire_read_pair_header},
                 {"pair_result", wire_read_pair_result_header},
                 {"scene_query", wire_read_scene_header},
                 {"scene_result", wire_read_scene_result_header},
                 {"definition_query", wire_read_definition_header}};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        for (uint32_t size = 0; size <= 32; size++) {
            unsigned char good[HOSTILE_BYTES_MAX], *copy = malloc(32);
            struct query_header header;
            hostile_good(kinds[k].type, good);
            assert_non_null(copy);
            memcpy(copy + 32 - size, good, size); /* a sanitizer sees what is read beyond */
            assert_int_equal(kinds[k].read(copy + 32 - size, size, &header) == NULL, size == 32);
            free(copy);
        }
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

static void test_pair_query_round_trip(void **state)
{
    (void) state;
    for (int i = 0; i < 60; i++) {
        unsigned char geometry[2][SAMPLE_BYTES_MAX], bytes[QUERY_BYTES_MAX];
        struct pair_query query = {.utime = 1700000000000000,
                                   .client_id = QUERY_ID_MAX,
                                   .sequence_number = 42,
                                   .duration = 0.1,
                                   .method = 2,
                                   .want = 1},
                          read;
        for (int k = 0; k < 2; k++)
            query.placement[k] = sample_placement(i + 7 * k, geometry[k]);
        const size_t size = wire_write_pair_query(&query, bytes);
        assert_int_equal(size, WIRE_PAIR_QUERY_BYTES + wire_placement_bytes(&query.placement[0]) +
                                   wire_placement_bytes(&query.placement[1]));
        assert_null(wire_read_pair_query(bytes, (uint32_t) size, &read));
        assert_int_equal(read.client_id, query.client_id);
        assert_int_equal(read.sequence_number, query.sequence_number);
        assert_true(read.duration == query.duration);
        assert_int_equal(read.want, query.want);
        for (int k = 0; k < 2; k++)
            assert_true(same_placement(&query.placement[k], &read.placement[k]));
        ASSERT_AS_LCM_WRITES(fmb_msgs_pair_query_t, bytes, size);
    }
}

/* Counts that no body has make a query that is answered, not a malformed one: the reader keeps what
 * fits, and the counts. */
static void test_long_lists_are_read(void **state)
{
    (void) state;
    static double many[500];
    static uint8_t shapes[300];
    static int32_t counts[200];
    static unsigned char bytes[16384];
    fmb_msgs_placement_t placement = {.dim = 500,
                                      .num_frames = 300,
                                      .shapes = shapes,
                                      .num_counts = 200,
                                      .counts = counts,
                                      .num_numbers = 100,
                                      .numbers = many,
                                      .position = many,
                                      .num_orientation = 70,
                                      .orientation = many,
                                      .num_velocity = 10,
                                      .velocity = many};
    char none[] = "";
    placement.name = none;
    fmb_msgs_pair_query_t message = {.a = placement, .b.name = none};
    int size = fmb_msgs_pair_query_t_encode(bytes, 0, sizeof bytes, &message);
    struct pair_query query;
    assert_true(size > 0);
    assert_null(wire_read_pair_query(bytes, (uint32_t) size, &query));
    assert_int_equal(query.placement[0].dim, 500);
    assert_int_equal(query.placement[0].frame_count, 300);
    assert_int_equal(query.placement[0].count_count, 200);
    assert_int_equal(query.placement[0].number_count, 100);
    assert_int_equal(query.placement[0].orientation_count, 70);
    assert_int_equal(query.placement[0].velocity_count, 10);
    assert_int_equal(query.placement[0].geometry.size, 4 + 4 + 300 + 4 + 800 + 4 + 800);
    assert_int_equal(query.placement[1].dim, 0);
}

/* ---- Geometries and handles ---- */

static void test_geometry_round_trip(void **state)
{
    (void) state;
    for (int dim = 2; dim <= 3; dim++)
        for (int code = 1; code <= 7; code++) {
            const int shape = geometry_shape(code).shape;
            unsigned char bytes[GEOMETRY_FRAME_BYTES_MAX];
            struct geometry_frame read;
            if (geometry_number_count(dim, shape, 0) == 0)
                continue;
            struct geometry_frame frame = sample_frame(dim, shape);
            frame.by_vertices = geometry_shape(code).by_vertices;
            const struct geometry geometry = {bytes, geometry_write(dim, &frame, bytes)};
            assert_int_equal(geometry.size, geometry_size(dim, &frame, 1));
            struct geometry_reader reader = geometry_begin(&geometry);
            assert_int_equal(reader.dim, dim);
            assert_true(geometry_next(&reader, &read));
            assert_memory_equal(&frame, &read, sizeof frame);
        }
}

static void test_numbers_of_frames(void **state)
{
    (void) state;
    static const int counts[2][9] = {{0, 6, 6, 0, 4, 0, 6, 0, 0}, {0, 12, 12, 9, 6, 0, 12, 9, 0}};
    for (int shape = 0; shape < 9; shape++) {
        for (int dim = 2; dim <= 3; dim++)
            for (int vertices = 0; vertices < 6; vertices++)
                assert_int_equal(geometry_number_count(dim, shape, vertices),
                                 shape == FMB_HULL ? dim * vertices : counts[dim - 2][shape]);
        assert_int_equal(geometry_number_count(1, shape, 4), 0);
        assert_int_equal(geometry_number_count(4, shape, 4), 0);
    }
    assert_int_equal(geometry_number_count(3, FMB_HULL, -1), 0);
    assert_int_equal(geometry_number_count(3, FMB_HULL, INT32_MAX), INT64_C(3) * INT32_MAX);
}

/* As many frames as a message has space for, of all shapes. */
static void test_geometry_of_many_frames(void **state)
{
    (void) state;
    static struct geometry_frame frames[QUERY_FRAMES_MAX];
    static unsigned char bytes[QUERY_BYTES_MAX];
    for (int dim = 2; dim <= 3; dim++) {
        int count = 0;
        for (size_t size = GEOMETRY_NONE_BYTES; size <= QUERY_BYTES_MAX; count++) {
            static const int shapes[] = {FMB_CUBOID, FMB_BOX, FMB_TETRAHEDRON, FMB_BOX, FMB_BOX};
            frames[count] = sample_frame(dim, shapes[count % 5]);
            frames[count].origin[0] = count;
            size += 1 + 8 * (size_t) geometry_number_count(dim, frames[count].shape, 0);
        }
        count--;
        const struct geometry geometry = {bytes, geometry_write_frames(dim, frames, count, bytes)};
        assert_int_equal(geometry.size, geometry_size(dim, frames, count));
        assert_true(geometry.size <= QUERY_BYTES_MAX);
        struct geometry_reader reader = geometry_begin(&geometry);
        struct geometry_frame read;
        assert_int_equal(reader.dim, dim);
        assert_int_equal(reader.frames_left, count);
        for (int i = 0; i < count; i++) {
            assert_true(geometry_next(&reader, &read));
            assert_memory_equal(&frames[i], &read, sizeof read);
        }
        assert_false(geometry_next(&reader, &read));
        assert_int_equal(reader.numbers_left, 0);
    }
}

/* What no frame is made of is refused, whatever the counts are. */
static void test_geometry_that_does_not_fit(void **state)
{
    (void) state;
    unsigned char bytes[GEOMETRY_FRAME_BYTES_MAX], other[GEOMETRY_FRAME_BYTES_MAX];
    struct geometry_frame frame = {.shape = FMB_CUBOID};
    const size_t size = geometry_write(3, &frame, bytes);
    struct geometry geometry = {other, size};
    const struct {
        size_t at;
        unsigned char byte;
    } changes[] = {{3, 1},   {3, 4},   {0, 0x80}, {8, 0}, {8, 5},
                   {8, 255}, {16, 11}, {7, 0},    {8, 6}, {8, 7}};
    for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
        memcpy(other, bytes, size);
        other[changes[i].at] = changes[i].byte;
        if (changes[i].at == 7) /* no frame: the list of numbers begins a byte earlier */
            geometry_write_none(3, other);
        struct geometry_reader reader = geometry_begin(&geometry);
        assert_false(geometry_next(&reader, &frame));
    }
}

/* A tetrahedron whose count says more or fewer vertices than it has, or that has none. */
static void test_a_frame_by_vertices_has_their_count(void **state)
{
    (void) state;
    struct geometry_frame frame = sample_frame(3, FMB_TETRAHEDRON), read;
    frame.by_vertices = true;
    unsigned char bytes[GEOMETRY_FRAME_BYTES_MAX];
    const struct geometry geometry = {bytes, geometry_write(3, &frame, bytes)};
    for (int count = 0; count < 256; count++) {
        bytes[16] = (unsigned char) count;
        struct geometry_reader reader = geometry_begin(&geometry);
        assert_int_equal(geometry_next(&reader, &read), count == 4);
    }
    bytes[16] = 4;
    struct geometry_reader reader = geometry_begin(&geometry);
    reader.counts_left = 0;
    assert_false(geometry_next(&reader, &read));
}

/* The second frame has one number less than it needs. */
static void test_a_later_frame_that_does_not_fit(void **state)
{
    (void) state;
    const struct geometry_frame frames[2] = {sample_frame(3, FMB_BOX), sample_frame(3, FMB_FACE)};
    unsigned char bytes[SAMPLE_BYTES_MAX];
    struct geometry geometry = {bytes, geometry_write_frames(3, frames, 2, bytes)};
    struct geometry_frame read;
    bytes[4 + 4 + 2 + 4 + 3]--;
    struct geometry_reader reader = geometry_begin(&geometry);
    assert_true(geometry_next(&reader, &read));
    assert_false(geometry_next(&reader, &read));
}

/* The handle is what any SHA-256 makes of the bytes between handle and position, as lcm-gen's own
 * encoder writes them: a client in any language can compute it. */
static void test_handles_are_hashes_of_the_encoding(void **state)
{
    (void) state;
    static const unsigned char abc[HANDLE_BYTES] = {0xba, 0x78, 0x16, 0xbf, 0x8f, 0x01, 0xcf, 0xea,
                                                    0x41, 0x41, 0x40, 0xde, 0x5d, 0xae, 0x22, 0x23};
    struct handle handle = hasher_handle(hasher, (const unsigned char *) "abc", 3);
    assert_memory_equal(handle.bytes, abc, sizeof abc);

    unsigned char bytes[GEOMETRY_FRAME_BYTES_MAX], encoded[HOSTILE_BYTES_MAX];
    struct geometry_frame frame = {.shape = FMB_TETRAHEDRON, .components = {1, 0, 0, 1}};
    const size_t size = geometry_write(2, &frame, bytes);
    uint8_t shapes[1] = {FMB_TETRAHEDRON};
    double numbers[6] = {0, 0, 1, 0, 0, 1};
    fmb_msgs_body_t body = {
        .dim = 2, .num_frames = 1, .shapes = shapes, .num_numbers = 6, .numbers = numbers};
    const int encoded_size = fmb_msgs_body_t_encode(encoded, 0, sizeof encoded, &body);
    assert_int_equal(encoded_size, 8 + HANDLE_BYTES + size);
    assert_memory_equal(encoded + 8 + HANDLE_BYTES, bytes, size);
}

static void test_handles_distinguish_zeros(void **state)
{
    (void) state;
    unsigned char bytes[2][GEOMETRY_FRAME_BYTES_MAX];
    struct handle handle[2];
    for (int i = 0; i < 2; i++) {
        struct geometry_frame frame = {.shape = FMB_CUBOID, .components = {1, i ? -0.0 : 0.0}};
        const size_t size = geometry_write(2, &frame, bytes[i]);
        handle[i] = hasher_handle(hasher, bytes[i], size);
        assert_false(handle_is_none(&handle[i]));
    }
    assert_false(handle_equal(&handle[0], &handle[1]));
}

/* ---- Definitions ---- */

static void test_definition_query_round_trip(void **state)
{
    (void) state;
    static struct definition_query query, read;
    static unsigned char bytes[QUERY_BYTES_MAX];
    const int most = (QUERY_BYTES_MAX - 8 - 4 * 8 - 4) / HANDLE_BYTES;
    for (int count = 0; count <= most; count += count < 5 ? 1 : most - 5) {
        query = (struct definition_query){
            .utime = 1, .client_id = 2, .sequence_number = 3, .first = 4, .handle_count = count};
        for (int i = 0; i < count; i++)
            query.handle[i].bytes[i % HANDLE_BYTES] = (unsigned char) i;
        const size_t size = wire_write_definition_query(&query, bytes);
        assert_null(wire_read_definition_query(bytes, (uint32_t) size, &read));
        assert_memory_equal(&query, &read, sizeof query);
        if (count > 0) /* lcm-gen's decoder copies 0 bytes to NULL, which sanitizers report */
            ASSERT_AS_LCM_WRITES(fmb_msgs_definition_query_t, bytes, size);
    }
}

static void test_definition_round_trip(void **state)
{
    (void) state;
    static struct definition definition, read;
    static unsigned char bytes[QUERY_BYTES_MAX], geometry[300][SAMPLE_BYTES_MAX];
    definition = (struct definition){.client_id = 2, .server_id = 4, .next = 17};
    for (int i = 0; i < 300; i++) {
        const struct placement placement = sample_placement(3 * i, geometry[i]); /* whole */
        struct query_body *body = &definition.body[definition.body_count++];
        body->geometry = placement.geometry;
        body->handle = hasher_handle(hasher, body->geometry.bytes, body->geometry.size);
    }
    const size_t size = wire_write_definition(&definition, bytes);
    assert_null(wire_read_definition(bytes, (uint32_t) size, hasher, &read));
    assert_int_equal(read.body_count, 300);
    assert_int_equal(read.next, 17);
    for (int i = 0; i < 300; i++) {
        const struct query_body *a = &definition.body[i], *b = &read.body[i];
        assert_true(handle_equal(&a->handle, &b->handle));
        assert_int_equal(a->geometry.size, b->geometry.size);
        assert_memory_equal(a->geometry.bytes, b->geometry.bytes, a->geometry.size);
    }
    ASSERT_AS_LCM_WRITES(fmb_msgs_definition_t, bytes, size);
}

/* One bit of a body, or of its handle, and it is refused. */
static void test_definitions_match_their_handles(void **state)
{
    (void) state;
    unsigned char bytes[HOSTILE_BYTES_MAX];
    struct definition *read = malloc(sizeof *read);
    const size_t size = hostile_good("definition", bytes);
    const size_t bodies_at = size - (2 * HANDLE_BYTES + 2 * (4 + 4 + 1 + 4) + 18 * 8);
    assert_non_null(read);
    for (size_t bit = 8 * bodies_at; bit < 8 * size; bit++) {
        bytes[bit / 8] ^= (unsigned char) (1 << bit % 8);
        assert_non_null(wire_read_definition(bytes, (uint32_t) size, hasher, read));
        bytes[bit / 8] ^= (unsigned char) (1 << bit % 8);
    }
    assert_null(wire_read_definition(bytes, (uint32_t) size, hasher, read));
    free(read);
}

/* A body without frames, or one beside a refusal, whatever its handle. */
static void test_definitions_have_frames_and_status_ok(void **state)
{
    (void) state;
    static struct definition definition, read;
    static unsigned char bytes[QUERY_BYTES_MAX];
    unsigned char geometry[SAMPLE_BYTES_MAX], none[GEOMETRY_NONE_BYTES];
    const struct placement placement = sample_placement(0, geometry); /* whole */
    struct query_body *body = &definition.body[0];
    geometry_write_none(3, none);
    for (int i = 0; i < 3; i++) {
        definition = (struct definition){.body_count = 1, .status = i == 1 ? FMB_BUSY : FMB_OK};
        body->geometry = i == 2 ? (struct geometry){none, sizeof none} : placement.geometry;
        body->handle = hasher_handle(hasher, body->geometry.bytes, body->geometry.size);
        const size_t size = wire_write_definition(&definition, bytes);
        const char *error = wire_read_definition(bytes, (uint32_t) size, hasher, &read);
        assert_int_equal(error == NULL, i == 0);
    }
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
        result.handle[0].bytes[0] = 10;
        result.method = 1;
        result.dim = dim;
        result.answer.verdict = FMB_OVERLAPPING;
        result.answer.has_contact = result.answer.has_box = true;
        result.answer.contact[1] = 0.25;
        for (int axis = 0; axis < dim; axis++)
            result.answer.box[1][axis] = 1.0 / (axis + 3);
        result.answer.box[1][0] = HUGE_VAL;
        result.answer.has_gap = true;
        result.answer.gap = (struct fmb_gap){.bounds = {-0.5, -0.25}, .direction = {0, -1}};
        result.compute_ns = 1234;
        unsigned char bytes[QUERY_BYTES_MAX];
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

static void test_pair_result_apart_round_trip(void **state)
{
    (void) state;
    for (int dim = 2; dim <= 3; dim++) {
        struct pair_result result, read;
        unsigned char bytes[QUERY_BYTES_MAX];
        memset(&result, 0, sizeof result);
        result.dim = dim;
        result.answer.verdict = FMB_SEPARATED;
        result.answer.has_gap = true;
        struct fmb_gap *gap = &result.answer.gap;
        gap->bounds[0] = 1e-9;
        gap->bounds[1] = HUGE_VAL;
        gap->has_witness = true;
        gap->time = 0.5;
        for (int axis = 0; axis < dim; axis++) {
            gap->direction[axis] = 1.0 / (axis + 3);
            gap->witness[0][axis] = axis + 1;
            gap->witness[1][axis] = -axis - 1;
        }
        size_t size = wire_write_pair_result(&result, bytes);
        assert_null(wire_read_pair_result(bytes, (uint32_t) size, &read));
        assert_memory_equal(&result, &read, sizeof result);
        ASSERT_AS_LCM_WRITES(fmb_msgs_pair_result_t, bytes, size);
    }
}

/* A result with this certificate, as no service need have written it. */
static size_t write_certificate(char *certificate, int32_t status, int32_t verdict,
                                unsigned char *out, size_t capacity)
{
    char detail[] = "";
    fmb_msgs_pair_result_t message = {
        .status = status, .detail = detail, .verdict = verdict, .certificate = certificate};
    int size = fmb_msgs_pair_result_t_encode(out, 0, (int) capacity, &message);
    assert_true(size > 0);
    return (size_t) size;
}

static void test_certificates_end_somewhere(void **state)
{
    (void) state;
    static char text[3 * FMB_CERTIFICATE_MAX];
    static unsigned char bytes[4 * FMB_CERTIFICATE_MAX];
    const size_t longest = FMB_CERTIFICATE_MAX - 1;
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
            assert_true(wire_write_pair_result(&result, bytes + size) <= QUERY_BYTES_MAX);
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
        unsigned char bytes[WIRE_STATUS_BYTES_MAX];
        struct pair_result result;
        size_t size = write_certificate(text, FMB_OK, FMB_SEPARATED, bytes, sizeof bytes);
        const char *error = wire_read_pair_result(bytes, (uint32_t) size, &result);
        assert_int_equal(error == NULL, byte >= ' ' && byte <= '~');
    }
}

static void test_certificates_have_a_verdict(void **state)
{
    (void) state;
    char some[] = "separated + a0", none[] = "";
    unsigned char bytes[WIRE_STATUS_BYTES_MAX];
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
    unsigned char bytes[QUERY_BYTES_MAX];
    size_t size = wire_write_pair_result(&result, bytes);
    assert_null(wire_read_pair_result(bytes, (uint32_t) size, &read));
    assert_int_equal(read.status, FMB_NOT_FINITE);
    assert_string_equal(read.detail, "a.origin[1]: bad");
    ASSERT_AS_LCM_WRITES(fmb_msgs_pair_result_t, bytes, size);
}

static bool is_accepted(const struct pair_result *result)
{
    unsigned char bytes[QUERY_BYTES_MAX];
    struct pair_result read;
    return !wire_read_pair_result(bytes, (uint32_t) wire_write_pair_result(result, bytes), &read);
}

/* Bodies that are separated have witness points, and no others do; those that touch have a gap of
 * 0.
 */
static void test_gaps_are_consistent(void **state)
{
    (void) state;
    for (int verdict = 0; verdict <= FMB_OVERLAPPING; verdict++)
        for (int witness = 0; witness < 2; witness++) {
            struct pair_result result = {.status = verdict ? FMB_OK : FMB_BUSY, .dim = 3};
            struct fmb_gap *gap = &result.answer.gap;
            result.answer.verdict = (enum fmb_verdict) verdict;
            result.answer.has_contact = verdict >= FMB_TOUCHING;
            result.answer.has_gap = true;
            gap->has_witness = witness;
            const bool good = verdict > 0 && witness == (verdict == FMB_SEPARATED);
            assert_int_equal(is_accepted(&result), good);
            gap->bounds[1] = 1;
            assert_int_equal(is_accepted(&result), good && verdict != FMB_TOUCHING);
            gap->bounds[0] = 2;
            assert_false(is_accepted(&result));
            gap->bounds[0] = NAN;
            assert_false(is_accepted(&result));
        }
}

/* A box in 3D beside a gap in 2D. */
static void test_box_and_gap_have_one_dimension(void **state)
{
    (void) state;
    double zero[6] = {0};
    char empty[] = "";
    for (int dim = 2; dim <= 3; dim++) {
        fmb_msgs_pair_result_t message = {.detail = empty,
                                          .verdict = FMB_OVERLAPPING,
                                          .num_contact = 2,
                                          .contact = zero,
                                          .num_box = 6,
                                          .box = zero,
                                          .num_gap = 2,
                                          .gap = zero,
                                          .num_direction = dim,
                                          .direction = zero,
                                          .certificate = empty};
        unsigned char bytes[WIRE_STATUS_BYTES_MAX];
        struct pair_result read;
        const int size = fmb_msgs_pair_result_t_encode(bytes, 0, sizeof bytes, &message);
        assert_true(size > 0);
        assert_int_equal(wire_read_pair_result(bytes, (uint32_t) size, &read) == NULL, dim == 3);
    }
}

/* Bodies that meet have a contact interval, and only they may have a box; only pairs that were
 * decided have a verdict. */
static void test_answers_are_consistent(void **state)
{
    (void) state;
    static const struct {
        int32_t status, verdict;
        bool contact, box, accepted;
    } cases[] = {
        {FMB_OK, FMB_TOUCHING, true, true, true},
        {FMB_OK, FMB_TOUCHING, true, false, true},
        {FMB_OK, FMB_TOUCHING, false, true, false},
        {FMB_OK, FMB_OVERLAPPING, false, false, false},
        {FMB_OK, FMB_SEPARATED, false, false, true},
        {FMB_OK, FMB_SEPARATED, true, false, false},
        {FMB_OK, FMB_SEPARATED, false, true, false},
        {FMB_OK, 0, false, false, false},
        {FMB_OK, FMB_OVERLAPPING + 1, false, false, false},
        {FMB_BUSY, 0, false, false, true},
        {FMB_BUSY, 0, true, false, false},
        {FMB_BUSY, 0, false, true, false},
        {FMB_BUSY, FMB_TOUCHING, false, false, false},
        {FMB_BUSY, FMB_OVERLAPPING + 1, true, true, false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct pair_result result = {.status = cases[i].status, .dim = 3};
        result.answer.verdict = (enum fmb_verdict) cases[i].verdict;
        result.answer.has_contact = cases[i].contact;
        result.answer.has_box = cases[i].box;
        assert_int_equal(is_accepted(&result), cases[i].accepted);
    }
}

/* A contact interval is finite, ordered and not negative; a box may be infinite, but has an order.
 */
static void test_intervals_and_boxes_are_such(void **state)
{
    (void) state;
    static const struct {
        double contact[2], box[2];
        bool accepted;
    } cases[] = {
        {{0, 1}, {0, 1}, true},         {{0, 1}, {-HUGE_VAL, HUGE_VAL}, true},
        {{0, HUGE_VAL}, {0, 1}, false}, {{HUGE_VAL, HUGE_VAL}, {0, 1}, false},
        {{1, 0}, {0, 1}, false},        {{-1, 0}, {0, 1}, false},
        {{NAN, 1}, {0, 1}, false},      {{0, NAN}, {0, 1}, false},
        {{0, 1}, {1, 0}, false},        {{0, 1}, {NAN, 1}, false},
        {{0, 1}, {0, NAN}, false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct pair_result result = {.dim = 3};
        result.answer.verdict = FMB_TOUCHING;
        result.answer.has_contact = result.answer.has_box = true;
        for (int end = 0; end < 2; end++) {
            result.answer.contact[end] = cases[i].contact[end];
            result.answer.box[end][i % 3] = cases[i].box[end];
        }
        assert_int_equal(is_accepted(&result), cases[i].accepted);
    }
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
    unsigned char bytes[WIRE_STATUS_BYTES_MAX];
    size_t size = wire_write_status(&status, bytes);
    assert_null(wire_read_status(bytes, (uint32_t) size, &read));
    assert_memory_equal(&status, &read, sizeof status);
    ASSERT_AS_LCM_WRITES(fmb_msgs_status_t, bytes, size);
}

/* A newer service may have more counters, in another order, and a longer version. */
static void test_status_of_a_newer_service(void **state)
{
    (void) state;
    char version[] = "10.20.30-with-a-long-name-that-goes-on-and-on";
    char text[][24] = {"result_CANNOT_DECIDE", "received_twice", "compute_max_ns", "", "received"};
    char *names[] = {text[0], text[1], text[2], text[3], text[4]};
    int64_t values[] = {3, 4, 6, 7, -8};
    fmb_msgs_status_t message = {
        .version = version, .num_counters = 5, .names = names, .values = values};
    unsigned char bytes[WIRE_STATUS_BYTES_MAX];
    struct wire_status status;
    int size = fmb_msgs_status_t_encode(bytes, 0, sizeof bytes, &message);
    assert_true(size > 0);
    assert_null(wire_read_status(bytes, (uint32_t) size, &status));
    assert_int_equal(status.results[FMB_CANNOT_DECIDE], 3);
    assert_int_equal(status.compute_max_ns, 6);
    assert_int_equal(status.received, -8);
    assert_int_equal(status.answered, 0);
    assert_memory_equal(status.version, version, sizeof status.version - 1);
}

static void test_names_round_trip(void **state)
{
    (void) state;
    static struct names names, read;
    static unsigned char bytes[QUERY_BYTES_MAX];
    names = (struct names){.utime = 5, .count = 2, .client_id = {1, -1}, .body_id = {7, INT64_MAX}};
    names.name[0] = "table";
    names.name[1] = "\xff\n";
    const size_t size = wire_write_names(&names, bytes);
    assert_int_equal(size, WIRE_NAMES_BYTES + 2 * 21 + 5 + 2);
    assert_null(wire_read_names(bytes, (uint32_t) size, &read));
    assert_int_equal(read.utime, 5);
    assert_int_equal(read.count, 2);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(read.client_id[i], names.client_id[i]);
        assert_int_equal(read.body_id[i], names.body_id[i]);
        assert_string_equal(read.name[i], names.name[i]);
    }
    ASSERT_AS_LCM_WRITES(fmb_msgs_names_t, bytes, size);
    names.count = QUERY_NAMES_MAX;
    for (int i = 0; i < names.count; i++)
        names.name[i] = "";
    assert_null(wire_read_names(bytes, (uint32_t) wire_write_names(&names, bytes), &read));
    assert_int_equal(read.count, QUERY_NAMES_MAX);
}

/* Messages of old versions have their own words, so that logs and services can name the version. */
static void test_old_versions_are_named(void **state)
{
    (void) state;
    const struct {
        uint64_t fingerprint;
        int version;
        const char *name, *mismatch;
    } cases[] = {
        {0x1704231dbc74a72c, 1, "fmb_msgs.pair_query_t (version 1)", "version 1"},
        {0xf9dadc6e7e54da5d, 2, "fmb_msgs.pair_query_t (version 2)", "version 2"},
        {0xf632860e1441ef51, 2, "fmb_msgs.scene_query_t (version 2)", "version 2"},
        {0x8cb2ead8b5dc3d8d, 2, "fmb_msgs.status_t (version 2)", "version 2"},
        {0x6d5222ebc7de383d, 2, "fmb_msgs.definition_t (version 2)", "version 2"},
        {(uint64_t) __fmb_msgs_scene_query_t_get_hash(), 0, "fmb_msgs.scene_query_t", "another"},
        {0xe2c4e2ab0ebcd9d9, 0, "fmb_msgs.definition_query_t", "another"},
        {5, 0, NULL, "another"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const int64_t fingerprint = (int64_t) cases[i].fingerprint;
        unsigned char bytes[8];
        struct pair_query query;
        big_endian_put_64(bytes, cases[i].fingerprint);
        assert_int_equal(wire_type_old_version(fingerprint), cases[i].version);
        if (cases[i].name)
            assert_string_equal(wire_type_name(fingerprint), cases[i].name);
        else
            assert_null(wire_type_name(fingerprint));
        assert_non_null(
            strstr(wire_read_pair_query(bytes, sizeof bytes, &query), cases[i].mismatch));
    }
}

static int set_up(void **state)
{
    (void) state;
    hasher = hasher_create();
    return hasher ? 0 : -1;
}

static int tear_down(void **state)
{
    (void) state;
    hasher_destroy(hasher);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fingerprints_are_pinned),
        cmocka_unit_test(test_damage_is_refused),
        cmocka_unit_test(test_negative_size_is_refused),
        cmocka_unit_test(test_short_headers_are_refused),
        cmocka_unit_test(test_mutants_are_survived),
        cmocka_unit_test(test_pair_query_round_trip),
        cmocka_unit_test(test_long_lists_are_read),
        cmocka_unit_test(test_geometry_round_trip),
        cmocka_unit_test(test_numbers_of_frames),
        cmocka_unit_test(test_geometry_of_many_frames),
        cmocka_unit_test(test_a_later_frame_that_does_not_fit),
        cmocka_unit_test(test_geometry_that_does_not_fit),
        cmocka_unit_test(test_a_frame_by_vertices_has_their_count),
        cmocka_unit_test(test_handles_are_hashes_of_the_encoding),
        cmocka_unit_test(test_handles_distinguish_zeros),
        cmocka_unit_test(test_definition_query_round_trip),
        cmocka_unit_test(test_definition_round_trip),
        cmocka_unit_test(test_definitions_match_their_handles),
        cmocka_unit_test(test_definitions_have_frames_and_status_ok),
        cmocka_unit_test(test_pair_result_round_trip),
        cmocka_unit_test(test_pair_result_apart_round_trip),
        cmocka_unit_test(test_certificates_end_somewhere),
        cmocka_unit_test(test_certificates_are_printable),
        cmocka_unit_test(test_certificates_have_a_verdict),
        cmocka_unit_test(test_refusal_round_trip),
        cmocka_unit_test(test_gaps_are_consistent),
        cmocka_unit_test(test_box_and_gap_have_one_dimension),
        cmocka_unit_test(test_answers_are_consistent),
        cmocka_unit_test(test_intervals_and_boxes_are_such),
        cmocka_unit_test(test_status_round_trip),
        cmocka_unit_test(test_status_of_a_newer_service),
        cmocka_unit_test(test_names_round_trip),
        cmocka_unit_test(test_old_versions_are_named),
    };
    return cmocka_run_group_tests_name("wire", tests, set_up, tear_down);
}
