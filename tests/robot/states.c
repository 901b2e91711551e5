#include "states.h"

#include "draw.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Metres. */
const double robot_link_length = 0.25;
static const double width = 0.08, hall = 3.5;

static void or_end(enum fmb_status status)
{
    if (status == FMB_OK)
        return;
    fprintf(stderr, "robot: %s\n", fmb_status_text(status));
    exit(EXIT_FAILURE);
}

/* ---- Bodies ---- */

/* Twelve boxes and four tetrahedra around the axis of the link. */
static void draw_link(struct draw *draw, struct fmb_frame frame[ROBOT_FRAMES])
{
    for (int i = 0; i < ROBOT_FRAMES; i++) {
        const double at = (i + 0.5) / ROBOT_FRAMES * robot_link_length,
                     angle = draw_uniform(draw, 0, 6.28);
        const double x = 0.4 * width * cos(angle), y = 0.4 * width * sin(angle);
        double number[12] = {x, y, at};
        if (i % 4 < 3) {
            for (int axis = 0; axis < 3; axis++)
                number[3 + axis] = draw_uniform(draw, 0.3, 0.7) * width;
            or_end(fmb_frame_make(3, FMB_BOX, number, 6, &frame[i]));
        } else {
            for (int axis = 0; axis < 9; axis++)
                number[3 + axis] = draw_uniform(draw, -0.7, 0.7) * width;
            or_end(fmb_frame_make(3, FMB_TETRAHEDRON, number, 12, &frame[i]));
        }
    }
}

const struct rings robot_rings[ROBOT_RINGS] = {{10, 15}, {10, 10}, {4, 15}};

static void make_hull(struct rings rings, const double axis[3], double middle, double *memory,
                      struct fmb_body *out)
{
    double vertex[ROBOT_HULL_DOUBLES / 4][3];
    const int count = rings_vertices(rings);
    rings_points(rings, axis, vertex);
    for (int v = 0; v < count; v++)
        vertex[v][2] += middle;
    or_end(fmb_body_make_hull(3, vertex[0], 3 * (size_t) count, memory, out));
}

static void draw_box(struct draw *draw, struct fmb_body *out)
{
    double size[3];
    for (int axis = 0; axis < 3; axis++)
        size[axis] = draw_uniform(draw, 0.1, 0.3);
    or_end(fmb_body_make(3, FMB_BOX, size, 3, out));
}

/* Ellipsoids, about the middle of the length. */
static void make_links(int rings, struct robot *out)
{
    const double axis[3] = {0.7 * width, 0.5 * width, 0.5 * robot_link_length};
    for (int i = 0; i < out->links; i++)
        make_hull(robot_rings[rings], axis, 0.5 * robot_link_length, out->hull[i], &out->body[i]);
}

static void draw_hulls(struct draw *draw, struct robot *out)
{
    make_links(ROBOT_RINGS_LINK, out);
    for (int i = out->links; i < out->links + out->obstacles; i++) {
        double axis[3];
        for (int k = 0; k < 3; k++)
            axis[k] = draw_uniform(draw, 0.05, 0.15);
        make_hull(robot_rings[ROBOT_RINGS_OBSTACLE], axis, 0, out->hull[i], &out->body[i]);
    }
}

static void draw_bodies(struct draw *draw, struct robot *out)
{
    for (int i = 0; i < ROBOT_LINKS; i++) {
        draw_link(draw, out->frame[i]);
        or_end(fmb_body_make_frames(out->frame[i], ROBOT_FRAMES, &out->body[i]));
    }
    for (int i = ROBOT_LINKS; i < ROBOT_BODIES; i++)
        draw_box(draw, &out->body[i]);
}

/* ---- Poses ---- */

