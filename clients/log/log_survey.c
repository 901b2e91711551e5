#include "log_survey.h"

#include "allocate.h"
#include "logged_query.h"
#include "complain.h"
#include "definitions.h"
#include "match.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct survey {
    const struct log_survey_options *options;
    struct log_survey *out;
    struct match *match;
    struct definitions *chosen; /* of the chosen events so far */
    bool has[LOG_STATUS];       /* [kind]: whether the channel is chosen */
    int64_t event;              /* number of the current event */
    int64_t first_utime;        /* of the first event */
    struct logged_query query;
};

/* ---- Which events are chosen ------------------------------------------------------------------
 */

static void choose(struct survey *survey, int64_t event)
{
    struct log_survey *out = survey->out;
    const size_t byte = (size_t) (event / 8), old = out->chosen_size;
    if (byte >= old) {
        out->chosen = allocate_grow(out->chosen, &out->chosen_size, byte + 1, 1);
        memset(out->chosen + old, 0, out->chosen_size - old);
    }
    out->chosen[byte] |= (unsigned char) (1 << event % 8);
}

bool log_survey_is_chosen(const struct log_survey *survey, int64_t event)
{
    const size_t byte = (size_t) (event / 8);
    return byte < survey->chosen_size && (survey->chosen[byte] >> event % 8 & 1);
}

/* Whether an event is chosen by its own time: any event except queries, and results with a query.
 */
static bool is_chosen_by_time(const struct survey *survey, int64_t utime)
{
    const struct log_choice *choice = survey->options->choice;
    return choice->body_count == 0 && log_choice_has_time(choice, survey->first_utime, utime);
}

/* Whether a query is chosen by time and bodies. Each result of a chosen query is chosen too, if its
 * channel is. */
static bool is_chosen_query(struct survey *survey, int64_t utime)
{
    const struct log_choice *choice = survey->options->choice;
    int32_t count;
    const struct placement *placement = logged_query_placements(&survey->query, &count);
    return log_choice_has_time(choice, survey->first_utime, utime) &&
           log_choice_has_body(choice, placement, count);
}

/* Chooses a result. In: query->in_range: whether the query is chosen; query: NULL without one. */
static void choose_result(struct survey *survey, enum log_kind kind,
                          const struct match_place *query, const struct match_place *result)
{
    const bool chosen = query ? query->in_range : is_chosen_by_time(survey, result->utime);
    if (chosen && survey->has[kind])
        choose(survey, result->number);
}

/* ---- Bodies that the cut must define ------------------------------------------------------------
 */

static int compare(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(struct handle));
}

static void sort_wanted(struct log_survey *out)
{
    size_t count = 0;
    if (out->wanted_count > 0)
        qsort(out->wanted, out->wanted_count, sizeof *out->wanted, compare);
    for (size_t i = 0; i < out->wanted_count; i++)
        if (count == 0 || !handle_equal(&out->wanted[i], &out->wanted[count - 1]))
            out->wanted[count++] = out->wanted[i];
    out->wanted_count = count;
}

/* Adds a handle. Duplicates are removed when the list is full, so it has at most twice the capacity
 * of the distinct ones. */
static void want(struct log_survey *out, const struct handle *handle)
{
    if (out->wanted_count == out->wanted_capacity) {
        sort_wanted(out);
        if (2 * out->wanted_count >= out->wanted_capacity)
            out->wanted = allocate_grow(out->wanted, &out->wanted_capacity,
                                        out->wanted_capacity + 1, sizeof *out->wanted);
    }
    out->wanted[out->wanted_count++] = *handle;
}

/* A query does not define the handles that it names: a service that lacks one of its bodies keeps
 * none of them. */
static void define_from_query(struct survey *survey, bool chosen)
{
    int32_t count;
    const struct placement *placement = logged_query_placements(&survey->query, &count);
    for (int32_t i = 0; chosen && i < count; i++)
        if (placement_by_handle(&placement[i]) &&
            !definitions_find(survey->chosen, &placement[i].handle))
            want(survey->out, &placement[i].handle);
    for (int32_t i = 0; i < count; i++) {
        definitions_add_placement(survey->out->definitions, &placement[i]);
        if (chosen)
            definitions_add_placement(survey->chosen, &placement[i]);
    }
}

static void define_from_message(struct survey *survey, const struct log_event *event, bool chosen)
{
    const uint32_t size = (uint32_t) event->kept;
    definitions_add_message(survey->out->definitions, event->data, size);
    if (chosen)
        definitions_add_message(survey->chosen, event->data, size);
}

