/* Whole replays: logs that are made up here of a service's and its clients' doings, and then
 * spoiled in every way; the report of a replay in several parts is that of one, and all adds up. */
#include "log_draft.h"
#include "replay_report.h"

#include "answer.h"
#include "wire.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static uint64_t drawn = 1;

static uint64_t draw(uint64_t below)
{
    drawn = drawn * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (drawn >> 33) % below;
}

/* ---- A log, and its replay ---- */

static struct log_draft recorded;
static int file = -1;
static char path[LOG_DRAFT_PATH_MAX];
static char *paths[] = {path};

static struct replay_options options(void)
{
    return (struct replay_options){.log = paths,
                                   .log_count = 1,
                                   .prefix = "",
                                   .from = -INFINITY,
                                   .to = INFINITY,
                                   .bodies = 1000};
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
    (void) state;
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
    return tally_outcome(&report->tally, which);
}

/* ---- What is on it ---- */

/* A cuboid with edges of this length. */
static struct query_frame frame(int64_t id, double edge, double at)
{
    struct query_frame out = {.body_id = id, .shape = FMB_CUBOID, .dim = 3};
    out.origin.count = 3;
    out.origin.number[0] = at;
    out.components.count = 9;
    for (int i = 0; i < 3; i++)
        out.components.number[4 * i] = edge;
    return out;
}

static struct query_frame by_key(int64_t id, int64_t key, double at)
{
    struct query_frame out = frame(id, 0, at);
    out.key = key;
    out.components = (struct query_numbers){0};
    return out;
}

static struct pair_query pair(int64_t number, struct query_frame a, struct query_frame b)
{
    return (struct pair_query){
        .utime = 5, .client_id = 7, .sequence_number = number, .duration = 1, .frame = {a, b}};
}

static void log_pair(int64_t utime, const struct pair_query *query)
{
    unsigned char bytes[WIRE_BYTES_MAX];
    log_draft_event(&recorded, WIRE_PAIR_QUERY, utime, bytes, wire_write_pair_query(query, bytes));
}

static void log_pair_result(int64_t utime, const struct pair_result *result)
{
    static unsigned char bytes[WIRE_RESULT_BYTES_MAX];
    log_draft_event(&recorded, WIRE_PAIR_RESULT, utime, bytes,
                    wire_write_pair_result(result, bytes));
}

/* What a service says that keeps components for good: key 100 * body + edge. */
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
        const struct query_frame *one = &query->frame[f];
        const bool known = one->components.count == 0;
        const double edge = known ? (double) (one->key % 100) : one->components.number[0];
        result.body_id[f] = one->body_id;
        result.key[f] = one->body_id ? 100 * one->body_id + (int64_t) edge : 0;
        end[f] = one->origin.number[0] + edge;
    }
    const double gap = fmax(query->frame[0].origin.number[0], query->frame[1].origin.number[0]) -
                       fmin(end[0], end[1]);
    result.answer.verdict = gap > 0 ? FMB_SEPARATED : gap < 0 ? FMB_OVERLAPPING : FMB_TOUCHING;
    return result;
}

static void log_both(int64_t utime, struct pair_query query)
{
    const struct pair_result result = result_of(&query);
    log_pair(utime, &query);
    log_pair_result(utime, &result);
}

static void check_in(const struct replay_options *with, const struct replay_report *whole,
                     int parts)
{
    struct replay_report report = replay_report_in(with, parts);
    char where[32];
    snprintf(where, sizeof where, "in %d parts", parts);
    expect_nothing(replay_report_differ(whole, &report), where);
    replay_report_free(&report);
}

/* Whether a report is the same in parts, also of other sizes. */
static void check_parts(const struct replay_options *with, const struct replay_report *whole)
{
    const int64_t size = replay_size(with), middle = (int64_t) draw((uint64_t) size + 1);
    const int64_t boundary[] = {0, middle, middle + (int64_t) draw((uint64_t) (size - middle) + 1),
                                size};
    struct replay_report report = replay_report_of(with, boundary, 3);
    expect_nothing(replay_report_differ(whole, &report), "in parts of any size");
    replay_report_free(&report);
    check_in(with, whole, 2 + (int) draw(4));
}

