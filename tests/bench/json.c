#include "json.h"

#include <math.h>

static void put_text(FILE *out, const char *text)
{
    putc('"', out);
    for (; *text; text++) {
        if (*text == '"' || *text == '\\')
            putc('\\', out);
        putc((unsigned char) *text < ' ' ? ' ' : *text, out);
    }
    putc('"', out);
}

static void put_key(struct json *json, const char *key)
{
    if (json->more)
        fputs(",", json->out);
    json->more = true;
    if (!key)
        return;
    put_text(json->out, key);
    putc(':', json->out);
}

void json_open(struct json *json, const char *key, char bracket)
{
    put_key(json, key);
    if (!key)
        putc('\n', json->out); /* a row a line */
    putc(bracket, json->out);
    json->more = false;
}

void json_close(struct json *json, char bracket)
{
    putc(bracket, json->out);
    json->more = true;
}

void json_number(struct json *json, const char *key, double number)
{
    put_key(json, key);
    if (isfinite(number))
        fprintf(json->out, "%.10g", number);
    else
        fputs("null", json->out);
}

void json_bool(struct json *json, const char *key, bool value)
{
    put_key(json, key);
    fputs(value ? "true" : "false", json->out);
}

void json_text(struct json *json, const char *key, const char *text)
{
    put_key(json, key);
    put_text(json->out, text);
}
