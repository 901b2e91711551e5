#include "scheduler.h"

#include <stdlib.h>

enum { ENTRIES = SCHEDULER_CLIENTS + 1, SHARED = SCHEDULER_CLIENTS, BUCKET_BITS = 11 };

/* Think time of a client that is unknown, and the longest that is estimated. */
enum { FIRST_GUESS_NS = 50000, THINK_MAX_NS = 16000000 };

struct scheduled_client {
    int64_t id;
    int64_t used_ns;  /* virtual time */
    int64_t idle;     /* value of scheduler.moments when it became idle */
    int64_t idle_ns;  /* when it became idle; 0: never */
    int64_t think_ns; /* estimate */
    int32_t position; /* in scheduler.active; -1: idle */
    int32_t next;     /* next client in the bucket; -1: none */
};

struct scheduler {
    struct scheduled_client client[ENTRIES];
    int32_t active[ENTRIES]; /* in no order */
    int32_t active_count;
    int32_t count;                    /* of clients, without the shared one */
    int64_t now_ns;                   /* the system's virtual time */
    int64_t moments;                  /* counts the times that a client became idle */
    int32_t bucket[1 << BUCKET_BITS]; /* [hash of the id] first client; -1: none */
    uint64_t multiplier;
};

struct scheduler *scheduler_create(uint64_t random)
{
    struct scheduler *scheduler = calloc(1, sizeof *scheduler);
    if (!scheduler)
        return NULL;
    scheduler->multiplier = random | 1;
    for (int i = 0; i < 1 << BUCKET_BITS; i++)
        scheduler->bucket[i] = -1;
    scheduler->client[SHARED] = (struct scheduled_client){
        .used_ns = SCHEDULER_ENTRY_NS, .think_ns = FIRST_GUESS_NS, .position = -1, .next = -1};
    return scheduler;
}

void scheduler_destroy(struct scheduler *scheduler)
{
    free(scheduler);
}

/* ---- Clients by id ---- */

/* Multiply-shift hashing: the highest bits of the product of the id and a random odd number. Two
 * ids that were chosen without knowing that number share a bucket with probability at most 2 /
 * buckets (Dietzfelbinger, Hagerup, Katajainen, Penttonen: A reliable randomized algorithm for the
 * closest-pair problem, 1997). */
static int32_t *bucket_of(struct scheduler *scheduler, int64_t id)
{
    return &scheduler->bucket[(uint64_t) id * scheduler->multiplier >> (64 - BUCKET_BITS)];
}

static void unlink_id(struct scheduler *scheduler, int32_t c)
{
    int32_t *link = bucket_of(scheduler, scheduler->client[c].id);
    while (*link != c)
        link = &scheduler->client[*link].next;
    *link = scheduler->client[c].next;
}

/* The client without debt that has been idle longest; SHARED: there is none. */
static int32_t find_replaceable(const struct scheduler *scheduler)
{
    int32_t found = SHARED;
    int64_t idle = INT64_MAX;
    for (int32_t c = 0; c < SCHEDULER_CLIENTS; c++) {
        const struct scheduled_client *client = &scheduler->client[c];
        if (client->position < 0 && client->used_ns <= scheduler->now_ns && client->idle < idle) {
            found = c;
            idle = client->idle;
        }
    }
    return found;
}

static int32_t add(struct scheduler *scheduler, int64_t id)
{
    int32_t c = scheduler->count;
    if (c < SCHEDULER_CLIENTS) {
        scheduler->count++;
    } else {
        c = find_replaceable(scheduler);
        if (c == SHARED)
            return c;
        unlink_id(scheduler, c);
    }
    int32_t *bucket = bucket_of(scheduler, id);
    scheduler->client[c] =
        (struct scheduled_client){.id = id,
                                  .used_ns = scheduler->now_ns + SCHEDULER_ENTRY_NS,
                                  .idle = scheduler->moments,
                                  .think_ns = FIRST_GUESS_NS,
                                  .position = -1,
                                  .next = *bucket};
    *bucket = c;
    return c;
}

int scheduler_client(struct scheduler *scheduler, int64_t id)
{
    int32_t c = *bucket_of(scheduler, id);
    while (c >= 0 && scheduler->client[c].id != id)
        c = scheduler->client[c].next;
    return c >= 0 ? c : add(scheduler, id);
}

/* ---- Virtual time ---- */

/* The virtual time at which an idle client would resume. */
static int64_t resume_ns(const struct scheduler *scheduler, int client)
{
    const int64_t used_ns = scheduler->client[client].used_ns;
    return used_ns > scheduler->now_ns ? used_ns : scheduler->now_ns;
}

/* Doubles the estimate if the think time was longer, and reduces it by a quarter if it was shorter.
 * No change if the bounds include the estimate. */
static void estimate_think(struct scheduled_client *c, int64_t min_ns, int64_t max_ns)
{
    if (min_ns > c->think_ns && c->think_ns < THINK_MAX_NS)
        c->think_ns *= 2;
    else if (max_ns < c->think_ns)
        c->think_ns -= c->think_ns / 4;
}

void scheduler_activate(struct scheduler *scheduler, int client, int64_t arrival_min_ns,
                        int64_t arrival_max_ns)
{
    struct scheduled_client *c = &scheduler->client[client];
    if (c->position >= 0)
        return;
    if (c->idle_ns)
        estimate_think(c, arrival_min_ns - c->idle_ns, arrival_max_ns - c->idle_ns);
    c->used_ns = resume_ns(scheduler, client);
    c->position = scheduler->active_count;
    scheduler->active[scheduler->active_count++] = client;
}

void scheduler_deactivate(struct scheduler *scheduler, int client, int64_t now_ns)
{
    struct scheduled_client *c = &scheduler->client[client];
    if (c->position < 0)
        return;
    const int32_t last = scheduler->active[--scheduler->active_count];
    scheduler->active[c->position] = last;
    scheduler->client[last].position = c->position;
    c->position = -1;
    c->idle = ++scheduler->moments;
    c->idle_ns = now_ns;
}

int scheduler_active(const struct scheduler *scheduler)
{
    return scheduler->active_count;
}

void scheduler_charge(struct scheduler *scheduler, int client, int64_t ns)
{
    scheduler->client[client].used_ns += ns;
}

/* The active client with the least virtual time, among those that the filter accepts (NULL: all);
 * -1: none. */
static int least_of(const struct scheduler *scheduler, scheduler_filter *may, const void *user)
{
    int found = -1;
    for (int32_t i = 0; i < scheduler->active_count; i++) {
        const int32_t c = scheduler->active[i];
        if ((!may || may(user, c)) &&
            (found < 0 || scheduler->client[c].used_ns < scheduler->client[found].used_ns))
            found = c;
    }
    return found;
}

int scheduler_next(struct scheduler *scheduler, scheduler_filter *may, const void *user)
{
    const int least = least_of(scheduler, NULL, NULL);
    if (least >= 0 && scheduler->client[least].used_ns > scheduler->now_ns)
        scheduler->now_ns = scheduler->client[least].used_ns;
    return least < 0 || !may || may(user, least) ? least : least_of(scheduler, may, user);
}

int64_t scheduler_patience(const struct scheduler *scheduler, int client)
{
    const struct scheduled_client *c = &scheduler->client[client];
    const int least = c->position < 0 ? least_of(scheduler, NULL, NULL) : -1;
    if (least < 0)
        return 0;
    const int64_t lead_ns = scheduler->client[least].used_ns - resume_ns(scheduler, client);
    if (c->think_ns > lead_ns)
        return 0;
    return 2 * c->think_ns < lead_ns ? 2 * c->think_ns : lead_ns;
}
