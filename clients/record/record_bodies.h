/* The bodies of a recording: makes sure that each of its files defines the handles that its queries
 * name.
 *
 * Bodies come from queries that carry them whole, and from definitions. Definitions are requested
 * from the service: of all bodies at the start, later of unknown handles in answered queries. Up to
 * RECORD_BODIES_BYTES of bodies are kept; beyond that the least recently used are dropped. In each
 * file a definition (definition_t of client 0 and server 0) precedes the first query that names the
 * handle. */
#ifndef RECORD_BODIES_H
#define RECORD_BODIES_H

#include "log_kind.h"

enum { RECORD_BODIES_BYTES = 64 << 20 };

struct record_bodies;

/* Publishes a definition_query_t. */
typedef void record_publish(void *user, const void *bytes, size_t size);

/* Requests all bodies. Exits with status 1 if memory is exhausted. */
struct record_bodies *record_bodies_open(record_publish *publish, void *user);
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

/* Writes these definitions, one message after the other. Returns false as soon as write does. */
typedef bool record_write(void *user, const void *bytes, size_t size);
bool record_bodies_define(struct record_bodies *bodies, record_write *write, void *user);

/* Begins a new file, which defines nothing yet. */
void record_bodies_begin_file(struct record_bodies *bodies);

/* Sends requests that are due. Returns the time to call it again; INT64_MAX: after the next
 * message. Quick if nothing is due. */
int64_t record_bodies_request(struct record_bodies *bodies, int64_t now_ns);

struct record_bodies_counts {
    int64_t defined;    /* bodies in written definitions */
    int64_t dropped;    /* bodies dropped because there were too many; an upper bound */
    int64_t unresolved; /* handles in answered queries whose bodies could not be obtained */
};
struct record_bodies_counts record_bodies_counts(const struct record_bodies *bodies);

#endif
