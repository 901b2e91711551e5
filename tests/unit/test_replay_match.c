/* Queries and results brought together: near each other, and so far apart that they have to go
 * through temporary files; against a naive model; and when temporary files fail. */
#include "match.h"
#include "recent.h"
#include "spill.h"

#include "log_read.h"

#include <errno.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include <cmocka.h>

/* ---- A stream of queries and results, and what became of each ---- */

struct event {
    bool is_result;
    struct match_item item;
};

struct fate {
    int both, alone;  /* how often it was told so */
    int64_t partner;  /* of a result: the number of its query; -1: none */
    int64_t told_at;  /* of a result: after so many events */
    int results_good; /* of a query: results that came with both */
};

enum { EVENTS_MAX = 400000 };

static struct {
    struct event *event; /* [count]; the place's number is the index */
    int64_t count, given;
    struct fate *fate; /* [count] */
    int64_t wrong;     /* items that were not what was put */
} stream;

/* Bytes are cut from here, so that each byte of one tells where it is from. */
static unsigned char noise[2 * LOG_DATA_MAX];

static int set_up(void **state)
{
    (void) state;
    srand(1);
    for (size_t i = 0; i < sizeof noise; i++)
        noise[i] = (unsigned char) (rand() >> 8);
    memset(&stream, 0, sizeof stream);
    stream.event = calloc(EVENTS_MAX, sizeof *stream.event);
    stream.fate = calloc(EVENTS_MAX, sizeof *stream.fate);
    return stream.event && stream.fate ? 0 : -1;
}

static int tear_down(void **state)
{
    (void) state;
    free(stream.event);
    free(stream.fate);
    return 0;
}

static struct match_item *add(bool is_result, struct query_header ids, uint32_t size)
{
    assert_true(stream.count < EVENTS_MAX);
    struct event *event = &stream.event[stream.count];
    *event = (struct event){.is_result = is_result,
                            .item = {.ids = ids,
                                     .kind = LOG_PAIR_QUERY,
                                     .place = {.log = (int32_t) (stream.count % 3),
                                               .mine = true,
                                               .number = stream.count,
                                               .offset = 100 * stream.count,
                                               .utime = -stream.count},
                                     .size = size,
                                     .bytes = noise + stream.count % LOG_DATA_MAX}};
    stream.count++;
    return &event->item;
}

static struct match_item *add_query(int64_t client_id, int64_t sequence_number, int64_t utime)
{
    struct match_item *item = add(false, (struct query_header){utime, client_id, sequence_number},
                                  100 + (uint32_t) (stream.count % 50));
    item->more = noise + (stream.count * 7) % LOG_DATA_MAX;
    item->more_size = 60 + (uint32_t) (stream.count % 7);
    return item;
}

static struct match_item *add_result(int64_t client_id, int64_t sequence_number, int64_t utime)
{
    return add(true, (struct query_header){utime, client_id, sequence_number},
               60 + (uint32_t) (stream.count % 11));
}

/* ---- What is told ---- */

static bool same_item(const struct match_item *a, const struct match_item *b)
{
    return a->kind == b->kind && a->ids.utime == b->ids.utime &&
           a->ids.client_id == b->ids.client_id &&
           a->ids.sequence_number == b->ids.sequence_number && a->place.log == b->place.log &&
           a->place.mine == b->place.mine && a->place.offset == b->place.offset &&
           a->place.utime == b->place.utime && a->size == b->size && a->more_size == b->more_size &&
           memcmp(a->bytes, b->bytes, a->size) == 0 &&
           (a->more_size == 0 || memcmp(a->more, b->more, a->more_size) == 0);
}

/* Its number; -1: it is nothing that was put. */
static int64_t number_of(const struct match_item *item, bool is_result)
{
    const int64_t number = item->place.number;
    if (number >= 0 && number < stream.given && stream.event[number].is_result == is_result &&
        same_item(item, &stream.event[number].item))
        return number;
    stream.wrong++;
    return -1;
}

