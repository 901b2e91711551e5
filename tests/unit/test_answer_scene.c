/* What a scene query gets: the answers of fmb_decide() to each of its pairs, to the bit; all that
 * one datagram has room for, and the rest on request; or what is wrong, and where. */
#include "answer.h"
#include "scene_truth.h"
#include "wire.h"

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

enum { BODIES = 40 };

static struct answerer answerer;
static struct scene_query scene, other;
static struct scene_result result, again;
static unsigned char bytes[2 * QUERY_BYTES_MAX];

static int set_up(void **state)
{
    (void) state;
    answerer = (struct answerer){.cache = cache_create(BODIES, 500), .server_id = 99};
    memset(&scene, 0, sizeof scene);
    scene.duration = 1;
    scene.which = QUERY_PAIRS_ALL;
    return answerer.cache && answer_prepare(&answerer) ? 0 : -1;
}

static int tear_down(void **state)
{
    (void) state;
    answer_release(&answerer);
    cache_destroy(answerer.cache);
    return 0;
}

/* What was in the result before must not show. */
static void ask(const struct scene_query *query)
{
    memset(&result, 0xa5, sizeof result);
    answer_scene(&answerer, query, &result);
}

/* The result as it stands in a datagram: of a size that was promised, and read back the same. */
static size_t assert_fits(void)
{
    const size_t size = wire_write_scene_result(&result, bytes);
    const size_t contacts = (size_t) result.contact_count;
    const size_t promised =
        WIRE_SCENE_RESULT_BYTES + 8 * (size_t) result.key_count +
        (size_t) result.verdict_count * (1 + (result.names_pairs ? WIRE_PAIR_BYTES : 0)) +
        (result.has_times ? 16 * contacts : 0) +
        (result.has_boxes ? 16 * (size_t) result.dim * contacts : 0);
    assert_true(size <= promised && promised <= QUERY_BYTES_MAX);
    const char *error = wire_read_scene_result(bytes, (uint32_t) size, &again);
    if (error)
        fail_msg("the result cannot be read: %s", error);
    assert_int_equal(again.end_pair, result.end_pair);
    assert_int_equal(again.contact_count, result.contact_count);
    return size;
}

static void ask_and_check(const struct scene_query *query)
{
    ask(query);
    scene_assert(query, &result);
    assert_fits();
}

static void set_cube(int32_t i, int64_t body_id, double x)
{
    const struct solid cube = {.dim = 3,
                               .shape = FMB_CUBOID,
                               .component = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                               .origin = {x}};
    scene_set_frame(&cube, body_id, &scene.frame[i]);
}

/* Cubes in a row, bodies 1, 2, ..., neighbours sharing a face. */
static void set_row(int32_t count)
{
    scene.frame_count = count;
    for (int32_t i = 0; i < count; i++)
        set_cube(i, i + 1, i);
}

/* ---- Right answers ---- */

static const int32_t wants[] = {0, QUERY_WANT_BOX, QUERY_WANT_TIMES,
                                QUERY_WANT_BOX | QUERY_WANT_TIMES};

static void ask_in_every_way(struct draw *draw, const char *method)
{
    scene.method = fmb_method_by_name(method)->number;
    for (int32_t which = QUERY_PAIRS_LISTED; which <= QUERY_PAIRS_ACROSS; which++)
        for (size_t w = 0; w < COUNT(wants); w++) {
            scene.which = which;
            scene.want = wants[w];
            scene.index_count = scene.split = 0;
            if (which == QUERY_PAIRS_LISTED)
                scene_draw_pairs(draw, 60, &scene);
            if (which == QUERY_PAIRS_ACROSS)
                scene.split = draw_int(draw, 0, scene.frame_count);
            ask_and_check(&scene);
        }
}

static double draw_duration(struct draw *draw)
{
    static const double others[] = {0, -0.0, 0x1p-1074, 0.1, 3, 1e300, DBL_MAX};
    return draw_coin(draw) ? 1 : others[draw_int(draw, 0, (int) COUNT(others) - 1)];
}

