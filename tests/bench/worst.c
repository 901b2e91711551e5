/* The worst that was found: pairs whose exponents differ most, one by one. */
#include "bench.h"

#include <string.h>

#include "family.h"
#include "trial.h"

/* What a call costs on pairs of a family one by one, in microseconds. */
struct cost {
    double mean, kind, worst; /* of all; of the kind of pair that costs most; of one pair */
};

struct asked {
    const char *name, *key;
    enum contender contender;
};

static double time_of(enum contender contender, const struct scene *scene)
{
    static const unsigned pair[1][2] = {{0, 1}};
    const struct work work = {.scene = scene, .pair = pair, .count = 1};
    const double start = stopwatch_now();
    contender_run(contender, &work);
    return (stopwatch_now() - start) / 1e3;
}

static double cost_of(enum contender contender, const struct trial *trial, double worst)
{
    struct fmb_prepared prepared[2];
    struct fmb_frame frame[2] = {trial->pair[0].a, trial->pair[0].b};
    const struct scene scene = {.count = 2, .prepared = prepared, .frame = frame};
    fmb_prepare(&frame[0], &prepared[0]);
    fmb_prepare(&frame[1], &prepared[1]);
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
    static const struct asked asked[] = {{"verdict", "verdict", CONTENDER_SINGLE},
                                         {"with the interval", "interval", CONTENDER_QUERY},
                                         {"and with the box", "box", CONTENDER_QUERY_BOX}};
    for (size_t i = 0; i < sizeof asked / sizeof *asked; i++) {
        bench_progress(name);
        const struct cost cost =
            cost_of_family(bench, family_by_name(name), asked[i].contender, pairs);
        bench_progress(NULL);
        printf("%-16s %-20s %10.1f %10.1f %10.1f\n", i == 0 ? name : "", asked[i].name, cost.mean,
               cost.kind, cost.worst);
        json_open(&bench->json, NULL, '{');
        json_text(&bench->json, "name", name);
        json_text(&bench->json, "asked", asked[i].key);
        json_number(&bench->json, "mean_us", cost.mean);
        json_number(&bench->json, "kind_us", cost.kind);
        json_number(&bench->json, "worst_us", cost.worst);
        json_close(&bench->json, '}');
    }
}

void worst_run(struct bench *bench)
{
    if (!bench_wants(bench, "worst"))
        return;
    printf(
        "\ncertified where exponents differ most, microseconds a call: mean of all, mean of the\n"
        "kind of pair that costs most, worst pair.\n\n");
    printf("%-16s %-20s %10s %10s %10s\n", "", "", "mean", "kind", "worst");
    json_open(&bench->json, "worst", '[');
    family_run(bench, "exponents-200", bench->quick ? 20 : 2000);
    family_run(bench, "exponents-all", bench->quick ? 5 : 300);
    json_close(&bench->json, ']');
}
