/* Fair scheduler: chooses the client to serve next by the compute time that each has used (similar
 * to start-time fair queueing, with equal weights).
 *
 * Each client has a virtual time: the nanoseconds charged to it. The active client with the least
 * virtual time is served next, except that the client served last continues for a slice
 * (scheduler_next()). The system's virtual time is the least of the active clients; it never
 * decreases. A client that becomes active resumes at the maximum of its own and the system's
 * virtual time, so that idling earns no credit. A client whose virtual time is above the system's
 * is in debt, and stays so while it is idle. A new id starts SCHEDULER_ENTRY_NS above the system's
 * virtual time, so that a client gains nothing by changing its id.
 *
 * SCHEDULER_CLIENTS ids have an entry of their own. A new id replaces the client without debt that
 * has been idle longest; if there is none, the new id shares one entry with all other ids without
 * an entry.
 *
 * Allocates nothing after scheduler_create(). One scheduler may be used by one thread at a time;
 * schedulers share no state. */
#ifndef SCHEDULER_H
#define SCHEDULER_H

#include <stdbool.h>
#include <stdint.h>

enum {
    SCHEDULER_CLIENTS = 1024,
    SCHEDULER_ENTRY_NS = 1000000, /* debt of a new id */
    SCHEDULER_SLICE_NS = 500000   /* see scheduler_next() */
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

/* Makes a client active or idle. No effect if it already is. */
void scheduler_activate(struct scheduler *scheduler, int client);
void scheduler_deactivate(struct scheduler *scheduler, int client);

/* Number of active clients. */
int scheduler_active(const struct scheduler *scheduler);

/* Adds nanoseconds to the virtual time of a client, active or idle. */
void scheduler_charge(struct scheduler *scheduler, int client, int64_t ns);

/* The client to serve, among the active clients that the filter accepts (NULL: all). This is the
 * client `last` while its virtual time exceeds that of no other by SCHEDULER_SLICE_NS or more, so
 * that clients do not alternate at every query; otherwise the one with the least virtual time.
 * On input: last: the client served last; -1: none.
 * Returns the client; -1: none. *lead_ns: the least virtual time of the others minus that of this
 * client, which may be negative while it continues its slice; INT64_MAX: there are no others. */
typedef bool scheduler_filter(const void *user, int client);
int scheduler_next(const struct scheduler *scheduler, scheduler_filter *may, const void *user,
                   int last, int64_t *lead_ns);

/* The active client with the least virtual time; -1: none is active. */
int scheduler_least(const struct scheduler *scheduler);

/* Advances the system's virtual time to the least of the active clients. To be called before a
 * client is served. */
void scheduler_advance(struct scheduler *scheduler);

/* The lead of an idle client: the least virtual time of an active client minus the virtual time at
 * which this client would resume if it became active now. INT64_MAX: no client is active. */
int64_t scheduler_lead(const struct scheduler *scheduler, int client);

#endif
