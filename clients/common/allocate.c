#include "allocate.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

enum { ROOM_MIN = 16 };

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

void *allocate_room(void *memory, size_t *room, size_t needed, size_t size)
{
    if (memory && needed <= *room)
        return memory;
    size_t wanted = *room > SIZE_MAX / 2 ? SIZE_MAX : 2 * *room;
    if (wanted < needed)
        wanted = needed;
    if (wanted < ROOM_MIN)
        wanted = ROOM_MIN;
    if (wanted > SIZE_MAX / size)
        allocate_failed();
    *room = wanted;
    return or_exit(realloc(memory, wanted * size));
}
