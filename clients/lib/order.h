/* Gives the answers to the parts of a question to the caller, in the order of its pairs. Those of
 * lists come as they are; those of blocks are kept until their row is complete. */
#ifndef ORDER_H
#define ORDER_H

#include "cut.h"

struct order {
    const struct cut *cut;
    fmb_client_sink *sink;
    void *user;
    struct part_answers *row; /* owned, [block_count]: of the row under way, by column */
};

/* On input: a cut to outlive the order. False: no memory. */
bool order_begin(const struct cut *cut, fmb_client_sink *sink, void *user, struct order *out);
void order_end(struct order *order);

/* The answers to the next part, in the order of the cut; takes what they own. */
void order_take(struct order *order, const struct part *part, struct part_answers *answers);

#endif
