#include "text.h"

#include "allocate.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { READ_BYTES = 1 << 16 };

void text_open(int fd, struct text *out)
{
    memset(out, 0, sizeof *out);
    out->fd = fd;
    scan_begin(&out->scan);
}

void text_close(struct text *text)
{
    free(text->bytes);
    memset(text, 0, sizeof *text);
}

/* Forgets the bytes before the object that is being read. */
static void drop_old(struct text *text)
{
    if (text->begin == 0)
        return;
    text->used -= text->begin;
    text->scanned -= text->begin;
    memmove(text->bytes, text->bytes + text->begin, text->used);
    text->begin = 0;
}

/* On output: how many bytes more; 0: the end; -1: errno. */
static ssize_t read_more(struct text *text)
{
    drop_old(text);
    text->bytes = allocate_room(text->bytes, &text->room, text->used + READ_BYTES, 1);
    ssize_t count;
    do
        count = read(text->fd, text->bytes + text->used, READ_BYTES);
    while (count < 0 && errno == EINTR);
    if (count > 0)
        text->used += (size_t) count;
    return count;
}

/* The number before end becomes 17 digits, which read back as the same double, and spaces. */
static void shorten_number(char *end, size_t length)
{
    char digits[TEXT_NUMBER_MAX + 1];
    char *number = end - length, after = *end;
    *end = '\0';
    double value = strtod(number, NULL);
    *end = after;
    int count = isfinite(value) ? snprintf(digits, sizeof digits, "%.17g", value)
                                : snprintf(digits, sizeof digits, "1e999");
    memset(number, ' ', length);
    memcpy(number, digits, (size_t) count);
}

/* Looks at the bytes there are, to the end of the object if it is among them. */
static enum scan_result scan_on(struct text *text)
{
    enum scan_result result = SCAN_MORE;
    while (result == SCAN_MORE && text->scanned < text->used) {
        size_t number = text->scan.number_bytes;
        char *byte = text->bytes + text->scanned++;
        result = scan_byte(&text->scan, (unsigned char) *byte);
        if (number > TEXT_NUMBER_MAX && text->scan.number_bytes == 0)
            shorten_number(byte, number);
    }
    if (scan_is_between(&text->scan))
        text->begin = text->scanned;
    return result;
}

/* Editors put one at the beginning of a file; JSON has none. The byte that was refused is the first
 * of three; the others may be still to come, and are waited for while it looks like one. */
static bool is_byte_order_mark(struct text *text)
{
    static const char mark[] = "\xef\xbb\xbf";
    text->begin = text->scanned - 1;
    for (size_t i = 0; i < 3; i++) {
        if (text->begin + i == text->used && read_more(text) <= 0)
            return false;
        if (text->bytes[text->begin + i] != mark[i])
            return false;
    }
    return true;
}

static enum text_outcome bad(struct text *text)
{
    if (scan_is_between(&text->scan) && is_byte_order_mark(text))
        scan_refuse(&text->scan, "a UTF-8 byte order mark");
    snprintf(text->error, sizeof text->error, "line %zu, column %zu: %s", text->scan.line,
             text->scan.column, text->scan.error);
    return TEXT_BAD;
}

static enum text_outcome end(struct text *text)
{
    if (scan_is_between(&text->scan))
        return TEXT_END;
    scan_end(&text->scan);
    return bad(text);
}

static enum text_outcome failed(struct text *text)
{
    snprintf(text->error, sizeof text->error, "%s", strerror(errno));
    return TEXT_FAILED;
}

static enum text_outcome done(struct text *text, const char **object, size_t *length)
{
    *object = text->bytes + text->begin;
    *length = text->scanned - text->begin;
    text->begin = text->scanned;
    scan_next(&text->scan);
    return TEXT_OBJECT;
}

enum text_outcome text_next(struct text *text, const char **object, size_t *length)
{
    for (;;) {
        switch (scan_on(text)) {
        case SCAN_DONE: return done(text, object, length);
        case SCAN_BAD: return bad(text);
        case SCAN_MORE: break;
        }
        ssize_t count = read_more(text);
        if (count < 0)
            return failed(text);
        if (count == 0)
            return end(text);
    }
}
