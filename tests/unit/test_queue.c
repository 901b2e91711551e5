/* Order, capacity; against a flood, against a naive model, and what memory is touched. */
#include "unit.h"

#include "draw.h"
#include "queue.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum { GUARD = 0xa5, CLIENTS = 100 };

/* Datagrams are cut from here, so that each byte of one shows its origin. */
static unsigned char noise[2 * QUEUE_DATAGRAM_MAX];
static unsigned char got_bytes[QUEUE_DATAGRAM_MAX + 1];

static int set_up(void **state)
{
    srand(1);
    for (size_t i = 0; i < sizeof noise; i++)
        noise[i] = (unsigned char) (rand() >> 8);
    return 0;
}

static struct queue *create(size_t chunks)
{
    struct queue *queue = queue_create(chunks, CLIENTS);
    assert_non_null(queue);
    return queue;
}

/* Odd kinds are scenes. */
static enum queue_fifo line_of(int kind)
{
    return kind % 2 ? QUEUE_SCENES : QUEUE_SHORT;
}

/* The kind says where the bytes were cut. */
static enum queue_put_result put(struct queue *queue, int client, int kind, size_t size)
{
    const struct queue_datagram datagram = {client, kind, size, .arrived_ns = 1000 + kind};
    return queue_put(queue, line_of(kind), &datagram, noise + kind);
}

static void keep(struct queue *queue, int client, int kind, size_t size)
{
    assert_int_equal(put(queue, client, kind, size), QUEUE_ADDED);
    assert_true(queue_waiting(queue, client)[line_of(kind)] > 0);
}

static void expect(const struct queue_datagram *got, int client, int kind, size_t size)
{
    assert_int_equal(got->client, client);
    assert_int_equal(got->kind, kind);
    assert_int_equal(got->arrived_ns, 1000 + kind);
    assert_int_equal(got->size, size);
    assert_memory_equal(got_bytes, noise + kind, size);
    assert_int_equal(got_bytes[size], GUARD);
}

static void expect_pop(struct queue *queue, int client, int kind, size_t size)
{
    struct queue_datagram got;
    got_bytes[size] = GUARD;
    assert_true(queue_pop(queue, client, line_of(kind), &got, got_bytes));
    expect(&got, client, kind, size);
}

static void expect_empty(struct queue *queue)
{
    struct queue_datagram got;
    for (int client = 0; client < CLIENTS; client++) {
        assert_int_equal(queue_oldest_ns(queue, client), INT64_MAX);
        for (int line = 0; line < QUEUE_FIFOS; line++) {
            assert_int_equal(queue_waiting(queue, client)[line], 0);
            assert_false(queue_pop(queue, client, (enum queue_fifo) line, &got, got_bytes));
        }
    }
    assert_int_equal(queue_largest(queue), -1);
    assert_false(queue_evict(queue, 0, &got, got_bytes));
    struct queue_counts counts = queue_counts(queue);
    assert_int_equal(counts.datagrams, 0);
    assert_int_equal(counts.chunks, 0);
    assert_int_equal(counts.clients, 0);
}

/* ---- A flood --------------------------------------------------------------------------------- */

enum { MODEST = CLIENTS - 1 };

struct flood {
    size_t chunks;
    int flooders;
    size_t size, modest_size;
};

/* Puts as the server does. The modest client loses nothing. */
static enum queue_put_result press(struct queue *queue, int client, size_t size)
{
    enum queue_put_result result;
    int evictions = 0;
    while ((result = put(queue, client, 0, size)) == QUEUE_FULL) {
        struct queue_datagram evicted;
        assert_true(++evictions <= QUEUE_DATAGRAM_MAX / QUEUE_CHUNK);
        assert_true(queue_evict(queue, queue_largest(queue), &evicted, got_bytes));
        assert_int_not_equal(evicted.client, MODEST);
    }
    return result;
}

/* The modest client sends its next query when it has an answer. Each is kept. */
static void withstand(struct flood flood)
{
    struct queue *queue = create(flood.chunks);
    const int rounds = 3000 / draw_step(6);
    int refused = 0;
    for (int round = 0; round < rounds; round++) {
        struct queue_datagram got;
        for (int i = 0; i < 20 * flood.flooders; i++)
            refused += press(queue, i % flood.flooders, flood.size) == QUEUE_REFUSED;
        assert_int_equal(press(queue, MODEST, flood.modest_size), QUEUE_ADDED);
        for (int i = 0; i < 20 * flood.flooders; i++)
            refused += press(queue, i % flood.flooders, flood.size) == QUEUE_REFUSED;
        assert_true(queue_pop(queue, MODEST, QUEUE_SHORT, &got, got_bytes));
        assert_true(queue_pop(queue, round % flood.flooders, QUEUE_SHORT, &got, got_bytes));
    }
    assert_true(refused > rounds);
    queue_destroy(queue);
}

