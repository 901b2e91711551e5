/* What a pair query gets: the right answer, or the status that says what is wrong and where. */
#include "unit.h"

#include "answer_now.h"
#include "big_endian.h"
#include "body.h"
#include "geometry_write.h"
#include "wire.h"
#include "writer.h"

#include "fmb_msgs_placement_t.h"

#include <math.h>

static struct answerer *answerer;
static struct answer_job *job;

static int set_up_frames(size_t frames)
{
    const struct answerer_options options = {frames, .server_id = 99,
                                             .secret = {0x243f6a8885a308d3, 0x13198a2e03707344}};
    answerer = answerer_create(&options);
    job = answer_job_create();
    return answerer && job ? 0 : -1;
}

static int set_up(void **state)
{
    return set_up_frames(2);
}

static int set_up_many(void **state)
{
    return set_up_frames(300);
}

static int set_up_one(void **state)
{
    return set_up_frames(1);
}

static int tear_down(void **state)
{
    answer_job_destroy(job);
    answerer_destroy(answerer);
    return 0;
}

static struct cache_counts counts(void)
{
    return cache_counts(answerer_cache(answerer));
}

/* Where the geometries of the query are: many frames fit. */
static unsigned char bytes[2][20000];

static const struct plain_frame unit_cube = {.shape = FMB_CUBOID,
                                             .components = {1, 0, 0, 0, 1, 0, 0, 0, 1}};

/* Body f + 1, of several frames. */
static void set_frames(struct pair_query *query, int f, int dim, const struct plain_frame *frames,
                       int count)
{
    struct query_placement *placement = &query->placement[f];
    assert_true(geometry_size(dim, frames, count) <= sizeof bytes[f]);
    *placement = (struct query_placement){
        .placed.id = f + 1, .body = geometry_write_frames(dim, frames, count, bytes[f])};
}

/* The handle in place of the frames. */
static void name(struct query_placement *placement, const struct handle *handle)
{
    placement->body = geometry_named(placement->body.dim, handle);
}

/* Two unit cubes, bodies 1 and 2, the second moved by half an edge. */
static struct pair_query cubes(void)
{
    struct pair_query query = {.utime = 3, .client_id = 4, .sequence_number = 5, .duration = 1};
    for (int f = 0; f < 2; f++)
        set_frames(&query, f, 3, &unit_cube, 1);
    query.placement[1].placed.position[0] = 0.5;
    return query;
}

/* The same with another second body. */
static struct pair_query stretched(double length)
{
    struct pair_query query = cubes();
    struct plain_frame cuboid = unit_cube;
    cuboid.components[0] = length;
    set_frames(&query, 1, 3, &cuboid, 1);
    query.placement[1].placed.position[0] = 0.5;
    return query;
}

/* Two unit squares. */
static struct pair_query squares(void)
{
    const struct plain_frame square = {.shape = FMB_CUBOID, .components = {1, 0, 0, 1}};
    struct pair_query query = {.client_id = 4, .duration = 1};
    for (int f = 0; f < 2; f++)
        set_frames(&query, f, 2, &square, 1);
    return query;
}

static struct plain_frame box(double centre, double size)
{
    return (struct plain_frame){
        .shape = FMB_BOX, .origin = {centre}, .components = {size, size, size}};
}

/* Number k of the geometry of one frame. */
static void put_number(int f, int k, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    big_endian_put_64(bytes[f] + 4 + 4 + 1 + 4 + 4 + 8 * k, bits);
}

/* A geometry of any counts, all numbers 0. */
static void set_geometry(struct pair_query *query, int f, int32_t dim, int32_t frames, int shape,
                         int32_t numbers)
{
    unsigned char *at = bytes[f];
    struct query_placement *placement = &query->placement[f];
    memset(at, 0, sizeof bytes[f]);
    big_endian_put_32(at, (uint32_t) dim);
    big_endian_put_32(at + 4, (uint32_t) frames);
    memset(at + 8, shape, (size_t) frames);
    big_endian_put_32(at + 8 + frames + 4, (uint32_t) numbers); /* after the number of counts */
    placement->body =
        (struct body_view){.dim = dim,
                           .frame_count = frames,
                           .number_count = numbers,
                           .bytes = at,
                           .size = (size_t) (GEOMETRY_NONE_BYTES + frames + 8 * numbers)};
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

/* Ends the counts of a case. */
enum { END = INT32_MIN };

static void a_pair_is_answered_and_its_ids_are_echoed(void **state)
{
    struct pair_query query = cubes();
    query.want = FMB_WANT_BOX;
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
        const struct body_view *geometry = &query.placement[f].body;
        const struct handle handle = handle_of(geometry->bytes, geometry->size);
        assert_true(handle_equal(&result.handle[f], &handle));
    }
    assert_int_equal(result.method, fmb_method_default()->number);
    assert_int_equal(result.answer.verdict, FMB_OVERLAPPING);
    assert_true(result.answer.has_contact); /* also at rest */
    assert_true(result.answer.contact[0] == 0 && result.answer.contact[1] == 1);
    assert_int_equal(result.dim, 3);
    assert_true(result.answer.box[0][0] == 0.5 && result.answer.box[1][0] == 1);
    assert_int_equal(counts().bodies, 1); /* both have one geometry */
}

/* Also without an id, or with another one. */
static void handles_stand_for_frames(void **state)
{
    struct pair_query query = stretched(2);
    const struct pair_result first = answer_to(&query);
    for (int64_t id = 0; id < 5; id++) {
        for (int f = 0; f < 2; f++) {
            query.placement[f].placed.id = id;
            name(&query.placement[f], &first.handle[f]);
        }
        query.placement[1].placed.position[0] = 1;
        const struct pair_result result = answer_to(&query);
        assert_int_equal(result.status, FMB_OK);
        assert_int_equal(result.answer.verdict, FMB_TOUCHING);
        assert_int_equal(result.body_id[0], id);
        assert_true(handle_is_none(&result.handle[0]) && handle_is_none(&result.handle[1]));
    }
    assert_int_equal(counts().hits, 10);
}

