/* The worst that was found: pairs whose exponents differ most, one by one; and pairs that a search
 * found to cost most. */
#include "bench.h"

#include <string.h>

#include "climb.h"
#include "family.h"
#include "trial.h"

/* ---- Families ---- */

struct cost {
    double mean, kind, worst; /* of all; of the kind of pair that costs most; of one pair */
};

struct operation {
    const char *name, *key;
    enum contender contender;
};

static double time_of(enum contender contender, const struct scene *scene)
{
    static const unsigned pair[1][2] = {{0, 1}};
    unsigned char verdict;
    const struct work work = {.scene = scene, .pair = pair, .count = 1, .verdicts = &verdict};
    const double start = stopwatch_now();
    contender_run(contender, &work);
    return (stopwatch_now() - start) / 1e3;
}

static double cost_of(enum contender contender, const struct trial *trial, double worst)
{
    struct fmb_prepared prepared[2];
    struct fmb_placement placement[2] = {trial->pair[0].a, trial->pair[0].b};
    const struct scene scene = {.count = 2, .prepared = prepared, .placement = placement};
    fmb_prepare(&placement[0], 0, 1, &prepared[0]);
    fmb_prepare(&placement[1], 0, 1, &prepared[1]);
    double us = time_of(contender, &scene);
    for (int again = 0; us > worst && again < 3; again++) { /* was it the machine? */
        const double other = time_of(contender, &scene);
        us = other < us ? other : us;
    }
    return us;
}

/* Mean of the kind. */
static double kind_of(const struct bench *bench, const struct family *family,
                      const struct cell *cell, enum contender contender, size_t pairs,
                      double *worst)
{
    struct draw draw = cell_draw(bench->seed, family->name, cell, 0);
    double sum = 0;
    for (size_t i = 0; i < pairs; i++) {
        struct question question;
        struct trial trial;
        family_draw(family, cell, &draw, &question);
        trial_begin(&question, &trial);
        const double us = cost_of(contender, &trial, *worst);
        *worst = us > *worst ? us : *worst;
        sum += us;
    }
    return sum / (double) pairs;
}

static struct cost cost_of_family(const struct bench *bench, const struct family *family,
                                  enum contender contender, size_t pairs)
{
    struct cell cells[CELL_WITH_FACES];
    const int count = family_cells(family, cells);
    struct cost cost = {0, 0, 0};
    for (int i = 0; i < count; i++) {
        const double mean = kind_of(bench, family, &cells[i], contender, pairs, &cost.worst);
        cost.kind = mean > cost.kind ? mean : cost.kind;
        cost.mean += mean / count;
    }
    return cost;
}

static void family_run(struct bench *bench, const char *name, size_t pairs)
{
    static const struct operation operation[] = {{"verdict", "verdict", CONTENDER_SINGLE},
                                                 {"with the interval", "interval", CONTENDER_QUERY},
                                                 {"and with the box", "box", CONTENDER_QUERY_BOX}};
    for (size_t i = 0; i < sizeof operation / sizeof *operation; i++) {
        bench_progress(name);
        const struct cost cost =
            cost_of_family(bench, family_by_name(name), operation[i].contender, pairs);
        bench_progress(NULL);
        printf("%-16s %-20s %10.1f %10.1f %10.1f\n", i == 0 ? name : "", operation[i].name,
               cost.mean, cost.kind, cost.worst);
        json_begin(&bench->json, NULL, '{');
        json_string(&bench->json, "name", name);
        json_string(&bench->json, "operation", operation[i].key);
        json_number(&bench->json, "mean_us", cost.mean);
        json_number(&bench->json, "kind_us", cost.kind);
        json_number(&bench->json, "worst_us", cost.worst);
        json_end(&bench->json, '}');
    }
}

/* ---- Search ----
 *
 * The tests count the work of such pairs and hold it below a bound (test_engine_work.c); here it is
 * timed. */

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
static double time_of_answer(const struct question *question, const struct fmb_method *method,
                             unsigned want, bool certify)
{
    static char text[CERTIFICATE_MAX];
    struct trial trial;
    struct fmb_answer answer;
    size_t length;
    trial_begin(question, &trial);
    const double start = stopwatch_now();
    pair_decide(method, &trial.pair[0], want, &answer);
    if (certify)
        pair_certificate(&trial.pair[0], text, sizeof text, &length);
    return timed(start);
}

static double time_of_verdict(const struct question *question)
{
    return time_of_answer(question, fmb_method_default(), 0, false);
}

static double time_of_box(const struct question *question)
{
    return time_of_answer(question, fmb_method_default(), FMB_WANT_BOX, false);
}

static double time_of_all(const struct question *question)
{
    return time_of_answer(question, fmb_method_default(), EVERYTHING, false);
}

static double time_of_certificate(const struct question *question)
{
    return time_of_answer(question, fmb_method_default(), EVERYTHING, true);
}

static double time_of_exact_verdict(const struct question *question)
{
    return time_of_answer(question, fmb_method_by_name("exact"), 0, false);
}

static double time_of_exact_all(const struct question *question)
{
    return time_of_answer(question, fmb_method_by_name("exact"), EVERYTHING, false);
}

static double time_of_exact_certificate(const struct question *question)
{
    return time_of_answer(question, fmb_method_by_name("exact"), EVERYTHING, true);
}

struct search {
    const char *name, *method, *key;
    climb_cost *cost;
    int climbs;
};

static void search_run(struct bench *bench, const struct search *search, bool posed)
{
    const int steps = bench->quick ? 10 : 500;
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
    printf("%-16s %-20s %10s %10s %10.1f\n", search->method, search->name, "", posed ? "posed" : "",
           worst);
    json_begin(&bench->json, NULL, '{');
    json_string(&bench->json, "name", "search");
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
    printf(
        "\ncertified where exponents differ most, microseconds a call: mean of all, mean of the\n"
        "kind of pair that costs most, worst pair. Below: the worst pair that a search found.\n\n");
    printf("%-16s %-20s %10s %10s %10s\n", "", "", "mean", "kind", "worst");
    json_begin(&bench->json, "worst", '[');
    family_run(bench, "exponents-200", bench->quick ? 20 : 2000);
    family_run(bench, "exponents-all", bench->quick ? 5 : 300);
    json_end(&bench->json, ']');
    printf("search\n");
    json_begin(&bench->json, "searched", '[');
    static const struct search searches[] = {
        {"two bodies", "", "bodies", time_of_body, 10},
        {"verdict", "certified", "verdict", time_of_verdict, 30},
        {"interval and box", "certified", "box", time_of_box, 30},
        {"and gap", "certified", "all", time_of_all, 30},
        {"and certificate", "certified", "certificate", time_of_certificate, 15},
        {"verdict", "exact", "verdict", time_of_exact_verdict, 30},
        {"box and gap", "exact", "all", time_of_exact_all, 30},
        {"and certificate", "exact", "certificate", time_of_exact_certificate, 15}};
    for (int posed = 0; posed < 2; posed++)
        for (size_t i = 0; i < sizeof searches / sizeof *searches; i++)
            search_run(bench, &searches[i], posed);
    json_end(&bench->json, ']');
}
