#include "log_query.h"

#include "complain.h"
#include "input.h"
#include "log_kind.h"

#include <errno.h>
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Limit on the matching events that an error lists. */
enum { LISTED_MAX = 8 };

struct query_search {
    const struct log_query_options *options;
    struct log_query *out;
    struct log_channels channels;
    struct input input;
    enum log_query_outcome outcome; /* the search ends if this is not FOUND */
    bool of_result;                 /* a result was found: the search is for its query */
    /* Matching events: their number, and the offsets of the first ones. `kind`, `error` and the
     * event in `out` are those of the first match. */
    int64_t count;
    int64_t listed[LISTED_MAX]; /* offsets */
    enum log_kind kind;
    const char *error; /* why the key of the first match cannot be read; NULL: it can */
};

static void fail(struct query_search *search, const char *what, int error)
{
    if (search->outcome == LOG_QUERY_FOUND)
        complain("%s: %s", what, strerror(error));
    search->outcome = LOG_QUERY_FAILED;
}

/* ---- Reading the logs ---- */

/* The last log is read at most three times, the others once. */
static void report_progress(struct query_search *search)
{
    const int64_t of = input_size(&search->input), half = search->input.passed / 2;
    search->options->progress(search->options->user, half < of ? half : of, of);
}

/* Calls take() for each event from the current position of the input on, until it returns false. */
static void for_each_event(struct query_search *search,
                           bool (*take)(struct query_search *search, const struct log_event *event))
{
    struct log_event event;
    struct log_damage damage;
    enum log_outcome outcome;
    while ((outcome = input_next(&search->input, &event, &damage)) < LOG_END) {
        if (outcome == LOG_EVENT && !take(search, &event))
            return;
        report_progress(search);
    }
    if (outcome == LOG_FAILED)
        fail(search, search->options->log[search->input.log], errno);
}

/* ---- The event ---- */

/* Whether the event is the query with the requested ids, or that of the result that was found. */
static bool is_query(const struct query_search *search, const struct log_event *event)
{
    const struct log_query_options *options = search->options;
    const enum log_kind kind = log_kind_of(&search->channels, event);
    struct match_key key;
    if (!log_kind_is_query(kind) || match_key_of(kind, event, &key))
        return false;
    return search->of_result ? match_key_equal(&key, &search->out->key)
                             : key.client_id == options->client_id &&
                                   key.sequence_number == options->sequence_number;
}

static bool matches(const struct query_search *search, const struct log_event *event)
{
    if (search->of_result || search->options->by == LOG_QUERY_IDS)
        return is_query(search, event);
    return search->options->by == LOG_QUERY_NUMBER ? event->number == search->options->number
                                                   : event->offset == search->options->offset;
}

static void keep_event(struct query_search *search, const struct log_event *event)
{
    struct log_query *out = search->out;
    search->kind = log_kind_of(&search->channels, event);
    search->error = match_key_of(search->kind, event, &out->key);
    out->number = event->number;
    out->offset = event->offset;
    out->size = event->size;
    memcpy(out->bytes, event->data, event->kept);
}

/* A client without a result repeats its query. The first of identical queries represents all of
 * them. */
static bool is_repeated(const struct query_search *search, const struct log_event *event)
{
    const struct log_query *out = search->out;
    return search->count > 0 && search->options->by == LOG_QUERY_IDS &&
           log_kind_of(&search->channels, event) == search->kind && event->size == out->size &&
           event->kept == event->size && memcmp(event->data, out->bytes, event->size) == 0;
}

static bool take_match(struct query_search *search, const struct log_event *event)
{
    if (!matches(search, event) || is_repeated(search, event))
        return true;
    if (search->count < LISTED_MAX)
        search->listed[search->count] = event->offset;
    if (search->count++ > 0)
        return true;
    keep_event(search, event);
    return search->options->by != LOG_QUERY_OFFSET && !search->of_result;
}

/* Reports why there is no answer to what was requested. */
__attribute__((format(printf, 2, 3))) static void refuse(struct query_search *search,
                                                         const char *format, ...)
{
    const struct log_query_options *options = search->options;
    char what[100], why[LOG_WHY_MAX];
    va_list list;
    va_start(list, format);
    vsnprintf(why, sizeof why, format, list);
    va_end(list);
    if (options->by == LOG_QUERY_IDS)
        snprintf(what, sizeof what, "client %" PRId64 ", sequence number %" PRId64,
                 options->client_id, options->sequence_number);
    else if (options->by == LOG_QUERY_NUMBER)
        snprintf(what, sizeof what, "event %" PRId64, options->number);
    else
        snprintf(what, sizeof what, "offset %" PRId64, options->offset);
    complain("%s: %s%s", options->log[options->log_count - 1], what, why);
    search->outcome = LOG_QUERY_NONE;
}

