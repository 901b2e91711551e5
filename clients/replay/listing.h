/* The differences that a replay reports: the first ones up to a limit, sorted by their queries,
 * whatever the order in which they are found. Differences of one query stay in the order of
 * arrival. Each takes some 300 bytes of memory, and the beginning of certificates that differ. */
#ifndef LISTING_H
#define LISTING_H

#include "found.h"

struct listing;

/* limit: most differences kept, from 0. Exits with status 1 if memory is exhausted. */
struct listing *listing_open(int64_t limit);
void listing_close(struct listing *list); /* may be NULL */

/* Adds a difference, and copies what it keeps of it. */
void listing_put(struct listing *list, const struct found *found);

/* Number of differences beyond the limit. */
int64_t listing_beyond(const struct listing *list);

/* Calls the sink for each difference kept. None may be added after that. */
void listing_each(struct listing *list, found_sink *sink, void *user);

#endif
