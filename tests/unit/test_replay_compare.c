/* Two results of a query compared: every way in which they can differ, numbers at their ends,
 * scenes against a naive model, results that lie; and that bytes which look the same are. */
#include "unit.h"

#include "compare.h"
#include "geometry_write.h"

#include "answer.h"
#include "answer_now.h"
#include "draw.h"
#include "replay_draw.h"
#include "wire.h"

#include <float.h>
#include <math.h>

static const struct compare_options exact = {.tolerance = 0};

/* ---- What is reported ---- */

enum { REPORTED_MAX = 20000 };

static struct difference reported[REPORTED_MAX];
static int reported_count;

static void on_difference(void *user, const struct difference *difference)
{
    (void) user;
    assert_true(reported_count < REPORTED_MAX);
    reported[reported_count++] = *difference;
}

static struct answerer *answerer;
static struct answer_job *job;

static int set_up(void **state)
{
    const struct answerer_options options = {.frames = 2000, .server_id = 99, .secret = {1, 2}};
    drawn = 1;
    answerer = answerer_create(&options);
    job = answer_job_create();
    return answerer && job ? 0 : -1;
}

static int tear_down(void **state)
{
    answer_job_destroy(job);
    answerer_destroy(answerer);
    return 0;
}

/* ---- Pairs ---- */

/* A unit cube or square at x = at, y = z = 0, which moves along x where speed is not 0; flat: its
 * first component is 0. What the placements of a test point to stays. */
static struct query_placement placed(int64_t id, int dim, double at, double speed, bool flat)
{
    static unsigned char bytes[2][2][GEOMETRY_FRAME_BYTES_MAX];
    unsigned char *geometry = bytes[dim - 2][flat];
    struct plain_frame frame = {.shape = FMB_CUBOID};
    for (int i = flat; i < dim; i++)
        frame.components[i * dim + i] = 1;
    return (struct query_placement){.placed.id = id,
                                    .body = geometry_write(dim, &frame, geometry),
                                    .placed.position = {at},
                                    .velocity_count = speed != 0 ? dim : 0,
                                    .placed.velocity = {speed}};
}

static struct query_placement frame(int64_t id, int dim, double at, double speed)
{
    return placed(id, dim, at, speed, false);
}

/* By a handle that is not held. */
static void make_unknown(struct query_placement *placement)
{
    placement->body = geometry_named(placement->body.dim, &(struct handle){{77}});
}

static struct pair_query pair(int dim, double at, double speed, int32_t want)
{
    return (struct pair_query){.utime = 3,
                               .client_id = 4,
                               .sequence_number = 5,
                               .duration = 2,
                               .want = want,
                               .placement = {frame(11, dim, 0, 0), frame(12, dim, at, speed)}};
}

/* Certificates stay good: each has a copy. */
static struct pair_result answer(const struct pair_query *query)
{
    static char certificate[64][FMB_CERTIFICATE_MAX];
    static int next;
    struct pair_result result;
    answer_pair(answerer, query, &result);
    if (result.certificate)
        result.certificate = strcpy(certificate[next = (next + 1) % 64], result.certificate);
    return result;
}

static enum replay_outcome compare_with(double tolerance, const struct pair_query *query,
                                        const struct pair_result *then,
                                        const struct pair_result *now)
{
    const struct compare_options options = {.tolerance = tolerance};
    static struct logged_query of;
    static struct logged_result results[2];
    struct exchange before = {.query = &of, .result = &results[0]};
    struct exchange after = {.query = &of, .result = &results[1]};
    reported_count = 0;
    of.kind = results[0].kind = results[1].kind = LOG_PAIR_QUERY;
    of.pair = *query;
    of.placement = of.pair.placement;
    of.placement_count = 2;
    results[0].pair = *then;
    results[1].pair = *now;
    const enum replay_outcome outcome =
        compare_exchanges(&options, &before, &after, on_difference, NULL);
    assert_int_equal(reported_count, outcome == REPLAY_DIFFERENT);
    return outcome;
}

static void expect_kind(double tolerance, const struct pair_query *query,
                        const struct pair_result *then, const struct pair_result *now,
                        enum difference_kind kind)
{
    assert_int_equal(compare_with(tolerance, query, then, now), REPLAY_DIFFERENT);
    assert_int_equal(reported[0].kind, kind);
    assert_int_equal(reported[0].body_id[0], 11);
    assert_int_equal(reported[0].body_id[1], 12);
    assert_false(reported[0].whole);
    assert_int_equal(reported[0].then.status, then->status);
    assert_int_equal(reported[0].now.status, now->status);
}

static void expect_same(double tolerance, const struct pair_query *query,
                        const struct pair_result *then, const struct pair_result *now)
{
    assert_int_equal(compare_with(tolerance, query, then, now), REPLAY_SAME);
}

enum {
    BOX = FMB_WANT_BOX,
    CERTIFICATE = FMB_WANT_CERTIFICATE,
    TIMES = FMB_WANT_TIMES,
    GAP = FMB_WANT_GAP,
    POINT = FMB_WANT_POINT
};

