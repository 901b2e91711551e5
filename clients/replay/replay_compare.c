/* Reads messages again, compares recorded results with new ones, counts the outcomes, and reports
 * differences and failures. */
#include "replay_parts.h"

#include "big_endian.h"
#include "complain.h"

#include <assert.h>
#include <errno.h>
#include <string.h>

void replay_fail(struct replay *replay, const char *what)
{
    if (!replay->failed)
        complain("%s: %s", what, strerror(errno));
    replay->failed = true;
}

void replay_fail_log(struct replay *replay, int log)
{
    replay_fail(replay, log < replay->options->log_count ? replay->options->log[log]
                                                         : replay->options->golden);
}

void replay_fail_changed(struct replay *replay, int log)
{
    errno = EIO;
    replay_fail_log(replay, log);
}

/* Results of the golden log are counted with the first log. */
static struct tally *tally_of(struct replay *replay, const struct match_place *place)
{
    return &replay->tally[place->log < replay->options->log_count ? place->log : 0];
}

struct tally_channel *replay_channel(struct replay *replay, const struct match_key *key,
                                     const struct match_place *place)
{
    return &tally_of(replay, place)->channel[tally_channel_of((enum log_kind) key->kind)];
}

void replay_refuse(struct replay *replay, enum log_kind kind, const struct message *message,
                   const char *error)
{
    replay_channel(replay, &message->key, &message->place)->unreadable[log_kind_is_result(kind)]++;
    replay->sink->unreadable(replay->sink->user, &message->place, replay->channels.name[kind],
                             error);
}

/* ---- Reading ---- */

bool replay_read_again(struct replay *replay, const struct match_key *key,
                       const struct match_place *place, unsigned char bytes[LOG_DATA_MAX],
                       struct message *out)
{
    *out = (struct message){*key, *place, bytes, 0};
    if (input_read_again(&replay->rereader, place->log, place->offset, bytes, &out->size))
        return true;
    replay_fail_log(replay, place->log);
    return false;
}

const char *replay_read_result(struct replay *replay, const struct message *result)
{
    return logged_result_read(&replay->then, (enum log_kind) result->key.kind, result->bytes,
                              result->size);
}

/* Reads the query of a comparison again, which could be decoded before. */
static bool read_query(struct replay *replay, const struct match_key *key,
                       const struct match_place *place)
{
    struct message query;
    if (!replay_read_again(replay, key, place, replay->compared_bytes, &query))
        return false;
    if (!logged_query_read(&replay->compared, (enum log_kind) key->kind, query.bytes, query.size))
        return true;
    replay_fail_changed(replay, place->log);
    return false;
}

static bool read_both(struct replay *replay, const struct match_item *item,
                      const struct new_result *answered)
{
    const char *error = logged_result_read(&replay->now, (enum log_kind) item->key.kind,
                                           answered->bytes, (uint32_t) answered->size);
    assert(!error); /* encoded by this process, or decoded before */
    (void) error;
    return read_query(replay, &item->key, &item->place);
}

/* The query, as it was read, with its results. */
static struct replayed replayed_of(struct replay *replay, bool has_recorded)
{
    struct replayed out = {.outcome = REPLAY_UNRECORDED};
    if (replay->compared.kind == LOG_PAIR_QUERY) {
        out.pair = &replay->compared.pair;
        out.pair_now = &replay->now.pair;
        out.pair_then = has_recorded ? &replay->then.pair : NULL;
    } else {
        out.scene = &replay->compared.scene;
        out.scene_now = &replay->now.scene;
        out.scene_then = has_recorded ? &replay->then.scene : NULL;
    }
    return out;
}

static void add_to_page(struct replay *replay, const struct match_item *item,
                        struct replayed replayed)
{
    int32_t count;
    struct query_placement *placement = logged_query_placements(&replay->compared, &count);
    replayed.log = replay->options->log[item->place.log];
    replayed.event_number = item->place.number;
    replayed.offset = item->place.offset;
    replayed.utime = item->place.utime;
    definitions_fill(replay->definitions, placement, count);
    page_take(replay->options->page, replay->options->names, replay->options->page_begin,
              &replayed);
}

