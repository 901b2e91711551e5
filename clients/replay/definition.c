#include "definition.h"

#include "wire.h"

#include <string.h>

static bool defines(const struct query_frame *frame)
{
    return frame->body_id > 0 && frame->key != 0 && frame->components.count > 0;
}

bool definition_is(const struct scene_query *query)
{
    if (query->client_id != DEFINITION_CLIENT || query->which != QUERY_PAIRS_LISTED ||
        query->index_count != 0 || query->frame_count < 1 || query->frame_count > QUERY_FRAMES_MAX)
        return false;
    for (int32_t i = 0; i < query->frame_count; i++)
        if (!defines(&query->frame[i]))
            return false;
    return true;
}

static void learn_frame(const struct query_frame *frame, struct known_bodies *known, bool mine)
{
    struct known_body *body = known_bodies_find(known, frame->body_id, frame->key);
    if (body && known_bodies_same(body, frame)) {
        body->mine = body->mine || mine;
        return;
    }
    body = known_bodies_learn(known, frame, frame->key, 0);
    if (body)
        body->mine = mine;
}

void definition_learn(const struct scene_query *query, struct known_bodies *known, bool mine)
{
    for (int32_t i = 0; i < query->frame_count; i++)
        learn_frame(&query->frame[i], known, mine);
}

void definition_begin(struct scene_query *query)
{
    query->utime = query->sequence_number = 0;
    query->client_id = DEFINITION_CLIENT;
    query->duration = 0;
    query->method = query->want = 0;
    query->which = QUERY_PAIRS_LISTED;
    query->split = query->first_pair = 0;
    query->frame_count = query->index_count = 0;
}

static size_t bytes_of(const struct scene_query *query)
{
    size_t bytes = WIRE_SCENE_QUERY_BYTES;
    for (int32_t i = 0; i < query->frame_count; i++)
        bytes += wire_frame_bytes(&query->frame[i]);
    return bytes;
}

bool definition_add(struct scene_query *query, const struct query_frame *frame,
                    const struct query_numbers *components)
{
    struct query_frame added = {.body_id = frame->body_id,
                                .key = frame->key,
                                .shape = frame->shape,
                                .dim = frame->dim,
                                .origin = {.count = frame->dim},
                                .components = *components};
    if (query->frame_count == QUERY_FRAMES_MAX ||
        bytes_of(query) + wire_frame_bytes(&added) > QUERY_BYTES_MAX)
        return false;
    query->frame[query->frame_count++] = added;
    return true;
}
