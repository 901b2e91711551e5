/* Scenes on the wire: of the sizes that wire.h gives, up to the last byte of a message; and which
 * answers are the same. */
#include "unit.h"

#include "sample_placement.h"
#include "wire.h"

#include "fmb_msgs_placement_t.h"
#include "fmb_msgs_scene_query_t.h"
#include "fmb_msgs_scene_result_t.h"

#include <math.h>

static struct scene_query query, query_read;
static struct scene_result result, result_read;
static unsigned char bytes[2 * QUERY_BYTES_MAX];

static int set_up(void **state)
{
    memset(&query, 0, sizeof query);
    memset(&result, 0, sizeof result);
    memset(&query_read, 0, sizeof query_read);
    memset(&result_read, 0, sizeof result_read);
    return 0;
}

/* A copy that ends where the message ends, so that a sanitizer sees any byte read beyond it. It
 * lives until the next one is made, since geometries point into it. */
static const unsigned char *copy_of(size_t size)
{
    static unsigned char *copy;
    free(copy);
    copy = malloc(size);
    assert_non_null(copy);
    return memcpy(copy, bytes, size);
}

static const char *read_query(size_t size)
{
    return wire_read_scene_query(copy_of(size), (uint32_t) size, &query_read);
}

static const char *read_result(size_t size)
{
    return wire_read_scene_result(copy_of(size), (uint32_t) size, &result_read);
}

static void expect_read(const char *error)
{
    if (error)
        fail_msg("not read: %s", error);
}

/* ---- Queries ---- */

static unsigned char geometries[QUERY_PLACEMENTS_MAX][SAMPLE_BYTES_MAX];

static void set_query(int32_t placements, int32_t indices, int32_t ignored)
{
    query.utime = 1700000000000000;
    query.client_id = QUERY_ID_MAX;
    query.sequence_number = 42;
    query.duration = 0.1;
    query.method = 2;
    query.want = 5;
    query.which = FMB_PAIRS_ACROSS;
    query.split = 3;
    query.first_pair = 7;
    query.margin = 0.25;
    query.placement_count = placements;
    query.index_count = indices;
    query.ignored_count = ignored;
    for (int32_t i = 0; i < placements; i++)
        query.placement[i] = sample_placement(i, geometries[i]);
    for (int32_t i = 0; i < indices; i++)
        query.pair[i / 2][i % 2] = (unsigned) (i * 7 % 1400);
    for (int32_t i = 0; i < ignored; i++)
        query.ignored[i / 2][i % 2] = (unsigned) (i * 5 % 1400);
}

static void assert_same_query(void)
{
    const size_t indices = (size_t) query.index_count, ignored = (size_t) query.ignored_count;
    assert_int_equal(query.utime, query_read.utime);
    assert_int_equal(query.client_id, query_read.client_id);
    assert_int_equal(query.sequence_number, query_read.sequence_number);
    assert_string_equal(query.label ? query.label : "", query_read.label);
    assert_memory_equal(&query.duration, &query_read.duration, sizeof query.duration);
    assert_int_equal(query.method, query_read.method);
    assert_int_equal(query.want, query_read.want);
    assert_int_equal(query.which, query_read.which);
    assert_int_equal(query.split, query_read.split);
    assert_int_equal(query.first_pair, query_read.first_pair);
    assert_true(query.margin == query_read.margin);
    assert_int_equal(query.placement_count, query_read.placement_count);
    assert_int_equal(query.index_count, query_read.index_count);
    assert_int_equal(query.ignored_count, query_read.ignored_count);
    for (int32_t i = 0; i < query.placement_count; i++)
        assert_true(same_placement(&query.placement[i], &query_read.placement[i]));
    assert_memory_equal(query.ignored, query_read.ignored, ignored * sizeof query.ignored[0][0]);
    assert_memory_equal(query.pair, query_read.pair, indices * sizeof query.pair[0][0]);
}

