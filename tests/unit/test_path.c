/* Edges of paths: no sampled pose contradicts what is proven of chains, branches, sliding and mimic
 * joints, carried bodies and rounded ones; bounds that are too small are found in this way.
 * Arguments and output: cli/path.bats. */
#include "unit.h"

#include "draw.h"
#include "fmb_robot.h"
#include "wrong_bounds.h"

#include <math.h>
#include <unistd.h>

static struct draw draw;

static int setup(void **state)
{
    draw_begin(&draw, "test_path");
    return 0;
}

/* ---- Robots ---- */

static struct fmb_robot *read_text(const char *text)
{
    struct fmb_robot *robot;
    char path[] = "/tmp/test_path-XXXXXX";
    const int fd = mkstemp(path);
    assert_true(fd >= 0);
    assert_int_equal(write(fd, text, strlen(text)), strlen(text));
    close(fd);
    if (fmb_robot_read(path, NULL, &robot) != 0)
        fail_msg("%s", fmb_robot_why(robot));
    unlink(path);
    return robot;
}

/* A robot among bodies, and an edge of it. */
struct world {
    struct fmb_robot *robot;
    struct fmb_robot_scene *scene;
    size_t joints;
    double q[2][16];
    struct fmb_body body[4];
    double vertices[4][64];
    struct fmb_placement placement[4];
    const char *links[4];
    struct fmb_scene around;
};

static void place_world(struct world *world)
{
    const struct fmb_robot_world bodies = {.scene = &world->around, .links = world->links};
    world->joints = fmb_robot_joints(world->robot, NULL);
    world->around.placements = world->placement;
    if (fmb_robot_scene(world->robot, &bodies, 1, NULL, 0, &world->scene) != 0)
        fail_msg("%s", fmb_robot_scene_why(world->scene));
}

static void clear_world(struct world *world)
{
    fmb_robot_scene_free(world->scene);
    fmb_robot_free(world->robot);
}

static void add_vector(char *text, const char *name, double size)
{
    sprintf(text + strlen(text), " %s=\"%.17g %.17g %.17g\"", name,
            draw_uniform(&draw, -size, size), draw_uniform(&draw, -size, size),
            draw_uniform(&draw, -size, size));
}

static void add_shape(char *text)
{
    strcat(text, "<collision><origin");
    add_vector(text, "xyz", 0.1);
    add_vector(text, "rpy", 3);
    strcat(text, "/><geometry>");
    const double size = draw_uniform(&draw, 0.02, 0.1);
    char *end = text + strlen(text);
    switch (draw_int(&draw, 0, 3)) {
    case 0: sprintf(end, "<sphere radius=\"%g\"/>", size); break;
    case 1: sprintf(end, "<capsule radius=\"%g\" length=\"%g\"/>", size, 2 * size); break;
    case 2: sprintf(end, "<cylinder radius=\"%g\" length=\"%g\"/>", size, 3 * size); break;
    default: sprintf(end, "<box size=\"%g %g %g\"/>", size, 2 * size, 4 * size);
    }
    strcat(text, "</geometry></collision>");
}

/* Draws links, each a child of the one before or of any other, with up to two shapes; the first
 * joint moves all of them, and what the first link carries moves relative to all others. */
static void draw_robot(char *text, int links, bool branches)
{
    static const char *const types[] = {"revolute", "continuous", "prismatic", "fixed"};
    strcpy(text, "<robot name=\"r\"><link name=\"base\"/>");
    for (int i = 1; i <= links; i++) {
        char *end = text + strlen(text);
        const int parent = i == 1 ? 0 : branches ? draw_int(&draw, 1, i - 1) : i - 1;
        const char *type = types[parent < 2 ? draw_int(&draw, 0, 2) : draw_int(&draw, 0, 5) % 4];
        sprintf(end, "<link name=\"l%d\">", i);
        for (int shapes = draw_int(&draw, 1, 2); shapes > 0; shapes--)
            add_shape(text);
        end = text + strlen(text);
        sprintf(end,
                "</link><joint name=\"j%d\" type=\"%s\"><parent link=\"%s%.0d\"/><child "
                "link=\"l%d\"/><origin",
                i, type, parent ? "l" : "base", parent, i);
        add_vector(text, "xyz", 0.3);
        add_vector(text, "rpy", 3);
        strcat(text, "/><axis");
        add_vector(text, "xyz", 2);
        strcat(text, "/><limit lower=\"-9\" upper=\"9\"/>");
        if (i == 4 && strcmp(type, "fixed") != 0 && strstr(text, "name=\"j1\""))
            strcat(text, "<mimic joint=\"j1\" multiplier=\"-0.7\" offset=\"0.2\"/>");
        strcat(text, "</joint>");
    }
    strcat(text, "</robot>");
}

