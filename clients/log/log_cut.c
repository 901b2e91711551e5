#include "log_cut.h"

#include "allocate.h"
#include "any_query.h"
#include "definition.h"
#include "log_survey.h"
#include "log_write.h"
#include "message.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Bytes between two words of progress. */
enum { PROGRESS_BYTES = 1 << 20 };

struct cut {
    const struct log_cut_options *options;
    const struct log_cut_sink *sink;
    struct log_cut_counts *counts;
    struct log_channels channels;
    struct input input;
    struct log_writer *output; /* NULL: not opened */
    struct log_survey survey;
    int64_t event; /* number of the one that is being copied, over all logs */
    int64_t passed, told;
    bool failed;
    struct any_query query, definition;
    unsigned char bytes[QUERY_BYTES_MAX];
};

/* Says what cannot be read or written, once. */
static void fail(struct cut *cut, const char *what, int error)
{
    if (!cut->failed)
        fprintf(stderr, "fmb: %s: %s\n", what, strerror(error));
    cut->failed = true;
}

static void fail_output(struct cut *cut, int error)
{
    if (!cut->failed)
        log_write_complain(cut->options->output, error);
    cut->failed = true;
}

/* Of the file that is being read. */
static void fail_input(struct cut *cut, int error)
{
    fail(cut, cut->options->log[cut->input.log], error);
}

/* All is read twice. */
static void on_progress(void *user, int64_t bytes)
{
    struct cut *cut = user;
    cut->passed += bytes;
    if (cut->passed - cut->told < PROGRESS_BYTES)
        return;
    cut->told = cut->passed;
    cut->sink->progress(cut->sink->user, cut->passed / 2, input_size(&cut->input));
}

/* ---- Writing ---- */

static void append(struct cut *cut, const struct log_event *event, const void *data, size_t size)
{
    if (!log_append(cut->output, event->utime, event->channel, event->channel_length, data, size))
        fail_output(cut, errno);
}

static void copy(struct cut *cut, const struct log_event *event)
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

/* ---- What is written back ---- */

static bool find_components(struct cut *cut, int64_t place, struct query_numbers *out)
{
    if (log_patches_find(cut->survey.patches, place, out))
        return true;
    fail(cut, "a temporary file", log_patches_error(cut->survey.patches));
    return false;
}

static void write_definition(struct cut *cut, const struct log_event *event)
{
    append(cut, event, cut->bytes, any_query_write(&cut->definition, cut->bytes));
    cut->counts->definitions++;
    cut->counts->defined += cut->definition.scene.frame_count;
    definition_begin(&cut->definition.scene);
}

static void define(struct cut *cut, const struct log_event *event, const struct query_frame *frame,
                   const struct log_patch *patch)
{
    struct scene_query *definition = &cut->definition.scene;
    struct query_numbers components;
    cut->definition.kind = LOG_SCENE_QUERY;
    definition_begin(definition);
    for (int32_t i = 0; i < patch->count; i++) {
        const struct query_frame *by_key = &frame[patch->put[i].frame];
        if (!find_components(cut, patch->put[i].components, &components))
            return;
        if (definition_add(definition, by_key, &components))
            continue;
        write_definition(cut, event);
        definition_add(definition, by_key, &components);
    }
    write_definition(cut, event);
    copy(cut, event);
}

static void write_back(struct cut *cut, const struct log_event *event, struct query_frame *frame,
                       const struct log_patch *patch)
{
    for (int32_t i = 0; i < patch->count; i++)
        if (!find_components(cut, patch->put[i].components, &frame[patch->put[i].frame].components))
            return;
    append(cut, event, cut->bytes, any_query_write(&cut->query, cut->bytes));
    cut->counts->queries++;
    cut->counts->frames += patch->count;
}

/* Whether the query that was read has all frames that the patch is for. */
static bool fits(const struct log_patch *patch, int32_t count)
{
    for (int32_t i = 0; i < patch->count; i++)
        if (patch->put[i].frame >= count)
            return false;
    return true;
}

