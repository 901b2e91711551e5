/* Counts what GMP allocates: for tests of code that must not use it. */
#ifndef GMP_ALLOCATIONS_H
#define GMP_ALLOCATIONS_H

#include <gmp.h>
#include <stdlib.h>

/* Since the program began, with the functions below in place. */
static long gmp_allocations;

static inline void *gmp_count_allocate(size_t size)
{
    gmp_allocations++;
    return malloc(size);
}

static inline void *gmp_count_reallocate(void *memory, size_t old, size_t size)
{
    (void) old;
    gmp_allocations++;
    return realloc(memory, size);
}

static inline void gmp_release(void *memory, size_t size)
{
    (void) size;
    free(memory);
}

/* Puts them in place. */
static inline void gmp_count_allocations(void)
{
    mp_set_memory_functions(gmp_count_allocate, gmp_count_reallocate, gmp_release);
}

#endif
