/* The work of a pair of the largest hulls and of each of its steps, counted, not timed. The service
 * looks at the bus between two steps, at least once a millisecond.
 *
 * Derivation. The work of a step is the sum of
 *
 *     scanned    vertices in doubles, in support_max(): 0.5 ns each, which is 4.5 instructions
 *                with two lanes;
 *     products   of limbs in integers: 0.5 ns each (exact_work.h);
 *     placed     vertices in integers: 1,000 ns each, beside their products, measured with numbers
 *                of the whole range;
 *     read       vertices that are converted to integers but not placed: 300 ns each;
 *     written    limbs of fractions that a certificate states: 600 ns each, to reduce the fraction
 *                and to print it, measured with 8 to 64 limbs.
 *
 * What else a step does is at most half of that: the scan of two hulls of 1,024 vertices takes a
 * thousand nanoseconds, where a point that it finds costs some ten, and the six facets that the
 * point adds to a mesh some five hundred. So the time of a step is at most 1.5 times its work. */

#include "unit.h"

#include <float.h>
#include <math.h>

#include "certificate_text.h"
#include "draw.h"
#include "exact_work.h"
#include "support.h"
#include "support_integers.h"
#include "work_steps.h"

enum { VERTICES = FMB_HULL_VERTICES_MAX, NUMBERS = FMB_DIM_MAX * VERTICES };

static const double ns_of_vertex = 0.5, ns_of_product = 0.5, ns_of_placed = 1e3, ns_of_read = 300,
                    ns_of_written = 600;
static const double ns_most = 1e6 / 1.5, ns_most_of_pair = 60e6 / 1.5,
                    ns_most_of_turning = 700e6 / 1.5;

static double scanned, placed, read, written;

struct support __real_support_max(const struct support_vertices *vertices,
                                  const double n[FMB_DIM_MAX]);
struct support __wrap_support_max(const struct support_vertices *vertices,
                                  const double n[FMB_DIM_MAX]);
struct support __wrap_support_max(const struct support_vertices *vertices,
                                  const double n[FMB_DIM_MAX])
{
    scanned += vertices->count;
    return __real_support_max(vertices, n);
}

void __real_support_integers_place(const struct support_integers *integers, int f, unsigned i,
                                   mpz_t out[3]);
void __wrap_support_integers_place(const struct support_integers *integers, int f, unsigned i,
                                   mpz_t out[3]);
void __wrap_support_integers_place(const struct support_integers *integers, int f, unsigned i,
                                   mpz_t out[3])
{
    placed++;
    __real_support_integers_place(integers, f, i, out);
}

void __real_support_integers_vertex(const struct support_integers *integers, int f, unsigned i,
                                    mpz_t out[3]);
void __wrap_support_integers_vertex(const struct support_integers *integers, int f, unsigned i,
                                    mpz_t out[3]);
void __wrap_support_integers_vertex(const struct support_integers *integers, int f, unsigned i,
                                    mpz_t out[3])
{
    read++;
    __real_support_integers_vertex(integers, f, i, out);
}

void __real_certificate_write_number(struct certificate_writer *writer, const mpq_t number);
void __wrap_certificate_write_number(struct certificate_writer *writer, const mpq_t number);
void __wrap_certificate_write_number(struct certificate_writer *writer, const mpq_t number)
{
    written += (double) (mpz_size(mpq_numref(number)) + mpz_size(mpq_denref(number)));
    __real_certificate_write_number(writer, number);
}

unsigned __real_support_list(const struct support_vertices *vertices, const double n[FMB_DIM_MAX],
                             double least, uint16_t *out);
unsigned __wrap_support_list(const struct support_vertices *vertices, const double n[FMB_DIM_MAX],
                             double least, uint16_t *out);
unsigned __wrap_support_list(const struct support_vertices *vertices, const double n[FMB_DIM_MAX],
                             double least, uint16_t *out)
{
    scanned += vertices->count;
    return __real_support_list(vertices, n, least, out);
}

static double work(void)
{
    return ns_of_vertex * scanned + ns_of_product * exact_work + ns_of_placed * placed +
           ns_of_read * read + ns_of_written * written;
}

/* ---- Hulls ---- */

struct large {
    double numbers[NUMBERS], memory[5 * VERTICES + 16];
    struct fmb_body body;
    struct fmb_placement at;
};

/* Points spread over a unit ball; a prism, 30 high, whose faces have half of all vertices each; the
 * same with exponents of a range, in a prism across its axis; the same with some vertices so large
 * that the sum of their coordinates overflows, and the other exponents below theirs. */
enum shape { BALL, PRISM, WIDE_BALL, WIDE_PRISM, HUGE_BALL, HUGE_PRISM, SHAPES };

