/* The bounds on the errors of slabs, attacked: for each kind of pair a search for the numbers that
 * come closest to them, the true errors being found in integers (slab_truth.h); in the list of
 * slabs.c, and in the order of operations that the filter's kernels have (slab_kernel.h).
 *
 * The search climbs: it starts from numbers that are likely to round badly (mantissas of ones, an
 * ulp beside a power of two, near cancellation), changes one at a time, and keeps what makes the
 * error of one slab larger relative to its bound. */

#include "unit.h"

#include <math.h>

#include "certified.h"
#include "draw.h"
#include "question.h"
#include "referee.h"
#include "slab_kernel.h"
#include "slab_truth.h"
#include "slabs.h"

/* slabs.c once more, with fused operations, and with a bound that is wrong (tests.mk). */
int fused_slabs_list(const struct slabs_pair *pair, bool rounds, struct slab_value out[SLABS_MAX]);
int planted_slabs_list(const struct slabs_pair *pair, bool rounds,
                       struct slab_value out[SLABS_MAX]);

/* ---- Numbers ---- */

static double nudged(struct draw *draw, double x, int most)
{
    return x * (1 + draw_int(draw, -most, most) * 0x1p-52);
}

static double draw_number(struct draw *draw)
{
    double x = draw_uniform(draw, 1, 2);
    switch (draw_int(draw, 0, 5)) {
    case 0: x = 2 - draw_int(draw, 1, 3) * 0x1p-52; break;
    case 1: x = 1 + draw_int(draw, 1, 3) * 0x1p-52; break;
    case 2: x = 1 + draw_int(draw, 0, 7) * 0x1p-3 + draw_int(draw, -1, 1) * 0x1p-27; break;
    case 3: x = nudged(draw, 1.5, 3); break;
    default: break;
    }
    if (draw_int(draw, 0, 3) == 0)
        x = ldexp(x, draw_int(draw, -3, 3));
    return draw_coin(draw) ? x : -x;
}

enum { NUMBERS_MAX = QUESTION_NUMBERS_MAX + 1 };

/* Lists the numbers of a question, its window too; returns how many. */
static int numbers_of(struct question *question, double *out[NUMBERS_MAX])
{
    int count = question_numbers(question, out);
    if (question->a.moving)
        out[count++] = &question->duration;
    return count;
}

static void mutate(struct draw *draw, struct question *question)
{
    double *number[NUMBERS_MAX];
    const int count = numbers_of(question, number);
    double *x = number[draw_int(draw, 0, count - 1)];
    switch (draw_int(draw, 0, 6)) {
    case 0: *x = nudged(draw, *x, 4); break;
    case 1: *x += ldexp(*x, -draw_int(draw, 1, 52)); break;
    case 2: *x -= ldexp(*x, -draw_int(draw, 2, 53)); break;
    case 3: *x = -*x; break;
    case 4: *x = draw_number(draw); break;
    case 5: *x = nudged(draw, *number[draw_int(draw, 0, count - 1)], 2); break;
    default: *x = ldexp(*x, draw_int(draw, -1, 1)); break;
    }
    if (fabs(*x) > 0x1p30 || fabs(*x) < 0x1p-30)
        *x = draw_number(draw);
    question->duration = fabs(question->duration);
}

/* ---- The search ---- */

struct kind {
    int dim;
    bool moving;
    enum fmb_shape a, b;
};

enum { SHAPES = 3, KINDS = 2 * SHAPES * SHAPES + 2 * 2 * 2 };

/* Those in space, with faces, then those in the plane. */
static struct kind kind_at(int i)
{
    const int space = 2 * SHAPES * SHAPES, shapes = i < space ? SHAPES : 2;
    const int n = i < space ? i : i - space;
    return (struct kind){i < space ? 3 : 2, n / (shapes * shapes),
                         (enum fmb_shape)(FMB_CUBOID + n / shapes % shapes),
                         (enum fmb_shape)(FMB_CUBOID + n % shapes)};
}

static const char *kind_text(struct kind kind)
{
    static char text[80];
    snprintf(text, sizeof text, "%dD %s %s %s", kind.dim, kind.moving ? "moving" : "static",
             fmb_shape_name((int) kind.a), fmb_shape_name((int) kind.b));
    return text;
}

