/* Replayed queries as the steps of a page (page.h). */
#ifndef PAGE_REPLAYED_H
#define PAGE_REPLAYED_H

#include "body_names.h"
#include "page.h"
#include "replayed.h"

/* Adds a query with its results. In: names: of the bodies, may be NULL; begin: the log time from
 * which the page counts, microseconds since 1970. */
void page_take(struct page *page, const struct body_names *names, int64_t begin,
               const struct replayed *replayed);

#endif
