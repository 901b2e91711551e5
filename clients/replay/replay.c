#include "replay_parts.h"

#include "allocate.h"
#include "complain.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* ---- Reading ---- */

/* The golden log comes after the others. */
static bool in_golden(const struct replay *replay)
{
    return replay->input.log == replay->options->log_count;
}

static void fail_golden(struct replay *replay, int64_t offset, const char *what)
{
    complain("%s: offset %" PRId64 ": %s", replay->options->golden, offset, what);
    replay->failed = true;
}

/* Registers a query or a result. error: why a query cannot be decoded; NULL: it can. */
static void take_message(struct replay *replay, enum log_kind kind, const struct log_event *event,
                         const char *error)
{
    struct match_item item;
    const bool golden = replay->options->golden;
    const char *unread =
        match_read(&item, kind, replay->input.log, event, golden ? NULL : &replay->then);
    struct tally_channel *channel = replay_channel(replay, &item);
    channel->results += item.is_result && !unread && !golden;
    item.unreadable = unread || error;
    if (item.unreadable) {
        channel->unreadable[item.is_result]++;
        replay_report(replay, &item, unread ? unread : error);
    }
    if (!unread && !(item.is_result && golden))
        match_add(&replay->match, &item);
}

static void take_golden(struct replay *replay, enum log_kind kind, const struct log_event *event)
{
    const uint32_t size = (uint32_t) event->kept;
    struct match_item item;
    if (kind == LOG_NAMES)
        body_names_read(replay->golden_names, event->data, size);
    if (kind >= LOG_STATUS)
        return;
    const char *error = match_read(&item, kind, replay->input.log, event, &replay->then);
    if (error && item.is_result)
        fail_golden(replay, event->offset, error);
    if (error)
        return;
    if (!item.is_result) {
        item.unreadable = logged_query_read(&replay->query, kind, event->data, size);
        if (!item.unreadable)
            body_names_take(replay->golden_names, &replay->query);
    }
    replay_channel(replay, &item)->results += item.is_result;
    match_add(&replay->golden, &item);
}

/* Adds the golden results, each with its own query, to the results to compare with. Returns false
 * if there are none, which was reported. */
static bool add_golden_results(struct replay *replay)
{
    struct match *golden = &replay->golden;
    bool any = false;
    match_all(golden);
    for (size_t i = 0; i < golden->count; i++) {
        struct match_item result = golden->item[i];
        if (!result.is_result)
            continue;
        result.own = result.other && !result.other->unreadable ? result.other : NULL;
        match_add(&replay->match, &result);
        any = true;
    }
    if (!any)
        complain("%s holds no results: is it an event log, with the prefix of the others?",
                 replay->options->golden);
    replay->failed = replay->failed || !any;
    return any;
}

static void take_event(struct replay *replay, const struct log_event *event)
{
    const enum log_kind kind = log_kind_of(&replay->channels, event);
    if (in_golden(replay)) {
        take_golden(replay, kind, event);
        return;
    }
    struct tally *tally = &replay->tally[replay->input.log];
    const struct match_place place = match_place_of(replay->input.log, event);
    const char *error = definitions_add_message(replay->definitions, replay->options->names, kind,
                                                event->data, (uint32_t) event->kept);
    if (!replay->started)
        replay->tally->first_utime = event->utime;
    replay->started = true;
    tally->events++;
    tally->bytes += event->length;
    tally->statuses += kind == LOG_STATUS;
    tally->definitions += kind == LOG_DEFINITION && !error;
    tally->unreadable_definitions += kind == LOG_DEFINITION && error;
    tally->other_events += kind == LOG_OTHER;
    if (log_kind_is_query(kind) || log_kind_is_result(kind))
        take_message(replay, kind, event, error);
    else if (kind == LOG_DEFINITION && error)
        replay->sink->unreadable(replay->sink->user, &place, replay->channels.name[kind], error);
}

static void take_damage(struct replay *replay, const struct log_damage *damage)
{
    if (in_golden(replay)) {
        fail_golden(replay, damage->offset, damage->what);
        return;
    }
    struct tally *tally = &replay->tally[replay->input.log];
    tally->damages++;
    tally->damaged_bytes += damage->length;
    tally->bytes += damage->length;
    replay->sink->damage(replay->sink->user, replay->input.log, damage);
}

/* ---- Opening and closing ---- */

static bool open_replay(struct replay *replay)
{
    const struct replay_options *options = replay->options;
    const int logs = options->log_count, count = logs + (options->golden != NULL);
    replay->paths = allocate((size_t) logs + 1, sizeof *replay->paths);
    memcpy(replay->paths, options->log, (size_t) logs * sizeof *replay->paths);
    replay->paths[logs] = (char *) (uintptr_t) options->golden;
    if (!input_open(&replay->input, replay->paths, count) ||
        !input_open(&replay->rereader, replay->paths, count) ||
        !input_open(&replay->golden_rereader, replay->paths, count))
        return false;
    replay->definitions = definitions_open();
    replay->golden_names = options->golden ? body_names_open() : NULL;
    replay->local = local_answerer_open(options->frames, replay->definitions);
    if ((options->bus && !replay_open_bus(replay)) ||
        !output_open(&options->write_golden, &replay->golden_file))
        return false;
    replay->new_golden = log_begin_output(replay->golden_file);
    if (replay->golden_file && !replay->new_golden)
        return false;
    replay->channels = log_channels(options->prefix);
    return true;
}

static void close_replay(struct replay *replay)
{
    replay_close_bus(replay);
    local_answerer_close(replay->local);
    g_queue_clear(&replay->again);
    match_clear(&replay->match);
    match_clear(&replay->golden);
    body_names_close(replay->golden_names);
    input_close(&replay->rereader);
    input_close(&replay->golden_rereader);
    free(replay->paths);
    definitions_close(replay->definitions);
    input_close(&replay->input);
    const bool empty = replay->new_golden && log_written(replay->new_golden) == 0;
    const int error = log_finish(replay->new_golden);
    if (error)
        output_complain(replay->options->write_golden.path, error);
    replay->failed = replay->failed || error;
    replay->failed =
        !output_close(replay->golden_file, !replay->failed && !empty) || replay->failed;
}

/* ---- The run ---- */

static void read_logs(struct replay *replay)
{
    struct log_event event;
    struct log_damage damage;
    enum log_outcome outcome;
    while ((outcome = input_next(&replay->input, &event, &damage)) < LOG_END) {
        if (outcome == LOG_EVENT)
            take_event(replay, &event);
        else
            take_damage(replay, &damage);
        replay->sink->progress(replay->sink->user, replay->input.passed / 2,
                               input_size(&replay->input));
        if (replay_has_ended(replay))
            return;
    }
    if (outcome == LOG_FAILED)
        replay_fail(replay, replay->paths[replay->input.log], errno);
}

static void run(struct replay *replay)
{
    read_logs(replay);
    if (replay->options->golden && !add_golden_results(replay))
        return;
    match_all(&replay->match);
    if (replay->options->golden)
        replay_pair_clients(replay);
    replay_compare_results(replay);
    replay_answer_queries(replay);
    replay->failed = replay->failed || replay_has_ended(replay);
}

bool replay_run(const struct replay_options *options, const struct replay_sink *sink,
                struct tally *tally)
{
    struct replay *replay = allocate(1, sizeof *replay);
    replay->options = options;
    replay->sink = sink;
    replay->tally = tally;
    replay->signals = -1;
    if (open_replay(replay))
        run(replay);
    else
        replay->failed = true;
    close_replay(replay);
    const bool good = !replay->failed;
    free(replay);
    return good;
}
