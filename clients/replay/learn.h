/* Learns from a query and its result which keys the service told for which components. */
#ifndef LEARN_H
#define LEARN_H

#include "known_bodies.h"
#include "match.h"

struct learner;

/* known: not owned. Never NULL: ends the program where there is no memory. */
struct learner *learner_open(struct known_bodies *known);
void learner_close(struct learner *learner); /* may be NULL */

/* A hint: learn() will soon be asked about this result. */
void learn_expect(const struct learner *learner, const struct match_item *result);

/* Whether a result may teach something, seen from its bytes alone. */
bool learn_may(const struct learner *learner, const struct match_item *result);

/* Bytes that are no messages teach nothing. A body is the user's own (known_body.mine) where a
 * query and a result that both are (match_place.mine) have told it, or told again what others had.
 */
void learn(struct learner *learner, const struct match_item *query,
           const struct match_item *result);

/* On output: true: the query is a definition (definition.h), and was learned. */
bool learn_definition(struct learner *learner, const struct match_item *query);

#endif
