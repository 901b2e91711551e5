/* Decodes and checks UTF-8. No shared state. */
#ifndef UTF8_H
#define UTF8_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Decodes the character at the start of a text of at least one byte. Returns its bytes and *code;
 * or 1 and U+FFFD if the text does not begin with valid UTF-8. */
size_t utf8_decode(const unsigned char *text, size_t size, uint32_t *code);

/* Whether the character is a control character: U+0000 to U+001F, or U+007F to U+009F. */
bool utf8_is_control(uint32_t code);

/* Whether the text is valid UTF-8 without control characters. */
bool utf8_is_text(const char *text);

#endif
