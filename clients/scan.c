#include "scan.h"

#include <stdio.h>
#include <string.h>

enum state {
    BETWEEN, /* white space before the object */
    VALUE,
    VALUE_OR_CLOSE, /* behind [ */
    KEY,            /* behind , in an object */
    KEY_OR_CLOSE,   /* behind { */
    COLON,
    NEXT, /* behind a value: , or the closing bracket */
    STRING,
    ESCAPE,   /* behind \ */
    HEX,      /* behind \u */
    MINUS,    /* - */
    ZERO,     /* 0 */
    INTEGER,  /* 12 */
    POINT,    /* 12. */
    FRACTION, /* 12.3 */
    EXPONENT, /* 12e */
    SIGN,     /* 12e- */
    POWER,    /* 12e-3 */
    LITERAL,
};

/* What each state waits for, for people. */
static const char *const expected[] = {
    [BETWEEN] = "an object, '{'",
    [VALUE] = "a value",
    [VALUE_OR_CLOSE] = "a value or ']'",
    [KEY] = "a key in quotes",
    [KEY_OR_CLOSE] = "a key in quotes or '}'",
    [COLON] = "':'",
    [STRING] = "a character",
    [ESCAPE] = "an escape of JSON",
    [HEX] = "a hexadecimal digit",
    [MINUS] = "a digit",
    [POINT] = "a digit",
    [EXPONENT] = "a digit or a sign",
    [SIGN] = "a digit",
};

void scan_begin(struct scan *scan)
{
    memset(scan, 0, sizeof *scan);
    scan->line = scan->column = 1;
}

void scan_next(struct scan *scan)
{
    scan->state = BETWEEN;
}

bool scan_is_between(const struct scan *scan)
{
    return scan->state == BETWEEN;
}

static bool in_object(const struct scan *scan)
{
    return scan->objects >> scan->depth & 1;
}

static const char *expected_now(const struct scan *scan)
{
    if (scan->state == LITERAL)
        return "true, false or null";
    if (expected[scan->state])
        return expected[scan->state];
    return in_object(scan) ? "',' or '}'" : "',' or ']'";
}

static enum scan_result bad(struct scan *scan, unsigned char byte)
{
    char found[16];
    if (byte > 0x20 && byte < 0x7f)
        snprintf(found, sizeof found, "'%c'", byte);
    else
        snprintf(found, sizeof found, "byte 0x%02x", byte);
    snprintf(scan->error, sizeof scan->error, "expected %s, found %s", expected_now(scan), found);
    return SCAN_BAD;
}

void scan_end(struct scan *scan)
{
    snprintf(scan->error, sizeof scan->error, "expected %s, found the end of the input",
             expected_now(scan));
}

static bool is_space(unsigned char byte)
{
    return byte == ' ' || byte == '\t' || byte == '\n' || byte == '\r';
}

static bool is_digit(unsigned char byte)
{
    return byte >= '0' && byte <= '9';
}

static enum scan_result to(struct scan *scan, enum state state)
{
    scan->state = (int) state;
    return SCAN_MORE;
}

static enum scan_result open_level(struct scan *scan, bool object)
{
    if (scan->depth == SCAN_DEPTH_MAX) {
        snprintf(scan->error, sizeof scan->error, "nested more than %d deep", SCAN_DEPTH_MAX);
        return SCAN_BAD;
    }
    scan->depth++;
    uint64_t bit = UINT64_C(1) << scan->depth;
    scan->objects = object ? scan->objects | bit : scan->objects & ~bit;
    return to(scan, object ? KEY_OR_CLOSE : VALUE_OR_CLOSE);
}

static enum scan_result close_level(struct scan *scan)
{
    scan->depth--;
    to(scan, NEXT);
    return scan->depth == 0 ? SCAN_DONE : SCAN_MORE;
}

static enum scan_result string(struct scan *scan, bool key)
{
    scan->key = key;
    return to(scan, STRING);
}

static enum scan_result literal(struct scan *scan, const char *rest)
{
    scan->literal = rest;
    return to(scan, LITERAL);
}

static enum scan_result value(struct scan *scan, unsigned char byte)
{
    switch (byte) {
    case '{': return open_level(scan, true);
    case '[': return open_level(scan, false);
    case '"': return string(scan, false);
    case '-': return to(scan, MINUS);
    case '0': return to(scan, ZERO);
    case 't': return literal(scan, "rue");
    case 'f': return literal(scan, "alse");
    case 'n': return literal(scan, "ull");
    }
    return is_digit(byte) ? to(scan, INTEGER) : bad(scan, byte);
}

static enum scan_result next(struct scan *scan, unsigned char byte)
{
    if (byte == ',')
        return to(scan, in_object(scan) ? KEY : VALUE);
    if (byte == (in_object(scan) ? '}' : ']'))
        return close_level(scan);
    return bad(scan, byte);
}

