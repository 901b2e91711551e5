/* Replays logs: answers every query of one or more logs again, in this process or by a service on
 * the bus, and compares with the recorded results, or with those of a golden log. */
#ifndef REPLAY_H
#define REPLAY_H

#include "body_names.h"
#include "input.h"
#include "output.h"
#include "page_exchange.h"
#include "tally.h"

/* Callbacks for the progress and the findings of a replay. None may be NULL. */
struct replay_sink {
    void (*difference)(void *user, const struct difference *difference);
    /* A message that cannot be decoded, and why; or a second result that contradicts the first. */
    void (*unreadable)(void *user, const struct match_place *place, const char *channel,
                       const char *what);
    /* Damage of a log. */
    void (*damage)(void *user, int log, const struct log_damage *damage);
    /* Progress: this share of the work is done, in bytes of the logs. */
    void (*progress)(void *user, int64_t bytes, int64_t of);
    void *user;
};

struct replay_options {
    char *const *log; /* [log_count] paths, read as one log */
    int log_count;
    const char *prefix; /* of the channels; "": none */
    const char *golden; /* path of a log with results to compare with; NULL: the recorded ones */
    struct output_options write_golden; /* for the new results */
    struct compare_options compare;
    size_t frames;                        /* capacity of the cache in this process */
    struct body_names *names;             /* receives the names of bodies; NULL: none */
    bool labels;                          /* count scenes by their label (tally.h) */
    struct page *page;                    /* receives what was replayed; NULL: none */
    const struct fmb_client_options *bus; /* the service that answers; NULL: this process */
};

/* Replays, and adds to tally[log_count]. Returns false if a file cannot be opened, read or written,
 * or the bus cannot be opened; this was reported on stderr.
 * Also returns false if no service answers or a signal arrived: see tally[0].bus.end. Answers until
 * then are counted. For one thread at a time. */
bool replay_run(const struct replay_options *options, const struct replay_sink *sink,
                struct tally *tally);

#endif
