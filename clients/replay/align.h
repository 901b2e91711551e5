/* Two queries of one scene by different recordings: which bodies and pairs are the same.
 *
 * Bodies are the same if their names are, or, where one has no name, their ids; several with the
 * same name or id are taken in their order, and so are anonymous ones. Indices, the order of the
 * bodies and the order within a pair may differ.
 *
 * Method: a table of the pairs of the recorded query, by the indices of their bodies, is filled
 * from the recorded result; then each pair of the new query is looked up. Time and memory grow with
 * the number of pairs, as those of the answer do; queries with the same bodies and pairs in the
 * same order, the usual case, take time by the number of bodies. For one thread at a time. */
#ifndef ALIGN_H
#define ALIGN_H

#include "body_names.h"
#include "replayed.h"

struct align;

/* then, now: names of the bodies of the recorded and of the new queries; may be NULL. Exits with
 * status 1 if memory is exhausted. */
struct align *align_open(const struct body_names *then, const struct body_names *now);
void align_close(struct align *align); /* may be NULL */

/* Returns whether both queries, of one kind, have the same bodies and pairs by the same indices.
 * In: decoded queries, which stay until align_results(). */
bool align_queries(struct align *align, const struct logged_query *then,
                   const struct logged_query *now);

/* Returns which pairs correspond, and which bodies and pairs only one of the queries has. Valid
 * until the next call. In: results to the queries for which align_queries() has returned false. */
const struct replayed_match *align_results(struct align *align, const struct logged_result *then,
                                           const struct logged_result *now);

#endif
