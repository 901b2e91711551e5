/* Whole replays: logs of a service and its clients that are made here and then spoiled in every
 * way, and all counts agree. */
#include "unit.h"

#include "draw.h"
#include "geometry_write.h"
#include "log_draft.h"
#include "log_world.h"
#include "replay_draw.h"
#include "replay_report.h"

#include "answer_now.h"
#include "wire.h"

#include <malloc.h>
#include <math.h>
#include <unistd.h>

/* ---- A log, and its replay ---- */

static struct log_draft recorded;
static int file = -1;
static char path[LOG_DRAFT_PATH_MAX];
static char *paths[] = {path};

static struct replay_options options(void)
{
    static const struct output_rules rules;
    return (struct replay_options){.log = paths,
                                   .log_count = 1,
                                   .prefix = "",
                                   .write_golden = {.kind = OUTPUT_LOG, .rules = &rules},
                                   .frames = 1000};
}

static void close_log(void)
{
    if (file >= 0)
        close(file);
    file = -1;
    log_draft_free(&recorded);
}

static void open_log(void)
{
    file = log_draft_file(recorded.bytes, recorded.size, path);
}

static int tear_down(void **state)
{
    close_log();
    return 0;
}

static void expect_nothing(const char *what, const char *where)
{
    if (what)
        fail_msg("%s: %s", where, what);
}

static int64_t outcome(const struct replay_report *report, enum replay_outcome which)
{
    return tally_both(&report->tally).outcome[which];
}

/* ---- What is on it ---- */

/* A cuboid with edges of this length. What the placements of a test point to stays. */
static struct body_view geometry(double edge)
{
    enum { KEPT = 4096 };
    static unsigned char bytes[KEPT][GEOMETRY_FRAME_BYTES_MAX];
    static int next;
    struct plain_frame frame = {.shape = FMB_CUBOID};
    for (int i = 0; i < 3; i++)
        frame.components[4 * i] = edge;
    next = (next + 1) % KEPT;
    return geometry_write(3, &frame, bytes[next]);
}

static struct handle handle(double edge)
{
    const struct body_view of = geometry(edge);
    return handle_of(of.bytes, of.size);
}

static struct query_placement whole(int64_t id, double edge, double at)
{
    return (struct query_placement){
        .placed.id = id, .body = geometry(edge), .placed.position = {at}};
}

static struct query_placement by_handle(int64_t id, double edge, double at)
{
    const struct handle of = handle(edge);
    return (struct query_placement){
        .placed.id = id, .body = geometry_named(3, &of), .placed.position = {at}};
}

static struct pair_query pair(int64_t number, struct query_placement a, struct query_placement b)
{
    return (struct pair_query){
        .utime = 5, .client_id = 7, .sequence_number = number, .duration = 1, .placement = {a, b}};
}

static void log_pair(int64_t utime, const struct pair_query *query)
{
    unsigned char bytes[QUERY_BYTES_MAX];
    log_draft_event(&recorded, WIRE_PAIR_QUERY, utime, bytes, wire_write_pair_query(query, bytes));
}

static void log_pair_result(int64_t utime, const struct pair_result *result)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    log_draft_event(&recorded, WIRE_PAIR_RESULT, utime, bytes,
                    wire_write_pair_result(result, bytes));
}

/* The bodies with edges of these lengths, up to the first 0. */
static void log_definition(int64_t utime, const double *edges)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    static struct definition definition;
    memset(&definition, 0, sizeof definition);
    for (; *edges > 0; edges++) {
        struct body_view *body = &definition.body[definition.body_count++];
        *body = geometry(*edges);
        body->handle = handle(*edges);
    }
    log_draft_event(&recorded, WIRE_DEFINITION, utime, bytes,
                    wire_write_definition(&definition, bytes));
}

static double edge_of(const struct query_placement *placement)
{
    struct plain_frame frame;
    for (double edge = 0.25; query_by_handle(placement); edge += 0.25) {
        const struct handle of = handle(edge);
        if (handle_equal(&of, &placement->body.handle))
            return edge;
    }
    struct geometry_reader reader = geometry_begin(&placement->body);
    assert_true(geometry_read(&reader, &frame));
    return frame.components[0];
}

