/* The bodies of a log, by handle.
 *
 * Bodies come from placements that carry them whole, and from definition_t messages, anywhere in
 * the log. Each distinct body is kept once, in some 150 bytes and its geometry (at most 109 bytes
 * for a frame): memory grows with the number of distinct bodies, not with the log. Adding a known
 * body costs one look-up. Handles are only computed once a first one is looked up.
 *
 * For one thread at a time. */
#ifndef DEFINITIONS_H
#define DEFINITIONS_H

#include "query.h"

struct definitions;

/* Exits with status 1 if memory is exhausted. The caller closes it. */
struct definitions *definitions_open(void);
void definitions_close(struct definitions *definitions); /* may be NULL */

/* Adds a body. On input: its geometry, which is copied; one without frames (of a placement by
 * handle) is ignored. Returns whether the body is new. */
bool definitions_add(struct definitions *definitions, const struct geometry *geometry);

/* The same for the body of a placement, if it is whole and has an id: services keep no others. */
bool definitions_add_placement(struct definitions *definitions, const struct placement *placement);

/* Adds the whole bodies of a message of at most QUERY_BYTES_MAX bytes: of a pair_query_t or
 * scene_query_t (_query), or of a definition_t (_message). Returns NULL; or a static text: why the
 * message cannot be decoded, and nothing of it was added. */
const char *definitions_add_query(struct definitions *definitions, const void *bytes,
                                  uint32_t size);
const char *definitions_add_message(struct definitions *definitions, const void *bytes,
                                    uint32_t size);

/* The geometry of a handle, valid until definitions_close(); NULL: no such body was added. */
const struct geometry *definitions_find(struct definitions *definitions,
                                        const struct handle *handle);

/* Number of bodies, and the bytes of memory that they take, tables included. */
size_t definitions_count(const struct definitions *definitions);
size_t definitions_bytes(const struct definitions *definitions);

#endif
