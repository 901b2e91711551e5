/* The page without its data, put together from the files of page/ when the program is built. */
#ifndef PAGE_TEMPLATE_H
#define PAGE_TEMPLATE_H

#include <stddef.h>

/* Where the data belong. */
#define PAGE_TEMPLATE_MARK "@DATA@"

extern const unsigned char page_template[];
extern const size_t page_template_size; /* bytes; no 0 at the end */

#endif
