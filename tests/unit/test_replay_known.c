/* What keys stand for: the list of bodies against a naive model, what is learned from queries and
 * results, and how a query by key is answered with it. */
#include "answer_now.h"
#include "known_bodies.h"
#include "learn.h"

#include "answer.h"
#include "wire.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static uint64_t drawn = 1;

static uint64_t draw(uint64_t below)
{
    drawn = drawn * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (drawn >> 33) % below;
}

/* A cuboid whose edges have this length. */
static struct query_frame frame(int64_t id, double edge)
{
    struct query_frame out = {.body_id = id, .shape = FMB_CUBOID, .dim = 3};
    out.origin.count = 3;
    out.components.count = 9;
    for (int i = 0; i < 3; i++)
        out.components.number[4 * i] = edge;
    return out;
}

static struct query_frame by_key(int64_t id, int64_t key)
{
    struct query_frame out = frame(id, 0);
    out.key = key;
    out.components = (struct query_numbers){0};
    return out;
}

/* ---- The list ---- */

static void expect_known(struct known_bodies *known, int64_t id, int64_t key, double edge)
{
    const struct query_frame wanted = frame(id, edge);
    const struct known_body *body = known_bodies_find(known, id, key);
    assert_non_null(body);
    assert_int_equal(body->body_id, id);
    assert_int_equal(body->key, key);
    assert_true(known_bodies_same(body, &wanted));
    struct query_frame completed = by_key(id, key);
    assert_true(known_bodies_complete(known, &completed));
    assert_int_equal(completed.key, key);
    assert_memory_equal(&completed.components, &wanted.components, sizeof wanted.components);
}

static void test_learns_and_finds(void **state)
{
    (void) state;
    struct known_bodies *known = known_bodies_create(3);
    struct query_frame cube = frame(7, 1);
    assert_null(known_bodies_find(known, 7, 100));
    assert_non_null(known_bodies_learn(known, &cube, 100, 99));
    expect_known(known, 7, 100, 1);
    assert_null(known_bodies_find(known, 7, 101));
    assert_null(known_bodies_find(known, 8, 100));
    assert_true(known_bodies_has(known, 7, 100, 99, false));
    assert_false(known_bodies_has(known, 7, 100, 98, false));
    known_bodies_find(known, 7, 100)->key_now = 5;
    cube = frame(7, 2); /* the same key, for something else: the later one counts */
    known_bodies_learn(known, &cube, 100, 98);
    expect_known(known, 7, 100, 2);
    assert_int_equal(known_bodies_find(known, 7, 100)->key_now, 0);
    assert_true(known_bodies_has(known, 7, 100, 98, false));
    assert_false(known_bodies_has(known, 7, 100, 99, false));
    known_bodies_destroy(known);
    known_bodies_destroy(NULL);
}

static void test_what_is_no_body_is_not_learned(void **state)
{
    (void) state;
    struct known_bodies *known = known_bodies_create(3);
    struct query_frame bad[] = {frame(0, 1),        frame(-1, 1),  frame(INT64_MIN, 1),
                                frame(1, HUGE_VAL), frame(1, NAN), by_key(1, 5),
                                frame(1, 1),        frame(1, 1),   frame(1, 1)};
    bad[6].shape = 77;
    bad[7].components.count = 1000; /* of which only the first were kept */
    bad[8].dim = 1000;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_null(known_bodies_learn(known, &bad[i], 5, 99));
        assert_null(known_bodies_find(known, bad[i].body_id, 5));
    }
    known_bodies_destroy(known);
}

static void test_another_shape_is_not_completed(void **state)
{
    (void) state;
    struct known_bodies *known = known_bodies_create(3);
    const struct query_frame cube = frame(7, 1);
    known_bodies_learn(known, &cube, 100, 99);
    struct query_frame other = by_key(7, 100);
    other.shape = FMB_TETRAHEDRON;
    const struct query_frame before = other;
    assert_false(known_bodies_complete(known, &other));
    assert_memory_equal(&other, &before, sizeof other);
    other = by_key(7, 100);
    other.dim = 2;
    assert_false(known_bodies_complete(known, &other));
    other = by_key(7, 101);
    assert_false(known_bodies_complete(known, &other));
    known_bodies_destroy(known);
}

