#include "ask.h"

#include <math.h>
#include <string.h>

#include "guard.h"
#include "wire.h"

/* Ids of bodies that are new each time begin here, far from the others; and those of scenes beyond
 * the pair's, of which queries may still wait in the service when a scene is asked. */
static const int64_t new_bodies = INT64_C(1) << 40, scene_bodies = 1000;

static const double answer_seconds = 3;

/* Where it does not come, or is a refusal, there is nothing to measure. */
static void ask_now(struct bus_bench *bench, struct datagram *query)
{
    guard_begin(answer_seconds);
    const double ns = line_round_trip(&bench->service, query);
    guard_end();
    if (isnan(ns))
        bus_bench_fail("a query was not answered");
    if (bench->service.status != FMB_OK)
        bus_bench_fail(fmb_status_text(bench->service.status));
}

static void set_key(struct query_frame *frame, int64_t key)
{
    frame->key = key;
    frame->components.count = 0;
}

/* ---- A pair ---- */

static const struct pair_query cube = {.duration = 1,
                                       .frame = {{.body_id = 1,
                                                  .shape = FMB_CUBOID,
                                                  .dim = 3,
                                                  .origin = {3, {0, 0, 0}},
                                                  .components = {9, {1, 0, 0, 0, 1, 0, 0, 0, 1}}},
                                                 {.body_id = 2,
                                                  .shape = FMB_TETRAHEDRON,
                                                  .dim = 3,
                                                  .origin = {3, {2, 0, 0}},
                                                  .components = {9, {1, 0, 0, 0, 1, 0, 0, 0, 1}},
                                                  .velocity = {3, {-1.5, 0, 0}}}}};

void ask_pair(struct bus_bench *bench, enum form form, struct datagram *out)
{
    struct pair_query query = cube;
    struct pair_result result;
    query.client_id = bench->service.client_id;
    bench->service.query_channel = WIRE_PAIR_QUERY;
    datagram_of_pair(&query, out);
    ask_now(bench, out);
    if (wire_read_pair_result(bench->service.bytes, (uint32_t) bench->service.size, &result))
        bus_bench_fail("a result that cannot be read");
    for (int i = 0; i < 2; i++) {
        if (form == FORM_BY_KEY)
            set_key(&query.frame[i], result.key[i]);
        if (form == FORM_NEW)
            query.frame[i].body_id += new_bodies;
    }
    datagram_of_pair(&query, out);
    if (form == FORM_NEW)
        datagram_renews(out, &query.frame[0], 2);
}

/* ---- A scene ---- */

static void shuffle(struct pairs *pairs, uint64_t seed)
{
    struct draw draw = {seed};
    for (size_t i = pairs->count; i > 1; i--) {
        const size_t j = (size_t) (draw_bits(&draw) % i);
        for (int end = 0; end < 2; end++) {
            const unsigned kept = pairs->at[i - 1][end];
            pairs->at[i - 1][end] = pairs->at[j][end];
            pairs->at[j][end] = kept;
        }
    }
}

struct ask_scene ask_scene_draw(int bodies, bool moving, size_t pairs, uint64_t seed)
{
    const struct cell cell = {3, moving, {FMB_CUBOID, FMB_TETRAHEDRON}};
    struct ask_scene out = {.scene = scene_draw(&cell, (size_t) bodies, seed, false),
                            .moving = moving};
    out.pairs = pairs_draw_of(&out.scene, true, pairs, seed);
    struct pairs apart = pairs_draw_of(&out.scene, false, pairs / 2, seed);
    memcpy(out.pairs.at, apart.at, pairs / 2 * sizeof *apart.at);
    pairs_free(&apart);
    shuffle(&out.pairs, seed);
    return out;
}

void ask_scene_free(struct ask_scene *scene)
{
    scene_free(&scene->scene);
    pairs_free(&scene->pairs);
}

