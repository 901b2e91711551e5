/* A service and a client in one thread, without a network: each on a bus of its own, and what one
 * publishes is carried over to the other; or lost, doubled, late, or replaced by a lie. */
#ifndef RELAY_H
#define RELAY_H

#include "fmb_client.h"
#include "query.h"
#include "server.h"

struct relay {
    lcm_t *service, *client;
    struct server *server;
    int queries;  /* that the client sent */
    size_t bytes; /* of them */
    /* Every so many; 0: none. */
    int lose_query, lose_result, double_result, delay_result, busy;
    bool deaf; /* no query arrives */
    /* Changes a result of a scene; turn counts them from 1. NULL: none is changed. */
    void (*lie)(struct scene_result *result, int turn);
    /* Called before a query is carried over. */
    void (*before)(struct relay *relay);
    /* For itself. */
    int results, turn;
    unsigned char late[QUERY_BYTES_MAX];
    unsigned late_size;
    char late_channel[64];
};

/* On input: all 0 but for what is to go wrong. */
void relay_open(struct relay *relay, size_t bodies);
void relay_close(struct relay *relay);

/* The service ends, and another one begins. */
void relay_restart(struct relay *relay, size_t bodies);

/* A client on the client's bus; tries as in fmb_client_options. */
struct fmb_client *relay_client(struct relay *relay, double timeout, int tries);

/* ---- Scenes and what libfmb says of them ---- */

/* Bodies of all shapes, of one dimension, some of them moving; ids from first_id on, 0: none.
 * size: of the space they are in, per axis. */
void relay_draw(struct fmb_client_frame *out, size_t count, int dim, double size, int64_t first_id,
                unsigned seed);

/* All answers that fmb_client_ask() has to give, in their order, by fmb_decide_batch(). */
struct relay_truth {
    size_t count, room;
    struct relay_pair {
        unsigned a, b;
        struct fmb_answer answer;
    } * pair;
    size_t told;   /* answers that were as they should be so far */
    size_t failed; /* those with a status */
};

void relay_truth_make(const struct fmb_client_scene *scene, struct relay_truth *out);
void relay_truth_clear(struct relay_truth *truth);

/* A sink: fails the test where an answer is not the next one, to the bit; those with a status are
 * counted, and their verdict is not looked at. */
void relay_check(void *truth, const struct fmb_client_answer *answer);

/* Asks, and checks all answers. */
void relay_ask(struct fmb_client *client, const struct fmb_client_scene *scene);

/* A smaller number where tests are to be fast. */
size_t relay_size(size_t size, size_t fast);

#endif
