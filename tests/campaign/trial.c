#include "trial.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "memory.h"

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
                      struct fmb_frame frame[SOLID_FRAMES_MAX], double **memory,
                      struct fmb_body *out)
{
    const int count = solid_frames(solid);
    double *next = NULL;
    *memory = NULL;
    for (int i = 0; i < count; i++) {
        double number[SOLID_NUMBERS_MAX];
        const struct solid one = solid_frame(solid, i);
        const size_t numbers = (size_t) solid_numbers(&one, number);
        const size_t doubles = fmb_hull_doubles(one.dim, numbers / (size_t) one.dim);
        if (solid_is_hull(&one)) {
            if (i == 0)
                next = *memory = memory_get((size_t) count * doubles * sizeof *next);
            expect_ok(fmb_frame_make_hull(one.dim, number, numbers, next, &frame[i]), question);
            next += doubles;
        } else {
            expect_ok((one.by_vertices ? fmb_frame_make_vertices : fmb_frame_make)(
                          one.dim, one.shape, number, numbers, &frame[i]),
                      question);
        }
        if (one.radius != 0)
            expect_ok(fmb_frame_inflate(&frame[i], one.radius), question);
    }
    expect_ok(fmb_body_make_frames(frame, (size_t) count, out), question);
}

void trial_end(struct trial *trial)
{
    free(trial->memory[0]);
    free(trial->memory[1]);
}

void trial_begin(const struct question *question, struct trial *out)
{
    out->question = *question;
    make_body(question, &question->a, out->frame[0], &out->memory[0], &out->body[0]);
    make_body(question, &question->b, out->frame[1], &out->memory[1], &out->body[1]);
    out->pair[0] = (struct pair){solid_placement(&question->a, &out->body[0]),
                                 solid_placement(&question->b, &out->body[1]), question->duration};
    out->pair[1] = (struct pair){out->pair[0].b, out->pair[0].a, out->pair[0].duration};
    expect_ok(pair_check(&out->pair[0]), question);
}

struct reply trial_decide(const struct trial *trial, const struct fmb_method *method, int order,
                          unsigned want)
{
    struct reply reply;
    memset(&reply, 0xa5, sizeof reply); /* what is not written shows */
    reply.status = pair_decide(method, &trial->pair[order], want, &reply.answer);
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
