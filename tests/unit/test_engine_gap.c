/* Gaps: each enclosure is checked in rational numbers, by code that shares nothing with the engine.
 */

#include "unit.h"

#include <float.h>
#include <math.h>

#include "draw.h"
#include "family.h"
#include "fmb_batch.h"
#include "gap_check.h"
#include "gmp_allocations.h"
#include "pair_draw.h"
#include "question.h"
#include "referee.h"

/* ---- Margins ---- */

/* The pairs of placements that a scene with a margin reports; gaps: capacity for all pairs. */
static int near_pairs(const struct fmb_placement *placement, unsigned count, double duration,
                      double margin, struct fmb_gap *gaps)
{
    const struct fmb_scene scene = {.placements = placement,
                                    .placement_count = count,
                                    .duration = duration,
                                    .instant = duration == 0,
                                    .which = FMB_PAIRS_ALL,
                                    .margin = margin};
    struct fmb_scene_limits limits;
    fmb_scene_limits_of(&scene, &limits);
    void *memory = malloc(fmb_scene_bytes(&limits));
    struct fmb_scene_state *running;
    struct fmb_scene_answers answers;
    int found = 0;
    assert_int_equal(fmb_scene_begin(&scene, &limits, memory, &running), FMB_OK);
    for (bool done = false; !done;) {
        done = fmb_scene_step(running, &answers);
        for (size_t k = 0; k < answers.count; k++)
            gaps[found++] = answers.gaps[k];
    }
    free(memory);
    return found;
}

/* A scene whose margin is the lower bound of a distance reports the pair, with the same gap; one
 * whose margin is less does not. */
static void check_margin(const struct pair *pair, const struct fmb_answer *answer)
{
    const struct fmb_placement placement[2] = {pair->a, pair->b};
    const double bound = answer->gap.bounds[0];
    struct fmb_gap near;
    if (answer->verdict != FMB_SEPARATED || !(bound > 0 && bound <= DBL_MAX))
        return;
    assert_int_equal(near_pairs(placement, 2, pair->duration, bound, &near), 1);
    assert_memory_equal(near.bounds, answer->gap.bounds, sizeof near.bounds);
    assert_int_equal(near_pairs(placement, 2, pair->duration, nextafter(bound, 0), &near), 0);
}

/* ---- Queries ---- */

static struct fmb_answer decide(const struct question *question, const char *method)
{
    struct ready ready;
    struct fmb_answer answer;
    referee_ready(question, &ready);
    assert_int_equal(
        pair_decide(fmb_method_by_name(method), &ready.pair, FMB_WANT_GAP | FMB_WANT_BOX, &answer),
        FMB_OK);
    return answer;
}

/* The gap of a method, in both orders. */
static struct fmb_answer check_by(const struct question *question, const char *method)
{
    struct ready ready;
    char why[200] = "";
    const struct question swapped = question_swapped(question);
    const struct fmb_answer answer = decide(question, method);
    const struct fmb_answer other = decide(&swapped, method);
    referee_ready(question, &ready);
    if (!answer.has_gap || !gap_check(&ready.pair, answer.verdict, &answer.gap, why, sizeof why)) {
        print_message("%s: %s, verdict %d, [%.17g, %.17g] along %.17g %.17g %.17g\n", method, why,
                      (int) answer.verdict, answer.gap.bounds[0], answer.gap.bounds[1],
                      answer.gap.direction[0], answer.gap.direction[1], answer.gap.direction[2]);
        referee_fail(question, why);
    }
    for (int f = 0; f < 2 && question->a.dim == 2; f++)
        assert_true(answer.gap.direction[2] == 0 && answer.gap.witness[f][2] == 0);
    if (!gap_check_swapped(question_is_symmetric(question), &answer.gap, &other.gap))
        referee_fail(question, "the other way round");
    return answer;
}

static struct fmb_answer check(const struct question *question)
{
    struct ready ready;
    const struct fmb_answer answer = check_by(question, "certified");
    check_by(question, "exact");
    referee_ready(question, &ready);
    check_margin(&ready.pair, &answer);
    return answer;
}

/* ---- Bodies ---- */

static struct fmb_answer gap_of_pair(const struct pair *pair)
{
    struct fmb_answer answer;
    assert_int_equal(pair_decide(fmb_method_default(), pair, FMB_WANT_GAP, &answer), FMB_OK);
    return answer;
}

static struct fmb_frame frame_of(int shape, const double *numbers)
{
    struct fmb_frame frame;
    const size_t count = shape == FMB_BOX ? 6 : 12;
    assert_int_equal(fmb_frame_make(3, shape, numbers, count, &frame), FMB_OK);
    return frame;
}

static struct fmb_body body_of(const struct fmb_frame *frames, size_t count)
{
    struct fmb_body body;
    assert_int_equal(fmb_body_make_frames(frames, count, &body), FMB_OK);
    return body;
}

/* ---- Random ---- */

typedef double number_function(struct draw *draw);

static double whole(struct draw *draw)
{
    return draw_int(draw, -3, 3);
}

static double any(struct draw *draw)
{
    return draw_uniform(draw, -1, 1);
}

static double wide(struct draw *draw)
{
    return draw_log(draw, -30, 5);
}

static void draw_vector(struct draw *draw, int dim, number_function *number, double *out)
{
    for (int axis = 0; axis < dim; axis++)
        out[axis] = number(draw);
}

static struct solid draw_solid(struct draw *draw, int dim, number_function *number)
{
    struct solid solid = {.dim = dim, .shape = question_draw_shape(draw, dim)};
    if (draw_int(draw, 0, 3) == 0)
        solid.shape = FMB_BOX;
    for (int i = 0; i < solid_count(&solid); i++)
        if (solid.shape == FMB_BOX)
            solid.component[i][i] = fabs(number(draw));
        else
            draw_vector(draw, dim, number, solid.component[i]);
    draw_vector(draw, dim, number, solid.origin);
    draw_vector(draw, dim, number, solid.velocity);
    if (draw_coin(draw))
        draw_vector(draw, dim, number, solid.local);
    solid.orientation_count = draw_coin(draw) ? 0 : dim == 3 ? 4 : 2;
    while (solid.orientation_count && solid.orientation[0] == 0 && solid.orientation[1] == 0 &&
           solid.orientation[2] == 0 && solid.orientation[3] == 0)
        draw_vector(draw, solid.orientation_count, number == wide ? any : number,
                    solid.orientation);
    const double length = draw_coin(draw) ? 1 : ldexp(1, draw_int(draw, -400, 400));
    for (int i = 0; i < solid.orientation_count; i++)
        solid.orientation[i] *= length;
    return solid;
}

