#include "log_query.h"

#include "allocate.h"
#include "input.h"
#include "message.h"
#include "told.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Bytes between two words of progress. */
enum { PROGRESS_BYTES = 1 << 20 };

/* Of several events that are meant so many are listed. */
enum { LISTED_MAX = 8 };

struct seeking {
    const struct log_query_options *options;
    struct log_query *out;
    struct log_channels channels;
    struct input input;
    struct told *told;
    int64_t passed, told_progress;
    enum log_query_outcome outcome; /* once it is not FOUND, it ends */
    /* What was meant. */
    int64_t count;
    int64_t listed[LISTED_MAX]; /* offsets */
    struct match_place place;   /* of the first */
    enum log_kind kind;
    struct query_header ids;
    size_t size;
    bool settled; /* the query is in *out, with all that it needs */
    unsigned char bytes[LOG_DATA_MAX];
};

static const char *last_log(const struct seeking *seeking)
{
    return seeking->options->log[seeking->options->log_count - 1];
}

static void fail(struct seeking *seeking, const char *what, int error)
{
    if (seeking->outcome == LOG_QUERY_FOUND)
        fprintf(stderr, "fmb: %s: %s\n", what, strerror(error));
    seeking->outcome = LOG_QUERY_FAILED;
}

/* ---- Going through the logs ---- */

/* Most are gone through twice: to find the event, and up to it. */
static void pass_bytes(struct seeking *seeking, int64_t bytes)
{
    seeking->passed += bytes;
    if (seeking->passed - seeking->told_progress < PROGRESS_BYTES)
        return;
    seeking->told_progress = seeking->passed;
    const int64_t of = input_size(&seeking->input), half = seeking->passed / 2;
    seeking->options->progress(seeking->options->user, half < of ? half : of, of);
}

/* Calls for each event from where the input stands, until that says false. */
static void for_each_event(struct seeking *seeking,
                           bool (*take)(struct seeking *seeking, const struct log_event *event))
{
    struct log_event event;
    struct log_damage damage;
    enum log_outcome outcome;
    while ((outcome = input_next(&seeking->input, &event, &damage)) == LOG_EVENT ||
           outcome == LOG_DAMAGE) {
        if (outcome == LOG_EVENT && !take(seeking, &event))
            return;
        pass_bytes(seeking, outcome == LOG_EVENT ? event.length : damage.length);
    }
    if (outcome == LOG_FAILED)
        fail(seeking, seeking->options->log[seeking->input.log], errno);
}

static struct match_place place_of(const struct seeking *seeking, const struct log_event *event)
{
    return (struct match_place){.log = seeking->input.log,
                                .number = event->number,
                                .offset = event->offset,
                                .utime = event->utime};
}

static bool is_same_place(const struct match_place *a, const struct match_place *b)
{
    return a->log == b->log && a->offset == b->offset;
}

/* ---- What is meant ---- */

static bool has_ids(const struct seeking *seeking, const struct log_event *event)
{
    const struct log_query_options *options = seeking->options;
    const enum log_kind kind = log_kind_of(&seeking->channels, event);
    struct match_item item;
    return message_is_query(kind) && !message_read_ids(kind, event, &item) &&
           item.ids.client_id == options->client_id &&
           item.ids.sequence_number == options->sequence_number;
}

static bool is_meant(const struct seeking *seeking, const struct log_event *event)
{
    switch (seeking->options->by) {
    case LOG_QUERY_NUMBER: return event->number == seeking->options->number;
    case LOG_QUERY_OFFSET: return event->offset == seeking->options->offset;
    default: return has_ids(seeking, event);
    }
}

/* A client that hears nothing asks the same again: the first stands for all of them. */
static bool is_repeated(const struct seeking *seeking, const struct log_event *event)
{
    return seeking->count > 0 && seeking->options->by == LOG_QUERY_IDS &&
           log_kind_of(&seeking->channels, event) == seeking->kind &&
           event->size == seeking->size && event->kept == event->size &&
           memcmp(event->data, seeking->bytes, event->size) == 0;
}

static bool take_meant(struct seeking *seeking, const struct log_event *event)
{
    if (!is_meant(seeking, event) || is_repeated(seeking, event))
        return true;
    if (seeking->count < LISTED_MAX)
        seeking->listed[seeking->count] = event->offset;
    if (seeking->count++ > 0)
        return true;
    seeking->place = place_of(seeking, event);
    seeking->kind = log_kind_of(&seeking->channels, event);
    seeking->size = event->size;
    memcpy(seeking->bytes, event->data, event->kept);
    return seeking->options->by != LOG_QUERY_OFFSET;
}

