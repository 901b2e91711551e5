/* The worst pairs that a search found. Tests count the work of such pairs and hold it below a bound
 * (test_engine_work.c); here it is timed. */
#include "bench.h"

#include "climb.h"
#include "trial.h"

enum { CERTIFICATE_MAX = 1 << 20, EVERYTHING = FMB_WANT_BOX | FMB_WANT_GAP };

static double timed(double start)
{
    return (stopwatch_now() - start) / 1e3;
}

static double time_of_body(const struct question *question)
{
    struct trial trial;
    const double start = stopwatch_now();
    trial_begin(question, &trial);
    return timed(start) / 2; /* for both orders: four bodies; a pair has two */
}

/* In: certify: with a certificate. */
static double time_of_answer(const struct question *question, unsigned want, bool certify)
{
    static char text[CERTIFICATE_MAX];
    struct trial trial;
    struct fmb_answer answer;
    size_t length;
    trial_begin(question, &trial);
    const double start = stopwatch_now();
    pair_decide(fmb_method_default(), &trial.pair[0], want, &answer);
    if (certify)
        pair_certificate(&trial.pair[0], text, sizeof text, &length);
    return timed(start);
}

static double time_of_verdict(const struct question *question)
{
    return time_of_answer(question, 0, false);
}

static double time_of_box(const struct question *question)
{
    return time_of_answer(question, FMB_WANT_BOX, false);
}

static double time_of_all(const struct question *question)
{
    return time_of_answer(question, EVERYTHING, false);
}

static double time_of_certificate(const struct question *question)
{
    return time_of_answer(question, EVERYTHING, true);
}

struct search {
    const char *name, *method, *key;
    climb_cost *cost;
    int climbs;
};

static void search_run(struct bench *bench, const struct search *search, bool posed)
{
    const int steps = bench->quick ? 10 : 200;
    struct draw draw = {.state = bench->seed};
    struct climber climber = {&draw, search->cost, -1074, 1023, posed};
    struct question question;
    bench_progress(search->name);
    climb(&climber, bench->quick ? 1 : search->climbs, steps, &question);
    double worst = search->cost(&question);
    for (int again = 0; again < 8; again++) { /* what the machine adds is not there each time */
        const double us = search->cost(&question);
        worst = us < worst ? us : worst;
    }
    bench_progress(NULL);
    printf("%-12s %-20s %-8s %10.1f\n", search->method, search->name, posed ? "posed" : "", worst);
    json_begin(&bench->json, NULL, '{');
    json_string(&bench->json, "method", search->method);
    json_string(&bench->json, "operation", search->key);
    json_bool(&bench->json, "posed", posed);
    json_number(&bench->json, "worst_us", worst);
    json_end(&bench->json, '}');
}

void worst_run(struct bench *bench)
{
    if (!bench_wants(bench, "worst"))
        return;
    printf("\nThe worst pair that a search found, microseconds a call.\n\n");
    json_begin(&bench->json, "worst", '[');
    static const struct search searches[] = {
        {"two bodies", "", "bodies", time_of_body, 10},
        {"verdict", "certified", "verdict", time_of_verdict, 2},
        {"interval and box", "certified", "box", time_of_box, 2},
        {"and gap", "certified", "all", time_of_all, 2},
        {"and certificate", "certified", "certificate", time_of_certificate, 2}};
    for (int posed = 0; posed < 2; posed++)
        for (size_t i = 0; i < sizeof searches / sizeof *searches; i++)
            search_run(bench, &searches[i], posed);
    json_end(&bench->json, ']');
}
