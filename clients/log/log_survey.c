#include "log_survey.h"

#include "allocate.h"
#include "message.h"
#include "temporary.h"
#include "told.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Patches of queries whose keys were known when they came, and of those looked at again at the end.
 */
enum { ROW_AT_ONCE, ROW_LATER };

/* A query that is to be looked at again. */
struct later {
    int64_t log, offset, event;
    bool mine;
};

struct surveying {
    const struct log_survey_options *options;
    struct log_survey *out;
    struct told *told;
    bool has[LOG_STATUS]; /* [kind]: whether the channel is chosen */
    FILE *later;          /* NULL: none so far */
    int64_t event;        /* number of the one that is being looked at */
    int64_t first_utime;  /* of the first */
    bool failed;
    struct any_query query;
    struct log_patch patch;
};

/* Says what cannot be read or written, once. */
static void fail(struct surveying *surveying, const char *what, int error)
{
    if (error && !surveying->failed)
        fprintf(stderr, "fmb: %s: %s\n", what, strerror(error));
    surveying->failed = surveying->failed || error;
}

static const char temporary[] = "a temporary file";

/* ---- What is chosen ---- */

static void choose(struct surveying *surveying, int64_t event)
{
    log_marks_set(surveying->out->marks, event);
}

/* By itself: all but queries, and results that have one; on a channel that is chosen. */
static bool is_chosen_alone(const struct surveying *surveying, int64_t utime)
{
    const struct log_choice *choice = surveying->options->choice;
    return choice->body_count == 0 && log_choice_has_time(choice, surveying->first_utime, utime);
}

/* By its time and its bodies: then its result is too, each if its channel is. */
static bool is_chosen_query(struct surveying *surveying, int64_t utime)
{
    const struct log_choice *choice = surveying->options->choice;
    int32_t count;
    const struct query_frame *frame = any_query_frames(&surveying->query, &count);
    return log_choice_has_time(choice, surveying->first_utime, utime) &&
           log_choice_has_body(choice, frame, count);
}

static enum log_kind result_of(enum log_kind query)
{
    return query == LOG_PAIR_QUERY ? LOG_PAIR_RESULT : LOG_SCENE_RESULT;
}

/* A query's place is mine if is_chosen_query(). A result's, if both channels are chosen: so both
 * are mine where what the result tells is told by what is chosen. */
static void on_both(void *user, const struct match_item *query, const struct match_item *result)
{
    struct surveying *surveying = user;
    if (query->place.mine && surveying->has[result_of(query->kind)])
        choose(surveying, result->place.number);
}

static void on_query_alone(void *user, const struct match_item *query)
{
    (void) user;
    (void) query;
}

static void on_result_alone(void *user, const struct match_item *result)
{
    struct surveying *surveying = user;
    if (surveying->has[result_of(result->kind)] && is_chosen_alone(surveying, result->place.utime))
        choose(surveying, result->place.number);
}

/* ---- What is written back ---- */

/* What is to be written back into a frame; NULL: nothing. all: whatever is known of its key; else
 * only where what is chosen does not tell that itself. Once many keys were told, a replay of the
 * cut, which learns them in another order, may have forgotten some: from there on the cut counts as
 * telling none. */
static struct known_body *wanted(struct surveying *surveying, const struct query_frame *frame,
                                 bool all)
{
    struct told *told = surveying->told;
    struct known_body *body = told_is_by_key(frame) ? told_body(told, frame) : NULL;
    return body && (all || !body->mine || known_bodies_half_full(told->known)) ? body : NULL;
}

static size_t bytes_wanted(struct surveying *surveying, const struct query_frame *frame,
                           int32_t count, bool all)
{
    size_t bytes = 0;
    for (int32_t i = 0; i < count; i++) {
        const struct known_body *body = wanted(surveying, &frame[i], all);
        bytes += body ? sizeof(double) * (size_t) body->components.count : 0;
    }
    return bytes;
}

/* Where the components of the body are kept. */
static int64_t place_of(struct surveying *surveying, struct known_body *body)
{
    if (body->key_now == 0)
        body->key_now = 1 + log_patches_keep(surveying->out->patches, &body->components);
    return body->key_now - 1;
}

