/* The request engine over a simulated network with loss and delay, and with a simulated clock.
 * Every run is the same on any machine. */
#include "unit.h"

#include "clock.h"
#include "query.h"
#include "request.h"
#include "scene_run.h"

static const int64_t us = 1000, ms = 1000000, s = 1000000000; /* nanoseconds */

/* ---- The clock, in place of the product's ---- */

static int64_t now;

int64_t clock_ns(void)
{
    return now += 20; /* as long as reading it takes */
}

int64_t clock_utime(void)
{
    return clock_ns() / 1000;
}

int clock_left_ms(int64_t until_ns)
{
    return until_ns > now ? (int) ((until_ns - now + 999999) / 1000000) : 0;
}

/* ---- The network ---- */

enum { RESULTS_MAX = 1 << 16, SENDINGS_MAX = 256, QUERY_SIZE = 400, SEND_NS = 2000 };

struct passage {
    int64_t time, number;
};

/* A service that answers one query after the other, in the order of their arrival. */
static struct network {
    double loss, late;  /* share of datagrams lost each way; share of results that are late */
    int64_t delay, lag; /* of each datagram; of late results in addition */
    int64_t service;    /* time that the service takes for a query */
    int64_t free_at;    /* time at which the service has answered all queries */
    int status;         /* of its results */
    uint64_t lost;      /* the datagram from the client that is lost, counted from 1; 0: none */
    bool drops_repeats; /* the service drops a query that has the number of the one before */
    uint64_t random;
    uint64_t sent, waits; /* datagrams from the client; calls of wait() */
    struct passage sending[SENDINGS_MAX];
    size_t first, count; /* results on their way, in the order of their arrival */
    struct passage result[RESULTS_MAX];
    struct requests requests;
} net;

static bool draw(double share)
{
    net.random ^= net.random << 13;
    net.random ^= net.random >> 7;
    net.random ^= net.random << 17;
    return (double) (net.random >> 11) * 0x1p-53 < share;
}

static void add_result(struct passage arrival)
{
    assert_true(net.count < RESULTS_MAX);
    size_t i = net.first + net.count++;
    for (; i > net.first && net.result[(i - 1) % RESULTS_MAX].time > arrival.time; i--)
        net.result[i % RESULTS_MAX] = net.result[(i - 1) % RESULTS_MAX];
    net.result[i % RESULTS_MAX] = arrival;
}

static bool publish(void *user, enum fmb_client_kind kind, const unsigned char *query, size_t size)
{
    (void) user, (void) kind, (void) size;
    int64_t number = 0;
    for (int i = 0; i < 8; i++)
        number = number << 8 | query[REQUEST_IDS_END - 8 + i];
    const int64_t before = net.sending[(net.sent - 1) % SENDINGS_MAX].number;
    const bool dropped = net.drops_repeats && net.sent > 0 && number == before;
    now += SEND_NS;
    net.sending[net.sent++ % SENDINGS_MAX] = (struct passage){now, number};
    if (draw(net.loss) || net.sent == net.lost || dropped)
        return true;
    const int64_t arrival = now + net.delay;
    net.free_at = (arrival > net.free_at ? arrival : net.free_at) + net.service;
    if (draw(net.loss))
        return true;
    const int64_t lag = draw(net.late) ? net.lag : 0;
    add_result((struct passage){net.free_at + net.delay + lag, number});
    return true;
}

static void wait_for_result(void *user, int other_fd, int timeout_ms)
{
    (void) user, (void) other_fd;
    const int64_t until = now + timeout_ms * ms;
    const int64_t next = net.count > 0 ? net.result[net.first].time : INT64_MAX;
    net.waits++;
    if (next > now)
        now = next < until ? next : until;
}

static bool receive(void *user)
{
    (void) user;
    while (net.count > 0 && net.result[net.first].time <= now) {
        const struct request_result result = {.kind = FMB_CLIENT_DEFINITION,
                                              .status = net.status,
                                              .detail = "",
                                              .bytes = (const unsigned char *) "",
                                              .number = net.result[net.first].number};
        net.first = (net.first + 1) % RESULTS_MAX;
        net.count--;
        requests_take(&net.requests, &result);
    }
    return true;
}

