/* Placements with an end, and pairs of bodies that turn within the window. */
#include "unit.h"

#include <float.h>
#include <math.h>

#include "fmb.h"
#include "fmb_batch.h"

static const double cube_numbers[] = {-0.5, -0.5, -0.5, 1, 0, 0, 0, 1, 0, 0, 0, 1};

static struct fmb_body cube_body(void)
{
    struct fmb_body body;
    assert_int_equal(fmb_body_make(3, FMB_CUBOID, cube_numbers, 12, &body), FMB_OK);
    return body;
}

/* A placement that turns from one orientation to another. */
static struct fmb_placement turning(const struct fmb_body *body, const double q0[4],
                                    const double q1[4])
{
    struct fmb_placement out = {.body = body, .orientation_count = 4, .end_count = 7};
    memcpy(out.orientation, q0, sizeof out.orientation);
    memcpy(out.end_orientation, q1, sizeof out.end_orientation);
    return out;
}

/* ---- Placements ---- */

static void ends_have_to_be_poses_of_the_same_motion(void **state)
{
    static const double one[4] = {1, 0, 0, 0}, long_one[4] = {4, 0, 0, 0};
    const double longer[4] = {4, 0, 0, 0x1p-26}; /* 16 + 2^-52 */
    const double right[4] = {0, 1, 0, 0}, nearly[4] = {0x1p-190, 1, 0, 0};
    const double zero[4] = {0}, infinite[4] = {1, INFINITY, 0, 0}, tiny[4] = {1, 0x1p-201, 0, 0};
    /* In doubles 3 * 0.1 - 0.3 is 2^-54. Neither pair is at right angles, though rounded arithmetic
     * gives 0 for the dot product of the second one. */
    const double third[4] = {0.75, 0.25, 0, 0}, tenth[4] = {0.1, -0.3, 0, 0};
    const double thrice[4] = {0.1, -(0.1 * 3), 0, 0};
    const struct {
        const double *q0, *q1;
        enum fmb_status status;
    } cases[] = {
        {one, one, FMB_OK},
        {one, long_one, FMB_OK},
        {long_one, one, FMB_OK},
        {one, longer, FMB_BAD_ORIENTATION},
        {longer, one, FMB_BAD_ORIENTATION},
        {one, right, FMB_BAD_ORIENTATION},
        {one, nearly, FMB_OK},
        {one, zero, FMB_BAD_ORIENTATION},
        {zero, one, FMB_BAD_ORIENTATION},
        {one, infinite, FMB_BAD_ORIENTATION},
        {one, tiny, FMB_BAD_ORIENTATION},
        {third, tenth, FMB_OK},
        {third, thrice, FMB_OK},
    };
    const struct fmb_body cube = cube_body();
    for (size_t i = 0; i < COUNT(cases); i++) {
        struct fmb_placement placement = turning(&cube, cases[i].q0, cases[i].q1);
        assert_int_equal(fmb_placement_check(&placement), cases[i].status);
        for (int k = 0; k < 4; k++) { /* any length */
            placement.orientation[k] *= 0x1p-700;
            placement.end_orientation[k] *= -0x1p-700;
        }
        if (cases[i].q1 != infinite)
            assert_int_equal(fmb_placement_check(&placement), cases[i].status);
    }
    struct fmb_placement placement = turning(&cube, one, one);
    placement.velocity[2] = 0x1p-1074;
    assert_int_equal(fmb_placement_check(&placement), FMB_WRONG_COUNT);
    placement.velocity[2] = 0;
    placement.end_position[1] = NAN;
    assert_int_equal(fmb_placement_check(&placement), FMB_NOT_FINITE);
    placement.end_position[1] = 0;
    for (int count = -1; count <= 9; count++) {
        placement.end_count = count;
        assert_int_equal(fmb_placement_check(&placement),
                         count == 0 || count == 7 ? FMB_OK : FMB_WRONG_COUNT);
    }
    memset(placement.orientation, 0, sizeof placement.orientation);
    placement.orientation_count = 0;
    for (int count = 1; count <= 7; count++) {
        placement.end_count = count;
        assert_int_equal(fmb_placement_check(&placement), count == 3 ? FMB_OK : FMB_WRONG_COUNT);
    }
}

static void poses_are_those_given_at_both_ends(void **state)
{
    static const double q0[4] = {0.8, 0.1, -0.3, 0.2}, q1[4] = {-0.7, 0.3, 0.25, -0.1};
    const struct fmb_body cube = cube_body();
    struct fmb_placement placement = turning(&cube, q0, q1), out;
    placement.position[0] = 0.1, placement.end_position[0] = 0.7, placement.id = 5;
    fmb_pose_at(&placement, 3, 0, &out);
    assert_memory_equal(out.position, placement.position, sizeof out.position);
    assert_memory_equal(out.orientation, q0, sizeof q0);
    assert_true(out.end_count == 0 && out.id == 5 && out.body == &cube);
    assert_int_equal(fmb_placement_check(&out), FMB_OK);
    fmb_pose_at(&placement, 3, 3, &out);
    assert_memory_equal(out.position, placement.end_position, sizeof out.position);
    assert_memory_equal(out.orientation, q1, sizeof q1);
    fmb_pose_at(&placement, 3, 1.5, &out);
    for (int i = 0; i < 4; i++) /* the sign that makes the turn less than 180 degrees */
        assert_float_equal(out.orientation[i], (q0[i] - q1[i]) / 2, 1e-15);
    assert_float_equal(out.position[0], 0.4, 1e-15);
    fmb_pose_at(&placement, 0, 0, &out);
    assert_memory_equal(out.orientation, q0, sizeof q0);
    for (int k = 0; k < 4; k++)
        placement.orientation[k] *= 0x1p-1000, placement.end_orientation[k] *= 0x1p-1000;
    fmb_pose_at(&placement, 3, 1e-9, &out);
    assert_int_equal(fmb_placement_check(&out), FMB_OK);
    struct fmb_placement moving = {.body = &cube, .velocity = {2, 0, 0}};
    fmb_pose_at(&moving, 3, 1.5, &moving);
    assert_true(moving.position[0] == 3 && moving.velocity[0] == 0);
}

