/* Order, turns, room; against a flood, against a naive model, and what memory is touched. */
#include "queue.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#define SEED UINT64_C(0xb5c3a1f00d96e287)

enum { GUARD = 0xa5 };

/* Datagrams are cut from here, so that each byte of one tells where it is from. */
static unsigned char noise[2 * QUEUE_DATAGRAM_MAX];
static unsigned char got_bytes[QUEUE_DATAGRAM_MAX + 1];

static int set_up(void **state)
{
    (void) state;
    srand(1);
    for (size_t i = 0; i < sizeof noise; i++)
        noise[i] = (unsigned char) (rand() >> 8);
    return 0;
}

static struct queue *create(size_t chunks)
{
    struct queue *queue = queue_create(chunks, SEED);
    assert_non_null(queue);
    return queue;
}

/* The kind says where the bytes were cut. */
static enum queue_put_result put(struct queue *queue, int64_t client_id, int kind, size_t size)
{
    return queue_put(queue, client_id, kind, noise + kind, size);
}

static void keep(struct queue *queue, int64_t client_id, int kind, size_t size)
{
    assert_int_equal(put(queue, client_id, kind, size), QUEUE_KEPT);
}

typedef bool take(struct queue *queue, struct queue_datagram *out, unsigned char *bytes);

static void expect(take *take_one, struct queue *queue, int64_t client_id, int kind, size_t size)
{
    struct queue_datagram got;
    got_bytes[size] = GUARD;
    assert_true(take_one(queue, &got, got_bytes));
    assert_int_equal(got.client_id, client_id);
    assert_int_equal(got.kind, kind);
    assert_int_equal(got.size, size);
    assert_memory_equal(got_bytes, noise + kind, size);
    assert_int_equal(got_bytes[size], GUARD);
}

static void expect_empty(struct queue *queue)
{
    struct queue_datagram got;
    assert_false(queue_pop(queue, &got, got_bytes));
    assert_false(queue_throw(queue, &got, got_bytes));
    struct queue_counts counts = queue_counts(queue);
    assert_int_equal(counts.datagrams, 0);
    assert_int_equal(counts.chunks, 0);
    assert_int_equal(counts.clients, 0);
}

static void test_a_client_is_served_in_order(void **state)
{
    (void) state;
    struct queue *queue = create(8);
    expect_empty(queue);
    for (int i = 0; i < 5; i++)
        keep(queue, 7, i, 100);
    struct queue_counts counts = queue_counts(queue);
    assert_int_equal(counts.datagrams, 5);
    assert_int_equal(counts.chunks, 5);
    assert_int_equal(counts.clients, 1);
    assert_int_equal(counts.capacity, 8);
    for (int i = 0; i < 5; i++)
        expect(queue_pop, queue, 7, i, 100);
    expect_empty(queue);
    counts = queue_counts(queue);
    assert_int_equal(counts.datagrams_most, 5);
    assert_int_equal(counts.chunks_most, 5);
    assert_int_equal(counts.clients_most, 1);
    queue_destroy(queue);
}

static void test_clients_take_turns(void **state)
{
    (void) state;
    struct queue *queue = create(32);
    for (int i = 0; i < 4; i++)
        keep(queue, 1, 10 + i, 50);
    for (int i = 0; i < 2; i++)
        keep(queue, -2, 20 + i, 9000);
    keep(queue, INT64_MIN, 30, 1);
    expect(queue_pop, queue, 1, 10, 50);
    expect(queue_pop, queue, -2, 20, 9000);
    keep(queue, 0, 40, 60); /* joins behind all: each of the others has one turn before it */
    expect(queue_pop, queue, INT64_MIN, 30, 1);
    expect(queue_pop, queue, 1, 11, 50);
    keep(queue, INT64_MIN, 31, 1); /* was gone: joins anew */
    expect(queue_pop, queue, -2, 21, 9000);
    expect(queue_pop, queue, 0, 40, 60);
    expect(queue_pop, queue, 1, 12, 50);
    expect(queue_pop, queue, INT64_MIN, 31, 1);
    expect(queue_pop, queue, 1, 13, 50);
    expect_empty(queue);
    queue_destroy(queue);
}

static void test_sizes_around_whole_chunks(void **state)
{
    (void) state;
    struct queue *queue = create(40);
    for (int chunks = 1; chunks <= 16; chunks++)
        for (int off = -1; off <= 1; off++) {
            size_t size = (size_t) (chunks * QUEUE_CHUNK + off);
            if (size > QUEUE_DATAGRAM_MAX)
                continue;
            keep(queue, 1, chunks, size);
            keep(queue, 1, chunks + 1, size);
            assert_int_equal(queue_counts(queue).chunks, 2 * (chunks + (off > 0)));
            expect(queue_pop, queue, 1, chunks, size);
            expect(queue_throw, queue, 1, chunks + 1, size);
            expect_empty(queue);
        }
    queue_destroy(queue);
}

