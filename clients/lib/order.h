/* Passes the answers to the parts of a scene to the caller, in the order of its pairs. Answers to
 * listed pairs are passed at once; those to blocks are kept until their row is complete. */
#ifndef ORDER_H
#define ORDER_H

#include "cut.h"

struct order {
    const struct cut *cut;
    fmb_client_sink *sink;
    void *user;
    struct part_answers *row; /* owned, [block_count]: the current row, by column */
};

/* On input: a cut, which must outlive the order. False: out of memory. */
bool order_begin(const struct cut *cut, fmb_client_sink *sink, void *user, struct order *out);
void order_end(struct order *order);

/* Takes the answers to the next part, in the order of the cut, and what they own. */
void order_take(struct order *order, const struct part *part, struct part_answers *answers);

#endif
