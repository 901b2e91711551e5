/* A robot arm that swings past a table with parts on it, at 100 Hz: in each step one scene with
 * times and boxes, and some single pairs, some of them with certificates. Links move; the table,
 * and what rests on it, is laid out in multiples of 1/64 m, so that what rests touches. */
#include "kinds.h"

#include "log_client.h"
#include "parts.h"

#include <string.h>

enum { STEPS = 24, STEP_US = 10000, LINKS = 3, STILL = 7, PARTS = STILL + LINKS };

static const double step_s = 0.01;

/* Bodies by number; their ids are one more. */
enum part { TABLE, COLUMN, CRATE, LID, WEDGE, SPIKE, PUCK, UPPER_ARM, FOREARM, GRIPPER };

static const unsigned pairs[][2] = {
    {CRATE, TABLE},   {LID, CRATE},       {WEDGE, TABLE},   {SPIKE, TABLE},   {PUCK, TABLE},
    {PUCK, CRATE},    {UPPER_ARM, TABLE}, {FOREARM, TABLE}, {FOREARM, CRATE}, {FOREARM, LID},
    {FOREARM, SPIKE}, {GRIPPER, TABLE},   {GRIPPER, CRATE}, {GRIPPER, LID},   {GRIPPER, WEDGE},
    {GRIPPER, SPIKE}, {GRIPPER, PUCK},
};
enum { PAIRS = sizeof pairs / sizeof *pairs };

/* Queried singly: as many in each step, in turns. */
enum { FIRST_SINGLE = 7, SINGLE = PAIRS - FIRST_SINGLE, SINGLE_A_STEP = 2 };

/* ---- The parts ---- */

/* The parts rest on the table's top at z = 3/4, the lid on the crate at z = 7/8. */
static void set_still(struct solid out[STILL])
{
    out[TABLE] = part_box(3, (double[]){0.3125, -0.625, 0.6875}, (double[]){0.75, 1.25, 0.0625});
    out[COLUMN] = part_box(3, (double[]){-0.125, -0.125, 0.5}, (double[]){0.25, 0.25, 0.375});
    out[CRATE] = part_box(3, (double[]){0.625, -0.0625, 0.75}, (double[]){0.1875, 0.1875, 0.125});
    out[LID] =
        part_box(3, (double[]){0.640625, -0.046875, 0.875}, (double[]){0.15625, 0.15625, 0.03125});
    out[WEDGE] =
        part_corner(3, (double[]){0.578125, 0.359375, 0.75}, (double[]){0.1875, 0.1875, 0.25});
    out[WEDGE].component[0][1] = 0.0625;
    out[WEDGE].component[1][0] = -0.03125;
    out[SPIKE] = part_corner(3, (double[]){0.875, 0.1875, 0.75}, (double[]){0.125, 0.125, 0.25});
    out[SPIKE].component[2][0] = out[SPIKE].component[2][1] = 0.03125;
    out[PUCK] = part_box(3, (double[]){0.375, -0.5, 0.75}, (double[]){0.125, 0.125, 0.0625});
    out[PUCK].moving = true;
    out[PUCK].velocity[0] = 0.0625;
    out[PUCK].velocity[1] = 1.5;
}

/* ---- The arm ---- */

struct pose {
    struct turn waist, pitch[LINKS]; /* from the x axis; from the horizontal */
};

static const double length[LINKS] = {0.5, 0.4375, 0.1875}, width[LINKS] = {0.11, 0.09, 0.1},
                    height[LINKS] = {0.11, 0.08, 0.05};

/* It comes from the side of the puck. */
static struct pose first_pose(void)
{
    return (struct pose){turn_by(-0.25), {turn_by(0.40625), turn_by(-0.28125), turn_by(-0.75)}};
}

/* It swings round, and down to the parts. */
static struct pose next_pose(const struct pose *pose)
{
    struct pose next = {.waist = turn_and(pose->waist, turn_by(0x1p-6))};
    for (int i = 0; i < LINKS; i++)
        next.pitch[i] = turn_and(pose->pitch[i], turn_by(-0x1p-9));
    return next;
}