/* The model: a list that is searched from its beginning, and a hand that goes round in it and
 * spares once those that were used since it came by. */
enum { MODEL_MAX = 64 };

struct model_body {
    int64_t id, key, server_id;
    double edge;
    bool used;
};

struct model {
    int count, capacity, hand;
    struct model_body body[MODEL_MAX];
};

/* NULL: it is not there. */
static struct model_body *model_find(struct model *model, int64_t id, int64_t key)
{
    for (int i = 0; i < model->count; i++)
        if (model->body[i].id == id && model->body[i].key == key) {
            model->body[i].used = true;
            return &model->body[i];
        }
    return NULL;
}

static struct model_body *model_room(struct model *model)
{
    if (model->count < model->capacity)
        return &model->body[model->count++];
    while (model->body[model->hand].used) {
        model->body[model->hand].used = false;
        model->hand = (model->hand + 1) % model->capacity;
    }
    struct model_body *room = &model->body[model->hand];
    model->hand = (model->hand + 1) % model->capacity;
    return room;
}

static void model_learn(struct model *model, int64_t id, int64_t key, int64_t server_id,
                        double edge)
{
    struct model_body *body = model_find(model, id, key);
    const bool used = body != NULL;
    if (!body)
        body = model_room(model);
    *body = (struct model_body){id, key, server_id, edge, used};
}

static void check_one(struct known_bodies *known, struct model *model)
{
    const int64_t id = 1 + (int64_t) draw(7), key = (int64_t) draw(5) - 2;
    const int64_t server_id = (int64_t) draw(3);
    const struct query_frame cube = frame(id, 1 + (double) draw(3));
    const struct model_body *body;
    switch (draw(3)) {
    case 0:
        known_bodies_learn(known, &cube, key, server_id);
        model_learn(model, id, key, server_id, cube.components.number[0]);
        break;
    case 1:
        if ((body = model_find(model, id, key)))
            expect_known(known, id, key, body->edge);
        else
            assert_null(known_bodies_find(known, id, key));
        break;
    default: {
        body = model_find(model, id, key);
        const bool has = body && body->server_id == server_id;
        assert_int_equal(known_bodies_has(known, id, key, server_id, false), has);
    }
    }
}

static void test_against_the_model(void **state)
{
    static const int capacities[] = {1, 2, 3, 5, 17, 64};
    (void) state;
    for (size_t i = 0; i < sizeof capacities / sizeof *capacities; i++) {
        struct model model = {.capacity = capacities[i]};
        struct known_bodies *known = known_bodies_create((size_t) capacities[i]);
        for (int round = 0; round < 20000; round++)
            check_one(known, &model);
        known_bodies_destroy(known);
    }
}

/* Ids that a log chose to be alike in all that a hash with known numbers makes of them: were they
 * all in one chain, this would take hours. */
static void test_ids_that_were_chosen(void **state)
{
    enum { MANY = 1 << 18 };
    (void) state;
    struct known_bodies *known = known_bodies_create(MANY);
    for (int64_t i = 0; i < MANY; i++) {
        const int64_t key = i;
        const int64_t id = (int64_t) ((query_id_mix(key) ^ 1) & (uint64_t) QUERY_ID_MAX) | 1;
        const struct query_frame cube = frame(id, 1);
        known_bodies_learn(known, &cube, key, 99);
    }
    known_bodies_destroy(known);
}

/* ---- Learning ---- */

static unsigned char query_bytes[QUERY_BYTES_MAX], result_bytes[QUERY_BYTES_MAX];

static struct match_item pair_item(const struct pair_query *query)
{
    return (struct match_item){.kind = LOG_PAIR_QUERY,
                               .bytes = query_bytes,
                               .size = (uint32_t) wire_write_pair_query(query, query_bytes)};
}

static struct match_item pair_result_item(const struct pair_result *result)
{
    return (struct match_item){.kind = LOG_PAIR_QUERY,
                               .bytes = result_bytes,
                               .size = (uint32_t) wire_write_pair_result(result, result_bytes)};
}