static void every_kind_of_difference_is_found(void **state)
{
    const struct pair_query query = pair(3, 0.5, 1, BOX | CERTIFICATE | GAP | POINT);
    const struct pair_result now = answer(&query);
    assert_true(now.answer.has_box && now.answer.has_contact && now.certificate);
    assert_true(now.answer.has_gap && now.answer.has_point);
    struct pair_result then = now;
    expect_same(0, &query, &then, &now);
    char other[FMB_CERTIFICATE_MAX];
    strcpy(other, now.certificate);
    other[strlen(other) - 1] ^= 1; /* at its end alone */
    then.certificate = other;
    expect_kind(0, &query, &then, &now, DIFFERENT_CERTIFICATE);
    then.certificate = "none such";
    expect_kind(0, &query, &then, &now, DIFFERENT_CERTIFICATE);
    assert_string_equal(reported[0].then.certificate, "none such");
    then.certificate = NULL;
    expect_kind(0, &query, &then, &now, DIFFERENT_CERTIFICATE);
    expect_kind(0, &query, &now, &then, DIFFERENT_CERTIFICATE);
    then.answer.gap.direction[2] = -then.answer.gap.direction[2] + 1;
    expect_kind(0, &query, &then, &now, DIFFERENT_GAP);
    then.answer.gap = now.answer.gap;
    then.answer.gap.bounds[1] = nextafter(then.answer.gap.bounds[1], 9);
    expect_kind(0, &query, &then, &now, DIFFERENT_GAP);
    then.answer.has_gap = false;
    expect_kind(0, &query, &then, &now, DIFFERENT_GAP);
    then.answer.point[3] = nextafter(then.answer.point[3], 9);
    expect_kind(0, &query, &then, &now, DIFFERENT_POINT);
    then.answer.has_point = false;
    expect_kind(0, &query, &then, &now, DIFFERENT_POINT);
    then.answer.box[1][2] = nextafter(then.answer.box[1][2], 9);
    expect_kind(0, &query, &then, &now, DIFFERENT_BOX);
    then.answer.has_box = false;
    expect_kind(0, &query, &then, &now, DIFFERENT_BOX);
    then.answer.contact[0] = nextafter(then.answer.contact[0], 9);
    expect_kind(0, &query, &then, &now, DIFFERENT_INTERVAL);
    then.answer.has_contact = false;
    expect_kind(0, &query, &then, &now, DIFFERENT_INTERVAL);
    then.answer.verdict = FMB_TOUCHING;
    expect_kind(0, &query, &then, &now, DIFFERENT_VERDICT);
    then = (struct pair_result){.status = FMB_BAD_ID};
    expect_kind(0, &query, &then, &now, DIFFERENT_STATUS);
    then.status = -7; /* of a service that lies */
    expect_kind(0, &query, &then, &now, DIFFERENT_STATUS);
}

static void other_fields_are_not_compared(void **state)
{
    const struct pair_query query = pair(3, 0.5, 1, BOX);
    const struct pair_result now = answer(&query);
    struct pair_result then = now;
    then.server_id = then.utime = then.compute_ns = -1;
    then.handle[0].bytes[0] ^= 1;
    then.method = 77;
    expect_same(0, &query, &then, &now);
    const struct pair_result refused = {.status = FMB_BAD_ID, .detail = "client_id: this"};
    then = refused;
    strcpy(then.detail, "in other words");
    expect_same(0, &query, &then, &refused);
}

static void statuses_of_the_moment_are_not_compared(void **state)
{
    const struct pair_query query = pair(3, 0.5, 1, BOX);
    const struct pair_result good = answer(&query);
    const struct pair_result busy = {.status = FMB_BUSY}, unknown = {.status = FMB_UNKNOWN_BODY};
    const struct pair_result bad = {.status = FMB_BAD_ID};
    for (double tolerance = 0; tolerance < 1; tolerance += 0.5) {
        assert_int_equal(compare_with(tolerance, &query, &busy, &good), REPLAY_BUSY);
        assert_int_equal(compare_with(tolerance, &query, &busy, &bad), REPLAY_BUSY);
        assert_int_equal(compare_with(tolerance, &query, &good, &busy), REPLAY_BUSY);
        assert_int_equal(compare_with(tolerance, &query, &busy, &unknown), REPLAY_BUSY);
        assert_int_equal(compare_with(tolerance, &query, &unknown, &good), REPLAY_UNKNOWN);
        assert_int_equal(compare_with(tolerance, &query, &unknown, &unknown), REPLAY_UNKNOWN);
        assert_int_equal(compare_with(tolerance, &query, &unknown, &busy), REPLAY_UNKNOWN);
        assert_int_equal(compare_with(tolerance, &query, &good, &unknown), REPLAY_UNDEFINED);
        assert_int_equal(compare_with(tolerance, &query, &bad, &unknown), REPLAY_UNDEFINED);
    }
}

/* ---- Numbers ---- */

/* Of two results with one of these for an end: what they are with this tolerance. Durations are 2.
 * The largest coordinate of the query is the larger of these two if it is finite and at least 1,
 * else 1. */
