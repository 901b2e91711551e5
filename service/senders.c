#include "senders.h"

/* A client may stand in one set of places; the least recently used of them makes room. */
static struct sender *find(struct senders *senders, int64_t client_id)
{
    uint64_t hash = (uint64_t) client_id * UINT64_C(0x9e3779b97f4a7c15);
    struct sender *set = senders->sender[(hash >> 32) % SENDERS_SETS];
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

void senders_note(struct senders *senders, int64_t client_id, int64_t sequence_number)
{
    struct sender *sender = find(senders, client_id);
    if (!sender->used_at) {
        sender->client_id = client_id;
        sender->last = sequence_number;
    } else if (sequence_number <= sender->last) {
        senders->repeated++;
    } else {
        int64_t skipped = sequence_number - sender->last - 1;
        int64_t room = SENDERS_GAPS_MAX - senders->gaps;
        senders->gaps += skipped < room ? skipped : room;
        sender->last = sequence_number;
    }
    sender->used_at = ++senders->now;
}
