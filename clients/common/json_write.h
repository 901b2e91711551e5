/* Writes JSON to a stream.
 *
 *     struct json_writer json = json_object(stdout);
 *     json_integer(&json, "count", 2);              {"count": 2, "box": [0,0.5,1]}
 *     json_numbers(&json, "box", box, 3);
 *     json_object_end(&json);
 *
 * key is the name of a member, in printable ASCII that needs no escape; NULL in an array and for
 * the outermost value. The writer adds commas. Check ferror(out) for write errors. */
#ifndef JSON_WRITE_H
#define JSON_WRITE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* The caller sets out (not owned), page and digits; all else is 0 at first. */
struct json_writer {
    FILE *out;
    bool page;  /* for scripts: no spaces, and integers beyond +-(2^53 - 1) as strings */
    int digits; /* of numbers; 0: as many as read back as the same bits */
    bool comma; /* private: the next element needs a comma before it */
};

/* bracket: '{' or '[', ended by '}' or ']'. */
void json_begin(struct json_writer *json, const char *key, char bracket);
void json_end(struct json_writer *json, char bracket);

/* Begin and end a text that is one object on a line; another one may follow. */
struct json_writer json_object(FILE *out);
void json_object_end(struct json_writer *json);

void json_null(struct json_writer *json, const char *key);
void json_bool(struct json_writer *json, const char *key, bool value);
void json_integer(struct json_writer *json, const char *key, int64_t value);

/* Writes null if the number is not finite. */
void json_number(struct json_writer *json, const char *key, double value);

void json_integers(struct json_writer *json, const char *key, const int64_t *integers, int count);

/* A vector, without spaces: [0,0.5,1]. */
void json_numbers(struct json_writer *json, const char *key, const double *numbers, int count);

/* Strings, escaped by escape(). text: NULL: null. */
void json_string(struct json_writer *json, const char *key, const char *text);
void json_bytes(struct json_writer *json, const char *key, const char *bytes, size_t count);

#endif
