#include "allocate.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

enum { CAPACITY_MIN = 16 };

_Noreturn void allocate_failed(void)
{
    fprintf(stderr, "fmb: out of memory\n");
    exit(1);
}

static void *or_exit(void *memory)
{
    if (!memory)
        allocate_failed();
    return memory;
}

void *allocate(size_t count, size_t size)
{
    return or_exit(calloc(count ? count : 1, size));
}

void *allocate_unset(size_t size)
{
    return or_exit(malloc(size));
}

void *allocate_grow(void *memory, size_t *capacity, size_t needed, size_t size)
{
    if (memory && needed <= *capacity)
        return memory;
    size_t wanted = *capacity > SIZE_MAX / 2 ? SIZE_MAX : 2 * *capacity;
    if (wanted < needed)
        wanted = needed;
    if (wanted < CAPACITY_MIN)
        wanted = CAPACITY_MIN;
    if (wanted > SIZE_MAX / size)
        allocate_failed();
    *capacity = wanted;
    return or_exit(realloc(memory, wanted * size));
}