static void an_end_needs_a_window(void **state)
{
    static const double q0[4] = {1, 0, 0, 0}, q1[4] = {1, 0, 0, 0.5};
    const struct fmb_body cube = cube_body();
    struct fmb_placement placements[2] = {turning(&cube, q0, q1), {.body = &cube}};
    struct fmb_answer answer;
    struct fmb_prepared prepared[2];
    enum fmb_verdict verdict;
    char why[100], text[10];
    size_t length;
    placements[1].position[0] = 1.25;
    assert_int_equal(
        fmb_decide(fmb_method_default(), &placements[0], &placements[1], 0, 0, &answer),
        FMB_BAD_DURATION);
    assert_int_equal(fmb_certificate(&placements[0], &placements[1], 0, text, 10, &length),
                     FMB_BAD_DURATION);
    struct fmb_scene scene = {.placements = placements, .placement_count = 2};
    assert_int_equal(fmb_scene_check(&scene, why, sizeof why), FMB_BAD_DURATION);
    assert_string_equal(why, "duration: it is 0, but body 0 moves");
    scene.instant = true;
    assert_int_equal(fmb_scene_check(&scene, why, sizeof why), FMB_OK);
    for (int i = 0; i < 2; i++)
        assert_int_equal(fmb_prepare(&placements[i], 0, 1, &prepared[i]), FMB_OK);
    assert_int_equal(fmb_decide_prepared(&prepared[0], &prepared[1], 0, &verdict),
                     FMB_BAD_DURATION);
}

/* In a window of 0 s, every answer is about the pose at its beginning. */
static void an_instant_takes_the_pose_at_the_beginning(void **state)
{
    static const double q0[4] = {1, 0.1, 0, 0}, q1[4] = {1, 0, 0, 0.5};
    const struct fmb_body cube = cube_body();
    struct fmb_placement placements[2] = {turning(&cube, q0, q1), {.body = &cube}};
    const unsigned pair[1][2] = {{0, 1}};
    const unsigned want = FMB_WANT_BOX | FMB_WANT_TIMES | FMB_WANT_GAP | FMB_WANT_POINT;
    struct fmb_scene scene = {.placements = placements,
                              .placement_count = 2,
                              .instant = true,
                              .want = want,
                              .which = FMB_PAIRS_LISTED,
                              .pairs = pair,
                              .pair_count = 1};
    struct fmb_answer answer[2];
    for (int k = 0; k < 40; k++) {
        placements[1].position[0] = 0.9 + k * 0.01;
        for (int still = 0; still < 2; still++) {
            struct fmb_scene_limits limits;
            struct fmb_scene_answers answers;
            struct fmb_scene_state *scene_state;
            placements[0].end_count = still ? 0 : 7;
            fmb_scene_limits_of(&scene, &limits);
            void *memory = malloc(fmb_scene_bytes(&limits));
            assert_int_equal(fmb_scene_begin(&scene, &limits, memory, &scene_state), FMB_OK);
            for (bool done = false; !done;) {
                done = fmb_scene_step(scene_state, &answers);
                if (answers.count > 0)
                    fmb_scene_answer(&answers, 0, &answer[still]);
            }
            free(memory);
        }
        assert_true(answer[0].verdict != 0);
        assert_memory_equal(&answer[0], &answer[1], sizeof answer[0]);
    }
}

/* The box of a body over the window contains all its poses. */
static void boxes_contain_the_turning_body(void **state)
{
    static const double corner[2] = {-0.5, 0.5};
    const struct fmb_body cube = cube_body();
    uint64_t seed = 7;
    for (int k = 0; k < 300; k++) {
        double q[2][4], box[2][3];
        for (int i = 0; i < 8; i++) {
            seed = seed * UINT64_C(6364136223846793005) + 1442695040888963407;
            q[i / 4][i % 4] = (double) (int64_t) seed * 0x1p-63;
        }
        struct fmb_placement placement = turning(&cube, q[0], q[1]);
        placement.position[1] = q[0][1], placement.end_position[1] = q[1][2];
        if (fmb_placement_check(&placement) != FMB_OK)
            continue;
        struct fmb_prepared prepared;
        assert_int_equal(fmb_prepare(&placement, 0, 1, &prepared), FMB_OK);
        fmb_box_of(&prepared, 2, box);
        for (int step = 0; step <= 64; step++) {
            struct fmb_placement pose;
            fmb_pose_at(&placement, 2, step / 32., &pose);
            const double w = pose.orientation[0], *v = pose.orientation + 1;
            const double n = w * w + v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
            for (int c = 0; c < 8; c++)
                for (int axis = 0; axis < 3; axis++) {
                    const double x[3] = {corner[c & 1], corner[c >> 1 & 1], corner[c >> 2]};
                    const int j = (axis + 1) % 3, l = (axis + 2) % 3;
                    const double at =
                        pose.position[axis] +
                        ((w * w + v[axis] * v[axis] - v[j] * v[j] - v[l] * v[l]) * x[axis] +
                         2 * (v[axis] * v[j] - w * v[l]) * x[j] +
                         2 * (v[axis] * v[l] + w * v[j]) * x[l]) /
                            n;
                    assert_true(at >= box[0][axis] - 1e-14 && at <= box[1][axis] + 1e-14);
                    assert_true(box[0][axis] > -2.5 && box[1][axis] < 2.5);
                }
        }
    }
}

/* ---- Verdicts ---- */

enum { EPSILON_BITS = 40 };

struct resting {
    struct fmb_body body[2];
    struct fmb_placement placement[2];
    double memory[2][400];
};

/* The certificate holds. It is missing if and only if the pair is not decided, or turns and
 * touches. */
static void check_certificate(const struct fmb_placement *a, const struct fmb_placement *b,
                              enum fmb_status status, enum fmb_verdict verdict)
{
    char text[FMB_CERTIFICATE_MAX], why[200];
    size_t length;
    assert_int_equal(fmb_certificate(a, b, 2, text, sizeof text, &length), status);
    assert_int_equal(length > 0, verdict == FMB_SEPARATED || verdict == FMB_OVERLAPPING ||
                                     (verdict && !a->end_count && !b->end_count));
    if (length > 0 && !fmb_certificate_holds(a, b, 2, verdict, text, why, sizeof why))
        fail_msg("%s: %s", why, text);
}

/* Decides a pair in a window of 2 s. Checks that both orders have the same answer, that
 * fmb_decide_prepared() gives the same verdict, and that the certificate of each order holds. */
