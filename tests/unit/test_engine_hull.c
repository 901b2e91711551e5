/* Families of pairs with a hull against the oracle, and through all ways to decide them: single
 * pairs, batches and scenes to the bit. */

#include "unit.h"

#include <math.h>

#include "oracle.h"
#include "posed.h"
#include "trial.h"

static void fail_of(const struct trial *trial, const char *why)
{
    printf("# %s\n", why);
    question_print(&trial->question);
    fail_msg("%s", why);
}

static bool same_bits(const double *x, const double *y, size_t count)
{
    return memcmp(x, y, count * sizeof *x) == 0;
}

/* Whether arrays of a batch or a scene hold the answer; NAN where it has none. */
static bool holds(const struct fmb_answer *answer, unsigned char verdict, const double *contact,
                  const double (*box)[FMB_DIM_MAX])
{
    if (verdict != answer->verdict)
        return false;
    if (!answer->has_contact)
        return isnan(contact[0]) && isnan(contact[1]) && isnan(box[0][0]);
    return same_bits(contact, answer->contact, 2) &&
           same_bits(box[0], answer->box[0], 2 * FMB_DIM_MAX);
}

static void expect_batch(const struct trial *trial, const struct fmb_answer *answer)
{
    static const unsigned pair[1][2] = {{0, 1}};
    const struct pair *of = &trial->pair[0];
    struct fmb_prepared frames[2];
    unsigned char verdict;
    double contact[1][2], box[1][2][FMB_DIM_MAX];
    assert_int_equal(fmb_prepare(&of->a, 0, 1, &frames[0]), FMB_OK);
    assert_int_equal(fmb_prepare(&of->b, 0, 1, &frames[1]), FMB_OK);
    const struct fmb_batch batch = {.frames = frames,
                                    .frame_count = 2,
                                    .pairs = pair,
                                    .pair_count = 1,
                                    .duration = of->duration,
                                    .verdicts = &verdict,
                                    .contacts = contact,
                                    .boxes = box};
    assert_int_equal(fmb_decide_batch(&batch), FMB_OK);
    if (!holds(answer, verdict, contact[0], (const double(*)[FMB_DIM_MAX]) box[0]))
        fail_of(trial, "other bits in a batch");
    enum fmb_verdict alone;
    assert_int_equal(fmb_decide_prepared(&frames[0], &frames[1], of->duration, &alone), FMB_OK);
    if (alone != answer->verdict)
        fail_of(trial, "another verdict of prepared frames");
}

static void expect_scene(const struct trial *trial, const struct fmb_answer *answer)
{
    static const unsigned pair[1][2] = {{0, 1}};
    const struct pair *of = &trial->pair[0];
    const struct fmb_placement placements[2] = {of->a, of->b};
    const struct fmb_scene scene = {.placements = placements,
                                    .placement_count = 2,
                                    .duration = of->duration,
                                    .want = FMB_WANT_TIMES | FMB_WANT_BOX,
                                    .which = FMB_PAIRS_LISTED,
                                    .pairs = pair,
                                    .pair_count = 1};
    const struct fmb_scene_limits limits = fmb_scene_limits_of(&scene);
    void *memory = malloc(fmb_scene_bytes(&limits));
    struct fmb_scene_state *state;
    struct fmb_scene_answers answers;
    size_t count = 0;
    assert_non_null(memory);
    assert_int_equal(fmb_scene_begin(&scene, &limits, memory, &state), FMB_OK);
    for (bool done = false; !done; count += answers.count) {
        done = fmb_scene_step(state, &answers);
        if (answers.count > 0 &&
            !holds(answer, answers.verdicts[0], answers.contacts[0], answers.boxes[0]))
            fail_of(trial, "other bits in a scene");
    }
    assert_int_equal(count, 1);
    free(memory);
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
            reply[order] = trial_decide(trial, method, order, method->certain ? FMB_WANT_BOX : 0);
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

static void families_are_right_and_the_same_in_every_way(void **state)
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
            const struct reply reply = trial_decide(&trial, fmb_method_default(), 0, FMB_WANT_BOX);
            if (has_one_frame(&question))
                expect_batch(&trial, &reply.answer);
            expect_scene(&trial, &reply.answer);
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
        cmocka_unit_test(families_are_right_and_the_same_in_every_way),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
