/* The article's elimination with its first rows in another order, which decides how soon one is
 * found that cannot hold (article, section 4): eliminate.c once more, given rows by ordered.c. */
#ifndef ORDERED_H
#define ORDERED_H

#include "rows.h"

/* SORTED: rows with the least slack first (inequality 11). */
enum order { ORDER_SORTED, ORDER_REVERSED };

/* From now on. */
void ordered_choose(enum order order);

/* As eliminate_decide() and rows_of_pair(). */
enum fmb_status ordered_decide(const struct frame_pair *pair, unsigned want,
                               struct fmb_answer *answer);
bool ordered_rows_of_pair(const struct inexact_pair *pair, struct row rows[ROWS_MAX], int *count);

#endif
