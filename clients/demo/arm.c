/* Prints scenes for fmb query: a robot arm that swings over a table with parts on it, in six
 * steps of a quarter of a second, one scene and one line each.
 *
 * Within a step a frame does not turn: each link stands as its joints say at the start of the
 * step, and goes straight to where its middle is at the end. The table, and what rests on it, are
 * laid out in multiples of 1/64 m, which doubles hold exactly: so what rests touches, and nothing
 * is a rounding error above or below. */
#include <math.h>
#include <stdio.h>

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

/* Frames as they are printed: metres, seconds. */
struct frame {
    int id;
    const char *shape;
    double origin[3];
    double component[3][3]; /* [component][axis] */
    int moving;
    double velocity[3];
};

/* The parts rest on the table's top at z = 3/4, the lid on the crate at z = 7/8. */
static const struct frame still[] = {
    {TABLE,
     "cuboid",
     {0.3125, -0.625, 0.6875},
     {{0.75, 0, 0}, {0, 1.25, 0}, {0, 0, 0.0625}},
     0,
     {0}},
    {COLUMN, "cuboid", {-0.125, -0.125, 0.5}, {{0.25, 0, 0}, {0, 0.25, 0}, {0, 0, 0.375}}, 0, {0}},
    {CRATE,
     "cuboid",
     {0.625, -0.0625, 0.75},
     {{0.1875, 0, 0}, {0, 0.1875, 0}, {0, 0, 0.125}},
     0,
     {0}},
    {LID,
     "cuboid",
     {0.640625, -0.046875, 0.875},
     {{0.15625, 0, 0}, {0, 0.15625, 0}, {0, 0, 0.03125}},
     0,
     {0}},
    {WEDGE,
     "tetrahedron",
     {0.578125, 0.359375, 0.75},
     {{0.1875, 0.0625, 0}, {-0.03125, 0.1875, 0}, {0, 0, 0.25}},
     0,
     {0}},
    {SPIKE,
     "tetrahedron",
     {0.875, 0.1875, 0.75},
     {{0.125, 0, 0}, {0, 0.125, 0}, {0.03125, 0.03125, 0.25}},
     0,
     {0}},
    {PUCK,
     "cuboid",
     {0.375, -0.5, 0.75},
     {{0.125, 0, 0}, {0, 0.125, 0}, {0, 0, 0.0625}},
     1,
     {0.0625, 0.25, 0}},
};
enum { STILL = sizeof still / sizeof *still };

static const int pairs[][2] = {
    {CRATE, TABLE},   {LID, CRATE},       {WEDGE, TABLE},   {SPIKE, TABLE},   {PUCK, TABLE},
    {PUCK, CRATE},    {UPPER_ARM, TABLE}, {FOREARM, TABLE}, {FOREARM, CRATE}, {FOREARM, LID},
    {FOREARM, SPIKE}, {GRIPPER, TABLE},   {GRIPPER, CRATE}, {GRIPPER, LID},   {GRIPPER, WEDGE},
    {GRIPPER, SPIKE}, {GRIPPER, PUCK},
};
enum { PAIRS = sizeof pairs / sizeof *pairs };

/* ---- The arm --------------------------------------------------------------------------------- */

struct link {
    int id;
    double length, width, height; /* metres */
};

static const struct link links[LINKS] = {
    {UPPER_ARM, 0.50, 0.11, 0.11}, {FOREARM, 0.45, 0.09, 0.08}, {GRIPPER, 0.17, 0.10, 0.05}};

static const double shoulder[3] = {0, 0, 0.93};

/* Degrees: the waist from the x axis; the links above the horizontal. */
struct pose {
    double waist, pitch[LINKS];
};

/* The pose at the start of a step: the arm swings round, and down to the parts. */
static struct pose pose_at(int step)
{
    double along = (double) step / STEPS; /* 0 to 1 */
    double dip = sin(90 * degree * fmin(1, 1.5 * along));
    return (struct pose){.waist = -52 + 98 * along,
                         .pitch = {56 - 8 * dip, -30 - 6 * dip, -78 - 6 * dip}};
}

