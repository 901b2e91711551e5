#include "live.h"

#include "allocate.h"
#include "answer.h"
#include "big_endian.h"
#include "check.h"
#include "join.h"
#include "scene_pairs.h"
#include "wire.h"

#include <assert.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum {
    /* After so many deaths of keys a query goes whole if it fits; after so many more the service is
     * believed not to hold as many bodies. Others may have replaced them each time. */
    DEATHS_TRUSTED = 2,
    DEATHS_MAX = 6,
    /* Queries for one of the log: each time it is taught it takes three or four of them. Ends what
     * a service that tells no keys would make of it. */
    ASKS_MAX = 64
};

struct live {
    struct known_bodies *known;
    int64_t client_id, next_number;
    int64_t next_utime; /* for queries whose ids are refused */
    union {
        struct pair_query pair;
        struct scene_query scene;
    } query;
    union {
        struct pair_result pair;
        struct scene_result scene;
    } result;
    struct scene_result joined;
    struct answerer refusing; /* all 0: enough to refuse */
};

_Static_assert((int) LOG_DATA_MAX >= (int) QUERY_BYTES_MAX &&
                   (int) LOG_DATA_MAX >= (int) WIRE_RESULT_BYTES_MAX,
               "room for queries and results");

struct live *live_open(struct known_bodies *known, int64_t client_id)
{
    struct live *live = allocate(1, sizeof *live);
    live->known = known;
    live->client_id = client_id;
    live->next_number = 1;
    return live;
}

void live_close(struct live *live)
{
    free(live);
}

/* ---- Queries as they are in a message ---- */

static const char *read_query(struct live *live, enum log_kind kind, const unsigned char *bytes,
                              size_t size)
{
    return kind == LOG_PAIR_QUERY
               ? wire_read_pair_query(bytes, (uint32_t) size, &live->query.pair)
               : wire_read_scene_query(bytes, (uint32_t) size, &live->query.scene);
}

static void read_recorded(struct live *live, const struct live_query *query)
{
    const char *error =
        read_query(live, query->recorded.kind, query->recorded.bytes, query->recorded.size);
    assert(!error); /* it was read before */
    (void) error;
}

/* Of the query that was read last. */
static struct query_frame *frames_of(struct live *live, enum log_kind kind, int32_t *count)
{
    *count = kind == LOG_PAIR_QUERY ? 2 : live->query.scene.frame_count;
    return kind == LOG_PAIR_QUERY ? live->query.pair.frame : live->query.scene.frame;
}

static bool is_good(const struct query_frame *frame)
{
    int32_t status;
    char detail[QUERY_TEXT_MAX];
    struct checking checking = {.status = &status, .detail = detail};
    return check_frame(&checking, frame);
}

/* Whether the service will look at a key: there is one, and the query is not refused before that,
 * for its length or for a frame. Then it is written again, and otherwise stays as it is, with all
 * that is wrong with it. */
static void set_keyed(struct live *live, struct live_query *out)
{
    int32_t count;
    struct query_frame *frame = frames_of(live, out->recorded.kind, &count);
    if (out->recorded.size > QUERY_BYTES_MAX || count > QUERY_FRAMES_MAX)
        return;
    for (int32_t i = 0; i < count; i++) {
        out->keyed = out->keyed || check_by_key(&frame[i]);
        out->told_keys = out->told_keys || (frame[i].body_id && !check_by_key(&frame[i]));
    }
    for (int32_t i = 0; i < count && out->keyed; i++)
        out->keyed = is_good(&frame[i]);
}

/* ---- Beginning ---- */

static bool knows_all(struct live *live, enum log_kind kind)
{
    int32_t count;
    const struct query_frame *frame = frames_of(live, kind, &count);
    for (int32_t i = 0; i < count; i++)
        if (check_by_key(&frame[i]) &&
            !known_bodies_find(live->known, frame[i].body_id, frame[i].key))
            return false;
    return true;
}