static void on_both(void *user, const struct match_item *query, const struct match_item *result)
{
    const int64_t q = number_of(query, false), r = number_of(result, true);
    (void) user;
    if (q < 0 || r < 0)
        return;
    if (query->kind != result->kind || query->ids.client_id != result->ids.client_id ||
        query->ids.sequence_number != result->ids.sequence_number)
        stream.wrong++;
    stream.fate[q].both++;
    stream.fate[r].both++;
    stream.fate[r].partner = q;
    stream.fate[r].told_at = stream.given;
}

static void on_query_alone(void *user, const struct match_item *query)
{
    const int64_t q = number_of(query, false);
    (void) user;
    if (q >= 0)
        stream.fate[q].alone++;
}

static void on_result_alone(void *user, const struct match_item *result)
{
    const int64_t r = number_of(result, true);
    (void) user;
    if (r >= 0)
        stream.fate[r].alone++;
}

static const struct match_sink sink = {on_both, on_query_alone, on_result_alone, NULL};

static void give(struct match *match, int64_t i)
{
    stream.fate[i] = (struct fate){.partner = -1};
    stream.given = i + 1;
    (stream.event[i].is_result ? match_result : match_query)(match, &stream.event[i].item);
}

/* Whatever the stream: each result is told once, each query is alone or has results. */
static void check_fates(void)
{
    int64_t odd = 0;
    for (int64_t i = 0; i < stream.count; i++) {
        const struct fate *fate = &stream.fate[i];
        odd += stream.event[i].is_result ? fate->both + fate->alone != 1
                                         : (fate->both > 0) + fate->alone != 1;
    }
    assert_int_equal(stream.wrong, 0);
    assert_int_equal(odd, 0);
}

static void run(void)
{
    struct match *match = match_open(&sink);
    for (int64_t i = 0; i < stream.count; i++)
        give(match, i);
    assert_true(match_finish(match));
    match_close(match);
    check_fates();
}

static int64_t partner_of(int64_t result)
{
    return stream.fate[result].partner;
}

static void expect_partners(const int64_t *partner, int64_t count)
{
    assert_int_equal(count, stream.count);
    for (int64_t i = 0; i < count; i++)
        if (stream.event[i].is_result && partner_of(i) != partner[i])
            fail_msg("result %d went to %d, not to %d", (int) i, (int) partner_of(i),
                     (int) partner[i]);
}

#define EXPECT_PARTNERS(...)                                                       \
    do {                                                                           \
        const int64_t expected[] = {__VA_ARGS__};                                  \
        expect_partners(expected, (int64_t) (sizeof expected / sizeof *expected)); \
    } while (0)

/* Of queries, in EXPECT_PARTNERS(). */
enum { Q = -2 };

/* ---- A few ---- */

static void test_a_result_goes_to_its_query(void **state)
{
    (void) state;
    add_query(1, 1, 5);
    add_query(1, 2, 5);
    add_query(2, 1, 5);
    add_result(2, 1, 5);
    add_result(1, 2, 5);
    add_result(1, 1, 5);
    add_result(3, 1, 5); /* of nobody */
    add_query(4, 1, 5);  /* of no result */
    run();
    EXPECT_PARTNERS(Q, Q, Q, 2, 1, 0, -1, Q);
    assert_int_equal(stream.fate[6].alone, 1);
    assert_int_equal(stream.fate[7].alone, 1);
    for (int r = 3; r <= 5; r++) /* at once */
        assert_int_equal(stream.fate[r].told_at, r + 1);
}

static void test_a_result_may_come_first(void **state)
{
    (void) state;
    add_result(1, 1, 5);
    add_result(1, 2, 5);
    add_query(1, 2, 5);
    add_query(1, 1, 5);
    run();
    EXPECT_PARTNERS(3, 2, Q, Q);
    assert_int_equal(stream.fate[1].told_at, 3);
}

static void test_pairs_and_scenes_are_apart(void **state)
{
    (void) state;
    add_query(1, 1, 5);
    add_query(1, 1, 5)->kind = LOG_SCENE_QUERY;
    add_result(1, 1, 5)->kind = LOG_SCENE_QUERY;
    add_result(1, 1, 5);
    add_result(1, 2, 5)->kind = LOG_SCENE_QUERY;
    add_query(1, 2, 5);
    run();
    EXPECT_PARTNERS(Q, Q, 1, 0, -1, Q);
}