static struct replay_report replay(bool once)
{
    const struct replay_options with = options();
    open_log();
    struct replay_report report = replay_report_in(&with, 1);
    assert_true(report.good);
    expect_nothing(replay_report_odd(&report, (int64_t) recorded.size, once), "adding up");
    check_in(&with, &report, 1);
    check_in(&with, &report, 20);
    check_parts(&with, &report);
    return report;
}

/* ---- One thing at a time ---- */

static void test_nothing(void **state)
{
    (void) state;
    struct replay_report report = replay(true);
    assert_int_equal(tally_queries(&report.tally), 0);
    replay_report_free(&report);
}

/* The clock of a machine that logs may be set back: what it logs then is no less there. */
static void test_a_clock_that_goes_back(void **state)
{
    static const int64_t utimes[] = {1000, 999, -5, INT64_MIN, 0, INT64_MAX, 1001};
    (void) state;
    for (int i = 0; i < 7; i++)
        log_both(utimes[i], pair(i, frame(1, 1, 0), frame(2, 1, i)));
    struct replay_report report = replay(true);
    assert_int_equal(tally_queries(&report.tally), 7);
    assert_int_equal(outcome(&report, REPLAY_SAME), 7);
    replay_report_free(&report);
}

static void test_differences_are_where_they_are(void **state)
{
    (void) state;
    for (int i = 0; i < 20; i++) {
        const struct pair_query query = pair(i, frame(1, 1, 0), frame(2, 1, i));
        struct pair_result result = result_of(&query);
        if (i % 5 == 2)
            result.answer.verdict = FMB_OVERLAPPING;
        log_pair(100 * i, &query);
        log_pair_result(100 * i + 1, &result);
    }
    struct replay_report report = replay(true);
    assert_int_equal(outcome(&report, REPLAY_SAME), 16);
    assert_int_equal(outcome(&report, REPLAY_DIFFERENT), 4);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(report.found[i].place.number, 2 * (5 * i + 2));
        assert_int_equal(report.found[i].place.utime, 100 * (5 * i + 2));
        assert_int_equal(report.found[i].ids.sequence_number, 5 * i + 2);
        assert_int_equal(report.found[i].difference.kind, DIFFERENT_VERDICT);
        assert_int_equal(report.found[i].difference.now.answer.verdict, FMB_SEPARATED);
    }
    replay_report_free(&report);
}

/* What a key stands for may be told only after it is used: the log began later than the service. */
static void test_keys_that_are_explained_later(void **state)
{
    (void) state;
    log_both(0, pair(1, by_key(3, 302, 0), frame(2, 1, 2)));
    log_both(1, pair(2, by_key(3, 302, 0), by_key(4, 401, 9)));
    log_both(2, pair(3, by_key(3, 302, 0), frame(2, 1, 1)));
    log_both(3, pair(4, frame(3, 2, 0), frame(2, 1, 1)));
    log_both(4, pair(5, by_key(3, 302, 0), frame(2, 1, 3)));
    struct replay_report report = replay(true);
    assert_int_equal(outcome(&report, REPLAY_SAME), 4);
    assert_int_equal(outcome(&report, REPLAY_UNKNOWN), 1);
    replay_report_free(&report);
}

/* Each keeps the results that were found for it. */
static void test_the_same_ids_and_keys_that_are_explained_later(void **state)
{
    (void) state;
    const struct pair_query one = pair(1, by_key(3, 302, 0), frame(2, 1, 2));
    const struct pair_query other = pair(1, by_key(3, 302, 0), frame(2, 1, 9));
    const struct pair_result result = result_of(&one);
    log_both(0, one);
    log_pair_result(0, &result);
    log_pair(1, &other);
    log_both(2, pair(2, frame(3, 2, 0), frame(2, 1, 1)));
    struct replay_report report = replay(false);
    assert_int_equal(outcome(&report, REPLAY_SAME), 3);
    assert_int_equal(outcome(&report, REPLAY_ALONE), 1);
    replay_report_free(&report);
}

static void push_out(void)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    static struct scene_result result = {.client_id = 1, .end_pair = 1, .status = FMB_BAD_ID};
    result.key_count = QUERY_FRAMES_MAX;
    for (int i = 0; i < 1000; i++) {
        result.sequence_number++;
        log_draft_event(&recorded, WIRE_SCENE_RESULT, 5, bytes,
                        wire_write_scene_result(&result, bytes));
    }
}

/* A query has a key that nothing explains, and tells one that others use: they can be answered,
 * however far away they stand. */
