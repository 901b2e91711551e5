/* Bytes as text, for what a page holds much of. */
#ifndef PAGE_BASE64_H
#define PAGE_BASE64_H

#include <stdint.h>
#include <stdio.h>

/* All 0 but for out is the beginning of a text. */
struct page_base64 {
    FILE *out; /* where it fails, ferror() tells */
    int count; /* of bytes that wait: fewer than three */
    unsigned char byte[3];
};

void page_base64_byte(struct page_base64 *text, unsigned char byte);

/* Four bytes, the lowest first. */
void page_base64_u32(struct page_base64 *text, uint32_t value);
void page_base64_float(struct page_base64 *text, float value);

/* Writes what waits. The next byte begins another text. */
void page_base64_end(struct page_base64 *text);

#endif