static struct pair_query pair(struct query_frame a, struct query_frame b)
{
    return (struct pair_query){.duration = 1, .frame = {a, b}};
}

/* What a service said to it. */
static struct pair_result said(const struct pair_query *query, int64_t server_id, int64_t key_a,
                               int64_t key_b)
{
    struct pair_result result = {.server_id = server_id, .key = {key_a, key_b}, .method = 4};
    for (int f = 0; f < 2; f++)
        result.body_id[f] = query->frame[f].body_id;
    result.answer.verdict = FMB_SEPARATED;
    return result;
}

static void learn_pair(struct learner *learner, struct pair_query query, struct pair_result result)
{
    const struct match_item query_item = pair_item(&query), result_item = pair_result_item(&result);
    learn(learner, &query_item, &result_item);
}

static void test_learns_from_pairs(void **state)
{
    (void) state;
    struct known_bodies *known = known_bodies_create(10);
    struct learner *learner = learner_open(known);
    struct pair_query query = pair(frame(1, 1), frame(2, 2));
    struct pair_result result = said(&query, 99, 500, 501);
    learn_pair(learner, query, result);
    expect_known(known, 1, 500, 1);
    expect_known(known, 2, 501, 2);
    query.frame[0] = frame(1, 3); /* replaced */
    query.frame[1] = by_key(2, 501);
    learn_pair(learner, query, said(&query, 99, 502, 501));
    expect_known(known, 1, 500, 1);
    expect_known(known, 1, 502, 3);
    expect_known(known, 2, 501, 2);
    learn_pair(learner, pair(frame(1, 4), frame(0, 5)), said(&query, 98, 500, 0));
    expect_known(known, 1, 500, 4); /* another service told the same key */
    assert_null(known_bodies_find(known, 0, 0));
    learner_close(learner);
    learner_close(NULL);
    known_bodies_destroy(known);
}

static void test_refusals_teach_nothing(void **state)
{
    (void) state;
    struct known_bodies *known = known_bodies_create(10);
    struct learner *learner = learner_open(known);
    const struct pair_query query = pair(frame(1, 1), frame(2, 2));
    struct pair_result result = said(&query, 99, 500, 501);
    result.status = FMB_BUSY;
    result.answer.verdict = 0;
    learn_pair(learner, query, result);
    assert_null(known_bodies_find(known, 1, 500));
    /* Nor do bytes that are no messages, however short. */
    const struct match_item query_item = pair_item(&query);
    result = said(&query, 99, 500, 501);
    struct match_item result_item = pair_result_item(&result);
    unsigned char *copy = malloc(result_item.size);
    for (uint32_t size = 0; size < result_item.size; size++) {
        struct match_item shorter = {.kind = LOG_PAIR_QUERY, .size = size};
        shorter.bytes = memcpy(copy + result_item.size - size, result_bytes, size);
        learn(learner, &query_item, &shorter);
        shorter.kind = LOG_SCENE_QUERY;
        learn(learner, &query_item, &shorter);
        assert_null(known_bodies_find(known, 1, 500));
    }
    free(copy);
    learner_close(learner);
    known_bodies_destroy(known);
}

/* A key is from 1 to 2^53 - 1: no service gives another, nor takes one. */
static void test_numbers_that_are_no_keys(void **state)
{
    static const int64_t bad[] = {-1, INT64_MIN, QUERY_ID_MAX + 1, INT64_MAX};
    (void) state;
    struct known_bodies *known = known_bodies_create(10);
    struct learner *learner = learner_open(known);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        const struct pair_query query = pair(frame(1, 1), frame(2, 2));
        learn_pair(learner, query, said(&query, 99, bad[i], 0));
        assert_null(known_bodies_find(known, 1, bad[i]));
    }
    learner_close(learner);
    known_bodies_destroy(known);
}

