#include "json_write.h"

#include "escape.h"
#include "number.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

static const int64_t integer_max = (INT64_C(1) << 53) - 1;

/* Writes what precedes a value: comma, space and key. */
static void begin_value(struct json_writer *json, const char *key)
{
    if (json->comma)
        putc(',', json->out);
    if (json->comma && !json->page)
        putc(' ', json->out);
    if (key)
        fprintf(json->out, json->page ? "\"%s\":" : "\"%s\": ", key);
    json->comma = true;
}

static void value(struct json_writer *json, const char *key, const char *text)
{
    begin_value(json, key);
    fputs(text, json->out);
}

void json_begin(struct json_writer *json, const char *key, char bracket)
{
    begin_value(json, key);
    putc(bracket, json->out);
    json->comma = false;
}

void json_end(struct json_writer *json, char bracket)
{
    putc(bracket, json->out);
    json->comma = true;
}

struct json_writer json_object(FILE *out)
{
    struct json_writer json = {.out = out};
    json_begin(&json, NULL, '{');
    return json;
}

void json_object_end(struct json_writer *json)
{
    fputs("}\n", json->out);
    json->comma = false;
}

void json_null(struct json_writer *json, const char *key)
{
    value(json, key, "null");
}

void json_bool(struct json_writer *json, const char *key, bool truth)
{
    value(json, key, truth ? "true" : "false");
}

void json_integer(struct json_writer *json, const char *key, int64_t integer)
{
    const bool exact = integer >= -integer_max && integer <= integer_max;
    begin_value(json, key);
    fprintf(json->out, exact || !json->page ? "%" PRId64 : "\"%" PRId64 "\"", integer);
}

void json_integers(struct json_writer *json, const char *key, const int64_t *integers, int count)
{
    json_begin(json, key, '[');
    for (int i = 0; i < count; i++)
        json_integer(json, NULL, integers[i]);
    json_end(json, ']');
}

static const char *number_text(const struct json_writer *json, double number,
                               char text[NUMBER_TEXT_MAX])
{
    if (json->digits == 0 || !isfinite(number))
        return number_exact(number, text);
    snprintf(text, NUMBER_TEXT_MAX, "%.*g", json->digits, number);
    return text;
}

void json_number(struct json_writer *json, const char *key, double number)
{
    char text[NUMBER_TEXT_MAX];
    value(json, key, number_text(json, number, text));
}

void json_numbers(struct json_writer *json, const char *key, const double *numbers, int count)
{
    char text[NUMBER_TEXT_MAX];
    json_begin(json, key, '[');
    for (int i = 0; i < count; i++)
        fprintf(json->out, "%s%s", i ? "," : "", number_text(json, numbers[i], text));
    json_end(json, ']');
}

void json_bytes(struct json_writer *json, const char *key, const char *bytes, size_t count)
{
    json_begin(json, key, '"');
    escape(json->out, ESCAPE_JSON, bytes, count);
    json_end(json, '"');
}

void json_string(struct json_writer *json, const char *key, const char *text)
{
    if (text)
        json_bytes(json, key, text, strlen(text));
    else
        json_null(json, key);
}
