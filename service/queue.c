#include "queue.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* Proof of the two guarantees in queue.h.
 *
 * Let C be the capacity, F the free chunks, h[c] what client c holds, and m the number of clients
 * that hold any, the sender s counted among them: C = F + sum of h[c]. A datagram of n chunks
 * arrives; with it the sender would hold L = h[s] + n. It is refused if
 *
 *     F + sum over c of max(h[c] - L, 0) < n                                               (1)
 *
 * and otherwise, while F < n, the newest datagram of a client that holds most is evicted.
 *
 * Evictions succeed. Evicting k chunks raises F by k and lowers the sum in (1) by at most k, so
 * that (1) does not become true: a datagram that was not refused at first is not refused later.
 * While F < n, the sum is positive; hence the client that holds most holds more than L, and is not
 * the sender.
 *
 * Refused datagrams exceed the share: m * L > C. With h[c] <= L + max(h[c] - L, 0) for the m - 1
 * others, and (1) in whole numbers (its left side is at most n - 1),
 *
 *     C <= F + h[s] + (m - 1) * L + (n - 1 - F) = m * L - 1.
 *
 * Evicted datagrams exceed the share: m * h > C for the h of their client. It holds most, so that
 * h >= L + 1 and no h[c] exceeds h; and F <= n - 1. Therefore
 *
 *     C <= (n - 1) + h[s] + (m - 1) * h = L - 1 + (m - 1) * h <= m * h - 2.
 *
 * The newest datagram is evicted, so h counts that datagram and all older ones. What the client has
 * left may be less than the share, by less than the size of the evicted datagram. */

/* Chunks are linked by index, counted from 1. Index 0 means none, so that memory of
 * zeros has no links. A datagram is identified by the index of its first chunk. */
struct queue_chunk {
    int32_t next; /* chunk of the same datagram, or next in the list of freed chunks */
    /* Set in the first chunk of a datagram only: */
    int32_t older, newer; /* neighbours in the FIFO: datagrams */
    int32_t size;         /* bytes of the datagram */
    int kind;
    int64_t arrived_ns;
    uint64_t arrival; /* number of the queue_put() call that added it */
};

struct queue_client {
    int64_t waiting[QUEUE_FIFOS];                     /* datagrams */
    int32_t oldest[QUEUE_FIFOS], newest[QUEUE_FIFOS]; /* datagrams */
};

struct queue {
    unsigned char (*bytes)[QUEUE_CHUNK]; /* of each chunk, from 0 */
    struct queue_chunk *chunk;
    int32_t free_chunk; /* the chunk freed last, first in the list of freed chunks */
    struct queue_client *client;
    int32_t *held;      /* [client] chunks; apart, so that all are read in 0.1 microseconds */
    int32_t client_end; /* no client from here on has held any */
    uint64_t arrivals;
    struct queue_counts counts;
};

struct queue *queue_create(size_t chunks, int clients)
{
    assert(chunks >= 1 && chunks <= QUEUE_CHUNKS_MAX && clients >= 1);
    struct queue *queue = calloc(1, sizeof *queue);
    if (!queue)
        return NULL;
    /* Large zeroed blocks take no memory before they are written to. */
    *queue = (struct queue){.bytes = aligned_alloc(QUEUE_CHUNK, chunks * QUEUE_CHUNK),
                            .chunk = calloc(chunks + 1, sizeof *queue->chunk),
                            .client = calloc((size_t) clients, sizeof *queue->client),
                            .held = calloc((size_t) clients, sizeof *queue->held),
                            .counts = {.capacity = (int64_t) chunks}};
    if (!queue->bytes || !queue->chunk || !queue->client || !queue->held) {
        queue_destroy(queue);
        return NULL;
    }
    return queue;
}

void queue_destroy(struct queue *queue)
{
    if (!queue)
        return;
    free(queue->bytes);
    free(queue->chunk);
    free(queue->client);
    free(queue->held);
    free(queue);
}

/* ---- Chunks ---------------------------------------------------------------------------------- */

