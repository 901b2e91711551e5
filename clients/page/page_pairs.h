/* Iterates over the pairs of a query with both results: the recorded one (then) and that of the
 * replay (now). For a pair query: its pair. For listed pairs: those that a result answers. For all
 * and across: those that a result names; all others are separated. */
#ifndef PAGE_PAIRS_H
#define PAGE_PAIRS_H

#include "replayed.h"

/* What one result states about a pair. */
struct page_side {
    bool answered;         /* false: nothing, and the other members are 0 */
    unsigned char verdict; /* enum fmb_verdict; 0: the method could not decide */
    bool has_times;
    int dim, gap_dim; /* of box and gap; 0: there is none */
    double times[2];
    double box[2][FMB_DIM_MAX];
    const struct fmb_gap *gap; /* of the result; where there is one */
};

struct page_pair {
    unsigned a, b; /* indices of placements; in a hostile log perhaps out of range */
    struct page_side then, now;
    bool differs; /* both answer the pair, differently */
};

/* Position of an iteration in one of the results. */
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

/* Returns true and the next pair, or false after the last one. */
bool page_pairs_next(struct page_pairs *pairs, struct page_pair *out);

/* Counts the pairs that the result answers with each verdict, including those it does not name. On
 * input: a result to the query, or NULL. */
void page_pairs_count(const struct scene_query *query, const struct scene_result *result,
                      int64_t count[FMB_OVERLAPPING + 1]);

#endif