static void test_answers_are_those_of_each_pair(void **state)
{
    (void) state;
    struct draw draw;
    draw_begin(&draw, "scenes, certified");
    for (long round = 0; round < draw_sample(96); round++) {
        scene_draw_frames(&draw, 2 + round % 2, round % 3 - 1, 12, &scene);
        scene.duration = draw_duration(&draw);
        for (int i = 0; i < 12; i++)
            scene.frame[i].body_id = draw_int(&draw, 0, 30);
        ask_in_every_way(&draw, "certified");
    }
}

static void test_answers_of_the_exact_method(void **state)
{
    (void) state;
    struct draw draw;
    draw_begin(&draw, "scenes, exact");
    for (long round = 0; round < draw_sample(16); round++) {
        scene_draw_frames(&draw, 2 + round % 2, -1, 8, &scene);
        ask_in_every_way(&draw, "exact");
    }
}

/* Of flat frames they say nothing. */
static void test_answers_of_inexact_methods(void **state)
{
    (void) state;
    struct draw draw;
    int undecided = 0;
    draw_begin(&draw, "scenes, inexact");
    for (long round = 0; round < draw_sample(160); round++) {
        scene.method = fmb_method_by_name(round % 2 ? "fmb" : "sat")->number;
        scene.which = QUERY_PAIRS_LISTED;
        scene.want = wants[round / 2 % 4];
        scene_draw_frames(&draw, 2 + (int) (round / 8 % 2), -1, 12, &scene);
        scene_draw_pairs(&draw, 60, &scene);
        ask_and_check(&scene);
        for (int32_t i = 0; i < result.verdict_count; i++)
            undecided += result.verdict[i] == 0;
        scene.which = QUERY_PAIRS_ALL;
        scene.index_count = 0;
        ask(&scene);
        assert_int_equal(result.status, FMB_CANNOT_DECIDE);
        assert_string_equal(result.detail, "method: listed pairs alone");
    }
    assert_true(undecided > 0);
}

/* The scene at which the tree of boxes looks: of all sizes, from the least doubles to the largest,
 * and where many boxes are the same. */
static void test_no_contact_is_lost_anywhere(void **state)
{
    (void) state;
    static const double scales[] = {0x1p-1074, 1e-308, 1e-300, 1, 1e150, 1e300, 0x1p1021};
    struct draw draw;
    draw_begin(&draw, "scenes of all sizes");
    scene.want = QUERY_WANT_BOX | QUERY_WANT_TIMES;
    for (long round = 0; round < draw_sample(112); round++) {
        const double scale = scales[round % (int) COUNT(scales)];
        const int dim = draw_int(&draw, 2, 3), room = draw_int(&draw, 0, 3);
        scene.frame_count = 20;
        for (int i = 0; i < 20; i++) {
            struct solid solid = {.dim = dim, .shape = draw_coin(&draw) ? 1 : 2};
            solid.moving = round % 2 && draw_coin(&draw);
            for (int axis = 0; axis < dim; axis++) {
                solid.component[axis][axis] = draw_int(&draw, 0, 1) * scale;
                solid.component[axis][0] += draw_int(&draw, -1, 1) * scale;
                solid.origin[axis] = draw_int(&draw, -room, room) * scale;
                solid.velocity[axis] = draw_int(&draw, -2, 2) * scale;
            }
            scene_set_frame(&solid, 0, &scene.frame[i]);
        }
        ask_and_check(&scene);
        scene.which = QUERY_PAIRS_ACROSS;
        scene.split = draw_int(&draw, 0, 20);
        ask_and_check(&scene);
        scene.which = QUERY_PAIRS_ALL;
        scene.split = 0;
    }
}

/* ---- Parts ---- */

