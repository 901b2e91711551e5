/* The queries of a log as the steps of a page (page.h). */
#ifndef PAGE_EXCHANGE_H
#define PAGE_EXCHANGE_H

#include "compare.h"
#include "page.h"

/* How a query was answered again. */
struct page_replayed {
    const char *log; /* path of its log */
    struct match_place place;
    int64_t begin; /* the log time from which the page counts, microseconds since 1970 */
    enum replay_outcome outcome;
    const char *note; /* how the scenes differ, if they do; "": they do not */
};

/* Adds a step. In: then: without a result if none was recorded; placements by handle have their
 * geometry, and a frame_count, if the log defines them. */
void page_take(struct page *page, const struct page_replayed *replayed, struct exchange *then,
               struct exchange *now);

#endif