static void test_keys_that_are_told_beside_unknown_ones(void **state)
{
    (void) state;
    for (int far = 0; far < 2; far++) {
        log_both(0, pair(1, frame(3, 2, 0), by_key(4, 401, 1)));
        if (far)
            push_out();
        log_both(1, pair(2, by_key(3, 302, 0), frame(2, 1, 2)));
        struct replay_report report = replay(true);
        assert_int_equal(outcome(&report, REPLAY_SAME), 1);
        assert_int_equal(outcome(&report, REPLAY_UNKNOWN), 1);
        replay_report_free(&report);
        close_log();
    }
}

/* A frame may have a key beside its components, as fmb log cut writes it: the result says whether
 * that is what the key stands for. */
static void test_keys_beside_components(void **state)
{
    (void) state;
    struct query_frame both = frame(3, 2, 0);
    both.key = 302;
    log_both(0, pair(1, both, frame(2, 1, 2)));
    for (int i = 2; i < 30; i++)
        log_both(i, pair(i, by_key(3, 302, 0), frame(2, 1, i % 5)));
    struct replay_report report = replay(true);
    assert_int_equal(outcome(&report, REPLAY_SAME), 29);
    replay_report_free(&report);
    close_log();
    both = frame(3, 1, 0); /* the key is of what it was before */
    both.key = 302;
    log_both(0, pair(1, both, frame(2, 1, 2)));
    log_both(1, pair(2, by_key(3, 302, 0), frame(2, 1, 2)));
    report = replay(true);
    assert_int_equal(outcome(&report, REPLAY_SAME), 1);
    assert_int_equal(outcome(&report, REPLAY_UNKNOWN), 1);
    replay_report_free(&report);
}

/* The same query asked again, each time before its key is explained. */
static void test_the_same_again_before_it_can_be_answered(void **state)
{
    (void) state;
    const struct pair_query query = pair(1, by_key(3, 302, 0), frame(2, 1, 2));
    const struct pair_result result = result_of(&query);
    log_pair(0, &query);
    log_pair(1, &query);
    log_pair_result(2, &result);
    log_pair_result(3, &result);
    log_both(4, pair(2, frame(3, 2, 0), frame(2, 1, 1)));
    log_both(5, query);
    struct replay_report report = replay(true);
    assert_int_equal(outcome(&report, REPLAY_SAME), 4);
    assert_int_equal(report.tally.channel[TALLY_PAIRS].results_alone, 0);
    replay_report_free(&report);
}

/* Of two services on one bus each query has two results. */
static void test_two_results(void **state)
{
    (void) state;
    for (int i = 0; i < 30; i++) {
        const struct pair_query query = pair(i, frame(3, 2, 0), frame(2, 1, i));
        struct pair_result result = result_of(&query);
        log_pair(0, &query);
        log_pair_result(0, &result);
        result.server_id = 98;
        if (i == 20)
            result.answer.verdict = FMB_TOUCHING;
        if (i % 2)
            log_both(0, pair(1000 + i, frame(3, 2, 0), frame(2, 1, i)));
        log_pair_result(0, &result);
    }
    struct replay_report report = replay(false);
    assert_int_equal(tally_queries(&report.tally), 45);
    assert_int_equal(outcome(&report, REPLAY_SAME), 15 + 59);
    assert_int_equal(outcome(&report, REPLAY_DIFFERENT), 1);
    assert_int_equal(outcome(&report, REPLAY_ALONE), 0);
    replay_report_free(&report);
}

/* A query whose header can be read and nothing else: its result is not one of nobody. */
static void test_a_query_that_cannot_be_read(void **state)
{
    unsigned char bytes[WIRE_BYTES_MAX];
    (void) state;
    for (int i = 0; i < 10; i++) {
        const struct pair_query query = pair(i, frame(3, 2, 0), frame(2, 1, i));
        const struct pair_result result = result_of(&query);
        const size_t size = wire_write_pair_query(&query, bytes);
        log_draft_event(&recorded, WIRE_PAIR_QUERY, 0, bytes, i % 3 ? size : size - 1);
        log_pair_result(0, &result);
    }
    struct replay_report report = replay(true);
    assert_int_equal(tally_queries(&report.tally), 6);
    assert_int_equal(report.tally.channel[TALLY_PAIRS].unreadable[0], 4);
    assert_int_equal(report.tally.channel[TALLY_PAIRS].results_alone, 0);
    replay_report_free(&report);
}

