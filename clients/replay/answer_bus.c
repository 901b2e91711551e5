#define _GNU_SOURCE /* ppoll() */
#include "answer_bus.h"

#include "allocate.h"
#include "behind.h"
#include "bus.h"
#include "clock.h"
#include "filter.h"
#include "live.h"
#include "random_id.h"
#include "signals.h"
#include "wire.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum {
    WINDOW = 64,
    /* A stock receive buffer has 212,992 bytes, and what came from others is in it too. A datagram
     * takes twice its bytes there at most and some for itself; the largest take 70,000. */
    CHARGE_MAX = 150000,
    CHARGE_LARGEST = 70000,
    CHARGE_EACH = 1024,
    /* A busy service is asked again after 10, 20, 40, ... 320, 320, ... milliseconds. */
    BUSY_PAUSE_MS = 10,
    BUSY_DOUBLINGS = 5,
    BUSY_MAX = 200,
    /* What waits behind queries, in bytes, before no more is read. */
    BEHIND_MAX = 8 << 20,
    /* Messages taken before queries are looked after again. */
    TAKEN_MAX = 2 * WINDOW,
    /* What is read is counted, and signals are looked for once in so many. */
    LOOK_EVERY = 256,
    /* LCM sends so many bytes in one datagram: the name of the channel, a 0 and the message. */
    DATAGRAM_MAX = 65499
};

static const int64_t ns_per_ms = 1000000, ns_per_s = 1000000000;

/* Some 30 years: for ever. */
static const double most_ns = 1e18;

/* A query under way. */
struct slot {
    int64_t sent_at;
    int64_t deadline; /* when to send it again; clock_ns() */
    int refusals;     /* the service was busy */
    bool pausing;     /* the deadline ends a pause after a refusal */
    bool done;
    size_t charge; /* of a receive buffer */
    struct live_query query;
};

/* Results of one type. */
struct intake {
    struct answer_bus *bus;
    enum log_kind kind; /* of their queries */
    char query_channel[BUS_CHANNEL_MAX], result_channel[BUS_CHANNEL_MAX];
    lcm_subscription_t *subscription;
    int64_t overtaken_at; /* queries sent before have been overtaken by one that is answered */
};

struct answer_bus {
    struct answer_bus_options options;
    struct answer_bus_sink sink;
    lcm_t *lcm;
    int signals; /* readable after SIGINT and SIGTERM */
    struct intake pairs, scenes;
    int64_t client_id, server_id, timeout_ns;
    struct live *live;
    struct behind *behind;
    bool news;             /* among what waits behind is what may tell keys */
    uint64_t oldest, next; /* queries: not passed on yet; not asked yet */
    struct slot *slot;     /* [query % WINDOW] */
    size_t charge;         /* of all that is under way */
    int64_t heard_at;      /* the last answer; clock_ns() */
    int silent;            /* time-outs in a row without any */
    int64_t begun_at, first_utime;
    unsigned looked;
    struct tally_bus counts;
};

static struct slot *slot_of(struct answer_bus *bus, uint64_t query)
{
    return &bus->slot[query % WINDOW];
}

static bool is_under_way(const struct answer_bus *bus)
{
    return bus->oldest < bus->next;
}

static bool goes_on(const struct answer_bus *bus)
{
    return bus->counts.end == ANSWER_BUS_NO_END;
}

/* The first reason stays. */
static void stop(struct answer_bus *bus, enum answer_bus_end end)
{
    if (!goes_on(bus))
        return;
    bus->counts.end = end;
    if (!is_under_way(bus))
        return;
    const struct match_place *place = &slot_of(bus, bus->oldest)->query.recorded.place;
    bus->counts.log = place->log;
    bus->counts.number = place->number;
    bus->counts.offset = place->offset;
}

/* ---- Queries going out ---- */

static struct intake *intake_of(struct answer_bus *bus, enum log_kind kind)
{
    return kind == LOG_PAIR_QUERY ? &bus->pairs : &bus->scenes;
}

