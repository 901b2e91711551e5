/* What was replayed, as one page that shows it: a timeline of contacts for each pair of bodies,
 * with the differences marked, and the scene at any event. The page holds all that it shows, and
 * fetches nothing. */
#ifndef PAGE_H
#define PAGE_H

#include "replayed.h"

#include <stdio.h>

struct page;

/* NULL: out of memory. title: what the logs are called, copied. */
struct page *page_open(const char *title);
void page_close(struct page *page); /* may be NULL */

/* Takes in one query and its answers; copies what it shows. Beyond a limit on events, pairs and
 * bytes nothing more is kept but differences, up to another limit; the page says what it left out.
 */
void page_take(struct page *page, const struct replayed *replayed);

/* Where out fails, ferror() tells. */
void page_write(const struct page *page, FILE *out);

#endif
