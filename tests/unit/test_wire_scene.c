/* Scenes on the wire: read back as they were written, of the sizes that wire.h gives, up to the
 * last byte of a message; and inconsistent results, which are refused. */
#include "as_lcm.h"
#include "hostile.h"
#include "sample_placement.h"
#include "wire.h"

#include "fmb_msgs_placement_t.h"
#include "fmb_msgs_scene_query_t.h"
#include "fmb_msgs_scene_result_t.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static struct scene_query query, query_read;
static struct scene_result result, result_read;
static unsigned char bytes[2 * QUERY_BYTES_MAX], again[QUERY_BYTES_MAX];

static int set_up(void **state)
{
    (void) state;
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

static size_t size_of_query(void)
{
    const size_t indices = (size_t) (query.index_count + query.ignored_count);
    size_t size =
        WIRE_SCENE_QUERY_BYTES + wire_text_bytes(query.label) + indices * WIRE_PAIR_BYTES / 2;
    for (int32_t i = 0; i < query.placement_count; i++)
        size += wire_placement_bytes(&query.placement[i]);
    return size;
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

static void test_query_round_trip(void **state)
{
    (void) state;
    for (int32_t placements = 0; placements < 40; placements++)
        for (int32_t indices = 0; indices < 7; indices++) { /* odd counts too: they may come */
            set_query(placements, indices, (indices + placements) % 4);
            query.label = placements % 3 ? "shelf \xff\n" : NULL;
            const size_t size = wire_write_scene_query(&query, bytes);
            assert_int_equal(size, size_of_query());
            expect_read(read_query(size));
            assert_same_query();
            ASSERT_AS_LCM_WRITES(fmb_msgs_scene_query_t, bytes, size);
        }
}

/* Indices are read many at a time: of every length as many as there are, and no more. */
static void test_lists_of_every_length(void **state)
{
    (void) state;
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
static void test_largest_queries(void **state)
{
    (void) state;
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
        query.placement[i].name = NULL;
        assert_int_equal(wire_placement_bytes(&query.placement[i]), QUERY_PLACEMENT_BYTES_MIN);
    }
    const size_t size = wire_write_scene_query(&query, bytes);
    assert_true(size <= QUERY_BYTES_MAX && size + QUERY_PLACEMENT_BYTES_MIN > QUERY_BYTES_MAX);
    expect_read(read_query(size));
    assert_same_query();
}

/* More placements, and pairs, than the structs hold: all are read, the first are kept. */
static void test_more_than_the_capacity(void **state)
{
    (void) state;
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
    assert_int_equal(query_read.placement[QUERY_PLACEMENTS_MAX - 1].body_id,
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
enum { NAMES = 1, TIMES = 2, BOXES = 4, GAPS = 8, FRAMES = 16, FORMS = 32 };

/* A gap that goes with the verdict. Every seventh of separated pairs that are not named has none.
 */
static void set_gap(int dim, int32_t i)
{
    struct fmb_gap *gap = &result.gap[i];
    const int verdict = result.verdict[i];
    memset(gap, 0, sizeof *gap);
    gap->has_witness = verdict == FMB_SEPARATED;
    if (gap->has_witness && i % 7 == 0 && !result.names_pairs) {
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
        result.pair[i][0] = (unsigned) i / 700;
        result.pair[i][1] = 100 + (unsigned) i % 700;
    }
    for (int32_t i = 0; i < result.contact_count && times; i++) {
        result.times[2 * i] = i % 3 ? 0.25 : 0;
        result.times[2 * i + 1] = i % 3 ? 0.25 * (1 + i) : 0;
    }
    for (int32_t i = 0; i < 2 * dim * result.contact_count && boxes; i++)
        result.boxes[i] = i / dim % 2 ? (i % 5 ? i : HUGE_VAL) : -1.5;
    result.names_pairs = names && verdicts > 0;
    result.has_times = times && result.contact_count > 0;
    result.has_boxes = boxes && result.contact_count > 0;
    result.has_gaps = form & GAPS && verdicts > 0;
    result.names_frames = result.has_gaps && form & FRAMES;
    for (int32_t i = 0; i < verdicts && result.has_gaps; i++)
        set_gap(dim, i);
    result.dim = result.has_boxes || result.has_gaps ? dim : 0;
}

static size_t bound_of_result(void)
{
    const size_t contacts = (size_t) result.contact_count, verdicts = (size_t) result.verdict_count;
    return WIRE_SCENE_RESULT_BYTES + 16 * (size_t) result.handle_count +
           2 * (size_t) result.unknown_count + verdicts +
           (result.names_pairs ? WIRE_PAIR_BYTES * verdicts : 0) +
           (result.has_times ? 16 * contacts : 0) +
           (result.has_boxes ? 16 * (size_t) result.dim * contacts : 0) +
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

static void test_result_round_trip(void **state)
{
    (void) state;
    for (int form = 0; form < 2 * FORMS; form++)
        for (int32_t verdicts = 0; verdicts < 40; verdicts++) {
            set_result(2 + form / FORMS, verdicts / 2, verdicts, form);
            const size_t size = write_and_read();
            if (verdicts == 0)
                continue; /* lcm-gen's decoder copies no bytes to nowhere, which sanitizers see */
            ASSERT_AS_LCM_WRITES(fmb_msgs_scene_result_t, bytes, size);
        }
}

/* As many of each kind of answer as the bound of wire.h admits, with the longest detail: the
 * message fits, and the bound is not wasteful. */
static void test_results_that_fill_a_message(void **state)
{
    (void) state;
    for (int form = 0; form < 2 * FORMS; form++) {
        int32_t verdicts = 0;
        do
            set_result(2 + form / FORMS, 300, ++verdicts, form);
        while (bound_of_result() + 5 + 16 + 48 + 96 < QUERY_BYTES_MAX &&
               verdicts < QUERY_VERDICTS_MAX);
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

static void test_refusal_round_trip(void **state)
{
    (void) state;
    result.status = FMB_UNKNOWN_BODY;
    strcpy(result.detail, "placements[1].handle: not held");
    result.unknown_count = 3;
    for (unsigned i = 0; i < 3; i++)
        result.unknown[i] = 1 + 2 * i;
    write_and_read();
    result.unknown[2] = 3; /* twice */
    assert_non_null(read_result(wire_write_scene_result(&result, bytes)));
    result.unknown[2] = QUERY_PLACEMENTS_MAX;
    assert_non_null(read_result(wire_write_scene_result(&result, bytes)));
    result.unknown_count = 0;
    assert_non_null(read_result(wire_write_scene_result(&result, bytes)));
    result.status = FMB_BUSY;
    write_and_read();
    result.unknown_count = 1;
    assert_non_null(read_result(wire_write_scene_result(&result, bytes)));
    result.unknown_count = 0;
    result.handle_count = 1;
    assert_non_null(read_result(wire_write_scene_result(&result, bytes)));
    result.handle_count = 0;
    result.end_pair = 1;
    assert_non_null(read_result(wire_write_scene_result(&result, bytes)));
}

/* ---- Results that no service gives ---- */

/* Three contacts with times and boxes in 3D, and space for the changes of a test. */
struct lie {
    fmb_msgs_scene_result_t message;
    char detail[8];
    uint8_t handles[HANDLE_BYTES * (QUERY_PLACEMENTS_MAX + 1)];
    double gaps[8], directions[12], witnesses[28];
    uint8_t verdicts[QUERY_VERDICTS_MAX + 1];
    int16_t indices[2 * QUERY_NAMED_MAX + 2];
    double times[QUERY_NUMBERS_MAX + 8], boxes[QUERY_NUMBERS_MAX + 8];
};

static struct lie lie;

static void begin_lie(void)
{
    static const int16_t indices[6] = {0, 1, 0, 2, 1, 2};
    memset(&lie, 0, sizeof lie);
    lie.message = (fmb_msgs_scene_result_t){.detail = lie.detail,
                                            .handles = lie.handles,
                                            .gaps = lie.gaps,
                                            .directions = lie.directions,
                                            .witnesses = lie.witnesses,
                                            .end_pair = 3,
                                            .num_verdicts = 3,
                                            .verdicts = lie.verdicts,
                                            .num_indices = 6,
                                            .indices = lie.indices,
                                            .num_times = 6,
                                            .times = lie.times,
                                            .num_boxes = 18,
                                            .boxes = lie.boxes};
    memcpy(lie.indices, indices, sizeof indices);
    for (int i = 0; i < 3; i++) {
        lie.verdicts[i] = FMB_OVERLAPPING;
        lie.times[2 * i + 1] = 1;
        for (int axis = 0; axis < 3; axis++)
            lie.boxes[6 * i + 3 + axis] = 1;
    }
}

static const char *read_lie(void)
{
    static unsigned char large[8 * QUERY_BYTES_MAX];
    const int size = fmb_msgs_scene_result_t_encode(large, 0, sizeof large, &lie.message);
    assert_true(size > 0);
    return wire_read_scene_result(large, (uint32_t) size, &result_read);
}

#define LIE(change)                            \
    do {                                       \
        begin_lie();                           \
        assert_null(read_lie());               \
        change;                                \
        if (!read_lie())                       \
            fail_msg("believed: %s", #change); \
    } while (0)

#define TRUE(change)             \
    do {                         \
        begin_lie();             \
        change;                  \
        assert_null(read_lie()); \
    } while (0)

static void test_lies_about_verdicts(void **state)
{
    (void) state;
    LIE(lie.verdicts[1] = 4);
    LIE(lie.verdicts[2] = 255);
    LIE(lie.message.status = FMB_BUSY);
    LIE(lie.message.num_verdicts = 2);
    LIE(lie.verdicts[0] = FMB_SEPARATED); /* then there are too many times */
    LIE((lie.verdicts[0] = FMB_SEPARATED, lie.message.num_times = 4, lie.message.num_boxes = 12));
    LIE((lie.verdicts[0] = 0, lie.message.num_times = 4, lie.message.num_boxes = 12));
    LIE((lie.message.num_verdicts = QUERY_VERDICTS_MAX + 1, lie.message.num_indices = 0));
    LIE(lie.message.num_handle_bytes = HANDLE_BYTES * (QUERY_PLACEMENTS_MAX + 1));
    LIE(lie.message.num_handle_bytes = HANDLE_BYTES + 1);
    LIE(lie.message.num_handle_bytes = HANDLE_BYTES + HANDLE_BYTES / 2);
    LIE(lie.message.end_pair = -1);
    TRUE((lie.verdicts[0] = FMB_SEPARATED, lie.message.num_times = 4, lie.message.num_boxes = 12,
          lie.message.num_indices = 0));
}

static void test_lies_about_pairs(void **state)
{
    (void) state;
    LIE(lie.message.num_indices = 4);
    LIE(lie.message.num_indices = 5);
    LIE(lie.indices[5] = QUERY_PLACEMENTS_MAX);
    LIE(lie.indices[5] = -1);
    LIE(lie.indices[0] = -1);
    LIE(lie.indices[4] = 2);                       /* with itself */
    LIE(lie.indices[5] = 0);                       /* the other way round */
    LIE(lie.indices[3] = 1);                       /* a second time */
    LIE(lie.indices[4] = 0);                       /* the same */
    LIE((lie.indices[2] = 1, lie.indices[4] = 0)); /* out of order */
    TRUE(lie.message.num_indices = 0);
    TRUE(lie.indices[5] = QUERY_PLACEMENTS_MAX - 1);
}

static void test_lies_about_times(void **state)
{
    (void) state;
    LIE(lie.message.num_times = 4);
    LIE(lie.message.num_times = 5);
    LIE(lie.times[0] = NAN);
    LIE(lie.times[5] = NAN);
    LIE(lie.times[2] = -0x1p-1074);
    LIE(lie.times[3] = -1);
    LIE(lie.times[5] = INFINITY);
    LIE(lie.times[4] = 1.5);
    LIE(lie.times[4] = lie.times[5] = NAN);
    TRUE(lie.times[4] = 1);
    TRUE(lie.message.num_times = 0);
}

static void test_lies_about_boxes(void **state)
{
    (void) state;
    LIE(lie.message.num_boxes = 6);
    LIE(lie.message.num_boxes = 17);
    LIE(lie.message.num_boxes = 1);
    LIE(lie.boxes[0] = NAN);
    LIE(lie.boxes[17] = NAN);
    LIE(lie.boxes[14] = 1.5);
    LIE(lie.boxes[3] = -INFINITY);
    LIE((lie.message.num_boxes = 12, lie.boxes[0] = 2)); /* in 2D */
    TRUE(lie.boxes[17] = INFINITY);
    TRUE(lie.message.num_boxes = 0);
}

/* Three pairs in 3D with gaps: one that overlaps, one that touches, one that is near. */
static void begin_gaps(void)
{
    begin_lie();
    lie.verdicts[1] = FMB_TOUCHING;
    lie.verdicts[2] = FMB_SEPARATED;
    lie.message.num_times = 4;
    lie.message.num_boxes = 12;
    lie.message.num_gaps = 6;
    lie.message.num_directions = 9;
    lie.message.num_witnesses = 21;
    lie.gaps[0] = lie.gaps[1] = -1;
    lie.gaps[4] = 0.5;
    lie.gaps[5] = 0.75;
    for (int i = 0; i < 14; i++)
        lie.witnesses[i] = NAN;
    assert_null(read_lie());
}

#define GAP_LIE(change)                        \
    do {                                       \
        begin_gaps();                          \
        change;                                \
        if (!read_lie())                       \
            fail_msg("believed: %s", #change); \
    } while (0)

/* No gap of the last pair, which is near. */
static void remove_gap(void)
{
    lie.gaps[4] = lie.gaps[5] = NAN;
    for (int i = 0; i < 3; i++)
        lie.directions[6 + i] = NAN;
    for (int i = 14; i < 21; i++)
        lie.witnesses[i] = NAN;
}

static void test_lies_about_gaps(void **state)
{
    (void) state;
    GAP_LIE(lie.message.num_gaps = 0);
    GAP_LIE(lie.message.num_gaps = 4);
    GAP_LIE(lie.message.num_gaps = 7);
    GAP_LIE(lie.message.num_directions = 8);
    GAP_LIE(lie.message.num_directions = 0);
    GAP_LIE(lie.message.num_witnesses = 14);
    GAP_LIE((lie.message.num_directions = 6, lie.message.num_witnesses = 15,
             memset(lie.witnesses + 10, 0, 5 * sizeof *lie.witnesses))); /* 2D, boxes 3D */
    GAP_LIE(lie.message.num_gaps = lie.message.num_directions = lie.message.num_witnesses = 0);
    GAP_LIE(lie.gaps[0] = -0.5);
    GAP_LIE(lie.gaps[1] = NAN);
    GAP_LIE(lie.gaps[0] = lie.gaps[1] = NAN);
    GAP_LIE(lie.gaps[2] = -1);
    GAP_LIE(lie.gaps[3] = 1);
    GAP_LIE(lie.directions[0] = NAN);
    GAP_LIE(lie.directions[8] = INFINITY);
    GAP_LIE(lie.witnesses[0] = 0);
    GAP_LIE(lie.witnesses[13] = -NAN); /* with other bits */
    GAP_LIE(lie.witnesses[14] = -1);
    GAP_LIE(lie.witnesses[14] = INFINITY);
    GAP_LIE(lie.witnesses[20] = NAN);
    GAP_LIE((lie.verdicts[2] = 0, lie.message.num_indices = 0));
    GAP_LIE(remove_gap());
    begin_gaps();
    remove_gap();
    lie.message.num_indices = 0;
    assert_null(read_lie());
    lie.directions[6] = 0;
    assert_non_null(read_lie());
    begin_gaps();
    lie.gaps[5] = lie.witnesses[20] = INFINITY;
    assert_null(read_lie());
    lie.message.num_boxes = 0;
    lie.message.num_directions = 6;
    lie.message.num_witnesses = 15;
    lie.witnesses[10] = lie.witnesses[11] = lie.witnesses[12] = lie.witnesses[13] = 0;
    assert_null(read_lie());
    assert_int_equal(result_read.dim, 2);
}

/* ---- Mutants ---- */

static uint64_t next_random(uint64_t *seed)
{
    *seed ^= *seed << 13;
    *seed ^= *seed >> 7;
    *seed ^= *seed << 17;
    return *seed;
}

/* What is read from damaged bytes, if anything, is what lcm-gen's decoder reads from them: written
 * again it is the same bytes. */
static void test_what_is_read_of_mutants_is_there(void **state)
{
    (void) state;
    uint64_t seed = 88172645463325252u;
    int accepted[2] = {0}, refused[2] = {0};
    for (int round = 0; round < 60000; round++) {
        const bool is_query = round % 2;
        const size_t size = hostile_good(is_query ? "scene_query" : "scene_result", bytes);
        for (uint64_t n = next_random(&seed) % 3 + 1; n > 0; n--)
            bytes[8 + next_random(&seed) % (size - 8)] = (unsigned char) next_random(&seed);
        if (is_query ? read_query(size) : read_result(size)) {
            refused[is_query]++;
            continue;
        }
        accepted[is_query]++;
        const size_t written = is_query ? wire_write_scene_query(&query_read, again)
                                        : wire_write_scene_result(&result_read, again);
        assert_int_equal(written, size);
        assert_memory_equal(again, bytes, size);
    }
    for (int i = 0; i < 2; i++)
        assert_true(accepted[i] > 1000 && refused[i] > 1000);
}

/* Only the padding, 1 byte after the flags and 7 after has_witness, does not count. */
static void answers_that_differ_in_any_byte_are_not_the_same(void **state)
{
    (void) state;
    const struct fmb_answer full = {.has_contact = true, .has_box = true, .has_gap = true};
    size_t same = 0;
    for (size_t i = 0; i < sizeof full; i++) {
        struct fmb_answer other;
        memcpy(&other, &full, sizeof full);
        ((unsigned char *) &other)[i] ^= 1;
        same += query_same_answer(&full, &other);
    }
    assert_int_equal(same, 8);
    assert_true(query_same_answer(&full, &full));
}

/* Numbers of a part that neither answer has are not compared. */
static void parts_that_no_answer_has_are_the_same(void **state)
{
    (void) state;
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
        TEST(test_query_round_trip),
        TEST(test_lists_of_every_length),
        TEST(test_largest_queries),
        TEST(test_more_than_the_capacity),
        TEST(test_result_round_trip),
        TEST(test_results_that_fill_a_message),
        TEST(test_refusal_round_trip),
        TEST(test_lies_about_verdicts),
        TEST(test_lies_about_pairs),
        TEST(test_lies_about_times),
        TEST(test_lies_about_boxes),
        TEST(test_lies_about_gaps),
        TEST(test_what_is_read_of_mutants_is_there),
    };
    return cmocka_run_group_tests_name("wire_scene", tests, NULL, NULL);
}
