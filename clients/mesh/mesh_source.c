#include "mesh_source.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Counted only now: lines need not be counted while they are read. */
static uint64_t line_of(const struct mesh_source *source, const unsigned char *where)
{
    uint64_t line = 1;
    const unsigned char *at = source->begin;
    while ((at = memchr(at, '\n', (size_t) (where - at)))) {
        line++;
        at++;
    }
    return line;
}

bool mesh_refuse_line(struct mesh_source *source, const unsigned char *where, const char *format,
                      ...)
{
    va_list arguments;
    const int length =
        snprintf(source->error, MESH_ERROR_MAX, "line %" PRIu64 ": ", line_of(source, where));
    va_start(arguments, format);
    vsnprintf(source->error + length, (size_t) (MESH_ERROR_MAX - length), format, arguments);
    va_end(arguments);
    return false;
}

bool mesh_refuse_byte(struct mesh_source *source, const unsigned char *where, const char *within,
                      uint64_t index, const char *format, ...)
{
    va_list arguments;
    int length = snprintf(source->error, MESH_ERROR_MAX, "byte %td", where - source->begin);
    if (within)
        length += snprintf(source->error + length, (size_t) (MESH_ERROR_MAX - length),
                           " (%s %" PRIu64 ")", within, index);
    length += snprintf(source->error + length, (size_t) (MESH_ERROR_MAX - length), ": ");
    va_start(arguments, format);
    vsnprintf(source->error + length, (size_t) (MESH_ERROR_MAX - length), format, arguments);
    va_end(arguments);
    return false;
}

bool mesh_refuse_room(struct mesh_source *source, uint64_t count, const char *what)
{
    snprintf(source->error, MESH_ERROR_MAX, "there is no memory for %" PRIu64 " %s", count, what);
    return false;
}

const char *mesh_word(const struct mesh_source *source, const unsigned char *at,
                      char text[MESH_WORD_MAX])
{
    size_t length = 0;
    while (!mesh_ends_word(source, at) && length < MESH_WORD_MAX - 1) {
        text[length++] = *at > ' ' && *at < 0x7f ? (char) *at : '?';
        at++;
    }
    text[length] = '\0';
    if (!mesh_ends_word(source, at))
        memcpy(text + MESH_WORD_MAX - 4, "...", 4);
    return text;
}

void *mesh_room(size_t count, size_t size)
{
    return count > SIZE_MAX / size ? NULL : malloc(count * size);
}

void mesh_skip_line(struct mesh_source *source)
{
    const unsigned char *end = memchr(source->at, '\n', mesh_left(source));
    source->at = end ? end : source->end;
}

void mesh_tell_now(struct mesh_source *source)
{
    const struct mesh_watch *watch = source->watch;
    source->told = source->at;
    if (watch)
        watch->told(watch->context, (uint64_t) (source->at - source->begin),
                    (uint64_t) (source->end - source->begin));
}