static void say_what(const struct seeking *seeking)
{
    const struct log_query_options *options = seeking->options;
    fprintf(stderr, "fmb: %s: ", last_log(seeking));
    if (options->by == LOG_QUERY_NUMBER)
        fprintf(stderr, "event %" PRId64, options->number);
    else if (options->by == LOG_QUERY_OFFSET)
        fprintf(stderr, "offset %" PRId64, options->offset);
    else
        fprintf(stderr, "client %" PRId64 ", sequence number %" PRId64, options->client_id,
                options->sequence_number);
}

static void say_several(const struct seeking *seeking)
{
    say_what(seeking);
    fprintf(stderr, " is there %" PRId64 " times:", seeking->count);
    for (int64_t i = 0; i < seeking->count && i < LISTED_MAX; i++)
        fprintf(stderr, " --offset %" PRId64, seeking->listed[i]);
    fprintf(stderr, "%s\n", seeking->count > LISTED_MAX ? " ..." : "");
}

/* On output: the place and the kind of the event. */
static void find_event(struct seeking *seeking)
{
    const int last = seeking->options->log_count - 1;
    seeking->input.log = last;
    log_rewind(seeking->input.reader[last]);
    if (seeking->options->by == LOG_QUERY_OFFSET) {
        if (seeking->options->offset > log_size(seeking->input.reader[last]))
            return;
        log_seek(seeking->input.reader[last], seeking->options->offset);
    }
    for_each_event(seeking, take_meant);
}

static void check_event(struct seeking *seeking)
{
    if (seeking->outcome != LOG_QUERY_FOUND)
        return;
    seeking->outcome = LOG_QUERY_NONE;
    if (seeking->count > 1) {
        say_several(seeking);
    } else if (seeking->count == 0) {
        say_what(seeking);
        fprintf(stderr, ": there is none\n");
    } else if (seeking->kind >= LOG_STATUS) {
        say_what(seeking);
        fprintf(stderr, ": no query, and no result, of this service (--prefix chooses it)\n");
    } else {
        seeking->outcome = LOG_QUERY_FOUND;
    }
}

/* ---- The query of a result ---- */

static void on_both(void *user, const struct match_item *query, const struct match_item *result)
{
    struct seeking *seeking = user;
    if (message_is_result(seeking->kind) && is_same_place(&result->place, &seeking->place)) {
        seeking->place = query->place;
        seeking->kind = query->kind;
    }
}

static void on_alone(void *user, const struct match_item *item)
{
    (void) user;
    (void) item;
}

/* The match's items are good, or not there. */
static bool read_item(struct seeking *seeking, const struct log_event *event,
                      struct match_item *item)
{
    const enum log_kind kind = log_kind_of(&seeking->channels, event);
    item->place = place_of(seeking, event);
    return kind < LOG_STATUS && !message_read_ids(kind, event, item) &&
           (message_is_result(kind) ||
            !any_query_read(&seeking->out->query, kind, item->bytes, item->size));
}

static bool take_for_result(struct seeking *seeking, const struct log_event *event)
{
    struct match_item item;
    if (!read_item(seeking, event, &item))
        return true;
    if (message_is_query(log_kind_of(&seeking->channels, event)))
        match_query(seeking->told->match, &item);
    else
        match_result(seeking->told->match, &item);
    return message_is_result(seeking->kind);
}

static void open_told(struct seeking *seeking)
{
    const struct match_sink sink = {on_both, on_alone, on_alone, seeking};
    told_close(seeking->told);
    seeking->told = told_open(&sink);
    input_rewind(&seeking->input);
}

static void find_query_of_result(struct seeking *seeking)
{
    if (seeking->outcome != LOG_QUERY_FOUND || message_is_query(seeking->kind))
        return;
    open_told(seeking);
    for_each_event(seeking, take_for_result);
    if (seeking->outcome == LOG_QUERY_FOUND && message_is_result(seeking->kind) &&
        !match_finish(seeking->told->match))
        fail(seeking, "a temporary file", errno);
    if (seeking->outcome == LOG_QUERY_FOUND && message_is_result(seeking->kind)) {
        say_what(seeking);
        fprintf(stderr, ": a result, whose query is not here\n");
        seeking->outcome = LOG_QUERY_NONE;
    }
}

/* ---- Its keys ---- */

