/* Limits, geometries, handles and names of the codec. The corpora of tests/fuzz prove
 * that it writes the bytes of lcm-gen, reads them back and refuses all others. */
#include "unit.h"

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

/* A change of any field changes the fingerprint, and with it breaks every old client and log. */
static void fingerprints_are_pinned(void **state)
{
    assert_int_equal(__fmb_msgs_body_t_get_hash(), 0x18fc974de94f47b6u);
    assert_int_equal(__fmb_msgs_definition_query_t_get_hash(), 0xe2c4e2ab0ebcd9d9u);
    assert_int_equal(__fmb_msgs_definition_t_get_hash(), 0xef476d61362c5fbau);
    assert_int_equal(__fmb_msgs_names_t_get_hash(), 0xc5646e8cb4490b7cu);
    assert_int_equal(__fmb_msgs_pair_query_t_get_hash(), 0x07880d0b8ca7b624u);
    assert_int_equal(__fmb_msgs_pair_result_t_get_hash(), 0x44daa0700d3b2b97u);
    assert_int_equal(__fmb_msgs_placement_t_get_hash(), 0x8e860009f2301ec1u);
    assert_int_equal(__fmb_msgs_scene_query_t_get_hash(), 0x3104e734f0051957u);
    assert_int_equal(__fmb_msgs_scene_result_t_get_hash(), 0x437691c0f4a35986u);
    assert_int_equal(__fmb_msgs_status_t_get_hash(), 0x15fcba856d637fcau);
}

/* LCM hands on a size that is a negative int for some short packets. */
static void negative_size_is_refused(void **state)
{
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

/* Counts that no body has make a query that is answered, not a malformed one: the reader keeps what
 * fits, and the counts. */
static void long_lists_are_read(void **state)
{
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
                                      .velocity = many,
                                      .num_end_pose = 20,
                                      .end_pose = many};
    char none[] = "";
    placement.name = none;
    fmb_msgs_pair_query_t message = {.a = placement, .b.name = none};
    message.b.num_end_pose = 9;
    message.b.end_pose = many;
    int size = fmb_msgs_pair_query_t_encode(bytes, 0, sizeof bytes, &message);
    struct pair_query query;
    assert_true(size > 0);
    assert_null(wire_read_pair_query(bytes, (uint32_t) size, &query));
    assert_int_equal(query.placement[0].body.dim, 500);
    assert_int_equal(query.placement[0].body.frame_count, 300);
    assert_int_equal(query.placement[0].body.count_count, 200);
    assert_int_equal(query.placement[0].body.number_count, 100);
    assert_int_equal(query.placement[0].placed.orientation_count, 70);
    assert_int_equal(query.placement[0].velocity_count, 10);
    assert_int_equal(query.placement[0].body.size, 4 + 4 + 300 + 4 + 800 + 4 + 800);
    assert_int_equal(query.placement[0].placed.end_count, 20);
    assert_int_equal(query.placement[1].body.dim, 0);
    assert_int_equal(query.placement[1].placed.end_count, 9);
}

/* ---- Geometries and handles ---- */

static void geometries_are_read_back(void **state)
{
    for (int dim = 2; dim <= 3; dim++)
        for (int code = 1; code <= 23; code = code == 7 ? 17 : code + 1) {
            const int shape = geometry_shape(code).shape;
            unsigned char bytes[GEOMETRY_FRAME_BYTES_MAX];
            struct plain_frame read;
            if (geometry_number_count(dim, shape, 0) == 0)
                continue;
            struct plain_frame frame = sample_frame(dim, shape);
            frame.by_vertices = geometry_shape(code).by_vertices;
            frame.has_radius = geometry_shape(code).has_radius;
            frame.radius = frame.has_radius ? 0.1 : 0;
            const struct body_view geometry = geometry_write(dim, &frame, bytes);
            assert_int_equal(geometry.size, geometry_size(dim, &frame, 1));
            assert_int_equal(bytes[8], code);
            assert_int_equal(geometry.number_count, geometry_number_count(dim, code, 0));
            struct geometry_reader reader = geometry_begin(&geometry);
            assert_int_equal(reader.dim, dim);
            assert_true(geometry_read(&reader, &read));
            assert_memory_equal(&frame, &read, sizeof frame);
        }
}

static void shapes_have_their_count_of_numbers(void **state)
{
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
static void geometries_of_many_frames_are_read_back(void **state)
{
    static struct plain_frame frames[QUERY_FRAMES_MAX];
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
        const struct body_view geometry = geometry_write_frames(dim, frames, count, bytes);
        assert_int_equal(geometry.size, geometry_size(dim, frames, count));
        assert_true(geometry.size <= QUERY_BYTES_MAX);
        struct geometry_reader reader = geometry_begin(&geometry);
        struct plain_frame read;
        assert_int_equal(reader.dim, dim);
        assert_int_equal(reader.frames_left, count);
        for (int i = 0; i < count; i++) {
            assert_true(geometry_read(&reader, &read));
            assert_memory_equal(&frames[i], &read, sizeof read);
        }
        assert_false(geometry_read(&reader, &read));
        assert_int_equal(reader.numbers_left, 0);
    }
}

