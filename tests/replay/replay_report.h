/* Replays that run in this process, and their reports compared. */
#ifndef REPLAY_REPORT_H
#define REPLAY_REPORT_H

#include "replay.h"

struct replay_report {
    bool good;                /* as replay_run() */
    struct tally tally;       /* of all logs */
    struct difference *found; /* owned, [found_count], by the places of their queries; no
                                 certificates, no details */
    int64_t found_count, found_room;
    char detail[COMPARE_DETAIL_MAX];            /* the last one */
    int64_t unreadable, damages, damaged_bytes; /* as they were reported, contradictions too */
    size_t most_memory;                         /* that malloc() had given out, bytes */
    int64_t progress;                           /* calls so far */
};

/* To be freed. */
struct replay_report replay_report_of(const struct replay_options *options);
void replay_report_free(struct replay_report *report);

/* What is not the same in two reports but for the times taken now, static; NULL: nothing. */
const char *replay_report_differ(const struct replay_report *a, const struct replay_report *b);

/* What does not add up in a report of logs of size bytes; NULL: all does. */
const char *replay_report_odd(const struct replay_report *report, int64_t size);

#endif
