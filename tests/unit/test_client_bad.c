/* The client library over a bus that loses, repeats and delays, with a service that is busy, gone,
 * slow, or forges results. */
#include "unit.h"

#include "client.h"
#include "hostile.h"
#include "big_endian.h"
#include "fmb_client_raw.h"
#include "held.h"
#include "leap_clock.h"
#include "relay.h"
#include "request.h"
#include "scene_part.h"
#include "wire.h"

#include <limits.h>
#include <math.h>
#include <sys/wait.h>
#include <unistd.h>

enum { PLACEMENTS = 700, ALL_WANTS = FMB_WANT_BOX | FMB_WANT_TIMES | FMB_WANT_POINT };

static const int64_t ms = 1000000, s = 1000000000; /* nanoseconds */

static struct fmb_placement placement[PLACEMENTS];
static unsigned list[2000][2];

/* Cut into some 15 queries. */
static struct fmb_scene all_pairs(void)
{
    relay_draw(placement, PLACEMENTS, 3, 12, 1, 5);
    return (struct fmb_scene){.placements = placement,
                              .placement_count = PLACEMENTS,
                              .which = FMB_PAIRS_ALL,
                              .duration = 1,
                              .want = ALL_WANTS};
}

static struct fmb_scene listed(void)
{
    struct fmb_scene scene = all_pairs();
    relay_draw(placement, 100, 3, 4, 1, 5);
    for (unsigned i = 0; i < 2000; i++) {
        list[i][0] = i % 100;
        list[i][1] = (i + 1 + i / 100) % 100;
    }
    scene.placement_count = 100;
    scene.which = FMB_PAIRS_LISTED;
    scene.pairs = (const unsigned(*)[2]) list;
    scene.pair_count = 2000;
    return scene;
}

/* ---- A bad bus ---- */

static void what_the_bus_loses_is_sent_again(void **state)
{
    test.relay->lose_query = 7;
    test.relay->lose_result = 5;
    test.relay->double_result = 3;
    test.relay->delay_result = 4;
    test.relay->busy = 11;
    relay_start(200, 0.05, 1000);
    struct fmb_scene scene = all_pairs();
    for (int i = 0; i < 3; i++)
        relay_query(test.client, &scene);
    scene = listed();
    for (int i = 0; i < 10; i++)
        relay_query(test.client, &scene);
    assert_true(relay_counts(test.client).repeated > 5);
    assert_int_equal(relay_counts(test.client).malformed, 0);
    assert_int_equal(relay_counts(test.client).outages, 0);
}

/* Publishes a message for this client, whose id it may not have. */
static void publish(void *context, const char *what, const unsigned char *bytes, size_t size)
{
    enum { CLIENT_ID_AT = 16, CLIENT_ID_END = CLIENT_ID_AT + 8 };
    static unsigned char own[QUERY_BYTES_MAX + 1];
    (void) what;
    assert_true(size <= sizeof own);
    memcpy(own, bytes, size);
    if (size >= CLIENT_ID_END)
        big_endian_put_64(own + CLIENT_ID_AT, (uint64_t) fmb_client_raw_id(test.client));
    relay_publish(context, WIRE_SCENE_RESULT, own, size);
}

static void messages_that_cannot_be_read_are_counted(void **state)
{
    relay_start(2000, 5, 6);
    const struct fmb_scene scene = listed();
    relay_query(test.client, &scene);
    const size_t count = hostile_each("scene_result", publish, test.relay);
    relay_query(test.client, &scene);
    assert_true(count > 300);
    assert_int_equal(relay_counts(test.client).malformed, count);
}

/* ---- Results of another kind, and refusals without end ---- */

/* Before a scene is answered, results of pairs come under the numbers of its queries. */
static struct fmb_client *deceived;

static void publish_pair_results(struct relay *relay)
{
    for (int number = 0; number < 20; number++) {
        struct pair_result result = {.client_id = fmb_client_raw_id(deceived),
                                     .sequence_number = number,
                                     .answer = {.verdict = FMB_SEPARATED}};
        unsigned char bytes[QUERY_BYTES_MAX];
        relay_publish(relay, WIRE_PAIR_RESULT, bytes, wire_write_pair_result(&result, bytes));
    }
}

static void results_of_another_kind_are_ignored(void **state)
{
    struct fmb_client_answer answer;
    relay_start(2000, 5, 6);
    const struct fmb_scene scene = all_pairs();
    assert_int_equal(fmb_client_query_pair(test.client, placement, 1, 0, &answer), FMB_OK);
    deceived = test.client;
    test.relay->before = publish_pair_results;
    relay_query(test.client, &scene);
    assert_int_equal(relay_counts(test.client).malformed, 0);
}

/* Before a pair is answered, results for another client come with the same sequence numbers. */
static void publish_results_of_another(struct relay *relay)
{
    for (int number = 0; number < 20; number++) {
        struct pair_result result = {.client_id = fmb_client_raw_id(deceived) + 1,
                                     .sequence_number = number,
                                     .answer = {.verdict = FMB_SEPARATED}};
        unsigned char bytes[QUERY_BYTES_MAX];
        relay_publish(relay, WIRE_PAIR_RESULT, bytes, wire_write_pair_result(&result, bytes));
    }
}

static void results_of_another_client_are_ignored(void **state)
{
    struct fmb_client_answer answer;
    relay_draw(placement, 2, 3, 1, 1, 5);
    relay_start(2000, 5, 6);
    deceived = test.client;
    test.relay->before = publish_results_of_another;
    assert_int_equal(fmb_client_query_pair(test.client, placement, 1, 0, &answer), FMB_OK);
    assert_int_equal(relay_counts(test.client).malformed, 0);
}

static bool publish_nothing(void *user, enum fmb_client_kind kind, const unsigned char *query,
                            size_t size)
{
    (void) user, (void) kind, (void) query, (void) size;
    return true;
}

static bool receive_nothing(void *user)
{
    (void) user;
    return true;
}

