/* Turns: decides which client is served next, by the compute time that each has used.
 *
 * Each client has a virtual time: the nanoseconds charged to it. The active client with the least
 * virtual time is served next, after a slice of the client served last (turns_next()). The current
 * virtual time is the least of the active clients. A client that becomes active resumes at the
 * maximum of its own and the current virtual time, so that idling earns no credit. A new id starts
 * TURNS_ENTRY_NS later than the current virtual time, so that a client gains nothing by changing
 * its id. A client that was charged for more than the others keeps that debt while it is idle.
 *
 * TURNS_CLIENTS ids have an entry of their own. A new id replaces the client that has been idle
 * longest, if that has no debt; if there is no such client, the new id shares one entry with all
 * other ids without an entry. */
#ifndef TURNS_H
#define TURNS_H

#include <stdbool.h>
#include <stdint.h>

enum { TURNS_CLIENTS = 1024, TURNS_ENTRY_NS = 1000000 };

struct turns;

/* On input: 64 random bits, so that no client can choose ids that collide. NULL: out of memory.
 * turns_destroy() accepts NULL. */
struct turns *turns_create(uint64_t random);
void turns_destroy(struct turns *turns);

/* The number of the client with this id, from 0 to TURNS_CLIENTS (the shared entry). Valid while
 * the client is active, and until the next call with another id. */
int turns_client(struct turns *turns, int64_t id);

/* Makes a client active or idle. No effect if it already is. */
void turns_activate(struct turns *turns, int client);
void turns_deactivate(struct turns *turns, int client);

int turns_active(const struct turns *turns); /* number of active clients */

void turns_charge(struct turns *turns, int client, int64_t ns);

/* The client to serve: the last one while its virtual time is less than TURNS_SLICE_NS beyond that
 * of every other client, so that clients do not alternate at every query; else the one with the
 * least. Only active clients that the filter accepts (NULL: all) are considered. last: -1: none.
 * Returns its number, -1: none. *lead_ns: the virtual time of the next such client minus that of
 * this one; INT64_MAX: there is no other. */
enum { TURNS_SLICE_NS = 500000 };
typedef bool turns_filter(const void *user, int client);
int turns_next(const struct turns *turns, turns_filter *may, const void *user, int last,
               int64_t *lead_ns);

/* The active client with the least virtual time; -1: none is active. */
int turns_least(const struct turns *turns);

/* A client is about to be served: the current virtual time becomes the least of the active clients,
 * if that is later. */
void turns_begin(struct turns *turns);

/* The least virtual time of an active client minus the virtual time that this idle client would
 * have if it became active now. INT64_MAX: no client is active. */
int64_t turns_lead(const struct turns *turns, int client);

#endif