static enum fmb_status decide(const struct fmb_placement placement[2], struct fmb_answer *out)
{
    struct fmb_answer swapped;
    const enum fmb_status status =
        fmb_decide(fmb_method_default(), &placement[0], &placement[1], 2, FMB_WANT_TIMES, out);
    assert_int_equal(
        fmb_decide(fmb_method_default(), &placement[1], &placement[0], 2, FMB_WANT_TIMES, &swapped),
        status);
    assert_memory_equal(out, &swapped, sizeof swapped);
    struct fmb_prepared prepared[2];
    enum fmb_verdict verdict = 0;
    for (int f = 0; f < 2; f++)
        assert_int_equal(fmb_prepare(&placement[f], 0, 1, &prepared[f]), FMB_OK);
    assert_int_equal(fmb_decide_prepared(&prepared[0], &prepared[1], 2, &verdict), status);
    assert_int_equal(verdict, out->verdict);
    check_certificate(&placement[0], &placement[1], status, out->verdict);
    check_certificate(&placement[1], &placement[0], status, out->verdict);
    return status;
}

/* Exchanges the beginning and the end. */
static void reverse(struct fmb_placement *placement)
{
    for (int i = 0; i < 4; i++) {
        const double q = placement->orientation[i], p = i < 3 ? placement->position[i] : 0;
        placement->orientation[i] = placement->end_orientation[i];
        placement->end_orientation[i] = q;
        if (i < 3) {
            placement->position[i] = placement->end_position[i];
            placement->end_position[i] = p;
        }
    }
}

/* Checks the gap of a pair that touches. */
static void check_touching_gap(const struct fmb_placement placement[2])
{
    struct fmb_answer answer;
    assert_int_equal(fmb_decide(fmb_method_default(), &placement[0], &placement[1], 2,
                                FMB_WANT_TIMES | FMB_WANT_GAP, &answer),
                     FMB_OK);
    assert_true(answer.has_gap && !answer.gap.has_witness);
    assert_true(answer.gap.bounds[0] == 0 && answer.gap.bounds[1] == 0);
    assert_true(answer.gap.time >= answer.contact[0] && answer.gap.time <= answer.contact[1]);
}

/* Expects the verdict and the contact, also with time reversed. */
static void expect(const struct fmb_placement placement[2], enum fmb_verdict verdict, double first,
                   double last)
{
    struct fmb_placement back[2] = {placement[0], placement[1]};
    struct fmb_answer answer;
    assert_int_equal(decide(placement, &answer), FMB_OK);
    assert_int_equal(answer.verdict, verdict);
    if (verdict == FMB_TOUCHING)
        check_touching_gap(placement);
    if (verdict != FMB_SEPARATED) {
        assert_true(answer.contact[0] <= first && answer.contact[0] >= first - 2e-12);
        assert_true(answer.contact[1] >= last && answer.contact[1] <= last + 2e-12);
    }
    for (int f = 0; f < 2; f++)
        if (back[f].end_count)
            reverse(&back[f]);
    assert_int_equal(decide(back, &answer), FMB_OK);
    assert_int_equal(answer.verdict, verdict);
    if (verdict == FMB_TOUCHING)
        check_touching_gap(back);
    if (verdict != FMB_SEPARATED) {
        assert_true(answer.contact[0] <= 2 - last && answer.contact[0] >= 2 - last - 2e-12);
        assert_true(answer.contact[1] >= 2 - first && answer.contact[1] <= 2 - first + 2e-12);
    }
}

static void box_of(double x, double y, double z, struct fmb_body *out)
{
    assert_int_equal(fmb_body_make(3, FMB_BOX, (const double[]){x, y, z}, 3, out), FMB_OK);
}

/* A table with its top at z = 0, and a body above it that turns about z and slides. */
static void set_table(struct resting *rest)
{
    static const double q0[4] = {1, 0, 0, 0}, q1[4] = {3, 0, 0, 1};
    box_of(10, 10, 1, &rest->body[0]);
    rest->placement[0] = (struct fmb_placement){.body = &rest->body[0], .position = {0, 0, -0.5}};
    rest->placement[1] = turning(&rest->body[1], q0, q1);
    rest->placement[1].position[0] = -1, rest->placement[1].end_position[0] = 1.5;
}

/* Sets the heights of the body at the beginning and at the end. */
static void lift(struct resting *rest, double begin, double end)
{
    rest->placement[1].position[2] = begin, rest->placement[1].end_position[2] = end;
}

static void expect_resting(struct resting *rest, double half)
{
    const double e = ldexp(1, -EPSILON_BITS);
    lift(rest, half, half);
    expect(rest->placement, FMB_TOUCHING, 0, 2);
    lift(rest, half + e, half + e);
    expect(rest->placement, FMB_SEPARATED, 0, 0);
    lift(rest, half - e, half - e);
    expect(rest->placement, FMB_OVERLAPPING, 0, 2);
    lift(rest, half, half + 1);
    expect(rest->placement, FMB_TOUCHING, 0, 0);
    lift(rest, half, half - e);
    expect(rest->placement, FMB_OVERLAPPING, 0, 2);
}

static void bodies_that_yaw_and_slide_on_a_table(void **state)
{
    struct resting rest;
    set_table(&rest);
    box_of(1, 1, 1, &rest.body[1]);
    expect_resting(&rest, 0.5);
    assert_int_equal(
        fmb_body_make_vertices(3, FMB_TETRAHEDRON,
                               (const double[]){0, 0, -0.5, 1, 0, -0.5, 0, 1, -0.5, 0, 0, 1}, 12,
                               &rest.body[1]),
        FMB_OK);
    expect_resting(&rest, 0.5);
    assert_int_equal(
        fmb_body_make_vertices(3, FMB_FACE, (const double[]){0, 0, -0.5, 1, 0, -0.5, 0, 1, 0.25}, 9,
                               &rest.body[1]),
        FMB_OK);
    expect_resting(&rest, 0.5);
}

/* A prism with 50 vertices at the bottom and 50 at the top. */
static void hulls_that_yaw_and_slide_on_a_table(void **state)
{
    struct resting rest;
    double vertices[100][3];
    set_table(&rest);
    for (int i = 0; i < 100; i++) {
        vertices[i][0] = cos(i % 50 * 0.1256), vertices[i][1] = sin(i % 50 * 0.1256);
        vertices[i][2] = i < 50 ? -0.5 : 0.5;
    }
    assert_int_equal(fmb_body_make_hull(3, vertices[0], 300, rest.memory[1], &rest.body[1]),
                     FMB_OK);
    expect_resting(&rest, 0.5);
}

