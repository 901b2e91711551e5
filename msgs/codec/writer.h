/* Writes LCM's encoding, which cursor.h reads. The caller ensures that the message fits; otherwise
 * the process is aborted. Functions are inline, as in cursor.h. No shared state. */
#ifndef WRITER_H
#define WRITER_H

#include "big_endian.h"

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

struct writer {
    unsigned char *at, *end; /* the free bytes */
};

/* Returns the next size bytes, which the caller fills. */
static inline unsigned char *writer_take(struct writer *writer, size_t size)
{
    unsigned char *at = writer->at;
    if (size > (size_t) (writer->end - at))
        abort();
    writer->at += size;
    return at;
}

static inline void writer_int64(struct writer *writer, int64_t value)
{
    big_endian_put_64(writer_take(writer, 8), (uint64_t) value);
}

static inline void writer_int32(struct writer *writer, int32_t value)
{
    big_endian_put_32(writer_take(writer, 4), (uint32_t) value);
}

static inline void writer_double(struct writer *writer, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    big_endian_put_64(writer_take(writer, 8), bits);
}

/* Begins a message with the fingerprint of its type. On input: out has capacity bytes. */
static inline struct writer writer_begin(unsigned char *out, size_t capacity, int64_t fingerprint)
{
    struct writer writer = {.at = out, .end = out + capacity};
    writer_int64(&writer, fingerprint);
    return writer;
}

/* Returns the size of the message in bytes. On input: the out of writer_begin(). */
static inline size_t writer_end(const struct writer *writer, const unsigned char *out)
{
    return (size_t) (writer->at - out);
}

/* Lists are written as the count, then the elements. */

static inline void writer_doubles(struct writer *writer, const double *number, int32_t count)
{
    writer_int32(writer, count);
    for (int32_t i = 0; i < count; i++)
        writer_double(writer, number[i]);
}

/* Writes the lower 16 bits of each index. */
static inline void writer_indices(struct writer *writer, const unsigned *index, int32_t count)
{
    writer_int32(writer, count);
    unsigned char *at = writer_take(writer, 2 * (size_t) count);
    for (int32_t i = 0; i < count; i++)
        big_endian_put_16(at + 2 * i, (uint16_t) index[i]);
}

static inline void writer_bytes(struct writer *writer, const unsigned char *byte, int32_t count)
{
    writer_int32(writer, count);
    memcpy(writer_take(writer, (size_t) count), byte, (size_t) count);
}

/* Strings are written as a count that includes the final 0, then the bytes. */
static inline void writer_string(struct writer *writer, const char *text)
{
    writer_bytes(writer, (const unsigned char *) text, (int32_t) strlen(text) + 1);
}

#endif