static struct question draw_question(struct draw *draw, struct kind kind)
{
    struct question question = {{.dim = kind.dim, .shape = kind.a, .moving = kind.moving},
                                {.dim = kind.dim, .shape = kind.b, .moving = kind.moving},
                                1};
    double *number[NUMBERS_MAX];
    for (int i = numbers_of(&question, number) - 1; i >= 0; i--)
        *number[i] = draw_number(draw);
    question.duration = fabs(question.duration);
    return question;
}

/* Whose bounds are attacked: of one list or the other. */
struct subject {
    const char *name;
    int (*list)(const struct slabs_pair *pair, bool rounds, struct slab_value out[SLABS_MAX]);
    slab_kernel_function *kernel;
    slab_kernel_axes_function *axes; /* not NULL: their bound, in space */
    double ratio;                    /* that the search must find, to have found anything */
};

/* index also says whether a kernel looks for normals that are zero. */
static int list_of(const struct subject *subject, const struct pair *pair,
                   const struct slabs_pair *slabs, int index, struct slab_value out[SLABS_MAX])
{
    const struct frame_pair frames = pair_frames(pair);
    return subject->kernel ? subject->kernel(&frames, index % 2, out)
                           : subject->list(slabs, true, out);
}

/* A pair as a subject takes it: kernels want the cuboid first, and the face last. */
static void set_pair(const struct subject *subject, const struct question *question,
                     struct ready *out)
{
    referee_ready(question, out);
    const struct pair pair = out->pair;
    if ((subject->kernel || subject->axes) && pair.a.body->one.shape > pair.b.body->one.shape)
        out->pair = (struct pair){pair.b, pair.a, pair.duration};
}

/* The worst error of slab number index (modulo how many there are) relative to its bound; -1 where
 * doubles say nothing of the pair. */
static double ratio_of(const struct subject *subject, const struct question *question, int index,
                       struct slab_truth *truth)
{
    struct ready ready;
    struct slabs_pair pair;
    struct slab_value slab[SLABS_MAX];
    set_pair(subject, question, &ready);
    if (!slab_truth_prepare(&ready.pair, &pair))
        return -1;
    slab_truth_set(truth, &ready.pair);
    if (subject->axes) {
        const struct frame_pair frames = pair_frames(&ready.pair);
        double bound;
        const double surely = subject->axes(&frames, &bound);
        return slab_truth_axes(truth, surely, bound);
    }
    const int count = list_of(subject, &ready.pair, &pair, index, slab);
    return slab_truth_worst(truth, &slab[index / 2 % count]);
}

/* The subject of the search. */
struct climb {
    struct question question;
    int index; /* of the slab */
    double ratio;
};

/* The best of some starts. */
static struct climb draw_start(struct draw *draw, const struct subject *subject, struct kind kind,
                               struct slab_truth *truth)
{
    struct climb best = {.ratio = -2};
    for (int n = 0; n < 40; n++) {
        struct climb start = {draw_question(draw, kind), draw_int(draw, 0, 8 * SLABS_MAX), -1};
        start.ratio = ratio_of(subject, &start.question, start.index, truth);
        if (start.ratio > best.ratio)
            best = start;
    }
    return best;
}

static struct climb climb(struct draw *draw, const struct subject *subject, struct kind kind,
                          struct slab_truth *truth)
{
    struct climb best = draw_start(draw, subject, kind, truth);
    for (int n = 0; n < 200; n++) {
        struct climb changed = best;
        for (int times = draw_int(draw, 1, 2); times > 0; times--)
            mutate(draw, &changed.question);
        changed.ratio = ratio_of(subject, &changed.question, changed.index, truth);
        if (changed.ratio >= best.ratio)
            best = changed;
    }
    return best;
}

/* The best of some climbs; one that comes to enough is the last. */
static struct climb search_kind(struct draw *draw, const struct subject *subject, struct kind kind,
                                long climbs, double enough)
{
    struct slab_truth truth;
    struct climb best = {.ratio = -2};
    slab_truth_init(&truth);
    for (; climbs > 0 && !(best.ratio >= enough); climbs--) {
        const struct climb one = climb(draw, subject, kind, &truth);
        if (one.ratio > best.ratio)
            best = one;
    }
    slab_truth_clear(&truth);
    return best;
}

