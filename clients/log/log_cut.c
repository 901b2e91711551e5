#include "log_cut.h"

#include "allocate.h"
#include "body_names.h"
#include "complain.h"
#include "definitions.h"
#include "input.h"
#include "log_write.h"
#include "logged_query.h"
#include "match.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

struct cutter {
    const struct log_cut_options *options;
    const struct log_cut_sink *sink;
    struct log_cut_counts *counts;
    struct log_channels channels;
    struct input input;
    struct output *file;       /* NULL: not opened */
    struct log_writer *output; /* of the file */
    bool failed;
    int64_t event; /* number of the current event, over all logs */

    struct definitions *definitions; /* of all bodies of the logs */
    struct body_names *names;        /* of all bodies of the logs */
    struct logged_query query;

    /* The first pass chooses events. */
    struct match *match;
    bool has[LOG_STATUS];  /* [kind]: whether the channel is chosen */
    int64_t first_utime;   /* of the first event */
    unsigned char *chosen; /* owned; one bit for each event */
    size_t chosen_size;    /* bytes */

    /* The second pass copies. */
    int64_t utime; /* of the event that is copied */
};

/* Reports an error of the output, or of the current input; only the first error. */
static void fail_output(struct cutter *cut, int error)
{
    if (!cut->failed)
        output_complain(cut->options->output.path, error);
    cut->failed = true;
}

static void fail_input(struct cutter *cut, int error)
{
    if (!cut->failed)
        complain("%s: %s", cut->options->log[cut->input.log], strerror(error));
    cut->failed = true;
}

/* One of two passes over the logs, so that progress counts half of the bytes read. take_damage: may
 * be NULL. */
static void read_logs(struct cutter *cut,
                      void (*take_event)(struct cutter *cut, const struct log_event *event),
                      void (*take_damage)(struct cutter *cut, const struct log_damage *damage))
{
    struct log_event event;
    struct log_damage damage;
    enum log_outcome outcome = LOG_END;
    while (!cut->failed && (outcome = input_next(&cut->input, &event, &damage)) < LOG_END) {
        if (outcome == LOG_EVENT)
            take_event(cut, &event);
        else if (take_damage)
            take_damage(cut, &damage);
        cut->sink->progress(cut->sink->user, cut->input.passed / 2, input_size(&cut->input));
    }
    if (outcome == LOG_FAILED)
        fail_input(cut, errno);
}

/* ---- Which events are chosen ---- */

static void choose(struct cutter *cut, int64_t event)
{
    const size_t byte = (size_t) (event / 8), old = cut->chosen_size;
    if (byte >= old) {
        cut->chosen = allocate_grow(cut->chosen, &cut->chosen_size, byte + 1, 1);
        memset(cut->chosen + old, 0, cut->chosen_size - old);
    }
    cut->chosen[byte] |= (unsigned char) (1 << event % 8);
}

static bool is_chosen(const struct cutter *cut, int64_t event)
{
    const size_t byte = (size_t) (event / 8);
    return byte < cut->chosen_size && (cut->chosen[byte] >> event % 8 & 1);
}

/* Whether an event is chosen by its own time: any event except queries, and results with a query.
 */
static bool is_chosen_by_time(const struct cutter *cut, int64_t utime)
{
    const struct log_choice *choice = &cut->options->choice;
    return choice->body_count == 0 && log_choice_has_time(choice, cut->first_utime, utime);
}

/* Whether a query is chosen by time and bodies. Each result of a chosen query is chosen too, if its
 * channel is. */
static bool is_chosen_query(struct cutter *cut, int64_t utime)
{
    const struct log_choice *choice = &cut->options->choice;
    int32_t count;
    const struct query_placement *placement = logged_query_placements(&cut->query, &count);
    return log_choice_has_time(choice, cut->first_utime, utime) &&
           log_choice_has_body(choice, placement, count);
}

