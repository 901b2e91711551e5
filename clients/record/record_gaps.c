#include "record_gaps.h"

#include "query.h"

#include <stdbool.h>
#include <string.h>

/* A client may stand in one set of places; where it does not, the least recently used is freed. */
static struct gaps_client *find_or_free(struct gaps *gaps, int64_t client_id)
{
    struct gaps_client *set = gaps->client[query_id_hash(client_id) % GAPS_SETS];
    struct gaps_client *oldest = set;
    for (int way = 0; way < GAPS_WAYS; way++) {
        if (set[way].used_at && set[way].client_id == client_id)
            return &set[way];
        if (set[way].used_at < oldest->used_at)
            oldest = &set[way];
    }
    oldest->used_at = 0;
    return oldest;
}

static bool is_seen(const struct gaps_client *client, int64_t number)
{
    return client->seen[number % GAPS_WINDOW / 64] >> number % 64 & 1;
}

static void set_seen(struct gaps_client *client, int64_t number, bool seen)
{
    uint64_t *word = &client->seen[number % GAPS_WINDOW / 64], bit = UINT64_C(1) << number % 64;
    *word = seen ? *word | bit : *word & ~bit;
}

/* All between the last one and this one are missing, until they come. */
static void advance(struct gaps *gaps, struct gaps_client *client, int64_t number)
{
    const int64_t skipped = number - client->last - 1, room = GAPS_MAX - gaps->missing;
    gaps->missing += skipped < room ? skipped : room;
    if (skipped >= GAPS_WINDOW)
        memset(client->seen, 0, sizeof client->seen);
    else
        for (int64_t i = client->last + 1; i < number; i++)
            set_seen(client, i, false);
    client->last = number;
}

void gaps_note(struct gaps *gaps, int64_t client_id, int64_t sequence_number)
{
    struct gaps_client *client = find_or_free(gaps, client_id);
    if (!client->used_at)
        *client = (struct gaps_client){
            .client_id = client_id, .first = sequence_number, .last = sequence_number};
    client->used_at = ++gaps->now;
    if (sequence_number > client->last)
        advance(gaps, client, sequence_number);
    else if (sequence_number < client->first || client->last - sequence_number >= GAPS_WINDOW)
        return; /* from before the beginning, or asked again, or counted as missing for good */
    else if (sequence_number < client->last && !is_seen(client, sequence_number))
        gaps->missing--;
    set_seen(client, sequence_number, true);
}
