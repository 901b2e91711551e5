/* Reads untrusted bytes in LCM's encoding: big-endian, no padding. Sizes have 64 bits, so that no
 * count overflows them. After the first error no bytes are left, and everything read is 0.
 *
 * Functions for numbers and lists of numbers are inline: a replay reads tens of millions of them a
 * second. No inline function stores the address of a cursor, so that compilers can keep a local
 * cursor in registers. No shared state. */
#ifndef CURSOR_H
#define CURSOR_H

#include "big_endian.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

struct cursor {
    const unsigned char *at, *end; /* the bytes left; none after an error */
    const char *error;             /* static text of the first error; NULL: none */
};

static inline uint64_t cursor_left(const struct cursor *cursor)
{
    return (uint64_t) (cursor->end - cursor->at);
}

/* Sets the error, unless there is one already. */
static inline void cursor_fail(struct cursor *cursor, const char *error)
{
    cursor->error = cursor->error ? cursor->error : error;
    cursor->end = cursor->at;
}

/* Takes the next size bytes and returns where they are. NULL, and an error: fewer are left. */
static inline const unsigned char *cursor_take(struct cursor *cursor, uint64_t size)
{
    const unsigned char *bytes = cursor->at;
    if (size > cursor_left(cursor)) {
        cursor_fail(cursor, "shorter than its fields");
        return NULL;
    }
    cursor->at += size;
    return bytes;
}

static inline int64_t cursor_int64(struct cursor *cursor)
{
    const unsigned char *bytes = cursor_take(cursor, 8);
    return bytes ? (int64_t) big_endian_64(bytes) : 0;
}

static inline int32_t cursor_int32(struct cursor *cursor)
{
    const unsigned char *bytes = cursor_take(cursor, 4);
    return bytes ? (int32_t) big_endian_32(bytes) : 0;
}

/* Decodes 8 bytes, which may have any alignment. */
static inline double cursor_double_at(const unsigned char *bytes)
{
    const uint64_t bits = big_endian_64(bytes);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline double cursor_double(struct cursor *cursor)
{
    const unsigned char *bytes = cursor_take(cursor, 8);
    return bytes ? cursor_double_at(bytes) : 0;
}

/* Begins to read a message, and checks the fingerprint of its type. On input: size bytes, which
 * must outlive the cursor; bytes may be NULL if size is 0. A size above INT32_MAX is an error. */
static inline struct cursor cursor_begin(const void *bytes, uint32_t size, int64_t fingerprint)
{
    struct cursor cursor = {.at = bytes ? bytes : (const void *) ""}; /* NULL + 0 is undefined */
    cursor.end = cursor.at + (size <= INT32_MAX ? size : 0);
    if (size > INT32_MAX)
        cursor_fail(&cursor, "size out of range");
    const int64_t found = cursor_int64(&cursor);
    if (!cursor.error && found != fingerprint)
        cursor_fail(&cursor, "another message type, or another version of it");
    return cursor;
}

/* Ends reading. Returns the first error, or NULL. Bytes that are left are an error. */
static inline const char *cursor_end(const struct cursor *cursor)
{
    return cursor_left(cursor) ? "longer than its fields" : cursor->error;
}

/* Reads a count of elements of at least size bytes each. Returns 0, and sets an error, if the count
 * is negative or the message has fewer bytes left. */
static inline int32_t cursor_count(struct cursor *cursor, uint64_t size)
{
    const int32_t count = cursor_int32(cursor);
    if (count >= 0 && (uint64_t) count * size <= cursor_left(cursor))
        return count;
    cursor_fail(cursor, count < 0 ? "negative count" : "shorter than its fields");
    return 0;
}

/* Reads a count, and takes that many elements of size bytes each. Returns the count; *bytes: the
 * elements. */
static inline int32_t cursor_list(struct cursor *cursor, uint64_t size, const unsigned char **bytes)
{
    const int32_t count = cursor_count(cursor, size);
    *bytes = cursor->at;
    cursor->at += (uint64_t) count * size;
    return count;
}

/* Reads a count, and that many numbers. The first max are stored. Returns the count of the message,
 * which may exceed max. */
static inline int32_t cursor_doubles(struct cursor *cursor, double *out, int max)
{
    const unsigned char *bytes;
    const int32_t count = cursor_list(cursor, 8, &bytes);
    for (int i = 0; i < count && i < max; i++)
        out[i] = cursor_double_at(bytes + 8 * i);
    return count;
}

/* The same for bytes. */
int32_t cursor_bytes(struct cursor *cursor, unsigned char *out, int max);

/* The same for 16-bit integers; a negative one becomes a number above 2^31. */
int32_t cursor_indices(struct cursor *cursor, unsigned *out, int max);

/* Takes a string. Returns where it is in the message; it ends with its only 0. A string without a
 * final 0, or with a 0 before it, is an error. After an error returns "". */
static inline const char *cursor_take_string(struct cursor *cursor)
{
    const unsigned char *bytes;
    const int32_t size = cursor_list(cursor, 1, &bytes);
    if (size > 0 && memchr(bytes, 0, (size_t) size) == bytes + size - 1)
        return (const char *) bytes;
    cursor_fail(cursor, "string without an end, or with two");
    return "";
}

/* Reads a string into out, truncated to size bytes (1 or more), final 0 included. Bytes that are
 * not printable become '?'. */
void cursor_string(struct cursor *cursor, char *out, size_t size);

/* Whether the byte is printable ASCII. Other bytes could control a terminal. */
bool cursor_is_printable(unsigned char byte);

#endif
