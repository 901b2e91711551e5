/* A replay: every query of one or more logs is answered again, in this process or by a live
 * service, and compared with the result that was recorded, or that a golden log holds. */
#ifndef REPLAY_H
#define REPLAY_H

#include "answer_bus.h"
#include "judge.h"

struct replay_options {
    char *const *log; /* [log_count], one after the other, as one */
    int log_count;
    const char *prefix;       /* of the channels, "" for none */
    const char *golden;       /* results to compare with, in place of those recorded; NULL: none */
    const char *write_golden; /* where the results go; NULL: nowhere */
    bool force;               /* write_golden may be there already */
    struct compare_options compare;
    double from, to;   /* queries of from <= t < to, in seconds of log time since the first event */
    size_t bodies;     /* capacity of the cache, in this process */
    struct page *page; /* takes in what was replayed; NULL: none */
    const struct answer_bus_options *bus; /* the service that answers; NULL: this process */
};

/* A part of the logs: what begins in [begin, end) of their bytes, taken together. The rest is read
 * for what the part needs of it: what keys stand for, and results that stand elsewhere. */
struct replay_part {
    int64_t begin, end;
};

/* Bytes of all logs; negative: one cannot be opened, which has been said on stderr. */
int64_t replay_size(const struct replay_options *options);

/* On output: tally[log_count], added to. False: a file failed, or cannot be opened or read, or
 * there is no bus, which has been said on stderr; or the service was given up, or a signal came:
 * tally[0].bus.end says so, and what has been answered until then is counted. With a bus the part
 * is all. */
bool replay_run(const struct replay_options *options, struct replay_part part,
                const struct replay_sink *sink, struct tally *tally);

#endif
