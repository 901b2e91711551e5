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

/* What the next byte is expected to be, or what it stands in. */
enum scan_state {
    /* Between tokens. */
    AT_OBJECT, /* white space before the object */
    AT_VALUE,
    AT_VALUE_OR_CLOSE, /* behind [ */
    AT_KEY,            /* behind , in an object */
    AT_KEY_OR_CLOSE,   /* behind { */
    AT_COLON,
    AT_COMMA_OR_CLOSE, /* behind a value */
    /* In a string. */
    AT_CHARACTER,
    AT_ESCAPE,       /* behind \ */
    AT_HEX,          /* behind \u */
    AT_OTHER_HALF,   /* behind \ud800 */
    AT_OTHER_HALF_U, /* behind \ud800\ */
    /* In a number. */
    AT_MINUS,    /* behind - */
    AT_ZERO,     /* behind 0 */
    AT_INTEGER,  /* behind 12 */
    AT_POINT,    /* behind 12. */
    AT_FRACTION, /* behind 12.3 */
    AT_EXPONENT, /* behind 12e */
    AT_SIGN,     /* behind 12e- */
    AT_POWER,    /* behind 12e-3 */
    /* In true, false or null. */
    AT_LITERAL
};

/* To be read by others: line, column, number_bytes, error. */
struct scan {
    enum scan_state state;
    int depth;
    uint64_t objects;    /* bit d: level d is an object, not an array */
    const char *literal; /* what has still to come of true, false or null */
    int hex_digits;      /* still to come behind \u */
    unsigned hex;        /* their value so far */
    bool other_half;     /* they are to be the second half of a character */
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

/* The input has ended within an object, or goes on with what is found. On output: error. */
void scan_end(struct scan *scan);
void scan_refuse(struct scan *scan, const char *found);

#endif