static void test_a_result_that_cannot_be_read(void **state)
{
    unsigned char bytes[WIRE_RESULT_BYTES_MAX];
    (void) state;
    for (int i = 0; i < 10; i++) {
        const struct pair_query query = pair(i, frame(3, 2, 0), frame(2, 1, i));
        const struct pair_result result = result_of(&query);
        const size_t size = wire_write_pair_result(&result, bytes);
        if (i != 9) /* one of nobody */
            log_pair(0, &query);
        log_draft_event(&recorded, WIRE_PAIR_RESULT, 0, bytes, i % 3 ? size : size - 1);
    }
    struct replay_report report = replay(true);
    assert_int_equal(tally_queries(&report.tally), 9);
    assert_int_equal(outcome(&report, REPLAY_SAME), 6);
    assert_int_equal(outcome(&report, REPLAY_ALONE), 3);
    assert_int_equal(report.tally.channel[TALLY_PAIRS].unreadable[1], 4);
    replay_report_free(&report);
}

/* More than a datagram, and than a log's reader keeps: the service says OVER_LIMIT. */
static void test_queries_beyond_all_limits(void **state)
{
    static unsigned char bytes[200000];
    static struct scene_query query;
    static struct scene_result result;
    static const size_t sizes[] = {QUERY_BYTES_MAX, QUERY_BYTES_MAX + 1, LOG_DATA_MAX,
                                   LOG_DATA_MAX + 1, sizeof bytes};
    (void) state;
    query.index_count = (QUERY_BYTES_MAX - WIRE_SCENE_QUERY_BYTES) / 2;
    for (int i = 0; i < 5; i++) {
        static unsigned char result_bytes[QUERY_BYTES_MAX];
        query.sequence_number = result.sequence_number = i;
        result.status = i ? FMB_OVER_LIMIT : FMB_BAD_PAIR;
        wire_write_scene_query(&query, bytes);
        log_draft_event(&recorded, WIRE_SCENE_QUERY, 0, bytes, sizes[i]);
        log_draft_event(&recorded, WIRE_SCENE_RESULT, 0, result_bytes,
                        wire_write_scene_result(&result, result_bytes));
    }
    struct replay_report report = replay(true);
    assert_int_equal(tally_queries(&report.tally), 5);
    assert_int_equal(outcome(&report, REPLAY_SAME), 5);
    assert_int_equal(tally_unreadable(&report.tally), 0);
    replay_report_free(&report);
}

/* Times that a result says of itself are counted, whatever they are. */
static void test_times_that_cannot_be(void **state)
{
    static const int64_t times[] = {INT64_MIN, -1, 0, 1, INT64_MAX};
    (void) state;
    for (int i = 0; i < 5; i++) {
        const struct pair_query query = pair(i, frame(3, 2, 0), frame(2, 1, i));
        struct pair_result result = result_of(&query);
        result.compute_ns = times[i];
        log_pair(0, &query);
        log_pair_result(0, &result);
    }
    struct replay_report report = replay(true);
    assert_int_equal(outcome(&report, REPLAY_SAME), 5);
    assert_int_equal(report.tally.then.count, 2);
    assert_int_equal(report.tally.then.max, INT64_MAX);
    replay_report_free(&report);
}

/* ---- A world: a service with room for few bodies, and clients that use its keys ---- */

enum { CLIENTS = 3, BODIES = 9, DELAYED_MAX = 64 };

struct delayed {
    int64_t at; /* event */
    bool scene;
    size_t size;
    unsigned char *bytes; /* owned */
};

static struct {
    struct answerer answerer;
    int64_t number[CLIENTS];
    struct {
        int64_t key; /* last told; 0: none */
        double edge;
    } body[CLIENTS][BODIES + 1];
    struct delayed delayed[DELAYED_MAX];
    int delayed_count;
    int64_t utime, flipped;
} world;

/* Ways to spoil a log. */
enum {
    BEGIN_LATE = 1, /* keys were told before it began */
    DELAYS = 2,     /* and results before queries */
    LOSSES = 4,
    REPEATS = 8, /* of results and of queries */
    FLIPS = 16,
    BUSY = 32,
    SPOILED = 64, /* messages that cannot be read */
    DAMAGE = 128,
    OTHERS = 256,
    CLOCK = 512,
    OTHER_UTIMES = 1024, /* results that do not echo it */
    EVERYTHING = 2047
};

