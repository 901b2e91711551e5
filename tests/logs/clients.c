/* Clients as a service has them: several at once, whose numbers and bodies run into each other; one
 * that repeats queries; a service that is busy, forgets bodies, and is started anew. */
#include "kinds.h"

#include "log_client.h"
#include "parts.h"

#include <string.h>

enum { CLIENTS = 3, BODIES = 12, STEPS = 8, STEP_US = 10000, LIVES = 4, RECORDER = 9000 };

struct clients {
    struct tape *tape;
    struct instance instance[LIVES]; /* one life of the service after the other */
    struct instance other;           /* beside the last one */
    struct log_client log_client[CLIENTS];
    struct scene_query scene;
    struct scene_result scene_result;
};

/* ---- Their queries ---- */

/* Box or corner number n of a row, as a client's publisher has it: they differ from one to the next
 * in size, and share their ids. */
static struct solid body(int client, int n, int step)
{
    const double size[3] = {1 + 0.125 * client, 1, 1};
    const double origin[3] = {n, 0.0625 * step, 0.1 * client};
    struct solid solid = n % 3 ? part_box(3, origin, size) : part_corner(3, origin, size);
    solid.moving = n % 2;
    solid.velocity[1] = n % 4 == 1 ? 6.25 : -6.25;
    return solid;
}

/* Publishers whose ids are their own. */
static int64_t id_of(int client, int n)
{
    return 1 + 100 * client + n;
}

static struct pair_query pair_of(int client, int step, int a, int b)
{
    struct pair_query query = {.duration = 0.01, .want = step % 2 ? FMB_WANT_BOX : 0};
    const struct solid solid[2] = {body(client, a, step), body(client, b, step)};
    part_place(&solid[0], id_of(client, a), &query.placement[0]);
    part_place(&solid[1], id_of(client, b), &query.placement[1]);
    return query;
}

static void set_scene(int client, int step, struct scene_query *query)
{
    query->duration = 0.01;
    query->which = FMB_PAIRS_ALL;
    query->want = FMB_WANT_TIMES;
    query->placement_count = BODIES;
    query->index_count = query->split = query->first_pair = 0;
    for (int n = 0; n < BODIES; n++) {
        const struct solid solid = body(client, n, step);
        part_place(&solid, id_of(client, n), &query->placement[n]);
    }
}

static void query_pair(struct clients *clients, int client, int step)
{
    struct pair_query query = pair_of(client, step, step % BODIES, (step + 1) % BODIES);
    struct pair_result result;
    log_client_pair(&clients->log_client[client], &query, &result);
}

static void query_scene(struct clients *clients, int client, int step)
{
    set_scene(client, step, &clients->scene);
    log_client_scene(&clients->log_client[client], &clients->scene, &clients->scene_result);
}

/* ---- What happens ---- */

/* They count alike, and results come after the next queries; no handle is used before a
 * result carries it. */
static void query_in_turns(struct clients *clients, struct instance *instance)
{
    instance->result_after_us = 400;
    for (int step = 0; step < STEPS; step++) {
        tape_reach(clients->tape, (int64_t) step * STEP_US);
        for (int client = 0; client < CLIENTS; client++)
            query_pair(clients, client, step);
        tape_pass(clients->tape, STEP_US / 2);
        query_scene(clients, step % CLIENTS, step);
    }
    instance->result_after_us = 45;
}

/* The same number again, the same query: once by handle, and once whole. */
static void query_again(struct clients *clients, struct instance *instance, bool whole)
{
    struct pair_query query = pair_of(0, 1, 1, 2);
    struct pair_result result;
    if (whole)
        for (int n = 1; n <= 2; n++)
            log_client_forget(&clients->log_client[0], id_of(0, n));
    log_client_pair(&clients->log_client[0], &query, &result);
    for (int i = 0; i < 2; i++)
        instance_query_pair(instance, &query, &result);
}

/* Until there is capacity: the same number again. */
static void be_turned_away(struct clients *clients, struct instance *instance)
{
    struct pair_query query = pair_of(1, 3, 3, 4);
    struct pair_result result;
    query.client_id = clients->log_client[1].client_id;
    query.sequence_number = clients->log_client[1].next_number++;
    for (int i = 0; i < 2; i++)
        instance_turn_away_pair(instance, &query);
    instance_query_pair(instance, &query, &result);

    set_scene(2, 3, &clients->scene);
    clients->scene.client_id = clients->log_client[2].client_id;
    clients->scene.sequence_number = clients->log_client[2].next_number++;
    instance_turn_away_scene(instance, &clients->scene);
    instance_query_scene(instance, &clients->scene, &clients->scene_result);
}

