/* Answers definition queries: pages of bodies that the cache holds. */
#include "answerer.h"

#include "check.h"
#include "wire.h"

#include <assert.h>

static bool check_definition_query(struct check_context *context,
                                   const struct definition_query *query)
{
    if (!check_ids(context, query->client_id, query->sequence_number))
        return false;
    if (query->handle_count > QUERY_HANDLES_MAX)
        return check_refuse(context, FMB_OVER_LIMIT, "num_handle_bytes",
                            "more than one datagram has");
    if (query->first < 0 || (query->handle_count > 0 && query->first > query->handle_count))
        return check_refuse(context, FMB_OVER_LIMIT, "first", "there are not so many");
    return true;
}

/* Returns the next requested body that is held, at or after *position, and sets *position to the
 * one after it; NULL: there are no more. */
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

/* Bytes of a result that are available for bodies. The detail is then empty. */
enum { PAGE_BYTES = QUERY_BYTES_MAX - WIRE_DEFINITION_BYTES + QUERY_TEXT_MAX - 1 };

/* The largest body is one that was defined by the only placement of a scene, in 2D at rest. */
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
        const size_t size = HANDLE_BYTES + cached->view.size;
        if (size > capacity || result->body_count == QUERY_BODIES_MAX) {
            result->next = here;
            return;
        }
        capacity -= size;
        result->body[result->body_count++] = cached->view;
    }
}

void answer_definition(struct answerer *answerer, const struct definition_query *query,
                       struct definition *result)
{
    struct check_context context = {&result->head, false, -1};
    answerer_begin(answerer, &query->header, FMB_OK, &result->head, DEFINITION_HEAD_BYTES);
    if (check_definition_query(&context, query))
        append_bodies(answerer->cache, query, result);
}
