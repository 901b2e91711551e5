#include "referee.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

void referee_fail(const struct question *question, const char *what)
{
    printf("# %s\n", what);
    question_print(question);
    fail_msg("%s", what);
}

static void make_body(const struct question *question, const struct solid *solid,
                      struct fmb_body *body)
{
    double number[SOLID_NUMBERS_MAX];
    const int count = solid_numbers(solid, number);
    enum fmb_status status = fmb_body_make(solid->dim, solid->shape, number, (size_t) count, body);
    if (status == FMB_OK && solid->radius != 0)
        status = fmb_body_inflate(body, solid->radius);
    if (status != FMB_OK)
        referee_fail(question, fmb_status_text(status));
}

void referee_ready(const struct question *question, struct ready *ready)
{
    question_pair(question, ready->body, &ready->pair); /* the placements; the bodies follow */
    make_body(question, &question->a, &ready->body[0]);
    make_body(question, &question->b, &ready->body[1]);
    enum fmb_status status = pair_check(&ready->pair);
    if (status != FMB_OK)
        referee_fail(question, fmb_status_text(status));
}

/* The methods that are never wrong, and how tight their intervals and boxes are to be. */
struct never_wrong {
    const char *name;
    enum oracle_limit limit;
};

static const struct never_wrong exact = {"exact", ORACLE_TIGHTEST};
static const struct never_wrong certified = {"certified", ORACLE_DESIGN};

static void decide(const struct never_wrong *method, const struct question *question,
                   const struct pair *pair, unsigned want, struct fmb_answer *answer)
{
    memset(answer, 0xa5, sizeof *answer); /* what is not written shows */
    enum fmb_status status = pair_decide(fmb_method_by_name(method->name), pair, want, answer);
    if (status != FMB_OK)
        referee_fail(question, fmb_status_text(status));
}

static void fail_of(const struct never_wrong *method, const struct question *question,
                    const char *why)
{
    char what[300];
    snprintf(what, sizeof what, "%s: %s", method->name, why);
    referee_fail(question, what);
}

void referee_decide(const struct question *question, struct fmb_answer *answer)
{
    struct ready ready;
    referee_ready(question, &ready);
    decide(&exact, question, &ready.pair, FMB_WANT_BOX, answer);
}

bool referee_same(const struct fmb_answer *one, const struct fmb_answer *other)
{
    return one->verdict == other->verdict && one->has_contact == other->has_contact &&
           one->has_box == other->has_box &&
           (!one->has_contact || memcmp(one->contact, other->contact, sizeof one->contact) == 0) &&
           (!one->has_box || memcmp(one->box, other->box, sizeof one->box) == 0) &&
           one->has_point == other->has_point &&
           (!one->has_point || memcmp(one->point, other->point, sizeof one->point) == 0);
}

/* On output: *answer, with the box and the point, which agrees with the truth. The point, which
 * takes longest, is compared in every 32nd call. */
static void assert_truth(const struct never_wrong *method, const struct question *question,
                         const struct pair *pair, const struct oracle_answer *truth,
                         struct fmb_answer *answer)
{
    static unsigned turn;
    char why[200];
    decide(method, question, pair, FMB_WANT_BOX | FMB_WANT_POINT, answer);
    if (answer->has_point != truth->has_contact)
        fail_of(method, question, "a point of a separated pair, or none of a contact");
    struct fmb_answer checked = *answer;
    checked.has_point = checked.has_point && turn++ % 32 == 0;
    if (!oracle_agrees(truth, pair, &checked, method->limit, why, sizeof why))
        fail_of(method, question, why);
}

static void assert_consistent(const struct never_wrong *method, const struct question *question,
                              const struct pair *pair, const struct fmb_answer *answer)
{
    const struct pair reversed = {pair->b, pair->a, pair->duration};
    struct fmb_answer boxless, swapped;
    decide(method, question, &reversed, FMB_WANT_BOX | FMB_WANT_POINT, &swapped);
    if (!referee_same(answer, &swapped))
        fail_of(method, question, "differs the other way round");

    decide(method, question, pair, FMB_WANT_POINT, &boxless);
    if (boxless.has_box)
        fail_of(method, question, "a box that was not requested");
    boxless.has_box = answer->has_box;
    memcpy(boxless.box, answer->box, sizeof boxless.box);
    if (!referee_same(answer, &boxless))
        fail_of(method, question, "differs without the box");
}

void referee_assert_truth(const struct question *question, const struct oracle_answer *truth)
{
    struct ready ready;
    struct fmb_answer answer;
    referee_ready(question, &ready);
    assert_truth(&exact, question, &ready.pair, truth, &answer);
    assert_truth(&certified, question, &ready.pair, truth, &answer);
}

enum fmb_verdict referee_assert(const struct question *question)
{
    struct ready ready;
    struct fmb_answer answer;
    struct oracle_answer truth;
    referee_ready(question, &ready);
    oracle_init(&truth);
    oracle_decide(&ready.pair, FMB_WANT_BOX, &truth);
    assert_truth(&exact, question, &ready.pair, &truth, &answer);
    assert_consistent(&exact, question, &ready.pair, &answer);
    assert_truth(&certified, question, &ready.pair, &truth, &answer);
    assert_consistent(&certified, question, &ready.pair, &answer);
    oracle_clear(&truth);
    return answer.verdict;
}