/* What a service says that holds all bodies, of cuboids along x. */
static struct pair_result result_of(const struct pair_query *query)
{
    struct pair_result result = {.utime = query->utime,
                                 .client_id = query->client_id,
                                 .sequence_number = query->sequence_number,
                                 .server_id = 99,
                                 .method = 4,
                                 .compute_ns = 1000};
    double end[2];
    for (int f = 0; f < 2; f++) {
        const struct query_placement *one = &query->placement[f];
        const double edge = edge_of(one);
        result.body_id[f] = one->placed.id;
        if (one->placed.id && !query_by_handle(one))
            result.handle[f] = handle(edge);
        end[f] = one->placed.position[0] + edge;
    }
    const double gap =
        fmax(query->placement[0].placed.position[0], query->placement[1].placed.position[0]) -
        fmin(end[0], end[1]);
    result.answer.verdict = gap > 0 ? FMB_SEPARATED : gap < 0 ? FMB_OVERLAPPING : FMB_TOUCHING;
    result.answer.has_contact = gap <= 0;
    result.answer.contact[1] = gap <= 0 ? query->duration : 0;
    return result;
}

static struct pair_result status_of(const struct pair_query *query, enum fmb_status status)
{
    return (struct pair_result){.utime = query->utime,
                                .client_id = query->client_id,
                                .sequence_number = query->sequence_number,
                                .status = status};
}

static void log_both(int64_t utime, struct pair_query query)
{
    const struct pair_result result = result_of(&query);
    log_pair(utime, &query);
    log_pair_result(utime, &result);
}

static struct replay_report replay(void)
{
    const struct replay_options with = options();
    open_log();
    struct replay_report report = replay_report_of(&with), again = replay_report_of(&with);
    assert_true(report.good);
    expect_nothing(replay_report_odd(&report, (int64_t) recorded.size), "adding up");
    expect_nothing(replay_report_differ(&report, &again), "once more");
    replay_report_free(&again);
    return report;
}

/* ---- One thing at a time ---- */

static void an_empty_log_has_nothing_to_compare(void **state)
{
    struct replay_report report = replay();
    assert_int_equal(tally_both(&report.tally).queries, 0);
    replay_report_free(&report);
}

/* The clock of a machine that logs may be set back: what it logs then is no less there. */
static void a_clock_that_goes_back_changes_nothing(void **state)
{
    static const int64_t utimes[] = {1000, 999, -5, INT64_MIN, 0, INT64_MAX, 1001};
    for (int i = 0; i < 7; i++)
        log_both(utimes[i], pair(i, whole(1, 1, 0), whole(2, 1, i)));
    struct replay_report report = replay();
    assert_int_equal(tally_both(&report.tally).queries, 7);
    assert_int_equal(outcome(&report, REPLAY_SAME), 7);
    replay_report_free(&report);
}

static void differences_are_where_they_are(void **state)
{
    for (int i = 0; i < 20; i++) {
        const struct pair_query query = pair(i, whole(1, 1, 0), whole(2, 1, i));
        struct pair_result result = result_of(&query);
        if (i % 5 == 2)
            result.answer = (struct fmb_answer){.verdict = FMB_OVERLAPPING, .has_contact = true};
        log_pair(100 * i, &query);
        log_pair_result(100 * i + 1, &result);
    }
    struct replay_report report = replay();
    assert_int_equal(outcome(&report, REPLAY_SAME), 16);
    assert_int_equal(outcome(&report, REPLAY_DIFFERENT), 4);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(report.found[i].place.number, 2 * (5 * i + 2));
        assert_int_equal(report.found[i].place.utime, 100 * (5 * i + 2));
        assert_int_equal(report.found[i].sequence_number, 5 * i + 2);
        assert_int_equal(report.found[i].kind, DIFFERENT_VERDICT);
        assert_int_equal(report.found[i].now.answer.verdict, FMB_SEPARATED);
    }
    replay_report_free(&report);
}

/* ---- Handles ---- */

static const double none[] = {0};

static void handles_are_defined_before_and_after(void **state)
{
    log_both(0, pair(1, by_handle(3, 2, 0), whole(2, 1, 2)));
    log_both(1, pair(2, by_handle(3, 2, 0), by_handle(4, 5, 9)));
    log_definition(2, (double[]){1, 2, 0});
    log_both(3, pair(3, by_handle(3, 2, 0), by_handle(0, 1, 1)));
    log_both(4, pair(4, whole(5, 3, 0), by_handle(4, 5, 1)));
    log_both(5, pair(5, by_handle(5, 3, 0), whole(2, 1, 3)));
    log_definition(6, (double[]){5, 0});
    log_definition(6, none);
    struct replay_report report = replay();
    assert_int_equal(outcome(&report, REPLAY_SAME), 5);
    assert_int_equal(report.tally.definitions, 3);
    replay_report_free(&report);
}