static struct question draw_question(struct draw *draw)
{
    static number_function *const numbers[] = {whole, any, any, wide};
    const int dim = draw_coin(draw) ? 3 : 2;
    number_function *number = numbers[draw_int(draw, 0, (int) COUNT(numbers) - 1)];
    struct question question = {draw_solid(draw, dim, number), draw_solid(draw, dim, number), 1};
    question_draw_movers(draw, &question);
    if (draw_coin(draw))
        for (int axis = 0; axis < dim; axis++)
            question.b.origin[axis] += number(draw);
    question.duration = draw_int(draw, 0, 2) ? 1 : draw_uniform(draw, 0, 3);
    return question;
}

/* Every length times a power of two, rounded where it is subnormal. */
static void scale_lengths(struct solid *solid, int exponent)
{
    double(*lengths[])[FMB_DIM_MAX] = {solid->component, solid->component + 1, solid->component + 2,
                                       &solid->origin,   &solid->velocity,     &solid->local};
    for (size_t i = 0; i < COUNT(lengths); i++)
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            (*lengths[i])[axis] = ldexp((*lengths[i])[axis], exponent);
}

/* Where 1e-12 of the lengths is less than the least double, the bounds are a few of the least
 * doubles apart, and no farther than fmb.h states. */
static void widths_near_the_least_doubles(void **state)
{
    struct draw draw;
    double widest = 0;
    draw_begin(&draw, "widths_near_the_least_doubles");
    for (long i = draw_sample(1000); i > 0; i--) {
        struct question question = draw_question(&draw);
        const int exponent = draw_int(&draw, -1078, -1040);
        scale_lengths(&question.a, exponent);
        scale_lengths(&question.b, exponent);
        const struct fmb_gap gap = check(&question).gap;
        widest = fmax(widest, (gap.bounds[1] - gap.bounds[0]) / 0x1p-1074);
    }
    print_message("at most %g of the least doubles wide\n", widest);
    assert_true(widest > 8);
}

static void random_pairs(void **state)
{
    struct draw draw;
    int verdicts[4] = {0};
    draw_begin(&draw, "random_pairs");
    for (long i = draw_sample(2000); i > 0; i--) {
        const struct question question = draw_question(&draw);
        verdicts[check(&question).verdict]++;
    }
    print_message("%d separated, %d touching, %d overlapping\n", verdicts[1], verdicts[2],
                  verdicts[3]);
    assert_true(verdicts[1] > 0 && verdicts[2] > 0 && verdicts[3] > 0);
}

/* Nearly all: integers take a hundred times longer. */
static void random_pairs_need_no_integers(void **state)
{
    struct draw draw;
    long integers = 0, count = draw_sample(2000);
    draw_begin(&draw, "random_pairs_need_no_integers");
    for (long i = 0; i < count; i++) {
        struct question question = {draw_solid(&draw, 3, any), draw_solid(&draw, 3, any), 1};
        question_draw_movers(&draw, &question);
        question.b.origin[0] += i % 3;
        const long before = gmp_allocations;
        decide(&question, "certified");
        integers += gmp_allocations != before;
    }
    print_message("%ld of %ld by integers\n", integers, count);
    assert_true(100 * integers <= count);
}

/* Pairs in 3D brought to a depth of 1e-3 by shifts along the direction of the gap, so that every
 * kind of facet, and each pair of edges, is the nearest of some. */
static void shallow_pairs(void **state)
{
    struct draw draw;
    int shallow = 0;
    draw_begin(&draw, "shallow_pairs");
    for (long n = draw_sample(6000); n > 0; n--) {
        struct question question = {draw_solid(&draw, 3, any), draw_solid(&draw, 3, any), 1};
        question_draw_movers(&draw, &question);
        question.b.origin[0] += 3;
        for (int round = 0; round < 3; round++) {
            const struct fmb_gap now = decide(&question, "certified").gap;
            for (int axis = 0; axis < 3; axis++)
                question.b.origin[axis] += (-1e-3 - now.bounds[0]) * now.direction[axis];
        }
        const double gap = check_by(&question, "certified").gap.bounds[0];
        shallow += gap < -0.99e-3 && gap > -1.01e-3;
    }
    print_message("%d of depth 1e-3\n", shallow);
    assert_true(shallow > 0);
}

/* ---- Hard families ---- */

static void hard_families(void **state)
{
    struct draw draw;
    draw_begin(&draw, "hard_families");
    for (size_t f = 0; family_at(f); f++) {
        struct cell cells[CELL_OF_ALL_SHAPES];
        for (int i = family_cells(family_at(f), cells) - 1; i >= 0; i--)
            for (long n = draw_sample(6); n > 0; n--) {
                struct question question;
                family_draw(family_at(f), &cells[i], &draw, &question);
                check(&question);
            }
    }
}

/* Numbers of all exponents, up to the ends of the doubles. */
static void all_exponents(void **state)
{
    struct draw draw;
    draw_begin(&draw, "all_exponents");
    for (long n = draw_sample(600); n > 0; n--) {
        struct question question;
        const struct cell cell = pair_draw_cell(&draw);
        if (draw_coin(&draw)) {
            pair_draw_stretched(&draw, &cell, &question);
        } else {
            question = draw_question(&draw);
            struct solid *solid[2] = {&question.a, &question.b};
            for (int s = 0; s < 2; s++)
                for (int axis = 0; axis < question.a.dim; axis++) {
                    if (draw_coin(&draw))
                        solid[s]->origin[axis] = draw_finite(&draw);
                    if (draw_coin(&draw))
                        solid[s]->component[axis % solid_count(solid[s])][axis] =
                            fabs(draw_finite(&draw));
                }
        }
        check(&question);
    }
}

/* ---- Small whole numbers: the truth is known ---- */

static void check_distance(const struct question *question, const struct fmb_answer *answer)
{
    struct ready ready;
    mpq_t square, bound;
    mpq_inits(square, bound, NULL);
    referee_ready(question, &ready);
    gap_check_distance(&ready.pair, square);
    for (int end = 0; end < 2; end++) {
        mpq_set_d(bound, fmax(answer->gap.bounds[end], 0));
        mpq_mul(bound, bound, bound);
        const int order = mpq_cmp(bound, square);
        if (end ? order < 0 : order > 0)
            referee_fail(question, "the distance is not within the bounds");
    }
    mpq_clears(square, bound, NULL);
}

