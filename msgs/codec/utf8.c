#include "utf8.h"

#include <string.h>

static const uint32_t replacement = 0xfffd;

/* Returns the length of the UTF-8 sequence that begins with this byte; 0: no sequence does. */
static size_t sequence_length(unsigned char first)
{
    if (first < 0x80)
        return 1;
    if (first < 0xc0 || first >= 0xf8)
        return 0;
    return first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
}

size_t utf8_decode(const unsigned char *text, size_t size, uint32_t *code)
{
    static const uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000}; /* [length], else overlong */
    const size_t length = sequence_length(text[0]);
    *code = replacement;
    if (length == 0 || length > size)
        return 1;
    uint32_t value = length == 1 ? text[0] : text[0] & (0x7fu >> length);
    for (size_t i = 1; i < length; i++) {
        if ((text[i] & 0xc0) != 0x80)
            return 1;
        value = value << 6 | (text[i] & 0x3f);
    }
    const bool surrogate = value >= 0xd800 && value < 0xe000;
    if (value < least[length] || value > 0x10ffff || surrogate)
        return 1;
    *code = value;
    return length;
}

bool utf8_is_control(uint32_t code)
{
    return code < ' ' || (code >= 0x7f && code < 0xa0);
}

bool utf8_is_text(const char *text)
{
    const unsigned char *at = (const unsigned char *) text;
    size_t left = strlen(text), length;
    for (; left > 0; at += length, left -= length) {
        uint32_t code;
        length = utf8_decode(at, left, &code);
        if (utf8_is_control(code) || (code == replacement && length == 1))
            return false;
    }
    return true;
}
