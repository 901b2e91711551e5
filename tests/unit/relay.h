/* A service in a thread of its own, on a bus of its own, that answers, loses, delays, repeats or
 * changes what a client gets. */
#ifndef RELAY_H
#define RELAY_H

#include "answer.h"
#include "bus.h"
#include "fmb_client.h"
#include "query.h"

#include <pthread.h>
#include <stdatomic.h>

/* Numbers of the bus_listen() calls. */
enum relay_kind { RELAY_PAIR, RELAY_SCENE, RELAY_DEFINITION, RELAY_KINDS };

enum { RELAY_SERVICES = 2 };

struct relay;

/* Changes a result; turn counts them from 1. */
typedef void relay_lie(struct scene_result *result, int turn);
typedef void relay_pair_lie(struct pair_result *result, int turn);
typedef void relay_before(struct relay *relay);

struct relay {
    _Atomic int queries;  /* received */
    _Atomic size_t bytes; /* of them */
    /* Every so many; 0: none. */
    _Atomic int lose_query, lose_result, double_result, delay_result, busy;
    _Atomic bool deaf; /* no query is answered */
    /* NULL: results are sent as they are. The second ones: of doubled results, the second copy. */
    relay_lie *_Atomic lie, *_Atomic second_lie;
    relay_pair_lie *_Atomic pair_lie, *_Atomic second_pair_lie;
    /* Called before a query is answered, in the relay's thread. */
    relay_before *_Atomic before;
    _Atomic int turn;
    char url[80];
    /* Internal. */
    struct answerer *service[RELAY_SERVICES]; /* each answers each query, in this order */
    pthread_mutex_t lock;                     /* of all that the thread uses */
    pthread_t thread;
    int stop[2];
    struct bus *bus;
    struct answer_job *job;
    struct scene_result result;
    struct definition_query definition_query;
    struct definition definition;
    int results;
    unsigned char late[QUERY_BYTES_MAX];
    size_t late_size;
    enum relay_kind late_kind;
};

/* Runs the program again in a network of its own (netns); to be called first in main(). */
void relay_enter(char **argv);

/* All 0. Not on the stack: where a test fails, the thread goes on. */
struct relay *relay_new(void);

/* Starts the thread. On input: what is to go wrong; frames: capacity of the service's cache. */
void relay_open(struct relay *relay, size_t frames);
void relay_close(struct relay *relay); /* and frees it */

/* The service ends, and another one begins, between two queries. From before() or any thread. */
void relay_restart(struct relay *relay, size_t frames);

/* A second service, which answers each query before the first one. */
void relay_add_service(struct relay *relay, size_t frames);

void relay_publish(struct relay *relay, const char *channel, const void *bytes, size_t size);

/* Waits until the relay has received this many queries and has processed them. */
void relay_wait(struct relay *relay, uint64_t queries);

/* Datagrams that the relay's receive buffer had no space for. */
uint64_t relay_dropped(struct relay *relay);

/* A client on the relay's bus; options as in fmb_client_options. */
struct fmb_client *relay_client(struct relay *relay, double timeout, int tries);

/* The relay and the client of a test, closed after it. At its start the relay exists but is not
 * open: relay_start(). */
extern struct relay_test {
    struct relay *relay;
    struct fmb_client *client; /* NULL: none */
} test;
int relay_set_up(void **state);
int relay_tear_down(void **state);
#define RELAY_TEST(name) cmocka_unit_test_setup_teardown(name, relay_set_up, relay_tear_down)

/* Opens the relay of the test, and a client. */
void relay_start(size_t frames, double timeout, int tries);

static inline struct fmb_client_counts relay_counts(const struct fmb_client *client)
{
    struct fmb_client_counts counts;
    fmb_client_get_counts(client, &counts);
    return counts;
}

/* ---- Scenes, and what libfmb decides ---- */

/* Bodies of all shapes, of one dimension, some of them moving, turned, or of several frames; ids
 * from first_id on, 0: none. size: of the space they are in, per axis. Bodies stay until the
 * program ends. */
void relay_draw(struct fmb_placement *out, size_t count, int dim, double size, int64_t first_id,
                unsigned seed);

/* Returns a body of these frames. */
const struct fmb_body *relay_body(const struct fmb_frame *frames, size_t count);

/* Returns a body of the first frame of this one, with another number (fmb_frame_numbers()). */
const struct fmb_body *relay_change(const struct fmb_body *body, int number, double value);

/* Reduces each body to its first frame. */
void relay_use_first_frames(struct fmb_placement *placements, size_t count);

/* All answers that fmb_client_query() has to give, in their order, by fmb_decide(). */
struct relay_truth {
    size_t count, capacity;
    struct relay_pair {
        unsigned a, b;
        struct fmb_answer answer;
    } * pair;
    size_t given;  /* answers that were right so far */
    size_t failed; /* those with a status */
};

void relay_truth_make(const struct fmb_scene *scene, struct relay_truth *out);
void relay_truth_clear(struct relay_truth *truth);

/* A sink: fails the test where an answer is not the next one, to the bit; those with a status are
 * counted, and their verdict is not looked at. */
void relay_check(void *truth, const struct fmb_client_answer *answer);

/* Queries the scene, and checks all answers. */
void relay_query(struct fmb_client *client, const struct fmb_scene *scene);

/* A smaller number where tests are to be fast. */
size_t relay_size(size_t size, size_t fast);

#endif
