/* The counts of a replay, for each log or in total. */
#ifndef TALLY_H
#define TALLY_H

#include "compare.h"
#include "histogram.h"

/* Counts of the queries of one channel: tally_count[] lists all but the differences. */
struct tally_channel {
    int64_t queries;                  /* queries that could be decoded */
    int64_t pairs;                    /* pairs decided */
    int64_t outcome[REPLAY_OUTCOMES]; /* [enum replay_outcome] */
    int64_t results;                  /* recorded, or in the golden */
    int64_t unmatched;      /* results without a query in the log, or long after its first result */
    int64_t results_again;  /* second results that agree with the first or depend on the moment */
    int64_t contradictions; /* second results that contradict the first */
    int64_t left_over;      /* of different clients: queries in one recording only */
    int64_t unreadable[2];  /* [query, result] */
    int64_t differences[DIFFERENT_KINDS];
};

enum { TALLY_PAIRS, TALLY_SCENES, TALLY_CHANNELS };
extern const char *const tally_channel_name[TALLY_CHANNELS]; /* of the queries */

/* The counts of a channel, in the order of the struct, with their names in reports. */
enum { TALLY_COUNTS = 16 };
struct tally_count {
    const char *key;    /* in JSON */
    const char *column; /* in the table for people; NULL: none */
    const char *junit;  /* before the number in JUnit XML; NULL: not there */
};
extern const struct tally_count tally_count[TALLY_COUNTS];

/* The counts as an array [TALLY_COUNTS]. */
const int64_t *tally_counts(const struct tally_channel *channel);

/* Why a replay through a service ended early. */
enum tally_end {
    TALLY_NO_END, /* it did not */
    TALLY_SIGNAL,
    TALLY_NO_SERVICE, /* no service answers */
    TALLY_BUS_FAILED
};

/* Counts of a replay through a service on the bus. */
struct tally_bus {
    int64_t used;      /* 1; 0: this process answered */
    int64_t end;       /* enum tally_end */
    int64_t answered;  /* queries of the log answered */
    int64_t ns;        /* from the first query to the last answer, nanoseconds */
    int64_t resent;    /* queries sent again for lack of an answer */
    int64_t whole;     /* queries sent again with frames that the service did not hold */
    int64_t not_sent;  /* queries too long for a datagram, or with ids out of range */
    int64_t supplied;  /* extra queries that only carried bodies to the service */
    int64_t services;  /* changes of the service that answers, the first one included */
    int64_t malformed; /* results that could not be decoded */
    /* Place of the first query without an answer, if that ended the replay. */
    int64_t log, number, offset;
};

struct tally {
    struct tally_channel channel[TALLY_CHANNELS];
    int64_t events, bytes;
    int64_t statuses; /* heartbeats */
    int64_t definitions, unreadable_definitions;
    int64_t other_events; /* on other channels */
    int64_t damages, damaged_bytes;
    struct histogram then, now; /* nanoseconds to decide */
    /* Only in the tally of the first log, for all logs: */
    struct tally_bus bus;
    int64_t first_utime; /* time of the first event, microseconds; 0: there is none */
    /* A GHashTable of this log. It maps a label of scenes, truncated as in struct difference, to a
     * struct tally_channel with their queries, outcomes and differences. NULL: there are none. */
    struct _GHashTable *labels;
};

/* The channel that a query or result is counted in. In: a kind of query or result. */
int tally_channel_of(enum log_kind kind);

/* Adds from to to. */
void tally_add(struct tally *to, const struct tally *from);

/* Returns the counts of a label, for the caller to increase. Exits if memory is exhausted. */
struct tally_channel *tally_label(struct tally *tally, const char *label);

/* Frees the labels. */
void tally_clear(struct tally *tally);

/* The sums over both channels. */
struct tally_channel tally_both(const struct tally *tally);

/* The number of queries compared: the same or different. */
int64_t tally_compared(const struct tally_channel *channel);

/* The number of messages that cannot be decoded, definitions included. */
int64_t tally_unreadable(const struct tally *tally);

#endif