static const struct {
    double tolerance, then, now;
    bool interval, box; /* the same */
} ends[] = {
    {0, 0.0, -0.0, false, false},
    {1e-300, 0.0, -0.0, true, true},
    {0, 0x1p-1074, 0, false, false},
    {0, 0x1p-1074, 0x1p-1073, false, false},
    {1e-320, 0x1p-1074, 0, true, true}, /* subnormal limits */
    {0x1p-1074, 0x1p-1074, 0, true, true},
    {0x1p-1074, 0x1p-1072, 0, false, false},
    {0.25, 1, 1.5, true, false}, /* 0.5 of 2 * 0.25, and of 1.5 * 0.25 */
    {0.25, 1, 0x1.8000000000001p0, false, false},
    {0.5, 1, 2, true, true},
    {0.5, 1, 0x1.fffffffffffffp0, true, true},
    {0.25, 3, 4, false, true},
    {0.25, 3, 0x1.0000000000001p2, false, false},
    {1e-12, DBL_MAX, 0x1.ffffffffffffep1023, false, true},
    {1, DBL_MAX, -DBL_MAX, false, false}, /* the difference overflows */
    {1, DBL_MAX, 0, false, true},
    {1, HUGE_VAL, DBL_MAX, false, false},
    {1, DBL_MAX, HUGE_VAL, false, false},
    {1, HUGE_VAL, -HUGE_VAL, false, false},
    {0, HUGE_VAL, HUGE_VAL, true, true},
    {1, HUGE_VAL, HUGE_VAL, true, true},
    {1, NAN, 1, false, false},
    {1, 1, NAN, false, false},
    {0, NAN, NAN, true, true}, /* the same bits */
};

static void ends_of_intervals_are_compared(void **state)
{
    const struct pair_query query = pair(3, 0.5, 1, 0);
    const struct pair_result good = answer(&query);
    for (size_t i = 0; i < COUNT(ends); i++)
        for (int end = 0; end < 2; end++) {
            struct pair_result then = good, now = good;
            then.answer.contact[end] = ends[i].then;
            now.answer.contact[end] = ends[i].now;
            if (ends[i].interval)
                expect_same(ends[i].tolerance, &query, &then, &now);
            else
                expect_kind(ends[i].tolerance, &query, &then, &now, DIFFERENT_INTERVAL);
        }
}

/* A query whose largest coordinate is that of these ends: of points. */
static struct pair_query query_of_ends(int dim, double then, double now)
{
    struct pair_query query = pair(dim, 0, 0, BOX);
    double most = 1;
    for (int f = 0; f < 2; f++)
        make_unknown(&query.placement[f]);
    most = isfinite(then) ? fmax(most, fabs(then)) : most;
    most = isfinite(now) ? fmax(most, fabs(now)) : most;
    query.placement[1].placed.position[dim - 1] = -most;
    return query;
}

static void set_box(struct pair_result *result, int side, int axis, double end)
{
    memset(result->answer.box, 0, sizeof result->answer.box);
    result->answer.box[side][axis] = end;
}

static void ends_of_boxes_are_compared(void **state)
{
    for (int dim = 2; dim <= 3; dim++) {
        const struct pair_query boxed = pair(dim, 0.5, 0, BOX);
        const struct pair_result good = answer(&boxed);
        for (size_t i = 0; i < COUNT(ends); i++)
            for (int at = 0; at < 2 * dim; at++) {
                const struct pair_query query = query_of_ends(dim, ends[i].then, ends[i].now);
                struct pair_result then = good, now = good;
                set_box(&then, at / dim, at % dim, ends[i].then);
                set_box(&now, at / dim, at % dim, ends[i].now);
                if (ends[i].box)
                    expect_same(ends[i].tolerance, &query, &then, &now);
                else
                    expect_kind(ends[i].tolerance, &query, &then, &now, DIFFERENT_BOX);
            }
    }
}

/* A result with one of the numbers for a bound of a gap. */
static void set_gap(struct pair_result *result, int bound, double value)
{
    struct fmb_gap *gap = &result->answer.gap;
    result->dim = 3;
    result->answer.verdict = FMB_SEPARATED;
    result->answer.has_contact = false;
    result->answer.has_gap = gap->has_witness = true;
    gap->bounds[bound] = value;
}

static void bounds_of_gaps_are_compared(void **state)
{
    const struct pair_query plain = pair(3, 0.5, 0, 0);
    const struct pair_result good = answer(&plain);
    for (size_t i = 0; i < COUNT(ends); i++)
        for (int bound = 0; bound < 2; bound++) {
            const struct pair_query query = query_of_ends(3, ends[i].then, ends[i].now);
            struct pair_result then = good, now = good;
            set_gap(&then, bound, ends[i].then);
            set_gap(&now, bound, ends[i].now);
            if (ends[i].box)
                expect_same(ends[i].tolerance, &query, &then, &now);
            else
                expect_kind(ends[i].tolerance, &query, &then, &now, DIFFERENT_GAP);
        }
}

/* Of bodies that overlap, so that only coordinates of the query count. */
static void expect_scale(const struct pair_query *query, double scale)
{
    struct pair_result then = {.dim = 3}, now;
    set_gap(&then, 0, -1e-3);
    then.answer.verdict = FMB_OVERLAPPING;
    then.answer.gap.has_witness = false;
    now = then;
    now.answer.gap.bounds[0] -= scale / 4;
    expect_same(0.251, query, &then, &now);
    expect_kind(0.249, query, &then, &now, DIFFERENT_GAP);
}

