/* The kinds of logs that are generated. The function of a kind makes the queries of a tape, from
 * its beginning to its end. */
#ifndef KINDS_H
#define KINDS_H

#include "tape.h"

#include <stdbool.h>

/* False: out of memory. */
typedef bool kind_function(struct tape *tape);

kind_function kind_hard_plane, kind_hard_space, kind_hard_moving, kind_turns;

struct kind {
    const char *name;
    const char *summary; /* one line, for people */
    kind_function *run;
};

#endif