static void test_one_chunk(void **state)
{
    (void) state;
    struct queue *queue = create(1);
    assert_int_equal(put(queue, 1, 0, QUEUE_CHUNK + 1), QUEUE_REFUSED);
    assert_int_equal(put(queue, 1, 0, QUEUE_DATAGRAM_MAX), QUEUE_REFUSED);
    keep(queue, 1, 1, QUEUE_CHUNK);
    assert_int_equal(put(queue, 1, 2, 1), QUEUE_REFUSED);
    assert_int_equal(put(queue, 2, 3, 1), QUEUE_REFUSED); /* it would hold as much */
    expect(queue_pop, queue, 1, 1, QUEUE_CHUNK);
    keep(queue, 2, 4, 1);
    expect(queue_throw, queue, 2, 4, 1);
    expect_empty(queue);
    queue_destroy(queue);
}

static void test_the_biggest_holder_loses_its_newest(void **state)
{
    (void) state;
    struct queue *queue = create(10);
    for (int i = 0; i < 6; i++)
        keep(queue, 1, 10 + i, 100);
    for (int i = 0; i < 4; i++)
        keep(queue, 2, 20 + i, 100);
    assert_int_equal(put(queue, 1, 16, 100), QUEUE_REFUSED);  /* holds most itself */
    assert_int_equal(put(queue, 2, 24, 5000), QUEUE_REFUSED); /* would hold 6 as well */
    assert_int_equal(put(queue, 2, 24, 100), QUEUE_FULL);
    assert_int_equal(put(queue, 2, 24, 100), QUEUE_FULL); /* nothing has changed */
    expect(queue_throw, queue, 1, 15, 100);
    keep(queue, 2, 24, 100);
    /* 5 and 5: for one that comes, the others give in turn until all are alike. */
    for (int i = 0; i < 3; i++) {
        struct queue_datagram thrown;
        assert_int_equal(put(queue, 3, 30 + i, 100), QUEUE_FULL);
        assert_true(queue_throw(queue, &thrown, got_bytes));
        assert_in_range(thrown.client_id, 1, 2);
        keep(queue, 3, 30 + i, 100);
    }
    assert_int_equal(put(queue, 3, 33, 100), QUEUE_REFUSED); /* 4, 3 and 3 */
    queue_destroy(queue);
}

/* The first would give 3 chunks, which are not enough: nobody loses anything for nothing. */
static void test_nothing_is_thrown_in_vain(void **state)
{
    (void) state;
    struct queue *queue = create(19);
    for (int i = 0; i < 19; i++)
        keep(queue, 1, i, 1);
    assert_int_equal(put(queue, 2, 50, QUEUE_DATAGRAM_MAX), QUEUE_REFUSED);
    assert_int_equal(put(queue, 2, 50, 10 * QUEUE_CHUNK), QUEUE_REFUSED);
    for (int i = 0; i < 9; i++) {
        assert_int_equal(put(queue, 2, 50, 9 * QUEUE_CHUNK), QUEUE_FULL);
        expect(queue_throw, queue, 1, 18 - i, 1);
    }
    keep(queue, 2, 50, 9 * QUEUE_CHUNK);
    assert_int_equal(queue_counts(queue).chunks, 19);
    queue_destroy(queue);
}

/* ---- A flood --------------------------------------------------------------------------------- */

enum { MODEST = 1000 };

struct flood {
    size_t chunks;
    int flooders;
    size_t size, modest_size;
};

/* Puts as the server does. Whoever is thrown out, it is not the modest client. */
static enum queue_put_result press(struct queue *queue, int64_t client_id, size_t size)
{
    enum queue_put_result result;
    int throws = 0;
    while ((result = put(queue, client_id, 0, size)) == QUEUE_FULL) {
        struct queue_datagram thrown;
        assert_true(++throws <= QUEUE_DATAGRAM_MAX / QUEUE_CHUNK);
        assert_true(queue_throw(queue, &thrown, got_bytes));
        assert_int_not_equal(thrown.client_id, MODEST);
    }
    return result;
}

/* The modest client asks again when it has its answer. It is kept, and before it comes no more than
 * one of each flooder. */
