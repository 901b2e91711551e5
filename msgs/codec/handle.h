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

/* Returns the handle of an encoded geometry of size bytes. The call allocates about 100 bytes
 * through GLib, which aborts the process if memory is exhausted. */
struct handle handle_of(const unsigned char *bytes, size_t size);

#endif
