#include "line.h"

#include <math.h>
#include <string.h>

#include "big_endian.h"
#include "clock.h"
#include "echo.h"
#include "guard.h"
#include "process.h"

/* Results begin with fingerprint, utime, client id, sequence number and server id; a pair's goes on
 * with two ids and two handles. compute_ns is the last field. */
enum {
    RESULT_SEQUENCE_AT = 24,
    SCENE_STATUS_AT = 40,
    PAIR_STATUS_AT = SCENE_STATUS_AT + 2 * 8 + 2 * HANDLE_BYTES,
    RESULT_BYTES_MIN = PAIR_STATUS_AT + 4 + 8
};

/* ---- Replies ---- */

static bool keep(struct line *line, const void *bytes, size_t size, size_t least)
{
    line->arrived_ns = clock_ns();
    if (size < least || size > sizeof line->bytes)
        return false;
    line->size = size;
    memcpy(line->bytes, bytes, size);
    return true;
}

static void on_echo(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct line *line = user;
    (void) channel;
    if (keep(line, buffer->data, buffer->data_size, ECHO_BYTES_MIN))
        line->id = (int64_t) big_endian_64(line->bytes);
}

static void take_result(struct line *line, const struct bus_message *message, size_t status_at)
{
    if (!keep(line, message->bytes, message->size, RESULT_BYTES_MIN))
        return;
    line->id = (int64_t) big_endian_64(line->bytes + RESULT_SEQUENCE_AT);
    line->status = (int32_t) big_endian_32(line->bytes + status_at);
    line->compute_ns = (int64_t) big_endian_64(line->bytes + line->size - 8);
}

enum { LISTENER_PAIRS, LISTENER_SCENES, LISTENERS };
static const char *const channels[LISTENERS] = {WIRE_PAIR_RESULT, WIRE_SCENE_RESULT};

static void on_message(void *user, const struct bus_message *message)
{
    struct line *line = user;
    take_result(line, message,
                message->listener == LISTENER_PAIRS ? PAIR_STATUS_AT : SCENE_STATUS_AT);
}

/* ---- Opening ---- */

static bool open_echo(struct line *line)
{
    line->lcm = lcm_create(line->url);
    if (!line->lcm)
        return false;
    lcm_subscription_t *replies = lcm_subscribe(line->lcm, ECHO_RESULT, on_echo, line);
    return replies && lcm_subscription_set_queue_capacity(replies, ECHO_QUEUE) == 0;
}

static bool open_service(struct line *line)
{
    char why[BUS_WHY_MAX];
    line->bus = bus_open(line->url, why);
    bool ok = line->bus;
    for (int i = 0; ok && i < LISTENERS; i++)
        ok = bus_listen(line->bus, channels[i], why);
    if (ok)
        line->receive_buffer = bus_counts(line->bus).receive_buffer;
    return ok;
}

void line_close(struct line *line)
{
    if (line->lcm)
        lcm_destroy(line->lcm);
    bus_close(line->bus);
    line->lcm = NULL;
    line->bus = NULL;
}

/* ---- Sending, waiting ---- */

static bool publish(struct line *line, const struct datagram *datagram)
{
    if (!line->echo)
        return bus_publish(line->bus, line->query_channel, datagram->bytes, datagram->size);
    return lcm_publish(line->lcm, line->query_channel, datagram->bytes,
                       (unsigned) datagram->size) == 0;
}

/* Milliseconds after which a wait for fmbd looks at the guard, whose signal may have come just
 * before it. */
enum { LOOK_MS = 100 };

/* Waits for a message or more. */
static bool handle(struct line *line)
{
    if (line->echo)
        return lcm_handle(line->lcm) == 0;
    return bus_wait(line->bus, -1, LOOK_MS) >= 0 && bus_receive(line->bus, on_message, line) >= 0 &&
           !guard_hit();
}

/* Waits for the reply with this id, or a later one. False: the guard was hit, or the bus failed. */
static bool await(struct line *line, int64_t id)
{
    while (line->id < id && handle(line))
        continue;
    return line->id >= id;
}

double line_round_trip(struct line *line, struct datagram *datagram)
{
    datagram_next(datagram, ++line->sequence);
    const int64_t begin = clock_ns();
    if (!publish(line, datagram) || !await(line, line->sequence))
        return NAN;
    return (double) (line->arrived_ns - begin);
}

/* ---- Probing ---- */

static const int64_t patience_ns = 10000000000;

/* A probe is repeated soon, as the other end may not have started. */
enum { SOON_MS = 50 };

/* Handles one message or some; returns false where none came in time. */
static bool handle_for(struct line *line, int timeout_ms)
{
    if (line->echo)
        return lcm_handle_timeout(line->lcm, timeout_ms) > 0;
    return bus_wait(line->bus, -1, timeout_ms) > 0 && bus_receive(line->bus, on_message, line) > 0;
}

static void make_probe(const struct line *line, struct datagram *out)
{
    const struct scene_query nothing = {.client_id = line->client_id, .duration = 1};
    if (line->echo)
        datagram_of_echo(ECHO_BYTES_MIN, ECHO_BYTES_MIN, out);
    else
        datagram_of_scene(&nothing, out);
}

/* A request for nothing, repeated until it is answered. */
static bool probe(struct line *line)
{
    static struct datagram datagram;
    const char *channel = line->query_channel;
    make_probe(line, &datagram);
    line->query_channel = line->echo ? ECHO_QUERY : WIRE_SCENE_QUERY;
    const int64_t first = line->sequence + 1, end = clock_ns() + patience_ns;
    while (line->id < first && clock_ns() < end) {
        datagram_next(&datagram, ++line->sequence);
        publish(line, &datagram);
        while (line->id < first && handle_for(line, SOON_MS))
            continue;
    }
    line->query_channel = channel;
    return line->id >= first;
}

bool line_open(const char *url, bool echo, struct line *out)
{
    memset(out, 0, sizeof *out);
    out->url = url;
    out->echo = echo;
    out->client_id = random_id();
    out->query_channel = echo ? ECHO_QUERY : WIRE_SCENE_QUERY;
    return (echo ? open_echo(out) : open_service(out)) && probe(out);
}