/* Indices are read many at a time: of every length as many as there are, and no more. */
static void lists_of_every_length_are_read(void **state)
{
    for (int32_t count = 0; count < 70; count++) {
        set_query(0, count, count);
        memset(query_read.ignored, 7, sizeof query_read.ignored);
        memset(query_read.pair, 7, sizeof query_read.pair);
        expect_read(read_query(wire_write_scene_query(&query, bytes)));
        assert_same_query();
        assert_int_equal(query_read.pair[count / 2][count % 2], 0x07070707);
        assert_int_equal(query_read.ignored[count / 2][count % 2], 0x07070707);
    }
}

/* To the last bytes: only pairs, and only placements. */
static void the_largest_queries_are_read(void **state)
{
    const int placements = (QUERY_BYTES_MAX - WIRE_SCENE_QUERY_BYTES) / QUERY_PLACEMENT_BYTES_MIN;
    set_query(0, (QUERY_BYTES_MAX - WIRE_SCENE_QUERY_BYTES) / 2, 0);
    query.label = "s"; /* the other bytes are even in number */
    assert_int_equal(wire_write_scene_query(&query, bytes), QUERY_BYTES_MAX);
    expect_read(read_query(QUERY_BYTES_MAX));
    assert_same_query();
    query.label = NULL;
    set_query(placements, 0, 0);
    for (int i = 0; i < placements; i++) {
        query.placement[i] = sample_placement(4, geometries[i]); /* 2D, by handle, at rest */
        query.placement[i].placed.name = NULL;
        assert_int_equal(wire_placement_bytes(&query.placement[i]), QUERY_PLACEMENT_BYTES_MIN);
    }
    const size_t size = wire_write_scene_query(&query, bytes);
    assert_true(size <= QUERY_BYTES_MAX && size + QUERY_PLACEMENT_BYTES_MIN > QUERY_BYTES_MAX);
    expect_read(read_query(size));
    assert_same_query();
}

/* More placements, and pairs, than the structs hold: all are read, the first are kept. */
static void lists_beyond_the_capacity_keep_the_first(void **state)
{
    static fmb_msgs_placement_t placements[QUERY_PLACEMENTS_MAX + 200];
    static int16_t indices[2 * QUERY_PAIRS_MAX + 2];
    const int count = QUERY_PLACEMENTS_MAX + 200;
    char none[] = "";
    for (int i = 0; i < count; i++)
        placements[i] = (fmb_msgs_placement_t){.body_id = i, .name = none};
    fmb_msgs_scene_query_t message = {
        .label = none, .num_placements = count, .placements = placements, .indices = indices};
    int size = fmb_msgs_scene_query_t_encode(bytes, 0, sizeof bytes, &message);
    assert_true(size > 0);
    expect_read(read_query((size_t) size));
    assert_int_equal(query_read.placement_count, count);
    assert_int_equal(query_read.placement[QUERY_PLACEMENTS_MAX - 1].placed.id,
                     QUERY_PLACEMENTS_MAX - 1);

    message.num_placements = 0;
    message.num_indices = 2 * QUERY_PAIRS_MAX + 2;
    indices[2 * QUERY_PAIRS_MAX - 1] = -2;
    size = fmb_msgs_scene_query_t_encode(bytes, 0, sizeof bytes, &message);
    assert_true(size > 0);
    expect_read(read_query((size_t) size));
    assert_int_equal(query_read.index_count, 2 * QUERY_PAIRS_MAX + 2);
    assert_int_equal(query_read.pair[QUERY_PAIRS_MAX - 1][1], (unsigned) -2);
}

/* ---- Results ---- */

/* What results have besides verdicts. */
enum { NAMES = 1, TIMES = 2, BOXES = 4, GAPS = 8, FRAMES = 16, POINTS = 32, FORMS = 64 };

/* A gap that goes with the verdict. Every seventh of separated pairs that are not named has none.
 * Every other pair that overlaps has witness points. */
