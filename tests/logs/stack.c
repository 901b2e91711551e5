/* Three towers that fall onto a plate, level by level, at 100 Hz, and come to rest: all pairs of
 * all bodies in each step, by handle, some with a margin, and of some that lie on each other a
 * certificate and a gap. One tower
 * is laid out in multiples of 1/64, so that it touches face on face. One is of tenths, and in turns
 * its levels touch but for rounding, are an ulp apart, or overlap by an ulp. One leans. */
#include "kinds.h"

#include "log_client.h"
#include "parts.h"

#include <math.h>
#include <string.h>

enum { STEPS = 24, STEP_US = 10000, TOWERS = 3, LEVELS = 5, BODIES = 1 + TOWERS * LEVELS };

/* Bodies by number; their ids are one more. */
enum tower { SQUARE, DECIMAL, LEANING };

static const double step_s = 0.01, gravity = 9.8125;

struct stack {
    struct solid rest[BODIES]; /* [0]: the plate; towers one after the other, from below */
};

static int body_of(int tower, int level)
{
    return 1 + tower * LEVELS + level;
}

/* ---- Where they come to rest ---- */

static struct solid square_level(int level)
{
    const double inset = level / 64.0;
    return part_box(3, (double[]){inset, inset, level * 0.125},
                    (double[]){0.5 - inset, 0.5 - inset / 2, 0.125});
}

/* On the level below, whose top is as sums round. */
static struct solid decimal_level(int level, const struct solid *below)
{
    const double height = 0.1 * (level % 3 + 1);
    double z = level == 0 ? 0 : below->origin[2] + below->component[2][2];
    if (level % 3 == 1)
        z = nextafter(z, HUGE_VAL);
    if (level % 3 == 2)
        z = nextafter(z, -HUGE_VAL);
    return part_box(3, (double[]){1 + 0.1 * level, 0.3, z},
                    (double[]){0.7, 0.7 - 0.1 * level, height});
}

/* Turned about two axes; the next level begins where this one's third component ends. */
static struct solid leaning_level(int level, const struct solid *below)
{
    const struct turn a = turn_by(0.125), b = turn_by(-0.0625);
    const double edge[3][3] = {{a.cosine, 0, -a.sine},
                               {a.sine * b.sine, b.cosine, a.cosine * b.sine},
                               {a.sine * b.cosine, -b.sine, a.cosine * b.cosine}};
    const double length[3] = {0.6, 0.5, 0.2};
    struct solid solid = part_box(3, (double[]){2.5, 0.1, 0}, length);
    for (int i = 0; i < 3; i++)
        for (int axis = 0; axis < 3; axis++)
            solid.component[i][axis] = length[i] * edge[i][axis];
    for (int axis = 0; axis < 3 && level > 0; axis++)
        solid.origin[axis] = below->origin[axis] + below->component[2][axis];
    return solid;
}

/* The highest one of each tower is a tetrahedron. */
static void set_rest(struct stack *stack)
{
    stack->rest[0] = part_box(3, (double[]){-1, -1, -0.25}, (double[]){5, 3, 0.25});
    for (int level = 0; level < LEVELS; level++) {
        struct solid *below = &stack->rest[body_of(0, level - (level > 0))];
        stack->rest[body_of(SQUARE, level)] = square_level(level);
        stack->rest[body_of(DECIMAL, level)] = decimal_level(level, below + DECIMAL * LEVELS);
        stack->rest[body_of(LEANING, level)] = leaning_level(level, below + LEANING * LEVELS);
    }
    for (int tower = 0; tower < TOWERS; tower++)
        stack->rest[body_of(tower, LEVELS - 1)].shape = FMB_TETRAHEDRON;
}

/* ---- How they fall ---- */

/* How high above its place a body still is; those of a tower land one after the other. */
static double height_at(int tower, int level, int step)
{
    const double seconds = step * step_s;
    const double height = 0x1p-6 * (level + 1) * (tower + 2) - gravity / 2 * seconds * seconds;
    return height > 0 ? height : 0;
}

/* In a step it goes straight to where it will be; what has landed moves no more, or by nothing. */
static struct solid level_at(const struct stack *stack, int tower, int level, int step)
{
    const double now = height_at(tower, level, step), then = height_at(tower, level, step + 1);
    struct solid solid = stack->rest[body_of(tower, level)];
    if (now > 0)
        solid.origin[2] += now;
    solid.moving = now > 0 || tower == DECIMAL;
    if (now > 0)
        solid.velocity[2] = (then - now) / step_s;
    return solid;
}

static void set_placements(const struct stack *stack, int step, struct scene_query *query)
{
    query->placement_count = BODIES;
    part_place(&stack->rest[0], 1, &query->placement[0]);
    for (int tower = 0; tower < TOWERS; tower++)
        for (int level = 0; level < LEVELS; level++) {
            const struct solid solid = level_at(stack, tower, level, step);
            const int body = body_of(tower, level);
            part_place(&solid, body + 1, &query->placement[body]);
        }
}

/* ---- Queries ---- */

static void query_scene(struct log_client *log_client, const struct stack *stack, int step)
{
    static const int32_t wants[] = {0, FMB_WANT_TIMES, FMB_WANT_BOX,
                                    FMB_WANT_TIMES | FMB_WANT_BOX | FMB_WANT_GAP};
    static struct scene_query query;
    static struct scene_result result;
    query.duration = step_s;
    query.want = wants[step % 4];
    query.which = FMB_PAIRS_ALL;
    query.margin = step % 2 ? 0 : step % 8 ? 1e-9 : 0.03125;
    set_placements(stack, step, &query);
    log_client_scene(log_client, &query, &result);
}

/* A level of a tower on that below. */
static void query_pair(struct log_client *log_client, const struct stack *stack, int tower,
                       int step)
{
    const int level = 1 + step % (LEVELS - 1);
    struct pair_query query = {.duration = step_s, .want = FMB_WANT_BOX | FMB_WANT_CERTIFICATE};
    struct pair_result result;
    if (step % 2)
        query.want |= FMB_WANT_GAP;
    for (int f = 0; f < 2; f++) {
        const struct solid solid = level_at(stack, tower, level - f, step);
        part_place(&solid, body_of(tower, level - f) + 1, &query.placement[f]);
    }
    log_client_pair(log_client, &query, &result);
}

bool kind_stack(struct tape *tape)
{
    const struct instance_options options = {
        .prefix = "", .server_id = 9007199254740991, .frames = 64};
    static struct log_client log_client;
    struct instance instance;
    struct stack stack;
    if (!instance_open(&instance, tape, &options))
        return false;
    log_client = (struct log_client){.instance = &instance, .client_id = 42};
    set_rest(&stack);
    for (int step = 0; step < STEPS; step++) {
        tape_reach(tape, (int64_t) step * STEP_US);
        query_scene(&log_client, &stack, step);
        query_pair(&log_client, &stack, step % TOWERS, step);
    }
    instance_beat(&instance);
    instance_close(&instance);
    return true;
}
