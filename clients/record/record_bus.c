#include "record_bus.h"

#include "bus.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Messages that LCM keeps of each channel until they are drained, in memory of its own; beyond that
 * it drops the newest, without a word. Of pairs that is a tenth of a second at the highest rate
 * that the bus carries: some 8 MB, or 1 GB if each were as large as a datagram; of the largest
 * scenes 67 MB. */
static const int lcm_queue[LOG_KINDS] = {
    [LOG_PAIR_QUERY] = 16384,  [LOG_PAIR_RESULT] = 16384, [LOG_SCENE_QUERY] = 1024,
    [LOG_SCENE_RESULT] = 1024, [LOG_STATUS] = 1024,       [LOG_OTHER] = 4096,
};

/* Messages drained before the caller may look at something else. */
enum { DRAINED_MAX = 1024 };

static void on_own(const lcm_recv_buf_t *message, const char *channel, void *user)
{
    const struct record_intake *intake = user;
    intake->bus->sink(intake->bus->user, intake->kind, channel, message);
}

/* The service's own channels may match too; those come twice then. */
static void on_other(const lcm_recv_buf_t *message, const char *channel, void *user)
{
    const struct record_intake *intake = user;
    const struct log_event event = {.channel = channel, .channel_length = strlen(channel)};
    if (log_kind_of(&intake->bus->channels, &event) == LOG_OTHER)
        on_own(message, channel, user);
}

static bool subscribe_to_own(struct record_bus *bus)
{
    for (int kind = 0; kind < LOG_OTHER; kind++)
        if (!bus_subscribe(bus->lcm, bus->channels.name[kind], on_own, &bus->intake[kind],
                           lcm_queue[kind]))
            return false;
    return true;
}

/* LCM puts an anchor before and one behind, which without parentheses would belong to the first and
 * the last of several alternatives. */
static bool subscribe_to_other(struct record_bus *bus, const char *pattern)
{
    const size_t size = strlen(pattern) + sizeof "()";
    char *whole = malloc(size);
    if (!whole)
        return false;
    snprintf(whole, size, "(%s)", pattern);
    const bool ok = bus_subscribe(bus->lcm, whole, on_other, &bus->intake[LOG_OTHER],
                                  lcm_queue[LOG_OTHER]) != NULL;
    free(whole);
    return ok;
}

/* Where others are not wanted, the system keeps them out: their messages fill no buffer, and pieces
 * of larger ones, which could crash LCM, do not reach it. */
static void keep_out_others(struct record_bus *bus)
{
    const char *channels[LOG_OTHER];
    for (int kind = 0; kind < LOG_OTHER; kind++)
        channels[kind] = bus->channels.name[kind];
    bus->filtered = filter_attach(&bus->others, channels, LOG_OTHER) > 0;
}

static int listen_to(struct record_bus *bus, const char *other)
{
    if (!subscribe_to_own(bus)) {
        fputs("fmb: the bus takes no subscription\n", stderr);
        return ARGS_FAILED;
    }
    if (other && !subscribe_to_other(bus, other)) {
        fprintf(stderr, "fmb: LCM takes no such regular expression: '%s'\n", other);
        return ARGS_USAGE;
    }
    if (!other)
        keep_out_others(bus);
    return ARGS_RUN;
}

int record_bus_open(const struct args_bus *bus, const char *other, record_sink *sink, void *user,
                    struct record_bus *out)
{
    *out = (struct record_bus){.channels = log_channels(bus->prefix), .sink = sink, .user = user};
    for (int kind = 0; kind < LOG_KINDS; kind++)
        out->intake[kind] = (struct record_intake){out, (enum log_kind) kind};
    filter_note_others(&out->others);
    out->lcm = bus_open("fmb", bus->url, &out->receive_buffer);
    if (!out->lcm)
        return ARGS_FAILED;
    const int code = listen_to(out, other);
    if (code != ARGS_RUN)
        record_bus_close(out);
    return code;
}

void record_bus_close(struct record_bus *bus)
{
    lcm_destroy(bus->lcm);
    bus->lcm = NULL;
}

bool record_bus_has_more(const struct record_bus *bus, int wait_ms)
{
    struct pollfd source = {.fd = lcm_get_fileno(bus->lcm), .events = POLLIN};
    return poll(&source, 1, wait_ms) > 0;
}

/* EINTR: the process was stopped and goes on. */
bool record_bus_drain(struct record_bus *bus)
{
    for (int drained = 0; drained < DRAINED_MAX && record_bus_has_more(bus, 0); drained++) {
        errno = 0;
        if (lcm_handle(bus->lcm) != 0 && errno != EINTR)
            return false;
    }
    return true;
}

int64_t record_bus_dropped(const struct record_bus *bus)
{
    return bus->filtered ? -1 : filter_dropped(&bus->others);
}
