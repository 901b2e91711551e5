/* Learns from a query and its result which keys the service told for which components. */
#ifndef LEARN_H
#define LEARN_H

#include "known_bodies.h"
#include "match.h"

struct learner;

/* known: not owned. Never NULL: ends the program where there is no memory. */
struct learner *learner_open(struct known_bodies *known);
void learner_close(struct learner *learner); /* may be NULL */

/* Bytes that are no messages teach nothing. */
void learn(struct learner *learner, const struct match_item *query,
           const struct match_item *result);

#endif
