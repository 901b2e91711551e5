/* The scenes of a query, with their answers, as the steps of a page (page.h). */
#ifndef QUERY_PAGE_H
#define QUERY_PAGE_H

#include "page.h"
#include "report.h"

struct query_page {
    struct report report; /* receives the scenes */
    struct page *page;    /* owned */
    double end;           /* of the last window, seconds since the first one began */
};

/* In: title: the name of the input. The windows of the scenes follow each other. */
struct query_page query_page_open(const char *title);

#endif
