/* Delivers the answers to the parts of a scene to the caller, in the order of its pairs. Answers to
 * listed pairs are delivered at once; those to blocks when their row is complete. */
#ifndef ORDER_H
#define ORDER_H

#include "division.h"

struct order {
    struct division *division;
    fmb_client_sink *sink;
    void *user;
    struct part_answers *row; /* owned, [block_count]: the current row, by column */
};

/* The division must outlive the order. Returns false if out of memory. */
bool order_begin(struct division *division, fmb_client_sink *sink, void *user, struct order *out);
void order_end(struct order *order);

/* Takes the answers to the next part, which has none afterwards. Parts come in the order of the
 * division. */
void order_take(struct order *order, struct part *part);

#endif
