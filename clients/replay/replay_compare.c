/* Reads messages again, compares recorded results with new ones, counts the outcomes, and reports
 * differences and failures. */
#include "replay_parts.h"

#include "big_endian.h"
#include "complain.h"

#include <assert.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>

void replay_fail(struct replay *replay, const char *what, int error)
{
    if (!replay->failed)
        complain("%s: %s", what, strerror(error));
    replay->failed = true;
}

/* Results of the golden log are counted with the first log. */
static struct tally *tally_of(struct replay *replay, const struct match_place *place)
{
    return &replay->tally[place->log < replay->options->log_count ? place->log : 0];
}

struct tally_channel *replay_channel(struct replay *replay, const struct match_item *item)
{
    return &tally_of(replay, &item->place)
                ->channel[tally_channel_of((enum log_kind) item->key.kind)];
}

void replay_report(struct replay *replay, const struct match_item *item, const char *what)
{
    const enum log_kind query = (enum log_kind) item->key.kind;
    replay->sink->unreadable(
        replay->sink->user, &item->place,
        replay->channels.name[item->is_result ? log_kind_result_of(query) : query], what);
}

/* ---- Reading ---- */

static bool read_again(struct replay *replay, struct input *input, const struct match_item *item,
                       unsigned char bytes[LOG_DATA_MAX], uint32_t *size)
{
    const struct match_place *place = &item->place;
    const bool good = input_read_again(input, place->log, place->offset, bytes, size);
    if (!good)
        replay_fail(replay, replay->paths[place->log], errno);
    return good;
}

/* What could be decoded before has changed. */
static bool is_unchanged(struct replay *replay, const struct match_item *item, const char *error)
{
    if (error)
        replay_fail(replay, replay->paths[item->place.log], EIO);
    return !error;
}

bool replay_read_query(struct replay *replay, struct input *input, const struct match_item *query,
                       unsigned char bytes[LOG_DATA_MAX], uint32_t *size, struct logged_query *out)
{
    return read_again(replay, input, query, bytes, size) &&
           is_unchanged(replay, query,
                        logged_query_read(out, (enum log_kind) query->key.kind, bytes, *size));
}

/* What reads a result, or its query, again. */
static struct input *rereader_of(struct replay *replay, const struct match_item *result)
{
    return result->place.log < replay->options->log_count ? &replay->rereader
                                                          : &replay->golden_rereader;
}

/* Reads a result again and decodes it. */
static bool read_result(struct replay *replay, const struct match_item *result,
                        unsigned char bytes[LOG_DATA_MAX], struct logged_result *out)
{
    uint32_t size;
    return read_again(replay, rereader_of(replay, result), result, bytes, &size) &&
           is_unchanged(replay, result,
                        logged_result_read(out, (enum log_kind) result->key.kind, bytes, size));
}

static bool read_compared(struct replay *replay, const struct match_item *query)
{
    uint32_t size;
    if (!replay_read_query(replay, &replay->rereader, query, replay->compared_bytes, &size,
                           &replay->compared))
        return false;
    if (query->key.kind == LOG_SCENE_QUERY && replay->compared.scene.label)
        snprintf(replay->label, sizeof replay->label, "%s", replay->compared.scene.label);
    return true;
}

/* Reads the own query of a golden result. */
static bool read_golden_query(struct replay *replay, const struct match_item *result)
{
    uint32_t size;
    return replay_read_query(replay, rereader_of(replay, result), result->own, replay->golden_bytes,
                             &size, &replay->golden_query);
}

/* ---- Comparing ---- */

/* The counts of the query's label, which may be "". */
static struct tally_channel *label_of(struct replay *replay, const struct match_item *query)
{
    const bool counted = replay->options->labels && query->key.kind == LOG_SCENE_QUERY;
    return counted ? tally_label(tally_of(replay, &query->place), replay->label) : &replay->others;
}

static void on_difference(void *user, const struct difference *difference)
{
    struct replay *replay = user;
    const struct match_item *query = replay->item;
    struct difference located = *difference;
    located.place = query->place;
    located.query_kind = (enum log_kind) query->key.kind;
    located.client_id = query->key.client_id;
    located.sequence_number = query->key.sequence_number;
    strcpy(located.label, replay->label);
    replay_channel(replay, query)->differences[difference->kind]++;
    label_of(replay, query)->differences[difference->kind]++;
    if (difference->detail)
        snprintf(replay->note, sizeof replay->note, "%s", difference->detail);
    replay->sink->difference(replay->sink->user, &located);
}

static void count(struct replay *replay, const struct match_item *query,
                  enum replay_outcome outcome, int64_t then_ns)
{
    replay_channel(replay, query)->outcome[outcome]++;
    label_of(replay, query)->queries++;
    label_of(replay, query)->outcome[outcome]++;
    if (then_ns > 0 && (outcome == REPLAY_SAME || outcome == REPLAY_DIFFERENT))
        histogram_add(&tally_of(replay, &query->place)->then, then_ns);
}

