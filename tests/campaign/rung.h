/* Which rung decides a pair. */
#ifndef RUNG_H
#define RUNG_H

#include "certified.h"

/* Returns the verdict of a checked pair by the method certified, and in *path the rung that decided
 * it. */
static inline enum fmb_verdict verdict_by_rung(const struct frame_pair *pair,
                                               enum certified_path *path)
{
    struct certified certified;
    struct fmb_prepared a, b;
    struct fmb_answer answer = {0};
    prepared_set(pair->a, &a);
    prepared_set(pair->b, &b);
    bool done = certified_begin(&a, &b, pair->duration, 0, INFINITY, SUPPORT_CERTIFIED, &certified,
                                &answer);
    *path = done ? certified.path : CERTIFIED_PROGRAMS;
    while (!done)
        done = certified_step(&certified, &answer);
    return answer.verdict;
}

#endif
