/* Allocation for tests: ends the program on failure. */
#ifndef MEMORY_H
#define MEMORY_H

#include <stdio.h>
#include <stdlib.h>

/* Returns zeros. Inline, as this is all that there is. */
static inline void *memory_get(size_t size)
{
    void *memory = calloc(1, size);
    if (!memory) {
        fprintf(stderr, "out of memory\n");
        exit(EXIT_FAILURE);
    }
    return memory;
}

#endif