static void unknown_handles_are_refused(void **state)
{
    struct pair_query query = stretched(2);
    struct handle handle = answer_to(&query).handle[1];
    handle.bytes[15] ^= 1;
    query = stretched(7); /* would be kept */
    name(&query.placement[0], &handle);
    expect(&query, FMB_UNKNOWN_BODY, "a.handle: not held; send the frames");
    query = cubes();
    put_number(0, 3, 7);
    name(&query.placement[1], &handle);
    expect(&query, FMB_UNKNOWN_BODY, "b.handle: not held; send the frames");
}

static void a_handle_of_the_other_dimension_is_refused(void **state)
{
    const struct plain_frame square = {.shape = FMB_CUBOID, .components = {1, 0, 0, 1}};
    struct pair_query query = cubes();
    const struct handle handle = answer_to(&query).handle[0];
    for (int f = 0; f < 2; f++)
        set_frames(&query, f, 2, &square, 1);
    name(&query.placement[1], &handle);
    expect(&query, FMB_WRONG_DIMENSION, "b.dim: not that of the body with this handle");
}

/* With capacity for one, the second body of a query does not evict the first, which is in use, but
 * is made for this query alone. */
static void a_cache_of_one_frame_answers_whole_pairs(void **state)
{
    struct pair_query query = stretched(2);
    query.want = FMB_WANT_BOX;
    const struct pair_result first = answer_to(&query);
    assert_int_equal(first.status, FMB_OK);
    assert_int_equal(counts().bodies, 1);
    for (int f = 0; f < 2; f++) {
        query = stretched(2);
        query.want = FMB_WANT_BOX;
        if (f == 1) /* the first body is held */
            name(&query.placement[0], &first.handle[0]);
        const struct pair_result result = answer_to(&query);
        assert_memory_equal(&result.answer, &first.answer, sizeof result.answer);
        assert_true(handle_equal(&result.handle[1], &first.handle[1]));
    }
    query = stretched(2);
    name(&query.placement[1], &first.handle[1]);
    expect(&query, FMB_UNKNOWN_BODY, "b.handle: not held; send the frames");
    assert_int_equal(counts().evictions, 0);
    query.placement[0] = query.placement[1] = stretched(3).placement[1];
    assert_int_equal(answer_to(&query).status, FMB_OK); /* nothing is in use any more */
    assert_int_equal(counts().evictions, 1);
}

/* One id with two geometries in one pair: each placement is what it says. */
static void one_id_may_have_two_bodies(void **state)
{
    struct pair_query query = stretched(2);
    query.placement[0].placed.id = query.placement[1].placed.id = 9;
    for (int repeat = 0; repeat < 3; repeat++) {
        query.placement[0].placed.position[0] = repeat;
        const struct pair_result result = answer_to(&query);
        assert_int_equal(result.answer.verdict, FMB_OVERLAPPING);
        assert_false(handle_equal(&result.handle[0], &result.handle[1]));
    }
    query.placement[0].placed.position[0] = 2.75; /* beyond the second, were it a cube */
    assert_int_equal(answer_to(&query).answer.verdict, FMB_SEPARATED);
    assert_int_equal(counts().misses, 2);
}

static void anonymous_bodies_are_not_kept(void **state)
{
    struct pair_query query = cubes();
    query.placement[0].placed.id = query.placement[1].placed.id = 0;
    const struct pair_result result = answer_to(&query);
    assert_int_equal(result.status, FMB_OK);
    assert_true(handle_is_none(&result.handle[0]) && handle_is_none(&result.handle[1]));
    assert_int_equal(counts().bodies, 0);
    assert_int_equal(counts().misses, 0);
}

/* ---- Refusals ---- */

/* What is changed of two unit cubes, and what is said of it. */
#define REFUSED(change, status, detail)                                                        \
    do {                                                                                       \
        struct pair_query query = cubes();                                                     \
        struct query_placement *const a = &query.placement[0], *const b = &query.placement[1]; \
        (void) a, (void) b;                                                                    \
        change;                                                                                \
        expect(&query, status, detail);                                                        \
    } while (0)

/* clang-format off */
static void numbers_that_are_not_finite_are_refused(void **state)
{
    REFUSED(put_number(1, 4, NAN), FMB_NOT_FINITE, "b.numbers[4]: not a finite number");
    REFUSED(put_number(0, 0, INFINITY), FMB_NOT_FINITE, "a.numbers[0]: not a finite number");
    REFUSED(a->placed.position[2] = -INFINITY, FMB_NOT_FINITE, "a.position[2]: not a finite number");
    REFUSED(a->velocity_count = 3; a->placed.velocity[1] = INFINITY, FMB_NOT_FINITE,
            "a.velocity[1]: not a finite number");
}