/* What a service checks before it counts on these numbers. */
static void set_total(const struct scene_query *scene, struct live_query *out)
{
    const bool across = scene->which == QUERY_PAIRS_ACROSS;
    out->first_pair = out->next_pair = scene->first_pair;
    out->listed = scene->which == QUERY_PAIRS_LISTED;
    out->total = -1;
    if (scene->which < QUERY_PAIRS_LISTED || scene->which > QUERY_PAIRS_ACROSS ||
        scene->frame_count > QUERY_FRAMES_MAX || scene->split < 0 ||
        scene->split > (across ? scene->frame_count : 0))
        return;
    const int32_t total = scene_pairs_total(scene);
    if (scene->first_pair >= 0 && scene->first_pair <= total)
        out->total = total;
}

static size_t bytes_of_pair(const struct pair_query *pair)
{
    const size_t result = 256; /* with a detail of usual length */
    return pair->want & QUERY_WANT_CERTIFICATE ? WIRE_BYTES_MAX : result;
}

/* Of the result; of the query with all frames whole. */
static size_t bytes_of_scene(const struct scene_query *scene, const struct live_query *query)
{
    const size_t number = sizeof(double);
    const size_t named = scene->which == QUERY_PAIRS_LISTED ? 0 : WIRE_PAIR_BYTES;
    const size_t times = scene->want & QUERY_WANT_TIMES ? 2 * number : 0;
    const size_t box = scene->want & QUERY_WANT_BOX ? 2 * FMB_DIM_MAX * number : 0;
    const size_t frames = (size_t) scene->frame_count;
    const size_t pairs = query->total < 0 ? 0 : (size_t) (query->total - query->first_pair);
    const size_t result =
        WIRE_SCENE_RESULT_BYTES + number * frames + pairs * (1 + named + times + box);
    const size_t whole =
        query->recorded.size + (query->keyed ? frames * FMB_COMPONENTS_MAX * number : 0);
    return result > whole ? result : whole;
}

static void set_bytes(const struct live *live, struct live_query *out)
{
    const size_t most = QUERY_BYTES_MAX, size = out->recorded.size;
    out->bytes = out->recorded.kind == LOG_PAIR_QUERY ? bytes_of_pair(&live->query.pair)
                                                      : bytes_of_scene(&live->query.scene, out);
    out->bytes = out->bytes < most ? out->bytes : most;
    out->bytes = out->bytes > size ? out->bytes : size;
}

enum answer_now_outcome live_begin(struct live *live, const struct match_item *recorded,
                                   struct live_query *out, const char **error)
{
    const bool pair = recorded->kind == LOG_PAIR_QUERY;
    memset(out, 0, offsetof(struct live_query, in_log)); /* what follows will be written */
    out->recorded = *recorded;
    out->recorded.bytes = out->in_log;
    memcpy(out->in_log, recorded->bytes, recorded->size);
    if ((*error = read_query(live, recorded->kind, recorded->bytes, recorded->size)))
        return ANSWER_NOW_UNREADABLE;
    frames_of(live, recorded->kind, &out->frames_once);
    set_keyed(live, out);
    if (!pair)
        set_total(&live->query.scene, out);
    set_bytes(live, out);
    return !out->keyed || knows_all(live, recorded->kind) ? ANSWER_NOW_DONE
                                                          : ANSWER_NOW_WITHOUT_BODY;
}

/* ---- Asking ---- */

static struct query_header own_ids(struct live *live, const struct query_header *recorded)
{
    if (query_id_ok(recorded->client_id) && query_id_ok(recorded->sequence_number))
        return (struct query_header){recorded->utime, live->client_id, live->next_number++};
    return (struct query_header){live->next_utime++, recorded->client_id,
                                 recorded->sequence_number};
}

static void put(unsigned char *b, int64_t value, int bytes)
{
    for (int i = bytes; i > 0; i--, value >>= 8)
        b[i - 1] = (unsigned char) value;
}

/* Where they stand in all queries, behind the fingerprint; and in those of scenes. */
enum { UTIME_AT = 8, CLIENT_AT = 16, NUMBER_AT = 24, FIRST_PAIR_AT = 56 };

