#include "replay_report.h"

#include <malloc.h>
#include <stdlib.h>
#include <string.h>

/* ---- What is reported ---- */

static void on_found(void *user, const struct difference *found)
{
    struct replay_report *report = user;
    if (report->found_count == report->found_room) {
        report->found_room = 2 * report->found_room + 16;
        report->found = realloc(report->found, (size_t) report->found_room * sizeof *report->found);
        if (!report->found)
            abort();
    }
    struct difference *put = &report->found[report->found_count++];
    *put = *found;
    put->then.certificate = put->now.certificate = put->detail = NULL;
    if (found->detail)
        strcpy(report->detail, found->detail);
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

static void on_progress(void *user, int64_t bytes, int64_t of)
{
    struct replay_report *report = user;
    if (report->progress++ % 64 != 0) /* mallinfo2() visits every free block */
        return;
    const struct mallinfo2 memory = mallinfo2();
    const size_t given = memory.uordblks + memory.hblkhd;
    report->most_memory = given > report->most_memory ? given : report->most_memory;
    (void) bytes;
    (void) of;
}

/* ---- Runs ---- */

/* Of one query they stay in their order. */
static int compare_places(const struct difference *a, const struct difference *b)
{
    if (a->place.log != b->place.log)
        return a->place.log < b->place.log ? -1 : 1;
    return a->place.offset < b->place.offset ? -1 : a->place.offset > b->place.offset;
}

static void sort_found(struct difference *found, int64_t count, struct difference *room)
{
    const int64_t half = count / 2;
    int64_t a = 0, b = half;
    if (count < 2)
        return;
    sort_found(found, half, room);
    sort_found(found + half, count - half, room);
    for (int64_t i = 0; i < count; i++)
        room[i] = b == count || (a < half && compare_places(&found[a], &found[b]) <= 0)
                      ? found[a++]
                      : found[b++];
    memcpy(found, room, (size_t) count * sizeof *found);
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
    struct difference *room = calloc((size_t) report.found_count + 1, sizeof *room);
    if (!room)
        abort();
    sort_found(report.found, report.found_count, room);
    free(room);
    return report;
}

void replay_report_free(struct replay_report *report)
{
    free(report->found);
    *report = (struct replay_report){.good = false};
}

/* ---- Comparing ---- */

static bool same_found(const struct difference *a, const struct difference *b)
{
    return compare_places(a, b) == 0 && a->place.number == b->place.number &&
           a->place.utime == b->place.utime && a->query_kind == b->query_kind &&
           a->client_id == b->client_id && a->sequence_number == b->sequence_number &&
           a->kind == b->kind && a->whole == b->whole &&
           memcmp(a->body_id, b->body_id, sizeof a->body_id) == 0 &&
           memcmp(a->placement, b->placement, sizeof a->placement) == 0 && a->dim == b->dim &&
           a->then.status == b->then.status && a->now.status == b->now.status &&
           query_same_answer(&a->then.answer, &b->then.answer) &&
           query_same_answer(&a->now.answer, &b->now.answer);
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
    if (a->unmatched != b->unmatched)
        return "results alone";
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
    return channel->unmatched + channel->results_again + channel->contradictions > channel->results
               ? "results alone or again"
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
    if (report->unreadable != tally_unreadable(tally) + tally_both(tally).contradictions)
        return "unreadable messages reported and counted";
    return differences != report->found_count ? "differences reported and counted" : NULL;
}
