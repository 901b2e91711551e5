/* The differences that a replay lists, in whatever order they are added: first those of scenes,
 * statuses and verdicts, then those of numbers and certificates; each sorted by the positions of
 * their queries, and those of one query in the order of arrival. Differences beyond a limit are
 * counted. Each kept takes some 1,200 bytes. */
#ifndef LISTING_H
#define LISTING_H

#include "compare.h"

struct listing;

/* Most bytes kept of a certificate. */
enum { LISTING_CERTIFICATE_MAX = 200 };

/* limit: most differences kept, from 0. Exits with status 1 if memory is exhausted. */
struct listing *listing_open(int64_t limit);
void listing_close(struct listing *list); /* may be NULL */

/* Adds a difference, which is copied. */
void listing_put(struct listing *list, const struct difference *difference);

/* Number of differences beyond the limit. */
int64_t listing_beyond(const struct listing *list);

/* Calls the sink for each difference kept, sorted. */
void listing_each(const struct listing *list, difference_sink *sink, void *user);

#endif