/* The link begins in the middle of a face at *joint; moves *joint to its end. */
static struct solid place_link(int link, struct turn waist, struct turn pitch, double joint[3])
{
    const double along[3] = {waist.cosine * pitch.cosine, waist.sine * pitch.cosine, pitch.sine};
    const double side[3] = {-waist.sine, waist.cosine, 0};
    const double up[3] = {-waist.cosine * pitch.sine, -waist.sine * pitch.sine, pitch.cosine};
    struct solid solid = {.dim = 3, .shape = FMB_CUBOID, .moving = true};
    for (int axis = 0; axis < 3; axis++) {
        solid.origin[axis] =
            joint[axis] - side[axis] * width[link] / 2 - up[axis] * height[link] / 2;
        solid.component[0][axis] = along[axis] * length[link];
        solid.component[1][axis] = side[axis] * width[link];
        solid.component[2][axis] = up[axis] * height[link];
        joint[axis] += solid.component[0][axis];
    }
    return solid;
}

static void place_arm(const struct pose *pose, struct solid out[LINKS])
{
    double joint[3] = {0, 0, 0.9375};
    for (int i = 0; i < LINKS; i++)
        out[i] = place_link(i, pose->waist, pose->pitch[i], joint);
}

/* The links as they are, with the velocities that take their middles to where they will be. */
static void set_arm(const struct pose *pose, struct solid out[LINKS])
{
    const struct pose next = next_pose(pose);
    struct solid then[LINKS];
    place_arm(pose, out);
    place_arm(&next, then);
    for (int i = 0; i < LINKS; i++) {
        double from[3], to[3];
        part_middle(&out[i], from);
        part_middle(&then[i], to);
        for (int axis = 0; axis < 3; axis++)
            out[i].velocity[axis] = (to[axis] - from[axis]) / step_s;
    }
}

/* ---- Queries ---- */

static void query_scene(struct log_client *log_client, const struct solid *solid)
{
    static struct scene_query query;
    static struct scene_result result;
    query.duration = step_s;
    query.want = FMB_WANT_BOX | FMB_WANT_TIMES;
    query.which = FMB_PAIRS_LISTED;
    query.placement_count = PARTS;
    query.index_count = 2 * PAIRS;
    memcpy(query.pair, pairs, sizeof pairs);
    for (int part = 0; part < PARTS; part++) {
        part_place(&solid[part], part + 1, &query.placement[part]);
        if (part >= STILL) /* it has turned: its frame is another */
            log_client_forget(log_client, part + 1);
    }
    log_client_scene(log_client, &query, &result);
}

/* The handles of the links are known by now, from the scene. */
static void query_pair(struct log_client *log_client, const struct solid *solid, int n)
{
    const unsigned *pair = pairs[FIRST_SINGLE + n % SINGLE];
    struct pair_result result;
    struct pair_query query = {.duration = step_s, .want = FMB_WANT_BOX};
    if (n % 4 == 0)
        query.want |= FMB_WANT_CERTIFICATE;
    for (int f = 0; f < 2; f++)
        part_place(&solid[pair[f]], pair[f] + 1, &query.placement[f]);
    log_client_pair(log_client, &query, &result);
}

static void swing(struct instance *instance, struct tape *tape)
{
    static struct log_client log_client;
    struct solid solid[PARTS];
    struct pose pose = first_pose();
    log_client = (struct log_client){.instance = instance, .client_id = 3141592653589793};
    set_still(solid);
    for (int step = 0; step < STEPS; step++) {
        tape_reach(tape, (int64_t) step * STEP_US);
        set_arm(&pose, &solid[STILL]);
        query_scene(&log_client, solid);
        for (int i = 0; i < SINGLE_A_STEP; i++)
            query_pair(&log_client, solid, SINGLE_A_STEP * step + i);
        pose = next_pose(&pose);
        for (int axis = 0; axis < 3; axis++)
            solid[PUCK].origin[axis] += step_s * solid[PUCK].velocity[axis];
    }
}

bool kind_arm(struct tape *tape)
{
    const struct instance_options options = {.prefix = "", .server_id = 1001, .frames = 64};
    struct instance instance;
    if (!instance_open(&instance, tape, &options))
        return false;
    instance_beat(&instance);
    swing(&instance, tape);
    tape_reach(tape, 1000000);
    instance_beat(&instance);
    instance_close(&instance);
    return true;
}
