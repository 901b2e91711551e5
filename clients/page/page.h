/* A replay as an HTML page: a timeline of contacts for each pair of bodies, with the differences
 * marked, and the scene of any query. The page is one file that fetches nothing. */
#ifndef PAGE_H
#define PAGE_H

#include "replayed.h"

#include <stdio.h>

/* Limits on queries and on the bytes of their data; further queries with differences are kept up to
 * limits of their own. Queries are kept as a whole, so the bytes may exceed their limit by up to a
 * megabyte. Of one query PAGE_PAIRS_MAX pairs are kept (page_event.h). */
enum {
    PAGE_EVENTS_MAX = 5000,
    PAGE_BYTES_MAX = 32 << 20,
    PAGE_DIFFERENCES_MAX = 1000,
    PAGE_DIFFERENCES_BYTES_MAX = 16 << 20
};

struct page;

/* Opens an empty page. In: title: the names of the logs, copied; begin: log time from which the
 * page counts seconds, microseconds since 1970. Returns a page, never NULL. Exits with status 1 if
 * memory is exhausted, as page_take() does. */
struct page *page_open(const char *title, int64_t begin);
void page_close(struct page *page); /* may be NULL */

/* Adds a query with its results; copies what the page shows. Queries beyond the limits are counted,
 * and the page states how many. */
void page_take(struct page *page, const struct replayed *replayed);

/* On output: ferror(out) is set if writing failed. */
void page_write(const struct page *page, FILE *out);

#endif
