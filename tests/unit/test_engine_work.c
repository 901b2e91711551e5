/* How much exact arithmetic a pair can take, counted and not timed: a search for the pair that
 * takes most stays below the bounds that the service is built on. */

#include "unit.h"

#include <math.h>

#include "climb.h"
#include "exact_work.h"
#include "family.h"
#include "limbs.h"
#include "referee.h"
#include "trial.h"
#include "turn_family.h"
#include "work_steps.h"

enum { TEXT_SIZE = FMB_CERTIFICATE_MAX, EVERYTHING = FMB_WANT_BOX | FMB_WANT_GAP };

static double work_of(const struct question *question, unsigned want)
{
    struct ready ready;
    struct fmb_answer answer;
    referee_ready(question, &ready);
    const double before = exact_work;
    assert_int_equal(pair_decide(fmb_method_by_name("certified"), &ready.pair, want, &answer),
                     FMB_OK);
    return exact_work - before;
}

static double work_of_verdict(const struct question *question)
{
    return work_of(question, 0);
}

static double work_of_all(const struct question *question)
{
    return work_of(question, EVERYTHING);
}

static double work_of_gap(const struct question *question)
{
    return work_of(question, FMB_WANT_GAP) - work_of_verdict(question);
}

static double work_of_body(const struct question *question)
{
    const double before = exact_work;
    struct ready ready;
    referee_ready(question, &ready);
    return exact_work - before;
}

static double work_of_certificate(const struct question *question)
{
    static char text[TEXT_SIZE];
    struct ready ready;
    size_t length;
    referee_ready(question, &ready);
    const double before = exact_work;
    assert_int_equal(pair_certificate(&ready.pair, text, sizeof text, &length), FMB_OK);
    return exact_work - before;
}

static double work(void)
{
    return exact_work;
}

static double step_of_all(const struct question *question)
{
    struct ready ready;
    int steps = 0;
    referee_ready(question, &ready);
    const struct fmb_placement placements[2] = {ready.pair.a, ready.pair.b};
    return work_of_scene_step(placements, ready.pair.duration, work, &steps);
}

static double step_of_certificate(const struct question *question)
{
    struct ready ready;
    int steps = 0;
    bool made;
    referee_ready(question, &ready);
    const struct fmb_placement placements[2] = {ready.pair.a, ready.pair.b};
    return work_of_certificate_step(placements, ready.pair.duration, work, &steps, &made);
}

struct search {
    const char *name;
    climb_cost *cost;
    double most[2]; /* products of limbs, half a nanosecond each; [1]: posed */
    int climbs;
};

/* Numbers of all exponents; and those with which certificates reduce fractions, near the widest. */
static void work_is_bounded(void **state)
{
    static const int ranges[][2] = {{-1074, 1023}, {-230, 230}};
    const struct search *search = *state;
    struct draw draw;
    double all = 0;
    draw_begin(&draw, search->name);
    for (int posed = 0; posed < 2; posed++)
        for (int r = 0; r < 2; r++) {
            struct climber climber = {&draw, search->cost, ranges[r][0], ranges[r][1], posed};
            struct question worst;
            const double work = climb(&climber, (int) draw_sample(search->climbs), 120, &worst);
            printf("# %s%s, 2^%d to 2^%d: at most %.0f products of limbs\n", search->name,
                   posed ? ", posed" : "", ranges[r][0], ranges[r][1], work);
            all += work;
            if (work > search->most[posed])
                referee_fail(&worst, "more work than is promised");
        }
    assert_true(all > 0);
}

/* An end of a contact that doubles do not give is computed only for the slabs that may have it: of
 * 25 slabs, few. */