static void test_every_pair_can_be_the_first(void **state)
{
    (void) state;
    struct draw draw;
    draw_begin(&draw, "first pairs");
    for (int32_t which = QUERY_PAIRS_LISTED; which <= QUERY_PAIRS_ACROSS; which++) {
        const int32_t last_split = which == QUERY_PAIRS_ACROSS ? 9 : 0;
        scene_draw_frames(&draw, 3, -1, 9, &scene);
        scene.which = which;
        scene.want = QUERY_WANT_BOX | QUERY_WANT_TIMES;
        scene.index_count = 0;
        if (which == QUERY_PAIRS_LISTED)
            scene_draw_pairs(&draw, 40, &scene);
        for (scene.split = 0; scene.split <= last_split; scene.split++) {
            const unsigned(*pair)[2];
            const int32_t total = scene_list(&scene, &pair);
            for (scene.first_pair = 0; scene.first_pair <= total; scene.first_pair++) {
                ask_and_check(&scene);
                assert_int_equal(result.end_pair, total);
            }
            ask(&scene); /* one beyond */
            assert_int_equal(result.status, FMB_BAD_PAIR);
            assert_string_equal(result.detail, "first_pair: there are not so many");
            scene.first_pair = 0;
        }
        scene.split = 0;
    }
}

/* Asks for part after part; each but the last fills its datagram. Returns how many there were. */
static int ask_all_parts(size_t largest_pair)
{
    const unsigned(*pair)[2];
    const int32_t total = scene_list(&scene, &pair);
    int parts = 0;
    for (scene.first_pair = 0; scene.first_pair < total; scene.first_pair = result.end_pair) {
        ask(&scene);
        scene_assert(&scene, &result);
        const size_t size = assert_fits();
        if (result.end_pair < total)
            assert_true(size + largest_pair + QUERY_TEXT_MAX + 8 > QUERY_BYTES_MAX);
        parts++;
    }
    scene.first_pair = 0;
    return parts;
}

/* All in one place, so that all meet. */
static void set_heap(int32_t count, int dim, bool moving, bool kept)
{
    scene.frame_count = count;
    for (int32_t i = 0; i < count; i++) {
        struct solid solid = {.dim = dim, .shape = FMB_CUBOID, .moving = moving};
        for (int axis = 0; axis < dim; axis++) {
            solid.component[axis][axis] = 1 + i % 3;
            solid.origin[axis] = 0.5 * (i % 2);
            solid.velocity[axis] = 0.25 * (i % 5);
        }
        scene_set_frame(&solid, kept ? i + 1 : 0, &scene.frame[i]);
    }
}

static void test_parts_fill_their_datagrams(void **state)
{
    (void) state;
    set_heap(100, 3, true, true);
    scene.want = QUERY_WANT_BOX | QUERY_WANT_TIMES;
    assert_int_equal(ask_all_parts(5 + 16 + 48), (4950 * 69 + 63943) / 63944);
    set_heap(160, 2, false, false);
    scene.want = 0;
    assert_int_equal(ask_all_parts(5), 1);
    scene.want = QUERY_WANT_BOX;
    assert_int_equal(ask_all_parts(5 + 32), (12720 * 37 + 64743) / 64744);
    scene.which = QUERY_PAIRS_LISTED;
    scene.index_count = 0;
    for (unsigned i = 0; i < 12000; i++) {
        scene.pair[i][0] = i % 160;
        scene.pair[i][1] = (i + 1 + i / 160) % 160;
        scene.index_count += 2;
    }
    assert_int_equal(ask_all_parts(1 + 32), (12000 * 33 + 64743) / 64744);
}

/* As many pairs as a query has room for, of two frames or of many: their verdicts fit, with keys.
 */
static void test_verdicts_of_listed_pairs_fit(void **state)
{
    (void) state;
    scene.which = QUERY_PAIRS_LISTED;
    for (int32_t count = 2; count <= 350; count += 348) {
        set_heap(count, 2, false, true);
        size_t size = WIRE_SCENE_QUERY_BYTES;
        for (int32_t i = 0; i < count; i++)
            size += wire_frame_bytes(&scene.frame[i]);
        const int32_t pairs = (int32_t) ((QUERY_BYTES_MAX - size) / WIRE_PAIR_BYTES);
        assert_true(pairs > (count == 2 ? 16000 : 9000));
        for (int32_t i = 0; i < pairs; i++) {
            scene.pair[i][0] = (unsigned) (i % count);
            scene.pair[i][1] = (unsigned) ((i + 1) % count);
        }
        scene.index_count = 2 * pairs;
        ask_and_check(&scene);
        assert_int_equal(result.end_pair, pairs);
        assert_int_equal(result.key_count, count);
    }
}