static void set_gap(int dim, int32_t i)
{
    struct fmb_gap *gap = &result.gap[i];
    const int verdict = result.verdict[i];
    memset(gap, 0, sizeof *gap);
    gap->has_witness = verdict == FMB_SEPARATED || (verdict == FMB_OVERLAPPING && i % 4 < 2);
    if (verdict == FMB_SEPARATED && i % 7 == 0 && !result.names_pairs) {
        gap->has_witness = false;
        gap->bounds[0] = gap->bounds[1] = NAN;
        return;
    }
    if (verdict != FMB_TOUCHING) {
        gap->bounds[0] = verdict == FMB_SEPARATED ? 0.25 * i : -i - 0.5;
        gap->bounds[1] = i % 5 == 0 && verdict == FMB_SEPARATED ? HUGE_VAL : gap->bounds[0];
    }
    gap->direction[i % dim] = i % 2 ? -1 : 1;
    for (int axis = 0; axis < dim && gap->has_witness; axis++) {
        gap->witness[0][axis] = axis + 0.5 * i;
        gap->witness[1][axis] = -axis;
    }
    gap->time = gap->has_witness ? 0.125 * i : 0;
    gap->frame[i % 2] = result.names_frames ? (unsigned) i % (INT16_MAX + 1) : 0;
}

static void set_result(int dim, int32_t handles, int32_t verdicts, int form)
{
    const bool names = form & NAMES, times = form & TIMES, boxes = form & BOXES;
    const bool points = form & POINTS;
    result.utime = 1;
    result.client_id = 2;
    result.sequence_number = 3;
    result.server_id = QUERY_ID_MAX;
    result.method = 4;
    result.compute_ns = 1234;
    result.handle_count = handles;
    result.verdict_count = verdicts;
    result.end_pair = verdicts + 1000;
    result.contact_count = 0;
    for (int32_t i = 0; i < handles; i++)
        memset(&result.handle[i], i % 255 + 1, sizeof result.handle[i]);
    for (int32_t i = 0; i < verdicts; i++) {
        result.verdict[i] = (unsigned char) (names         ? (form & GAPS ? 1 : 2) + i % 2
                                             : form & GAPS ? 1 + i % 3
                                                           : i % 4);
        result.contact_count += result.verdict[i] >= 2;
        if (!names)
            continue;
        result.pair[i][0] = (unsigned) i / 600;
        result.pair[i][1] = 100 + (unsigned) i % 600;
    }
    for (int32_t i = 0; i < result.contact_count && times; i++) {
        result.times[2 * i] = i % 3 ? 0.25 : 0;
        result.times[2 * i + 1] = i % 3 ? 0.25 * (1 + i) : 0;
    }
    for (int32_t i = 0; i < 2 * dim * result.contact_count && boxes; i++)
        result.boxes[i] = i / dim % 2 ? (i % 5 ? i : HUGE_VAL) : -1.5;
    for (int32_t i = 0; i < (1 + dim) * result.contact_count && points; i++)
        result.points[i] = i % (1 + dim) ? -0.75 * i : i;
    result.names_pairs = names && verdicts > 0;
    result.has_times = times && result.contact_count > 0;
    result.has_boxes = boxes && result.contact_count > 0;
    result.has_points = points && result.contact_count > 0;
    result.has_gaps = form & GAPS && verdicts > 0;
    result.names_frames = result.has_gaps && form & FRAMES;
    for (int32_t i = 0; i < verdicts && result.has_gaps; i++)
        set_gap(dim, i);
    result.dim = result.has_boxes || result.has_points || result.has_gaps ? dim : 0;
}

static size_t bound_of_result(void)
{
    const size_t contacts = (size_t) result.contact_count, verdicts = (size_t) result.verdict_count;
    return WIRE_SCENE_RESULT_BYTES + 16 * (size_t) result.handle_count +
           2 * (size_t) result.unknown_count + verdicts +
           (result.names_pairs ? WIRE_PAIR_BYTES * verdicts : 0) +
           (result.has_times ? 16 * contacts : 0) +
           (result.has_boxes ? 16 * (size_t) result.dim * contacts : 0) +
           (result.has_points ? 8 * (size_t) (1 + result.dim) * contacts : 0) +
           (result.has_gaps ? (size_t) wire_gap_bytes(result.dim, result.names_frames) * verdicts
                            : 0);
}

