/* Certificates that the maker gives: they hold by the checker, for pairs of all kinds, and prove
 * nothing else, whatever is done to them. The checker has tests of its own
 * (test_engine_certificate_check.c). */

#include "unit.h"

#include <float.h>
#include <math.h>

#include "hard_pairs.h"
#include "referee.h"

enum { TEXT_SIZE = FMB_CERTIFICATE_MAX, WHY_SIZE = 200 };

static const enum fmb_verdict verdicts[] = {FMB_SEPARATED, FMB_TOUCHING, FMB_OVERLAPPING};

/* ---- Spans ---- */

/* The exponents of the lowest and above the highest bit of the numbers of a pair that is not
 * rotated. */
struct span {
    int low, high;
};

/* Adds x, or x y with the product of powers of two above x and y as its bound. */
static void span_add(struct span *span, double x, const double *y)
{
    int exponent_x, exponent_y = 0;
    unsigned __int128 product = (unsigned __int128) ldexp(frexp(fabs(x), &exponent_x), 53);
    int unit = exponent_x - 53;
    if (y) {
        product *= (unsigned __int128) ldexp(frexp(fabs(*y), &exponent_y), 53);
        unit += exponent_y - 53;
    }
    if (product == 0)
        return;
    for (; !(product & 1); product >>= 1)
        unit++;
    span->low = unit < span->low ? unit : span->low;
    span->high = exponent_x + exponent_y > span->high ? exponent_x + exponent_y : span->high;
}

/* Whether fmb.h gives the pair no certificate. In: not rotated, no boxes. */
static bool spans_too_much(const struct question *question)
{
    struct span span = {1 << 20, -(1 << 20)};
    for (int side = 0; side < 2; side++) {
        const struct solid *solid = side == 0 ? &question->a : &question->b;
        for (int axis = 0; axis < solid->dim; axis++) {
            for (int i = 0; i < solid_count(solid); i++)
                span_add(&span, solid->component[i][axis], NULL);
            span_add(&span, solid->origin[axis], NULL);
            if (solid->moving)
                span_add(&span, solid->velocity[axis], &question->duration);
        }
    }
    return span.high - span.low + 1 > 512;
}

/* ---- What must be so of each pair ---- */

static enum fmb_verdict verdict_of(const struct pair *pair)
{
    struct fmb_answer answer;
    assert_int_equal(FMB_OK, pair_decide(fmb_method_by_name("exact"), pair, 0, &answer));
    return answer.verdict;
}

static bool holds(const struct pair *pair, enum fmb_verdict verdict, const char *text)
{
    char why[WHY_SIZE] = "?";
    bool does = pair_certificate_holds(pair, verdict, text, why, sizeof why);
    assert_true(does == (why[0] == '\0'));
    assert_null(strchr(why, '\n'));
    return does;
}

/* The text says what is not so, if it names another verdict. */
static void refute_other_verdicts(const struct question *question, const struct pair *pair,
                                  enum fmb_verdict verdict, const char *text)
{
    for (size_t i = 0; i < COUNT(verdicts); i++)
        if (verdicts[i] != verdict && holds(pair, verdicts[i], text))
            referee_fail(question, "a wrong verdict was proved");
}

/* On output: a certificate, in a buffer of TEXT_SIZE. Returns the verdict. */
static enum fmb_verdict make(const struct question *question, const struct pair *pair, char *text,
                             size_t *length)
{
    memset(text, 'x', 200);
    if (pair_certificate(pair, text, TEXT_SIZE, length) != FMB_OK)
        referee_fail(question, "no certificate");
    if (strlen(text) != *length)
        referee_fail(question, "another length than it has");
    return verdict_of(pair);
}

static void assert_certificate_holds(const struct question *question, const struct pair *pair,
                                     enum fmb_verdict verdict, const char *text)
{
    char why[WHY_SIZE];
    if (pair_certificate_holds(pair, verdict, text, why, sizeof why))
        return;
    printf("# %.1000s\n# %s\n", text, why);
    referee_fail(question, "the certificate does not hold");
}