/* Up to the share that is promised, to the chunk: 21 clients, 16 chunks each. */
static void many_floods_share_the_queue(void **state)
{
    const size_t chunks = 21 * 16;
    withstand((struct flood){.chunks = chunks, .flooders = 20, .size = 1, .modest_size = 65536});
    withstand((struct flood){.chunks = chunks, .flooders = 20, .size = 9000, .modest_size = 65536});
    withstand((struct flood){.chunks = chunks, .flooders = 20, .size = 65536, .modest_size = 400});
}

/* ---- Against a model ------------------------------------------------------------------------- */

enum { MODEL_CHUNKS = 300, MODEL_CLIENTS = 24 };

struct item {
    int client;
    int kind;
    size_t size;
};

/* What waits, in the order in which it came. */
struct model {
    struct item item[MODEL_CHUNKS];
    int items;
    int64_t capacity, items_most, chunks_most;
    int64_t put, refused, evicted, popped;
};

static int chunks_of(size_t size)
{
    int chunks = 0;
    for (size_t space = 0; space < size; space += QUEUE_CHUNK)
        chunks++;
    return chunks;
}

static int held(const struct model *model, int client)
{
    int chunks = 0;
    for (int i = 0; i < model->items; i++)
        if (model->item[i].client == client)
            chunks += chunks_of(model->item[i].size);
    return chunks;
}

static int held_by_all(const struct model *model)
{
    int chunks = 0;
    for (int i = 0; i < model->items; i++)
        chunks += chunks_of(model->item[i].size);
    return chunks;
}

static int clients_that_hold(const struct model *model)
{
    int clients = 0;
    for (int c = 0; c < MODEL_CLIENTS; c++)
        clients += held(model, c) > 0;
    return clients;
}

static void drop_item(struct model *model, int i)
{
    model->items--;
    memmove(&model->item[i], &model->item[i + 1],
            (size_t) (model->items - i) * sizeof *model->item);
}

