#include "turns.h"

#include <stdlib.h>

enum { ENTRIES = TURNS_CLIENTS + 1, SHARED = TURNS_CLIENTS, BUCKET_BITS = 11 };

struct client {
    int64_t id;
    int64_t used_ns;  /* virtual time */
    int64_t idle;     /* moment at which it became idle; see turns.moments */
    int32_t position; /* in turns.active; -1: idle */
    int32_t next;     /* in its bucket; -1: none */
};

struct turns {
    struct client client[ENTRIES];
    int32_t active[ENTRIES]; /* in no order */
    int32_t active_count;
    int32_t count;                    /* of clients, without the shared one */
    int64_t now_ns;                   /* the current virtual time */
    int64_t moments;                  /* counts activations and the reverse */
    int32_t bucket[1 << BUCKET_BITS]; /* first client; -1: none */
    uint64_t multiplier;
};

struct turns *turns_create(uint64_t random)
{
    struct turns *turns = calloc(1, sizeof *turns);
    if (!turns)
        return NULL;
    turns->multiplier = random | 1;
    for (int i = 0; i < 1 << BUCKET_BITS; i++)
        turns->bucket[i] = -1;
    turns->client[SHARED] = (struct client){.used_ns = TURNS_ENTRY_NS, .position = -1, .next = -1};
    return turns;
}

void turns_destroy(struct turns *turns)
{
    free(turns);
}

/* ---- Clients by id ---- */

/* The highest bits of the product with a random odd number: two ids share a bucket with a
 * probability of at most 2 / buckets if they were chosen without knowing that number
 * (Dietzfelbinger, Hagerup, Katajainen, Penttonen: A reliable randomized algorithm for the
 * closest-pair problem, 1997). */
static int32_t *bucket_of(struct turns *turns, int64_t id)
{
    return &turns->bucket[(uint64_t) id * turns->multiplier >> (64 - BUCKET_BITS)];
}

static void forget(struct turns *turns, int32_t c)
{
    int32_t *link = bucket_of(turns, turns->client[c].id);
    while (*link != c)
        link = &turns->client[*link].next;
    *link = turns->client[c].next;
}

/* The client that has been idle longest, without debt; SHARED: none. */
static int32_t find_replaceable(const struct turns *turns)
{
    int32_t found = SHARED;
    int64_t idle = INT64_MAX;
    for (int32_t c = 0; c < TURNS_CLIENTS; c++) {
        const struct client *client = &turns->client[c];
        if (client->position < 0 && client->used_ns <= turns->now_ns && client->idle < idle) {
            found = c;
            idle = client->idle;
        }
    }
    return found;
}

static int32_t add(struct turns *turns, int64_t id)
{
    int32_t c = turns->count;
    if (c < TURNS_CLIENTS) {
        turns->count++;
    } else {
        c = find_replaceable(turns);
        if (c == SHARED)
            return c;
        forget(turns, c);
    }
    int32_t *bucket = bucket_of(turns, id);
    turns->client[c] = (struct client){.id = id,
                                       .used_ns = turns->now_ns + TURNS_ENTRY_NS,
                                       .idle = turns->moments,
                                       .position = -1,
                                       .next = *bucket};
    *bucket = c;
    return c;
}

int turns_client(struct turns *turns, int64_t id)
{
    int32_t c = *bucket_of(turns, id);
    while (c >= 0 && turns->client[c].id != id)
        c = turns->client[c].next;
    return c >= 0 ? c : add(turns, id);
}

/* ---- Virtual time ---- */

static int64_t resumes_at(const struct turns *turns, int client)
{
    const int64_t used_ns = turns->client[client].used_ns;
    return used_ns > turns->now_ns ? used_ns : turns->now_ns;
}

void turns_activate(struct turns *turns, int client)
{
    struct client *c = &turns->client[client];
    if (c->position >= 0)
        return;
    c->used_ns = resumes_at(turns, client);
    c->position = turns->active_count;
    turns->active[turns->active_count++] = client;
}

void turns_deactivate(struct turns *turns, int client)
{
    struct client *c = &turns->client[client];
    if (c->position < 0)
        return;
    const int32_t last = turns->active[--turns->active_count];
    turns->active[c->position] = last;
    turns->client[last].position = c->position;
    c->position = -1;
    c->idle = ++turns->moments;
}

int turns_active(const struct turns *turns)
{
    return turns->active_count;
}

void turns_charge(struct turns *turns, int client, int64_t ns)
{
    turns->client[client].used_ns += ns;
}

/* The active client with the least virtual time among those that the filter accepts, but for one;
 * -1: there is none. */
static int least_of(const struct turns *turns, turns_filter *may, const void *user, int except)
{
    int found = -1;
    for (int32_t i = 0; i < turns->active_count; i++) {
        const int32_t c = turns->active[i];
        if (c != except && (!may || may(user, c)) &&
            (found < 0 || turns->client[c].used_ns < turns->client[found].used_ns))
            found = c;
    }
    return found;
}

int turns_least(const struct turns *turns)
{
    return least_of(turns, NULL, NULL, -1);
}

/* The virtual time of the other client minus that of the first; INT64_MAX: there is no other. */
static int64_t lead_over(const struct turns *turns, int client, int other)
{
    return other < 0 ? INT64_MAX : turns->client[other].used_ns - turns->client[client].used_ns;
}

int turns_next(const struct turns *turns, turns_filter *may, const void *user, int last,
               int64_t *lead_ns)
{
    const int other = least_of(turns, may, user, last);
    if (last >= 0 && turns->client[last].position >= 0 && (!may || may(user, last))) {
        *lead_ns = lead_over(turns, last, other);
        if (*lead_ns > -TURNS_SLICE_NS)
            return last;
    }
    *lead_ns = other < 0 ? INT64_MAX : lead_over(turns, other, least_of(turns, may, user, other));
    return other;
}

void turns_begin(struct turns *turns)
{
    const int least = turns_least(turns);
    if (least >= 0 && turns->client[least].used_ns > turns->now_ns)
        turns->now_ns = turns->client[least].used_ns;
}

int64_t turns_lead(const struct turns *turns, int client)
{
    const int least = turns_least(turns);
    return least < 0 ? INT64_MAX : turns->client[least].used_ns - resumes_at(turns, client);
}
