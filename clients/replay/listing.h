/* The differences that are told of a replay: the first ones, so many, in the order of their
 * queries, whatever the order in which they are found. Those of one query stay in the order in
 * which they came. Each takes some 300 bytes of memory, and a certificate that differs its
 * beginning. */
#ifndef LISTING_H
#define LISTING_H

#include "found.h"

struct listing;

/* limit: of those that are kept, from 0. Never NULL: ends the program where there is no memory. */
struct listing *listing_open(int64_t limit);
void listing_close(struct listing *told); /* may be NULL */

/* Copies what it keeps. */
void listing_put(struct listing *told, const struct found *found);

/* How many there were beyond those that are kept. */
int64_t listing_beyond(const struct listing *told);

/* Calls the sink for each that is kept. No more may be put then. */
void listing_each(struct listing *told, found_sink *sink, void *user);

#endif
