/* What was read of a log behind queries that have no answer yet, and waits for its turn: first in,
 * first out. */
#ifndef BEHIND_H
#define BEHIND_H

#include "match.h"

struct behind;

struct behind_item {
    struct match_item item; /* its bytes are copies */
    uint64_t after;         /* so many queries come before it */
    bool is_result;
    struct behind_item *next; /* of behind.c */
};

/* Never NULL: ends the program where there is no memory. */
struct behind *behind_open(void);
void behind_close(struct behind *behind); /* may be NULL */

void behind_put(struct behind *behind, const struct match_item *item, bool is_result,
                uint64_t after);

/* The oldest; NULL: none waits. */
const struct behind_item *behind_first(const struct behind *behind);
void behind_drop_first(struct behind *behind);

/* That all of them take. */
size_t behind_bytes(const struct behind *behind);

#endif
