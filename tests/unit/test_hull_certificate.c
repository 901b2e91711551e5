/* Certificates of pairs with a hull: of shapes given by their vertices they prove the verdict of
 * the shapes, of other hulls one verdict and no other, and no change of the text proves another
 * one. */

#include "unit.h"

#include <math.h>

#include "draw.h"
#include "hull_draw.h"
#include "referee.h"

enum { TEXT_SIZE = FMB_CERTIFICATE_MAX, WHY_SIZE = 200 };

/* Writes and checks the certificate. Returns the verdict that it proves; 0: none. */
static enum fmb_verdict prove(const struct pair *pair, char text[TEXT_SIZE])
{
    char why[WHY_SIZE];
    size_t length;
    assert_int_equal(pair_certificate(pair, text, TEXT_SIZE, &length), FMB_OK);
    if (length == 0)
        return 0;
    for (int verdict = FMB_SEPARATED; verdict <= FMB_OVERLAPPING; verdict++) {
        const char *name = fmb_verdict_name(verdict);
        if (strncmp(text, name, strlen(name)) != 0)
            continue;
        if (!pair_certificate_holds(pair, verdict, text, why, sizeof why)) {
            print_message("%s\n%s\n", text, why);
            return 0;
        }
        return verdict;
    }
    return 0;
}

static void shapes_by_their_vertices(void **state)
{
    struct draw draw;
    int verdicts[4] = {0};
    size_t longest = 0;
    draw_begin(&draw, "shapes_by_their_vertices");
    for (long i = draw_sample(3000); i > 0; i--) {
        const struct question question = hull_draw_question(&draw);
        struct ready ready;
        struct shape_hull hull[2];
        struct fmb_answer answer;
        char text[TEXT_SIZE];
        referee_ready(&question, &ready);
        assert_int_equal(pair_decide(fmb_method_default(), &ready.pair, 0, &answer), FMB_OK);
        hull_replace(&question, (unsigned) draw_int(&draw, 1, 3), hull, &ready.pair);
        const enum fmb_verdict verdict = prove(&ready.pair, text);
        longest = strlen(text) > longest ? strlen(text) : longest;
        if (verdict != answer.verdict)
            referee_fail(&question, text);
        verdicts[verdict]++;
    }
    print_message("%d separated, %d touching, %d overlapping, at most %zu characters\n",
                  verdicts[1], verdicts[2], verdicts[3], longest);
    assert_true(verdicts[1] > 0 && verdicts[2] > 0 && verdicts[3] > 0);
}

/* Small whole numbers: flat hulls, segments and points, touching and overlapping in every way. */
static void small_hulls(void **state)
{
    struct draw draw;
    int verdicts[4] = {0};
    draw_begin(&draw, "small_hulls");
    for (long i = draw_sample(10000); i > 0; i--) {
        struct hull_pair_draw drawn;
        char text[TEXT_SIZE], other[TEXT_SIZE];
        hull_draw_small(&draw, &drawn);
        const enum fmb_verdict verdict = prove(&drawn.pair, text);
        const struct pair swapped = {drawn.pair.b, drawn.pair.a, drawn.pair.duration};
        if (!verdict || prove(&swapped, other) != verdict)
            fail_msg("%s | %s", text, other);
        for (int exact = 0; exact < 2; exact++) {
            struct fmb_answer answer;
            assert_int_equal(pair_decide(fmb_method_by_name(exact ? "exact" : "certified"),
                                         &drawn.pair, 0, &answer),
                             FMB_OK);
            assert_int_equal(answer.verdict, verdict);
        }
        verdicts[verdict]++;
    }
    print_message("%d separated, %d touching, %d overlapping\n", verdicts[1], verdicts[2],
                  verdicts[3]);
    assert_true(verdicts[1] > 0 && verdicts[2] > 0 && verdicts[3] > 0);
}

/* One character replaced, left out or added. */
static void tamper(struct draw *draw, char text[TEXT_SIZE + 1])
{
    static const char characters[] = "0123456789-/: ()abdnst";
    const size_t length = strlen(text), at = (size_t) draw_int(draw, 0, (int) length - 1);
    const char c = characters[draw_int(draw, 0, (int) sizeof characters - 2)];
    switch (draw_int(draw, 0, 2)) {
    case 0: text[at] = c; break;
    case 1: memmove(text + at, text + at + 1, length - at); break;
    default: memmove(text + at + 1, text + at, length - at + 1); text[at] = c;
    }
}

static void tampered_texts_prove_no_wrong_verdict(void **state)
{
    struct draw draw;
    long held = 0;
    draw_begin(&draw, "tampered_texts_prove_no_wrong_verdict");
    for (long i = draw_sample(2000); i > 0; i--) {
        struct hull_pair_draw drawn;
        char text[TEXT_SIZE + 1], changed[TEXT_SIZE + 1];
        hull_draw_small(&draw, &drawn);
        const enum fmb_verdict verdict = prove(&drawn.pair, text);
        for (int change = 0; change < 20; change++) {
            memcpy(changed, text, sizeof changed);
            tamper(&draw, changed);
            for (int other = 0; other <= 4; other++) {
                const bool holds = fmb_certificate_holds(
                    &drawn.pair.a, &drawn.pair.b, drawn.pair.duration, other, changed, NULL, 0);
                if (holds && other != (int) verdict)
                    fail_msg("%s | %s", text, changed);
                held += holds && strcmp(text, changed) != 0;
            }
        }
    }
    /* Another normal, or another point, may prove the same. */
    print_message("%ld of the changed texts hold\n", held);
    assert_true(held > 0);
}