static struct query_frame frame_of(const struct fmb_frame *frame, int64_t body_id)
{
    const struct fmb_body *body = frame->body;
    struct query_frame out = {.body_id = body_id,
                              .shape = (int32_t) body->shape,
                              .dim = body->dim,
                              .origin = {.count = body->dim},
                              .components = {.count = body->count * body->dim},
                              .velocity = {.count = frame->moving ? body->dim : 0}};
    memcpy(out.origin.number, frame->origin, sizeof frame->origin);
    memcpy(out.velocity.number, frame->velocity, sizeof frame->velocity);
    for (int i = 0; i < body->count; i++)
        memcpy(out.components.number + i * body->dim, body->component[i],
               (size_t) body->dim * sizeof(double));
    return out;
}

/* In as many queries as it takes, whose results tell the keys. */
static void hold_frames(struct bus_bench *bench, struct scene_query *query)
{
    static struct scene_query part;
    static struct scene_result result;
    static struct datagram datagram;
    const int at_a_time = 400;
    for (int first = 0; first < query->frame_count; first += at_a_time) {
        const int left = query->frame_count - first, count = left < at_a_time ? left : at_a_time;
        part = (struct scene_query){.client_id = query->client_id, .duration = 1};
        part.frame_count = count;
        memcpy(part.frame, query->frame + first, (size_t) count * sizeof *part.frame);
        datagram_of_scene(&part, &datagram);
        ask_now(bench, &datagram);
        if (wire_read_scene_result(bench->service.bytes, (uint32_t) bench->service.size, &result) ||
            result.key_count != count)
            bus_bench_fail("a result without keys");
        for (int i = 0; i < count; i++)
            query->frame[first + i].key = result.key[i];
    }
}

static void set_form(struct bus_bench *bench, enum form form, struct scene_query *query)
{
    hold_frames(bench, query);
    for (int i = 0; i < query->frame_count; i++) {
        if (form == FORM_BY_KEY)
            set_key(&query->frame[i], query->frame[i].key);
        else
            query->frame[i].key = 0;
        if (form == FORM_NEW)
            query->frame[i].body_id += new_bodies;
    }
}

/* How many pairs the query has room for. */
static size_t room_for_pairs(const struct scene_query *query)
{
    size_t taken = WIRE_SCENE_QUERY_BYTES;
    for (int i = 0; i < query->frame_count; i++)
        taken += wire_frame_bytes(&query->frame[i]);
    if (taken > QUERY_BYTES_MAX)
        bus_bench_fail("a scene that is too large");
    return (QUERY_BYTES_MAX - taken) / WIRE_PAIR_BYTES;
}

static void list_pairs(const struct pairs *pairs, size_t count, struct scene_query *query)
{
    query->index_count = 2 * (int32_t) count;
    for (size_t i = 0; i < count; i++)
        memcpy(query->pair[i], pairs->at[i], sizeof query->pair[i]);
}

/* How many of the pairs the result has room for. */
static size_t room_in_result(struct bus_bench *bench, const struct scene_query *query)
{
    static struct scene_result result;
    static struct datagram datagram;
    datagram_of_scene(query, &datagram);
    ask_now(bench, &datagram);
    if (wire_read_scene_result(bench->service.bytes, (uint32_t) bench->service.size, &result))
        bus_bench_fail("a result that cannot be read");
    return (size_t) result.end_pair;
}

size_t ask_scene(struct bus_bench *bench, const struct ask_scene *scene, enum form form,
                 int32_t which, int32_t want, struct datagram *out)
{
    static struct scene_query query;
    query = (struct scene_query){.client_id = bench->service.client_id,
                                 .duration = 1,
                                 .want = want,
                                 .which = which,
                                 .frame_count = (int32_t) scene->scene.count};
    bench->service.query_channel = WIRE_SCENE_QUERY;
    for (int i = 0; i < query.frame_count; i++)
        query.frame[i] = frame_of(&scene->scene.frame[i], scene_bodies + i);
    set_form(bench, form, &query);
    if (which == QUERY_PAIRS_LISTED) {
        const size_t room = room_for_pairs(&query);
        list_pairs(&scene->pairs, room < scene->pairs.count ? room : scene->pairs.count, &query);
    }
    const size_t count = room_in_result(bench, &query);
    if (which == QUERY_PAIRS_LISTED)
        list_pairs(&scene->pairs, count, &query);
    datagram_of_scene(&query, out);
    if (form == FORM_NEW)
        datagram_renews(out, &query.frame[0], query.frame_count);
    return count;
}
