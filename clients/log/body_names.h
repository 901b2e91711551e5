/* The names of the bodies of a log: the last one that a client sent with a body's id, in the
 * placements of its queries or in a names_t message. Names are bytes from the bus. At most
 * BODY_NAMES_MAX are kept, and none of more than QUERY_NAME_MAX bytes, which services refuse. For
 * one thread at a time. */
#ifndef BODY_NAMES_H
#define BODY_NAMES_H

#include "logged_query.h"

enum { BODY_NAMES_MAX = 1 << 14 };

struct body_names;

/* Exits with status 1 if memory is exhausted. */
struct body_names *body_names_open(void);
void body_names_close(struct body_names *names); /* may be NULL */

/* Sets the names that a client's query gives to its bodies. */
void body_names_take(struct body_names *names, const struct logged_query *query);

/* Sets the names in a names_t. Returns NULL; or a static text: why it cannot be decoded. */
const char *body_names_read(struct body_names *names, const void *bytes, uint32_t size);

/* The name; NULL: none. names may be NULL: there are none. */
const char *body_names_find(const struct body_names *names, int64_t client_id, int64_t body_id);

int32_t body_names_count(const struct body_names *names);

/* Writes all names as names_t messages; none if there are none. Returns false as soon as sink does.
 */
bool body_names_write(const struct body_names *names, int64_t utime, log_sink *sink, void *user);

#endif