/* Two services, or a result that was delivered twice. */
static void test_a_result_that_comes_again(void **state)
{
    (void) state;
    add_query(1, 1, 5);
    add_result(1, 1, 5);
    add_result(1, 1, 5);
    add_result(1, 2, 5);
    add_result(1, 2, 5);
    add_query(1, 2, 5);
    add_result(1, 2, 5);
    run();
    EXPECT_PARTNERS(Q, 0, 0, 5, 5, Q, 5);
}

/* The same number again asks the same query again: each of the two gets a result. */
static void test_a_query_that_comes_again(void **state)
{
    (void) state;
    add_query(1, 1, 5);
    add_query(1, 1, 5);
    add_result(1, 1, 5);
    add_result(1, 1, 5);
    add_query(1, 1, 5);
    add_result(1, 1, 5);
    run();
    EXPECT_PARTNERS(Q, Q, 0, 1, Q, 4);
}

static void test_results_that_come_first_go_to_one_query_each(void **state)
{
    (void) state;
    add_result(1, 1, 5);
    add_result(1, 1, 5);
    add_query(1, 1, 5);
    add_query(1, 1, 5);
    run();
    EXPECT_PARTNERS(2, 3, Q, Q);
}

static void test_utime_chooses(void **state)
{
    (void) state;
    add_query(1, 1, 5);
    add_query(1, 1, 6);
    add_result(1, 1, 6);
    add_result(1, 1, 5);
    add_query(2, 1, 5);
    add_result(2, 1, 7); /* not echoed as it was */
    add_query(3, 1, 5);
    add_query(3, 1, 6);
    add_result(3, 1, 6);
    add_result(3, 1, 7);
    run();
    EXPECT_PARTNERS(Q, Q, 1, 0, Q, 4, Q, Q, 7, 6);
}

/* A log may say any numbers: sums of them may overflow. */
static void test_any_ids(void **state)
{
    static const int64_t any[] = {INT64_MIN,     INT64_MIN + 1, -1,       0, 1,
                                  INT64_MAX - 1, INT64_MAX - 2, INT64_MAX};
    enum { ANY = sizeof any / sizeof *any, ALL = ANY * ANY * ANY };
    (void) state;
    for (int round = 0; round < 2; round++)
        for (int i = 0; i < ALL; i++) {
            const int64_t a = any[i % ANY], b = any[i / ANY % ANY], c = any[i / ANY / ANY];
            (round ? add_result(a, b, c) : add_query(a, b, c))->kind =
                i % 2 ? LOG_SCENE_QUERY : LOG_PAIR_QUERY;
        }
    run();
    for (int i = 0; i < ALL; i++)
        assert_int_equal(partner_of(ALL + i), i);
    stream.count = 0; /* and through the files */
    for (int i = 0; i < ANY * ANY; i++)
        add_query(any[i % ANY], any[i / ANY], 5)->kind = LOG_SCENE_QUERY;
    for (int i = 0; i < ANY * ANY; i++)
        add_result(any[i % ANY], any[i / ANY], INT64_MIN)->kind = LOG_SCENE_QUERY;
    run();
    for (int i = 0; i < ANY * ANY; i++)
        assert_int_equal(partner_of(ANY * ANY + i), i);
}

static void test_of_nothing(void **state)
{
    (void) state;
    run();
    struct match *match = match_open(&sink);
    match_close(match); /* without an end */
    match_close(NULL);
}

/* ---- Who waits ---- */

static int64_t open_after(struct match *match, int64_t i)
{
    give(match, i);
    return match_open_count(match);
}

