/* Change a question in a way whose effect on the answer is known, and the engine must know it
 * too: to the bit, where the effect is exact in doubles. No oracle is needed.
 *
 * All numbers drawn are small integers, so that every change is exact. */

#include "unit.h"

#include <float.h>
#include <math.h>

#include "draw.h"
#include "question.h"
#include "referee.h"

/* ---- Questions ---- */

static struct solid draw_solid(struct draw *draw, int dim, bool moving)
{
    struct solid solid = {.dim = dim, .moving = moving};
    solid.shape =
        (enum fmb_shape) draw_int(draw, FMB_CUBOID, dim == 3 ? FMB_FACE : FMB_TETRAHEDRON);
    for (int i = 0; i < solid_count(&solid); i++)
        draw_integers(draw, dim, -4, 4, solid.component[i]);
    draw_integers(draw, dim, -4, 4, solid.origin);
    if (moving)
        draw_integers(draw, dim, -3, 3, solid.velocity);
    return solid;
}

static struct question draw_question(struct draw *draw)
{
    static const double durations[] = {0, 0.5, 1, 4};
    const int dim = draw_int(draw, 2, 3);
    const bool moving = draw_coin(draw);
    struct question question = {draw_solid(draw, dim, moving), draw_solid(draw, dim, moving),
                                durations[draw_int(draw, 0, 3)]};
    return question;
}

/* ---- Changes ---- */

/* Applies change to each vector of the question: origins, components, velocities. */
typedef void change_vector(double *vector, int dim, int parameter);

static void change_vectors(struct question *question, change_vector *change, int parameter)
{
    for (int side = 0; side < 2; side++) {
        struct solid *solid = side == 0 ? &question->a : &question->b;
        change(solid->origin, solid->dim, parameter);
        change(solid->velocity, solid->dim, parameter);
        for (int i = 0; i < FMB_DIM_MAX; i++)
            change(solid->component[i], solid->dim, parameter);
    }
}

static void change_box(struct fmb_answer *answer, int dim, change_vector *change, int parameter)
{
    for (int end = 0; answer->has_box && end < 2; end++)
        change(answer->box[end], dim, parameter);
}

/* A change does to *answer what it must do, when it does to *question what it says. */
typedef void change_question(struct draw *draw, struct question *question,
                             struct fmb_answer *answer);

static void swap(struct draw *draw, struct question *question, struct fmb_answer *answer)
{
    (void) draw, (void) answer;
    *question = question_swapped(question);
}

static void exchange_axes(double *vector, int dim, int axis)
{
    int other = (axis + 1) % dim;
    double kept = vector[axis];
    vector[axis] = vector[other];
    vector[other] = kept;
}

static void permute_axes(struct draw *draw, struct question *question, struct fmb_answer *answer)
{
    const int dim = question->a.dim;
    for (int times = draw_int(draw, 1, 2); times > 0; times--) {
        const int axis = draw_int(draw, 0, dim - 1);
        change_vectors(question, exchange_axes, axis);
        change_box(answer, dim, exchange_axes, axis);
    }
}

static void scale_vector(double *vector, int dim, int exponent)
{
    for (int axis = 0; axis < dim; axis++)
        vector[axis] = ldexp(vector[axis], exponent);
}

/* Far enough for products to leave the doubles, near enough for the box to keep all its bits. */
static void scale(struct draw *draw, struct question *question, struct fmb_answer *answer)
{
    const int exponent = draw_int(draw, -900, 900);
    change_vectors(question, scale_vector, exponent);
    change_box(answer, question->a.dim, scale_vector, exponent);
}

/* 0 - x is never -0. */
static void reflect_vector(double *vector, int dim, int axis)
{
    (void) dim;
    vector[axis] = 0 - vector[axis];
}

static void reflect(struct draw *draw, struct question *question, struct fmb_answer *answer)
{
    const int dim = question->a.dim, axis = draw_int(draw, 0, dim - 1);
    change_vectors(question, reflect_vector, axis);
    change_box(answer, dim, reflect_vector, axis);
    double lower = answer->box[0][axis];
    answer->box[0][axis] = answer->box[1][axis];
    answer->box[1][axis] = lower;
}

