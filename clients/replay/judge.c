#include "judge.h"

#include "allocate.h"
#include "big_endian.h"
#include "check.h"
#include "wire.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

struct judge {
    struct judge_options options;
    union {
        struct pair_query pair;
        struct scene_query scene;
    } query;
    union {
        struct pair_result pair;
        struct scene_result scene;
    } then, now;
    const struct match_item *item; /* the query whose differences are being found */
};

struct judge *judge_open(const struct judge_options *options)
{
    struct judge *judge = allocate(1, sizeof *judge);
    judge->options = *options;
    return judge;
}

void judge_close(struct judge *judge)
{
    free(judge);
}

static struct tally *tally_of(const struct judge *judge, const struct match_item *item)
{
    return &judge->options.tally[item->place.log];
}

static struct tally_channel *channel_of(const struct judge *judge, const struct match_item *item)
{
    return &tally_of(judge, item)->channel[tally_channel_of(item->kind)];
}

/* ---- Messages ---- */

/* Of a query that is longer than a datagram nobody reads more than the header. */
static void read_header(struct judge *judge, const struct match_item *query)
{
    memset(&judge->query, 0, sizeof judge->query);
    if (query->kind == LOG_PAIR_QUERY) {
        judge->query.pair.utime = query->ids.utime;
        judge->query.pair.client_id = query->ids.client_id;
        judge->query.pair.sequence_number = query->ids.sequence_number;
    } else {
        judge->query.scene.utime = query->ids.utime;
        judge->query.scene.client_id = query->ids.client_id;
        judge->query.scene.sequence_number = query->ids.sequence_number;
    }
}

/* The query, and what it was answered now: both have been read, or written, here before. */
static void read_query(struct judge *judge, const struct match_item *query)
{
    const char *error = NULL;
    if (query->size > QUERY_BYTES_MAX)
        read_header(judge, query);
    else if (query->kind == LOG_PAIR_QUERY)
        error = wire_read_pair_query(query->bytes, query->size, &judge->query.pair);
    else
        error = wire_read_scene_query(query->bytes, query->size, &judge->query.scene);
    if (!error)
        error = query->kind == LOG_PAIR_QUERY
                    ? wire_read_pair_result(query->more, query->more_size, &judge->now.pair)
                    : wire_read_scene_result(query->more, query->more_size, &judge->now.scene);
    assert(!error);
    (void) error;
}

const char *judge_read_result(struct judge *judge, const struct match_item *result)
{
    return result->kind == LOG_PAIR_QUERY
               ? wire_read_pair_result(result->bytes, result->size, &judge->then.pair)
               : wire_read_scene_result(result->bytes, result->size, &judge->then.scene);
}

/* With the last 8 bytes results of both types end; of bytes that have been read. */
static int64_t compute_ns_of(const struct match_item *result)
{
    return (int64_t) big_endian_64(result->bytes + result->size - sizeof(int64_t));
}

/* ---- For the page ---- */

/* Frames that came by key, with what that stands for. */
static void complete(const struct judge *judge, struct query_frame *frame, int32_t count)
{
    for (int32_t i = 0; i < count && i < QUERY_FRAMES_MAX; i++)
        if (check_by_key(&frame[i]))
            known_bodies_complete(judge->options.known, &frame[i]);
}

static void show(struct judge *judge, const struct match_item *query, bool has_then,
                 enum replay_outcome outcome)
{
    struct replayed replayed = {.log = judge->options.log[query->place.log],
                                .event_number = query->place.number,
                                .offset = query->place.offset,
                                .utime = query->place.utime,
                                .outcome = outcome};
    if (query->kind == LOG_PAIR_QUERY) {
        complete(judge, judge->query.pair.frame, 2);
        replayed.pair = &judge->query.pair;
        replayed.pair_now = &judge->now.pair;
        replayed.pair_then = has_then ? &judge->then.pair : NULL;
    } else {
        complete(judge, judge->query.scene.frame, judge->query.scene.frame_count);
        replayed.scene = &judge->query.scene;
        replayed.scene_now = &judge->now.scene;
        replayed.scene_then = has_then ? &judge->then.scene : NULL;
    }
    page_take(judge->options.page, &replayed);
}

/* ---- Judging ---- */

static void on_difference(void *user, const struct difference *difference)
{
    struct judge *judge = user;
    const struct match_item *query = judge->item;
    const struct found found = {query->place, query->kind, query->ids, *difference};
    channel_of(judge, query)->differences[difference->kind]++;
    judge->options.sink->found(judge->options.sink->user, &found);
}

static enum replay_outcome compare(struct judge *judge, const struct match_item *query)
{
    const struct compare_options *options = &judge->options.compare;
    judge->item = query;
    if (query->kind == LOG_PAIR_QUERY)
        return compare_pairs(options, &judge->query.pair, &judge->then.pair, &judge->now.pair,
                             on_difference, judge);
    return compare_scenes(options, &judge->query.scene, &judge->then.scene, &judge->now.scene,
                          on_difference, judge);
}

static void count_time(const struct judge *judge, const struct match_item *query,
                       const struct match_item *result)
{
    const int64_t compute_ns = compute_ns_of(result);
    if (compute_ns > 0)
        histogram_add(&tally_of(judge, query)->then, compute_ns);
}

static void refuse_result(const struct judge *judge, const struct match_item *result,
                          const char *error)
{
    static const char *const channel[TALLY_CHANNELS] = {WIRE_PAIR_RESULT, WIRE_SCENE_RESULT};
    channel_of(judge, result)->unreadable[1]++;
    judge->options.sink->unreadable(judge->options.sink->user, &result->place,
                                    channel[tally_channel_of(result->kind)], error);
}

/* The bytes were the same, or have to be looked at. */
static enum replay_outcome judge_bytes(struct judge *judge, const struct match_item *query,
                                       const struct match_item *result)
{
    const bool same =
        compare_bytes_same(query->kind, result->bytes, result->size, query->more, query->more_size);
    if (same && !judge->options.page) {
        count_time(judge, query, result);
        return REPLAY_SAME;
    }
    const char *error = judge_read_result(judge, result);
    if (error) {
        refuse_result(judge, result, error);
        return REPLAY_ALONE;
    }
    read_query(judge, query);
    const enum replay_outcome outcome = compare(judge, query);
    if (outcome == REPLAY_SAME || outcome == REPLAY_DIFFERENT)
        count_time(judge, query, result);
    if (judge->options.page)
        show(judge, query, true, outcome);
    return outcome;
}

void judge_both(struct judge *judge, const struct match_item *query,
                const struct match_item *result)
{
    if (query->place.mine)
        channel_of(judge, query)->outcome[judge_bytes(judge, query, result)]++;
}

void judge_query_alone(struct judge *judge, const struct match_item *query)
{
    if (!query->place.mine)
        return;
    channel_of(judge, query)->outcome[REPLAY_ALONE]++;
    if (!judge->options.page)
        return;
    read_query(judge, query);
    show(judge, query, false, REPLAY_ALONE);
}

void judge_result_alone(struct judge *judge, const struct match_item *result)
{
    if (!result->place.mine)
        return;
    const char *error = judge_read_result(judge, result);
    if (error)
        refuse_result(judge, result, error);
    else
        channel_of(judge, result)->results_alone++;
}
