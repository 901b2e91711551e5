#include "answers.h"

#include "allocate.h"
#include "ask.h"
#include "bus.h"
#include "wire.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

struct answers_bus {
    struct args_bus bus;
    bool certificate; /* wanted */
    lcm_t *lcm;       /* NULL: could not be opened */
    struct ask *ask;  /* NULL: could not be opened */
    double patience;  /* seconds until a query is given up */
    uint64_t advised; /* outages of which the user was told */
};

/* One scene being asked: the questions run ahead of the answers. */
struct asking {
    const struct scene *scene;
    struct scene_cursor asked, answered;
    const struct answers_bus *answers;
    answers_sink *sink;
    void *user;
};

static int32_t want_of(const struct answers_question *question)
{
    return (question->box ? QUERY_WANT_BOX : 0) |
           (question->certificate ? QUERY_WANT_CERTIFICATE : 0);
}

struct answers_bus *answers_bus_open(const struct args_bus *bus,
                                     const struct answers_question *question, double timeout,
                                     int retries)
{
    struct answers_bus *answers = allocate(1, sizeof *answers);
    struct ask_options options = {.prefix = bus->prefix,
                                  .method = question->method ? question->method->number : 0,
                                  .want = want_of(question),
                                  .timeout = timeout,
                                  .retries = retries};
    answers->bus = *bus;
    answers->certificate = question->certificate;
    answers->patience = timeout * (retries + 1);
    answers->lcm = bus_open("fmb", bus->url, NULL);
    if (answers->lcm)
        answers->ask = ask_open(answers->lcm, &options);
    if (answers->lcm && !answers->ask)
        fprintf(stderr, "fmb: cannot listen on %s\n", args_bus_name(bus));
    if (!answers->ask)
        fprintf(stderr, "fmb: to decide without a bus: fmb query --local\n");
    return answers;
}

void answers_bus_close(struct answers_bus *answers)
{
    if (answers->ask)
        ask_close(answers->ask);
    if (answers->lcm)
        lcm_destroy(answers->lcm);
    free(answers);
}

static void fill_numbers(struct query_numbers *out, const double *numbers, int count)
{
    out->count = count;
    memcpy(out->number, numbers, (size_t) count * sizeof *numbers);
}

static void fill_frame(const struct scene_body *body, struct query_frame *out)
{
    int dim = body->body.dim;
    double components[FMB_COMPONENTS_MAX];
    for (int i = 0; i < body->body.count; i++)
        memcpy(components + i * dim, body->body.component[i], (size_t) dim * sizeof *components);
    out->body_id = body->id;
    out->shape = (int32_t) body->body.shape;
    out->dim = dim;
    fill_numbers(&out->origin, body->origin, dim);
    fill_numbers(&out->components, components, body->body.count * dim);
    fill_numbers(&out->velocity, body->velocity, body->moving ? dim : 0);
}

static bool next_question(void *user, struct pair_query *out)
{
    struct asking *asking = user;
    struct scene_pair pair;
    if (!scene_next_pair(asking->scene, &asking->asked, &pair))
        return false;
    out->duration = asking->scene->duration;
    fill_frame(&asking->scene->body[pair.a], &out->frame[0]);
    fill_frame(&asking->scene->body[pair.b], &out->frame[1]);
    return true;
}

static const char *error_of(const struct asking *asking, const struct pair_result *result)
{
    const struct answers_bus *answers = asking->answers;
    if (!answers->ask)
        return "no bus";
    if (!result)
        return ask_is_silent(answers->ask) ? "no fmbd answered" : "fmbd gave no answer";
    if (answers->certificate && result->status == FMB_OK && !result->certificate)
        return "the certificate is too long for a message: ask with --local";
    return report_refusal(result);
}

static void take_answer(void *user, const struct pair_result *result)
{
    struct asking *asking = user;
    struct outcome outcome;
    memset(&outcome, 0, sizeof outcome);
    scene_next_pair(asking->scene, &asking->answered, &outcome.pair);
    outcome.error = error_of(asking, result);
    if (!outcome.error) {
        outcome.answer = result->answer;
        outcome.certificate = asking->answers->certificate ? result->certificate : NULL;
    }
    asking->sink(asking->user, asking->scene, &outcome);
}

/* Once for each outage. */
static void advise(struct answers_bus *answers)
{
    const char *prefix = answers->bus.prefix;
    struct ask_counts counts = ask_counts(answers->ask);
    if (answers->advised == counts.outages)
        return;
    answers->advised = counts.outages;
    fprintf(stderr, "fmb: no fmbd answered on channel %s%s of %s within %g s\n", prefix,
            WIRE_PAIR_RESULT, args_bus_name(&answers->bus), answers->patience);
    if (counts.malformed > 0)
        fprintf(stderr, "fmb: %" PRIu64 " results could not be read: another version of fmbd?\n",
                counts.malformed);
    fprintf(stderr, "fmb: start one with 'fmbd%s%s &', or decide without it: fmb query --local\n",
            *prefix ? " --prefix " : "", prefix);
}

void answers_bus_scene(struct answers_bus *answers, const struct scene *scene, answers_sink *sink,
                       void *user)
{
    struct asking asking = {.scene = scene, .answers = answers, .sink = sink, .user = user};
    struct pair_query query;
    if (answers->ask) {
        ask_all(answers->ask, next_question, take_answer, &asking);
        advise(answers);
        return;
    }
    while (next_question(&asking, &query))
        take_answer(&asking, NULL);
}
