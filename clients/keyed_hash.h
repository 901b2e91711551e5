/* A keyed hash for tables (uthash) with keys from untrusted input: without the secret, no sender
 * can compute keys that collide. uthash's own functions have no secret. */
#ifndef KEYED_HASH_H
#define KEYED_HASH_H

#include <stddef.h>
#include <stdint.h>

struct keyed_hash {
    uint64_t secret[2];
};

/* Makes a hash with a new random secret. */
struct keyed_hash keyed_hash_make(void);

/* SipHash-1-3 of `size` bytes. The value depends on the machine's byte order. */
unsigned keyed_hash_of(const struct keyed_hash *hash, const void *key, size_t size);

#endif
