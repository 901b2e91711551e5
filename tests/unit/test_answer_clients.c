/* Clients that follow the rules of msgs/README.md always get right answers, whatever is lost on the
 * way, and whatever others do with the same ids: simulated clients against fmb_decide(). */
#include "unit.h"

#include "answer_now.h"
#include "scene_truth.h"
#include "wire.h"

enum { CLIENTS = 5, IDS = 24, PLACEMENTS = 8, CONTENTS = 64 };

/* Two clients are in 2D, the others in 3D; all use the same ids, each for bodies of its own. */
struct client {
    int dim;
    int content[IDS + 1];           /* of each body, as it is now */
    struct handle handle[CONTENTS]; /* as far as results have reported it */
};

static struct {
    struct draw draw;
    struct answerer *answerer;
    struct answer_job *job;
    struct client client[CLIENTS];
    struct scene content[2]; /* [dim - 2]: CONTENTS placements */
    bool quiet;              /* nothing is lost or interrupted */
    long answered, by_handle, unknown;
} world;

static void begin(bool quiet, size_t frames)
{
    const struct answerer_options options = {frames, .server_id = 1,
                                             .secret = {0x243f6a8885a308d3, 0x13198a2e03707344}};
    struct draw draw;
    draw_begin(&draw, "clients");
    memset(&world, 0, sizeof world);
    world.draw = draw;
    world.quiet = quiet;
    world.answerer = answerer_create(&options);
    world.job = answer_job_create();
    assert_true(world.answerer && world.job);
    for (int dim = 2; dim <= 3; dim++)
        scene_draw_placements(&world.draw, dim, -1, CONTENTS, &world.content[dim - 2]);
    for (int c = 0; c < CLIENTS; c++) {
        struct client *client = &world.client[c];
        client->dim = c < 2 ? 2 : 3;
        for (int id = 1; id <= IDS; id++)
            client->content[id] = draw_int(&world.draw, 0, CONTENTS - 1);
    }
}

static void end(void)
{
    answer_job_destroy(world.job);
    answerer_destroy(world.answerer);
}

static bool one_in(int n)
{
    return draw_int(&world.draw, 1, n) == 1;
}

static struct query_placement *content_of(const struct client *client, int content)
{
    return &world.content[client->dim - 2].query.placement[content];
}

/* ---- Handles ---- */

/* A handle is that of one geometry for ever. */
static void store_handle(struct client *client, int64_t id, const struct handle *handle)
{
    struct handle *known = &client->handle[client->content[id]];
    assert_false(handle_is_none(handle));
    assert_true(handle_is_none(known) || handle_equal(known, handle));
    *known = *handle;
}

static void shorten(const struct client *client, struct query_placement *placement)
{
    if (placement->placed.id == 0)
        return;
    const struct handle *handle = &client->handle[client->content[placement->placed.id]];
    if (handle_is_none(handle) || one_in(8))
        return;
    scene_name(placement, handle);
    world.by_handle++;
}

/* ---- Queries ---- */

static void change_bodies(struct client *client)
{
    for (int id = 1; id <= IDS; id++)
        if (one_in(12))
            client->content[id] = draw_int(&world.draw, 0, CONTENTS - 1);
}

/* Any body of the client, somewhere; one in eight is anonymous. */
static void place(const struct client *client, struct query_placement *out)
{
    const int64_t id = one_in(8) ? 0 : draw_int(&world.draw, 1, IDS);
    const int anywhere = draw_int(&world.draw, 0, CONTENTS - 1);
    *out = *content_of(client, id ? client->content[id] : anywhere);
    out->placed.id = id;
    if (one_in(2))
        memcpy(out->placed.position, content_of(client, anywhere)->placed.position,
               sizeof out->placed.position);
}

static void place_all(const struct client *client, struct scene_query *out)
{
    out->duration = 1;
    out->want = draw_int(&world.draw, 0, 1) * FMB_WANT_BOX | FMB_WANT_TIMES;
    out->method = one_in(16) ? fmb_method_by_name("exact")->number : 0;
    out->which = draw_int(&world.draw, FMB_PAIRS_LISTED, FMB_PAIRS_ACROSS);
    out->placement_count = draw_int(&world.draw, 2, PLACEMENTS);
    for (int32_t i = 0; i < out->placement_count; i++)
        place(client, &out->placement[i]);
    out->index_count = out->split = out->first_pair = 0;
    if (out->which == FMB_PAIRS_LISTED)
        scene_draw_pairs(&world.draw, 8, out);
    if (out->which == FMB_PAIRS_ACROSS)
        out->split = draw_int(&world.draw, 0, out->placement_count);
}

/* Another client sends a scene of its own, and does not wait for the result. */
static void disturb(void)
{
    static struct scene_query query;
    static struct scene_result result;
    const struct client *client = &world.client[draw_int(&world.draw, 0, CLIENTS - 1)];
    place_all(client, &query);
    if (one_in(2))
        for (int32_t i = 0; i < query.placement_count; i++)
            shorten(client, &query.placement[i]);
    scene_answer(world.job, world.answerer, &query, &result);
}