static enum request_taken note_status(void *user, struct request *request,
                                      const struct request_result *result)
{
    (void) request;
    *(int *) user = result->status;
    return REQUEST_COMPLETE;
}

/* Requests without a bus. */
static struct requests unsent;

static void open_unsent(void)
{
    memset(&unsent, 0, sizeof unsent);
    unsent.transport =
        (struct request_transport){.publish = publish_nothing, .receive = receive_nothing};
    unsent.timeout_ns = 1;
    requests_forget_pace(&unsent);
}

/* Begins a request for `bytes` bytes, and sends a query of `size` bytes. */
static struct request *send_unsent(enum fmb_client_kind kind, size_t bytes, size_t size,
                                   int *status)
{
    assert_true(requests_ready(&unsent, bytes));
    struct request *request = request_begin(&unsent, kind, bytes, note_status, status);
    request->size = size;
    request_send(&unsent, request);
    return request;
}

/* A later query of a request may be larger than the first. */
static void larger_queries_of_a_request_are_charged(void **state)
{
    int status;
    open_unsent();
    for (int i = 0; i < 3; i++) {
        send_unsent(FMB_CLIENT_SCENE, REQUEST_IDS_END, QUERY_BYTES_MAX, &status);
        assert_int_equal(requests_ready(&unsent, QUERY_BYTES_MAX), i == 0);
    }
    assert_false(requests_ready(&unsent, REQUEST_IDS_END));
}

/* A request releases its share of the window when it ends. */
static void the_window_is_free_when_all_requests_have_ended(void **state)
{
    int status;
    open_unsent();
    for (int i = 0; i < 10; i++) {
        struct request *request =
            send_unsent(FMB_CLIENT_SCENE, QUERY_BYTES_MAX, REQUEST_IDS_END, &status);
        assert_true(requests_ready(&unsent, QUERY_BYTES_MAX));
        if (i % 2)
            request_end(&unsent, request);
        else
            requests_give_up(&unsent, FMB_CLIENT_LATE);
    }
    assert_int_equal(unsent.count, 0);
    assert_int_equal(unsent.charge, 0);
}

/* In the end the refusal is the result. Its pauses, a minute in all, are not waited for. */
static void a_service_that_stays_busy_is_given_up(void **state)
{
    const struct request_result busy = {
        .kind = FMB_CLIENT_DEFINITION, .status = FMB_BUSY, .detail = ""};
    int status = FMB_OK, refusals = 0;
    open_unsent();
    send_unsent(FMB_CLIENT_DEFINITION, REQUEST_IDS_END, REQUEST_IDS_END, &status);
    for (; status == FMB_OK && refusals < 1000; refusals++)
        requests_take(&unsent, &busy);
    assert_int_equal(status, FMB_BUSY);
    assert_int_equal(unsent.count, 0);
    assert_in_range(refusals, 100, 300);
}

/* Results under numbers that no query has come without end. */
static bool receive_a_wrong_number(void *user)
{
    struct requests *requests = *(struct requests **) user;
    const struct request_result wrong = {
        .kind = FMB_CLIENT_DEFINITION, .status = FMB_OK, .detail = "", .number = 1000};
    requests_take(requests, &wrong);
    return true;
}

static void wait_a_millisecond(void *user, int other_fd, int timeout_ms)
{
    (void) user, (void) other_fd, (void) timeout_ms;
    clock_leap(ms);
}

static void results_without_a_query_do_not_prolong_others(void **state)
{
    const int64_t timeout = 20 * ms;
    static struct requests requests, *forged = &requests;
    int status = FMB_OK;
    requests.transport = (struct request_transport){&forged, publish_nothing, wait_a_millisecond,
                                                    receive_a_wrong_number};
    requests.timeout_ns = timeout;
    requests.tries = 3;
    requests_forget_pace(&requests);
    struct request *request =
        request_begin(&requests, FMB_CLIENT_DEFINITION, REQUEST_IDS_END, note_status, &status);
    request->size = REQUEST_IDS_END;
    request_send(&requests, request);
    const int64_t begin = clock_ns();
    while (requests.count > 0 && clock_ns() < begin + 100 * timeout)
        requests_step(&requests, -1, INT64_MAX);
    assert_int_equal(status, FMB_CLIENT_NO_ANSWER);
    assert_true(requests.counts.repeated > 0);
}

/* ---- No service ---- */

struct tally {
    size_t good, none[8]; /* [-status] */
};

static void count(void *user, const struct fmb_client_answer *answer)
{
    struct tally *tally = user;
    assert_true(answer->status <= 0 && answer->status > -8);
    if (answer->status == FMB_OK)
        tally->good++;
    else
        tally->none[-answer->status]++;
}

static struct tally query(struct fmb_client *client, const struct fmb_scene *scene)
{
    struct tally tally = {0};
    assert_int_equal(fmb_client_query(client, scene, count, &tally), FMB_OK);
    return tally;
}

/* Advances the clock beyond all time limits if the service does not answer, or after its first lie.
 */
static void let_time_pass(struct relay *relay)
{
    if (relay->deaf || relay->turn > 0)
        clock_leap(100 * s);
}

static double seconds_since(int64_t start)
{
    return 1e-9 * (double) (clock_ns() - start);
}

/* A client may run for hours, and the service be started after it. While there is none, each call
 * takes a timeout, and sends one query alone. */
