/* Prints scenes for fmb query: a robot arm that swings over a table with parts on it, in six
 * steps of a quarter of a second, one scene and one line each.
 *
 * Within a step a body does not turn: a link keeps its orientation at the start of the step, and
 * its middle moves straight to its position at the end. The table and the parts on it have
 * positions and sizes in multiples of 1/64 m, which doubles hold exactly, so that they touch.
 * Neighbouring links always meet at their joint: these pairs are ignored. */
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { STEPS = 6, LINKS = 3 };

static const double step_s = 0.25;
static const double degree = 3.14159265358979323846 / 180;

enum id {
    TABLE = 1,
    COLUMN = 2, /* of the arm */
    UPPER_ARM = 11,
    FOREARM = 12,
    GRIPPER = 13,
    CRATE = 21,
    LID = 22,   /* on the crate */
    WEDGE = 23, /* a tetrahedron */
    SPIKE = 24, /* a tetrahedron */
    PUCK = 25,  /* slides over the table */
};

/* A body as it is printed: metres, seconds. */
struct body {
    int id;
    const char *name;
    double size[3]; /* of a box; 0: the components of a tetrahedron */
    double position[3];
    double component[3][3]; /* [component][axis] */
    double orientation[4];  /* w, x, y, z; all 0: none */
    double velocity[3];
};

/* The parts rest on the table's top at z = 3/4, the lid on the crate at z = 7/8. */
static const struct body still[] = {
    {TABLE, "table", {0.75, 1.25, 0.0625}, {0.6875, 0, 0.71875}, {{0}}, {0}, {0}},
    {COLUMN, "column", {0.25, 0.25, 0.375}, {0, 0, 0.6875}, {{0}}, {0}, {0}},
    {CRATE, "crate", {0.1875, 0.1875, 0.125}, {0.71875, 0.03125, 0.8125}, {{0}}, {0}, {0}},
    {LID, "lid", {0.15625, 0.15625, 0.03125}, {0.71875, 0.03125, 0.890625}, {{0}}, {0}, {0}},
    {WEDGE,
     "wedge",
     {0},
     {0.578125, 0.359375, 0.75},
     {{0.1875, 0.0625, 0}, {-0.03125, 0.1875, 0}, {0, 0, 0.25}},
     {0},
     {0}},
    {SPIKE,
     "spike",
     {0},
     {0.875, 0.1875, 0.75},
     {{0.125, 0, 0}, {0, 0.125, 0}, {0.03125, 0.03125, 0.25}},
     {0},
     {0}},
    {PUCK,
     "puck",
     {0.125, 0.125, 0.0625},
     {0.4375, -0.4375, 0.78125},
     {{0}},
     {0},
     {0.0625, 0.25, 0}},
};
enum { STILL = sizeof still / sizeof *still };

static const int ignored[][2] = {{COLUMN, UPPER_ARM}, {UPPER_ARM, FOREARM}, {FOREARM, GRIPPER}};
enum { IGNORED = sizeof ignored / sizeof *ignored };

/* ---- The arm --------------------------------------------------------------------------------- */

static const struct link {
    int id;
    const char *name;
    double size[3]; /* length, width, height; metres */
} links[LINKS] = {{UPPER_ARM, "upper arm", {0.50, 0.11, 0.11}},
                  {FOREARM, "forearm", {0.45, 0.09, 0.08}},
                  {GRIPPER, "gripper", {0.17, 0.10, 0.05}}};

static const double shoulder[3] = {0, 0, 0.93};

/* Angles in degrees: the waist from the x axis; the links above the horizontal. */
struct pose {
    double waist, pitch[LINKS];
};

/* Returns the pose at the start of a step: the arm swings round, and down to the parts. */
static struct pose pose_at(int step)
{
    double progress = (double) step / STEPS; /* 0 to 1 */
    double dip = sin(90 * degree * fmin(1, 1.5 * progress));
    return (struct pose){.waist = -52 + 98 * progress,
                         .pitch = {56 - 8 * dip, -30 - 6 * dip, -78 - 6 * dip}};
}

