/* The service: accepts queries from any source, and publishes results through a callback.
 *
 * Queries are put into a queue (queue.h), so that the bus is empty before anything is computed.
 * Clients share compute time (turns.h): of the clients with a query, the one that has used least is
 * served next. A client's pair and definition queries do not wait for its own scenes. Scenes are
 * answered in steps; between them other clients are served and the bus is read. If the queue is
 * full, the client that holds most of it gets FMB_BUSY for its newest query. If all jobs are taken
 * (jobs.h) and another client needs one, the longest ends: with the pairs answered so far, or as
 * busy.
 *
 * For one thread. The caller's loop:
 *
 *     read the bus: server_receive() for each message, then server_received();
 *     server_work();
 *     if that returned SERVER_IDLE: wait for the bus, then server_resume();
 *     if it returned SERVER_EXPECTING: yield to other programs, then server_resume(). */
#ifndef SERVER_H
#define SERVER_H

#include "bus.h"
#include "meter.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct server;

/* Kinds of messages. */
enum server_kind { SERVER_PAIRS, SERVER_SCENES, SERVER_DEFINITIONS, SERVER_STATUS, SERVER_KINDS };

struct server_options {
    const char *prefix; /* of the channels; "": none */
    size_t frames;      /* capacity of the cache */
    int64_t server_id;  /* random, 1 to 2^53 - 1 */
    uint64_t secret[3]; /* random */
    /* Publishes a message. Returns false if it could not be sent. */
    bool (*publish)(void *user, const char *channel, const unsigned char *bytes, size_t size);
    void *user;
    const struct meter_clocks *clocks; /* NULL: the system's clocks */
};

/* NULL: out of memory. After this only GMP and the publisher allocate. server_destroy() accepts
 * NULL. */
struct server *server_create(const struct server_options *options);
void server_destroy(struct server *server);

/* The channels on which messages of a kind are received and answered. SERVER_STATUS is received
 * too: the heartbeats of other services. Valid until server_destroy(). */
const char *server_query_channel(const struct server *server, enum server_kind kind);
const char *server_result_channel(const struct server *server, enum server_kind kind);

/* Processes a message from the query channel of a kind: a query is queued, or refused if the queue
 * is full. The bytes are not trusted and may have any alignment. */
void server_receive(struct server *server, enum server_kind kind, const unsigned char *bytes,
                    size_t size);

/* Call this after each batch of datagrams, empty ones included. On input: the number of datagrams
 * read, including those not passed to server_receive(). The time spent reading is charged to the
 * clients that sent them. */
void server_received(struct server *server, int datagrams);

enum server_state {
    SERVER_IDLE,      /* no query is pending */
    SERVER_WORKING,   /* queries are pending */
    SERVER_EXPECTING, /* queries are pending, but a more urgent one is expected (expect.h) */
};

/* Answers queries for about 0.3 ms at most, or one pair of frames if that takes longer. */
enum server_state server_work(struct server *server);

/* Discards the time since the last call: the caller has waited. */
void server_resume(struct server *server);

/* Milliseconds until the heartbeat is due, rounded up; 0: now. */
int server_beat_due_ms(const struct server *server);

/* Publishes the heartbeat, and reports malformed messages that have not been reported yet on
 * stderr. On input: counts of the bus. */
void server_beat(struct server *server, const struct bus_counts *bus);

#endif
