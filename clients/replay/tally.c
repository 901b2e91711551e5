#include "tally.h"

#include "wire.h"

#include <glib.h>
#include <stddef.h>

const char *const tally_channel_name[TALLY_CHANNELS] = {WIRE_PAIR_QUERY, WIRE_SCENE_QUERY};

const struct tally_count tally_count[TALLY_COUNTS] = {
    {"queries", "queries", "queries: "},
    {"pairs", "pairs", NULL},
    {"same", "same", ", same: "},
    {"different", "different", ", different: "},
    {"busy", "busy", ", busy: "},
    {"unknown_body", "unknown body", ", unknown body: "},
    {"not_defined", "not defined", ", not defined: "},
    {"not_held", NULL, ", not held: "},
    {"no_result", "no result", ", no result: "},
    {"results", NULL, NULL},
    {"unmatched_results", NULL, NULL},
    {"second_results", NULL, NULL},
    {"contradictions", NULL, NULL},
    {"left_over", NULL, NULL},
    {"unreadable_queries", NULL, NULL},
    {"unreadable_results", NULL, NULL},
};

_Static_assert(offsetof(struct tally_channel, differences) == TALLY_COUNTS * sizeof(int64_t),
               "each count has its names");
_Static_assert(offsetof(struct tally, then) % sizeof(int64_t) == 0, "counts only");

const int64_t *tally_counts(const struct tally_channel *channel)
{
    return &channel->queries;
}

int tally_channel_of(enum log_kind kind)
{
    return kind == LOG_SCENE_QUERY || kind == LOG_SCENE_RESULT ? TALLY_SCENES : TALLY_PAIRS;
}

/* Adds the 64-bit integers of two structs. */
static void add(void *to, const void *from, size_t size)
{
    int64_t *sum = to;
    const int64_t *count = from;
    for (size_t i = 0; i < size / sizeof *sum; i++)
        sum[i] += count[i];
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
    add(to, from, offsetof(struct tally, then));
    add_histogram(&to->then, &from->then);
    add_histogram(&to->now, &from->now);
    if (from->bus.used)
        to->bus = from->bus;
}

struct tally_channel *tally_label(struct tally *tally, const char *label)
{
    if (!tally->labels)
        tally->labels = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free);
    struct tally_channel *counts = g_hash_table_lookup(tally->labels, label);
    if (!counts)
        g_hash_table_insert(tally->labels, g_strdup(label),
                            counts = g_new0(struct tally_channel, 1));
    return counts;
}

void tally_clear(struct tally *tally)
{
    g_clear_pointer(&tally->labels, g_hash_table_destroy);
}

struct tally_channel tally_both(const struct tally *tally)
{
    struct tally_channel both = tally->channel[TALLY_PAIRS];
    add(&both, &tally->channel[TALLY_SCENES], sizeof both);
    return both;
}

int64_t tally_compared(const struct tally_channel *channel)
{
    return channel->outcome[REPLAY_SAME] + channel->outcome[REPLAY_DIFFERENT];
}

int64_t tally_unreadable(const struct tally *tally)
{
    const struct tally_channel both = tally_both(tally);
    return tally->unreadable_definitions + both.unreadable[0] + both.unreadable[1];
}
