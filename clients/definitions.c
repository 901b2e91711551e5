#include "definitions.h"

#include "allocate.h"
#include "big_endian.h"
#include "keyed_hash.h"
#include "wire.h"

#include <stdlib.h>
#include <string.h>

#define uthash_malloc(size) allocate(1, size)
#include <uthash.h>

struct body {
    UT_hash_handle by_bytes, by_handle;
    struct body *next; /* whose handle is not computed yet */
    struct handle handle;
    struct geometry geometry;
    unsigned char bytes[];
};

/* What the two tables and the allocator take of a body, about. */
enum { TABLE_BYTES = 48 };

struct definitions {
    struct body *by_bytes, *by_handle; /* heads of the tables */
    struct body *unhashed;
    size_t bytes; /* of all bodies */
    struct keyed_hash hash;
    struct hasher *hasher;
    struct pair_query pair;
    struct scene_query scene;
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
    definitions->hash = keyed_hash_make();
    return definitions;
}

void definitions_close(struct definitions *definitions)
{
    if (!definitions)
        return;
    struct body *first = definitions->by_bytes;
    HASH_CLEAR(by_handle, definitions->by_handle);
    HASH_CLEAR(by_bytes, definitions->by_bytes);
    while (first) {
        struct body *next = first->by_bytes.next;
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
    const unsigned value = keyed_hash_of(&definitions->hash, geometry->bytes, geometry->size);
    struct body *body;
    if (!has_frames(geometry))
        return false;
    HASH_FIND_BYHASHVALUE(by_bytes, definitions->by_bytes, geometry->bytes, geometry->size, value,
                          body);
    if (body)
        return false;
    body = allocate(1, sizeof *body + geometry->size);
    memcpy(body->bytes, geometry->bytes, geometry->size);
    body->geometry = (struct geometry){body->bytes, geometry->size};
    HASH_ADD_KEYPTR_BYHASHVALUE(by_bytes, definitions->by_bytes, body->bytes, body->geometry.size,
                                value, body);
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

static void add_placements(struct definitions *definitions, const struct placement *placement,
                           int32_t count)
{
    for (int32_t i = 0; i < count; i++)
        definitions_add_placement(definitions, &placement[i]);
}

const char *definitions_add_query(struct definitions *definitions, const void *bytes, uint32_t size)
{
    struct scene_query *scene = &definitions->scene;
    struct query_header header;
    if (size > QUERY_BYTES_MAX)
        return too_long;
    if (!wire_read_pair_header(bytes, size, &header)) {
        const char *error = wire_read_pair_query(bytes, size, &definitions->pair);
        if (!error)
            add_placements(definitions, definitions->pair.placement, 2);
        return error;
    }
    const char *error = wire_read_scene_query(bytes, size, scene);
    if (!error)
        add_placements(definitions, scene->placement,
                       scene->placement_count < QUERY_PLACEMENTS_MAX ? scene->placement_count
                                                                     : QUERY_PLACEMENTS_MAX);
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

static struct body *find(const struct definitions *definitions, const struct handle *handle)
{
    const unsigned value = keyed_hash_of(&definitions->hash, handle, sizeof *handle);
    struct body *body;
    HASH_FIND_BYHASHVALUE(by_handle, definitions->by_handle, handle, sizeof *handle, value, body);
    return body;
}

static void compute_handles(struct definitions *definitions)
{
    for (struct body *body; (body = definitions->unhashed) != NULL;) {
        definitions->unhashed = body->next;
        body->handle = hasher_handle(definitions->hasher, body->bytes, body->geometry.size);
        const unsigned value =
            keyed_hash_of(&definitions->hash, &body->handle, sizeof body->handle);
        HASH_ADD_BYHASHVALUE(by_handle, definitions->by_handle, handle, sizeof body->handle, value,
                             body);
    }
}

const struct geometry *definitions_find(struct definitions *definitions,
                                        const struct handle *handle)
{
    compute_handles(definitions);
    const struct body *body = find(definitions, handle);
    return body ? &body->geometry : NULL;
}

size_t definitions_count(const struct definitions *definitions)
{
    return HASH_CNT(by_bytes, definitions->by_bytes);
}

size_t definitions_bytes(const struct definitions *definitions)
{
    return definitions->bytes;
}
