/* JSON written as it comes. */
#ifndef BENCH_JSON_H
#define BENCH_JSON_H

#include <stdbool.h>
#include <stdio.h>

struct json {
    FILE *out;
    bool more; /* something stands before in what is open: a comma comes first */
};

/* The key is NULL in an array. Opening: '{' or '['; closing: '}' or ']'. A number that is not
 * finite is null. */
void json_open(struct json *json, const char *key, char bracket);
void json_close(struct json *json, char bracket);
void json_number(struct json *json, const char *key, double number);
void json_bool(struct json *json, const char *key, bool value);
void json_text(struct json *json, const char *key, const char *text);

#endif
