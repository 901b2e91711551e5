/* Pending queries: bounded storage, shared by all clients.
 *
 * Each client has two FIFOs: one for short queries (pairs and definitions), one for scenes.
 * scheduler.h decides which client is served next.
 *
 * Capacity is counted in chunks. When too few are free, the newest datagram of a client that holds
 * most chunks is evicted. Only chunks above the total that the sender would then hold can be taken
 * from a client; if these are too few, the new datagram is refused (queue.c has the rule and the
 * proof). Let m be the number of clients that hold any chunk, the sender included, and
 * share = capacity / m:
 *
 * - A datagram is never refused if its client holds at most the share with it.
 * - A datagram is never evicted if it and all older ones of its client take at most the share.
 *
 * So a client whose pending datagrams never exceed capacity / (most clients pending at once) loses
 * nothing, whatever the others do. Every datagram that was added is popped or evicted exactly once.
 *
 * All memory is allocated by queue_create() and touched on first use; the chunk freed last is
 * reused first. An operation takes time proportional to the chunks of its datagram; if too few are
 * free, also to the highest number of a client so far: a nanosecond each. One queue may be used by
 * one thread at a time; queues share no state. */
#ifndef QUEUE_H
#define QUEUE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Most bytes of a datagram; UDP's limit is 65,507. */
enum { QUEUE_DATAGRAM_MAX = 65536 };

/* Bytes of a chunk: one page. Most queries have a few hundred bytes, and touch one page while they
 * are pending. Smaller chunks would touch no less memory, and need more links for large datagrams.
 */
enum { QUEUE_CHUNK = 4096 };

enum { QUEUE_CHUNKS_MAX = 1 << 20 }; /* 4 GiB */

enum queue_fifo { QUEUE_SHORT, QUEUE_SCENES, QUEUE_FIFOS };

struct queue;

struct queue_datagram {
    int client;
    int kind;           /* any value */
    size_t size;        /* bytes */
    int64_t arrived_ns; /* of any clock */
};

enum queue_put_result {
    QUEUE_ADDED,
    QUEUE_FULL,    /* not added yet: evict from queue_largest(), then call queue_put() again */
    QUEUE_REFUSED, /* not added: the other clients do not hold enough more than the sender */
};

struct queue_counts {
    int64_t datagrams, chunks, clients; /* pending now */
    int64_t capacity;                   /* chunks */
    /* Most ever pending at once. Only this many chunks of memory were ever touched. */
    int64_t datagrams_most, chunks_most;
};

/* On input: chunks from 1 to QUEUE_CHUNKS_MAX; clients from 1, numbered 0 to clients - 1 below.
 * Returns NULL if out of memory. The caller destroys it; queue_destroy() accepts NULL. */
struct queue *queue_create(size_t chunks, int clients);
void queue_destroy(struct queue *queue);

/* Copies a datagram to the end of a FIFO of its client. On input: size from 1 to
 * QUEUE_DATAGRAM_MAX. queue_pop() and queue_evict() return the same *datagram and bytes.
 *
 * QUEUE_FULL and QUEUE_REFUSED change nothing. After QUEUE_FULL, if evictions and queue_put()
 * alternate with no other change between them, the datagram is added after at most
 * QUEUE_DATAGRAM_MAX / QUEUE_CHUNK evictions. */
enum queue_put_result queue_put(struct queue *queue, enum queue_fifo fifo,
                                const struct queue_datagram *datagram, const unsigned char *bytes);

/* [fifo] Number of datagrams in each FIFO of a client. The array follows later changes. */
const int64_t *queue_waiting(const struct queue *queue, int client);

/* Arrival time of the oldest pending datagram of a client, nanoseconds; INT64_MAX: none. */
int64_t queue_oldest_ns(const struct queue *queue, int client);

/* Removes the oldest datagram of a FIFO. On output: *out, and its out->size bytes. Returns false,
 * and changes nothing, if the FIFO is empty. */
bool queue_pop(struct queue *queue, int client, enum queue_fifo fifo, struct queue_datagram *out,
               unsigned char bytes[QUEUE_DATAGRAM_MAX]);

/* Returns a client that holds most chunks: after QUEUE_FULL, evict from it. -1: the queue is empty.
 */
int queue_largest(const struct queue *queue);

/* Removes the newest datagram of a client, in whichever FIFO it is. On output: as for queue_pop().
 * Returns false, and changes nothing, if the client has none. */
bool queue_evict(struct queue *queue, int client, struct queue_datagram *out,
                 unsigned char bytes[QUEUE_DATAGRAM_MAX]);

struct queue_counts queue_counts(const struct queue *queue);

#endif