static void certificates_of_family_hold(void **state)
{
    const struct hard_family *family = *state;
    long count[4] = {0};
    size_t length, longest[4] = {0}, total[4] = {0};
    char *text = malloc(TEXT_SIZE);
    struct draw draw;
    draw_begin(&draw, family->name);
    for (long n = draw_sample(family->usual / 3); n > 0; n--) {
        struct question question;
        struct ready ready;
        hard_draw(&draw, family, &question);
        referee_ready(&question, &ready);
        const struct pair orders[] = {ready.pair,
                                      {ready.pair.b, ready.pair.a, ready.pair.duration}};
        for (size_t i = 0; i < COUNT(orders); i++) {
            enum fmb_verdict verdict = make(&question, &orders[i], text, &length);
            if (spans_too_much(&question) != (length == 0))
                referee_fail(&question, "a certificate, or none, against what fmb.h says");
            count[verdict]++;
            if (length == 0) {
                refute_other_verdicts(&question, &orders[i], 0, text);
                continue;
            }
            assert_certificate_holds(&question, &orders[i], verdict, text);
            refute_other_verdicts(&question, &orders[i], verdict, text);
            total[verdict] += length;
            longest[verdict] = length > longest[verdict] ? length : longest[verdict];
        }
    }
    for (size_t i = 0; i < COUNT(verdicts); i++) {
        const enum fmb_verdict v = verdicts[i];
        printf("# %s: %ld %s, %zu characters on average, at most %zu\n", family->name, count[v],
               fmb_verdict_name(v), count[v] ? total[v] / (size_t) count[v] : 0, longest[v]);
    }
    free(text);
}

/* ---- Texts that something happened to ---- */

static void put_verdict(const char *text, enum fmb_verdict verdict, char *out, size_t size)
{
    snprintf(out, size, "%s%s", fmb_verdict_name(verdict), text + strcspn(text, " "));
}

/* A truncated text proves no other verdict, and none without weights of both frames. It may hold if
 * the weight that is missing follows from the others. */
static void cut_everywhere(const struct question *question, const struct pair *pair,
                           enum fmb_verdict verdict, const char *text)
{
    char cut[1000];
    const size_t length = strlen(text);
    for (size_t left = 0; left < length && length < sizeof cut; left++) {
        snprintf(cut, left + 1, "%s", text);
        refute_other_verdicts(question, pair, verdict, cut);
        if (!strstr(cut, " b ") && holds(pair, verdict, cut))
            referee_fail(question, "a certificate that was cut holds");
    }
}

/* A few bytes changed, taken out or put in; it may still be right, but then of this verdict. */
static void garble(struct draw *draw, char *text, size_t size)
{
    static const char bytes[] = "0123456789- /():+xabvdz\n\x01\x7f\xff";
    for (int times = draw_int(draw, 1, 3); times > 0; times--) {
        const size_t length = strlen(text);
        char *at = text + draw_int(draw, 0, (int) length - 1);
        const char byte = bytes[draw_int(draw, 0, (int) sizeof bytes - 2)];
        switch (draw_int(draw, 0, 2)) {
        case 0: *at = byte; break;
        case 1: memmove(at, at + 1, strlen(at)); break;
        case 2:
            if (length + 1 < size) {
                memmove(at + 1, at, strlen(at) + 1);
                *at = byte;
            }
        }
    }
}

static void tampered_texts_prove_no_wrong_verdict(void **state)
{
    struct draw draw;
    size_t families = 0;
    draw_begin(&draw, "tampered_texts_prove_no_wrong_verdict");
    while (hard_family_at(families))
        families++;
    char *text = malloc(TEXT_SIZE), other[1000];
    for (long n = draw_sample(800); n > 0; n--) {
        struct question question;
        struct ready ready;
        size_t length;
        hard_draw(&draw, hard_family_at((size_t) draw_int(&draw, 0, (int) families - 1)),
                  &question);
        referee_ready(&question, &ready);
        const enum fmb_verdict verdict = make(&question, &ready.pair, text, &length);
        if (length == 0)
            continue;
        cut_everywhere(&question, &ready.pair, verdict, text);
        for (size_t i = 0; i < COUNT(verdicts); i++) {
            put_verdict(text, verdicts[i], other, sizeof other);
            refute_other_verdicts(&question, &ready.pair, verdict, other);
        }
        for (int times = 0; times < 20; times++) {
            put_verdict(text, verdicts[times % COUNT(verdicts)], other, sizeof other);
            garble(&draw, other, sizeof other);
            refute_other_verdicts(&question, &ready.pair, verdict, other);
            holds(&ready.pair, verdict, other);
        }
    }
    free(text);
}

