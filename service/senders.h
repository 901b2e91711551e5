/* What the sequence numbers of the clients tell: how many queries were lost on the way, and
 * how many were asked again. A fixed number of clients is remembered; one that was forgotten
 * starts anew. */
#ifndef SENDERS_H
#define SENDERS_H

#include <stdint.h>

/* Where the count of gaps stays: clients may skip as far as they like. */
#define SENDERS_GAPS_MAX ((INT64_C(1) << 53) - 1)

enum { SENDERS_SETS = 256, SENDERS_WAYS = 4 };

struct sender {
    int64_t client_id;
    int64_t last;     /* highest sequence number so far */
    int64_t gaps;     /* sequence numbers skipped */
    uint64_t used_at; /* 0: free */
};

/* All 0 at the start. */
struct senders {
    struct sender sender[SENDERS_SETS][SENDERS_WAYS];
    uint64_t now;
    int64_t gaps;     /* of all clients, forgotten ones too */
    int64_t repeated; /* not above the highest so far */
};

/* Both numbers from 0 to 2^53 - 1. */
void senders_note(struct senders *senders, int64_t client_id, int64_t sequence_number);

/* How many of this client's sequence numbers were skipped; 0 where it is not remembered. */
int64_t senders_gaps(const struct senders *senders, int64_t client_id);

#endif