static void small_worlds(void **state)
{
    struct draw draw;
    int separated = 0;
    draw_begin(&draw, "small_worlds");
    for (long n = draw_sample(300); n > 0; n--) {
        const int dim = draw_int(&draw, 0, 3) ? 2 : 3;
        struct question question = {draw_solid(&draw, dim, whole), draw_solid(&draw, dim, whole),
                                    1};
        question_draw_movers(&draw, &question);
        for (int axis = 0; axis < dim; axis++)
            question.b.origin[axis] += draw_int(&draw, -5, 5);
        const struct fmb_answer answer = check(&question);
        if (answer.verdict != FMB_SEPARATED)
            continue;
        separated++;
        check_distance(&question, &answer);
    }
    assert_true(separated > 5);
}

static struct solid unit_cube(double x, double y, double z)
{
    struct solid cube = {.dim = 3, .shape = FMB_BOX, .origin = {x, y, z}};
    for (int i = 0; i < 3; i++)
        cube.component[i][i] = 1;
    return cube;
}

/* Of cubes along the axes the gap is known by name. */
static void known_gaps(void **state)
{
    static const struct {
        double at[3], gap;
        int verdict;
    } cases[] = {
        {{3, 0, 0}, 2, FMB_SEPARATED},
        {{4, 5, 0}, 5, FMB_SEPARATED},
        {{2, 3, 3}, 3, FMB_SEPARATED},
        {{1, 0.5, 0}, 0, FMB_TOUCHING},
        {{1, 1, 1}, 0, FMB_TOUCHING},
        {{0.75, 0, 0}, -0.25, FMB_OVERLAPPING},
        {{0.5, 0.125, 0}, -0.5, FMB_OVERLAPPING},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        const double *at = cases[i].at;
        const struct question question = {unit_cube(0, 0, 0), unit_cube(at[0], at[1], at[2]), 0};
        const struct fmb_answer answer = check(&question);
        assert_int_equal(answer.verdict, cases[i].verdict);
        assert_true(answer.gap.bounds[0] <= cases[i].gap && cases[i].gap <= answer.gap.bounds[1]);
        const struct fmb_answer certified = decide(&question, "certified");
        if (cases[i].gap < 3) /* no root */
            assert_true(certified.gap.bounds[0] == certified.gap.bounds[1]);
    }
}

static bool holds(const struct question *question, const struct fmb_answer *answer,
                  const struct fmb_gap *gap)
{
    struct ready ready;
    char why[200];
    referee_ready(question, &ready);
    return gap_check(&ready.pair, answer->verdict, gap, why, sizeof why);
}

/* What is wrong by little is not taken for proven. */
static void wrong_gaps_are_refused(void **state)
{
    struct question question = {unit_cube(0, 0, 0), unit_cube(4, 5, 0), 0};
    const struct fmb_answer apart = check(&question);
    struct fmb_gap gap = apart.gap;
    gap.bounds[0] = 5 + 1e-13;
    assert_false(holds(&question, &apart, &gap));
    gap = apart.gap;
    gap.bounds[1] = 5 - 1e-13;
    assert_false(holds(&question, &apart, &gap));
    gap = apart.gap;
    gap.bounds[0] -= 1e-11;
    assert_false(holds(&question, &apart, &gap));
    gap = apart.gap;
    gap.direction[0] = -gap.direction[0];
    assert_false(holds(&question, &apart, &gap));
    for (int side = 0; side < 2; side++) {
        gap = apart.gap;
        gap.witness[side][1] += side ? -1e-12 : 1e-12;
        assert_false(holds(&question, &apart, &gap));
    }
    question.b = unit_cube(0.75, 0.5, 0);
    const struct fmb_answer deep = check(&question);
    for (int end = 0; end < 2; end++) {
        gap = deep.gap;
        gap.bounds[end] = -0.25 + (end ? -1e-13 : 1e-13);
        assert_false(holds(&question, &deep, &gap));
    }
    question.b = unit_cube(1, 0.5, 0);
    const struct fmb_answer touching = check(&question);
    gap = touching.gap;
    gap.direction[0] = -1;
    assert_false(holds(&question, &touching, &gap));
    gap = touching.gap;
    gap.bounds[1] = 1e-300;
    assert_false(holds(&question, &touching, &gap));
}

/* Of bodies of several frames: the gap of frames that are not the nearest. */
static void gaps_of_other_frames_are_refused(void **state)
{
    struct fmb_frame frame[2];
    struct fmb_body row, cube;
    struct fmb_answer answer;
    char why[200];
    static const double one[6] = {0, 0, 0, 1, 1, 1}, nearer[6] = {0.5, 0, 0, 1, 1, 1};
    assert_int_equal(fmb_frame_make(3, FMB_BOX, one, 6, &frame[0]), FMB_OK);
    assert_int_equal(fmb_frame_make(3, FMB_BOX, nearer, 6, &frame[1]), FMB_OK);
    assert_int_equal(fmb_body_make_frames(frame, 2, &row), FMB_OK);
    assert_int_equal(fmb_body_make_frames(frame, 1, &cube), FMB_OK);
    for (int deep = 0; deep < 2; deep++) {
        struct pair pair = {
            {.body = &row}, {.body = &cube, .position = {deep ? 1.25 : 3, 0.125, 0}}, 0};
        assert_int_equal(pair_decide(fmb_method_default(), &pair, FMB_WANT_GAP, &answer), FMB_OK);
        assert_true(gap_check(&pair, answer.verdict, &answer.gap, why, sizeof why));
        pair.a.body = &cube;
        pair.a.position[0] = deep ? 0.375 : 0;
        assert_int_equal(pair_decide(fmb_method_default(), &pair, FMB_WANT_GAP, &answer), FMB_OK);
        pair.a.body = &row;
        pair.a.position[0] = 0;
        assert_false(gap_check(&pair, answer.verdict, &answer.gap, why, sizeof why));
        assert_non_null(strstr(why, "nearer than the lower bound"));
    }
}

/* ---- Close ---- */

static void turn_any(struct draw *draw, struct solid *solid)
{
    solid->orientation_count = solid->dim == 3 ? 4 : 2;
    draw_vector(draw, solid->orientation_count, any, solid->orientation);
}

/* Moves b along the direction of the gap until that is target, nearly. */
static void bring_close(struct question *question, double target)
{
    for (int step = 0; step < 2; step++) {
        const struct fmb_gap gap = decide(question, "exact").gap;
        for (int axis = 0; axis < question->a.dim; axis++)
            question->b.origin[axis] -= (gap.bounds[0] - target) * gap.direction[axis];
    }
}