static void make_world(void)
{
    memset(&world, 0, sizeof world);
    world.answerer.cache = cache_create(6, 500);
    world.answerer.server_id = 99;
    assert_true(world.answerer.cache && answer_prepare(&world.answerer));
}

static void end_world(void)
{
    for (int i = 0; i < world.delayed_count; i++)
        free(world.delayed[i].bytes);
    answer_release(&world.answerer);
    cache_destroy(world.answerer.cache);
}

static struct query_frame draw_frame(int client)
{
    const int id = (int) draw(BODIES + 1);
    const double at = 0.5 * (double) draw(8);
    struct query_frame out;
    if (id && world.body[client][id].key && draw(10) < 6) {
        out = by_key(id, world.body[client][id].key, at);
    } else {
        if (id && draw(4) == 0)
            world.body[client][id].edge = 0; /* another body from now on */
        if (world.body[client][id].edge == 0)
            world.body[client][id].edge = 1 + (double) draw(3);
        out = frame(id, world.body[client][id].edge, at);
        out.key = draw(20) == 0 ? (int64_t) draw(600) : 0;
    }
    out.velocity.count = draw(3) ? 0 : 3;
    out.velocity.number[0] = out.velocity.count ? -1 : 0;
    return out;
}

static void heard(int client, const struct query_frame *one, int64_t key)
{
    if (one->body_id && key)
        world.body[client][one->body_id].key = key;
}

static void forget(int client, const struct query_frame *one)
{
    world.body[client][one->body_id].key = 0;
}

static void delay(int64_t at, bool scene, const unsigned char *bytes, size_t size)
{
    assert_true(world.delayed_count < DELAYED_MAX);
    struct delayed *delayed = &world.delayed[world.delayed_count++];
    *delayed = (struct delayed){at, scene, size, malloc(size)};
    assert_non_null(delayed->bytes);
    memcpy(delayed->bytes, bytes, size);
}

static void write_event(int ways, const char *channel, const unsigned char *bytes, size_t size)
{
    if (ways & DAMAGE && draw(30) == 0)
        log_draft_raw(&recorded, "any bytes that are no event", draw(27));
    world.utime += (int64_t) draw(1000);
    if (ways & CLOCK && draw(20) == 0)
        world.utime -= (int64_t) draw(100000);
    if (ways & SPOILED && draw(25) == 0) {
        unsigned char *spoiled = malloc(size);
        memcpy(spoiled, bytes, size);
        if (draw(2))
            spoiled[draw(size)] ^= (unsigned char) (1 + draw(255));
        else
            size = draw(size + 1);
        log_draft_event(&recorded, channel, world.utime, spoiled, size);
        free(spoiled);
    } else {
        log_draft_event(&recorded, channel, world.utime, bytes, size);
    }
    if (ways & OTHERS && draw(10) == 0)
        log_draft_event(&recorded, draw(2) ? "POSE" : "X_" WIRE_PAIR_QUERY, world.utime, bytes,
                        draw(size));
    if (ways & OTHERS && draw(20) == 0)
        log_draft_event(&recorded, WIRE_STATUS, world.utime, "heartbeat", 9);
}

static int64_t draw_delay(int ways)
{
    return ways & DELAYS && draw(3) == 0 ? (int64_t) draw(60) : (int64_t) draw(3);
}

static void log_result(int ways, int64_t at, bool scene, const unsigned char *bytes, size_t size)
{
    if (ways & LOSSES && draw(15) == 0)
        return;
    for (int times = ways & REPEATS && draw(8) == 0 ? 2 : 1; times > 0; times--)
        delay(at + draw_delay(ways), scene, bytes, size);
}

static bool flip(int ways, unsigned char *verdict)
{
    if (!(ways & FLIPS) || draw(12) != 0 || *verdict < FMB_TOUCHING)
        return false;
    *verdict ^= FMB_TOUCHING ^ FMB_OVERLAPPING;
    world.flipped++;
    return true;
}

static size_t write_pair_result(int ways, struct pair_result result, unsigned char *bytes)
{
    unsigned char verdict = (unsigned char) result.answer.verdict;
    if (flip(ways, &verdict))
        result.answer.verdict = (enum fmb_verdict) verdict;
    if (ways & BUSY && draw(15) == 0)
        result = (struct pair_result){.utime = result.utime,
                                      .client_id = result.client_id,
                                      .sequence_number = result.sequence_number,
                                      .status = FMB_BUSY};
    result.utime += ways & OTHER_UTIMES && draw(15) == 0;
    result.compute_ns = (int64_t) draw(3000);
    return wire_write_pair_result(&result, bytes);
}

