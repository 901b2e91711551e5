/* A client's line to fmbd or to the echo: plain lcm_publish() and lcm_handle(), nothing asked
 * again, nothing between the clock and the bus. */
#ifndef LINE_H
#define LINE_H

#include <lcm/lcm.h>

#include "datagram.h"

struct line {
    lcm_t *lcm;
    bool echo;
    const char *query_channel; /* of datagrams that are sent: scenes, until it is set otherwise */
    long receive_buffer;       /* granted, bytes */
    int64_t client_id, sequence;
    /* The reply that came last. */
    int64_t id, arrived_ns;
    int64_t compute_ns; /* as the service says; the echo: 0 */
    int32_t status;     /* the echo: 0 */
    size_t size;
    unsigned char bytes[QUERY_BYTES_MAX];
};

/* Opens the line and waits, ten seconds at most, until somebody answers. To be closed with
 * line_close() in any case. False: nobody does, or there is no bus. */
bool line_open(const char *url, bool echo, struct line *out);
void line_close(struct line *line);

/* Opens it anew as the same client. */
bool line_reopen(const char *url, struct line *line);

/* Sends the datagram as the next one of this line. */
bool line_send(struct line *line, struct datagram *datagram);
/* Until the reply with this id has come. False: the guard was hit, or the bus failed. */
bool line_await(struct line *line, int64_t id);

/* Nanoseconds from before the datagram is sent to when its reply is handed over; NAN: it did not
 * come. */
double line_round_trip(struct line *line, struct datagram *datagram);

/* Asks for nothing, to know what was lost before: of the service, sequence numbers that it saw
 * skipped; of the echo, how many requests it saw. Asked again each time after so many milliseconds,
 * since this may be lost as well, which the echo counts too. -1: no answer within ten seconds. */
int64_t line_count(struct line *line, int patience_ms);

#endif
