#include "text.h"

#include "allocate.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void text_open(int fd, struct text *out)
{
    const int own = dup(fd);
    *out = (struct text){.line = 1, .column = 1, .object_max = TEXT_OBJECT_MAX};
    out->file = own >= 0 ? fdopen(own, "r") : NULL;
}

void text_close(struct text *text)
{
    if (text->file)
        fclose(text->file);
    free(text->bytes);
    memset(text, 0, sizeof *text);
}

/* ---- Positions and errors -------------------------------------------------------------------- */

static void count_byte(struct text *text, int byte)
{
    const bool continuation = (byte & 0xc0) == 0x80;
    if (byte == '\n') {
        text->line++;
        text->column = 1;
    } else if (!continuation) {
        text->column++;
    }
}

/* Counts the first bytes of the object. */
static void count_bytes(struct text *text, size_t count)
{
    for (size_t i = 0; i < count; i++)
        count_byte(text, (unsigned char) text->bytes[i]);
}

enum text_outcome text_refuse(struct text *text, size_t offset, const char *format, ...)
{
    char what[TEXT_ERROR_MAX / 2];
    va_list list;
    va_start(list, format);
    vsnprintf(what, sizeof what, format, list);
    va_end(list);
    count_bytes(text, offset);
    snprintf(text->error, sizeof text->error, "line %zu, column %zu: %s", text->line, text->column,
             what);
    return TEXT_BAD;
}

static enum text_outcome refuse_byte(struct text *text, int byte)
{
    if (byte > 0x20 && byte < 0x7f)
        return text_refuse(text, 0, "expected an object, '{', found '%c'%s", byte,
                           byte == '<' ? " (is it a URDF? fmb scene reads it)" : "");
    return text_refuse(text, 0, "expected an object, '{', found byte 0x%02x", (unsigned) byte);
}

static enum text_outcome failed(struct text *text)
{
    snprintf(text->error, sizeof text->error, "%s", strerror(errno));
    return TEXT_FAILED;
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

/* Returns the first byte after white space, and after a byte order mark at the start of the input;
 * EOF: there is none. */
static int first_byte(struct text *text)
{
    int byte = getc_unlocked(text->file);
    if (!text->started && byte == 0xef) {
        if (getc_unlocked(text->file) != 0xbb || getc_unlocked(text->file) != 0xbf)
            return byte;
        byte = getc_unlocked(text->file);
    }
    text->started = true;
    for (; byte == ' ' || byte == '\t' || byte == '\r' || byte == '\n';
         byte = getc_unlocked(text->file))
        count_byte(text, byte);
    return byte;
}

/* In: the first byte of the object. */
static enum scan read_object(struct text *text, int byte)
{
    enum scan result = SCAN_MORE;
    for (; byte != EOF && text->used <= text->object_max; byte = getc_unlocked(text->file)) {
        text->bytes = allocate_grow(text->bytes, &text->capacity, text->used + 1, 1);
        text->bytes[text->used++] = (char) byte;
        result = scan_byte(text, (char) byte);
        if (result != SCAN_MORE)
            break;
    }
    return result;
}

enum text_outcome text_next(struct text *text, const char **object, size_t *length)
{
    if (!text->file)
        return failed(text);
    count_bytes(text, text->used);
    text->used = 0;
    const int first = first_byte(text);
    if (first == EOF)
        return ferror(text->file) ? failed(text) : TEXT_END;
    if (first != '{')
        return refuse_byte(text, first);
    const enum scan result = read_object(text, first);
    *object = text->bytes;
    *length = text->used;
    if (result == SCAN_DONE)
        return TEXT_OBJECT;
    if (result == SCAN_DEEP)
        return text_refuse(text, *length - 1, "nested more than %d deep", TEXT_DEPTH_MAX);
    if (text->used > text->object_max)
        return text_refuse(text, 0, "an object of more than %zu bytes", text->object_max);
    if (ferror(text->file))
        return failed(text);
    return text_refuse(text, *length, "the input ends within an object");
}