static void open_network(double loss, int64_t delay, int64_t service)
{
    memset(&net, 0, sizeof net);
    net.loss = loss;
    net.delay = delay;
    net.service = service;
    net.random = 88172645463325252;
    net.requests.transport = (struct request_transport){NULL, publish, wait_for_result, receive};
    net.requests.timeout_ns = s / 2; /* the defaults */
    net.requests.tries = 6;
    requests_forget_pace(&net.requests);
}

/* ---- A client ---- */

enum { TIMES_MAX = 1 << 20 };

static struct load {
    int64_t queries, answers, given_up;
    bool ended[FMB_CLIENT_RAW_WINDOW];
    int64_t sent_at[FMB_CLIENT_RAW_WINDOW]; /* [query % FMB_CLIENT_RAW_WINDOW] */
    int64_t time[TIMES_MAX];                /* of the answers, from the first sending */
} load;

static enum request_taken take(void *user, struct request *request,
                               const struct request_result *result)
{
    const size_t slot = (size_t) ((int64_t *) user - load.sent_at);
    (void) request;
    load.ended[slot] = true;
    if (result->status < 0)
        load.given_up++;
    else
        load.time[load.answers++ % TIMES_MAX] = now - load.sent_at[slot];
    return REQUEST_COMPLETE;
}

/* Sends queries for `duration`. At most `window` queries, counted from the oldest one without a
 * result, are under way, as for the parts of a scene. */
static void query_for(int64_t duration, int window)
{
    const int64_t end = now + duration;
    int64_t oldest = 0;
    memset(&load, 0, sizeof load);
    while (now < end) {
        while (oldest < load.queries && load.ended[oldest % FMB_CLIENT_RAW_WINDOW])
            oldest++;
        for (; load.queries - oldest < window; load.queries++) {
            const int64_t slot = load.queries % FMB_CLIENT_RAW_WINDOW;
            struct request *request = request_begin(&net.requests, FMB_CLIENT_DEFINITION,
                                                    QUERY_SIZE, take, &load.sent_at[slot]);
            request->size = QUERY_SIZE;
            load.ended[slot] = false;
            load.sent_at[slot] = now;
            request_send(&net.requests, request);
        }
        requests_step(&net.requests, -1, INT64_MAX);
    }
}

static int compare(const void *a, const void *b)
{
    const int64_t p = *(const int64_t *) a, q = *(const int64_t *) b;
    return (p > q) - (p < q);
}

static int64_t median(void)
{
    const int64_t count = load.answers < TIMES_MAX ? load.answers : TIMES_MAX;
    qsort(load.time, (size_t) count, sizeof *load.time, compare);
    return load.time[count / 2];
}

/* ---- Loss ---- */

static const double heavy_loss = 0.3;

/* Half of the queries, or their results, are lost, so that an answer takes 2.04 datagrams. With
 * delay each loss costs a round trip, and the window waits for its oldest query. */
static void a_full_window_keeps_a_share_of_its_rate_under_loss(void **state)
{
    static const struct {
        int64_t delay_ms;
        int tries;
        double share;
    } network[] = {{0, 6, 0.3}, {20, 60, 0.1}, {100, 60, 0.1}};
    for (size_t i = 0; i < COUNT(network); i++) {
        open_network(0, network[i].delay_ms * ms, 100 * us);
        query_for(60 * s, FMB_CLIENT_RAW_WINDOW);
        const int64_t without = load.answers;
        open_network(heavy_loss, network[i].delay_ms * ms, 100 * us);
        net.requests.tries = network[i].tries;
        query_for(60 * s, FMB_CLIENT_RAW_WINDOW);
        assert_true((double) load.answers > network[i].share * (double) without);
        assert_true((double) net.sent < 3 * (double) load.answers);
        assert_int_equal(load.given_up, 0);
    }
}