/* A table with 12 corners and an edge on it, which yaw in opposite directions. */
static void edges_yaw_on_a_turning_hull(void **state)
{
    static const double corner[12][2] = {{4, 0},     {3.5, 2},  {2, 3.5},  {0, 4},
                                         {-2, 3.5},  {-3.5, 2}, {-4, 0},   {-3.5, -2},
                                         {-2, -3.5}, {0, -4},   {2, -3.5}, {3.5, -2}};
    static const double edge[] = {-1, 0, 0, 1, 0, 0, 0, 0.25, 1};
    const double back[4] = {3, 0, 0, -1}, forth[4] = {3, 0, 0, 1};
    struct resting rest;
    double vertices[24][3];
    for (int i = 0; i < 24; i++) {
        memcpy(vertices[i], corner[i % 12], sizeof corner[0]);
        vertices[i][2] = i < 12 ? 0 : -1;
    }
    assert_int_equal(fmb_body_make_hull(3, vertices[0], 72, rest.memory[0], &rest.body[0]), FMB_OK);
    assert_int_equal(fmb_body_make_hull(3, edge, 9, rest.memory[1], &rest.body[1]), FMB_OK);
    rest.placement[0] = turning(&rest.body[0], forth, back);
    rest.placement[1] = turning(&rest.body[1], back, forth);
    expect_resting(&rest, 0);
}

/* A prism touches a wall at the beginning, after 53.13 and after 90 degrees, and its corners are in
 * the wall in between. The vertical edges of both are parallel throughout. */
static void a_prism_that_touches_three_times_overlaps(void **state)
{
    static const double corner[5][2] = {{3, 0}, {3, -1.5}, {1, -3}, {0, -3}, {-1, 0}};
    struct resting rest;
    double vertices[10][3];
    for (int i = 0; i < 10; i++) {
        memcpy(vertices[i], corner[i % 5], sizeof corner[0]);
        vertices[i][2] = i < 5 ? -1 : 1;
    }
    assert_int_equal(fmb_body_make_hull(3, vertices[0], 30, rest.memory[1], &rest.body[1]), FMB_OK);
    box_of(2, 20, 4, &rest.body[0]);
    rest.placement[0] = (struct fmb_placement){.body = &rest.body[0], .position = {4, 0, 0}};
    rest.placement[1] =
        turning(&rest.body[1], (const double[]){1, 0, 0, 0}, (const double[]){1, 0, 0, 1});
    expect(rest.placement, FMB_OVERLAPPING, 0, 2);
}

/* Edges pass each other at a distance of about 3e-7. Each corner of the flat box is two vertices.
 */
static void a_flat_box_passes_closely(void **state)
{
    struct resting rest;
    box_of(0.7578125, 0, 2.99609375, &rest.body[0]);
    box_of(1.03125, 1.171875, 1.93359375, &rest.body[1]);
    rest.placement[0] = (struct fmb_placement){
        .body = &rest.body[0],
        .orientation = {-0.344970703125, -0.669189453125, 0.57177734375, -0.052001953125},
        .end_orientation = {-0.405303955078125, -0.690887451171875, 0.614013671875, 0.06103515625},
        .position = {-0.86302566528320312, -0.32026386260986328, 0.75673103332519531},
        .end_position = {-0.90167713165283203, -0.34527492523193359, 0.70648193359375},
        .orientation_count = 4,
        .end_count = 7};
    rest.placement[1] = (struct fmb_placement){
        .body = &rest.body[1],
        .orientation = {-0.885498046875, 0.909423828125, 0.08837890625, -0.67626953125},
        .end_orientation = {-0.868316650390625, 0.9230499267578125, 0.0667724609375,
                            -0.7143707275390625},
        .position = {0.079602777816035086, 1.4218058233416855, 1.9582365414053697},
        .end_position = {-0.011046826981328195, 1.4269346838153183, 2.0663765331656236},
        .orientation_count = 4,
        .end_count = 7};
    expect(rest.placement, FMB_SEPARATED, 0, 0);
}

/* Both turn about one axis as one body, at rest relative to each other: 2^-40 deep, touching, or
 * 2^-40 apart. */
static void bodies_on_one_turntable(void **state)
{
    static const double q0[4] = {2, 1, 0, 1}, q1[4] = {3, 0, 1, -1};
    struct fmb_body body[2];
    const double e = ldexp(1, -EPSILON_BITS);
    for (int k = -1; k <= 1; k++) {
        assert_int_equal(fmb_body_make(3, FMB_BOX, (const double[]){1, 0, 0, 1, 1, 1}, 6, &body[0]),
                         FMB_OK);
        assert_int_equal(
            fmb_body_make(3, FMB_BOX, (const double[]){2 + k * e, 0.25, 0.5, 1, 2, 1}, 6, &body[1]),
            FMB_OK);
        const struct fmb_placement pair[2] = {turning(&body[0], q0, q1), turning(&body[1], q0, q1)};
        expect(pair, k < 0 ? FMB_OVERLAPPING : k == 0 ? FMB_TOUCHING : FMB_SEPARATED, 0, 2);
    }
}

/* A door that turns about an edge that it shares with a post. */
static void doors_hang_on_their_posts(void **state)
{
    static const double q0[4] = {1, 0, 0, 0}, q1[4] = {1, 0, 0, 1};
    struct fmb_body post, door;
    const double e = ldexp(1, -EPSILON_BITS);
    box_of(1, 1, 2, &post);
    for (int k = -1; k <= 1; k++) {
        assert_int_equal(
            fmb_body_make(3, FMB_BOX, (const double[]){0.5 + k * e, 0.125 + k * e, 0, 1, 0.25, 2},
                          6, &door),
            FMB_OK);
        struct fmb_placement pair[2] = {turning(&door, q0, q1),
                                        {.body = &post, .position = {-0.5, -0.5, 0}}};
        if (k == 0) {
            expect(pair, FMB_TOUCHING, 0, 2);
        } else {
            /* The corner moves in front of the post, or into it, while it turns. */
            struct fmb_answer answer;
            assert_int_equal(decide(pair, &answer), FMB_OK);
            assert_int_equal(answer.verdict, k > 0 ? FMB_SEPARATED : FMB_OVERLAPPING);
        }
    }
}

