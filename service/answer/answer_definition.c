#include "answerer.h"

#include "check.h"
#include "wire.h"

#include <assert.h>
#include <stdio.h>

static bool check_definition_query(struct checking *checking, const struct definition_query *query)
{
    if (!check_ids(checking, query->client_id, query->sequence_number))
        return false;
    if (query->handle_count > QUERY_HANDLES_MAX)
        return check_refuse(checking, FMB_OVER_LIMIT, "num_handle_bytes",
                            "more than one datagram has");
    if (query->first < 0 || (query->handle_count > 0 && query->first > query->handle_count))
        return check_refuse(checking, FMB_OVER_LIMIT, "first", "there are not so many");
    return true;
}

/* The next body that was requested; NULL: there are no more. *position is advanced beyond it. */
static const struct cached *next_body(const struct cache *cache,
                                      const struct definition_query *query, int64_t *position)
{
    if (query->handle_count == 0)
        return cache_next(cache, position);
    while (*position < query->handle_count) {
        const struct cached *cached = cache_peek(cache, &query->handle[(*position)++]);
        if (cached)
            return cached;
    }
    return NULL;
}

/* Bytes of a page for bodies: where there are any, the detail is empty. */
enum { PAGE_BYTES = QUERY_BYTES_MAX - WIRE_DEFINITION_BYTES + QUERY_TEXT_MAX - 1 };

/* The largest body came as the only placement of a scene, in 2D at rest. */
static_assert(PAGE_BYTES - HANDLE_BYTES >= QUERY_BYTES_MAX - WIRE_SCENE_QUERY_BYTES -
                                               (QUERY_PLACEMENT_BYTES_MIN - GEOMETRY_NONE_BYTES),
              "a page has space for any body");

static void append_bodies(const struct cache *cache, const struct definition_query *query,
                          struct definition *result)
{
    size_t capacity = PAGE_BYTES;
    int64_t position = query->first, here = position;
    for (const struct cached *cached; (cached = next_body(cache, query, &position));
         here = position) {
        const size_t size = HANDLE_BYTES + cached->geometry.size;
        if (size > capacity || result->body_count == QUERY_BODIES_MAX) {
            result->next = here;
            return;
        }
        capacity -= size;
        result->body[result->body_count++] = (struct query_body){cached->handle, cached->geometry};
    }
}

/* The array of the result stays as it is. */
static void begin_result(const struct answerer *answerer, const struct query_header *query,
                         struct definition *result)
{
    result->header = *query;
    result->server_id = answerer->server_id;
    result->status = FMB_OK;
    result->detail[0] = '\0';
    result->next = 0;
    result->body_count = 0;
}

void answer_definition(struct answerer *answerer, const struct definition_query *query,
                       struct definition *result)
{
    struct checking checking = {.status = &result->status, .detail = result->detail};
    begin_result(answerer, &query->header, result);
    if (check_definition_query(&checking, query))
        append_bodies(answerer->cache, query, result);
}

void answer_definition_refused(const struct answerer *answerer, const struct query_header *query,
                               enum fmb_status status, struct definition *result)
{
    begin_result(answerer, query, result);
    result->status = (int32_t) status;
    snprintf(result->detail, sizeof result->detail, "%s", fmb_status_text(result->status));
}
