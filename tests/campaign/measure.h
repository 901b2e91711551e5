/* One cell of the accuracy campaign: draws its pairs, runs all methods and the oracle. */
#ifndef MEASURE_H
#define MEASURE_H

#include <stdint.h>

#include "cell.h"
#include "certified.h"
#include "family.h"
#include "campaign_tally.h"

/* By enum certified_path: which step of the certified method decided the verdict. */
enum { MEASURE_PATHS = CERTIFIED_PROGRAMS + 1 };
const char *measure_path_name(int path);

/* Of one method. Times: the median over the batches of pairs of a batch's mean. */
struct measure_method {
    struct tally tally;
    double ns_verdict; /* a query, verdict (and interval) only */
    double ns_box;     /* a query, with the box where there is contact */
    double ns_gap;     /* a query with the gap; 0: the method has none */
};

struct measure {
    const struct family *family;
    struct cell cell;
    uint64_t pairs;
    uint64_t truth[TALLY_VERDICTS]; /* pairs of each verdict */
    uint64_t not_as_made;         /* pairs whose verdict is not the one that the family promises */
    uint64_t path[MEASURE_PATHS]; /* of (A, B) */
    struct measure_method method[TRIAL_METHODS_MAX]; /* in the order of fmb_method_at() */
};

/* On input: family and cell are set, all else is 0. */
void measure_cell(struct measure *measure, long pairs, uint64_t seed);

#endif
