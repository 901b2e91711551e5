/* A crowd in the plane, of boxes and triangles turned every way, most of them moving: those who
 * walk across those who stand, all of them at once, and neighbours listed. Two answers have no
 * space for all that they find, or are broken off where the service has others waiting: then the
 * query is queried again from where the answer ended. */
#include "kinds.h"

#include "log_client.h"
#include "parts.h"

#include <string.h>

enum { STEPS = 2, STEP_US = 10000, WALKERS = 100, STANDING = 40, BODIES = WALKERS + STANDING };

static const double step_s = 0.01, field = 2, speed = 60; /* metres, and per second: in a hurry */

struct crowd {
    struct log_client log_client;
    struct draw draw;
    struct solid solid[BODIES]; /* who walks first; their ids are one more */
    struct scene_query query;
    struct scene_result result;
};

/* ---- Who is there ---- */

/* A box or half of one, of any proportions, turned. */
static struct solid draw_body(struct draw *draw)
{
    const struct turn turn = turn_by(draw_uniform(draw, -2, 2));
    const double length = draw_uniform(draw, 0.25, 2), width = draw_uniform(draw, 0.25, 1);
    struct solid solid = {.dim = 2, .shape = draw_coin(draw) ? FMB_CUBOID : FMB_TETRAHEDRON};
    for (int axis = 0; axis < 2; axis++)
        solid.origin[axis] = draw_uniform(draw, -field, field);
    solid.component[0][0] = turn.cosine * length;
    solid.component[0][1] = turn.sine * length;
    solid.component[1][0] = -turn.sine * width;
    solid.component[1][1] = turn.cosine * width;
    return solid;
}

static void draw_crowd(struct crowd *crowd)
{
    for (int i = 0; i < BODIES; i++) {
        struct solid *solid = &crowd->solid[i];
        *solid = draw_body(&crowd->draw);
        solid->moving = i < WALKERS;
        for (int axis = 0; axis < 2 && solid->moving; axis++)
            solid->velocity[axis] = draw_uniform(&crowd->draw, -speed, speed);
    }
}

static void walk(struct crowd *crowd)
{
    for (int i = 0; i < WALKERS; i++)
        for (int axis = 0; axis < 2; axis++)
            crowd->solid[i].origin[axis] += step_s * crowd->solid[i].velocity[axis];
}

/* ---- Queries ---- */

/* So many of those who walk, from the first, and of those who stand. */
static void begin_query(struct crowd *crowd, int32_t which, int32_t want, int walkers, int standing)
{
    struct scene_query *query = &crowd->query;
    query->duration = step_s;
    query->which = which;
    query->want = want;
    query->split = which == FMB_PAIRS_ACROSS ? walkers : 0;
    query->first_pair = query->index_count = 0;
    query->placement_count = walkers + standing;
    for (int i = 0; i < walkers; i++)
        part_place(&crowd->solid[i], i + 1, &query->placement[i]);
    for (int i = 0; i < standing; i++)
        part_place(&crowd->solid[WALKERS + i], WALKERS + i + 1, &query->placement[walkers + i]);
}

static int32_t pairs_of(const struct scene_query *query)
{
    const int32_t n = query->placement_count, split = query->split;
    switch (query->which) {
    case FMB_PAIRS_ALL: return n * (n - 1) / 2;
    case FMB_PAIRS_ACROSS: return split * (n - split);
    default: return query->index_count / 2;
    }
}

/* Until all pairs have been answered. */
static void query_to_the_end(struct crowd *crowd)
{
    const int32_t end = pairs_of(&crowd->query);
    do {
        log_client_scene(&crowd->log_client, &crowd->query, &crowd->result);
        crowd->query.first_pair = crowd->result.end_pair;
    } while (crowd->result.status == FMB_OK && crowd->result.end_pair < end);
}

/* Who stands next to each other in the list, at distances of one to three. */
static void list_neighbours(struct crowd *crowd)
{
    struct scene_query *query = &crowd->query;
    const int32_t n = query->placement_count;
    int32_t count = 0;
    for (int32_t i = 0; i < n; i++)
        for (int32_t step = 1; step <= 3; step++) {
            query->pair[count][0] = (unsigned) i;
            query->pair[count++][1] = (unsigned) ((i + step) % n);
        }
    query->index_count = 2 * count;
}

/* The service has answered a part of the scene, and other clients wait: it stops there. */
static void query_and_be_interrupted(struct crowd *crowd)
{
    begin_query(crowd, FMB_PAIRS_ACROSS, 0, WALKERS, STANDING);
    crowd->log_client.instance->stop_after = 1;
    log_client_scene(&crowd->log_client, &crowd->query, &crowd->result);
    crowd->log_client.instance->stop_after = 0;
    crowd->query.first_pair = crowd->result.end_pair;
    query_to_the_end(crowd);
}

static void query_step(struct crowd *crowd, int step)
{
    begin_query(crowd, FMB_PAIRS_ACROSS, FMB_WANT_TIMES, 30, 20 + step);
    crowd->query.margin = 0.25;
    query_to_the_end(crowd);
    crowd->query.margin = 0;
    begin_query(crowd, FMB_PAIRS_LISTED, FMB_WANT_BOX | FMB_WANT_TIMES, 25, 5);
    list_neighbours(crowd);
    query_to_the_end(crowd);
}

static void query_all(struct crowd *crowd, struct tape *tape)
{
    begin_query(crowd, FMB_PAIRS_ACROSS, 0, WALKERS, STANDING);
    query_to_the_end(crowd); /* defines every body */
    begin_query(crowd, FMB_PAIRS_ALL, FMB_WANT_BOX | FMB_WANT_TIMES, WALKERS, STANDING);
    query_to_the_end(crowd);
    for (int step = 0; step < STEPS; step++) {
        tape_reach(tape, (int64_t) (step + 1) * STEP_US);
        walk(crowd);
        query_step(crowd, step);
    }
    query_and_be_interrupted(crowd);
}

bool kind_crowd(struct tape *tape)
{
    const struct instance_options options = {.prefix = "", .server_id = 77, .frames = 512};
    static struct crowd crowd;
    struct instance instance;
    if (!instance_open(&instance, tape, &options))
        return false;
    crowd.log_client = (struct log_client){.instance = &instance, .client_id = 0, .next_number = 1};
    crowd.draw.state = 160;
    draw_crowd(&crowd);
    query_all(&crowd, tape);
    instance_beat(&instance);
    instance_close(&instance);
    return true;
}