/* The link's frame, which begins in the middle of a face at *joint; moves *joint to its end. */
static struct frame place_link(const struct link *link, double waist, double pitch, double joint[3])
{
    double a = waist * degree, p = pitch * degree;
    double along[3] = {cos(a) * cos(p), sin(a) * cos(p), sin(p)};
    double side[3] = {-sin(a), cos(a), 0};
    double up[3] = {-cos(a) * sin(p), -sin(a) * sin(p), cos(p)};
    struct frame frame = {.id = link->id, .shape = "cuboid", .moving = 1};
    for (int axis = 0; axis < 3; axis++) {
        frame.origin[axis] =
            joint[axis] - side[axis] * link->width / 2 - up[axis] * link->height / 2;
        frame.component[0][axis] = along[axis] * link->length;
        frame.component[1][axis] = side[axis] * link->width;
        frame.component[2][axis] = up[axis] * link->height;
        joint[axis] += frame.component[0][axis];
    }
    return frame;
}

static void place_arm(const struct pose *pose, struct frame out[LINKS])
{
    double joint[3] = {shoulder[0], shoulder[1], shoulder[2]};
    for (int i = 0; i < LINKS; i++)
        out[i] = place_link(&links[i], pose->waist, pose->pitch[i], joint);
}

static double middle(const struct frame *frame, int axis)
{
    return frame->origin[axis] +
           (frame->component[0][axis] + frame->component[1][axis] + frame->component[2][axis]) / 2;
}

/* The links at the start of the step, with the velocities that take them to the next one. */
static void make_arm(int step, struct frame out[LINKS])
{
    struct frame next[LINKS];
    struct pose here = pose_at(step), there = pose_at(step + 1);
    place_arm(&here, out);
    place_arm(&there, next);
    for (int i = 0; i < LINKS; i++)
        for (int axis = 0; axis < 3; axis++)
            out[i].velocity[axis] = (middle(&next[i], axis) - middle(&out[i], axis)) / step_s;
}

/* What slides has come further, by whole 64ths of a metre. */
static struct frame still_at(int index, int step)
{
    struct frame frame = still[index];
    for (int axis = 0; axis < 3; axis++)
        frame.origin[axis] += step * step_s * frame.velocity[axis];
    return frame;
}

/* ---- JSON ------------------------------------------------------------------------------------ */

static void print_vector(const double v[3])
{
    printf("[%.17g,%.17g,%.17g]", v[0], v[1], v[2]);
}

static void print_frame(const struct frame *frame)
{
    printf("{\"id\": %d, \"shape\": \"%s\", \"origin\": ", frame->id, frame->shape);
    print_vector(frame->origin);
    printf(", \"components\": [");
    for (int i = 0; i < 3; i++) {
        printf("%s", i ? "," : "");
        print_vector(frame->component[i]);
    }
    printf("]");
    if (frame->moving) {
        printf(", \"velocity\": ");
        print_vector(frame->velocity);
    }
    printf("}");
}

static void print_scene(int step)
{
    struct frame arm[LINKS];
    make_arm(step, arm);
    printf("{\"dim\": 3, \"duration\": %.17g, \"bodies\": [", step_s);
    for (int i = 0; i < STILL; i++) {
        struct frame frame = still_at(i, step);
        printf("%s", i ? ", " : "");
        print_frame(&frame);
    }
    for (int i = 0; i < LINKS; i++) {
        printf(", ");
        print_frame(&arm[i]);
    }
    printf("], \"pairs\": [");
    for (int i = 0; i < PAIRS; i++)
        printf("%s[%d,%d]", i ? "," : "", pairs[i][0], pairs[i][1]);
    printf("]}\n");
}

int main(void)
{
    for (int step = 0; step < STEPS; step++)
        print_scene(step);
    return fflush(stdout) == 0 ? 0 : 1;
}
