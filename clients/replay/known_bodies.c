#include "known_bodies.h"

#include "allocate.h"
#include "check.h"
#include "random_id.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* Linked by index; 0 ends the chains of the buckets. Who goes for another is found by a hand that
 * walks round: it spares those that were used since it came by, once. So to use a body touches its
 * own slot alone, not its neighbours in some order; slots are small and lie together, and there are
 * no more buckets than there is use for: most logs ask for every frame, and have few bodies. */
enum { NONE = 0, BUCKET_BITS_MIN = 8 };

struct slot {
    int64_t body_id, key, server_id;
    uint32_t next; /* in the bucket */
    bool used;     /* since the hand came by */
};

struct known_bodies {
    uint32_t capacity, count, hand;
    uint64_t multiplier[2]; /* random */
    int bucket_bits;
    uint32_t *bucket;        /* [2^bucket_bits]: first slot of each */
    struct slot *slot;       /* [capacity + 1] */
    struct known_body *body; /* [capacity + 1] */
};

struct known_bodies *known_bodies_create(size_t capacity)
{
    assert(capacity >= 1 && capacity < UINT32_MAX / 2);
    struct known_bodies *known = allocate(1, sizeof *known);
    known->capacity = (uint32_t) capacity;
    known->bucket_bits = BUCKET_BITS_MIN;
    for (int i = 0; i < 2; i++)
        known->multiplier[i] = query_id_mix(random_id());
    known->bucket = allocate((size_t) 1 << known->bucket_bits, sizeof *known->bucket);
    known->slot = allocate_in_lines(capacity + 1, sizeof *known->slot);
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

/* A log may hold any ids. The upper bits of a sum of products: with numbers that nobody knows, two
 * bodies share a bucket by chance alone. */
static uint32_t *bucket_of(const struct known_bodies *known, int64_t body_id, int64_t key)
{
    const uint64_t sum =
        (uint64_t) body_id * known->multiplier[0] + (uint64_t) key * known->multiplier[1];
    return &known->bucket[sum >> (64 - known->bucket_bits)];
}

static uint32_t find(const struct known_bodies *known, int64_t body_id, int64_t key)
{
    uint32_t s = *bucket_of(known, body_id, key);
    while (s != NONE && (known->slot[s].body_id != body_id || known->slot[s].key != key))
        s = known->slot[s].next;
    return s;
}

void known_bodies_expect_soon(const struct known_bodies *known, int64_t body_id, int64_t key)
{
    __builtin_prefetch(bucket_of(known, body_id, key));
}

void known_bodies_expect(const struct known_bodies *known, int64_t body_id, int64_t key)
{
    const uint32_t s = *bucket_of(known, body_id, key);
    __builtin_prefetch(&known->slot[s]);
    __builtin_prefetch(&known->body[s]);
}

static void link_slot(struct known_bodies *known, uint32_t s)
{
    uint32_t *bucket = bucket_of(known, known->slot[s].body_id, known->slot[s].key);
    known->slot[s].next = *bucket;
    *bucket = s;
}

static void unlink_slot(struct known_bodies *known, uint32_t s)
{
    uint32_t *link = bucket_of(known, known->slot[s].body_id, known->slot[s].key);
    while (*link != s)
        link = &known->slot[*link].next;
    *link = known->slot[s].next;
}

/* Twice as many buckets. */
static void grow(struct known_bodies *known)
{
    free(known->bucket);
    known->bucket_bits++;
    known->bucket = allocate((size_t) 1 << known->bucket_bits, sizeof *known->bucket);
    for (uint32_t s = 1; s <= known->count; s++)
        link_slot(known, s);
}

static uint32_t free_slot(struct known_bodies *known)
{
    if (known->count < known->capacity) {
        if (known->count >> known->bucket_bits > 0)
            grow(known);
        return ++known->count;
    }
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
    known->slot[s] = (struct slot){.body_id = body_id, .key = key};
    link_slot(known, s);
    return s;
}

static uint32_t use(struct known_bodies *known, int64_t body_id, int64_t key)
{
    const uint32_t s = find(known, body_id, key);
    known->slot[s].used = true; /* that of none too */
    return s;
}

struct known_body *known_bodies_find(struct known_bodies *known, int64_t body_id, int64_t key)
{
    const uint32_t s = use(known, body_id, key);
    return s == NONE ? NULL : &known->body[s];
}

bool known_bodies_has(struct known_bodies *known, int64_t body_id, int64_t key, int64_t server_id,
                      bool mine)
{
    const uint32_t s = use(known, body_id, key);
    return s != NONE && known->slot[s].server_id == server_id && (!mine || known->body[s].mine);
}

bool known_bodies_half_full(const struct known_bodies *known)
{
    return known->count > known->capacity / 2;
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
    uint32_t s = use(known, frame->body_id, key);
    if (s == NONE)
        s = insert(known, frame->body_id, key);
    known->slot[s].server_id = server_id;
    known->body[s] = (struct known_body){.body_id = frame->body_id,
                                         .key = key,
                                         .server_id = server_id,
                                         .dim = frame->dim,
                                         .shape = frame->shape,
                                         .components = frame->components};
    return &known->body[s];
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
