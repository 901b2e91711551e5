/* The client library over a bus that loses, repeats and delays, with a service that is busy, gone,
 * slow, or lies. */
#include "asking.h"
#include "clock.h"
#include "hostile.h"
#include "relay.h"
#include "wire.h"

#include <limits.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

enum { FRAMES = 700, ALL_WANTS = FMB_CLIENT_WANT_BOX | FMB_CLIENT_WANT_TIMES };

static struct fmb_client_frame frame[FRAMES];
static unsigned list[2000][2];

/* Cut into some 15 queries. */
static struct fmb_client_scene all_pairs(void)
{
    relay_draw(frame, FRAMES, 3, 12, 1, 5);
    return (struct fmb_client_scene){.frames = frame,
                                     .frame_count = FRAMES,
                                     .which = FMB_CLIENT_ALL,
                                     .duration = 1,
                                     .want = ALL_WANTS};
}

static struct fmb_client_scene listed(void)
{
    struct fmb_client_scene scene = all_pairs();
    relay_draw(frame, 100, 3, 4, 1, 5);
    for (unsigned i = 0; i < 2000; i++) {
        list[i][0] = i % 100;
        list[i][1] = (i + 1 + i / 100) % 100;
    }
    scene.frame_count = 100;
    scene.which = FMB_CLIENT_LISTED;
    scene.pairs = (const unsigned(*)[2]) list;
    scene.pair_count = 2000;
    return scene;
}

/* ---- A bad bus ---- */

static void test_what_the_bus_loses_is_asked_again(void **state)
{
    (void) state;
    struct relay relay = {
        .lose_query = 7, .lose_result = 5, .double_result = 3, .delay_result = 4, .busy = 11};
    relay_open(&relay, 200);
    struct fmb_client *client = relay_client(&relay, 0.05, 30);
    struct fmb_client_scene scene = all_pairs();
    for (int i = 0; i < 3; i++)
        relay_ask(client, &scene);
    scene = listed();
    for (int i = 0; i < 10; i++)
        relay_ask(client, &scene);
    assert_true(fmb_client_counts(client).repeated > 5);
    assert_int_equal(fmb_client_counts(client).malformed, 0);
    assert_int_equal(fmb_client_counts(client).outages, 0);
    fmb_client_close(client);
    relay_close(&relay);
}

static void publish(void *context, const char *what, const unsigned char *bytes, size_t size)
{
    struct relay *relay = context;
    (void) what;
    lcm_publish(relay->client, WIRE_SCENE_RESULT, bytes, (unsigned) size);
}

static void litter(struct relay *relay)
{
    if (relay->queries == 1)
        hostile_each("pair_result", publish, relay);
}

static void test_what_cannot_be_read_is_counted(void **state)
{
    (void) state;
    struct relay relay = {.before = litter};
    relay_open(&relay, 2000);
    struct fmb_client *client = relay_client(&relay, 5, 1);
    const struct fmb_client_scene scene = listed();
    relay_ask(client, &scene);
    assert_true(fmb_client_counts(client).malformed > 300);
    fmb_client_close(client);
    relay_close(&relay);
}

/* ---- Nobody there ---- */

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

static struct tally ask(struct fmb_client *client, const struct fmb_client_scene *scene)
{
    struct tally tally = {0};
    assert_int_equal(fmb_client_ask(client, scene, count, &tally), FMB_OK);
    return tally;
}

/* A little more than the second between two probes. */
static void wait_for_probe(void)
{
    nanosleep(&(struct timespec){1, 50000000}, NULL);
}