static void a_tolerance_is_relative_to_the_largest_coordinate(void **state)
{
    static const struct plain_frame huge = {.shape = FMB_CUBOID,
                                            .components = {1e200, 0, 0, 0, 1e200, 0, 0, 0, 1e200}};
    unsigned char bytes[GEOMETRY_FRAME_BYTES_MAX];
    struct pair_query query = query_of_ends(3, 5, 0);
    expect_scale(&query, 5);
    query.placement[0].placed.velocity[1] = -3; /* for 2 s */
    expect_scale(&query, 5);
    query.placement[0].velocity_count = 3;
    expect_scale(&query, 6);
    query = pair(3, 0.5, 0, 0); /* cubes: a corner is sqrt(3) from the origin */
    expect_scale(&query, 0.5 + sqrt(3));
    query.placement[1].placed.position[0] = -1e-3;
    expect_scale(&query, 1e-3 + sqrt(3));
    query = pair(3, -6, 3, 0); /* ends at 0 */
    expect_scale(&query, 6 + sqrt(3));
    query.placement[1].body = geometry_write(3, &huge, bytes);
    expect_scale(&query, 3e200); /* the squares overflow: the engine adds the components */
}

/* Nearest points need not be the only ones. */
static void with_a_tolerance_witness_points_may_differ(void **state)
{
    const struct pair_query query = pair(3, 2, 0, GAP);
    const struct pair_result now = answer(&query);
    struct pair_result then = now;
    assert_true(now.answer.gap.has_witness);
    then.answer.gap.witness[0][1] += 0.25;
    then.answer.gap.direction[0] += 0.25;
    expect_same(1e-12, &query, &then, &now);
    expect_kind(0, &query, &then, &now, DIFFERENT_GAP);
    then.answer.has_gap = false;
    expect_kind(1, &query, &then, &now, DIFFERENT_GAP);
}

static void with_a_tolerance_certificates_may_differ(void **state)
{
    const struct pair_query query = pair(3, 0.5, 0, CERTIFICATE);
    const struct pair_result now = answer(&query);
    struct pair_result then = now;
    then.certificate = NULL;
    expect_same(1e-12, &query, &then, &now);
    then.answer.verdict = FMB_TOUCHING; /* but nothing else that is not a number */
    expect_kind(1, &query, &then, &now, DIFFERENT_VERDICT);
    then = now;
    then.answer.has_contact = false;
    expect_kind(1, &query, &then, &now, DIFFERENT_INTERVAL);
}

/* The time of a point by the duration, 2 s; its coordinates by the largest of the query, 5. */
static void points_are_compared_with_the_tolerance(void **state)
{
    const struct pair_query query = query_of_ends(3, 5, 0);
    struct pair_result then = {.dim = 3}, now;
    then.answer = (struct fmb_answer){
        .verdict = FMB_OVERLAPPING, .has_contact = true, .has_point = true, .point = {1, 1, 1, 1}};
    for (int i = 0; i < 4; i++) {
        now = then;
        now.answer.point[i] += i ? 1.25 : 0.5;
        expect_same(0.251, &query, &then, &now);
        expect_kind(0.249, &query, &then, &now, DIFFERENT_POINT);
        expect_kind(0, &query, &then, &now, DIFFERENT_POINT);
    }
}

/* A box of the other dimension is another box, though all numbers that both have be the same. */
static void boxes_of_another_dimension_differ(void **state)
{
    for (int dim = 2; dim <= 3; dim++) {
        const struct pair_query query = pair(dim, 0.5, 0, BOX);
        struct pair_result now = answer(&query), then;
        now.answer.box[0][2] = now.answer.box[1][2] = 0;
        then = now;
        then.dim = 5 - dim;
        expect_kind(0, &query, &then, &now, DIFFERENT_BOX);
        expect_kind(1, &query, &then, &now, DIFFERENT_BOX);
    }
}

/* ---- Scenes: a model ---- */

/* The model works on the structs that are compared, because copies would be large. */
static struct logged_query scene_logged = {.kind = LOG_SCENE_QUERY};
static struct logged_result results_logged[2] = {{.kind = LOG_SCENE_QUERY},
                                                 {.kind = LOG_SCENE_QUERY}};
static struct scene_query *const scene = &scene_logged.scene;
static struct scene_result *const then = &results_logged[0].scene;
static struct scene_result *const now = &results_logged[1].scene;

/* One answer, as a scene's result has it. */
struct plain {
    bool there;
    int verdict;
    bool has_times, has_box;
    double times[2], box[6];
    bool has_gap;
    struct fmb_gap gap;
};

enum { PAIRS_MAX = 20000 };

static struct plain plain_then[PAIRS_MAX], plain_now[PAIRS_MAX];
static unsigned requested[PAIRS_MAX][2];

/* All pairs of the query, in their order. */
static int list_requested(void)
{
    int count = 0;
    if (scene->which == FMB_PAIRS_LISTED) {
        for (; count < scene->index_count / 2; count++)
            memcpy(requested[count], scene->pair[count], sizeof requested[count]);
        return count;
    }
    for (int a = 0; a < scene->placement_count; a++)
        for (int b = a + 1; b < scene->placement_count; b++)
            if (scene->which == FMB_PAIRS_ALL || (a < scene->split && b >= scene->split)) {
                assert_true(count < PAIRS_MAX);
                requested[count][0] = (unsigned) a;
                requested[count++][1] = (unsigned) b;
            }
    return count;
}

static int number_of(const unsigned pair_of[2], int from, int count)
{
    while (from < count && (requested[from][0] != pair_of[0] || requested[from][1] != pair_of[1]))
        from++;
    return from;
}

