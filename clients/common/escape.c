#include "escape.h"

#include "utf8.h"

#include <stdint.h>
#include <string.h>

static const uint32_t replacement = 0xfffd;

/* Whether a character would move the cursor, end the line or reorder the text around it: control
 * characters, line separators, and the marks of bidirectional text. */
static bool is_unsafe(uint32_t code)
{
    return utf8_is_control(code) || code == 0x61c || code == 0x200e || code == 0x200f ||
           (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
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

static const char *xml_of(uint32_t code)
{
    switch (code) {
    case '&': return "&amp;";
    case '<': return "&lt;";
    case '>': return "&gt;";
    case '"': return "&quot;";
    }
    return is_unsafe(code) || (code >= replacement && code <= 0xffff) ? "\xef\xbf\xbd" : NULL;
}

static const char *terminal_of(uint32_t code, char text[16])
{
    if (code == replacement)
        return "\xef\xbf\xbd";
    if (!is_unsafe(code))
        return NULL;
    snprintf(text, 16, code < 0x100 ? "\\x%02x" : "\\u%04x", (unsigned) code);
    return text;
}

void escape(FILE *out, enum escape form, const char *text, size_t size)
{
    const unsigned char *at = (const unsigned char *) text, *end = at + size, *kept = at;
    while (at < end) {
        char buffer[16];
        uint32_t code;
        const size_t length = utf8_decode(at, (size_t) (end - at), &code);
        const char *escaped = form == ESCAPE_JSON                 ? json_of(code, buffer)
                              : form == ESCAPE_XML                ? xml_of(code)
                              : form == ESCAPE_CSV && code == '"' ? "\"\""
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

void escape_text(FILE *out, const char *text)
{
    escape(out, ESCAPE_TERMINAL, text, strlen(text));
}

size_t escape_characters(const char *text)
{
    const unsigned char *at = (const unsigned char *) text, *end = at + strlen(text);
    size_t count = 0;
    while (at < end) {
        char buffer[16];
        uint32_t code;
        at += utf8_decode(at, (size_t) (end - at), &code);
        count += is_unsafe(code) ? strlen(terminal_of(code, buffer)) : 1;
    }
    return count;
}
