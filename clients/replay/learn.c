#include "learn.h"

#include "allocate.h"
#include "big_endian.h"
#include "check.h"
#include "definition.h"
#include "wire.h"

#include <stdlib.h>

struct learner {
    struct known_bodies *known;
    union {
        struct pair_query pair;
        struct scene_query scene;
    } query;
    union {
        struct pair_result pair;
        struct scene_result scene;
    } result;
};

struct learner *learner_open(struct known_bodies *known)
{
    struct learner *learner = allocate(1, sizeof *learner);
    learner->known = known;
    return learner;
}

void learner_close(struct learner *learner)
{
    free(learner);
}

/* ---- Is there anything new? ----
 *
 * Most results tell what is known already. That is seen from their bytes, at places that are the
 * same in all: a pair's ids of bodies and keys; of a scene that was decided, the number of its keys
 * (its detail is empty). */

enum { SERVER_AT = 32, BODIES_AT = 40, KEYS_AT = 56, KEYS_END = 72, KEY_COUNT_AT = 61 };

static int64_t int64_at(const unsigned char *b)
{
    return (int64_t) big_endian_64(b);
}

void learn_expect(const struct learner *learner, const struct match_item *result)
{
    if (result->kind != LOG_PAIR_QUERY || result->size < KEYS_END)
        return;
    for (int f = 0; f < 2; f++)
        known_bodies_expect(learner->known, int64_at(result->bytes + BODIES_AT + 8 * f),
                            int64_at(result->bytes + KEYS_AT + 8 * f));
}

static bool pair_tells_news(const struct learner *learner, const struct match_item *result,
                            bool mine)
{
    if (result->size < KEYS_END)
        return false;
    const int64_t server_id = int64_at(result->bytes + SERVER_AT);
    for (int f = 0; f < 2; f++) {
        const int64_t body_id = int64_at(result->bytes + BODIES_AT + 8 * f);
        const int64_t key = int64_at(result->bytes + KEYS_AT + 8 * f);
        if (key != 0 && !known_bodies_has(learner->known, body_id, key, server_id, mine))
            return true;
    }
    return false;
}

static bool scene_tells_keys(const struct match_item *result)
{
    return result->size >= KEY_COUNT_AT + 4 && big_endian_32(result->bytes + KEY_COUNT_AT) != 0;
}

bool learn_may(const struct learner *learner, const struct match_item *result)
{
    return result->kind == LOG_PAIR_QUERY ? pair_tells_news(learner, result, false)
                                          : scene_tells_keys(result);
}

/* ---- Learning ---- */

/* Who told a key. */
struct telling {
    int64_t server_id;
    bool mine;
};

/* Whether a frame that came whole has the very key that the result tells for it: then it says
 * itself what its key stands for, as fmb log cut writes it, and the result adds nothing to that. */
static bool claims(const struct query_frame *frame, int64_t key)
{
    return frame->key == key;
}

/* What a service tells again it has told before: a key of its names the same components for ever.
 * What is only claimed counts where nothing was told. */
static void learn_frame(struct learner *learner, const struct query_frame *frame, int64_t key,
                        struct telling telling)
{
    struct known_bodies *known = learner->known;
    if (check_by_key(frame) || key == 0 || !query_id_ok(key) ||
        known_bodies_has(known, frame->body_id, key, telling.server_id, telling.mine))
        return;
    struct known_body *body = known_bodies_find(known, frame->body_id, key);
    const bool same = body && known_bodies_same(body, frame);
    const bool mine = telling.mine || (same && body->mine);
    if (!body || (body->server_id != telling.server_id && !claims(frame, key)))
        body = known_bodies_learn(known, frame, key, claims(frame, key) ? 0 : telling.server_id);
    else if (!same)
        return;
    if (body)
        body->mine = mine;
}

static void learn_pair(struct learner *learner, const struct match_item *query_item,
                       const struct match_item *result_item)
{
    struct pair_query *query = &learner->query.pair;
    struct pair_result *result = &learner->result.pair;
    const bool mine = query_item->place.mine && result_item->place.mine;
    if (!pair_tells_news(learner, result_item, mine) ||
        wire_read_pair_query(query_item->bytes, query_item->size, query) ||
        wire_read_pair_result(result_item->bytes, result_item->size, result) ||
        result->status != FMB_OK)
        return;
    const struct telling telling = {result->server_id, mine};
    for (int f = 0; f < 2; f++)
        learn_frame(learner, &query->frame[f], result->key[f], telling);
}

static void learn_scene(struct learner *learner, const struct match_item *query_item,
                        const struct match_item *result_item)
{
    struct scene_query *query = &learner->query.scene;
    struct scene_result *result = &learner->result.scene;
    if (!scene_tells_keys(result_item) ||
        wire_read_scene_query(query_item->bytes, query_item->size, query) ||
        wire_read_scene_result(result_item->bytes, result_item->size, result) ||
        result->status != FMB_OK)
        return;
    const struct telling telling = {result->server_id,
                                    query_item->place.mine && result_item->place.mine};
    for (int32_t i = 0; i < query->frame_count && i < result->key_count; i++)
        learn_frame(learner, &query->frame[i], result->key[i], telling);
}

void learn(struct learner *learner, const struct match_item *query, const struct match_item *result)
{
    (query->kind == LOG_PAIR_QUERY ? learn_pair : learn_scene)(learner, query, result);
}

bool learn_definition(struct learner *learner, const struct match_item *item)
{
    struct scene_query *query = &learner->query.scene;
    if (item->kind != LOG_SCENE_QUERY || item->ids.client_id != DEFINITION_CLIENT ||
        wire_read_scene_query(item->bytes, item->size, query) || !definition_is(query))
        return false;
    definition_learn(query, learner->known, item->place.mine);
    return true;
}
