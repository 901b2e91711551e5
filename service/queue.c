#include "queue.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* Why the promises of queue.h hold.
 *
 * Let C be the capacity, F the free chunks, h[c] what client c holds, and m the number of clients
 * that hold any, the sender s counted among them: C = F + sum of h[c]. A datagram of n chunks
 * arrives; with it the sender would hold L = h[s] + n. It is refused where
 *
 *     F + sum over c of max(h[c] - L, 0) < n                                               (1)
 *
 * and otherwise, while F < n, the newest datagram of a client that holds most is evicted.
 *
 * No eviction is in vain: each, of k chunks, raises F by k and lowers the sum in (1) by at most k,
 * so what was not refused is not refused afterwards. While F < n, the sum is positive: the client
 * that holds most holds more than L, and so is not the sender.
 *
 * A client that is refused wants more than a share, m * L > C: with h[c] <= L + max(h[c] - L, 0)
 * for the m - 1 others, and (1) in whole numbers,
 *
 *     C <= F + h[s] + (m - 1) * L + (n - 1 - F) = m * L - 1.
 *
 * A client that has a datagram evicted holds more than a share, m * h > C: it holds most,
 * h >= L + 1, and F <= n - 1, so that
 *
 *     C <= (n - 1) + h[s] + (m - 1) * h = L - 1 + (m - 1) * h <= m * h - 2.
 *
 * And its newest is evicted: h counts that datagram and all older ones. What is left may be less
 * than a share, by less than the size of what was evicted. */

/* Chunks and clients are linked by index. They count from 1: 0 is none, and what starts as 0 is
 * linked to nothing. A datagram is named by its first chunk. */
struct chunk {
    int32_t next; /* of the datagram, or of those that are free again */
    /* Of the first chunk: */
    int32_t older, newer; /* datagram of the line */
    int32_t size;         /* bytes of the datagram */
    int kind;
    uint64_t arrival; /* ascending */
};

struct client {
    int32_t chunks;                                   /* held */
    int32_t oldest[QUEUE_LINES], newest[QUEUE_LINES]; /* datagrams */
    int32_t equal_before, equal_after;                /* in the list of those that hold as many */
};

struct queue {
    unsigned char (*bytes)[QUEUE_CHUNK]; /* of each chunk, from 0 */
    struct chunk *chunk;
    int32_t free_chunk; /* freed last */
    struct client *client;
    int32_t *level; /* by number of chunks: first client that holds so many */
    int32_t top;    /* the most that any client holds */
    uint64_t arrivals;
    struct queue_counts counts;
};

