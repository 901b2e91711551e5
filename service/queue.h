/* Pending queries: bounded storage, shared by all clients.
 *
 * Each client has two first-in, first-out lines: one for short queries (pairs and definitions), one
 * for scenes. turns.h decides which client is served next.
 *
 * Capacity is counted in chunks. When none is free, the client that holds most loses its newest
 * datagram, but it keeps at least as much as the sender would then hold. Let m be the number of
 * clients that hold any chunk, the sender included, and share = capacity / m:
 *
 * - A datagram is never refused if its client holds at most the share with it.
 * - A datagram is never evicted if it and all older ones of its client take at most the share.
 *
 * So a client whose pending datagrams never exceed capacity / (most clients pending at once) loses
 * nothing, whatever the others do. Every datagram that was kept is popped or evicted exactly once.
 *
 * All memory is allocated by queue_create() and touched on first use; the chunk freed last is
 * reused first. An operation takes time proportional to the chunks of its datagram, independent of
 * the number of clients. */
#ifndef QUEUE_H
#define QUEUE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Most bytes of a datagram; UDP's limit is 65,507. */
enum { QUEUE_DATAGRAM_MAX = 65536 };

/* Bytes of a chunk: one page. Most queries are a few hundred bytes, and touch one page while they
 * are pending; smaller chunks would not touch less memory, and would make more links for large
 * datagrams. */
enum { QUEUE_CHUNK = 4096 };

enum { QUEUE_CHUNKS_MAX = 1 << 20 }; /* 4 GiB */

enum queue_line { QUEUE_SHORT, QUEUE_SCENES, QUEUE_LINES };

struct queue;

struct queue_datagram {
    int client;
    int kind; /* as given to queue_put() */
    size_t size;
};

enum queue_put_result {
    QUEUE_KEPT,
    QUEUE_FULL,    /* not kept yet: call queue_evict(), then put it again */
    QUEUE_REFUSED, /* not kept: no other client holds sufficiently more than the sender */
};

struct queue_counts {
    int64_t datagrams, chunks, clients; /* pending now */
    int64_t capacity;                   /* chunks */
    /* Most ever pending at once. Only this many chunks of memory were ever touched. */
    int64_t datagrams_most, chunks_most;
};

/* On input: chunks from 1 to QUEUE_CHUNKS_MAX; clients have the numbers 0 to clients - 1.
 * NULL: out of memory. queue_destroy() accepts NULL. */
struct queue *queue_create(size_t chunks, int clients);
void queue_destroy(struct queue *queue);

/* Copies a datagram to the end of a line. On input: size from 1 to QUEUE_DATAGRAM_MAX; any kind.
 *
 * QUEUE_FULL changes nothing. If queue_evict() and queue_put() then alternate, with no other call
 * between them, the datagram is kept after at most QUEUE_DATAGRAM_MAX / QUEUE_CHUNK evictions. */
enum queue_put_result queue_put(struct queue *queue, int client, enum queue_line line, int kind,
                                const unsigned char *bytes, size_t size);

/* Whether the line has a datagram. */
bool queue_has(const struct queue *queue, int client, enum queue_line line);

/* Removes the oldest datagram of a line. On output: *out, and its out->size bytes. False: the line
 * is empty. */
bool queue_pop(struct queue *queue, int client, enum queue_line line, struct queue_datagram *out,
               unsigned char bytes[QUEUE_DATAGRAM_MAX]);

/* After queue_put() returned QUEUE_FULL: removes the newest datagram of a client that holds most
 * chunks. On output: as queue_pop(). */
bool queue_evict(struct queue *queue, struct queue_datagram *out,
                 unsigned char bytes[QUEUE_DATAGRAM_MAX]);

struct queue_counts queue_counts(const struct queue *queue);

#endif