/* Returns a link that begins at joint, turned by the pitch about y, then by the waist about z.
 * Moves joint to its end. */
static struct body place_link(const struct link *link, double waist, double pitch, double joint[3])
{
    const double a = waist * degree, p = pitch * degree;
    const double direction[3] = {cos(a) * cos(p), sin(a) * cos(p), sin(p)};
    struct body body = {.id = link->id, .name = link->name};
    memcpy(body.size, link->size, sizeof body.size);
    for (int axis = 0; axis < 3; axis++) {
        body.position[axis] = joint[axis] + direction[axis] * link->size[0] / 2;
        joint[axis] += direction[axis] * link->size[0];
    }
    body.orientation[0] = cos(a / 2) * cos(p / 2);
    body.orientation[1] = sin(a / 2) * sin(p / 2);
    body.orientation[2] = -cos(a / 2) * sin(p / 2);
    body.orientation[3] = sin(a / 2) * cos(p / 2);
    return body;
}

static void place_arm(const struct pose *pose, struct body out[LINKS])
{
    double joint[3] = {shoulder[0], shoulder[1], shoulder[2]};
    for (int i = 0; i < LINKS; i++)
        out[i] = place_link(&links[i], pose->waist, pose->pitch[i], joint);
}

/* Returns the links at the start of a step, with the velocities that take them to the next one. */
static void make_arm(int step, struct body out[LINKS])
{
    struct body next[LINKS];
    struct pose here = pose_at(step), there = pose_at(step + 1);
    place_arm(&here, out);
    place_arm(&there, next);
    for (int i = 0; i < LINKS; i++)
        for (int axis = 0; axis < 3; axis++)
            out[i].velocity[axis] = (next[i].position[axis] - out[i].position[axis]) / step_s;
}

/* A part at the start of a step. One that slides has moved by a whole number of 64ths of a metre.
 */
static struct body still_at(int index, int step)
{
    struct body body = still[index];
    for (int axis = 0; axis < 3; axis++)
        body.position[axis] += step * step_s * body.velocity[axis];
    return body;
}

/* ---- JSON ------------------------------------------------------------------------------------ */

static void print_vector(const char *key, const double *v, int count)
{
    printf("%s[", key);
    for (int i = 0; i < count; i++)
        printf("%s%.17g", i ? "," : "", v[i]);
    printf("]");
}

static void print_body(const struct body *body)
{
    printf("{\"id\": %d, \"name\": \"%s\", ", body->id, body->name);
    if (body->size[0] > 0) {
        print_vector("\"shape\": \"box\", \"size\": ", body->size, 3);
    } else {
        printf("\"shape\": \"tetrahedron\", \"components\": [");
        for (int i = 0; i < 3; i++)
            print_vector(i ? "," : "", body->component[i], 3);
        printf("]");
    }
    print_vector(", \"position\": ", body->position, 3);
    if (body->orientation[0] != 0)
        print_vector(", \"orientation\": ", body->orientation, 4);
    print_vector(", \"velocity\": ", body->velocity, 3);
    printf("}");
}

static void print_scene(int step)
{
    struct body body[STILL + LINKS];
    for (int i = 0; i < STILL; i++)
        body[i] = still_at(i, step);
    make_arm(step, body + STILL);
    printf("{\"dim\": 3, \"duration\": %.17g, \"bodies\": [", step_s);
    for (int i = 0; i < STILL + LINKS; i++) {
        printf("%s", i ? ", " : "");
        print_body(&body[i]);
    }
    printf("], \"ignore\": [");
    for (int i = 0; i < IGNORED; i++)
        printf("%s[%d,%d]", i ? "," : "", ignored[i][0], ignored[i][1]);
    printf("]}\n");
}

int main(void)
{
    for (int step = 0; step < STEPS; step++)
        print_scene(step);
    return fflush(stdout) == 0 ? 0 : 1;
}