static void only_slabs_that_may_have_an_end_are_computed(void **state)
{
    long contacts = 0;
    struct draw draw;
    draw_begin(&draw, "only_slabs_that_may_have_an_end_are_computed");
    for (size_t f = 0; family_at(f); f++) {
        const struct family *family = family_at(f);
        struct cell cells[CELL_OF_ALL_SHAPES];
        const int count = family_cells(family, cells);
        for (int c = 0; c < count; c++) {
            struct question question;
            const long before = exact_ends;
            family_draw(family, &cells[c], &draw, &question);
            work_of_verdict(&question);
            contacts += exact_ends > before;
        }
    }
    printf("# %ld contacts in integers, %ld ends\n", contacts, exact_ends);
    assert_true(contacts > 0 && exact_ends < 12 * contacts);
}

static long spans;

struct dyadic_span __real_limbs_span_of(const struct frame_pair *pair);
struct dyadic_span __wrap_limbs_span_of(const struct frame_pair *pair);
struct dyadic_span __wrap_limbs_span_of(const struct frame_pair *pair)
{
    spans++;
    return __real_limbs_span_of(pair);
}

/* Whether the ends of a contact that doubles give are exact is worth a look only if the numbers of
 * both frames have few bits. Frames that have not: of 25 bits, of an origin that rounds, turned. */
static void contacts_of_numbers_that_round_are_taken_as_they_are(void **state)
{
    static const struct {
        double size, local, orientation[4];
        bool looks;
    } cases[] = {{1 + 0x1p-23, 0, {1}, true},
                 {1 + 0x1p-24, 0, {1}, false},
                 {1, 0.1, {1}, false},
                 {1, 0, {1, 2, 3, 4.1}, false}};
    for (size_t i = 0; i < COUNT(cases); i++)
        for (int swapped = 0; swapped < 2; swapped++) {
            const double size = cases[i].size;
            const struct solid plain = {.dim = 3,
                                        .shape = FMB_CUBOID,
                                        .component = {{1}, {0, 1}, {0, 0, 1}},
                                        .moving = true,
                                        .velocity = {3, 2, 1}};
            struct solid other = {.dim = 3,
                                  .shape = FMB_CUBOID,
                                  .component = {{size}, {0, size}, {0, 0, size}},
                                  .local = {cases[i].local},
                                  .origin = {3.7, 2.25, 1},
                                  .orientation_count = 4};
            memcpy(other.orientation, cases[i].orientation, sizeof other.orientation);
            const struct question question = {swapped ? other : plain, swapped ? plain : other, 1};
            const long before = spans;
            work_of(&question, FMB_WANT_TIMES);
            assert_int_equal(spans > before, cases[i].looks);
        }
}

/* Bounds the work for pairs that turn, in products of limbs: for each step, for each step of a
 * certificate, and for a pair. Numbers and quaternions of all exponents take the most work. */
static void work_of_turning_pairs_is_bounded(void **state)
{
    static const double most_of_step = 2e5, most_of_pair = 3.5e8;
    double most[2] = {0}, pair = 0;
    struct draw draw;
    draw_begin(&draw, "work_of_turning_pairs_is_bounded");
    for (size_t f = 0; family_turning_at(f); f++) {
        const struct family *family = family_turning_at(f);
        struct cell cells[CELL_OF_ALL_SHAPES];
        const int count = family_cells(family, cells);
        for (long n = count * draw_sample(4) - 1; n >= 0; n--) {
            struct question question;
            struct trial trial;
            int steps = 0;
            bool made;
            family_draw(family, &cells[n % count], &draw, &question);
            trial_begin(&question, &trial);
            const struct fmb_placement placements[2] = {trial.pair[0].a, trial.pair[0].b};
            const double before = exact_work;
            const double step = work_of_scene_step(placements, question.duration, work, &steps);
            pair = fmax(pair, exact_work - before);
            most[0] = fmax(most[0], step);
            if (trial.body[0].frame_count == 1 && trial.body[1].frame_count == 1)
                most[1] = fmax(most[1], work_of_certificate_step(placements, question.duration,
                                                                 work, &steps, &made));
            trial_end(&trial);
        }
    }
    printf("# at most %.0f in a step, %.0f of a certificate; a pair %.0f\n", most[0], most[1],
           pair);
    assert_true(most[0] > 0 && most[0] <= most_of_step && most[1] <= most_of_step);
    assert_true(pair <= most_of_pair);
}