/* A body that is sent whole later defines the handles of the queries before it, also where these
 * and their results stand elsewhere; a body without an id does not. */
static void handles_are_defined_by_whole_bodies(void **state)
{
    for (int anonymous = 0; anonymous < 2; anonymous++) {
        const struct pair_query one = pair(1, by_handle(3, 2, 0), by_handle(4, 1, 2));
        const struct pair_result result = result_of(&one);
        log_pair(0, &one);
        log_both(1, pair(2, whole(anonymous ? 0 : 8, 1, 0), whole(9, 2, 0)));
        log_pair_result(2, &result);
        log_pair(3, &one);
        log_pair_result(4, &result);
        struct replay_report report = replay();
        assert_int_equal(outcome(&report, REPLAY_SAME), anonymous ? 1 : 3);
        assert_int_equal(outcome(&report, REPLAY_UNDEFINED), anonymous ? 2 : 0);
        replay_report_free(&report);
        close_log();
    }
}

static void a_verdict_is_compared_where_the_definition_comes_late(void **state)
{
    const struct pair_query query = pair(1, by_handle(3, 2, 0), by_handle(4, 1, 2));
    struct pair_result result = result_of(&query);
    result.answer.verdict = FMB_OVERLAPPING;
    log_pair(0, &query);
    log_pair_result(1, &result);
    log_definition(2, (double[]){1, 2, 0});
    struct replay_report report = replay();
    assert_int_equal(report.found_count, 1);
    assert_int_equal(report.found[0].now.answer.verdict, FMB_TOUCHING);
    replay_report_free(&report);
}

/* Overwrites bytes of an event after it was read, whenever progress is reported. */
static int64_t overwritten; /* offset of these bytes */

static void overwrite(void *user, int64_t bytes, int64_t of)
{
    (void) user;
    (void) bytes;
    (void) of;
    assert_int_equal(pwrite(file, "\xff\xff\xff\xff", 4, overwritten), 4);
}

static void refuse_difference(void *user, const struct difference *difference)
{
    (void) user;
    (void) difference;
    fail_msg("a result that changed was compared");
}

static void ignore_unreadable(void *user, const struct match_place *place, const char *channel,
                              const char *what)
{
    (void) user;
    (void) place;
    (void) channel;
    (void) what;
}

static void ignore_damage(void *user, int log, const struct log_damage *damage)
{
    (void) user;
    (void) log;
    (void) damage;
}

/* Its sync word, its lengths or its fingerprint changes. */
static void a_result_that_changes_before_it_can_be_compared(void **state)
{
    static const int64_t offsets[] = {0, 20, 24, 28 + sizeof WIRE_PAIR_RESULT - 1};
    const struct replay_sink sink = {refuse_difference, ignore_unreadable, ignore_damage, overwrite,
                                     NULL};
    for (size_t i = 0; i < COUNT(offsets); i++) {
        const struct pair_query query = pair(1, by_handle(3, 2, 0), by_handle(4, 1, 2));
        const struct pair_result result = result_of(&query);
        struct tally tally = {.events = 0};
        log_pair(0, &query);
        overwritten = (int64_t) recorded.size + offsets[i];
        log_pair_result(1, &result);
        log_definition(2, (double[]){1, 2, 0});
        open_log();
        const struct replay_options changing = options();
        assert_false(replay_run(&changing, &sink, &tally));
        assert_int_equal(tally_both(&tally).outcome[REPLAY_SAME], 0);
        close_log();
    }
}

/* One id, two bodies: handles say which. */
static void two_clients_use_the_same_ids_for_other_bodies(void **state)
{
    for (int i = 0; i < 40; i++) {
        const double edge = i % 2 ? 1 : 3;
        struct pair_query query = pair(i / 2, i < 2 ? whole(1, edge, 0) : by_handle(1, edge, 0),
                                       i < 2 ? whole(2, 2, 0) : by_handle(2, 2, 0.25 * i));
        query.client_id = i % 2;
        log_both(i, query);
    }
    struct replay_report report = replay();
    assert_int_equal(outcome(&report, REPLAY_SAME), 40);
    replay_report_free(&report);
}

