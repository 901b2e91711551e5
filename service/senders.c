#include "senders.h"

#include "query.h"

/* A client may stand in one set of places. Where it does not, the least recently used of them
 * is freed for it. */
static struct sender *find_or_free(struct senders *senders, int64_t client_id)
{
    struct sender *set = senders->sender[query_id_hash(client_id) % SENDERS_SETS];
    struct sender *oldest = set;
    for (int way = 0; way < SENDERS_WAYS; way++) {
        if (set[way].used_at && set[way].client_id == client_id)
            return &set[way];
        if (set[way].used_at < oldest->used_at)
            oldest = &set[way];
    }
    oldest->used_at = 0;
    return oldest;
}

static void add(int64_t *gaps, int64_t skipped)
{
    const int64_t room = SENDERS_GAPS_MAX - *gaps;
    *gaps += skipped < room ? skipped : room;
}

void senders_note(struct senders *senders, int64_t client_id, int64_t sequence_number)
{
    struct sender *sender = find_or_free(senders, client_id);
    if (!sender->used_at) {
        sender->client_id = client_id;
        sender->last = sequence_number;
        sender->gaps = 0;
    } else if (sequence_number <= sender->last) {
        senders->repeated++;
    } else {
        const int64_t skipped = sequence_number - sender->last - 1;
        add(&sender->gaps, skipped);
        add(&senders->gaps, skipped);
        sender->last = sequence_number;
    }
    sender->used_at = ++senders->now;
}

int64_t senders_gaps(const struct senders *senders, int64_t client_id)
{
    const struct sender *set = senders->sender[query_id_hash(client_id) % SENDERS_SETS];
    for (int way = 0; way < SENDERS_WAYS; way++)
        if (set[way].used_at && set[way].client_id == client_id)
            return set[way].gaps;
    return 0;
}