static void write_recorded(struct live_query *query)
{
    memcpy(query->asked, query->recorded.bytes, query->recorded.size);
    put(query->asked + UTIME_AT, query->ids.utime, 8);
    put(query->asked + CLIENT_AT, query->ids.client_id, 8);
    put(query->asked + NUMBER_AT, query->ids.sequence_number, 8);
    if (query->next_pair != query->first_pair)
        put(query->asked + FIRST_PAIR_AT, query->next_pair, 4);
    query->frames = query->frames_once;
    query->size = query->recorded.size;
}

/* A frame by key as it goes to the service. One of another shape or dimension than its key was told
 * for names nothing, then as now. With components the key of the log may stay: the service does not
 * look at it, and it tells later whose the key in the result is. */
static void put_frame(struct live *live, struct live_query *query, struct query_frame *frame,
                      bool by_key)
{
    const struct known_body *body =
        check_by_key(frame) ? known_bodies_find(live->known, frame->body_id, frame->key) : NULL;
    if (!body || body->dim != frame->dim || body->shape != frame->shape)
        return;
    if (by_key && body->key_now != 0) {
        frame->key = body->key_now;
        query->by_key++;
    } else {
        frame->components = body->components;
        query->completed++;
    }
}

static void put_frames(struct live *live, struct live_query *query, bool by_key)
{
    int32_t count;
    read_recorded(live, query);
    struct query_frame *frame = frames_of(live, query->kind, &count);
    query->by_key = query->completed = 0;
    for (int32_t i = 0; i < count; i++)
        put_frame(live, query, &frame[i], by_key);
    query->frames = count;
}

static void write_pair(struct live *live, struct live_query *query)
{
    struct pair_query *pair = &live->query.pair;
    put_frames(live, query, query->failures < DEATHS_TRUSTED);
    pair->utime = query->ids.utime;
    pair->client_id = query->ids.client_id;
    pair->sequence_number = query->ids.sequence_number;
    query->size = wire_write_pair_query(pair, query->asked);
}

static size_t size_of_scene(const struct scene_query *scene)
{
    size_t size = WIRE_SCENE_QUERY_BYTES + (size_t) scene->index_count * (WIRE_PAIR_BYTES / 2);
    for (int32_t i = 0; i < scene->frame_count; i++)
        size += wire_frame_bytes(&scene->frame[i]);
    return size;
}

/* A query of no pairs, of the frames whose keys the service has not told yet: as many as fit. */
static void put_lesson(struct live *live, struct live_query *query)
{
    struct scene_query *scene = &live->query.scene;
    size_t size = WIRE_SCENE_QUERY_BYTES;
    int32_t count = 0;
    read_recorded(live, query);
    for (int32_t i = 0; i < scene->frame_count; i++) {
        struct query_frame *frame = &scene->frame[i];
        query->by_key = query->completed = 0;
        frame->velocity.count = 0;
        put_frame(live, query, frame, true);
        if (query->completed == 0)
            continue;
        size += wire_frame_bytes(frame);
        if (size > QUERY_BYTES_MAX)
            break;
        scene->frame[count++] = *frame;
    }
    scene->duration = 0;
    scene->method = scene->want = scene->split = scene->first_pair = scene->index_count = 0;
    scene->which = QUERY_PAIRS_LISTED;
    scene->frame_count = query->frames = count;
    query->by_key = 0;
    query->completed = count;
    query->teaches = true;
    query->lessons++;
}

static void write_scene(struct live *live, struct live_query *query)
{
    struct scene_query *scene = &live->query.scene;
    const bool by_key = query->failures < DEATHS_TRUSTED;
    put_frames(live, query, by_key);
    if (size_of_scene(scene) > QUERY_BYTES_MAX && !by_key)
        put_frames(live, query, true);
    scene->first_pair = query->next_pair;
    if (size_of_scene(scene) > QUERY_BYTES_MAX)
        put_lesson(live, query);
    scene->utime = query->ids.utime;
    scene->client_id = query->ids.client_id;
    scene->sequence_number = query->ids.sequence_number;
    query->size = wire_write_scene_query(scene, query->asked);
}