static void put_plain(const struct scene_result *result, int i, int *contact, struct plain *out)
{
    *out = (struct plain){.there = true, .verdict = result->verdict[i]};
    out->has_gap = result->has_gaps && result->dim == scene->placement[0].body.dim &&
                   !isnan(result->gap[i].bounds[0]);
    if (out->has_gap)
        out->gap = result->gap[i];
    if (out->verdict < FMB_TOUCHING)
        return;
    const int at = (*contact)++;
    if (result->has_times && !isnan(result->times[2 * at])) {
        out->has_times = true;
        memcpy(out->times, &result->times[2 * at], sizeof out->times);
    }
    if (result->has_boxes && result->dim == scene->placement[0].body.dim) {
        out->has_box = true;
        memcpy(out->box, &result->boxes[2 * result->dim * at],
               2 * (size_t) result->dim * sizeof(double));
    }
}

/* The answers of a result, by the number of their pair. False: it is none to this query. */
static bool plain_of(const struct scene_result *result, int total, struct plain *out)
{
    const bool listed = scene->which == FMB_PAIRS_LISTED;
    int contact = 0, number = scene->first_pair - 1;
    if (result->end_pair < scene->first_pair || result->end_pair > total)
        return false;
    if (listed &&
        (result->names_pairs || result->verdict_count != result->end_pair - scene->first_pair))
        return false;
    if (!listed && !result->names_pairs && result->verdict_count > 0)
        return false;
    for (int i = 0; i < total; i++)
        out[i] = (struct plain){.there = !listed && i >= scene->first_pair && i < result->end_pair,
                                .verdict = FMB_SEPARATED};
    for (int i = 0; i < result->verdict_count; i++) {
        number = listed ? number + 1 : number_of(result->pair[i], number + 1, total);
        if (number >= result->end_pair)
            return false;
        put_plain(result, i, &contact, &out[number]);
    }
    return true;
}

static bool same_plain(const struct plain *a, const struct plain *b)
{
    return a->verdict == b->verdict && a->has_times == b->has_times && a->has_box == b->has_box &&
           memcmp(a->times, b->times, sizeof a->times) == 0 &&
           memcmp(a->box, b->box, sizeof a->box) == 0 && a->has_gap == b->has_gap &&
           query_same_gap(&a->gap, &b->gap);
}

/* What is reported is what the model says. */
static void check_differences(int total)
{
    int found = 0;
    for (int i = 0; i < total; i++) {
        if (!plain_then[i].there || !plain_now[i].there ||
            same_plain(&plain_then[i], &plain_now[i]))
            continue;
        assert_true(found < reported_count);
        const struct difference *difference = &reported[found++];
        assert_false(difference->whole);
        for (int f = 0; f < 2; f++) {
            assert_int_equal(difference->placement[f], requested[i][f]);
            assert_int_equal(difference->body_id[f], scene->placement[requested[i][f]].placed.id);
        }
        assert_int_equal(difference->then.answer.verdict, plain_then[i].verdict);
        assert_int_equal(difference->now.answer.verdict, plain_now[i].verdict);
        if (plain_then[i].verdict != plain_now[i].verdict)
            assert_int_equal(difference->kind, DIFFERENT_VERDICT);
        else
            assert_true(difference->kind == DIFFERENT_INTERVAL ||
                        difference->kind == DIFFERENT_BOX || difference->kind == DIFFERENT_GAP);
    }
    assert_int_equal(found, reported_count);
}

static enum replay_outcome compare(void)
{
    struct exchange before = {.query = &scene_logged, .result = &results_logged[0]};
    struct exchange after = {.query = &scene_logged, .result = &results_logged[1]};
    reported_count = 0;
    scene_logged.placement = scene->placement;
    scene_logged.placement_count = scene->placement_count;
    return compare_exchanges(&exact, &before, &after, on_difference, NULL);
}

static void check_scene(void)
{
    const enum replay_outcome outcome = compare();
    if (then->status == FMB_BUSY || then->status == FMB_UNKNOWN_BODY ||
        now->status == FMB_UNKNOWN_BODY) {
        assert_true(outcome == (then->status == FMB_BUSY           ? REPLAY_BUSY
                                : then->status == FMB_UNKNOWN_BODY ? REPLAY_UNKNOWN
                                                                   : REPLAY_UNDEFINED));
        return;
    }
    assert_int_equal(outcome, reported_count ? REPLAY_DIFFERENT : REPLAY_SAME);
    const int total = now->status == FMB_OK ? list_requested() : 0;
    const bool both = then->status == FMB_OK && now->status == FMB_OK;
    if (both) {
        assert_true(plain_of(now, total, plain_now));
        if (plain_of(then, total, plain_then)) {
            check_differences(total);
            return;
        }
    } else if (then->status == now->status) {
        assert_int_equal(reported_count, 0);
        return;
    }
    assert_int_equal(reported_count, 1);
    assert_true(reported[0].whole);
    assert_int_equal(reported[0].kind, both ? DIFFERENT_SCENE : DIFFERENT_STATUS);
}

/* ---- Scenes: drawn ---- */

static void draw_pairs(int frames)
{
    scene->split = scene->which == FMB_PAIRS_ACROSS ? (int32_t) draw((uint64_t) frames + 1) : 0;
    scene->index_count = 0;
    if (scene->which == FMB_PAIRS_LISTED && frames > 1)
        for (int pairs = (int) draw(40); scene->index_count < 2 * pairs; scene->index_count += 2) {
            unsigned *to = scene->pair[scene->index_count / 2];
            to[0] = (unsigned) draw((uint64_t) frames);
            to[1] = (to[0] + 1 + (unsigned) draw((uint64_t) frames - 1)) % (unsigned) frames;
        }
}

