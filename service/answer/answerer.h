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

/* Set all fields of a result except the contents of the arrays of a scene and a definition. */
void answerer_begin_pair(const struct answerer *answerer, const struct pair_query *query,
                         struct pair_result *result);
void answerer_begin_scene(const struct answerer *answerer, const struct query_header *query,
                          struct scene_result *result);
void answerer_begin_definition(const struct answerer *answerer, const struct query_header *query,
                               struct definition *result);

/* Sets a status, and its text as the detail. */
void answerer_set_status(enum fmb_status status, int32_t *out, char detail[QUERY_TEXT_MAX]);

#endif
