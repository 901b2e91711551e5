/* The pairs of a scene query that lists none: all pairs of its placements, or those across. They
 * are numbered from 0 in lexicographic order, ignored pairs included. */
#ifndef QUERY_PAIRS_H
#define QUERY_PAIRS_H

#include "query.h"

/* Returns the number of placements in the struct. */
int32_t query_stored_placements(const struct scene_query *query);

/* Whether (a, b) is a pair of the query, for any a and b. */
bool query_has_pair(const struct scene_query *query, unsigned a, unsigned b);

/* Returns the number of the pair (a, b). In: a pair of the query. */
int64_t query_pair_number(const struct scene_query *query, unsigned a, unsigned b);

/* A set of pairs of placements: bit query_pair_bit(pair) of QUERY_PAIR_SET_BYTES bytes. */
enum { QUERY_PAIR_SET_BYTES = QUERY_PLACEMENTS_MAX * QUERY_PLACEMENTS_MAX / 8 + 1 };

/* Returns the bit of a pair, in either order. In: indices below QUERY_PLACEMENTS_MAX. */
size_t query_pair_bit(const unsigned pair[2]);

/* Returns the number of pairs that are not ignored, of those with numbers from query->first_pair to
 * end_pair - 1. A query of listed pairs, which are never ignored, is accepted too. In: set: scratch
 * memory, not initialized. */
int64_t query_pairs_until(const struct scene_query *query, int32_t end_pair,
                          unsigned char set[QUERY_PAIR_SET_BYTES]);

#endif