static void test_learns_from_scenes(void **state)
{
    static struct scene_query query;
    static struct scene_result result;
    (void) state;
    struct known_bodies *known = known_bodies_create(10);
    struct learner *learner = learner_open(known);
    query.frame_count = result.key_count = 5;
    for (int i = 0; i < 5; i++) {
        query.frame[i] = i == 2 ? by_key(i, 700) : frame(i, i + 1);
        result.key[i] = i ? 700 + i : 0;
    }
    result.server_id = 99;
    struct match_item query_item = {LOG_SCENE_QUERY, .bytes = query_bytes,
                                    .size = (uint32_t) wire_write_scene_query(&query, query_bytes)};
    struct match_item result_item = {LOG_SCENE_QUERY, .bytes = result_bytes};
    result.key_count = 0;
    result_item.size = (uint32_t) wire_write_scene_result(&result, result_bytes);
    learn(learner, &query_item, &result_item);
    assert_null(known_bodies_find(known, 1, 701));
    result.key_count = 4; /* of a service that lies: one is missing */
    result.status = FMB_UNKNOWN_BODY;
    result_item.size = (uint32_t) wire_write_scene_result(&result, result_bytes);
    learn(learner, &query_item, &result_item);
    assert_null(known_bodies_find(known, 1, 701));
    result.status = FMB_OK;
    result_item.size = (uint32_t) wire_write_scene_result(&result, result_bytes);
    learn(learner, &query_item, &result_item);
    expect_known(known, 1, 701, 2);
    assert_null(known_bodies_find(known, 2, 702)); /* that came by key */
    expect_known(known, 3, 703, 4);
    assert_null(known_bodies_find(known, 4, 704));
    result.key_count = 30; /* more than there are frames */
    result_item.size = (uint32_t) wire_write_scene_result(&result, result_bytes);
    learn(learner, &query_item, &result_item);
    expect_known(known, 4, 704, 5);
    learner_close(learner);
    known_bodies_destroy(known);
}

/* ---- Answering ---- */

static struct pair_result ask(struct answer_now *now, struct pair_query query,
                              enum answer_now_outcome expected)
{
    struct answered_now out;
    struct pair_result result;
    const struct match_item item = pair_item(&query);
    assert_int_equal(answer_now(now, LOG_PAIR_QUERY, item.bytes, item.size, &out), expected);
    assert_null(wire_read_pair_result(out.bytes, (uint32_t) out.size, &result));
    assert_int_equal(out.status, result.status);
    assert_int_equal(out.pairs, result.status == FMB_OK);
    return result;
}

/* Edges of 1 at 0, and of the given length at -2: it reaches the first where it is 2, and lies in
 * it where it is longer. */
static int verdict(struct answer_now *now, struct query_frame other)
{
    for (int axis = 0; axis < 3; axis++)
        other.origin.number[axis] = -2;
    return (int) ask(now, pair(frame(1000, 1), other), ANSWER_NOW_DONE).answer.verdict;
}

static void test_a_key_is_what_it_stood_for(void **state)
{
    (void) state;
    struct known_bodies *known = known_bodies_create(10);
    struct answer_now *now = answer_now_open(10, known);
    for (int edge = 1; edge <= 3; edge++) {
        const struct query_frame cube = frame(7, edge);
        known_bodies_learn(known, &cube, 100 + edge, 99);
    }
    for (int round = 0; round < 3; round++) /* the cache has only one of them at a time */
        for (int edge = 1; edge <= 3; edge++)
            assert_int_equal(verdict(now, by_key(7, 100 + edge)), edge);
    const struct query_frame cube = frame(7, 3);
    known_bodies_learn(known, &cube, 101, 98);
    assert_int_equal(verdict(now, by_key(7, 101)), FMB_OVERLAPPING);
    answer_now_close(now);
    answer_now_close(NULL);
    known_bodies_destroy(known);
}

/* A frame that has both, key and components, is what its components say, and says nothing of others
 * with the key: whoever sends components may send any key beside them. */
