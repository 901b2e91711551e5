/* Anticipation: decides whether to wait briefly for the next query of the client just served.
 *
 * A client that waits for each answer before it sends its next query has no pending query after it
 * was served, however little time it has used. The service would then begin work for another
 * client, which may take milliseconds. This is deceptive idleness (Iyer, Druschel: Anticipatory
 * scheduling, 2001). So the service waits a moment, and charges half of the wait to the client.
 *
 * Times are nanoseconds of one monotonic clock. No function allocates; there is no shared state. */
#ifndef ANTICIPATION_H
#define ANTICIPATION_H

#include "scheduler.h"

#include <stdbool.h>
#include <stdint.h>

/* The service does not wait for a client whose average think time exceeds ANTICIPATION_THINK_NS,
 * unless the work that would begin instead takes ANTICIPATION_RATIO times as long: a client on a
 * busy machine is slow to send, but a certificate for another client would delay it by more. Other
 * clients are waited for up to ANTICIPATION_MAX_NS: a client whose core was busy takes longer than
 * usual, and work for another client usually delays it by more. */
enum { ANTICIPATION_THINK_NS = 150000, ANTICIPATION_RATIO = 16, ANTICIPATION_MAX_NS = 1000000 };

struct anticipation {
    int client;        /* the anticipated client; -1: none */
    int64_t until_ns;  /* the end of the wait */
    int64_t polled_ns; /* time of the last poll */
    int64_t waited_ns; /* the wait so far, as anticipation_poll() counts it */
    struct anticipated_client {
        int64_t idle_ns;  /* while the client is idle: time of its last answer; 0: unknown */
        int64_t think_ns; /* average from an answer to the next query; 0: unknown */
    } clients[SCHEDULER_CLIENTS + 1];
};

/* Anticipates no client, and knows no think times. */
void anticipation_init(struct anticipation *anticipation);

/* Records that a client got an answer and has no pending query. */
void anticipation_answered(struct anticipation *anticipation, int client, int64_t now_ns);

/* Records that a query of an idle client has arrived. On input: not_before_ns: when the bus was
 * last empty, taken as the time of arrival. (The query may have been read much later, while the
 * service was busy with other clients.) */
void anticipation_arrived(struct anticipation *anticipation, int client, int64_t not_before_ns);

/* Begins to wait for a client. On input: max_ns: upper limit of the wait; other_ns: what the work
 * that would begin instead usually takes; leads: the client has used less time than the others, by
 * more than a slice. Returns false, and does nothing, if waiting does not pay: max_ns is 0 or less,
 * or the client's think time is too long (above), or exceeds other_ns though the client does not
 * lead.
 */
bool anticipation_begin(struct anticipation *anticipation, int client, int64_t now_ns,
                        int64_t max_ns, int64_t other_ns, bool leads);

/* Returns whether the wait is not over. The time since the last poll is added to the wait, as
 * ANTICIPATION_POLL_NS at most: if it was longer, the system ran other programs. On input: a client
 * is anticipated. */
enum { ANTICIPATION_POLL_NS = 50000 };
bool anticipation_poll(struct anticipation *anticipation, int64_t now_ns);

/* Stops waiting. Returns the nanoseconds to charge to the anticipated client: half of the wait,
 * since other clients use the bus, the caches and the cores meanwhile, at the expense of a client
 * that has one query in progress. A client that exploits this still leaves a third of the time to
 * another. On input: a client is anticipated. */
int64_t anticipation_end(struct anticipation *anticipation, int64_t now_ns);

#endif
