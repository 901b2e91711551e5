/* Pairs with a hull against the oracle, for other shapes: cuboids, boxes, tetrahedra and faces are
 * hulls of their vertices. */

#include "unit.h"

#include <float.h>
#include <math.h>

#include "family.h"
#include "oracle.h"
#include "programs.h"
#include "referee.h"
#include "support_decision.h"

/* Makes the body of a solid of one frame. Returns false if there are more, or numbers too large. */
static bool make_body(const struct solid *solid, struct fmb_body *out)
{
    double number[SOLID_NUMBERS_MAX];
    const size_t count = (size_t) solid_numbers(solid, number);
    if (solid_frames(solid) > 1)
        return false;
    return (solid->by_vertices
                ? fmb_body_make_vertices(solid->dim, (int) solid->shape, number, count, out)
                : fmb_body_make(solid->dim, (int) solid->shape, number, count, out)) == FMB_OK;
}

static void decide_in_integers(const struct frame_pair *frames, struct fmb_answer *out)
{
    struct support_pair pair;
    support_pair_set(frames, &pair);
    struct programs *programs = programs_begin(&pair, FMB_WANT_BOX | FMB_WANT_TIMES, NULL, 0);
    int steps = 0;
    while (!programs_step(programs))
        assert_true(++steps < 2000);
    programs_end(programs, out);
}

static double largest_coordinate(const struct frame_pair *frames)
{
    double largest = 0;
    for (int f = 0; f < 2; f++) {
        struct fmb_prepared prepared;
        double box[2][FMB_DIM_MAX];
        assert_int_equal(fmb_prepare((f ? frames->b : frames->a).placement, 0, 1, &prepared),
                         FMB_OK);
        fmb_box_of(&prepared, frames->duration, box);
        for (int k = 0; k < 2 * FMB_DIM_MAX; k++)
            largest = fmax(largest, fabs(box[k / FMB_DIM_MAX][k % FMB_DIM_MAX]));
    }
    return largest;
}

/* Whether an end is at most so far beyond the exact one, rounded outward. */
static bool is_close(double end, double exact, double sign, double limit)
{
    const double beyond = sign * (end - exact);
    return end == exact || (beyond >= 0 && beyond <= limit + 0x1p-1074);
}

static void check_within_limits(const struct frame_pair *frames, const struct fmb_answer *exact,
                                const struct fmb_answer *answer)
{
    const double largest = largest_coordinate(frames);
    assert_int_equal(answer->verdict, exact->verdict);
    assert_int_equal(answer->has_box, exact->verdict != FMB_SEPARATED);
    for (int end = 0; end < 2 && answer->has_box; end++) {
        const double sign = end ? 1 : -1;
        assert_true(
            is_close(answer->contact[end], exact->contact[end], sign, 1e-12 * frames->duration));
        assert_true(answer->contact[end] >= 0 && answer->contact[end] <= frames->duration);
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            assert_true(
                is_close(answer->box[end][axis], exact->box[end][axis], sign, 1e-12 * largest));
    }
}

static void check_search(const struct frame_pair *frames, enum fmb_verdict verdict)
{
    struct support_pair pair;
    struct support_nearest nearest;
    support_pair_set(frames, &pair);
    if (!pair.usable)
        return;
    const enum fmb_verdict found =
        support_search(&pair, support_separating_distance(&pair), &nearest);
    assert_true(found == 0 || found == verdict);
}

/* with_oracle: false saves the time of the oracle. */
static void check(const struct question *question, bool with_oracle)
{
    struct fmb_body a, b;
    if (!make_body(&question->a, &a) || !make_body(&question->b, &b))
        return;
    const struct fmb_placement at_a = solid_placement(&question->a, &a);
    const struct fmb_placement at_b = solid_placement(&question->b, &b);
    if (placements_check(&at_a, &at_b, question->duration) != FMB_OK)
        return;
    const struct frame_pair frames = {{&a.one, &at_a}, {&b.one, &at_b}, question->duration};
    const struct frame_pair swapped = {frames.b, frames.a, frames.duration};
    const struct pair pair = {at_a, at_b, question->duration};
    struct fmb_answer exact = {0}, certified, answer = {0}, other = {0};
    char why[200];
    decide_in_integers(&frames, &exact);
    if (with_oracle && !oracle_check_tightest(&pair, FMB_WANT_BOX, &exact, why, sizeof why))
        referee_fail(question, why);
    assert_int_equal(pair_decide(fmb_method_default(), &pair, 0, &certified), FMB_OK);
    assert_int_equal(certified.verdict, exact.verdict);
    check_search(&frames, exact.verdict);
    const unsigned want = FMB_WANT_BOX | FMB_WANT_TIMES;
    assert_int_equal(support_decide(&frames, want, SUPPORT_CERTIFIED, &answer), FMB_OK);
    assert_int_equal(support_decide(&swapped, want, SUPPORT_CERTIFIED, &other), FMB_OK);
    assert_memory_equal(&answer, &other, sizeof answer);
    check_within_limits(&frames, &exact, &answer);
}