struct queue *queue_create(size_t chunks, int clients)
{
    assert(chunks >= 1 && chunks <= QUEUE_CHUNKS_MAX && clients >= 1);
    struct queue *queue = calloc(1, sizeof *queue);
    if (!queue)
        return NULL;
    /* Large blocks of 0 take no memory before they are written to. */
    *queue = (struct queue){.bytes = aligned_alloc(QUEUE_CHUNK, chunks * QUEUE_CHUNK),
                            .chunk = calloc(chunks + 1, sizeof *queue->chunk),
                            .client = calloc((size_t) clients + 1, sizeof *queue->client),
                            .level = calloc(chunks + 1, sizeof *queue->level),
                            .counts = {.capacity = (int64_t) chunks}};
    if (!queue->bytes || !queue->chunk || !queue->client || !queue->level) {
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
    free(queue->level);
    free(queue);
}

/* ---- Chunks ---------------------------------------------------------------------------------- */

static int32_t chunks_of(size_t size)
{
    return (int32_t) ((size + QUEUE_CHUNK - 1) / QUEUE_CHUNK);
}

/* Bytes in the chunk of a datagram that starts at this place. */
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

/* The datagram, in no line yet. Enough chunks are free. */
static int32_t write_datagram(struct queue *queue, int kind, const unsigned char *bytes,
                              size_t size)
{
    int32_t first = 0, *link = &first;
    for (size_t start = 0; start < size; start += QUEUE_CHUNK) {
        int32_t chunk = take_chunk(queue);
        memcpy(queue->bytes[chunk - 1], bytes + start, piece(size, start));
        *link = chunk;
        link = &queue->chunk[chunk].next;
    }
    *link = 0;
    queue->chunk[first].size = (int32_t) size;
    queue->chunk[first].kind = kind;
    return first;
}

/* Frees its chunks. */
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

/* ---- Clients by what they hold -------------------------------------------------------------- */

static void leave_level(struct queue *queue, int32_t c)
{
    int32_t before = queue->client[c].equal_before, after = queue->client[c].equal_after;
    if (before)
        queue->client[before].equal_after = after;
    else
        queue->level[queue->client[c].chunks] = after;
    if (after)
        queue->client[after].equal_before = before;
}

static void join_level(struct queue *queue, int32_t c)
{
    int32_t *first = &queue->level[queue->client[c].chunks];
    queue->client[c].equal_before = 0;
    queue->client[c].equal_after = *first;
    if (*first)
        queue->client[*first].equal_before = c;
    *first = c;
}

/* Where the top falls, it falls no farther than to what this client still holds: by the chunks of
 * one datagram. */
static void hold(struct queue *queue, int32_t c, int32_t more_chunks)
{
    struct client *client = &queue->client[c];
    if (client->chunks)
        leave_level(queue, c);
    else
        queue->counts.clients++;
    client->chunks += more_chunks;
    queue->counts.chunks += more_chunks;
    if (client->chunks)
        join_level(queue, c);
    else
        queue->counts.clients--;
    if (client->chunks > queue->top)
        queue->top = client->chunks;
    while (queue->top && !queue->level[queue->top])
        queue->top--;
}

/* Free chunks, and what clients hold beyond the limit; counted as far as wanted. The first client
 * adds as many as there are levels above the limit, and each other one at least one: so neither
 * more levels nor more clients are visited than chunks are wanted. */
static int32_t obtainable(const struct queue *queue, int32_t limit, int32_t wanted)
{
    int32_t found = (int32_t) (queue->counts.capacity - queue->counts.chunks);
    for (int32_t level = queue->top; level > limit && found < wanted; level--)
        for (int32_t c = queue->level[level]; c && found < wanted; c = queue->client[c].equal_after)
            found += level - limit;
    return found;
}

/* ---- Lines ----------------------------------------------------------------------------------- */

static void append(struct queue *queue, int32_t c, enum queue_line line, int32_t datagram)
{
    struct client *client = &queue->client[c];
    queue->chunk[datagram].older = client->newest[line];
    queue->chunk[datagram].newer = 0;
    if (client->newest[line])
        queue->chunk[client->newest[line]].newer = datagram;
    else
        client->oldest[line] = datagram;
    client->newest[line] = datagram;
}

/* A datagram at either end of its line. */
static void unlink_datagram(struct queue *queue, int32_t c, enum queue_line line, int32_t datagram)
{
    struct client *client = &queue->client[c];
    int32_t older = queue->chunk[datagram].older, newer = queue->chunk[datagram].newer;
    if (older)
        queue->chunk[older].newer = newer;
    else
        client->oldest[line] = newer;
    if (newer)
        queue->chunk[newer].older = older;
    else
        client->newest[line] = older;
}

static void take(struct queue *queue, int32_t c, enum queue_line line, int32_t datagram,
                 struct queue_datagram *out, unsigned char *bytes)
{
    out->client = c - 1;
    out->kind = queue->chunk[datagram].kind;
    out->size = (size_t) queue->chunk[datagram].size;
    unlink_datagram(queue, c, line, datagram);
    read_datagram(queue, datagram, bytes);
    hold(queue, c, -chunks_of(out->size));
    queue->counts.datagrams--;
}

/* The line of the newest datagram of a client that holds any. */
static enum queue_line newest_line(const struct queue *queue, int32_t c)
{
    const int32_t *newest = queue->client[c].newest;
    const struct chunk *chunk = queue->chunk;
    if (!newest[QUEUE_SHORT])
        return QUEUE_SCENES;
    if (!newest[QUEUE_SCENES])
        return QUEUE_SHORT;
    return chunk[newest[QUEUE_SHORT]].arrival > chunk[newest[QUEUE_SCENES]].arrival ? QUEUE_SHORT
                                                                                    : QUEUE_SCENES;
}

/* ---- The whole ------------------------------------------------------------------------------- */

enum queue_put_result queue_put(struct queue *queue, int client, enum queue_line line, int kind,
                                const unsigned char *bytes, size_t size)
{
    assert(size >= 1 && size <= QUEUE_DATAGRAM_MAX);
    const int32_t chunks = chunks_of(size), c = client + 1;
    if (obtainable(queue, queue->client[c].chunks + chunks, chunks) < chunks)
        return QUEUE_REFUSED;
    if (queue->counts.capacity - queue->counts.chunks < chunks)
        return QUEUE_FULL;
    const int32_t datagram = write_datagram(queue, kind, bytes, size);
    queue->chunk[datagram].arrival = ++queue->arrivals;
    append(queue, c, line, datagram);
    hold(queue, c, chunks);
    if (++queue->counts.datagrams > queue->counts.datagrams_most)
        queue->counts.datagrams_most = queue->counts.datagrams;
    return QUEUE_KEPT;
}

bool queue_has(const struct queue *queue, int client, enum queue_line line)
{
    return queue->client[client + 1].oldest[line] != 0;
}

bool queue_pop(struct queue *queue, int client, enum queue_line line, struct queue_datagram *out,
               unsigned char bytes[QUEUE_DATAGRAM_MAX])
{
    const int32_t c = client + 1;
    if (!queue_has(queue, client, line))
        return false;
    take(queue, c, line, queue->client[c].oldest[line], out, bytes);
    return true;
}

bool queue_evict(struct queue *queue, struct queue_datagram *out,
                 unsigned char bytes[QUEUE_DATAGRAM_MAX])
{
    if (!queue->top)
        return false;
    const int32_t c = queue->level[queue->top];
    const enum queue_line line = newest_line(queue, c);
    take(queue, c, line, queue->client[c].newest[line], out, bytes);
    return true;
}

struct queue_counts queue_counts(const struct queue *queue)
{
    return queue->counts;
}