/* What the bus does not take is sent again after the time-out, as what it loses. */
static void send_slot(struct answer_bus *bus, struct slot *slot)
{
    struct live_query *query = &slot->query;
    lcm_publish(bus->lcm, intake_of(bus, query->kind)->query_channel, query->asked,
                (unsigned) query->size);
    slot->pausing = false;
    slot->sent_at = clock_ns();
    slot->deadline = slot->sent_at + bus->timeout_ns;
}

static void finish(struct answer_bus *bus, struct slot *slot)
{
    bus->charge -= slot->charge;
    bus->counts.deaths += slot->query.deaths;
    bus->counts.lessons += slot->query.lessons;
    slot->done = true;
}

/* Whether LCM sends it in one datagram, which the service hears. What is written here always is. */
static bool is_heard(struct answer_bus *bus, const struct match_item *query)
{
    return strlen(intake_of(bus, query->kind)->query_channel) + 1 + query->size <= DATAGRAM_MAX;
}

static void ask(struct answer_bus *bus, struct slot *slot)
{
    if (is_heard(bus, &slot->query.recorded)) {
        live_next(bus->live, &slot->query);
        send_slot(bus, slot);
    } else {
        live_refuse(bus->live, &slot->query);
        bus->counts.too_long++;
        finish(bus, slot);
    }
}

/* ---- Answers coming in ---- */

static void hear(struct answer_bus *bus)
{
    bus->heard_at = clock_ns();
    bus->silent = 0;
}

static void note_service(struct answer_bus *bus, int64_t server_id)
{
    bus->counts.services += bus->counts.services == 0 || server_id != bus->server_id;
    bus->server_id = server_id;
}

/* Numbers under its own id are each of one query; live.h says what tells others apart. */
static bool same_ids(const struct answer_bus *bus, const struct query_header *a,
                     const struct query_header *b)
{
    return a->client_id == b->client_id && a->sequence_number == b->sequence_number &&
           (a->client_id == bus->client_id || a->utime == b->utime);
}

/* The query under way whose result has these ids. NULL: there is none, or none any more. */
static struct slot *find_slot(struct answer_bus *bus, enum log_kind kind,
                              const struct query_header *ids)
{
    for (uint64_t query = bus->oldest; query < bus->next; query++) {
        struct slot *slot = slot_of(bus, query);
        if (!slot->done && slot->query.kind == kind && same_ids(bus, &slot->query.ids, ids))
            return slot;
    }
    return NULL;
}

static void pause_slot(struct answer_bus *bus, struct slot *slot)
{
    const int doublings = slot->refusals < BUSY_DOUBLINGS ? slot->refusals : BUSY_DOUBLINGS;
    slot->refusals++;
    slot->pausing = true;
    slot->deadline = clock_ns() + ns_per_ms * (BUSY_PAUSE_MS << doublings);
    bus->counts.busy++;
}

/* A service answers the queries of a client in the order in which they come. (But it refuses the
 * newest first.) */
static void note_overtaken(struct intake *intake, const struct slot *slot)
{
    if (slot->sent_at > intake->overtaken_at)
        intake->overtaken_at = slot->sent_at;
}

static void take(struct intake *intake, struct slot *slot, const lcm_recv_buf_t *buffer)
{
    struct answer_bus *bus = intake->bus;
    const bool patient = slot->refusals < BUSY_MAX;
    const enum live_taken taken =
        live_take(bus->live, &slot->query, buffer->data, buffer->data_size, patient);
    if (taken == LIVE_NONSENSE) {
        bus->counts.nonsense++;
        return;
    }
    hear(bus);
    note_service(bus, slot->query.server_id);
    if (taken == LIVE_BUSY) {
        pause_slot(bus, slot);
        return;
    }
    note_overtaken(intake, slot);
    if (taken == LIVE_MORE)
        ask(bus, slot);
    else
        finish(bus, slot);
}