/* More bodies than the cache has space for, one after the other and again. */
static void a_cache_that_is_too_small_leaves_queries_open(void **state)
{
    struct replay_options with = options();
    with.frames = 2;
    for (int i = 0; i < 60; i++)
        log_both(
            i,
            pair(i, i < 20 ? whole(1 + i, 1 + 0.25 * i, 0) : by_handle(7, 1 + 0.25 * (i % 20), 0),
                 i < 20 ? whole(50, 6.25, i) : by_handle(8, 6.25, i)));
    open_log();
    struct replay_report report = replay_report_of(&with);
    assert_int_equal(outcome(&report, REPLAY_SAME), 60);
    replay_report_free(&report);
}

/* A definition whose body is not what its handle says. */
static void a_false_definition_defines_nothing(void **state)
{
    log_definition(0, (double[]){2, 0});
    recorded.bytes[recorded.size - 1] ^= 1;
    log_both(1, pair(1, by_handle(3, 2, 0), whole(4, 1, 0)));
    struct replay_report report = replay();
    assert_int_equal(outcome(&report, REPLAY_UNDEFINED), 1);
    assert_int_equal(report.tally.unreadable_definitions, 1);
    assert_int_equal(tally_unreadable(&report.tally), 1);
    replay_report_free(&report);
}

/* ---- Results of the moment, and second ones ---- */

static void results_of_the_moment_are_not_compared(void **state)
{
    for (int i = 0; i < 30; i++) {
        const struct pair_query query = pair(i, by_handle(1, i % 3 ? 1 : 2, 0), whole(2, 1, i));
        const struct pair_result result = status_of(&query, i % 2 ? FMB_BUSY : FMB_UNKNOWN_BODY);
        log_pair(i, &query);
        log_pair_result(i, &result);
    }
    struct replay_report report = replay();
    assert_int_equal(outcome(&report, REPLAY_BUSY), 15);
    assert_int_equal(outcome(&report, REPLAY_UNKNOWN), 15);
    replay_report_free(&report);
}

/* A client repeats a query that was refused, under the same number; or another service answers. */
static void an_answer_after_a_result_of_the_moment_is_compared(void **state)
{
    for (int repeats = 0; repeats < 2; repeats++) {
        for (int i = 0; i < 20; i++) {
            const struct pair_query query = pair(i, by_handle(1, i % 2 ? 1 : 2, 0), whole(2, 1, i));
            const struct pair_result busy = status_of(&query, FMB_BUSY);
            const struct pair_result unknown = status_of(&query, FMB_UNKNOWN_BODY);
            log_pair(i, &query);
            log_pair_result(i, &unknown);
            log_pair_result(i, &busy);
            if (repeats)
                log_pair(i, &query);
            const struct pair_result result = result_of(&query);
            log_pair_result(i, &result);
        }
        log_definition(20, (double[]){2, 0});
        struct replay_report report = replay();
        assert_int_equal(outcome(&report, REPLAY_SAME), 20);
        assert_int_equal(outcome(&report, REPLAY_UNKNOWN), repeats ? 20 : 0);
        assert_int_equal(report.tally.channel[TALLY_PAIRS].results_again, repeats ? 20 : 40);
        replay_report_free(&report);
        close_log();
    }
}

/* Of two services on one bus each query has two results. The first counts. */
static void second_results_are_counted(void **state)
{
    for (int i = 0; i < 30; i++) {
        const struct pair_query query = pair(i, whole(3, 2, 0), whole(2, 1, i));
        struct pair_result result = result_of(&query);
        log_pair(0, &query);
        log_pair_result(0, &result);
        result.server_id = 98;
        if (i == 20)
            result.answer = (struct fmb_answer){.verdict = FMB_TOUCHING, .has_contact = true};
        if (i == 21)
            result = status_of(&query, FMB_BUSY);
        if (i % 2)
            log_both(0, pair(1000 + i, whole(3, 2, 0), whole(2, 1, i)));
        log_pair_result(0, &result);
    }
    struct replay_report report = replay();
    assert_int_equal(tally_both(&report.tally).queries, 45);
    assert_int_equal(outcome(&report, REPLAY_SAME), 45);
    assert_int_equal(report.tally.channel[TALLY_PAIRS].results_again, 29);
    assert_int_equal(tally_both(&report.tally).contradictions, 1);
    replay_report_free(&report);
}