static void refuse_several(struct query_search *search)
{
    char offsets[LISTED_MAX * 32] = "";
    for (int64_t i = 0, used = 0; i < search->count && i < LISTED_MAX; i++)
        used += sprintf(offsets + used, " --offset %" PRId64, search->listed[i]);
    refuse(search, " is there %" PRId64 " times:%s%s", search->count, offsets,
           search->count > LISTED_MAX ? " ..." : "");
}

static void find_event(struct query_search *search)
{
    const bool seeks = search->options->by == LOG_QUERY_OFFSET && !search->of_result;
    input_begin(&search->input, search->options->log_count - 1);
    if (seeks && search->input.reader && search->options->offset <= log_size(search->input.reader))
        log_seek(search->input.reader, search->options->offset);
    search->count = 0;
    for_each_event(search, take_match);
    if (search->outcome != LOG_QUERY_FOUND)
        return;
    if (search->count > 1)
        refuse_several(search);
    else if (search->count == 0)
        refuse(search,
               search->of_result ? ": a result, whose query is not here" : ": there is none");
    else if (search->kind >= LOG_STATUS)
        refuse(search, ": neither a query nor a result of this service (--prefix chooses it)");
    else if (search->error)
        refuse(search, ": %s", search->error);
}

/* ---- Its bodies ---- */

static bool take_definitions(struct query_search *search, const struct log_event *event)
{
    const enum log_kind kind = log_kind_of(&search->channels, event);
    const uint32_t size = (uint32_t) event->kept;
    definitions_add_message(search->out->definitions, search->out->names, kind, event->data, size);
    return true;
}

/* Sets the names of placements without one. */
static void fill_names(struct log_query *out, struct query_placement *placement, int32_t count)
{
    for (int32_t i = 0; i < count; i++)
        if (!placement[i].placed.name || !*placement[i].placed.name)
            placement[i].placed.name =
                body_names_find(out->names, out->key.client_id, placement[i].placed.id);
}

static void find_bodies(struct query_search *search)
{
    struct log_query *out = search->out;
    int32_t count;
    const uint32_t size = (uint32_t) (out->size < LOG_DATA_MAX ? out->size : LOG_DATA_MAX);
    const char *error = logged_query_read(&out->query, search->kind, out->bytes, size);
    if (error) {
        refuse(search, ": %s", error);
        return;
    }
    struct query_placement *placement = logged_query_placements(&out->query, &count);
    if (definitions_fill(out->definitions, placement, count) < 0)
        return; /* no placement is by handle */
    input_begin(&search->input, 0);
    for_each_event(search, take_definitions);
    fill_names(out, placement, count);
    const int32_t missing = definitions_fill(out->definitions, placement, count);
    if (search->outcome != LOG_QUERY_FOUND || missing < 0)
        return;
    refuse(search, ": placement %d, body %" PRId64 ", came by a handle that no log here defines",
           (int) missing, placement[missing].placed.id);
}

/* ---- The search ---- */

static void run(struct query_search *search)
{
    find_event(search);
    if (search->outcome != LOG_QUERY_FOUND)
        return;
    search->of_result = log_kind_is_result(search->kind);
    if (search->of_result)
        find_event(search);
    if (search->outcome == LOG_QUERY_FOUND)
        find_bodies(search);
}

enum log_query_outcome log_query(const struct log_query_options *options, struct log_query *out)
{
    struct query_search search = {
        .options = options, .out = out, .channels = log_channels(options->prefix)};
    out->definitions = definitions_open();
    out->names = body_names_open();
    if (input_open(&search.input, options->log, options->log_count))
        run(&search);
    else
        search.outcome = LOG_QUERY_FAILED;
    input_close(&search.input);
    return search.outcome;
}

void log_query_clear(struct log_query *query)
{
    definitions_close(query->definitions);
    body_names_close(query->names);
    query->definitions = NULL;
    query->names = NULL;
}
