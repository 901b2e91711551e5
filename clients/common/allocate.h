/* Allocation that reports a failure on stderr and exits with status 1. */
#ifndef ALLOCATE_H
#define ALLOCATE_H

#include <stddef.h>

/* On output: count elements of size bytes, all 0; never NULL, even for a count of 0. The caller
 * frees it. */
void *allocate(size_t count, size_t size);

/* One of size bytes, from 1, not cleared. */
void *allocate_unset(size_t size);

/* On input: memory of allocate() or NULL. On output: the same contents with room for at least
 * `needed` elements; *room tells for how many, and grows at least twofold, so that a list that
 * is filled one by one is copied a few times only. */
void *allocate_room(void *memory, size_t *room, size_t needed, size_t size);

/* Where a library has found no memory. */
_Noreturn void allocate_failed(void);

#endif
