/* Queries and results that have not found each other yet, any number of them, in temporary files
 * (temporary.h). */
#ifndef SPILL_H
#define SPILL_H

#include "match.h"

struct spill;

struct spill *spill_open(void); /* never NULL */
void spill_close(struct spill *spill);

enum spill_side { SPILL_QUERIES, SPILL_RESULTS, SPILL_SIDES };

/* What fails is told by spill_join(). */
void spill_put(struct spill *spill, enum spill_side side, const struct match_item *item);

/* Brings together what was put: a result goes to the first query with the same kind, client id,
 * sequence number and utime that has none yet; else to such a one with another utime; else, if all
 * have one, to the last one, by utime. False: a file failed, and errno. */
bool spill_join(struct spill *spill, const struct match_sink *sink);

#endif
