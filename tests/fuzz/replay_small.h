/* What a replay keeps in memory, made so small that small inputs meet its limits: this file's
 * object takes the place of match.o, spill.o, known_bodies.o and temporary.o. */
#ifndef REPLAY_SMALL_H
#define REPLAY_SMALL_H

#include <stdbool.h>
#include <stddef.h>

/* Of replays from now on: bytes of the latest queries, and of the latest results, as many as the
 * longest of them takes or more; and bodies whose keys are known. */
void replay_small_begin(size_t recent_bytes, size_t bodies);

/* What they have put there since then. */
struct replay_small {
    size_t longest, all; /* bytes, of a query or result, and of all of them */
    bool forgets;        /* bodies had to go for others */
};
struct replay_small replay_small_used(void);

#endif
