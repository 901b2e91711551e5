/* What a campaign counts of one method. Queries are counted in both orders: two a pair. */
#ifndef TALLY_H
#define TALLY_H

#include <stdbool.h>
#include <stdint.h>

#include "fmb.h"
#include "oracle.h"
#include "trial.h"

enum { TALLY_VERDICTS = FMB_OVERLAPPING + 1, TALLY_WHY_MAX = 120 };

/* Of intervals, or of boxes: those that both the method and the truth have. */
struct tally_ends {
    uint64_t count, misses; /* misses: those that do not contain the true one */
    double in_most,
        out_most; /* the farthest that an end lies inside of the true one, and outside, relative */
};

/* Gaps of pairs in one order. A width is that of the enclosure divided by the limit of fmb.h. */
struct tally_gaps {
    uint64_t count, unproven; /* by gap_check.h */
    double width_most;
};

/* The first reply of a method that is never wrong, and was. */
struct tally_wrong {
    struct question question;
    char why[TALLY_WHY_MAX];
};

struct tally {
    uint64_t queries, refused;
    uint64_t count[TALLY_VERDICTS][TALLY_VERDICTS]; /* [true verdict][verdict said] */
    uint64_t order_verdict; /* pairs whose two orders differ, in the verdict or in refusing */
    struct tally_ends contact, box;
    struct tally_gaps gap;
    /* Of methods that are never wrong: queries that break what is promised, in any way. */
    uint64_t broken;
    struct tally_wrong first;
};

/* Wrong verdicts by kind. */
uint64_t tally_false_separated(const struct tally *tally); /* in contact, called separated */
uint64_t tally_false_contact(const struct tally *tally);
uint64_t tally_false_kind(const struct tally *tally); /* touching <-> overlapping */
uint64_t tally_wrong_verdicts(const struct tally *tally);

/* One reply against the truth: counts all but the orders. */
void tally_reply(struct tally *tally, const struct oracle_answer *truth, const struct pair *pair,
                 const struct reply *reply);

/* Both orders. */
void tally_orders(struct tally *tally, const struct reply *one, const struct reply *other);

/* A gap of a pair with this verdict, the true one. False if it is not proven; why is one line. */
bool tally_gap(struct tally *tally, enum fmb_verdict verdict, const struct pair *pair,
               const struct fmb_gap *gap, char why[TALLY_WHY_MAX]);

/* Something was wrong that must not be. why is one line. */
void tally_broken(struct tally *tally, const struct question *question, const char *why);

#endif
