/* The service on a bus: takes queries from it, answers them on it, and says once a second how
 * it is. Needs nothing of the process around it, so that it runs on memq:// as well.
 *
 * What comes is put into queues first (queue.h), which are the service's own, bounded, and fair
 * to each client: one for pairs and one for scenes. So LCM's buffers are empty whenever something
 * is computed, and who asks one pair does not wait behind scenes: those are interrupted to let
 * pairs pass. What there is no room for is told that the service is busy. */
#ifndef SERVER_H
#define SERVER_H

#include <lcm/lcm.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct server;

struct server_options {
    const char *prefix;  /* of the channels, "" for none */
    size_t bodies;       /* capacity of the cache */
    int64_t server_id;   /* random, 1 to 2^53 - 1 */
    int64_t first_key;   /* random, see cache_create() */
    uint64_t seed;       /* random, see queue_create() */
    int64_t restarts;    /* to be told in the status */
    long receive_buffer; /* to be told in the status; 0: not known */
};

/* Subscribes. On output: a server, to be freed with server_destroy() before the bus; NULL: out
 * of memory, or the bus refused (LCM has said why on stderr). Within lcm_handle() queries are put
 * into the queues, and refused where there is no room.
 * Allocates nothing after this but what the exact step and liblcm do. */
struct server *server_create(lcm_t *lcm, const struct server_options *options);
void server_destroy(struct server *server);

/* Takes what the bus has, up to a limit. To be called when it has something. False: it failed. */
bool server_drain(struct server *server);

/* Answers some of what waits, at most one scene. Returns whether there was anything. */
bool server_answer(struct server *server);

/* Whether something waits to be answered. */
bool server_is_waiting(const struct server *server);

/* Publishes the heartbeat where a second has gone by, and says on stderr what is left to say of
 * malformed messages. Returns milliseconds until it is due again, rounded up. */
int server_beat(struct server *server);

/* Publishes it now. */
void server_publish_status(struct server *server);

/* Names of the channels, for people; valid while the server lives. */
enum { SERVER_PAIRS = 0, SERVER_SCENES = 1 };
const char *server_query_channel(const struct server *server, int kind);
const char *server_result_channel(const struct server *server, int kind);
const char *server_status_channel(const struct server *server);

#endif
