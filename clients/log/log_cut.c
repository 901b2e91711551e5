#include "log_cut.h"

#include "allocate.h"
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

    /* The first pass chooses events, and the bodies that the cut must define. */
    struct match *match;
    bool has[LOG_STATUS]; /* [kind]: whether the channel is chosen */
    int64_t first_utime;  /* of the first event */
    struct logged_query query;
    unsigned char *chosen; /* owned; one bit for each event */
    size_t chosen_size;    /* bytes */
    /* Distinct handles that chosen queries name and no earlier chosen event defines, ascending. */
    struct handle *wanted; /* owned */
    size_t wanted_count, wanted_capacity;
    struct definitions *all_definitions, *chosen_definitions; /* of all events; of those chosen */

    /* The second pass copies. */
    bool begun;    /* the definitions have been written */
    int64_t utime; /* of the first event that is copied */
    struct definition_writer definitions;
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
    const struct placement *placement = logged_query_placements(&cut->query, &count);
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

/* ---- Bodies that the cut must define ---- */

static int compare(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(struct handle));
}

static void sort_wanted(struct cutter *cut)
{
    size_t count = 0;
    if (cut->wanted_count > 0)
        qsort(cut->wanted, cut->wanted_count, sizeof *cut->wanted, compare);
    for (size_t i = 0; i < cut->wanted_count; i++)
        if (count == 0 || !handle_equal(&cut->wanted[i], &cut->wanted[count - 1]))
            cut->wanted[count++] = cut->wanted[i];
    cut->wanted_count = count;
}

/* Adds a handle. Duplicates are removed when the list is full, so it has at most twice the capacity
 * of the distinct ones. */
static void want(struct cutter *cut, const struct handle *handle)
{
    if (cut->wanted_count == cut->wanted_capacity) {
        sort_wanted(cut);
        if (2 * cut->wanted_count >= cut->wanted_capacity)
            cut->wanted = allocate_grow(cut->wanted, &cut->wanted_capacity,
                                        cut->wanted_capacity + 1, sizeof *cut->wanted);
    }
    cut->wanted[cut->wanted_count++] = *handle;
}

/* A query does not define the handles that it names: a service that lacks one of its bodies keeps
 * none of them. */
static void define_from_query(struct cutter *cut, bool chosen)
{
    int32_t count;
    const struct placement *placement = logged_query_placements(&cut->query, &count);
    for (int32_t i = 0; chosen && i < count; i++)
        if (placement_by_handle(&placement[i]) &&
            !definitions_find(cut->chosen_definitions, &placement[i].handle))
            want(cut, &placement[i].handle);
    for (int32_t i = 0; i < count; i++) {
        definitions_add_placement(cut->all_definitions, &placement[i]);
        if (chosen)
            definitions_add_placement(cut->chosen_definitions, &placement[i]);
    }
}

static void define_from_message(struct cutter *cut, const struct log_event *event, bool chosen)
{
    const uint32_t size = (uint32_t) event->kept;
    definitions_add_message(cut->all_definitions, event->data, size);
    if (chosen)
        definitions_add_message(cut->chosen_definitions, event->data, size);
}

/* ---- The first pass ---- */

static void take_query(struct cutter *cut, const struct match_key *key, struct match_place *place)
{
    struct match_item *result = match_find(cut->match, key);
    const enum log_kind kind = (enum log_kind) key->kind;
    place->in_range = is_chosen_query(cut, place->utime);
    if (place->in_range && cut->has[kind])
        choose(cut, place->number);
    define_from_query(cut, place->in_range && cut->has[kind]);
    if (!result || !result->is_result) {
        match_add(cut->match, key, place, false);
        return;
    }
    choose_result(cut, log_kind_result_of(kind), place, &result->place);
    match_remove(cut->match, result);
    match_free(result);
}

static void take_result(struct cutter *cut, const struct match_key *key,
                        const struct match_place *place)
{
    struct match_item *query = match_find(cut->match, key);
    if (!query || query->is_result) {
        match_add(cut->match, key, place, true);
        return;
    }
    choose_result(cut, log_kind_result_of((enum log_kind) key->kind), &query->place, place);
    match_remove(cut->match, query);
    match_free(query);
}

/* Returns false if the event is not a query or result, or cannot be decoded. */
static bool take_message(struct cutter *cut, const struct log_event *event, enum log_kind kind)
{
    struct query_header ids;
    struct match_place place = {.log = cut->input.log,
                                .number = cut->event,
                                .offset = event->offset,
                                .utime = event->utime};
    if (kind >= LOG_STATUS || log_kind_ids(kind, event, &ids))
        return false;
    const struct match_key key = {log_kind_query_of(kind), ids.client_id, ids.sequence_number,
                                  ids.utime};
    if (log_kind_is_result(kind)) {
        take_result(cut, &key, &place);
        return true;
    }
    if (logged_query_read(&cut->query, kind, event->data, (uint32_t) event->kept))
        return false;
    take_query(cut, &key, &place);
    return true;
}