static void a_service_that_comes_back_is_found(void **state)
{
    const double timeout = 30;
    const int tries = 10;
    test.relay->deaf = true;
    test.relay->before = let_time_pass;
    relay_start(2000, timeout, tries);
    const struct fmb_scene scene = listed();
    int64_t start = clock_ns();
    assert_int_equal(query(test.client, &scene).none[-FMB_CLIENT_NO_SERVICE], 2000);
    assert_true(seconds_since(start) >= tries * timeout);
    for (int i = 0; i < 3; i++) {
        const uint64_t queries = relay_counts(test.client).queries;
        start = clock_ns();
        assert_int_equal(query(test.client, &scene).none[-FMB_CLIENT_NO_SERVICE], 2000);
        assert_true(seconds_since(start) >= timeout && seconds_since(start) < tries * timeout);
        assert_int_equal(relay_counts(test.client).queries, queries + 1);
    }
    assert_int_equal(relay_counts(test.client).outages, 1);
    test.relay->deaf = false;
    relay_query(test.client, &scene);
    assert_int_equal(relay_counts(test.client).outages, 1);
    test.relay->deaf = true;
    /* Results of queries that were repeated may arrive even now: then a service is there. */
    size_t none = 0;
    for (int i = 0; i < 5 && none < 2000; i++)
        none = query(test.client, &scene).none[-FMB_CLIENT_NO_SERVICE];
    assert_int_equal(none, 2000);
    assert_int_equal(relay_counts(test.client).outages, 2);
}

/* The service comes back while it is being found out whether it has: the whole scene is answered.
 */
static void hear_third(struct relay *relay)
{
    relay->deaf = relay->queries < 3;
}

static void a_repeat_finds_the_service(void **state)
{
    test.relay->deaf = true;
    relay_open(test.relay, 2000);
    test.relay->before = let_time_pass;
    test.client = relay_client(test.relay, 30, 1);
    const struct fmb_scene scene = listed();
    struct fmb_scene one = scene;
    one.pair_count = 1;
    assert_int_equal(query(test.client, &one).none[-FMB_CLIENT_NO_SERVICE], 1);
    test.relay->before = hear_third;
    test.relay->queries = 0;
    relay_query(test.client, &scene);
}

static void no_service_costs_the_time_of_one_query(void **state)
{
    test.relay->deaf = true;
    relay_start(10, 0.05, 2);
    static const unsigned ignored[2][2] = {{0, 1}, {PLACEMENTS - 1, 3}};
    struct fmb_scene scene = all_pairs();
    scene.ignored = ignored;
    scene.ignored_count = 2;
    const int64_t start = clock_ns();
    assert_int_equal(query(test.client, &scene).none[-FMB_CLIENT_NO_SERVICE],
                     PLACEMENTS * (PLACEMENTS - 1) / 2 - 2);
    assert_true(seconds_since(start) >= 2 * 0.05);
    assert_int_equal(relay_counts(test.client).queries, 2); /* the window's */
}

/* ---- An end ---- */

/* The service ends during a scene: the answers so far are given, and a status for the others. */
static void die(struct relay *relay)
{
    relay->deaf = relay->queries > 3;
    let_time_pass(relay);
}

static void the_others_have_no_answer(void **state)
{
    test.relay->before = die;
    struct relay_truth truth;
    relay_start(2000, 30, 1);
    struct fmb_scene scene = listed();
    relay_truth_make(&scene, &truth);
    assert_int_equal(fmb_client_query(test.client, &scene, relay_check, &truth), FMB_OK);
    assert_true(truth.given > 0 && truth.failed > 0);
    assert_int_equal(truth.given + truth.failed, 2000);
    relay_truth_clear(&truth);
}

static void the_time_for_all_ends_it(void **state)
{
    test.relay->deaf = true;
    relay_open(test.relay, 10);
    const struct fmb_client_options options = {
        .url = test.relay->url, .timeout = 1000, .tries = 100, .within = 0.05};
    test.client = fmb_client_open(&options, NULL, 0);
    const struct fmb_scene scene = listed();
    assert_non_null(test.client);
    assert_int_equal(query(test.client, &scene).none[-FMB_CLIENT_LATE], 2000);
    test.relay->deaf = false;
    test.client->run.within = 1000;
    relay_query(test.client, &scene);
}

/* Handles the first answers for longer than the timeout of a query, so that the results of all
 * queries under way arrive meanwhile. */
struct slowly {
    struct relay_truth truth;
    struct relay *relay;
    struct fmb_client *client;
};

static void check_slowly(void *user, const struct fmb_client_answer *answer)
{
    struct slowly *slowly = user;
    const struct fmb_client_counts counts = relay_counts(slowly->client);
    if (slowly->truth.given < 8) {
        relay_wait(slowly->relay, counts.queries + counts.repeated);
        clock_leap(40 * s);
    }
    relay_check(&slowly->truth, answer);
}

static void a_caller_that_takes_long_gets_all_answers(void **state)
{
    struct slowly slowly = {.relay = relay_new()};
    relay_open(slowly.relay, 2000);
    struct fmb_client *client = slowly.client = relay_client(slowly.relay, 30, 4);
    struct fmb_scene scene = listed();
    scene.pair_count = 200;
    scene.want = ALL_WANTS | FMB_WANT_CERTIFICATE;
    relay_use_first_frames(placement, PLACEMENTS); /* certificates are of those */
    relay_truth_make(&scene, &slowly.truth);
    assert_int_equal(fmb_client_query(client, &scene, check_slowly, &slowly), FMB_OK);
    assert_int_equal(slowly.truth.failed, 0);
    assert_int_equal(slowly.truth.given, 200);
    relay_truth_clear(&slowly.truth);
    fmb_client_close(client);
    relay_close(slowly.relay);
}

/* What is under way at once fits into a usual receive buffer: two of the largest datagrams, or many
 * small ones. */
static _Atomic int enough;

static void end_the_time_when_enough(struct relay *relay)
{
    if (relay->queries == enough)
        clock_leap(100 * s);
}

static void what_is_under_way_is_limited(void **state)
{
    struct fmb_scene scene = all_pairs();
    for (int small = 0; small < 2; small++) {
        struct relay *relay = relay_new();
        relay->deaf = true;
        relay->before = end_the_time_when_enough;
        enough = small ? 31 : 2;
        relay_open(relay, 10);
        struct fmb_client *client = relay_client(relay, 1000, 1);
        if (small)
            scene = listed();
        scene.want = small ? FMB_WANT_CERTIFICATE : 0;
        client->run.within = 60;
        query(client, &scene);
        const struct fmb_client_counts counts = relay_counts(client);
        assert_true(small ? counts.queries >= 31 && counts.queries <= 64 : counts.queries == 2);
        assert_true(counts.bytes <= (small ? 20000 : 130000) * (1 + counts.repeated));
        fmb_client_close(client);
        relay_close(relay);
    }
}

