#include "tally.h"

#include "wire.h"

const char *const tally_channel_name[TALLY_CHANNELS] = {WIRE_PAIR_QUERY, WIRE_SCENE_QUERY};

int tally_channel_of(enum log_kind kind)
{
    return kind == LOG_SCENE_QUERY || kind == LOG_SCENE_RESULT ? TALLY_SCENES : TALLY_PAIRS;
}

void tally_add_channel(struct tally_channel *to, const struct tally_channel *from)
{
    to->queries += from->queries;
    to->pairs += from->pairs;
    for (int i = 0; i < REPLAY_OUTCOMES; i++)
        to->outcome[i] += from->outcome[i];
    for (int i = 0; i < DIFFERENT_KINDS; i++)
        to->differences[i] += from->differences[i];
    to->results += from->results;
    to->results_alone += from->results_alone;
    to->results_again += from->results_again;
    to->contradictions += from->contradictions;
    to->left_over += from->left_over;
    for (int i = 0; i < 2; i++)
        to->unreadable[i] += from->unreadable[i];
}

static void add_histogram(struct histogram *to, const struct histogram *from)
{
    for (int i = 0; i < HISTOGRAM_BUCKETS; i++)
        to->bucket[i] += from->bucket[i];
    to->count += from->count;
    to->max = to->max > from->max ? to->max : from->max;
}

void tally_add(struct tally *to, const struct tally *from)
{
    for (int i = 0; i < TALLY_CHANNELS; i++)
        tally_add_channel(&to->channel[i], &from->channel[i]);
    to->events += from->events;
    to->bytes += from->bytes;
    to->statuses += from->statuses;
    to->definitions += from->definitions;
    to->unreadable_definitions += from->unreadable_definitions;
    to->other_events += from->other_events;
    to->damages += from->damages;
    to->damaged_bytes += from->damaged_bytes;
    add_histogram(&to->then, &from->then);
    add_histogram(&to->now, &from->now);
    if (from->bus.used)
        to->bus = from->bus;
}

int64_t tally_queries(const struct tally *tally)
{
    return tally->channel[TALLY_PAIRS].queries + tally->channel[TALLY_SCENES].queries;
}

int64_t tally_outcome(const struct tally *tally, enum replay_outcome outcome)
{
    return tally->channel[TALLY_PAIRS].outcome[outcome] +
           tally->channel[TALLY_SCENES].outcome[outcome];
}

int64_t tally_unreadable(const struct tally *tally)
{
    int64_t sum = tally->unreadable_definitions;
    for (int i = 0; i < TALLY_CHANNELS; i++)
        sum += tally->channel[i].unreadable[0] + tally->channel[i].unreadable[1];
    return sum;
}

int64_t tally_compared(const struct tally *tally)
{
    return tally_outcome(tally, REPLAY_SAME) + tally_outcome(tally, REPLAY_DIFFERENT);
}

int64_t tally_contradictions(const struct tally *tally)
{
    return tally->channel[TALLY_PAIRS].contradictions + tally->channel[TALLY_SCENES].contradictions;
}

int64_t tally_left_over(const struct tally *tally)
{
    return tally->channel[TALLY_PAIRS].left_over + tally->channel[TALLY_SCENES].left_over;
}