static void withstand(struct flood flood)
{
    struct queue *queue = create(flood.chunks);
    enum { ROUNDS = 3000 };
    int refused = 0, waited = -1, served = 0; /* waited: turns; -1: nothing waits */
    for (int round = 0; round < ROUNDS; round++) {
        for (int i = 0; i < 20 * flood.flooders; i++)
            refused += press(queue, i % flood.flooders, flood.size) == QUEUE_REFUSED;
        if (waited < 0) {
            assert_int_equal(press(queue, MODEST, flood.modest_size), QUEUE_KEPT);
            waited = 0;
        }
        for (int turn = 0; turn < 2; turn++) {
            struct queue_datagram got;
            assert_true(queue_pop(queue, &got, got_bytes));
            if (got.client_id == MODEST) {
                served++;
                waited = -1;
            } else if (waited >= 0) {
                assert_true(++waited <= flood.flooders);
            }
        }
    }
    assert_true(refused > ROUNDS);
    /* Two turns a round; of its rounds of waiting the last may have a turn to spare. */
    assert_true(served >= 2 * ROUNDS / (flood.flooders + 2));
    queue_destroy(queue);
}

static void test_a_flood_of_small_ones(void **state)
{
    (void) state;
    withstand((struct flood){.chunks = 64, .flooders = 1, .size = 10, .modest_size = 400});
    withstand((struct flood){.chunks = 64, .flooders = 1, .size = 10, .modest_size = 65536});
}

static void test_a_flood_of_large_ones(void **state)
{
    (void) state;
    withstand((struct flood){.chunks = 64, .flooders = 1, .size = 65536, .modest_size = 400});
    withstand((struct flood){.chunks = 64, .flooders = 1, .size = 65536, .modest_size = 65536});
}

/* Up to the share that is promised, to the chunk: 21 clients, 16 chunks each. */
static void test_many_who_flood(void **state)
{
    (void) state;
    const size_t chunks = 21 * 16;
    withstand((struct flood){.chunks = chunks, .flooders = 20, .size = 1, .modest_size = 65536});
    withstand((struct flood){.chunks = chunks, .flooders = 20, .size = 9000, .modest_size = 65536});
    withstand((struct flood){.chunks = chunks, .flooders = 20, .size = 65536, .modest_size = 400});
}

/* ---- Against a model ------------------------------------------------------------------------- */

enum { MODEL_CHUNKS = 300, MODEL_IDS = 24 };

struct item {
    int64_t client_id;
    int kind;
    size_t size;
};

/* What waits, in the order in which it came, and the clients in the order of their turns. */
struct model {
    struct item item[MODEL_CHUNKS];
    int64_t turn[MODEL_IDS];
    int items, turns;
    int64_t capacity, items_most, chunks_most, turns_most;
    int64_t put, refused, thrown, popped;
};

static int chunks_of(size_t size)
{
    int chunks = 0;
    for (size_t room = 0; room < size; room += QUEUE_CHUNK)
        chunks++;
    return chunks;
}

static int held(const struct model *model, int64_t client_id)
{
    int chunks = 0;
    for (int i = 0; i < model->items; i++)
        if (model->item[i].client_id == client_id)
            chunks += chunks_of(model->item[i].size);
    return chunks;
}

static int held_by_all(const struct model *model)
{
    int chunks = 0;
    for (int t = 0; t < model->turns; t++)
        chunks += held(model, model->turn[t]);
    return chunks;
}

static void drop_turn(struct model *model, int64_t client_id)
{
    int kept = 0;
    for (int t = 0; t < model->turns; t++)
        if (model->turn[t] != client_id)
            model->turn[kept++] = model->turn[t];
    model->turns = kept;
}

static void drop_item(struct model *model, int i)
{
    int64_t client_id = model->item[i].client_id;
    model->items--;
    memmove(&model->item[i], &model->item[i + 1],
            (size_t) (model->items - i) * sizeof *model->item);
    if (!held(model, client_id))
        drop_turn(model, client_id);
}

