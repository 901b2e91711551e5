/* Pages without their data, put together from the files of template/ when the program is built. */
#ifndef PAGE_TEMPLATE_H
#define PAGE_TEMPLATE_H

#include <stddef.h>
#include <stdio.h>

struct page_template {
    const unsigned char *bytes;
    size_t size; /* no 0 at the end */
};

extern const struct page_template page_template_replay, page_template_mesh;

/* What stands before the data, and what behind them: the data are JSON, of page_json.h. */
void page_template_begin(const struct page_template *page, FILE *out);
void page_template_end(const struct page_template *page, FILE *out);

#endif
