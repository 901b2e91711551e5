/* A verdict that its certificate does not show becomes an error. */
#include "unit.h"

#include "answers.h"

/* Two unit squares, the second one at (x, 0), and the right outcome. */
static struct {
    struct scene_body body[2];
    struct scene scene;
    struct outcome outcome;
    char certificate[1000];
} squares;

static void place_squares(double x)
{
    static const double edges[] = {1, 0, 0, 1};
    size_t length;
    memset(&squares, 0, sizeof squares);
    for (int i = 0; i < 2; i++) {
        squares.body[i].id = i + 1;
        assert_int_equal(fmb_body_make(2, FMB_CUBOID, edges, 4, &squares.body[i].body), FMB_OK);
    }
    squares.body[1].position[0] = x;
    squares.scene = (struct scene){
        .dim = 2, .duration = 1, .body_count = 2, .body = squares.body, .all_pairs = true};
    squares.outcome.pair = (struct scene_pair){.a = 0, .b = 1};
    squares.outcome.certificate = squares.certificate;
    const struct fmb_placement a = scene_placement(&squares.body[0]);
    const struct fmb_placement b = scene_placement(&squares.body[1]);
    assert_int_equal(fmb_decide(fmb_method_default(), &a, &b, 1, 0, &squares.outcome.answer),
                     FMB_OK);
    assert_int_equal(
        fmb_certificate(&a, &b, 1, squares.certificate, sizeof squares.certificate, &length),
        FMB_OK);
}

static const double apart[] = {0.5, 1, 1.5};

static void what_holds_stays_as_it_was(void **state)
{
    for (int i = 0; i < 3; i++) {
        place_squares(apart[i]);
        struct outcome outcome = squares.outcome;
        char text[VERIFY_TEXT_MAX];
        verify_outcome(&squares.scene, "the", &outcome, text);
        assert_memory_equal(&outcome, &squares.outcome, sizeof outcome);
    }
}

static void expect_refuted(const struct outcome *outcome)
{
    static const char begin[] = "the service's certificate does not hold: ";
    struct outcome refuted = *outcome;
    char text[VERIFY_TEXT_MAX];
    verify_outcome(&squares.scene, "the service's", &refuted, text);
    assert_ptr_equal(refuted.error, text);
    assert_memory_equal(text, begin, sizeof begin - 1);
    assert_true(strlen(text) > sizeof begin - 1);
    assert_null(refuted.certificate);
    assert_int_equal(refuted.answer.verdict, 0);
    assert_int_equal(refuted.pair.b, outcome->pair.b);
}

static void another_verdict_is_refuted(void **state)
{
    for (int i = 0; i < 3; i++)
        for (int verdict = FMB_SEPARATED; verdict <= FMB_OVERLAPPING; verdict++) {
            place_squares(apart[i]);
            struct outcome outcome = squares.outcome;
            if (outcome.answer.verdict == (enum fmb_verdict) verdict)
                continue;
            outcome.answer.verdict = (enum fmb_verdict) verdict;
            expect_refuted(&outcome);
        }
}

/* The certificate of one scene, word for word, beside another one. */
static void another_scene_s_certificate_is_refuted(void **state)
{
    for (int i = 0; i < 3; i++) {
        place_squares(apart[i]);
        struct outcome outcome = squares.outcome;
        char certificate[1000];
        strcpy(certificate, squares.certificate);
        outcome.certificate = certificate;
        place_squares(apart[(i + 1) % 3]);
        expect_refuted(&outcome);
    }
}

static void nonsense_is_refuted(void **state)
{
    static char huge[100000];
    memset(huge, '(', sizeof huge - 1);
    const char *const texts[] = {"", "x", "touching", "\"\\", huge};
    place_squares(1);
    for (size_t i = 0; i < COUNT(texts); i++) {
        struct outcome outcome = squares.outcome;
        outcome.certificate = texts[i];
        expect_refuted(&outcome);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_holds_stays_as_it_was),
        cmocka_unit_test(another_verdict_is_refuted),
        cmocka_unit_test(another_scene_s_certificate_is_refuted),
        cmocka_unit_test(nonsense_is_refuted),
    };
    return cmocka_run_group_tests_name("verify", tests, NULL, NULL);
}
