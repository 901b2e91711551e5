#include "escape.h"

#include <stdint.h>
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

/* Decodes the character at the start of a text. Returns its bytes and *code; or 1 and U+FFFD if the
 * text does not begin with valid UTF-8. */
static size_t decode(const unsigned char *text, size_t size, uint32_t *code)
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

/* These functions return the replacement of a character; NULL: it is written as it is. In JSON it
 * is one or two units of UTF-16, unless it is printable ASCII. */
static const char *json_of(uint32_t code, char text[16])
{
    if (code == '"' || code == '\\')
        snprintf(text, 16, "\\%c", (char) code);
    else if (code > 0xffff)
        snprintf(text, 16, "\\u%04x\\u%04x", (unsigned) (0xd800 + ((code - 0x10000) >> 10)),
                 (unsigned) (0xdc00 + (code & 0x3ff)));
    else if (code < ' ' || code > '~' || code == '<' || code == '>' || code == '&')
        snprintf(text, 16, "\\u%04x", (unsigned) code);
    else
        return NULL;
    return text;
}

static bool is_control(uint32_t code)
{
    return code < ' ' || (code >= 0x7f && code < 0xa0);
}

static const char *xml_of(uint32_t code)
{
    switch (code) {
    case '&': return "&amp;";
    case '<': return "&lt;";
    case '>': return "&gt;";
    case '"': return "&quot;";
    case '\n': return NULL;
    }
    return is_control(code) || (code >= replacement && code <= 0xffff) ? "\xef\xbf\xbd" : NULL;
}

static const char *terminal_of(uint32_t code, char text[16])
{
    if (code == replacement)
        return "\xef\xbf\xbd";
    if (!is_control(code))
        return NULL;
    snprintf(text, 16, "\\x%02x", (unsigned) code);
    return text;
}

void escape(FILE *out, enum escape form, const char *text, size_t size)
{
    const unsigned char *at = (const unsigned char *) text, *end = at + size, *kept = at;
    while (at < end) {
        char buffer[16];
        uint32_t code;
        const size_t length = decode(at, (size_t) (end - at), &code);
        const char *escaped = form == ESCAPE_JSON  ? json_of(code, buffer)
                              : form == ESCAPE_XML ? xml_of(code)
                                                   : terminal_of(code, buffer);
        if (escaped) {
            fwrite(kept, 1, (size_t) (at - kept), out);
            fputs(escaped, out);
            kept = at + length;
        }
        at += length;
    }
    fwrite(kept, 1, (size_t) (at - kept), out);
}

bool escape_is_text(const char *text)
{
    const unsigned char *at = (const unsigned char *) text;
    size_t left = strlen(text), length;
    for (; left > 0; at += length, left -= length) {
        uint32_t code;
        length = decode(at, left, &code);
        if (is_control(code) || (code == replacement && length == 1))
            return false;
    }
    return true;
}

size_t escape_characters(const char *text)
{
    size_t count = 0;
    for (; *text; text++)
        count += ((unsigned char) *text & 0xc0) != 0x80;
    return count;
}
