#include "fuzz.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

_Noreturn void fuzz_failed(const char *file, int line, const char *what)
{
    dprintf(STDERR_FILENO, "%s:%d: this does not hold: %s\n", file, line, what);
    abort();
}

void *fuzz_room(size_t size)
{
    void *memory = malloc(size);
    if (!memory && size > 0)
        fuzz_failed(__FILE__, __LINE__, "memory");
    return memory;
}

uint8_t *fuzz_copy(const uint8_t *data, size_t size)
{
    uint8_t *copy = fuzz_room(size);
    if (size > 0)
        memcpy(copy, data, size);
    return copy;
}