static void wrong_counts_are_refused(void **state)
{
    const struct handle handle = {{1}};
    REFUSED(set_geometry(&query, 0, 3, 1, FMB_CUBOID, 9), FMB_WRONG_COUNT, "a.num_numbers: expected 12 numbers, found 9");
    REFUSED(set_geometry(&query, 1, 3, 1, FMB_FACE, 12), FMB_WRONG_COUNT, "b.num_numbers: expected 9 numbers, found 12");
    REFUSED(set_geometry(&query, 1, 3, 2, FMB_TETRAHEDRON, 12), FMB_WRONG_COUNT, "b.num_numbers: expected 24 numbers, found 12");
    REFUSED(set_geometry(&query, 1, 3, 1, FMB_BOX, 12), FMB_WRONG_COUNT, "b.num_numbers: expected 6 numbers, found 12");
    REFUSED(b->velocity_count = 2, FMB_WRONG_COUNT, "b.num_velocity: expected 3 numbers, found 2");
    REFUSED(a->placed.orientation_count = 3, FMB_WRONG_COUNT, "a.num_orientation: expected 4 numbers, found 3");
    REFUSED(a->placed.orientation_count = 5, FMB_WRONG_COUNT, "a.num_orientation: expected 4 numbers, found 5");
    REFUSED(query = squares(); b->placed.orientation_count = 4, FMB_WRONG_COUNT,
            "b.num_orientation: expected 2 numbers, found 4");
    REFUSED(a->body.handle = handle, FMB_WRONG_COUNT, "a.num_frames: both a handle and frames");
    REFUSED(set_geometry(&query, 1, 3, 0, 0, 2); b->body.handle = handle, FMB_WRONG_COUNT,
            "b.num_numbers: expected 0 numbers, found 2");
    REFUSED(set_geometry(&query, 1, 3, 0, 0, 0), FMB_NO_FRAMES, "b.num_frames: neither a handle nor frames");
    REFUSED(set_geometry(&query, 1, 3, 0, 0, 12), FMB_NO_FRAMES, "b.num_frames: neither a handle nor frames");
}

static void unknown_shapes_and_dimensions_are_refused(void **state)
{
    for (int shape = 0; shape < 256; shape++) {
        const int core = shape & ~FMB_MSGS_PLACEMENT_T_SHAPE_RADIUS;
        if (shape >= 32 || core < FMB_CUBOID || core > 7)
            REFUSED(bytes[0][8] = (unsigned char) shape, FMB_UNKNOWN_SHAPE, "a.shapes[0]: unknown shape");
    }
    REFUSED(set_geometry(&query, 1, 3, 3, FMB_CUBOID, 36); bytes[1][8 + 2] = 9, FMB_UNKNOWN_SHAPE,
            "b.shapes[2]: unknown shape");
    for (int dim = 0; dim < 2; dim++)
        REFUSED(set_geometry(&query, 0, dim, 1, FMB_CUBOID, 12), FMB_WRONG_DIMENSION, "a.dim: neither 2 nor 3");
    REFUSED(set_geometry(&query, 0, 2, 1, FMB_FACE, 6), FMB_WRONG_DIMENSION, "a.dim: a face is in 3D");
    REFUSED(set_geometry(&query, 0, 2, 1, FMB_CUBOID, 6), FMB_DIMENSIONS_DIFFER, "dim: a 2D body against a 3D one");
}

/* Gives a placement an end with this orientation. An orientation that is missing at the beginning
 * is set to (1, 0, 0, 0). */
static void set_end(struct query_placement *placement, const double q[4])
{
    struct fmb_placement *placed = &placement->placed;
    const int dim = placement->body.dim;
    placed->orientation_count = 2 * dim - 2;
    placed->orientation[0] += placed->orientation[0] == 0;
    placed->end_count = 3 * dim - 2;
    memcpy(placed->end_position, placed->position, sizeof placed->position);
    memcpy(placed->end_orientation, q, (size_t) placed->orientation_count * sizeof *q);
}

static void bad_ends_are_refused(void **state)
{
    static const char detail[] = "a.end_pose: no orientation, half a turn away, or not from 1/4 to 4 times as long";
    const double turned[4] = {1, 0, 0, 1}, bad[][4] = {{0, 0, 0, 0}, {0, 0, 0, 1}, {4.000000000000001, 0, 0, 0},
        {0.24999999999999997, 0, 0, 0}, {1, 0, 0x1p-201, 0}, {0, 1, 1e-3, 1e200}};
    for (size_t i = 0; i < COUNT(bad); i++)
        REFUSED(set_end(a, bad[i]), FMB_BAD_ORIENTATION, detail);
    REFUSED(set_end(a, turned); a->placed.end_orientation[2] = NAN, FMB_NOT_FINITE, "a.end_pose[5]: not a finite number");
    REFUSED(set_end(a, turned); a->placed.end_position[1] = -INFINITY, FMB_NOT_FINITE, "a.end_pose[1]: not a finite number");
    for (int k = 1; k <= 6; k++) {
        char text[60];
        snprintf(text, sizeof text, "b.num_end_pose: expected 7 numbers, found %d", k);
        REFUSED(set_end(b, turned); b->placed.end_count = k, FMB_WRONG_COUNT, text);
    }
    REFUSED(set_end(b, turned); b->placed.orientation_count = 0, FMB_WRONG_COUNT, "b.num_end_pose: expected 3 numbers, found 7");
    REFUSED(set_end(b, turned); b->velocity_count = 3, FMB_WRONG_COUNT, "b.num_end_pose: a velocity too");
    REFUSED(set_end(b, turned); query.duration = 0, FMB_BAD_DURATION, "b.num_end_pose: the duration is 0");
    REFUSED(query = squares(); set_end(a, (double[4]){0, 1}), FMB_BAD_ORIENTATION, detail);
    REFUSED(query = squares(); set_end(a, turned); a->placed.end_count = 5, FMB_WRONG_COUNT,
            "a.num_end_pose: expected 4 numbers, found 5");
}

/* The second body is a rounded cube of which number k is this one. */
static struct pair_query with_number(int k, double value)
{
    struct pair_query query = cubes();
    set_geometry(&query, 1, 3, 1, FMB_MSGS_PLACEMENT_T_SHAPE_RADIUS + FMB_CUBOID, 13);
    put_number(1, k, value);
    return query;
}