/* ---- Little is asked ---- */

static void test_empty_scenes(void **state)
{
    (void) state;
    for (int32_t which = QUERY_PAIRS_LISTED; which <= QUERY_PAIRS_ACROSS; which++)
        for (int32_t frames = 0; frames <= 1; frames++)
            for (int32_t split = 0; split <= (which == QUERY_PAIRS_ACROSS ? frames : 0); split++) {
                set_row(frames);
                scene.which = which;
                scene.split = split;
                scene.want = QUERY_WANT_BOX | QUERY_WANT_TIMES;
                ask_and_check(&scene);
                assert_int_equal(result.end_pair, 0);
                assert_int_equal(result.key_count, frames);
            }
}

static void test_echo(void **state)
{
    (void) state;
    set_row(2);
    scene.utime = 3;
    scene.client_id = 4;
    scene.sequence_number = 5;
    for (int refused = 0; refused < 2; refused++) {
        scene.want = refused ? 64 : 0;
        ask(&scene);
        assert_int_equal(result.status, refused ? FMB_UNKNOWN_WANT : FMB_OK);
        assert_int_equal(result.utime, 3);
        assert_int_equal(result.client_id, 4);
        assert_int_equal(result.sequence_number, 5);
        assert_int_equal(result.server_id, 99);
        assert_int_equal(result.lost, 0);
        assert_int_equal(result.compute_ns, 0);
    }
}

/* ---- Refusals ---- */

/* Of a scene that is wrong in one place: nothing is decided or kept. */
static void expect(enum fmb_status status, const char *detail)
{
    const int64_t kept = cache_counts(answerer.cache).misses;
    ask(&scene);
    assert_string_equal(result.detail, detail);
    assert_int_equal(result.status, status);
    assert_int_equal(result.method, 0);
    assert_int_equal(result.key_count + result.verdict_count + result.contact_count, 0);
    assert_int_equal(result.end_pair, 0);
    assert_fits();
    assert_int_equal(cache_counts(answerer.cache).misses, kept);
}

static void test_bad_frames(void **state)
{
    (void) state;
    set_row(1400);
    scene.frame[3].components.number[4] = NAN;
    expect(FMB_NOT_FINITE, "frames[3].components[4]: not a finite number");
    set_row(1400);
    scene.frame[1399].origin.number[2] = -INFINITY;
    expect(FMB_NOT_FINITE, "frames[1399].origin[2]: not a finite number");
    set_row(7);
    scene.frame[6].velocity = (struct query_numbers){.count = 3, .number = {0, INFINITY, 0}};
    expect(FMB_NOT_FINITE, "frames[6].velocity[1]: not a finite number");
    set_row(7);
    scene.frame[0].components.count = INT32_MAX;
    expect(FMB_WRONG_COUNT, "frames[0].components: expected 9 numbers, found 2147483647");
    set_row(7);
    scene.frame[5].velocity.count = 2;
    expect(FMB_WRONG_COUNT, "frames[5].velocity: expected 3 numbers, found 2");
    set_row(7);
    scene.frame[5].shape = -1;
    expect(FMB_UNKNOWN_SHAPE, "frames[5].shape: unknown shape");
    set_row(7);
    scene.frame[0].dim = scene.frame[0].origin.count = INT32_MAX;
    expect(FMB_WRONG_DIMENSION, "frames[0].dim: neither 2 nor 3");
    set_row(7);
    scene.frame[2].dim = scene.frame[2].origin.count = 2;
    scene.frame[2].components.count = 4;
    expect(FMB_DIMENSIONS_DIFFER, "frames[2].dim: a 2D frame against a 3D one");
    set_row(7);
    scene.frame[2].body_id = -1;
    expect(FMB_BAD_ID, "frames[2].body_id: not from 0 to 2^53 - 1");
    set_row(7);
    scene.frame[2].key = QUERY_ID_MAX + 1;
    expect(FMB_BAD_ID, "frames[2].key: not from 0 to 2^53 - 1");
}