static const double huge_unit = 0x1p1019;

static void make_large(struct draw *draw, enum shape shape, const int range[2], struct large *out)
{
    for (int k = 0; k < VERTICES; k++) {
        double *to = out->numbers + (ptrdiff_t) FMB_DIM_MAX * k;
        const bool prism = shape % 2 == PRISM;
        const double z = prism ? k % 2 * 30 - 15 : 1 - 2 * (k + 0.5) / VERTICES;
        const double r = shape == HUGE_PRISM ? 16 : prism ? 1 : sqrt(1 - z * z), angle = k * 2.4;
        to[0] = r * cos(angle);
        to[1] = r * sin(angle);
        to[2] = z;
        const bool largest = shape >= HUGE_BALL && k < 8;
        for (int axis = 0; axis < (shape < WIDE_BALL || largest ? 0 : prism ? 2 : 3); axis++)
            to[axis] = ldexp(
                to[axis], draw_int(draw, range[0], range[1]) - (shape < HUGE_BALL ? 0 : range[1]));
        for (int axis = 0; axis < 3 && shape >= HUGE_BALL; axis++)
            to[axis] *= prism ? huge_unit : DBL_MAX;
    }
    out->at = (struct fmb_placement){.body = &out->body, .orientation_count = 4};
    for (int k = 0; k < 4; k++)
        out->at.orientation[k] = draw_uniform(draw, -1, 1);
    assert_int_equal(
        fmb_body_make_hull(FMB_DIM_MAX, out->numbers, NUMBERS, out->memory, &out->body), FMB_OK);
}

/* Where the second hull is: about the middle of the first; with its lowest vertex, or its lower
 * face, on the highest or upper one of the first in a common orientation; anywhere. */
enum place { CONCENTRIC, RESTING, ANYWHERE, PLACES };

static void put(struct draw *draw, enum place place, double unit, struct large large[2])
{
    struct fmb_placement *a = &large[0].at, *b = &large[1].at;
    if (place == RESTING) {
        const double q[4] = {1, 2, 3, 4}, z[FMB_DIM_MAX] = {22, 20, 4}; /* 30 of the turned axis */
        memcpy(a->orientation, q, sizeof q);
        memcpy(b->orientation, q, sizeof q);
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            b->position[axis] = unit * z[axis];
        return;
    }
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        b->position[axis] = place == ANYWHERE ? unit * draw_uniform(draw, -1, 1) : 0;
        a->velocity[axis] = unit * draw_uniform(draw, -1, 1);
        b->velocity[axis] = unit * draw_uniform(draw, -1, 1);
    }
}

/* Gives both hulls an end in place of a velocity. RESTING: the second hull turns about the axis of
 * both and slides on the face of the first hull. */
static void give_ends(struct draw *draw, enum place place, double unit, struct large large[2])
{
    for (int f = 0; f < 2; f++) {
        struct fmb_placement *at = &large[f].at;
        memset(at->velocity, 0, sizeof at->velocity);
        at->end_count = 7;
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            at->end_position[axis] =
                place == RESTING ? at->position[axis] : unit * draw_uniform(draw, -1, 1);
        for (int k = 0; k < 4; k++)
            at->end_orientation[k] = at->orientation[k] + draw_uniform(draw, -0.2, 0.2);
        if (place == RESTING) {
            const double q[2][4] = {{1, 2, 3, 4}, {-2, 7, 4, 9}}, x[FMB_DIM_MAX] = {2, -1, -6};
            memcpy(at->end_orientation, q[f], sizeof q[f]);
            for (int axis = 0; axis < FMB_DIM_MAX && f == 1; axis++)
                at->end_position[axis] += unit / 8 * x[axis];
        }
    }
}

/* ---- Steps ---- */

/* Returns the greatest work of a step, in nanoseconds. */
typedef double work_of_step(const struct large large[2], int *steps);

static double work_of_scene(const struct large large[2], int *steps)
{
    const struct fmb_placement placements[2] = {large[0].at, large[1].at};
    return work_of_scene_step(placements, 1, work, steps);
}

static double work_of_certificate(const struct large large[2], int *steps)
{
    const struct fmb_placement placements[2] = {large[0].at, large[1].at};
    bool made;
    const double most = work_of_certificate_step(placements, 1, work, steps, &made);
    assert_true(made);
    return most;
}

static double work_of_turning_certificate(const struct large large[2], int *steps)
{
    const struct fmb_placement placements[2] = {large[0].at, large[1].at};
    bool made;
    return work_of_certificate_step(placements, 1, work, steps, &made);
}

