#include "known_bodies.h"

#include "allocate.h"
#include "check.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* Linked by index; 0 ends the chains of the buckets. Who goes for another is found by a hand that
 * walks round: it spares those that were used since it came by, once. So to use a body touches its
 * own slot alone, not its neighbours in some order: most logs ask of it for every frame. */
enum { NONE = 0 };

struct slot {
    int64_t body_id, key;
    uint32_t next; /* in the bucket */
    bool used;     /* since the hand came by */
};

struct known_bodies {
    uint32_t capacity, count, hand;
    uint32_t mask;
    uint32_t *bucket;        /* [mask + 1]: first slot of each */
    struct slot *slot;       /* [capacity + 1] */
    struct known_body *body; /* [capacity + 1] */
};

struct known_bodies *known_bodies_create(size_t capacity)
{
    struct known_bodies *known = allocate(1, sizeof *known);
    uint32_t buckets = 2;
    assert(capacity >= 1 && capacity < UINT32_MAX / 2);
    while (buckets < capacity)
        buckets *= 2;
    known->capacity = (uint32_t) capacity;
    known->mask = buckets - 1;
    known->bucket = allocate(buckets, sizeof *known->bucket);
    known->slot = allocate(capacity + 1, sizeof *known->slot);
    known->body = allocate(capacity + 1, sizeof *known->body);
    return known;
}

void known_bodies_destroy(struct known_bodies *known)
{
    if (!known)
        return;
    free(known->bucket);
    free(known->slot);
    free(known->body);
    free(known);
}

/* A log may hold any ids: both numbers are mixed, so that no arithmetic pattern fills one bucket.
 */
static uint32_t *bucket_of(const struct known_bodies *known, int64_t body_id, int64_t key)
{
    const uint64_t mixed = query_id_mix(body_id ^ (int64_t) query_id_mix(key));
    return &known->bucket[(uint32_t) (mixed >> 32) & known->mask];
}

static uint32_t find(const struct known_bodies *known, int64_t body_id, int64_t key)
{
    uint32_t s = *bucket_of(known, body_id, key);
    while (s != NONE && (known->slot[s].body_id != body_id || known->slot[s].key != key))
        s = known->slot[s].next;
    return s;
}

static void unlink_slot(struct known_bodies *known, uint32_t s)
{
    uint32_t *link = bucket_of(known, known->slot[s].body_id, known->slot[s].key);
    while (*link != s)
        link = &known->slot[*link].next;
    *link = known->slot[s].next;
}

static uint32_t free_slot(struct known_bodies *known)
{
    if (known->count < known->capacity)
        return ++known->count;
    for (;;) {
        known->hand = known->hand % known->capacity + 1;
        if (!known->slot[known->hand].used)
            break;
        known->slot[known->hand].used = false;
    }
    unlink_slot(known, known->hand);
    return known->hand;
}

static uint32_t insert(struct known_bodies *known, int64_t body_id, int64_t key)
{
    const uint32_t s = free_slot(known);
    uint32_t *bucket = bucket_of(known, body_id, key);
    known->slot[s] = (struct slot){.body_id = body_id, .key = key, .next = *bucket};
    *bucket = s;
    return s;
}

struct known_body *known_bodies_find(struct known_bodies *known, int64_t body_id, int64_t key)
{
    const uint32_t s = find(known, body_id, key);
    if (s == NONE)
        return NULL;
    known->slot[s].used = true;
    return &known->body[s];
}

bool known_bodies_has(struct known_bodies *known, int64_t body_id, int64_t key, int64_t server_id)
{
    const struct known_body *body = known_bodies_find(known, body_id, key);
    return body && body->server_id == server_id;
}

/* A log may say anything. */
static bool can_have_key(const struct query_frame *frame)
{
    int32_t status;
    char detail[QUERY_TEXT_MAX];
    struct checking checking = {.status = &status, .detail = detail};
    return frame->body_id > 0 && frame->components.count > 0 && check_frame(&checking, frame);
}

struct known_body *known_bodies_learn(struct known_bodies *known, const struct query_frame *frame,
                                      int64_t key, int64_t server_id)
{
    if (!can_have_key(frame))
        return NULL;
    struct known_body *body = known_bodies_find(known, frame->body_id, key);
    if (!body)
        body = &known->body[insert(known, frame->body_id, key)];
    *body = (struct known_body){.body_id = frame->body_id,
                                .key = key,
                                .server_id = server_id,
                                .dim = frame->dim,
                                .shape = frame->shape,
                                .components = frame->components};
    return body;
}

bool known_bodies_same(const struct known_body *body, const struct query_frame *frame)
{
    return body->dim == frame->dim && body->shape == frame->shape &&
           body->components.count == frame->components.count &&
           memcmp(body->components.number, frame->components.number,
                  (size_t) frame->components.count * sizeof(double)) == 0;
}

bool known_bodies_complete(struct known_bodies *known, struct query_frame *frame)
{
    const struct known_body *body = known_bodies_find(known, frame->body_id, frame->key);
    if (!body || body->dim != frame->dim || body->shape != frame->shape)
        return false;
    frame->components = body->components;
    return true;
}