/* Each flaw that the checker names, by hand: two squares that share an edge. */
static void flaws_are_named(void **state)
{
    static const double a[] = {0, 0, 1, 0, 1, 1, 0, 1}, b[] = {1, 0, 2, 0, 2, 1, 1, 1};
    static const struct {
        const char *text, *why;
        int verdict;
    } cases[] = {
        {"touching normal (1 0) at 0 a 1:1/2 2:1/2 b 0:1/2 3:1/2", "", FMB_TOUCHING},
        {"touching normal (1 0) at 0 a 1:1/2 2 b 0 3", "", FMB_TOUCHING},
        {"touching normal (2 0) at 0 a 1:1 b 0:1", "", FMB_TOUCHING},
        {"touching normal (1 0) at 0 a 1 b 0", "", FMB_TOUCHING},
        {"touching normal (0 1) at 0 a 1:1 b 0:1", "two sides", FMB_TOUCHING},
        {"touching normal (0 0) at 0 a 1:1 b 0:1", "constant", FMB_TOUCHING},
        {"touching normal (1 0) at 1 a 1:1 b 0:1", "window", FMB_TOUCHING},
        {"touching normal (1 0) at 0 a 2:1 b 0:1", "no common point", FMB_TOUCHING},
        {"touching normal (1 0) at 0 a 1:1 b 3:1", "no common point", FMB_TOUCHING},
        {"touching normal (1 0) at 0 a 1 b 3", "no common point", FMB_TOUCHING},
        {"touching normal (1 0) at 0 a 1:1/2 b 0:1", "no common point", FMB_TOUCHING},
        {"touching normal (1 0) at 0 a 1 2 b 0 3", "do not follow", FMB_TOUCHING},
        {"touching normal (1 0) at 0 a 0 1 2 3 b 0 1", "weights", FMB_TOUCHING},
        {"touching normal (1 0) at 0 a 1:3/2 2 b 0 3", "not positive", FMB_TOUCHING},
        {"touching normal (1 0) at 0 a 1:3/2 2 b 0:1 3", "no common point", FMB_TOUCHING},
        {"touching normal (1 0) at 0 a 1 2 b 0:1", "not positive", FMB_TOUCHING},
        {"touching normal (1 0) at 0 a 1:1 b", "weights", FMB_TOUCHING},
        {"touching normal (1 0) at 0 a 1:2 1:-1 b 0:1", "weights", FMB_TOUCHING},
        {"touching normal (1 0) at 0 a 1:1/2 1:1/2 b 0:1", "weights", FMB_TOUCHING},
        {"touching normal (1 0) at 0 a 4:1 b 0:1", "weights", FMB_TOUCHING},
        {"touching normal (1 0) at 0 a 4 b 0:1", "weights", FMB_TOUCHING},
        {"touching normal (1 0) at 0 a 0:0 1:1 b 0:1", "weights", FMB_TOUCHING},
        {"touching normal (1 0) at 0 a 1:2/2 b 0:1", "weights", FMB_TOUCHING},
        {"touching normal (1 0) at 0 a 1: b 0:1", "weights", FMB_TOUCHING},
        {"touching normal (1 0) at 0 a 1:1 b 0:1 ", "follows", FMB_TOUCHING},
        {"touching normal (1 0) at 0 (1 0) a 1:1 b 0:1", "weights", FMB_TOUCHING},
        {"touching normal (1 0 0) at 0 a 1:1 b 0:1", "normal", FMB_TOUCHING},
        {"touching + a0 at 0 a 1:1 b 0:1", "normal", FMB_TOUCHING},
        {"touching normal (1 0) at 0/1 a 1:1 b 0:1", "time", FMB_TOUCHING},
        {"separated normal (1 0)", "apart", FMB_SEPARATED},
        {"overlapping at 0 a 1:1 b 0:1", "span the first frame", FMB_OVERLAPPING},
        {"overlapping at 0 a 1:1/2 2:1/2 b 0:1/2 3:1/2", "span the first", FMB_OVERLAPPING},
    };
    double memory[2][64];
    struct fmb_body body[2];
    assert_int_equal(fmb_body_make_hull(2, a, COUNT(a), memory[0], &body[0]), FMB_OK);
    assert_int_equal(fmb_body_make_hull(2, b, COUNT(b), memory[1], &body[1]), FMB_OK);
    const struct fmb_placement first = {.body = &body[0]}, second = {.body = &body[1]};
    for (size_t i = 0; i < COUNT(cases); i++) {
        char why[WHY_SIZE] = "";
        const bool holds = fmb_certificate_holds(&first, &second, 0, cases[i].verdict,
                                                 cases[i].text, why, sizeof why);
        if (holds != (cases[i].why[0] == '\0') || !strstr(why, cases[i].why))
            fail_msg("%s: %s", cases[i].text, why);
    }
}

/* Cubes at a distance of 2^510: f - e = 511, and one bit of m (fmb.h). */
static void numbers_that_span_too_many_bits_have_none(void **state)
{
    static const double cube[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1};
    double memory[64];
    struct fmb_body body;
    char text[TEXT_SIZE];
    assert_int_equal(fmb_body_make_hull(3, cube, COUNT(cube), memory, &body), FMB_OK);
    for (int exponent = 510; exponent <= 511; exponent++) {
        const struct pair pair = {
            {.body = &body}, {.body = &body, .position = {0, ldexp(-1, exponent)}}, .duration = 1};
        assert_int_equal(prove(&pair, text), exponent == 510 ? FMB_SEPARATED : 0);
        assert_int_equal(text[0] == '\0', exponent > 510);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shapes_by_their_vertices),
        cmocka_unit_test(small_hulls),
        cmocka_unit_test(tampered_texts_prove_no_wrong_verdict),
        cmocka_unit_test(flaws_are_named),
        cmocka_unit_test(numbers_that_span_too_many_bits_have_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
