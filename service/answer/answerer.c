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

void answerer_begin_pair(const struct answerer *answerer, const struct pair_query *query,
                         struct pair_result *result)
{
    memset(result, 0, sizeof *result);
    result->header = query->header;
    result->server_id = answerer->server_id;
    for (int f = 0; f < 2; f++)
        result->body_id[f] = query->placement[f].placed.id;
}

void answerer_begin_scene(const struct answerer *answerer, const struct query_header *query,
                          struct scene_result *result)
{
    memset(result, 0, offsetof(struct scene_result, unknown));
    result->header = *query;
    result->server_id = answerer->server_id;
}

void answerer_begin_definition(const struct answerer *answerer, const struct query_header *query,
                               struct definition *result)
{
    memset(result, 0, offsetof(struct definition, body));
    result->header = *query;
    result->server_id = answerer->server_id;
}

void answerer_set_status(enum fmb_status status, int32_t *out, char detail[QUERY_TEXT_MAX])
{
    *out = (int32_t) status;
    snprintf(detail, QUERY_TEXT_MAX, "%s", fmb_status_text(*out));
}

/* ---- Refusals ---- */

static size_t refuse_pair(const struct answerer *answerer, const struct pair_query *query,
                          enum fmb_status status, unsigned char out[QUERY_BYTES_MAX])
{
    struct pair_result result;
    answerer_begin_pair(answerer, query, &result);
    answerer_set_status(status, &result.status, result.detail);
    return wire_write_pair_result(&result, out);
}

static size_t refuse_scene(struct answerer *answerer, const struct query_header *query,
                           enum fmb_status status, unsigned char out[QUERY_BYTES_MAX])
{
    struct scene_result *result = &answerer->scene;
    answerer_begin_scene(answerer, query, result);
    answerer_set_status(status, &result->status, result->detail);
    return wire_write_scene_result(result, out);
}

static size_t refuse_definition(struct answerer *answerer, const struct query_header *query,
                                enum fmb_status status, unsigned char out[QUERY_BYTES_MAX])
{
    struct definition *result = &answerer->definition;
    answerer_begin_definition(answerer, query, result);
    answerer_set_status(status, &result->status, result->detail);
    return wire_write_definition(result, out);
}

const char *answer_refused(struct answerer *answerer, enum answer_kind kind,
                           const unsigned char *bytes, size_t size, enum fmb_status status,
                           unsigned char out[QUERY_BYTES_MAX], size_t *out_size)
{
    struct pair_query pair;
    const char *error = kind == ANSWER_PAIR ? wire_read_pair_query(bytes, (uint32_t) size, &pair)
                        : kind == ANSWER_SCENE
                            ? wire_read_scene_header(bytes, (uint32_t) size, &pair.header)
                            : wire_read_definition_header(bytes, (uint32_t) size, &pair.header);
    if (!error)
        *out_size = kind == ANSWER_PAIR    ? refuse_pair(answerer, &pair, status, out)
                    : kind == ANSWER_SCENE ? refuse_scene(answerer, &pair.header, status, out)
                                           : refuse_definition(answerer, &pair.header, status, out);
    return error;
}
