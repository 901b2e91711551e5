#include "ask.h"

#include "allocate.h"
#include "bus.h"
#include "random_id.h"
#include "wire.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum {
    WINDOW = 64,
    /* Results of other clients come in too: room for bursts of them. */
    QUEUE_CAPACITY = 32 * WINDOW,
    /* A busy service is asked again after 10, 20, 40, ... 320, 320, ... milliseconds, a minute in
     * all; then its refusal is the answer. */
    BUSY_PAUSE_MS = 10,
    BUSY_DOUBLINGS = 5,
    BUSY_MAX = 200
};

/* A query under way. */
struct slot {
    size_t size;
    unsigned char query[WIRE_BYTES_MAX];
    double sent_at;  /* the first time; seconds of now() */
    double deadline; /* when to send it again, or to give it up */
    int tries;       /* left */
    int refusals;    /* the service was busy */
    bool pausing;    /* the deadline ends a pause after a refusal */
    bool done;
    bool answered; /* done with result; else done without one */
    struct pair_result result;
};

struct ask {
    lcm_t *lcm;
    lcm_subscription_t *subscription;
    char query_channel[BUS_CHANNEL_MAX];
    struct ask_options options;
    int64_t client_id;
    int64_t oldest, next;     /* sequence numbers: not delivered yet; not asked yet */
    struct slot slot[WINDOW]; /* [sequence number % WINDOW] */
    double heard_at;          /* the last answer */
    bool silent;
    struct ask_counts counts;
};

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double) time.tv_sec + 1e-9 * (double) time.tv_nsec;
}

static int64_t utime_now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_REALTIME, &time);
    return (int64_t) time.tv_sec * 1000000 + time.tv_nsec / 1000;
}

static struct slot *slot_of(struct ask *ask, int64_t sequence_number)
{
    return &ask->slot[sequence_number % WINDOW];
}

/* --- Answers coming in ----------------------------------------------------------------------- */

static void pause_slot(struct slot *slot)
{
    int doublings = slot->refusals < BUSY_DOUBLINGS ? slot->refusals : BUSY_DOUBLINGS;
    slot->refusals++;
    slot->pausing = true;
    slot->deadline = now() + 1e-3 * (BUSY_PAUSE_MS << doublings);
}

static void take_result(struct ask *ask, const struct pair_result *result)
{
    int64_t number = result->sequence_number;
    if (result->client_id != ask->client_id || number < ask->oldest || number >= ask->next)
        return;
    struct slot *slot = slot_of(ask, number);
    if (slot->done)
        return;
    ask->heard_at = now();
    if (result->status == FMB_BUSY && slot->refusals < BUSY_MAX) {
        pause_slot(slot);
        return;
    }
    slot->result = *result;
    slot->done = slot->answered = true;
    ask->counts.answered++;
}

static void on_result(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct ask *ask = user;
    struct pair_result result;
    (void) channel;
    if (wire_read_pair_result(buffer->data, buffer->data_size, &result))
        ask->counts.malformed++;
    else
        take_result(ask, &result);
}

/* --- Queries going out ----------------------------------------------------------------------- */

static void send_slot(struct ask *ask, struct slot *slot)
{
    if (lcm_publish(ask->lcm, ask->query_channel, slot->query, (unsigned) slot->size) < 0)
        ask->counts.unsent++;
    slot->pausing = false;
    slot->deadline = now() + ask->options.timeout;
}

static void ask_one(struct ask *ask, struct pair_query *query)
{
    struct slot *slot = slot_of(ask, ask->next);
    query->utime = utime_now();
    query->client_id = ask->client_id;
    query->sequence_number = ask->next++;
    query->method = ask->options.method;
    query->want = ask->options.want;
    slot->size = wire_write_pair_query(query, slot->query);
    slot->tries = ask->options.retries;
    slot->refusals = 0;
    slot->done = slot->answered = false;
    slot->sent_at = now();
    ask->counts.asked++;
    if (ask->silent)
        slot->done = true;
    else
        send_slot(ask, slot);
}

