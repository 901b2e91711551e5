#include "definitions.h"

#include "logged_query.h"
#include "big_endian.h"
#include "keyed_hash.h"

#include <stdlib.h>
#include <string.h>

struct defined_body {
    UT_hash_handle by_bytes, by_handle;
    struct defined_body *next; /* the next body whose handle is not computed yet */
    struct handle handle;
    struct geometry geometry;
    unsigned char bytes[];
};

/* Approximate overhead of the two tables and the allocator for each body. */
enum { TABLE_BYTES = 48 };

struct definitions {
    struct defined_body *by_bytes, *by_handle; /* heads of the tables */
    struct defined_body *unhashed;
    size_t bytes; /* of all bodies */
    struct hasher *hasher;
    struct logged_query query;
    struct definition definition;
};

/* ---- Opening and closing ----------------------------------------------------------------------
 */

struct definitions *definitions_open(void)
{
    struct definitions *definitions = allocate(1, sizeof *definitions);
    definitions->hasher = hasher_create();
    if (!definitions->hasher)
        allocate_failed();
    return definitions;
}

void definitions_close(struct definitions *definitions)
{
    if (!definitions)
        return;
    struct defined_body *first = definitions->by_bytes;
    HASH_CLEAR(by_handle, definitions->by_handle);
    HASH_CLEAR(by_bytes, definitions->by_bytes);
    while (first) {
        struct defined_body *next = first->by_bytes.next;
        free(first);
        first = next;
    }
    hasher_destroy(definitions->hasher);
    free(definitions);
}

/* ---- Adding -----------------------------------------------------------------------------------
 */

static bool has_frames(const struct geometry *geometry)
{
    return geometry->size > GEOMETRY_NONE_BYTES && big_endian_32(geometry->bytes + 4) > 0;
}

bool definitions_add(struct definitions *definitions, const struct geometry *geometry)
{
    struct defined_body *body;
    if (!has_frames(geometry))
        return false;
    HASH_FIND(by_bytes, definitions->by_bytes, geometry->bytes, geometry->size, body);
    if (body)
        return false;
    body = allocate(1, sizeof *body + geometry->size);
    memcpy(body->bytes, geometry->bytes, geometry->size);
    body->geometry = (struct geometry){body->bytes, geometry->size};
    HASH_ADD_KEYPTR(by_bytes, definitions->by_bytes, body->bytes, body->geometry.size, body);
    definitions->bytes += sizeof *body + TABLE_BYTES + geometry->size;
    body->next = definitions->unhashed;
    definitions->unhashed = body;
    return true;
}

bool definitions_add_placement(struct definitions *definitions, const struct placement *placement)
{
    return placement->body_id != 0 && definitions_add(definitions, &placement->geometry);
}

static const char too_long[] = "longer than any message of this type";

const char *definitions_add_query(struct definitions *definitions, const void *bytes, uint32_t size)
{
    struct logged_query *query = &definitions->query;
    struct query_header header;
    int32_t count;
    if (size > QUERY_BYTES_MAX)
        return too_long;
    const bool pair = !wire_read_pair_header(bytes, size, &header);
    const char *error =
        logged_query_read(query, pair ? LOG_PAIR_QUERY : LOG_SCENE_QUERY, bytes, size);
    const struct placement *placement = logged_query_placements(query, &count);
    for (int32_t i = 0; !error && i < count; i++)
        definitions_add_placement(definitions, &placement[i]);
    return error;
}

const char *definitions_add_message(struct definitions *definitions, const void *bytes,
                                    uint32_t size)
{
    struct definition *definition = &definitions->definition;
    const char *error = size > QUERY_BYTES_MAX
                            ? too_long
                            : wire_read_definition(bytes, size, definitions->hasher, definition);
    for (int32_t i = 0; !error && i < definition->body_count; i++)
        definitions_add(definitions, &definition->body[i].geometry);
    return error;
}

/* ---- Finding ----------------------------------------------------------------------------------
 */

static void compute_handles(struct definitions *definitions)
{
    for (struct defined_body *body; (body = definitions->unhashed) != NULL;) {
        definitions->unhashed = body->next;
        body->handle = hasher_handle(definitions->hasher, body->bytes, body->geometry.size);
        HASH_ADD(by_handle, definitions->by_handle, handle, sizeof body->handle, body);
    }
}

const struct geometry *definitions_find(struct definitions *definitions,
                                        const struct handle *handle)
{
    const struct defined_body *body;
    compute_handles(definitions);
    HASH_FIND(by_handle, definitions->by_handle, handle, sizeof *handle, body);
    return body ? &body->geometry : NULL;
}

int32_t definitions_missing(struct definitions *definitions, const struct placement *placement,
                            int32_t count)
{
    for (int32_t i = 0; i < count; i++)
        if (placement_by_handle(&placement[i]) &&
            !definitions_find(definitions, &placement[i].handle))
            return i;
    return -1;
}

void definitions_fill(struct definitions *definitions, struct placement *placement, int32_t count)
{
    for (int32_t i = 0; i < count; i++) {
        const struct geometry *geometry = placement_by_handle(&placement[i])
                                              ? definitions_find(definitions, &placement[i].handle)
                                              : NULL;
        if (geometry)
            placement[i].geometry = *geometry;
    }
}

size_t definitions_count(const struct definitions *definitions)
{
    return HASH_CNT(by_bytes, definitions->by_bytes);
}

size_t definitions_bytes(const struct definitions *definitions)
{
    return definitions->bytes;
}

/* ---- Writing ----------------------------------------------------------------------------------
 */

bool definition_writer_flush(struct definition_writer *writer)
{
    if (writer->definition.body_count == 0)
        return true;
    const size_t size = wire_write_definition(&writer->definition, writer->bytes);
    writer->definition.body_count = 0;
    writer->size = 0;
    return writer->sink(writer->user, writer->bytes, size);
}

/* One geometry always fits: it comes from a message of at most QUERY_BYTES_MAX whose header is no
 * shorter. */
bool definition_writer_add(struct definition_writer *writer, const struct handle *handle,
                           const struct geometry *geometry)
{
    struct definition *definition = &writer->definition;
    const size_t size = HANDLE_BYTES + geometry->size;
    if ((DEFINITION_BYTES + writer->size + size > QUERY_BYTES_MAX ||
         definition->body_count == QUERY_BODIES_MAX) &&
        !definition_writer_flush(writer))
        return false;
    writer->size += size;
    definition->body[definition->body_count++] = (struct query_body){*handle, *geometry};
    return true;
}
