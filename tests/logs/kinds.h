/* The kinds of logs, each in a file of its own: what is queried in it, from the beginning of a tape
 * to its end. */
#ifndef KINDS_H
#define KINDS_H

#include "tape.h"

#include <stdbool.h>

/* False: out of memory. */
typedef bool kind_function(struct tape *tape);

kind_function kind_arm, kind_stack, kind_crowd, kind_hard_plane, kind_hard_space, kind_hard_moving;
kind_function kind_refused, kind_clients, kind_foreign;

struct kind {
    const char *name;
    const char *summary; /* one line, for people */
    kind_function *run;
};

#endif
