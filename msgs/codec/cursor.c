#include "cursor.h"

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

bool cursor_is_printable(unsigned char byte)
{
    return byte >= ' ' && byte < 0x7f;
}

void cursor_string(struct cursor *cursor, char *out, size_t size)
{
    const char *text = cursor_take_string(cursor);
    size_t i = 0;
    for (; text[i] && i < size - 1; i++)
        out[i] = cursor_is_printable((unsigned char) text[i]) ? text[i] : '?';
    out[i] = '\0';
}