/* ---- Events -----------------------------------------------------------------------------------
 */

static void take_query(struct survey *survey, const struct match_key *key,
                       struct match_place *place)
{
    struct match_item *result = match_find(survey->match, key);
    const enum log_kind kind = (enum log_kind) key->kind;
    place->in_range = is_chosen_query(survey, place->utime);
    if (place->in_range && survey->has[kind])
        choose(survey, place->number);
    define_from_query(survey, place->in_range && survey->has[kind]);
    if (!result || !result->is_result) {
        match_add(survey->match, key, place, false);
        return;
    }
    choose_result(survey, log_kind_result_of(kind), place, &result->place);
    match_remove(survey->match, result);
    match_free(result);
}

static void take_result(struct survey *survey, const struct match_key *key,
                        const struct match_place *place)
{
    struct match_item *query = match_find(survey->match, key);
    if (!query || query->is_result) {
        match_add(survey->match, key, place, true);
        return;
    }
    choose_result(survey, log_kind_result_of((enum log_kind) key->kind), &query->place, place);
    match_remove(survey->match, query);
    match_free(query);
}

/* Returns false if the event is not a query or result, or cannot be decoded. */
static bool take_message(struct survey *survey, const struct log_event *event, enum log_kind kind)
{
    struct query_header ids;
    struct match_place place = {.log = survey->options->input->log,
                                .number = survey->event,
                                .offset = event->offset,
                                .utime = event->utime};
    if (kind >= LOG_STATUS || log_kind_ids(kind, event, &ids))
        return false;
    const struct match_key key = {log_kind_query_of(kind), ids.client_id, ids.sequence_number,
                                  ids.utime};
    if (log_kind_is_result(kind)) {
        take_result(survey, &key, &place);
        return true;
    }
    if (logged_query_read(&survey->query, kind, event->data, (uint32_t) event->kept))
        return false;
    take_query(survey, &key, &place);
    return true;
}

static void survey_event(struct survey *survey, const struct log_event *event)
{
    const enum log_kind kind = log_kind_of(survey->options->channels, event);
    if (survey->event == 0)
        survey->first_utime = event->utime;
    if (!take_message(survey, event, kind)) {
        const bool chosen = log_choice_has_channel(survey->options->choice, event) &&
                            is_chosen_by_time(survey, event->utime);
        if (chosen)
            choose(survey, survey->event);
        if (kind == LOG_DEFINITION)
            define_from_message(survey, event, chosen);
    }
    survey->event++;
}

static bool survey_events(struct survey *survey)
{
    const struct log_survey_options *options = survey->options;
    struct log_event event;
    struct log_damage damage;
    enum log_outcome outcome;
    while ((outcome = input_next(options->input, &event, &damage)) < LOG_END) {
        if (outcome == LOG_EVENT)
            survey_event(survey, &event);
        options->progress(options->user);
    }
    if (outcome == LOG_FAILED)
        complain("%s: %s", options->log[options->input->log], strerror(errno));
    return outcome == LOG_END;
}

static void on_unmatched(void *user, struct match_item *query, struct match_item *result)
{
    struct survey *survey = user;
    choose_result(survey, log_kind_result_of((enum log_kind) result->key.kind),
                  query ? &query->place : NULL, &result->place);
    if (query)
        match_free(query);
    match_free(result);
}

static void choose_channels(struct survey *survey)
{
    const struct log_channels *channels = survey->options->channels;
    for (int kind = 0; kind < LOG_STATUS; kind++) {
        const struct log_event event = {.channel = channels->name[kind],
                                        .channel_length = channels->length[kind]};
        survey->has[kind] = log_choice_has_channel(survey->options->choice, &event);
    }
}

bool log_survey(const struct log_survey_options *options, struct log_survey *out)
{
    struct survey *survey = allocate(1, sizeof *survey);
    *out = (struct log_survey){.definitions = definitions_open()};
    survey->options = options;
    survey->out = out;
    survey->match = match_open();
    survey->chosen = log_choice_is_all(options->choice) ? out->definitions : definitions_open();
    choose_channels(survey);
    const bool good = survey_events(survey);
    if (good)
        match_finish(survey->match, on_unmatched, survey);
    sort_wanted(out);
    if (survey->chosen != out->definitions)
        definitions_close(survey->chosen);
    match_close(survey->match);
    free(survey);
    return good;
}

void log_survey_clear(struct log_survey *survey)
{
    free(survey->chosen);
    free(survey->wanted);
    definitions_close(survey->definitions);
    *survey = (struct log_survey){.chosen = NULL};
}