static void test_bad_counts(void **state)
{
    (void) state;
    set_row(2);
    scene.frame_count = 1401;
    expect(FMB_OVER_LIMIT, "num_frames: more than 1400");
    scene.frame_count = INT32_MAX;
    expect(FMB_OVER_LIMIT, "num_frames: more than 1400");
    set_row(2);
    scene.which = QUERY_PAIRS_LISTED;
    scene.index_count = INT32_MAX;
    expect(FMB_OVER_LIMIT, "num_indices: more than 32500");
    scene.index_count = 3;
    expect(FMB_WRONG_COUNT, "num_indices: not two for each pair");
    scene.index_count = 2;
    for (scene.which = QUERY_PAIRS_ALL; scene.which <= QUERY_PAIRS_ACROSS; scene.which++)
        expect(FMB_WRONG_COUNT, "num_indices: none but where pairs are listed");
}

static void test_bad_pairs(void **state)
{
    (void) state;
    static const struct {
        unsigned a, b;
        int place;
    } bad[] = {{7, 0, 6}, {0, 7, 7}, {UINT32_MAX, 8, 6}, {6, (unsigned) INT16_MIN, 7}};
    set_row(7);
    scene.which = QUERY_PAIRS_LISTED;
    scene.index_count = 10;
    for (int i = 0; i < 5; i++)
        scene.pair[i][1] = 1;
    for (size_t i = 0; i < COUNT(bad); i++) {
        char detail[60];
        scene.pair[3][0] = bad[i].a;
        scene.pair[3][1] = bad[i].b;
        snprintf(detail, sizeof detail, "indices[%d]: no frame has this index", bad[i].place);
        expect(FMB_BAD_PAIR, detail);
    }
    scene.pair[3][0] = scene.pair[3][1] = 2;
    expect(FMB_BAD_PAIR, "indices[7]: a frame against itself");
    scene.pair[3][0] = 6;
    ask_and_check(&scene);
}

static void test_bad_questions(void **state)
{
    (void) state;
    const double durations[] = {-1, NAN, INFINITY, -0x1p-1074};
    set_row(2);
    for (size_t i = 0; i < COUNT(durations); i++) {
        scene.duration = durations[i];
        expect(FMB_BAD_DURATION, "duration: negative or not finite");
    }
    scene.duration = 1;
    scene.method = -1;
    expect(FMB_UNKNOWN_METHOD, "method: unknown method");
    scene.method = 0;
    scene.want = QUERY_WANT_CERTIFICATE;
    expect(FMB_UNKNOWN_WANT, "want: wants what this version does not give");
    scene.want = 0;
    for (scene.which = -1; scene.which <= 3; scene.which += 4)
        expect(FMB_UNKNOWN_WANT, "which: wants what this version does not give");
    scene.which = QUERY_PAIRS_ALL;
    scene.split = 1;
    expect(FMB_BAD_PAIR, "split: not 0");
    scene.which = QUERY_PAIRS_ACROSS;
    scene.split = 3;
    expect(FMB_BAD_PAIR, "split: not from 0 to num_frames");
    scene.split = INT32_MIN;
    expect(FMB_BAD_PAIR, "split: not from 0 to num_frames");
    scene.split = 1;
    scene.first_pair = 2;
    expect(FMB_BAD_PAIR, "first_pair: there are not so many");
    scene.first_pair = INT32_MIN;
    expect(FMB_BAD_PAIR, "first_pair: there are not so many");
    scene.first_pair = 0;
    scene.client_id = -1;
    expect(FMB_BAD_ID, "client_id: not from 0 to 2^53 - 1");
    scene.client_id = 1;
    scene.sequence_number = INT64_MAX;
    expect(FMB_BAD_ID, "sequence_number: not from 0 to 2^53 - 1");
}

