#include "replay.h"

#include "allocate.h"
#include "answer_now.h"
#include "input.h"
#include "learn.h"
#include "log_write.h"
#include "message.h"
#include "temporary.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

/* Bytes between two words of progress. */
enum { PROGRESS_BYTES = 1 << 16 };

struct replay {
    const struct replay_options *options;
    struct replay_part part;
    const struct replay_sink *sink;
    struct tally *tally; /* [log_count] */
    struct log_channels channels;
    struct input input;
    struct log_reader *golden;     /* NULL: none */
    struct log_writer *new_golden; /* NULL: none */
    struct known_bodies *known;
    struct learner *learner;
    struct answer_now *now; /* NULL: the service on the bus answers */
    struct answer_bus *bus; /* NULL: this process does */
    struct judge *judge;
    /* With the results recorded; and where there is a golden, with those of that, else NULL. */
    struct match *recorded, *compared;
    /* Places of queries that came by keys which nothing before them explains: they are asked once
     * more at the end, when all of the log is known, and brought together with their results there.
     * Until then they have no answer (more). Others may have the same ids: here their places stand
     * for these, so that each gets the results that were found for it. NULL: none so far. */
    FILE *later;
    struct match *late;
    int64_t first_utime, at, told;
    bool started, failed;
    bool asks_again; /* those that were put off */
};

/* Says what cannot be read or written; the rest goes on. */
static void fail(struct replay *replay, const char *what)
{
    if (!replay->failed)
        fprintf(stderr, "fmb: %s: %s\n", what, strerror(errno));
    replay->failed = true;
}

static struct tally_channel *channel_of(struct replay *replay, const struct match_item *item)
{
    return &replay->tally[item->place.log].channel[tally_channel_of(item->kind)];
}

/* ---- What is of the part ---- */

static bool in_time(const struct replay *replay, int64_t utime)
{
    const double seconds = ((double) utime - (double) replay->first_utime) / 1e6;
    return seconds >= replay->options->from && seconds < replay->options->to;
}

/* Whether what begins there in the log that is being read is of the part. */
static bool in_part(const struct replay *replay, int64_t offset)
{
    const int64_t at = replay->input.begin[replay->input.log] + offset;
    return at >= replay->part.begin && at < replay->part.end;
}

/* ---- What is brought together ---- */

static bool is_put_off(const struct match_item *query)
{
    return query->place.mine && query->more_size == 0;
}

static struct match_item by_place(const struct match_item *item, const struct match_place *query)
{
    struct match_item out = *item;
    out.ids = (struct query_header){.client_id = query->log, .sequence_number = query->offset};
    return out;
}

static void settle(struct replay *replay, const struct match_item *query,
                   const struct match_item *result)
{
    if (is_put_off(query)) {
        const struct match_item late = by_place(result, &query->place);
        match_result(replay->late, &late);
    } else {
        judge_both(replay->judge, query, result);
    }
}

static void on_recorded(void *user, const struct match_item *query, const struct match_item *result)
{
    struct replay *replay = user;
    learn(replay->learner, query, result);
    if (!replay->compared)
        settle(replay, query, result);
}

static void on_query_alone(void *user, const struct match_item *query)
{
    struct replay *replay = user;
    if (!replay->compared && !is_put_off(query))
        judge_query_alone(replay->judge, query);
}

static void on_result_alone(void *user, const struct match_item *result)
{
    struct replay *replay = user;
    if (!replay->compared)
        judge_result_alone(replay->judge, result);
}

static void on_compared(void *user, const struct match_item *query, const struct match_item *result)
{
    settle(user, query, result);
}

static void on_query_without(void *user, const struct match_item *query)
{
    if (!is_put_off(query))
        judge_query_alone(((struct replay *) user)->judge, query);
}

static void on_result_without(void *user, const struct match_item *result)
{
    judge_result_alone(((struct replay *) user)->judge, result);
}

/* With the ids that its bytes have; they could be read before. */
static struct match_item by_ids(const struct match_item *late)
{
    const struct log_event event = {.data = late->bytes, .size = late->size, .kept = late->size};
    struct match_item out = *late;
    message_read_ids(late->kind, &event, &out);
    out.more = late->more;
    out.more_size = late->more_size;
    return out;
}