/* A cube that tumbles over an edge on the table. */
static void cubes_tumble_over_an_edge(void **state)
{
    static const double q0[4] = {1, 0, 0, 0}, q1[4] = {1, 0, 1, 0};
    struct resting rest;
    const double e = ldexp(1, -EPSILON_BITS);
    set_table(&rest);
    assert_int_equal(
        fmb_body_make(3, FMB_BOX, (const double[]){-0.5, 0, 0.5, 1, 1, 1}, 6, &rest.body[1]),
        FMB_OK);
    rest.placement[1] = turning(&rest.body[1], q0, q1);
    lift(&rest, 0, 0);
    expect(rest.placement, FMB_TOUCHING, 0, 2);
    lift(&rest, e, e);
    expect(rest.placement, FMB_SEPARATED, 0, 0);
    lift(&rest, -e, -e);
    expect(rest.placement, FMB_OVERLAPPING, 0, 2);
}

static void set_rounded(struct resting *rest, int f, const double *vertices, size_t numbers,
                        double radius)
{
    assert_int_equal(fmb_body_make_hull(3, vertices, numbers, rest->memory[f], &rest->body[f]),
                     FMB_OK);
    assert_int_equal(fmb_body_inflate(&rest->body[f], radius), FMB_OK);
}

/* Rounded bodies that yaw and slide: a ball, a capsule and a plate on a table, a ball on the edge
 * of the table, and a capsule on a capsule. A capsule also hangs on a post and grazes a ceiling. */
static void rounded_bodies_rest_and_hang(void **state)
{
    static const double rod[] = {-1, 0, 0, 1, 0, 0}, across[] = {0, -1, 0, 0, 1, 0};
    static const double post[] = {0, 0, -2, 0, 0, 2}, door[] = {0.5, 0, 0, 2, 0, 0};
    static const double plate[] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
    static const double back[4] = {3, 0, 0, -1}, forth[4] = {3, 0, 0, 1};
    const double e = ldexp(1, -EPSILON_BITS);
    struct resting rest;
    struct fmb_answer answer;
    set_table(&rest);
    set_rounded(&rest, 1, (const double[]){0, 0, 0}, 3, 0.5);
    expect_resting(&rest, 0.5);
    set_rounded(&rest, 1, (const double[]){0, 0, 0}, 3, 1.25);
    rest.placement[0].position[1] = -5.75; /* the edge is 3/4 beside the centre, and 1 below */
    rest.placement[0].position[2] = -1.5;
    expect_resting(&rest, 0);
    set_table(&rest);
    set_rounded(&rest, 1, rod, 6, 0.25);
    expect_resting(&rest, 0.25);
    set_rounded(&rest, 1, plate, 12, 0.125);
    expect_resting(&rest, 0.125);
    set_rounded(&rest, 0, rod, 6, 0.375);
    set_rounded(&rest, 1, across, 6, 0.125);
    rest.placement[0].position[2] = 0;
    rest.placement[1].position[0] = -0.5, rest.placement[1].end_position[0] = 0.5;
    expect_resting(&rest, 0.5);
    for (int k = -1; k <= 1; k++) {
        set_rounded(&rest, 0, post, 6, 0.25 - k * e);
        set_rounded(&rest, 1, door, 6, 0.25);
        rest.placement[1] = turning(&rest.body[1], back, forth);
        expect(rest.placement,
               k < 0    ? FMB_OVERLAPPING
               : k == 0 ? FMB_TOUCHING
                        : FMB_SEPARATED,
               0, 2);
        /* At half time, an end of the capsule is nearest to the ceiling. */
        box_of(8, 1, 8, &rest.body[0]);
        set_rounded(&rest, 1, across, 6, 0.5);
        rest.placement[0].position[1] = 2 + k * e;
        rest.placement[1] = turning(&rest.body[1], back, forth);
        assert_int_equal(decide(rest.placement, &answer), FMB_OK);
        assert_int_equal(answer.verdict, k < 0    ? FMB_OVERLAPPING
                                         : k == 0 ? FMB_TOUCHING
                                                  : FMB_SEPARATED);
        if (k <= 0)
            assert_true(answer.contact[0] <= 1 && answer.contact[1] >= 1);
        rest.placement[0].position[1] = 0;
    }
}

/* Two crossed capsules approach slowly while each turns about its own core, so that the direction
 * of the nearest points is fixed in neither. */
static void capsules_that_roll_approach_slowly(void **state)
{
    static const double rod[] = {-1, 0, 0, 1, 0, 0}, across[] = {0, -1, 0, 0, 1, 0};
    struct resting rest;
    set_rounded(&rest, 0, rod, 6, 0.25);
    set_rounded(&rest, 1, across, 6, 0.125);
    rest.placement[0] =
        turning(&rest.body[0], (const double[]){3, -1, 0, 0}, (const double[]){3, 1, 0, 0});
    rest.placement[1] =
        turning(&rest.body[1], (const double[]){3, 0, -1, 0}, (const double[]){3, 0, 2, 0});
    lift(&rest, 0.375 + 0x1p-20, 0.375 - 0x1p-30);
    expect(rest.placement, FMB_OVERLAPPING, 2 / (1 + 0x1p-10), 2);
    lift(&rest, 0.375 + 0x1p-20, 0.375 + 0x1p-40);
    expect(rest.placement, FMB_SEPARATED, 0, 0);
    lift(&rest, 0.375 + 0x1p-20, 0.375);
    expect(rest.placement, FMB_TOUCHING, 2, 2);
}

/* A point passes through a turning plate at an irrational time. The interiors meet then, and at no
 * time that the engine tests. */