static void a_lost_single_query_is_repeated_soon(void **state)
{
    open_network(heavy_loss, 0, 100 * us);
    query_for(60 * s, 1);
    assert_true(median() < 20 * ms);
    assert_true(load.answers > 60 * s / (30 * ms));
    assert_true((double) net.sent < 3 * (double) load.answers);
    assert_int_equal(load.given_up, 0);
}

/* A query is repeated with the same number, twice soon, then after intervals that double. So a lost
 * datagram costs milliseconds, and a slow service is not flooded. */
static void a_lost_query_is_repeated_soon_and_then_more_rarely(void **state)
{
    int64_t intervals[SENDINGS_MAX];
    open_network(0, 0, 100 * us);
    net.requests.tries = 2;
    query_for(10 * ms, 1);
    assert_int_equal(net.requests.counts.repeated, 0);
    net.loss = 1;
    const struct passage *at = &net.sending[net.sent];
    const int before = (int) net.sent;
    query_for(s, 1);
    const int count = (int) net.sent - before;
    assert_true(net.sent < SENDINGS_MAX);
    assert_in_range(count, 5, 10);
    for (int i = 1; i < count; i++) {
        assert_int_equal(at[i].number, at[0].number);
        intervals[i] = at[i].time - at[i - 1].time;
        if (i <= 2)
            assert_in_range(intervals[i], ms, 20 * ms);
        else
            assert_in_range(intervals[i], 2 * intervals[i - 1] - 2 * ms, 2 * intervals[i - 1] + ms);
    }
    assert_int_equal(load.given_up, 1);
}

/* A wait does not end before a deadline or a result: the client does not spin. */
static void a_wait_lasts_until_something_is_due(void **state)
{
    open_network(heavy_loss, 0, 100 * us);
    query_for(10 * s, 1);
    assert_true(net.waits < 4 * net.sent);
}

/* ---- Order ---- */

/* One result in five comes after those of some later queries. Fewer than that are repeated. */
static void reordered_results_cause_few_repeats(void **state)
{
    open_network(0, 0, 100 * us);
    net.late = 0.2;
    net.lag = ms / 2;
    query_for(20 * s, FMB_CLIENT_RAW_WINDOW);
    assert_true((double) net.sent < 1.2 * (double) load.answers);
}

/* A few queries take long, such as pairs of bodies of many frames; later ones are answered before
 * them. They are repeated once immediately, and then at intervals that double. */
static void slow_queries_that_are_overtaken_back_off(void **state)
{
    open_network(0, 0, 100 * us);
    net.late = 0.002;
    net.lag = 200 * ms;
    query_for(60 * s, FMB_CLIENT_RAW_WINDOW);
    const double slow = net.late * (double) net.sent;
    assert_true(load.answers > 10000);
    assert_true((double) net.requests.counts.repeated < 8 * slow);
}

/* A slow service, which stops for a while at first, has not reached most queries: only the oldest
 * of the waiting queries is repeated. A lost query is repeated once later queries have their
 * results, not only when nothing else is left of the window. */
static void queries_in_line_are_not_repeated(void **state)
{
    open_network(0, 0, 3 * ms);
    net.requests.timeout_ns = 5 * s;
    net.free_at = now + 100 * ms;
    net.lost = 3;
    query_for(550 * ms, FMB_CLIENT_RAW_WINDOW);
    assert_true(load.answers >= 140 && net.sent < SENDINGS_MAX);
    assert_in_range(net.requests.counts.repeated, 1, 30);
    int again = 3;
    while (net.sending[again].number != net.sending[2].number)
        again++;
    assert_true(again < FMB_CLIENT_RAW_WINDOW + 16);
}

/* ---- Delay ---- */

/* The service takes 85 ms for each query, so that the first is repeated after 10, 30 and 70. The
 * time from the last repeat to its result is not the time that the service takes: a client that
 * measured it would go on to repeat. */
