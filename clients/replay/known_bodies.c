#include "known_bodies.h"

#include "allocate.h"
#include "check.h"
#include "random_id.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

/* Linked by index, next in the bucket; 0 ends the chains. Who goes for another is found by a hand
 * that walks round: it spares those that were used since it came by, once. So to use a body touches
 * its own line alone, not its neighbours in some order; and there are no more buckets than there is
 * use for: most logs ask for every frame, and have few bodies. */
enum { NONE = 0, BUCKET_BITS_MIN = 8 };

struct known_bodies {
    uint32_t capacity, count, hand;
    uint64_t multiplier[2]; /* random */
    int bucket_bits;
    uint32_t *bucket;        /* [2^bucket_bits]: the first of each */
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
    known->body = allocate_in_lines(capacity + 1, sizeof *known->body);
    return known;
}

void known_bodies_destroy(struct known_bodies *known)
{
    if (!known)
        return;
    free(known->bucket);
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
    while (s != NONE && (known->body[s].body_id != body_id || known->body[s].key != key))
        s = known->body[s].next;
    return s;
}

void known_bodies_expect_soon(const struct known_bodies *known, int64_t body_id, int64_t key)
{
    __builtin_prefetch(bucket_of(known, body_id, key));
}

void known_bodies_expect(const struct known_bodies *known, int64_t body_id, int64_t key)
{
    const uint32_t s = *bucket_of(known, body_id, key);
    __builtin_prefetch(&known->body[s]);
}

static void link_body(struct known_bodies *known, uint32_t s)
{
    uint32_t *bucket = bucket_of(known, known->body[s].body_id, known->body[s].key);
    known->body[s].next = *bucket;
    *bucket = s;
}

static void unlink_body(struct known_bodies *known, uint32_t s)
{
    uint32_t *link = bucket_of(known, known->body[s].body_id, known->body[s].key);
    while (*link != s)
        link = &known->body[*link].next;
    *link = known->body[s].next;
}

/* Twice as many buckets. */
static void grow(struct known_bodies *known)
{
    free(known->bucket);
    known->bucket_bits++;
    known->bucket = allocate((size_t) 1 << known->bucket_bits, sizeof *known->bucket);
    for (uint32_t s = 1; s <= known->count; s++)
        link_body(known, s);
}

static uint32_t free_place(struct known_bodies *known)
{
    if (known->count < known->capacity) {
        if (known->count >> known->bucket_bits > 0)
            grow(known);
        return ++known->count;
    }
    for (;;) {
        known->hand = known->hand % known->capacity + 1;
        if (!known->body[known->hand].used)
            break;
        known->body[known->hand].used = false;
    }
    unlink_body(known, known->hand);
    return known->hand;
}

static uint32_t use(struct known_bodies *known, int64_t body_id, int64_t key)
{
    const uint32_t s = find(known, body_id, key);
    known->body[s].used = true; /* that of none too */
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
    const struct known_body *body = known_bodies_find(known, body_id, key);
    return body && body->server_id == server_id && (!mine || body->mine);
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
    const bool is_new = s == NONE;
    if (is_new)
        s = free_place(known);
    known->body[s] = (struct known_body){.body_id = frame->body_id,
                                         .key = key,
                                         .server_id = server_id,
                                         .used = !is_new,
                                         .next = is_new ? NONE : known->body[s].next,
                                         .dim = frame->dim,
                                         .shape = frame->shape,
                                         .components = frame->components};
    if (is_new)
        link_body(known, s);
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
