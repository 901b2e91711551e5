#include "replay_parts.h"

#include "allocate.h"
#include "complain.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static const char *read_key(enum log_kind kind, const struct log_event *event, struct message *out)
{
    out->bytes = event->data;
    out->size = (uint32_t) event->kept;
    return match_key_of(kind, event, &out->key);
}

/* ---- The first reading ---- */

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

static bool in_time(const struct replay *replay, int64_t utime)
{
    const double seconds = ((double) utime - (double) replay->first_utime) / 1e6;
    return seconds >= replay->options->from && seconds < replay->options->to;
}

static struct match_place place_of(const struct replay *replay, const struct log_event *event)
{
    return (struct match_place){.log = replay->input.log,
                                .in_range = in_golden(replay) || in_time(replay, event->utime),
                                .number = event->number,
                                .offset = event->offset,
                                .utime = event->utime};
}

/* Registers a query or a result, after the bodies and names of a query were collected. error: why
 * a query cannot be decoded; NULL: it can. */
static void take_message(struct replay *replay, enum log_kind kind, const struct log_event *event,
                         const char *error)
{
    struct message message = {.place = place_of(replay, event)};
    const char *no_ids = read_key(kind, event, &message);
    const bool is_query = log_kind_is_query(kind);
    error = no_ids ? no_ids : error;
    if (error && message.place.in_range)
        replay_refuse(replay, kind, &message, error);
    if (no_ids)
        return;
    if (is_query) {
        replay_take_query(replay, &message, error);
    } else if (!replay->options->golden) {
        replay_channel(replay, &message.key, &message.place)->results += message.place.in_range;
        replay_take_result(replay, &message);
    }
}

static void count_definition(struct replay *replay, const struct log_event *event,
                             const char *error)
{
    const struct match_place place = place_of(replay, event);
    replay->tally[place.log].definitions += !error;
    replay->tally[place.log].unreadable_definitions += error != NULL;
    if (error)
        replay->sink->unreadable(replay->sink->user, &place, replay->channels.name[LOG_DEFINITION],
                                 error);
}

static void take_golden(struct replay *replay, enum log_kind kind, const struct log_event *event)
{
    struct message result = {.place = place_of(replay, event)};
    replay->golden_has_queries = replay->golden_has_queries || log_kind_is_query(kind);
    if (!log_kind_is_result(kind))
        return;
    const char *error = read_key(kind, event, &result);
    if (!error)
        error = replay_read_result(replay, &result);
    if (error) {
        fail_golden(replay, event->offset, error);
        return;
    }
    replay_channel(replay, &result.key, &result.place)->results++;
    replay_take_result(replay, &result);
}

static void survey_event(struct replay *replay, const struct log_event *event)
{
    const enum log_kind kind = log_kind_of(&replay->channels, event);
    if (in_golden(replay)) {
        take_golden(replay, kind, event);
        return;
    }
    struct tally *tally = &replay->tally[replay->input.log];
    if (!replay->started)
        replay->first_utime = event->utime;
    replay->started = true;
    tally->events++;
    tally->bytes += event->length;
    tally->statuses += kind == LOG_STATUS;
    tally->other_events += kind == LOG_OTHER;
    if ((replay->old_version = log_kind_old_version(kind, event)) != 0)
        return;
    const uint32_t size = (uint32_t) event->kept;
    const char *error = definitions_add_message(replay->definitions, replay->options->names, kind,
                                                event->data, size);
    if (log_kind_is_query(kind) || log_kind_is_result(kind))
        take_message(replay, kind, event, error);
    else if (kind == LOG_DEFINITION)
        count_definition(replay, event, error);
}

/* ---- The second reading ---- */

static void answer_event(struct replay *replay, const struct log_event *event)
{
    const enum log_kind kind = log_kind_of(&replay->channels, event);
    struct message message = {.place = place_of(replay, event)};
    if (log_kind_is_query(kind) && !read_key(kind, event, &message))
        replay_answer_query(replay, &message);
}

/* ---- Both ---- */

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

static bool open_output(struct replay *replay)
{
    return output_open(&replay->options->write_golden, &replay->golden_file) &&
           (!replay->golden_file ||
            (replay->new_golden = log_begin_output(replay->golden_file)) != NULL);
}

