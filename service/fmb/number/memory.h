/* Memory through the functions of GMP, which end the process if it is exhausted. */
#ifndef FMB_MEMORY_H
#define FMB_MEMORY_H

#include <gmp.h>
#include <stddef.h>

static inline void *memory_allocate(size_t bytes)
{
    void *(*allocate)(size_t);
    mp_get_memory_functions(&allocate, NULL, NULL);
    return allocate(bytes);
}

/* bytes: as allocated. */
static inline void memory_release(void *memory, size_t bytes)
{
    void (*release)(void *, size_t);
    mp_get_memory_functions(NULL, NULL, &release);
    release(memory, bytes);
}

#endif
