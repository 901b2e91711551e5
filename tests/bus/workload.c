#include "workload.h"

#include <math.h>
#include <string.h>

#include "geometry_write.h"
#include "guard.h"
#include "wire.h"

/* Ids of a scene's bodies begin after the pair's. */
static const int64_t scene_bodies = 1000;

static const double answer_seconds = 3;

/* Without an answer, or with a refusal, there is nothing to measure. */
static void query_once(struct bus_bench *bench, struct datagram *query)
{
    guard_begin(answer_seconds);
    const double ns = line_round_trip(&bench->service, query);
    guard_end();
    if (isnan(ns))
        bus_bench_fail("a query was not answered");
    if (bench->service.status != FMB_OK)
        bus_bench_fail(fmb_status_text(bench->service.status));
}

static void read_scene(const struct bus_bench *bench, struct scene_result *out)
{
    if (wire_read_scene_result(bench->service.bytes, (uint32_t) bench->service.size, out))
        bus_bench_fail("a result that cannot be read");
}

/* ---- Placements ---- */

static void set_whole(const struct fmb_placement *from, int64_t body_id,
                      struct query_placement *out, unsigned char bytes[GEOMETRY_FRAME_BYTES_MAX])
{
    const struct fmb_frame *frame = fmb_body_frame(from->body, 0);
    const int dim = frame->dim;
    struct plain_frame own = {.shape = (int) frame->shape};
    for (int i = 0; i < frame->count; i++)
        memcpy(own.components + i * dim, frame->component[i], (size_t) dim * sizeof(double));
    *out = (struct query_placement){
        .placed = *from, .velocity_count = dim, .body = geometry_write(dim, &own, bytes)};
    out->placed.id = body_id;
    if (from->velocity[0] == 0 && from->velocity[1] == 0 && from->velocity[2] == 0)
        out->velocity_count = 0;
}

static void set_handle(struct query_placement *placement, struct handle handle)
{
    placement->body = geometry_named(placement->body.dim, &handle);
}

/* ---- A pair ---- */

void workload_pair(struct bus_bench *bench, enum form form, struct datagram *out)
{
    static const double components[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    static unsigned char geometry[2][GEOMETRY_FRAME_BYTES_MAX];
    struct fmb_body body[2];
    fmb_body_make(3, FMB_CUBOID, components, 9, &body[0]);
    fmb_body_make(3, FMB_TETRAHEDRON, components, 9, &body[1]);
    const struct fmb_placement placement[2] = {
        {.body = &body[0]}, {.body = &body[1], .position = {2, 0, 0}, .velocity = {-1.5, 0, 0}}};
    struct pair_query query = {.client_id = bench->service.client_id, .duration = 1};
    struct pair_result result;
    for (int i = 0; i < 2; i++)
        set_whole(&placement[i], 1 + i, &query.placement[i], geometry[i]);
    bench->service.query_channel = WIRE_PAIR_QUERY;
    datagram_of_pair(&query, out);
    query_once(bench, out);
    if (wire_read_pair_result(bench->service.bytes, (uint32_t) bench->service.size, &result))
        bus_bench_fail("a result that cannot be read");
    for (int i = 0; i < 2 && form == FORM_BY_HANDLE; i++)
        set_handle(&query.placement[i], result.handle[i]);
    datagram_of_pair(&query, out);
    if (form == FORM_NEW)
        datagram_renew(out, &query.placement[0], 2);
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

struct workload_scene workload_scene_draw(int bodies, size_t pairs, uint64_t seed)
{
    const struct cell cell = {3, false, {FMB_CUBOID, FMB_TETRAHEDRON}};
    struct workload_scene out = {.scene = scene_draw(&cell, (size_t) bodies, seed)};
    out.pairs = pairs_draw_of(&out.scene, true, pairs, seed);
    struct pairs apart = pairs_draw_of(&out.scene, false, pairs / 2, seed);
    memcpy(out.pairs.at, apart.at, pairs / 2 * sizeof *apart.at);
    pairs_free(&apart);
    shuffle(&out.pairs, seed);
    return out;
}

void workload_scene_free(struct workload_scene *scene)
{
    scene_free(&scene->scene);
    pairs_free(&scene->pairs);
}

/* Lets the service hold the bodies, in as many queries as it takes. */
static void set_handles(struct bus_bench *bench, struct scene_query *query)
{
    static struct scene_query part;
    static struct scene_result result;
    static struct datagram datagram;
    const int at_a_time = 300;
    for (int first = 0; first < query->placement_count; first += at_a_time) {
        const int left = query->placement_count - first,
                  count = left < at_a_time ? left : at_a_time;
        part = (struct scene_query){.client_id = query->client_id,
                                    .duration = 1,
                                    .which = FMB_PAIRS_LISTED,
                                    .placement_count = count};
        memcpy(part.placement, query->placement + first, (size_t) count * sizeof *part.placement);
        datagram_of_scene(&part, &datagram);
        query_once(bench, &datagram);
        read_scene(bench, &result);
        if (result.handle_count != count)
            bus_bench_fail("a result without handles");
        for (int i = 0; i < count; i++)
            set_handle(&query->placement[first + i], result.handle[i]);
    }
}

/* How many pairs the query has space for. */
static size_t space_for_pairs(const struct scene_query *query)
{
    size_t used = WIRE_SCENE_QUERY_BYTES;
    for (int i = 0; i < query->placement_count; i++)
        used += wire_placement_bytes(&query->placement[i]);
    if (used > QUERY_BYTES_MAX)
        bus_bench_fail("a scene that is too large");
    return (QUERY_BYTES_MAX - used) / WIRE_PAIR_BYTES;
}

static void list_pairs(const struct pairs *pairs, size_t count, struct scene_query *query)
{
    query->index_count = 2 * (int32_t) count;
    for (size_t i = 0; i < count; i++)
        memcpy(query->pair[i], pairs->at[i], sizeof query->pair[i]);
}

/* How many of the pairs the result has space for. */
static size_t pairs_answered(struct bus_bench *bench, const struct scene_query *query)
{
    static struct scene_result result;
    static struct datagram datagram;
    datagram_of_scene(query, &datagram);
    query_once(bench, &datagram);
    read_scene(bench, &result);
    return (size_t) result.end_pair;
}

size_t workload_scene(struct bus_bench *bench, const struct workload_scene *scene, enum form form,
                      struct datagram *out)
{
    static struct scene_query query;
    static unsigned char geometry[QUERY_PLACEMENTS_MAX][GEOMETRY_FRAME_BYTES_MAX];
    query = (struct scene_query){.client_id = bench->service.client_id,
                                 .duration = 1,
                                 .which = FMB_PAIRS_LISTED,
                                 .placement_count = (int32_t) scene->scene.count};
    bench->service.query_channel = WIRE_SCENE_QUERY;
    for (int i = 0; i < query.placement_count; i++)
        set_whole(&scene->scene.placement[i], scene_bodies + i, &query.placement[i], geometry[i]);
    if (form == FORM_BY_HANDLE)
        set_handles(bench, &query);
    const size_t space = space_for_pairs(&query), drawn = scene->pairs.count;
    list_pairs(&scene->pairs, space < drawn ? space : drawn, &query);
    const size_t count = pairs_answered(bench, &query);
    list_pairs(&scene->pairs, count, &query);
    datagram_of_scene(&query, out);
    if (form == FORM_NEW)
        datagram_renew(out, &query.placement[0], query.placement_count);
    return count;
}
