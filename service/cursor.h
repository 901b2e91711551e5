/* A walk over bytes that nobody vouches for, in LCM's encoding: big-endian, no padding. Sizes are
 * of 64 bits, so that no count can make them wrap. The first error ends the walk: there is nothing
 * left, and everything read after it is 0.
 *
 * Numbers and lists of them are inline: a replay reads tens of millions of them a second. Nothing
 * here gives the address of a cursor away, so that of one in a local variable a compiler makes
 * registers. */
#ifndef CURSOR_H
#define CURSOR_H

#include "big_endian.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

struct cursor {
    const unsigned char *at, *end; /* what is left; nothing after an error */
    const char *error;             /* static; NULL: none so far */
};

static inline uint64_t cursor_left(const struct cursor *cursor)
{
    return (uint64_t) (cursor->end - cursor->at);
}

/* An error; the first one stays. */
static inline void cursor_fail(struct cursor *cursor, const char *error)
{
    cursor->error = cursor->error ? cursor->error : error;
    cursor->end = cursor->at;
}

/* The next so many bytes, 1 or more; NULL where they are not there, which is an error. */
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

/* On input: size bytes as LCM gives them (it is unsigned there, and can be a negative number of
 * ints: that is an error); what type they should be of. */
static inline struct cursor cursor_begin(const void *bytes, uint32_t size, int64_t fingerprint)
{
    /* Of no bytes there may be no address, to which not even 0 can be added. */
    struct cursor cursor = {.at = bytes ? bytes : (const void *) ""};
    cursor.end = cursor.at + size;
    if (size > INT32_MAX)
        cursor_fail(&cursor, "size out of range");
    else if (cursor_int64(&cursor) != fingerprint)
        cursor_fail(&cursor, "another message type, or another version of it");
    return cursor;
}

/* The error, also that something is left over; or NULL. */
static inline const char *cursor_end(const struct cursor *cursor)
{
    return cursor_left(cursor) ? "longer than its fields" : cursor->error;
}

/* A count of things of at least size bytes each: they are there, or it is an error, and 0. */
static inline int32_t cursor_count(struct cursor *cursor, uint64_t size)
{
    const int32_t count = cursor_int32(cursor);
    if (count >= 0 && (uint64_t) count * size <= cursor_left(cursor))
        return count;
    cursor_fail(cursor, count < 0 ? "negative count" : "shorter than its fields");
    return 0;
}

/* A counted list of things of so many bytes: all of it is walked. Returns the count. */
static inline int32_t cursor_list(struct cursor *cursor, uint64_t size, const unsigned char **bytes)
{
    const int32_t count = cursor_count(cursor, size);
    *bytes = cursor->at;
    cursor->at += (uint64_t) count * size;
    return count;
}

/* Counted lists: all of it is walked, the first max of it put into out. Returns the count. */
static inline int32_t cursor_doubles(struct cursor *cursor, double *out, int max)
{
    const unsigned char *bytes;
    const int32_t count = cursor_list(cursor, 8, &bytes);
    for (int i = 0; i < count && i < max; i++)
        out[i] = cursor_double_at(bytes + 8 * i);
    return count;
}

int32_t cursor_int64s(struct cursor *cursor, int64_t *out, int max);
int32_t cursor_bytes(struct cursor *cursor, unsigned char *out, int max);

/* Of 16 bits each; a negative number becomes one above 2^31. */
int32_t cursor_indices(struct cursor *cursor, unsigned *out, int max);

/* A string, where it stands. Returns its length, without the final 0; after an error 0, and *bytes
 * is left alone. */
size_t cursor_take_string(struct cursor *cursor, const unsigned char **bytes);

/* A string; what does not fit into size bytes is cut, and what is not printable becomes '?'. */
void cursor_string(struct cursor *cursor, char *out, size_t size);

/* ASCII; other bytes could do things to a terminal. */
bool cursor_is_printable(unsigned char byte);

#endif