static void test_refused_without_a_look(void **state)
{
    (void) state;
    const struct query_header header = {7, 8, 9};
    memset(&result, 0xa5, sizeof result);
    answer_scene_refused(&answerer, &header, FMB_BUSY, &result);
    assert_int_equal(result.status, FMB_BUSY);
    assert_string_equal(result.detail, "busy");
    assert_int_equal(result.utime, 7);
    assert_int_equal(result.client_id, 8);
    assert_int_equal(result.sequence_number, 9);
    assert_true(assert_fits() < 120);
}

/* ---- Keys ---- */

static void by_key(struct query_frame *frame, int64_t key)
{
    frame->key = key;
    frame->components = (struct query_numbers){0};
}

static void test_keys_mixed_with_whole_frames(void **state)
{
    (void) state;
    struct draw draw;
    draw_begin(&draw, "keys");
    scene.want = QUERY_WANT_BOX | QUERY_WANT_TIMES;
    for (long round = 0; round < draw_sample(64); round++) {
        int64_t key[12];
        scene_draw_frames(&draw, 2 + round % 2, -1, 12, &scene);
        for (int i = 0; i < 12; i++)
            scene.frame[i].body_id = i % 4 ? 100 + i : 0;
        scene.method = round % 4 == 3 ? fmb_method_by_name("exact")->number : 0;
        ask_and_check(&scene);
        assert_int_equal(result.key_count, 12);
        memcpy(key, result.key, sizeof key);
        other = scene;
        bool all = true;
        for (int i = 0; i < 12; i++) {
            assert_int_equal(key[i] == 0, i % 4 == 0);
            if (key[i] && (round % 8 == 7 || draw_coin(&draw)))
                by_key(&other.frame[i], key[i]);
            else
                all = all && !key[i];
        }
        ask(&other);
        scene_assert(&scene, &result);
        assert_int_equal(result.key_count, all ? 0 : 12);
        if (!all)
            assert_memory_equal(result.key, key, sizeof key);
    }
}

/* Exactly those that are not held are told of, and the cache stays as it was. */
static void test_dead_keys(void **state)
{
    (void) state;
    set_row(6);
    ask(&scene);
    for (int i = 0; i < 6; i++)
        if (i != 2)
            by_key(&scene.frame[i], result.key[i] + (i == 1 || i == 4));
    scene.frame[2].components.number[0] = 7;
    scene.frame[5].shape = FMB_TETRAHEDRON;
    const struct cache_counts before = cache_counts(answerer.cache);
    ask(&scene);
    assert_int_equal(result.status, FMB_UNKNOWN_BODY);
    assert_string_equal(result.detail,
                        "frames: keys that are not held; send the components where "
                        "keys[] is 0");
    assert_int_equal(result.key_count, 6);
    const int64_t expected[] = {500, 0, 0, 503, 0, 0};
    assert_memory_equal(result.key, expected, sizeof expected);
    assert_int_equal(result.verdict_count + result.end_pair + result.method, 0);
    assert_fits();
    const struct cache_counts after = cache_counts(answerer.cache);
    assert_int_equal(after.bodies, before.bodies);
    assert_int_equal(after.misses, before.misses);
}

/* Each frame is what it says; the key that dies with the second is told of as it was given. */
static void test_one_id_with_two_bodies(void **state)
{
    (void) state;
    for (int method = 0; method < 2; method++) {
        scene.method = method ? fmb_method_by_name("exact")->number : 0;
        set_row(4);
        for (int i = 0; i < 4; i++) {
            scene.frame[i].body_id = 9;
            scene.frame[i].components.number[0] = i % 2 ? 1.5 : 1;
        }
        ask_and_check(&scene);
        other = scene;
        for (int i = 0; i < 3; i++)
            assert_int_not_equal(result.key[i], result.key[3]);
        by_key(&other.frame[1], result.key[3]);
        ask(&other); /* key 1 is held when it is looked up, though frame 0 replaces it then */
        scene_assert(&scene, &result);
        by_key(&other.frame[1], result.key[1]);
        ask(&other);
        assert_int_equal(result.status, FMB_UNKNOWN_BODY);
    }
}

