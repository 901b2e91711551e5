#include "answer_now.h"

#include "allocate.h"
#include "answer.h"
#include "check.h"
#include "clock.h"
#include "wire.h"

#include <stdlib.h>

/* Any will do, as long as it is always the same. */
enum { SERVER_ID = 1, FIRST_KEY = 1 };

/* Never given by a cache that counts from FIRST_KEY. */
static const int64_t no_key = QUERY_ID_MAX;

struct answer_now {
    struct answerer answerer;
    struct known_bodies *known;
    union {
        struct pair_query pair;
        struct scene_query scene;
    } query;
    union {
        struct pair_result pair;
        struct scene_result scene;
    } result;
    int64_t key_then[QUERY_FRAMES_MAX]; /* of the frames that came by key; 0: of others */
    unsigned char bytes[LOG_DATA_MAX];
};

_Static_assert((int) LOG_DATA_MAX >= (int) QUERY_BYTES_MAX &&
                   (int) LOG_DATA_MAX >= (int) WIRE_RESULT_BYTES_MAX,
               "room for a result");

struct answer_now *answer_now_open(size_t bodies, struct known_bodies *known)
{
    struct answer_now *now = allocate(1, sizeof *now);
    now->known = known;
    now->answerer.server_id = SERVER_ID;
    now->answerer.cache = cache_create(bodies, FIRST_KEY);
    if (!now->answerer.cache || !answer_prepare(&now->answerer))
        allocate_failed();
    return now;
}

void answer_now_close(struct answer_now *now)
{
    if (!now)
        return;
    cache_destroy(now->answerer.cache);
    answer_release(&now->answerer);
    free(now);
}

/* ---- Keys ----
 *
 * A key of the log becomes the key that this cache has for the same components. A frame that has
 * both, key and components (fmb log cut writes such), counts as one by key, as it once was: the
 * result has as much room then. But what its key stands for is for results to say: whoever sends
 * components may send any key beside them. */

static void keep(struct answer_now *now, struct known_body *known)
{
    cache_keep(now->answerer.cache, known->body_id, known->dim, known->shape,
               known->components.number, &known->key_now);
}

/* The key under which the components of a frame that has both are known here: one that no other
 * frame has. 0: the frame is no such one. */
static int64_t claim(struct answer_now *now, struct query_frame *frame)
{
    if (frame->key <= 0 || frame->components.count == 0)
        return 0;
    const int64_t key = -frame->key;
    const struct known_body *known = known_bodies_find(now->known, frame->body_id, key);
    if (!known || !known_bodies_same(known, frame))
        known = known_bodies_learn(now->known, frame, key, 0);
    if (!known)
        return 0;
    frame->components.count = 0;
    return key;
}

/* 0: it is whole, or has a key that cannot be one and is refused. */
static int64_t key_of(struct answer_now *now, struct query_frame *frame)
{
    const int64_t claimed = claim(now, frame);
    return claimed || !check_by_key(frame) || !query_id_ok(frame->key) ? claimed : frame->key;
}

/* Returns whether the key is known, if it is there. */
static bool translate(struct answer_now *now, struct query_frame *frame, int64_t *key_then)
{
    *key_then = key_of(now, frame);
    if (*key_then == 0)
        return true;
    struct known_body *known = known_bodies_find(now->known, frame->body_id, *key_then);
    if (known && known->key_now == 0)
        keep(now, known);
    frame->key = known ? known->key_now : no_key;
    return known != NULL;
}

static bool translate_all(struct answer_now *now, struct query_frame *frame, int32_t count)
{
    bool all = true;
    for (int32_t i = 0; i < count; i++)
        if (check_by_key(&frame[i]))
            known_bodies_expect(now->known, frame[i].body_id, frame[i].key);
    for (int32_t i = 0; i < count; i++)
        all = translate(now, &frame[i], &now->key_then[i]) && all;
    return all;
}

/* For when the cache has lost some of them since: those of other publishers, with the same ids, may
 * have come between. What was known for the first frames may have had to go for those that claim.
 */
static void keep_all(struct answer_now *now, struct query_frame *frame, int32_t count)
{
    for (int32_t i = 0; i < count; i++) {
        if (now->key_then[i] == 0)
            continue;
        struct known_body *known =
            known_bodies_find(now->known, frame[i].body_id, now->key_then[i]);
        if (!known)
            continue;
        keep(now, known);
        frame[i].key = known->key_now;
    }
}

static void expect_soon(const struct answer_now *now, const struct query_frame *frame)
{
    cache_expect_soon(now->answerer.cache, frame->body_id);
    if (check_by_key(frame))
        known_bodies_expect_soon(now->known, frame->body_id, frame->key);
}