/* A client may run for hours, and the service be started behind it. */
static void test_it_asks_again_when_the_service_is_back(void **state)
{
    (void) state;
    struct relay relay = {.deaf = true};
    relay_open(&relay, 2000);
    struct fmb_client *client = relay_client(&relay, 0.02, 3);
    const struct fmb_client_scene scene = listed();
    assert_int_equal(ask(client, &scene).none[-FMB_CLIENT_NOBODY], 2000);
    const int asked = relay.queries;
    assert_int_equal(asked % 3, 0);
    assert_int_equal(ask(client, &scene).none[-FMB_CLIENT_NOBODY], 2000);
    assert_int_equal(relay.queries, asked); /* too soon for a probe */
    wait_for_probe();
    assert_int_equal(ask(client, &scene).none[-FMB_CLIENT_NOBODY], 2000);
    assert_int_equal(relay.queries, asked + 1);
    assert_int_equal(fmb_client_counts(client).outages, 1);
    wait_for_probe();
    relay.deaf = false;
    relay_ask(client, &scene);
    relay.deaf = true;
    assert_int_equal(ask(client, &scene).none[-FMB_CLIENT_NOBODY], 2000);
    assert_int_equal(fmb_client_counts(client).outages, 2);
    fmb_client_close(client);
    relay_close(&relay);
}

static void test_nobody_there_costs_the_time_of_one_query(void **state)
{
    (void) state;
    struct relay relay = {.deaf = true};
    relay_open(&relay, 10);
    struct fmb_client *client = relay_client(&relay, 0.05, 2);
    const struct fmb_client_scene scene = all_pairs();
    assert_int_equal(ask(client, &scene).none[-FMB_CLIENT_NOBODY], FRAMES * (FRAMES - 1) / 2);
    assert_true(relay.queries <= 8);
    fmb_client_close(client);
    relay_close(&relay);
}

/* The service dies while a scene is asked: what was answered is given, the rest in its place. */
static void die(struct relay *relay)
{
    relay->deaf = relay->queries > 6;
}

static void test_the_rest_has_no_answer(void **state)
{
    (void) state;
    struct relay relay = {.before = die};
    struct relay_truth truth;
    relay_open(&relay, 2000);
    struct fmb_client *client = relay_client(&relay, 0.02, 2);
    struct fmb_client_scene scene = listed();
    relay_truth_make(&scene, &truth);
    assert_int_equal(fmb_client_ask(client, &scene, relay_check, &truth), FMB_OK);
    assert_true(truth.told > 0 && truth.failed > 0);
    assert_int_equal(truth.told + truth.failed, 2000);
    relay_truth_clear(&truth);
    fmb_client_close(client);
    relay_close(&relay);
}

static void test_the_time_for_all_ends_it(void **state)
{
    (void) state;
    struct relay relay = {.deaf = true};
    relay_open(&relay, 10);
    struct fmb_client *client = relay_client(&relay, 1000, 100);
    struct fmb_client_scene scene = listed();
    scene.within = 0.05;
    assert_int_equal(ask(client, &scene).none[-FMB_CLIENT_LATE], 2000);
    relay.deaf = false;
    scene.within = 1000;
    relay_ask(client, &scene);
    fmb_client_close(client);
    relay_close(&relay);
}

/* The time ends while it is found out whether the service is back: the others are given up too, and
 * no second probe goes out within the second. */
static void test_the_time_for_all_ends_a_probe(void **state)
{
    (void) state;
    struct relay relay = {.deaf = true};
    relay_open(&relay, 2000);
    struct fmb_client *client = relay_client(&relay, 0.5, 1);
    struct fmb_client_scene scene = listed();
    assert_int_equal(ask(client, &scene).none[-FMB_CLIENT_NOBODY], 2000);
    const int asked = relay.queries;
    wait_for_probe();
    scene.within = 0.02;
    assert_int_equal(ask(client, &scene).none[-FMB_CLIENT_LATE], 2000);
    assert_int_equal(relay.queries, asked + 1);
    scene.within = 0;
    assert_int_equal(ask(client, &scene).none[-FMB_CLIENT_NOBODY], 2000);
    assert_int_equal(relay.queries, asked + 1);
    wait_for_probe();
    relay.deaf = false;
    relay_ask(client, &scene);
    fmb_client_close(client);
    relay_close(&relay);
}

/* Longer over the first answers than the service is waited for. */
static void check_slowly(void *user, const struct fmb_client_answer *answer)
{
    const struct relay_truth *truth = user;
    if (truth->told < 8)
        nanosleep(&(struct timespec){0, 120000000}, NULL);
    relay_check(user, answer);
}