static void bad_radii_are_refused(void **state)
{
    for (int k = 1; k <= 7; k++)
        if (k != FMB_HULL && k < 6)
            REFUSED(set_geometry(&query, 1, 3, 1, FMB_MSGS_PLACEMENT_T_SHAPE_RADIUS + k, 11), FMB_WRONG_COUNT,
                    k == FMB_FACE  ? "b.num_numbers: expected 10 numbers, found 11"
                    : k == FMB_BOX ? "b.num_numbers: expected 7 numbers, found 11"
                                   : "b.num_numbers: expected 13 numbers, found 11");
    REFUSED(query = with_number(0, NAN), FMB_NOT_FINITE, "b.numbers[0]: not a finite number");
    REFUSED(query = with_number(0, INFINITY), FMB_NOT_FINITE, "b.numbers[0]: not a finite number");
    REFUSED(query = with_number(0, -1), FMB_BAD_SIZE, "b.numbers[0]: a negative radius");
    REFUSED(query = with_number(0, -0x1p-1074), FMB_BAD_SIZE, "b.numbers[0]: a negative radius");
    REFUSED(query = with_number(12, -INFINITY), FMB_NOT_FINITE, "b.numbers[12]: not a finite number");
    REFUSED(set_geometry(&query, 1, 3, 2, FMB_MSGS_PLACEMENT_T_SHAPE_RADIUS + FMB_BOX, 14);
            big_endian_put_64(bytes[1] + GEOMETRY_NONE_BYTES + 2 + 8 * 13, 0xbff0000000000000),
            FMB_BAD_SIZE, "b.numbers[13]: a negative size");
    REFUSED(set_geometry(&query, 1, 3, 2, FMB_MSGS_PLACEMENT_T_SHAPE_RADIUS + FMB_BOX, 14);
            big_endian_put_64(bytes[1] + GEOMETRY_NONE_BYTES + 2 + 8 * 7, 0xbff0000000000000),
            FMB_BAD_SIZE, "b.numbers[7]: a negative radius");
}

static void bad_orientations_are_refused(void **state)
{
    static const char detail[] = "b.orientation: zero, not finite, or components that differ by more than 2^200";
    const double q[][4] = {{0, 0, 0, 0}, {-0.0, 0, -0.0, 0}, {NAN, 0, 0, 1}, {1, INFINITY, 0, 0}, {0, 0, -INFINITY, 0},
                           {1, 0, 0x1p-201, 0}, {0x1p-1000, 0, 0, 1}};
    for (size_t i = 0; i < COUNT(q); i++)
        for (int by_handle = 0; by_handle < 2; by_handle++)
            REFUSED(b->placed.orientation_count = 4; memcpy(b->placed.orientation, q[i], sizeof q[i]);
                    if (by_handle) name(b, &(struct handle){{1}}), FMB_BAD_ORIENTATION, detail);
    struct pair_query query = squares();
    query.placement[1].placed.orientation_count = 2;
    expect(&query, FMB_BAD_ORIENTATION, detail);
    query.placement[1].placed.orientation[1] = -1e-150;
    assert_int_equal(answer_to(&query).status, FMB_OK);
    query = cubes();
    query.placement[1].placed.orientation_count = 4;
    memcpy(query.placement[1].placed.orientation, (const double[]){1, 0x1p-200, 0, 0}, 4 * sizeof(double));
    assert_int_equal(answer_to(&query).status, FMB_OK);
}

static void bad_requests_are_refused(void **state)
{
    const double durations[] = {-1, NAN, INFINITY, -5e-324};
    for (size_t i = 0; i < COUNT(durations); i++)
        REFUSED(query.duration = durations[i], FMB_BAD_DURATION, "duration: negative or not finite");
    REFUSED(query.method = 77, FMB_UNKNOWN_METHOD, "method: unknown method");
    for (int bit = 5; bit < 31; bit++) /* bits without a name */
        REFUSED(query.want = FMB_WANT_BOX | 1 << bit, FMB_UNKNOWN_WANT, "want: wants what this version does not give");
    for (int method = 2; method <= 3; method++)
        REFUSED(query.want = FMB_WANT_GAP; query.method = method, FMB_CANNOT_DECIDE, "method: gives no gaps");
    REFUSED(b->placed.id = QUERY_ID_MAX + 1, FMB_BAD_ID, "b.body_id: not from 0 to 2^53 - 1");
    REFUSED(b->placed.id = -1, FMB_BAD_ID, "b.body_id: not from 0 to 2^53 - 1");
    REFUSED(query.client_id = INT64_MAX, FMB_BAD_ID, "client_id: not from 0 to 2^53 - 1");
    REFUSED(query.sequence_number = -7, FMB_BAD_ID, "sequence_number: not from 0 to 2^53 - 1");
    struct pair_query query = cubes();
    query.placement[0].placed.id = QUERY_ID_MAX;
    assert_int_equal(answer_to(&query).status, FMB_OK);
}
/* clang-format on */

/* Frames by vertices: of each, the number of its vertices. */
static void set_vertices(struct pair_query *query, int f, int32_t dim, const int *codes,
                         const int32_t *counts, int32_t frames, int32_t numbers)
{
    struct query_placement *placement = &query->placement[f];
    struct writer writer = {.at = bytes[f], .end = bytes[f] + sizeof bytes[f]};
    int32_t by_vertices = 0;
    for (int32_t i = 0; counts[i] != END; i++)
        by_vertices++;
    writer_int32(&writer, dim);
    writer_int32(&writer, frames);
    for (int32_t i = 0; i < frames; i++)
        *writer_take(&writer, 1) = (unsigned char) codes[i];
    writer_int32(&writer, by_vertices);
    for (int32_t i = 0; i < by_vertices; i++)
        writer_int32(&writer, counts[i]);
    writer_int32(&writer, numbers);
    for (int32_t i = 0; i < numbers; i++)
        writer_double(&writer, i * i % 7);
    placement->body = (struct body_view){.dim = dim,
                                         .frame_count = frames,
                                         .count_count = by_vertices,
                                         .number_count = numbers,
                                         .bytes = bytes[f],
                                         .size = writer_end(&writer, bytes[f])};
}