void live_next(struct live *live, struct live_query *query)
{
    query->asks++;
    query->kind = query->recorded.kind;
    query->ids = own_ids(live, &query->recorded.ids);
    query->teaches = false;
    query->by_key = query->completed = 0;
    if (!query->keyed || query->hopeless || query->asks > ASKS_MAX)
        write_recorded(query);
    else
        (query->kind == LOG_PAIR_QUERY ? write_pair : write_scene)(live, query);
}

/* ---- Results ---- */

static const char *read_result(struct live *live, enum log_kind kind, const void *bytes,
                               uint32_t size)
{
    return kind == LOG_PAIR_QUERY ? wire_read_pair_result(bytes, size, &live->result.pair)
                                  : wire_read_scene_result(bytes, size, &live->result.scene);
}

static int32_t status_of(const struct live *live, enum log_kind kind)
{
    return kind == LOG_PAIR_QUERY ? live->result.pair.status : live->result.scene.status;
}

/* Whether the answers are those to the pairs that were asked last, so many as there are. */
static bool answers_pairs(const struct scene_result *scene, const struct live_query *query)
{
    const int32_t least = query->next_pair + (query->next_pair < query->total);
    if (scene->end_pair < least || scene->end_pair > query->total)
        return false;
    if (query->listed)
        return !scene->names_pairs && scene->verdict_count == scene->end_pair - query->next_pair;
    return scene->names_pairs || scene->verdict_count == 0;
}

/* Whether a result is one to what was asked; whoever goes through its pairs counts on that. */
static bool goes_with(const struct live *live, const struct live_query *query)
{
    const struct scene_result *scene = &live->result.scene;
    if (status_of(live, query->kind) < FMB_OK)
        return false;
    if (query->kind == LOG_PAIR_QUERY)
        return true;
    if (scene->key_count != 0 && scene->key_count != query->frames)
        return false;
    return scene->status != FMB_OK || query->teaches || answers_pairs(scene, query);
}

/* Of the frame of this number; 0: it tells none. */
static int64_t key_of(const struct live *live, enum log_kind kind, int32_t frame)
{
    const struct scene_result *scene = &live->result.scene;
    const int64_t key = kind == LOG_PAIR_QUERY     ? live->result.pair.key[frame]
                        : frame < scene->key_count ? scene->key[frame]
                                                   : 0;
    return query_id_ok(key) ? key : 0;
}

/* The keys that the service tells for what came whole in place of a key of the log. */
static void learn_keys(struct live *live, const struct live_query *query)
{
    int32_t count;
    read_query(live, query->kind, query->asked, query->size);
    struct query_frame *frame = frames_of(live, query->kind, &count);
    for (int32_t i = 0; i < count; i++) {
        const int64_t key = key_of(live, query->kind, i);
        if (key == 0 || frame[i].key == 0 || frame[i].components.count == 0)
            continue;
        struct known_body *body = known_bodies_find(live->known, frame[i].body_id, frame[i].key);
        if (body && known_bodies_same(body, &frame[i]))
            body->key_now = key;
    }
}

/* After UNKNOWN_BODY: the keys of the service that are not held. Of a pair that may be either.
 * Other queries under way with the same keys will find them forgotten, and are told the same. */
static void forget_keys(struct live *live, const struct live_query *query)
{
    int32_t count;
    read_recorded(live, query);
    struct query_frame *frame = frames_of(live, query->kind, &count);
    for (int32_t i = 0; i < count; i++) {
        struct known_body *body =
            check_by_key(&frame[i]) ? known_bodies_find(live->known, frame[i].body_id, frame[i].key)
                                    : NULL;
        if (body && key_of(live, query->kind, i) == 0)
            body->key_now = 0;
    }
}

/* Whether the query has to be asked again, for the keys' sake. */
static bool lacks_keys(struct live *live, struct live_query *query)
{
    const int32_t status = status_of(live, query->kind);
    if (status == FMB_OK && query->completed > 0)
        learn_keys(live, query);
    if (query->teaches) {
        query->hopeless = status != FMB_OK;
        return true;
    }
    if (status != FMB_UNKNOWN_BODY || query->by_key == 0)
        return false;
    forget_keys(live, query);
    query->deaths++;
    return query->failures++ < DEATHS_MAX;
}