/* The query was read before: where it is another now, somebody has written into the log. */
static void copy_patched(struct cut *cut, const struct log_event *event,
                         const struct log_patch *patch)
{
    const enum log_kind kind = log_kind_of(&cut->channels, event);
    int32_t count;
    if (!message_is_query(kind) ||
        any_query_read(&cut->query, kind, event->data, event->kept) != NULL) {
        fail_input(cut, ENODATA);
        return;
    }
    struct query_frame *frame = any_query_frames(&cut->query, &count);
    if (!any_query_is_whole(&cut->query) || !fits(patch, count))
        fail_input(cut, ENODATA);
    else if (patch->define)
        define(cut, event, frame, patch);
    else
        write_back(cut, event, frame, patch);
}

/* ---- Copying ---- */

static void take_event(struct cut *cut, const struct log_event *event)
{
    struct log_cut_counts *counts = cut->counts;
    const int64_t number = cut->event++;
    counts->events++;
    counts->bytes += event->length;
    if (!log_marks_has(cut->survey.marks, number))
        return;
    counts->kept_events++;
    counts->kept[log_kind_of(&cut->channels, event)]++;
    const struct log_patch *patch = log_patches_of(cut->survey.patches, number);
    if (patch)
        copy_patched(cut, event, patch);
    else
        copy(cut, event);
}

static void take_damage(struct cut *cut, const struct log_damage *damage)
{
    cut->counts->damages++;
    cut->counts->damaged_bytes += damage->length;
    cut->counts->bytes += damage->length;
    cut->sink->damage(cut->sink->user, cut->input.log, damage);
}

static void copy_all(struct cut *cut)
{
    struct log_event event;
    struct log_damage damage;
    enum log_outcome outcome = LOG_END;
    input_rewind(&cut->input);
    while (!cut->failed && ((outcome = input_next(&cut->input, &event, &damage)) == LOG_EVENT ||
                            outcome == LOG_DAMAGE)) {
        if (outcome == LOG_EVENT)
            take_event(cut, &event);
        else
            take_damage(cut, &damage);
        on_progress(cut, outcome == LOG_EVENT ? event.length : damage.length);
    }
    if (outcome == LOG_FAILED)
        fail_input(cut, errno);
    const int error = log_marks_error(cut->survey.marks);
    const int other = log_patches_error(cut->survey.patches);
    if (error || other)
        fail(cut, "a temporary file", error ? error : other);
    cut->counts->kept_bytes = log_written(cut->output);
}

/* ---- The run ---- */

static bool is_same_file(const char *path, const char *other)
{
    struct stat a, b;
    return stat(path, &a) == 0 && stat(other, &b) == 0 && a.st_dev == b.st_dev &&
           a.st_ino == b.st_ino;
}

/* Also by another name: it would be emptied before it is read. */
static bool writes_into_log(const struct log_cut_options *options)
{
    for (int i = 0; i < options->log_count; i++)
        if (is_same_file(options->output, options->log[i]))
            return true;
    return false;
}

static bool open_cut(struct cut *cut)
{
    const struct log_cut_options *options = cut->options;
    char why[LOG_WHY_MAX];
    if (!input_open(&cut->input, options->log, options->log_count, why)) {
        fprintf(stderr, "fmb: %s\n", why);
        return false;
    }
    if (writes_into_log(options)) {
        fprintf(stderr, "fmb: %s: is one of the logs that are cut\n", options->output);
        return false;
    }
    cut->channels = log_channels(options->prefix);
    cut->output = log_create(options->output, options->force);
    if (!cut->output)
        log_write_complain(options->output, errno);
    return cut->output != NULL;
}

static void run(struct cut *cut)
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
    cut->counts->unknown_frames = cut->survey.unknown_frames;
    cut->counts->unknown_queries = cut->survey.unknown_queries;
    log_survey_clear(&cut->survey);
}

bool log_cut(const struct log_cut_options *options, const struct log_cut_sink *sink,
             struct log_cut_counts *counts)
{
    struct cut *cut = allocate(1, sizeof *cut);
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
    const bool good = !cut->failed;
    free(cut);
    return good;
}
