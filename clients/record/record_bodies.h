/* The bodies of a recording. Each of its files has to define the handles that its queries name.
 *
 * Bodies come from queries that carry them whole, and from definitions. Definitions are requested
 * from the service: of all bodies at the start, later of unknown handles in answered queries. The
 * caller sends the requests and receives their results (fmb_client_raw.h). Up to
 * RECORD_BODIES_BYTES of bodies are kept; beyond that the least recently used are dropped. In each
 * file a definition (definition_t of client 0 and server 0) precedes the first query that names the
 * handle. */
#ifndef RECORD_BODIES_H
#define RECORD_BODIES_H

#include "definitions.h"
#include "fmb_client_raw.h"
#include "log_kind.h"

enum { RECORD_BODIES_BYTES = 64 << 20 };

struct record_bodies;

/* client_id: of the requests. Exits with status 1 if memory is exhausted. */
struct record_bodies *record_bodies_open(int64_t client_id);
void record_bodies_close(struct record_bodies *bodies);

/* Processes a received message of one of the service's channels. Returns NULL; or a static text:
 * why it cannot be decoded. */
const char *record_bodies_take(struct record_bodies *bodies, enum log_kind kind,
                               const unsigned char *bytes, size_t size);

/* Whether the last message processed is a request of this recorder, or the answer to one. Its
 * bodies are written before the queries that name them. */
bool record_bodies_is_own(const struct record_bodies *bodies);

/* Most bytes of the events with the definitions that must precede the last message processed; 0:
 * none. */
size_t record_bodies_needed(const struct record_bodies *bodies);

/* Writes these definitions, one message after the other. Returns false as soon as sink does. */
bool record_bodies_define(struct record_bodies *bodies, definition_sink *sink, void *user);

/* Begins a new file, which defines nothing yet. */
void record_bodies_begin_file(struct record_bodies *bodies);

/* As record_bodies_define(), of all known bodies that the file defined, for one that has lost its
 * beginning. The last message counts as processed. */
bool record_bodies_define_again(struct record_bodies *bodies, definition_sink *sink, void *user);

/* The time when a request is due; INT64_MAX: none is, before the next message. */
int64_t record_bodies_due(const struct record_bodies *bodies);

/* Writes the definition_query_t that is due, without ids. Returns its size; 0: none is due. The
 * next one is due after record_bodies_take_result(). */
size_t record_bodies_request(struct record_bodies *bodies, int64_t now_ns,
                             unsigned char out[QUERY_BYTES_MAX]);

/* A fmb_client_raw_sink for requests; user: the bodies. Handles whose request had no result are
 * requested again after the next answered query that names them. */
void record_bodies_take_result(void *user, const struct fmb_client_raw_result *result);

struct record_bodies_counts {
    int64_t defined;    /* bodies in written definitions */
    int64_t dropped;    /* bodies dropped because there were too many; an upper bound */
    int64_t unresolved; /* handles in answered queries whose bodies could not be obtained */
};
struct record_bodies_counts record_bodies_counts(const struct record_bodies *bodies);

#endif
