/* Pairs the queries of two recordings of the same scenes by different clients.
 *
 * In: the queries that have no result, and the results of the golden log that have no query, after
 * all matches by client id and sequence number. Clients with such a match are not paired: what is
 * left of them has no counterpart.
 *
 * Steps: 1. Number the queries of the replayed logs: their clients by first appearance, and the
 * queries of a client within their group (type, label, first pair; for pairs, the ids of both
 * bodies). Repeated queries, with the same ids, are one. 2. Number the queries of the golden log in
 * the same way. A golden log without queries has only the types of its results: then the group is
 * the type, on both sides. 3. Give each result the ids of the query with the number of its own
 * query, and match it as if it were recorded with that query. */
#include "replay_parts.h"

#include <stdlib.h>
#include <string.h>

/* An entry of a table: of clients (by id), of counts (by client and group), of queries of the
 * replayed logs (by client, group and number), or of the golden log (by type and ids). */
struct pair_key {
    int64_t number[3];
    struct handle group;
};

struct replay_pair {
    struct pair_key key;
    int64_t number;
    struct match_item *query;   /* while queries are paired; NULL: none */
    struct match_key query_key; /* of that query */
    UT_hash_handle hh;
};

/* The tables of one recording. */
struct recording {
    struct replay_pair *clients, *counts;
};

/* ---- Tables ---- */

static struct replay_pair *find(struct replay_pair *table, const struct pair_key *key)
{
    struct replay_pair *entry = NULL;
    if (table)
        HASH_FIND(hh, table, key, sizeof *key, entry);
    return entry;
}

/* The entry of a key, which is added if there is none: *is_new. Its number is that of earlier
 * entries. */
static struct replay_pair *take(struct replay_pair **table, const struct pair_key *key,
                                bool *is_new)
{
    struct replay_pair *entry = find(*table, key);
    *is_new = !entry;
    if (entry)
        return entry;
    entry = allocate(1, sizeof *entry);
    entry->key = *key;
    entry->number = HASH_COUNT(*table);
    HASH_ADD(hh, *table, key, sizeof entry->key, entry);
    return entry;
}

static void clear(struct replay_pair **table)
{
    struct replay_pair *first = *table;
    HASH_CLEAR(hh, *table);
    while (first) {
        struct replay_pair *next = first->hh.next;
        free(first);
        first = next;
    }
}

static struct pair_key key_of_client(int64_t client_id)
{
    return (struct pair_key){.number = {client_id}};
}

static struct pair_key key_of_ids(const struct match_key *key)
{
    return (struct pair_key){.number = {key->kind, key->client_id, key->sequence_number}};
}

/* ---- Clients with matches ---- */

void replay_note_match(struct replay *replay, const struct match_item *query,
                       const struct match_place *result)
{
    const struct pair_key client = key_of_client(query->key.client_id);
    bool is_new;
    match_note(replay->match, query, result);
    if (replay->options->golden)
        take(&replay->matched_clients, &client, &is_new);
}

static bool is_matched(struct replay *replay, int64_t client_id)
{
    const struct pair_key client = key_of_client(client_id);
    return find(replay->matched_clients, &client);
}

void replay_close_pairs(struct replay *replay)
{
    clear(&replay->matched_clients);
}

/* ---- Numbers ---- */

/* The group of a query; NULL: of results without queries. A label is in a query of at most
 * QUERY_BYTES_MAX, whose other fields are longer than the numbers: replay->whole holds both. */
static struct handle group_of(struct replay *replay, int64_t kind, const struct logged_query *query)
{
    unsigned char *out = replay->whole;
    size_t label = 0;
    int64_t number[3] = {kind};
    if (query && kind == LOG_PAIR_QUERY) {
        number[1] = query->pair.placement[0].placed.id;
        number[2] = query->pair.placement[1].placed.id;
    } else if (query) {
        number[1] = query->scene.first_pair;
        label = query->scene.label ? strlen(query->scene.label) : 0;
        memcpy(out + sizeof number, query->scene.label ? query->scene.label : "", label);
    }
    memcpy(out, number, sizeof number);
    return hasher_handle(replay->hasher, out, sizeof number + label);
}

/* The client, group and number of the next query of a client and group. */
static struct pair_key next_key(struct recording *recording, int64_t client_id,
                                const struct handle *group)
{
    const struct pair_key client = key_of_client(client_id);
    bool is_new;
    struct pair_key key = {.group = *group};
    key.number[0] = take(&recording->clients, &client, &is_new)->number;
    struct replay_pair *count = take(&recording->counts, &key, &is_new);
    count->number = is_new ? 0 : count->number + 1;
    key.number[1] = count->number;
    return key;
}

