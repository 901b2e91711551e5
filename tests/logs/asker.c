#include "asker.h"

/* Whole, or by key where one is known. The numbers stay in the frame all the same. */
static void name_frame(const struct asker *asker, struct query_frame *frame)
{
    const int64_t id = frame->body_id;
    frame->key = id >= 1 && id <= ASKER_BODIES_MAX ? asker->key[id] : 0;
    frame->components.count =
        frame->key ? 0 : fmb_component_count(frame->dim, frame->shape) * frame->dim;
}

/* Keys are told of bodies that came whole or by a key that is held. */
static void learn(struct asker *asker, int64_t body_id, int64_t key)
{
    if (body_id >= 1 && body_id <= ASKER_BODIES_MAX)
        asker->key[body_id] = key;
}

void asker_forget(struct asker *asker, int64_t body_id)
{
    asker->key[body_id] = 0;
}

static void ask_pair(struct asker *asker, struct pair_query *query, struct pair_result *result)
{
    query->client_id = asker->client_id;
    query->sequence_number = asker->next_number++;
    for (int f = 0; f < 2; f++)
        name_frame(asker, &query->frame[f]);
    instance_ask_pair(asker->instance, query, result);
    if (result->status == FMB_OK || result->status == FMB_UNKNOWN_BODY)
        for (int f = 0; f < 2; f++)
            learn(asker, query->frame[f].body_id, result->key[f]);
}

void asker_pair(struct asker *asker, struct pair_query *query, struct pair_result *result)
{
    ask_pair(asker, query, result);
    if (result->status == FMB_UNKNOWN_BODY)
        ask_pair(asker, query, result);
}

static void ask_scene(struct asker *asker, struct scene_query *query, struct scene_result *result)
{
    query->client_id = asker->client_id;
    query->sequence_number = asker->next_number++;
    for (int32_t i = 0; i < query->frame_count; i++)
        name_frame(asker, &query->frame[i]);
    instance_ask_scene(asker->instance, query, result);
    for (int32_t i = 0; i < result->key_count; i++)
        learn(asker, query->frame[i].body_id, result->key[i]);
}

void asker_scene(struct asker *asker, struct scene_query *query, struct scene_result *result)
{
    ask_scene(asker, query, result);
    if (result->status == FMB_UNKNOWN_BODY)
        ask_scene(asker, query, result);
}