/* Opens the service or the local answerer. */
static bool open_answers(struct replay *replay)
{
    const struct replay_options *options = replay->options;
    if (options->bus)
        replay->bus = answer_bus_open(options->bus, replay_on_answered, replay);
    else
        replay->local = local_answerer_open(options->frames, replay->definitions);
    return replay->bus || replay->local;
}

static bool open_replay(struct replay *replay)
{
    const struct replay_options *options = replay->options;
    const int logs = options->log_count, count = logs + (options->golden != NULL);
    replay->paths = allocate((size_t) logs + 1, sizeof *replay->paths);
    memcpy(replay->paths, options->log, (size_t) logs * sizeof *replay->paths);
    replay->paths[logs] = (char *) (uintptr_t) options->golden;
    if (!input_open(&replay->input, replay->paths, count) ||
        !input_open(&replay->rereader, replay->paths, count))
        return false;
    replay->definitions = definitions_open();
    if (!open_answers(replay) || !open_output(replay))
        return false;
    replay->hasher = hasher_create();
    if (!replay->hasher)
        allocate_failed();
    replay->channels = log_channels(options->prefix);
    replay->match = match_open();
    return true;
}

static void close_replay(struct replay *replay)
{
    if (replay->bus)
        replay->tally[0].bus = answer_bus_counts(replay->bus);
    answer_bus_close(replay->bus);
    local_answerer_close(replay->local);
    for (struct match_item *query; (query = match_pop(&replay->again));)
        free(query);
    free(replay->recorded);
    match_close(replay->match);
    replay_close_pairs(replay);
    input_close(&replay->rereader);
    free(replay->paths);
    hasher_destroy(replay->hasher);
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

static void fail_old_version(struct replay *replay)
{
    complain("%s: recorded by version %d, whose messages are others: replay it with that",
             replay->options->log[replay->input.log], replay->old_version);
    replay->failed = true;
}

/* damage: NULL: it was reported before. */
static void read_logs(struct replay *replay,
                      void (*take)(struct replay *replay, const struct log_event *event),
                      void (*damaged)(struct replay *replay, const struct log_damage *damage))
{
    struct log_event event;
    struct log_damage damage;
    enum log_outcome outcome;
    while ((outcome = input_next(&replay->input, &event, &damage)) < LOG_END) {
        if (outcome == LOG_EVENT)
            take(replay, &event);
        else if (damaged)
            damaged(replay, &damage);
        replay->sink->progress(replay->sink->user, replay->input.passed / 2);
        if (replay->old_version)
            fail_old_version(replay);
        if (replay->old_version || replay_has_ended(replay))
            return;
    }
    if (outcome == LOG_FAILED)
        replay_fail_log(replay, replay->input.log);
}

static void run(struct replay *replay)
{
    read_logs(replay, survey_event, take_damage);
    if (replay->old_version)
        return;
    if (!replay_has_ended(replay)) {
        replay_finish_matches(replay);
        replay->input.count = replay->options->log_count;
        input_begin(&replay->input, 0);
        read_logs(replay, answer_event, NULL);
    }
    replay_finish_answers(replay);
    replay->failed = replay->failed || replay_has_ended(replay);
}

bool replay_run(const struct replay_options *options, const struct replay_sink *sink,
                struct tally *tally)
{
    struct replay *replay = allocate(1, sizeof *replay);
    replay->options = options;
    replay->sink = sink;
    replay->tally = tally;
    if (open_replay(replay))
        run(replay);
    else
        replay->failed = true;
    close_replay(replay);
    const bool good = !replay->failed;
    free(replay);
    return good;
}

bool replay_extent(const struct replay_options *options, int64_t *size, int64_t *first_utime)
{
    struct input input;
    struct log_event event;
    struct log_damage damage;
    enum log_outcome outcome;
    const bool good = input_open(&input, options->log, options->log_count);
    while ((outcome = good ? input_next(&input, &event, &damage) : LOG_END) == LOG_DAMAGE)
        continue;
    *size = good ? input_size(&input) : 0;
    *first_utime = outcome == LOG_EVENT ? event.utime : 0;
    input_close(&input);
    return good;
}
