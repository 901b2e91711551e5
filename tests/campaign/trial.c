#include "trial.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int trial_methods(void)
{
    int count = 0;
    while (fmb_method_at((size_t) count))
        count++;
    if (count > TRIAL_METHODS_MAX) {
        fprintf(stderr, "more methods than TRIAL_METHODS_MAX\n");
        exit(EXIT_FAILURE);
    }
    return count;
}

bool trial_never_wrong(const struct fmb_method *method)
{
    return strcmp(method->name, "exact") == 0 || strcmp(method->name, "certified") == 0;
}

static void expect_ok(enum fmb_status status, const struct question *question)
{
    if (status == FMB_OK)
        return;
    fprintf(stderr, "the engine refuses a question: %s\n", fmb_status_text(status));
    question_print(question);
    exit(EXIT_FAILURE);
}

static void make_body(const struct question *question, const struct solid *solid,
                      struct fmb_body *out)
{
    double number[FMB_COMPONENTS_MAX];
    const int count = solid_count(solid);
    for (int i = 0; i < count; i++)
        memcpy(&number[i * solid->dim], solid->component[i],
               (size_t) solid->dim * sizeof number[0]);
    expect_ok(fmb_body_make(solid->dim, solid->shape, number, (size_t) (count * solid->dim), out),
              question);
}

void trial_begin(const struct question *question, struct trial *out)
{
    out->question = *question;
    question_pair(&out->question, out->body, &out->pair[0]); /* the frames; the bodies follow */
    make_body(question, &question->a, &out->body[0]);
    make_body(question, &question->b, &out->body[1]);
    out->pair[1] = (struct fmb_pair){out->pair[0].b, out->pair[0].a, out->pair[0].duration};
    expect_ok(fmb_pair_check(&out->pair[0]), question);
}

struct reply trial_ask(const struct trial *trial, const struct fmb_method *method, int order,
                       unsigned want)
{
    struct reply reply;
    memset(&reply, 0xa5, sizeof reply); /* what is not written shows */
    reply.status = fmb_decide(method, &trial->pair[order], want, &reply.answer);
    return reply;
}

bool reply_same_verdict(const struct reply *one, const struct reply *other)
{
    return one->status == other->status && one->answer.verdict == other->answer.verdict;
}

bool reply_same(const struct reply *one, const struct reply *other)
{
    const struct fmb_answer *p = &one->answer, *q = &other->answer;
    return reply_same_verdict(one, other) && p->has_contact == q->has_contact &&
           p->has_box == q->has_box &&
           (!p->has_contact || memcmp(p->contact, q->contact, sizeof p->contact) == 0) &&
           (!p->has_box || memcmp(p->box, q->box, sizeof p->box) == 0);
}