static void draw_placement(struct fmb_placement *out, double size)
{
    for (int i = 0; i < 3; i++)
        out->position[i] = draw_uniform(&draw, -size, size);
    out->orientation_count = 4;
    for (int i = 0; i < 4; i++)
        out->orientation[i] = draw_uniform(&draw, -1, 1);
}

/* Two obstacles, a carried body, and an edge of up to `step` a joint. */
static void draw_world(struct world *world, int links, bool branches, double step)
{
    static char text[1 << 16];
    *world = (struct world){.robot = NULL};
    draw_robot(text, links, branches);
    world->robot = read_text(text);
    world->around.placement_count = 3;
    for (int i = 0; i < 3; i++) {
        double numbers[12];
        for (int k = 0; k < 12; k++)
            numbers[k] = draw_uniform(&draw, -0.15, 0.15);
        assert_int_equal(
            i == 0 ? fmb_body_make(3, FMB_CUBOID, numbers, 12, &world->body[i])
                   : fmb_body_make_hull(3, numbers, 12, world->vertices[i], &world->body[i]),
            FMB_OK);
        if (i == 2)
            fmb_body_inflate(&world->body[i], 0.05);
        world->placement[i] = (struct fmb_placement){.body = &world->body[i], .group = i != 1};
        draw_placement(&world->placement[i], i == 1 ? 0.1 : 0.9);
    }
    world->links[1] = "l1";
    place_world(world);
    for (size_t j = 0; j < world->joints; j++) {
        world->q[0][j] = draw_uniform(&draw, -3, 3);
        world->q[1][j] =
            world->q[0][j] + (draw_int(&draw, 0, 3) ? draw_uniform(&draw, -step, step) : 0);
    }
}

/* ---- Sampled poses ---- */

/* Returns the least gap at a time of the edge. */
static double sampled_gap(const struct world *world, double s)
{
    double q[16], least = INFINITY;
    for (size_t j = 0; j < world->joints; j++)
        q[j] = (1 - s) * world->q[0][j] + s * world->q[1][j];
    assert_int_equal(fmb_robot_place(world->scene, q), 0);
    struct fmb_scene scene = *fmb_robot_scene_get(world->scene);
    struct fmb_scene_limits limits;
    struct fmb_scene_state *state;
    struct fmb_scene_answers answers;
    scene.margin = 1e6;
    fmb_scene_limits_of(&scene, &limits);
    void *memory = malloc(fmb_scene_bytes(&limits));
    assert_int_equal(fmb_scene_begin(&scene, &limits, memory, &state), FMB_OK);
    for (bool done = false; !done;) {
        done = fmb_scene_step(state, &answers);
        for (size_t k = 0; k < answers.count; k++)
            least = fmin(least, answers.gaps[k].bounds[0]);
    }
    free(memory);
    return least;
}

static struct fmb_robot_edge prove_edge(const struct world *world, double clearance)
{
    struct fmb_robot_path *path;
    struct fmb_robot_edge edge;
    if (fmb_robot_path_begin(world->scene, clearance, &path) != 0 ||
        fmb_robot_path_edge(path, world->q[0], world->q[1]) != 0)
        fail_msg("%s", fmb_robot_path_why(path));
    while (!fmb_robot_path_step(path, &edge))
        ;
    fmb_robot_path_free(path);
    return edge;
}

/* Far above all errors of poses, far below what a wrong bound costs. */
static const double sure = 1e-9;

/* Whether no pose that is sampled contradicts an answer. */
static bool holds(const struct world *world, const struct fmb_robot_edge *edge, int samples)
{
    const bool proven = edge->verdict == FMB_ROBOT_FREE || edge->verdict == FMB_ROBOT_NEAR;
    const double to = proven ? 1 : edge->at[0];
    if (edge->verdict == FMB_ROBOT_CONTACT && !(sampled_gap(world, edge->at[1]) < sure))
        return false;
    for (int i = 0; i <= samples && to > 0; i++)
        if (sampled_gap(world, to * i / samples) < edge->clearance - sure)
            return false;
    return !proven || edge->clearance <= edge->closest;
}

static void sampled_poses_agree_with_every_verdict(void **state)
{
    long count[5] = {0};
    for (long i = 0; i < draw_sample(400); i++) {
        struct world world;
        draw_world(&world, draw_int(&draw, 1, 6), draw_coin(&draw), draw_coin(&draw) ? 0.3 : 2);
        const double wanted = draw_coin(&draw) ? 0 : 0.1;
        const struct fmb_robot_edge edge = prove_edge(&world, wanted);
        count[edge.verdict]++;
        assert_true(holds(&world, &edge, 48));
        assert_int_not_equal(edge.verdict, FMB_ROBOT_UNDECIDED);
        if (edge.verdict == FMB_ROBOT_FREE && wanted > 0)
            assert_true(edge.clearance >= wanted);
        else if (edge.verdict == FMB_ROBOT_FREE)
            assert_true(edge.clearance >= 0.9 * edge.closest);
        else if (edge.verdict == FMB_ROBOT_NEAR)
            assert_true(edge.closest < wanted && edge.clearance >= 0.9 * edge.closest);
        else
            assert_true(edge.at[1] - edge.at[0] <= 0x1p-16);
        clear_world(&world);
    }
    for (int verdict = FMB_ROBOT_FREE; verdict <= FMB_ROBOT_CONTACT; verdict++)
        assert_true(count[verdict] >= draw_sample(20));
}

