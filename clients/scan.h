/* Where a JSON object ends, one byte at a time, and whether it is one: RFC 8259's grammar and
 * nothing beside it.
 *
 * The tree is built by cJSON (json.c), which takes a whole text and lets much pass that is no
 * JSON: numbers like 01 and 1., control characters, \u0000. What has passed here, cJSON reads as
 * it is meant. And since a byte is judged when it comes, an input that begins wrong is refused at
 * once however long it is, and objects can be answered one by one while more are on the way. */
#ifndef SCAN_H
#define SCAN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Scenes nest 5 deep; a limit keeps the reader's own recursion small. */
enum { SCAN_DEPTH_MAX = 32 };

enum { SCAN_ERROR_MAX = 96 };

enum scan_result { SCAN_MORE, SCAN_DONE, SCAN_BAD };

/* To be read by others: line, column, number_bytes, error. */
struct scan {
    int state;
    int depth;
    uint64_t objects;    /* bit d: level d is an object, not an array */
    const char *literal; /* what has still to come of true, false or null */
    int hex_digits;      /* still to come behind \u */
    unsigned hex;        /* their value so far */
    bool key;            /* the string is one */
    size_t number_bytes; /* of the number that is being read; else 0 */
    size_t line, column; /* of the next byte, from 1; columns are characters of UTF-8 */
    char error[SCAN_ERROR_MAX];
};

/* At the very beginning of an input: line 1, column 1. */
void scan_begin(struct scan *scan);

/* Before the next object of the same input: lines and columns go on. */
void scan_next(struct scan *scan);

/* Has nothing but white space come since scan_begin() or scan_next()? */
bool scan_is_between(const struct scan *scan);

/* On output: DONE with the brace that closes the object; MORE before it; BAD, error, and line
 * and column of the byte. After DONE only scan_next() may follow, after BAD nothing. */
enum scan_result scan_byte(struct scan *scan, unsigned char byte);

/* The input has ended within an object. On output: error. */
void scan_end(struct scan *scan);

#endif
