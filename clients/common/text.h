/* Splits an input, which may still grow, into the texts of its JSON objects.
 *
 * An object ends where its first brace closes: brackets outside of strings are counted, nothing
 * else matters. A UTF-8 byte order mark at the start is skipped. json.c decides whether the
 * text in between is JSON. */
#ifndef TEXT_H
#define TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

enum {
    TEXT_DEPTH_MAX = 32,       /* scenes nest 5 deep; cJSON recurses once per level */
    TEXT_OBJECT_MAX = 1 << 30, /* bytes of one object, so that an endless one is refused */
    TEXT_ERROR_MAX = 160
};

enum text_outcome { TEXT_OBJECT, TEXT_END, TEXT_BAD, TEXT_FAILED };

/* Memory: the longest object. Callers read error; the rest is private. */
struct text {
    FILE *file;  /* owned; NULL: errno says why */
    char *bytes; /* owned; of the current object */
    size_t used, capacity;
    size_t line, column; /* of bytes[0], from 1; columns are characters of UTF-8 */
    size_t object_max;   /* TEXT_OBJECT_MAX */
    int depth;
    uint64_t braces; /* bit d: of the open brackets, the d-th from the innermost is a brace */
    bool started;    /* a byte order mark has been skipped, if there is one */
    bool in_string, escaped;
    char error[TEXT_ERROR_MAX];
};

/* In: an open file, read from its current position; not owned. */
void text_open(int fd, struct text *out);
void text_close(struct text *text);

/* Returns
 *   TEXT_OBJECT  *object has *length bytes, begins with '{' and ends with a bracket that closes
 *                the brace or does not match; valid until the next call
 *   TEXT_END     nothing but white space was left
 *   TEXT_BAD     what follows is no object; error is set
 *   TEXT_FAILED  the file cannot be read; error is set
 * After any but TEXT_OBJECT there is no next call. */
enum text_outcome text_next(struct text *text, const char **object, size_t *length);

/* Sets error to "line 3, column 14: " and the formatted text, for the byte at `offset` of the
 * current object. Returns TEXT_BAD. */
enum text_outcome text_refuse(struct text *text, size_t offset, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
