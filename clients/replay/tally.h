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
    int64_t results_alone; /* whose query is not in the log, or has had one long before */
    int64_t unreadable[2]; /* [query, result] */
};

enum { TALLY_PAIRS, TALLY_SCENES, TALLY_CHANNELS };

/* Of a live service that answered (answer_bus.h). */
struct tally_bus {
    int64_t used;     /* 1; 0: all was answered in this process */
    int64_t end;      /* enum answer_bus_end */
    int64_t answered; /* queries of the log */
    int64_t ns;       /* from the first query to the last answer */
    int64_t late_ns;  /* how late a query was sent at most, where the log's times counted */
    int64_t again;    /* sent again, for want of an answer */
    int64_t busy;     /* refused so, and sent again */
    int64_t deaths;   /* keys of the service had died, and components went in their place */
    int64_t lessons;  /* queries asked besides, which brought components alone */
    int64_t too_long; /* not asked: no service hears a query so long */
    int64_t services; /* how often another service answered than before; 1: it was one */
    int64_t nonsense; /* results that could not be read */
    /* Of the query that has waited longest for its answer, where that was the end. */
    int64_t log, number, offset;
};

/* Numbers alone, so that it may lie in memory that processes share. */
struct tally {
    struct tally_channel channel[TALLY_CHANNELS];
    int64_t events, bytes; /* in the part of the logs that was replayed */
    int64_t statuses;      /* heartbeats */
    int64_t other_events;  /* on other channels */
    int64_t damages, damaged_bytes;
    struct histogram then, now; /* nanoseconds to decide */
    struct tally_bus bus;       /* of the first log, for all of them */
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