static void other_shapes_as_hulls_have_the_same_answers(void **state)
{
    const long each = draw_sample(8);
    for (size_t f = 0; family_at(f); f++) {
        const struct family *family = family_at(f);
        struct cell cell[CELL_OF_ALL_SHAPES];
        const int cells = family_cells(family, cell);
        for (int c = 0; c < cells; c++) {
            struct draw draw = cell_draw(7, family->name, &cell[c], 0);
            for (long i = 0; i < each; i++) {
                struct question question;
                family_draw(family, &cell[c], &draw, &question);
                check(&question, i == 0);
            }
        }
    }
}

/* ---- By the public functions ---- */

enum { VERTICES = 64 };

struct hull {
    double vertices[3 * VERTICES], memory[4 * VERTICES];
    size_t count;
    struct fmb_body body;
};

static void make_hull(int dim, struct hull *hull)
{
    assert_int_equal(fmb_body_make_hull(dim, hull->vertices, hull->count * (size_t) dim,
                                        hull->memory, &hull->body),
                     FMB_OK);
}

static enum fmb_verdict verdict_of(const struct fmb_placement *a, const struct fmb_placement *b,
                                   double duration)
{
    struct fmb_answer answer, swapped, exact;
    const unsigned want = FMB_WANT_BOX;
    const struct fmb_method *method = fmb_method_default();
    assert_int_equal(fmb_decide(method, a, b, duration, want, &answer), FMB_OK);
    assert_int_equal(fmb_decide(method, b, a, duration, want, &swapped), FMB_OK);
    assert_memory_equal(&answer, &swapped, sizeof answer);
    assert_int_equal(fmb_decide(fmb_method_by_name("exact"), a, b, duration, want, &exact), FMB_OK);
    assert_int_equal(exact.verdict, answer.verdict);
    for (int end = 0; end < 2 && answer.has_box; end++)
        assert_true(
            is_close(answer.contact[end], exact.contact[end], end ? 1 : -1, 1e-12 * duration));
    return answer.verdict;
}

static void points_and_lines_meet(void **state)
{
    struct hull point = {{1, 2, 3}, {0}, 1, {0}}, same = point, other = {{1, 2, 4}, {0}, 1, {0}};
    struct hull segment = {{0, 2, 3, 2, 2, 3}, {0}, 2, {0}};
    make_hull(3, &point);
    make_hull(3, &same);
    make_hull(3, &other);
    make_hull(3, &segment);
    const struct fmb_placement p = {.body = &point.body}, q = {.body = &same.body};
    const struct fmb_placement r = {.body = &other.body}, s = {.body = &segment.body};
    const struct fmb_placement end = {.body = &point.body, .position = {1, 0, 0}};
    const struct fmb_placement by = {.body = &other.body, .velocity = {0, 0, -4}};
    assert_int_equal(verdict_of(&p, &q, 0), FMB_OVERLAPPING);
    assert_int_equal(verdict_of(&p, &r, 0), FMB_SEPARATED);
    assert_int_equal(verdict_of(&p, &s, 0), FMB_OVERLAPPING);
    assert_int_equal(verdict_of(&end, &s, 0), FMB_TOUCHING);
    /* A point that meets another one, or a segment, at a time within the window, or at its end. */
    assert_int_equal(verdict_of(&p, &by, 1), FMB_OVERLAPPING);
    assert_int_equal(verdict_of(&p, &by, 0.25), FMB_OVERLAPPING);
    assert_int_equal(verdict_of(&p, &by, 0.125), FMB_SEPARATED);
    assert_int_equal(verdict_of(&s, &by, 1), FMB_OVERLAPPING);
}