/* Features of every kind next to each other, at distances down to those of rounding. */
static void near_contact(void **state)
{
    static const double targets[] = {1e-3, 1e-9, 1e-13, 0, -1e-9, -1e-3};
    struct draw draw;
    draw_begin(&draw, "near_contact");
    for (long n = draw_sample(600); n > 0; n--) {
        struct question question = draw_question(&draw);
        for (int axis = 0; axis < question.a.dim; axis++)
            question.b.origin[axis] += draw_int(&draw, -4, 4);
        if (draw_coin(&draw)) { /* parallel faces and edges, but for rounding */
            turn_any(&draw, &question.a);
            question.b.orientation_count = question.a.orientation_count;
            memcpy(question.b.orientation, question.a.orientation, sizeof question.b.orientation);
        }
        bring_close(&question, targets[draw_int(&draw, 0, (int) COUNT(targets) - 1)]);
        if (draw_int(&draw, 0, 3) == 0) {
            question.a.origin[0] += 1e12;
            question.b.origin[0] += 1e12;
        }
        check(&question);
    }
}

/* Boxes that lie on each other, turned against each other by less and less. */
static void nearly_parallel(void **state)
{
    struct draw draw;
    draw_begin(&draw, "nearly_parallel");
    for (long n = draw_sample(600); n > 0; n--) {
        struct question question = {unit_cube(0, 0, 0), unit_cube(0, 0, 0), 1};
        const double height = draw_coin(&draw) ? 1 + 1e-9 : 1 - 1e-9;
        const double angle = draw_log(&draw, -60, 0);
        for (int i = 0; i < 3; i++)
            question.b.component[i][i] = draw_uniform(&draw, 0.5, 2);
        if (draw_int(&draw, 0, 3) == 0)
            question.b.shape = FMB_TETRAHEDRON;
        question.b.origin[0] = draw_uniform(&draw, -0.5, 0.5);
        question.b.origin[2] =
            0.5 + (question.b.shape == FMB_BOX ? 0.5 * question.b.component[2][2] : 0) * height;
        if (draw_coin(&draw)) { /* about its own axis, or nearly */
            question.b.orientation_count = 4;
            question.b.orientation[0] = 1;
            question.b.orientation[3] = angle;
            question.b.orientation[1] = draw_coin(&draw) ? 0 : draw_log(&draw, -60, -20);
        }
        if (draw_coin(&draw)) {
            question.b.moving = true;
            draw_vector(&draw, 3, any, question.b.velocity);
            question.b.velocity[draw_int(&draw, 0, 2)] *= draw_log(&draw, -60, 0);
        }
        check(&question);
    }
}

/* ---- Batches ---- */

enum { FRAMES = 64, PAIRS = 500 };

static void batches_give_the_same(void **state)
{
    static struct fmb_body body[FRAMES];
    static struct fmb_placement placement[FRAMES];
    static struct fmb_prepared prepared[FRAMES];
    static unsigned pairs[PAIRS][2];
    static unsigned char verdicts[PAIRS];
    static struct fmb_gap gaps[PAIRS];
    static double contacts[PAIRS][2], boxes[PAIRS][2][FMB_DIM_MAX];
    struct draw draw;
    draw_begin(&draw, "batches_give_the_same");
    for (long n = draw_sample(24); n > 0; n--) {
        size_t open[PAIRS], open_count = 0;
        for (unsigned i = 0; i < FRAMES; i += 2) {
            struct question question = draw_question(&draw);
            const struct solid *solid[2] = {&question.a, &question.b};
            for (unsigned s = 0; s < 2; s++) {
                double number[SOLID_NUMBERS_MAX];
                const int count = solid_numbers(solid[s], number);
                assert_int_equal(fmb_body_make(solid[s]->dim, solid[s]->shape, number,
                                               (size_t) count, &body[i + s]),
                                 FMB_OK);
                placement[i + s] = solid_placement(solid[s], &body[i + s]);
                assert_int_equal(fmb_prepare(&placement[i + s], 0, 1, &prepared[i + s]), FMB_OK);
            }
        }
        for (int k = 0; k < PAIRS; k++)
            for (int side = 0; side < 2; side++)
                pairs[k][side] = (unsigned) draw_int(&draw, 0, FRAMES - 1);
        struct fmb_batch batch = {.frames = prepared,
                                  .frame_count = FRAMES,
                                  .pairs = (const unsigned(*)[2]) pairs,
                                  .pair_count = PAIRS,
                                  .duration = draw_int(&draw, 0, 2),
                                  .verdicts = verdicts,
                                  .gaps = gaps};
        batch.instant = batch.duration == 0;
        batch.contacts = draw_coin(&draw) ? contacts : NULL;
        batch.boxes = draw_coin(&draw) ? boxes : NULL;
        if (draw_coin(&draw)) {
            batch.open = open;
            batch.open_count = &open_count;
        }
        fmb_decide_batch(&batch);
        for (size_t k = 0; k < open_count; k++) {
            struct fmb_batch one = batch;
            assert_int_equal(verdicts[open[k]], 0);
            assert_true(isnan(gaps[open[k]].bounds[0]));
            one.pairs += open[k];
            one.pair_count = 1;
            one.verdicts += open[k];
            one.gaps += open[k];
            one.contacts = NULL;
            one.boxes = NULL;
            one.open = one.open_count = NULL;
            assert_int_equal(fmb_decide_batch(&one), FMB_OK);
        }
        for (int k = 0; k < PAIRS; k++) {
            struct fmb_answer answer;
            const enum fmb_status status =
                fmb_decide(fmb_method_default(), &placement[pairs[k][0]], &placement[pairs[k][1]],
                           batch.duration, FMB_WANT_GAP, &answer);
            if (status != FMB_OK) {
                assert_int_equal(verdicts[k], 0);
                assert_true(isnan(gaps[k].bounds[0]) && isnan(gaps[k].bounds[1]));
                continue;
            }
            assert_int_equal(verdicts[k], answer.verdict);
            assert_true(gap_check_same(&gaps[k], &answer.gap));
        }
    }
}

/* ---- Bodies of several frames ---- */

enum { ROW = 40 };

static void draw_row(struct draw *draw, int dim, struct fmb_frame frame[ROW], struct fmb_body *out)
{
    const int count = draw_int(draw, 2, ROW);
    for (int i = 0; i < count; i++) {
        struct solid solid = draw_solid(draw, dim, draw_coin(draw) ? whole : any);
        double number[SOLID_NUMBERS_MAX];
        solid.local[0] += i;
        const int numbers = solid_numbers(&solid, number);
        assert_int_equal(fmb_frame_make(dim, solid.shape, number, (size_t) numbers, &frame[i]),
                         FMB_OK);
    }
    assert_int_equal(fmb_body_make_frames(frame, (size_t) count, out), FMB_OK);
}

