/* Big-endian integers, as LCM encodes them in messages and logs. Inline, so that compilers turn the
 * shifts into one instruction: a replay reads millions of numbers a second. */
#ifndef BIG_ENDIAN_H
#define BIG_ENDIAN_H

#include <stdint.h>

static inline uint16_t big_endian_16(const unsigned char *b)
{
    return (uint16_t) (b[0] << 8 | b[1]);
}

static inline uint32_t big_endian_32(const unsigned char *b)
{
    return (uint32_t) b[0] << 24 | (uint32_t) b[1] << 16 | (uint32_t) b[2] << 8 | b[3];
}

static inline uint64_t big_endian_64(const unsigned char *b)
{
    return (uint64_t) big_endian_32(b) << 32 | big_endian_32(b + 4);
}

static inline void big_endian_put_16(unsigned char *b, uint16_t value)
{
    b[0] = (unsigned char) (value >> 8);
    b[1] = (unsigned char) value;
}

static inline void big_endian_put_32(unsigned char *b, uint32_t value)
{
    b[0] = (unsigned char) (value >> 24);
    b[1] = (unsigned char) (value >> 16);
    b[2] = (unsigned char) (value >> 8);
    b[3] = (unsigned char) value;
}

static inline void big_endian_put_64(unsigned char *b, uint64_t value)
{
    for (int i = 0; i < 8; i++)
        b[i] = (unsigned char) (value >> (56 - 8 * i));
}

#endif
