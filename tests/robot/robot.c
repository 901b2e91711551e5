/* States of a robot a second: in process, as bodies, where all are placed anew or only the links,
 * and as single frames; and in FCL. Then edges of paths. */
#include "fcl.h"
#include "paths.h"
#include "stopwatch.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 25, FRAMES = ROBOT_LINKS * ROBOT_FRAMES + ROBOT_OBSTACLES };

static void *or_end(void *memory)
{
    if (memory)
        return memory;
    fputs("robot: out of memory\n", stderr);
    exit(EXIT_FAILURE);
}

/* ---- Ways ---- */

/* A way to decide a state: returns how many pairs meet. */
struct way {
    const char *name;
    int (*decide)(void *context, int state);
    void *context;
};

struct in_process {
    const struct robot *robot;
    struct fmb_scene_limits limits;
    void *memory;
};

static int count_contacts(enum fmb_status begun, struct fmb_scene_state *state)
{
    struct fmb_scene_answers answers;
    int contacts = 0;
    for (bool done = begun != FMB_OK; !done; contacts += (int) answers.count)
        done = fmb_scene_step(state, &answers);
    return contacts;
}

static int decide_scene(const struct fmb_scene *scene, const struct in_process *in)
{
    struct fmb_scene_state *state;
    const enum fmb_status begun = fmb_scene_begin(scene, &in->limits, in->memory, &state);
    return count_contacts(begun, state);
}

static int decide_bodies(void *context, int state)
{
    const struct in_process *in = context;
    const struct fmb_scene scene = robot_scene(in->robot, state);
    return decide_scene(&scene, in);
}

/* A scene that is begun once. */
struct standing {
    struct in_process in;
    struct fmb_placement placement[ROBOT_BODIES];
    struct fmb_scene_state *state; /* NULL: not begun */
};

static int decide_again(void *context, int state)
{
    struct standing *standing = context;
    const struct robot *robot = standing->in.robot;
    const size_t links = (size_t) robot->links;
    const size_t count = standing->state ? links : links + ROBOT_OBSTACLES;
    memcpy(standing->placement, robot->placement[state], count * sizeof *standing->placement);
    if (standing->state)
        return count_contacts(fmb_scene_again(standing->state, links), standing->state);
    struct fmb_scene scene = robot_scene(robot, state);
    scene.placements = standing->placement;
    const enum fmb_status begun =
        fmb_scene_begin(&scene, &standing->in.limits, standing->in.memory, &standing->state);
    return count_contacts(begun, standing->state);
}

static int decide_fcl(void *context, int state)
{
    return fcl_robot_decide(context, state);
}

/* ---- Single frames ---- */

/* The same scenes with each frame turned into a body of its own: corners rounded by the user. */
struct corners {
    struct in_process in;
    struct fmb_body (*body)[FRAMES]; /* [state], made anew each time */
    unsigned (*ignored)[2];
    size_t ignored_count;
};

static void turn(const double q[4], const double v[3], double out[3])
{
    const double w = q[0], x = q[1], y = q[2], z = q[3], n = w * w + x * x + y * y + z * z;
    out[0] = ((w * w + x * x - y * y - z * z) * v[0] + 2 * (x * y - w * z) * v[1] +
              2 * (x * z + w * y) * v[2]) /
             n;
    out[1] = (2 * (x * y + w * z) * v[0] + (w * w - x * x + y * y - z * z) * v[1] +
              2 * (y * z - w * x) * v[2]) /
             n;
    out[2] = (2 * (x * z - w * y) * v[0] + 2 * (y * z + w * x) * v[1] +
              (w * w - x * x - y * y + z * z) * v[2]) /
             n;
}

/* Frame number k of the robot, and its body. */
static const struct fmb_frame *frame_at(const struct robot *robot, int k, int *body)
{
    const int links = ROBOT_LINKS * ROBOT_FRAMES;
    *body = k < links ? k / ROBOT_FRAMES : ROBOT_LINKS + k - links;
    return fmb_body_frame(&robot->body[*body], (unsigned) (k < links ? k % ROBOT_FRAMES : 0));
}

static void make_corners(const struct robot *robot, int state, int k, struct fmb_body *body,
                         struct fmb_placement *out)
{
    int of;
    double numbers[9];
    const struct fmb_frame *frame = frame_at(robot, k, &of);
    const struct fmb_placement *at = &robot->placement[state][of];
    for (int i = 0; i < 3; i++)
        turn(at->orientation, frame->component[i], numbers + 3 * i);
    const int shape = frame->shape == FMB_TETRAHEDRON ? FMB_TETRAHEDRON : FMB_CUBOID;
    fmb_body_make(3, shape, numbers, 9, body);
    *out = (struct fmb_placement){.body = body, .group = at->group};
    turn(at->orientation, frame->origin, out->position);
    for (int axis = 0; axis < 3; axis++)
        out->position[axis] += at->position[axis];
}

