#include "comparison.h"

#include "allocate.h"
#include "logged_query.h"
#include "big_endian.h"
#include "wire.h"

#include <assert.h>
#include <errno.h>
#include <stdlib.h>

union decoded_result {
    struct pair_result pair;
    struct scene_result scene;
};

struct comparison {
    struct comparison_options options;
    struct logged_query query;
    union decoded_result then, now;
    const struct match_item *item; /* the query of the current comparison */
    unsigned char bytes[LOG_DATA_MAX];
};

struct comparison *comparison_open(const struct comparison_options *options)
{
    struct comparison *comparison = allocate(1, sizeof *comparison);
    comparison->options = *options;
    return comparison;
}

void comparison_close(struct comparison *comparison)
{
    free(comparison);
}

static struct tally *tally_of(const struct comparison *comparison, const struct match_item *item)
{
    return &comparison->options.tally[item->place.log];
}

static struct tally_channel *channel_of(const struct comparison *comparison,
                                        const struct match_item *item)
{
    return &tally_of(comparison, item)->channel[tally_channel_of((enum log_kind) item->key.kind)];
}

/* ---- Reading ---- */

static const char *read_result(enum log_kind kind, const unsigned char *bytes, uint32_t size,
                               union decoded_result *out)
{
    return kind == LOG_PAIR_QUERY ? wire_read_pair_result(bytes, size, &out->pair)
                                  : wire_read_scene_result(bytes, size, &out->scene);
}

const char *comparison_read(struct comparison *comparison, enum log_kind kind,
                            const unsigned char *bytes, uint32_t size)
{
    return read_result(kind, bytes, size, &comparison->then);
}

bool comparison_is_transient(const struct comparison *comparison, enum log_kind kind)
{
    return compare_status_is_transient(kind == LOG_PAIR_QUERY ? comparison->then.pair.status
                                                              : comparison->then.scene.status);
}

/* Reads a query again, which could be decoded before. */
static bool read_query(struct comparison *comparison, enum log_kind kind, int log, int64_t offset)
{
    uint32_t size;
    if (!event_reader_read(comparison->options.rereader, log, offset, comparison->bytes, &size))
        return false;
    if (!logged_query_read(&comparison->query, kind, comparison->bytes, size))
        return true;
    errno = EIO;
    return false;
}

static bool read_both(struct comparison *comparison, const struct match_item *item)
{
    const enum log_kind kind = (enum log_kind) item->key.kind;
    const char *error = read_result(kind, item->now, item->now_size, &comparison->now);
    assert(!error); /* encoded by this process, or decoded before */
    (void) error;
    return read_query(comparison, kind, item->place.log, item->place.offset);
}

/* ---- For the page ---- */

static void add_to_page(struct comparison *comparison, const struct match_item *item,
                        bool has_recorded, enum replay_outcome outcome)
{
    struct replayed replayed = {.log = comparison->options.log[item->place.log],
                                .event_number = item->place.number,
                                .offset = item->place.offset,
                                .utime = item->place.utime,
                                .outcome = outcome};
    int32_t count;
    struct placement *placement = logged_query_placements(&comparison->query, &count);
    definitions_fill(comparison->options.definitions, placement, count);
    for (int32_t i = 0; i < count; i++)
        if (placement_by_handle(&placement[i]) && placement[i].geometry.size > GEOMETRY_NONE_BYTES)
            placement[i].frame_count = geometry_begin(&placement[i].geometry).frames_left;
    if (item->key.kind == LOG_PAIR_QUERY) {
        replayed.pair = &comparison->query.pair;
        replayed.pair_now = &comparison->now.pair;
        replayed.pair_then = has_recorded ? &comparison->then.pair : NULL;
    } else {
        replayed.scene = &comparison->query.scene;
        replayed.scene_now = &comparison->now.scene;
        replayed.scene_then = has_recorded ? &comparison->then.scene : NULL;
    }
    page_take(comparison->options.page, &replayed);
}

/* ---- Comparing ---- */

static void on_difference(void *user, const struct difference *difference)
{
    struct comparison *comparison = user;
    const struct match_item *query = comparison->item;
    const struct located_difference located = {query->place, (enum log_kind) query->key.kind,
                                               query->key.client_id, query->key.sequence_number,
                                               *difference};
    channel_of(comparison, query)->differences[difference->kind]++;
    comparison->options.sink->difference(comparison->options.sink->user, &located);
}

static enum replay_outcome compare(struct comparison *comparison, difference_sink *sink)
{
    const struct compare_options *options = &comparison->options.compare;
    if (comparison->query.kind == LOG_PAIR_QUERY)
        return compare_pairs(options, &comparison->query.pair, &comparison->then.pair,
                             &comparison->now.pair, sink, comparison);
    return compare_scenes(options, &comparison->query.scene, &comparison->then.scene,
                          &comparison->now.scene, sink, comparison);
}

static void count(struct comparison *comparison, const struct match_item *query,
                  enum replay_outcome outcome, int64_t then_ns)
{
    channel_of(comparison, query)->outcome[outcome]++;
    if (then_ns > 0 && (outcome == REPLAY_SAME || outcome == REPLAY_DIFFERENT))
        histogram_add(&tally_of(comparison, query)->then, then_ns);
}

/* Results of both types end with compute_ns. */
bool comparison_same_bytes(struct comparison *comparison, const struct match_item *query,
                           const unsigned char *then, size_t size)
{
    if (comparison->options.page || !compare_bytes_same((enum log_kind) query->key.kind, then, size,
                                                        query->now, query->now_size))
        return false;
    count(comparison, query, REPLAY_SAME, (int64_t) big_endian_64(then + size - sizeof(int64_t)));
    return true;
}

bool comparison_run(struct comparison *comparison, const struct match_item *query)
{
    if (!query->place.in_range)
        return true;
    if (!read_both(comparison, query))
        return false;
    comparison->item = query;
    const enum replay_outcome outcome = compare(comparison, on_difference);
    count(comparison, query, outcome,
          query->key.kind == LOG_PAIR_QUERY ? comparison->then.pair.compute_ns
                                            : comparison->then.scene.compute_ns);
    if (comparison->options.page)
        add_to_page(comparison, query, true, outcome);
    return true;
}

bool comparison_unrecorded(struct comparison *comparison, const struct match_item *query)
{
    if (!query->place.in_range)
        return true;
    count(comparison, query, REPLAY_UNRECORDED, 0);
    if (!comparison->options.page)
        return true;
    if (!read_both(comparison, query))
        return false;
    add_to_page(comparison, query, false, REPLAY_UNRECORDED);
    return true;
}

/* ---- Second results ---- */

static void no_difference(void *user, const struct difference *difference)
{
    (void) user;
    (void) difference;
}

bool comparison_second(struct comparison *comparison, const struct match_note *note,
                       const struct match_place *place, const unsigned char *first, uint32_t size)
{
    static const char *const channel[TALLY_CHANNELS] = {WIRE_PAIR_RESULT, WIRE_SCENE_RESULT};
    const enum log_kind kind = (enum log_kind) note->key.kind;
    const int which = tally_channel_of(kind);
    struct tally_channel *tally = &comparison->options.tally[place->log].channel[which];
    if (!read_query(comparison, kind, note->query_log, note->query_offset) ||
        read_result(kind, first, size, &comparison->now))
        return false;
    if (compare(comparison, no_difference) != REPLAY_DIFFERENT) {
        tally->results_again++;
        return true;
    }
    tally->contradictions++;
    comparison->options.sink->unreadable(comparison->options.sink->user, place, channel[which],
                                         "contradicts an earlier result of the same query");
    return true;
}