static void wrong_counts_of_vertices_are_refused(void **state)
{
    static const struct {
        int32_t dim, frames;
        int codes[3];
        int32_t counts[4], numbers;
        enum fmb_status status;
        const char *detail;
    } cases[] = {
        /* clang-format off */
        {3, 3, {6, 4, 7}, {4, 3, END}, 27, FMB_OK, ""},
        {2, 1, {6}, {3, END}, 6, FMB_OK, ""},
        {3, 1, {6}, {END}, 12, FMB_WRONG_COUNT, "b.num_counts: expected 1 numbers, found 0"},
        {3, 1, {4}, {2, END}, 6, FMB_WRONG_COUNT, "b.num_counts: expected 0 numbers, found 1"},
        {3, 2, {7, 6}, {3, 4, 4, END}, 21, FMB_WRONG_COUNT, "b.num_counts: expected 2 numbers, found 3"},
        {3, 2, {7, 6}, {3, 5, END}, 21, FMB_WRONG_COUNT, "b.counts[1]: not a number of vertices of this shape"},
        {3, 1, {6}, {INT32_MAX, END}, 12, FMB_WRONG_COUNT, "b.counts[0]: not a number of vertices of this shape"},
        {3, 1, {6}, {4, END}, 11, FMB_WRONG_COUNT, "b.num_numbers: expected 12 numbers, found 11"},
        {2, 1, {7}, {3, END}, 6, FMB_WRONG_DIMENSION, "b.dim: a face is in 3D"},
        {3, 1, {8}, {3, END}, 6, FMB_UNKNOWN_SHAPE, "b.shapes[0]: unknown shape"},
        {3, 2, {4, 5}, {1, END}, 9, FMB_OK, ""},
        {2, 1, {5}, {1000, END}, 2000, FMB_OK, ""},
        {2, 1, {5}, {1024, END}, 2048, FMB_OK, ""},
        {2, 1, {5}, {1025, END}, 2050, FMB_OVER_LIMIT, "b.counts[0]: more than 1024 vertices"},
        {3, 1, {5}, {0, END}, 0, FMB_WRONG_COUNT, "b.counts[0]: not a number of vertices of this shape"},
        {3, 1, {5}, {-5, END}, 0, FMB_WRONG_COUNT, "b.counts[0]: not a number of vertices of this shape"},
        {3, 1, {5}, {INT32_MAX, END}, 3, FMB_OVER_LIMIT, "b.counts[0]: more than 1024 vertices"},
        {3, 1, {5}, {END}, 3, FMB_WRONG_COUNT, "b.num_counts: expected 1 numbers, found 0"}
        /* clang-format on */
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        struct pair_query query = cases[i].dim == 2 ? squares() : cubes();
        set_vertices(&query, 1, cases[i].dim, cases[i].codes, cases[i].counts, cases[i].frames,
                     cases[i].numbers);
        if (cases[i].status == FMB_OK)
            assert_int_equal(answer_to(&query).status, FMB_OK);
        else
            expect(&query, cases[i].status, cases[i].detail);
    }
}

/* Hulls that meet, one of them in steps of a scene of its own: what libfmb says, whatever is
 * wanted.
 */
static void pairs_of_hulls_are_answered_as_by_libfmb(void **state)
{
    static const double vertices[2][8] = {{0, 0, 2, 0, 0, 2, 2, 2}, {1, 1, 3, 1, 3, 3, 1, 3}};
    for (int32_t want = 0; want < 32; want++) {
        static double memory[2][64];
        struct fmb_body body[2];
        struct fmb_placement placed[2];
        struct pair_query query = squares();
        struct fmb_answer expected;
        char certificate[FMB_CERTIFICATE_MAX];
        size_t length;
        if (want & FMB_WANT_TIMES)
            continue;
        query.want = want;
        for (int f = 0; f < 2; f++) {
            query.placement[f].body = geometry_write_hull(2, vertices[f], 4, bytes[f]);
            assert_int_equal(fmb_body_make_hull(2, vertices[f], 8, memory[f], &body[f]), FMB_OK);
            placed[f] = query.placement[f].placed;
            placed[f].body = &body[f];
        }
        enum fmb_status status =
            fmb_decide(fmb_method_default(), &placed[0], &placed[1], query.duration,
                       (unsigned) want & ~(unsigned) FMB_WANT_CERTIFICATE, &expected);
        if (status == FMB_OK && want & FMB_WANT_CERTIFICATE)
            status = fmb_certificate(&placed[0], &placed[1], query.duration, certificate,
                                     sizeof certificate, &length);
        const struct pair_result result = answer_to(&query);
        assert_int_equal(result.status == FMB_OK, status == FMB_OK);
        assert_int_equal(result.answer.verdict, status == FMB_OK ? expected.verdict : 0);
        assert_int_equal(result.certificate != NULL,
                         status == FMB_OK && want & FMB_WANT_CERTIFICATE && length > 0);
        if (result.certificate)
            assert_string_equal(result.certificate, certificate);
    }
}

/* With a handle there are no counts. */
static void a_handle_has_no_counts(void **state)
{
    static const int32_t counts[] = {4, END};
    struct pair_query query = cubes();
    set_vertices(&query, 0, 3, NULL, counts, 0, 0);
    query.placement[0].body.handle = (struct handle){{1}};
    expect(&query, FMB_WRONG_COUNT, "a.num_counts: expected 0 numbers, found 1");
}

static void bad_names_are_refused(void **state)
{
    static const char good[] =
        "0123456789012345678901234567890123456789012345678901234567890\xe2\x82\xac";
    static const char *const bad[] = {
        "0123456789012345678901234567890123456789012345678901234567890\xe2\x82\xac.", "\xff"};
    struct pair_query query = cubes();
    const struct pair_result unnamed = answer_to(&query);
    query.placement[0].placed.name = good;
    assert_int_equal(strlen(good), 64);
    const struct pair_result named = answer_to(&query);
    assert_int_equal(named.status, FMB_OK);
    assert_memory_equal(&named.handle[0], &unnamed.handle[0], sizeof named.handle[0]);
    for (size_t i = 0; i < COUNT(bad); i++) {
        query = cubes();
        query.placement[1].placed.name = bad[i];
        expect(&query, FMB_BAD_NAME,
               "b.name: a name that is not UTF-8 of at most 64 bytes without controls");
    }
}

