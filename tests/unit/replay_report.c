#include "replay_report.h"

#include <malloc.h>
#include <stdlib.h>
#include <string.h>

/* ---- What is reported ---- */

static void on_found(void *user, const struct located_difference *found)
{
    struct replay_report *report = user;
    if (report->found_count == report->found_room) {
        report->found_room = 2 * report->found_room + 16;
        report->found = realloc(report->found, (size_t) report->found_room * sizeof *report->found);
        if (!report->found)
            abort();
    }
    struct located_difference *put = &report->found[report->found_count++];
    *put = *found;
    put->difference.then.certificate = put->difference.now.certificate = NULL;
}

static void on_unreadable(void *user, const struct match_place *place, const char *channel,
                          const char *what)
{
    struct replay_report *report = user;
    (void) place;
    if (!channel || !what)
        abort();
    report->unreadable++;
}

static void on_damage(void *user, int log, const struct log_damage *damage)
{
    struct replay_report *report = user;
    (void) log;
    report->damages++;
    report->damaged_bytes += damage->length;
}

static void on_progress(void *user, int64_t bytes)
{
    struct replay_report *report = user;
    if (report->progress++ % 64 != 0) /* mallinfo2() visits every free block */
        return;
    const struct mallinfo2 memory = mallinfo2();
    const size_t given = memory.uordblks + memory.hblkhd;
    report->most_memory = given > report->most_memory ? given : report->most_memory;
    (void) bytes;
}

/* ---- Runs ---- */

/* Of one query they stay in their order. */
static int compare_places(const struct located_difference *a, const struct located_difference *b)
{
    if (a->place.log != b->place.log)
        return a->place.log < b->place.log ? -1 : 1;
    return a->place.offset < b->place.offset ? -1 : a->place.offset > b->place.offset;
}

static void sort_found(struct located_difference *found, int64_t count,
                       struct located_difference *scratch)
{
    const int64_t half = count / 2;
    int64_t a = 0, b = half;
    if (count < 2)
        return;
    sort_found(found, half, scratch);
    sort_found(found + half, count - half, scratch);
    for (int64_t i = 0; i < count; i++)
        scratch[i] = b == count || (a < half && compare_places(&found[a], &found[b]) <= 0)
                         ? found[a++]
                         : found[b++];
    memcpy(found, scratch, (size_t) count * sizeof *found);
}

struct replay_report replay_report_of(const struct replay_options *options)
{
    struct replay_report report = {.good = true};
    const struct replay_sink sink = {on_found, on_unreadable, on_damage, on_progress, &report};
    struct tally *tally = calloc((size_t) options->log_count, sizeof *tally);
    if (!tally)
        abort();
    report.good = replay_run(options, &sink, tally);
    for (int log = 0; log < options->log_count; log++)
        tally_add(&report.tally, &tally[log]);
    free(tally);
    struct located_difference *scratch = calloc((size_t) report.found_count + 1, sizeof *scratch);
    if (!scratch)
        abort();
    sort_found(report.found, report.found_count, scratch);
    free(scratch);
    return report;
}

void replay_report_free(struct replay_report *report)
{
    free(report->found);
    *report = (struct replay_report){.good = false};
}

/* ---- Comparing ---- */

static bool same_found(const struct located_difference *a, const struct located_difference *b)
{
    const struct difference *x = &a->difference, *y = &b->difference;
    return compare_places(a, b) == 0 && a->place.number == b->place.number &&
           a->place.utime == b->place.utime && a->kind == b->kind && a->client_id == b->client_id &&
           a->sequence_number == b->sequence_number && x->kind == y->kind && x->whole == y->whole &&
           memcmp(x->body_id, y->body_id, sizeof x->body_id) == 0 &&
           memcmp(x->placement, y->placement, sizeof x->placement) == 0 && x->dim == y->dim &&
           x->then.status == y->then.status && x->now.status == y->now.status &&
           query_same_answer(&x->then.answer, &y->then.answer) &&
           query_same_answer(&x->now.answer, &y->now.answer);
}

static const char *differ_in_channel(const struct tally_channel *a, const struct tally_channel *b)
{
    if (a->queries != b->queries)
        return "queries";
    if (a->pairs != b->pairs)
        return "pairs";
    if (memcmp(a->outcome, b->outcome, sizeof a->outcome) != 0)
        return "outcomes";
    if (memcmp(a->differences, b->differences, sizeof a->differences) != 0)
        return "differences by kind";
    if (a->results != b->results)
        return "results";
    if (a->results_alone != b->results_alone)
        return "unmatched results";
    if (a->results_again != b->results_again || a->contradictions != b->contradictions)
        return "second results";
    return memcmp(a->unreadable, b->unreadable, sizeof a->unreadable) != 0 ? "unreadable" : NULL;
}

static const char *differ_in_tally(const struct tally *a, const struct tally *b)
{
    for (int i = 0; i < TALLY_CHANNELS; i++) {
        const char *what = differ_in_channel(&a->channel[i], &b->channel[i]);
        if (what)
            return what;
    }
    if (a->events != b->events || a->bytes != b->bytes || a->statuses != b->statuses ||
        a->other_events != b->other_events)
        return "events";
    if (a->damages != b->damages || a->damaged_bytes != b->damaged_bytes)
        return "damages";
    if (memcmp(&a->then, &b->then, sizeof a->then) != 0)
        return "times then";
    return a->now.count != b->now.count ? "how many times now" : NULL;
}

const char *replay_report_differ(const struct replay_report *a, const struct replay_report *b)
{
    const char *what = differ_in_tally(&a->tally, &b->tally);
    if (what)
        return what;
    if (a->good != b->good)
        return "whether all went well";
    if (a->found_count != b->found_count)
        return "how many differences";
    for (int64_t i = 0; i < a->found_count; i++)
        if (!same_found(&a->found[i], &b->found[i]))
            return "a difference";
    return a->unreadable != b->unreadable || a->damages != b->damages ||
                   a->damaged_bytes != b->damaged_bytes
               ? "what was reported as unreadable"
               : NULL;
}

static const char *odd_channel(const struct tally_channel *channel)
{
    int64_t outcomes = 0, differences = 0;
    for (int i = 0; i < REPLAY_OUTCOMES; i++) {
        outcomes += channel->outcome[i];
        if (channel->outcome[i] < 0)
            return "an outcome below 0";
    }
    for (int i = 0; i < DIFFERENT_KINDS; i++)
        differences += channel->differences[i];
    if (outcomes != channel->queries)
        return "queries and their outcomes";
    if (differences < channel->outcome[REPLAY_DIFFERENT])
        return "queries and their differences";
    return channel->results_alone + channel->results_again + channel->contradictions >
                   channel->results
               ? "unmatched or repeated results"
               : NULL;
}

const char *replay_report_odd(const struct replay_report *report, int64_t size)
{
    const struct tally *tally = &report->tally;
    int64_t differences = 0;
    for (int i = 0; i < TALLY_CHANNELS; i++) {
        const char *what = odd_channel(&tally->channel[i]);
        if (what)
            return what;
        for (int kind = 0; kind < DIFFERENT_KINDS; kind++)
            differences += tally->channel[i].differences[kind];
    }
    if (tally->bytes != size)
        return "the bytes of the logs";
    if (report->damages != tally->damages || report->damaged_bytes != tally->damaged_bytes)
        return "damages reported and counted";
    if (report->unreadable != tally_unreadable(tally) + tally_contradictions(tally))
        return "unreadable messages reported and counted";
    return differences != report->found_count ? "differences reported and counted" : NULL;
}