static void test_who_is_slow_to_take_answers_gets_them_all(void **state)
{
    (void) state;
    struct relay relay = {.deaf = false};
    struct relay_truth truth;
    relay_open(&relay, 2000);
    struct fmb_client *client = relay_client(&relay, 0.1, 4);
    struct fmb_client_scene scene = listed();
    scene.pair_count = 200;
    scene.want = ALL_WANTS | FMB_CLIENT_WANT_CERTIFICATE;
    relay_truth_make(&scene, &truth);
    assert_int_equal(fmb_client_ask(client, &scene, check_slowly, &truth), FMB_OK);
    assert_int_equal(truth.failed, 0);
    assert_int_equal(truth.told, 200);
    relay_truth_clear(&truth);
    fmb_client_close(client);
    relay_close(&relay);
}

/* What is under way at once fits into a usual receive buffer: two of the largest datagrams, or many
 * small ones. */
static void test_what_is_under_way_is_limited(void **state)
{
    (void) state;
    struct fmb_client_scene scene = all_pairs();
    for (int small = 0; small < 2; small++) {
        struct relay relay = {.deaf = true};
        relay_open(&relay, 10);
        struct fmb_client *client = relay_client(&relay, 1000, 1);
        if (small)
            scene = listed();
        scene.want = small ? FMB_CLIENT_WANT_CERTIFICATE : 0;
        scene.within = 0.05;
        ask(client, &scene);
        assert_true(small ? relay.queries > 30 && relay.queries <= 64 : relay.queries == 2);
        assert_true(relay.bytes <= (small ? 20000 : 130000));
        fmb_client_close(client);
        relay_close(&relay);
    }
}

/* ---- Lies ---- */

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

static void no_such_frame(struct scene_result *result, int turn)
{
    (void) turn;
    result->pair[result->verdict_count - 1][1] = 1399;
}

static void against_itself(struct scene_result *result, int turn)
{
    (void) turn;
    result->pair[0][0] = result->pair[0][1];
}

static void names_what_was_listed(struct scene_result *result, int turn)
{
    (void) turn;
    result->names_pairs = !result->names_pairs;
    for (int32_t i = 0; i < result->verdict_count; i++)
        result->pair[i][0] = 0, result->pair[i][1] = 1;
}

static void one_key(struct scene_result *result, int turn)
{
    (void) turn;
    result->key_count = 1;
    result->key[0] = 1;
}

static void many_keys(struct scene_result *result, int turn)
{
    (void) turn;
    result->key_count = QUERY_FRAMES_MAX;
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

static void times_of_pairs_at_rest(struct scene_result *result, int turn)
{
    (void) turn;
    memset(result->times, 0, sizeof result->times);
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
    {"no such frame", no_such_frame, true, false},
    {"against itself", against_itself, true, false},
    {"names what was listed", names_what_was_listed, true, true},
    {"one key", one_key, true, true},
    {"many keys", many_keys, true, true},
    {"boxes of 2D", boxes_of_2d, true, true},
    {"no times", no_times, true, true},
    {"times of pairs at rest", times_of_pairs_at_rest, true, true},
    {"times of none", times_of_none, true, true},
    {"separated is named", separated_is_named, true, true},
};

/* Nothing of it is believed: no answer is given, and each result counts as malformed. */
static void test_lies_are_no_answers(void **state)
{
    (void) state;
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++)
        for (int of_list = 0; of_list < 2; of_list++) {
            struct relay relay = {.lie = lies[i].lie};
            struct fmb_client_scene scene = of_list ? listed() : all_pairs();
            if (!(of_list ? lies[i].list : lies[i].named))
                continue;
            scene.frame_count = of_list ? 100 : 400;
            scene.want = lies[i].list ? ALL_WANTS : 0; /* of names alone: nothing else shows them */
            relay_open(&relay, 2000);
            struct fmb_client *client = relay_client(&relay, 0.01, 2);
            const struct tally tally = ask(client, &scene);
            if (tally.good != 0 || tally.none[-FMB_CLIENT_NOBODY] == 0)
                print_error("lie: %s, %s\n", lies[i].name, of_list ? "listed" : "all");
            assert_int_equal(tally.good, 0);
            assert_int_equal(tally.none[-FMB_CLIENT_NOBODY], of_list ? 2000 : 400 * 399 / 2);
            assert_int_equal(fmb_client_counts(client).malformed, relay.turn);
            fmb_client_close(client);
            relay_close(&relay);
        }
}