static void test_frames_that_have_both(void **state)
{
    (void) state;
    struct known_bodies *known = known_bodies_create(10);
    struct answer_now *now = answer_now_open(10, known);
    for (int round = 0; round < 2; round++)
        for (int edge = 1; edge <= 3; edge++) {
            struct query_frame both = frame(7, edge);
            both.key = 300;
            assert_int_equal(verdict(now, both), edge);
        }
    assert_null(known_bodies_find(known, 7, 300));
    ask(now, pair(frame(1000, 1), by_key(7, 300)), ANSWER_NOW_WITHOUT_BODY);
    const struct query_frame cube = frame(7, 3); /* a result says what it is */
    known_bodies_learn(known, &cube, 300, 99);
    for (int edge = 1; edge <= 3; edge++) {
        struct query_frame both = frame(7, edge);
        both.key = 300;
        assert_int_equal(verdict(now, both), edge);
        assert_int_equal(verdict(now, by_key(7, 300)), FMB_OVERLAPPING);
    }
    answer_now_close(now);
    known_bodies_destroy(known);
}

/* It counts as one by key: a scene's result tells no keys, and has room for more. */
static void test_scenes_of_frames_that_have_both(void **state)
{
    static struct scene_query scene;
    static struct scene_result result;
    (void) state;
    struct known_bodies *known = known_bodies_create(10);
    struct answer_now *now = answer_now_open(10, known);
    scene.frame_count = 3;
    scene.which = QUERY_PAIRS_ALL;
    for (int whole = 0; whole < 2; whole++) {
        struct answered_now out;
        for (int i = 0; i < 3; i++) {
            scene.frame[i] = frame(i + 1, 1);
            scene.frame[i].key = whole && i == 1 ? 0 : 300 + i;
        }
        const size_t size = wire_write_scene_query(&scene, query_bytes);
        assert_int_equal(answer_now(now, LOG_SCENE_QUERY, query_bytes, size, &out),
                         ANSWER_NOW_DONE);
        assert_null(wire_read_scene_result(out.bytes, (uint32_t) out.size, &result));
        assert_int_equal(result.key_count, whole ? 3 : 0);
        assert_int_equal(result.verdict_count, 3);
    }
    answer_now_close(now);
    known_bodies_destroy(known);
}

/* The list may have room for one body alone. */
static void test_frames_that_have_both_where_there_is_no_room(void **state)
{
    (void) state;
    struct known_bodies *known = known_bodies_create(1);
    struct answer_now *now = answer_now_open(1, known);
    struct pair_query query = pair(frame(7, 1), frame(8, 1));
    query.frame[0].key = 300;
    query.frame[1].key = 301;
    for (int round = 0; round < 3; round++) {
        struct answered_now out;
        const struct match_item item = pair_item(&query);
        answer_now(now, LOG_PAIR_QUERY, item.bytes, item.size, &out);
        query.frame[round % 2].components.count = 0;
    }
    answer_now_close(now);
    known_bodies_destroy(known);
}

static void test_keys_that_are_not_known(void **state)
{
    (void) state;
    struct known_bodies *known = known_bodies_create(10);
    struct answer_now *now = answer_now_open(10, known);
    struct pair_query query = pair(frame(1, 1), by_key(7, 300));
    assert_int_equal(ask(now, query, ANSWER_NOW_WITHOUT_BODY).status, FMB_UNKNOWN_BODY);
    query.frame[1] = by_key(7, 1); /* one that the cache here gives */
    assert_int_equal(ask(now, query, ANSWER_NOW_WITHOUT_BODY).status, FMB_UNKNOWN_BODY);
    query.frame[1] = by_key(0, 1);
    assert_int_equal(ask(now, query, ANSWER_NOW_WITHOUT_BODY).status, FMB_UNKNOWN_BODY);
    answer_now_close(now);
    known_bodies_destroy(known);
}

/* As the service says of them, whose cache is not asked. */
static void test_keys_that_cannot_be(void **state)
{
    static const int64_t bad[] = {-1, INT64_MIN, QUERY_ID_MAX + 1, INT64_MAX};
    (void) state;
    struct known_bodies *known = known_bodies_create(10);
    struct answer_now *now = answer_now_open(10, known);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        const struct pair_query query = pair(frame(1, 1), by_key(7, bad[i]));
        assert_int_equal(ask(now, query, ANSWER_NOW_DONE).status, FMB_BAD_ID);
    }
    answer_now_close(now);
    known_bodies_destroy(known);
}