/* ---- Forged results ---- */

static void too_far(struct scene_result *result, int turn)
{
    (void) turn;
    result->end_pair = INT_MAX;
}

static void not_on(struct scene_result *result, int turn)
{
    (void) turn;
    result->end_pair = 0;
    result->verdict_count = result->contact_count = 0;
    result->names_pairs = result->has_times = result->has_boxes = false;
}

static void negative_end(struct scene_result *result, int turn)
{
    not_on(result, turn);
    result->end_pair = -1;
}

/* What the counts of times and boxes have to be then, so that it can be read. */
static void keep_first(struct scene_result *result, int32_t verdicts)
{
    result->verdict_count = verdicts;
    result->contact_count = 0;
    for (int32_t i = 0; i < verdicts; i++)
        result->contact_count += result->verdict[i] > FMB_SEPARATED;
}

static void one_verdict_less(struct scene_result *result, int turn)
{
    (void) turn;
    keep_first(result, result->verdict_count - 1);
    result->end_pair += result->names_pairs; /* of named ones fewer are no lie */
    result->end_pair = result->names_pairs ? INT_MAX : result->end_pair;
}

static void pairs_out_of_order(struct scene_result *result, int turn)
{
    (void) turn;
    const unsigned pair[2] = {result->pair[0][0], result->pair[0][1]};
    memcpy(result->pair[0], result->pair[1], sizeof pair);
    memcpy(result->pair[1], pair, sizeof pair);
}

static void a_pair_twice(struct scene_result *result, int turn)
{
    (void) turn;
    memcpy(result->pair[1], result->pair[0], sizeof result->pair[0]);
}

static void the_other_way_round(struct scene_result *result, int turn)
{
    (void) turn;
    const unsigned a = result->pair[0][0];
    result->pair[0][0] = result->pair[0][1];
    result->pair[0][1] = a;
}

static void no_such_placement(struct scene_result *result, int turn)
{
    (void) turn;
    result->pair[result->verdict_count - 1][1] = 1399;
}

static void against_itself(struct scene_result *result, int turn)
{
    (void) turn;
    result->pair[0][0] = result->pair[0][1];
}

static void names_listed_pairs(struct scene_result *result, int turn)
{
    (void) turn;
    result->names_pairs = !result->names_pairs;
    for (int32_t i = 0; i < result->verdict_count; i++)
        result->pair[i][0] = 0, result->pair[i][1] = 1;
}

static void another_handle(struct scene_result *result, int turn)
{
    (void) turn;
    result->handle[result->handle_count - 1].bytes[HANDLE_BYTES - 1] ^= 1;
}

static void one_handle_less(struct scene_result *result, int turn)
{
    (void) turn;
    result->handle_count--;
}

static void a_handle_more(struct scene_result *result, int turn)
{
    (void) turn;
    result->handle[result->handle_count] = result->handle[0];
    result->handle_count++;
}

static void unknown_although_whole(struct scene_result *result, int turn)
{
    not_on(result, turn);
    result->status = FMB_UNKNOWN_BODY;
    result->handle_count = 0;
    result->unknown_count = 1;
    result->unknown[0] = 0;
}

static void boxes_of_2d(struct scene_result *result, int turn)
{
    (void) turn;
    result->dim = 2;
    memset(result->boxes, 0, sizeof result->boxes);
}

static void no_times(struct scene_result *result, int turn)
{
    (void) turn;
    result->has_times = false;
}

static void times_of_none(struct scene_result *result, int turn)
{
    (void) turn;
    for (int32_t i = 0; i < 2 * result->contact_count; i++)
        result->times[i] = NAN;
}

static void separated_is_named(struct scene_result *result, int turn)
{
    (void) turn;
    result->verdict[0] = FMB_SEPARATED;
    keep_first(result, result->verdict_count);
    result->end_pair = result->names_pairs ? result->end_pair : INT_MAX;
}

static void boxes_unwanted(struct scene_result *result, int turn)
{
    (void) turn;
    result->has_boxes = true;
    result->dim = 3;
    memset(result->boxes, 0, sizeof result->boxes);
}

/* Statuses below 0 are the library's own. */
static void status_of_the_library(struct scene_result *result, int turn)
{
    not_on(result, turn);
    result->status = FMB_CLIENT_LATE;
    result->handle_count = 0;
}

static const struct {
    const char *name;
    void (*lie)(struct scene_result *result, int turn);
    bool named, list; /* where it is one */
} lies[] = {
    {"too far", too_far, true, true},
    {"not on", not_on, true, true},
    {"negative end", negative_end, true, true},
    {"one verdict less", one_verdict_less, true, true},
    {"pairs out of order", pairs_out_of_order, true, false},
    {"a pair twice", a_pair_twice, true, false},
    {"the other way round", the_other_way_round, true, false},
    {"no such placement", no_such_placement, true, false},
    {"against itself", against_itself, true, false},
    {"names what was listed", names_listed_pairs, true, true},
    {"another handle", another_handle, true, true},
    {"one handle less", one_handle_less, true, true},
    {"a handle more", a_handle_more, true, true},
    {"unknown although whole", unknown_although_whole, true, true},
    {"boxes of 2D", boxes_of_2d, true, true},
    {"boxes unasked", boxes_unwanted, true, false},
    {"status of the library", status_of_the_library, true, true},
    {"no times", no_times, true, true},
    {"times of none", times_of_none, true, true},
    {"separated is named", separated_is_named, true, true},
};

/* Expects that forged results are ignored: they give no answer, and count as malformed. One that
 * arrives after its query was given up shows at least that there is a service; if all do, on a slow
 * machine, the scene is queried again. pairs: of the scene. */