/* Of a pair asked alone: which of interval, box and certificate are there, and whether that fits.
 */
static const struct {
    enum fmb_verdict verdict;
    bool moving, contact, box, certificate;
    unsigned want;
    bool good;
} pair_lies[] = {
    {FMB_TOUCHING, true, true, true, true, 3, true},
    {FMB_OVERLAPPING, false, false, true, true, 3, true},
    {FMB_SEPARATED, true, false, false, true, 3, true},
    {FMB_SEPARATED, true, true, false, false, 0, false},
    {FMB_OVERLAPPING, false, true, false, false, 0, false},
    {FMB_SEPARATED, false, false, true, false, 1, false},
    {FMB_OVERLAPPING, false, false, true, false, 2, false},
    {FMB_OVERLAPPING, false, false, false, true, 1, false},
};

static void test_of_a_pair_nothing_is_taken_that_was_not_asked(void **state)
{
    (void) state;
    static const struct part part = {.alone = true, .frame_count = 2, .frame = {0, 1}, .total = 1};
    struct fmb_client_scene scene = listed();
    for (size_t i = 0; i < sizeof pair_lies / sizeof *pair_lies; i++) {
        struct part_answers answers = {0};
        const struct pair_result result = {
            .dim = 3,
            .answer = {.verdict = pair_lies[i].verdict,
                       .has_contact = pair_lies[i].contact,
                       .has_box = pair_lies[i].box},
            .certificate = pair_lies[i].certificate ? "proof" : NULL};
        frame[0].moving = false;
        frame[1].moving = pair_lies[i].moving;
        scene.want = pair_lies[i].want;
        assert_int_equal(part_take_pair(&part, &scene, &result, &answers),
                         pair_lies[i].good ? PART_TAKEN : PART_NONSENSE);
        assert_int_equal(answers.answered, pair_lies[i].good);
        part_answers_clear(&answers);
    }
}

/* Once the truth comes, it is taken: a lie costs a time-out. */
static void lies_at_first(struct scene_result *result, int turn)
{
    if (turn % 3 != 0)
        pairs_out_of_order(result, turn);
    else if (turn % 2 != 0)
        result->sequence_number += 1000000;
    if (turn % 3 == 1)
        result->end_pair = -7;
}

static void test_the_truth_after_lies_is_taken(void **state)
{
    (void) state;
    struct relay relay = {.lie = lies_at_first};
    relay_open(&relay, 2000);
    struct fmb_client *client = relay_client(&relay, 0.01, 1000);
    struct fmb_client_scene scene = all_pairs();
    scene.frame_count = 400;
    relay_ask(client, &scene);
    assert_true(fmb_client_counts(client).malformed > 0);
    fmb_client_close(client);
    relay_close(&relay);
}

/* The smallest steps that are steps: every one is a query, and it ends. */
static void step_by_step(struct scene_result *result, int turn)
{
    (void) turn;
    if (result->verdict_count < 2)
        return;
    result->end_pair -= result->verdict_count - 1;
    keep_first(result, 1);
}