static int64_t larger(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

static void add_item(struct model *model, struct item item)
{
    if (!held(model, item.client_id))
        model->turn[model->turns++] = item.client_id;
    model->item[model->items++] = item;
    model->items_most = larger(model->items_most, model->items);
    model->turns_most = larger(model->turns_most, model->turns);
    model->chunks_most = larger(model->chunks_most, held_by_all(model));
}

static enum queue_put_result model_put(const struct model *model, struct item item)
{
    int64_t need = chunks_of(item.size), would_hold = held(model, item.client_id) + need;
    int64_t free_chunks = model->capacity - held_by_all(model), room = free_chunks;
    for (int t = 0; t < model->turns; t++)
        room += larger(held(model, model->turn[t]) - would_hold, 0);
    return free_chunks >= need ? QUEUE_KEPT : room >= need ? QUEUE_FULL : QUEUE_REFUSED;
}

/* The sender counted. */
static int clients_with(const struct model *model, int64_t sender_id)
{
    return model->turns + !held(model, sender_id);
}

/* Any of those that hold most may be chosen, but more than a share it must be. */
static void throw_one(struct queue *queue, struct model *model, int64_t sender_id)
{
    struct queue_datagram thrown;
    memset(got_bytes, 0, sizeof got_bytes);
    assert_true(queue_throw(queue, &thrown, got_bytes));
    for (int t = 0; t < model->turns; t++)
        assert_true(held(model, model->turn[t]) <= held(model, thrown.client_id));
    assert_true(clients_with(model, sender_id) * held(model, thrown.client_id) > model->capacity);
    int newest = model->items - 1;
    while (model->item[newest].client_id != thrown.client_id)
        newest--;
    assert_int_equal(thrown.kind, model->item[newest].kind);
    assert_int_equal(thrown.size, model->item[newest].size);
    assert_memory_equal(got_bytes, noise + thrown.kind, thrown.size);
    drop_item(model, newest);
    model->thrown++;
}

static void put_both(struct queue *queue, struct model *model, struct item item)
{
    enum queue_put_result result = model_put(model, item);
    int throws = 0;
    assert_int_equal(put(queue, item.client_id, item.kind, item.size), result);
    while (result == QUEUE_FULL) {
        throw_one(queue, model, item.client_id);
        assert_true(++throws <= QUEUE_DATAGRAM_MAX / QUEUE_CHUNK);
        result = put(queue, item.client_id, item.kind, item.size);
        assert_int_equal(result, model_put(model, item));
        assert_int_not_equal(result, QUEUE_REFUSED);
    }
    model->put++;
    if (result == QUEUE_KEPT) {
        add_item(model, item);
        return;
    }
    int64_t would_hold = held(model, item.client_id) + chunks_of(item.size);
    assert_true(clients_with(model, item.client_id) * would_hold > model->capacity);
    model->refused++;
}

static void pop_both(struct queue *queue, struct model *model)
{
    if (!model->items) {
        expect_empty(queue);
        return;
    }
    int64_t client_id = model->turn[0];
    int oldest = 0;
    while (model->item[oldest].client_id != client_id)
        oldest++;
    expect(queue_pop, queue, client_id, model->item[oldest].kind, model->item[oldest].size);
    drop_turn(model, client_id);
    model->turn[model->turns++] = client_id;
    drop_item(model, oldest);
    model->popped++;
}

static void compare_counts(const struct queue *queue, const struct model *model)
{
    struct queue_counts counts = queue_counts(queue);
    assert_int_equal(counts.datagrams, model->items);
    assert_int_equal(counts.chunks, held_by_all(model));
    assert_int_equal(counts.clients, model->turns);
    assert_int_equal(counts.datagrams_most, model->items_most);
    assert_int_equal(counts.chunks_most, model->chunks_most);
    assert_int_equal(counts.clients_most, model->turns_most);
}

static size_t draw_size(void)
{
    switch (rand() % 8) {
    case 0: return (size_t) (rand() % QUEUE_DATAGRAM_MAX + 1);
    case 1: {
        size_t size = (size_t) ((rand() % 16 + 1) * QUEUE_CHUNK + rand() % 3 - 1);
        return size < QUEUE_DATAGRAM_MAX ? size : QUEUE_DATAGRAM_MAX;
    }
    default: return (size_t) (rand() % 600 + 1);
    }
}

/* Few ids are drawn most often; some are far apart, some differ in their highest bits alone. */
static int64_t draw_id(void)
{
    int i = rand() % (rand() % MODEL_IDS + 1);
    return i % 3 == 0 ? i : i % 3 == 1 ? INT64_MAX - i : (int64_t) ((uint64_t) i << 59);
}

/* Turns from filling to draining and back. */
static void compare_with_model(int capacity, int operations)
{
    struct queue *queue = create((size_t) capacity);
    struct model model = {.capacity = capacity};
    int puts_of_16 = 8;
    for (int i = 0; i < operations; i++) {
        if (rand() % (4 * capacity) == 0)
            puts_of_16 = rand() % 16 + 1;
        if (rand() % 16 < puts_of_16)
            put_both(queue, &model,
                     (struct item){draw_id(), rand() % QUEUE_DATAGRAM_MAX, draw_size()});
        else
            pop_both(queue, &model);
        compare_counts(queue, &model);
    }
    assert_true(model.refused > operations / 100);
    assert_true(capacity == 1 || model.thrown > operations / 1000);
    while (model.items)
        pop_both(queue, &model);
    expect_empty(queue);
    assert_int_equal(model.put, model.popped + model.refused + model.thrown);
    queue_destroy(queue);
}

static void test_against_a_model(void **state)
{
    (void) state;
    compare_with_model(1, 20000);
    compare_with_model(2, 20000);
    compare_with_model(17, 60000);
    compare_with_model(64, 60000);
    compare_with_model(MODEL_CHUNKS, 40000);
}

/* ---- Memory ---------------------------------------------------------------------------------- */

static long page_faults(void)
{
    struct rusage usage;
    assert_int_equal(getrusage(RUSAGE_SELF, &usage), 0);
    return usage.ru_minflt;
}

/* A large queue of which few chunks are in use at any time: each would be a fault if it were
 * touched. */
static void test_what_was_freed_is_used_again(void **state)
{
    (void) state;
    enum { CHUNKS = 65536 };
    struct queue *queue = create(CHUNKS);
    long before = page_faults();
    for (int i = 0; i < CHUNKS; i++) {
        keep(queue, i, i % 1000, 400);
        keep(queue, -i - 1, i % 1000, 5000);
        expect(queue_pop, queue, i, i % 1000, 400);
        expect(queue_pop, queue, -i - 1, i % 1000, 5000);
    }
    /* The hash table is touched everywhere: 4 bytes for each client that there could be. */
    assert_true(page_faults() - before < CHUNKS / 64);
    assert_int_equal(queue_counts(queue).chunks_most, 3);
    assert_int_equal(queue_counts(queue).clients_most, 2);
    queue_destroy(queue);
}

static long faults_of_some_more(struct queue *queue)
{
    struct queue_datagram got;
    long before = page_faults();
    for (int i = 0; i < 10000; i++)
        if (put(queue, i, 0, 5000) != QUEUE_KEPT || !queue_pop(queue, &got, got_bytes))
            return -1;
    return page_faults() - before;
}

/* After a flood as well, when all was touched long ago: a child that shares its pages gets its own
 * copy of those that it writes to, each by a fault. */
static void test_what_was_freed_last_is_used_first(void **state)
{
    (void) state;
    enum { CHUNKS = 4096 };
    struct queue *queue = create(CHUNKS);
    for (int i = 0; i < CHUNKS; i++)
        keep(queue, i, 0, QUEUE_CHUNK);
    for (int i = 0; i < CHUNKS; i++)
        expect(queue_pop, queue, i, 0, QUEUE_CHUNK);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        long faults = faults_of_some_more(queue);
        _exit(faults >= 0 && faults < CHUNKS / 8 ? 0 : 1);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 0);
    queue_destroy(queue);
}