static void assert_same_result(void)
{
    const size_t verdicts = (size_t) result.verdict_count, contacts = (size_t) result.contact_count;
    assert_int_equal(result.utime, result_read.utime);
    assert_int_equal(result.client_id, result_read.client_id);
    assert_int_equal(result.sequence_number, result_read.sequence_number);
    assert_int_equal(result.server_id, result_read.server_id);
    assert_int_equal(result.status, result_read.status);
    assert_string_equal(result.detail, result_read.detail);
    assert_int_equal(result.method, result_read.method);
    assert_int_equal(result.end_pair, result_read.end_pair);
    assert_int_equal(result.compute_ns, result_read.compute_ns);
    assert_int_equal(result.dim, result_read.dim);
    assert_int_equal(result.names_frames, result_read.names_frames);
    assert_int_equal(result.handle_count, result_read.handle_count);
    assert_int_equal(result.unknown_count, result_read.unknown_count);
    assert_int_equal(result.verdict_count, result_read.verdict_count);
    assert_int_equal(result.contact_count, result_read.contact_count);
    assert_int_equal(result.names_pairs, result_read.names_pairs);
    assert_int_equal(result.has_times, result_read.has_times);
    assert_int_equal(result.has_boxes, result_read.has_boxes);
    assert_int_equal(result.has_points, result_read.has_points);
    if (result.has_points)
        assert_memory_equal(result.points, result_read.points,
                            (1 + (size_t) result.dim) * contacts * sizeof(double));
    assert_int_equal(result.has_gaps, result_read.has_gaps);
    for (size_t i = 0; i < verdicts && result.has_gaps; i++)
        assert_true(query_same_gap(&result.gap[i], &result_read.gap[i]));
    assert_memory_equal(result.handle, result_read.handle,
                        (size_t) result.handle_count * sizeof *result.handle);
    assert_memory_equal(result.unknown, result_read.unknown,
                        (size_t) result.unknown_count * sizeof *result.unknown);
    assert_memory_equal(result.verdict, result_read.verdict, verdicts);
    if (result.names_pairs)
        assert_memory_equal(result.pair, result_read.pair, verdicts * sizeof result.pair[0]);
    if (result.has_times)
        assert_memory_equal(result.times, result_read.times, 2 * contacts * sizeof(double));
    if (result.has_boxes)
        assert_memory_equal(result.boxes, result_read.boxes,
                            2 * (size_t) result.dim * contacts * sizeof(double));
}

static size_t write_and_read(void)
{
    const size_t size = wire_write_scene_result(&result, bytes);
    assert_true(size <= bound_of_result());
    expect_read(read_result(size));
    assert_same_result();
    return size;
}

/* As many of each kind of answer as the bound of wire.h admits, with the longest detail: the
 * message fits, and the bound is not wasteful. */
static void results_fill_a_message_to_its_last_byte(void **state)
{
    enum { ANSWER_BYTES = 400 }; /* more than one takes */
    for (int form = 0; form < 2 * FORMS; form++) {
        int32_t verdicts = 0, left = QUERY_BYTES_MAX;
        do { /* as many more as surely fit, or one */
            verdicts += left > ANSWER_BYTES ? left / ANSWER_BYTES : 1;
            verdicts = verdicts < QUERY_VERDICTS_MAX ? verdicts : QUERY_VERDICTS_MAX;
            set_result(2 + form / FORMS, 300, verdicts, form);
            left = QUERY_BYTES_MAX - (int32_t) bound_of_result() - (5 + 16 + 48 + 96);
        } while (left > 0 && verdicts < QUERY_VERDICTS_MAX);
        memset(result.detail, 'x', QUERY_TEXT_MAX - 1);
        const size_t size = write_and_read();
        assert_true(size <= QUERY_BYTES_MAX);
        assert_true(bound_of_result() - size < 8);
        result.detail[0] = '\0';
    }
    set_result(2, 0, QUERY_VERDICTS_MAX, 0);
    write_and_read();
    /* To the very last byte. */
    set_result(2, 0, QUERY_NAMED_MAX - 60, NAMES);
    const size_t left = QUERY_BYTES_MAX - wire_write_scene_result(&result, bytes);
    result.handle_count = (int32_t) (left / HANDLE_BYTES);
    memset(result.handle, 1, left / HANDLE_BYTES * HANDLE_BYTES);
    memset(result.detail, 'x', left % HANDLE_BYTES);
    result.detail[left % HANDLE_BYTES] = '\0';
    assert_int_equal(write_and_read(), QUERY_BYTES_MAX);
}

