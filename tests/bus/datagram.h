/* What is sent: the bytes of a query or of a request to the echo, made before the clock starts, and
 * changed in place from one to the next. */
#ifndef DATAGRAM_H
#define DATAGRAM_H

#include "query.h"

struct datagram {
    size_t size;
    size_t id_at; /* of its sequence number or id */
    /* Frames whose body is to be another one each time, frame_bytes apart; 0: none. */
    size_t frames_at, frame_bytes;
    int renewed;
    unsigned char bytes[QUERY_BYTES_MAX];
};

/* How the bodies of a query come. */
enum form {
    FORM_HELD,   /* whole, and the service holds them */
    FORM_BY_KEY, /* by the keys that it gave for them */
    FORM_NEW,    /* whole, and never seen before */
    FORMS
};
const char *form_name(enum form form);

/* The queries are as they are to be sent, but for their sequence number. */
void datagram_of_pair(const struct pair_query *query, struct datagram *out);
void datagram_of_scene(const struct scene_query *query, struct datagram *out);
/* The bodies are to be new ones each time: all frames take as many bytes as the first. */
void datagram_renews(struct datagram *datagram, const struct query_frame *first, int frames);

/* On input: sizes of ECHO_BYTES_MIN or more; a reply of 0: none. */
void datagram_of_echo(size_t size, size_t reply, struct datagram *out);

/* Makes it the next one. */
void datagram_next(struct datagram *datagram, int64_t id);

#endif