/* Twice as long at half the speed. */
static void stretch_time(struct draw *draw, struct question *question, struct fmb_answer *answer)
{
    const int exponent = draw_int(draw, -300, 300);
    question->duration = ldexp(question->duration, exponent);
    scale_vector(question->a.velocity, FMB_DIM_MAX, -exponent);
    scale_vector(question->b.velocity, FMB_DIM_MAX, -exponent);
    if (answer->has_contact)
        scale_vector(answer->contact, 2, exponent);
}

static void reorder_components(struct draw *draw, struct question *question,
                               struct fmb_answer *answer)
{
    (void) answer;
    struct solid *solid = draw_coin(draw) ? &question->a : &question->b;
    double kept[FMB_DIM_MAX];
    const int i = draw_int(draw, 0, solid_count(solid) - 1), j = (i + 1) % solid_count(solid);
    memcpy(kept, solid->component[i], sizeof kept);
    memcpy(solid->component[i], solid->component[j], sizeof kept);
    memcpy(solid->component[j], kept, sizeof kept);
}

/* The same set, with another of its vertices for an origin: o + c_i. A cuboid then has -c_i in
 * place of c_i; a tetrahedron the ways from there to the old origin and to the others. */
static void start_elsewhere(struct draw *draw, struct question *question, struct fmb_answer *answer)
{
    (void) answer;
    struct solid *solid = draw_coin(draw) ? &question->a : &question->b;
    const int i = draw_int(draw, 0, solid_count(solid) - 1);
    for (int axis = 0; axis < solid->dim; axis++) {
        const double way = solid->component[i][axis];
        solid->origin[axis] += way;
        solid->component[i][axis] = -way;
        for (int j = 0; solid->shape != FMB_CUBOID && j < solid_count(solid); j++)
            if (j != i)
                solid->component[j][axis] -= way;
    }
}

struct exact_change {
    const char *name;
    change_question *apply;
};

static const struct exact_change exact_changes[] = {
    {"swap", swap},
    {"permute_axes", permute_axes},
    {"scale", scale},
    {"reflect", reflect},
    {"stretch_time", stretch_time},
    {"reorder_components", reorder_components},
    {"start_elsewhere", start_elsewhere},
};

static void answer_follows(void **state)
{
    const struct exact_change *change = *state;
    const long size = draw_sample(16000);
    struct draw draw;
    draw_begin(&draw, change->name);
    for (long n = 0; n < size; n++) {
        struct question question = draw_question(&draw);
        struct fmb_answer expected, found;
        referee_decide(&question, &expected);
        change->apply(&draw, &question, &expected);
        referee_decide(&question, &found);
        if (!referee_same(&expected, &found))
            referee_fail(&question, change->name);
    }
}

/* ---- Changes whose effect is rounded ---- */

static void expect_same_time(const struct question *question, const struct fmb_answer *one,
                             const struct fmb_answer *other)
{
    struct fmb_answer boxless = *other;
    boxless.has_box = one->has_box;
    memcpy(boxless.box, one->box, sizeof boxless.box);
    if (!referee_same(one, &boxless))
        referee_fail(question, "another verdict or interval");
}

/* Whether moved can be the double next to (or at) q + way, on the outer side (sign), if still is
 * the one next to q. With q between still and the double inside of it, moved is between the
 * roundings of these two, moved. */
static bool end_has_moved(double still, double moved, double way, double sign)
{
    const double inner = nextafter(still, -sign * HUGE_VAL) + way, outer = still + way;
    return sign * moved >= sign * nextafter(inner, -sign * HUGE_VAL) &&
           sign * moved <= sign * nextafter(outer, sign * HUGE_VAL);
}

static void translation_moves_the_box(void **state)
{
    struct draw draw;
    draw_begin(&draw, "translation_moves_the_box");
    for (long n = draw_sample(16000); n > 0; n--) {
        struct question question = draw_question(&draw);
        struct fmb_answer still, moved;
        double way[FMB_DIM_MAX] = {0};
        referee_decide(&question, &still);
        for (int axis = 0; axis < question.a.dim; axis++) {
            way[axis] = draw_int(&draw, -1, 1) * ldexp(1, draw_int(&draw, 0, 40));
            question.a.origin[axis] += way[axis];
            question.b.origin[axis] += way[axis];
        }
        referee_decide(&question, &moved);
        expect_same_time(&question, &still, &moved);
        for (int end = 0; still.has_box && end < 2; end++)
            for (int axis = 0; axis < question.a.dim; axis++)
                if (!end_has_moved(still.box[end][axis], moved.box[end][axis], way[axis],
                                   end == 0 ? -1 : 1))
                    referee_fail(&question, "the box has not moved as the frames have");
    }
}

