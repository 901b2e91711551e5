/* A seven-joint arm, whose links are hulls, moves among rotated boxes. Each edge changes every
 * joint by 0.5 rad. The least gap of each timed edge is 9 to 11 mm. FCL decides 50 poses of an
 * edge; the computation of these poses is not timed. */
#include "paths.h"

#include "draw.h"
#include "fcl.h"
#include "fmb_robot.h"
#include "stopwatch.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { JOINTS = 7, EDGES = 100, TRIED = 2000, SAMPLES = 50, CROWD = 1000 };

static const double step = 0.5, wanted = 0.01, proven = 0.005;

static void fail(const char *why)
{
    fprintf(stderr, "robot: %s\n", why);
    exit(EXIT_FAILURE);
}

/* ---- The arm ---- */

struct arm {
    struct robot *states; /* the bodies, and the poses of an edge for FCL */
    struct fmb_body box[CROWD];
    struct fmb_placement crowd[CROWD];
    struct fmb_robot *robot;
    struct fmb_robot_scene *scene;
    struct draw draw;
};

/* Reads a URDF file whose links have no bodies, except the base, which is far below. The hulls are
 * bodies of the world that the links carry. */
static struct fmb_robot *read_arm(void)
{
    char path[] = "/tmp/robot-XXXXXX";
    struct fmb_robot *robot;
    FILE *out = fdopen(mkstemp(path), "w");
    if (!out)
        fail("/tmp: no file can be written");
    fputs(
        "<robot name='arm'><link name='base'><collision><origin xyz='0 0 -9'/><geometry>"
        "<sphere radius='0.1'/></geometry></collision></link>",
        out);
    for (int i = 0; i < JOINTS; i++)
        fprintf(out,
                "<link name='l%d'/><joint name='j%d' type='continuous'><origin xyz='0 0 %g'/>"
                "<parent link='%s%.0d'/><child link='l%d'/><axis xyz='%d %d 0'/></joint>",
                i + 1, i, i == 0 ? 0 : robot_link_length, i == 0 ? "base" : "l", i, i + 1, i % 2,
                1 - i % 2);
    fputs("</robot>", out);
    fclose(out);
    const int failed = fmb_robot_read(path, NULL, &robot);
    unlink(path);
    if (failed)
        fail(fmb_robot_why(robot));
    return robot;
}

/* Boxes in a cube of 7 m. They are smaller than the boxes of states.c, so that edges are free. */
static struct fmb_scene draw_crowd(struct arm *arm, int count)
{
    for (int i = 0; i < count; i++) {
        struct fmb_placement *at = &arm->crowd[i];
        double size[3];
        for (int k = 0; k < 3; k++) {
            size[k] = draw_uniform(&arm->draw, 0.05, 0.15);
            at->position[k] = draw_uniform(&arm->draw, -3.5, 3.5);
        }
        for (int k = 0; k < 4; k++)
            at->orientation[k] = draw_uniform(&arm->draw, -1, 1);
        if (fmb_body_make(3, FMB_BOX, size, 3, &arm->box[i]) != FMB_OK)
            fail("a box is refused");
        at->body = &arm->box[i];
        at->orientation_count = 4;
        at->group = 2;
    }
    return (struct fmb_scene){
        .placements = arm->crowd, .placement_count = (size_t) count, .which = FMB_PAIRS_ALL};
}

static struct arm *arm_open(int hulls, int boxes, int crowd)
{
    static const char names[][3] = {"l1", "l2", "l3", "l4", "l5", "l6", "l7"};
    const char *links[ROBOT_BODIES] = {NULL};
    struct arm *arm = calloc(1, sizeof *arm);
    if (!arm)
        fail("out of memory");
    arm->states = malloc(sizeof *arm->states);
    if (!arm->states)
        fail("out of memory");
    robot_draw_arm(hulls, JOINTS, boxes, arm->states);
    arm->robot = read_arm();
    arm->draw = (struct draw){20261};
    for (int i = 0; i < JOINTS; i++)
        links[i] = names[i];
    const struct fmb_scene scene = robot_scene(arm->states, 0), around = draw_crowd(arm, crowd);
    const struct fmb_robot_world world[] = {{.scene = &scene, .links = links}, {.scene = &around}};
    if (fmb_robot_scene(arm->robot, world, 2, NULL, 0, &arm->scene))
        fail(fmb_robot_scene_why(arm->scene));
    return arm;
}

static void arm_close(struct arm *arm)
{
    fmb_robot_scene_free(arm->scene);
    fmb_robot_free(arm->robot);
    free(arm->states);
    free(arm);
}

/* ---- Edges ---- */

struct edge {
    double q[2][JOINTS];
};

static struct edge draw_edge(struct draw *draw)
{
    struct edge edge;
    for (int j = 0; j < JOINTS; j++) {
        edge.q[0][j] = draw_uniform(draw, -2, 2);
        edge.q[1][j] = edge.q[0][j] + (draw_bits(draw) % 2 ? step : -step);
    }
    return edge;
}

static struct fmb_robot_edge prove(struct fmb_robot_path *path, const struct edge *edge)
{
    struct fmb_robot_edge answer;
    if (fmb_robot_path_edge(path, edge->q[0], edge->q[1]))
        fail(fmb_robot_path_why(path));
    while (!fmb_robot_path_step(path, &answer))
        ;
    return answer;
}