static void test_more_bodies_than_the_cache_holds(void **state)
{
    (void) state;
    static int64_t key[3 * BODIES];
    scene.want = QUERY_WANT_BOX;
    for (int method = 0; method < 2; method++) {
        scene.method = method ? fmb_method_by_name("exact")->number : 0;
        set_row(3 * BODIES);
        for (int32_t i = 0; i < scene.frame_count; i++)
            scene.frame[i].components.number[0] = 1 + i % 7 * 0.25;
        ask_and_check(&scene);
        memcpy(key, result.key, sizeof key);
        other = scene;
        for (int32_t i = 0; i < scene.frame_count; i++)
            by_key(&other.frame[i], key[i]);
        ask(&other);
        assert_int_equal(result.status, FMB_UNKNOWN_BODY);
        for (int32_t i = 0; i < scene.frame_count; i++) {
            assert_true(result.key[i] == (i < 2 * BODIES ? 0 : key[i]));
            if (result.key[i] == 0)
                other.frame[i] = scene.frame[i];
        }
        ask(&other);
        scene_assert(&scene, &result);
    }
}

/* ---- Memory ---- */

/* The linker puts these in the place of malloc() and the like, where our own code calls them
 * (GMP, which the exact step asks, has its own). */
void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *old, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *old, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);

static long allocations;

void *__wrap_malloc(size_t size)
{
    allocations++;
    return __real_malloc(size);
}

void *__wrap_calloc(size_t count, size_t size)
{
    allocations++;
    return __real_calloc(count, size);
}

void *__wrap_realloc(void *old, size_t size)
{
    allocations++;
    return __real_realloc(old, size);
}

void *__wrap_aligned_alloc(size_t alignment, size_t size)
{
    allocations++;
    return __real_aligned_alloc(alignment, size);
}

/* All is taken at the start, whatever is asked: by key or whole, evicting or not, refused or not.
 */
static void test_answers_allocate_nothing(void **state)
{
    (void) state;
    struct draw draw;
    draw_begin(&draw, "memory");
    assert_true(allocations > 0); /* by set_up() */
    allocations = 0;
    for (int round = 0; round < 40; round++) {
        scene_draw_frames(&draw, 2 + round % 2, -1, 60, &scene);
        for (int i = 0; i < 60; i++)
            scene.frame[i].body_id = draw_int(&draw, 0, 100);
        scene.want = wants[round % 4];
        scene.which = round % 3;
        scene.split = scene.which == QUERY_PAIRS_ACROSS ? 20 : 0;
        scene.index_count = 0;
        if (scene.which == QUERY_PAIRS_LISTED)
            scene_draw_pairs(&draw, 500, &scene);
        ask(&scene);
        assert_int_equal(result.status, FMB_OK);
        scene.frame[7].key = 3;
        scene.frame[7].components.count = 0;
        ask(&scene);
        assert_int_equal(result.status, FMB_UNKNOWN_BODY);
    }
    set_heap(1400, 3, true, true);
    scene.which = QUERY_PAIRS_ALL;
    scene.split = scene.index_count = 0;
    ask(&scene);
    assert_int_equal(result.status, FMB_OK);
    assert_int_equal(allocations, 0);
}

/* ---- Calls between ---- */

static int64_t asked_between;

static bool ask_a_pair(void *user)
{
    const struct solid solid = {.dim = 2, .shape = FMB_TETRAHEDRON, .component = {{1, 0}, {0, 1}}};
    struct pair_query query = {.duration = 1, .want = QUERY_WANT_BOX | QUERY_WANT_CERTIFICATE};
    struct pair_result pair_result;
    for (int f = 0; f < 2; f++)
        scene_set_frame(&solid, 1 + asked_between++ % 1000, &query.frame[f]);
    answer_pair(user, &query, &pair_result);
    assert_int_equal(pair_result.answer.verdict, FMB_OVERLAPPING);
    return true;
}