/* What is defined is told by what is chosen, from there on. */
static void note(struct surveying *surveying, int32_t i, struct known_body *body)
{
    struct log_patch *patch = &surveying->patch;
    patch->put[patch->count].frame = i;
    patch->put[patch->count++].components = place_of(surveying, body);
    body->mine = body->mine || patch->define;
}

static void count_unknown(struct surveying *surveying, const struct query_frame *frame,
                          int32_t count)
{
    int64_t unknown = 0;
    for (int32_t i = 0; i < count; i++)
        unknown += told_is_by_key(&frame[i]) && !told_body(surveying->told, &frame[i]);
    surveying->out->unknown_frames += unknown;
    surveying->out->unknown_queries += unknown > 0;
}

/* The query that was read, of so many bytes, is chosen: what is to be written back into it? One
 * whose counts are wrong is refused before any key is looked at: it stays. One that was looked at
 * later, since it lacked a key when it came, may lack none in the cut, and be answered in its
 * place: so that its other keys stand for the same there, all of them are written back. */
static void settle(struct surveying *surveying, int64_t event, size_t size, int row)
{
    int32_t count;
    const struct query_frame *frame = any_query_frames(&surveying->query, &count);
    struct log_patch *patch = &surveying->patch;
    const size_t least = bytes_wanted(surveying, frame, count, false);
    const bool all =
        row == ROW_LATER && size + bytes_wanted(surveying, frame, count, true) <= QUERY_BYTES_MAX;
    count_unknown(surveying, frame, count);
    if (least == 0 || log_choice_is_all(surveying->options->choice) ||
        !any_query_is_whole(&surveying->query))
        return;
    patch->event = event;
    patch->count = 0;
    patch->define = size + least > QUERY_BYTES_MAX;
    for (int32_t i = 0; i < count; i++) {
        struct known_body *body = wanted(surveying, &frame[i], all);
        if (body)
            note(surveying, i, body);
    }
    log_patches_put(surveying->out->patches, row, patch);
}

static void look_later(struct surveying *surveying, const struct match_place *place)
{
    const struct later later = {place->log, place->offset, place->number, place->mine};
    errno = 0;
    if (!surveying->later)
        surveying->later = temporary_open();
    if (!surveying->later || fwrite(&later, sizeof later, 1, surveying->later) != 1)
        fail(surveying, temporary, errno ? errno : EIO);
}

static bool read_again(struct surveying *surveying, const struct later *later,
                       struct match_item *item)
{
    struct log_event event;
    item->place = (struct match_place){.log = (int32_t) later->log,
                                       .mine = later->mine,
                                       .number = later->event,
                                       .offset = later->offset};
    return input_again(surveying->options->input, item->place.log, later->offset, &event) &&
           !message_read_ids(log_kind_of(surveying->options->channels, &event), &event, item) &&
           !any_query_read(&surveying->query, item->kind, item->bytes, item->size);
}

/* As fmb replay does: what was not known when a query came may be known now. */
static void look_at_rest(struct surveying *surveying)
{
    struct later later;
    struct match_item item;
    if (!surveying->later)
        return;
    rewind(surveying->later);
    while (!surveying->failed && fread(&later, sizeof later, 1, surveying->later) == 1) {
        if (!read_again(surveying, &later, &item)) {
            fail(surveying, surveying->options->log[later.log], ENODATA);
            return;
        }
        const bool chosen = later.mine && surveying->has[item.kind];
        if (chosen)
            settle(surveying, later.event, item.size, ROW_LATER);
    }
    if (ferror(surveying->later))
        fail(surveying, temporary, EIO);
}

/* ---- Events ---- */

/* Longer than a datagram: it is refused, and its keys are nobody's concern. */
static bool is_too_long(const struct match_item *query)
{
    return query->size > QUERY_BYTES_MAX;
}

static void look(struct surveying *surveying, const struct match_item *query, bool chosen)
{
    switch (told_look(surveying->told, &surveying->query, chosen)) {
    case TOLD_DEFINITION: return;
    case TOLD_SOME: look_later(surveying, &query->place); break;
    case TOLD_ALL:
        if (chosen)
            settle(surveying, query->place.number, query->size, ROW_AT_ONCE);
    }
    match_query(surveying->told->match, query);
}