/* The exchange of the query with a result. */
static struct exchange exchange_of(struct replay *replay, const struct logged_result *result)
{
    return (struct exchange){
        .query = &replay->compared, .result = result, .names = replay->options->names};
}

/* Compares the new result with the recorded one, if any, which the caller has read, and its own
 * query. size: of the recorded result; same_bytes: of both results. */
static void compare_read(struct replay *replay, const struct match_item *query,
                         const struct new_result *answered, uint32_t size, bool same_bytes)
{
    const enum log_kind kind = (enum log_kind) query->key.kind;
    const struct match_item *result = query->other;
    struct exchange then = exchange_of(replay, result ? &replay->then : NULL),
                    now = exchange_of(replay, &replay->now);
    const bool has_own = result && result->own;
    if (has_own) {
        then.query = &replay->golden_query;
        then.names = replay->golden_names;
    }
    then.by_order =
        result && !has_own && (result->by_order || result->key.utime != query->key.utime);
    if (!read_compared(replay, query) ||
        (result &&
         !is_unchanged(replay, result,
                       logged_result_read(&replay->then, kind, replay->result_bytes, size))))
        return;
    const char *error =
        logged_result_read(&replay->now, kind, answered->bytes, (uint32_t) answered->size);
    assert(!error); /* encoded by this process, or decoded before */
    (void) error;
    if (replay->options->compare.tolerance > 0)
        definitions_fill(replay->definitions, &replay->compared);
    replay->item = query;
    const enum replay_outcome outcome =
        answered->not_held ? REPLAY_NOT_HELD
        : !result          ? REPLAY_UNRECORDED
        : same_bytes && !has_own
            ? REPLAY_SAME
            : compare_exchanges(&replay->options->compare, &then, &now, on_difference, replay);
    count(replay, query, outcome, result ? replay->then.head.compute_ns : 0);
    if (!replay->options->page)
        return;
    const struct page_replayed replayed = {.log = replay->paths[query->place.log],
                                           .place = query->place,
                                           .begin = replay->tally->first_utime,
                                           .outcome = outcome,
                                           .note = replay->note};
    definitions_fill(replay->definitions, &replay->compared);
    page_take(replay->options->page, &replayed, &then, &now);
}

void replay_compare(struct replay *replay, const struct match_item *query,
                    const struct new_result *answered)
{
    const unsigned char *then = replay->result_bytes;
    const struct match_item *result = query->other;
    uint32_t size = 0;
    replay->label[0] = replay->note[0] = 0;
    /* A query comes before its result: so the golden log is read forwards. */
    if (result &&
        ((result->own && !read_golden_query(replay, result)) ||
         !read_again(replay, rereader_of(replay, result), result, replay->result_bytes, &size)))
        return;
    const bool same = result && compare_bytes_same((enum log_kind) query->key.kind, then, size,
                                                   answered->bytes, answered->size);
    if (replay->options->page || replay->options->labels || (result && (!same || result->own)))
        compare_read(replay, query, answered, size, same);
    else if (same) /* results of both types end with compute_ns */
        count(replay, query, REPLAY_SAME, (int64_t) big_endian_64(then + size - sizeof(int64_t)));
    else
        count(replay, query, answered->not_held ? REPLAY_NOT_HELD : REPLAY_UNRECORDED, 0);
}

/* ---- Second results, and results without a query ---- */

static void no_difference(void *user, const struct difference *difference)
{
    (void) user;
    (void) difference;
}

static void compare_second(struct replay *replay, const struct match_item *second)
{
    const struct match_item *query = second->other;
    struct exchange then = exchange_of(replay, &replay->then),
                    now = exchange_of(replay, &replay->now);
    struct tally_channel *channel = replay_channel(replay, second);
    bool differs = false;
    if (second->own)
        then.query = now.query = &replay->golden_query;
    if (second->own || !query->unreadable) {
        if (!(second->own ? read_golden_query(replay, second) : read_compared(replay, query)) ||
            !read_result(replay, query->other, replay->query_bytes, &replay->now) ||
            !read_result(replay, second, replay->result_bytes, &replay->then))
            return;
        differs = compare_exchanges(&replay->options->compare, &then, &now, no_difference, NULL) ==
                  REPLAY_DIFFERENT;
    }
    channel->results_again += !differs;
    channel->contradictions += differs;
    if (differs)
        replay_report(replay, second, "contradicts an earlier result of the same query");
}

void replay_compare_results(struct replay *replay)
{
    for (size_t i = 0; i < replay->match.count; i++) {
        const struct match_item *item = &replay->match.item[i];
        if (!item->is_result)
            continue;
        if (!item->other)
            replay_channel(replay, item)->unmatched++;
        else if (item->second)
            compare_second(replay, item);
    }
}