/* The frames in the place of each handle that is not held. There is one at least. */
static void send_whole(const struct scene_query *whole, const struct scene_result *result,
                       struct scene_query *sent)
{
    assert_true(result->unknown_count > 0);
    for (int32_t i = 0; i < result->unknown_count; i++) {
        const unsigned index = result->unknown[i];
        assert_true(query_by_handle(&sent->placement[index]));
        sent->placement[index] = whole->placement[index];
    }
    world.unknown++;
}

/* False: lost on the way there or back, as far as the client knows. */
static bool get_answer(const struct scene_query *sent, struct scene_result *result)
{
    if (!world.quiet && one_in(4))
        disturb();
    if (!world.quiet && one_in(8))
        return false;
    scene_answer(world.job, world.answerer, sent, result);
    return world.quiet || !one_in(8);
}

/* Handles are those of the placements that came whole with an id, in their order. */
static void store_handles(struct client *client, const struct scene_query *sent,
                          const struct scene_result *result)
{
    int32_t count = 0;
    for (int32_t i = 0; i < sent->placement_count; i++) {
        const struct query_placement *placement = &sent->placement[i];
        if (placement->placed.id && !query_by_handle(placement))
            store_handle(client, placement->placed.id, &result->handle[count++]);
    }
    assert_int_equal(result->handle_count, count);
}

static void query_scene(struct client *client)
{
    static struct scene_query whole, sent;
    static struct scene_result result;
    place_all(client, &whole);
    sent = whole;
    for (int32_t i = 0; i < sent.placement_count; i++)
        shorten(client, &sent.placement[i]);
    int unknown = 0;
    for (;;) {
        if (!get_answer(&sent, &result))
            continue;
        if (result.status != FMB_UNKNOWN_BODY)
            break;
        assert_true(++unknown <= PLACEMENTS); /* each time one more is whole */
        send_whole(&whole, &result, &sent);
    }
    scene_assert(&whole, &result);
    store_handles(client, &sent, &result);
    world.answered++;
}

/* The same, pair by pair. */
static void query_pair(struct client *client)
{
    static struct scene_query whole;
    static const unsigned both[2] = {0, 1};
    struct pair_query sent = {.want = FMB_WANT_BOX | FMB_WANT_POINT, .duration = 1};
    struct pair_result result;
    struct fmb_answer answer;
    whole.duration = 1;
    for (int f = 0; f < 2; f++) {
        place(client, &whole.placement[f]);
        sent.placement[f] = whole.placement[f];
        shorten(client, &sent.placement[f]);
    }
    answer_pair(world.answerer, &sent, &result);
    if (result.status == FMB_UNKNOWN_BODY) {
        memcpy(sent.placement, whole.placement, sizeof sent.placement);
        answer_pair(world.answerer, &sent, &result);
        world.unknown++;
    }
    assert_int_equal(result.status, FMB_OK);
    scene_decide(&whole, both, &answer);
    assert_memory_equal(&answer, &result.answer, sizeof answer);
    for (int f = 0; f < 2; f++)
        if (sent.placement[f].placed.id && !query_by_handle(&sent.placement[f]))
            store_handle(client, sent.placement[f].placed.id, &result.handle[f]);
        else
            assert_true(handle_is_none(&result.handle[f]));
    world.answered++;
}

static void query_much(void)
{
    for (long round = 0; round < draw_sample(6000); round++) {
        struct client *client = &world.client[draw_int(&world.draw, 0, CLIENTS - 1)];
        change_bodies(client);
        (one_in(4) ? query_pair : query_scene)(client);
    }
}

static void clients_that_share_ids_and_lose_datagrams(void **state)
{
    static const size_t frames[] = {1, 6, 24, 100};
    for (size_t i = 0; i < COUNT(frames); i++) {
        begin(false, frames[i]);
        query_much();
        const struct cache_counts counts = cache_counts(answerer_cache(world.answerer));
        assert_true(world.answered > 0 && world.by_handle > 0 && world.unknown > 0);
        assert_true(counts.evictions > 0 && counts.hits > 0);
        assert_true(counts.frames <= counts.frame_capacity);
        assert_true(counts.frames + SOLID_FRAMES_MAX > counts.frame_capacity);
        assert_true(counts.ids <= IDS);
        end();
    }
}

/* With capacity for the bodies of all clients each is prepared once, whichever client uses which id
 * for which of them, and no handle is ever unknown. */
static void clients_that_share_ids_do_not_disturb_each_other(void **state)
{
    begin(true, 2 * CONTENTS * SOLID_FRAMES_MAX);
    query_much();
    const struct cache_counts counts = cache_counts(answerer_cache(world.answerer));
    assert_true(world.by_handle > 0);
    assert_int_equal(world.unknown, 0);
    assert_int_equal(counts.evictions, 0);
    assert_int_equal(counts.misses, counts.bodies);
    assert_int_equal(counts.ids, IDS);
    end();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clients_that_share_ids_and_lose_datagrams),
        cmocka_unit_test(clients_that_share_ids_do_not_disturb_each_other),
    };
    return cmocka_run_group_tests_name("answer_clients", tests, NULL, NULL);
}
