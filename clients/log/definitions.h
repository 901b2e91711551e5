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

#include "wire.h"

struct definitions;

/* Exits with status 1 if memory is exhausted. The caller closes it. */
struct definitions *definitions_open(void);
void definitions_close(struct definitions *definitions); /* may be NULL */

/* Adds a body. In: its geometry, which is copied; one without frames (of a placement by handle) is
 * ignored. Returns whether the body is new. */
bool definitions_add(struct definitions *definitions, const struct geometry *geometry);

/* Adds the body of a placement if it has frames and an id: services cache no others. */
bool definitions_add_placement(struct definitions *definitions, const struct placement *placement);

/* Adds the bodies with frames of a message of at most QUERY_BYTES_MAX bytes: of a pair_query_t or
 * scene_query_t (_query), or of a definition_t (_message). Returns NULL; or a static text: why the
 * message cannot be decoded. Then nothing of it was added. */
const char *definitions_add_query(struct definitions *definitions, const void *bytes,
                                  uint32_t size);
const char *definitions_add_message(struct definitions *definitions, const void *bytes,
                                    uint32_t size);

/* The geometry of a handle, valid until definitions_close(); NULL: no such body was added. */
const struct geometry *definitions_find(struct definitions *definitions,
                                        const struct handle *handle);

/* The first placement by handle whose body was not added; -1: none. */
int32_t definitions_missing(struct definitions *definitions, const struct placement *placement,
                            int32_t count);

/* Sets the geometry of each placement by handle whose body was added. */
void definitions_fill(struct definitions *definitions, struct placement *placement, int32_t count);

/* The number of bodies, and the memory they take, tables included, bytes. */
size_t definitions_count(const struct definitions *definitions);
size_t definitions_bytes(const struct definitions *definitions);

/* ---- Writing ---- */

/* Bytes of a definition_t without bodies, of client 0 and server 0. */
enum { DEFINITION_BYTES = WIRE_DEFINITION_BYTES - QUERY_TEXT_MAX + 1 };

/* Writes a message. Returns false if it failed. */
typedef bool definition_sink(void *user, const void *bytes, size_t size);

/* Packs bodies into such messages. The caller sets sink and user, and all other members to 0. */
struct definition_writer {
    definition_sink *sink;
    void *user;
    size_t size; /* of the bodies in the message */
    struct definition definition;
    unsigned char bytes[QUERY_BYTES_MAX];
};

/* Adds a body. Its geometry must stay valid until it is written, at the latest by
 * definition_writer_flush(). Return false if the sink does. */
bool definition_writer_add(struct definition_writer *writer, const struct handle *handle,
                           const struct geometry *geometry);
bool definition_writer_flush(struct definition_writer *writer);

#endif