/* The same query again, each time before its handle is defined. */
static void repeats_before_the_answer_are_the_same(void **state)
{
    const struct pair_query query = pair(1, by_handle(3, 2, 0), whole(2, 1, 2));
    const struct pair_result result = result_of(&query);
    log_pair(0, &query);
    log_pair(1, &query);
    log_pair_result(2, &result);
    log_pair_result(3, &result);
    log_both(4, pair(2, whole(3, 2, 0), whole(2, 1, 1)));
    log_both(5, query);
    struct replay_report report = replay();
    assert_int_equal(outcome(&report, REPLAY_SAME), 4);
    assert_int_equal(report.tally.channel[TALLY_PAIRS].unmatched, 0);
    replay_report_free(&report);
}

/* ---- Messages that cannot be read, or say little ---- */

/* A query whose header can be read and nothing else: its result is not one of nobody. */
static void an_unreadable_query_is_counted(void **state)
{
    unsigned char bytes[QUERY_BYTES_MAX];
    for (int i = 0; i < 10; i++) {
        const struct pair_query query = pair(i, whole(3, 2, 0), whole(2, 1, i));
        const struct pair_result result = result_of(&query);
        const size_t size = wire_write_pair_query(&query, bytes);
        log_draft_event(&recorded, WIRE_PAIR_QUERY, 0, bytes, i % 3 ? size : size - 1);
        log_pair_result(0, &result);
    }
    struct replay_report report = replay();
    assert_int_equal(tally_both(&report.tally).queries, 6);
    assert_int_equal(report.tally.channel[TALLY_PAIRS].unreadable[0], 4);
    assert_int_equal(report.tally.channel[TALLY_PAIRS].unmatched, 0);
    replay_report_free(&report);
}

static void an_unreadable_result_is_counted(void **state)
{
    unsigned char bytes[QUERY_BYTES_MAX];
    for (int i = 0; i < 10; i++) {
        const struct pair_query query = pair(i, whole(3, 2, 0), whole(2, 1, i));
        const struct pair_result result = result_of(&query);
        const size_t size = wire_write_pair_result(&result, bytes);
        if (i != 9) /* a result without a query */
            log_pair(0, &query);
        log_draft_event(&recorded, WIRE_PAIR_RESULT, 0, bytes, i % 3 ? size : size - 1);
    }
    struct replay_report report = replay();
    assert_int_equal(tally_both(&report.tally).queries, 9);
    assert_int_equal(outcome(&report, REPLAY_SAME), 6);
    assert_int_equal(outcome(&report, REPLAY_UNRECORDED), 3);
    assert_int_equal(report.tally.channel[TALLY_PAIRS].unreadable[1], 4);
    replay_report_free(&report);
}

/* More than a datagram, and than a log's reader keeps: the service says OVER_LIMIT. */
static void queries_beyond_all_limits_replay_as_refused(void **state)
{
    static unsigned char bytes[200000];
    static struct scene_query query;
    static struct scene_result result;
    static const size_t sizes[] = {QUERY_BYTES_MAX, QUERY_BYTES_MAX + 1, LOG_DATA_MAX,
                                   LOG_DATA_MAX + 1, sizeof bytes};
    query.label = "abc"; /* so that whole pairs fill the datagram */
    query.which = FMB_PAIRS_LISTED;
    query.index_count = (QUERY_BYTES_MAX - WIRE_SCENE_QUERY_BYTES - 3) / 2;
    for (int i = 0; i < 5; i++) {
        static unsigned char result_bytes[QUERY_BYTES_MAX];
        query.sequence_number = result.sequence_number = i;
        result.status = i ? FMB_OVER_LIMIT : FMB_BAD_PAIR;
        wire_write_scene_query(&query, bytes);
        log_draft_event(&recorded, WIRE_SCENE_QUERY, 0, bytes, sizes[i]);
        log_draft_event(&recorded, WIRE_SCENE_RESULT, 0, result_bytes,
                        wire_write_scene_result(&result, result_bytes));
    }
    struct replay_report report = replay();
    assert_int_equal(tally_both(&report.tally).queries, 5);
    assert_int_equal(outcome(&report, REPLAY_SAME), 5);
    assert_int_equal(tally_unreadable(&report.tally), 0);
    replay_report_free(&report);
}