/* The bounds are proven by frames of theirs, and no pair of frames has a gap below them. */
static void check_bodies(const struct pair *pair)
{
    struct fmb_answer answer, other;
    assert_int_equal(pair_decide(fmb_method_default(), pair, FMB_WANT_GAP, &answer), FMB_OK);
    const struct pair swapped = {pair->b, pair->a, pair->duration};
    assert_int_equal(pair_decide(fmb_method_default(), &swapped, FMB_WANT_GAP, &other), FMB_OK);
    assert_true(gap_check_swapped(false, &answer.gap, &other.gap));
    check_margin(pair, &answer);
    assert_int_equal(answer.gap.frame[0], other.gap.frame[1]);
    assert_int_equal(answer.gap.frame[1], other.gap.frame[0]);
    bool lower = false, upper = false;
    for (unsigned i = 0; i < pair->a.body->frame_count; i++)
        for (unsigned j = 0; j < pair->b.body->frame_count; j++) {
            struct pair one = *pair;
            struct fmb_body body[2];
            struct fmb_answer of_one;
            assert_int_equal(fmb_body_make_frames(&pair->a.body->frames[i], 1, &body[0]), FMB_OK);
            assert_int_equal(fmb_body_make_frames(&pair->b.body->frames[j], 1, &body[1]), FMB_OK);
            one.a.body = &body[0];
            one.b.body = &body[1];
            assert_int_equal(pair_decide(fmb_method_default(), &one, FMB_WANT_GAP, &of_one),
                             FMB_OK);
            assert_true(answer.gap.bounds[0] <= of_one.gap.bounds[1]);
            assert_true(answer.gap.bounds[1] <= of_one.gap.bounds[1]);
            if (i == answer.gap.frame[0] && j == answer.gap.frame[1]) /* the pair that is named */
                upper = (answer.gap.bounds[1] == of_one.gap.bounds[1] &&
                         (answer.gap.bounds[1] == 0 || gap_check_upper(pair, i, j, &answer.gap)));
            lower = lower ||
                    (answer.gap.bounds[0] >= of_one.gap.bounds[0] &&
                     (answer.verdict == FMB_TOUCHING || gap_check_lower(pair, i, j, &answer.gap)));
        }
    assert_true(lower && upper);
}

/* Of pairs of frames with one gap, the same is named in both orders, and by a scene. */
static void equal_gaps_name_one_pair_of_frames(void **state)
{
    static const double at[3] = {0, 4, 8}, cube[6] = {0, 0, 0, 1, 1, 1};
    struct fmb_frame frame[2][3];
    struct fmb_body body[2];
    struct fmb_placement placement[2] = {{.body = &body[0]}, {.body = &body[1]}};
    for (int s = 0; s < 2; s++) { /* the second row in the opposite order */
        for (int i = 0; i < 3; i++) {
            double numbers[6];
            memcpy(numbers, cube, sizeof cube);
            numbers[0] = at[s ? 2 - i : i];
            assert_int_equal(fmb_frame_make(3, FMB_BOX, numbers, 6, &frame[s][i]), FMB_OK);
        }
        assert_int_equal(fmb_body_make_frames(frame[s], 3, &body[s]), FMB_OK);
    }
    placement[1].position[1] = 3;
    const struct pair pair = {placement[0], placement[1], 0};
    const struct pair swapped = {placement[1], placement[0], 0};
    struct fmb_answer answer, other;
    assert_int_equal(pair_decide(fmb_method_default(), &pair, FMB_WANT_GAP, &answer), FMB_OK);
    assert_int_equal(pair_decide(fmb_method_default(), &swapped, FMB_WANT_GAP, &other), FMB_OK);
    assert_true(answer.gap.bounds[0] == 2 && answer.gap.bounds[1] == 2);
    assert_int_equal(answer.gap.frame[0] + answer.gap.frame[1], 2);
    assert_int_equal(answer.gap.frame[0], other.gap.frame[1]);
    assert_int_equal(answer.gap.frame[1], other.gap.frame[0]);
}

static void bodies_of_several_frames(void **state)
{
    static struct fmb_frame frame[2][ROW];
    struct draw draw;
    int verdicts[4] = {0};
    draw_begin(&draw, "bodies_of_several_frames");
    for (long n = draw_sample(120); n > 0; n--) {
        const int dim = draw_int(&draw, 2, 3);
        struct fmb_body body[2];
        struct pair pair = {{.body = &body[0]}, {.body = &body[1]}, 1};
        for (int s = 0; s < 2; s++) {
            draw_row(&draw, dim, frame[s], &body[s]);
            struct fmb_placement *placement = s ? &pair.b : &pair.a;
            draw_vector(&draw, dim, whole, placement->position);
            placement->position[1] *= 6;
            if (draw_coin(&draw))
                draw_vector(&draw, dim, any, placement->velocity);
            if (draw_coin(&draw)) {
                placement->orientation_count = dim == 3 ? 4 : 2;
                draw_vector(&draw, placement->orientation_count, any, placement->orientation);
            }
        }
        struct fmb_answer answer;
        assert_int_equal(pair_decide(fmb_method_default(), &pair, 0, &answer), FMB_OK);
        verdicts[answer.verdict]++;
        check_bodies(&pair);
    }
    assert_true(verdicts[FMB_SEPARATED] > 0 && verdicts[FMB_OVERLAPPING] > 0);
}

/* ---- Ties ---- */

/* Boxes around a unit cube, on each side of each axis, at the same distance or a few ulps farther.
 * Which of them gives the direction and the points depends neither on the order of the frames nor
 * on that of the bodies. */
static void ties_do_not_depend_on_any_order(void **state)
{
    enum { SIDES = 6 };
    static const double cube[6] = {0, 0, 0, 1, 1, 1};
    struct draw draw;
    draw_begin(&draw, "ties_do_not_depend_on_any_order");
    const struct fmb_frame middle = frame_of(FMB_BOX, cube);
    const struct fmb_body a = body_of(&middle, 1);
    for (long n = draw_sample(400); n > 0; n--) {
        struct fmb_frame frame[SIDES];
        struct fmb_gap first;
        const bool ulps = draw_coin(&draw);
        const int turned = draw_int(&draw, 0, 2);
        for (int side = 0; side < SIDES; side++) {
            double at[6] = {0, 0, 0, 1, 1, 1};
            at[side / 2] = (side % 2 ? -1 : 1) * (2 + (ulps ? draw_int(&draw, 0, 3) * 0x1p-51 : 0));
            frame[side] = frame_of(FMB_BOX, at);
        }
        struct pair pair = {.a = {.body = &a}};
        if (turned > 0) {
            pair.a.orientation_count = 4;
            draw_vector(&draw, 4, turned == 1 ? whole : any, pair.a.orientation);
            pair.a.orientation[0] += 5;
        }
        pair.b = pair.a;
        for (int order = 0; order < 6; order++) {
            for (int i = SIDES - 1; i > 0; i--) {
                const int j = draw_int(&draw, 0, i);
                const struct fmb_frame moved = frame[i];
                frame[i] = frame[j];
                frame[j] = moved;
            }
            const struct fmb_body b = body_of(frame, SIDES);
            pair.b.body = &b;
            const struct pair swapped = {pair.b, pair.a, 0};
            const struct fmb_gap gap = gap_of_pair(&pair).gap, other = gap_of_pair(&swapped).gap;
            assert_true(gap_check_swapped(false, &gap, &other));
            if (order == 0)
                first = gap;
            assert_true(gap_check_same(&first, &gap));
        }
    }
}