static int32_t chunks_of(size_t size)
{
    return (int32_t) ((size + QUEUE_CHUNK - 1) / QUEUE_CHUNK);
}

/* Bytes in the chunk that begins at byte `start` of a datagram of `size` bytes. */
static size_t piece(size_t size, size_t start)
{
    return size - start < QUEUE_CHUNK ? size - start : QUEUE_CHUNK;
}

static int32_t take_chunk(struct queue *queue)
{
    int32_t chunk = queue->free_chunk;
    if (!chunk)
        chunk = (int32_t) ++queue->counts.chunks_most;
    else
        queue->free_chunk = queue->chunk[chunk].next;
    return chunk;
}

/* Copies a datagram into free chunks and returns its index. It is in no FIFO yet. On input: enough
 * chunks are free. */
static int32_t write_datagram(struct queue *queue, const struct queue_datagram *datagram,
                              const unsigned char *bytes)
{
    const size_t size = datagram->size;
    int32_t first = 0, *link = &first;
    for (size_t start = 0; start < size; start += QUEUE_CHUNK) {
        int32_t chunk = take_chunk(queue);
        memcpy(queue->bytes[chunk - 1], bytes + start, piece(size, start));
        *link = chunk;
        link = &queue->chunk[chunk].next;
    }
    *link = 0;
    queue->chunk[first].size = (int32_t) size;
    queue->chunk[first].kind = datagram->kind;
    queue->chunk[first].arrived_ns = datagram->arrived_ns;
    queue->chunk[first].arrival = ++queue->arrivals;
    return first;
}

/* Copies a datagram out, and frees its chunks. */
static void read_datagram(struct queue *queue, int32_t datagram, unsigned char *bytes)
{
    size_t size = (size_t) queue->chunk[datagram].size;
    int32_t chunk = datagram;
    for (size_t start = 0; start < size; start += QUEUE_CHUNK) {
        memcpy(bytes + start, queue->bytes[chunk - 1], piece(size, start));
        int32_t next = queue->chunk[chunk].next;
        queue->chunk[chunk].next = queue->free_chunk;
        queue->free_chunk = chunk;
        chunk = next;
    }
}

/* ---- What clients hold ----------------------------------------------------------------------- */

/* Adds more_chunks, which may be negative, to what the client holds. */
static void hold(struct queue *queue, int32_t c, int32_t more_chunks)
{
    const bool held = queue->held[c];
    queue->held[c] += more_chunks;
    queue->counts.chunks += more_chunks;
    queue->counts.clients += (queue->held[c] != 0) - held;
}

/* What clients hold above the limit together: the sum in (1) with L = limit. */
static int32_t held_above(const struct queue *queue, int32_t limit)
{
    int32_t sum = 0;
    for (int32_t c = 0; c < queue->client_end; c++)
        sum += queue->held[c] > limit ? queue->held[c] - limit : 0;
    return sum;
}

/* ---- FIFOs ----------------------------------------------------------------------------------- */

static void append(struct queue *queue, int32_t c, enum queue_fifo fifo, int32_t datagram)
{
    struct queue_client *client = &queue->client[c];
    queue->chunk[datagram].older = client->newest[fifo];
    queue->chunk[datagram].newer = 0;
    if (client->newest[fifo])
        queue->chunk[client->newest[fifo]].newer = datagram;
    else
        client->oldest[fifo] = datagram;
    client->newest[fifo] = datagram;
    client->waiting[fifo]++;
}

/* Removes a datagram from its FIFO. On input: its oldest or its newest. */
static void unlink_datagram(struct queue *queue, int32_t c, enum queue_fifo fifo, int32_t datagram)
{
    struct queue_client *client = &queue->client[c];
    int32_t older = queue->chunk[datagram].older, newer = queue->chunk[datagram].newer;
    if (older)
        queue->chunk[older].newer = newer;
    else
        client->oldest[fifo] = newer;
    if (newer)
        queue->chunk[newer].older = older;
    else
        client->newest[fifo] = older;
    client->waiting[fifo]--;
}