/* Times that a result says of itself are counted, whatever they are. */
static void negative_times_are_not_counted(void **state)
{
    static const int64_t times[] = {INT64_MIN, -1, 0, 1, INT64_MAX};
    for (int i = 0; i < 5; i++) {
        const struct pair_query query = pair(i, whole(3, 2, 0), whole(2, 1, i));
        struct pair_result result = result_of(&query);
        result.compute_ns = times[i];
        log_pair(0, &query);
        log_pair_result(0, &result);
    }
    struct replay_report report = replay();
    assert_int_equal(outcome(&report, REPLAY_SAME), 5);
    assert_int_equal(report.tally.then.count, 2);
    assert_int_equal(report.tally.then.max, INT64_MAX);
    replay_report_free(&report);
}

/* ---- Scenes of two recordings ---- */

/* Bodies of one edge at these positions, with the ids from 1 on; and the result of the answerer, or
 * alone that. */
static void log_scene(int64_t client_id, const double *position, int32_t count, bool result_only)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    static struct scene_query query;
    const struct answerer_options of = {.frames = 100, .server_id = 99, .secret = {1, 2}};
    struct answerer *answerer = answerer_create(&of);
    struct answer_job *job = answer_job_create();
    memset(&query, 0, sizeof query);
    query.client_id = client_id;
    query.sequence_number = 1;
    query.utime = client_id;
    query.placement_count = count;
    query.which = FMB_PAIRS_ALL;
    for (int32_t i = 0; i < count; i++)
        query.placement[i] = whole(i + 1, 1, position[i]);
    const size_t size = wire_write_scene_query(&query, bytes);
    assert_null(answer_job_begin(job, ANSWER_SCENE, bytes, size));
    if (!result_only)
        log_draft_event(&recorded, WIRE_SCENE_QUERY, 0, bytes, size);
    while (!answer_job_step(job, answerer))
        continue;
    log_draft_event(&recorded, WIRE_SCENE_RESULT, 1, bytes,
                    wire_write_scene_result(answer_job_scene_result(job), bytes));
    answer_job_destroy(job);
    answerer_destroy(answerer);
}

/* Replays a scene of other bodies against a golden log. */
static struct replay_report replay_scenes(int64_t client_id, const double *golden,
                                          int32_t golden_count, bool results_only,
                                          const double *position, int32_t count)
{
    char golden_path[LOG_DRAFT_PATH_MAX];
    log_scene(7, golden, golden_count, results_only);
    const int golden_file = log_draft_file(recorded.bytes, recorded.size, golden_path);
    log_draft_free(&recorded);
    log_scene(client_id, position, count, false);
    open_log();
    struct replay_options with = options();
    with.golden = golden_path;
    const struct replay_report report = replay_report_of(&with);
    assert_true(report.good);
    close(golden_file);
    close_log();
    return report;
}

static void expect_scene(struct replay_report report, const char *detail)
{
    assert_int_equal(outcome(&report, REPLAY_DIFFERENT), 1);
    assert_int_equal(outcome(&report, REPLAY_SAME), 0);
    assert_int_equal(report.found_count, 1);
    assert_int_equal(report.found[0].kind, DIFFERENT_SCENE);
    assert_string_equal(report.detail, detail);
    replay_report_free(&report);
}

static const double row[] = {0, 0.5, 9}; /* the first two overlap */

/* The new body overlaps the second one: it is after all pairs that the golden has. */
static void a_golden_of_fewer_bodies_is_different(void **state)
{
    static const double more[] = {0, 0.5, 9, 1.25};
    for (int64_t client = 7; client < 9; client++)
        expect_scene(replay_scenes(client, row, 3, false, more, 4),
                     "the recording has 3 bodies, the query 4: 4 is new");
    expect_scene(replay_scenes(8, row, 3, true, more, 4),
                 "the recording answers 3 pairs, the query has 6");
}

static void a_golden_of_more_bodies_is_different(void **state)
{
    for (int64_t client = 7; client < 9; client++)
        expect_scene(replay_scenes(client, row, 3, false, row, 2),
                     "the recording has 3 bodies, the query 2: 3 is missing");
    expect_scene(replay_scenes(8, row, 3, true, row, 2),
                 "the recording answers 3 pairs, the query has 1");
    expect_scene(replay_scenes(7, row, 3, true, row, 2),
                 "a result is of other pairs than its query");
}

