#include "log_cut.h"

#include "allocate.h"
#include "body_names.h"
#include "complain.h"
#include "definitions.h"
#include "input.h"
#include "log_write.h"
#include "logged_query.h"
#include "match.h"
#include "progress.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* Most damaged places that are reported; the others are counted. */
enum { COMPLAINTS_MAX = 20 };

struct cutter {
    const struct log_cut_options *options;
    struct log_cut_counts *counts;
    struct log_channels channels;
    struct input input;
    struct output *file;       /* NULL: not opened */
    struct log_writer *output; /* of the file */
    bool failed;

    struct definitions *definitions; /* of all bodies of the logs */
    struct body_names *names;        /* of all bodies of the logs */
    struct logged_query query;

    struct match match;
    struct logged_result result;
    bool started;
    int64_t first_utime; /* of the first event */

    /* The second pass copies. */
    size_t next;   /* item of match */
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
        progress_to(cut->input.passed / 2, input_size(&cut->input));
    }
    if (outcome == LOG_FAILED)
        fail_input(cut, errno);
}

/* ---- The first pass ---- */

/* Takes the bodies and names, and adds queries and results that can be decoded. */
static void survey_event(struct cutter *cut, const struct log_event *event)
{
    const enum log_kind kind = log_kind_of(&cut->channels, event);
    struct match_item item;
    if (!cut->started)
        cut->first_utime = event->utime;
    cut->started = true;
    const char *error = definitions_add_message(cut->definitions, cut->names, kind, event->data,
                                                (uint32_t) event->kept);
    if (kind >= LOG_STATUS || error || match_read(&item, kind, cut->input.log, event, &cut->result))
        return;
    item.chosen = log_choice_has_time(&cut->options->choice, cut->first_utime, event->utime);
    match_add(&cut->match, &item);
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
    if (log_read_data(cut->input.reader, event, data))
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
    append(cut, &event, bytes, size);
    return !cut->failed;
}

/* ---- The second pass ---- */

/* Writes the definitions that a query needs before it, and notes the bodies that the event defines.
 * A query does not define the handles that it names: a service that lacks one of its bodies keeps
 * none of them. */
static void define(struct cutter *cut, enum log_kind kind, const struct log_event *event)
{
    const uint32_t size = (uint32_t) event->kept;
    if (!log_kind_is_query(kind)) {
        definitions_add_message(cut->definitions, NULL, kind, event->data, size);
        return;
    }
    if (logged_query_read(&cut->query, kind, event->data, size))
        return;
    const struct query_placement *placement = cut->query.placement;
    const int32_t count = cut->query.placement_count;
    const int32_t bodies = definitions_write(cut->definitions, placement, count, append_own, cut);
    cut->counts->defined += bodies > 0 ? bodies : 0;
    for (int32_t i = 0; i < count; i++)
        if (query_by_handle(&placement[i]))
            definitions_want(cut->definitions, &placement[i].body.handle);
    definitions_add_query(cut->definitions, &cut->query);
}

/* A result is chosen with its query. Results without a query and other messages are chosen by their
 * own time. To be called for each event, in order: the items of the first pass are in that order.
 */
static bool is_chosen(struct cutter *cut, enum log_kind kind, const struct log_event *event)
{
    const struct log_choice *choice = &cut->options->choice;
    const struct match_item *item =
        cut->next < cut->match.count ? &cut->match.item[cut->next] : NULL;
    const struct match_item *query = NULL;
    if (item && item->place.log == cut->input.log && item->place.offset == event->offset) {
        query = item->is_result ? item->other : item;
        cut->next++;
    }
    if (!log_choice_has_channel(choice, event->channel))
        return false;
    if (query)
        return query->chosen;
    return log_choice_has_time(choice, cut->first_utime, event->utime) &&
           (kind != LOG_NAMES || log_choice_is_all(choice));
}

static void copy_event(struct cutter *cut, const struct log_event *event)
{
    struct log_cut_counts *counts = cut->counts;
    counts->events++;
    counts->bytes += event->length;
    const enum log_kind kind = log_kind_of(&cut->channels, event);
    if (!is_chosen(cut, kind, event))
        return;
    cut->utime = event->utime;
    /* The output begins with the names of all bodies, unless the whole log follows, which has them.
     */
    if (counts->kept_events++ == 0 && !log_choice_is_all(&cut->options->choice)) {
        counts->names = body_names_count(cut->names);
        body_names_write(cut->names, cut->utime, append_own, cut);
    }
    counts->kept[kind]++;
    define(cut, kind, event);
    copy(cut, event);
}

static void take_damage(struct cutter *cut, const struct log_damage *damage)
{
    cut->counts->damages++;
    cut->counts->damaged_bytes += damage->length;
    cut->counts->bytes += damage->length;
    if (cut->counts->damages <= COMPLAINTS_MAX)
        complain("%s: offset %" PRId64 ": %" PRId64 " bytes: %s; left out",
                 cut->options->log[cut->input.log], damage->offset, damage->length, damage->what);
}

/* ---- The cut ---- */

static void run(struct cutter *cut)
{
    cut->definitions = definitions_open();
    cut->names = body_names_open();
    read_logs(cut, survey_event, NULL);
    match_all(&cut->match);
    input_begin(&cut->input, 0);
    definitions_begin_file(cut->definitions);
    read_logs(cut, copy_event, take_damage);
    cut->counts->kept_bytes = log_written(cut->output);
    cut->counts->unknown = (int64_t) definitions_wanted(cut->definitions);
    match_clear(&cut->match);
    definitions_close(cut->definitions);
    body_names_close(cut->names);
}

bool log_cut(const struct log_cut_options *options, struct log_cut_counts *counts)
{
    struct cutter *cut = allocate(1, sizeof *cut);
    *counts = (struct log_cut_counts){.events = 0};
    cut->options = options;
    cut->counts = counts;
    cut->channels = log_channels(options->prefix);
    if (input_open(&cut->input, options->log, options->log_count) &&
        output_open(&options->output, &cut->file))
        cut->output = log_begin_output(cut->file);
    if (cut->output)
        run(cut);
    else
        cut->failed = true;
    input_close(&cut->input);
    if (counts->damages > COMPLAINTS_MAX)
        complain("and %" PRId64 " more damaged places", counts->damages - COMPLAINTS_MAX);
    const int error = log_finish(cut->output);
    if (error)
        fail_output(cut, error);
    const bool keep = !cut->failed && counts->kept_events > 0;
    const bool good = output_close(cut->file, keep) && !cut->failed;
    free(cut);
    return good;
}