static void a_point_through_a_turning_plate_is_never_called_touching(void **state)
{
    static const double q0[4] = {4, 0, 0, 0}, q1[4] = {4, 1, 0, 0};
    static const double plate_vertices[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    struct fmb_body plate, point;
    double memory[2][64];
    struct fmb_answer answer;
    assert_int_equal(fmb_body_make_hull(3, plate_vertices, 12, memory[0], &plate), FMB_OK);
    assert_int_equal(
        fmb_body_make_hull(3, (const double[]){0.25, 0.625, 0.125}, 3, memory[1], &point), FMB_OK);
    const struct fmb_placement pair[2] = {turning(&plate, q0, q1), {.body = &point}};
    assert_int_equal(decide(pair, &answer), FMB_CANNOT_DECIDE);
}

/* Two windows that share a pose both have the contact in that pose. */
static void windows_join(void **state)
{
    static const double q0[4] = {1, 0, 0, 0}, q1[4] = {3, 0, 0, 1}, q2[4] = {2, 1, 0, 1};
    struct resting rest;
    set_table(&rest);
    box_of(1, 1, 1, &rest.body[1]);
    rest.placement[1] = turning(&rest.body[1], q0, q1);
    lift(&rest, 1.5, 0.5);
    expect(rest.placement, FMB_TOUCHING, 2, 2);
    rest.placement[1] = turning(&rest.body[1], q1, q2);
    lift(&rest, 0.5, 2.5);
    struct fmb_answer answer;
    assert_int_equal(decide(rest.placement, &answer), FMB_OK);
    assert_true(answer.verdict != FMB_SEPARATED && answer.contact[0] == 0);
}

/* A straight motion given as an end has the same verdict as the velocity, and nearly the same
 * contact. */
static void straight_motion_as_an_end(void **state)
{
    uint64_t seed = 3;
    int counts[4] = {0};
    for (int k = 0; k < 300; k++) {
        double number[12];
        for (int i = 0; i < 12; i++) {
            seed = seed * UINT64_C(6364136223846793005) + 1442695040888963407;
            number[i] = (double) (seed >> 60) / 4 - 2;
        }
        struct fmb_body body[2];
        box_of(fabs(number[0]) + 0.5, fabs(number[1]) + 0.5, 1, &body[0]);
        box_of(1, 1, fabs(number[2]), &body[1]);
        struct fmb_placement pair[2] = {
            {.body = &body[0], .orientation_count = 4, .orientation = {2, 1, 0, 0}},
            {.body = &body[1], .position = {number[3], number[4], number[5]}}};
        struct fmb_answer by_end, by_velocity;
        memcpy(pair[1].velocity, &number[6], sizeof pair[1].velocity);
        assert_int_equal(decide(pair, &by_velocity), FMB_OK);
        for (int axis = 0; axis < 3; axis++) {
            pair[1].end_position[axis] = pair[1].position[axis] + 2 * pair[1].velocity[axis];
            pair[1].velocity[axis] = 0;
        }
        pair[1].end_count = 3;
        const enum fmb_status status = decide(pair, &by_end);
        if (status == FMB_CANNOT_DECIDE) { /* touches at one time */
            assert_int_equal(by_velocity.verdict, FMB_TOUCHING);
            counts[0]++;
            continue;
        }
        counts[by_end.verdict]++;
        assert_int_equal(by_end.verdict, by_velocity.verdict);
        for (int end = 0; end < 2 && by_end.has_contact; end++)
            assert_float_equal(by_end.contact[end], by_velocity.contact[end], 4e-12);
    }
    assert_true(counts[FMB_SEPARATED] > 30 && counts[FMB_OVERLAPPING] > 30 && counts[0] < 5);
}

/* A contact that ends with a graze. Its last time lies in intervals whose midpoints are not short
 * dyadic numbers. */
static void the_end_of_a_graze_is_that_of_exact_poses(void **state)
{
    static const double box[4] = {-0x1.ab199a5cf83c8p-2, -0x1.cc3bf00e29928p-1, 0x1.e6ef8a214a85p-4,
                                  0x1.633cfd9bb194p-3};
    static const double cuboid[6] = {-0x1.d2e7f418f419cp-2, 0x1.842eda4148c58p-3,
                                     -0x1.f66ed6d4490ep-4,  0x1.f3027ad4b8ec4p-2,
                                     -0x1.8f3ef82a7113p-4,  -0x1.e34d46ff0d22p-5};
    struct fmb_body a, b;
    assert_int_equal(fmb_body_make(2, FMB_BOX, box, 4, &a), FMB_OK);
    assert_int_equal(fmb_body_make(2, FMB_CUBOID, cuboid, 6, &b), FMB_OK);
    const struct fmb_placement pair[2] = {
        {.body = &a,
         .position = {0x1.94cb7112155cp-3, 0x1.67c406c148c6p-1},
         .orientation = {-0x1.16d6cc7c4c1e8p-2, 0x1.3dc331bdc738p-2},
         .orientation_count = 2},
        {.body = &b,
         .position = {-0x1.d60dd1725129bp-2, 0x1.8d00c39ee2443p+0},
         .orientation = {0x1.8a0300895ebd4p-3, 0x1.5d2aa27038048p-3},
         .orientation_count = 2,
         .end_position = {-0x1.94c4edf62e15dp+1, 0x1.8ce7eed478b7p+1},
         .end_orientation = {-0x1.70b845cfe432cp-2, 0x1.16836505e41aep-1},
         .end_count = 4}};
    struct fmb_answer answer;
    assert_int_equal(fmb_decide(fmb_method_default(), &pair[0], &pair[1], 1, 0, &answer), FMB_OK);
    assert_int_equal(answer.verdict, FMB_OVERLAPPING);
    /* In rational arithmetic, the frames part between these times. */
    assert_true(answer.contact[1] >= 0.2896245213189828);
    assert_true(answer.contact[1] <= 0.2896245213189829 + 1e-12);
}

/* Frames with a common centre overlap deeply, but the origin is often on the boundary of the
 * simplex with which a search ends. The depth is greatest when faces are parallel, or when squares
 * are turned by 45 degrees against each other. */
static void bodies_with_a_common_centre(void **state)
{
    static const struct {
        double size[2][3], orientation[2][4], height, depth;
    } known[] = {
        {{{1, 1, 1}, {1, 1, 1}}, {{1, 0, 0, 0}, {1, 0, 0, 1}}, 0, 1},
        {{{1, 1, 1}, {1, 1, 1}}, {{2, 0, 0, -1}, {2, 0, 0, 1}}, 0, 1},
        {{{1, 1, 1}, {1, 1, 1}}, {{1, 0, 0, 0}, {3, 1, 0, 0}}, 0, 1},
        {{{1, 1, 1}, {1, 1, 1}}, {{1, 0, 0, 0}, {1, 0, 0, 1}}, 0.25, 0.75},
        {{{2, 2, 2}, {1, 1, 1}}, {{1, 0, 0, 0}, {1, 0, 0, 1}}, 0, 1.5},
        {{{1, 1, 4}, {1, 1, 4}}, {{1, 0, 0, 0}, {1, 0, 0, 1}}, 0, 0.5 + 0x1.6a09e667f3bccp-1},
        {{{1, 1, 4}, {4, 1, 1}}, {{1, 0, 0, 0}, {1, 0, 0, 1}}, 0, 0.5 + 0x1.6a09e667f3bccp-1},
    };
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        struct resting rest;
        struct fmb_answer answer;
        for (int f = 0; f < 2; f++)
            box_of(known[k].size[f][0], known[k].size[f][1], known[k].size[f][2], &rest.body[f]);
        rest.placement[0] = (struct fmb_placement){.body = &rest.body[0]};
        rest.placement[1] =
            turning(&rest.body[1], known[k].orientation[0], known[k].orientation[1]);
        lift(&rest, known[k].height, known[k].height);
        expect(rest.placement, FMB_OVERLAPPING, 0, 2);
        assert_int_equal(fmb_decide(fmb_method_default(), &rest.placement[0], &rest.placement[1], 2,
                                    FMB_WANT_GAP, &answer),
                         FMB_OK);
        assert_true(answer.has_gap);
        assert_true(answer.gap.bounds[0] <= -known[k].depth + 0x1p-52);
        assert_true(answer.gap.bounds[1] >= -known[k].depth - 0x1p-52);
        assert_true(answer.gap.bounds[1] - answer.gap.bounds[0] <= 2e-12);
    }
}

