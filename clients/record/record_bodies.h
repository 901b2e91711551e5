/* The bodies and names of a recording. Each of its files has to define the handles that its queries
 * name, and the names of the bodies.
 *
 * Bodies come from queries that carry them whole, and from definitions. Definitions are requested
 * from the service: of all bodies at the start, later of the unknown handles that queries name. The
 * caller sends the requests and receives their results (fmb_client_raw.h); results with bodies are
 * recorded as they are. Up to RECORD_BODIES_BYTES of bodies are kept. When there are more, all are
 * dropped, and requested again if queries name them.
 *
 * In a file that does not begin the recording, definitions are written before the first query that
 * names the handle, and the names are at its beginning. */
#ifndef RECORD_BODIES_H
#define RECORD_BODIES_H

#include "body_names.h"
#include "definitions.h"
#include "fmb_client_raw.h"

enum { RECORD_BODIES_BYTES = 64 << 20 };

struct record_bodies;

/* client_id: of the requests. Exits with status 1 if memory is exhausted. */
struct record_bodies *record_bodies_open(int64_t client_id);
void record_bodies_close(struct record_bodies *bodies);

/* Reads a received message of one of the service's channels. Returns NULL; or a static text: why it
 * cannot be decoded. */
const char *record_bodies_read(struct record_bodies *bodies, enum log_kind kind,
                               const unsigned char *bytes, size_t size);

/* Who the message read is for, and whether it is recorded. */
enum record_bodies_owner {
    RECORD_OTHERS, /* clients and services: recorded */
    RECORD_OWN,    /* this recorder: a request, or a result without bodies */
    RECORD_BODIES  /* this recorder: a result with bodies, which is recorded */
};
enum record_bodies_owner record_bodies_owner(const struct record_bodies *bodies);

/* Begins a file that defines nothing yet, and writes the names to it. */
bool record_bodies_begin_file(struct record_bodies *bodies, int64_t utime, log_sink *sink,
                              void *user);

/* Most bytes of the events with the definitions that must precede the message read; 0: none. */
size_t record_bodies_needed(const struct record_bodies *bodies);

/* Writes these definitions, one message after the other. Returns false as soon as sink does. */
bool record_bodies_define(struct record_bodies *bodies, log_sink *sink, void *user);

/* Keeps the bodies and names of the message read, which is in the file. */
void record_bodies_keep(struct record_bodies *bodies);

/* The time when a request is due; INT64_MAX: none is, before the next message. */
int64_t record_bodies_due(const struct record_bodies *bodies);

/* Writes the definition_query_t that is due, without ids. Returns its size; 0: none is due. The
 * next one is due after record_bodies_take_result(). */
size_t record_bodies_request(struct record_bodies *bodies, int64_t now_ns,
                             unsigned char out[QUERY_BYTES_MAX]);

/* A fmb_client_raw_sink for requests; user: the bodies. Handles whose request had no result are
 * requested again after the next query that names them. */
void record_bodies_take_result(void *user, const struct fmb_client_raw_result *result);

struct record_bodies_counts {
    int64_t defined;    /* bodies in definitions that were written for this recording */
    int64_t dropped;    /* bodies dropped because there were too many */
    int64_t unresolved; /* handles in queries whose bodies could not be obtained */
    int64_t skipped;    /* sequence numbers of queries that did not arrive */
};
struct record_bodies_counts record_bodies_counts(const struct record_bodies *bodies);

#endif