/* ---- Sizes ---- */

static unsigned char large[LOG_DATA_MAX];

/* A pair query of that many bytes: its last list is long. */
static void make_large_pair(uint32_t size)
{
    struct pair_query query = pair(frame(1, 1), frame(2, 1));
    query.frame[1].velocity.count = 1;
    const size_t written = wire_write_pair_query(&query, large);
    const uint32_t count = 1 + (size - (uint32_t) written) / 8;
    const size_t at = written - 12;
    for (int i = 0; i < 4; i++)
        large[at + (size_t) i] = (unsigned char) (count >> (24 - 8 * i));
    memset(large + at + 4, 0, sizeof large - at - 4);
    assert_int_equal((size - written) % 8, 0);
}

static void expect_large(struct answer_now *now, enum log_kind kind, uint32_t size,
                         enum answer_now_outcome outcome, int32_t status)
{
    struct answered_now out;
    assert_int_equal(answer_now(now, kind, large, size, &out), outcome);
    if (outcome == ANSWER_NOW_DONE)
        assert_int_equal(out.status, status);
}

static void test_more_than_a_datagram(void **state)
{
    static struct scene_query scene;
    (void) state;
    struct known_bodies *known = known_bodies_create(10);
    struct answer_now *now = answer_now_open(10, known);
    struct pair_query query = pair(frame(1, 1), frame(2, 1));
    query.frame[1].velocity.count = 1;
    const uint32_t odd = (uint32_t) wire_write_pair_query(&query, large) % 8;
    const uint32_t last = (QUERY_BYTES_MAX - odd) / 8 * 8 + odd; /* at most a datagram */
    make_large_pair(last);
    expect_large(now, LOG_PAIR_QUERY, last, ANSWER_NOW_DONE, FMB_WRONG_COUNT);
    make_large_pair(last + 8);
    expect_large(now, LOG_PAIR_QUERY, last + 8, ANSWER_NOW_DONE, FMB_OVER_LIMIT);
    expect_large(now, LOG_PAIR_QUERY, last + 9, ANSWER_NOW_UNREADABLE, 0);
    scene.index_count = (QUERY_BYTES_MAX - WIRE_SCENE_QUERY_BYTES) / 2;
    assert_int_equal(wire_write_scene_query(&scene, large), QUERY_BYTES_MAX);
    expect_large(now, LOG_SCENE_QUERY, QUERY_BYTES_MAX, ANSWER_NOW_DONE, FMB_BAD_PAIR);
    expect_large(now, LOG_SCENE_QUERY, QUERY_BYTES_MAX - 1, ANSWER_NOW_UNREADABLE, 0);
    /* Of a larger scene the service looks at the header alone. */
    expect_large(now, LOG_SCENE_QUERY, QUERY_BYTES_MAX + 1, ANSWER_NOW_DONE, FMB_OVER_LIMIT);
    expect_large(now, LOG_SCENE_QUERY, LOG_DATA_MAX, ANSWER_NOW_DONE, FMB_OVER_LIMIT);
    answer_now_close(now);
    known_bodies_destroy(known);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_learns_and_finds),
        cmocka_unit_test(test_what_is_no_body_is_not_learned),
        cmocka_unit_test(test_another_shape_is_not_completed),
        cmocka_unit_test(test_against_the_model),
        cmocka_unit_test(test_ids_that_were_chosen),
        cmocka_unit_test(test_learns_from_pairs),
        cmocka_unit_test(test_refusals_teach_nothing),
        cmocka_unit_test(test_numbers_that_are_no_keys),
        cmocka_unit_test(test_learns_from_scenes),
        cmocka_unit_test(test_a_key_is_what_it_stood_for),
        cmocka_unit_test(test_frames_that_have_both),
        cmocka_unit_test(test_scenes_of_frames_that_have_both),
        cmocka_unit_test(test_frames_that_have_both_where_there_is_no_room),
        cmocka_unit_test(test_keys_that_are_not_known),
        cmocka_unit_test(test_keys_that_cannot_be),
        cmocka_unit_test(test_more_than_a_datagram),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