/* Searches all kinds (of axes: those in space); each must come to the ratio that is
 * requested, and none beyond 1. */
static void attack(const struct subject *subject)
{
    struct draw draw;
    draw_begin(&draw, subject->name);
    for (int i = 0; i < KINDS; i++) {
        const struct kind kind = kind_at(i);
        if (subject->axes && kind.dim == 2)
            continue;
        const struct climb worst = search_kind(&draw, subject, kind, draw_sample(30), HUGE_VAL);
        printf("# %s, %s: largest error %.4g of the bound\n", subject->name, kind_text(kind),
               worst.ratio);
        if (!(worst.ratio <= 1))
            referee_fail(&worst.question, "an error beyond its bound");
        if (!(worst.ratio >= subject->ratio))
            referee_fail(&worst.question, "the search finds nothing");
    }
}

/* The search has teeth: it shows for every kind that a bound so much smaller does not hold. */
static void attack_planted(const struct subject *subject)
{
    struct draw draw;
    draw_begin(&draw, subject->name);
    for (int i = 0; i < KINDS; i++) {
        const struct kind kind = kind_at(i);
        const struct climb worst = search_kind(&draw, subject, kind, 500, subject->ratio);
        printf("# %s, %s: an error %.4g of the bound\n", subject->name, kind_text(kind),
               worst.ratio);
        if (!(worst.ratio >= subject->ratio))
            referee_fail(&worst.question, "no error beyond the planted bound");
    }
}

/* ---- Tests ---- */

static bool has_fused_operations(void)
{
#if defined __x86_64__ || defined __i386__
    return __builtin_cpu_supports("fma");
#else
    return true; /* or the compiler has made none */
#endif
}

static void errors_of_slabs_stay_within_their_bounds(void **state)
{
    static const struct subject slabs = {.name = "slabs", .list = slabs_list, .ratio = 0.01};
    attack(&slabs);
}

static void errors_of_kernels_stay_within_their_bounds(void **state)
{
    static const struct subject kernel = {
        .name = "kernels", .kernel = slab_kernel_list, .ratio = 0.01};
    attack(&kernel);
}

static void errors_along_axes_stay_within_their_bound(void **state)
{
    static const struct subject axes = {.name = "axes", .axes = slab_kernel_axes, .ratio = 0.01};
    static const struct subject fused = {
        .name = "fused axes", .axes = fused_slab_kernel_axes, .ratio = 0.01};
    attack(&axes);
    if (has_fused_operations())
        attack(&fused);
}

static void a_wrong_bound_is_found(void **state)
{
    static const struct subject planted = {
        .name = "planted slabs", .list = planted_slabs_list, .ratio = 1.01};
    attack_planted(&planted);
}

static void a_wrong_bound_of_kernels_is_found(void **state)
{
    static const struct subject planted = {
        .name = "planted kernels", .kernel = planted_slab_kernel_list, .ratio = 1.01};
    attack_planted(&planted);
}

/* The derivation holds for fused operations as well: the list has none, kernels have them. */
static void bounds_hold_with_fused_operations(void **state)
{
    static const struct subject fused = {
        .name = "fused slabs", .list = fused_slabs_list, .ratio = 0.01};
    static const struct subject kernel = {
        .name = "fused kernels", .kernel = fused_slab_kernel_list, .ratio = 0.01};
    if (!has_fused_operations())
        skip();
    attack(&fused);
    attack(&kernel);
}

#if defined __x86_64__
static long differences(const struct slab_value *one, const struct slab_value *other, int count)
{
    long different = 0;
    for (int i = 0; i < count; i++)
        different += one[i].middle != other[i].middle;
    return different;
}
#endif

