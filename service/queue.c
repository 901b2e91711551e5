#include "queue.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* Why the promises of queue.h hold.
 *
 * Let C be the capacity, F the free chunks, h[c] what client c holds, and m the number of clients
 * that hold any, the sender s counted among them: C = F + sum of h[c]. A datagram of n chunks
 * comes; with it the sender would hold L = h[s] + n. It is refused where
 *
 *     F + sum over c of max(h[c] - L, 0) < n                                               (1)
 *
 * and otherwise, while F < n, the newest datagram of one that holds most is thrown out.
 *
 * Nothing is thrown out in vain: each throw, of k chunks, raises F by k and lowers the sum in (1)
 * by k at most, so what was not refused is not refused afterwards. While F < n, the sum is
 * positive: who holds most holds more than L, and so is not the sender.
 *
 * Who is refused wants more than a share, m * L > C: with h[c] <= L + max(h[c] - L, 0) for the
 * m - 1 others, and (1) in whole numbers,
 *
 *     C <= F + h[s] + (m - 1) * L + (n - 1 - F) = m * L - 1.
 *
 * Who has a datagram thrown out holds more than a share, m * h > C: it holds most, h >= L + 1, and
 * F <= n - 1, so that
 *
 *     C <= (n - 1) + h[s] + (m - 1) * h = L - 1 + (m - 1) * h <= m * h - 2.
 *
 * And it is its newest that goes: h counts that datagram and all older ones. What is left may be
 * less than a share, by less than the size of what went. */

/* Chunks and clients are linked by index. They count from 1: 0 is none, and what starts as 0 is
 * linked to nothing. A datagram is called by its first chunk. */
struct chunk {
    int32_t next; /* of the datagram, or of those that are free again */
    /* Of the first chunk: */
    int32_t older, newer; /* datagram of the client */
    int32_t size;         /* bytes of the datagram */
    int kind;
};

struct client {
    int64_t id;
    int32_t chunks;                    /* held */
    int32_t oldest, newest;            /* datagrams */
    int32_t next;                      /* in the bucket, or of those that are free again */
    int32_t before, after;             /* in the ring of turns */
    int32_t equal_before, equal_after; /* in the list of those that hold as many */
};

struct queue {
    unsigned char (*bytes)[QUEUE_CHUNK]; /* of each chunk, from 0 */
    struct chunk *chunk;
    int32_t free_chunk; /* freed last */
    /* Client 0 holds nothing and closes the ring of turns: after it comes who is next. */
    struct client *client;
    int32_t free_client;
    int32_t *bucket; /* first client of each */
    uint64_t multiplier;
    int bucket_shift;
    int32_t *level; /* by number of chunks: first client that holds so many */
    int32_t top;    /* the most that any client holds */
    struct queue_counts counts;
};

