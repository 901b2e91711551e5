/* text.c with no more memory than an object has bytes, so that a sanitizer sees what is read beyond
 * it: this file's object takes the place of text.o. */
#include "allocate.h"

#include <stdlib.h>

static void *grow(void *memory, size_t *capacity, size_t needed, size_t size)
{
    *capacity = needed;
    memory = realloc(memory, needed * size);
    if (!memory)
        allocate_failed();
    return memory;
}

#define allocate_grow grow
#include "text.c"