static void test_counts_what_is_mine_and_may_be_told_of(void **state)
{
    (void) state;
    add_query(1, 1, 5);
    add_query(1, 2, 5)->place.mine = false;
    add_result(1, 2, 5);
    add_result(1, 1, 5)->place.mine = false; /* there may be another one */
    add_result(1, 3, 5);
    add_result(1, 4, 5)->place.mine = false;
    add_query(1, 4, 5);
    add_query(1, 3, 5)->place.mine = false;
    struct match *match = match_open(&sink);
    static const int64_t open[] = {1, 1, 1, 1, 2, 2, 3, 2};
    for (int64_t i = 0; i < 8; i++)
        assert_int_equal(open_after(match, i), open[i]);
    for (int i = 0; i < 300; i++) { /* what pushes them out of memory */
        struct match_item *query = add_query(2, i, 5);
        query->size = LOG_DATA_MAX;
        query->place.mine = false;
        give(match, stream.count - 1);
    }
    assert_int_equal(match_open_count(match), 0);
    add_query(1, 5, 5);
    assert_int_equal(open_after(match, stream.count - 1), 1);
    for (int i = 0; i < 300; i++) {
        struct match_item *query = add_query(2, i, 5);
        query->size = LOG_DATA_MAX;
        query->place.mine = false;
        give(match, stream.count - 1);
    }
    assert_int_equal(match_open_count(match), 1);
    assert_true(match_finish(match));
    match_close(match);
    check_fates();
}

/* ---- Many, far apart ---- */

static uint64_t drawn;

static uint64_t draw(uint64_t below)
{
    drawn = drawn * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (drawn >> 33) % below;
}

struct turn {
    int64_t at; /* where in the stream it is to stand */
    int64_t pair;
    bool is_result;
};

static int compare_turns(const void *left, const void *right)
{
    const struct turn *a = left, *b = right;
    return a->at < b->at ? -1 : a->at > b->at;
}

/* Delays: of most a few events, of some as long as the stream; of a few backwards. */
static int64_t draw_delay(int64_t pairs)
{
    switch (draw(8)) {
    case 0: return (int64_t) draw((uint64_t) (4 * pairs)) + 2;
    case 1: return -(int64_t) draw((uint64_t) (2 * pairs)) - 2;
    case 2: return -(int64_t) draw(9) - 2;
    default: return (int64_t) draw(60) + 2;
    }
}

static uint32_t draw_size(void)
{
    switch (draw(20)) {
    case 0: return LOG_DATA_MAX;
    case 1: return LOG_DATA_MAX - (uint32_t) draw(20);
    case 2: return (uint32_t) draw(LOG_DATA_MAX) + 1;
    default: return (uint32_t) draw(400) + 32;
    }
}

/* Of pairs whose ids nobody else has: then it is clear what belongs together. A few clients, and
 * the same numbers again at other times. */
static struct query_header ids_of(int64_t pair)
{
    return (struct query_header){pair / 5000, pair % 7, pair % 5000};
}

static void add_drawn(const struct turn *turn)
{
    struct match_item *item = add(turn->is_result, ids_of(turn->pair), draw_size());
    item->kind = turn->pair % 3 ? LOG_PAIR_QUERY : LOG_SCENE_QUERY;
    if (turn->is_result)
        return;
    item->more_size = draw(4) ? draw_size() : 0;
    item->more = item->more_size ? noise + draw(LOG_DATA_MAX) : NULL;
}

/* What has only one of the two: every 50th pair no result, every 50th no query. */
static void draw_stream(int64_t pairs)
{
    struct turn *turn = calloc((size_t) (2 * pairs), sizeof *turn);
    int64_t turns = 0;
    assert_non_null(turn);
    for (int64_t pair = 0; pair < pairs; pair++) {
        if (pair % 50 != 0)
            turn[turns++] = (struct turn){4 * pair, pair, false};
        if (pair % 50 != 1)
            turn[turns++] = (struct turn){4 * pair + draw_delay(pairs), pair, true};
    }
    qsort(turn, (size_t) turns, sizeof *turn, compare_turns);
    for (int64_t i = 0; i < turns; i++)
        add_drawn(&turn[i]);
    free(turn);
}

static bool same_ids(const struct match_item *a, const struct match_item *b)
{
    return a->kind == b->kind && a->ids.client_id == b->ids.client_id &&
           a->ids.sequence_number == b->ids.sequence_number && a->ids.utime == b->ids.utime;
}

/* The model: looks at all. */
static int64_t find_query(const struct match_item *result)
{
    for (int64_t i = 0; i < stream.count; i++)
        if (!stream.event[i].is_result && same_ids(&stream.event[i].item, result))
            return i;
    return -1;
}

