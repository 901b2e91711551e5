/* Pages without their data, assembled from the files of template/ by the Makefile. */
#ifndef PAGE_TEMPLATE_H
#define PAGE_TEMPLATE_H

#include <stddef.h>
#include <stdio.h>

struct page_template {
    const unsigned char *bytes;
    size_t size; /* no 0 at the end */
};

extern const struct page_template page_template_replay, page_template_mesh;

/* The parts before and after the data, which are JSON by json_write.h. */
void page_template_begin(const struct page_template *page, FILE *out);
void page_template_end(const struct page_template *page, FILE *out);

#endif
