/* The page without its data: text, style, scripts and three.js, put together by the Makefile. */
#ifndef PAGE_TEMPLATE_H
#define PAGE_TEMPLATE_H

#include <stdio.h>

/* The parts before and after the data, which are JSON by json_write.h. */
void page_template_begin(FILE *out);
void page_template_end(FILE *out);

#endif