static void expect_ignored(relay_lie *lie, const struct fmb_scene *scene, size_t pairs)
{
    uint64_t malformed = 0;
    for (int again = 0; again < 20 && malformed == 0; again++) {
        struct relay *relay = relay_new();
        relay->lie = lie;
        relay->before = let_time_pass;
        relay_open(relay, 2000);
        struct fmb_client *client = relay_client(relay, 30, 1);
        const struct tally tally = query(client, scene);
        assert_int_equal(tally.good, 0);
        assert_int_equal(tally.none[-FMB_CLIENT_NO_SERVICE] + tally.none[-FMB_CLIENT_NO_ANSWER],
                         pairs);
        malformed = relay_counts(client).malformed;
        assert_in_range(malformed, 0, relay->turn);
        fmb_client_close(client);
        relay_close(relay);
    }
    assert_true(malformed > 0);
}

static void forged_results_are_ignored(void **state)
{
    for (size_t i = 0; i < COUNT(lies); i++)
        for (int of_list = 0; of_list < 2; of_list++) {
            struct fmb_scene scene = of_list ? listed() : all_pairs();
            scene.placement_count = of_list ? 100 : 400;
            scene.want = lies[i].list ? ALL_WANTS : 0; /* of names alone: nothing else shows them */
            print_message("# %s, %s\n", lies[i].name, of_list ? "listed" : "all");
            if (of_list ? lies[i].list : lies[i].named)
                expect_ignored(lies[i].lie, &scene, of_list ? 2000 : 400 * 399 / 2);
        }
}

static void no_gaps(struct scene_result *result, int turn)
{
    (void) turn;
    result->has_gaps = false;
}

/* That of the first separated pair. */
static struct fmb_gap *near_gap(struct scene_result *result)
{
    int32_t i = 0;
    while (result->verdict[i] != FMB_SEPARATED)
        i++;
    return &result->gap[i];
}

static void too_far_apart(struct scene_result *result, int turn)
{
    (void) turn;
    near_gap(result)->bounds[0] = near_gap(result)->bounds[1] = 1;
}

static void no_gap(struct scene_result *result, int turn)
{
    (void) turn;
    near_gap(result)->bounds[0] = NAN;
}

static void gaps_of_2d(struct scene_result *result, int turn)
{
    (void) turn;
    result->dim = 2;
}

static void gaps_unwanted(struct scene_result *result, int turn)
{
    (void) turn;
    result->has_gaps = true;
    result->dim = 3;
    memset(result->gap, 0, (size_t) result->verdict_count * sizeof *result->gap);
}

static void forged_gaps_are_ignored(void **state)
{
    static relay_lie *const gap_lies[] = {no_gaps, too_far_apart, no_gap, gaps_of_2d,
                                          gaps_unwanted};
    for (size_t i = 0; i < COUNT(gap_lies); i++) {
        struct fmb_scene scene = all_pairs();
        scene.placement_count = 200;
        scene.want = 0;
        scene.margin = gap_lies[i] == gaps_unwanted ? 0 : 0.5;
        print_message("# lie %zu\n", i);
        expect_ignored(gap_lies[i], &scene, 200 * 199 / 2);
    }
}

/* Of a pair query: which of box, certificate and gap are present, and whether that fits. (wire.h
 * checks the interval.) */
static const struct {
    enum fmb_verdict verdict;
    bool box, certificate, gap;
    unsigned want;
    bool good;
} pair_lies[] = {
    {FMB_TOUCHING, true, true, false, 3, true},
    {FMB_OVERLAPPING, true, true, true, 11, true},
    {FMB_SEPARATED, false, true, true, 11, true},
    {FMB_SEPARATED, true, false, false, 1, false},
    {FMB_OVERLAPPING, true, false, false, 2, false},
    {FMB_OVERLAPPING, false, true, false, 1, false},
    {FMB_SEPARATED, false, false, false, 8, false},
    {FMB_SEPARATED, false, false, true, 0, false},
};

/* Returns a part with one pair of these placements of a scene, which has no answer yet. */
static struct part *part_of(const struct fmb_scene *scene, unsigned a, unsigned b)
{
    static struct requests requests;
    static struct scene_run run = {.requests = &requests};
    static struct division_body body[PLACEMENTS];
    static struct part part;
    run.scene = scene;
    run.division.body = body;
    part_answers_clear(&part.answers);
    part = (struct part){.run = &run, .which = FMB_PAIRS_LISTED, .total = 1, .placement_count = 2};
    part.placement[0] = a;
    part.placement[1] = b;
    part.pair[0][1] = 1;
    return &part;
}

/* Passes a result to a part. Returns whether it was taken. */
static bool takes(struct part *part, const struct request_result *result)
{
    static struct request request;
    const enum request_taken taken = part_take(part, &request, result);
    assert_int_equal(part->done, taken == REQUEST_COMPLETE);
    assert_int_equal(part->answers.answered, part->done);
    return part->done;
}

static void results_of_a_pair_fit_their_query(void **state)
{
    struct fmb_scene scene = listed();
    for (size_t i = 0; i < COUNT(pair_lies); i++) {
        const struct pair_result result = {
            .dim = 3,
            .answer = {.verdict = pair_lies[i].verdict,
                       .has_box = pair_lies[i].box,
                       .has_gap = pair_lies[i].gap},
            .certificate = pair_lies[i].certificate ? "proof" : NULL};
        scene.want = pair_lies[i].want;
        const struct request_result taken = {.kind = FMB_CLIENT_PAIR, .pair = &result};
        assert_int_equal(takes(part_of(&scene, 0, 2), &taken), pair_lies[i].good);
    }
}

/* The frames that have a gap, of bodies of one frame and of three: named if and only if a body has
 * several, and such that the body has. */