/* A point moves on a circle and passes another point, which is some ulps off the circle. Points
 * have no edges: only the direction from point to point separates them. */
static void points_pass_each_other_closely(void **state)
{
    static const double end[] = {1, 0.9, 0.7};
    for (int k = 0; k < 6; k++) {
        struct resting rest;
        const double beside = k % 2 ? 1 - 0x1p-47 : 1 + 0x1p-47;
        const double at[2] = {0.6 * beside, 0.8 * beside};
        for (int f = 0; f < 2; f++)
            assert_int_equal(fmb_body_make_hull(2, f ? at : (const double[]){1, 0}, 2,
                                                rest.memory[f], &rest.body[f]),
                             FMB_OK);
        rest.placement[0] = (struct fmb_placement){.body = &rest.body[0],
                                                   .orientation = {1, 0},
                                                   .orientation_count = 2,
                                                   .end_orientation = {1, end[k / 2]},
                                                   .end_count = 4};
        rest.placement[1] = (struct fmb_placement){.body = &rest.body[1]};
        expect(rest.placement, FMB_SEPARATED, 0, 0);
    }
}

/* Scaling by a power of 2, from 2^-1000 to 2^900, keeps the verdict. */
static void numbers_of_any_size(void **state)
{
    static const double q0[4] = {1, 0, 0, 0}, q1[4] = {3, 0, 0, 1};
    struct resting rest;
    for (int exponent = -1000; exponent <= 900; exponent += 380) {
        const double scale = ldexp(1, exponent);
        box_of(10 * scale, 10 * scale, scale, &rest.body[0]);
        box_of(scale, scale, scale, &rest.body[1]);
        rest.placement[0] =
            (struct fmb_placement){.body = &rest.body[0], .position = {0, 0, -0.5 * scale}};
        rest.placement[1] = turning(&rest.body[1], q0, q1);
        lift(&rest, 0.5 * scale, 0.5 * scale);
        expect(rest.placement, FMB_TOUCHING, 0, 2);
        lift(&rest, 0.75 * scale, 0.75 * scale);
        expect(rest.placement, FMB_SEPARATED, 0, 2);
        lift(&rest, 0.25 * scale, 0.25 * scale);
        expect(rest.placement, FMB_OVERLAPPING, 0, 2);
    }
}

/* ---- Random bodies ---- */

static uint64_t seed_of_draw;

static int draw(int low, int high)
{
    seed_of_draw = seed_of_draw * UINT64_C(6364136223846793005) + 1442695040888963407;
    return low + (int) ((seed_of_draw >> 33) % (unsigned) (high - low + 1));
}

/* Draws a body of dimension dim. */
static void draw_body(int dim, double memory[400], struct fmb_body *out)
{
    double number[60];
    const int kind = draw(0, 3), vertices = draw(1, 16);
    for (int i = 0; i < 60; i++)
        number[i] = draw(-4, 4);
    enum fmb_status status;
    if (kind == 0)
        status = fmb_body_make(dim, FMB_BOX, (const double[]){fabs(number[0]) + 1, 3, 2},
                               (size_t) dim, out);
    else if (kind == 1)
        status =
            fmb_body_make_vertices(dim, FMB_TETRAHEDRON, number, (size_t) dim * (dim + 1u), out);
    else if (kind == 2 && dim == 3)
        status = fmb_body_make_vertices(3, FMB_FACE, number, 9, out);
    else
        status = fmb_body_make_hull(dim, number, (size_t) (dim * vertices), memory, out);
    assert_int_equal(status, FMB_OK);
    if (draw(0, 3) == 0)
        assert_int_equal(fmb_body_inflate(out, 0.25), FMB_OK);
}

static void draw_placement(const struct fmb_body *body, bool turns, struct fmb_placement *out)
{
    const int count = body->dim == 3 ? 4 : 2;
    do {
        *out = (struct fmb_placement){.body = body, .orientation_count = count};
        out->end_count = turns ? body->dim + count : 0;
        for (int i = 0; i < count; i++) {
            out->orientation[i] = draw(-3, 3);
            out->end_orientation[i] = draw(-3, 3);
        }
        for (int axis = 0; axis < body->dim; axis++) {
            out->position[axis] = 0.5 * draw(-7, 7);
            out->end_position[axis] = 0.5 * draw(-7, 7);
            out->velocity[axis] = turns ? 0 : 0.25 * draw(-2, 2);
        }
    } while (fmb_placement_check(out) != FMB_OK);
}

/* ---- Scenes ---- */

