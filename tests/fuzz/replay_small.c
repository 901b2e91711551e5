#define _GNU_SOURCE /* memfd_create() */
#include "replay_small.h"

#define known_bodies_create create_known_bodies
#define known_bodies_learn learn_body
#include "known_bodies.c"
#undef known_bodies_create
#undef known_bodies_learn

#include "recent.h"
#include "temporary.h"

#include <sys/mman.h>

struct known_bodies *known_bodies_create(size_t capacity);
struct known_body *known_bodies_learn(struct known_bodies *known, const struct query_frame *frame,
                                      int64_t key, int64_t server_id);

static struct {
    size_t recent_bytes, bodies;
} limits;
static struct replay_small used;

void replay_small_begin(size_t recent_bytes, size_t bodies)
{
    limits.recent_bytes = recent_bytes;
    limits.bodies = bodies;
    used = (struct replay_small){.longest = 0};
}

struct replay_small replay_small_used(void)
{
    return used;
}

/* ---- Bodies ---- */

struct known_bodies *known_bodies_create(size_t capacity)
{
    return create_known_bodies(capacity < limits.bodies ? capacity : limits.bodies);
}

struct known_body *known_bodies_learn(struct known_bodies *known, const struct query_frame *frame,
                                      int64_t key, int64_t server_id)
{
    const bool full = known->count == known->capacity;
    used.forgets = used.forgets || (full && find(known, frame->body_id, key) == NONE);
    return learn_body(known, frame, key, server_id);
}

/* ---- Queries and results ---- */

static struct recent_item *put(struct recent *recent, const struct match_item *item)
{
    struct recent_item *copy = recent_put(recent, item);
    used.longest = copy->length > used.longest ? copy->length : used.longest;
    used.all += copy->length;
    return copy;
}

#define recent_open(bytes, gone, user) \
    recent_open((bytes) < limits.recent_bytes ? (bytes) : limits.recent_bytes, gone, user)
#define recent_put put
#include "match.c"

/* ---- What goes to files ---- */

#define SPILL_QUERIES_AT_ONCE 1
#define SPILL_PART_BITS 1
#include "spill.c"

/* In memory, where making one takes no disk. */
FILE *temporary_open(void)
{
    const int file = memfd_create("temporary", MFD_CLOEXEC);
    return file < 0 ? NULL : fdopen(file, "w+b");
}
