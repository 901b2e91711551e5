#include "known_bodies.h"

#include "allocate.h"
#include "check.h"

#include <stdlib.h>
#include <string.h>

/* Linked by index as in the service's cache: entry 0 holds nothing; it closes the ring of use, with
 * the newest on one side and the oldest on the other, and ends the chains of the buckets. */
enum { NONE = 0, ENDS = 0 };

struct entry {
    struct known_body body;
    uint32_t next;         /* in the bucket */
    uint32_t newer, older; /* in the order of use */
};

struct known_bodies {
    size_t capacity, used;
    uint32_t mask;
    uint32_t *bucket;    /* [mask + 1] */
    struct entry *entry; /* [capacity + 1] */
};

struct known_bodies *known_bodies_create(size_t capacity)
{
    struct known_bodies *known = allocate(1, sizeof *known);
    uint32_t buckets = 2;
    while (buckets < capacity)
        buckets *= 2;
    known->capacity = capacity;
    known->mask = buckets - 1;
    known->bucket = allocate(buckets, sizeof *known->bucket);
    known->entry = allocate(capacity + 1, sizeof *known->entry);
    return known;
}

void known_bodies_destroy(struct known_bodies *known)
{
    if (!known)
        return;
    free(known->bucket);
    free(known->entry);
    free(known);
}

/* A log may hold any ids: both numbers are mixed, so that no arithmetic pattern fills one bucket.
 */
static uint32_t *bucket_of(struct known_bodies *known, int64_t body_id, int64_t key)
{
    const uint64_t mixed = query_id_mix(body_id ^ (int64_t) query_id_mix(key));
    return &known->bucket[(uint32_t) (mixed >> 32) & known->mask];
}

static uint32_t find(struct known_bodies *known, int64_t body_id, int64_t key)
{
    uint32_t e = *bucket_of(known, body_id, key);
    while (e != NONE &&
           (known->entry[e].body.body_id != body_id || known->entry[e].body.key != key))
        e = known->entry[e].next;
    return e;
}

static void unlink_use(struct known_bodies *known, uint32_t e)
{
    const uint32_t newer = known->entry[e].newer, older = known->entry[e].older;
    known->entry[newer].older = older;
    known->entry[older].newer = newer;
}

static void link_newest(struct known_bodies *known, uint32_t e)
{
    const uint32_t newest = known->entry[ENDS].older;
    known->entry[e].newer = ENDS;
    known->entry[e].older = newest;
    known->entry[newest].newer = e;
    known->entry[ENDS].older = e;
}

static uint32_t evict_oldest(struct known_bodies *known)
{
    const uint32_t e = known->entry[ENDS].newer;
    const struct known_body *body = &known->entry[e].body;
    uint32_t *link = bucket_of(known, body->body_id, body->key);
    while (*link != e)
        link = &known->entry[*link].next;
    *link = known->entry[e].next;
    unlink_use(known, e);
    return e;
}

static uint32_t insert(struct known_bodies *known, int64_t body_id, int64_t key)
{
    const uint32_t e =
        known->used < known->capacity ? (uint32_t) ++known->used : evict_oldest(known);
    uint32_t *bucket = bucket_of(known, body_id, key);
    known->entry[e].next = *bucket;
    *bucket = e;
    link_newest(known, e);
    return e;
}

struct known_body *known_bodies_find(struct known_bodies *known, int64_t body_id, int64_t key)
{
    const uint32_t e = find(known, body_id, key);
    if (e == NONE)
        return NULL;
    unlink_use(known, e);
    link_newest(known, e);
    return &known->entry[e].body;
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
        body = &known->entry[insert(known, frame->body_id, key)].body;
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