/* In a row, some over each other: a good part of the pairs meets. */
static void draw_scene(void)
{
    static const int32_t methods[] = {0, 0, 1, 4, 2, 3};
    const int frames = (int) draw(9), dim = 2 + (int) draw(2);
    memset(scene, 0, sizeof *scene);
    scene->client_id = 4;
    scene->duration = 1;
    scene->want = (int32_t) (draw(2) * BOX | draw(2) * TIMES);
    scene->which = (int32_t) draw(3);
    scene->method = methods[draw(scene->which == FMB_PAIRS_LISTED ? 6 : 4)];
    if (scene->method < 2 || scene->method > 3) {
        scene->want |= draw(2) ? GAP : 0;
        scene->margin = 0.5 * (double) draw(3);
    }
    scene->placement_count = frames;
    for (int i = 0; i < frames; i++) {
        const int64_t id = draw(2) ? 20 + i : 0;
        const double at = 0.25 * (double) draw(16), speed = draw(2) ? 0.25 * (double) draw(5) : 0;
        /* Of flat ones there are methods that cannot decide. */
        scene->placement[i] = placed(id, dim, at, speed, draw(8) == 0);
    }
    draw_pairs(frames);
    const int total = list_requested();
    scene->first_pair = draw(3) ? 0 : (int32_t) draw((uint64_t) total + 1);
}

static unsigned char then_bytes[QUERY_BYTES_MAX], now_bytes[QUERY_BYTES_MAX];
static size_t now_size;

/* Both as they come from the wire. */
static void answer_now(void)
{
    static unsigned char query[QUERY_BYTES_MAX];
    assert_null(answer_job_begin(job, ANSWER_SCENE, query, wire_write_scene_query(scene, query)));
    while (!answer_job_step(job, answerer))
        continue;
    now_size = wire_write_scene_result(answer_job_scene_result(job), now_bytes);
    memcpy(then_bytes, now_bytes, now_size);
    assert_null(wire_read_scene_result(now_bytes, (uint32_t) now_size, now));
    assert_null(wire_read_scene_result(then_bytes, (uint32_t) now_size, then));
}

static void cut(struct scene_result *result, int32_t end)
{
    if (end >= result->end_pair)
        return;
    int contacts = 0, kept = 0;
    for (; kept < result->verdict_count; kept++) {
        const int number = result->names_pairs ? number_of(result->pair[kept], 0, PAIRS_MAX - 1)
                                               : scene->first_pair + kept;
        if (number >= end)
            break;
        contacts += result->verdict[kept] >= FMB_TOUCHING;
    }
    result->end_pair = end;
    result->verdict_count = kept;
    result->contact_count = contacts;
}

/* Of the answers one, so that the reader might take it. */
static void change_one(struct scene_result *result)
{
    const int at = result->verdict_count ? (int) draw((uint64_t) result->verdict_count) : 0;
    const int contact = result->contact_count ? (int) draw((uint64_t) result->contact_count) : -1;
    switch (draw(6)) {
    case 0:
        if (result->verdict_count > 0 && result->verdict[at] >= FMB_TOUCHING)
            result->verdict[at] ^= FMB_TOUCHING ^ FMB_OVERLAPPING;
        break;
    case 3:
        if (result->verdict_count > 0 && result->has_gaps)
            result->gap[at].direction[1] += 0.5;
        break;
    case 4: result->has_gaps = false; break;
    case 1:
        if (contact >= 0 && result->has_times)
            result->times[2 * contact + 1] += 0.5;
        break;
    case 2:
        if (contact >= 0 && result->has_boxes)
            result->boxes[2 * result->dim * contact + result->dim] += 0.5;
        break;
    default: result->has_boxes = false;
    }
}

/* A named one, as if it had not been found. */
static void drop_one(struct scene_result *result)
{
    if (!result->names_pairs || result->verdict_count == 0)
        return;
    const size_t count = (size_t) result->verdict_count, at = draw(count),
                 dim = (size_t) result->dim;
    const size_t after = count - at - 1;
    const bool contact = result->verdict[at] >= FMB_TOUCHING;
    size_t from = 0;
    for (size_t i = 0; i < at; i++)
        from += result->verdict[i] >= FMB_TOUCHING;
    const size_t rest = (size_t) result->contact_count - from - contact;
    memmove(&result->gap[at], &result->gap[at + 1], after * sizeof result->gap[0]);
    memmove(&result->verdict[at], &result->verdict[at + 1], after);
    memmove(&result->pair[at], &result->pair[at + 1], after * sizeof result->pair[0]);
    result->verdict_count--;
    if (!contact)
        return;
    memmove(&result->times[2 * from], &result->times[2 * from + 2], 2 * rest * sizeof(double));
    memmove(&result->boxes[2 * dim * from], &result->boxes[2 * dim * (from + 1)],
            2 * dim * rest * sizeof(double));
    result->contact_count--;
}

/* What was written and read again, exact to the byte. */
static bool through_the_wire(struct scene_result *result)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    const size_t size = wire_write_scene_result(result, bytes);
    return !wire_read_scene_result(bytes, (uint32_t) size, result);
}