static void frames_of_a_gap_fit_the_bodies(void **state)
{
    static const struct {
        unsigned a, b; /* placements: 0 has one frame, 1 has three */
        bool named;
        unsigned frame[2];
        bool good;
    } cases[] = {
        {0, 0, false, {0, 0}, true}, {0, 0, true, {0, 0}, false}, {0, 1, true, {0, 2}, true},
        {0, 1, true, {0, 3}, false}, {0, 1, true, {1, 0}, false}, {0, 1, false, {0, 0}, false},
        {1, 0, true, {2, 0}, true},  {1, 1, true, {2, 2}, true},  {1, 1, true, {3, 2}, false}};
    struct fmb_scene scene = listed();
    static struct scene_result named;
    scene.want = FMB_WANT_GAP;
    for (size_t i = 0; i < COUNT(cases); i++) {
        const struct pair_result result = {
            .dim = 3,
            .names_frames = cases[i].named,
            .answer = {.verdict = FMB_OVERLAPPING,
                       .has_gap = true,
                       .gap = {.frame = {cases[i].frame[0], cases[i].frame[1]}}}};
        named =
            (struct scene_result){.end_pair = 1, .dim = 3, .verdict_count = 1, .contact_count = 1};
        named.verdict[0] = FMB_OVERLAPPING;
        named.has_gaps = true;
        named.names_frames = cases[i].named;
        named.gap[0] = result.answer.gap;
        const struct request_result pair = {.kind = FMB_CLIENT_PAIR, .pair = &result};
        const struct request_result all = {.kind = FMB_CLIENT_SCENE, .scene = &named};
        assert_int_equal(takes(part_of(&scene, cases[i].a, cases[i].b), &pair), cases[i].good);
        assert_int_equal(takes(part_of(&scene, cases[i].a, cases[i].b), &all), cases[i].good);
    }
}

/* A forged result costs a retry. */
static void lies_at_first(struct scene_result *result, int turn)
{
    if (turn % 3 != 0)
        pairs_out_of_order(result, turn);
    else if (turn % 2 != 0)
        result->sequence_number += 1000000;
    if (turn % 3 == 1)
        result->end_pair = -7;
}

static void the_right_result_after_forged_ones_is_taken(void **state)
{
    test.relay->lie = lies_at_first;
    relay_start(2000, 0.01, 10000);
    struct fmb_scene scene = all_pairs();
    scene.placement_count = 400;
    relay_query(test.client, &scene);
    assert_true(relay_counts(test.client).malformed > 0);
}

/* The smallest steps that are steps: every one is a query, and it ends. A second result of one is
 * not a result of the next. */
static void step_by_step(struct scene_result *result, int turn)
{
    (void) turn;
    if (result->verdict_count < 2)
        return;
    result->end_pair -= result->verdict_count - 1;
    keep_first(result, 1);
}

static void steps_of_one_pair_end(void **state)
{
    test.relay->lie = test.relay->second_lie = step_by_step;
    test.relay->double_result = 1;
    relay_start(2000, 5, 6);
    struct fmb_scene scene = listed();
    scene.pair_count = 300;
    relay_query(test.client, &scene);
    assert_int_equal(relay_counts(test.client).queries, 300);
    assert_int_equal(relay_counts(test.client).malformed, 0);
}

static void for_ever(struct scene_result *result, int turn)
{
    (void) turn;
    result->compute_ns = INT64_MAX;
}

static void in_no_time(struct scene_result *result, int turn)
{
    result->compute_ns = -turn;
}

/* A query lists as many pairs as are decided soon. */
static void slow_services_get_fewer_pairs_a_query(void **state)
{
    test.relay->lie = for_ever;
    relay_start(2000, 5, 6);
    struct fmb_scene scene = listed();
    relay_query(test.client, &scene);
    uint64_t before = relay_counts(test.client).queries;
    relay_query(test.client, &scene);
    assert_int_equal(relay_counts(test.client).queries - before, 2000 / 16);
    /* A few pairs that take no time do not make queries long at once. */
    test.relay->lie = in_no_time;
    scene.pair_count = 16;
    relay_query(test.client, &scene);
    scene.pair_count = 2000;
    before = relay_counts(test.client).queries;
    relay_query(test.client, &scene);
    assert_true(relay_counts(test.client).queries - before > 1);
    before = relay_counts(test.client).queries;
    relay_query(test.client, &scene);
    assert_int_equal(relay_counts(test.client).queries - before, 1);
}

/* ---- Handles ---- */

/* UNKNOWN_BODY to every query by handle, and to no other. */
static void unknown_body(struct scene_result *result, int turn)
{
    if (result->handle_count == 0)
        unknown_although_whole(result, turn);
}

/* Returns the number of queries that a scene of 100 pairs takes with these results, when its bodies
 * have been sent before. */
static uint64_t queries_with(relay_lie *lie)
{
    struct relay *relay = relay_new();
    relay_open(relay, 2000);
    struct fmb_client *client = relay_client(relay, 5, 1);
    struct fmb_scene scene = listed();
    scene.pair_count = 100;
    relay_query(client, &scene);
    relay->lie = lie;
    const uint64_t before = relay_counts(client).queries;
    relay_query(client, &scene);
    const struct fmb_client_counts counts = relay_counts(client);
    assert_int_equal(counts.malformed, 0);
    fmb_client_close(client);
    relay_close(relay);
    return counts.queries - before;
}

static void unknown_bodies_for_ever_are_sent_whole(void **state)
{
    assert_int_equal(queries_with(unknown_body), 2); /* by handle, then whole */
}

/* Each result has one more unknown body, until all bodies are sent whole. */
static void another_unknown_body(struct scene_result *result, int turn)
{
    if (result->handle_count == 100)
        return;
    unknown_although_whole(result, turn);
    result->unknown[0] = (unsigned) turn % 100;
}

static void unknown_bodies_one_by_one_are_sent_whole(void **state)
{
    assert_int_equal(queries_with(another_unknown_body), 3);
}

