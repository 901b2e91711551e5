/* A 64-bit digest of bytes. Not collision-resistant. */
#ifndef DIGEST_H
#define DIGEST_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

static inline uint64_t digest_word(uint64_t state, uint64_t word)
{
    state = (state ^ word) * UINT64_C(0x9e3779b97f4a7c15); /* odd: 2^64 over the golden ratio */
    return state ^ state >> 29;
}

/* Returns the digest of `size` more bytes. state: the digest of the bytes before them; 0: there are
 * none. Takes four words at a time, so that their multiplications overlap: the frames of a robot
 * have tens of kilobytes. */
static inline uint64_t digest(uint64_t state, const unsigned char *bytes, size_t size)
{
    uint64_t word[4], lane[4] = {state ^ size, 1, 2, 3};
    for (; size >= sizeof word; bytes += sizeof word, size -= sizeof word) {
        memcpy(word, bytes, sizeof word);
        for (int i = 0; i < 4; i++)
            lane[i] = digest_word(lane[i], word[i]);
    }
    memset(word, 0, sizeof word);
    memcpy(word, bytes, size);
    for (int i = 0; i < 4; i++)
        state = digest_word(digest_word(state, lane[i]), word[i]);
    return state;
}

#endif
