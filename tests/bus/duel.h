/* fmbd against the echo: round trips with datagrams of the same sizes, in blocks, one of fmbd after
 * one of the echo, so that other load of the machine affects both. */
#ifndef DUEL_H
#define DUEL_H

#include "bus_bench.h"

/* Of a side, in microseconds: of each block the median, the 99 % and the largest; of these, over
 * all blocks, medians and quartiles. */
struct duel_side {
    struct spread p50, p99, max;
};

struct duel {
    size_t query_bytes, result_bytes;
    struct duel_side service, echo;
    struct spread ratio_p50, ratio_p99; /* of fmbd's block to the echo's beside it */
    struct spread compute;              /* time to decide as fmbd reports it, microseconds */
    int lost;                           /* round trips that did not come back, in these blocks */
};

/* Sends the query once, so that the echo's replies are as long as its result: a result that is not
 * OK ends the program. Then the blocks. */
struct duel duel_run(struct bus_bench *bench, struct datagram *query, int blocks, int trips);

/* The fields of an open object, and the line of a table. */
void duel_put(struct json_writer *json, const struct duel *duel);
void duel_print_head(void);
void duel_print(const char *name, const struct duel *duel);

#endif