/* most_allowed: nanoseconds of a pair. */
static void assert_short(const char *name, const int range[2], bool turns, double most_allowed,
                         work_of_step *step)
{
    static struct large large[2];
    struct draw draw;
    double most = 0, most_of_pair = 0;
    int steps = 0;
    draw_begin(&draw, name);
    for (long turn = SHAPES * PLACES * draw_sample(3) - 1; turn >= 0; turn--) {
        const int shape = (int) (turn % SHAPES), place = (int) (turn / SHAPES % PLACES);
        make_large(&draw, shape, range, &large[0]);
        make_large(&draw, shape, range, &large[1]);
        put(&draw, place, shape < HUGE_BALL ? 1 : huge_unit, large);
        if (turns)
            give_ends(&draw, place, shape < HUGE_BALL ? 1 : huge_unit, large);
        const double before = work(), of_turn = step(large, &steps);
        most_of_pair = fmax(most_of_pair, work() - before);
        if (turn < SHAPES * PLACES)
            printf("# shape %d, place %d: at most %.0f ns in a step\n", shape, place, of_turn);
        most = fmax(most, of_turn);
    }
    printf("# %d steps, at most %.0f ns; a pair at most %.0f ns\n", steps, most, most_of_pair);
    assert_true(most > 0 && most <= ns_most && most_of_pair <= most_allowed);
    assert_true(scanned > 0 && exact_work > 0 && placed > 0);
}

static void steps_are_short(void **state)
{
    static const int whole[2] = {-1000, 900};
    assert_short("steps_are_short", whole, false, ns_most_of_pair, work_of_scene);
}

static void steps_of_turning_hulls_are_short(void **state)
{
    static const int wide[2] = {-500, 500};
    assert_short("steps_of_turning_hulls_are_short", wide, true, ns_most_of_turning, work_of_scene);
}

static void steps_of_certificates_of_turning_hulls_are_short(void **state)
{
    static const int wide[2] = {-110, 100};
    assert_short("steps_of_certificates_of_turning_hulls_are_short", wide, true, ns_most_of_turning,
                 work_of_turning_certificate);
}

/* Exponents that together with the orientations span nearly the bits that a certificate may. */
static void steps_of_certificates_are_short(void **state)
{
    static const int range[2] = {-110, 100};
    assert_short("steps_of_certificates_are_short", range, false, ns_most_of_pair,
                 work_of_certificate);
    assert_true(written > 0);
}

/* Doubles tell vertices apart even if the bound on their distance from the origin of their body
 * overflows: at most 128 of 2,048 in a step, on average, get a value in integers. */
static void few_vertices_of_huge_hulls_get_a_value_in_integers(void **state)
{
    static const int range[2] = {-1000, 900};
    static struct large large[2];
    struct draw draw;
    draw_begin(&draw, "few_vertices_of_huge_hulls_get_a_value_in_integers");
    for (long turn = draw_sample(8); turn > 0; turn--) {
        const long before = exact_terms;
        int steps = 0;
        for (int f = 0; f < 2; f++)
            make_large(&draw, turn % 2 ? HUGE_BALL : HUGE_PRISM, range, &large[f]);
        put(&draw, turn % 4 ? ANYWHERE : CONCENTRIC, huge_unit, large);
        assert_true(isinf(large[0].body.reach));
        work_of_scene(large, &steps);
        printf("# %ld coordinates in %d steps\n", exact_terms - before, steps);
        assert_true(exact_terms - before <= (long) steps * 128 * FMB_DIM_MAX);
    }
    assert_true(exact_terms > 0);
}

static void overlaps_in_general_position_need_no_integers(void **state)
{
    static struct large large[2];
    struct draw draw;
    const long before = exact_terms;
    draw_begin(&draw, "overlaps_in_general_position_need_no_integers");
    for (long turn = draw_sample(8); turn > 0; turn--) {
        struct fmb_answer answer;
        for (int f = 0; f < 2; f++)
            make_large(&draw, turn % 2 ? BALL : PRISM, NULL, &large[f]);
        put(&draw, turn % 4 < 2 ? ANYWHERE : CONCENTRIC, 1, large);
        fmb_decide(fmb_method_default(), &large[0].at, &large[1].at, 1, 0, &answer);
        assert_int_equal(answer.verdict, FMB_OVERLAPPING);
    }
    assert_int_equal(exact_terms, before);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_are_short),
        cmocka_unit_test(steps_of_certificates_are_short),
        cmocka_unit_test(steps_of_turning_hulls_are_short),
        cmocka_unit_test(steps_of_certificates_of_turning_hulls_are_short),
        cmocka_unit_test(few_vertices_of_huge_hulls_get_a_value_in_integers),
        cmocka_unit_test(overlaps_in_general_position_need_no_integers)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