/* Chooses a result. In: query->in_range: whether the query is chosen; query: NULL without one. */
static void choose_result(struct cutter *cut, enum log_kind kind, const struct match_place *query,
                          const struct match_place *result)
{
    const bool chosen = query ? query->in_range : is_chosen_by_time(cut, result->utime);
    if (chosen && cut->has[kind])
        choose(cut, result->number);
}

/* ---- The first pass ---- */

/* Chooses a query. Out: place->in_range. */
static void take_query(struct cutter *cut, enum log_kind kind, struct match_place *place)
{
    place->in_range = is_chosen_query(cut, place->utime);
    if (place->in_range && cut->has[kind])
        choose(cut, place->number);
}

/* Returns false if the event is not a query or result, or cannot be decoded. */
static bool take_message(struct cutter *cut, const struct log_event *event, enum log_kind kind)
{
    const bool is_result = log_kind_is_result(kind);
    struct match_key key;
    struct match_place place = {.log = cut->input.log,
                                .number = cut->event,
                                .offset = event->offset,
                                .utime = event->utime};
    if (kind >= LOG_STATUS || match_key_of(kind, event, &key) ||
        (!is_result && logged_query_read(&cut->query, kind, event->data, (uint32_t) event->kept)))
        return false;
    if (!is_result)
        take_query(cut, kind, &place);
    struct match_item *other = match_take(cut->match, &key, &place, is_result);
    if (other)
        choose_result(cut, log_kind_result_of(log_kind_query_of(kind)),
                      is_result ? &other->place : &place, is_result ? &place : &other->place);
    free(other);
    return true;
}

/* A part of a log has the names of all of it at its beginning. */
static void survey_event(struct cutter *cut, const struct log_event *event)
{
    const struct log_choice *choice = &cut->options->choice;
    const enum log_kind kind = log_kind_of(&cut->channels, event);
    const uint32_t size = (uint32_t) event->kept;
    if (cut->event == 0)
        cut->first_utime = event->utime;
    if (!take_message(cut, event, kind) && log_choice_has_channel(choice, event) &&
        is_chosen_by_time(cut, event->utime) && (kind != LOG_NAMES || log_choice_is_all(choice)))
        choose(cut, cut->event);
    definitions_add_message(cut->definitions, cut->names, kind, event->data, size);
    cut->event++;
}

static void on_unmatched(void *user, struct match_item *query, struct match_item *result)
{
    struct cutter *cut = user;
    choose_result(cut, log_kind_result_of((enum log_kind) result->key.kind),
                  query ? &query->place : NULL, &result->place);
    free(query);
    free(result);
}

static void choose_channels(struct cutter *cut)
{
    const struct log_channels *channels = &cut->channels;
    for (int kind = 0; kind < LOG_STATUS; kind++) {
        const struct log_event event = {.channel = channels->name[kind],
                                        .channel_length = channels->length[kind]};
        cut->has[kind] = log_choice_has_channel(&cut->options->choice, &event);
    }
}

/* Allocates the chosen events, which the caller frees. */
static void survey(struct cutter *cut)
{
    cut->match = match_open();
    choose_channels(cut);
    read_logs(cut, survey_event, NULL);
    if (!cut->failed)
        match_finish(cut->match, on_unmatched, cut);
    match_close(cut->match);
}

/* ---- Writing ---- */

static void append(struct cutter *cut, const struct log_event *event, const void *data, size_t size)
{
    if (!log_append(cut->output, event->utime, event->channel, event->channel_length, data, size))
        fail_output(cut, errno);
}

/* An event that is larger than what the reader keeps is read again. */
static void copy(struct cutter *cut, const struct log_event *event)
{
    if (event->kept == event->size) {
        append(cut, event, event->data, event->size);
        return;
    }
    unsigned char *data = allocate_unset(event->size);
    if (log_read_data(cut->input.reader, event, 0, data, event->size))
        append(cut, event, data, event->size);
    else
        fail_input(cut, errno);
    free(data);
}

static bool append_own(void *user, enum log_kind kind, const void *bytes, size_t size)
{
    struct cutter *cut = user;
    const struct log_event event = {.utime = cut->utime,
                                    .channel = cut->channels.name[kind],
                                    .channel_length = cut->channels.length[kind]};
    cut->counts->definitions += kind == LOG_DEFINITION;
    append(cut, &event, bytes, size);
    return !cut->failed;
}

