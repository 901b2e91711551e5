#include "asker.h"

#include "parts.h"

static bool is_own(int64_t body_id)
{
    return body_id >= 1 && body_id <= ASKER_BODIES_MAX;
}

void asker_name(const struct asker *asker, struct placement *placement)
{
    const int64_t id = placement->body_id;
    if (is_own(id) && !handle_is_none(&asker->handle[id]))
        part_by_handle(placement, &asker->handle[id]);
}

void asker_forget(struct asker *asker, int64_t body_id)
{
    asker->handle[body_id] = (struct handle){{0}};
}

static void forget_placement(struct asker *asker, const struct placement *placement)
{
    if (is_own(placement->body_id))
        asker_forget(asker, placement->body_id);
}

static void ask_pair(struct asker *asker, struct pair_query *query, struct pair_result *result)
{
    query->client_id = asker->client_id;
    query->sequence_number = asker->next_number++;
    for (int p = 0; p < 2; p++)
        asker_name(asker, &query->placement[p]);
    instance_ask_pair(asker->instance, query, result);
    for (int p = 0; p < 2; p++)
        if (is_own(result->body_id[p]) && !handle_is_none(&result->handle[p]))
            asker->handle[result->body_id[p]] = result->handle[p];
}

void asker_pair(struct asker *asker, struct pair_query *query, struct pair_result *result)
{
    const struct pair_query whole = *query;
    ask_pair(asker, query, result);
    if (result->status != FMB_UNKNOWN_BODY)
        return;
    *query = whole;
    for (int p = 0; p < 2; p++)
        forget_placement(asker, &query->placement[p]);
    ask_pair(asker, query, result);
}

static void ask_scene(struct asker *asker, const struct scene_query *query,
                      struct scene_result *result)
{
    static struct scene_query sent;
    sent = *query;
    sent.client_id = asker->client_id;
    sent.sequence_number = asker->next_number++;
    for (int32_t i = 0; i < sent.placement_count; i++)
        asker_name(asker, &sent.placement[i]);
    instance_ask_scene(asker->instance, &sent, result);
    for (int32_t i = 0, next = 0; i < sent.placement_count && next < result->handle_count; i++) {
        const int64_t id = sent.placement[i].body_id;
        if (id != 0 && !placement_by_handle(&sent.placement[i])) {
            if (is_own(id))
                asker->handle[id] = result->handle[next];
            next++;
        }
    }
}

void asker_scene(struct asker *asker, const struct scene_query *query, struct scene_result *result)
{
    ask_scene(asker, query, result);
    if (result->status != FMB_UNKNOWN_BODY)
        return;
    for (int32_t i = 0; i < result->unknown_count; i++)
        forget_placement(asker, &query->placement[result->unknown[i]]);
    ask_scene(asker, query, result);
}