static void fused_operations_are_fused(void **state)
{
#if defined __x86_64__
    if (!has_fused_operations())
        skip();
    struct draw draw;
    long different[2] = {0};
    draw_begin(&draw, "fused_operations_are_fused");
    for (int n = 0; n < 100; n++) {
        struct question question = draw_question(&draw, kind_at(0));
        struct ready ready;
        struct slabs_pair pair;
        struct slab_value plain[SLABS_MAX], fused[SLABS_MAX];
        referee_ready(&question, &ready);
        if (!slab_truth_prepare(&ready.pair, &pair))
            continue;
        const struct frame_pair frames = pair_frames(&ready.pair);
        const int count = slabs_list(&pair, true, plain);
        assert_int_equal(count, fused_slabs_list(&pair, true, fused));
        different[0] += differences(plain, fused, count);
        assert_int_equal(count, slab_kernel_list(&frames, false, plain));
        assert_int_equal(count, fused_slab_kernel_list(&frames, false, fused));
        different[1] += differences(plain, fused, count);
    }
    assert_true(different[0] > 0 && different[1] > 0);
#else
    skip();      /* not every machine has them */
#endif
}

/* ---- The ends of the range ---- */

/* Components whose largest number lies where the range ends, or between; the others are of any
 * size below, subnormal too. */
static void draw_extreme_solid(struct draw *draw, struct solid *solid, int exponent)
{
    for (int i = 0; i < solid->dim; i++) {
        const int largest = draw_int(draw, 0, solid->dim - 1);
        for (int axis = 0; axis < solid->dim; axis++) {
            const int least = draw_coin(draw) ? -1074 : exponent - 60;
            const int e = axis == largest ? exponent : draw_int(draw, least, exponent);
            solid->component[i][axis] = ldexp(draw_number(draw), e);
        }
    }
}

static int draw_exponent(struct draw *draw)
{
    static const int ends[] = {-196, -100, 0, 100, 195};
    return ends[draw_int(draw, 0, (int) COUNT(ends) - 1)];
}

static struct question draw_extreme(struct draw *draw)
{
    struct question question = draw_question(draw, kind_at(draw_int(draw, 0, KINDS - 1)));
    struct solid *solids[2] = {&question.a, &question.b};
    for (int f = 0; f < 2; f++) {
        draw_extreme_solid(draw, solids[f], draw_exponent(draw));
        const int e = draw_coin(draw) ? draw_exponent(draw) : draw_int(draw, -1074, 195);
        for (int axis = 0; axis < question.a.dim; axis++) {
            solids[f]->origin[axis] = ldexp(draw_number(draw), e - draw_int(draw, 0, 50));
            solids[f]->velocity[axis] = ldexp(draw_number(draw), draw_exponent(draw) / 2);
        }
    }
    question.duration = ldexp(question.duration, draw_exponent(draw) / 2);
    return question;
}

static void bounds_hold_at_the_ends_of_the_range(void **state)
{
    static const struct subject subjects[] = {
        {.name = "slabs", .list = slabs_list, .ratio = 0},
        {.name = "kernels", .kernel = slab_kernel_list, .ratio = 0}};
    struct draw draw;
    struct slab_truth truth;
    long said = 0;
    double largest[COUNT(subjects)] = {0};
    draw_begin(&draw, "bounds_hold_at_the_ends_of_the_range");
    slab_truth_init(&truth);
    for (long n = draw_sample(40000); n > 0; n--) {
        struct question question = draw_extreme(&draw);
        const int index = draw_int(&draw, 0, 8 * SLABS_MAX);
        for (size_t i = 0; i < COUNT(subjects); i++) {
            const double ratio = ratio_of(&subjects[i], &question, index, &truth);
            said += ratio >= 0;
            largest[i] = fmax(largest[i], ratio);
            if (ratio > 1)
                referee_fail(&question, subjects[i].name);
        }
    }
    slab_truth_clear(&truth);
    printf("# ends of the range: largest error %.4g of the bound, of kernels %.4g\n", largest[0],
           largest[1]);
    assert_true(said > 0 && largest[0] > 1e-3 && largest[1] > 1e-3);
}

/* ---- Extents ---- */

/* The sign of how far apart boxes along the axes are along one of them, over the window, exactly:
 * that of the gap of the slab across it. */