static void scenes_compare_as_the_model(void **state)
{
    int different = 0, same = 0, shorter = 0;
    for (int round = 0; round < 10000; round++) {
        draw_scene();
        answer_now();
        check_scene();
        assert_int_equal(reported_count, 0);
        const int32_t span = now->end_pair - scene->first_pair;
        for (uint64_t changes = draw(4); changes > 0; changes--)
            (draw(3) ? change_one : drop_one)(then);
        if (span > 0 && draw(3) == 0)
            cut(then, scene->first_pair + (int32_t) draw((uint64_t) span + 1));
        if (span > 0 && draw(3) == 0)
            cut(now, scene->first_pair + (int32_t) draw((uint64_t) span + 1));
        if (!through_the_wire(then) || !through_the_wire(now))
            continue;
        check_scene();
        different += reported_count > 0;
        same += reported_count == 0;
        shorter += then->end_pair != now->end_pair;
    }
    assert_in_range(different, 1000, 10000);
    assert_in_range(same, 1000, 10000);
    assert_in_range(shorter, 250, 10000);
}

/* ---- Results that are not of the query ---- */

/* Any result beside any query. */
static void results_of_other_queries_differ(void **state)
{
    static unsigned char kept[20][QUERY_BYTES_MAX];
    static size_t kept_size[20];
    int count = 0, whole = 0, walked = 0;
    for (int round = 0; round < 2000; round++) {
        draw_scene();
        answer_now();
        for (int i = 0; i < count; i++) {
            assert_null(wire_read_scene_result(kept[i], (uint32_t) kept_size[i], then));
            check_scene();
            whole += reported_count > 0 && reported[0].whole;
            walked += reported_count == 0 || !reported[0].whole;
        }
        if (round % 100 == 0) {
            kept_size[count] = now_size;
            memcpy(kept[count++], now_bytes, now_size);
        }
    }
    assert_in_range(whole, 2500, 50000);
    assert_in_range(walked, 250, 50000);
}

/* Of a service that does not follow the rules. */
static void a_named_pair_that_is_ignored_keeps_its_place(void **state)
{
    static const unsigned expected[][2] = {{0, 1}, {0, 2}, {1, 2}};
    static struct logged_query of = {.kind = LOG_SCENE_QUERY};
    static struct logged_result result = {.kind = LOG_SCENE_QUERY};
    struct exchange exchange = {.query = &of, .result = &result};
    struct fmb_client_answer found;
    of.scene = (struct scene_query){
        .which = FMB_PAIRS_ALL, .placement_count = 3, .ignored = {{0, 1}}, .ignored_count = 2};
    of.placement = of.scene.placement;
    of.placement_count = 3;
    result.scene = (struct scene_result){
        .end_pair = 3, .verdict_count = 1, .names_pairs = true, .pair = {{0, 1}}};
    result.scene.verdict[0] = FMB_TOUCHING;
    exchange_begin(&exchange);
    for (size_t i = 0; i < COUNT(expected); i++) {
        assert_true(exchange_next(&exchange, true, &found));
        assert_int_equal(found.a, expected[i][0]);
        assert_int_equal(found.b, expected[i][1]);
        assert_int_equal(found.answer.verdict, i == 0 ? FMB_TOUCHING : FMB_SEPARATED);
    }
    assert_false(exchange_next(&exchange, true, &found));
    exchange_end(&exchange);
}

static void expect_whole(void)
{
    assert_int_equal(compare(), REPLAY_DIFFERENT);
    assert_int_equal(reported_count, 1);
    assert_true(reported[0].whole);
    assert_int_equal(reported[0].kind, DIFFERENT_SCENE);
}

/* As many pairs as a message has room for, all of them in contact, and nothing else said. */
static void the_most_pairs_are_compared(void **state)
{
    memset(scene, 0, sizeof *scene);
    scene->duration = 1;
    scene->which = FMB_PAIRS_LISTED;
    scene->placement_count = 2;
    for (int i = 0; i < 2; i++)
        scene->placement[i] = frame(0, 2, 0, 0);
    const int pairs = (QUERY_BYTES_MAX - 400) / 4; /* what the placements leave */
    scene->index_count = 2 * pairs;
    for (int i = 0; i < pairs; i++)
        scene->pair[i][1] = 1;
    answer_now();
    assert_int_equal(now->verdict_count, pairs);
    check_scene();
    assert_int_equal(reported_count, 0);
    memset(then->verdict, FMB_TOUCHING, (size_t) pairs);
    check_scene();
    assert_int_equal(reported_count, pairs);
    then->end_pair = pairs + 1;
    expect_whole();
    then->end_pair = INT32_MAX;
    expect_whole();
}

/* Indices of a scene with about the most placements that a query can have, and beyond it. */
enum { PLACEMENTS = 400 };