static void certificates_of_other_pairs_prove_no_wrong_verdict(void **state)
{
    struct draw draw;
    draw_begin(&draw, "certificates_of_other_pairs_prove_no_wrong_verdict");
    char *text[2] = {malloc(TEXT_SIZE), malloc(TEXT_SIZE)};
    for (long n = draw_sample(6000); n > 0; n--) {
        struct question question[2];
        struct ready ready[2];
        enum fmb_verdict verdict[2];
        size_t length;
        hard_draw(&draw, hard_family_at(0), &question[0]); /* of small whole numbers */
        question[1] = question[0];
        draw_integers(&draw, question[1].b.dim, -3, 3, question[1].b.origin);
        for (int i = 0; i < 2; i++) {
            referee_ready(&question[i], &ready[i]);
            verdict[i] = make(&question[i], &ready[i].pair, text[i], &length);
        }
        for (int i = 0; i < 2; i++)
            refute_other_verdicts(&question[i], &ready[i].pair, verdict[i], text[1 - i]);
    }
    free(text[0]);
    free(text[1]);
}

/* ---- Lengths ---- */

static int compare_lengths(const void *x, const void *y)
{
    const size_t *a = x, *b = y;
    return (*a > *b) - (*a < *b);
}

/* Numbers of 53 bits, rotated, half of the pairs moving: half of all texts, also of those of
 * overlapping boxes, are shorter than 200 characters. */
static void texts_are_short(void **state)
{
    enum { TEXTS = 400 };
    const size_t texts = TEXTS / (size_t) draw_step(10);
    static const int counts[] = {
        [FMB_CUBOID] = 12, [FMB_TETRAHEDRON] = 12, [FMB_FACE] = 9, [FMB_BOX] = 6};
    struct draw draw;
    draw_begin(&draw, "texts_are_short");
    for (int shape = FMB_CUBOID; shape <= FMB_BOX; shape++) {
        size_t lengths[TEXTS], count = 0;
        while (count < texts) {
            struct fmb_body body[2];
            struct fmb_placement place[2] = {{.body = &body[0]}, {.body = &body[1]}};
            struct pair pair;
            char text[TEXT_SIZE];
            for (int f = 0; f < 2; f++) {
                double numbers[12];
                for (int i = 0; i < counts[shape]; i++)
                    numbers[i] = draw_uniform(&draw, shape == FMB_BOX && i > 2 ? 0.3 : -1, 1);
                assert_int_equal(fmb_body_make(3, shape, numbers, (size_t) counts[shape], &body[f]),
                                 FMB_OK);
                place[f].orientation_count = 4;
                for (int i = 0; i < 4; i++)
                    place[f].orientation[i] = draw_uniform(&draw, -1, 1);
                for (int i = 0; i < 3 && count % 2; i++)
                    place[f].velocity[i] = draw_uniform(&draw, -1, 1);
            }
            pair = (struct pair){place[0], place[1], 1};
            size_t length;
            assert_int_equal(FMB_OK, pair_certificate(&pair, text, sizeof text, &length));
            if (verdict_of(&pair) != FMB_OVERLAPPING)
                continue;
            assert_true(holds(&pair, FMB_OVERLAPPING, text));
            lengths[count++] = length;
        }
        qsort(lengths, texts, sizeof *lengths, compare_lengths);
        printf("# %s: %zu characters, of nine in ten %zu, at most %zu\n", fmb_shape_name(shape),
               lengths[texts / 2], lengths[9 * texts / 10], lengths[texts - 1]);
        assert_true(lengths[texts / 2] < 200);
    }
}

