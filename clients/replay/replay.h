/* A replay: every query of one or more logs is answered again, and compared with the result that
 * was recorded, or that a golden log holds. */
#ifndef REPLAY_H
#define REPLAY_H

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
    size_t bodies;     /* capacity of the cache */
    struct page *page; /* takes in what was replayed; NULL: none */
};

/* A part of the logs: what begins in [begin, end) of their bytes, taken together. The rest is read
 * for what the part needs of it: what keys stand for, and results that stand elsewhere. */
struct replay_part {
    int64_t begin, end;
};

/* Bytes of all logs; negative: one cannot be opened, which has been said on stderr. */
int64_t replay_size(const struct replay_options *options);

/* On output: tally[log_count], added to. False: a file failed, or cannot be opened or read, which
 * has been said on stderr. */
bool replay_run(const struct replay_options *options, struct replay_part part,
                const struct replay_sink *sink, struct tally *tally);

#endif
