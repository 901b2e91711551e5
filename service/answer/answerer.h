/* State of an answerer, and the beginnings of results. Private to answer*.c. */
#ifndef ANSWERER_H
#define ANSWERER_H

#include "answer.h"

struct answerer {
    struct cache *cache; /* owned */
    int64_t server_id;
    /* Buffers of answer_refused(). */
    struct scene_result scene;
    struct definition definition;
};

/* Set all fields of a result except the contents of the arrays of a scene and a definition. With a
 * status other than FMB_OK, the detail is its text. */
void answerer_begin_pair(const struct answerer *answerer, const struct pair_query *query,
                         enum fmb_status status, struct pair_result *result);
void answerer_begin_scene(const struct answerer *answerer, const struct query_header *query,
                          enum fmb_status status, struct scene_result *result);
void answerer_begin_definition(const struct answerer *answerer, const struct query_header *query,
                               enum fmb_status status, struct definition *result);

#endif
