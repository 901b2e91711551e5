/* Pairs the queries of two recordings of the same scenes by different clients.
 *
 * In: the queries and results that have no counterpart by client id and sequence number. A client
 * with any such counterpart is not paired: its other queries have none.
 *
 * Steps:
 *   1. note_matched()   the clients that are not paired
 *   2. pair_queries()   numbers the clients of the replayed logs by first appearance, and the
 *                       queries of a client within their group (type, label, first pair; for
 *                       pairs, the ids of both bodies). Repeated queries, with the same ids,
 *                       count as one query with several times. Then it numbers the queries
 *                       of the golden log in the same way: equal numbers are a pair. A golden
 *                       log without queries has only the types of its results: then the group
 *                       is the type, on both sides
 *   3. rename_results() gives each golden result the key of the query that its own query is paired
 *                       with; for a repeated query, the key of the same repeat. So match_all()
 *                       matches the result as if it were recorded with that query */
#include "replay_parts.h"

#include "keyed_hash.h"

#include <stdlib.h>
#include <string.h>

/* What an entry of the table is about, and its key. */
enum pair_kind {
    PAIR_CLIENT, /* a client: its id */
    PAIR_IDS,    /* a query, or a result without queries: kind, client id, sequence number */
    PAIR_TIME,   /* a repeat of such a query or result: the same, and its time */
    PAIR_SENT,   /* a repeat in the replayed logs: as IDS, and the number of its time */
    PAIR_GROUP,  /* the queries of a client and group: number of the client, group */
    PAIR_QUERY   /* a query of the replayed logs: numbers of client and query, group */
};

struct pair_key {
    int64_t kind, golden; /* enum pair_kind; 1: of the golden log */
    int64_t number[4];
    struct handle group;
};

struct pair_entry {
    struct pair_key key;
    /* CLIENT: its number, from 1, or MATCHED; TIME: its number, from 2; GROUP: number of queries;
     * IDS: number of times. */
    int64_t count;
    int64_t utime;            /* IDS: the first time */
    struct match_item *query; /* QUERY, SENT: the query; IDS of the golden log: its counterpart */
    UT_hash_handle hh;
};

enum { MATCHED = -1 };

struct pairing {
    struct replay *replay;
    struct pair_entry *table;
    int64_t clients[2]; /* how many: of the replayed logs, of the golden log */
};

/* The entry of a key, which is added if there is none. */
static struct pair_entry *entry_of(struct pairing *pairing, struct pair_key key)
{
    struct pair_entry *entry = NULL;
    HASH_FIND(hh, pairing->table, &key, sizeof key, entry);
    if (entry)
        return entry;
    entry = allocate(1, sizeof *entry);
    entry->key = key;
    HASH_ADD(hh, pairing->table, key, sizeof entry->key, entry);
    return entry;
}

static struct pair_entry *client_of(struct pairing *pairing, bool golden, int64_t client_id)
{
    return entry_of(pairing, (struct pair_key){PAIR_CLIENT, golden, {client_id}, {{0}}});
}

/* last: for IDS 0, for TIME the time, for SENT the number of the time. */
static struct pair_entry *entry_of_ids(struct pairing *pairing, enum pair_kind what, bool golden,
                                       const struct match_key *key, int64_t last)
{
    const int64_t client_id = key->client_id, number = key->sequence_number;
    return entry_of(pairing,
                    (struct pair_key){what, golden, {key->kind, client_id, number, last}, {{0}}});
}

static struct pair_entry *ids_of(struct pairing *pairing, bool golden, const struct match_key *key)
{
    return entry_of_ids(pairing, PAIR_IDS, golden, key, 0);
}

static void note_matched(struct pairing *pairing)
{
    const struct match *match = &pairing->replay->match;
    for (size_t i = 0; i < match->count; i++)
        for (int golden = 0; match->item[i].other && golden < 2; golden++)
            client_of(pairing, golden, match->item[i].key.client_id)->count = MATCHED;
}

/* The group of a query; NULL: of results without queries. A label is in a query of at most
 * QUERY_BYTES_MAX, whose other fields are longer than the numbers: replay->whole holds both. */
static struct handle group_of(struct replay *replay, int64_t kind, const struct logged_query *query)
{
    unsigned char *out = replay->whole;
    const char *label = "";
    int64_t number[3] = {kind};
    if (query && kind == LOG_PAIR_QUERY) {
        number[1] = query->pair.placement[0].placed.id;
        number[2] = query->pair.placement[1].placed.id;
    } else if (query) {
        number[1] = query->scene.first_pair;
        label = query->scene.label ? query->scene.label : "";
    }
    memcpy(out, number, sizeof number);
    strcpy((char *) out + sizeof number, label);
    return handle_of(out, sizeof number + strlen(label));
}