/* Boxes of axis-aligned cuboids with integer corners are integers: nothing is rounded. */
static void translation_moves_whole_boxes_exactly(void **state)
{
    struct draw draw;
    draw_begin(&draw, "translation_moves_whole_boxes_exactly");
    for (long n = draw_sample(16000); n > 0; n--) {
        struct question question = draw_question(&draw);
        struct solid *solids[2] = {&question.a, &question.b};
        for (int side = 0; side < 2; side++) {
            solids[side]->shape = FMB_CUBOID;
            solids[side]->moving = false;
            memset(solids[side]->component, 0, sizeof solids[side]->component);
            for (int axis = 0; axis < question.a.dim; axis++)
                solids[side]->component[axis][axis] = draw_int(&draw, -5, 5);
        }
        struct fmb_answer expected, found;
        referee_decide(&question, &expected);
        for (int axis = 0; axis < question.a.dim; axis++) {
            const double way = draw_int(&draw, -1, 1) * ldexp(1, draw_int(&draw, 0, 40));
            for (int side = 0; side < 2; side++) {
                solids[side]->origin[axis] += way;
                if (expected.has_box)
                    expected.box[side][axis] += way; /* here: the end */
            }
        }
        referee_decide(&question, &found);
        if (!referee_same(&expected, &found))
            referee_fail(&question, "moved box");
    }
}

/* Two frames carried along by one more velocity meet as before. */
static void common_velocity_changes_no_times(void **state)
{
    struct draw draw;
    draw_begin(&draw, "common_velocity_changes_no_times");
    for (long n = draw_sample(16000); n > 0; n--) {
        struct question question = draw_question(&draw);
        struct fmb_answer still, moved;
        question.a.moving = question.b.moving = true;
        referee_decide(&question, &still);
        for (int axis = 0; axis < question.a.dim; axis++) {
            double more = draw_int(&draw, -9, 9);
            question.a.velocity[axis] += more;
            question.b.velocity[axis] += more;
        }
        referee_decide(&question, &moved);
        expect_same_time(&question, &still, &moved);
    }
}

/* Start where they end, go back: same verdict, same box, and T - t in place of t. */
static void time_runs_backwards(void **state)
{
    struct draw draw;
    draw_begin(&draw, "time_runs_backwards");
    for (long n = draw_sample(16000); n > 0; n--) {
        struct question question = draw_question(&draw);
        const double T = question.duration;
        struct fmb_answer forth, back;
        question.a.moving = question.b.moving = true;
        referee_decide(&question, &forth);
        for (int axis = 0; axis < question.a.dim; axis++) {
            question.a.origin[axis] += T * question.a.velocity[axis];
            question.b.origin[axis] += T * question.b.velocity[axis];
            question.a.velocity[axis] = -question.a.velocity[axis];
            question.b.velocity[axis] = -question.b.velocity[axis];
        }
        referee_decide(&question, &back);
        /* -t is rounded as t is, the other way. */
        for (int end = 0; forth.has_contact && end < 2; end++)
            if (!end_has_moved(-forth.contact[1 - end], back.contact[end], T, end == 0 ? -1 : 1))
                referee_fail(&question, "interval back in time");
        memcpy(forth.contact, back.contact, sizeof forth.contact);
        if (!referee_same(&forth, &back))
            referee_fail(&question, "verdict or box back in time");
    }
}

int main(void)
{
    const struct CMUnitTest rounded[] = {
        cmocka_unit_test(translation_moves_the_box),
        cmocka_unit_test(translation_moves_whole_boxes_exactly),
        cmocka_unit_test(common_velocity_changes_no_times),
        cmocka_unit_test(time_runs_backwards),
    };
    struct CMUnitTest tests[COUNT(exact_changes) + COUNT(rounded)];
    for (size_t i = 0; i < COUNT(exact_changes); i++)
        tests[i] = (struct CMUnitTest){.name = exact_changes[i].name,
                                       .test_func = answer_follows,
                                       .initial_state = (void *) (uintptr_t) &exact_changes[i]};
    memcpy(&tests[COUNT(exact_changes)], rounded, sizeof rounded);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
