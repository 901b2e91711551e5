/* The queries of a log as the steps of a page (page.h). */
#ifndef PAGE_EXCHANGE_H
#define PAGE_EXCHANGE_H

#include "compare.h"
#include "page.h"

/* How a query was answered again. */
struct page_replayed {
    const char *log; /* path of the log that contains it */
    struct match_place place;
    int64_t begin; /* the log time from which the page counts, microseconds since 1970 */
    enum replay_outcome outcome;
    const char *note; /* how the scenes differ, if they do; "": they do not */
};

/* Adds a step. then has no result if none was recorded. Placements by handle have their geometry,
 * and a frame_count, if the log defines the handle. */
void page_take(struct page *page, const struct page_replayed *replayed, struct exchange *then,
               struct exchange *now);

#endif
