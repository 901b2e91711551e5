/* What a scene query gets: the answers of fmb_decide() to each of its pairs, to the bit; as many as
 * one datagram has space for, and the remainder on request; in steps, which may be interrupted; or
 * what is wrong, and where. */
#include "unit.h"

#include "answer_now.h"
#include "geometry_write.h"
#include "scene_truth.h"
#include "wire.h"

#include <float.h>
#include <math.h>

enum { BODIES = 40 };

static struct answerer *answerer;
static struct answer_job *job, *second_job;
static struct scene scene;
static struct scene_query *const query = &scene.query;
static struct scene_query other;
static struct scene_result result, again;
static unsigned char bytes[2 * QUERY_BYTES_MAX];

static int set_up(void **state)
{
    const struct answerer_options options = {BODIES, .server_id = 99,
                                             .secret = {0x243f6a8885a308d3, 0x13198a2e03707344}};
    answerer = answerer_create(&options);
    job = answer_job_create();
    second_job = answer_job_create();
    memset(&scene, 0, sizeof scene);
    query->duration = 1;
    query->which = FMB_PAIRS_ALL;
    return answerer && job && second_job ? 0 : -1;
}

static int tear_down(void **state)
{
    answer_job_destroy(job);
    answer_job_destroy(second_job);
    answerer_destroy(answerer);
    return 0;
}

static void answer_to(const struct scene_query *whole)
{
    scene_answer(job, answerer, whole, &result);
}

/* The result as it is in a datagram: of a size that was promised, and read back the same. */
static size_t assert_fits(void)
{
    const size_t size = wire_write_scene_result(&result, bytes);
    const size_t contacts = (size_t) result.contact_count;
    const size_t promised =
        WIRE_SCENE_RESULT_BYTES + 2 * (size_t) result.unknown_count +
        HANDLE_BYTES * (size_t) result.handle_count +
        (size_t) result.verdict_count * (1 + (result.names_pairs ? WIRE_PAIR_BYTES : 0)) +
        (result.has_times ? 16 * contacts : 0) +
        (result.has_boxes ? 16 * (size_t) result.dim * contacts : 0) +
        (result.has_points ? 8 * (1 + (size_t) result.dim) * contacts : 0) +
        (result.has_gaps ? (size_t) wire_gap_bytes(result.dim, result.names_frames) *
                               (size_t) result.verdict_count
                         : 0);
    assert_true(size <= promised && promised <= QUERY_BYTES_MAX);
    const char *error = wire_read_scene_result(bytes, (uint32_t) size, &again);
    if (error)
        fail_msg("the result cannot be read: %s", error);
    assert_int_equal(again.end_pair, result.end_pair);
    assert_int_equal(again.contact_count, result.contact_count);
    return size;
}

static void answer_and_check(const struct scene_query *whole)
{
    answer_to(whole);
    scene_assert(whole, &result);
    assert_fits();
}