/* Of two services on a bus, the one that holds no body answers first. */
static void two_services_are_answered_though_one_holds_no_body(void **state)
{
    struct fmb_client_answer answer;
    relay_start(2000, 5, 6);
    const struct fmb_scene scene = listed();
    relay_query(test.client, &scene);
    assert_int_equal(fmb_client_query_pair(test.client, placement, 1, 0, &answer), FMB_OK);
    relay_add_service(test.relay, 2000);
    relay_query(test.client, &scene);
    assert_int_equal(fmb_client_query_pair(test.client, placement, 1, 0, &answer), FMB_OK);
    for (int i = 0; i < 3; i++)
        relay_query(test.client, &scene);
    assert_int_equal(relay_counts(test.client).malformed, 0);
    assert_int_equal(relay_dropped(test.relay), 0);
}

static void another_pair_handle(struct pair_result *result, int turn)
{
    (void) turn;
    result->handle[1].bytes[0] ^= 1;
}

static void no_pair_handle(struct pair_result *result, int turn)
{
    static const struct handle none;
    (void) turn;
    result->handle[0] = none;
}

static void wrong_handles_of_a_pair_are_malformed(void **state)
{
    relay_pair_lie *const lie[] = {another_pair_handle, no_pair_handle};
    for (int i = 0; i < 2; i++) {
        struct relay *relay = relay_new();
        relay->pair_lie = lie[i];
        relay->before = let_time_pass;
        struct fmb_client_answer answer;
        relay_open(relay, 2000);
        struct fmb_client *client = relay_client(relay, 30, 1);
        relay_draw(placement, 2, 3, 1, 1, 1);
        assert_int_equal(fmb_client_query_pair(client, placement, 1, 0, &answer),
                         FMB_CLIENT_NO_SERVICE);
        assert_in_range(relay_counts(client).malformed, 1, relay->turn);
        fmb_client_close(client);
        relay_close(relay);
    }
}

/* The table is full, and a scene begins; only if the scene is small, the table is cleared. */
static void bodies_are_kept_until_the_table_is_full(void **state)
{
    static struct held held;
    static struct requests requests;
    static struct scene_run run = {.requests = &requests, .held = &held};
    static struct fmb_placement bodies[HELD_MAX];
    static const double size[3] = {1, 1, 1};
    struct fmb_body box;
    struct fmb_scene scene = {.placements = bodies, .which = FMB_PAIRS_LISTED};
    uint64_t number = 0;
    const struct body_view geometry = {.bytes = (const unsigned char *) &number,
                                       .size = sizeof number};
    assert_int_equal(fmb_body_make(3, FMB_BOX, size, 3, &box), FMB_OK);
    for (int i = 0; i < HELD_MAX; i++)
        bodies[i].body = &box;
    struct held_body *first = held_find(&held, &geometry);
    first->held = true;
    for (int more = -1; more < 2; more++) {
        scene.placement_count = more == 0 ? HELD_MAX / 2 : 0;
        for (number = held.count; held.count < (size_t) (HELD_MAX + more); number++)
            assert_false(held_find(&held, &geometry)->held);
        number = 0;
        assert_ptr_equal(held_find(&held, &geometry), first);
        assert_true(first->held);
        assert_int_equal(scene_run(&run, &scene, false, NULL, NULL), FMB_OK);
        assert_int_equal(held.count, more == 1 ? 0 : HELD_MAX + more);
    }
}

/* ---- Second results ---- */

static void other_verdict(struct scene_result *result, int turn)
{
    (void) turn;
    result->verdict[0] = result->verdict[0] == FMB_TOUCHING ? FMB_OVERLAPPING : FMB_TOUCHING;
}

static void other_pair_verdict(struct pair_result *result, int turn)
{
    (void) turn;
    result->answer.verdict = result->answer.verdict == FMB_SEPARATED ? FMB_TOUCHING : FMB_SEPARATED;
    result->answer.has_contact = result->answer.verdict == FMB_TOUCHING;
    result->answer.contact[0] = result->answer.contact[1] = 0;
    result->answer.has_box = false;
    result->dim = 0;
}

/* The answers are those of the first results. */
static void second_results_are_ignored(void **state)
{
    struct fmb_client_answer answer;
    struct fmb_scene scene = listed();
    test.relay->double_result = 1;
    test.relay->second_lie = other_verdict;
    test.relay->second_pair_lie = other_pair_verdict;
    relay_start(2000, 5, 6);
    scene.want = 0;
    for (int i = 0; i < 5; i++) {
        relay_query(test.client, &scene);
        assert_int_equal(fmb_client_query_pair(test.client, &placement[i], 1, 0, &answer), FMB_OK);
        struct fmb_answer expected;
        assert_int_equal(
            fmb_decide(fmb_method_default(), &placement[i], &placement[i + 1], 1, 0, &expected),
            FMB_OK);
        assert_int_equal(answer.answer.verdict, expected.verdict);
    }
    assert_int_equal(relay_counts(test.client).malformed, 0);
}

/* ---- The process ---- */