static void on_late(void *user, const struct match_item *query, const struct match_item *result)
{
    const struct match_item own = by_ids(query);
    judge_both(((struct replay *) user)->judge, &own, result);
}

static void on_late_without(void *user, const struct match_item *query)
{
    const struct match_item own = by_ids(query);
    judge_query_alone(((struct replay *) user)->judge, &own);
}

static void match_late(struct replay *replay, const struct match_item *query)
{
    const struct match_item late = by_place(query, &query->place);
    match_query(replay->late, &late);
}

static void match_all(struct replay *replay, const struct match_item *query)
{
    match_query(replay->recorded, query);
    if (replay->compared)
        match_query(replay->compared, query);
}

/* ---- Messages ---- */

static void refuse(struct replay *replay, enum log_kind kind, const struct match_item *item,
                   const char *error)
{
    channel_of(replay, item)->unreadable[message_is_query(kind) ? 0 : 1]++;
    replay->sink->unreadable(replay->sink->user, &item->place, replay->channels.name[kind], error);
}

static void ask_later(struct replay *replay, const struct match_place *place)
{
    const struct match_sink late = {on_late, on_late_without, on_result_without, replay};
    if (!replay->late)
        replay->late = match_open(&late);
    if (!replay->later)
        replay->later = temporary_open();
    if (!replay->later || fwrite(place, sizeof *place, 1, replay->later) != 1)
        fail(replay, "a temporary file");
}

static void count_answer(struct replay *replay, const struct match_item *query,
                         const struct answered_now *answered)
{
    channel_of(replay, query)->queries++;
    channel_of(replay, query)->pairs += answered->pairs;
    if (answered->status == FMB_OK)
        histogram_add(&replay->tally[query->place.log].now, answered->compute_ns);
}

/* Without the time taken, with which results end: goldens are the same bytes on every machine. */
static void write_golden(struct replay *replay, const struct match_item *query)
{
    static const unsigned char no_time[sizeof(int64_t)];
    unsigned char bytes[LOG_DATA_MAX];
    const int kind = query->kind == LOG_PAIR_QUERY ? LOG_PAIR_RESULT : LOG_SCENE_RESULT;
    memcpy(bytes, query->more, query->more_size);
    memcpy(bytes + query->more_size - sizeof no_time, no_time, sizeof no_time);
    if (!log_append(replay->new_golden, query->place.utime, replay->channels.name[kind],
                    replay->channels.length[kind], bytes, query->more_size))
        fail(replay, replay->options->write_golden);
}

static void take_answer(struct replay *replay, struct match_item *query,
                        const struct answered_now *answered)
{
    query->more = answered->bytes;
    query->more_size = (uint32_t) answered->size;
    count_answer(replay, query, answered);
    if (replay->new_golden)
        write_golden(replay, query);
}

/* To where it is brought together with its result, in the order of the log. */
static void pass_query(struct replay *replay, const struct match_item *query)
{
    if (replay->bus)
        answer_bus_pass(replay->bus, query, ANSWER_BUS_QUERY);
    else
        match_all(replay, query);
}

/* last: there is nothing more to be learned of keys. What a bus answers comes later. */
static enum answer_now_outcome ask(struct replay *replay, const struct match_item *query, bool last,
                                   struct answered_now *out)
{
    if (replay->bus)
        return answer_bus_query(replay->bus, query, last, &out->error);
    return answer_now(replay->now, query->kind, query->bytes, query->size, out);
}

/* A query that cannot be read has a result all the same, perhaps, which is not to be compared. */
static void answer(struct replay *replay, struct match_item *query)
{
    struct answered_now answered;
    switch (ask(replay, query, false, &answered)) {
    case ANSWER_NOW_UNREADABLE:
        refuse(replay, query->kind, query, answered.error);
        query->place.mine = false;
        break;
    case ANSWER_NOW_WITHOUT_BODY: ask_later(replay, &query->place); break;
    case ANSWER_NOW_DONE:
        if (replay->bus)
            return;
        take_answer(replay, query, &answered);
    }
    pass_query(replay, query);
}

/* ---- The golden: results in the order of their queries ----
 *
 * Of several parts each reads it, and tells of its own queries' results what cannot be read. */

