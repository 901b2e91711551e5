/* A service's messages as they come by on a bus: byte for byte, well formed or not. */
#ifndef RECORD_BUS_H
#define RECORD_BUS_H

#include "args.h"
#include "filter.h"
#include "log_kind.h"

#include <lcm/lcm.h>

/* Called for each message. channel and *message are good until it returns. message->data_size can
 * be a negative number of ints. */
typedef void record_sink(void *user, enum log_kind kind, const char *channel,
                         const lcm_recv_buf_t *message);

struct record_bus {
    lcm_t *lcm;
    struct filter_others others;
    long receive_buffer; /* bytes that the system grants; 0: not known */
    bool filtered;       /* the system passes nothing on but whole datagrams on the channels */
    struct record_intake {
        const struct record_bus *bus;
        enum log_kind kind;
    } intake[LOG_KINDS];
    struct log_channels channels;
    record_sink *sink;
    void *user;
};

/* Opens the bus and listens to the channels of the service, and to all others that match a regular
 * expression; other: NULL for none. On output: ARGS_RUN; or after lines on stderr an exit code, and
 * there is nothing to close. Messages wait from now on. *out must stay where it is. */
int record_bus_open(const struct args_bus *bus, const char *other, record_sink *sink, void *user,
                    struct record_bus *out);
void record_bus_close(struct record_bus *bus);

/* Takes what the bus has, up to a limit. False: it failed, errno. */
bool record_bus_drain(struct record_bus *bus);

/* Whether it has something, or gets something within so many milliseconds. */
bool record_bus_has_more(const struct record_bus *bus, int wait_ms);

/* How many datagrams, on whatever channels, the system has thrown away because LCM did not take
 * them in time; -1: not known, as it is where it keeps others out by itself. */
int64_t record_bus_dropped(const struct record_bus *bus);

#endif