static void the_most_placements_are_compared(void **state)
{
    for (int which = FMB_PAIRS_ALL; which <= FMB_PAIRS_ACROSS; which += 2) {
        memset(scene, 0, sizeof *scene);
        scene->duration = 1;
        scene->which = which;
        scene->split = which == FMB_PAIRS_ACROSS ? 350 : 0;
        scene->placement_count = PLACEMENTS;
        for (int i = 0; i < PLACEMENTS; i++)
            scene->placement[i] = frame(i + 1, 2, 10 * i, 0);
        answer_now();
        assert_int_equal(now->verdict_count, 0);
        then->names_pairs = true;
        then->verdict_count = then->contact_count = 1;
        then->verdict[0] = FMB_TOUCHING;
        then->pair[0][0] = 349;
        then->pair[0][1] = PLACEMENTS - 1;
        assert_int_equal(compare(), REPLAY_DIFFERENT);
        assert_int_equal(reported_count, 1);
        assert_int_equal(reported[0].placement[0], 349);
        assert_int_equal(reported[0].body_id[1], PLACEMENTS);
        assert_int_equal(reported[0].now.answer.verdict, FMB_SEPARATED);
        then->pair[0][1] = PLACEMENTS;
        expect_whole();
        then->pair[0][1] = UINT32_MAX;
        expect_whole();
        then->pair[0][0] = UINT32_MAX - 1;
        expect_whole();
        then->end_pair = -1;
        expect_whole();
    }
}

/* ---- Bytes that look the same ---- */

/* From blocks that end where they end. */
static bool looks_same(enum log_kind kind, const unsigned char *a, const unsigned char *b,
                       size_t size)
{
    unsigned char *copy[2] = {malloc(size ? size : 1), malloc(size ? size : 1)};
    memcpy(copy[0], a, size);
    memcpy(copy[1], b, size);
    const bool same = compare_bytes_same(kind, copy[0], size, copy[1], size);
    free(copy[0]);
    free(copy[1]);
    return same;
}

static void scenes_whose_bytes_are_the_same(void **state)
{
    int same = 0;
    for (int round = 0; round < 300; round++) {
        draw_scene();
        if (draw(4) == 0 && scene->placement_count > 0) { /* refused in many ways */
            if (draw(2))
                make_unknown(&scene->placement[0]);
            else
                scene->placement[0].body.handle.bytes[0] = 77;
        }
        answer_now();
        for (size_t at = 0; at < now_size; at++) {
            memcpy(then_bytes, now_bytes, now_size);
            then_bytes[at] ^= (unsigned char) (1 + draw(255));
            if (!looks_same(LOG_SCENE_QUERY, then_bytes, now_bytes, now_size))
                continue;
            same++;
            assert_null(wire_read_scene_result(then_bytes, (uint32_t) now_size, then));
            assert_int_equal(compare(), REPLAY_SAME);
        }
        for (size_t size = 0; size < now_size; size++)
            assert_false(compare_bytes_same(LOG_SCENE_QUERY, now_bytes, size, now_bytes, now_size));
    }
    assert_in_range(same, 2000, 100000); /* ids, handles, time taken */
}

static struct pair_query drawn_pair(void)
{
    static const int32_t methods[] = {0, 1, 2, 3, 4, 99};
    struct pair_query query = pair(2 + (int) draw(2), 0.25 * (double) draw(8),
                                   draw(2) ? 0.25 * (double) draw(9) - 1 : 0, (int32_t) draw(4));
    query.method = methods[draw(6)];
    if (draw(4) == 0)
        make_unknown(&query.placement[draw(2)]);
    if (draw(8) == 0)
        query.duration = -1;
    return query;
}

static void pairs_whose_bytes_are_the_same(void **state)
{
    static unsigned char a[QUERY_BYTES_MAX], b[QUERY_BYTES_MAX];
    int same = 0, unknown = 0;
    for (int round = 0; round < 1000; round++) {
        const struct pair_query query = drawn_pair();
        const struct pair_result result = answer(&query);
        const size_t size = wire_write_pair_result(&result, b);
        unknown += result.status == FMB_UNKNOWN_BODY;
        for (size_t at = 0; at < size; at++) {
            struct pair_result read;
            memcpy(a, b, size);
            a[at] ^= (unsigned char) (1 + draw(255));
            if (!looks_same(LOG_PAIR_QUERY, a, b, size))
                continue;
            same++;
            assert_null(wire_read_pair_result(a, (uint32_t) size, &read));
            expect_same(0, &query, &read, &result);
        }
        assert_int_equal(looks_same(LOG_PAIR_QUERY, b, b, size),
                         compare_with(0, &query, &result, &result) == REPLAY_SAME);
        for (size_t shorter = 0; shorter < size; shorter++)
            assert_false(compare_bytes_same(LOG_PAIR_QUERY, b, shorter, b, size));
    }
    assert_in_range(same, 10000, 100000);
    assert_in_range(unknown, 50, 1000);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(every_kind_of_difference_is_found),
        TEST(other_fields_are_not_compared),
        TEST(statuses_of_the_moment_are_not_compared),
        TEST(ends_of_intervals_are_compared),
        TEST(ends_of_boxes_are_compared),
        TEST(bounds_of_gaps_are_compared),
        TEST(a_tolerance_is_relative_to_the_largest_coordinate),
        TEST(with_a_tolerance_witness_points_may_differ),
        TEST(points_are_compared_with_the_tolerance),
        TEST(with_a_tolerance_certificates_may_differ),
        TEST(boxes_of_another_dimension_differ),
        TEST(scenes_compare_as_the_model),
        TEST(results_of_other_queries_differ),
        TEST(a_named_pair_that_is_ignored_keeps_its_place),
        TEST(the_most_pairs_are_compared),
        TEST(the_most_placements_are_compared),
        TEST(scenes_whose_bytes_are_the_same),
        TEST(pairs_whose_bytes_are_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