static int gap_sign(struct slab_truth *truth, const struct pair *pair, int axis)
{
    const int dim = pair->a.body->dim, u = (axis + 1) % dim, v = (axis + 2) % dim;
    slab_truth_set(truth, pair);
    slab_truth_compute(truth, (struct slab_normal){u, v});
    return mpz_sgn(truth->gap);
}

/* Boxes along the axes, end to end along all of them, or nearly. Components may point down; that
 * of the other frame starts where one ends, at the start of the window or at its end. */
static struct question draw_end_to_end(struct draw *draw)
{
    const bool moving = draw_coin(draw);
    const int dim = draw_int(draw, 2, 3);
    struct question question =
        draw_question(draw, (struct kind){dim, moving, FMB_CUBOID, FMB_CUBOID});
    question.duration = draw_coin(draw) ? 1 : question.duration;
    for (int axis = 0; axis < dim; axis++) {
        for (int i = 0; i < dim; i++) {
            double *a = &question.a.component[i][axis], *b = &question.b.component[i][axis];
            *a = i == axis ? ldexp(*a, draw_int(draw, -40, 40)) : 0;
            *b = i == axis ? ldexp(*b, draw_int(draw, -40, 40)) : 0;
        }
        const double far = ldexp(question.a.origin[axis], draw_int(draw, -40, 40));
        const double end = question.a.component[axis][axis];
        const double speed = question.b.velocity[axis] - question.a.velocity[axis];
        question.a.origin[axis] = far;
        question.b.origin[axis] = far + (end > 0 ? end : 0);
        if (question.b.component[axis][axis] < 0)
            question.b.origin[axis] -= question.b.component[axis][axis];
        if (moving && speed < 0 && draw_coin(draw))
            question.b.origin[axis] -= speed * question.duration;
    }
    return question;
}

static void extents_part_no_pair_that_touches(void **state)
{
    struct draw draw;
    struct slab_truth truth;
    long count[3] = {0};
    draw_begin(&draw, "extents_part_no_pair_that_touches");
    slab_truth_init(&truth);
    for (long n = draw_sample(100000); n > 0; n--) {
        struct question question = draw_end_to_end(&draw);
        struct ready ready;
        struct slabs_pair pair;
        referee_ready(&question, &ready);
        if (!slab_truth_prepare(&ready.pair, &pair))
            referee_fail(&question, "doubles say nothing of it");
        int sign = -1;
        for (int axis = 0; axis < question.a.dim; axis++) {
            const int one = gap_sign(&truth, &ready.pair, axis);
            sign = one > sign ? one : sign;
        }
        count[sign + 1]++;
        const struct frame_pair frames = pair_frames(&ready.pair);
        enum certified_path path;
        const enum fmb_verdict verdict = certified_verdict(&frames, &path);
        if (path != CERTIFIED_FILTER)
            continue;
        if (verdict == FMB_SEPARATED && sign <= 0 && !pair.motion.drifts)
            referee_fail(&question, "parted, and they touch");
        if (verdict == FMB_OVERLAPPING && sign >= 0)
            referee_fail(&question, "overlapping, and they do not");
        if (verdict == FMB_SEPARATED && sign <= 0 && pair.motion.drifts &&
            referee_assert(&question) != FMB_SEPARATED)
            referee_fail(&question, "parted, and they meet");
    }
    slab_truth_clear(&truth);
    printf("# end to end: %ld overlap, %ld touch, %ld do not along some axis\n", count[0], count[1],
           count[2]);
    assert_true(count[0] > 0 && count[1] > 0 && count[2] > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_of_slabs_stay_within_their_bounds),
        cmocka_unit_test(errors_of_kernels_stay_within_their_bounds),
        cmocka_unit_test(errors_along_axes_stay_within_their_bound),
        cmocka_unit_test(a_wrong_bound_is_found),
        cmocka_unit_test(a_wrong_bound_of_kernels_is_found),
        cmocka_unit_test(bounds_hold_with_fused_operations),
        cmocka_unit_test(fused_operations_are_fused),
        cmocka_unit_test(bounds_hold_at_the_ends_of_the_range),
        cmocka_unit_test(extents_part_no_pair_that_touches),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
