/* Anticipation: decides whether to wait briefly for the next query of the client just served.
 *
 * A client that sends its next query after the answer to the last one is idle whenever its turn
 * ends. Without anticipation the service would then begin work for another client, which may take
 * milliseconds, however little time this client has used: deceptive idleness (Iyer, Druschel:
 * Anticipatory scheduling, 2001). So the service waits a moment, and charges half of it to the
 * client. */
#ifndef EXPECT_H
#define EXPECT_H

#include "turns.h"

#include <stdbool.h>
#include <stdint.h>

/* The service does not wait for clients that take longer than EXPECT_THINK_NS on average. It waits
 * up to EXPECT_MAX_NS for others: a client whose core was busy takes longer than usual, and work
 * for another client usually delays it by more. */
enum { EXPECT_THINK_NS = 150000, EXPECT_MAX_NS = 1000000 };

struct expect {
    int client; /* the expected client; -1: none */
    int64_t until_ns, polled_ns, waited_ns;
    struct expect_client {
        int64_t idle_ns;  /* while it is idle: time of its last answer; 0: not known */
        int64_t think_ns; /* average time until its next query; 0: not known */
    } clients[TURNS_CLIENTS + 1];
};

void expect_init(struct expect *expect);

/* Records that a client got an answer and has no pending query. */
void expect_answered(struct expect *expect, int client, int64_t now_ns);

/* Records that a query of an idle client has arrived, after not_before_ns, when the bus was last
 * empty. (The time of reading is no measure, since the service was busy with other clients.) */
void expect_arrived(struct expect *expect, int client, int64_t not_before_ns);

/* Begins to wait for a client, for at most most_ns. other_ns: what the work that would begin
 * instead usually takes. False: waiting does not pay. */
bool expect_begin(struct expect *expect, int client, int64_t now_ns, int64_t most_ns,
                  int64_t other_ns);

/* Whether to keep waiting. The time between two polls counts as EXPECT_POLL_NS at most: if it was
 * longer, the system ran other programs. */
enum { EXPECT_POLL_NS = 50000 };
bool expect_poll(struct expect *expect, int64_t now_ns);

/* Stops waiting. Returns the nanoseconds to charge to the expected client: half of the time. (Other
 * clients use the bus, the caches and the cores meanwhile, at the expense of a client that has one
 * query under way. A client that exploits this still leaves a third of the time to another.) */
int64_t expect_end(struct expect *expect, int64_t now_ns);

#endif
