/* Allocation that reports a failure on stderr and exits with status 1. */
#ifndef ALLOCATE_H
#define ALLOCATE_H

#include <stddef.h>

/* Returns count elements of size bytes, all 0; not NULL even for a count of 0. The caller frees
 * them. */
void *allocate(size_t count, size_t size);

/* Returns size bytes, at least 1, not cleared. The caller frees them. */
void *allocate_unset(size_t size);

/* Returns the same contents with a capacity of at least `needed` elements of size bytes. On input:
 * memory of allocate() or NULL, and its capacity in *capacity. On output: the new capacity, at
 * least twice the old one if that was too small, so that a list that grows by one is copied rarely.
 */
void *allocate_grow(void *memory, size_t *capacity, size_t needed, size_t size);

/* Reports that a library is out of memory, and exits with status 1. */
_Noreturn void allocate_failed(void);

#endif
