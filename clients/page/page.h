/* What was replayed, as one page that shows it: a timeline of contacts for each pair of bodies,
 * with the differences marked, and the scene at any event. The page holds all that it shows, and
 * fetches nothing. */
#ifndef PAGE_H
#define PAGE_H

#include "replayed.h"

#include <stdio.h>

/* What is kept: so many queries and bytes of what the page holds; beyond them so many more queries
 * with differences, and bytes. A query is kept whole, so that it may be somewhat more, up to a
 * megabyte. Of one query PAGE_PAIRS_MAX pairs (page_event.h). */
enum {
    PAGE_EVENTS_MAX = 5000,
    PAGE_BYTES_MAX = 32 << 20,
    PAGE_DIFFERENCES_MAX = 1000,
    PAGE_DIFFERENCES_BYTES_MAX = 16 << 20
};

struct page;

/* Where there is no memory, the program ends (allocate.h). title: what the logs are called,
 * copied. begin: log time from which the page counts seconds, microseconds since 1970. */
struct page *page_open(const char *title, int64_t begin);
void page_close(struct page *page); /* may be NULL */

/* Takes in one query and its answers; copies what it shows. Beyond a limit on events, pairs and
 * bytes nothing more is kept but differences, up to another limit; the page says what it left out.
 */
void page_take(struct page *page, const struct replayed *replayed);

/* Where out fails, ferror() tells. */
void page_write(const struct page *page, FILE *out);

#endif
