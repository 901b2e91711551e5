/* The JSON objects of an input as texts, one after the other, while the input may still grow. */
#ifndef TEXT_H
#define TEXT_H

#include "scan.h"

/* Numbers of more characters are put shorter without changing the double that they mean: cJSON
 * cuts them in two. */
enum { TEXT_NUMBER_MAX = 63 };

enum { TEXT_ERROR_MAX = SCAN_ERROR_MAX + 64 };

enum text_outcome { TEXT_OBJECT, TEXT_END, TEXT_BAD, TEXT_FAILED };

/* Memory: the longest object, and one piece of the input. To be read by others: error. */
struct text {
    int fd;
    char *bytes; /* owned */
    size_t used, room;
    size_t begin;   /* of the object that is being read */
    size_t scanned; /* bytes before this one have been looked at */
    struct scan scan;
    char error[TEXT_ERROR_MAX]; /* after BAD: "line 3, column 14: expected ..."; after FAILED */
};

/* On input: an open file, read from where it stands; not owned. */
void text_open(int fd, struct text *out);
void text_close(struct text *text);

/* On output: OBJECT: *object has *length bytes, is well-formed JSON, and lives until the next
 * call; END: nothing but white space follows; BAD: what follows is no JSON object; FAILED: the
 * file cannot be read. */
enum text_outcome text_next(struct text *text, const char **object, size_t *length);

#endif
