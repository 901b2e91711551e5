/* Fair scheduler: chooses the client to serve next by the time that each has used (similar to
 * start-time fair queueing, with equal weights).
 *
 * Each client has a virtual time: the nanoseconds charged to it. The active client with the least
 * virtual time is served next. The system's virtual time is the least of the active clients; it
 * never decreases. A client that becomes active resumes at the maximum of its own and the system's
 * virtual time, so that idling earns no credit. A client whose virtual time is above the system's
 * is in debt, and stays so while it is idle. A new id starts SCHEDULER_ENTRY_NS above the system's
 * virtual time, so that a client gains nothing by changing its id.
 *
 * A client that waits for each answer before it sends its next query is idle after each turn,
 * however little time it has used. If work for another client began at once, it would delay the
 * next query, each time by as much as it takes (deceptive idleness; Iyer, Druschel: Anticipatory
 * scheduling, 2001). So the service waits for such a client as long as it leads: its virtual time
 * is less than any active client's (scheduler_patience()). The wait is charged to it. Let
 * the turns of n other clients take X: after one turn of each, the client has the time X for
 * queries and waits. So it has 1 / (n + 1) of the time if it sends its next query within X; and if
 * it takes longer, it is not delayed by more than the turn that is in progress.
 *
 * SCHEDULER_CLIENTS ids have an entry of their own. A new id replaces the client without debt that
 * has been idle longest; if there is none, the new id shares one entry with all other ids without
 * an entry.
 *
 * All times come from one clock that also counts while other programs run. Otherwise a client in
 * closed loop would be charged for waits in wall time, and other clients only for part of theirs.
 * Allocates nothing after scheduler_create(). One scheduler may be used by one thread at a time;
 * schedulers share no state. */
#ifndef SCHEDULER_H
#define SCHEDULER_H

#include <stdbool.h>
#include <stdint.h>

enum {
    SCHEDULER_CLIENTS = 1024,
    SCHEDULER_ENTRY_NS = 1000000 /* debt of a new id */
};

struct scheduler;

/* On input: 64 random bits, which clients must not know: they hash ids, so that no client can
 * choose ids that collide. Returns NULL if out of memory. The caller destroys it;
 * scheduler_destroy() accepts NULL. */
struct scheduler *scheduler_create(uint64_t random);
void scheduler_destroy(struct scheduler *scheduler);

/* Returns the number of the client with this id, from 0 to SCHEDULER_CLIENTS (the shared entry); it
 * is assigned if the id is new. Valid while the client is active, and while idle until the next
 * call with another id. Below, client is such a number. */
int scheduler_client(struct scheduler *scheduler, int64_t id);

/* Makes a client active or idle. No effect if it already is. On input: arrival_min_ns,
 * arrival_max_ns: bounds on the time at which its query arrived, which the service may have read
 * later; now_ns: the time of its answer. From these its think time is estimated, which is the time
 * from an answer to the next query: the estimate is doubled if it was too short, and reduced by a
 * quarter if it was too long, so that about 70 % of the times are shorter. */
void scheduler_activate(struct scheduler *scheduler, int client, int64_t arrival_min_ns,
                        int64_t arrival_max_ns);
void scheduler_deactivate(struct scheduler *scheduler, int client, int64_t now_ns);

/* Number of active clients. */
int scheduler_active(const struct scheduler *scheduler);

/* Adds nanoseconds to the virtual time of a client, active or idle. */
void scheduler_charge(struct scheduler *scheduler, int client, int64_t ns);

/* The client to serve: the one with the least virtual time among the active clients that the filter
 * accepts (NULL: all); -1: none. Advances the system's virtual time. */
typedef bool scheduler_filter(const void *user, int client);
int scheduler_next(struct scheduler *scheduler, scheduler_filter *may, const void *user);

/* How long to wait for the next query of a client before another client is served, in nanoseconds:
 * twice its think time, but only while it leads. 0: not at all, since the client is active, no
 * other client is active, or the client's think time exceeds its lead. */
int64_t scheduler_patience(const struct scheduler *scheduler, int client);

#endif
