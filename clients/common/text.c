#include "text.h"

#include "allocate.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { READ_BYTES = 1 << 16 };

void text_open(int fd, struct text *out)
{
    *out = (struct text){.fd = fd, .line = 1, .column = 1, .object_max = TEXT_OBJECT_MAX};
}

void text_close(struct text *text)
{
    free(text->bytes);
    memset(text, 0, sizeof *text);
}

/* ---- Positions and errors -------------------------------------------------------------------- */

/* Moves begin forward, and counts lines and columns. */
static void advance(struct text *text, size_t count)
{
    for (; count > 0; count--) {
        const unsigned char byte = (unsigned char) text->bytes[text->begin++];
        const bool continuation = (byte & 0xc0) == 0x80;
        if (byte == '\n') {
            text->line++;
            text->column = 1;
        } else if (!continuation) {
            text->column++;
        }
    }
}

enum text_outcome text_refuse(struct text *text, size_t offset, const char *format, ...)
{
    char what[TEXT_ERROR_MAX / 2];
    va_list list;
    va_start(list, format);
    vsnprintf(what, sizeof what, format, list);
    va_end(list);
    advance(text, offset);
    snprintf(text->error, sizeof text->error, "line %zu, column %zu: %s", text->line, text->column,
             what);
    return TEXT_BAD;
}

static enum text_outcome refuse_byte(struct text *text, unsigned char byte)
{
    if (byte > 0x20 && byte < 0x7f)
        return text_refuse(text, 0, "expected an object, '{', found '%c'", byte);
    return text_refuse(text, 0, "expected an object, '{', found byte 0x%02x", byte);
}

static enum text_outcome failed(struct text *text)
{
    snprintf(text->error, sizeof text->error, "%s", strerror(errno));
    return TEXT_FAILED;
}

/* ---- Reading --------------------------------------------------------------------------------- */

/* Drops the bytes before begin and appends a piece of the input. Returns how many bytes were read;
 * 0: the end; -1: errno. */
static ssize_t read_more(struct text *text)
{
    text->used -= text->begin;
    text->scanned -= text->begin;
    if (text->begin > 0)
        memmove(text->bytes, text->bytes + text->begin, text->used);
    text->begin = 0;
    text->bytes = allocate_grow(text->bytes, &text->capacity, text->used + READ_BYTES, 1);
    ssize_t count;
    do
        count = read(text->fd, text->bytes + text->used, READ_BYTES);
    while (count < 0 && errno == EINTR);
    if (count > 0)
        text->used += (size_t) count;
    return count;
}

/* ---- The end of an object -------------------------------------------------------------------- */

enum scan { SCAN_MORE, SCAN_DONE, SCAN_DEEP };

/* A bracket that does not match ends the object too: cJSON reports its place. */
static enum scan scan_byte(struct text *text, char byte)
{
    const bool brace = byte == '{' || byte == '}';
    if (text->in_string) {
        text->in_string = byte != '"' || text->escaped;
        text->escaped = byte == '\\' && !text->escaped;
    } else if (byte == '"') {
        text->in_string = true;
    } else if (byte == '{' || byte == '[') {
        if (text->depth == TEXT_DEPTH_MAX)
            return SCAN_DEEP;
        text->depth++;
        text->braces = text->braces << 1 | brace;
    } else if (byte == '}' || byte == ']') {
        text->depth = (text->braces & 1) == brace ? text->depth - 1 : 0;
        text->braces >>= 1;
        return text->depth > 0 ? SCAN_MORE : SCAN_DONE;
    }
    return SCAN_MORE;
}

/* ---- Objects --------------------------------------------------------------------------------- */

static bool is_space(char byte)
{
    return byte == ' ' || byte == '\t' || byte == '\r' || byte == '\n';
}

static enum scan scan_object(struct text *text)
{
    enum scan result = SCAN_MORE;
    while (result == SCAN_MORE && text->scanned < text->used)
        result = scan_byte(text, text->bytes[text->scanned++]);
    return result;
}

/* Skips a byte order mark at the start of the input. A read that fails is repeated by
 * find_object(). */
static void skip_mark(struct text *text)
{
    static const char mark[] = {'\xef', '\xbb', '\xbf'};
    text->started = true;
    while (text->used < sizeof mark &&
           (text->used == 0 || memcmp(text->bytes, mark, text->used) == 0))
        if (read_more(text) <= 0)
            return;
    if (text->used >= sizeof mark && memcmp(text->bytes, mark, sizeof mark) == 0)
        text->begin = text->scanned = sizeof mark;
}

/* Skips white space. Returns 1 if another byte follows, 0 at the end, -1: errno. */
static ssize_t find_object(struct text *text)
{
    ssize_t count = 1;
    while (count > 0) {
        while (text->begin < text->used && is_space(text->bytes[text->begin]))
            advance(text, 1);
        text->scanned = text->begin;
        if (text->begin < text->used)
            return 1;
        count = read_more(text);
    }
    return count;
}

enum text_outcome text_next(struct text *text, const char **object, size_t *length)
{
    if (!text->started)
        skip_mark(text);
    advance(text, text->scanned - text->begin);
    ssize_t count = find_object(text);
    if (count <= 0)
        return count < 0 ? failed(text) : TEXT_END;
    if (text->bytes[text->begin] != '{')
        return refuse_byte(text, (unsigned char) text->bytes[text->begin]);
    while (count > 0) {
        const enum scan result = scan_object(text);
        *object = text->bytes + text->begin;
        *length = text->scanned - text->begin;
        if (result == SCAN_DONE)
            return TEXT_OBJECT;
        if (result == SCAN_DEEP)
            return text_refuse(text, *length - 1, "nested more than %d deep", TEXT_DEPTH_MAX);
        if (*length > text->object_max)
            return text_refuse(text, 0, "an object of more than %zu bytes", text->object_max);
        count = read_more(text);
    }
    return count < 0 ? failed(text) : text_refuse(text, *length, "the input ends within an object");
}
