/* What a replay counts: for each log, and added up. */
#ifndef TALLY_H
#define TALLY_H

#include "compare.h"
#include "histogram.h"

/* Of the queries of one channel. */
struct tally_channel {
    int64_t queries;                   /* that could be read */
    int64_t pairs;                     /* that were decided */
    int64_t outcome[REPLAY_ALONE + 1]; /* [enum replay_outcome] */
    int64_t differences[DIFFERENT_KINDS];
    int64_t results;       /* recorded, or in the golden */
    int64_t results_alone; /* whose query is not in the log */
    int64_t unreadable[2]; /* [query, result] */
};

enum { TALLY_PAIRS, TALLY_SCENES, TALLY_CHANNELS };

/* Numbers alone, so that it may lie in memory that processes share. */
struct tally {
    struct tally_channel channel[TALLY_CHANNELS];
    int64_t events, bytes; /* in the part of the logs that was replayed */
    int64_t statuses;      /* heartbeats */
    int64_t other_events;  /* on other channels */
    int64_t damages, damaged_bytes;
    struct histogram then, now; /* nanoseconds to decide */
};

/* Which channel a kind of query or result is counted in; heartbeats and others have none. */
int tally_channel_of(enum log_kind kind);

/* Adds. */
void tally_add_channel(struct tally_channel *to, const struct tally_channel *from);
void tally_add(struct tally *to, const struct tally *from);

/* Over both channels. */
int64_t tally_queries(const struct tally *tally);
int64_t tally_outcome(const struct tally *tally, enum replay_outcome outcome);
int64_t tally_unreadable(const struct tally *tally);

/* How many queries were compared: the same, or different. */
int64_t tally_compared(const struct tally *tally);

#endif
