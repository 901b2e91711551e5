/* A verdict that its certificate does not show becomes an error. */
#include "unit.h"

#include "answers.h"

/* Two unit squares, the second one at (x, 0), and the right answer. */
static struct {
    struct fmb_body body;
    struct fmb_placement placement[2];
    struct fmb_scene scene;
    struct fmb_client_answer answer;
    char certificate[1000];
} squares;

static void place_squares(double x)
{
    static const double edges[] = {1, 0, 0, 1};
    size_t length;
    memset(&squares, 0, sizeof squares);
    assert_int_equal(fmb_body_make(2, FMB_CUBOID, edges, 4, &squares.body), FMB_OK);
    for (int i = 0; i < 2; i++)
        squares.placement[i] = (struct fmb_placement){.id = i + 1, .body = &squares.body};
    squares.placement[1].position[0] = x;
    squares.scene =
        (struct fmb_scene){.placements = squares.placement, .placement_count = 2, .duration = 1};
    squares.answer.b = 1;
    squares.answer.text = "";
    squares.answer.certificate = squares.certificate;
    const struct fmb_placement *a = &squares.placement[0], *b = &squares.placement[1];
    assert_int_equal(fmb_decide(fmb_method_default(), a, b, 1, 0, &squares.answer.answer), FMB_OK);
    assert_int_equal(
        fmb_certificate(a, b, 1, squares.certificate, sizeof squares.certificate, &length), FMB_OK);
}

static const double apart[] = {0.5, 1, 1.5};

static void what_holds_stays_as_it_was(void **state)
{
    for (int i = 0; i < 3; i++) {
        place_squares(apart[i]);
        struct fmb_client_answer answer = squares.answer;
        char text[VERIFY_TEXT_MAX];
        verify_answer(&squares.scene, "the", &answer, text);
        assert_memory_equal(&answer, &squares.answer, sizeof answer);
    }
}

static void expect_refuted(const struct fmb_client_answer *answer)
{
    static const char begin[] = "the service's certificate does not hold: ";
    struct fmb_client_answer refuted = *answer;
    char text[VERIFY_TEXT_MAX];
    verify_answer(&squares.scene, "the service's", &refuted, text);
    assert_int_not_equal(refuted.status, FMB_OK);
    assert_ptr_equal(refuted.text, text);
    assert_memory_equal(text, begin, sizeof begin - 1);
    assert_true(strlen(text) > sizeof begin - 1);
    assert_null(refuted.certificate);
    assert_int_equal(refuted.answer.verdict, 0);
    assert_int_equal(refuted.b, answer->b);
}

static void another_verdict_is_refuted(void **state)
{
    for (int i = 0; i < 3; i++)
        for (int verdict = FMB_SEPARATED; verdict <= FMB_OVERLAPPING; verdict++) {
            place_squares(apart[i]);
            struct fmb_client_answer answer = squares.answer;
            if (answer.answer.verdict == (enum fmb_verdict) verdict)
                continue;
            answer.answer.verdict = (enum fmb_verdict) verdict;
            expect_refuted(&answer);
        }
}

/* The certificate of one scene, word for word, beside another one. */
static void another_scene_s_certificate_is_refuted(void **state)
{
    for (int i = 0; i < 3; i++) {
        place_squares(apart[i]);
        struct fmb_client_answer answer = squares.answer;
        char certificate[1000];
        strcpy(certificate, squares.certificate);
        answer.certificate = certificate;
        place_squares(apart[(i + 1) % 3]);
        expect_refuted(&answer);
    }
}

static void nonsense_is_refuted(void **state)
{
    static char huge[100000];
    memset(huge, '(', sizeof huge - 1);
    const char *const texts[] = {"", "x", "touching", "\"\\", huge};
    place_squares(1);
    for (size_t i = 0; i < COUNT(texts); i++) {
        struct fmb_client_answer answer = squares.answer;
        answer.certificate = texts[i];
        expect_refuted(&answer);
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