/* Unit cubes with equal depths along several axes, at rest and moving along z: one of the axes is
 * the direction, always the same. */
static void equal_depths_have_one_direction(void **state)
{
    static const struct {
        const char *method;
        double offset, speed, expected[3];
    } cases[] = {{"certified", 0.5, 0, {1, 0, 0}}, {"certified", 0, 0, {1, 0, 0}},
                 {"certified", 0.5, 1, {1, 0, 0}}, {"certified", 0, 1, {-1, 0, 0}},
                 {"exact", 0.5, 0, {0, 0, 1}},     {"exact", 0, 0, {-1, 0, 0}},
                 {"exact", 0.5, 1, {0, 1, 0}},     {"exact", 0, 1, {0, 0, 1}}};
    for (size_t i = 0; i < COUNT(cases); i++) {
        const double at = cases[i].offset;
        struct question question = {unit_cube(0, 0, 0), unit_cube(at, at, at), 1};
        question.b.moving = true;
        question.b.velocity[2] = cases[i].speed;
        const struct fmb_gap gap = check_by(&question, cases[i].method).gap;
        assert_memory_equal(gap.direction, cases[i].expected, sizeof gap.direction);
    }
}

/* ---- Raised bounds ---- */

/* Tetrahedra that face each other along an axis, each body with a second one farther away. The
 * boxes give a better lower bound than the frames. It is proven too, although their distance
 * rounds. */
static void bounds_of_boxes_are_proven(void **state)
{
    struct draw draw;
    draw_begin(&draw, "bounds_of_boxes_are_proven");
    for (long n = draw_sample(300); n > 0; n--) {
        struct fmb_frame frame[2][2];
        struct fmb_body body[2];
        for (int s = 0; s < 2; s++) {
            const double out = s ? 1 : -1;
            for (int i = 0; i < 2; i++) {
                const double number[12] = {
                    out * (draw_uniform(&draw, 0, 1) + 3 * i), 0, 0, 0, 1, 0, 0, 0, 1, out, 0, 0};
                frame[s][i] = frame_of(FMB_TETRAHEDRON, number);
            }
            body[s] = body_of(frame[s], 2);
        }
        const struct pair pair = {.a = {.body = &body[0]}, .b = {.body = &body[1]}};
        check_bodies(&pair);
    }
}

/* ---- Margins ---- */

/* Tetrahedra that face each other along an axis at a small distance. Their boxes give it more
 * accurately than the gap, but the margin is compared with the lower bound of the gap. */
static void a_margin_is_compared_with_the_lower_bound(void **state)
{
    struct draw draw;
    draw_begin(&draw, "a_margin_is_compared_with_the_lower_bound");
    for (long n = draw_sample(300); n > 0; n--) {
        const double unit = draw_coin(&draw) ? 1 : 0x1p-1055;
        struct fmb_frame frame[2][2];
        struct fmb_body body[2];
        struct fmb_placement placement[2] = {{.body = &body[0]}, {.body = &body[1]}};
        const int axis = draw_int(&draw, 0, 2);
        for (int s = 0; s < 2; s++) {
            const double out = s ? 1 : -1;
            double number[12] = {0, 0, 0, 0, 1, 0, 0, 0, 1, out, 0, 0};
            for (int i = 0; i < 4; i++) { /* x to the axis */
                const double x = number[3 * i];
                number[3 * i] = number[3 * i + axis];
                number[3 * i + axis] = x;
            }
            number[axis] = draw_uniform(&draw, 0, 0x1p-10) + s * 0x1p-10;
            for (int i = 0; i < 12; i++)
                number[i] *= unit;
            frame[s][0] = frame[s][1] = frame_of(FMB_TETRAHEDRON, number);
            body[s] = body_of(frame[s], draw_int(&draw, 1, 2));
        }
        const struct pair pair = {placement[0], placement[1], 0};
        const struct fmb_answer answer = gap_of_pair(&pair);
        assert_true(answer.gap.bounds[0] > 0);
        check_margin(&pair, &answer);
    }
}

/* A body beside itself: frames near the origin of the body have the gap more accurately than those
 * far from it, whose enclosure alone reaches the margin. */
static void frames_within_the_width_of_others_count(void **state)
{
    struct draw draw;
    draw_begin(&draw, "frames_within_the_width_of_others_count");
    for (long n = draw_sample(100); n > 0; n--) {
        struct fmb_frame frame[2];
        for (int i = 0; i < 2; i++) {
            const double number[6] = {i * 0x1p20, 0, 0, 1, 1, 1};
            frame[i] = frame_of(FMB_BOX, number);
        }
        const struct fmb_body body = body_of(frame, 2);
        struct fmb_placement placement[2] = {{.body = &body, .orientation_count = 4}};
        for (int k = 0; k < 4; k++)
            placement[0].orientation[k] = draw_uniform(&draw, 0.1, 1);
        placement[1] = placement[0];
        for (int axis = 0; axis < 3; axis++)
            placement[1].position[axis] = draw_uniform(&draw, 2, 3);
        const struct pair pair = {placement[0], placement[1], 0};
        const struct fmb_gap gap = gap_of_pair(&pair).gap;
        const double margin = gap.bounds[1] - 0x1p-31;
        struct fmb_gap near;
        assert_true(gap.bounds[0] < margin);
        assert_int_equal(near_pairs(placement, 2, 0, margin, &near), 1);
        assert_memory_equal(near.bounds, gap.bounds, sizeof gap.bounds);
    }
}

/* 96 cubes in rows, each with an orientation of its own that libm computes from a quarter turn, so
 * that none is exactly one: neighbours are near or overlap by rounding, and all of them are found.
 */