static void survey_event(struct cutter *cut, const struct log_event *event)
{
    const enum log_kind kind = log_kind_of(&cut->channels, event);
    if (cut->event == 0)
        cut->first_utime = event->utime;
    if (!take_message(cut, event, kind)) {
        const bool chosen = log_choice_has_channel(&cut->options->choice, event) &&
                            is_chosen_by_time(cut, event->utime);
        if (chosen)
            choose(cut, cut->event);
        if (kind == LOG_DEFINITION)
            define_from_message(cut, event, chosen);
    }
    cut->event++;
}

static void on_unmatched(void *user, struct match_item *query, struct match_item *result)
{
    struct cutter *cut = user;
    choose_result(cut, log_kind_result_of((enum log_kind) result->key.kind),
                  query ? &query->place : NULL, &result->place);
    if (query)
        match_free(query);
    match_free(result);
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

/* Allocates the chosen events and the definitions, which the caller frees. */
static void survey(struct cutter *cut)
{
    cut->all_definitions = definitions_open();
    cut->match = match_open();
    cut->chosen_definitions =
        log_choice_is_all(&cut->options->choice) ? cut->all_definitions : definitions_open();
    choose_channels(cut);
    read_logs(cut, survey_event, NULL);
    if (!cut->failed)
        match_finish(cut->match, on_unmatched, cut);
    sort_wanted(cut);
    if (cut->chosen_definitions != cut->all_definitions)
        definitions_close(cut->chosen_definitions);
    match_close(cut->match);
}

/* ---- Writing ---- */

static void append(struct cutter *cut, const struct log_event *event, const void *data, size_t size)
{
    if (!log_append(cut->output, event->utime, event->channel, event->channel_length, data, size))
        fail_output(cut, errno);
}

/* An event that is larger than what the reader keeps. */
struct large_event {
    struct cutter *cut;
    const struct log_event *event;
};

static bool read_large(void *user, size_t from, unsigned char *out, size_t count)
{
    const struct large_event *large = user;
    struct cutter *cut = large->cut;
    if (log_read_data(cut->input.reader[cut->input.log], large->event, from, out, count))
        return true;
    fail_input(cut, errno);
    return false;
}

static void copy(struct cutter *cut, const struct log_event *event)
{
    struct large_event large = {cut, event};
    if (event->kept == event->size)
        append(cut, event, event->data, event->size);
    else if (!log_append_large(cut->output, event->utime, event->channel, event->channel_length,
                               event->size, read_large, &large))
        fail_output(cut, errno);
}

static bool write_definition(void *user, const void *bytes, size_t size)
{
    struct cutter *cut = user;
    const struct log_event event = {.utime = cut->utime,
                                    .channel = cut->channels.name[LOG_DEFINITION],
                                    .channel_length = cut->channels.length[LOG_DEFINITION]};
    append(cut, &event, bytes, size);
    cut->counts->definitions++;
    return true;
}

static void define(struct cutter *cut)
{
    for (size_t i = 0; i < cut->wanted_count; i++) {
        const struct geometry *geometry = definitions_find(cut->all_definitions, &cut->wanted[i]);
        cut->counts->defined += geometry != NULL;
        cut->counts->unknown += !geometry;
        if (geometry)
            definition_writer_add(&cut->definitions, &cut->wanted[i], geometry);
    }
    definition_writer_flush(&cut->definitions);
}

/* ---- The second pass ---- */

static void copy_event(struct cutter *cut, const struct log_event *event)
{
    struct log_cut_counts *counts = cut->counts;
    counts->events++;
    counts->bytes += event->length;
    if (!is_chosen(cut, cut->event++))
        return;
    if (!cut->begun) {
        cut->utime = event->utime;
        define(cut);
    }
    cut->begun = true;
    const enum log_kind kind = log_kind_of(&cut->channels, event);
    counts->kept_events++;
    counts->kept[kind]++;
    const int old_version = log_kind_old_version(kind, event);
    counts->old_messages += old_version > 0;
    counts->old_version = old_version ? old_version : counts->old_version;
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
    survey(cut);
    input_rewind(&cut->input);
    cut->event = 0;
    read_logs(cut, copy_event, take_damage);
    cut->counts->kept_bytes = log_written(cut->output);
    free(cut->chosen);
    free(cut->wanted);
    definitions_close(cut->all_definitions);
}

bool log_cut(const struct log_cut_options *options, const struct log_cut_sink *sink,
             struct log_cut_counts *counts)
{
    struct cutter *cut = allocate(1, sizeof *cut);
    *counts = (struct log_cut_counts){.events = 0};
    cut->options = options;
    cut->sink = sink;
    cut->counts = counts;
    cut->definitions.sink = write_definition;
    cut->definitions.user = cut;
    if (open_cut(cut))
        run(cut);
    else
        cut->failed = true;
    input_close(&cut->input);
    const int error = log_finish(cut->output);
    if (error)
        fail_output(cut, error);
    const bool good = output_close(cut->file, !cut->failed) && !cut->failed;
    free(cut);
    return good;
}
