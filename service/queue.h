/* The datagrams that wait for their turn: bounded, and fair to every client.
 *
 * Each client has a line of its own, first in, first out, and the clients take turns: one
 * datagram a turn. One that arrives joins behind all others, so between two turns of a client
 * each other client has one at most, whatever it sends.
 *
 * Room is counted in chunks. When there is none left, it is taken from those that hold most, the
 * newest of their datagrams first, and only down to what the sender would hold itself. With
 * capacity chunks, m clients that hold any, the sender counted among them, and m * share <=
 * capacity:
 *
 * - A datagram with which its client holds no more than the share is never refused.
 * - A datagram is never thrown out if it and all older ones of its client, taken together, are no
 *   more than the share.
 *
 * So who never has more than capacity / (most clients that ever wait at once) chunks waiting
 * loses nothing, whatever the others do. Nothing is forgotten silently: what was put is popped or
 * thrown out, each into the caller's hands, and what was refused still is in them.
 *
 * All memory is taken at the start, but only touched where it is needed: what was freed last is
 * used first. An operation costs O(chunks of the datagram), whoever waits; for the search by id
 * that is so on average. */
#ifndef QUEUE_H
#define QUEUE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Bytes of a datagram: no UDP datagram has more than 65,507. */
enum { QUEUE_DATAGRAM_MAX = 65536 };

/* Bytes. A page: most queries are a few hundred bytes, and then one that waits touches one page;
 * a smaller chunk would not touch less memory, and large datagrams would have more to link. */
enum { QUEUE_CHUNK = 4096 };

/* 4 GiB. */
enum { QUEUE_CHUNKS_MAX = 1 << 20 };

struct queue;

struct queue_datagram {
    int64_t client_id;
    int kind; /* as given to queue_put() */
    size_t size;
};

enum queue_put_result {
    QUEUE_KEPT,
    QUEUE_FULL,    /* not kept yet: others have to give room */
    QUEUE_REFUSED, /* not kept, since nobody holds so much more than the sender */
};

struct queue_counts {
    int64_t datagrams, chunks, clients; /* that wait now */
    int64_t capacity;                   /* chunks */
    /* The most that ever waited at once. Of the memory for chunks no more was ever touched. */
    int64_t datagrams_most, chunks_most, clients_most;
};

/* On input: chunks from 1 to QUEUE_CHUNKS_MAX; seed: 64 random bits, so that nobody can choose
 * client ids that are slow to find. (With another seed all is slower at worst.)
 * On output: a queue, to be freed with queue_destroy(); NULL: out of memory. */
struct queue *queue_create(size_t chunks, uint64_t seed);
void queue_destroy(struct queue *queue);

/* Copies a datagram into its client's line. On input: size from 1 to QUEUE_DATAGRAM_MAX; any
 * client_id and kind.
 *
 * With QUEUE_FULL nothing has changed: the caller calls queue_throw() and puts the datagram again,
 * until it is kept. With nothing else in between, that is so after 16 times
 * (QUEUE_DATAGRAM_MAX / QUEUE_CHUNK) at most, and it is not refused any more: nothing is thrown
 * out in vain. */
enum queue_put_result queue_put(struct queue *queue, int64_t client_id, int kind,
                                const unsigned char *bytes, size_t size);

/* Takes the oldest datagram of the client whose turn it is. On output: its out->size bytes.
 * False: none waits. */
bool queue_pop(struct queue *queue, struct queue_datagram *out,
               unsigned char bytes[QUEUE_DATAGRAM_MAX]);

/* Takes the newest datagram of a client that holds as many chunks as any other; for when
 * queue_put() says QUEUE_FULL. On output: as queue_pop(). */
bool queue_throw(struct queue *queue, struct queue_datagram *out,
                 unsigned char bytes[QUEUE_DATAGRAM_MAX]);

struct queue_counts queue_counts(const struct queue *queue);

#endif
