/* The service on a bus: takes queries from it, answers them on it, and says once a second how
 * it is. Needs nothing of the process around it, so that it runs on memq:// as well. */
#ifndef SERVER_H
#define SERVER_H

#include <lcm/lcm.h>
#include <stddef.h>
#include <stdint.h>

struct server;

/* Queries wait in LCM's queue while one is answered; beyond this many LCM drops the newest,
 * which the sequence numbers tell. */
enum { SERVER_QUEUE = 1024 };

struct server_options {
    const char *prefix;  /* of the channels, "" for none */
    size_t bodies;       /* capacity of the cache */
    int64_t server_id;   /* random, 1 to 2^53 - 1 */
    int64_t first_key;   /* random, see cache_create() */
    long receive_buffer; /* to be told in the status; 0: not known */
};

/* Subscribes. On output: a server, to be freed with server_destroy() before the bus; NULL: out
 * of memory, or the bus refused (LCM has said why on stderr). Answers from within lcm_handle().
 * Allocates nothing after this but what the exact step and liblcm do. */
struct server *server_create(lcm_t *lcm, const struct server_options *options);
void server_destroy(struct server *server);

/* Publishes the heartbeat, and says on stderr what is left to say of malformed messages. */
void server_publish_status(struct server *server);

/* Names of the channels, for people; valid while the server lives. */
const char *server_query_channel(const struct server *server);
const char *server_result_channel(const struct server *server);
const char *server_status_channel(const struct server *server);

#endif