/* On output: false once the source has no more. */
static bool fill_window(struct ask *ask, ask_source *source, void *user)
{
    while (ask->next - ask->oldest < WINDOW) {
        struct pair_query query;
        memset(&query, 0, sizeof query);
        if (!source(user, &query))
            return false;
        ask_one(ask, &query);
    }
    return true;
}

static void give_up(struct ask *ask, struct slot *slot)
{
    slot->done = true;
    if (ask->heard_at < slot->sent_at)
        ask->silent = true;
}

static void look_after(struct ask *ask, struct slot *slot, double time)
{
    if (slot->done || (time < slot->deadline && !ask->silent))
        return;
    if (ask->silent || (!slot->pausing && slot->tries == 0)) {
        give_up(ask, slot);
        return;
    }
    if (!slot->pausing)
        slot->tries--;
    ask->counts.repeated++;
    send_slot(ask, slot);
}

static void look_after_window(struct ask *ask)
{
    double time = now();
    for (int64_t number = ask->oldest; number < ask->next; number++)
        look_after(ask, slot_of(ask, number), time);
}

/* Milliseconds to the next deadline, rounded up; at most a second, so that no clock can make this
 * wait for ever. */
static int time_to_wait_ms(struct ask *ask)
{
    double earliest = now() + 1, start = earliest - 1;
    for (int64_t number = ask->oldest; number < ask->next; number++) {
        const struct slot *slot = slot_of(ask, number);
        if (!slot->done && slot->deadline < earliest)
            earliest = slot->deadline;
    }
    return earliest > start ? (int) ceil(1e3 * (earliest - start)) : 0;
}

/* Waits for one message, then takes those that are there already, but no more than a window or
 * so at a time: another client's flood must not keep this one from sending. */
static void listen_to_bus(struct ask *ask)
{
    int wait_ms = time_to_wait_ms(ask);
    for (int i = 0; i < 2 * WINDOW; i++) {
        if (lcm_handle_timeout(ask->lcm, wait_ms) <= 0)
            return;
        wait_ms = 0;
        if (slot_of(ask, ask->oldest)->done)
            return;
    }
}

static void deliver(struct ask *ask, ask_sink *sink, void *user)
{
    while (ask->oldest < ask->next) {
        const struct slot *slot = slot_of(ask, ask->oldest);
        if (!slot->done)
            return;
        sink(user, slot->answered ? &slot->result : NULL);
        ask->oldest++;
    }
}

void ask_all(struct ask *ask, ask_source *source, ask_sink *sink, void *user)
{
    bool more = true;
    for (;;) {
        more = more && fill_window(ask, source, user);
        deliver(ask, sink, user);
        if (ask->oldest < ask->next) {
            listen_to_bus(ask);
            look_after_window(ask);
        } else if (!more) {
            return;
        }
    }
}

/* --- Opening and closing --------------------------------------------------------------------- */

static bool subscribe(struct ask *ask)
{
    char channel[BUS_CHANNEL_MAX];
    bus_channel(ask->query_channel, ask->options.prefix, WIRE_PAIR_QUERY);
    bus_channel(channel, ask->options.prefix, WIRE_PAIR_RESULT);
    if (lcm_get_fileno(ask->lcm) < 0)
        return false;
    ask->subscription = lcm_subscribe(ask->lcm, channel, on_result, ask);
    return ask->subscription &&
           lcm_subscription_set_queue_capacity(ask->subscription, QUEUE_CAPACITY) == 0;
}

struct ask *ask_open(lcm_t *lcm, const struct ask_options *options)
{
    struct ask *ask = allocate(1, sizeof *ask);
    ask->lcm = lcm;
    ask->options = *options;
    ask->client_id = random_id();
    ask->heard_at = -1;
    if (subscribe(ask))
        return ask;
    ask_close(ask);
    return NULL;
}

void ask_close(struct ask *ask)
{
    if (ask->subscription)
        lcm_unsubscribe(ask->lcm, ask->subscription);
    free(ask);
}

bool ask_is_silent(const struct ask *ask)
{
    return ask->silent;
}

struct ask_counts ask_counts(const struct ask *ask)
{
    return ask->counts;
}