/* Pairs of frames of one link, and of neighbours. */
static void ignore_frames(struct corners *out)
{
    const unsigned links = ROBOT_LINKS * ROBOT_FRAMES;
    out->ignored = or_end(calloc((size_t) links * 2 * ROBOT_FRAMES, sizeof *out->ignored));
    for (unsigned a = 0; a < links; a++)
        for (unsigned b = a + 1; b < links && b / ROBOT_FRAMES <= a / ROBOT_FRAMES + 1; b++) {
            out->ignored[out->ignored_count][0] = a;
            out->ignored[out->ignored_count++][1] = b;
        }
}

static int decide_corners(void *context, int state)
{
    struct corners *corners = context;
    static struct fmb_placement placement[FRAMES];
    for (int k = 0; k < FRAMES; k++)
        make_corners(corners->in.robot, state, k, &corners->body[0][k], &placement[k]);
    const struct fmb_scene scene = {.placements = placement,
                                    .placement_count = FRAMES,
                                    .which = FMB_PAIRS_ALL,
                                    .ignored = (const unsigned(*)[2]) corners->ignored,
                                    .ignored_count = corners->ignored_count};
    return decide_scene(&scene, &corners->in);
}

/* ---- Measuring ---- */

/* CPU time of a state, in microseconds: the median of rounds. */
static double measure(const struct way *way, int *contacts)
{
    double time[ROUNDS];
    for (int round = -1; round < ROUNDS; round++) { /* the first is not counted */
        const double begin = stopwatch_now();
        *contacts = 0;
        for (int state = 0; state < ROBOT_STATES; state++)
            *contacts += way->decide(way->context, state);
        if (round >= 0)
            time[round] = (stopwatch_now() - begin) / ROBOT_STATES * 1e-3;
    }
    return spread_of(time, ROUNDS).median;
}

static void report(const struct way *way)
{
    int contacts;
    const double time = measure(way, &contacts);
    printf("%-44s %8.1f us a state %9.0f states/s %8.2f contacts a state\n", way->name, time,
           1e6 / time, (double) contacts / ROBOT_STATES);
}

static void report_bodies(struct in_process *in)
{
    static struct standing standing;
    standing = (struct standing){.in = *in};
    report(&(struct way){"bodies with poses", decide_bodies, in});
    report(&(struct way){"bodies with poses, only the links moved", decide_again, &standing});
}

static void report_fcl(const struct robot *robot)
{
    struct fcl_robot *fcl = fcl_robot_create(robot);
    if (fcl)
        report(&(struct way){"FCL, dynamic AABB trees", decide_fcl, fcl});
    else
        puts("FCL: not installed (make deps-bench)");
    fcl_robot_destroy(fcl);
}

static void run_states(void)
{
    struct robot *robot = or_end(malloc(sizeof *robot));
    robot_draw(robot);
    const struct fmb_scene scene = robot_scene(robot, 0);
    struct in_process bodies = {.robot = robot};
    fmb_scene_limits_of(&scene, &bodies.limits);
    bodies.memory = or_end(malloc(fmb_scene_bytes(&bodies.limits)));
    struct corners corners = {.in = {robot, {FRAMES, FRAMES, 0, FRAMES}, NULL}};
    ignore_frames(&corners);
    corners.in.limits.ignored = corners.ignored_count;
    corners.in.memory = or_end(malloc(fmb_scene_bytes(&corners.in.limits)));
    corners.body = or_end(calloc(1, sizeof *corners.body));
    report_bodies(&bodies);
    report(&(struct way){"every frame a body, corners by the user", decide_corners, &corners});
    report_fcl(robot);

    robot_draw_hulls(robot); /* fewer bodies than before: the memory suffices */
    printf("Hulls: %d links of %d vertices, %d obstacles of %d\n", robot->links,
           rings_vertices(robot_rings[ROBOT_RINGS_LINK]), robot->obstacles,
           rings_vertices(robot_rings[ROBOT_RINGS_OBSTACLE]));
    report_bodies(&bodies);
    report_fcl(robot);
    free(corners.body);
    free(corners.in.memory);
    free(corners.ignored);
    free(bodies.memory);
    free(robot);
}

/* robot [states | paths] */
int main(int argc, char **argv)
{
    const char *section = argc > 1 ? argv[1] : "";
    stopwatch_pin();
    if (strcmp(section, "paths") != 0)
        run_states();
    if (strcmp(section, "states") != 0)
        paths_run();
    return EXIT_SUCCESS;
}