/* A pair query does not look at groups: also where it takes a job. */
static void groups_of_a_pair_do_not_matter(void **state)
{
    struct plain_frame frames[2] = {unit_cube, unit_cube};
    for (int count = 1; count <= 2; count++) {
        struct pair_query query = cubes();
        set_frames(&query, 0, 3, frames, count);
        const struct pair_result before = answer_to(&query);
        query.placement[0].placed.group = query.placement[1].placed.group = -7;
        const struct pair_result after = answer_to(&query);
        assert_int_equal(after.status, FMB_OK);
        assert_int_equal(after.answer.verdict, before.answer.verdict);
        assert_memory_equal(&after.handle, &before.handle, sizeof after.handle);
    }
}

/* The fourth number of the position is the two counts after it, 0; the counts are appended. */
static void four_dimensions(void **state)
{
    static unsigned char message[QUERY_BYTES_MAX];
    struct pair_query query = cubes();
    big_endian_put_32(bytes[1], 4);
    const size_t size = wire_write_pair_query(&query, message) + 8;
    assert_null(answer_job_begin(job, ANSWER_PAIR, message, size));
    assert_true(answer_job_step(job, answerer));
    assert_int_equal(answer_job_pair_result(job)->status, FMB_WRONG_DIMENSION);
    assert_string_equal(answer_job_pair_result(job)->detail, "b.dim: neither 2 nor 3");
}

/* 0 is a flat frame. */
static void bad_sizes_are_refused(void **state)
{
    struct plain_frame frames[3] = {box(0, 1), unit_cube, box(3, 1)};
    struct pair_query query = cubes();
    frames[0].components[2] = -0x1p-1074;
    set_frames(&query, 1, 3, frames, 3);
    expect(&query, FMB_BAD_SIZE, "b.numbers[5]: a negative size");
    frames[0].components[2] = 0;
    frames[2].components[0] = -1;
    set_frames(&query, 1, 3, frames, 3);
    expect(&query, FMB_BAD_SIZE, "b.numbers[21]: a negative size");
    frames[2].components[0] = NAN;
    set_frames(&query, 1, 3, frames, 3);
    expect(&query, FMB_NOT_FINITE, "b.numbers[21]: not a finite number");
    frames[2].components[0] = INFINITY;
    set_frames(&query, 1, 3, frames, 3);
    expect(&query, FMB_NOT_FINITE, "b.numbers[21]: not a finite number");
    frames[2].components[0] = -0.0;
    frames[1].origin[0] = frames[1].components[0] = -1; /* these may be negative */
    set_frames(&query, 1, 3, frames, 3);
    assert_int_equal(answer_to(&query).status, FMB_OK);
}

/* ---- Bodies of several frames, and poses ---- */

static struct fmb_placement placement_of(struct query_bodies *own,
                                         const struct query_placement *from)
{
    struct fmb_placement out = from->placed;
    out.body = body_make(&from->body, own->memory);
    return out;
}

/* As the engine decides it in one call. */
static struct fmb_answer truth(const struct pair_query *query)
{
    static struct query_bodies own[2];
    const unsigned want = (unsigned) query->want & (FMB_WANT_BOX | FMB_WANT_GAP | FMB_WANT_POINT);
    struct fmb_answer answer;
    const struct fmb_placement a = placement_of(&own[0], &query->placement[0]);
    const struct fmb_placement b = placement_of(&own[1], &query->placement[1]);
    assert_int_equal(
        fmb_decide(fmb_method_by_number(query->method), &a, &b, query->duration, want, &answer),
        FMB_OK);
    return answer;
}

/* Two gratings of boxes, one turned and moving towards the other. */
static struct pair_query gratings(int count, double spacing, double distance)
{
    struct plain_frame frames[300];
    struct pair_query query = {.client_id = 4, .duration = 1, .want = FMB_WANT_BOX};
    for (int i = 0; i < count; i++) {
        frames[i] = i % 5 == 4 ? unit_cube : box(0, 1);
        frames[i].origin[0] = spacing * i;
    }
    for (int f = 0; f < 2; f++)
        set_frames(&query, f, 3, frames, count);
    query.placement[1].placed.position[1] = distance;
    query.placement[1].placed.orientation_count = 4;
    memcpy(query.placement[1].placed.orientation, (const double[]){2, 0, 0, 1}, 4 * sizeof(double));
    query.placement[1].velocity_count = 3;
    query.placement[1].placed.velocity[1] = -1;
    return query;
}

/* Whole and by handle, with every method, in steps: the answer of one call of the engine. */
static void bodies_of_several_frames_are_answered(void **state)
{
    const double distance[] = {-100, 0, 1.75, 2, 1000};
    for (int i = 0; i < 5; i++)
        for (int k = 0; k < 10; k++) {
            struct pair_query query = gratings(7, 2, distance[i]);
            const int method = k / 2;
            query.duration = k % 2;
            query.method = method;
            query.want |= FMB_WANT_POINT;
            if (fmb_method_by_number(method)->certain)
                query.want |= FMB_WANT_GAP;
            const struct fmb_answer expected = truth(&query);
            for (int by_handle = 0; by_handle < 2; by_handle++) {
                const struct pair_result result = answer_to(&query);
                assert_int_equal(result.status, FMB_OK);
                assert_memory_equal(&result.answer, &expected, sizeof expected);
                assert_int_equal(result.dim, expected.has_box || expected.has_gap ? 3 : 0);
                assert_int_equal(result.names_frames, expected.has_gap);
                assert_int_equal(handle_is_none(&result.handle[0]), by_handle);
                for (int f = 0; f < 2 && !by_handle; f++)
                    name(&query.placement[f], &result.handle[f]);
            }
        }
    assert_int_equal(counts().misses, 1); /* both have the same frames */
    assert_int_equal(counts().frames, 7);
}