static int64_t larger(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

static void add_item(struct model *model, struct item item)
{
    model->item[model->items++] = item;
    model->items_most = larger(model->items_most, model->items);
    model->chunks_most = larger(model->chunks_most, held_by_all(model));
}

static enum queue_put_result model_put(const struct model *model, struct item item)
{
    int64_t need = chunks_of(item.size), would_hold = held(model, item.client) + need;
    int64_t free_chunks = model->capacity - held_by_all(model), obtainable = free_chunks;
    for (int c = 0; c < MODEL_CLIENTS; c++)
        obtainable += larger(held(model, c) - would_hold, 0);
    return free_chunks >= need ? QUEUE_ADDED : obtainable >= need ? QUEUE_FULL : QUEUE_REFUSED;
}

/* The sender counted. */
static int clients_with(const struct model *model, int sender)
{
    return clients_that_hold(model) + !held(model, sender);
}

/* Any of those that hold most may be chosen, but it must hold more than a share. */
static void evict_one(struct queue *queue, struct model *model, int sender)
{
    struct queue_datagram evicted;
    memset(got_bytes, 0, sizeof got_bytes);
    assert_true(queue_evict(queue, queue_largest(queue), &evicted, got_bytes));
    for (int c = 0; c < MODEL_CLIENTS; c++)
        assert_true(held(model, c) <= held(model, evicted.client));
    assert_true(clients_with(model, sender) * held(model, evicted.client) > model->capacity);
    int newest = model->items - 1;
    while (model->item[newest].client != evicted.client)
        newest--;
    assert_int_equal(evicted.kind, model->item[newest].kind);
    assert_int_equal(evicted.size, model->item[newest].size);
    assert_memory_equal(got_bytes, noise + evicted.kind, evicted.size);
    drop_item(model, newest);
    model->evicted++;
}

static void put_both(struct queue *queue, struct model *model, struct item item)
{
    enum queue_put_result result = model_put(model, item);
    int evictions = 0;
    assert_int_equal(put(queue, item.client, item.kind, item.size), result);
    while (result == QUEUE_FULL) {
        evict_one(queue, model, item.client);
        assert_true(++evictions <= QUEUE_DATAGRAM_MAX / QUEUE_CHUNK);
        result = put(queue, item.client, item.kind, item.size);
        assert_int_equal(result, model_put(model, item));
        assert_int_not_equal(result, QUEUE_REFUSED);
    }
    model->put++;
    if (result == QUEUE_ADDED) {
        add_item(model, item);
        return;
    }
    int64_t would_hold = held(model, item.client) + chunks_of(item.size);
    assert_true(clients_with(model, item.client) * would_hold > model->capacity);
    model->refused++;
}

/* The oldest of a line in which something waits. */
static void pop_both(struct queue *queue, struct model *model)
{
    if (!model->items) {
        expect_empty(queue);
        return;
    }
    const struct item any = model->item[rand() % model->items];
    int oldest = 0;
    while (model->item[oldest].client != any.client ||
           line_of(model->item[oldest].kind) != line_of(any.kind))
        oldest++;
    expect_pop(queue, any.client, model->item[oldest].kind, model->item[oldest].size);
    drop_item(model, oldest);
    model->popped++;
}

static void compare_counts(const struct queue *queue, const struct model *model)
{
    struct queue_counts counts = queue_counts(queue);
    assert_int_equal(counts.datagrams, model->items);
    assert_int_equal(counts.chunks, held_by_all(model));
    assert_int_equal(counts.clients, clients_that_hold(model));
    assert_int_equal(counts.datagrams_most, model->items_most);
    assert_int_equal(counts.chunks_most, model->chunks_most);
    assert_int_equal(counts.capacity, model->capacity);
    assert_int_equal(queue_largest(queue) < 0, model->items == 0);
    for (int c = 0; c < MODEL_CLIENTS; c++) {
        int64_t oldest_ns[QUEUE_FIFOS] = {INT64_MAX, INT64_MAX}, waiting[QUEUE_FIFOS] = {0};
        for (int i = model->items - 1; i >= 0; i--)
            if (model->item[i].client == c) {
                const enum queue_fifo line = line_of(model->item[i].kind);
                oldest_ns[line] = 1000 + model->item[i].kind;
                waiting[line]++;
            }
        for (int line = 0; line < QUEUE_FIFOS; line++)
            assert_int_equal(queue_waiting(queue, c)[line], waiting[line]);
        assert_int_equal(queue_oldest_ns(queue, c),
                         oldest_ns[0] < oldest_ns[1] ? oldest_ns[0] : oldest_ns[1]);
    }
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

/* A few are drawn most often. */
static int draw_client(void)
{
    return rand() % (rand() % MODEL_CLIENTS + 1);
}

/* Turns from filling to draining and back. */
static void compare_with_model(int capacity, int operations)
{
    operations /= draw_step(4);
    struct queue *queue = create((size_t) capacity);
    struct model model = {.capacity = capacity};
    int puts_of_16 = 8;
    for (int i = 0; i < operations; i++) {
        if (rand() % (4 * capacity) == 0)
            puts_of_16 = rand() % 16 + 1;
        if (rand() % 16 < puts_of_16)
            put_both(queue, &model,
                     (struct item){draw_client(), rand() % QUEUE_DATAGRAM_MAX, draw_size()});
        else
            pop_both(queue, &model);
        compare_counts(queue, &model);
    }
    assert_true(model.refused > operations / 100);
    assert_true(capacity == 1 || model.evicted > operations / 1000);
    while (model.items)
        pop_both(queue, &model);
    expect_empty(queue);
    assert_int_equal(model.put, model.popped + model.refused + model.evicted);
    queue_destroy(queue);
}

static void the_queue_matches_a_model(void **state)
{
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

static long faults_of_some_more(struct queue *queue)
{
    struct queue_datagram got;
    long before = page_faults();
    for (int i = 0; i < 10000; i++)
        if (put(queue, i % CLIENTS, 0, 5000) != QUEUE_ADDED ||
            !queue_pop(queue, i % CLIENTS, QUEUE_SHORT, &got, got_bytes))
            return -1;
    return page_faults() - before;
}

/* After a flood as well, when all was touched long ago: a child that shares its pages gets its own
 * copy of those that it writes to, each by a fault. */
static void what_was_freed_last_is_used_first(void **state)
{
    enum { CHUNKS = 4096 };
    struct queue *queue = create(CHUNKS);
    for (int i = 0; i < CHUNKS; i++)
        keep(queue, i % CLIENTS, 0, QUEUE_CHUNK);
    for (int i = 0; i < CHUNKS; i++)
        expect_pop(queue, i % CLIENTS, 0, QUEUE_CHUNK);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(many_floods_share_the_queue),
        cmocka_unit_test(the_queue_matches_a_model),
        cmocka_unit_test(what_was_freed_last_is_used_first),
    };
    return cmocka_run_group_tests_name("queue", tests, set_up, NULL);
}