static void log_query(int ways, int64_t at, bool scene, const unsigned char *bytes, size_t size)
{
    if (ways & LOSSES && draw(20) == 0)
        return;
    for (int times = ways & REPEATS && draw(10) == 0 ? 2 : 1; times > 0 && at >= 0; times--)
        write_event(ways, scene ? WIRE_SCENE_QUERY : WIRE_PAIR_QUERY, bytes, size);
}

static void ask_pair(int ways, int64_t at, int client)
{
    static unsigned char bytes[WIRE_RESULT_BYTES_MAX], query_bytes[WIRE_BYTES_MAX];
    struct pair_query query = pair(++world.number[client], draw_frame(client), draw_frame(client));
    struct pair_result result;
    query.client_id = client;
    query.want = (int32_t) draw(4);
    if (draw(30) == 0)
        query.duration = -1;
    answer_pair(&world.answerer, &query, &result);
    for (int f = 0; f < 2; f++)
        if (result.status == FMB_UNKNOWN_BODY)
            forget(client, &query.frame[f]);
        else
            heard(client, &query.frame[f], result.key[f]);
    if (at < 0)
        return;
    const size_t size = write_pair_result(ways, result, bytes);
    const bool early = ways & DELAYS && draw(20) == 0;
    if (early)
        write_event(ways, WIRE_PAIR_RESULT, bytes, size);
    log_query(ways, at, false, query_bytes, wire_write_pair_query(&query, query_bytes));
    if (!early)
        log_result(ways, at, false, bytes, size);
}

static void ask_scene(int ways, int64_t at, int client)
{
    static unsigned char bytes[QUERY_BYTES_MAX], query_bytes[QUERY_BYTES_MAX];
    static struct scene_query query;
    static struct scene_result result;
    memset(&query, 0, sizeof query);
    query.client_id = client;
    query.sequence_number = ++world.number[client];
    query.duration = 1;
    query.want = (int32_t) (draw(2) * QUERY_WANT_BOX | draw(2) * QUERY_WANT_TIMES);
    query.which = (int32_t) draw(3);
    query.frame_count = (int32_t) draw(6);
    query.split = query.which == QUERY_PAIRS_ACROSS ? query.frame_count / 2 : 0;
    for (int i = 0; i < query.frame_count; i++)
        query.frame[i] = draw_frame(client);
    for (int i = 1; query.which == QUERY_PAIRS_LISTED && i < query.frame_count; i++) {
        query.pair[query.index_count / 2][1] = (unsigned) i;
        query.index_count += 2;
    }
    answer_scene(&world.answerer, &query, &result);
    for (int i = 0; i < query.frame_count; i++)
        if (result.status == FMB_UNKNOWN_BODY && !result.key[i])
            forget(client, &query.frame[i]);
        else if (result.status == FMB_OK && result.key_count)
            heard(client, &query.frame[i], result.key[i]);
    if (at < 0)
        return;
    if (result.verdict_count > 0)
        flip(ways, &result.verdict[0]);
    result.compute_ns = (int64_t) draw(3000);
    log_query(ways, at, true, query_bytes, wire_write_scene_query(&query, query_bytes));
    log_result(ways, at, true, bytes, wire_write_scene_result(&result, bytes));
}

/* Those whose time has come. */
static void log_delayed(int ways, int64_t at)
{
    for (int i = 0; i < world.delayed_count; i++) {
        struct delayed delayed = world.delayed[i];
        if (delayed.at > at)
            continue;
        world.delayed[i--] = world.delayed[--world.delayed_count];
        write_event(ways, delayed.scene ? WIRE_SCENE_RESULT : WIRE_PAIR_RESULT, delayed.bytes,
                    delayed.size);
        free(delayed.bytes);
    }
}

static void make_log(int ways, int64_t queries)
{
    make_world();
    for (int64_t at = ways & BEGIN_LATE ? -100 : 0; at < queries; at++) {
        (draw(3) ? ask_pair : ask_scene)(ways, at, (int) draw(CLIENTS));
        log_delayed(ways, at);
    }
    log_delayed(ways, INT64_MAX);
    if (ways & DAMAGE && draw(2))
        recorded.size -= draw(40);
    end_world();
}