/* ---- A ball on an arm, for which bounds are tight ---- */

/* A ball of radius 0.1 at a distance of 1 from a turning joint, or on a sliding one, along x; and a
 * box, whose face is at x = 1.1 + gap. */
static void make_arm(struct world *world, const char *type, double gap, double from, double to)
{
    static const double size[3] = {1, 4, 4};
    char text[1024];
    *world = (struct world){.q = {{from}, {to}}};
    snprintf(text, sizeof text,
             "<robot name=\"r\"><link name=\"base\"/><link name=\"ball\"><collision>"
             "<origin xyz=\"1 0 0\"/><geometry><sphere radius=\"0.1\"/></geometry></collision>"
             "</link><joint name=\"j\" type=\"%s\"><parent link=\"base\"/><child link=\"ball\"/>"
             "<axis xyz=\"%s\"/><limit lower=\"-9\" upper=\"9\"/></joint></robot>",
             type, strcmp(type, "prismatic") == 0 ? "1 0 0" : "0 0 1");
    world->robot = read_text(text);
    world->around.placement_count = 1;
    assert_int_equal(fmb_body_make(3, FMB_BOX, size, 3, &world->body[0]), FMB_OK);
    world->placement[0] =
        (struct fmb_placement){.body = &world->body[0], .position = {1.6 + gap, 0, 0}};
    place_world(world);
}

static void halved_bounds_are_found(void **state)
{
    int wrong[3] = {0, 0, 0};
    for (int fault = 0; fault < 3; fault++) {
        wrong_speed = fault == 1 ? 0.5 : 1;
        wrong_curve = fault == 2 ? 0.5 : 1;
        for (int i = 1; i < 40; i++) {
            struct world world;
            if (i % 2)
                make_arm(&world, "revolute", 0.0005 * i, -0.02 * i, 0.02 * i);
            else
                make_arm(&world, "prismatic", 0.01 * i, 0, 0.0099 * i);
            const struct fmb_robot_edge edge = prove_edge(&world, 0);
            wrong[fault] += !holds(&world, &edge, 64);
            clear_world(&world);
        }
    }
    wrong_speed = wrong_curve = 1;
    assert_int_equal(wrong[0], 0);
    assert_true(wrong[1] > 0);
    assert_true(wrong[2] > 0);
}

static void a_known_contact_is_enclosed(void **state)
{
    struct world world;
    make_arm(&world, "prismatic", 0.25, 0, 1);
    struct fmb_robot_edge edge = prove_edge(&world, 0);
    assert_int_equal(edge.verdict, FMB_ROBOT_CONTACT);
    assert_true(edge.at[0] <= 0.25 && 0.25 <= edge.at[1] && edge.at[1] - edge.at[0] <= 0x1p-16);
    assert_true(edge.a == 0 && edge.b == 1);
    world.q[0][0] = 0.3; /* begins in contact */
    edge = prove_edge(&world, 0);
    assert_true(edge.verdict == FMB_ROBOT_CONTACT && edge.at[0] == 0 && edge.at[1] == 0);
    world.q[0][0] = world.q[1][0] = 0.1; /* one pose */
    edge = prove_edge(&world, 0.2);
    assert_true(edge.verdict == FMB_ROBOT_NEAR && edge.clearance > 0.135 && edge.closest < 0.1501);
    edge = prove_edge(&world, 0.1);
    assert_true(edge.verdict == FMB_ROBOT_FREE && edge.clearance >= 0.1);
    clear_world(&world);
}

/* A ball that turns about its own centre, on a face. */
static void resting_links_are_undecided(void **state)
{
    struct world world;
    make_arm(&world, "revolute", 0, 0, 0);
    world.placement[0].position[0] = 1.6 + 0x1p-52;
    fmb_robot_scene_free(world.scene);
    place_world(&world);
    world.q[0][0] = -0.5;
    world.q[1][0] = 0.5;
    const struct fmb_robot_edge edge = prove_edge(&world, 0);
    assert_int_equal(edge.verdict, FMB_ROBOT_UNDECIDED);
    assert_true(edge.at[0] < 0.5 + 1e-4 && edge.at[1] > 0.5 - 1e-4 &&
                edge.at[1] - edge.at[0] <= 0x1p-30);
    clear_world(&world);
}