static void multiply(const double a[4], const double b[4], double out[4])
{
    const double product[4] = {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
                               a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
                               a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
                               a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
    memcpy(out, product, sizeof product);
}

/* Turns about a random axis by at most so much. */
static void draw_turn(struct draw *draw, double most, double out[4])
{
    double axis[3], sum = 0;
    for (int i = 0; i < 3; i++) {
        axis[i] = draw_uniform(draw, -1, 1);
        sum += axis[i] * axis[i];
    }
    const double half = draw_uniform(draw, -most, most) / 2;
    out[0] = cos(half);
    for (int i = 0; i < 3; i++)
        out[1 + i] = sin(half) * axis[i] / sqrt(sum);
}

static void draw_arm(struct draw *draw, int links, struct fmb_placement *placement)
{
    double q[4], p[3] = {0};
    draw_turn(draw, 6.28, q);
    for (int i = 0; i < links; i++) {
        double step[4];
        memcpy(placement[i].orientation, q, sizeof q);
        memcpy(placement[i].position, p, sizeof p);
        placement[i].orientation_count = 4;
        p[0] += robot_link_length * 2 * (q[1] * q[3] + q[0] * q[2]);
        p[1] += robot_link_length * 2 * (q[2] * q[3] - q[0] * q[1]);
        p[2] += robot_link_length * (q[0] * q[0] - q[1] * q[1] - q[2] * q[2] + q[3] * q[3]);
        draw_turn(draw, 1.2, step);
        multiply(q, step, q);
    }
}

static void draw_obstacles(struct draw *draw, const struct robot *robot,
                           struct fmb_placement *placement)
{
    for (int i = robot->links; i < robot->links + robot->obstacles; i++) {
        for (int axis = 0; axis < 3; axis++)
            placement[i].position[axis] = draw_uniform(draw, -hall / 2, hall / 2);
        draw_turn(draw, 6.28, placement[i].orientation);
        placement[i].orientation_count = 4;
        placement[i].group = 1;
    }
}

struct fmb_scene robot_scene(const struct robot *robot, int state)
{
    return (struct fmb_scene){.placements = robot->placement[state],
                              .placement_count = (size_t) (robot->links + robot->obstacles),
                              .which = FMB_PAIRS_ALL,
                              .ignored = (const unsigned(*)[2]) robot->neighbour,
                              .ignored_count = (size_t) robot->links - 1};
}

static size_t contacts_of(const struct robot *robot, int n)
{
    const struct fmb_scene scene = robot_scene(robot, n);
    struct fmb_scene_limits limits;
    fmb_scene_limits_of(&scene, &limits);
    struct fmb_scene_state *state;
    struct fmb_scene_answers answers;
    size_t contacts = 0;
    void *memory = malloc(fmb_scene_bytes(&limits));
    or_end(memory ? fmb_scene_begin(&scene, &limits, memory, &state) : FMB_OVER_LIMIT);
    for (bool done = false; !done; contacts += answers.count)
        done = fmb_scene_step(state, &answers);
    free(memory);
    return contacts;
}

/* The obstacles stand where they are in all states, and do not meet each other. */
static void place_obstacles(struct draw *draw, struct robot *out)
{
    struct fmb_placement *first = out->placement[0];
    draw_obstacles(draw, out, first);
    for (int i = out->links; i < out->links + out->obstacles; i++)
        for (int k = out->links; k < i; k++) {
            struct fmb_answer answer;
            or_end(fmb_decide(fmb_method_default(), &first[i], &first[k], 0, 0, &answer));
            if (answer.verdict == FMB_SEPARATED)
                continue;
            for (int axis = 0; axis < 3; axis++)
                first[i].position[axis] = draw_uniform(draw, -hall / 2, hall / 2);
            k = out->links - 1; /* all again */
        }
    for (int n = 1; n < ROBOT_STATES; n++)
        memcpy(out->placement[n], first, sizeof out->placement[n]);
}

static void begin_states(struct robot *out)
{
    for (int i = 0; i < out->links + out->obstacles; i++)
        out->placement[0][i].body = &out->body[i];
    for (unsigned i = 0; i + 1 < (unsigned) out->links; i++) {
        out->neighbour[i][0] = i;
        out->neighbour[i][1] = i + 1;
    }
}

static void draw_states(struct draw *draw, struct robot *out)
{
    begin_states(out);
    place_obstacles(draw, out);
    for (int n = 0; n < ROBOT_STATES; n++)
        for (size_t contacts = 0; contacts < 1 || contacts > ROBOT_CONTACTS_MAX;
             contacts = contacts_of(out, n))
            draw_arm(draw, out->links, out->placement[n]);
}

static struct draw begin_robot(int links, int obstacles, struct robot *out)
{
    memset(out, 0, sizeof *out);
    out->links = links;
    out->obstacles = obstacles;
    return (struct draw){20260};
}

void robot_draw(struct robot *out)
{
    struct draw draw = begin_robot(ROBOT_LINKS, ROBOT_OBSTACLES, out);
    draw_bodies(&draw, out);
    draw_states(&draw, out);
}

void robot_draw_hulls(struct robot *out)
{
    struct draw draw = begin_robot(ROBOT_HULLS, ROBOT_OBSTACLES, out);
    draw_hulls(&draw, out);
    draw_states(&draw, out);
}

void robot_draw_arm(int rings, int links, int boxes, struct robot *out)
{
    struct draw draw = begin_robot(links, boxes, out);
    make_links(rings, out);
    for (int i = links; i < links + boxes; i++)
        draw_box(&draw, &out->body[i]);
    begin_states(out);
    place_obstacles(&draw, out);
}
