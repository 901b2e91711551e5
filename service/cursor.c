#include "cursor.h"

static const char too_short[] = "shorter than its fields";

struct cursor cursor_begin(const void *bytes, uint32_t size, int64_t fingerprint)
{
    struct cursor cursor = {.at = bytes, .left = size};
    if (size > INT32_MAX)
        cursor.error = "size out of range";
    else if (cursor_int64(&cursor) != fingerprint)
        cursor_fail(&cursor, "another message type, or another version of it");
    return cursor;
}

const char *cursor_end(const struct cursor *cursor)
{
    if (cursor->error)
        return cursor->error;
    return cursor->left ? "longer than its fields" : NULL;
}

void cursor_fail(struct cursor *cursor, const char *error)
{
    if (!cursor->error)
        cursor->error = error;
}

const unsigned char *cursor_too_short(struct cursor *cursor)
{
    cursor_fail(cursor, too_short);
    return NULL;
}

int32_t cursor_wrong_count(struct cursor *cursor, int32_t count)
{
    cursor_fail(cursor, count < 0 ? "negative count" : too_short);
    return 0;
}

/* A counted list of things of so many bytes. Returns the count; *kept: how many the caller wants.
 */
static int32_t take_list(struct cursor *cursor, uint64_t size, int max, const unsigned char **bytes,
                         int *kept)
{
    int32_t count = cursor_count(cursor, size);
    *bytes = cursor_take(cursor, (uint64_t) count * size);
    *kept = !*bytes ? 0 : count < max ? count : max;
    return count;
}

int32_t cursor_doubles(struct cursor *cursor, double *out, int max)
{
    const unsigned char *bytes;
    int kept;
    const int32_t count = take_list(cursor, 8, max, &bytes, &kept);
    for (int i = 0; i < kept; i++)
        out[i] = cursor_double_at(bytes + 8 * i);
    return count;
}

int32_t cursor_int64s(struct cursor *cursor, int64_t *out, int max)
{
    const unsigned char *bytes;
    int kept;
    const int32_t count = take_list(cursor, 8, max, &bytes, &kept);
    for (int i = 0; i < kept; i++)
        out[i] = (int64_t) big_endian_64(bytes + 8 * i);
    return count;
}

/* So many at a time, which a compiler makes vectors of: scenes have tens of thousands. */
enum { INDICES = 16 };

static void read_indices(const unsigned char *restrict bytes, unsigned *restrict out)
{
    for (int i = 0; i < INDICES; i++)
        out[i] = (unsigned) (int16_t) (uint16_t) (bytes[2 * i] << 8 | bytes[2 * i + 1]);
}

int32_t cursor_indices(struct cursor *cursor, unsigned *out, int max)
{
    const unsigned char *bytes;
    int kept;
    const int32_t count = take_list(cursor, 2, max, &bytes, &kept);
    int i = 0;
    for (; i + INDICES <= kept; i += INDICES)
        read_indices(bytes + 2 * i, out + i);
    for (; i < kept; i++)
        out[i] = (unsigned) (int16_t) big_endian_16(bytes + 2 * i);
    return count;
}

int32_t cursor_bytes(struct cursor *cursor, unsigned char *out, int max)
{
    const unsigned char *bytes;
    int kept;
    const int32_t count = take_list(cursor, 1, max, &bytes, &kept);
    if (kept > 0)
        memcpy(out, bytes, (size_t) kept);
    return count;
}

size_t cursor_take_string(struct cursor *cursor, const unsigned char **bytes)
{
    int32_t size = cursor_count(cursor, 1);
    const unsigned char *at = cursor_take(cursor, (uint64_t) size);
    if (!at)
        return 0;
    if (size == 0 || memchr(at, 0, (size_t) size) != at + size - 1) {
        cursor->error = "string without an end, or with two";
        return 0;
    }
    *bytes = at;
    return (size_t) size - 1;
}

bool cursor_is_printable(unsigned char byte)
{
    return byte >= ' ' && byte < 0x7f;
}

void cursor_string(struct cursor *cursor, char *out, size_t size)
{
    const unsigned char *bytes = NULL;
    size_t length = cursor_take_string(cursor, &bytes);
    size_t kept = length < size ? length : size - 1;
    for (size_t i = 0; i < kept; i++)
        out[i] = cursor_is_printable(bytes[i]) ? (char) bytes[i] : '?';
    out[kept] = '\0';
}