/* Components for all frames that came by key. False: not all are known. */
static bool complete(struct seeking *seeking)
{
    int32_t count;
    struct query_frame *frame = any_query_frames(&seeking->out->query, &count);
    for (int32_t i = 0; i < count; i++)
        if (told_is_by_key(&frame[i]) && !told_body(seeking->told, &frame[i]))
            return false;
    for (int32_t i = 0; i < count; i++)
        if (told_is_by_key(&frame[i]))
            frame[i].components = told_body(seeking->told, &frame[i])->components;
    return true;
}

static void take_found(struct seeking *seeking, const struct match_item *item)
{
    struct log_query *out = seeking->out;
    out->place = item->place;
    out->ids = item->ids;
    out->size = item->size;
    seeking->settled =
        told_look(seeking->told, &out->query, false) != TOLD_SOME && complete(seeking);
}

static bool take_for_keys(struct seeking *seeking, const struct log_event *event)
{
    struct match_item item;
    if (!read_item(seeking, event, &item))
        return true;
    if (message_is_result(log_kind_of(&seeking->channels, event))) {
        match_result(seeking->told->match, &item);
        return true;
    }
    if (is_same_place(&item.place, &seeking->place))
        take_found(seeking, &item);
    else if (item.size <= QUERY_BYTES_MAX &&
             told_look(seeking->told, &seeking->out->query, false) == TOLD_DEFINITION)
        return true;
    if (!seeking->settled)
        match_query(seeking->told->match, &item);
    return !seeking->settled;
}

static void say_unknown(const struct seeking *seeking)
{
    int32_t count;
    const struct query_frame *frame = any_query_frames(&seeking->out->query, &count);
    for (int32_t i = 0; i < count; i++) {
        if (!told_is_by_key(&frame[i]) || told_body(seeking->told, &frame[i]))
            continue;
        say_what(seeking);
        fprintf(stderr,
                ": frame %d, body %" PRId64 ", came by key %" PRId64
                ", and no log here tells what that stands for\n",
                (int) i, frame[i].body_id, frame[i].key);
        return;
    }
}

/* As fmb replay: keys that are not known when the query comes may be known when all has been read.
 */
static void look_again(struct seeking *seeking)
{
    struct log_event event;
    struct match_item item;
    if (!input_again(&seeking->input, seeking->place.log, seeking->place.offset, &event) ||
        !read_item(seeking, &event, &item)) {
        fail(seeking, seeking->options->log[seeking->place.log], ENODATA);
        return;
    }
    take_found(seeking, &item);
    if (seeking->settled)
        return;
    say_unknown(seeking);
    seeking->outcome = LOG_QUERY_NONE;
}

/* A query that is none by its bytes has no keys; why, is said. */
static bool is_readable(struct seeking *seeking)
{
    struct log_event event;
    const struct match_place *place = &seeking->place;
    const char *error = "it is not there any more";
    struct match_item item;
    if (input_again(&seeking->input, place->log, place->offset, &event)) {
        const enum log_kind kind = log_kind_of(&seeking->channels, &event);
        error = message_read_ids(kind, &event, &item);
        if (!error)
            error = any_query_read(&seeking->out->query, kind, item.bytes, item.size);
    }
    if (!error)
        return true;
    say_what(seeking);
    fprintf(stderr, ": %s\n", error);
    seeking->outcome = LOG_QUERY_NONE;
    return false;
}

static void find_keys(struct seeking *seeking)
{
    if (seeking->outcome != LOG_QUERY_FOUND || !is_readable(seeking))
        return;
    open_told(seeking);
    for_each_event(seeking, take_for_keys);
    if (seeking->outcome == LOG_QUERY_FOUND && !seeking->settled)
        look_again(seeking);
}

/* ---- The run ---- */

enum log_query_outcome log_query(const struct log_query_options *options, struct log_query *out)
{
    struct seeking *seeking = allocate(1, sizeof *seeking);
    char why[LOG_WHY_MAX];
    seeking->options = options;
    seeking->out = out;
    seeking->channels = log_channels(options->prefix);
    if (input_open(&seeking->input, options->log, options->log_count, why)) {
        find_event(seeking);
        check_event(seeking);
        find_query_of_result(seeking);
        find_keys(seeking);
    } else {
        fprintf(stderr, "fmb: %s\n", why);
        seeking->outcome = LOG_QUERY_FAILED;
    }
    const enum log_query_outcome outcome = seeking->outcome;
    told_close(seeking->told);
    input_close(&seeking->input);
    free(seeking);
    return outcome;
}
