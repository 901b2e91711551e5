#include "scan.h"

#include <stdio.h>
#include <string.h>

/* What each state waits for, for people; NULL: what may follow a value. */
static const char *const expected[] = {
    [AT_OBJECT] = "an object, '{'",
    [AT_VALUE] = "a value",
    [AT_VALUE_OR_CLOSE] = "a value or ']'",
    [AT_KEY] = "a key in quotes",
    [AT_KEY_OR_CLOSE] = "a key in quotes or '}'",
    [AT_COLON] = "':'",
    [AT_CHARACTER] = "a character",
    [AT_ESCAPE] = "an escape of JSON",
    [AT_HEX] = "a hexadecimal digit",
    [AT_OTHER_HALF] = "the other half of the character, \\udc00 to \\udfff",
    [AT_OTHER_HALF_U] = "the other half of the character, \\udc00 to \\udfff",
    [AT_MINUS] = "a digit",
    [AT_POINT] = "a digit",
    [AT_EXPONENT] = "a digit or a sign",
    [AT_SIGN] = "a digit",
    [AT_LITERAL] = "true, false or null",
};

void scan_begin(struct scan *scan)
{
    memset(scan, 0, sizeof *scan);
    scan->line = scan->column = 1;
}

void scan_next(struct scan *scan)
{
    scan->state = AT_OBJECT;
}

bool scan_is_between(const struct scan *scan)
{
    return scan->state == AT_OBJECT;
}

static bool in_object(const struct scan *scan)
{
    return scan->objects >> scan->depth & 1;
}

static const char *expected_now(const struct scan *scan)
{
    if (expected[scan->state])
        return expected[scan->state];
    return in_object(scan) ? "',' or '}'" : "',' or ']'";
}

void scan_refuse(struct scan *scan, const char *found)
{
    snprintf(scan->error, sizeof scan->error, "expected %s, found %s", expected_now(scan), found);
}

void scan_end(struct scan *scan)
{
    scan_refuse(scan, "the end of the input");
}

static enum scan_result bad(struct scan *scan, unsigned char byte)
{
    char found[16];
    if (byte > 0x20 && byte < 0x7f)
        snprintf(found, sizeof found, "'%c'", byte);
    else
        snprintf(found, sizeof found, "byte 0x%02x", byte);
    scan_refuse(scan, found);
    return SCAN_BAD;
}

/* ---- Between tokens -------------------------------------------------------------------------- */

static bool is_space(unsigned char byte)
{
    return byte == ' ' || byte == '\t' || byte == '\n' || byte == '\r';
}

static bool is_digit(unsigned char byte)
{
    return byte >= '0' && byte <= '9';
}

static enum scan_result to(struct scan *scan, enum scan_state state)
{
    scan->state = state;
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
    return to(scan, object ? AT_KEY_OR_CLOSE : AT_VALUE_OR_CLOSE);
}

static enum scan_result close_level(struct scan *scan)
{
    scan->depth--;
    to(scan, AT_COMMA_OR_CLOSE);
    return scan->depth == 0 ? SCAN_DONE : SCAN_MORE;
}

static enum scan_result string(struct scan *scan, bool key)
{
    scan->key = key;
    return to(scan, AT_CHARACTER);
}

static enum scan_result literal(struct scan *scan, const char *rest)
{
    scan->literal = rest;
    return to(scan, AT_LITERAL);
}

static enum scan_result value(struct scan *scan, unsigned char byte)
{
    switch (byte) {
    case '{': return open_level(scan, true);
    case '[': return open_level(scan, false);
    case '"': return string(scan, false);
    case '-': return to(scan, AT_MINUS);
    case '0': return to(scan, AT_ZERO);
    case 't': return literal(scan, "rue");
    case 'f': return literal(scan, "alse");
    case 'n': return literal(scan, "ull");
    }
    return is_digit(byte) ? to(scan, AT_INTEGER) : bad(scan, byte);
}

static enum scan_result key(struct scan *scan, unsigned char byte)
{
    return byte == '"' ? string(scan, true) : bad(scan, byte);
}

static enum scan_result next(struct scan *scan, unsigned char byte)
{
    if (byte == ',')
        return to(scan, in_object(scan) ? AT_KEY : AT_VALUE);
    if (byte == (in_object(scan) ? '}' : ']'))
        return close_level(scan);
    return bad(scan, byte);
}

static enum scan_result structure(struct scan *scan, unsigned char byte)
{
    if (is_space(byte))
        return SCAN_MORE;
    switch (scan->state) {
    case AT_OBJECT:
        if (byte == '{')
            return open_level(scan, true);
        break;
    case AT_VALUE: return value(scan, byte);
    case AT_VALUE_OR_CLOSE: return byte == ']' ? close_level(scan) : value(scan, byte);
    case AT_KEY_OR_CLOSE:
        if (byte == '}')
            return close_level(scan);
        return key(scan, byte);
    case AT_KEY: return key(scan, byte);
    case AT_COLON:
        if (byte == ':')
            return to(scan, AT_VALUE);
        break;
    case AT_COMMA_OR_CLOSE: return next(scan, byte);
    default: break;
    }
    return bad(scan, byte);
}

/* ---- Strings --------------------------------------------------------------------------------- */

static int hex_value(unsigned char byte)
{
    if (is_digit(byte))
        return byte - '0';
    if (byte >= 'a' && byte <= 'f')
        return byte - 'a' + 10;
    return byte >= 'A' && byte <= 'F' ? byte - 'A' + 10 : -1;
}