struct queue *queue_create(size_t chunks, uint64_t seed)
{
    assert(chunks >= 1 && chunks <= QUEUE_CHUNKS_MAX);
    int bucket_bits = 1;
    while ((size_t) 1 << bucket_bits < chunks)
        bucket_bits++;
    struct queue *queue = calloc(1, sizeof *queue);
    if (!queue)
        return NULL;
    /* Large blocks of 0 take no memory before they are written to. */
    *queue = (struct queue){.bytes = aligned_alloc(QUEUE_CHUNK, chunks * QUEUE_CHUNK),
                            .chunk = calloc(chunks + 1, sizeof *queue->chunk),
                            .client = calloc(chunks + 1, sizeof *queue->client),
                            .bucket = calloc((size_t) 1 << bucket_bits, sizeof *queue->bucket),
                            .multiplier = seed | 1,
                            .bucket_shift = 64 - bucket_bits,
                            .level = calloc(chunks + 1, sizeof *queue->level),
                            .counts = {.capacity = (int64_t) chunks}};
    if (!queue->bytes || !queue->chunk || !queue->client || !queue->bucket || !queue->level) {
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
    free(queue->bucket);
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

/* The datagram, in no line yet. There is room for it. */
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

/* ---- Clients: by id -------------------------------------------------------------------------- */

/* The highest bits of the product with a random odd number: two ids fall into one bucket with a
 * probability of 2 / buckets at most, whoever chose them without knowing the number
 * (Dietzfelbinger, Hagerup, Katajainen, Penttonen: A reliable randomized algorithm for the
 * closest-pair problem, 1997). There are as many buckets as there can be clients: two others at
 * most stand in a client's way on average. The collisions of query_id_hash() are known to
 * everybody. */
static int32_t *bucket_of(struct queue *queue, int64_t id)
{
    return &queue->bucket[(uint64_t) id * queue->multiplier >> queue->bucket_shift];
}

static int32_t find_client(struct queue *queue, int64_t id)
{
    int32_t c = *bucket_of(queue, id);
    while (c && queue->client[c].id != id)
        c = queue->client[c].next;
    return c;
}

/* ---- Clients: the ring of turns -------------------------------------------------------------- */

static void leave_ring(struct queue *queue, int32_t c)
{
    int32_t before = queue->client[c].before, after = queue->client[c].after;
    queue->client[before].after = after;
    queue->client[after].before = before;
}

static void join_ring(struct queue *queue, int32_t c)
{
    int32_t last = queue->client[0].before;
    queue->client[c].before = last;
    queue->client[c].after = 0;
    queue->client[last].after = c;
    queue->client[0].before = c;
}

/* ---- Clients: by what they hold -------------------------------------------------------------- */

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
    if (queue->client[c].chunks)
        leave_level(queue, c);
    queue->client[c].chunks += more_chunks;
    queue->counts.chunks += more_chunks;
    if (queue->client[c].chunks)
        join_level(queue, c);
    if (queue->client[c].chunks > queue->top)
        queue->top = queue->client[c].chunks;
    while (queue->top && !queue->level[queue->top])
        queue->top--;
}

/* Free chunks, and what clients hold beyond the limit; counted as far as wanted. The first client
 * adds as many as there are levels above the limit, and each other one at least: so neither more
 * levels nor more clients are looked at than chunks are wanted. */
static int32_t room(const struct queue *queue, int32_t limit, int32_t wanted)
{
    int32_t found = (int32_t) (queue->counts.capacity - queue->counts.chunks);
    for (int32_t level = queue->top; level > limit && found < wanted; level--)
        for (int32_t c = queue->level[level]; c && found < wanted; c = queue->client[c].equal_after)
            found += level - limit;
    return found;
}

/* ---- Clients: they come and go --------------------------------------------------------------- */

static int32_t add_client(struct queue *queue, int64_t id)
{
    int32_t c = queue->free_client;
    if (!c)
        c = (int32_t) ++queue->counts.clients_most;
    else
        queue->free_client = queue->client[c].next;
    int32_t *bucket = bucket_of(queue, id);
    queue->client[c] = (struct client){.id = id, .next = *bucket};
    *bucket = c;
    join_ring(queue, c);
    queue->counts.clients++;
    return c;
}

static void remove_client(struct queue *queue, int32_t c)
{
    int32_t *link = bucket_of(queue, queue->client[c].id);
    while (*link != c)
        link = &queue->client[*link].next;
    *link = queue->client[c].next;
    leave_ring(queue, c);
    queue->client[c].next = queue->free_client;
    queue->free_client = c;
    queue->counts.clients--;
}

/* ---- Datagrams in the lines of clients ------------------------------------------------------- */

static void append(struct queue *queue, int32_t c, int32_t datagram)
{
    struct client *client = &queue->client[c];
    queue->chunk[datagram].older = client->newest;
    queue->chunk[datagram].newer = 0;
    if (client->newest)
        queue->chunk[client->newest].newer = datagram;
    else
        client->oldest = datagram;
    client->newest = datagram;
}

/* One at either end of the line. */
static void unlink_datagram(struct queue *queue, int32_t c, int32_t datagram)
{
    struct client *client = &queue->client[c];
    int32_t older = queue->chunk[datagram].older, newer = queue->chunk[datagram].newer;
    if (older)
        queue->chunk[older].newer = newer;
    else
        client->oldest = newer;
    if (newer)
        queue->chunk[newer].older = older;
    else
        client->newest = older;
}

/* The client goes with its last datagram. */
static void take_out(struct queue *queue, int32_t c, int32_t datagram, struct queue_datagram *out,
                     unsigned char *bytes)
{
    out->client_id = queue->client[c].id;
    out->kind = queue->chunk[datagram].kind;
    out->size = (size_t) queue->chunk[datagram].size;
    unlink_datagram(queue, c, datagram);
    read_datagram(queue, datagram, bytes);
    hold(queue, c, -chunks_of(out->size));
    if (!queue->client[c].oldest)
        remove_client(queue, c);
    queue->counts.datagrams--;
}

/* ---- The whole ------------------------------------------------------------------------------- */

enum queue_put_result queue_put(struct queue *queue, int64_t client_id, int kind,
                                const unsigned char *bytes, size_t size)
{
    assert(size >= 1 && size <= QUEUE_DATAGRAM_MAX);
    int32_t chunks = chunks_of(size), c = find_client(queue, client_id);
    if (room(queue, queue->client[c].chunks + chunks, chunks) < chunks)
        return QUEUE_REFUSED;
    if (queue->counts.capacity - queue->counts.chunks < chunks)
        return QUEUE_FULL;
    if (!c)
        c = add_client(queue, client_id);
    append(queue, c, write_datagram(queue, kind, bytes, size));
    hold(queue, c, chunks);
    if (++queue->counts.datagrams > queue->counts.datagrams_most)
        queue->counts.datagrams_most = queue->counts.datagrams;
    return QUEUE_KEPT;
}

bool queue_pop(struct queue *queue, struct queue_datagram *out,
               unsigned char bytes[QUEUE_DATAGRAM_MAX])
{
    int32_t c = queue->client[0].after;
    if (!c)
        return false;
    leave_ring(queue, c);
    join_ring(queue, c);
    take_out(queue, c, queue->client[c].oldest, out, bytes);
    return true;
}

bool queue_throw(struct queue *queue, struct queue_datagram *out,
                 unsigned char bytes[QUEUE_DATAGRAM_MAX])
{
    if (!queue->top)
        return false;
    int32_t c = queue->level[queue->top];
    take_out(queue, c, queue->client[c].newest, out, bytes);
    return true;
}

struct queue_counts queue_counts(const struct queue *queue)
{
    return queue->counts;
}