/* ---- By hand ---- */

static void assert_made(const struct question *question, const char *expected)
{
    struct ready ready;
    char text[200];
    size_t length;
    referee_ready(question, &ready);
    assert_int_equal(FMB_OK, pair_certificate(&ready.pair, text, sizeof text, &length));
    assert_string_equal(expected, text);
    assert_int_equal(strlen(expected), length);
}

/* Unit cubes. B begins at x and, if moving, goes on by 1 along x. */
static struct question cubes(double x, bool moving)
{
    return (struct question){
        .a = {3, FMB_CUBOID, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0}, {0}, false},
        .b = {3, FMB_CUBOID, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {x, 0, 0}, {0.5, 0, 0}, moving},
        .duration = 2};
}

static void what_is_made_of_cubes(void **state)
{
    const struct question apart = cubes(3, false), touching = cubes(1, false);
    const struct question overlapping = cubes(0.75, false), arriving = cubes(-2, true);
    const struct question passing = cubes(-1.5, true);
    assert_made(&apart, "separated normal (1 0 0)");
    assert_made(&touching, "touching normal (1 0 0) at 0 a 1 b 0");
    assert_made(&overlapping, "overlapping at 0 a 0 1 2:1/16 4 b 0 1:1/16 2 4:1/16");
    assert_made(&arriving, "touching normal (-1 0 0) at 2 a 0 b 1");
    assert_made(&passing, "overlapping at 3/2 a 0 1:1/16 2:1/16 4:1/16 b 0 1 2 4");
}

/* Flat frames along the first axes; B is at place. */
static struct question flat_frames(int rank, const double place[3])
{
    struct question question = {.a = {.dim = 3, .shape = FMB_CUBOID}, .duration = 1};
    for (int i = 0; i < rank; i++)
        question.a.component[i][i] = 1;
    question.b = question.a;
    memcpy(question.b.origin, place, sizeof question.b.origin);
    return question;
}

static void what_is_made_of_flat_frames(void **state)
{
    static const struct {
        int rank;
        double place[3];
        const char *text;
    } cases[] = {
        {2, {0, 0, 1}, "separated normal (0 0 1)"},
        {2, {3, 0, 0}, "separated normal (1 0 0)"},
        {2, {1, 1, 0}, "touching normal (0 1 0) at 0 a 3 b 0"},
        {2, {0, 0, 0}, "overlapping at 0 a 0 1 2:3/8 b 0 1:1/8 2"},
        {1, {3, 0, 0}, "separated normal (1 0 0)"},
        {1, {0, 3, 0}, "separated normal (0 1 0)"},
        {1, {1, 0, 0}, "touching normal (1 0 0) at 0 a 1 b 0"},
        {0, {0, 0, 3}, "separated normal (0 0 1)"},
        {0, {0, 0, 0}, "overlapping at 0 a 0 b 0"},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        const struct question question = flat_frames(cases[i].rank, cases[i].place);
        assert_made(&question, cases[i].text);
    }
}

/* ---- Sizes and refusals ---- */

/* The widest span with a certificate, and one bit more: of numbers at rest, of v T, of a box, whose
 * unit is half its size, and of a rotation, whose squared quaternion multiplies all numbers. */
static void certificates_end_with_the_span(void **state)
{
    static const struct {
        int shape;
        bool moving, turned;
        int exponent; /* of the farthest coordinate that has a certificate */
    } cases[] = {{FMB_CUBOID, false, false, 510},
                 {FMB_CUBOID, true, false, 509},
                 {FMB_BOX, false, false, 509},
                 {FMB_CUBOID, false, true, 508}};
    static const double numbers[] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, size[] = {1, 1, 1};
    for (size_t i = 0; i < COUNT(cases); i++)
        for (int more = 0; more < 2; more++) {
            const bool box = cases[i].shape == FMB_BOX;
            const double far = ldexp(-1, cases[i].exponent + more);
            struct fmb_body body;
            char text[FMB_CERTIFICATE_MAX] = "#", why[WHY_SIZE];
            size_t length = 1;
            assert_int_equal(
                fmb_body_make(3, cases[i].shape, box ? size : numbers, box ? 3 : 9, &body), FMB_OK);
            const struct fmb_placement a = {.body = &body};
            struct fmb_placement b = {.body = &body};
            (cases[i].moving ? b.velocity : b.position)[1] = far;
            b.orientation_count = cases[i].turned ? 4 : 0;
            for (int k = 0; k < b.orientation_count; k++)
                b.orientation[k] = 0.75;
            assert_int_equal(fmb_certificate(&a, &b, 1, text, sizeof text, &length), FMB_OK);
            assert_int_equal(strlen(text), length);
            assert_true(more == (length == 0));
            const enum fmb_verdict verdict = cases[i].moving ? FMB_OVERLAPPING : FMB_SEPARATED;
            assert_true(fmb_certificate_holds(&a, &b, 1, verdict, text, why, sizeof why) == !more);
        }
}

