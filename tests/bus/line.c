#include "line.h"

#include <math.h>
#include <string.h>

#include "bus.h"
#include "bytes.h"
#include "clock.h"
#include "echo.h"
#include "guard.h"
#include "random_id.h"
#include "wire.h"

/* Replies that LCM may keep; more than are ever under way. */
enum { LCM_QUEUE = 4096 };

/* Of results: utime, client id, sequence number, server id come first, compute_ns last. */
enum { RESULT_SEQUENCE_AT = 24, PAIR_STATUS_AT = 72, SCENE_STATUS_AT = 40, RESULT_BYTES_MIN = 84 };

static void read_result(struct line *line, size_t status_at)
{
    if (line->size < RESULT_BYTES_MIN)
        return;
    line->id = (int64_t) bytes_get(line->bytes + RESULT_SEQUENCE_AT, 8);
    line->status = (int32_t) bytes_get(line->bytes + status_at, 4);
    line->compute_ns = (int64_t) bytes_get(line->bytes + line->size - 8, 8);
}

static bool keep(struct line *line, const lcm_recv_buf_t *buffer)
{
    line->arrived_ns = clock_ns();
    if (buffer->data_size < ECHO_BYTES_MIN || buffer->data_size > sizeof line->bytes)
        return false;
    line->size = buffer->data_size;
    memcpy(line->bytes, buffer->data, line->size);
    return true;
}

static void on_echo(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct line *line = user;
    (void) channel;
    if (keep(line, buffer))
        line->id = (int64_t) bytes_get(line->bytes, 8);
}

static void on_pair(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct line *line = user;
    (void) channel;
    if (keep(line, buffer))
        read_result(line, PAIR_STATUS_AT);
}

static void on_scene(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct line *line = user;
    (void) channel;
    if (keep(line, buffer))
        read_result(line, SCENE_STATUS_AT);
}

static bool subscribe(struct line *line)
{
    if (line->echo)
        return bus_subscribe(line->lcm, ECHO_RESULT, on_echo, line, LCM_QUEUE);
    return bus_subscribe(line->lcm, WIRE_PAIR_RESULT, on_pair, line, LCM_QUEUE) &&
           bus_subscribe(line->lcm, WIRE_SCENE_RESULT, on_scene, line, LCM_QUEUE);
}

/* How often what is to come up is asked. */
enum { OFTEN_MS = 50 };

bool line_reopen(const char *url, struct line *line)
{
    line->lcm = bus_open("bench-bus", url, &line->receive_buffer);
    return line->lcm && subscribe(line);
}

bool line_open(const char *url, bool echo, struct line *out)
{
    memset(out, 0, sizeof *out);
    out->echo = echo;
    out->client_id = random_id();
    out->query_channel = echo ? ECHO_QUERY : WIRE_SCENE_QUERY;
    return line_reopen(url, out) && line_count(out, OFTEN_MS) >= 0;
}

void line_close(struct line *line)
{
    if (line->lcm)
        lcm_destroy(line->lcm);
    line->lcm = NULL;
}

bool line_send(struct line *line, struct datagram *datagram)
{
    datagram_next(datagram, ++line->sequence);
    return lcm_publish(line->lcm, line->query_channel, datagram->bytes,
                       (unsigned) datagram->size) == 0;
}

bool line_await(struct line *line, int64_t id)
{
    while (line->id != id)
        if (lcm_handle(line->lcm) != 0)
            return false;
    return true;
}

double line_round_trip(struct line *line, struct datagram *datagram)
{
    datagram_next(datagram, ++line->sequence);
    const int64_t begin = clock_ns();
    if (lcm_publish(line->lcm, line->query_channel, datagram->bytes, (unsigned) datagram->size) !=
            0 ||
        !line_await(line, line->sequence))
        return NAN;
    return (double) (line->arrived_ns - begin);
}

/* ---- Counting ---- */

static void datagram_of_nothing(const struct line *line, struct datagram *out)
{
    static const struct scene_query nothing = {.duration = 1};
    if (line->echo) {
        datagram_of_echo(ECHO_BYTES_MIN, ECHO_BYTES_MIN, out);
        return;
    }
    datagram_of_scene(&nothing, out);
    bytes_put(out->bytes + out->id_at - 8, (uint64_t) line->client_id, 8);
}

static int64_t counted(const struct line *line)
{
    static struct scene_result result;
    if (line->echo)
        return (int64_t) bytes_get(line->bytes + ECHO_COUNT_AT, 8);
    return wire_read_scene_result(line->bytes, (uint32_t) line->size, &result) ? -1 : result.lost;
}

static bool has_come(const struct line *line)
{
    return line->id == line->sequence;
}

/* Asked again and again: the other one may not be there yet, or this may be what is lost. The same
 * number asks the same again; what was sent before has been read when it is answered. */
int64_t line_count(struct line *line, int patience_ms)
{
    static struct datagram nothing;
    datagram_of_nothing(line, &nothing);
    datagram_next(&nothing, ++line->sequence);
    for (int64_t end = clock_ns() + 10000000000; clock_ns() < end && !has_come(line);) {
        lcm_publish(line->lcm, line->echo ? ECHO_QUERY : WIRE_SCENE_QUERY, nothing.bytes,
                    (unsigned) nothing.size);
        while (!has_come(line) && lcm_handle_timeout(line->lcm, patience_ms) > 0)
            ;
    }
    return has_come(line) ? counted(line) : -1;
}
