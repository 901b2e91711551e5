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
    double number[FMB_COMPONENTS_MAX];
    const int count = solid_count(solid);
    for (int i = 0; i < count; i++)
        memcpy(&number[i * solid->dim], solid->component[i],
               (size_t) solid->dim * sizeof number[0]);
    enum fmb_status status =
        fmb_body_make(solid->dim, solid->shape, number, (size_t) (count * solid->dim), body);
    if (status != FMB_OK)
        referee_fail(question, fmb_status_text(status));
}

void referee_ready(const struct question *question, struct ready *ready)
{
    question_pair(question, ready->body, &ready->pair); /* the frames; the bodies follow */
    make_body(question, &question->a, &ready->body[0]);
    make_body(question, &question->b, &ready->body[1]);
    enum fmb_status status = fmb_pair_check(&ready->pair);
    if (status != FMB_OK)
        referee_fail(question, fmb_status_text(status));
}

static void ask(const struct question *question, const struct fmb_pair *pair, unsigned want,
                struct fmb_answer *answer)
{
    memset(answer, 0xa5, sizeof *answer); /* what is not written shows */
    enum fmb_status status = fmb_decide(fmb_method_by_name("exact"), pair, want, answer);
    if (status != FMB_OK)
        referee_fail(question, fmb_status_text(status));
}

void referee_ask(const struct question *question, struct fmb_answer *answer)
{
    struct ready ready;
    referee_ready(question, &ready);
    ask(question, &ready.pair, FMB_WANT_BOX, answer);
}

bool referee_same(const struct fmb_answer *one, const struct fmb_answer *other)
{
    return one->verdict == other->verdict && one->has_contact == other->has_contact &&
           one->has_box == other->has_box &&
           (!one->has_contact || memcmp(one->contact, other->contact, sizeof one->contact) == 0) &&
           (!one->has_box || memcmp(one->box, other->box, sizeof one->box) == 0);
}

void referee_assert_truth(const struct question *question, const struct oracle_answer *truth)
{
    char why[200];
    struct ready ready;
    struct fmb_answer answer;
    referee_ready(question, &ready);
    ask(question, &ready.pair, FMB_WANT_BOX, &answer);
    if (!oracle_agrees(truth, &ready.pair, &answer, ORACLE_TIGHTEST, why, sizeof why))
        referee_fail(question, why);
}

enum fmb_verdict referee_assert(const struct question *question)
{
    char why[200];
    struct ready ready;
    struct fmb_answer answer, boxless, swapped;
    referee_ready(question, &ready);
    ask(question, &ready.pair, FMB_WANT_BOX, &answer);
    if (!oracle_check_tightest(&ready.pair, FMB_WANT_BOX, &answer, why, sizeof why))
        referee_fail(question, why);

    const struct fmb_pair reversed = {ready.pair.b, ready.pair.a, ready.pair.duration};
    ask(question, &reversed, FMB_WANT_BOX, &swapped);
    if (!referee_same(&answer, &swapped))
        referee_fail(question, "differs the other way round");

    ask(question, &ready.pair, 0, &boxless);
    if (boxless.has_box)
        referee_fail(question, "a box that nobody wanted");
    boxless.has_box = answer.has_box;
    memcpy(boxless.box, answer.box, sizeof boxless.box);
    if (!referee_same(&answer, &boxless))
        referee_fail(question, "differs without the box");
    return answer.verdict;
}
