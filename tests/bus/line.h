/* A client's connection to fmbd or to the echo. fmbd is queried through the receiver that its
 * clients use (bus.h), the echo through liblcm only. Nothing is repeated, and nothing is done
 * between the clock and the bus. */
#ifndef LINE_H
#define LINE_H

#include <lcm/lcm.h>

#include "bus.h"
#include "datagram.h"
#include "wire.h"

struct line {
    const char *url; /* not owned */
    bool echo;
    lcm_t *lcm;                /* the echo's, else NULL */
    struct bus *bus;           /* fmbd's, else NULL */
    const char *query_channel; /* scenes, unless it is set */
    long receive_buffer;       /* fmbd's client: granted, bytes */
    int64_t client_id, sequence;
    /* The last reply. */
    int64_t id, arrived_ns;
    int64_t compute_ns; /* as the service reports it; the echo: 0 */
    int32_t status;     /* the echo: 0 */
    size_t size;
    unsigned char bytes[QUERY_BYTES_MAX];
};

/* Opens the line and waits until the other end answers, ten seconds at most. False: it does not, or
 * there is no bus. To be closed with line_close() in any case. */
bool line_open(const char *url, bool echo, struct line *out);
void line_close(struct line *line);

/* Nanoseconds from before the datagram is sent until its reply is handed over; NAN: there was none.
 */
double line_round_trip(struct line *line, struct datagram *datagram);

#endif
