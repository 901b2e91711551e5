#include "log_cut.h"

#include "allocate.h"
#include "complain.h"
#include "definitions.h"
#include "log_survey.h"
#include "log_write.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct cutter {
    const struct log_cut_options *options;
    const struct log_cut_sink *sink;
    struct log_cut_counts *counts;
    struct log_channels channels;
    struct input input;
    struct log_writer *output; /* NULL: not opened */
    struct log_survey survey;
    int64_t event;      /* number of the event that is being copied, over all logs */
    bool failed, begun; /* begun: the definitions have been written */
    int64_t utime;      /* of the first event that is copied */
    struct definition_writer definitions;
};

/* Reports an error of the output, or of the current input; only the first error. */
static void fail_output(struct cutter *cut, int error)
{
    if (!cut->failed)
        log_write_complain(cut->options->output, error);
    cut->failed = true;
}

static void fail_input(struct cutter *cut, int error)
{
    if (!cut->failed)
        complain("%s: %s", cut->options->log[cut->input.log], strerror(error));
    cut->failed = true;
}

/* The logs are read twice, so that progress counts half of the bytes read. */
static void on_progress(void *user)
{
    struct cutter *cut = user;
    cut->sink->progress(cut->sink->user, cut->input.passed / 2, input_size(&cut->input));
}

/* ---- Writing ---- */

static void append(struct cutter *cut, const struct log_event *event, const void *data, size_t size)
{
    if (!log_append(cut->output, event->utime, event->channel, event->channel_length, data, size))
        fail_output(cut, errno);
}

static void copy(struct cutter *cut, const struct log_event *event)
{
    if (event->kept == event->size) {
        append(cut, event, event->data, event->size);
        return;
    }
    const void *data = log_map(cut->input.reader[cut->input.log], event);
    if (!data) {
        fail_input(cut, errno);
        return;
    }
    append(cut, event, data, event->size);
    log_unmap(data, event);
}

/* ---- Definitions ---- */

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
    const struct log_survey *survey = &cut->survey;
    for (size_t i = 0; i < survey->wanted_count; i++) {
        const struct geometry *geometry = definitions_find(survey->definitions, &survey->wanted[i]);
        cut->counts->defined += geometry != NULL;
        cut->counts->unknown += !geometry;
        if (geometry)
            definition_writer_add(&cut->definitions, &survey->wanted[i], geometry);
    }
    definition_writer_flush(&cut->definitions);
}

/* ---- Copying ---- */

static void take_event(struct cutter *cut, const struct log_event *event)
{
    struct log_cut_counts *counts = cut->counts;
    const int64_t number = cut->event++;
    counts->events++;
    counts->bytes += event->length;
    if (!log_survey_is_chosen(&cut->survey, number))
        return;
    if (!cut->begun) {
        cut->utime = event->utime;
        define(cut);
    }
    cut->begun = true;
    const enum log_kind kind = log_kind_of(&cut->channels, event);
    counts->kept_events++;
    counts->kept[kind]++;
    counts->version_1 += log_kind_is_version_1(kind, event);
    copy(cut, event);
}

static void take_damage(struct cutter *cut, const struct log_damage *damage)
{
    cut->counts->damages++;
    cut->counts->damaged_bytes += damage->length;
    cut->counts->bytes += damage->length;
    cut->sink->damage(cut->sink->user, cut->input.log, damage);
}

static void copy_all(struct cutter *cut)
{
    struct log_event event;
    struct log_damage damage;
    enum log_outcome outcome = LOG_END;
    input_rewind(&cut->input);
    while (!cut->failed && (outcome = input_next(&cut->input, &event, &damage)) < LOG_END) {
        if (outcome == LOG_EVENT)
            take_event(cut, &event);
        else
            take_damage(cut, &damage);
        on_progress(cut);
    }
    if (outcome == LOG_FAILED)
        fail_input(cut, errno);
    cut->counts->kept_bytes = log_written(cut->output);
}

/* ---- The cut ---- */

/* Whether the output is one of the logs, by any name: it would be truncated before it is read. */
static bool writes_into_log(const struct log_cut_options *options)
{
    for (int i = 0; i < options->log_count; i++)
        if (log_is_same_file(options->output, options->log[i]))
            return true;
    return false;
}

static bool open_cut(struct cutter *cut)
{
    const struct log_cut_options *options = cut->options;
    if (!input_open(&cut->input, options->log, options->log_count))
        return false;
    if (writes_into_log(options)) {
        complain("%s: is one of the logs that are cut", options->output);
        return false;
    }
    cut->channels = log_channels(options->prefix);
    cut->output = log_create(options->output, options->force);
    if (!cut->output)
        log_write_complain(options->output, errno);
    return cut->output != NULL;
}

static void run(struct cutter *cut)
{
    const struct log_survey_options options = {.input = &cut->input,
                                               .log = cut->options->log,
                                               .channels = &cut->channels,
                                               .choice = &cut->options->choice,
                                               .progress = on_progress,
                                               .user = cut};
    if (log_survey(&options, &cut->survey))
        copy_all(cut);
    else
        cut->failed = true;
    log_survey_clear(&cut->survey);
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
    const bool good = !cut->failed;
    free(cut);
    return good;
}
