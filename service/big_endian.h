/* Numbers as LCM writes them, in messages and in logs: the highest byte first. Inline: they are
 * looked at by the million, and the shifts are one instruction to a compiler that sees them. */
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

#endif
