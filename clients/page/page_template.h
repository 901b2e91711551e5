/* The page without its data: text, style, scripts and three.js, put together by the Makefile. */
#ifndef PAGE_TEMPLATE_H
#define PAGE_TEMPLATE_H

#include <stdio.h>

/* The parts before and after the elements with the data. */
void page_template_begin(FILE *out);
void page_template_end(FILE *out);

#endif
