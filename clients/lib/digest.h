/* A 64-bit digest of bytes. Not collision-resistant. */
#ifndef DIGEST_H
#define DIGEST_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* On input: state: the digest of the bytes before these, 0 at first. */
static inline uint64_t digest(uint64_t state, const unsigned char *bytes, size_t size)
{
    const uint64_t factor = UINT64_C(0x9e3779b97f4a7c15); /* odd: 2^64 over the golden ratio */
    uint64_t word;
    for (; size > 0; bytes += 8) {
        const size_t count = size < 8 ? size : 8;
        word = 0;
        memcpy(&word, bytes, count);
        state = (state ^ word ^ (uint64_t) size << 48) * factor;
        state ^= state >> 29;
        size -= count;
    }
    return state;
}

#endif
