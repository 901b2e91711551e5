#include "record_answered.h"

/* Counts stay where sums of them cannot overflow: a heartbeat may say anything. */
#define PUBLISHED_MAX (INT64_C(1) << 53)

static struct answered_server *find_or_free(struct answered *answered, int64_t server_id)
{
    struct answered_server *oldest = answered->server;
    for (int i = 0; i < ANSWERED_SERVERS; i++) {
        struct answered_server *server = &answered->server[i];
        if (server->used_at && server->server_id == server_id)
            return server;
        if (server->used_at < oldest->used_at)
            oldest = server;
    }
    if (answered->forgotten < PUBLISHED_MAX)
        answered->forgotten += oldest->missing;
    *oldest = (struct answered_server){.server_id = server_id, .first = -1};
    return oldest;
}

void answered_result(struct answered *answered, int64_t server_id)
{
    struct answered_server *server = find_or_free(answered, server_id);
    server->used_at = ++answered->now;
    server->came += server->first >= 0;
}

/* What one heartbeat counts as missing because it was overtaken, the next one finds. */
void answered_heartbeat(struct answered *answered, int64_t server_id, int64_t published)
{
    if (published < 0 || published > PUBLISHED_MAX)
        return;
    struct answered_server *server = find_or_free(answered, server_id);
    server->used_at = ++answered->now;
    if (server->first < 0)
        server->first = published;
    const int64_t missing = published - server->first - server->came;
    server->missing = missing > 0 ? missing : 0;
}

int64_t answered_missing(const struct answered *answered)
{
    int64_t missing = answered->forgotten;
    for (int i = 0; i < ANSWERED_SERVERS; i++)
        missing += answered->server[i].missing;
    return missing;
}
