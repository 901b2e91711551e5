#include "page_base64.h"

#include <string.h>

static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/* Three bytes are four digits; of one or two, digits of nothing but padding are written as '='. */
static void put_group(const struct page_base64 *text)
{
    const unsigned bits =
        (unsigned) text->byte[0] << 16 | (unsigned) text->byte[1] << 8 | text->byte[2];
    for (int i = 0; i < 4; i++)
        putc(i <= text->count ? digit[bits >> (18 - 6 * i) & 63] : '=', text->out);
}

void page_base64_byte(struct page_base64 *text, unsigned char byte)
{
    text->byte[text->count++] = byte;
    if (text->count == 3)
        page_base64_end(text);
}

void page_base64_u32(struct page_base64 *text, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        page_base64_byte(text, (unsigned char) (value >> 8 * i));
}

void page_base64_float(struct page_base64 *text, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    page_base64_u32(text, bits);
}

void page_base64_end(struct page_base64 *text)
{
    if (text->count > 0)
        put_group(text);
    memset(text->byte, 0, sizeof text->byte);
    text->count = 0;
}