static void cubes_rolled_by_libm(void **state)
{
    enum { SIDE = 4, LENGTH = 6, CUBES = SIDE * SIDE * LENGTH };
    static struct fmb_placement placement[CUBES];
    static struct fmb_gap gaps[CUBES * (CUBES - 1) / 2];
    struct fmb_body cube;
    static const double size[3] = {1, 1, 1};
    assert_int_equal(fmb_body_make(3, FMB_BOX, size, 3, &cube), FMB_OK);
    for (int i = 0; i < CUBES; i++) {
        const double angle = (i % 4) * acos(-1) / 2;
        const int axis = 1 + i % 3;
        placement[i] = (struct fmb_placement){
            .body = &cube,
            .position = {i % SIDE, i / SIDE % SIDE, (double) (i / (SIDE * SIDE))},
            .orientation = {cos(angle / 2)},
            .orientation_count = 4};
        placement[i].orientation[axis] = sin(angle / 2);
    }
    int neighbours = 0;
    const int found = near_pairs(placement, CUBES, 0, 1e-9, gaps);
    for (int k = 0; k < found; k++)
        assert_true(gaps[k].bounds[0] > -1e-12 && gaps[k].bounds[1] < 1e-12);
    for (int i = 0; i < CUBES; i++)
        for (int j = 0; j < i; j++) {
            bool near = true;
            for (int axis = 0; axis < 3; axis++)
                near = near && fabs(placement[i].position[axis] - placement[j].position[axis]) <= 1;
            neighbours += near;
        }
    assert_int_equal(found, neighbours);
}

static void inexact_methods_have_none(void **state)
{
    const struct question question = {unit_cube(0, 0, 0), unit_cube(3, 0, 0), 0};
    struct ready ready;
    struct fmb_answer answer;
    referee_ready(&question, &ready);
    for (size_t i = 0; fmb_method_at(i); i++) {
        const struct fmb_method *method = fmb_method_at(i);
        assert_int_equal(pair_decide(method, &ready.pair, FMB_WANT_GAP, &answer),
                         method->certain ? FMB_OK : FMB_CANNOT_DECIDE);
        assert_true(answer.has_gap == method->certain);
        assert_int_equal(pair_decide(method, &ready.pair, 0, &answer), FMB_OK);
        assert_false(answer.has_gap);
        assert_true(answer.gap.bounds[1] == 0);
    }
}

/* Gaps beyond the largest double. */
static void infinite_gaps(void **state)
{
    struct question question = {unit_cube(-DBL_MAX, 0, 0), unit_cube(DBL_MAX, 0, 0), 0};
    assert_true(check(&question).gap.bounds[0] == INFINITY);
    question.a.origin[0] = 0;
    assert_true(isfinite(check(&question).gap.bounds[0]));
    for (int side = 0; side < 2; side++) { /* witness points beyond the doubles */
        struct solid *solid = side ? &question.b : &question.a;
        solid->origin[0] = solid->local[0] = DBL_MAX;
        solid->origin[1] = side ? 1e300 : 0;
    }
    const struct fmb_answer far = check(&question);
    struct fmb_gap gap = far.gap;
    assert_true(isinf(gap.witness[0][0]) && isfinite(gap.bounds[1]));
    gap.bounds[0] = gap.bounds[1] = 0.99e300;
    assert_false(holds(&question, &far, &gap));
}

/* ---- Single cases ---- */

/* Three frames equally far from one: direction and points are those of the same two. */
static void direction_and_points_belong_together(void **state)
{
    static const double at[4][6] = {
        {0, 0, 0, 1, 1, 1}, {2, 0, 0, 1, 1, 1}, {0, -2, 0, 1, 1, 1}, {0, 0, 2, 1, 1, 1}};
    struct draw draw;
    draw_begin(&draw, "direction_and_points_belong_together");
    struct fmb_frame frame[4];
    for (int i = 0; i < 4; i++)
        frame[i] = frame_of(FMB_BOX, at[i]);
    const struct fmb_body a = body_of(frame, 1), b = body_of(frame + 1, 3);
    for (int i = 0; i < 500; i++) {
        struct pair pair = {.a = {.body = &a, .orientation_count = 4}};
        draw_vector(&draw, 4, any, pair.a.orientation);
        pair.b = pair.a;
        pair.b.body = &b;
        const struct fmb_gap gap = gap_of_pair(&pair).gap;
        double along = 0;
        for (int axis = 0; axis < 3; axis++)
            along += gap.direction[axis] * (gap.witness[1][axis] - gap.witness[0][axis]);
        assert_true(along > 1 - 1e-9);
    }
}

/* One pair of frames touches, another is separated by less than doubles see. */
static void touching_bodies_have_no_gap(void **state)
{
    static const double of_a[2][12] = {{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1},
                                       {10.5, 0.5, 0.5, 1, 1, 1}};
    static const double of_b[2][12] = {
        {1. / 3, 1. / 3, 1. / 3 + 0x1p-51, 1, 0, 0, 0, 1, 0, 0, 0, 1}, {11.5, 0.5, 0.5, 1, 1, 1}};
    const struct fmb_frame a[2] = {frame_of(FMB_TETRAHEDRON, of_a[0]), frame_of(FMB_BOX, of_a[1])};
    const struct fmb_frame b[2] = {frame_of(FMB_CUBOID, of_b[0]), frame_of(FMB_BOX, of_b[1])};
    const struct fmb_body body_a = body_of(a, 2), body_b = body_of(b, 2);
    const struct pair pair = {.a = {.body = &body_a}, .b = {.body = &body_b}};
    const struct fmb_answer answer = gap_of_pair(&pair);
    assert_int_equal(answer.verdict, FMB_TOUCHING);
    assert_true(answer.gap.bounds[0] == 0 && answer.gap.bounds[1] == 0);
}

/* Frames at the same position whose numbers differ but round to the same: boxes by their centres,
 * simplices by their vertices. */
static void frames_equal_after_rounding_have_an_order(void **state)
{
    static const double centre[2] = {0x1p-60, 0x1p-59};
    for (int shape = 0; shape < 2; shape++) {
        struct fmb_frame frame[2];
        struct fmb_body body[2];
        for (int s = 0; s < 2; s++) {
            const double c = centre[s], at[6] = {c, c, c, 1, 1, 1};
            const double vertex[12] = {-1, -1, -1, c, -1, -1, -1, c, -1, -1, -1, c};
            frame[s] = frame_of(FMB_BOX, at);
            if (shape == 1)
                assert_int_equal(fmb_frame_make_vertices(3, FMB_TETRAHEDRON, vertex, 12, &frame[s]),
                                 FMB_OK);
            body[s] = body_of(&frame[s], 1);
        }
        assert_memory_equal(frame[0].component, frame[1].component, sizeof frame[0].component);
        assert_memory_equal(frame[0].origin, frame[1].origin, sizeof frame[0].origin);
        const struct pair pair = {.a = {.body = &body[0]}, .b = {.body = &body[1]}};
        const struct pair swapped = {pair.b, pair.a, 0};
        const struct fmb_gap gap = gap_of_pair(&pair).gap, other = gap_of_pair(&swapped).gap;
        assert_true(gap_check_swapped(false, &gap, &other));
    }
}

