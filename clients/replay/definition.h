/* Definitions: queries that say what keys stand for, and ask nothing. fmb log cut writes them where
 * the components do not fit into the query that needs them.
 *
 * A definition is a scene_query_t with client_id 0, PAIRS_LISTED and no indices, of one frame at
 * least, all of whose frames have a body_id, a key and components. From its place in the log on
 * each of its keys stands for these components, until a result tells another thing. A service takes
 * it for what it is, a scene of no pairs. Nobody answers it in a log: so it is no query without a
 * result, and nothing is compared there. */
#ifndef DEFINITION_H
#define DEFINITION_H

#include "known_bodies.h"

enum { DEFINITION_CLIENT = 0 };

bool definition_is(const struct scene_query *query);

/* mine: what was defined so is the user's own (known_body.mine). */
void definition_learn(const struct scene_query *query, struct known_bodies *known, bool mine);

/* Makes a definition without frames. */
void definition_begin(struct scene_query *query);

/* Adds what the key of the frame, which came by key, stands for. False: there is no room; a
 * definition of what was added so far is to be written first. */
bool definition_add(struct scene_query *query, const struct query_frame *frame,
                    const struct query_numbers *components);

#endif
