/* Pairs the queries of two recordings of the same scenes by different clients.
 *
 * In: the queries that have no result, and the results of the golden log that have no query, after
 * all matches by client id and sequence number. Clients with such a match are not paired: what is
 * left of them has no counterpart.
 *
 * Steps:
 *   1. number_queries()       the queries of the replayed logs: their clients by first appearance,
 *                             and the queries of a client within their group (type, label, first
 *                             pair; for pairs, the ids of both bodies). Repeated queries, with the
 *                             same ids, are one
 *   2. pair_golden()          the queries of the golden log, in the same way. A golden log without
 *                             queries has only the types of its results: then the group is the
 *                             type, on both sides
 *   3. replay_pair_results()  gives each result the ids of the query with the number of its own
 *                             query, and matches it as if it were recorded with that query */
#include "replay_parts.h"

#include <stdlib.h>
#include <string.h>

/* What an entry of the table is about, and its key. */
enum pair_kind {
    PAIR_MATCHED, /* a client with matches: its id */
    PAIR_CLIENT,  /* a client: its id */
    PAIR_GROUP,   /* the queries of a client and group: number of the client, group */
    PAIR_QUERY,   /* a query of the replayed logs: numbers of client and query, group */
    PAIR_IDS      /* a query of the golden log: kind, client id, sequence number */
};

struct pair_key {
    int64_t kind, golden; /* enum pair_kind; 1: of the golden log */
    int64_t number[3];
    struct handle group;
};

struct replay_pair {
    struct pair_key key;
    int64_t count;              /* CLIENT: its number, from 1; GROUP: queries; IDS: how often */
    struct match_item *query;   /* QUERY, IDS: while queries are paired; NULL: none */
    struct match_key query_key; /* of that query */
    UT_hash_handle hh;
};

static struct replay_pair *find(const struct replay *replay, const struct pair_key *key)
{
    struct replay_pair *entry = NULL;
    if (replay->pairs)
        HASH_FIND(hh, replay->pairs, key, sizeof *key, entry);
    return entry;
}

/* The entry of a key, which is added if there is none. */
static struct replay_pair *take(struct replay *replay, const struct pair_key *key)
{
    struct replay_pair *entry = find(replay, key);
    if (entry)
        return entry;
    entry = allocate(1, sizeof *entry);
    entry->key = *key;
    HASH_ADD(hh, replay->pairs, key, sizeof entry->key, entry);
    return entry;
}

void replay_close_pairs(struct replay *replay)
{
    struct replay_pair *first = replay->pairs;
    HASH_CLEAR(hh, replay->pairs);
    while (first) {
        struct replay_pair *next = first->hh.next;
        free(first);
        first = next;
    }
}

/* ---- Clients with matches ---- */

static struct pair_key key_of_matched(int64_t client_id)
{
    return (struct pair_key){.kind = PAIR_MATCHED, .number = {client_id}};
}

void replay_note_match(struct replay *replay, const struct match_item *query,
                       const struct match_place *result)
{
    const struct pair_key key = key_of_matched(query->key.client_id);
    match_note(replay->match, query, result);
    if (replay->options->golden)
        take(replay, &key);
}

static bool is_matched(struct replay *replay, int64_t client_id)
{
    const struct pair_key key = key_of_matched(client_id);
    return find(replay, &key);
}

/* ---- Numbers ---- */

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
    return hasher_handle(replay->hasher, out, sizeof number + strlen(label));
}

/* The key of the next query of a client and group. by_type: without queries. */
static struct pair_key next_key(struct replay *replay, bool golden, const struct match_key *ids,
                                bool by_type)
{
    const struct pair_key client = {PAIR_CLIENT, golden, {ids->client_id}, {{0}}};
    struct pair_key key = {.kind = PAIR_GROUP,
                           .golden = golden,
                           .group = group_of(replay, ids->kind, by_type ? NULL : &replay->query)};
    struct replay_pair *entry = take(replay, &client);
    if (entry->count == 0)
        entry->count = ++replay->paired_clients[golden];
    key.number[0] = entry->count;
    key.number[1] = take(replay, &key)->count++;
    key.kind = PAIR_QUERY;
    key.golden = false;
    return key;
}