/* What no frame is made of is refused, whatever the counts are. */
static void inconsistent_bodies_have_no_frames(void **state)
{
    unsigned char bytes[GEOMETRY_FRAME_BYTES_MAX];
    const struct plain_frame frame = {.shape = FMB_CUBOID};
    const struct body_view good = geometry_write(3, &frame, bytes);
    const struct {
        struct body_view body;
        unsigned char shape;
    } bodies[] = {{.body.dim = 1},
                  {.body.dim = 4},
                  {.body.dim = INT32_MIN},
                  {.shape = 255},
                  {.shape = 9},
                  {.body.number_count = 11},
                  {.body.frame_count = -1},
                  {.shape = FMB_HULL},
                  {.shape = 6},
                  {.shape = 7}};
    for (size_t i = 0; i < COUNT(bodies); i++) {
        struct body_view body = good;
        struct plain_frame read;
        bytes[4 + 4] = bodies[i].shape ? bodies[i].shape : FMB_CUBOID;
        body.dim = bodies[i].body.dim ? bodies[i].body.dim : 3;
        body.number_count = bodies[i].body.number_count ? bodies[i].body.number_count : 12;
        struct geometry_reader reader = geometry_begin(&body);
        reader.frames_left += bodies[i].body.frame_count;
        assert_false(geometry_read(&reader, &read));
    }
}

/* The handle is what any SHA-256 makes of the bytes between handle and position, as lcm-gen's own
 * encoder writes them: a client in any language can compute it. */
static void handles_are_hashes_of_the_encoding(void **state)
{
    static const unsigned char abc[HANDLE_BYTES] = {0xba, 0x78, 0x16, 0xbf, 0x8f, 0x01, 0xcf, 0xea,
                                                    0x41, 0x41, 0x40, 0xde, 0x5d, 0xae, 0x22, 0x23};
    struct handle handle = handle_of((const unsigned char *) "abc", 3);
    assert_memory_equal(handle.bytes, abc, sizeof abc);

    unsigned char bytes[GEOMETRY_FRAME_BYTES_MAX], encoded[HOSTILE_BYTES_MAX];
    struct plain_frame frame = {.shape = FMB_TETRAHEDRON, .components = {1, 0, 0, 1}};
    const size_t size = geometry_write(2, &frame, bytes).size;
    uint8_t shapes[1] = {FMB_TETRAHEDRON};
    double numbers[6] = {0, 0, 1, 0, 0, 1};
    fmb_msgs_body_t body = {
        .dim = 2, .num_frames = 1, .shapes = shapes, .num_numbers = 6, .numbers = numbers};
    const int encoded_size = fmb_msgs_body_t_encode(encoded, 0, sizeof encoded, &body);
    assert_int_equal(encoded_size, 8 + HANDLE_BYTES + size);
    assert_memory_equal(encoded + 8 + HANDLE_BYTES, bytes, size);
}

static void handles_distinguish_zeros(void **state)
{
    unsigned char bytes[2][GEOMETRY_FRAME_BYTES_MAX];
    struct handle handle[2];
    for (int i = 0; i < 2; i++) {
        struct plain_frame frame = {.shape = FMB_CUBOID, .components = {1, i ? -0.0 : 0.0}};
        const size_t size = geometry_write(2, &frame, bytes[i]).size;
        handle[i] = handle_of(bytes[i], size);
        assert_false(handle_is_none(&handle[i]));
    }
    assert_false(handle_equal(&handle[0], &handle[1]));
}

/* A newer service may have more counters, in another order, and a longer version. */
static void a_heartbeat_of_a_newer_service_is_read(void **state)
{
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

static void names_are_read_back(void **state)
{
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
    static unsigned char encoded[QUERY_BYTES_MAX];
    fmb_msgs_names_t message;
    assert_int_equal(fmb_msgs_names_t_decode(bytes, 0, (int) size, &message), size);
    assert_int_equal(fmb_msgs_names_t_encode(encoded, 0, sizeof encoded, &message), size);
    assert_memory_equal(encoded, bytes, size);
    fmb_msgs_names_t_decode_cleanup(&message);
    names.count = QUERY_NAMES_MAX;
    for (int i = 0; i < names.count; i++)
        names.name[i] = "";
    assert_null(wire_read_names(bytes, (uint32_t) wire_write_names(&names, bytes), &read));
    assert_int_equal(read.count, QUERY_NAMES_MAX);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fingerprints_are_pinned),
        cmocka_unit_test(negative_size_is_refused),
        cmocka_unit_test(long_lists_are_read),
        cmocka_unit_test(geometries_are_read_back),
        cmocka_unit_test(shapes_have_their_count_of_numbers),
        cmocka_unit_test(geometries_of_many_frames_are_read_back),
        cmocka_unit_test(inconsistent_bodies_have_no_frames),
        cmocka_unit_test(handles_are_hashes_of_the_encoding),
        cmocka_unit_test(handles_distinguish_zeros),
        cmocka_unit_test(a_heartbeat_of_a_newer_service_is_read),
        cmocka_unit_test(names_are_read_back),
    };
    return cmocka_run_group_tests_name("wire", tests, NULL, NULL);
}