static void expect_refused(void)
{
    assert_non_null(read_result(wire_write_scene_result(&result, bytes)));
}

/* What the corpora of tests/fuzz have no example of. */
static void inconsistent_results_are_refused(void **state)
{
    set_result(3, 0, 2, NAMES | GAPS); /* separated, touching */
    write_and_read();
    result.gap[1].bounds[1] = 1;
    expect_refused();
    result.gap[1].bounds[0] = result.gap[1].bounds[1] = NAN; /* only separated pairs have none */
    expect_refused();
    set_result(3, 0, 2, NAMES | GAPS);
    result.gap[0].time = INFINITY;
    expect_refused();
    for (int i = 0; i < 2; i++) {
        set_result(3, 0, 4, BOXES | POINTS);
        write_and_read();
        result.points[i] = i ? NAN : -0.5; /* times are not negative */
        expect_refused();
    }
    memset(&result, 0, sizeof result);
    result.status = FMB_BUSY;
    result.handle_count = 1;
    expect_refused();
    result.handle_count = 0;
    result.end_pair = 1;
    expect_refused();

    char detail[] = "";
    uint8_t verdicts[3] = {FMB_TOUCHING, FMB_TOUCHING, FMB_TOUCHING};
    int16_t indices[6] = {0, 1, 0, 2, 1, 2};
    fmb_msgs_scene_result_t message = {.detail = detail,
                                       .end_pair = 3,
                                       .num_verdicts = 3,
                                       .verdicts = verdicts,
                                       .indices = indices};
    for (message.num_indices = 0; message.num_indices <= 6; message.num_indices++) {
        const int size = fmb_msgs_scene_result_t_encode(bytes, 0, sizeof bytes, &message);
        assert_int_equal(read_result((size_t) size) == NULL, message.num_indices % 6 == 0);
    }
}

/* Only the padding, 7 bytes after has_witness, does not count. */
static void answers_that_differ_in_any_byte_are_not_the_same(void **state)
{
    const struct fmb_answer full = {.has_contact = true,
                                    .has_box = true,
                                    .has_gap = true,
                                    .has_point = true,
                                    .gap.has_witness = true};
    size_t same = 0;
    for (size_t i = 0; i < sizeof full; i++) {
        struct fmb_answer other;
        memcpy(&other, &full, sizeof full);
        ((unsigned char *) &other)[i] ^= 1;
        same += query_same_answer(&full, &other);
    }
    assert_int_equal(same, 7);
    assert_true(query_same_answer(&full, &full));
}

/* Numbers of a part that neither answer has are not compared. */
static void parts_that_no_answer_has_are_the_same(void **state)
{
    const struct fmb_answer none = {.verdict = FMB_SEPARATED};
    struct fmb_answer other = none;
    other.contact[0] = other.box[0][0] = other.gap.bounds[1] = 1;
    assert_true(query_same_answer(&none, &other));
    other.has_contact = other.has_gap = true;
    assert_int_equal(query_parts_that_differ(&none, &other), FMB_WANT_TIMES | FMB_WANT_GAP);
}

#define TEST(name) cmocka_unit_test_setup(name, set_up)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(answers_that_differ_in_any_byte_are_not_the_same),
        TEST(parts_that_no_answer_has_are_the_same),
        TEST(lists_of_every_length_are_read),
        TEST(the_largest_queries_are_read),
        TEST(lists_beyond_the_capacity_keep_the_first),
        TEST(results_fill_a_message_to_its_last_byte),
        TEST(inconsistent_results_are_refused),
    };
    return cmocka_run_group_tests_name("wire_scene", tests, NULL, NULL);
}
