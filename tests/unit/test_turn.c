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
    /* 3 * 0.1 - 0.3 is 2^-54 in doubles: not at right angles, though it is by rounded arithmetic.
     */
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

/* In a window of 0 s: the pose at its beginning, in every answer. */
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

/* The box of a body over the window has all its poses. */
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

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(ends_have_to_be_poses_of_the_same_motion),
        cmocka_unit_test(poses_are_those_given_at_both_ends),
        cmocka_unit_test(an_end_needs_a_window),
        cmocka_unit_test(an_instant_takes_the_pose_at_the_beginning),
        cmocka_unit_test(boxes_contain_the_turning_body),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