/* Plates in one plane that one of them leaves: they overlap at time 0 and at no other time. */
static void plates_that_part(void **state)
{
    struct hull plate = {{0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0, 1, 1, 0}, {0}, 5, {0}};
    make_hull(3, &plate);
    const struct fmb_placement still = {.body = &plate.body};
    struct fmb_placement leaves = {
        .body = &plate.body, .position = {1, 0, 0}, .velocity = {0, 0, 3}};
    assert_int_equal(verdict_of(&still, &leaves, 1), FMB_OVERLAPPING);
    leaves.velocity[0] = 1;
    assert_int_equal(verdict_of(&still, &leaves, 1), FMB_OVERLAPPING);
    leaves.position[2] = -1.5; /* passes through in the middle of the window */
    assert_int_equal(verdict_of(&still, &leaves, 1), FMB_OVERLAPPING);
    leaves.position[0] = 1.5; /* is beside it by then, edge at edge */
    assert_int_equal(verdict_of(&still, &leaves, 1), FMB_TOUCHING);
    leaves.position[0] = 1.75;
    assert_int_equal(verdict_of(&still, &leaves, 1), FMB_SEPARATED);
    leaves.position[2] = 0;
    leaves.position[0] = 2; /* at once, edge at edge */
    assert_int_equal(verdict_of(&still, &leaves, 1), FMB_TOUCHING);
}

/* In 2D a segment that leaves its line. */
static void segments_that_part(void **state)
{
    struct hull segment = {{0, 0, 2, 0}, {0}, 2, {0}};
    make_hull(2, &segment);
    const struct fmb_placement still = {.body = &segment.body};
    struct fmb_placement leaves = {.body = &segment.body, .position = {1}, .velocity = {0, 1}};
    assert_int_equal(verdict_of(&still, &leaves, 1), FMB_OVERLAPPING);
    leaves.position[0] = 2;
    assert_int_equal(verdict_of(&still, &leaves, 1), FMB_TOUCHING);
}

static void draw_hull(struct draw *draw, int dim, int most, size_t count, struct hull *out)
{
    out->count = count;
    for (size_t i = 0; i < count; i++)
        draw_integers(draw, dim, -most, most, out->vertices + i * (size_t) dim);
    make_hull(dim, out);
}

/* The same pair with coordinates near the largest double has the same answer, times 2^1022. */
static void expect_huge(const struct fmb_placement *a, const struct fmb_placement *b,
                        double duration, const struct fmb_answer *answer)
{
    const double unit = 0x1p1022;
    struct hull hull[2];
    struct fmb_placement at[2] = {*a, *b};
    struct fmb_answer huge;
    for (int f = 0; f < 2; f++) {
        const struct fmb_frame *frame = fmb_body_frame(at[f].body, 0);
        bool by_vertices;
        hull[f].count = frame->vertex_count;
        const size_t numbers =
            fmb_frame_numbers(frame, &by_vertices, hull[f].vertices, COUNT(hull[f].vertices));
        for (size_t i = 0; i < numbers; i++)
            hull[f].vertices[i] *= unit;
        make_hull(frame->dim, &hull[f]);
        at[f].body = &hull[f].body;
        for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
            at[f].position[axis] *= unit;
            at[f].velocity[axis] *= unit;
        }
    }
    verdict_of(&at[0], &at[1], duration);
    fmb_decide(fmb_method_by_name("exact"), &at[0], &at[1], duration, FMB_WANT_BOX, &huge);
    assert_int_equal(huge.verdict, answer->verdict);
    assert_memory_equal(huge.contact, answer->contact, sizeof huge.contact);
    for (int k = 0; k < 2 * FMB_DIM_MAX; k++) {
        const int end = k / FMB_DIM_MAX, axis = k % FMB_DIM_MAX;
        assert_true(huge.box[end][axis] == answer->box[end][axis] * unit);
    }
}

/* The answer depends on the set alone: not on the order of the vertices, on repeated ones, or on
 * those inside. */
static void the_list_of_vertices_does_not_matter(void **state)
{
    struct draw draw;
    draw_begin(&draw, "lists of vertices");
    for (long turn = 0; turn < draw_sample(3000); turn++) {
        const int dim = draw_int(&draw, 2, 3), most = draw_int(&draw, 1, 3);
        struct hull a, b, longer;
        draw_hull(&draw, dim, most, (size_t) draw_int(&draw, 1, 7), &a);
        draw_hull(&draw, dim, most, (size_t) draw_int(&draw, 1, 7), &b);
        longer.count = 3 * a.count;
        for (size_t i = 0; i < longer.count; i++)
            for (size_t axis = 0; axis < (size_t) dim; axis++) {
                const double *v = a.vertices + (a.count - 1 - i % a.count) * (size_t) dim;
                const double *w = a.vertices + i / 3 * (size_t) dim;
                longer.vertices[i * (size_t) dim + axis] =
                    i < 2 * a.count ? v[axis] : 0.5 * (v[axis] + w[axis]);
            }
        make_hull(dim, &longer);
        struct fmb_placement at_a = {.body = &a.body}, at_b = {.body = &b.body};
        draw_integers(&draw, dim, -most, most, at_b.position);
        if (draw_coin(&draw))
            draw_integers(&draw, dim, -most, most, at_b.velocity);
        struct fmb_placement at_longer = at_a;
        at_longer.body = &longer.body;
        const double duration = draw_coin(&draw) ? 1 : 0.5;
        struct fmb_answer one, other;
        const struct fmb_method *exact = fmb_method_by_name("exact");
        fmb_decide(exact, &at_a, &at_b, duration, FMB_WANT_BOX, &one);
        fmb_decide(exact, &at_longer, &at_b, duration, FMB_WANT_BOX, &other);
        assert_memory_equal(&one, &other, sizeof one);
        verdict_of(&at_longer, &at_b, duration);
        expect_huge(&at_a, &at_b, duration, &one);
    }
}