/* ---- Pairs ---- */

/* Of one of which the log's reader has not kept all, the header has to do. */
static const char *read_pair(const unsigned char *bytes, size_t size, struct pair_query *out)
{
    struct query_header header;
    const char *error = wire_read_pair_query(bytes, (uint32_t) size, out);
    if (!error || size < LOG_DATA_MAX)
        return error;
    error = wire_read_pair_header(bytes, (uint32_t) size, &header);
    *out = (struct pair_query){.utime = header.utime,
                               .client_id = header.client_id,
                               .sequence_number = header.sequence_number};
    return error;
}

static void ask_pair(struct answer_now *now, struct answered_now *out)
{
    struct pair_result *result = &now->result.pair;
    const int64_t begin = clock_ns();
    answer_pair(&now->answerer, &now->query.pair, result);
    out->compute_ns = clock_ns() - begin;
    out->status = result->status;
    out->pairs = result->status == FMB_OK;
}

static enum answer_now_outcome answer_pair_now(struct answer_now *now, const unsigned char *bytes,
                                               size_t size, struct answered_now *out)
{
    struct pair_query *query = &now->query.pair;
    bool known = true;
    if ((out->error = read_pair(bytes, size, query)))
        return ANSWER_NOW_UNREADABLE;
    expect_soon(now, &query->frame[0]);
    expect_soon(now, &query->frame[1]);
    if (size > QUERY_BYTES_MAX) {
        answer_pair_refused(&now->answerer, query, FMB_OVER_LIMIT, &now->result.pair);
    } else {
        known = translate_all(now, query->frame, 2);
        ask_pair(now, out);
        if (known && now->result.pair.status == FMB_UNKNOWN_BODY) {
            keep_all(now, query->frame, 2);
            ask_pair(now, out);
        }
    }
    out->status = now->result.pair.status;
    now->result.pair.compute_ns = out->compute_ns;
    out->size = wire_write_pair_result(&now->result.pair, now->bytes);
    return known ? ANSWER_NOW_DONE : ANSWER_NOW_WITHOUT_BODY;
}

/* ---- Scenes ---- */

static void ask_scene(struct answer_now *now, struct answered_now *out)
{
    struct scene_result *result = &now->result.scene;
    const int64_t begin = clock_ns();
    answer_scene(&now->answerer, &now->query.scene, result);
    out->compute_ns = clock_ns() - begin;
    out->pairs = result->status == FMB_OK ? result->end_pair - now->query.scene.first_pair : 0;
}

/* As the service, which looks at the header alone. */
static enum answer_now_outcome refuse_scene_now(struct answer_now *now, const unsigned char *bytes,
                                                size_t size, struct answered_now *out)
{
    struct query_header header;
    if ((out->error = wire_read_scene_header(bytes, (uint32_t) size, &header)))
        return ANSWER_NOW_UNREADABLE;
    answer_scene_refused(&now->answerer, &header, FMB_OVER_LIMIT, &now->result.scene);
    out->status = FMB_OVER_LIMIT;
    out->size = wire_write_scene_result(&now->result.scene, now->bytes);
    return ANSWER_NOW_DONE;
}

static enum answer_now_outcome answer_scene_now(struct answer_now *now, const unsigned char *bytes,
                                                size_t size, struct answered_now *out)
{
    struct scene_query *query = &now->query.scene;
    if (size > QUERY_BYTES_MAX)
        return refuse_scene_now(now, bytes, size, out);
    if ((out->error = wire_read_scene_query(bytes, (uint32_t) size, query)))
        return ANSWER_NOW_UNREADABLE;
    const int32_t count =
        query->frame_count < QUERY_FRAMES_MAX ? query->frame_count : QUERY_FRAMES_MAX;
    const bool known = translate_all(now, query->frame, count);
    ask_scene(now, out);
    if (known && now->result.scene.status == FMB_UNKNOWN_BODY) {
        keep_all(now, query->frame, count);
        ask_scene(now, out);
    }
    out->status = now->result.scene.status;
    now->result.scene.compute_ns = out->compute_ns;
    out->size = wire_write_scene_result(&now->result.scene, now->bytes);
    return known ? ANSWER_NOW_DONE : ANSWER_NOW_WITHOUT_BODY;
}

enum answer_now_outcome answer_now(struct answer_now *now, enum log_kind kind,
                                   const unsigned char *bytes, size_t size,
                                   struct answered_now *out)
{
    *out = (struct answered_now){.bytes = now->bytes};
    return kind == LOG_PAIR_QUERY ? answer_pair_now(now, bytes, size, out)
                                  : answer_scene_now(now, bytes, size, out);
}