/* ---- The second pass ---- */

/* Begins the output with the names of all bodies, unless the whole log follows, which has them. */
static void begin_output(struct cutter *cut)
{
    if (log_choice_is_all(&cut->options->choice))
        return;
    cut->counts->names = body_names_count(cut->names);
    body_names_write(cut->names, cut->utime, append_own, cut);
}

/* Writes the definitions that a query needs before it. A query does not define the handles that it
 * names: a service that lacks one of its bodies keeps none of them. */
static void define(struct cutter *cut, enum log_kind kind, const struct log_event *event)
{
    const uint32_t size = (uint32_t) event->kept;
    if (!log_kind_is_query(kind)) {
        definitions_add_message(cut->definitions, NULL, kind, event->data, size);
        return;
    }
    if (logged_query_read(&cut->query, kind, event->data, size))
        return;
    int32_t count;
    const struct query_placement *placement = logged_query_placements(&cut->query, &count);
    const int32_t bodies = definitions_write(cut->definitions, placement, count, append_own, cut);
    cut->counts->defined += bodies > 0 ? bodies : 0;
    for (int32_t i = 0; i < count; i++)
        if (query_by_handle(&placement[i]))
            definitions_want(cut->definitions, &placement[i].body.handle);
    definitions_add_query(cut->definitions, &cut->query);
}

static void copy_event(struct cutter *cut, const struct log_event *event)
{
    struct log_cut_counts *counts = cut->counts;
    counts->events++;
    counts->bytes += event->length;
    if (!is_chosen(cut, cut->event++))
        return;
    const enum log_kind kind = log_kind_of(&cut->channels, event);
    const int old_version = log_kind_old_version(kind, event);
    cut->utime = event->utime;
    if (counts->kept_events++ == 0)
        begin_output(cut);
    counts->kept[kind]++;
    counts->old_messages += old_version > 0;
    counts->old_version = old_version ? old_version : counts->old_version;
    define(cut, kind, event);
    copy(cut, event);
}

static void take_damage(struct cutter *cut, const struct log_damage *damage)
{
    cut->counts->damages++;
    cut->counts->damaged_bytes += damage->length;
    cut->counts->bytes += damage->length;
    cut->sink->damage(cut->sink->user, cut->input.log, damage);
}

/* ---- The cut ---- */

static bool open_cut(struct cutter *cut)
{
    const struct log_cut_options *options = cut->options;
    if (!input_open(&cut->input, options->log, options->log_count))
        return false;
    cut->channels = log_channels(options->prefix);
    if (output_open(&options->output, &cut->file))
        cut->output = log_begin_output(cut->file);
    return cut->output != NULL;
}

static void run(struct cutter *cut)
{
    cut->definitions = definitions_open();
    cut->names = body_names_open();
    survey(cut);
    input_begin(&cut->input, 0);
    cut->event = 0;
    definitions_begin_file(cut->definitions);
    read_logs(cut, copy_event, take_damage);
    cut->counts->kept_bytes = log_written(cut->output);
    cut->counts->unknown = (int64_t) definitions_wanted(cut->definitions);
    free(cut->chosen);
    definitions_close(cut->definitions);
    body_names_close(cut->names);
}

bool log_cut(const struct log_cut_options *options, const struct log_cut_sink *sink,
             struct log_cut_counts *counts)
{
    struct cutter *cut = allocate(1, sizeof *cut);
    *counts = (struct log_cut_counts){.events = 0};
    cut->options = options;
    cut->sink = sink;
    cut->counts = counts;
    if (open_cut(cut))
        run(cut);
    else
        cut->failed = true;
    input_close(&cut->input);
    const int error = log_finish(cut->output);
    if (error)
        fail_output(cut, error);
    const bool keep = !cut->failed && counts->kept_events > 0;
    const bool good = output_close(cut->file, keep) && !cut->failed;
    free(cut);
    return good;
}
