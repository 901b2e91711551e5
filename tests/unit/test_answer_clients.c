/* Clients that follow the rules of msgs/README.md always get right answers, whatever is lost on the
 * way, and whatever others do with the same ids: simulated clients against fmb_decide(). */
#include "answer.h"
#include "scene_truth.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { CLIENTS = 5, IDS = 24, FRAMES = 8, CONTENTS = 64, FIRST_KEY = 1000, KEYS_MAX = 1 << 20 };

/* Two clients are in 2D, the others in 3D; all use the same ids, each for bodies of its own. */
struct client {
    int dim;
    int content[IDS + 1]; /* of each body, as it is now */
    int64_t key[IDS + 1]; /* what it was told for that; 0: nothing */
};

static struct {
    struct draw draw;
    struct answerer answerer;
    struct client client[CLIENTS];
    struct scene_query content[2]; /* [dim - 2]: CONTENTS frames */
    bool quiet;                    /* nothing is lost, and no client disturbs another */
    long answered, by_key, unknown;
} world;

/* What each key was given for; NULL: it was not given yet. */
static const struct query_frame *named[KEYS_MAX];

static void begin(int clients_that_share, size_t bodies)
{
    struct draw draw;
    draw_begin(&draw, "clients");
    memset(&world, 0, sizeof world);
    memset(named, 0, sizeof named);
    world.draw = draw;
    world.quiet = clients_that_share == 1;
    world.answerer.cache = cache_create(bodies, FIRST_KEY);
    assert_true(answer_prepare(&world.answerer));
    for (int dim = 2; dim <= 3; dim++)
        scene_draw_frames(&world.draw, dim, -1, CONTENTS, &world.content[dim - 2]);
    for (int c = 0; c < CLIENTS; c++) {
        struct client *client = &world.client[c];
        client->dim = c < 2 ? 2 : 3;
        for (int id = 1; id <= IDS; id++)
            client->content[id] = draw_int(&world.draw, 0, CONTENTS - 1);
    }
}

static void end(void)
{
    answer_release(&world.answerer);
    cache_destroy(world.answerer.cache);
}

static bool one_in(int n)
{
    return draw_int(&world.draw, 1, n) == 1;
}

static const struct query_frame *frame_of(const struct client *client, int content)
{
    return &world.content[client->dim - 2].frame[content];
}

/* ---- Keys ---- */

static bool same_components(const struct query_frame *one, const struct query_frame *other)
{
    return one->shape == other->shape && one->dim == other->dim &&
           memcmp(&one->components, &other->components, sizeof one->components) == 0;
}

/* A key names one set of components for ever. */
static void learn(struct client *client, int64_t id, int64_t key)
{
    const struct query_frame *frame = frame_of(client, client->content[id]);
    const struct query_frame **names = &named[key - FIRST_KEY];
    assert_true(key >= FIRST_KEY && key < FIRST_KEY + KEYS_MAX);
    assert_true(!*names || same_components(*names, frame));
    *names = frame;
    client->key[id] = key;
}

static void send_by_key(struct query_frame *frame, int64_t key)
{
    frame->key = key;
    frame->components = (struct query_numbers){0};
    world.by_key++;
}

/* ---- Queries ---- */

static void turn_bodies(struct client *client)
{
    for (int id = 1; id <= IDS; id++)
        if (one_in(12)) {
            client->content[id] = draw_int(&world.draw, 0, CONTENTS - 1);
            client->key[id] = 0;
        }
}

/* A frame of any body of the client, somewhere; one in eight is anonymous. */
static void place(const struct client *client, struct query_frame *out)
{
    const int64_t id = one_in(8) ? 0 : draw_int(&world.draw, 1, IDS);
    const int anywhere = draw_int(&world.draw, 0, CONTENTS - 1);
    *out = *frame_of(client, id ? client->content[id] : anywhere);
    out->body_id = id;
    if (one_in(2))
        out->origin = frame_of(client, anywhere)->origin;
}

static void place_all(const struct client *client, struct scene_query *out)
{
    out->duration = 1;
    out->want = draw_int(&world.draw, 0, 1) * QUERY_WANT_BOX | QUERY_WANT_TIMES;
    out->method = one_in(16) ? fmb_method_by_name("exact")->number : 0;
    out->which = draw_int(&world.draw, QUERY_PAIRS_LISTED, QUERY_PAIRS_ACROSS);
    out->frame_count = draw_int(&world.draw, 2, FRAMES);
    for (int32_t i = 0; i < out->frame_count; i++)
        place(client, &out->frame[i]);
    out->index_count = out->split = out->first_pair = 0;
    if (out->which == QUERY_PAIRS_LISTED)
        scene_draw_pairs(&world.draw, 8, out);
    if (out->which == QUERY_PAIRS_ACROSS)
        out->split = draw_int(&world.draw, 0, out->frame_count);
}

/* What the client sends of it: bodies whose key it knows by key, as a rule. */
static void shorten(const struct client *client, struct scene_query *sent)
{
    for (int32_t i = 0; i < sent->frame_count; i++) {
        struct query_frame *frame = &sent->frame[i];
        if (frame->body_id && client->key[frame->body_id] && !one_in(8))
            send_by_key(frame, client->key[frame->body_id]);
    }
}