static void too_small_a_size_is_reported(void **state)
{
    const struct question question = cubes(1, false);
    struct ready ready;
    char text[64];
    size_t length, needed;
    referee_ready(&question, &ready);
    assert_int_equal(FMB_OVER_LIMIT, pair_certificate(&ready.pair, NULL, 0, &needed));
    for (size_t size = 0; size < sizeof text; size++) {
        memset(text, '#', sizeof text);
        enum fmb_status status = pair_certificate(&ready.pair, text, size, &length);
        assert_int_equal(needed, length);
        assert_int_equal(size > needed ? FMB_OK : FMB_OVER_LIMIT, status);
        if (size > 0)
            assert_int_equal(size > needed ? needed : 0, strlen(text));
        for (size_t i = size; i < sizeof text; i++)
            assert_int_equal('#', text[i]);
    }
}

static void assert_refused(const struct pair *pair, enum fmb_status status)
{
    char text[64] = "#", why[WHY_SIZE];
    size_t length = 1;
    assert_int_equal(status, pair_certificate(pair, text, sizeof text, &length));
    assert_int_equal(0, length);
    assert_string_equal("", text);
    assert_false(
        pair_certificate_holds(pair, FMB_SEPARATED, "separated normal (1 0 0)", why, sizeof why));
    assert_string_equal(fmb_status_text(status), why);
}

static void bad_pairs_are_refused(void **state)
{
    const struct question question = cubes(3, true);
    struct question flat_one = cubes(3, true);
    struct ready ready, plane;
    referee_ready(&question, &ready);
    flat_one.a.dim = flat_one.b.dim = 2;
    referee_ready(&flat_one, &plane);

    struct pair pair = ready.pair;
    pair.a = plane.pair.a;
    assert_refused(&pair, FMB_DIMENSIONS_DIFFER);
    pair = ready.pair;
    pair.b.velocity[1] = NAN;
    assert_refused(&pair, FMB_NOT_FINITE);
    pair = ready.pair;
    pair.duration = -1;
    assert_refused(&pair, FMB_BAD_DURATION);
}

int main(void)
{
    const struct CMUnitTest others[] = {
        cmocka_unit_test(what_is_made_of_cubes),
        cmocka_unit_test(what_is_made_of_flat_frames),
        cmocka_unit_test(texts_are_short),
        cmocka_unit_test(certificates_end_with_the_span),
        cmocka_unit_test(too_small_a_size_is_reported),
        cmocka_unit_test(bad_pairs_are_refused),
        cmocka_unit_test(tampered_texts_prove_no_wrong_verdict),
        cmocka_unit_test(certificates_of_other_pairs_prove_no_wrong_verdict),
    };
    struct CMUnitTest tests[HARD_FAMILIES_MAX + COUNT(others)];
    size_t count = 0;
    for (; hard_family_at(count); count++)
        tests[count] =
            (struct CMUnitTest){.name = hard_family_at(count)->name,
                                .test_func = certificates_of_family_hold,
                                .initial_state = (void *) (uintptr_t) hard_family_at(count)};
    memcpy(&tests[count], others, sizeof others);
    return _cmocka_run_group_tests("engine_certificate", tests, count + COUNT(others), NULL, NULL);
}