/* Makes two hulls of random points in the unit ball, and moves the second one by up to 1 on each
 * axis. */
static void draw_pair(struct draw *draw, size_t count, struct hull hull[2],
                      struct fmb_placement at[2])
{
    for (int f = 0; f < 2; f++) {
        hull[f].count = count;
        for (size_t i = 0; i < count; i++) {
            double *v = hull[f].vertices + 3 * i;
            do {
                for (int axis = 0; axis < 3; axis++)
                    v[axis] = draw_uniform(draw, -1, 1);
            } while (v[0] * v[0] + v[1] * v[1] + v[2] * v[2] > 1);
        }
        make_hull(3, &hull[f]);
        at[f] = (struct fmb_placement){.body = &hull[f].body};
    }
    for (int axis = 0; axis < 3; axis++)
        at[1].position[axis] = draw_uniform(draw, -1, 1);
}

/* Doubles give the points of nearly all random overlaps at rest. Without support_widen() they give
 * two of three points, and the linear programs compute the others. */
static void doubles_give_the_points_of_overlaps(void **state)
{
    struct draw draw;
    int overlaps = 0, given = 0;
    draw_begin(&draw, "points of overlaps");
    for (int turn = 0; turn < 1000; turn++) {
        struct hull hull[2];
        struct fmb_placement at[2];
        draw_pair(&draw, turn % 2 ? 16 : VERTICES, hull, at);
        const struct frame_pair frames = {
            {&hull[0].body.one, &at[0]}, {&hull[1].body.one, &at[1]}, 0};
        struct fmb_answer answer;
        if (support_decide(&frames, 0, SUPPORT_QUICK, &answer) != FMB_OK ||
            answer.verdict != FMB_OVERLAPPING)
            continue;
        overlaps++;
        given += support_decide(&frames, FMB_WANT_POINT, SUPPORT_QUICK, &answer) == FMB_OK;
    }
    assert_true(overlaps > 500);
    assert_in_range(given, 0.95 * overlaps, overlaps);
}