static void test_all_chunks_come_back(void **state)
{
    (void) state;
    enum { CHUNKS = 64 };
    struct queue *queue = create(CHUNKS);
    for (int round = 0; round < 3; round++) {
        for (int i = 0; i < CHUNKS; i++)
            keep(queue, i, i, 1);
        assert_int_equal(put(queue, CHUNKS, 0, 1), QUEUE_REFUSED);
        for (int i = 0; i < CHUNKS; i++)
            expect(queue_pop, queue, i, i, 1);
        expect_empty(queue);
        for (int i = 0; i < CHUNKS / 16; i++)
            keep(queue, 1, i, QUEUE_DATAGRAM_MAX);
        for (int i = CHUNKS / 16 - 1; i >= 0; i--)
            expect(queue_throw, queue, 1, i, QUEUE_DATAGRAM_MAX);
        expect_empty(queue);
    }
    assert_int_equal(queue_counts(queue).clients_most, CHUNKS);
    queue_destroy(queue);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_client_is_served_in_order),
        cmocka_unit_test(test_clients_take_turns),
        cmocka_unit_test(test_sizes_around_whole_chunks),
        cmocka_unit_test(test_one_chunk),
        cmocka_unit_test(test_the_biggest_holder_loses_its_newest),
        cmocka_unit_test(test_nothing_is_thrown_in_vain),
        cmocka_unit_test(test_a_flood_of_small_ones),
        cmocka_unit_test(test_a_flood_of_large_ones),
        cmocka_unit_test(test_many_who_flood),
        cmocka_unit_test(test_against_a_model),
        cmocka_unit_test(test_what_was_freed_is_used_again),
        cmocka_unit_test(test_what_was_freed_last_is_used_first),
        cmocka_unit_test(test_all_chunks_come_back),
    };
    return cmocka_run_group_tests_name("queue", tests, set_up, NULL);
}
