#include "logged_query.h"

#include "wire.h"

#include <string.h>

static const char *read_header(struct logged_query *out, const unsigned char *bytes, uint32_t size)
{
    if (out->kind == LOG_PAIR_QUERY) {
        memset(&out->pair, 0, sizeof out->pair);
        return wire_read_pair_header(bytes, size, &out->pair.header);
    }
    memset(&out->scene, 0, sizeof out->scene);
    return wire_read_scene_header(bytes, size, &out->scene.header);
}

const char *logged_query_read(struct logged_query *out, enum log_kind kind,
                              const unsigned char *bytes, uint32_t size)
{
    out->kind = kind;
    if (size > QUERY_BYTES_MAX)
        return read_header(out, bytes, size);
    return kind == LOG_PAIR_QUERY ? wire_read_pair_query(bytes, size, &out->pair)
                                  : wire_read_scene_query(bytes, size, &out->scene);
}

static int32_t least(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

struct placement *logged_query_placements(struct logged_query *query, int32_t *count)
{
    *count = query->kind == LOG_PAIR_QUERY
                 ? 2
                 : least(query->scene.placement_count, QUERY_PLACEMENTS_MAX);
    return query->kind == LOG_PAIR_QUERY ? query->pair.placement : query->scene.placement;
}

static bool placements_are_whole(const struct placement *placement, int32_t count)
{
    for (int32_t i = 0; i < count; i++)
        if (placement[i].dim > FMB_DIM_MAX ||
            placement[i].orientation_count > QUERY_ORIENTATION_MAX ||
            placement[i].velocity_count > FMB_DIM_MAX)
            return false;
    return true;
}

static bool is_whole(const struct logged_query *query)
{
    const struct scene_query *scene = &query->scene;
    if (query->kind == LOG_PAIR_QUERY)
        return placements_are_whole(query->pair.placement, 2);
    return scene->placement_count <= QUERY_PLACEMENTS_MAX &&
           scene->index_count <= 2 * QUERY_PAIRS_MAX &&
           scene->ignored_count <= 2 * QUERY_PAIRS_MAX &&
           placements_are_whole(scene->placement, scene->placement_count);
}

static size_t bytes_of(const struct logged_query *query)
{
    const bool pair = query->kind == LOG_PAIR_QUERY;
    const struct placement *placement = pair ? query->pair.placement : query->scene.placement;
    const int32_t count = pair ? 2 : query->scene.placement_count;
    size_t bytes = pair ? WIRE_PAIR_QUERY_BYTES : WIRE_SCENE_QUERY_BYTES;
    for (int32_t i = 0; i < count; i++)
        bytes += wire_placement_bytes(&placement[i]);
    if (!pair)
        bytes += WIRE_PAIR_BYTES / 2 *
                 ((size_t) query->scene.index_count + (size_t) query->scene.ignored_count);
    return bytes;
}

size_t logged_query_write(const struct logged_query *query, unsigned char out[QUERY_BYTES_MAX])
{
    if (!is_whole(query) || bytes_of(query) > QUERY_BYTES_MAX)
        return 0;
    return query->kind == LOG_PAIR_QUERY ? wire_write_pair_query(&query->pair, out)
                                         : wire_write_scene_query(&query->scene, out);
}

/* The number of placements in the struct. */
static int64_t placement_count(const struct scene_query *query)
{
    return query->placement_count < QUERY_PLACEMENTS_MAX ? query->placement_count
                                                         : QUERY_PLACEMENTS_MAX;
}

int64_t logged_query_pairs(const struct scene_query *query)
{
    const int64_t n = placement_count(query);
    if (query->which == QUERY_PAIRS_LISTED)
        return query->index_count / 2;
    return query->which == QUERY_PAIRS_ACROSS ? query->split * (n - query->split) : n * (n - 1) / 2;
}

int64_t logged_query_pair_number(const struct scene_query *query, unsigned a, unsigned b)
{
    const int64_t n = placement_count(query), first = a, second = b;
    if (query->which == QUERY_PAIRS_ACROSS)
        return first * (n - query->split) + second - query->split;
    return first * n - first * (first + 1) / 2 + second - (first + 1);
}
