#include "log_client.h"

#include "parts.h"

static bool is_own(int64_t body_id)
{
    return body_id >= 1 && body_id <= LOG_CLIENT_BODIES_MAX;
}

void log_client_name(const struct log_client *log_client, struct query_placement *placement)
{
    const int64_t id = placement->placed.id;
    if (is_own(id) && !handle_is_none(&log_client->handle[id]))
        part_by_handle(placement, &log_client->handle[id]);
}

void log_client_forget(struct log_client *log_client, int64_t body_id)
{
    log_client->handle[body_id] = (struct handle){{0}};
}

static void forget_placement(struct log_client *log_client, const struct query_placement *placement)
{
    if (is_own(placement->placed.id))
        log_client_forget(log_client, placement->placed.id);
}

static void send_pair(struct log_client *log_client, struct pair_query *query,
                      struct pair_result *result)
{
    query->client_id = log_client->client_id;
    query->sequence_number = log_client->next_number++;
    for (int p = 0; p < 2; p++)
        log_client_name(log_client, &query->placement[p]);
    instance_query_pair(log_client->instance, query, result);
    for (int p = 0; p < 2; p++)
        if (is_own(result->body_id[p]) && !handle_is_none(&result->handle[p]))
            log_client->handle[result->body_id[p]] = result->handle[p];
}

void log_client_pair(struct log_client *log_client, struct pair_query *query,
                     struct pair_result *result)
{
    const struct pair_query whole = *query;
    send_pair(log_client, query, result);
    if (result->status != FMB_UNKNOWN_BODY)
        return;
    *query = whole;
    for (int p = 0; p < 2; p++)
        forget_placement(log_client, &query->placement[p]);
    send_pair(log_client, query, result);
}

static void send_scene(struct log_client *log_client, const struct scene_query *query,
                       struct scene_result *result)
{
    static struct scene_query sent;
    sent = *query;
    sent.client_id = log_client->client_id;
    sent.sequence_number = log_client->next_number++;
    for (int32_t i = 0; i < sent.placement_count; i++)
        log_client_name(log_client, &sent.placement[i]);
    instance_query_scene(log_client->instance, &sent, result);
    for (int32_t i = 0, next = 0; i < sent.placement_count && next < result->handle_count; i++) {
        const int64_t id = sent.placement[i].placed.id;
        if (id != 0 && !query_by_handle(&sent.placement[i])) {
            if (is_own(id))
                log_client->handle[id] = result->handle[next];
            next++;
        }
    }
}

void log_client_scene(struct log_client *log_client, const struct scene_query *query,
                      struct scene_result *result)
{
    send_scene(log_client, query, result);
    if (result->status != FMB_UNKNOWN_BODY)
        return;
    for (int32_t i = 0; i < result->unknown_count; i++)
        forget_placement(log_client, &query->placement[result->unknown[i]]);
    send_scene(log_client, query, result);
}
