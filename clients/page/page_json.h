/* JSON text that grows in memory, safe to stand in a <script> of a page. */
#ifndef PAGE_JSON_H
#define PAGE_JSON_H

#include <stddef.h>
#include <stdint.h>

/* All 0 is an empty one. Where there is no memory, the program ends (allocate.h). */
struct page_json {
    char *bytes; /* owned; used of them, and no 0 at the end */
    size_t used, room;
};

void page_json_clear(struct page_json *json);

/* As it is: punctuation, and names of members. */
void page_json_raw(struct page_json *json, const char *text);

/* Integers that doubles, the only numbers of the reader, may not hold become strings. */
void page_json_integer(struct page_json *json, int64_t value);

/* Reads back as the same bits; not finite: null. */
void page_json_number(struct page_json *json, double value);

/* With its quotes. What is no UTF-8 becomes U+FFFD, and each < is written as \u003c, so that
 * neither an end of the script nor a comment begins in it. */
void page_json_string(struct page_json *json, const char *text);

#endif
