#include "ask.h"

#include "allocate.h"
#include "bus.h"
#include "clock.h"
#include "random_id.h"
#include "wire.h"

#include <stdlib.h>
#include <string.h>

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

static const int64_t ns_per_ms = 1000000, ns_per_s = 1000000000;

/* A query under way. */
struct slot {
    size_t size;
    unsigned char query[WIRE_BYTES_MAX];
    int64_t sent_at;  /* the first time; clock_ns() */
    int64_t deadline; /* when to send it again, or to give it up; clock_ns() */
    int tries;        /* left */
    int refusals;     /* the service was busy */
    bool pausing;     /* the deadline ends a pause after a refusal */
    bool done;
    bool answered; /* done with result; else done without one */
    struct pair_result result;
    char certificate[QUERY_CERTIFICATE_MAX]; /* of the result, if it has one */
};

struct ask {
    lcm_t *lcm;
    lcm_subscription_t *subscription;
    char query_channel[BUS_CHANNEL_MAX];
    struct ask_options options;
    int64_t client_id;
    int64_t oldest, next;     /* sequence numbers: not delivered yet; not asked yet */
    struct slot slot[WINDOW]; /* [sequence number % WINDOW] */
    int64_t timeout_ns;
    int64_t heard_at; /* the last answer; clock_ns() */
    bool silent;
    int64_t probe_at; /* while silent: not before this is a query sent; clock_ns() */
    bool probing;     /* one was, and may still be answered */
    struct ask_counts counts;
};

static struct slot *slot_of(struct ask *ask, int64_t sequence_number)
{
    return &ask->slot[sequence_number % WINDOW];
}

/* ---- Answers coming in ----------------------------------------------------------------------- */

static void pause_slot(struct slot *slot)
{
    int doublings = slot->refusals < BUSY_DOUBLINGS ? slot->refusals : BUSY_DOUBLINGS;
    slot->refusals++;
    slot->pausing = true;
    slot->deadline = clock_ns() + ns_per_ms * (BUSY_PAUSE_MS << doublings);
}

/* There is a service, even if the answer comes too late for its query. */
static void hear(struct ask *ask)
{
    ask->heard_at = clock_ns();
    ask->silent = ask->probing = false;
}

static void take_result(struct ask *ask, const struct pair_result *result)
{
    int64_t number = result->sequence_number;
    if (result->client_id != ask->client_id)
        return;
    hear(ask);
    if (number < ask->oldest || number >= ask->next)
        return;
    struct slot *slot = slot_of(ask, number);
    if (slot->done)
        return;
    if (result->status == FMB_BUSY && slot->refusals < BUSY_MAX) {
        pause_slot(slot);
        return;
    }
    slot->result = *result;
    if (result->certificate)
        slot->result.certificate = strcpy(slot->certificate, result->certificate);
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

/* ---- Queries going out ----------------------------------------------------------------------- */

static void send_slot(struct ask *ask, struct slot *slot)
{
    if (lcm_publish(ask->lcm, ask->query_channel, slot->query, (unsigned) slot->size) < 0)
        ask->counts.unsent++;
    slot->pausing = false;
    slot->deadline = clock_ns() + ask->timeout_ns;
}

/* While nobody answers, a query goes out once in a second, one try, to find out whether somebody
 * does again; the others cost no time. */
static void ask_in_silence(struct ask *ask, struct slot *slot)
{
    if (slot->sent_at < ask->probe_at) {
        slot->done = true;
        return;
    }
    ask->probing = true;
    slot->tries = 0;
    send_slot(ask, slot);
}

static void ask_one(struct ask *ask, struct pair_query *query)
{
    struct slot *slot = slot_of(ask, ask->next);
    query->utime = clock_utime();
    query->client_id = ask->client_id;
    query->sequence_number = ask->next++;
    query->method = ask->options.method;
    query->want = ask->options.want;
    slot->size = wire_write_pair_query(query, slot->query);
    slot->tries = ask->options.retries;
    slot->refusals = 0;
    slot->done = slot->answered = false;
    slot->sent_at = clock_ns();
    ask->counts.asked++;
    if (ask->silent)
        ask_in_silence(ask, slot);
    else
        send_slot(ask, slot);
}

/* Nothing is asked behind a probe: its answer says whether the others are sent or given up.
 * On output: false once the source has no more. */
static bool fill_window(struct ask *ask, ask_source *source, void *user)
{
    while (ask->next - ask->oldest < WINDOW && !ask->probing) {
        struct pair_query query;
        memset(&query, 0, sizeof query);
        if (!source(user, &query))
            return false;
        ask_one(ask, &query);
    }
    return true;
}

/* Gives up all that is under way. */
static void fall_silent(struct ask *ask)
{
    for (int64_t number = ask->oldest; number < ask->next; number++)
        slot_of(ask, number)->done = true;
    if (!ask->silent)
        ask->counts.outages++;
    ask->silent = true;
    ask->probing = false;
    ask->probe_at = clock_ns() + ns_per_s;
}

static void give_up(struct ask *ask, struct slot *slot)
{
    slot->done = true;
    if (ask->heard_at < slot->sent_at)
        fall_silent(ask);
}

static void look_after(struct ask *ask, struct slot *slot, int64_t time)
{
    if (slot->done || time < slot->deadline)
        return;
    if (!slot->pausing && slot->tries == 0) {
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
    int64_t time = clock_ns();
    for (int64_t number = ask->oldest; number < ask->next; number++)
        look_after(ask, slot_of(ask, number), time);
}

/* Milliseconds to the next deadline, rounded up; at most a second, so that no clock can make this
 * wait for ever. */
static int time_to_wait_ms(struct ask *ask)
{
    int64_t start = clock_ns(), earliest = start + ns_per_s;
    for (int64_t number = ask->oldest; number < ask->next; number++) {
        const struct slot *slot = slot_of(ask, number);
        if (!slot->done && slot->deadline < earliest)
            earliest = slot->deadline;
    }
    return earliest > start ? (int) ((earliest - start + ns_per_ms - 1) / ns_per_ms) : 0;
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

/* ---- Opening and closing --------------------------------------------------------------------- */

static bool subscribe(struct ask *ask)
{
    char channel[BUS_CHANNEL_MAX];
    bus_channel(ask->query_channel, ask->options.prefix, WIRE_PAIR_QUERY);
    bus_channel(channel, ask->options.prefix, WIRE_PAIR_RESULT);
    if (lcm_get_fileno(ask->lcm) < 0)
        return false;
    ask->subscription = bus_subscribe(ask->lcm, channel, on_result, ask, QUEUE_CAPACITY);
    return ask->subscription != NULL;
}

struct ask *ask_open(lcm_t *lcm, const struct ask_options *options)
{
    struct ask *ask = allocate(1, sizeof *ask);
    ask->lcm = lcm;
    ask->options = *options;
    ask->client_id = random_id();
    ask->timeout_ns = (int64_t) (options->timeout * (double) ns_per_s);
    ask->heard_at = INT64_MIN;
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
