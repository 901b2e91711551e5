/* Families of pairs with a hull against the oracle. */

#include "unit.h"

#include "oracle.h"
#include "posed.h"
#include "trial.h"

static void fail_of(const struct trial *trial, const char *why)
{
    printf("# %s\n", why);
    question_print(&trial->question);
    fail_msg("%s", why);
}

static bool has_one_frame(const struct question *question)
{
    return solid_frames(&question->a) == 1 && solid_frames(&question->b) == 1;
}

/* Both certain methods in both orders against the truth; the inexact ones refuse frames. */
static enum fmb_verdict expect_truth(const struct trial *trial)
{
    char why[200];
    struct reply reply[2];
    struct oracle_answer truth;
    oracle_init(&truth);
    oracle_decide(&trial->pair[0], FMB_WANT_BOX, &truth);
    for (int m = 0; m < trial_methods(); m++) {
        const struct fmb_method *method = fmb_method_at((size_t) m);
        const bool exact = strcmp(method->name, "exact") == 0;
        for (int order = 0; order < 2; order++)
            reply[order] = trial_decide(trial, method, order,
                                        method->certain ? FMB_WANT_BOX | FMB_WANT_POINT : 0);
        if (!method->certain) {
            for (int order = 0; order < 2; order++)
                if (has_one_frame(&trial->question) && reply[order].status != FMB_CANNOT_DECIDE)
                    fail_of(trial, "an inexact method decides");
            continue;
        }
        assert_int_equal(reply[0].status, FMB_OK);
        if (!oracle_agrees(&truth, &trial->pair[0], &reply[0].answer,
                           exact ? ORACLE_TIGHTEST : ORACLE_DESIGN, why, sizeof why))
            fail_of(trial, why);
        if (!reply_same(&reply[0], &reply[1]))
            fail_of(trial, "other bits in the other order");
    }
    oracle_clear(&truth);
    return truth.verdict;
}

static void families_are_right(void **state)
{
    long pairs = 0;
    for (size_t f = 0; family_posed_at(f); f++) {
        const struct family *family = family_posed_at(f);
        struct cell cells[CELL_OF_ALL_SHAPES];
        const int count = family->cells & FAMILY_A_HULL ? family_cells(family, cells) : 0;
        for (int c = 0; c < count; c++) {
            struct draw draw = cell_draw(7, family->name, &cells[c], 0);
            struct question question;
            struct trial trial;
            family_draw(family, &cells[c], &draw, &question);
            trial_begin(&question, &trial);
            const enum fmb_verdict verdict = expect_truth(&trial);
            if (family->verdict != 0 && (int) verdict != family->verdict)
                fail_of(&trial, "not the verdict that the family has");
            trial_end(&trial);
            pairs++;
        }
    }
    printf("# %ld pairs\n", pairs);
    assert_true(pairs > 700);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(families_are_right),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