/* ---- Comparing ---- */

static void on_difference(void *user, const struct difference *difference)
{
    struct replay *replay = user;
    const struct match_item *query = replay->item;
    struct difference located = *difference;
    located.place = query->place;
    located.query_kind = (enum log_kind) query->key.kind;
    located.client_id = query->key.client_id;
    located.sequence_number = query->key.sequence_number;
    replay_channel(replay, &query->key, &query->place)->differences[difference->kind]++;
    replay->sink->difference(replay->sink->user, &located);
}

static void count(struct replay *replay, const struct match_item *query,
                  enum replay_outcome outcome, int64_t then_ns)
{
    replay_channel(replay, &query->key, &query->place)->outcome[outcome]++;
    if (then_ns > 0 && (outcome == REPLAY_SAME || outcome == REPLAY_DIFFERENT))
        histogram_add(&tally_of(replay, &query->place)->then, then_ns);
}

static void compare_unrecorded(struct replay *replay, const struct match_item *query,
                               const struct new_result *answered)
{
    count(replay, query, REPLAY_UNRECORDED, 0);
    if (replay->options->page && read_both(replay, query, answered))
        add_to_page(replay, query, replayed_of(replay, false));
}

/* Results of both types end with compute_ns. */
static bool is_same(struct replay *replay, const struct message *then, const struct new_result *now)
{
    return !replay->options->page && compare_bytes_same((enum log_kind) then->key.kind, then->bytes,
                                                        then->size, now->bytes, now->size);
}

void replay_compare(struct replay *replay, const struct match_item *query,
                    const struct new_result *answered)
{
    struct message then;
    if (!query->has_recorded) {
        compare_unrecorded(replay, query, answered);
        return;
    }
    if (!replay_read_again(replay, &query->key, &query->then, replay->result_bytes, &then))
        return;
    if (is_same(replay, &then, answered)) {
        count(replay, query, REPLAY_SAME,
              (int64_t) big_endian_64(then.bytes + then.size - sizeof(int64_t)));
        return;
    }
    if (replay_read_result(replay, &then)) {
        replay_fail_changed(replay, query->then.log);
        return;
    }
    if (!read_both(replay, query, answered))
        return;
    replay->item = query;
    struct replayed replayed = replayed_of(replay, true);
    replayed.outcome = compare_results(&replay->options->compare, &replayed, on_difference, replay);
    count(replay, query, replayed.outcome, logged_result_compute_ns(&replay->then));
    if (replay->options->page)
        add_to_page(replay, query, replayed);
}

/* ---- Second results ---- */

static void no_difference(void *user, const struct difference *difference)
{
    (void) user;
    (void) difference;
}

void replay_compare_second(struct replay *replay, const struct match_note *note,
                           const struct message *second, const struct message *first)
{
    const struct match_place query = {.log = note->query_log, .offset = note->query_offset};
    struct tally_channel *tally = replay_channel(replay, &second->key, &second->place);
    const enum log_kind kind = log_kind_result_of((enum log_kind) second->key.kind);
    if (!read_query(replay, &note->key, &query))
        return;
    if (logged_result_read(&replay->now, (enum log_kind) first->key.kind, first->bytes,
                           first->size)) {
        replay_fail_changed(replay, first->place.log);
        return;
    }
    const struct replayed replayed = replayed_of(replay, true);
    if (compare_results(&replay->options->compare, &replayed, no_difference, NULL) !=
        REPLAY_DIFFERENT) {
        tally->results_again++;
    } else {
        tally->contradictions++;
        replay->sink->unreadable(replay->sink->user, &second->place, replay->channels.name[kind],
                                 "contradicts an earlier result of the same query");
    }
}
