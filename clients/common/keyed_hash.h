/* Hash tables: uthash with a keyed hash, and with allocation that exits with status 1 on failure.
 * Keys come from untrusted input: without the secret, no sender can compute keys that collide.
 * uthash's own functions have no secret. Include this in place of uthash.h.
 *
 * For one thread at a time. */
#ifndef KEYED_HASH_H
#define KEYED_HASH_H

#include "allocate.h"

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#define uthash_malloc(size) allocate(1, size)
#define HASH_FUNCTION(key, size, value) ((value) = keyed_hash_value(key, size))
#include <uthash.h>

/* Empties a table, whose elements are freed. */
#define HASH_FREE(table)                            \
    do {                                            \
        __typeof__(table) element = (table), after; \
        HASH_CLEAR(hh, table);                      \
        for (; element; element = after) {          \
            after = element->hh.next;               \
            free(element);                          \
        }                                           \
    } while (0)

/* SipHash-1-3 of `size` bytes. The value depends on the machine's byte order. */
unsigned keyed_hash_of(const uint64_t secret[2], const void *key, size_t size);

/* The same with one random secret for all tables, made when it is first used. */
unsigned keyed_hash_value(const void *key, size_t size);

#endif