/* ---- The end ----
 *
 * Results as the log would have them: wire_write_*()'s bytes, with the ids of the query that was
 * recorded. */

static void keep_pair(struct live *live, struct live_query *query)
{
    struct pair_result *result = &live->result.pair;
    const struct query_header *ids = &query->recorded.ids;
    query->answered.compute_ns = result->compute_ns;
    query->answered.status = result->status;
    query->answered.pairs = result->status == FMB_OK;
    result->utime = ids->utime;
    result->client_id = ids->client_id;
    result->sequence_number = ids->sequence_number;
    result->compute_ns = 0;
    query->answered.size = wire_write_pair_result(result, query->result);
    query->answered.bytes = query->result;
}

static void keep_scene(struct live_query *query, struct scene_result *result)
{
    const struct query_header *ids = &query->recorded.ids;
    query->answered.compute_ns = result->compute_ns;
    query->answered.status = result->status;
    query->answered.pairs = result->status == FMB_OK ? result->end_pair - query->first_pair : 0;
    result->utime = ids->utime;
    result->client_id = ids->client_id;
    result->sequence_number = ids->sequence_number;
    result->compute_ns = 0;
    query->answered.size = wire_write_scene_result(result, query->result);
    query->answered.bytes = query->result;
}

/* Behind the answers so far. Without keys where none were told once: their room was for answers. */
static struct scene_result *join_parts(struct live *live, struct live_query *query)
{
    struct scene_result *result = &live->result.scene;
    if (query->keyed && !query->told_keys)
        result->key_count = 0;
    if (query->next_pair == query->first_pair)
        return result;
    wire_read_scene_result(query->answered.bytes, (uint32_t) query->answered.size, &live->joined);
    live->joined.compute_ns = query->answered.compute_ns;
    read_recorded(live, query);
    return join(&live->joined, result, &live->query.scene) ? &live->joined : NULL;
}

static enum live_taken take_part(struct live *live, struct live_query *query)
{
    struct scene_result *result = join_parts(live, query);
    if (!result)
        return LIVE_NONSENSE;
    keep_scene(query, result);
    if (result->end_pair >= query->total || !join_has_room(result))
        return LIVE_DONE;
    query->next_pair = result->end_pair;
    query->asks = query->failures = 0;
    return LIVE_MORE;
}

static enum live_taken take_last(struct live *live, struct live_query *query)
{
    if (query->kind == LOG_PAIR_QUERY)
        keep_pair(live, query);
    else
        keep_scene(query, &live->result.scene);
    return LIVE_DONE;
}

enum live_taken live_take(struct live *live, struct live_query *query, const void *bytes,
                          uint32_t size, bool patient)
{
    if (size > QUERY_BYTES_MAX || read_result(live, query->kind, bytes, size) ||
        !goes_with(live, query))
        return LIVE_NONSENSE;
    const int32_t status = status_of(live, query->kind);
    query->server_id =
        query->kind == LOG_PAIR_QUERY ? live->result.pair.server_id : live->result.scene.server_id;
    if (status == FMB_BUSY && patient)
        return LIVE_BUSY;
    if (lacks_keys(live, query))
        return LIVE_MORE;
    const bool part = status == FMB_OK && query->kind == LOG_SCENE_QUERY;
    return (part ? take_part : take_last)(live, query);
}

void live_refuse(struct live *live, struct live_query *query)
{
    read_recorded(live, query);
    if (query->recorded.kind == LOG_PAIR_QUERY)
        answer_pair_refused(&live->refusing, &live->query.pair, FMB_OVER_LIMIT, &live->result.pair);
    else
        answer_scene_refused(&live->refusing, &query->recorded.ids, FMB_OVER_LIMIT,
                             &live->result.scene);
    query->kind = query->recorded.kind;
    take_last(live, query);
}