static void a_golden_of_the_same_bodies_is_the_same(void **state)
{
    for (int results_only = 0; results_only < 2; results_only++)
        for (int64_t client = 7; client < 9; client++) {
            struct replay_report report = replay_scenes(client, row, 3, results_only, row, 3);
            assert_int_equal(outcome(&report, REPLAY_SAME), 1);
            assert_int_equal(report.found_count, 0);
            replay_report_free(&report);
        }
}

/* Some 100 bytes for a query and for its result, as the help of fmb replay says; the list of them
 * reserves up to twice its size. */
static void results_after_all_queries_take_bounded_memory(void **state)
{
    const int64_t count = 100000 / draw_step(10);
    struct pair_query query = pair(0, whole(3, 2, 0), whole(2, 1, 2));
    struct pair_result result = result_of(&query);
    for (int i = 0; i < count; i++) {
        query.sequence_number = i;
        log_pair(i, &query);
    }
    for (int64_t i = 0; i < count; i++) {
        result.sequence_number = i * 7919 % count; /* in another order */
        log_pair_result(i, &result);
    }
    const struct replay_options with = options();
    const size_t before = mallinfo2().uordblks + mallinfo2().hblkhd;
    open_log();
    struct replay_report report = replay_report_of(&with);
    assert_int_equal(outcome(&report, REPLAY_SAME), count);
    assert_true(report.most_memory < before + (32 << 20) + 2 * 200 * (size_t) count);
    replay_report_free(&report);
}

/* ---- Worlds, spoiled ---- */

/* Ways to spoil a log. */
enum {
    FLIPS = 1,
    SPOILED = 2, /* messages that cannot be read */
    DAMAGE = 4,
    CLOCK = 8,
    AGAIN = 16,        /* results twice */
    OTHER_UTIMES = 32, /* results that do not echo it */
    EVERYTHING = 63
};

/* Flips the verdict of a contact. Returns whether it was one. */
static bool flip(const char *channel, unsigned char *bytes, size_t *size)
{
    static struct scene_result scene;
    struct pair_result result;
    if (strcmp(channel, WIRE_SCENE_RESULT) == 0) {
        if (wire_read_scene_result(bytes, (uint32_t) *size, &scene) || scene.contact_count == 0)
            return false;
        int32_t k = 0;
        while (scene.verdict[k] < FMB_TOUCHING)
            k++;
        scene.verdict[k] ^= FMB_TOUCHING ^ FMB_OVERLAPPING;
        wire_write_scene_result(&scene, bytes);
        return true;
    }
    if (strcmp(channel, WIRE_PAIR_RESULT) != 0 ||
        wire_read_pair_result(bytes, (uint32_t) *size, &result) || !result.answer.has_contact)
        return false;
    result.answer.verdict ^= FMB_TOUCHING ^ FMB_OVERLAPPING;
    result.certificate = NULL; /* it points into the bytes */
    *size = wire_write_pair_result(&result, bytes);
    return true;
}

/* Adds the events of a world. Returns how many verdicts were flipped. */
static int64_t add_world(const struct log_world *world, int ways)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    int64_t flipped = 0;
    for (size_t i = 0; i < world->count; i++) {
        const struct world_event *event = &world->event[i];
        const bool is_result = strstr(event->channel, "_RESULT");
        const int64_t utime = event->utime - (ways & CLOCK && draw(20) == 0 ? 100000 : 0);
        size_t size = event->size;
        memcpy(bytes, event->bytes, size);
        if (ways & DAMAGE && draw(30) == 0)
            log_draft_raw(&recorded, "any bytes that are no event", draw(27));
        if (ways & FLIPS && draw(8) == 0)
            flipped += flip(event->channel, bytes, &size);
        if (ways & OTHER_UTIMES && is_result && size > 16 && draw(15) == 0)
            bytes[15] ^= 1;
        if (ways & SPOILED && draw(25) == 0 && draw(2))
            bytes[draw(size)] ^= (unsigned char) (1 + draw(255));
        else if (ways & SPOILED && draw(25) == 0)
            size = draw(size + 1);
        for (int times = ways & AGAIN && is_result && draw(8) == 0 ? 2 : 1; times > 0; times--)
            log_draft_event(&recorded, event->channel, utime, bytes, size);
    }
    if (ways & DAMAGE && draw(2))
        recorded.size -= draw(40);
    return flipped;
}