static void remove_datagram(struct queue *queue, int32_t c, enum queue_fifo fifo, int32_t datagram,
                            struct queue_datagram *out, unsigned char *bytes)
{
    out->client = c;
    out->kind = queue->chunk[datagram].kind;
    out->size = (size_t) queue->chunk[datagram].size;
    out->arrived_ns = queue->chunk[datagram].arrived_ns;
    unlink_datagram(queue, c, fifo, datagram);
    read_datagram(queue, datagram, bytes);
    hold(queue, c, -chunks_of(out->size));
    queue->counts.datagrams--;
}

/* The FIFO that has the client's newest datagram. On input: a client that holds one. */
static enum queue_fifo newest_fifo(const struct queue *queue, int32_t c)
{
    const int32_t *newest = queue->client[c].newest;
    const struct queue_chunk *chunk = queue->chunk;
    if (!newest[QUEUE_SHORT])
        return QUEUE_SCENES;
    if (!newest[QUEUE_SCENES])
        return QUEUE_SHORT;
    return chunk[newest[QUEUE_SHORT]].arrival > chunk[newest[QUEUE_SCENES]].arrival ? QUEUE_SHORT
                                                                                    : QUEUE_SCENES;
}

/* ---- Interface ------------------------------------------------------------------------------- */

enum queue_put_result queue_put(struct queue *queue, enum queue_fifo fifo,
                                const struct queue_datagram *datagram, const unsigned char *bytes)
{
    assert(datagram->size >= 1 && datagram->size <= QUEUE_DATAGRAM_MAX);
    const int32_t chunks = chunks_of(datagram->size), c = datagram->client;
    const int32_t missing = chunks - (int32_t) (queue->counts.capacity - queue->counts.chunks);
    if (missing > 0)
        return held_above(queue, queue->held[c] + chunks) < missing ? QUEUE_REFUSED : QUEUE_FULL;
    if (c >= queue->client_end)
        queue->client_end = c + 1;
    append(queue, c, fifo, write_datagram(queue, datagram, bytes));
    hold(queue, c, chunks);
    if (++queue->counts.datagrams > queue->counts.datagrams_most)
        queue->counts.datagrams_most = queue->counts.datagrams;
    return QUEUE_ADDED;
}

const int64_t *queue_waiting(const struct queue *queue, int client)
{
    return queue->client[client].waiting;
}

int64_t queue_oldest_ns(const struct queue *queue, int client)
{
    int64_t oldest_ns = INT64_MAX;
    for (int fifo = 0; fifo < QUEUE_FIFOS; fifo++) {
        const int32_t datagram = queue->client[client].oldest[fifo];
        if (datagram && queue->chunk[datagram].arrived_ns < oldest_ns)
            oldest_ns = queue->chunk[datagram].arrived_ns;
    }
    return oldest_ns;
}

bool queue_pop(struct queue *queue, int client, enum queue_fifo fifo, struct queue_datagram *out,
               unsigned char bytes[QUEUE_DATAGRAM_MAX])
{
    if (queue->client[client].waiting[fifo] == 0)
        return false;
    remove_datagram(queue, client, fifo, queue->client[client].oldest[fifo], out, bytes);
    return true;
}

int queue_largest(const struct queue *queue)
{
    int largest = 0;
    for (int32_t c = 1; c < queue->client_end; c++)
        if (queue->held[c] >= queue->held[largest])
            largest = c;
    return queue->held[largest] > 0 ? largest : -1;
}

bool queue_evict(struct queue *queue, int client, struct queue_datagram *out,
                 unsigned char bytes[QUEUE_DATAGRAM_MAX])
{
    if (queue->held[client] == 0)
        return false;
    const enum queue_fifo fifo = newest_fifo(queue, client);
    remove_datagram(queue, client, fifo, queue->client[client].newest[fifo], out, bytes);
    return true;
}

struct queue_counts queue_counts(const struct queue *queue)
{
    return queue->counts;
}
