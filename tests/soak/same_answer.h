/* Whether two answers are the same, number by number: the bytes between them mean nothing. */
#ifndef SAME_ANSWER_H
#define SAME_ANSWER_H

#include "query.h"

#include <string.h>

/* Inline: one line, for two programs. */
static inline bool same_answer(const struct fmb_answer *x, const struct fmb_answer *y)
{
    return x->verdict == y->verdict && x->has_contact == y->has_contact &&
           x->has_box == y->has_box && memcmp(x->contact, y->contact, sizeof x->contact) == 0 &&
           memcmp(x->box, y->box, sizeof x->box) == 0 && x->has_gap == y->has_gap &&
           query_same_gap(&x->gap, &y->gap);
}

#endif