static void test_steps_of_one_pair_end(void **state)
{
    (void) state;
    struct relay relay = {.lie = step_by_step};
    relay_open(&relay, 2000);
    struct fmb_client *client = relay_client(&relay, 5, 1);
    struct fmb_client_scene scene = listed();
    scene.pair_count = 300;
    relay_ask(client, &scene);
    assert_int_equal(fmb_client_counts(client).queries, 300);
    fmb_client_close(client);
    relay_close(&relay);
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

/* So many pairs are asked at once as are decided soon. */
static void test_slow_services_are_asked_less_at_once(void **state)
{
    (void) state;
    struct relay relay = {.lie = for_ever};
    relay_open(&relay, 2000);
    struct fmb_client *client = relay_client(&relay, 5, 1);
    const struct fmb_client_scene scene = listed();
    relay_ask(client, &scene);
    int before = relay.queries;
    relay_ask(client, &scene);
    assert_int_equal(relay.queries - before, 2000 / 16);
    relay.lie = in_no_time;
    relay_ask(client, &scene);
    before = relay.queries;
    relay_ask(client, &scene);
    assert_int_equal(relay.queries - before, 1);
    fmb_client_close(client);
    relay_close(&relay);
}

/* A service that never knows a key: one that was sent none is not asked for ever. */
static void unknown_body(struct scene_result *result, int turn)
{
    (void) turn;
    not_on(result, turn);
    result->status = FMB_UNKNOWN_BODY;
    result->key_count = 0;
}

static void count_unknown(void *user, const struct fmb_client_answer *answer)
{
    assert_int_equal(answer->status, FMB_UNKNOWN_BODY);
    ++*(size_t *) user;
}

static void test_unknown_bodies_for_ever_are_a_refusal(void **state)
{
    (void) state;
    struct relay relay = {0};
    size_t refused = 0;
    relay_open(&relay, 2000);
    struct fmb_client *client = relay_client(&relay, 5, 1);
    struct fmb_client_scene scene = listed();
    scene.pair_count = 100;
    relay_ask(client, &scene);
    const int before = relay.queries;
    relay.lie = unknown_body;
    assert_int_equal(fmb_client_ask(client, &scene, count_unknown, &refused), FMB_OK);
    assert_int_equal(refused, 100);
    assert_int_equal(relay.queries, before + 3); /* by key, once more, whole */
    fmb_client_close(client);
    relay_close(&relay);
}

/* ---- Callbacks ---- */

struct within {
    struct fmb_client *client;
    const struct fmb_client_scene *scene;
    size_t called;
};

static void ask_within(void *user, const struct fmb_client_answer *answer)
{
    struct within *within = user;
    struct fmb_client_answer none;
    const struct fmb_client_watcher watcher = {0};
    (void) answer;
    within->called++;
    assert_int_equal(fmb_client_ask(within->client, within->scene, ask_within, user),
                     FMB_CLIENT_INSIDE);
    assert_int_equal(fmb_client_ask_pair(within->client, frame, 1, 0, &none), FMB_CLIENT_INSIDE);
    assert_int_equal(fmb_client_handle(within->client, 0), FMB_CLIENT_INSIDE);
    assert_int_equal(fmb_client_watch(within->client, &watcher), FMB_CLIENT_INSIDE);
}

static void test_no_call_within_a_callback(void **state)
{
    (void) state;
    struct relay relay = {0};
    relay_open(&relay, 2000);
    const struct fmb_client_scene scene = listed();
    struct within within = {.client = relay_client(&relay, 5, 1), .scene = &scene};
    assert_int_equal(fmb_client_ask(within.client, &scene, ask_within, &within), FMB_OK);
    assert_int_equal(within.called, 2000);
    fmb_client_close(within.client);
    relay_close(&relay);
}

struct watching {
    int64_t pairs, scenes, heartbeats, malformed, overlapping, touching, end_pair;
    int64_t served, served_scenes; /* as the last heartbeat said */
};

static void on_pair(void *user, const struct fmb_client_pair_result *result)
{
    assert_int_equal(result->status, FMB_OK);
    assert_int_equal(result->body_id[0], frame[0].body_id);
    ((struct watching *) user)->pairs++;
}

static void on_scene(void *user, const struct fmb_client_scene_result *result)
{
    struct watching *watching = user;
    watching->scenes++;
    watching->overlapping += result->overlapping;
    watching->touching += result->touching;
    watching->end_pair = result->end_pair;
    assert_true(result->names_pairs);
}

static void on_heartbeat(void *user, const struct fmb_client_heartbeat *heartbeat)
{
    struct watching *watching = user;
    assert_string_equal(heartbeat->version, fmb_version());
    watching->heartbeats++;
    watching->served_scenes = heartbeat->scenes;
    watching->served = heartbeat->received;
}

static void on_malformed(void *user, const char *what)
{
    assert_non_null(what);
    ((struct watching *) user)->malformed++;
}

static void carry_status(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct relay *relay = user;
    lcm_publish(relay->client, channel, buffer->data, buffer->data_size);
}

/* One client listens to what another one is answered. */
static void test_watching(void **state)
{
    (void) state;
    struct relay relay = {0};
    struct watching watching = {0};
    struct relay_truth truth;
    const struct fmb_client_watcher watcher = {on_pair, on_scene, on_heartbeat, on_malformed,
                                               &watching};
    relay_open(&relay, 2000);
    lcm_subscribe(relay.service, WIRE_STATUS, carry_status, &relay);
    struct fmb_client *asker = relay_client(&relay, 5, 1), *watch = relay_client(&relay, 5, 1);
    assert_int_equal(fmb_client_watch(watch, &watcher), FMB_OK);
    struct fmb_client_scene scene = all_pairs();
    struct fmb_client_answer answer;
    scene.frame_count = 100;
    relay_truth_make(&scene, &truth);
    relay_ask(asker, &scene);
    assert_int_equal(fmb_client_ask_pair(asker, frame, 1, 0, &answer), FMB_OK);
    server_publish_status(relay.server);
    while (lcm_handle_timeout(relay.service, 0) > 0)
        continue;
    lcm_publish(relay.client, WIRE_STATUS, "no status", 9);
    assert_true(fmb_client_fileno(watch) >= 0);
    while (fmb_client_handle(watch, 0) > 0)
        continue;
    assert_int_equal(watching.scenes, 1);
    assert_int_equal(watching.end_pair, 4950);
    assert_int_equal(watching.overlapping + watching.touching, truth.count);
    assert_int_equal(watching.pairs, 1);
    assert_true(watching.heartbeats >= 1);
    assert_int_equal(watching.served, 2);
    assert_int_equal(watching.served_scenes, 1);
    assert_int_equal(watching.malformed, 1);
    relay_truth_clear(&truth);
    fmb_client_close(asker);
    fmb_client_close(watch);
    relay_close(&relay);
}

/* ---- Opening ---- */

static void test_wrong_options_are_told(void **state)
{
    (void) state;
    lcm_t *lcm = lcm_create("memq://");
    char why[FMB_CLIENT_WHY_MAX], little[8];
    const struct fmb_client_options wrong[] = {{.lcm = lcm, .prefix = "a.*"},
                                               {.lcm = lcm, .timeout = -1},
                                               {.lcm = lcm, .timeout = NAN},
                                               {.lcm = lcm, .tries = -1},
                                               {.url = "tcpq://127.0.0.1:1"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        why[0] = '\0';
        assert_null(fmb_client_open(&wrong[i], why, sizeof why));
        assert_true(strlen(why) > 10);
        assert_null(fmb_client_open(&wrong[i], little, sizeof little));
        assert_int_equal(strlen(little), sizeof little - 1);
        assert_null(fmb_client_open(&wrong[i], NULL, 0));
    }
    fmb_client_close(NULL);
    lcm_destroy(lcm);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_the_bus_loses_is_asked_again),
        cmocka_unit_test(test_what_cannot_be_read_is_counted),
        cmocka_unit_test(test_it_asks_again_when_the_service_is_back),
        cmocka_unit_test(test_nobody_there_costs_the_time_of_one_query),
        cmocka_unit_test(test_the_rest_has_no_answer),
        cmocka_unit_test(test_the_time_for_all_ends_it),
        cmocka_unit_test(test_the_time_for_all_ends_a_probe),
        cmocka_unit_test(test_who_is_slow_to_take_answers_gets_them_all),
        cmocka_unit_test(test_what_is_under_way_is_limited),
        cmocka_unit_test(test_lies_are_no_answers),
        cmocka_unit_test(test_of_a_pair_nothing_is_taken_that_was_not_asked),
        cmocka_unit_test(test_the_truth_after_lies_is_taken),
        cmocka_unit_test(test_steps_of_one_pair_end),
        cmocka_unit_test(test_slow_services_are_asked_less_at_once),
        cmocka_unit_test(test_unknown_bodies_for_ever_are_a_refusal),
        cmocka_unit_test(test_no_call_within_a_callback),
        cmocka_unit_test(test_watching),
        cmocka_unit_test(test_wrong_options_are_told),
    };
    return cmocka_run_group_tests_name("client_bad", tests, NULL, NULL);
}