static void on_result(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct intake *intake = user;
    struct answer_bus *bus = intake->bus;
    struct query_header ids;
    (void) channel;
    const char *error = intake->kind == LOG_PAIR_QUERY
                            ? wire_read_pair_result_header(buffer->data, buffer->data_size, &ids)
                            : wire_read_scene_result_header(buffer->data, buffer->data_size, &ids);
    if (error) {
        bus->counts.nonsense++;
        return;
    }
    struct slot *slot = find_slot(bus, intake->kind, &ids);
    if (slot)
        take(intake, slot, buffer);
    else if (ids.client_id == bus->client_id)
        hear(bus);
}

/* ---- Waiting ---- */

/* When something is to be done, at the latest. */
static int64_t earliest(struct answer_bus *bus, int64_t until)
{
    for (uint64_t query = bus->oldest; query < bus->next; query++) {
        const struct slot *slot = slot_of(bus, query);
        if (!slot->done && slot->deadline < until)
            until = slot->deadline;
    }
    return until;
}

static struct timespec time_to(int64_t when)
{
    const int64_t left = when - clock_ns();
    return left > 0 ? (struct timespec){.tv_sec = left / ns_per_s, .tv_nsec = left % ns_per_s}
                    : (struct timespec){.tv_sec = 0};
}

/* Takes what has come; waits for the first message, until then at most. */
static void listen(struct answer_bus *bus, int64_t until)
{
    enum { BUS, SIGNALS, SOURCES };
    struct pollfd source[SOURCES] = {
        [BUS] = {.fd = lcm_get_fileno(bus->lcm), .events = POLLIN},
        [SIGNALS] = {.fd = bus->signals, .events = POLLIN},
    };
    struct timespec wait = time_to(until);
    for (int taken = 0; taken < TAKEN_MAX && goes_on(bus); taken++) {
        const int ready = ppoll(source, SOURCES, &wait, NULL);
        if (ready == 0 || (ready < 0 && errno == EINTR))
            return;
        if (ready > 0 && source[SIGNALS].revents)
            stop(bus, ANSWER_BUS_SIGNAL);
        else if (ready < 0 || lcm_handle(bus->lcm) != 0)
            stop(bus, ANSWER_BUS_FAILED);
        wait = (struct timespec){.tv_sec = 0};
    }
}

/* Answers to others come in, and this one is not behind them: the service is not that far yet. */
static bool is_waited_for(struct answer_bus *bus, const struct slot *slot, int64_t time)
{
    return time < bus->heard_at + bus->timeout_ns &&
           slot->sent_at >= intake_of(bus, slot->query.kind)->overtaken_at;
}

/* After a time-out of the oldest. */
static void note_silence(struct answer_bus *bus, const struct slot *slot)
{
    if (bus->heard_at < slot->sent_at && ++bus->silent > bus->options.retries)
        stop(bus, ANSWER_BUS_NOBODY);
}

static void look_after(struct answer_bus *bus)
{
    const int64_t time = clock_ns();
    bool is_oldest = true;
    for (uint64_t query = bus->oldest; query < bus->next && goes_on(bus); query++) {
        struct slot *slot = slot_of(bus, query);
        if (slot->done)
            continue;
        if (time >= slot->deadline && slot->pausing) {
            send_slot(bus, slot);
        } else if (time >= slot->deadline && is_waited_for(bus, slot, time)) {
            slot->deadline = bus->heard_at + bus->timeout_ns;
        } else if (time >= slot->deadline) {
            if (is_oldest)
                note_silence(bus, slot);
            bus->counts.again++;
            send_slot(bus, slot);
        }
        is_oldest = false;
    }
}

static void pass_answer(struct answer_bus *bus, struct slot *slot)
{
    struct match_item query = slot->query.recorded;
    bus->oldest++;
    bus->counts.answered++;
    bus->counts.ns = clock_ns() - bus->begun_at;
    bus->sink.answered(bus->sink.user, &query, &slot->query.answered);
}

