/* The pairs of a query, then and now side by side: the one of a pair query; those that a scene
 * lists and a result answers; of all and across those that a result names, for all others are
 * separated. */
#ifndef PAGE_PAIRS_H
#define PAGE_PAIRS_H

#include "replayed.h"

/* What one result says of a pair. */
struct page_side {
    bool answered;         /* false: it says nothing, and what follows is 0 */
    unsigned char verdict; /* enum fmb_verdict; 0: the method could not decide */
    bool has_times;
    int dim; /* of the box; 0: there is none */
    double times[2];
    double box[2][FMB_DIM_MAX];
};

struct page_pair {
    unsigned a, b; /* frames; of a hostile log maybe none of the query */
    struct page_side then, now;
    bool differs; /* both have answered, and not the same */
};

/* Where a walk through the pairs is in one of the results. */
struct page_place {
    const struct scene_result *result; /* NULL: none, or it answers nothing */
    int32_t verdict, contact;          /* the next ones */
};

struct page_pairs {
    const struct replayed *replayed; /* not owned */
    bool pair_given;
    struct page_place then, now;
};

void page_pairs_begin(const struct replayed *replayed, struct page_pairs *out);

/* On output: true and *out, or false after the last one. */
bool page_pairs_next(struct page_pairs *pairs, struct page_pair *out);

/* How many pairs the scene asks for. */
int64_t page_pairs_total(const struct scene_query *query);

/* How many pairs the result answers with each verdict, those it does not name included. On input:
 * a result to the query, or NULL. */
void page_pairs_count(const struct scene_query *query, const struct scene_result *result,
                      int64_t count[FMB_OVERLAPPING + 1]);

#endif