static void take_query(struct surveying *surveying, struct match_item *item)
{
    item->place.mine = is_chosen_query(surveying, item->place.utime);
    const bool chosen = item->place.mine && surveying->has[item->kind];
    if (chosen)
        choose(surveying, item->place.number);
    if (is_too_long(item))
        match_query(surveying->told->match, item);
    else
        look(surveying, item, chosen);
}

/* Of one that is too long the ids are enough. */
static bool read_query(struct surveying *surveying, enum log_kind kind,
                       const struct match_item *item)
{
    if (!any_query_read(&surveying->query, kind, item->bytes, item->size))
        return true;
    surveying->query.kind = LOG_SCENE_QUERY;
    surveying->query.scene.frame_count = 0;
    return is_too_long(item);
}

/* False: it is no query and no result, or cannot be read as such. */
static bool take_message(struct surveying *surveying, const struct log_event *event,
                         struct match_item *item)
{
    const enum log_kind kind = log_kind_of(surveying->options->channels, event);
    if (kind >= LOG_STATUS || message_read_ids(kind, event, item))
        return false;
    if (message_is_result(kind)) {
        item->place.mine = surveying->has[kind] && surveying->has[item->kind];
        match_result(surveying->told->match, item);
        return true;
    }
    if (!read_query(surveying, kind, item))
        return false;
    take_query(surveying, item);
    return true;
}

static void take_event(struct surveying *surveying, const struct log_event *event)
{
    struct match_item item = {.place = {.log = surveying->options->input->log,
                                        .number = surveying->event,
                                        .offset = event->offset,
                                        .utime = event->utime}};
    if (surveying->event == 0)
        surveying->first_utime = event->utime;
    if (!take_message(surveying, event, &item) &&
        log_choice_has_channel(surveying->options->choice, event) &&
        is_chosen_alone(surveying, event->utime))
        choose(surveying, surveying->event);
    surveying->event++;
}

static void take_events(struct surveying *surveying)
{
    const struct log_survey_options *options = surveying->options;
    struct log_event event;
    struct log_damage damage;
    enum log_outcome outcome = LOG_END;
    while (!surveying->failed &&
           ((outcome = input_next(options->input, &event, &damage)) == LOG_EVENT ||
            outcome == LOG_DAMAGE)) {
        if (outcome == LOG_EVENT)
            take_event(surveying, &event);
        options->progress(options->user, outcome == LOG_EVENT ? event.length : damage.length);
    }
    if (outcome == LOG_FAILED)
        fail(surveying, options->log[options->input->log], errno);
}

static void choose_channels(struct surveying *surveying)
{
    const struct log_channels *channels = surveying->options->channels;
    for (int kind = 0; kind < LOG_STATUS; kind++) {
        const struct log_event event = {.channel = channels->name[kind],
                                        .channel_length = channels->length[kind]};
        surveying->has[kind] = log_choice_has_channel(surveying->options->choice, &event);
    }
}

bool log_survey(const struct log_survey_options *options, struct log_survey *out)
{
    struct surveying *surveying = allocate(1, sizeof *surveying);
    const struct match_sink sink = {on_both, on_query_alone, on_result_alone, surveying};
    *out = (struct log_survey){.marks = log_marks_open(), .patches = log_patches_open()};
    surveying->options = options;
    surveying->out = out;
    surveying->told = told_open(&sink);
    choose_channels(surveying);
    take_events(surveying);
    if (!surveying->failed && !match_finish(surveying->told->match))
        fail(surveying, temporary, errno);
    look_at_rest(surveying);
    fail(surveying, temporary, log_marks_error(out->marks));
    fail(surveying, temporary, log_patches_error(out->patches));
    const bool good = !surveying->failed;
    told_close(surveying->told);
    if (surveying->later)
        fclose(surveying->later);
    free(surveying);
    return good;
}

void log_survey_clear(struct log_survey *survey)
{
    log_marks_close(survey->marks);
    log_patches_close(survey->patches);
    *survey = (struct log_survey){.marks = NULL};
}