static void fail_golden(struct replay *replay, int64_t offset, const char *what, bool own)
{
    if (own)
        fprintf(stderr, "fmb: %s: offset %" PRId64 ": %s\n", replay->options->golden, offset, what);
    replay->failed = replay->failed || own;
}

static void take_golden(struct replay *replay, enum log_kind kind, const struct log_event *event,
                        bool mine, bool own)
{
    struct match_item item = {
        .place = {
            .mine = mine, .number = event->number, .offset = event->offset, .utime = event->utime}};
    const char *error = message_read_ids(kind, event, &item);
    if (!error)
        error = judge_read_result(replay->judge, &item);
    if (error) {
        fail_golden(replay, event->offset, error, own);
        return;
    }
    channel_of(replay, &item)->results += mine;
    match_result(replay->compared, &item);
}

/* The next one. False: there is none. own: of a query of this part; mine: of one that counts. */
static bool pull_golden(struct replay *replay, bool mine, bool own)
{
    struct log_event event;
    struct log_damage damage;
    enum log_outcome outcome;
    while ((outcome = log_next(replay->golden, &event, &damage)) == LOG_EVENT ||
           outcome == LOG_DAMAGE) {
        const enum log_kind kind =
            outcome == LOG_EVENT ? log_kind_of(&replay->channels, &event) : LOG_OTHER;
        if (message_is_result(kind)) {
            take_golden(replay, kind, &event, mine, own);
            return true;
        }
        if (outcome == LOG_DAMAGE)
            fail_golden(replay, damage.offset, damage.what, own);
    }
    if (outcome == LOG_FAILED)
        fail(replay, replay->options->golden);
    return false;
}

/* After each query of the log. */
static void follow_golden(struct replay *replay, bool mine, int64_t offset)
{
    if (replay->golden)
        pull_golden(replay, mine, in_part(replay, offset));
}

/* ---- What comes from the bus, in the order of the log ---- */

static void on_answered(void *user, struct match_item *query, const struct answered_now *answered)
{
    struct replay *replay = user;
    take_answer(replay, query, answered);
    if (replay->asks_again) {
        match_late(replay, query);
        return;
    }
    match_all(replay, query);
    follow_golden(replay, query->place.mine, query->place.offset);
}

static void on_passed(void *user, const struct match_item *item, bool is_result)
{
    struct replay *replay = user;
    if (is_result) {
        match_result(replay->recorded, item);
    } else {
        match_all(replay, item);
        follow_golden(replay, item->place.mine, item->place.offset);
    }
}

/* ---- Events ---- */

static struct match_place place_of(const struct replay *replay, const struct log_event *event)
{
    return (struct match_place){
        .log = replay->input.log,
        .mine = in_part(replay, event->offset) && in_time(replay, event->utime),
        .number = event->number,
        .offset = event->offset,
        .utime = event->utime};
}

static void take_query(struct replay *replay, struct match_item *query)
{
    if (learn_definition(replay->learner, query))
        return;
    const bool mine = query->place.mine;
    if (mine)
        answer(replay, query);
    else
        pass_query(replay, query);
    if (!replay->bus)
        follow_golden(replay, mine, query->place.offset);
}

static void take_result(struct replay *replay, const struct match_item *result)
{
    channel_of(replay, result)->results += result->place.mine && !replay->golden;
    learn_expect(replay->learner, result);
    if (replay->bus)
        answer_bus_pass(replay->bus, result,
                        learn_may(replay->learner, result) ? ANSWER_BUS_NEWS : ANSWER_BUS_RESULT);
    else
        match_result(replay->recorded, result);
}

static void take_message(struct replay *replay, enum log_kind kind, const struct log_event *event)
{
    struct match_item item; /* not set: message_read_ids() does */
    item.place = place_of(replay, event);
    const char *error = message_read_ids(kind, event, &item);
    if (error && item.place.mine)
        refuse(replay, kind, &item, error);
    if (error)
        return;
    if (message_is_query(kind))
        take_query(replay, &item);
    else
        take_result(replay, &item);
}