static void pass_first(struct answer_bus *bus)
{
    const struct behind_item *first = behind_first(bus->behind);
    bus->sink.passed(bus->sink.user, &first->item, first->is_result);
    behind_drop_first(bus->behind);
    bus->news = bus->news && behind_first(bus->behind);
}

/* All whose turn it is. */
static void pass_on(struct answer_bus *bus)
{
    while (goes_on(bus)) {
        const struct behind_item *first = behind_first(bus->behind);
        struct slot *slot = slot_of(bus, bus->oldest);
        if (first && first->after <= bus->oldest)
            pass_first(bus);
        else if (is_under_way(bus) && slot->done)
            pass_answer(bus, slot);
        else
            return;
    }
}

static void step(struct answer_bus *bus, int64_t until)
{
    listen(bus, earliest(bus, until));
    look_after(bus);
    pass_on(bus);
}

static void wait_for_all(struct answer_bus *bus)
{
    while (goes_on(bus) && is_under_way(bus))
        step(bus, clock_ns() + ns_per_s);
}

/* ---- Asking ---- */

static size_t charge_of(size_t bytes)
{
    const size_t charge = 2 * bytes + CHARGE_EACH;
    return charge < CHARGE_LARGEST ? charge : CHARGE_LARGEST;
}

static bool has_room(const struct answer_bus *bus, size_t charge)
{
    return bus->charge == 0 || bus->charge + charge <= CHARGE_MAX;
}

/* When a query is due. Times of a log may be anything. */
static int64_t due_at(struct answer_bus *bus, int64_t utime)
{
    if (bus->begun_at == 0) {
        bus->begun_at = clock_ns();
        bus->first_utime = utime;
    }
    if (bus->options.speed == 0)
        return bus->begun_at;
    const double us = (double) utime - (double) bus->first_utime;
    return bus->begun_at + (int64_t) fmin(fmax(0, 1000 * us / bus->options.speed), most_ns);
}

static void wait_for_turn(struct answer_bus *bus, const struct slot *slot)
{
    const int64_t due = due_at(bus, slot->query.recorded.place.utime);
    int64_t time;
    while (goes_on(bus) && ((time = clock_ns()) < due || !has_room(bus, slot->charge)))
        step(bus, time < due ? due : time + ns_per_s);
    if (bus->options.speed > 0 && clock_ns() - due > bus->counts.late_ns)
        bus->counts.late_ns = clock_ns() - due;
}

static void begin_slot(struct answer_bus *bus, struct slot *slot)
{
    slot->refusals = 0;
    slot->done = false;
    bus->charge += slot->charge;
    bus->next++;
    ask(bus, slot);
    pass_on(bus);
}

enum answer_now_outcome answer_bus_query(struct answer_bus *bus, const struct match_item *query,
                                         bool last, const char **error)
{
    struct slot *slot = slot_of(bus, bus->next);
    while (goes_on(bus) && bus->next - bus->oldest == WINDOW)
        step(bus, clock_ns() + ns_per_s);
    enum answer_now_outcome outcome = live_begin(bus->live, query, &slot->query, error);
    if ((slot->query.keyed && bus->news) || outcome == ANSWER_NOW_WITHOUT_BODY) {
        wait_for_all(bus);
        outcome = live_begin(bus->live, query, &slot->query, error);
    }
    if (outcome == ANSWER_NOW_UNREADABLE || (outcome == ANSWER_NOW_WITHOUT_BODY && !last))
        return outcome;
    slot->charge = charge_of(slot->query.bytes);
    wait_for_turn(bus, slot);
    if (goes_on(bus))
        begin_slot(bus, slot);
    return ANSWER_NOW_DONE;
}

void answer_bus_pass(struct answer_bus *bus, const struct match_item *item,
                     enum answer_bus_what what)
{
    if (!goes_on(bus))
        return;
    if (!is_under_way(bus)) {
        bus->sink.passed(bus->sink.user, item, what != ANSWER_BUS_QUERY);
        return;
    }
    behind_put(bus->behind, item, what != ANSWER_BUS_QUERY, bus->next);
    bus->news = bus->news || what == ANSWER_BUS_NEWS;
    while (goes_on(bus) && behind_bytes(bus->behind) > BEHIND_MAX)
        step(bus, clock_ns() + ns_per_s);
}

