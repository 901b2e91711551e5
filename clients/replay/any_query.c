#include "any_query.h"

#include "wire.h"

_Static_assert((int) WIRE_BYTES_MAX <= (int) QUERY_BYTES_MAX, "every pair fits");

const char *any_query_read(struct any_query *out, enum log_kind kind, const unsigned char *bytes,
                           size_t size)
{
    out->kind = kind;
    return kind == LOG_PAIR_QUERY ? wire_read_pair_query(bytes, (uint32_t) size, &out->pair)
                                  : wire_read_scene_query(bytes, (uint32_t) size, &out->scene);
}

struct query_frame *any_query_frames(struct any_query *query, int32_t *count)
{
    if (query->kind == LOG_PAIR_QUERY) {
        *count = 2;
        return query->pair.frame;
    }
    *count =
        query->scene.frame_count < QUERY_FRAMES_MAX ? query->scene.frame_count : QUERY_FRAMES_MAX;
    return query->scene.frame;
}

static bool frame_is_whole(const struct query_frame *frame)
{
    return frame->origin.count <= FMB_COMPONENTS_MAX &&
           frame->components.count <= FMB_COMPONENTS_MAX &&
           frame->velocity.count <= FMB_COMPONENTS_MAX;
}

static bool frames_are_whole(const struct query_frame *frame, int32_t count)
{
    for (int32_t i = 0; i < count; i++)
        if (!frame_is_whole(&frame[i]))
            return false;
    return true;
}

bool any_query_is_whole(const struct any_query *query)
{
    const struct scene_query *scene = &query->scene;
    if (query->kind == LOG_PAIR_QUERY)
        return frames_are_whole(query->pair.frame, 2);
    return scene->frame_count <= QUERY_FRAMES_MAX && scene->index_count <= 2 * QUERY_PAIRS_MAX &&
           frames_are_whole(scene->frame, scene->frame_count);
}

static size_t scene_bytes(const struct scene_query *scene)
{
    size_t bytes = WIRE_SCENE_QUERY_BYTES + sizeof(int16_t) * (size_t) scene->index_count;
    for (int32_t i = 0; i < scene->frame_count; i++)
        bytes += wire_frame_bytes(&scene->frame[i]);
    return bytes;
}

size_t any_query_write(const struct any_query *query, unsigned char out[QUERY_BYTES_MAX])
{
    if (query->kind == LOG_PAIR_QUERY)
        return wire_write_pair_query(&query->pair, out);
    return scene_bytes(&query->scene) > QUERY_BYTES_MAX
               ? 0
               : wire_write_scene_query(&query->scene, out);
}