static void a_child_that_closes_harms_nothing(void **state)
{
    struct relay *relay = relay_new();
    int status;
    relay_open(relay, 2000);
    struct fmb_client *client = relay_client(relay, 5, 1);
    const struct fmb_scene scene = listed();
    relay_query(client, &scene);
    const pid_t child = fork();
    if (child == 0) {
        fmb_client_close(client);
        _exit(0);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
    relay_query(client, &scene);
    assert_int_equal(relay_dropped(relay), 0);
    fmb_client_close(client);
    relay_close(relay);
}

/* ---- Callbacks ---- */

struct within {
    struct fmb_client *client;
    const struct fmb_scene *scene;
    size_t called;
};

static void query_within(void *user, const struct fmb_client_answer *answer)
{
    struct within *within = user;
    struct fmb_client_answer none;
    const struct fmb_client_watcher watcher = {0};
    (void) answer;
    within->called++;
    assert_int_equal(fmb_client_query(within->client, within->scene, query_within, user),
                     FMB_CLIENT_INSIDE);
    assert_int_equal(fmb_client_query_pair(within->client, placement, 1, 0, &none),
                     FMB_CLIENT_INSIDE);
    assert_int_equal(fmb_client_handle(within->client, 0), FMB_CLIENT_INSIDE);
    assert_int_equal(fmb_client_watch(within->client, &watcher), FMB_CLIENT_INSIDE);
}

static void no_call_within_a_callback(void **state)
{
    relay_open(test.relay, 2000);
    const struct fmb_scene scene = listed();
    struct within within = {.client = relay_client(test.relay, 5, 1), .scene = &scene};
    assert_int_equal(fmb_client_query(within.client, &scene, query_within, &within), FMB_OK);
    assert_int_equal(within.called, 2000);
    fmb_client_close(within.client);
}

struct watching {
    int64_t heartbeats, malformed;
    int64_t served, served_scenes; /* as the last heartbeat said */
};

static void on_heartbeat(void *user, const struct fmb_client_heartbeat *heartbeat)
{
    struct watching *watching = user;
    assert_string_equal(heartbeat->version, fmb_version());
    watching->heartbeats++;
    watching->served_scenes = fmb_client_get_counter(heartbeat, "scenes");
    watching->served = fmb_client_get_counter(heartbeat, "received");
    assert_int_equal(fmb_client_get_counter(heartbeat, "no such counter"), 0);
    assert_int_equal(heartbeat->counter_count, WIRE_COUNTERS);
    for (size_t i = 0; i < heartbeat->counter_count; i++)
        for (size_t k = 0; k < i; k++)
            assert_string_not_equal(heartbeat->counters[i].name, heartbeat->counters[k].name);
}

static void on_malformed(void *user, const char *what)
{
    assert_non_null(what);
    ((struct watching *) user)->malformed++;
}

static void a_watcher_sees_heartbeats(void **state)
{
    struct watching watching = {0};
    struct wire_status status = {.received = 2, .scenes = 1};
    unsigned char heartbeat[WIRE_STATUS_BYTES_MAX];
    const struct fmb_client_watcher watcher = {on_heartbeat, on_malformed, &watching};
    snprintf(status.version, sizeof status.version, "%s", fmb_version());
    relay_open(test.relay, 2000);
    struct fmb_client *watch = relay_client(test.relay, 5, 1);
    assert_int_equal(fmb_client_watch(watch, &watcher), FMB_OK);
    relay_publish(test.relay, WIRE_STATUS, heartbeat, wire_write_status(&status, heartbeat));
    relay_publish(test.relay, WIRE_STATUS, "no status", 9);
    assert_true(fmb_client_fileno(watch) >= 0);
    while (watching.malformed == 0 && fmb_client_handle(watch, 60) > 0)
        continue;
    assert_true(watching.heartbeats >= 1);
    assert_int_equal(watching.served, 2);
    assert_int_equal(watching.served_scenes, 1);
    assert_int_equal(watching.malformed, 1);
    fmb_client_close(watch);
}

/* ---- Opening ---- */

static void wrong_options_are_refused(void **state)
{
    char why[FMB_CLIENT_WHY_MAX], little[8];
    const struct fmb_client_options wrong[] = {{.prefix = "a.*"},
                                               {.timeout = -1},
                                               {.timeout = NAN},
                                               {.tries = -1},
                                               {.within = -1},
                                               {.within = NAN},
                                               {.url = "tcpq://127.0.0.1:1"}};
    static const char *const named[] = {"prefix", "timeout", "timeout", "tries",
                                        "within", "within",  "tcpq"};
    for (size_t i = 0; i < COUNT(wrong); i++) {
        why[0] = '\0';
        assert_null(fmb_client_open(&wrong[i], why, sizeof why));
        assert_non_null(strstr(why, named[i]));
        assert_null(fmb_client_open(&wrong[i], little, sizeof little));
        assert_int_equal(strlen(little), sizeof little - 1);
        assert_null(fmb_client_open(&wrong[i], NULL, 0));
    }
    fmb_client_close(NULL);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        RELAY_TEST(what_the_bus_loses_is_sent_again),
        RELAY_TEST(messages_that_cannot_be_read_are_counted),
        RELAY_TEST(results_of_another_kind_are_ignored),
        RELAY_TEST(results_of_another_client_are_ignored),
        cmocka_unit_test(larger_queries_of_a_request_are_charged),
        cmocka_unit_test(the_window_is_free_when_all_requests_have_ended),
        cmocka_unit_test(a_service_that_stays_busy_is_given_up),
        cmocka_unit_test(results_without_a_query_do_not_prolong_others),
        RELAY_TEST(a_service_that_comes_back_is_found),
        RELAY_TEST(a_repeat_finds_the_service),
        RELAY_TEST(no_service_costs_the_time_of_one_query),
        RELAY_TEST(the_others_have_no_answer),
        RELAY_TEST(the_time_for_all_ends_it),
        cmocka_unit_test(a_caller_that_takes_long_gets_all_answers),
        cmocka_unit_test(what_is_under_way_is_limited),
        cmocka_unit_test(forged_results_are_ignored),
        cmocka_unit_test(forged_gaps_are_ignored),
        cmocka_unit_test(results_of_a_pair_fit_their_query),
        cmocka_unit_test(frames_of_a_gap_fit_the_bodies),
        RELAY_TEST(the_right_result_after_forged_ones_is_taken),
        RELAY_TEST(steps_of_one_pair_end),
        RELAY_TEST(slow_services_get_fewer_pairs_a_query),
        cmocka_unit_test(unknown_bodies_for_ever_are_sent_whole),
        cmocka_unit_test(unknown_bodies_one_by_one_are_sent_whole),
        RELAY_TEST(two_services_are_answered_though_one_holds_no_body),
        cmocka_unit_test(wrong_handles_of_a_pair_are_malformed),
        cmocka_unit_test(bodies_are_kept_until_the_table_is_full),
        RELAY_TEST(second_results_are_ignored),
        cmocka_unit_test(a_child_that_closes_harms_nothing),
        RELAY_TEST(no_call_within_a_callback),
        RELAY_TEST(a_watcher_sees_heartbeats),
        cmocka_unit_test(wrong_options_are_refused),
    };
    (void) argc;
    relay_enter(argv);
    return cmocka_run_group_tests_name("client_bad", tests, NULL, NULL);
}
