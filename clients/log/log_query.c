#include "log_query.h"

#include "allocate.h"
#include "complain.h"
#include "input.h"
#include "log_kind.h"
#include "progress.h"

#include <errno.h>
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct query_search {
    const struct log_query_options *options;
    struct log_query *out;
    struct log_channels channels;
    struct input input;
    struct match match; /* of the last log */
    struct logged_result result;
    enum log_query_outcome outcome;
    /* How many events have the number. The members below describe the first one, whose data is in
     * out->bytes. */
    int64_t count;
    enum log_kind kind;
    size_t item;       /* its index in match */
    const char *error; /* why it cannot be decoded; NULL: it can */
};

/* ---- Reading the logs ---- */

static void take_match(struct query_search *search, enum log_kind kind,
                       const struct log_event *event, const char *error)
{
    if (search->count++ > 0)
        return;
    search->kind = kind;
    search->item = search->match.count;
    search->error = error;
    search->out->size = event->kept;
    memcpy(search->out->bytes, event->data, event->kept);
}

static void take_event(struct query_search *search, const struct log_event *event)
{
    const enum log_kind kind = log_kind_of(&search->channels, event);
    struct match_item item;
    definitions_add_message(search->out->definitions, search->out->names, kind, event->data,
                            (uint32_t) event->kept);
    if (search->input.log + 1 < search->options->log_count)
        return;
    const char *error = match_read(&item, kind, event, &search->result);
    if (event->number == search->options->event)
        take_match(search, kind, event, error);
    if (!error)
        match_add(&search->match, &item);
}

static void read_logs(struct query_search *search)
{
    const struct log_query_options *options = search->options;
    struct input *input = &search->input;
    struct log_event event;
    struct log_damage damage;
    enum log_outcome outcome;
    while ((outcome = input_next(input, &event, &damage)) < LOG_END) {
        if (outcome == LOG_EVENT)
            take_event(search, &event);
        progress_to(input->passed, input_size(input));
    }
    if (outcome == LOG_FAILED) {
        complain("%s: %s", options->log[input->log], strerror(errno));
        search->outcome = LOG_QUERY_FAILED;
    }
}

/* ---- The query ---- */

/* Reports why there is no answer to what was requested. */
__attribute__((format(printf, 2, 3))) static void refuse(struct query_search *search,
                                                         const char *format, ...)
{
    const struct log_query_options *options = search->options;
    char why[LOG_WHY_MAX];
    va_list list;
    va_start(list, format);
    vsnprintf(why, sizeof why, format, list);
    va_end(list);
    complain("%s: event %" PRId64 "%s", options->log[options->log_count - 1], options->event, why);
    search->outcome = LOG_QUERY_NONE;
}

/* Returns the query that was requested, or whose result was. Returns NULL after an error, which was
 * reported: there is none, or there are several. */
static const struct match_item *find_query(struct query_search *search)
{
    if (search->count > 1)
        refuse(search, " is there %" PRId64 " times: 'fmb log cut' numbers events anew",
               search->count);
    else if (search->count == 0)
        refuse(search, ": there is none");
    else if (search->kind >= LOG_STATUS)
        refuse(search, ": neither a query nor a result of this service (--prefix chooses it)");
    else if (search->error)
        refuse(search, ": %s", search->error);
    if (search->outcome != LOG_QUERY_FOUND)
        return NULL;
    match_all(&search->match);
    const struct match_item *item = &search->match.item[search->item];
    if (!item->is_result)
        return item;
    if (!item->other)
        refuse(search, ": a result, whose query is not here");
    return item->other;
}

/* Sets the names of placements without one. */
static void fill_names(struct log_query *out)
{
    for (int32_t i = 0; i < out->query.placement_count; i++) {
        struct fmb_placement *placed = &out->query.placement[i].placed;
        if (!placed->name || !*placed->name)
            placed->name = body_names_find(out->names, out->key.client_id, placed->id);
    }
}

/* Reads the query again, with the bodies and names of its placements. */
static void read_query(struct query_search *search, const struct match_item *query)
{
    struct log_query *out = search->out;
    const int last = search->options->log_count - 1;
    uint32_t size;
    if (!input_read_again(&search->input, last, query->place.offset, out->bytes, &size)) {
        complain("%s: %s", search->options->log[last], strerror(errno));
        search->outcome = LOG_QUERY_FAILED;
        return;
    }
    out->number = query->place.number;
    out->offset = query->place.offset;
    out->key = query->key;
    out->size = size;
    const char *error =
        logged_query_read(&out->query, (enum log_kind) query->key.kind, out->bytes, size);
    if (error) {
        refuse(search, ": %s", error);
        return;
    }
    fill_names(out);
    const int32_t missing = definitions_fill(out->definitions, &out->query);
    if (missing >= 0)
        refuse(search,
               ": placement %d, body %" PRId64 ", came by a handle that no log here defines",
               (int) missing, out->query.placement[missing].placed.id);
}

/* ---- The search ---- */

static void run(struct query_search *search)
{
    read_logs(search);
    const struct match_item *query = search->outcome == LOG_QUERY_FOUND ? find_query(search) : NULL;
    if (query)
        read_query(search, query);
}

enum log_query_outcome log_query(const struct log_query_options *options, struct log_query *out)
{
    struct query_search *search = allocate(1, sizeof *search);
    search->options = options;
    search->out = out;
    search->channels = log_channels(options->prefix);
    out->definitions = definitions_open();
    out->names = body_names_open();
    if (input_open(&search->input, options->log, options->log_count))
        run(search);
    else
        search->outcome = LOG_QUERY_FAILED;
    const enum log_query_outcome outcome = search->outcome;
    input_close(&search->input);
    match_clear(&search->match);
    free(search);
    return outcome;
}

void log_query_clear(struct log_query *query)
{
    definitions_close(query->definitions);
    body_names_close(query->names);
    query->definitions = NULL;
    query->names = NULL;
}