/* A scene in steps gives the answers of fmb_decide() for each pair, bit for bit. */
static void scenes_give_the_answers_of_single_pairs(void **state)
{
    enum { BODIES = 14 };
    const unsigned want = FMB_WANT_BOX | FMB_WANT_TIMES | FMB_WANT_GAP | FMB_WANT_POINT;
    static struct fmb_body body[BODIES];
    static struct fmb_frame parts[BODIES][2];
    static double memory[BODIES][400];
    struct fmb_placement placement[BODIES];
    unsigned pairs[BODIES * BODIES][2], count = 0;
    seed_of_draw = 5;
    for (unsigned i = 0; i < BODIES; i++) {
        draw_body(3, memory[i], &body[i]);
        if (i % 4 == 3) {
            parts[i][0] = body[i].one, parts[i][1] = body[i - 1].one;
            assert_int_equal(fmb_body_make_frames(parts[i], 2, &body[i]), FMB_OK);
        }
        draw_placement(&body[i], i % 3 > 0, &placement[i]);
        for (unsigned j = 0; j < i; j++, count++)
            pairs[count][0] = j, pairs[count][1] = i;
    }
    struct fmb_scene scene = {.placements = placement,
                              .placement_count = BODIES,
                              .duration = 2,
                              .want = want,
                              .which = FMB_PAIRS_LISTED,
                              .pairs = (const unsigned(*)[2]) pairs,
                              .pair_count = count};
    struct fmb_scene_limits limits;
    struct fmb_scene_answers answers;
    struct fmb_scene_state *scene_state;
    fmb_scene_limits_of(&scene, &limits);
    void *memory_of_scene = malloc(fmb_scene_bytes(&limits));
    assert_int_equal(fmb_scene_begin(&scene, &limits, memory_of_scene, &scene_state), FMB_OK);
    unsigned next = 0;
    for (bool done = false; !done;) {
        done = fmb_scene_step(scene_state, &answers);
        for (size_t k = 0; k < answers.count; k++, next++) {
            struct fmb_answer one, other;
            fmb_scene_answer(&answers, k, &other);
            const enum fmb_status status =
                fmb_decide(fmb_method_default(), &placement[pairs[next][0]],
                           &placement[pairs[next][1]], 2, want, &one);
            assert_int_equal(status == FMB_OK, other.verdict != 0);
            assert_memory_equal(&one, &other, sizeof one);
        }
    }
    assert_int_equal(next, count);
    free(memory_of_scene);
}

/* A scene of all pairs gives an answer for a pair without a verdict. */
static void pairs_without_a_verdict_are_named(void **state)
{
    static const double q0[4] = {4, 0, 0, 0}, q1[4] = {4, 1, 0, 0};
    static const double plate_vertices[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    struct fmb_body plate, point;
    double memory[2][64];
    assert_int_equal(fmb_body_make_hull(3, plate_vertices, 12, memory[0], &plate), FMB_OK);
    assert_int_equal(
        fmb_body_make_hull(3, (const double[]){0.25, 0.625, 0.125}, 3, memory[1], &point), FMB_OK);
    const struct fmb_placement pair[3] = {
        turning(&plate, q0, q1), {.body = &point}, {.body = &point, .position = {50, 0, 0}}};
    struct fmb_scene scene = {.placements = pair, .placement_count = 3, .duration = 1};
    struct fmb_scene_limits limits;
    struct fmb_scene_answers answers;
    struct fmb_scene_state *scene_state;
    size_t count = 0;
    fmb_scene_limits_of(&scene, &limits);
    void *memory_of_scene = malloc(fmb_scene_bytes(&limits));
    assert_int_equal(fmb_scene_begin(&scene, &limits, memory_of_scene, &scene_state), FMB_OK);
    for (bool done = false; !done; count += answers.count) {
        done = fmb_scene_step(scene_state, &answers);
        for (size_t k = 0; k < answers.count; k++)
            assert_true(answers.verdicts[k] == 0 && answers.pairs[k][0] + answers.pairs[k][1] == 1);
    }
    assert_int_equal(count, 1);
    free(memory_of_scene);
}

/* Numbers whose exponents span a thousand bits: both orders have the same answer, a query for the
 * gap has the same verdict, the bounds of the gap do not contradict it, and the computation ends.
 */
static void hostile_exponents_end(void **state)
{
    seed_of_draw = 9;
    for (int k = 0; k < 12; k++) {
        struct fmb_body body[2];
        struct fmb_placement pair[2];
        struct fmb_answer answer, swapped;
        for (int f = 0; f < 2; f++) {
            double number[12];
            for (int i = 0; i < 12; i++)
                number[i] = ldexp(draw(-9, 9), draw(-500, 500));
            assert_int_equal(fmb_body_make(3, FMB_CUBOID, number, 12, &body[f]), FMB_OK);
            draw_placement(&body[f], true, &pair[f]);
            for (int axis = 0; axis < 3; axis++)
                pair[f].end_position[axis] = ldexp(draw(-9, 9), draw(-500, 500));
        }
        const enum fmb_status status =
            fmb_decide(fmb_method_default(), &pair[0], &pair[1], 2, FMB_WANT_TIMES, &answer);
        assert_int_equal(
            fmb_decide(fmb_method_default(), &pair[1], &pair[0], 2, FMB_WANT_TIMES, &swapped),
            status);
        assert_memory_equal(&answer, &swapped, sizeof answer);
        assert_int_equal(
            fmb_decide(fmb_method_default(), &pair[0], &pair[1], 2, FMB_WANT_GAP, &answer), status);
        assert_int_equal(answer.verdict, swapped.verdict);
        assert_true(answer.has_gap == (status == FMB_OK));
        assert_true(answer.gap.bounds[0] <= answer.gap.bounds[1]);
        assert_true(answer.verdict == FMB_SEPARATED ? answer.gap.bounds[1] > 0
                                                    : answer.gap.bounds[0] <= 0);
    }
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(ends_have_to_be_poses_of_the_same_motion),
        cmocka_unit_test(poses_are_those_given_at_both_ends),
        cmocka_unit_test(an_end_needs_a_window),
        cmocka_unit_test(an_instant_takes_the_pose_at_the_beginning),
        cmocka_unit_test(boxes_contain_the_turning_body),
        cmocka_unit_test(bodies_that_yaw_and_slide_on_a_table),
        cmocka_unit_test(hulls_that_yaw_and_slide_on_a_table),
        cmocka_unit_test(edges_yaw_on_a_turning_hull),
        cmocka_unit_test(a_prism_that_touches_three_times_overlaps),
        cmocka_unit_test(a_flat_box_passes_closely),
        cmocka_unit_test(bodies_on_one_turntable),
        cmocka_unit_test(doors_hang_on_their_posts),
        cmocka_unit_test(cubes_tumble_over_an_edge),
        cmocka_unit_test(rounded_bodies_rest_and_hang),
        cmocka_unit_test(capsules_that_roll_approach_slowly),
        cmocka_unit_test(a_point_through_a_turning_plate_is_never_called_touching),
        cmocka_unit_test(windows_join),
        cmocka_unit_test(straight_motion_as_an_end),
        cmocka_unit_test(the_end_of_a_graze_is_that_of_exact_poses),
        cmocka_unit_test(bodies_with_a_common_centre),
        cmocka_unit_test(points_pass_each_other_closely),
        cmocka_unit_test(numbers_of_any_size),
        cmocka_unit_test(scenes_give_the_answers_of_single_pairs),
        cmocka_unit_test(pairs_without_a_verdict_are_named),
        cmocka_unit_test(hostile_exponents_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
