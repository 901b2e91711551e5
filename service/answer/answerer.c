#include "answerer.h"

#include "wire.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct answerer *answerer_create(const struct answerer_options *options)
{
    struct answerer *answerer = malloc(sizeof *answerer);
    if (!answerer)
        return NULL;
    answerer->server_id = options->server_id;
    answerer->cache = cache_create(options->frames, options->secret);
    if (!answerer->cache) {
        free(answerer);
        return NULL;
    }
    return answerer;
}

void answerer_destroy(struct answerer *answerer)
{
    if (!answerer)
        return;
    cache_destroy(answerer->cache);
    free(answerer);
}

struct cache *answerer_cache(struct answerer *answerer)
{
    return answerer->cache;
}

/* ---- Results ---- */

void answerer_begin(const struct answerer *answerer, const struct query_header *query,
                    enum fmb_status status, struct result_head *out, size_t size)
{
    memset(out, 0, size);
    out->header = *query;
    out->server_id = answerer->server_id;
    out->status = (int32_t) status;
    if (status != FMB_OK)
        snprintf(out->detail, sizeof out->detail, "%s", fmb_status_text(out->status));
}

void answerer_begin_pair(const struct answerer *answerer, const struct pair_query *query,
                         enum fmb_status status, struct pair_result *result)
{
    answerer_begin(answerer, &query->header, status, &result->head, sizeof *result);
    for (int f = 0; f < 2; f++)
        result->body_id[f] = query->placement[f].placed.id;
}

/* ---- Refusals ---- */

const char *answer_refused(struct answerer *answerer, enum answer_kind kind,
                           const unsigned char *bytes, size_t size, enum fmb_status status,
                           unsigned char out[QUERY_BYTES_MAX], size_t *out_size)
{
    struct pair_query pair;
    struct pair_result result;
    const char *error = kind == ANSWER_PAIR ? wire_read_pair_query(bytes, (uint32_t) size, &pair)
                        : kind == ANSWER_SCENE
                            ? wire_read_scene_header(bytes, (uint32_t) size, &pair.header)
                            : wire_read_definition_header(bytes, (uint32_t) size, &pair.header);
    if (error)
        return error;
    if (kind == ANSWER_PAIR) {
        answerer_begin_pair(answerer, &pair, status, &result);
        *out_size = wire_write_pair_result(&result, out);
    } else if (kind == ANSWER_SCENE) {
        answerer_begin(answerer, &pair.header, status, &answerer->scene.head, SCENE_HEAD_BYTES);
        *out_size = wire_write_scene_result(&answerer->scene, out);
    } else {
        answerer_begin(answerer, &pair.header, status, &answerer->definition.head,
                       DEFINITION_HEAD_BYTES);
        *out_size = wire_write_definition(&answerer->definition, out);
    }
    return NULL;
}