static void a_slow_service_gets_repeats_at_first_only(void **state)
{
    open_network(0, 0, 85 * ms);
    net.requests.timeout_ns = 5 * s;
    net.drops_repeats = true;
    query_for(20 * 86 * ms, 1);
    assert_in_range(load.answers, 19, 21);
    assert_in_range(net.requests.counts.repeated, 1, 10);
}

/* When the network becomes slow, at first every query is repeated before its result comes. */
static void the_interval_adapts_to_a_longer_delay(void **state)
{
    for (int lossy = 0; lossy < 2; lossy++) {
        open_network(0, 0, 100 * us);
        query_for(s, 1);
        assert_int_equal(net.requests.counts.repeated, 0);
        net.loss = lossy ? heavy_loss : 0;
        net.delay = 100 * ms;
        net.requests.tries = 60;
        query_for(20 * s, 1);
        const uint64_t before = net.requests.counts.repeated;
        query_for(60 * s, 1);
        if (lossy)
            assert_true(load.answers > 100);
        else
            assert_int_equal(net.requests.counts.repeated, before);
        assert_int_equal(load.given_up, 0);
    }
}

/* ---- A busy service ---- */

/* A busy service is queried for a minute, at growing intervals, whatever the timeout is. */
static void a_busy_service_is_queried_for_a_minute(void **state)
{
    open_network(0, 0, 100 * us);
    net.status = FMB_BUSY;
    query_for(70 * s, 1);
    assert_int_equal(load.answers, 1);
    assert_int_equal(load.given_up, 0);
    assert_true(load.time[0] > 60 * s);
    assert_true(net.sent < 300);
}

/* ---- The end of a scene ---- */

static void count_statuses(void *user, const struct fmb_client_answer *answer)
{
    int *count = user; /* [-status] */
    assert_in_range(-answer->status, 0, 7);
    count[-answer->status]++;
}

/* If the requests are given up and the time for the scene ends in the same step, the status is that
 * there is no service. */
static void no_service_takes_precedence_over_late(void **state)
{
    enum { PAIRS = 3000 };
    static struct scene_run run;
    static struct held held;
    static unsigned pair[PAIRS][2];
    static const double size[3] = {1, 1, 1};
    struct fmb_body box;
    const struct fmb_placement placement[2] = {{.body = &box}, {.body = &box}};
    assert_int_equal(fmb_body_make(3, FMB_BOX, size, 3, &box), FMB_OK);
    for (int i = 0; i < PAIRS; i++)
        pair[i][1] = 1;
    const struct fmb_scene scene = {.placements = placement,
                                    .placement_count = 2,
                                    .which = FMB_PAIRS_LISTED,
                                    .pairs = (const unsigned(*)[2]) pair,
                                    .pair_count = PAIRS};
    for (int late = 0; late < 2; late++) {
        int count[8] = {0};
        open_network(1, 0, 0);
        run = (struct scene_run){.requests = &net.requests, .held = &held, .within = late ? 2 : 3};
        assert_int_equal(scene_run(&run, &scene, true, count_statuses, count), FMB_OK);
        assert_int_equal(count[late ? -FMB_CLIENT_LATE : -FMB_CLIENT_NO_SERVICE], PAIRS);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_full_window_keeps_a_share_of_its_rate_under_loss),
        cmocka_unit_test(a_lost_single_query_is_repeated_soon),
        cmocka_unit_test(a_lost_query_is_repeated_soon_and_then_more_rarely),
        cmocka_unit_test(a_wait_lasts_until_something_is_due),
        cmocka_unit_test(reordered_results_cause_few_repeats),
        cmocka_unit_test(slow_queries_that_are_overtaken_back_off),
        cmocka_unit_test(queries_in_line_are_not_repeated),
        cmocka_unit_test(a_slow_service_gets_repeats_at_first_only),
        cmocka_unit_test(the_interval_adapts_to_a_longer_delay),
        cmocka_unit_test(a_busy_service_is_queried_for_a_minute),
        cmocka_unit_test(no_service_takes_precedence_over_late),
    };
    return cmocka_run_group_tests_name("client_pace", tests, NULL, NULL);
}
