/* Puts a question to the engine and holds the answer against the oracle; fails the running
 * cmocka test, and prints the question, where they differ. */
#ifndef REFEREE_H
#define REFEREE_H

#include "fmb.h"
#include "oracle.h"
#include "question.h"

/* A question ready for the engine. Not to be copied: pair points into body. */
struct ready {
    struct fmb_body body[2];
    struct pair pair;
};

/* In: solids of one frame. Bodies and pair through fmb_body_make and pair_check; fails the test if
 * these refuse. */
void referee_ready(const struct question *question, struct ready *ready);

/* The answer of the exact method, box wanted. */
void referee_decide(const struct question *question, struct fmb_answer *answer);

/* Same verdict, and the same bits of the interval and of the box where there are any. */
bool referee_same(const struct fmb_answer *one, const struct fmb_answer *other);

/* The methods that are never wrong, queried in both orders, with the box and without it, agree with
 * the oracle (exact: ORACLE_TIGHTEST; certified: ORACLE_DESIGN) and each with itself, to the bit.
 * Returns the verdict. */
enum fmb_verdict referee_assert(const struct question *question);

/* The same against a truth that is known already, box included, in this order only. */
void referee_assert_truth(const struct question *question, const struct oracle_answer *truth);

/* Fails the test: prints what and the question first. */
void referee_fail(const struct question *question, const char *what);

#endif