/* Pairs that are answered meanwhile, and throw every body of the scene out of the cache, do not
 * show in its answers. */
static void test_pairs_answered_between_do_not_show(void **state)
{
    (void) state;
    answerer.between = ask_a_pair;
    answerer.user = &answerer;
    asked_between = 0;
    set_heap(100, 2, true, true);
    scene.want = QUERY_WANT_TIMES;
    for (int method = 0; method < 2; method++) {
        scene.method = method ? fmb_method_by_name("exact")->number : 0;
        ask_all_parts(21);
    }
    assert_true(asked_between > 100);
}

static bool enough(void *user)
{
    int *calls = user;
    return --*calls > 0;
}

/* A scene that is ended early has the answers up to where it came, and the next one the rest. */
static void test_scenes_end_early_where_others_wait(void **state)
{
    (void) state;
    struct draw draw;
    draw_begin(&draw, "scenes cut off");
    set_heap(24, 3, true, false);
    for (int i = 0; i < 4; i++)
        scene.frame[20 + i].origin.number[0] = 1e9; /* these meet nobody */
    scene.method = fmb_method_by_name("exact")->number;
    scene.want = QUERY_WANT_BOX | QUERY_WANT_TIMES;
    for (scene.which = QUERY_PAIRS_LISTED; scene.which <= QUERY_PAIRS_ACROSS; scene.which++) {
        const unsigned(*pair)[2];
        scene.index_count = 0;
        scene.split = scene.which == QUERY_PAIRS_ACROSS ? 10 : 0;
        if (scene.which == QUERY_PAIRS_LISTED)
            scene_draw_pairs(&draw, 100, &scene);
        const int32_t total = scene_list(&scene, &pair);
        int parts = 0, calls;
        answerer.between = enough;
        answerer.user = &calls;
        for (scene.first_pair = 0; scene.first_pair < total; scene.first_pair = result.end_pair) {
            calls = draw_int(&draw, 1, 2);
            ask_and_check(&scene);
            parts++;
        }
        assert_true(parts > 3);
        scene.first_pair = 0;
    }
}

/* However dear a pair is, others do not wait for many. */
static void test_others_are_let_in_often(void **state)
{
    (void) state;
    static const struct {
        const char *method;
        int32_t want;
        int pairs;
    } each[] = {{"certified", 0, 128}, {"certified", QUERY_WANT_BOX, 64}, {"exact", 0, 8}};
    answerer.between = enough;
    set_heap(60, 2, false, false);
    for (size_t i = 0; i < COUNT(each); i++) {
        int calls = 1;
        answerer.user = &calls;
        scene.method = fmb_method_by_name(each[i].method)->number;
        scene.want = each[i].want;
        ask_and_check(&scene);
        assert_true(result.end_pair <= each[i].pairs);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_answers_are_those_of_each_pair),
        TEST(test_answers_of_the_exact_method),
        TEST(test_answers_of_inexact_methods),
        TEST(test_no_contact_is_lost_anywhere),
        TEST(test_every_pair_can_be_the_first),
        TEST(test_parts_fill_their_datagrams),
        TEST(test_verdicts_of_listed_pairs_fit),
        TEST(test_empty_scenes),
        TEST(test_echo),
        TEST(test_bad_frames),
        TEST(test_bad_counts),
        TEST(test_bad_pairs),
        TEST(test_bad_questions),
        TEST(test_refused_without_a_look),
        TEST(test_keys_mixed_with_whole_frames),
        TEST(test_dead_keys),
        TEST(test_one_id_with_two_bodies),
        TEST(test_more_bodies_than_the_cache_holds),
        TEST(test_answers_allocate_nothing),
        TEST(test_pairs_answered_between_do_not_show),
        TEST(test_scenes_end_early_where_others_wait),
        TEST(test_others_are_let_in_often),
    };
    return cmocka_run_group_tests_name("answer_scene", tests, NULL, NULL);
}