static const struct solid unit_cube = {
    .dim = 3, .shape = FMB_CUBOID, .component = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

static void set_cube(int32_t i, int64_t body_id, double x)
{
    struct solid cube = unit_cube;
    cube.origin[0] = x;
    scene_set(&scene, i, &cube, body_id);
}

/* Cubes in a row, bodies 1, 2, ..., neighbours sharing a face. */
static void set_row(int32_t count)
{
    query->placement_count = count;
    for (int32_t i = 0; i < count; i++)
        set_cube(i, i + 1, i);
}

/* The first component of placement i: another body. */
static void stretch(int32_t i, double length)
{
    scene_put_number(&scene, i, 3, length);
}

static struct cache_counts counts(void)
{
    return cache_counts(answerer_cache(answerer));
}

/* ---- Right answers ---- */

enum { WANTS_WITHOUT_GAPS = 6 };
static const int32_t wants[] = {
    0,
    FMB_WANT_BOX,
    FMB_WANT_TIMES,
    FMB_WANT_BOX | FMB_WANT_TIMES,
    FMB_WANT_POINT,
    FMB_WANT_BOX | FMB_WANT_POINT,
    FMB_WANT_GAP,
    FMB_WANT_BOX | FMB_WANT_TIMES | FMB_WANT_POINT | FMB_WANT_GAP,
};

static double draw_margin(struct draw *draw)
{
    static const double margins[] = {0, 0, 0x1p-1074, 1e-9, 0.5, 3, DBL_MAX};
    return margins[draw_int(draw, 0, (int) COUNT(margins) - 1)];
}

static void answer_in_every_way(struct draw *draw, const char *method)
{
    query->method = fmb_method_by_name(method)->number;
    for (int32_t which = FMB_PAIRS_ALL; which <= FMB_PAIRS_ACROSS; which++)
        for (size_t w = 0; w < COUNT(wants); w++) {
            query->which = which;
            query->want = wants[w];
            query->margin = draw_margin(draw);
            query->index_count = query->split = 0;
            if (which == FMB_PAIRS_LISTED)
                scene_draw_pairs(draw, 60, query);
            if (which == FMB_PAIRS_ACROSS)
                query->split = draw_int(draw, 0, query->placement_count);
            answer_and_check(query);
        }
}

static double draw_duration(struct draw *draw)
{
    static const double others[] = {0, -0.0, 0x1p-1074, 0.1, 3, 1e300, DBL_MAX};
    return draw_coin(draw) ? 1 : others[draw_int(draw, 0, (int) COUNT(others) - 1)];
}

static void answers_are_those_of_each_pair(void **state)
{
    struct draw draw;
    draw_begin(&draw, "scenes, certified");
    for (long round = 0; round < draw_sample(96); round++) {
        scene_draw_placements(&draw, 2 + round % 2, round % 3 - 1, 12, &scene);
        query->duration = draw_duration(&draw);
        for (int i = 0; i < 12; i++)
            query->placement[i].placed.id = draw_int(&draw, 0, 30);
        answer_in_every_way(&draw, "certified");
    }
}

static void answers_of_the_exact_method(void **state)
{
    struct draw draw;
    draw_begin(&draw, "scenes, exact");
    for (long round = 0; round < draw_sample(16); round++) {
        scene_draw_placements(&draw, 2 + round % 2, -1, 8, &scene);
        answer_in_every_way(&draw, "exact");
    }
}

/* Of flat frames they say nothing. */
static void answers_of_inexact_methods(void **state)
{
    struct draw draw;
    int undecided = 0;
    draw_begin(&draw, "scenes, inexact");
    for (long round = 0; round < draw_sample(160); round++) {
        query->method = fmb_method_by_name(round % 2 ? "fmb" : "sat")->number;
        query->which = FMB_PAIRS_LISTED;
        query->want = wants[round / 2 % WANTS_WITHOUT_GAPS];
        scene_draw_placements(&draw, 2 + (int) (round / 8 % 2), -1, 12, &scene);
        scene_draw_pairs(&draw, 60, query);
        answer_and_check(query);
        for (int32_t i = 0; i < result.verdict_count; i++)
            undecided += result.verdict[i] == 0;
        query->which = FMB_PAIRS_ALL;
        query->index_count = 0;
        answer_to(query);
        assert_int_equal(result.status, FMB_CANNOT_DECIDE);
        assert_string_equal(result.detail, "method: listed pairs alone");
    }
    assert_true(undecided > 0);
}

/* ---- Parts ---- */

static void every_pair_can_be_the_first(void **state)
{
    struct draw draw;
    draw_begin(&draw, "first pairs");
    for (int32_t which = FMB_PAIRS_ALL; which <= FMB_PAIRS_ACROSS; which++) {
        const int32_t last_split = which == FMB_PAIRS_ACROSS ? 9 : 0;
        scene_draw_placements(&draw, 3, -1, 9, &scene);
        query->which = which;
        query->want = FMB_WANT_BOX | FMB_WANT_TIMES;
        query->index_count = 0;
        if (which == FMB_PAIRS_LISTED)
            scene_draw_pairs(&draw, 40, query);
        for (query->split = 0; query->split <= last_split; query->split++) {
            const unsigned(*pair)[2];
            const int32_t total = scene_list(query, &pair);
            for (query->first_pair = 0; query->first_pair <= total; query->first_pair++) {
                answer_and_check(query);
                assert_int_equal(result.end_pair, total);
            }
            answer_to(query); /* one beyond */
            assert_int_equal(result.status, FMB_BAD_PAIR);
            assert_string_equal(result.detail, "first_pair: there are not so many");
            query->first_pair = 0;
        }
        query->split = 0;
    }
}

/* Requests part after part; each but the last fills its datagram. Returns how many there were. */
static int answer_all_parts(size_t largest_pair)
{
    const unsigned(*pair)[2];
    const int32_t total = scene_list(query, &pair);
    int parts = 0;
    for (query->first_pair = 0; query->first_pair < total; query->first_pair = result.end_pair) {
        answer_to(query);
        scene_assert(query, &result);
        const size_t size = assert_fits();
        if (result.end_pair < total)
            assert_true(size + largest_pair + QUERY_TEXT_MAX + 8 > QUERY_BYTES_MAX);
        parts++;
    }
    query->first_pair = 0;
    return parts;
}

/* All in one place, so that all meet. */
static void set_heap(int32_t count, int dim, bool moving, bool kept)
{
    query->placement_count = count;
    for (int32_t i = 0; i < count; i++) {
        struct solid solid = {.dim = dim, .shape = FMB_CUBOID, .moving = moving};
        for (int axis = 0; axis < dim; axis++) {
            solid.component[axis][axis] = 1 + i % 3;
            solid.origin[axis] = 0.5 * (i % 2);
            solid.velocity[axis] = 0.25 * (i % 5);
        }
        scene_set(&scene, i, &solid, kept ? i + 1 : 0);
    }
}

/* How many results so many contacts of so many bytes take. */
static int parts_of(int pairs, int pair_bytes, int handles)
{
    const int capacity = QUERY_BYTES_MAX - WIRE_SCENE_RESULT_BYTES - HANDLE_BYTES * handles;
    const int each = capacity / pair_bytes;
    return (pairs + each - 1) / each;
}

static void parts_fill_their_datagrams(void **state)
{
    set_heap(100, 3, true, true);
    query->want = FMB_WANT_BOX | FMB_WANT_TIMES | FMB_WANT_POINT;
    assert_int_equal(answer_all_parts(5 + 16 + 48 + 32), parts_of(4950, 5 + 16 + 48 + 32, 100));
    set_heap(160, 2, false, false);
    query->want = 0;
    assert_int_equal(answer_all_parts(5), 1);
    query->want = FMB_WANT_BOX;
    assert_int_equal(answer_all_parts(5 + 32), parts_of(12720, 5 + 32, 0));
    query->which = FMB_PAIRS_LISTED;
    query->index_count = 0;
    for (unsigned i = 0; i < 10600; i++) {
        query->pair[i][0] = i % 160;
        query->pair[i][1] = (i + 1 + i / 160) % 160;
        query->index_count += 2;
    }
    assert_int_equal(answer_all_parts(1 + 32), parts_of(10600, 1 + 32, 0));
    query->want = FMB_WANT_POINT;
    assert_int_equal(answer_all_parts(1 + 24), parts_of(10600, 1 + 24, 0));
    query->want = FMB_WANT_GAP;
    query->index_count = 4000;
    assert_int_equal(answer_all_parts(1 + 72), parts_of(2000, 1 + 72, 0));
}

/* As many contacts as fit, then one separated pair for each byte that is left, and one more. */
static void a_datagram_is_filled_to_its_last_byte(void **state)
{
    enum { HANDLES = 4, CONTACT_BYTES = 1 + 16 };
    const int32_t capacity = QUERY_BYTES_MAX - WIRE_SCENE_RESULT_BYTES - HANDLE_BYTES * HANDLES;
    const int32_t contacts = capacity / CONTACT_BYTES;
    const int32_t fit = contacts + capacity % CONTACT_BYTES;
    set_row(HANDLES);
    query->want = FMB_WANT_TIMES;
    query->which = FMB_PAIRS_LISTED;
    query->index_count = 2 * (fit + 1);
    for (int32_t i = 0; i <= fit; i++) {
        query->pair[i][0] = 0;
        query->pair[i][1] = i < contacts ? 1 : 3;
    }
    answer_to(query);
    scene_assert(query, &result);
    assert_fits();
    assert_int_equal(result.contact_count, contacts);
    assert_int_equal(result.end_pair, fit);
}

/* As many pairs as a query has space for, of two placements or of many: all verdicts fit, beside
 * the handles. */
static void verdicts_of_listed_pairs_fit(void **state)
{
    query->which = FMB_PAIRS_LISTED;
    for (int32_t count = 2; count <= 350; count += 348) {
        set_heap(count, 2, false, true);
        size_t size = WIRE_SCENE_QUERY_BYTES;
        for (int32_t i = 0; i < count; i++)
            size += wire_placement_bytes(&query->placement[i]);
        const int32_t pairs = (int32_t) ((QUERY_BYTES_MAX - size) / WIRE_PAIR_BYTES);
        assert_true(pairs > (count == 2 ? 15790 : 4550));
        for (int32_t i = 0; i < pairs; i++) {
            query->pair[i][0] = (unsigned) (i % count);
            query->pair[i][1] = (unsigned) ((i + 1) % count);
        }
        query->index_count = 2 * pairs;
        answer_and_check(query);
        assert_int_equal(result.end_pair, pairs);
        assert_int_equal(result.handle_count, count);
    }
}

/* ---- Small queries ---- */

static void empty_scenes_are_answered(void **state)
{
    for (int32_t which = FMB_PAIRS_ALL; which <= FMB_PAIRS_ACROSS; which++)
        for (int32_t count = 0; count <= 1; count++)
            for (int32_t split = 0; split <= (which == FMB_PAIRS_ACROSS ? count : 0); split++) {
                set_row(count);
                query->which = which;
                query->split = split;
                query->want = FMB_WANT_BOX | FMB_WANT_TIMES;
                answer_and_check(query);
                assert_int_equal(result.end_pair, 0);
                assert_int_equal(result.handle_count, count);
            }
}

/* ---- Refusals ---- */

/* Of a scene that is wrong in one place: nothing is decided or kept. */
static void expect(enum fmb_status status, const char *detail)
{
    const int64_t kept = counts().misses;
    answer_to(query);
    assert_string_equal(result.detail, detail);
    assert_int_equal(result.status, status);
    assert_int_equal(result.method, 0);
    assert_int_equal(result.handle_count + result.verdict_count + result.contact_count, 0);
    assert_int_equal(result.unknown_count + result.end_pair, 0);
    assert_fits();
    assert_int_equal(counts().misses, kept);
}

static void bad_placements_are_refused(void **state)
{
    set_row(340);
    query->placement[339].placed.position[2] = -INFINITY;
    expect(FMB_NOT_FINITE, "placements[339].position[2]: not a finite number");
    set_row(7);
    scene_name(&query->placement[2], &(struct handle){{1}});
    query->placement[2].body.dim = 2;
    scene_name(&query->placement[2], &(struct handle){{1}});
    expect(FMB_DIMENSIONS_DIFFER, "placements[2].dim: a 2D body against a 3D one");
}

/* Placements of dimension 0 are so short that a message has more of them than are valid. */
static void too_many_placements_are_refused(void **state)
{
    enum {
        HEAD = 8 + 3 * 8 + 5 + 8 + 2 * 4 + 8 + 3 * 4,
        COUNT_AT = HEAD,
        PLACEMENT = 65,
        NAME = 40
    };
    query->placement_count = 0;
    wire_write_scene_query(query, bytes);
    const size_t size = HEAD + 4 + (QUERY_PLACEMENTS_MAX + 1) * PLACEMENT + 8;
    memset(bytes + COUNT_AT, 0, size - COUNT_AT);
    bytes[COUNT_AT + 2] = (QUERY_PLACEMENTS_MAX + 1) >> 8;
    bytes[COUNT_AT + 3] = (QUERY_PLACEMENTS_MAX + 1) & 0xff;
    for (size_t i = 0; i <= QUERY_PLACEMENTS_MAX; i++) /* an empty name has a length of 1 */
        bytes[COUNT_AT + 4 + i * PLACEMENT + NAME + 3] = 1;
    assert_null(answer_job_begin(job, ANSWER_SCENE, bytes, size));
    assert_true(answer_job_step(job, answerer));
    assert_int_equal(answer_job_scene_result(job)->status, FMB_OVER_LIMIT);
    assert_string_equal(answer_job_scene_result(job)->detail, "num_placements: more than 788");
}

static void wrong_counts_are_refused(void **state)
{
    set_row(2);
    query->which = FMB_PAIRS_LISTED;
    query->index_count = 3;
    expect(FMB_WRONG_COUNT, "num_indices: not two for each pair");
    query->index_count = 2;
    for (query->which = FMB_PAIRS_ALL; query->which <= FMB_PAIRS_ACROSS; query->which += 2)
        expect(FMB_WRONG_COUNT, "num_indices: indices without PAIRS_LISTED");
    query->index_count = 0;
    query->which = FMB_PAIRS_ALL;
    query->ignored_count = 1;
    expect(FMB_WRONG_COUNT, "num_ignored: not two for each pair");
}

static void bad_pairs_are_refused(void **state)
{
    static const struct {
        unsigned a, b;
        int place;
    } bad[] = {{7, 0, 6}, {0, 7, 7}, {UINT32_MAX, 8, 6}, {6, (unsigned) INT16_MIN, 7}};
    set_row(7);
    query->which = FMB_PAIRS_LISTED;
    query->index_count = 80;
    for (int i = 0; i < 40; i++)
        query->pair[i][1] = 1;
    for (int at = 3; at < 40; at += 34) /* alone, and among many */
        for (size_t i = 0; i < COUNT(bad); i++) {
            char detail[60];
            query->pair[at][0] = bad[i].a;
            query->pair[at][1] = bad[i].b;
            snprintf(detail, sizeof detail, "indices[%d]: no placement has this index",
                     bad[i].place + 2 * (at - 3));
            expect(FMB_BAD_PAIR, detail);
            query->pair[at][0] = query->pair[at][1] = 2;
            snprintf(detail, sizeof detail, "indices[%d]: a placement against itself", 2 * at + 1);
            expect(FMB_BAD_PAIR, detail);
            query->pair[at][0] = 6;
        }
    answer_and_check(query);
}

static void set_ignored(int32_t i, unsigned a, unsigned b)
{
    query->ignored[i][0] = a;
    query->ignored[i][1] = b;
}

static void bad_ignored_pairs_are_refused(void **state)
{
    set_row(7);
    query->ignored_count = 4;
    set_ignored(0, 1, 2);
    set_ignored(1, 3, 7);
    expect(FMB_BAD_PAIR, "ignored[3]: no placement has this index");
    set_ignored(1, UINT32_MAX, 3);
    expect(FMB_BAD_PAIR, "ignored[2]: no placement has this index");
    set_ignored(1, 5, 5);
    expect(FMB_BAD_PAIR, "ignored[3]: a placement against itself");
    query->which = FMB_PAIRS_LISTED;
    query->index_count = 6;
    for (unsigned i = 0; i < 3; i++) {
        query->pair[i][0] = i + 3;
        query->pair[i][1] = i;
    }
    set_ignored(1, 1, 4);
    expect(FMB_BAD_PAIR, "indices[2]: a pair to ignore");
    set_ignored(1, 4, 1);
    expect(FMB_BAD_PAIR, "indices[2]: a pair to ignore");
    set_ignored(1, 4, 2);
    answer_and_check(query);
    assert_int_equal(result.verdict_count, 3);
}

/* Ignored pairs count in the numbering, and get no answer, wherever the answers begin. */
static void ignored_pairs_are_left_out(void **state)
{
    struct draw draw;
    draw_begin(&draw, "ignored pairs");
    for (long round = 0; round < draw_sample(24); round++) {
        const unsigned(*pair)[2];
        scene_draw_placements(&draw, 2 + round % 2, -1, 10, &scene);
        query->which = round % 4 / 2 ? FMB_PAIRS_ACROSS : FMB_PAIRS_ALL;
        query->split = query->which == FMB_PAIRS_ACROSS ? 5 : 0;
        query->want = wants[round % (int) COUNT(wants)];
        query->margin = draw_margin(&draw);
        query->ignored_count = 2 * draw_int(&draw, 1, 30);
        for (int32_t i = 0; i < query->ignored_count / 2; i++) {
            const unsigned a = (unsigned) draw_int(&draw, 0, 9);
            set_ignored(i, a, (a + (unsigned) draw_int(&draw, 1, 9)) % 10);
        }
        for (int32_t i = 0; i < query->placement_count; i++)
            query->placement[i].placed.group = draw_int(&draw, -1, 2);
        query->label = round % 2 ? "any bytes\n\xff" : NULL;
        const int32_t total = scene_list(query, &pair);
        for (query->first_pair = 0; query->first_pair <= total; query->first_pair++)
            answer_and_check(query);
        query->first_pair = 0;
    }
}

/* A listed pair within a group is refused; the pairs of others are decided. */
static void listed_pairs_within_a_group_are_refused(void **state)
{
    set_row(5);
    query->which = FMB_PAIRS_LISTED;
    query->index_count = 6;
    for (unsigned i = 0; i < 3; i++) {
        query->pair[i][0] = i + 1;
        query->pair[i][1] = i;
    }
    query->placement[0].placed.group = query->placement[4].placed.group = INT64_MIN;
    answer_and_check(query);
    query->placement[3].placed.group = query->placement[2].placed.group = INT64_MIN;
    expect(FMB_BAD_PAIR, "indices[4]: a pair of one group");
    query->placement[3].placed.group = 0;
    answer_and_check(query);
}

/* A body of many frames, in 2D: boxes in a row. Returns its handle. */
static struct handle keep_large_body(int32_t frames)
{
    static unsigned char geometry[QUERY_BYTES_MAX];
    static struct plain_frame frame[QUERY_FRAMES_MAX];
    for (int32_t i = 0; i < frames; i++)
        frame[i] =
            (struct plain_frame){.shape = FMB_BOX, .origin = {2 * i, 0}, .components = {1, 1}};
    query->placement_count = 1;
    query->placement[0] = (struct query_placement){
        .placed.id = 5, .body.dim = 2, .body.frame_count = frames, .body.number_count = 4 * frames};
    query->placement[0].body = geometry_write_frames(2, frame, frames, geometry);
    answer_to(query);
    assert_int_equal(result.status, FMB_OK);
    return result.handle[0];
}

/* 64 placements of 1024 frames are as many as a query may have. */
static void too_many_frames_are_refused(void **state)
{
    const struct answerer_options options = {2048, .server_id = 99, .secret = {1, 2}};
    answerer_destroy(answerer);
    answerer = answerer_create(&options);
    assert_non_null(answerer);
    const struct handle handle = keep_large_body(1024);
    query->placement_count = 64;
    for (int32_t i = 0; i < 65; i++) {
        query->placement[i] = query->placement[0];
        scene_name(&query->placement[i], &handle);
        query->placement[i].placed.position[1] = 1.5 * i;
    }
    query->placement[7].placed.position[1] = query->placement[6].placed.position[1] + 0.5;
    answer_to(query);
    assert_string_equal(result.detail, "");
    assert_int_equal(result.contact_count, 1);
    assert_int_equal(result.end_pair, 64 * 63 / 2);
    query->placement_count = 65;
    expect(FMB_OVER_LIMIT, "placements[64].num_frames: more than 65536 frames in the query");
}

static void bad_requests_are_refused(void **state)
{
    const double margins[] = {-1, NAN, INFINITY, -0x1p-1074};
    set_row(2);
    query->duration = -1;
    expect(FMB_BAD_DURATION, "duration: negative or not finite");
    query->duration = 1;
    for (size_t i = 0; i < COUNT(margins); i++) {
        query->margin = margins[i];
        expect(FMB_BAD_MARGIN, "margin: negative or not finite");
        query->margin = 0;
    }
    query->which = FMB_PAIRS_LISTED;
    for (query->method = 2; query->method <= 3; query->method++) {
        query->want = FMB_WANT_GAP;
        expect(FMB_CANNOT_DECIDE, "method: gives no gaps");
        query->want = 0;
        query->margin = 0x1p-1074;
        expect(FMB_CANNOT_DECIDE, "method: gives no gaps");
        query->margin = 0;
    }
    query->which = FMB_PAIRS_ALL;
    for (query->want = 2; query->want <= 2 * FMB_WANT_POINT; query->want *= 16)
        expect(FMB_UNKNOWN_WANT, "want: wants what this version does not give");
    query->want = 0;
    for (query->which = -1; query->which <= 3; query->which += 4)
        expect(FMB_UNKNOWN_WANT, "which: wants what this version does not give");
    query->which = FMB_PAIRS_ALL;
    query->split = 1;
    expect(FMB_BAD_PAIR, "split: not 0");
    query->which = FMB_PAIRS_ACROSS;
    query->split = 3;
    expect(FMB_BAD_PAIR, "split: not from 0 to num_placements");
    query->split = INT32_MIN;
    expect(FMB_BAD_PAIR, "split: not from 0 to num_placements");
    query->split = 1;
    query->first_pair = 2;
    expect(FMB_BAD_PAIR, "first_pair: there are not so many");
    query->first_pair = INT32_MIN;
    expect(FMB_BAD_PAIR, "first_pair: there are not so many");
    query->first_pair = 0;
    query->client_id = -1;
    expect(FMB_BAD_ID, "client_id: not from 0 to 2^53 - 1");
}

static void malformed_bytes_are_refused(void **state)
{
    set_row(2);
    const size_t size = wire_write_scene_query(query, bytes);
    assert_non_null(answer_job_begin(job, ANSWER_SCENE, bytes, size - 1));
    assert_non_null(answer_job_begin(job, ANSWER_SCENE, bytes, QUERY_BYTES_MAX + 1));
    assert_non_null(answer_job_begin(job, ANSWER_SCENE, NULL, 0));
    assert_null(answer_job_begin(job, ANSWER_SCENE, bytes, size));
}

/* ---- Handles ---- */

static void handles_and_whole_placements_may_be_mixed(void **state)
{
    struct draw draw;
    draw_begin(&draw, "handles");
    query->want = FMB_WANT_BOX | FMB_WANT_TIMES;
    for (long round = 0; round < draw_sample(64); round++) {
        int handles = 0;
        scene_draw_placements(&draw, 2 + round % 2, -1, 12, &scene);
        for (int i = 0; i < 12; i++)
            query->placement[i].placed.id = i % 4 ? 100 + i : 0;
        query->method = round % 4 == 3 ? fmb_method_by_name("exact")->number : 0;
        answer_and_check(query);
        assert_int_equal(result.handle_count, 9);
        other = *query;
        for (int i = 0, h = 0; i < 12; i++) {
            struct query_placement *placement = &other.placement[i];
            if (i % 4 && (round % 8 == 7 || draw_coin(&draw)))
                scene_name(placement, &result.handle[h]);
            h += i % 4 != 0;
            if (draw_coin(&draw))
                placement->placed.id = 0;
            handles += placement->placed.id && !query_by_handle(placement);
        }
        answer_to(&other);
        scene_assert(query, &result);
        assert_int_equal(result.handle_count, handles);
    }
}

/* Exactly those that are not held are listed, and the cache stays as it was. */
static void unknown_handles_are_listed(void **state)
{
    set_row(6);
    for (int i = 0; i < 6; i++)
        stretch(i, 1 + i);
    answer_to(query);
    assert_int_equal(result.handle_count, 6);
    for (int i = 0; i < 6; i++) {
        if (i == 2)
            continue;
        struct handle handle = result.handle[i];
        handle.bytes[HANDLE_BYTES - 1] ^= i == 1 || i == 4; /* in the same bucket */
        scene_name(&query->placement[i], &handle);
    }
    stretch(2, 77);
    const struct cache_counts before = counts();
    answer_to(query);
    assert_int_equal(result.status, FMB_UNKNOWN_BODY);
    assert_string_equal(result.detail, "placements[1].handle: not held; send the frames");
    assert_int_equal(result.unknown_count, 2);
    assert_int_equal(result.unknown[0], 1);
    assert_int_equal(result.unknown[1], 4);
    assert_int_equal(result.handle_count + result.verdict_count + result.end_pair, 0);
    assert_int_equal(result.method, 0);
    assert_fits();
    assert_int_equal(counts().bodies, before.bodies);
    assert_int_equal(counts().misses, before.misses);
}

/* A body of the other dimension has this handle: that is wrong, whatever is not held besides. */
static void a_handle_of_the_other_dimension_is_refused(void **state)
{
    const struct solid square = {.dim = 2, .shape = FMB_CUBOID, .component = {{1, 0}, {0, 1}}};
    query->placement_count = 1;
    scene_set(&scene, 0, &square, 5);
    answer_to(query);
    const struct handle handle = result.handle[0];
    set_row(3);
    scene_name(&query->placement[0], &(struct handle){{1}});
    scene_name(&query->placement[2], &handle);
    expect(FMB_WRONG_DIMENSION, "placements[2].dim: not that of the body with this handle");
}

/* Bodies in use are not evicted: those that come later are used once. */
static void more_bodies_than_the_cache_holds_are_answered(void **state)
{
    static struct handle handle[3 * BODIES];
    query->want = FMB_WANT_BOX;
    for (int method = 0; method < 2; method++) {
        query->method = method ? fmb_method_by_name("exact")->number : 0;
        set_row(3 * BODIES);
        for (int32_t i = 0; i < query->placement_count; i++)
            stretch(i, 1 + i * 0.25);
        answer_and_check(query);
        memcpy(handle, result.handle, sizeof handle);
        other = *query;
        for (int32_t i = 0; i < query->placement_count; i++)
            scene_name(&other.placement[i], &handle[i]);
        answer_to(&other);
        assert_int_equal(result.status, FMB_UNKNOWN_BODY);
        assert_int_equal(result.unknown_count, 2 * BODIES);
        for (int32_t i = 0; i < 2 * BODIES; i++) {
            const unsigned unknown = result.unknown[i];
            assert_int_equal(unknown, BODIES + i);
            other.placement[unknown] = query->placement[unknown];
        }
        answer_to(&other);
        scene_assert(query, &result);
    }
}

/* ---- Memory ---- */

/* The linker puts these in the place of malloc() and the like, where our own code calls them
 * (GMP, which exact arithmetic uses, has its own). */
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

/* All memory is allocated at the start, whatever the query: by handle or whole, evicting or not,
 * refused or not. */
static void answers_allocate_nothing(void **state)
{
    struct draw draw;
    draw_begin(&draw, "memory");
    assert_true(allocations > 0); /* by set_up() */
    allocations = 0;
    for (int round = 0; round < 40; round++) {
        scene_draw_placements(&draw, 2 + round % 2, -1, 60, &scene);
        for (int i = 0; i < 60; i++)
            query->placement[i].placed.id = draw_int(&draw, 0, 100);
        query->want = wants[round % 4];
        query->which = round % 3;
        query->split = query->which == FMB_PAIRS_ACROSS ? 20 : 0;
        query->index_count = 0;
        if (query->which == FMB_PAIRS_LISTED)
            scene_draw_pairs(&draw, 500, query);
        answer_to(query);
        assert_int_equal(result.status, FMB_OK);
        scene_name(&query->placement[7], &(struct handle){{3}});
        answer_to(query);
        assert_int_equal(result.status, FMB_UNKNOWN_BODY);
    }
    set_heap(300, 3, true, true);
    query->which = FMB_PAIRS_ALL;
    query->split = query->index_count = 0;
    answer_to(query);
    assert_int_equal(result.status, FMB_OK);
    assert_int_equal(allocations, 0);
}

/* ---- Steps ---- */

/* Another scene whose bodies, as many as the cache holds, evict all others. */
static void evict_all(void)
{
    static struct scene evicting;
    static struct scene_result evicted;
    static int64_t stamp;
    evicting.query = (struct scene_query){.duration = 1, .which = FMB_PAIRS_ALL};
    evicting.query.placement_count = BODIES;
    for (int32_t i = 0; i < BODIES; i++) {
        struct solid cube = unit_cube;
        cube.component[0][0] = 1000 + (double) stamp++;
        scene_set(&evicting, i, &cube, 1 + i);
    }
    scene_answer(second_job, answerer, &evicting.query, &evicted);
    assert_int_equal(evicted.handle_count, BODIES);
}

/* What is answered between the steps, and evicts every body of the scene, does not show in the
 * result. */
static void queries_between_steps_do_not_show(void **state)
{
    struct draw draw;
    draw_begin(&draw, "steps");
    query->want = FMB_WANT_BOX | FMB_WANT_TIMES;
    for (int method = 0; method < 2; method++)
        for (long round = 0; round < draw_sample(8); round++) {
            int steps = 0;
            query->method = method ? fmb_method_by_name("exact")->number : 0;
            scene_draw_placements(&draw, 2 + round % 2, -1, 36, &scene);
            for (int i = 0; i < 36; i++)
                query->placement[i].placed.id = 1 + i;
            answer_and_check(query);
            again = result;
            scene_begin(job, query);
            for (; !answer_job_step(job, answerer); steps++)
                if (steps % 4 == 0)
                    evict_all();
            const struct scene_result *stepwise = answer_job_scene_result(job);
            scene_assert(query, stepwise);
            assert_int_equal(stepwise->end_pair, again.end_pair);
            assert_memory_equal(stepwise->handle, again.handle, 36 * sizeof(struct handle));
            assert_true(steps > 5);
        }
}

/* After any number of steps; its bodies can be evicted at once. */
static void a_scene_without_answers_stops_as_busy(void **state)
{
    int steps = 1;
    for (;; steps++) {
        set_row(BODIES);
        scene_begin(job, query);
        bool complete = false;
        for (int i = 0; i < steps; i++) {
            assert_false(complete);
            complete = answer_job_step(job, answerer);
        }
        if (complete || answer_job_has_answers(job))
            break;
        answer_job_stop(job);
        result = *answer_job_scene_result(job);
        assert_int_equal(result.status, FMB_BUSY);
        assert_int_equal(result.header.sequence_number, query->sequence_number);
        assert_int_equal(result.end_pair + result.verdict_count + result.handle_count, 0);
        const struct cache_counts before = counts();
        evict_all();
        assert_int_equal(counts().evictions - before.evictions, before.bodies);
    }
    assert_in_range(steps, 6, 10);
}

/* A job that is begun anew while it is under way has forgotten the first query. */
static void a_job_can_be_begun_anew(void **state)
{
    set_heap(60, 3, true, true);
    for (int steps = 0; steps < 12; steps++) {
        set_heap(60, 3, true, true);
        scene_begin(job, query);
        for (int i = 0; i < steps; i++)
            answer_job_step(job, answerer);
        set_row(3);
        answer_and_check(query);
    }
}

/* A scene that is stopped early has the answers so far, and the next query has the remainder. */
static void a_stopped_scene_continues_where_it_ended(void **state)
{
    static const char *const methods[] = {"exact", "certified"};
    struct draw draw;
    draw_begin(&draw, "scenes that are stopped");
    set_heap(40, 3, true, false);
    for (int i = 0; i < 4; i++)
        query->placement[36 + i].placed.position[0] = 1e9; /* far from all */
    query->want = FMB_WANT_BOX | FMB_WANT_TIMES;
    for (size_t m = 0; m < COUNT(methods); m++)
        for (query->which = FMB_PAIRS_ALL; query->which <= FMB_PAIRS_ACROSS; query->which++) {
            const unsigned(*pair)[2];
            query->method = fmb_method_by_name(methods[m])->number;
            query->index_count = 0;
            query->split = query->which == FMB_PAIRS_ACROSS ? 10 : 0;
            if (query->which == FMB_PAIRS_LISTED)
                scene_draw_pairs(&draw, 100, query);
            const int32_t total = scene_list(query, &pair);
            int parts = 0;
            for (query->first_pair = 0; query->first_pair < total;
                 query->first_pair = result.end_pair) {
                int more = draw_int(&draw, 0, 1);
                scene_begin(job, query);
                while (!answer_job_step(job, answerer))
                    if (answer_job_has_answers(job) && more-- == 0) {
                        answer_job_stop(job);
                        break;
                    }
                result = *answer_job_scene_result(job);
                scene_assert(query, &result);
                assert_fits();
                parts++;
            }
            assert_true(parts > 1);
            query->first_pair = 0;
        }
}

/* Frames that meet, at numbers of which some are very large and others very small: their pairs need
 * exact arithmetic. */
static void set_slivers(int32_t count)
{
    query->placement_count = count;
    query->want = FMB_WANT_BOX | FMB_WANT_TIMES;
    for (int32_t i = 0; i < count; i++) {
        struct solid solid = {
            .dim = 3,
            .shape = FMB_TETRAHEDRON,
            .moving = true,
            .component = {{1e200, 1, 1e-200}, {3e-180, 1e190, 7}, {1, 3e-170, 5}}};
        solid.velocity[i % 3] = 1e-100 * (i + 1);
        scene_set(&scene, i, &solid, 1 + i);
    }
}

/* In the middle of a block too, which the next query has nothing to do with. */
static void no_step_decides_two_exact_pairs(void **state)
{
    int steps = 0;
    set_slivers(8);
    scene_begin(job, query);
    while (!answer_job_step(job, answerer))
        steps += answer_job_has_answers(job);
    scene_assert(query, answer_job_scene_result(job));
    assert_true(steps > 8 * 7 / 2); /* programs take several each */
    for (query->first_pair = 0; query->first_pair < 8 * 7 / 2; query->first_pair++) {
        set_slivers(8);
        scene_begin(job, query);
        bool complete = false;
        while (!answer_job_has_answers(job) && !complete)
            complete = answer_job_step(job, answerer);
        if (!complete)
            answer_job_stop(job);
        result = *answer_job_scene_result(job);
        scene_assert(query, &result);
        assert_int_equal(result.end_pair, query->first_pair + 1);
        other = *query;
        query->first_pair = 0;
        set_row(3);
        answer_and_check(query);
        *query = other;
    }
}

/* No step decides more than a block. */
static void steps_are_short(void **state)
{
    static const struct {
        const char *method;
        int32_t want;
        int pairs;
    } each[] = {{"certified", 0, 128}, {"certified", FMB_WANT_BOX, 32}, {"exact", 0, 1}};
    set_heap(60, 2, false, false);
    for (size_t i = 0; i < COUNT(each); i++) {
        query->method = fmb_method_by_name(each[i].method)->number;
        query->want = each[i].want;
        scene_begin(job, query);
        while (!answer_job_has_answers(job))
            assert_false(answer_job_step(job, answerer));
        answer_job_stop(job);
        scene_assert(query, answer_job_scene_result(job));
        assert_true(answer_job_scene_result(job)->end_pair <= each[i].pairs);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(answers_are_those_of_each_pair),
        TEST(answers_of_the_exact_method),
        TEST(answers_of_inexact_methods),
        TEST(every_pair_can_be_the_first),
        TEST(parts_fill_their_datagrams),
        TEST(a_datagram_is_filled_to_its_last_byte),
        TEST(verdicts_of_listed_pairs_fit),
        TEST(empty_scenes_are_answered),
        TEST(bad_placements_are_refused),
        TEST(too_many_placements_are_refused),
        TEST(wrong_counts_are_refused),
        TEST(bad_pairs_are_refused),
        TEST(bad_ignored_pairs_are_refused),
        TEST(ignored_pairs_are_left_out),
        TEST(listed_pairs_within_a_group_are_refused),
        TEST(too_many_frames_are_refused),
        TEST(bad_requests_are_refused),
        TEST(malformed_bytes_are_refused),
        TEST(handles_and_whole_placements_may_be_mixed),
        TEST(unknown_handles_are_listed),
        TEST(a_handle_of_the_other_dimension_is_refused),
        TEST(more_bodies_than_the_cache_holds_are_answered),
        TEST(answers_allocate_nothing),
        TEST(queries_between_steps_do_not_show),
        TEST(a_scene_without_answers_stops_as_busy),
        TEST(a_job_can_be_begun_anew),
        TEST(a_stopped_scene_continues_where_it_ended),
        TEST(no_step_decides_two_exact_pairs),
        TEST(steps_are_short),
    };
    return cmocka_run_group_tests_name("answer_scene", tests, NULL, NULL);
}
