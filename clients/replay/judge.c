#include "judge.h"

#include "allocate.h"
#include "any_query.h"
#include "big_endian.h"
#include "wire.h"

#include <assert.h>
#include <errno.h>
#include <stdlib.h>

union any_result {
    struct pair_result pair;
    struct scene_result scene;
};

struct judge {
    struct judge_options options;
    struct any_query query;
    union any_result then, now;
    const struct match_item *item; /* whose differences are being found */
    unsigned char bytes[LOG_DATA_MAX];
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
    return &tally_of(judge, item)->channel[tally_channel_of((enum log_kind) item->key.kind)];
}

/* ---- Reading ---- */

static const char *read_result(enum log_kind kind, const unsigned char *bytes, uint32_t size,
                               union any_result *out)
{
    return kind == LOG_PAIR_QUERY ? wire_read_pair_result(bytes, size, &out->pair)
                                  : wire_read_scene_result(bytes, size, &out->scene);
}

const char *judge_read(struct judge *judge, enum log_kind kind, const unsigned char *bytes,
                       uint32_t size)
{
    return read_result(kind, bytes, size, &judge->then);
}

bool judge_of_the_moment(const struct judge *judge, enum log_kind kind)
{
    return compare_is_of_the_moment(kind == LOG_PAIR_QUERY ? judge->then.pair.status
                                                           : judge->then.scene.status);
}

/* The query could be read before. */
static bool read_query(struct judge *judge, enum log_kind kind, int log, int64_t offset)
{
    uint32_t size;
    if (!again_read(judge->options.again, log, offset, judge->bytes, &size))
        return false;
    if (!any_query_read(&judge->query, kind, judge->bytes, size))
        return true;
    errno = EIO;
    return false;
}

static bool read_both(struct judge *judge, const struct match_item *item)
{
    const enum log_kind kind = (enum log_kind) item->key.kind;
    const char *error = read_result(kind, item->now, item->now_size, &judge->now);
    assert(!error); /* it was written here, or read before */
    (void) error;
    return read_query(judge, kind, item->place.log, item->place.offset);
}

/* ---- For the page ---- */

static void show(struct judge *judge, const struct match_item *item, bool has_then,
                 enum replay_outcome outcome)
{
    struct replayed replayed = {.log = judge->options.log[item->place.log],
                                .event_number = item->place.number,
                                .offset = item->place.offset,
                                .utime = item->place.utime,
                                .outcome = outcome};
    int32_t count;
    struct placement *placement = any_query_placements(&judge->query, &count);
    definitions_fill(judge->options.definitions, placement, count);
    for (int32_t i = 0; i < count; i++)
        if (placement_by_handle(&placement[i]) && placement[i].geometry.size > GEOMETRY_NONE_BYTES)
            placement[i].frame_count = geometry_begin(&placement[i].geometry).frames_left;
    if (item->key.kind == LOG_PAIR_QUERY) {
        replayed.pair = &judge->query.pair;
        replayed.pair_now = &judge->now.pair;
        replayed.pair_then = has_then ? &judge->then.pair : NULL;
    } else {
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
    const struct found found = {query->place, (enum log_kind) query->key.kind, query->key.client_id,
                                query->key.sequence_number, *difference};
    channel_of(judge, query)->differences[difference->kind]++;
    judge->options.sink->found(judge->options.sink->user, &found);
}

static enum replay_outcome compare(struct judge *judge, difference_sink *sink)
{
    const struct compare_options *options = &judge->options.compare;
    if (judge->query.kind == LOG_PAIR_QUERY)
        return compare_pairs(options, &judge->query.pair, &judge->then.pair, &judge->now.pair, sink,
                             judge);
    return compare_scenes(options, &judge->query.scene, &judge->then.scene, &judge->now.scene, sink,
                          judge);
}

static void count(struct judge *judge, const struct match_item *query, enum replay_outcome outcome,
                  int64_t then_ns)
{
    channel_of(judge, query)->outcome[outcome]++;
    if (then_ns > 0 && (outcome == REPLAY_SAME || outcome == REPLAY_DIFFERENT))
        histogram_add(&tally_of(judge, query)->then, then_ns);
}

/* Results of both types end with compute_ns. */
bool judge_same(struct judge *judge, const struct match_item *query, const unsigned char *then,
                size_t size)
{
    if (judge->options.page || !compare_bytes_same((enum log_kind) query->key.kind, then, size,
                                                   query->now, query->now_size))
        return false;
    count(judge, query, REPLAY_SAME, (int64_t) big_endian_64(then + size - sizeof(int64_t)));
    return true;
}

bool judge_both(struct judge *judge, const struct match_item *query)
{
    if (!query->place.mine)
        return true;
    if (!read_both(judge, query))
        return false;
    judge->item = query;
    const enum replay_outcome outcome = compare(judge, on_difference);
    count(judge, query, outcome,
          query->key.kind == LOG_PAIR_QUERY ? judge->then.pair.compute_ns
                                            : judge->then.scene.compute_ns);
    if (judge->options.page)
        show(judge, query, true, outcome);
    return true;
}

bool judge_alone(struct judge *judge, const struct match_item *query)
{
    if (!query->place.mine)
        return true;
    count(judge, query, REPLAY_ALONE, 0);
    if (!judge->options.page)
        return true;
    if (!read_both(judge, query))
        return false;
    show(judge, query, false, REPLAY_ALONE);
    return true;
}

/* ---- Second results ---- */

static void no_difference(void *user, const struct difference *difference)
{
    (void) user;
    (void) difference;
}

bool judge_second(struct judge *judge, const struct match_note *note,
                  const struct match_place *place, const unsigned char *first, uint32_t size)
{
    static const char *const channel[TALLY_CHANNELS] = {WIRE_PAIR_RESULT, WIRE_SCENE_RESULT};
    const enum log_kind kind = (enum log_kind) note->key.kind;
    const int which = tally_channel_of(kind);
    struct tally_channel *tally = &judge->options.tally[place->log].channel[which];
    if (!read_query(judge, kind, note->query_log, note->query_offset) ||
        read_result(kind, first, size, &judge->now))
        return false;
    if (compare(judge, no_difference) != REPLAY_DIFFERENT) {
        tally->results_again++;
        return true;
    }
    tally->contradictions++;
    judge->options.sink->unreadable(judge->options.sink->user, place, channel[which],
                                    "contradicts an earlier result of the same query");
    return true;
}