/* With bodies sent whole and by handle, each method gives the status and the answer of
 * fmb_decide(). */
static void ends_are_answered(void **state)
{
    static const double ends[][4] = {{1, 0, 0, 0}, {2, 0, 0, 1}, {-1, 0.5, 0, 0}};
    for (int i = 0; i < 3 * 6; i++) {
        struct pair_query query = i % 2 ? gratings(3, 2, 3) : cubes();
        struct query_placement *b = &query.placement[1];
        static struct query_bodies own[2];
        struct fmb_answer expected;
        query.method = (int) (i / 6);
        query.want = FMB_WANT_BOX | FMB_WANT_POINT | (query.method < 2 ? FMB_WANT_GAP : 0);
        b->velocity_count = 0;
        b->placed.velocity[1] = 0;
        b->placed.position[2] = 1.25;
        set_end(b, ends[i / 2 % 3]);
        b->placed.end_position[2] = 0.75;
        const struct fmb_placement pair[2] = {placement_of(&own[0], &query.placement[0]),
                                              placement_of(&own[1], b)};
        const enum fmb_status status = fmb_decide(
            fmb_method_by_number(query.method), &pair[0], &pair[1], query.duration,
            (unsigned) query.want & ~(query.method < 2 ? 0u : FMB_WANT_POINT), &expected);
        for (int by_handle = 0; by_handle < 2; by_handle++) {
            const struct pair_result result = answer_to(&query);
            assert_int_equal(result.status, status);
            assert_memory_equal(&result.answer, &expected, sizeof expected);
            for (int f = 0; f < 2 && status == FMB_OK && !by_handle; f++)
                name(&query.placement[f], &result.handle[f]);
        }
    }
}

/* A cube with a radius, above one without: of body coordinates and numbers, in body and by handle.
 */
static void a_radius_is_part_of_the_shape(void **state)
{
    static const double radii[] = {0, -0.0, 0.25, 0.5, 0.75};
    static const enum fmb_verdict verdicts[] = {FMB_SEPARATED, FMB_SEPARATED, FMB_SEPARATED,
                                                FMB_TOUCHING, FMB_OVERLAPPING};
    for (size_t i = 0; i < COUNT(radii); i++) {
        struct plain_frame rounded = unit_cube;
        rounded.has_radius = true;
        rounded.radius = radii[i];
        struct pair_query query = cubes();
        query.want = FMB_WANT_GAP | FMB_WANT_BOX;
        query.placement[1].placed.position[2] = 1.5;
        const struct pair_result plain = answer_to(&query);
        set_frames(&query, 1, 3, &rounded, 1);
        query.placement[1].placed.position[0] = 0.5;
        query.placement[1].placed.position[2] = 1.5;
        for (int by_handle = 0; by_handle < 2; by_handle++) {
            static unsigned char message[QUERY_BYTES_MAX];
            assert_null(answer_job_begin(job, ANSWER_PAIR, message,
                                         wire_write_pair_query(&query, message)));
            answer_job_step(job, answerer);
            const bool complete = answer_job_step(job, answerer);
            assert_int_equal(complete || answer_job_is_short(job), radii[i] == 0);
            while (!answer_job_step(job, answerer))
                ;
            const struct pair_result result = *answer_job_pair_result(job);
            assert_int_equal(result.status, FMB_OK);
            assert_int_equal(result.answer.verdict, verdicts[i]);
            if (radii[i] == 0)
                assert_memory_equal(&result.answer, &plain.answer, sizeof result.answer);
            assert_true(result.answer.gap.bounds[0] <= 0.5 - radii[i] &&
                        result.answer.gap.bounds[1] >= 0.5 - radii[i]);
            if (by_handle)
                continue;
            assert_false(handle_equal(&result.handle[1], &plain.handle[1]));
            name(&query.placement[1], &result.handle[1]);
        }
    }
    assert_int_equal(counts().bodies, 2);
    assert_int_equal(counts().frames, 2);
}

/* A pair of many frames takes many steps, between which other queries are answered. */
static void many_frames_take_many_steps(void **state)
{
    static unsigned char message[QUERY_BYTES_MAX];
    const struct pair_query query = gratings(100, 0.001, 0.5);
    const struct fmb_answer expected = truth(&query);
    struct pair_result result;
    int steps = 1;
    const size_t size = wire_write_pair_query(&query, message);
    assert_null(answer_job_begin(job, ANSWER_PAIR, message, size));
    memset(message, 0xa5, size); /* it was copied */
    for (; !answer_job_step(job, answerer); steps++) {
        assert_true(steps == 1 || !answer_job_is_short(job));
        const struct pair_query other = stretched(steps + 1); /* would evict the bodies */
        answer_pair(answerer, &other, &result);
        assert_int_equal(result.status, FMB_OK);
    }
    assert_true(steps > 10);
    assert_memory_equal(&answer_job_pair_result(job)->answer, &expected, sizeof expected);
}

static void a_job_that_is_stopped(void **state)
{
    static unsigned char message[QUERY_BYTES_MAX];
    const struct pair_query query = gratings(100, 0.001, 0.5);
    const size_t size = wire_write_pair_query(&query, message);
    assert_null(answer_job_begin(job, ANSWER_PAIR, message, size));
    assert_false(answer_job_step(job, answerer));
    answer_job_stop(job);
    const struct pair_result *result = answer_job_pair_result(job);
    assert_int_equal(result->status, FMB_BUSY);
    assert_string_equal(result->detail, "busy");
    assert_int_equal(result->answer.verdict, 0);
    assert_non_null(answer_job_begin(job, ANSWER_PAIR, message, size - 1));
}