/* Another client asks for a scene of its own, does not wait for the answer, and forgets it. */
static void disturb(void)
{
    static struct scene_query query;
    static struct scene_result result;
    const struct client *client = &world.client[draw_int(&world.draw, 0, CLIENTS - 1)];
    place_all(client, &query);
    if (one_in(2))
        shorten(client, &query);
    answer_scene(&world.answerer, &query, &result);
}

/* Where a key is dead, the components go in its place. Some must be. */
static void send_whole(struct client *client, const struct scene_query *whole,
                       const struct scene_result *result, struct scene_query *sent)
{
    int repaired = 0;
    assert_int_equal(result->key_count, sent->frame_count);
    for (int32_t i = 0; i < sent->frame_count; i++) {
        if (sent->frame[i].components.count > 0 || result->key[i] != 0)
            continue;
        sent->frame[i] = whole->frame[i];
        client->key[whole->frame[i].body_id] = 0;
        repaired++;
    }
    assert_true(repaired > 0);
    world.unknown++;
}

/* False: lost on the way there or back, as far as the client knows. */
static bool get_answer(const struct scene_query *sent, struct scene_result *result)
{
    if (!world.quiet && one_in(4))
        disturb();
    if (!world.quiet && one_in(8))
        return false;
    answer_scene(&world.answerer, sent, result);
    return world.quiet || !one_in(8);
}

static void ask_scene(struct client *client)
{
    static struct scene_query whole, sent;
    static struct scene_result result;
    place_all(client, &whole);
    sent = whole;
    shorten(client, &sent);
    int unknown = 0;
    for (;;) {
        if (!get_answer(&sent, &result))
            continue;
        if (result.status != FMB_UNKNOWN_BODY)
            break;
        assert_true(++unknown <= FRAMES); /* each time one frame more is whole */
        send_whole(client, &whole, &result, &sent);
    }
    scene_assert(&whole, &result);
    assert_true(result.key_count == 0 || result.key_count == whole.frame_count);
    for (int32_t i = 0; i < result.key_count; i++)
        if (whole.frame[i].body_id)
            learn(client, whole.frame[i].body_id, result.key[i]);
    world.answered++;
}

/* The same, pair by pair. */
static void ask_pair(struct client *client)
{
    static struct scene_query whole;
    static const unsigned both[2] = {0, 1};
    struct pair_query sent = {.want = QUERY_WANT_BOX, .duration = 1};
    struct pair_result result;
    struct fmb_answer answer;
    whole.duration = 1;
    for (int f = 0; f < 2; f++) {
        place(client, &whole.frame[f]);
        sent.frame[f] = whole.frame[f];
        if (sent.frame[f].body_id && client->key[sent.frame[f].body_id])
            send_by_key(&sent.frame[f], client->key[sent.frame[f].body_id]);
    }
    answer_pair(&world.answerer, &sent, &result);
    if (result.status == FMB_UNKNOWN_BODY) {
        memcpy(sent.frame, whole.frame, sizeof sent.frame);
        answer_pair(&world.answerer, &sent, &result);
        world.unknown++;
    }
    assert_int_equal(result.status, FMB_OK);
    scene_decide(&whole, both, &answer);
    assert_memory_equal(&answer, &result.answer, sizeof answer);
    for (int f = 0; f < 2; f++)
        if (whole.frame[f].body_id)
            learn(client, whole.frame[f].body_id, result.key[f]);
    world.answered++;
}

static void ask_much(int clients)
{
    for (long round = 0; round < draw_sample(6000); round++) {
        struct client *client = &world.client[draw_int(&world.draw, 0, clients - 1)];
        turn_bodies(client);
        (one_in(4) ? ask_pair : ask_scene)(client);
    }
}

static void test_clients_that_share_ids_and_lose_datagrams(void **state)
{
    static const size_t bodies[] = {1, 6, 12, 100};
    (void) state;
    for (size_t i = 0; i < sizeof bodies / sizeof *bodies; i++) {
        begin(CLIENTS, bodies[i]);
        ask_much(CLIENTS);
        const struct cache_counts counts = cache_counts(world.answerer.cache);
        assert_true(world.answered > 0 && world.by_key > 0 && world.unknown > 0);
        assert_true(counts.replacements > 0 && counts.hits > 0);
        assert_int_equal(counts.evictions > 0, bodies[i] < IDS);
        assert_true(counts.bodies <= counts.capacity);
        end();
    }
}

/* With room for its bodies, and nobody who uses its ids, no key of a client ever dies but where it
 * turns the body itself. */
static void test_a_client_alone_keeps_its_keys(void **state)
{
    (void) state;
    begin(1, IDS);
    ask_much(1);
    assert_true(world.by_key > 0);
    assert_int_equal(world.unknown, 0);
    assert_int_equal(cache_counts(world.answerer.cache).evictions, 0);
    end();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_clients_that_share_ids_and_lose_datagrams),
        cmocka_unit_test(test_a_client_alone_keeps_its_keys),
    };
    return cmocka_run_group_tests_name("answer_clients", tests, NULL, NULL);
}
