/* A question put to the methods of the engine, in both orders. */
#ifndef TRIAL_H
#define TRIAL_H

#include <stdbool.h>
#include <stddef.h>

#include "fmb.h"
#include "question.h"

enum { TRIAL_METHODS_MAX = 8 };

/* How many methods the table has; more than TRIAL_METHODS_MAX end the program. */
int trial_methods(void);

/* Whether the method is documented never to be wrong. */
bool trial_never_wrong(const struct fmb_method *method);

/* Not to be copied: the pairs point into body, bodies into frame, and hulls into memory. */
struct trial {
    struct question question;
    double *memory[2]; /* of hulls; NULL: none */
    struct fmb_frame frame[2][SOLID_FRAMES_MAX];
    struct fmb_body body[2];
    struct pair pair[2]; /* (A, B), and (B, A) */
};

/* Ends the program, with the question printed, if the engine refuses it: those drawn are legal. */
void trial_begin(const struct question *question, struct trial *out);

/* Frees the memory of hulls. Without any it need not be called. */
void trial_end(struct trial *trial);

/* What a method said. status is OK or CANNOT_DECIDE; the latter has an answer of zeros. */
struct reply {
    enum fmb_status status;
    struct fmb_answer answer;
};

struct reply trial_decide(const struct trial *trial, const struct fmb_method *method, int order,
                          unsigned want);

/* Same status, verdict and bits. */
bool reply_same_verdict(const struct reply *one, const struct reply *other);
bool reply_same(const struct reply *one, const struct reply *other);

#endif