static void test_delays_beyond_what_is_in_memory(void **state)
{
    int64_t bytes = 0, soon = 0, far = 0;
    (void) state;
    drawn = 1;
    draw_stream(6000);
    run();
    for (int64_t i = 0; i < stream.count; i++) {
        const struct match_item *item = &stream.event[i].item;
        bytes += item->size + item->more_size;
        if (!stream.event[i].is_result)
            continue;
        const int64_t query = find_query(item);
        assert_int_equal(partner_of(i), query);
        soon += query >= 0 && stream.fate[i].told_at < stream.count;
        far += query >= 0 && stream.fate[i].told_at == stream.count;
    }
    assert_true(bytes > 64 << 20);      /* many times what is in memory */
    assert_in_range(soon, 500, 100000); /* both ways of bringing together were gone */
    assert_in_range(far, 500, 100000);
}

/* Three megabytes under way, some of it long, wherever the ring of what is in memory has come to
 * before: with items that were matched long ago, and then suddenly none. */
static void add_much(int64_t before, bool results_first)
{
    enum { WAIT = 9000 };
    for (int64_t i = 0; i < before; i++) {
        add_query(1, i, 0);
        add_result(1, i, 0);
    }
    for (int64_t i = 0; i < WAIT; i++) {
        struct match_item *item = results_first ? add_result(2, i, 0) : add_query(2, i, 0);
        if (i % 100 == 0)
            item->size = 10000;
    }
    for (int64_t i = 0; i < WAIT; i++)
        if (results_first)
            add_query(2, i * 7 % WAIT, 0);
        else
            add_result(2, i * 7 % WAIT, 0);
}

static void test_what_waits_is_in_memory(void **state)
{
    (void) state;
    for (int64_t before = 0; before < 16000; before += 1237)
        for (int first = 0; first < 2; first++) {
            stream.count = 0;
            add_much(before, first);
            run();
            for (int64_t i = 0; i < stream.count; i++) {
                assert_int_equal(stream.fate[i].both, 1);
                if (stream.event[i].is_result)
                    assert_int_equal(stream.fate[i].told_at,
                                     1 + (stream.fate[i].partner > i ? stream.fate[i].partner : i));
            }
        }
}

/* Not even the longest items, one after the other, push out what has just come. */
static void test_the_longest(void **state)
{
    (void) state;
    for (int i = 0; i < 700; i++) {
        struct match_item *query =
            add(false, (struct query_header){1, 1, i < 400 ? i : 10000}, LOG_DATA_MAX);
        query->more = noise;
        query->more_size = LOG_DATA_MAX;
        add(true, (struct query_header){1, 1, i < 400 ? 399 - i : 10000}, LOG_DATA_MAX);
    }
    run();
    for (int i = 0; i < 400; i++)
        assert_int_equal(partner_of(2 * i + 1), 2 * (399 - i));
    for (int i = 400; i < 700; i++)
        assert_int_equal(partner_of(2 * i + 1), 2 * i);
}

/* ---- The same ids for everything: a client that never counts ---- */

enum { MANY = 100000 };

static void expect_one_each(void)
{
    for (int64_t i = 0; i < stream.count; i++)
        assert_int_equal(stream.fate[i].both, 1);
}

static void test_the_same_ids_one_by_one(void **state)
{
    (void) state;
    for (int i = 0; i < MANY; i++) {
        add_query(0, 0, 0);
        add_result(0, 0, 0);
    }
    run();
    for (int i = 0; i < MANY; i++)
        assert_int_equal(partner_of(2 * i + 1), 2 * i);
}

static void test_the_same_ids_a_few_under_way(void **state)
{
    (void) state;
    for (int i = 0; i < MANY + 5000; i++) {
        if (i < MANY)
            add_query(0, 0, 0);
        if (i >= 5000)
            add_result(0, 0, 0);
    }
    run();
    expect_one_each();
}

static void add_same(bool results, int64_t utime)
{
    for (int i = 0; i < MANY; i++)
        if (results)
            add_result(0, 0, utime);
        else
            add_query(0, 0, utime);
}

/* Most of them through the files. */
static void test_the_same_ids_far_apart(void **state)
{
    (void) state;
    for (int first = 0; first < 2; first++) {
        stream.count = 0;
        add_same(first, 0);
        add_same(!first, 1);
        run();
        expect_one_each();
        stream.count = 0;
        add_same(first, 0);
        add_same(!first, 0);
        run(); /* some get more than one, the latest: those of others are in the files already */
    }
}

