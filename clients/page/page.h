/* A replay as an HTML page: a timeline of contacts for each pair of bodies, with the differences
 * marked, and the scene of any query. The page is one file that fetches nothing. */
#ifndef PAGE_H
#define PAGE_H

#include "replayed.h"

#include <stdio.h>

/* Limits on queries and bytes of their data; and on those with differences that are kept beyond
 * them. Queries are kept whole, so that the bytes may be exceeded by up to a megabyte. Of one query
 * PAGE_PAIRS_MAX pairs are kept (page_event.h). */
enum {
    PAGE_EVENTS_MAX = 5000,
    PAGE_BYTES_MAX = 32 << 20,
    PAGE_DIFFERENCES_MAX = 1000,
    PAGE_DIFFERENCES_BYTES_MAX = 16 << 20
};

struct page;

/* Never NULL: exits with status 1 without memory, as page_take() does. title: the names of the
 * logs, copied. begin: log time from which the page counts seconds, microseconds since 1970. */
struct page *page_open(const char *title, int64_t begin);
void page_close(struct page *page); /* may be NULL */

/* Adds a query with its results; copies what the page shows. Queries beyond the limits are counted,
 * and the page says so. */
void page_take(struct page *page, const struct replayed *replayed);

/* On output: ferror(out) is set if writing failed. */
void page_write(const struct page *page, FILE *out);

#endif