/* Between tokens. */
static enum scan_result structure(struct scan *scan, unsigned char byte)
{
    if (is_space(byte))
        return SCAN_MORE;
    switch (scan->state) {
    case BETWEEN: return byte == '{' ? open_level(scan, true) : bad(scan, byte);
    case VALUE_OR_CLOSE: return byte == ']' ? close_level(scan) : value(scan, byte);
    case KEY_OR_CLOSE:
        if (byte == '}')
            return close_level(scan);
        return byte == '"' ? string(scan, true) : bad(scan, byte);
    case KEY: return byte == '"' ? string(scan, true) : bad(scan, byte);
    case COLON: return byte == ':' ? to(scan, VALUE) : bad(scan, byte);
    case NEXT: return next(scan, byte);
    default: return value(scan, byte);
    }
}

static int hex_value(unsigned char byte)
{
    if (is_digit(byte))
        return byte - '0';
    if (byte >= 'a' && byte <= 'f')
        return byte - 'a' + 10;
    return byte >= 'A' && byte <= 'F' ? byte - 'A' + 10 : -1;
}

static enum scan_result hex(struct scan *scan, unsigned char byte)
{
    int digit = hex_value(byte);
    if (digit < 0)
        return bad(scan, byte);
    scan->hex = scan->hex << 4 | (unsigned) digit;
    if (--scan->hex_digits > 0)
        return SCAN_MORE;
    if (scan->hex == 0) {
        snprintf(scan->error, sizeof scan->error, "\\u0000 in a string");
        return SCAN_BAD;
    }
    return to(scan, STRING);
}

static enum scan_result in_string(struct scan *scan, unsigned char byte)
{
    switch (scan->state) {
    case HEX: return hex(scan, byte);
    case ESCAPE:
        if (byte == 'u') {
            scan->hex_digits = 4;
            scan->hex = 0;
            return to(scan, HEX);
        }
        return byte && strchr("\"\\/bfnrt", byte) ? to(scan, STRING) : bad(scan, byte);
    }
    if (byte == '"')
        return to(scan, scan->key ? COLON : NEXT);
    if (byte == '\\')
        return to(scan, ESCAPE);
    return byte < 0x20 ? bad(scan, byte) : SCAN_MORE;
}

static enum scan_result in_literal(struct scan *scan, unsigned char byte)
{
    if (byte != (unsigned char) *scan->literal)
        return bad(scan, byte);
    scan->literal++;
    return *scan->literal ? SCAN_MORE : to(scan, NEXT);
}

/* The state that a number is in with one more byte; NEXT: it has ended before the byte; KEY,
 * which no number is in: the byte is wrong. */
static enum state number_state(enum state state, unsigned char byte)
{
    bool digit = is_digit(byte);
    bool exponent = byte == 'e' || byte == 'E';
    switch (state) {
    case MINUS: return byte == '0' ? ZERO : digit ? INTEGER : KEY;
    case ZERO: return digit ? KEY : byte == '.' ? POINT : exponent ? EXPONENT : NEXT;
    case INTEGER: return digit ? INTEGER : byte == '.' ? POINT : exponent ? EXPONENT : NEXT;
    case POINT: return digit ? FRACTION : KEY;
    case FRACTION: return digit ? FRACTION : exponent ? EXPONENT : NEXT;
    case EXPONENT: return digit ? POWER : byte == '+' || byte == '-' ? SIGN : KEY;
    case SIGN: return digit ? POWER : KEY;
    default: return digit ? POWER : NEXT;
    }
}

static enum scan_result in_number(struct scan *scan, unsigned char byte)
{
    enum state state = number_state((enum state) scan->state, byte);
    if (state == KEY)
        return bad(scan, byte);
    to(scan, state);
    return state == NEXT ? structure(scan, byte) : SCAN_MORE;
}

static bool is_number(int state)
{
    return state >= MINUS && state <= POWER;
}

static enum scan_result token(struct scan *scan, unsigned char byte)
{
    switch (scan->state) {
    case STRING:
    case ESCAPE:
    case HEX: return in_string(scan, byte);
    case LITERAL: return in_literal(scan, byte);
    }
    return is_number(scan->state) ? in_number(scan, byte) : structure(scan, byte);
}

static void advance(struct scan *scan, unsigned char byte)
{
    bool continuation = (byte & 0xc0) == 0x80;
    if (byte == '\n') {
        scan->line++;
        scan->column = 1;
    } else if (!continuation) {
        scan->column++;
    }
}

enum scan_result scan_byte(struct scan *scan, unsigned char byte)
{
    enum scan_result result = token(scan, byte);
    if (result == SCAN_BAD)
        return result;
    scan->number_bytes = is_number(scan->state) ? scan->number_bytes + 1 : 0;
    advance(scan, byte);
    return result;
}
