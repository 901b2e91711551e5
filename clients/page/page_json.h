/* JSON text in memory, escaped for a <script> element. */
#ifndef PAGE_JSON_H
#define PAGE_JSON_H

#include "json_write.h"

struct page_json {
    struct json_writer json; /* the writer of the elements, each on its own line */
    char *bytes;             /* owned; `used` of them, as of the last page_json_flush() */
    size_t used;
};

/* Open a text, and bring bytes up to date. Exit with status 1 if memory is exhausted. */
void page_json_open(struct page_json *out);
void page_json_flush(struct page_json *page);
void page_json_close(struct page_json *page);

/* Copies the text, as of the last page_json_flush(). */
void page_json_write(const struct page_json *page, FILE *out);

#endif