/* What is refused in a job: nothing is cached. */
static void bodies_of_several_frames_have_no_certificate(void **state)
{
    struct pair_query query = gratings(2, 2, 0);
    query.want = FMB_WANT_CERTIFICATE;
    expect(&query, FMB_CANNOT_DECIDE, "want: a certificate is for bodies of one frame");
    query.want = 0;
    const struct pair_result result = answer_to(&query);
    query = stretched(9);
    query.want = FMB_WANT_CERTIFICATE;
    name(&query.placement[1], &result.handle[1]);
    expect(&query, FMB_CANNOT_DECIDE, "want: a certificate is for bodies of one frame");
    query = gratings(3, 2, 0);
    name(&query.placement[1], &(struct handle){{1}});
    expect(&query, FMB_UNKNOWN_BODY, "b.handle: not held; send the frames");
}

static bool certified(const struct pair_query *query, const struct pair_result *result)
{
    static struct query_bodies own[2];
    struct fmb_placement placement[2];
    char why[200];
    assert_int_equal(result->status, FMB_OK);
    assert_non_null(result->certificate);
    for (int f = 0; f < 2; f++)
        placement[f] = placement_of(&own[f], &query->placement[f]);
    return fmb_certificate_holds(&placement[0], &placement[1], query->duration,
                                 result->answer.verdict, result->certificate, why, sizeof why);
}

static void certificates_are_given_on_request(void **state)
{
    const double apart[] = {0.5, 1, 1.5};
    const enum fmb_verdict verdict[] = {FMB_OVERLAPPING, FMB_TOUCHING, FMB_SEPARATED};
    for (int i = 0; i < 9; i++) {
        struct pair_query query = cubes();
        query.placement[1].placed.position[0] = apart[i % 3];
        if (i >= 6) /* a turn about x keeps the verdict; touching has no certificate */
            set_end(&query.placement[1], (double[4]){1, 1, 0, 0});
        query.placement[0].velocity_count = i >= 3 ? 3 : 0;
        query.placement[0].placed.velocity[1] = 0.25;
        query.want = FMB_WANT_CERTIFICATE;
        struct pair_result result = answer_to(&query);
        assert_int_equal(result.answer.verdict, verdict[i % 3]);
        if (i == 7) {
            assert_null(result.certificate);
            continue;
        }
        assert_true(certified(&query, &result));
        assert_false(result.answer.has_box);
        char text[200];
        assert_true(strlen(result.certificate) < sizeof text);
        strcpy(text, result.certificate);
        query.want |= FMB_WANT_BOX;
        result = answer_to(&query);
        assert_string_equal(result.certificate, text);
        assert_int_equal(result.answer.has_box, verdict[i % 3] != FMB_SEPARATED);
        query.want = FMB_WANT_BOX;
        assert_null(answer_to(&query).certificate);
        query.want = FMB_WANT_CERTIFICATE;
        query.placement[0].placed.position[0] = NAN;
        assert_null(answer_to(&query).certificate);
    }
}

/* The body is kept all the same, and its handle known. */
static void inexact_methods_do_not_decide_flat_frames(void **state)
{
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

/* Of bodies of one frame, moving. */
static void gaps_and_points_are_given_on_request(void **state)
{
    const double speed[] = {0, -2, -2.5, -7};
    for (int i = 0; i < 8; i++) {
        struct pair_query query = cubes();
        const bool gap = i < 4;
        query.want = gap ? FMB_WANT_GAP : FMB_WANT_POINT;
        query.placement[1].placed.position[0] = 3;
        query.placement[1].velocity_count = 3;
        query.placement[1].placed.velocity[0] = speed[i % 4];
        const struct pair_result result = answer_to(&query);
        const struct fmb_answer expected = truth(&query);
        assert_memory_equal(&result.answer, &expected, sizeof expected);
        assert_int_equal(result.answer.has_gap, gap);
        assert_int_equal(result.answer.gap.has_witness, i == 0);
        assert_int_equal(result.answer.has_point, i > 4); /* i == 4: they stay apart */
        assert_int_equal(result.dim, i == 4 ? 0 : 3);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_pair_is_answered_and_its_ids_are_echoed),
        TEST(handles_stand_for_frames),
        TEST(unknown_handles_are_refused),
        TEST(a_handle_of_the_other_dimension_is_refused),
        cmocka_unit_test_setup_teardown(a_cache_of_one_frame_answers_whole_pairs, set_up_one,
                                        tear_down),
        TEST(one_id_may_have_two_bodies),
        TEST(anonymous_bodies_are_not_kept),
        TEST(numbers_that_are_not_finite_are_refused),
        TEST(wrong_counts_are_refused),
        TEST(wrong_counts_of_vertices_are_refused),
        TEST(pairs_of_hulls_are_answered_as_by_libfmb),
        TEST(a_handle_has_no_counts),
        TEST(bad_names_are_refused),
        TEST(groups_of_a_pair_do_not_matter),
        TEST(four_dimensions),
        TEST(unknown_shapes_and_dimensions_are_refused),
        TEST(bad_orientations_are_refused),
        TEST(bad_sizes_are_refused),
        cmocka_unit_test_setup_teardown(bodies_of_several_frames_are_answered, set_up_many,
                                        tear_down),
        TEST(a_radius_is_part_of_the_shape),
        cmocka_unit_test_setup_teardown(many_frames_take_many_steps, set_up_many, tear_down),
        TEST(a_job_that_is_stopped),
        cmocka_unit_test_setup_teardown(bodies_of_several_frames_have_no_certificate, set_up_many,
                                        tear_down),
        TEST(bad_ends_are_refused),
        cmocka_unit_test_setup_teardown(ends_are_answered, set_up_many, tear_down),
        TEST(bad_radii_are_refused),
        TEST(bad_requests_are_refused),
        TEST(certificates_are_given_on_request),
        TEST(inexact_methods_do_not_decide_flat_frames),
        TEST(gaps_and_points_are_given_on_request),
    };
    return cmocka_run_group_tests_name("answer", tests, NULL, NULL);
}