static void take_event(struct replay *replay, const struct log_event *event)
{
    const enum log_kind kind = log_kind_of(&replay->channels, event);
    struct tally *tally = &replay->tally[replay->input.log];
    if (!replay->started)
        replay->first_utime = event->utime;
    replay->started = true;
    if (in_part(replay, event->offset)) {
        tally->events++;
        tally->bytes += event->length;
        tally->statuses += kind == LOG_STATUS;
        tally->other_events += kind == LOG_OTHER;
    }
    if (kind < LOG_STATUS)
        take_message(replay, kind, event);
    replay->at = replay->input.begin[replay->input.log] + event->offset + event->length;
}

static void take_damage(struct replay *replay, const struct log_damage *damage)
{
    struct tally *tally = &replay->tally[replay->input.log];
    if (in_part(replay, damage->offset)) {
        tally->damages++;
        tally->damaged_bytes += damage->length;
        tally->bytes += damage->length;
        replay->sink->damage(replay->sink->user, replay->input.log, damage);
    }
    replay->at = replay->input.begin[replay->input.log] + damage->offset + damage->length;
}

/* ---- The run ---- */

static bool same_file(const char *path, const char *other)
{
    struct stat a, b;
    return stat(path, &a) == 0 && stat(other, &b) == 0 && a.st_dev == b.st_dev &&
           a.st_ino == b.st_ino;
}

static bool is_read(const struct replay_options *options, const char *path)
{
    for (int log = 0; log < options->log_count; log++)
        if (same_file(options->log[log], path))
            return true;
    return options->golden && same_file(options->golden, path);
}

static bool open_goldens(struct replay *replay)
{
    const struct replay_options *options = replay->options;
    char why[LOG_WHY_MAX];
    if (options->golden && !(replay->golden = log_open(options->golden, why))) {
        fprintf(stderr, "fmb: %s: %s\n", options->golden, why);
        return false;
    }
    if (options->write_golden && is_read(options, options->write_golden)) {
        fprintf(stderr, "fmb: %s: it is read: write elsewhere\n", options->write_golden);
        return false;
    }
    if (options->write_golden &&
        !(replay->new_golden = log_create(options->write_golden, options->force))) {
        log_write_complain(options->write_golden, errno);
        return false;
    }
    return true;
}

/* Where the queries are answered. */
static bool open_answers(struct replay *replay)
{
    const struct replay_options *options = replay->options;
    const struct answer_bus_sink sink = {on_answered, on_passed, replay};
    if (options->bus)
        replay->bus = answer_bus_open(options->bus, replay->known, &sink);
    else
        replay->now = answer_now_open(options->bodies, replay->known);
    return replay->bus || replay->now;
}

static bool open_replay(struct replay *replay)
{
    const struct replay_options *options = replay->options;
    const struct match_sink recorded = {on_recorded, on_query_alone, on_result_alone, replay};
    const struct match_sink golden = {on_compared, on_query_without, on_result_without, replay};
    char why[LOG_WHY_MAX];
    if (!input_open(&replay->input, options->log, options->log_count, why)) {
        fprintf(stderr, "fmb: %s\n", why);
        return false;
    }
    replay->known = known_bodies_create(KNOWN_BODIES_USUAL);
    if (!open_answers(replay) || !open_goldens(replay))
        return false;
    replay->channels = log_channels(options->prefix);
    replay->learner = learner_open(replay->known);
    replay->recorded = match_open(&recorded);
    replay->compared = options->golden ? match_open(&golden) : NULL;
    const struct judge_options judging = {options->compare, options->log,  replay->sink,
                                          replay->tally,    options->page, replay->known};
    replay->judge = judge_open(&judging);
    return true;
}

static void close_replay(struct replay *replay)
{
    if (replay->bus)
        replay->tally[0].bus = answer_bus_counts(replay->bus);
    answer_bus_close(replay->bus);
    judge_close(replay->judge);
    match_close(replay->late);
    match_close(replay->compared);
    match_close(replay->recorded);
    answer_now_close(replay->now);
    learner_close(replay->learner);
    known_bodies_destroy(replay->known);
    if (replay->later)
        fclose(replay->later);
    log_close(replay->golden);
    input_close(&replay->input);
    const int error = log_finish(replay->new_golden);
    if (!error)
        return;
    log_write_complain(replay->options->write_golden, error);
    replay->failed = true;
}

