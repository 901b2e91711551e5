/* Decodes the numbers of binary files, in either byte order. Inline: meshes have millions of them.
 */
#ifndef MESH_BITS_H
#define MESH_BITS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* An unsigned integer of size bytes, 1 to 8. */
static inline uint64_t mesh_bits(const unsigned char *bytes, size_t size, bool big_endian)
{
    uint64_t bits = 0;
    for (size_t i = 0; i < size; i++)
        bits = bits << 8 | bytes[big_endian ? i : size - 1 - i];
    return bits;
}

/* The IEEE 754 number with these bits. */
static inline float mesh_float(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline double mesh_double(uint64_t bits)
{
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

#endif
