/* The bodies of a log, by handle.
 *
 * Bodies come from placements that carry them whole, and from definition_t messages, anywhere in
 * the log. Each distinct body is kept once, in some 200 bytes and its encoded form (at most 109
 * bytes for a frame): memory grows with the number of distinct bodies, not with the log. Adding a
 * body that is known costs one look-up.
 *
 * A file that is written has to define the handles that its queries name. Per file and body one
 * definition (definition_t of client 0 and server 0) is written, before the first query that needs
 * it; a file that contains the body in another message needs none.
 *
 * For one thread at a time. */
#ifndef DEFINITIONS_H
#define DEFINITIONS_H

#include "body_names.h"
#include "wire.h"

struct definitions;

/* Exits with status 1 if memory is exhausted. The caller closes it. */
struct definitions *definitions_open(void);
void definitions_close(struct definitions *definitions); /* may be NULL */

/* Adds a body, which is copied; one without frames (of a placement by handle) is ignored. Its
 * handle is not read. Returns whether the body is new. */
bool definitions_add(struct definitions *definitions, const struct body_view *view);

/* Adds the bodies of a query that have frames and an id: services cache no others. */
void definitions_add_query(struct definitions *definitions, const struct logged_query *query);

/* Adds the bodies that have frames in a message: a pair query, a scene query, or a definition;
 * others have none. Sets the names in a query or a names_t too, unless names is NULL. Returns NULL;
 * or a static text: why the message cannot be decoded. Then nothing of it was added. */
const char *definitions_add_message(struct definitions *definitions, struct body_names *names,
                                    enum log_kind kind, const void *bytes, uint32_t size);

/* The body of a handle, valid until definitions_close(); NULL: no such body was added. */
const struct body_view *definitions_find(struct definitions *definitions,
                                         const struct handle *handle);

/* Replaces the handle of each placement of a query whose body was added by that body. Returns the
 * first one whose body was not; -1: none. */
int32_t definitions_fill(struct definitions *definitions, struct logged_query *query);

/* The number of bodies, and the memory they take, tables included, bytes. */
size_t definitions_count(struct definitions *definitions);
size_t definitions_bytes(struct definitions *definitions);

/* ---- Handles without a body ---- */

/* Notes a handle that is named, but whose body was not added. Returns whether it is new, or was
 * given up. */
bool definitions_want(struct definitions *definitions, const struct handle *handle);
void definitions_give_up(struct definitions *definitions, const struct handle *handle);

/* The number of these handles whose bodies were not added later. */
size_t definitions_wanted(struct definitions *definitions);

/* ---- Files that define what they name ---- */

/* Begins a file, which defines nothing yet. Bodies that are added later are in the file, and so are
 * those that were known and are added again. */
void definitions_begin_file(struct definitions *definitions);

/* Most bytes that definitions_write() writes, events of the log included. */
size_t definitions_needed(struct definitions *definitions, const struct query_placement *placement,
                          int32_t count);

/* Writes a definition_t of each known body that the placements name by handle and the file does not
 * define. Returns the number of bodies; -1 as soon as sink returns false. */
int32_t definitions_write(struct definitions *definitions, const struct query_placement *placement,
                          int32_t count, log_sink *sink, void *user);

#endif
