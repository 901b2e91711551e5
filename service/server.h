/* The service: accepts queries from any source, and publishes results through a callback.
 *
 * Queries are put into a queue (queue.h), so that the bus is read before anything is computed.
 * Clients share time (scheduler.h): of the clients with a query, the one that has used least is
 * served next, for one turn. A client's pair and definition queries do not wait for its own scenes;
 * pairs with a hull or a body of several frames do. Scenes are answered in steps; between turns
 * other clients are served and the bus is read. If the queue is full, the client that holds most of
 * it gets FMB_BUSY for its newest query. While a query of a client has waited for longer than
 * SERVER_BUSY_NS, its new queries get FMB_BUSY. Queries that have waited for longer than
 * SERVER_EXPIRY_NS, and refusals beyond the limit of a client, get no result; they are counted. If
 * all jobs (jobs.h) are in use and another client needs one, the job that has used most time ends:
 * with the pairs answered so far, or as FMB_BUSY.
 *
 * What each part of fair sharing is for:
 *
 *     scheduler  clients use equal time, whatever they query, and whether or not they wait for
 *                each answer
 *     queue      a flood takes no capacity of others
 *     jobs       memory for scenes is bounded, and long ones let short ones begin
 *
 * One server may be used by one thread at a time; servers share no state. The caller's loop:
 *
 *     read the bus: server_receive() for each message, then server_end_batch();
 *     server_work();
 *     if that returned SERVER_IDLE: wait for the bus, then server_resume();
 *     if it returned SERVER_ANTICIPATING: yield to other programs, then server_resume(). */
#ifndef SERVER_H
#define SERVER_H

#include "answer.h"
#include "bus.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A query that has waited for longer since its arrival is dropped; a repeat has its own arrival.
 * While a query of a client has waited for longer than SERVER_BUSY_NS, its new queries are refused.
 * Otherwise a client that repeats waiting queries would have each of them answered many times. */
#define SERVER_EXPIRY_NS INT64_C(5000000000)
#define SERVER_BUSY_NS INT64_C(1000000000)

struct server;

/* Kinds of messages: queries as in answer.h, and heartbeats. */
enum server_kind {
    SERVER_PAIRS = ANSWER_PAIR,
    SERVER_SCENES = ANSWER_SCENE,
    SERVER_DEFINITIONS = ANSWER_DEFINITION,
    SERVER_STATUS,
    SERVER_KINDS
};

struct server_options {
    const char *prefix; /* of the channels; "": none */
    size_t frames;      /* capacity of the cache */
    int64_t server_id;  /* random, 1 to 2^53 - 1 */
    uint64_t secret[3]; /* random */
    /* Publishes a message. Returns false if it could not be sent. */
    bool (*publish)(void *user, const char *channel, const unsigned char *bytes, size_t size);
    void *user;
    int64_t (*clock_ns)(void); /* nanoseconds; NULL: clock_ns() */
};

/* Allocates all memory; after this only GMP and the publisher allocate. The options are copied;
 * user must outlive the server. Returns NULL if out of memory. server_destroy() accepts
 * NULL. */
struct server *server_create(const struct server_options *options);
void server_destroy(struct server *server);

/* The channels on which messages of a kind are received and answered. SERVER_STATUS is received
 * too: the heartbeats of other services. Valid until server_destroy(). */
const char *server_query_channel(const struct server *server, enum server_kind kind);
const char *server_result_channel(const struct server *server, enum server_kind kind);

/* Processes a message from the query channel of a kind. A query is queued. It is refused if it is
 * too long, if an older query of its client has waited too long, or if the queue is full. A
 * malformed message is counted and reported. A heartbeat is checked for another service. On input:
 * size bytes, untrusted, of any alignment; they are not used after the call. */
void server_receive(struct server *server, enum server_kind kind, const unsigned char *bytes,
                    size_t size);

/* To be called after each batch of datagrams, empty batches included. On input: the number of
 * datagrams read, including those not passed to server_receive(). The time spent reading is charged
 * to the clients that sent them. */
void server_end_batch(struct server *server, int datagrams);

enum server_state {
    SERVER_IDLE,         /* no query is pending */
    SERVER_WORKING,      /* queries are pending */
    SERVER_ANTICIPATING, /* queries are pending, but a more urgent one is expected (scheduler.h) */
};

/* Answers pending queries for 25 microseconds, or for one turn if it takes longer: a quarter of a
 * millisecond, or one step (at most a block of pairs in doubles, or one pair of frames in exact
 * arithmetic). Returns what to do next. */
enum server_state server_work(struct server *server);

/* Discards the time since the last call: the caller has waited. */
void server_resume(struct server *server);

/* Milliseconds until the heartbeat is due, rounded up; 0: now. */
int server_heartbeat_due_ms(const struct server *server);

/* Publishes the heartbeat. Reports on stderr the malformed messages and the queries in fragments
 * that have not been reported yet. On input: counts of the bus, whose listeners are the kinds of
 * messages. */
void server_heartbeat(struct server *server, const struct bus_counts *bus);

#endif
