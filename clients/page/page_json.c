#include "page_json.h"

#include "allocate.h"
#include "number.h"
#include "query.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void page_json_clear(struct page_json *json)
{
    free(json->bytes);
    memset(json, 0, sizeof *json);
}

static void add(struct page_json *json, const void *bytes, size_t count)
{
    json->bytes = allocate_room(json->bytes, &json->room, json->used + count, 1);
    memcpy(json->bytes + json->used, bytes, count);
    json->used += count;
}

void page_json_raw(struct page_json *json, const char *text)
{
    add(json, text, strlen(text));
}

void page_json_integer(struct page_json *json, int64_t value)
{
    bool exact = value >= -QUERY_ID_MAX && value <= QUERY_ID_MAX;
    char text[32];
    snprintf(text, sizeof text, exact ? "%" PRId64 : "\"%" PRId64 "\"", value);
    page_json_raw(json, text);
}

void page_json_number(struct page_json *json, double value)
{
    char text[NUMBER_TEXT_MAX];
    page_json_raw(json, number_exact(value, text));
}

/* ---- Strings --------------------------------------------------------------------------------- */

/* How many bytes the character at the beginning of text has in UTF-8; 0: there is none. No byte
 * behind the final 0 is read, since none that continues a character is 0.
 *
 *     first byte   second byte
 *     c2 .. df     80 .. bf     two bytes in all
 *     e0           a0 .. bf     three; less would have fit into two
 *     e1 .. ef     80 .. bf     three, but after ed no more than 9f: surrogates
 *     f0           90 .. bf     four
 *     f1 .. f3     80 .. bf     four
 *     f4           80 .. 8f     four; more would be beyond U+10FFFF */
static size_t character_bytes(const unsigned char *text)
{
    const unsigned char first = text[0];
    if (first < 0x80)
        return 1;
    if (first < 0xc2 || first > 0xf4)
        return 0;
    const size_t count = first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
    const unsigned char low = first == 0xe0 ? 0xa0 : first == 0xf0 ? 0x90 : 0x80;
    const unsigned char high = first == 0xed ? 0x9f : first == 0xf4 ? 0x8f : 0xbf;
    if (text[1] < low || text[1] > high)
        return 0;
    for (size_t i = 2; i < count; i++)
        if (text[i] < 0x80 || text[i] > 0xbf)
            return 0;
    return count;
}

static void add_escaped(struct page_json *json, unsigned code)
{
    char text[16];
    snprintf(text, sizeof text, "\\u%04x", code);
    page_json_raw(json, text);
}

void page_json_string(struct page_json *json, const char *text)
{
    enum { DELETE = 0x7f, REPLACEMENT = 0xfffd };
    const unsigned char *at = (const unsigned char *) text;
    page_json_raw(json, "\"");
    while (*at) {
        const size_t count = character_bytes(at);
        if (count == 0)
            add_escaped(json, REPLACEMENT);
        else if (*at < ' ' || *at == DELETE || strchr("\"\\<>&", *at))
            add_escaped(json, *at);
        else
            add(json, at, count);
        at += count ? count : 1;
    }
    page_json_raw(json, "\"");
}
