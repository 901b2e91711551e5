/* Numbers as LCM writes them. Inline: each of them is a load or a store. */
#ifndef BYTES_H
#define BYTES_H

#include <stdint.h>

static inline void bytes_put(unsigned char *at, uint64_t number, int size)
{
    for (int i = size; i-- > 0; number >>= 8)
        at[i] = (unsigned char) number;
}

static inline uint64_t bytes_get(const unsigned char *at, int size)
{
    uint64_t number = 0;
    for (int i = 0; i < size; i++)
        number = number << 8 | at[i];
    return number;
}

#endif
