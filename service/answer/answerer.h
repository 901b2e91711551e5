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

/* Bytes of the results of scenes and definitions without their arrays. */
enum {
    SCENE_HEAD_BYTES = offsetof(struct scene_result, unknown),
    DEFINITION_HEAD_BYTES = offsetof(struct definition, body)
};

/* Clears the first `size` bytes of a result, and fills in its head. With a status other than
 * FMB_OK, the detail is its text. */
void answerer_begin(const struct answerer *answerer, const struct query_header *query,
                    enum fmb_status status, struct result_head *out, size_t size);

/* The same for a pair: also sets the ids of the bodies. */
void answerer_begin_pair(const struct answerer *answerer, const struct pair_query *query,
                         enum fmb_status status, struct pair_result *result);

#endif