/* Numbers the times at which a query was sent again. */
static void add_repeat(struct pairing *pairing, struct match_item *item, bool golden,
                       struct pair_entry *ids)
{
    const struct match_key *key = &item->key;
    if (key->utime == ids->utime)
        return;
    struct pair_entry *time = entry_of_ids(pairing, PAIR_TIME, golden, key, key->utime);
    if (time->count > 0)
        return;
    time->count = ++ids->count;
    if (!golden)
        entry_of_ids(pairing, PAIR_SENT, false, key, time->count)->query = item;
}

static void pair_item(struct pairing *pairing, struct match_item *item, bool golden, bool by_type)
{
    struct replay *replay = pairing->replay;
    uint32_t size;
    struct pair_entry *client = client_of(pairing, golden, item->key.client_id);
    if (item->unreadable || client->count == MATCHED)
        return;
    struct pair_entry *ids = ids_of(pairing, golden, &item->key);
    if (ids->count > 0) {
        add_repeat(pairing, item, golden, ids);
        return;
    }
    ids->count = 1;
    ids->utime = item->key.utime;
    if (!by_type && !replay_read_query(replay, &replay->rereader, item, replay->query_bytes, &size,
                                       &replay->query))
        return;
    if (client->count == 0)
        client->count = ++pairing->clients[golden];
    struct pair_key key = {PAIR_GROUP,
                           golden,
                           {client->count},
                           group_of(replay, item->key.kind, by_type ? NULL : &replay->query)};
    key.number[1] = entry_of(pairing, key)->count++;
    key.kind = PAIR_QUERY;
    key.golden = false;
    struct pair_entry *pair = entry_of(pairing, key);
    if (!golden)
        pair->query = item;
    ids->query = pair->query;
    item->left_over = !golden || !pair->query;
    if (golden && pair->query)
        pair->query->left_over = false;
}

static void pair_items(struct pairing *pairing, struct match *match, bool results, bool golden,
                       bool by_type)
{
    const int logs = pairing->replay->options->log_count;
    for (size_t i = 0; i < match->count; i++) {
        struct match_item *item = &match->item[i];
        if (item->is_result == results && (item->place.log == logs) == golden)
            pair_item(pairing, item, golden, by_type);
    }
}

static void pair_queries(struct pairing *pairing)
{
    struct replay *replay = pairing->replay;
    bool by_type = true;
    for (size_t i = 0; i < replay->golden.count; i++)
        by_type = by_type && replay->golden.item[i].is_result;
    pair_items(pairing, &replay->match, false, false, by_type);
    pair_items(pairing, by_type ? &replay->match : &replay->golden, by_type, true, by_type);
}

static void rename_results(struct pairing *pairing)
{
    struct match *match = &pairing->replay->match;
    for (size_t i = 0; i < match->count; i++) {
        struct match_item *item = &match->item[i];
        if (!item->is_result || item->other)
            continue;
        const struct pair_entry *ids = ids_of(pairing, true, &item->key);
        if (!ids->query)
            continue;
        const struct match_item *query = ids->query;
        if (item->key.utime != ids->utime) {
            const int64_t number =
                entry_of_ids(pairing, PAIR_TIME, true, &item->key, item->key.utime)->count;
            const struct pair_entry *sent =
                entry_of_ids(pairing, PAIR_SENT, false, &query->key, number);
            query = sent->query ? sent->query : query;
        }
        item->key = query->key;
        item->by_order = true;
    }
}

/* Counts and reports the queries, and results without queries, that only one recording has. */
static void report_left_over(struct replay *replay, const struct match *match)
{
    for (size_t i = 0; i < match->count; i++) {
        const struct match_item *item = &match->item[i];
        if (!item->left_over)
            continue;
        replay_channel(replay, item)->left_over++;
        replay_report(replay, item, "has no counterpart in the other recording");
    }
}

void replay_pair_clients(struct replay *replay)
{
    struct pairing pairing = {.replay = replay};
    note_matched(&pairing);
    pair_queries(&pairing);
    rename_results(&pairing);
    HASH_FREE(pairing.table);
    match_all(&replay->match);
    report_left_over(replay, &replay->match);
    report_left_over(replay, &replay->golden);
}
