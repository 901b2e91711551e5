/* Messages to send: the bytes of a query or of a request to the echo, encoded before the clock
 * starts and changed in place from one message to the next. */
#ifndef DATAGRAM_H
#define DATAGRAM_H

#include "query.h"

struct datagram {
    size_t size;
    size_t id_at; /* of its sequence number or id */
    /* Placements whose bodies change with each message, placement_bytes apart; 0: none. */
    size_t placements_at, placement_bytes;
    int renewed;
    unsigned char bytes[QUERY_BYTES_MAX];
};

/* How the bodies of a query are given. */
enum form {
    FORM_HELD,      /* whole, and the service holds them */
    FORM_BY_HANDLE, /* by their handles */
    FORM_NEW,       /* whole, and new to the service each time */
    FORMS
};
const char *form_name(enum form form);

/* Complete but for the sequence number. */
void datagram_of_pair(const struct pair_query *query, struct datagram *out);
void datagram_of_scene(const struct scene_query *query, struct datagram *out);

/* From now on each message has new bodies. On input: placements of one frame in 3D, which all take
 * as many bytes as the first; the first number of its first component is not 0. */
void datagram_renew(struct datagram *datagram, const struct query_placement *first, int placements);

/* On input: sizes from ECHO_BYTES_MIN; a reply of 0: none. */
void datagram_of_echo(size_t size, size_t reply, struct datagram *out);

/* Turns it into the next message. */
void datagram_next(struct datagram *datagram, int64_t id);

#endif