/* Lost on the way; then some that the logger did not receive either. */
static void get_lost(struct clients *clients, struct instance *instance)
{
    struct pair_query query = pair_of(0, 2, 5, 6);
    query.client_id = clients->log_client[0].client_id;
    query.sequence_number = clients->log_client[0].next_number++;
    instance_miss_pair(instance, &query);
    clients->log_client[0].next_number += 7;
    query_scene(clients, 0, 2);
}

/* Client 1 publishes other bodies under the ids of client 0, and both are answered. The first query
 * of client 0 names its body as it was; then that has changed too. */
static void share_ids(struct clients *clients)
{
    for (int step = 0; step < 3; step++)
        for (int client = 0; client < 2; client++) {
            struct pair_query query = pair_of(0, step, 7, 8);
            struct pair_result result;
            struct solid solid = body(0, 7, step);
            solid.component[0][0] = 2 + client;
            part_place(&solid, id_of(0, 7), &query.placement[0]);
            if (step + client == 1)
                log_client_forget(&clients->log_client[client], id_of(0, 7));
            log_client_pair(&clients->log_client[client], &query, &result);
        }
}

/* A recorder that comes late requests all bodies; then some by handle, one of which no service ever
 * held. */
static void define_bodies(struct clients *clients, struct instance *instance)
{
    const struct handle handle[] = {clients->log_client[1].handle[id_of(1, 3)],
                                    {{1, 2, 3}},
                                    clients->log_client[2].handle[id_of(2, 4)]};
    instance_define(instance, RECORDER, 1, NULL, 0);
    instance_define(instance, RECORDER, 100, handle, 3);
}

static bool start(struct clients *clients, int life, size_t frames)
{
    const struct instance_options options = {
        .prefix = "", .server_id = 500 + life, .frames = frames};
    if (!instance_open(&clients->instance[life], clients->tape, &options))
        return false;
    for (int client = 0; client < CLIENTS; client++)
        clients->log_client[client].instance = &clients->instance[life];
    return true;
}

static void stop(struct clients *clients, int life)
{
    instance_beat(&clients->instance[life]);
    instance_close(&clients->instance[life]);
}

static void live_first(struct clients *clients)
{
    struct instance *instance = &clients->instance[0];
    query_in_turns(clients, instance);
    query_again(clients, instance, false);
    query_again(clients, instance, true);
    be_turned_away(clients, instance);
    get_lost(clients, instance);
    share_ids(clients);
    define_bodies(clients, instance);
}

/* Handles of the first life are not held; then their bodies come whole. */
static void live_again(struct clients *clients)
{
    for (int client = 0; client < CLIENTS; client++) {
        query_scene(clients, client, 5);
        query_pair(clients, client, 5);
    }
}

/* With capacity for so few bodies that the bodies of clients evict each other. */
static void live_small(struct clients *clients)
{
    for (int step = 0; step < 4; step++)
        for (int client = 0; client < CLIENTS; client++)
            query_pair(clients, client, step);
}

/* Two services on the same channels. The second one starts later, and does not hold what the first
 * one holds: its UNKNOWN_BODY comes after an answer. Then bodies come whole, and both answer. */
static void live_beside_another(struct clients *clients)
{
    struct instance *instance = &clients->instance[LIVES - 1];
    const struct instance_options options = {.prefix = "", .server_id = 600, .frames = 64};
    for (int step = 0; step < 5; step++) {
        if (step == 2 && instance_open(&clients->other, clients->tape, &options))
            instance->other = &clients->other;
        if (step == 3)
            for (int n = 0; n < BODIES; n++)
                log_client_forget(&clients->log_client[0], id_of(0, n));
        query_pair(clients, 0, step % 2);
    }
    if (instance->other)
        instance_close(instance->other);
    instance->other = NULL;
}

static bool live(struct clients *clients)
{
    static const struct {
        size_t frames;
        void (*happens)(struct clients *clients);
    } lives[LIVES] = {
        {256, live_first}, {256, live_again}, {3, live_small}, {64, live_beside_another}};
    for (int life = 0; life < LIVES; life++) {
        tape_reach(clients->tape, life * INT64_C(1000000));
        if (!start(clients, life, lives[life].frames))
            return false;
        lives[life].happens(clients);
        stop(clients, life);
    }
    return true;
}

bool kind_clients(struct tape *tape)
{
    static struct clients clients;
    memset(&clients, 0, sizeof clients);
    clients.tape = tape;
    for (int client = 0; client < CLIENTS; client++)
        clients.log_client[client] =
            (struct log_client){.client_id = 8000 + client, .next_number = 5};
    return live(&clients);
}