/* UTF-16 has characters of two halves, and each is an escape of its own. */
static bool is_first_half(unsigned unit)
{
    return unit >= 0xd800 && unit < 0xdc00;
}

static bool is_second_half(unsigned unit)
{
    return unit >= 0xdc00 && unit < 0xe000;
}

/* Behind the fourth digit. */
static enum scan_result unit(struct scan *scan)
{
    if (scan->hex == 0) {
        snprintf(scan->error, sizeof scan->error, "\\u0000 in a string");
        return SCAN_BAD;
    }
    if (scan->other_half != is_second_half(scan->hex)) {
        snprintf(scan->error, sizeof scan->error, "expected %s, found \\u%04x",
                 scan->other_half ? expected[AT_OTHER_HALF] : "a character", scan->hex);
        return SCAN_BAD;
    }
    return to(scan, is_first_half(scan->hex) ? AT_OTHER_HALF : AT_CHARACTER);
}

static enum scan_result hex(struct scan *scan, unsigned char byte)
{
    int digit = hex_value(byte);
    if (digit < 0)
        return bad(scan, byte);
    scan->hex = scan->hex << 4 | (unsigned) digit;
    return --scan->hex_digits > 0 ? SCAN_MORE : unit(scan);
}

static enum scan_result begin_hex(struct scan *scan, bool other_half)
{
    scan->hex_digits = 4;
    scan->hex = 0;
    scan->other_half = other_half;
    return to(scan, AT_HEX);
}

static enum scan_result escape(struct scan *scan, unsigned char byte)
{
    if (byte == 'u')
        return begin_hex(scan, false);
    return byte && strchr("\"\\/bfnrt", byte) ? to(scan, AT_CHARACTER) : bad(scan, byte);
}

static enum scan_result character(struct scan *scan, unsigned char byte)
{
    if (byte == '"')
        return to(scan, scan->key ? AT_COLON : AT_COMMA_OR_CLOSE);
    if (byte == '\\')
        return to(scan, AT_ESCAPE);
    return byte < 0x20 ? bad(scan, byte) : SCAN_MORE;
}

static enum scan_result in_string(struct scan *scan, unsigned char byte)
{
    switch (scan->state) {
    case AT_ESCAPE: return escape(scan, byte);
    case AT_HEX: return hex(scan, byte);
    case AT_OTHER_HALF: return byte == '\\' ? to(scan, AT_OTHER_HALF_U) : bad(scan, byte);
    case AT_OTHER_HALF_U: return byte == 'u' ? begin_hex(scan, true) : bad(scan, byte);
    default: return character(scan, byte);
    }
}

/* ---- Literals and numbers -------------------------------------------------------------------- */

static enum scan_result in_literal(struct scan *scan, unsigned char byte)
{
    if (byte != (unsigned char) *scan->literal)
        return bad(scan, byte);
    scan->literal++;
    return *scan->literal ? SCAN_MORE : to(scan, AT_COMMA_OR_CLOSE);
}

/* What one more byte does to a number: it goes on, in another state perhaps; it has ended before
 * the byte; or the byte is wrong, because the number cannot end yet. */
enum step { STAYS, ENDED, WRONG };

static enum step stay(struct scan *scan, enum scan_state state)
{
    scan->state = state;
    return STAYS;
}

/* Behind digits, where an exponent may follow. */
static enum step exponent_or_end(struct scan *scan, unsigned char byte)
{
    return byte == 'e' || byte == 'E' ? stay(scan, AT_EXPONENT) : ENDED;
}

/* Behind digits before the point. */
static enum step point_or_end(struct scan *scan, unsigned char byte)
{
    return byte == '.' ? stay(scan, AT_POINT) : exponent_or_end(scan, byte);
}

static enum step number_step(struct scan *scan, unsigned char byte)
{
    bool digit = is_digit(byte);
    switch (scan->state) {
    case AT_MINUS:
        if (!digit)
            return WRONG;
        return stay(scan, byte == '0' ? AT_ZERO : AT_INTEGER);
    case AT_ZERO: return point_or_end(scan, byte);
    case AT_INTEGER: return digit ? STAYS : point_or_end(scan, byte);
    case AT_POINT: return digit ? stay(scan, AT_FRACTION) : WRONG;
    case AT_FRACTION: return digit ? STAYS : exponent_or_end(scan, byte);
    case AT_EXPONENT:
        if (byte == '+' || byte == '-')
            return stay(scan, AT_SIGN);
        return digit ? stay(scan, AT_POWER) : WRONG;
    case AT_SIGN: return digit ? stay(scan, AT_POWER) : WRONG;
    case AT_POWER: return digit ? STAYS : ENDED;
    default: return WRONG;
    }
}

static enum scan_result in_number(struct scan *scan, unsigned char byte)
{
    switch (number_step(scan, byte)) {
    case STAYS: return SCAN_MORE;
    case ENDED: to(scan, AT_COMMA_OR_CLOSE); return structure(scan, byte);
    case WRONG: break;
    }
    return bad(scan, byte);
}

/* ---- Any byte -------------------------------------------------------------------------------- */

static bool is_string(enum scan_state state)
{
    return state >= AT_CHARACTER && state <= AT_OTHER_HALF_U;
}

static bool is_number(enum scan_state state)
{
    return state >= AT_MINUS && state <= AT_POWER;
}

static enum scan_result token(struct scan *scan, unsigned char byte)
{
    if (is_string(scan->state))
        return in_string(scan, byte);
    if (is_number(scan->state))
        return in_number(scan, byte);
    if (scan->state == AT_LITERAL)
        return in_literal(scan, byte);
    return structure(scan, byte);
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
