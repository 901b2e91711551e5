#include "told.h"

#include "allocate.h"
#include "check.h"
#include "definition.h"
#include "learn.h"

#include <stdlib.h>

static void on_both(void *user, const struct match_item *query, const struct match_item *result)
{
    struct told *told = user;
    learn(told->learner, query, result);
    told->sink.both(told->sink.user, query, result);
}

static void on_query_alone(void *user, const struct match_item *query)
{
    struct told *told = user;
    told->sink.query_alone(told->sink.user, query);
}

static void on_result_alone(void *user, const struct match_item *result)
{
    struct told *told = user;
    told->sink.result_alone(told->sink.user, result);
}

struct told *told_open(const struct match_sink *sink)
{
    struct told *told = allocate(1, sizeof *told);
    const struct match_sink matched = {on_both, on_query_alone, on_result_alone, told};
    told->sink = *sink;
    told->known = known_bodies_create(KNOWN_BODIES_USUAL);
    told->learner = learner_open(told->known);
    told->match = match_open(&matched);
    return told;
}

void told_close(struct told *told)
{
    if (!told)
        return;
    match_close(told->match);
    learner_close(told->learner);
    known_bodies_destroy(told->known);
    free(told);
}

bool told_is_by_key(const struct query_frame *frame)
{
    return check_by_key(frame) && query_id_ok(frame->key);
}

enum told_keys told_look(struct told *told, struct any_query *query, bool mine)
{
    int32_t count;
    const struct query_frame *frame = any_query_frames(query, &count);
    bool all = true;
    if (query->kind == LOG_SCENE_QUERY && definition_is(&query->scene)) {
        definition_learn(&query->scene, told->known, mine);
        return TOLD_DEFINITION;
    }
    for (int32_t i = 0; i < count; i++)
        if (told_is_by_key(&frame[i]) &&
            !known_bodies_find(told->known, frame[i].body_id, frame[i].key))
            all = false;
    return all ? TOLD_ALL : TOLD_SOME;
}

struct known_body *told_body(struct told *told, const struct query_frame *frame)
{
    struct known_body *body = known_bodies_find(told->known, frame->body_id, frame->key);
    return body && body->dim == frame->dim && body->shape == frame->shape ? body : NULL;
}
