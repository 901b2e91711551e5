/* Results of one scene query, asked in parts, as one result. */
#ifndef JOIN_H
#define JOIN_H

#include "query.h"

/* Whether a result has room for another contact, its keys counted. */
bool join_has_room(const struct scene_result *result);

/* Puts the answers of the next result behind those of a result, as many as it has room for: what it
 * would have been, had it not ended before. On input: both are OK, have been read by
 * wire_read_scene_result(), and answer the query: the one from its first_pair on, the next one from
 * the end_pair of that; pairs are named in both, or all listed. Times taken are added. False: they
 * do not have the same of contacts; nothing was changed. */
bool join(struct scene_result *result, const struct scene_result *next,
          const struct scene_query *query);

#endif