static void check_golden(void)
{
    char folder[] = "/tmp/test_replay_run.XXXXXX", golden[64];
    struct replay_options with = options();
    assert_non_null(mkdtemp(folder));
    snprintf(golden, sizeof golden, "%s/golden", folder);
    with.write_golden.path = golden;
    struct replay_report report = replay_report_of(&with);
    assert_true(report.good);
    const int64_t queries = tally_both(&report.tally).queries;
    replay_report_free(&report);
    with.write_golden.path = NULL;
    with.golden = golden;
    report = replay_report_of(&with);
    assert_true(report.good);
    expect_nothing(replay_report_odd(&report, (int64_t) recorded.size), "golden");
    assert_int_equal(tally_both(&report.tally).queries, queries);
    /* Where a handle is not defined, the golden has UNKNOWN_BODY. */
    assert_int_equal(outcome(&report, REPLAY_SAME) + outcome(&report, REPLAY_UNKNOWN), queries);
    assert_int_equal(
        report.tally.channel[TALLY_PAIRS].results + report.tally.channel[TALLY_SCENES].results,
        queries);
    replay_report_free(&report);
    unlink(golden);
    rmdir(folder);
}

/* No client repeats a query: each result that is compared belongs to one query. */
static void check_ways(uint64_t seed, int ways)
{
    const struct world_options of = {.seed = seed, .steps = 50, .once = true};
    struct log_world world;
    world_make(&of, &world);
    add_world(&world, 0);
    struct replay_report plain = replay();
    assert_int_equal(outcome(&plain, REPLAY_DIFFERENT), 0);
    assert_int_equal(tally_both(&plain.tally).contradictions, 0);
    assert_true(outcome(&plain, REPLAY_SAME) > 50);
    check_golden();
    close_log();
    const int64_t flipped = add_world(&world, ways);
    struct replay_report report = replay();
    assert_true(!(ways & FLIPS) || flipped > 0);
    if (!(ways & SPOILED))
        assert_true(outcome(&report, REPLAY_DIFFERENT) <= flipped);
    if (!(ways & (SPOILED | DAMAGE))) {
        assert_int_equal(tally_both(&report.tally).contradictions, 0);
        assert_int_equal(outcome(&report, REPLAY_SAME) + outcome(&report, REPLAY_DIFFERENT),
                         outcome(&plain, REPLAY_SAME));
        assert_true(!(ways & FLIPS) || outcome(&report, REPLAY_DIFFERENT) > flipped / 2);
    }
    replay_report_free(&plain);
    replay_report_free(&report);
    close_log();
    log_world_clear(&world);
}

static void worlds_spoiled_in_one_way(void **state)
{
    for (int way = 1; way < EVERYTHING; way *= 2)
        for (uint64_t seed = 1; seed < 5; seed++)
            check_ways(seed, way);
}

static void worlds_spoiled_in_many_ways(void **state)
{
    for (uint64_t seed = 10; seed < (getenv("FMB_FAST") ? 15 : 50); seed++)
        check_ways(seed, (int) draw(EVERYTHING + 1));
    check_ways(9, EVERYTHING);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_teardown(name, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(an_empty_log_has_nothing_to_compare),
        TEST(a_clock_that_goes_back_changes_nothing),
        TEST(differences_are_where_they_are),
        TEST(handles_are_defined_before_and_after),
        TEST(handles_are_defined_by_whole_bodies),
        TEST(a_verdict_is_compared_where_the_definition_comes_late),
        TEST(a_result_that_changes_before_it_can_be_compared),
        TEST(two_clients_use_the_same_ids_for_other_bodies),
        TEST(a_cache_that_is_too_small_leaves_queries_open),
        TEST(a_false_definition_defines_nothing),
        TEST(results_of_the_moment_are_not_compared),
        TEST(an_answer_after_a_result_of_the_moment_is_compared),
        TEST(second_results_are_counted),
        TEST(repeats_before_the_answer_are_the_same),
        TEST(an_unreadable_query_is_counted),
        TEST(an_unreadable_result_is_counted),
        TEST(queries_beyond_all_limits_replay_as_refused),
        TEST(negative_times_are_not_counted),
        TEST(a_golden_of_fewer_bodies_is_different),
        TEST(a_golden_of_more_bodies_is_different),
        TEST(a_golden_of_the_same_bodies_is_the_same),
        TEST(results_after_all_queries_take_bounded_memory),
        TEST(worlds_spoiled_in_one_way),
        TEST(worlds_spoiled_in_many_ways),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