static void test_the_same_number_at_many_times(void **state)
{
    (void) state;
    for (int64_t i = 0; i < 2 * MANY; i++)
        if (i < MANY)
            add_query(0, 0, i);
        else
            add_result(0, 0, (i - MANY) * 7 % MANY);
    run();
    for (int64_t i = MANY; i < 2 * MANY; i++)
        assert_int_equal(partner_of(i), (i - MANY) * 7 % MANY);
}

static void test_the_same_ids_and_no_result(void **state)
{
    (void) state;
    add_same(false, 0);
    add_result(0, 0, 1);
    run();
    assert_int_equal(stream.fate[MANY].both, 1);
}

/* More results than queries: the rest goes to the last one. */
static void test_the_same_ids_and_results_too_many(void **state)
{
    (void) state;
    add_query(0, 0, 1);
    add_query(0, 0, 2);
    add_same(true, 3);
    run();
    assert_int_equal(stream.fate[0].both, 1);
    assert_int_equal(stream.fate[1].both, MANY - 1);
}

/* ---- Temporary files that fail ---- */

static void add_apart(void)
{
    for (int i = 0; i < 300; i++) {
        add_query(1, i, 5);
        add_result(2, i, 5);
    }
}

static bool run_bad(int *error)
{
    struct match *match = match_open(&sink);
    for (int64_t i = 0; i < stream.count; i++)
        give(match, i);
    const bool good = match_finish(match);
    *error = errno;
    match_close(match);
    return good;
}

static void test_no_place_for_temporary_files(void **state)
{
    int error;
    (void) state;
    setenv("TMPDIR", "/nowhere/at/all", 1);
    add_apart();
    assert_false(run_bad(&error));
    assert_int_equal(error, ENOENT);
    stream.count = 0; /* that needs none */
    for (int i = 0; i < 300; i++) {
        add_query(1, i, 5);
        add_result(1, i, 5);
    }
    assert_true(run_bad(&error));
    unsetenv("TMPDIR");
}

/* As where the disk is full: what is written last is only refused when it leaves the buffer. */
static void test_temporary_files_that_are_full(void **state)
{
    static const rlim_t room[] = {0, 100, 4096, 10000};
    struct rlimit before, limit;
    int error;
    (void) state;
    signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before);
    for (size_t i = 0; i < sizeof room / sizeof *room; i++)
        for (int large = 0; large < 2; large++) {
            stream.count = 0;
            for (int k = 0; k < (large ? 300 : 6400); k++) /* several in each file */
                add_query(1, k, 5)->size = large ? 10000 : 32;
            for (int k = 0; k < (large ? 300 : 6400); k++)
                add_result(2, k, 5)->size = large ? 10000 : 32;
            limit = (struct rlimit){room[i], before.rlim_max};
            setrlimit(RLIMIT_FSIZE, &limit);
            const bool good = run_bad(&error);
            setrlimit(RLIMIT_FSIZE, &before);
            assert_false(good);
            assert_int_equal(error, EFBIG);
        }
    signal(SIGXFSZ, SIG_DFL);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(test_##name, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(a_result_goes_to_its_query),
        TEST(a_result_may_come_first),
        TEST(pairs_and_scenes_are_apart),
        TEST(a_result_that_comes_again),
        TEST(a_query_that_comes_again),
        TEST(results_that_come_first_go_to_one_query_each),
        TEST(utime_chooses),
        TEST(any_ids),
        TEST(of_nothing),
        TEST(counts_what_is_mine_and_may_be_told_of),
        TEST(delays_beyond_what_is_in_memory),
        TEST(what_waits_is_in_memory),
        TEST(the_longest),
        TEST(the_same_ids_one_by_one),
        TEST(the_same_ids_a_few_under_way),
        TEST(the_same_ids_far_apart),
        TEST(the_same_number_at_many_times),
        TEST(the_same_ids_and_no_result),
        TEST(the_same_ids_and_results_too_many),
        TEST(no_place_for_temporary_files),
        TEST(temporary_files_that_are_full),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
