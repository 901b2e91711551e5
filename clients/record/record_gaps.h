/* Which queries did not come by: the sequence numbers that each client has skipped.
 *
 * One that comes late, overtaken by at most GAPS_WINDOW - 1 others, is not missing any more, and
 * one that comes again is none. A client may begin anywhere. A fixed number of clients is
 * remembered; one that was forgotten begins anew, and what it skipped before stays counted. */
#ifndef RECORD_GAPS_H
#define RECORD_GAPS_H

#include <stdint.h>

enum { GAPS_SETS = 256, GAPS_WAYS = 4, GAPS_WINDOW = 1024 };

/* Where the count stays: clients may skip as far as they like. */
#define GAPS_MAX ((INT64_C(1) << 53) - 1)

struct gaps_client {
    int64_t client_id;
    int64_t first, last;             /* where it began; the highest number so far */
    uint64_t seen[GAPS_WINDOW / 64]; /* [number % GAPS_WINDOW] of those that are not too old */
    uint64_t used_at;                /* 0: free */
};

/* All 0 at the start. */
struct gaps {
    struct gaps_client client[GAPS_SETS][GAPS_WAYS];
    uint64_t now;
    int64_t missing; /* of all clients, forgotten ones too */
};

/* Both numbers from 0 to 2^53 - 1. */
void gaps_note(struct gaps *gaps, int64_t client_id, int64_t sequence_number);

#endif