/* A square plate turns by a right angle about its centre. Once within the window, a corner enters
 * the face of a cube to a depth of about 2^-30, slowly: doubles do not see the ends of the
 * contact. Integers take the work of a few directions and verdicts, not of a search by halving. */
static void ends_of_shallow_contacts_are_found_by_their_polynomials(void **state)
{
    static const double most_allowed = 3e4, side[3] = {1, 1, 1}, plate[3] = {1, 1, 0.25};
    struct fmb_body body[2];
    struct fmb_placement placement[2] = {{.body = &body[0]}, {.body = &body[1]}};
    double most = 0;
    assert_int_equal(fmb_body_make(3, FMB_BOX, side, 3, &body[0]), FMB_OK);
    assert_int_equal(fmb_body_make(3, FMB_BOX, plate, 3, &body[1]), FMB_OK);
    for (int k = 0; k < 8; k++) {
        const double z = 0.5 * k / 8;
        struct fmb_placement *moving = &placement[1];
        struct fmb_answer answer;
        moving->position[0] = moving->end_position[0] = 0.5 + sqrt(0.5) - 0x1p-30;
        moving->position[1] = moving->end_position[1] = 0.03125 * k;
        moving->orientation_count = 4;
        moving->end_count = 7;
        moving->orientation[0] = 1;
        moving->orientation[3] = z;
        moving->end_orientation[0] = 1 - z; /* (1 + z k) (1 + k) */
        moving->end_orientation[3] = 1 + z;
        const double before = exact_work;
        assert_int_equal(
            fmb_decide(fmb_method_default(), &placement[0], moving, 1, FMB_WANT_TIMES, &answer),
            FMB_OK);
        most = fmax(most, exact_work - before);
        assert_int_equal(answer.verdict, FMB_OVERLAPPING);
        assert_true(answer.contact[1] - answer.contact[0] < 0x1p-13);
        /* Turned by 2 atan(s), the corner reaches (1 + 2 s - s^2) / (2 + 2 s^2) from the centre. */
        const long double reach = (long double) moving->position[0] - 0.5L;
        const long double root = sqrtl(2 - 4 * reach * reach);
        for (int late = 0; late < 2 && k == 0; late++)
            assert_true(fabsl(answer.contact[late] -
                              (1 + (late ? root : -root)) / (2 * reach + 1)) <= 0x1p-40L);
    }
    printf("# at most %.0f\n", most);
    assert_true(most > 0 && most <= most_allowed);
}

/* The limits are about one and a half times the work that searches found; a step takes less than a
 * millisecond. */
int main(void)
{
    static struct search searches[] = {
        {"steps", step_of_all, {1e6, 1.8e6}, 2},
        {"steps of certificates", step_of_certificate, {5e4, 5e4}, 8},
        {"bodies", work_of_body, {2e4, 2e4}, 8},
        {"verdicts", work_of_verdict, {1.1e7, 1.4e7}, 2},
        {"all", work_of_all, {7e7, 1.05e8}, 2},
        {"gaps", work_of_gap, {4e4, 3e5}, 8},
        {"certificates", work_of_certificate, {2.4e5, 2.4e5}, 8}};
    enum { SEARCHES = COUNT(searches) };
    struct CMUnitTest tests[4 + SEARCHES] = {
        cmocka_unit_test(only_slabs_that_may_have_an_end_are_computed),
        cmocka_unit_test(contacts_of_numbers_that_round_are_taken_as_they_are),
        cmocka_unit_test(work_of_turning_pairs_is_bounded),
        cmocka_unit_test(ends_of_shallow_contacts_are_found_by_their_polynomials)};
    for (size_t i = 0; i < SEARCHES; i++)
        tests[4 + i] = (struct CMUnitTest) cmocka_unit_test_prestate(work_is_bounded, &searches[i]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