void answer_bus_finish(struct answer_bus *bus)
{
    wait_for_all(bus);
}

bool answer_bus_goes_on(struct answer_bus *bus)
{
    struct pollfd source = {.fd = bus->signals, .events = POLLIN};
    if (++bus->looked % LOOK_EVERY == 0 && poll(&source, 1, 0) > 0)
        stop(bus, ANSWER_BUS_SIGNAL);
    return goes_on(bus);
}

struct tally_bus answer_bus_counts(const struct answer_bus *bus)
{
    return bus->counts;
}

/* ---- Life ---- */

static bool open_intake(struct answer_bus *bus, struct intake *intake, enum log_kind kind)
{
    const bool pair = kind == LOG_PAIR_QUERY;
    intake->bus = bus;
    intake->kind = kind;
    bus_channel(intake->query_channel, bus->options.prefix,
                pair ? WIRE_PAIR_QUERY : WIRE_SCENE_QUERY);
    bus_channel(intake->result_channel, bus->options.prefix,
                pair ? WIRE_PAIR_RESULT : WIRE_SCENE_RESULT);
    /* Those of other clients come in too: room for bursts of them. Beyond it LCM drops. */
    intake->subscription =
        bus_subscribe(bus->lcm, intake->result_channel, on_result, intake, pair ? 10000 : 1000);
    if (!intake->subscription)
        fprintf(stderr, "fmb: cannot listen on channel %s\n", intake->result_channel);
    return intake->subscription != NULL;
}

/* Own queries too would come to LCM, to be read and thrown away, and what could crash it. Where the
 * system takes no filter it works all the same. The signals come last: until the bus is open they
 * simply end the process. */
static bool open_bus(struct answer_bus *bus)
{
    struct filter_others others;
    filter_note_others(&others);
    bus->lcm = bus_open("fmb", bus->options.url, NULL);
    if (!bus->lcm || !open_intake(bus, &bus->pairs, LOG_PAIR_QUERY) ||
        !open_intake(bus, &bus->scenes, LOG_SCENE_QUERY))
        return false;
    const char *channels[] = {bus->pairs.result_channel, bus->scenes.result_channel};
    filter_attach(&others, channels, sizeof channels / sizeof *channels);
    bus->signals = signals_open();
    if (bus->signals < 0)
        perror("fmb: signals");
    return bus->signals >= 0;
}

struct answer_bus *answer_bus_open(const struct answer_bus_options *options,
                                   struct known_bodies *known, const struct answer_bus_sink *sink)
{
    struct answer_bus *bus = allocate(1, sizeof *bus);
    bus->options = *options;
    bus->sink = *sink;
    bus->signals = -1;
    bus->client_id = random_id();
    bus->timeout_ns = (int64_t) fmin((double) ns_per_s * options->timeout, most_ns);
    bus->counts.used = 1;
    bus->live = live_open(known, bus->client_id);
    bus->behind = behind_open();
    bus->slot = allocate(WINDOW, sizeof *bus->slot);
    if (open_bus(bus))
        return bus;
    answer_bus_close(bus);
    return NULL;
}

static void close_intake(struct answer_bus *bus, struct intake *intake)
{
    if (intake->subscription)
        lcm_unsubscribe(bus->lcm, intake->subscription);
}

void answer_bus_close(struct answer_bus *bus)
{
    if (!bus)
        return;
    close_intake(bus, &bus->pairs);
    close_intake(bus, &bus->scenes);
    if (bus->lcm)
        lcm_destroy(bus->lcm);
    if (bus->signals >= 0)
        close(bus->signals);
    live_close(bus->live);
    behind_close(bus->behind);
    free(bus->slot);
    free(bus);
}