static void inexact_methods_refuse_hulls(void **state)
{
    struct hull solid = {{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, {0}, 4, {0}};
    make_hull(3, &solid);
    const struct fmb_placement at = {.body = &solid.body};
    struct fmb_answer answer;
    assert_int_equal(fmb_decide(fmb_method_by_name("fmb"), &at, &at, 0, 0, &answer),
                     FMB_CANNOT_DECIDE);
    assert_int_equal(fmb_decide(fmb_method_by_name("sat"), &at, &at, 0, 0, &answer),
                     FMB_CANNOT_DECIDE);
}

/* Puts two cubes onto each other in a computed tilt: doubles do not decide them. */
static void rest_in_a_tilt(struct draw *draw, struct hull cube[2], struct fmb_placement at[2])
{
    double q[4], square = 0;
    for (int k = 0; k < 4; k++) {
        q[k] = draw_uniform(draw, 0.1, 1);
        square += q[k] * q[k];
    }
    for (int f = 0; f < 2; f++) {
        cube[f].count = 8;
        for (int i = 0; i < 24; i++)
            cube[f].vertices[i] = i / 3 >> i % 3 & 1;
        make_hull(3, &cube[f]);
        at[f] = (struct fmb_placement){.body = &cube[f].body, .orientation_count = 4};
        memcpy(at[f].orientation, q, sizeof q);
    }
    at[1].position[0] = (q[0] * q[0] + q[1] * q[1] - q[2] * q[2] - q[3] * q[3]) / square;
    at[1].position[1] = 2 * (q[1] * q[2] + q[0] * q[3]) / square;
    at[1].position[2] = 2 * (q[1] * q[3] - q[0] * q[2]) / square;
}

/* A scene that is abandoned within an exact decision frees its memory (which a sanitizer checks).
 */
static void a_scene_may_be_abandoned(void **state)
{
    struct draw draw;
    draw_begin(&draw, "abandoned");
    for (int steps = 1; steps < 20; steps++) {
        struct hull cube[2];
        struct fmb_placement at[2];
        struct fmb_scene_state *scene_state;
        struct fmb_scene_answers answers;
        rest_in_a_tilt(&draw, cube, at);
        const struct fmb_scene scene = {
            .placements = at, .placement_count = 2, .want = FMB_WANT_BOX | FMB_WANT_TIMES};
        struct fmb_scene_limits limits;
        fmb_scene_limits_of(&scene, &limits);
        void *memory = malloc(fmb_scene_bytes(&limits));
        assert_int_equal(fmb_scene_begin(&scene, &limits, memory, &scene_state), FMB_OK);
        for (int i = 0; i < steps && !fmb_scene_step(scene_state, &answers); i++)
            ;
        fmb_scene_end(scene_state);
        free(memory);
    }
}

/* A batch and a scene give the bits of single pairs. */
static void batch_and_scene_agree_with_single_pairs(void **state)
{
    enum { BODIES = 40 };
    static struct hull hull[BODIES];
    static struct fmb_placement placement[BODIES];
    struct draw draw;
    draw_begin(&draw, "batch");
    for (int i = 0; i < BODIES; i++) {
        draw_hull(&draw, 3, 3, (size_t) draw_int(&draw, 1, 20), &hull[i]);
        placement[i] = (struct fmb_placement){.body = &hull[i].body};
        draw_integers(&draw, 3, -6, 6, placement[i].position);
        draw_integers(&draw, 3, -1, 1, placement[i].velocity);
        if (draw_coin(&draw)) {
            placement[i].orientation_count = 4;
            for (int k = 0; k < 4; k++)
                placement[i].orientation[k] = draw_uniform(&draw, 0.1, 1);
        }
    }
    for (int i = 0; i < BODIES / 2; i += 2)
        rest_in_a_tilt(&draw, &hull[i], &placement[i]);
    const struct fmb_scene scene = {.placements = placement,
                                    .placement_count = BODIES,
                                    .duration = 1,
                                    .want = FMB_WANT_BOX | FMB_WANT_TIMES};
    struct fmb_scene_limits limits;
    fmb_scene_limits_of(&scene, &limits);
    void *memory = malloc(fmb_scene_bytes(&limits));
    struct fmb_scene_state *scene_state;
    struct fmb_scene_answers answers;
    static bool met[BODIES][BODIES];
    assert_int_equal(fmb_scene_begin(&scene, &limits, memory, &scene_state), FMB_OK);
    for (bool done = false; !done;) {
        done = fmb_scene_step(scene_state, &answers);
        for (size_t k = 0; k < answers.count; k++) {
            const unsigned a = answers.pairs[k][0], b = answers.pairs[k][1];
            struct fmb_answer answer;
            fmb_decide(fmb_method_default(), &placement[a], &placement[b], 1, FMB_WANT_BOX,
                       &answer);
            assert_int_equal(answer.verdict, answers.verdicts[k]);
            assert_memory_equal(answer.contact, answers.contacts[k], sizeof answer.contact);
            assert_memory_equal(answer.box, answers.boxes[k], sizeof answer.box);
            met[a][b] = true;
        }
    }
    free(memory);
    for (unsigned a = 0; a < BODIES; a++)
        for (unsigned b = a + 1; b < BODIES; b++) {
            struct fmb_prepared prepared[2];
            enum fmb_verdict verdict;
            fmb_prepare(&placement[a], 0, 1, &prepared[0]);
            fmb_prepare(&placement[b], 0, 1, &prepared[1]);
            assert_int_equal(fmb_decide_prepared(&prepared[0], &prepared[1], 1, &verdict), FMB_OK);
            assert_int_equal(verdict == FMB_SEPARATED, !met[a][b]);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(other_shapes_as_hulls_have_the_same_answers),
        cmocka_unit_test(points_and_lines_meet),
        cmocka_unit_test(plates_that_part),
        cmocka_unit_test(segments_that_part),
        cmocka_unit_test(the_list_of_vertices_does_not_matter),
        cmocka_unit_test(doubles_give_the_points_of_overlaps),
        cmocka_unit_test(inexact_methods_refuse_hulls),
        cmocka_unit_test(a_scene_may_be_abandoned),
        cmocka_unit_test(batch_and_scene_agree_with_single_pairs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