/* Bodies that share a frame, at the same place: the other frames determine the order of the pair.
 */
static void a_shared_frame_has_an_order(void **state)
{
    static const double at[2][6] = {{0, 0, 0, 2, 1, 1.5}, {0.1, 0.2, 0.3, 0.5, 0.25, 0.125}};
    const struct fmb_frame frame[2] = {frame_of(FMB_BOX, at[0]), frame_of(FMB_BOX, at[1])};
    const struct fmb_body a = body_of(frame, 1), b = body_of(frame, 2);
    const struct pair pair = {.a = {.body = &a}, .b = {.body = &b}};
    const struct pair swapped = {.a = {.body = &b}, .b = {.body = &a}};
    const struct fmb_gap one = gap_of_pair(&pair).gap, other = gap_of_pair(&swapped).gap;
    assert_true(gap_check_swapped(false, &one, &other));
}

/* Squares of normals of tiny edges underflow. */
static void tiny_edges(void **state)
{
    struct draw draw;
    draw_begin(&draw, "tiny_edges");
    for (int e = 30; e <= 49; e++)
        for (int i = 0; i < 10; i++) {
            const double s = 0x1p-199, tiny = ldexp(1 + draw_uniform(&draw, 0, 1), -e);
            struct question question = {
                {.dim = 3,
                 .shape = FMB_TETRAHEDRON,
                 .component = {{s, 0, 0},
                               {s, 0, s * 0x1.8p-49},
                               {s * (1 - 0x1p-10), s * draw_uniform(&draw, 1, 1.1), s * 0.1}}},
                {.dim = 3,
                 .shape = FMB_TETRAHEDRON,
                 .origin = {s * draw_uniform(&draw, 1.9, 2), s * 0.5, -s * 0.5},
                 .component = {{-s, 0, 0},
                               {-s, s * 0x1p-49 * tiny, s * 0x1.4p-49},
                               {-s * (1 - 0x1p-10), s * 0.1, s * draw_uniform(&draw, 1, 1.1)}}},
                0};
            check(&question);
        }
}

/* A tetrahedron with a short edge, an edge of another across it, and both turned: the products of
 * the short edge, from those of the components that it is the difference of, are noise. */
static void short_edges(void **state)
{
    struct draw draw;
    draw_begin(&draw, "short_edges");
    for (long n = draw_sample(60); n > 0; n--) {
        const double width = 0x1p-28, depth = 0x1p-31;
        const double y = draw_uniform(&draw, -0.1, 0.1), z = draw_uniform(&draw, 0.9, 1.1);
        struct question question = {
            .a = {.dim = 3,
                  .shape = FMB_TETRAHEDRON,
                  .component = {{-0.25 - width / 2, -1, -z},
                                {-0.25 + width / 2, -1, -z},
                                {draw_uniform(&draw, -0.6, -0.4), -2,
                                 draw_uniform(&draw, -0.2, 0.2)}},
                  .local = {0.25, 1, z}},
            .b = {.dim = 3,
                  .shape = FMB_TETRAHEDRON,
                  .component = {{0, 2, 0}, {1, 1 + y, -1}, {-1, 1, -z}},
                  .local = {0, -1, depth}},
        };
        draw_vector(&draw, 4, any, question.a.orientation);
        question.a.orientation_count = question.b.orientation_count = 4;
        memcpy(question.b.orientation, question.a.orientation, sizeof question.b.orientation);
        check(&question);
    }
}

/* Squares of products of the longest edges overflow, and those of others do not. */
static void long_edges(void **state)
{
    const struct question question = {
        {.dim = 3, .shape = FMB_BOX, .component = {{0x1p199}, {0, 0x1p199}, {0, 0, 0x1p120}}},
        {.dim = 3,
         .shape = FMB_BOX,
         .component = {{1}, {0, 1}, {0, 0, 1}},
         .orientation = {1, 0.25, 0.5, 0.75},
         .orientation_count = 4},
        0};
    check(&question);
}

/* Where two bodies move together their way may be beyond all doubles, and the gap still is small;
 * where all is at the origin there is nothing to scale by. */
static void extreme_places(void **state)
{
    struct question together = {unit_cube(0, 0, 0), unit_cube(0, 3, 0.1), 1e10};
    const struct solid point = {.dim = 2, .shape = FMB_CUBOID};
    const struct question points = {point, point, 0};
    together.a.velocity[0] = together.b.velocity[0] = 1e300;
    check(&together);
    check(&points);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_pairs),
        cmocka_unit_test(random_pairs_need_no_integers),
        cmocka_unit_test(widths_near_the_least_doubles),
        cmocka_unit_test(shallow_pairs),
        cmocka_unit_test(hard_families),
        cmocka_unit_test(all_exponents),
        cmocka_unit_test(small_worlds),
        cmocka_unit_test(known_gaps),
        cmocka_unit_test(wrong_gaps_are_refused),
        cmocka_unit_test(gaps_of_other_frames_are_refused),
        cmocka_unit_test(near_contact),
        cmocka_unit_test(nearly_parallel),
        cmocka_unit_test(batches_give_the_same),
        cmocka_unit_test(bodies_of_several_frames),
        cmocka_unit_test(ties_do_not_depend_on_any_order),
        cmocka_unit_test(equal_depths_have_one_direction),
        cmocka_unit_test(bounds_of_boxes_are_proven),
        cmocka_unit_test(a_margin_is_compared_with_the_lower_bound),
        cmocka_unit_test(equal_gaps_name_one_pair_of_frames),
        cmocka_unit_test(frames_within_the_width_of_others_count),
        cmocka_unit_test(cubes_rolled_by_libm),
        cmocka_unit_test(inexact_methods_have_none),
        cmocka_unit_test(infinite_gaps),
        cmocka_unit_test(direction_and_points_belong_together),
        cmocka_unit_test(touching_bodies_have_no_gap),
        cmocka_unit_test(frames_equal_after_rounding_have_an_order),
        cmocka_unit_test(a_shared_frame_has_an_order),
        cmocka_unit_test(tiny_edges),
        cmocka_unit_test(short_edges),
        cmocka_unit_test(long_edges),
        cmocka_unit_test(extreme_places),
    };
    gmp_count_allocations();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