/* A bus may take long over few bytes. */
static void tell_progress(struct replay *replay)
{
    if (replay->at - replay->told < PROGRESS_BYTES && !replay->bus)
        return;
    replay->told = replay->at;
    replay->sink->progress(replay->sink->user, replay->at);
}

/* The service was given up, or a signal came. */
static bool has_ended(const struct replay *replay)
{
    return replay->bus && !answer_bus_goes_on(replay->bus);
}

/* Nothing of the part waits for what comes behind it. */
static bool is_done(const struct replay *replay)
{
    return replay->at >= replay->part.end && !replay->later &&
           match_open_count(replay->compared ? replay->compared : replay->recorded) == 0;
}

static void read_logs(struct replay *replay)
{
    struct log_event event;
    struct log_damage damage;
    enum log_outcome outcome;
    while ((outcome = input_next(&replay->input, &event, &damage)) == LOG_EVENT ||
           outcome == LOG_DAMAGE) {
        if (outcome == LOG_EVENT)
            take_event(replay, &event);
        else
            take_damage(replay, &damage);
        tell_progress(replay);
        if (is_done(replay) || has_ended(replay))
            return;
    }
    if (outcome == LOG_FAILED)
        fail(replay, replay->options->log[replay->input.log]);
}

/* Of what has been asked all is answered and matched. */
static void finish_bus(struct replay *replay)
{
    if (replay->bus)
        answer_bus_finish(replay->bus);
}

static void ask_again(struct replay *replay, const struct match_place *place)
{
    struct match_item query = {.place = *place};
    struct log_event event;
    struct answered_now answered;
    errno = 0;
    if (!input_again(&replay->input, place->log, place->offset, &event) ||
        message_read_ids(log_kind_of(&replay->channels, &event), &event, &query) ||
        ask(replay, &query, true, &answered) == ANSWER_NOW_UNREADABLE) {
        errno = errno ? errno : EIO; /* it was there before */
        fail(replay, replay->options->log[place->log]);
        return;
    }
    if (replay->bus)
        return;
    take_answer(replay, &query, &answered);
    match_late(replay, &query);
}

static void ask_all_again(struct replay *replay)
{
    struct match_place place;
    if (!replay->later)
        return;
    replay->asks_again = true;
    bool good = fflush(replay->later) == 0 && fseeko(replay->later, 0, SEEK_SET) == 0;
    while (good && !has_ended(replay) && fread(&place, sizeof place, 1, replay->later) == 1)
        ask_again(replay, &place);
    if (!good || ferror(replay->later))
        fail(replay, "a temporary file");
    finish_bus(replay);
}

/* What it still waits for may stand behind what has been read of the golden; the last part counts
 * what nobody waits for. */
static void read_golden(struct replay *replay)
{
    const bool last = replay->part.end == input_size(&replay->input);
    while (replay->golden && (last || !is_done(replay)) && pull_golden(replay, last, last))
        continue;
}

/* All that is known is known before those that were put off are asked. After an early end what
 * stands alone says nothing: its partner may be what was not read. */
static void finish(struct replay *replay)
{
    finish_bus(replay);
    if (has_ended(replay)) {
        replay->failed = true;
        return;
    }
    read_golden(replay);
    if (is_done(replay)) /* what is left is of others */
        return;
    if (!match_finish(replay->recorded) || (replay->compared && !match_finish(replay->compared)))
        fail(replay, "a temporary file");
    ask_all_again(replay);
    if (has_ended(replay))
        replay->failed = true;
    else if (replay->late && !match_finish(replay->late))
        fail(replay, "a temporary file");
}

bool replay_run(const struct replay_options *options, struct replay_part part,
                const struct replay_sink *sink, struct tally *tally)
{
    struct replay replay = {.options = options, .part = part, .sink = sink, .tally = tally};
    if (open_replay(&replay)) {
        read_logs(&replay);
        finish(&replay);
    } else {
        replay.failed = true;
    }
    close_replay(&replay);
    return !replay.failed;
}

int64_t replay_size(const struct replay_options *options)
{
    struct input input;
    char why[LOG_WHY_MAX];
    if (!input_open(&input, options->log, options->log_count, why)) {
        fprintf(stderr, "fmb: %s\n", why);
        return -1;
    }
    const int64_t size = input_size(&input);
    input_close(&input);
    return size;
}