/* Numbers the remaining queries of the replayed logs. */
static void number_queries(struct replay *replay, bool by_type, struct replay_pair **numbered)
{
    struct recording recording = {NULL, NULL};
    for (struct match_item *query = match_any(replay->match); query; query = query->hh.next) {
        const struct match_key *ids = &query->key;
        struct message message;
        bool is_new;
        if (query->unreadable || is_matched(replay, ids->client_id) ||
            !replay_read_again(replay, ids, &query->place, replay->query_bytes, &message) ||
            logged_query_read(&replay->query, (enum log_kind) ids->kind, message.bytes,
                              message.size))
            continue;
        const struct handle group = group_of(replay, ids->kind, by_type ? NULL : &replay->query);
        const struct pair_key key = next_key(&recording, ids->client_id, &group);
        struct replay_pair *entry = take(numbered, &key, &is_new);
        entry->query = query;
        query->left_over = true;
        entry->query_key = *ids;
    }
    clear(&recording.clients);
    clear(&recording.counts);
}

/* ---- The golden log ---- */

void replay_count_left_over(struct replay *replay, const struct match_key *key,
                            const struct match_place *place)
{
    replay_channel(replay, key, place)->left_over++;
    replay->sink->unreadable(replay->sink->user, place, replay->channels.name[key->kind],
                             "has no counterpart in the other recording");
}

/* Pairs a query, or a result of a log without queries, with the numbered queries. */
static void pair_event(struct replay *replay, struct recording *golden,
                       const struct log_event *event, enum log_kind kind,
                       struct replay_pair *numbered, struct replay_pair **pairs)
{
    struct match_key key;
    bool is_new;
    const bool by_type = log_kind_is_result(kind);
    if (match_key_of(kind, event, &key) || is_matched(replay, key.client_id) ||
        (!by_type && logged_query_read(&replay->query, kind, event->data, (uint32_t) event->kept)))
        return;
    const struct pair_key unique = key_of_ids(&key);
    struct replay_pair *pair = take(pairs, &unique, &is_new);
    if (!is_new)
        return;
    const struct handle group = group_of(replay, key.kind, by_type ? NULL : &replay->query);
    const struct pair_key number = next_key(golden, key.client_id, &group);
    const struct replay_pair *query = find(numbered, &number);
    if (query) {
        pair->query = query->query;
        pair->query_key = query->query_key;
        query->query->left_over = false;
        return;
    }
    const struct match_place place = {.log = replay->options->log_count,
                                      .number = event->number,
                                      .offset = event->offset,
                                      .utime = event->utime};
    replay_count_left_over(replay, &key, &place);
}

/* Reads the golden log once more; its damage was reported before. */
static void pair_golden(struct replay *replay, struct replay_pair *numbered,
                        struct replay_pair **pairs)
{
    struct recording golden = {NULL, NULL};
    struct log_event event;
    struct log_damage damage;
    enum log_outcome outcome;
    input_begin(&replay->input, replay->options->log_count);
    while ((outcome = input_next(&replay->input, &event, &damage)) < LOG_END) {
        const enum log_kind kind =
            outcome == LOG_EVENT ? log_kind_of(&replay->channels, &event) : LOG_OTHER;
        if (replay->golden_has_queries ? log_kind_is_query(kind) : log_kind_is_result(kind))
            pair_event(replay, &golden, &event, kind, numbered, pairs);
    }
    if (outcome == LOG_FAILED)
        replay_fail_log(replay, replay->options->log_count);
    clear(&golden.clients);
    clear(&golden.counts);
}

/* ---- Results ---- */

void replay_pair_results(struct replay *replay)
{
    struct replay_pair *numbered = NULL, *pairs = NULL;
    number_queries(replay, !replay->golden_has_queries, &numbered);
    pair_golden(replay, numbered, &pairs);
    clear(&numbered);
    for (struct match_item *result; (result = match_list_take(&replay->unmatched));) {
        const struct pair_key unique = key_of_ids(&result->key);
        const struct replay_pair *pair = find(pairs, &unique);
        struct message message;
        if (!pair || !pair->query)
            replay_channel(replay, &result->key, &result->place)->unmatched++;
        else if (replay_read_again(replay, &pair->query_key, &result->place, replay->query_bytes,
                                   &message))
            replay_take_result(replay, &message);
        match_free(result);
    }
    clear(&pairs);
}