/* Numbers the remaining queries of the replayed logs. */
static void number_queries(struct replay *replay)
{
    for (struct match_item *query = match_any(replay->match); query; query = query->hh.next) {
        const struct match_key *ids = &query->key;
        struct message message;
        if (query->unreadable || is_matched(replay, ids->client_id) ||
            !replay_read_again(replay, ids, &query->place, replay->query_bytes, &message) ||
            logged_query_read(&replay->query, (enum log_kind) ids->kind, message.bytes,
                              message.size))
            continue;
        const struct pair_key key = next_key(replay, false, ids, !replay->golden_has_queries);
        struct replay_pair *entry = take(replay, &key);
        entry->query = query;
        entry->query_key = *ids;
        query->left_over = true;
    }
}

/* ---- The golden log ---- */

void replay_count_left_over(struct replay *replay, const struct match_key *key,
                            const struct match_place *place)
{
    replay_channel(replay, key, place)->left_over++;
    replay->sink->unreadable(replay->sink->user, place, replay->channels.name[key->kind],
                             "has no counterpart in the other recording");
}

static struct pair_key key_of_ids(const struct match_key *key)
{
    return (struct pair_key){.kind = PAIR_IDS,
                             .number = {key->kind, key->client_id, key->sequence_number}};
}

/* Pairs a query, or a result of a log without queries, with the numbered queries. */
static void pair_event(struct replay *replay, const struct log_event *event, enum log_kind kind)
{
    struct match_key ids;
    const bool by_type = log_kind_is_result(kind);
    if (match_key_of(kind, event, &ids) || is_matched(replay, ids.client_id) ||
        (!by_type && logged_query_read(&replay->query, kind, event->data, (uint32_t) event->kept)))
        return;
    const struct pair_key unique = key_of_ids(&ids);
    struct replay_pair *pair = take(replay, &unique);
    if (pair->count++ > 0)
        return;
    const struct pair_key key = next_key(replay, true, &ids, by_type);
    const struct replay_pair *numbered = find(replay, &key);
    if (numbered) {
        pair->query = numbered->query;
        pair->query_key = numbered->query_key;
        numbered->query->left_over = false;
        return;
    }
    const struct match_place place = {.log = replay->options->log_count,
                                      .number = event->number,
                                      .offset = event->offset,
                                      .utime = event->utime};
    replay_count_left_over(replay, &ids, &place);
}

/* Reads the golden log once more; its damage was reported before. */
static void pair_golden(struct replay *replay)
{
    struct log_event event;
    struct log_damage damage;
    enum log_outcome outcome;
    input_begin(&replay->input, replay->options->log_count);
    while ((outcome = input_next(&replay->input, &event, &damage)) < LOG_END) {
        const enum log_kind kind =
            outcome == LOG_EVENT ? log_kind_of(&replay->channels, &event) : LOG_OTHER;
        if (replay->golden_has_queries ? log_kind_is_query(kind) : log_kind_is_result(kind))
            pair_event(replay, &event, kind);
    }
    if (outcome == LOG_FAILED)
        replay_fail_log(replay, replay->options->log_count);
}

/* ---- Results ---- */

void replay_pair_results(struct replay *replay)
{
    number_queries(replay);
    pair_golden(replay);
    for (struct match_item *result; (result = match_pop(&replay->unmatched));) {
        const struct pair_key unique = key_of_ids(&result->key);
        const struct replay_pair *pair = find(replay, &unique);
        struct message message;
        if (!pair || !pair->query)
            replay_channel(replay, &result->key, &result->place)->unmatched++;
        else if (replay_read_again(replay, &pair->query_key, &result->place, replay->query_bytes,
                                   &message))
            replay_take_result(replay, &message);
        free(result);
    }
}