static struct fmb_robot_path *path_begin(const struct arm *arm, double clearance)
{
    struct fmb_robot_path *path;
    if (fmb_robot_path_begin(arm->scene, clearance, &path))
        fail(fmb_robot_path_why(path));
    return path;
}

/* Poses for FCL, evenly spaced, both ends included. */
static void sample(const struct arm *arm, const struct edge *edge)
{
    const struct fmb_scene *scene = fmb_robot_scene_get(arm->scene);
    for (int i = 0; i < SAMPLES; i++) {
        double q[JOINTS];
        for (int j = 0; j < JOINTS; j++)
            q[j] = edge->q[0][j] + i / (SAMPLES - 1.0) * (edge->q[1][j] - edge->q[0][j]);
        if (fmb_robot_place(arm->scene, q))
            fail(fmb_robot_scene_why(arm->scene));
        for (int link = 0; link < JOINTS; link++)
            arm->states->placement[i][link] = scene->placements[1 + link]; /* 0: the base */
    }
}

/* Returns the number of poses in which anything collides. */
static int decide_samples(struct fcl_robot *fcl)
{
    int poses = 0;
    for (int i = 0; i < SAMPLES; i++)
        poses += fcl_robot_decide(fcl, i) > 0;
    return poses;
}

/* Random edges: prints how many are in contact, and how many contacts the poses of FCL miss. */
static void find_contacts(const struct arm *arm, struct fcl_robot *fcl)
{
    int count[FMB_ROBOT_UNDECIDED + 1] = {0}, missed = 0, wrong = 0;
    struct draw draw = {20262};
    struct fmb_robot_path *path = path_begin(arm, 0);
    for (int i = 0; i < TRIED; i++) {
        const struct edge edge = draw_edge(&draw);
        const enum fmb_robot_verdict verdict = prove(path, &edge).verdict;
        count[verdict]++;
        sample(arm, &edge);
        const bool found = fcl && decide_samples(fcl) > 0;
        missed += verdict == FMB_ROBOT_CONTACT && !found;
        wrong += verdict == FMB_ROBOT_FREE && found;
    }
    printf("  %d random edges: %d free, %d in contact, %d undecided", TRIED, count[FMB_ROBOT_FREE],
           count[FMB_ROBOT_CONTACT], count[FMB_ROBOT_UNDECIDED]);
    if (fcl)
        printf("; FCL misses %d of the contacts, and finds %d on free edges", missed, wrong);
    putchar('\n');
    fmb_robot_path_free(path);
}

/* ---- Measuring ---- */

enum { PROVEN, FOUND, SAMPLED, WAYS };

static const char *const ways[] = {"proven to 5 mm", "clearance found to a tenth",
                                   "FCL, 50 poses (not proven)"};

/* Out: *median: the median times of an edge, in microseconds. fcl: NULL if it is not measured. */
static void time_edges(struct arm *arm, struct fcl_robot *fcl, double median[WAYS])
{
    static double time[WAYS][EDGES];
    struct fmb_robot_path *path[] = {path_begin(arm, proven), path_begin(arm, 0)};
    for (int found = 0; found < EDGES;) {
        const struct edge edge = draw_edge(&arm->draw);
        const struct fmb_robot_edge answer = prove(path[FOUND], &edge);
        if (answer.verdict != FMB_ROBOT_FREE || fabs(answer.closest - wanted) > 0.1 * wanted)
            continue;
        sample(arm, &edge);
        for (int way = PROVEN; way < (fcl ? WAYS : SAMPLED); way++) {
            const double begin = stopwatch_now();
            if (way != SAMPLED)
                prove(path[way], &edge);
            else if (decide_samples(fcl) > 0)
                fail("FCL finds a contact on a free edge");
            time[way][found] = (stopwatch_now() - begin) * 1e-3;
        }
        found++;
    }
    for (int way = PROVEN; way < WAYS; way++)
        median[way] = spread_of(time[way], EDGES).median;
    fmb_robot_path_free(path[PROVEN]);
    fmb_robot_path_free(path[FOUND]);
}

static void report(int hulls, int boxes, int crowd)
{
    double median[WAYS];
    struct arm *arm = arm_open(hulls, boxes, crowd);
    struct fcl_robot *fcl = crowd ? NULL : fcl_robot_create(arm->states);
    printf("Links of %d vertices, %d boxes:\n", rings_vertices(robot_rings[hulls]), boxes + crowd);
    time_edges(arm, fcl, median);
    for (int way = PROVEN; way < (fcl ? WAYS : SAMPLED); way++)
        printf("  %-28s %8.1f us an edge\n", ways[way], median[way]);
    if (!crowd)
        find_contacts(arm, fcl);
    fcl_robot_destroy(fcl);
    arm_close(arm);
}

void paths_run(void)
{
    printf("Paths: an arm of %d joints, %d edges of %g rad a joint that come within 1 cm\n", JOINTS,
           EDGES, step);
    report(ROBOT_RINGS_SMALL, 20, 0);
    report(ROBOT_RINGS_LINK, 20, 0);
    report(ROBOT_RINGS_SMALL, 0, CROWD);
}
