/* Base64, for the large arrays of a page. */
#ifndef PAGE_BASE64_H
#define PAGE_BASE64_H

#include <stdint.h>
#include <stdio.h>

/* The start of a text: all 0 but out. */
struct page_base64 {
    FILE *out; /* ferror() is set if writing failed */
    int count; /* of buffered bytes: fewer than three */
    unsigned char byte[3];
};

void page_base64_byte(struct page_base64 *text, unsigned char byte);

/* Four bytes, the lowest first. */
void page_base64_u32(struct page_base64 *text, uint32_t value);
void page_base64_float(struct page_base64 *text, float value);

/* Writes the buffered bytes and the padding. The next byte begins another text. */
void page_base64_end(struct page_base64 *text);

#endif
