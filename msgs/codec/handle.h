/* Handles: content addresses of bodies.
 *
 * A handle is the first 16 bytes of the SHA-256 (FIPS 180-4) of the geometry as encoded on the
 * wire. It is the same in every service and in every log. No two geometries with the same handle
 * are known; finding two takes some 2^64 hashes. */
#ifndef HANDLE_H
#define HANDLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

enum { HANDLE_BYTES = 16 };

struct handle {
    unsigned char bytes[HANDLE_BYTES];
};

/* Whether all bytes are 0, which stands for no handle. */
static inline bool handle_is_none(const struct handle *handle)
{
    static const struct handle none;
    return memcmp(handle, &none, sizeof none) == 0;
}

static inline bool handle_equal(const struct handle *a, const struct handle *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

/* Computes handles. One hasher may be used by one thread at a time; hashers share no state. */
struct hasher;

/* Returns NULL if out of memory (GLib may abort the process instead). hasher_destroy() accepts
 * NULL. */
struct hasher *hasher_create(void);
void hasher_destroy(struct hasher *hasher);

/* Returns the handle of an encoded geometry of size bytes. GLib allocates some 70 bytes in each
 * call, and frees them in the next one. */
struct handle hasher_handle(struct hasher *hasher, const unsigned char *bytes, size_t size);

#endif
