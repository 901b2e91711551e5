#include "cursor.h"

int32_t cursor_int64s(struct cursor *cursor, int64_t *out, int max)
{
    const unsigned char *bytes;
    const int32_t count = cursor_list(cursor, 8, &bytes);
    for (int i = 0; i < count && i < max; i++)
        out[i] = (int64_t) big_endian_64(bytes + 8 * i);
    return count;
}

/* Indices read at a time, so that compilers vectorize: a scene can have tens of thousands. */
enum { INDICES = 16 };

static void read_indices(const unsigned char *restrict bytes, unsigned *restrict out)
{
    for (int i = 0; i < INDICES; i++)
        out[i] = (unsigned) (int16_t) (uint16_t) (bytes[2 * i] << 8 | bytes[2 * i + 1]);
}

int32_t cursor_indices(struct cursor *cursor, unsigned *out, int max)
{
    const unsigned char *bytes;
    const int32_t count = cursor_list(cursor, 2, &bytes);
    const int kept = count < max ? count : max;
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
    const int32_t count = cursor_list(cursor, 1, &bytes);
    if (count > 0)
        memcpy(out, bytes, (size_t) (count < max ? count : max));
    return count;
}

size_t cursor_take_string(struct cursor *cursor, const unsigned char **bytes)
{
    const unsigned char *at;
    const int32_t size = cursor_list(cursor, 1, &at);
    if (size == 0 || memchr(at, 0, (size_t) size) != at + size - 1) {
        cursor_fail(cursor, "string without an end, or with two");
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