static void check_golden(void)
{
    char folder[] = "/tmp/test_replay_run.XXXXXX", golden[64];
    struct replay_options with = options();
    assert_non_null(mkdtemp(folder));
    snprintf(golden, sizeof golden, "%s/golden", folder);
    with.write_golden = golden;
    struct replay_report report = replay_report_in(&with, 1);
    assert_true(report.good);
    const int64_t queries = tally_queries(&report.tally);
    replay_report_free(&report);
    with.write_golden = NULL;
    with.golden = golden;
    report = replay_report_in(&with, 1);
    assert_true(report.good);
    expect_nothing(replay_report_odd(&report, (int64_t) recorded.size, true), "golden");
    assert_int_equal(tally_queries(&report.tally), queries);
    assert_int_equal(outcome(&report, REPLAY_SAME) + outcome(&report, REPLAY_UNKNOWN), queries);
    assert_int_equal(
        report.tally.channel[TALLY_PAIRS].results + report.tally.channel[TALLY_SCENES].results,
        queries);
    check_parts(&with, &report);
    replay_report_free(&report);
    unlink(golden);
    rmdir(folder);
}

/* Of several ranges of time what the whole has. */
static void check_ranges(const struct replay_report *whole)
{
    static const double ends[] = {-INFINITY, -0.01, 0.013, 0.02, 0.05, INFINITY};
    struct tally sum = {.events = 0};
    for (int i = 0; i < 5; i++) {
        struct replay_options with = options();
        with.from = ends[i];
        with.to = ends[i + 1];
        struct replay_report report = replay_report_in(&with, 1);
        if (i == 2)
            check_parts(&with, &report);
        tally_add(&sum, &report.tally);
        replay_report_free(&report);
    }
    for (int i = 0; i < TALLY_CHANNELS; i++) {
        const struct tally_channel *a = &sum.channel[i], *b = &whole->tally.channel[i];
        assert_int_equal(a->queries, b->queries);
        assert_int_equal(a->pairs, b->pairs);
        assert_int_equal(a->results, b->results);
        assert_int_equal(a->results_alone, b->results_alone);
        assert_memory_equal(a->outcome, b->outcome, sizeof a->outcome);
        assert_memory_equal(a->unreadable, b->unreadable, sizeof a->unreadable);
    }
}

static void check_ways(int ways)
{
    make_log(ways, 150);
    struct replay_report report = replay(!(ways & (REPEATS | SPOILED)));
    if (!(ways & (BEGIN_LATE | LOSSES | REPEATS | BUSY | SPOILED | DAMAGE | OTHER_UTIMES)))
        assert_int_equal(outcome(&report, REPLAY_DIFFERENT), world.flipped);
    if (!(ways & (FLIPS | SPOILED)))
        assert_int_equal(outcome(&report, REPLAY_DIFFERENT), 0);
    check_ranges(&report);
    if (!(ways & (REPEATS | SPOILED | DAMAGE)))
        check_golden();
    replay_report_free(&report);
    close_log();
}

static void test_worlds_spoiled_in_one_way(void **state)
{
    (void) state;
    check_ways(0);
    for (int way = 1; way < EVERYTHING; way *= 2)
        check_ways(way);
}

static void test_worlds_spoiled_in_many_ways(void **state)
{
    (void) state;
    for (int round = 0; round < (getenv("FMB_FAST") ? 3 : 12); round++)
        check_ways((int) draw(EVERYTHING + 1));
    check_ways(EVERYTHING);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_teardown(test_##name, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(nothing),
        TEST(a_clock_that_goes_back),
        TEST(differences_are_where_they_are),
        TEST(keys_that_are_explained_later),
        TEST(the_same_ids_and_keys_that_are_explained_later),
        TEST(keys_that_are_told_beside_unknown_ones),
        TEST(keys_beside_components),
        TEST(the_same_again_before_it_can_be_answered),
        TEST(two_results),
        TEST(a_query_that_cannot_be_read),
        TEST(a_result_that_cannot_be_read),
        TEST(queries_beyond_all_limits),
        TEST(times_that_cannot_be),
        TEST(worlds_spoiled_in_one_way),
        TEST(worlds_spoiled_in_many_ways),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
