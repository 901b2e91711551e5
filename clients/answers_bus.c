#include "answers.h"

#include "allocate.h"
#include "bus_client.h"
#include "complain.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

struct answers_bus {
    struct args_bus bus;
    struct answers_question question;
    struct fmb_client *client; /* NULL: could not be opened */
    double patience;           /* seconds until a query is given up */
    uint64_t advised;          /* outages of which the user was told */
};

/* One scene being asked. */
struct asking {
    const struct scene *scene;
    struct scene_cursor told; /* pairs so far */
    bool certificate;         /* wanted */
    answers_sink *sink;
    void *user;
};

struct answers_bus *answers_bus_open(const struct args_bus *bus,
                                     const struct answers_question *question, double timeout,
                                     int retries)
{
    struct answers_bus *answers = allocate(1, sizeof *answers);
    const struct fmb_client_options options = {.timeout = timeout, .tries = retries + 1};
    answers->bus = *bus;
    answers->question = *question;
    answers->patience = timeout * (retries + 1);
    answers->client = bus_client_open(bus, options);
    if (!answers->client)
        complain("to decide without a bus: fmb query --local");
    return answers;
}

void answers_bus_close(struct answers_bus *answers)
{
    fmb_client_close(answers->client);
    free(answers);
}

/* ---- The question ---------------------------------------------------------------------------- */

static struct fmb_client_frame frame_of(const struct scene_body *body)
{
    const int dim = body->body.dim;
    struct fmb_client_frame frame = {
        .body_id = body->id, .shape = (int) body->body.shape, .dim = dim, .moving = body->moving};
    for (int i = 0; i < body->body.count; i++)
        memcpy(frame.components + i * dim, body->body.component[i],
               (size_t) dim * sizeof *frame.components);
    memcpy(frame.origin, body->origin, sizeof frame.origin);
    memcpy(frame.velocity, body->velocity, sizeof frame.velocity);
    return frame;
}

static struct fmb_client_frame *frames_of(const struct scene *scene)
{
    struct fmb_client_frame *frame = allocate(scene->body_count, sizeof *frame);
    for (size_t i = 0; i < scene->body_count; i++)
        frame[i] = frame_of(&scene->body[i]);
    return frame;
}

static unsigned (*pairs_of(const struct scene *scene))[2]
{
    unsigned(*pair)[2] = allocate(scene->pair_count, sizeof *pair);
    for (size_t i = 0; i < scene->pair_count; i++) {
        pair[i][0] = (unsigned) scene->pair[i].a;
        pair[i][1] = (unsigned) scene->pair[i].b;
    }
    return pair;
}

static unsigned want_of(const struct answers_question *question, const struct scene *scene)
{
    unsigned want = 0;
    if (question->box)
        want |= FMB_CLIENT_WANT_BOX;
    if (question->certificate)
        want |= FMB_CLIENT_WANT_CERTIFICATE;
    for (size_t i = 0; i < scene->body_count; i++)
        if (scene->body[i].moving)
            want |= FMB_CLIENT_WANT_TIMES;
    return want;
}

/* ---- The answers ----------------------------------------------------------------------------- */

/* Pairs of which nothing is heard, where all are asked, are separated. */
static void give_separated(const struct asking *asking, struct scene_pair pair)
{
    const struct outcome outcome = {.pair = pair, .answer.verdict = FMB_SEPARATED};
    asking->sink(asking->user, asking->scene, &outcome);
}

static const char *error_of(const struct asking *asking, const struct fmb_client_answer *answer)
{
    if (answer->status != FMB_OK)
        return answer->text;
    if (asking->certificate && !answer->certificate)
        return "the certificate is too long for a message: ask with --local";
    return NULL;
}

static void take_answer(void *user, const struct fmb_client_answer *answer)
{
    struct asking *asking = user;
    struct outcome outcome = {.error = error_of(asking, answer)};
    while (scene_next_pair(asking->scene, &asking->told, &outcome.pair) &&
           (outcome.pair.a != answer->a || outcome.pair.b != answer->b))
        give_separated(asking, outcome.pair);
    if (!outcome.error) {
        outcome.answer = answer->answer;
        outcome.certificate = answer->certificate;
    }
    asking->sink(asking->user, asking->scene, &outcome);
}

/* error: why nothing was asked; NULL if it was. */
static void give_rest(struct asking *asking, const char *error)
{
    struct outcome outcome = {.error = error};
    while (scene_next_pair(asking->scene, &asking->told, &outcome.pair))
        if (error)
            asking->sink(asking->user, asking->scene, &outcome);
        else
            give_separated(asking, outcome.pair);
}

/* Once for each outage. */
static void advise(struct answers_bus *answers)
{
    const char *prefix = answers->bus.prefix;
    const struct fmb_client_counts counts = fmb_client_counts(answers->client);
    if (answers->advised == counts.outages)
        return;
    answers->advised = counts.outages;
    fprintf(stderr, "fmb: no fmbd answered on channel %sFMB_%s_RESULT of %s within %g s\n", prefix,
            answers->question.certificate ? "PAIR" : "SCENE", args_bus_name(&answers->bus),
            answers->patience);
    if (counts.malformed > 0)
        fprintf(stderr, "fmb: %" PRIu64 " results could not be read: another version of fmbd?\n",
                counts.malformed);
    fprintf(stderr, "fmb: start one with 'fmbd%s%s &', or decide without it: fmb query --local\n",
            *prefix ? " --prefix " : "", prefix);
}

static void ask(struct answers_bus *answers, struct asking *asking)
{
    const struct answers_question *question = &answers->question;
    const struct scene *scene = asking->scene;
    struct fmb_client_frame *frame = frames_of(scene);
    unsigned(*pair)[2] = pairs_of(scene);
    const struct fmb_client_scene asked = {
        .frames = frame,
        .frame_count = scene->body_count,
        .which = scene->all_pairs ? FMB_CLIENT_ALL : FMB_CLIENT_LISTED,
        .pairs = pair,
        .pair_count = scene->pair_count,
        .duration = scene->duration,
        .want = want_of(question, scene),
        .method = question->method ? question->method->number : 0,
    };
    const int status = fmb_client_ask(answers->client, &asked, take_answer, asking);
    give_rest(asking, status == FMB_OK ? NULL : fmb_client_why(answers->client));
    free(frame);
    free(pair);
    advise(answers);
}

void answers_bus_scene(struct answers_bus *answers, const struct scene *scene, answers_sink *sink,
                       void *user)
{
    struct asking asking = {
        .scene = scene, .certificate = answers->question.certificate, .sink = sink, .user = user};
    if (answers->client)
        ask(answers, &asking);
    else
        give_rest(&asking, "no bus");
}