static void an_edge_can_be_abandoned(void **state)
{
    struct world world;
    struct fmb_robot_path *path;
    struct fmb_robot_edge edge, again;
    draw_world(&world, 6, false, 2);
    assert_int_equal(fmb_robot_path_begin(world.scene, 0, &path), 0);
    assert_int_equal(fmb_robot_path_step(path, &edge), 0);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(fmb_robot_path_edge(path, world.q[0], world.q[1]), 0);
        for (int k = 0; k < i; k++)
            fmb_robot_path_step(path, &edge);
    }
    assert_int_equal(fmb_robot_path_edge(path, world.q[0], world.q[1]), 0);
    while (!fmb_robot_path_step(path, &edge))
        ;
    again = prove_edge(&world, 0);
    assert_true(edge.verdict == again.verdict && edge.at[0] == again.at[0] &&
                edge.clearance == again.clearance && edge.closest == again.closest);
    fmb_robot_path_free(path);
    clear_world(&world);
}

static void a_complete_edge_keeps_its_answer(void **state)
{
    struct world world;
    struct fmb_robot_path *path;
    struct fmb_robot_edge edge, again;
    make_arm(&world, "prismatic", 0.25, 0, 1);
    assert_int_equal(fmb_robot_path_begin(world.scene, 0, &path), 0);
    assert_int_equal(fmb_robot_path_edge(path, world.q[0], world.q[1]), 0);
    while (!fmb_robot_path_step(path, &edge))
        ;
    for (int i = 0; i < 2; i++) {
        again = (struct fmb_robot_edge){.clearance = -1};
        assert_int_equal(fmb_robot_path_step(path, &again), 1);
        assert_true(again.verdict == FMB_ROBOT_CONTACT && again.at[0] == edge.at[0] &&
                    again.at[1] == edge.at[1] && again.clearance == edge.clearance &&
                    again.closest == edge.closest && again.a == edge.a && again.b == edge.b);
    }
    world.q[1][0] = NAN;
    assert_int_equal(fmb_robot_path_edge(path, world.q[0], world.q[1]), -1);
    assert_int_equal(fmb_robot_path_step(path, &again), 0);
    fmb_robot_path_free(path);
    clear_world(&world);
}

static void bad_edges_and_worlds_are_refused(void **state)
{
    struct world world;
    struct fmb_robot_path *path;
    make_arm(&world, "continuous", 0.1, 0, 3.2);
    assert_int_equal(fmb_robot_path_begin(world.scene, 0, &path), 0);
    assert_int_equal(fmb_robot_path_edge(path, world.q[0], world.q[1]), -1);
    assert_non_null(strstr(fmb_robot_path_why(path), "unwrap"));
    world.q[1][0] = NAN;
    assert_int_equal(fmb_robot_path_edge(path, world.q[0], world.q[1]), -1);
    assert_non_null(strstr(fmb_robot_path_why(path), "not finite"));
    fmb_robot_path_free(path);
    assert_int_equal(fmb_robot_path_begin(world.scene, -1, &path), -1);
    fmb_robot_path_free(path);
    world.around.duration = 1;
    for (int ends = 0; ends < 2; ends++) {
        world.placement[0].velocity[1] = !ends;
        world.placement[0].end_count = ends ? 3 + world.placement[0].orientation_count : 0;
        fmb_robot_scene_free(world.scene);
        place_world(&world);
        assert_int_equal(fmb_robot_path_begin(world.scene, 0, &path), -1);
        assert_non_null(strstr(fmb_robot_path_why(path), "moves"));
        fmb_robot_path_free(path);
    }
    clear_world(&world);
    world.robot = read_text(
        "<robot name=\"r\"><link name=\"base\"><collision><geometry>"
        "<sphere radius=\"1\"/></geometry></collision></link></robot>");
    world.around = (struct fmb_scene){.placement_count = 0};
    place_world(&world);
    assert_int_equal(fmb_robot_path_begin(world.scene, 0, &path), -1);
    assert_non_null(strstr(fmb_robot_path_why(path), "no joint"));
    fmb_robot_path_free(path);
    clear_world(&world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sampled_poses_agree_with_every_verdict),
        cmocka_unit_test(halved_bounds_are_found),
        cmocka_unit_test(a_known_contact_is_enclosed),
        cmocka_unit_test(resting_links_are_undecided),
        cmocka_unit_test(an_edge_can_be_abandoned),
        cmocka_unit_test(a_complete_edge_keeps_its_answer),
        cmocka_unit_test(bad_edges_and_worlds_are_refused),
    };
    return cmocka_run_group_tests(tests, setup, NULL);
}
