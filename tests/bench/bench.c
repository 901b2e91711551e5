/* The benchmark: what a verdict costs, by kind of pair and by method; what its bounds cost; what
 * contacts cost in a scene full of them; and the worst that was found.
 *
 * Distinct pairs, methods in turn within each block, medians of blocks, time of this thread alone.
 */
#include "certified.h"
#include "draw.h"
#include "pairs.h"
#include "stopwatch.h"
#include "unbounded.h"

#include <stdio.h>
#include <stdlib.h>

enum { PAIRS = 4096, SEED = 20240607 };

/* ---- What is timed: a call on each pair, nanoseconds ---- */

typedef double run(const struct pairs *pairs, const void *what);

static volatile unsigned sink; /* so that nothing is left out */

static double run_method(const struct pairs *pairs, const void *what)
{
    const double start = stopwatch_now();
    for (size_t i = 0; i < pairs->count; i++) {
        struct fmb_answer answer;
        fmb_decide(what, &pairs->pair[i], 0, &answer);
        sink += answer.verdict;
    }
    return stopwatch_now() - start;
}

static double run_box(const struct pairs *pairs, const void *what)
{
    const double start = stopwatch_now();
    for (size_t i = 0; i < pairs->count; i++) {
        struct fmb_answer answer;
        fmb_decide(what, &pairs->pair[i], FMB_WANT_BOX, &answer);
        sink += answer.verdict;
    }
    return stopwatch_now() - start;
}

typedef enum slabs_outcome filter(const struct slabs_pair *pair, bool rounds);

struct filter_of {
    filter *function;
};

static double run_filter(const struct pairs *pairs, const void *what)
{
    const struct filter_of *of = what;
    const double start = stopwatch_now();
    for (size_t i = 0; i < pairs->count; i++) {
        struct slabs_pair slabs;
        if (slabs_prepare(&pairs->pair[i], &slabs))
            sink += of->function(&slabs, true);
    }
    return stopwatch_now() - start;
}

struct contender {
    run *run;
    const void *what;
};

/* Median nanoseconds a pair of each. */
static void race(const struct pairs *pairs, const struct contender *contenders, int count,
                 double *out)
{
    struct stopwatch watch[8] = {{{0}, 0}};
    for (int block = 0; block < STOPWATCH_BLOCKS; block++)
        for (int i = 0; i < count; i++)
            watch[i].block[watch[i].blocks++] =
                contenders[i].run(pairs, contenders[i].what) / (double) pairs->count;
    for (int i = 0; i < count; i++)
        out[i] = stopwatch_median(&watch[i]);
}

/* ---- Sections ---- */

static void print_pair(double in_contact, double separated)
{
    printf(" %9.0f /%5.0f", in_contact, separated);
}

static void race_cell(const struct cell *cell)
{
    static const struct filter_of bounded = {slabs_filter}, unbounded = {unbounded_filter};
    const void *certified = fmb_method_by_name("certified");
    const struct contender contenders[] = {
        {run_method, certified},
        {run_filter, &bounded},
        {run_filter, &unbounded},
        {run_method, fmb_method_by_name("sat")},
        {run_method, fmb_method_by_name("fmb")},
        {run_method, fmb_method_by_name("exact")},
        {run_box, certified},
    };
    enum { COUNT = sizeof contenders / sizeof *contenders };
    struct pairs all = pairs_draw(family_by_name("random"), cell, PAIRS, SEED);
    double ns[2][COUNT];
    for (int contact = 0; contact < 2; contact++) {
        struct pairs some = pairs_in_contact(&all, contact);
        race(&some, contenders, COUNT, ns[contact]);
        pairs_free(&some);
    }
    char text[CELL_TEXT_MAX];
    printf("%-13s", cell_text(cell, text));
    for (int i = 0; i < COUNT; i++)
        print_pair(ns[1][i], ns[0][i]);
    printf("   %.2f /%5.2f\n", ns[1][1] / ns[1][2], ns[0][1] / ns[0][2]);
    fflush(stdout);
    pairs_free(&all);
}

static void section_random(void)
{
    struct cell cells[CELL_WITH_FACES];
    const int count = cell_list(false, cells);
    printf(
        "Random pairs (the article's distribution), nanoseconds a query, in contact / separated.\n"
        "certified, fmb, sat and exact: fmb_decide(), with the interval of moving pairs; +box:\n"
        "with the box; filter: verdict alone, with bounds; bare: the same compiled without;\n"
        "ratio: filter to bare.\n\n");
    printf("%-13s %16s %16s %16s %16s %16s %16s %16s   %s\n", "", "certified", "filter", "bare",
           "sat", "fmb", "exact", "+box", "ratio");
    for (int i = 0; i < count; i++)
        race_cell(&cells[i]);
}

static void section_unsure(long pairs)
{
    struct cell cells[CELL_WITH_FACES];
    const int count = cell_list(false, cells);
    const struct family *random = family_by_name("random");
    long unsure = 0, asked = 0;
    for (int i = 0; i < count; i++)
        for (long done = 0; done < pairs; done += PAIRS) {
            struct pairs some = pairs_draw(random, &cells[i], PAIRS, SEED + (uint64_t) done);
            for (size_t k = 0; k < some.count; k++, asked++) {
                enum certified_path path;
                certified_verdict(&some.pair[k], &path);
                unsure += path != CERTIFIED_FILTER;
            }
            pairs_free(&some);
        }
    printf("\nThe filter was unsure of %ld in %ld random pairs.\n", unsure, asked);
}

static void race_grid(const char *name, double pitch)
{
    const void *certified = fmb_method_by_name("certified");
    const struct contender contenders[] = {
        {run_method, certified}, {run_method, fmb_method_by_name("exact")}, {run_box, certified}};
    struct pairs all = pairs_of_grid(pitch, 22);
    double ns[3];
    race(&all, contenders, 3, ns);
    printf("%-28s %7zu %10.0f %10.0f %10.0f\n", name, all.count, ns[0], ns[1], ns[2]);
    pairs_free(&all);
}

static void section_grids(void)
{
    printf("\n10,648 cubes in a grid, every one with its neighbours, nanoseconds a pair.\n\n");
    printf("%-28s %7s %10s %10s %10s\n", "", "pairs", "certified", "exact", "+box");
    race_grid("pitch 1, all touch", 1);
    race_grid("pitch 0.1, an ulp either way", 0.1);
}

static double run_verdict(const struct pairs *pairs, const void *what)
{
    (void) what;
    const double start = stopwatch_now();
    for (size_t i = 0; i < pairs->count; i++) {
        enum certified_path path;
        sink += certified_verdict(&pairs->pair[i], &path);
    }
    return stopwatch_now() - start;
}

/* What a function costs on pairs of a family one by one, in microseconds. */
struct spread {
    double mean, kind, worst; /* of all; of the kind of pair that costs most; of one pair */
};

static double cost_of(const struct contender *contender, const struct fmb_pair *pair,
                      const struct spread *spread)
{
    struct fmb_pair copy = *pair;
    const struct pairs one = {1, &copy, NULL};
    double us = contender->run(&one, contender->what) / 1e3;
    for (int again = 0; us > spread->worst && again < 3; again++) { /* was it the machine? */
        const double other = contender->run(&one, contender->what) / 1e3;
        us = other < us ? other : us;
    }
    return us;
}

static struct spread spread_of(const struct family *family, const struct contender *contender,
                               size_t pairs)
{
    struct cell cells[CELL_WITH_FACES];
    const int count = family_cells(family, cells);
    struct spread spread = {0};
    for (int i = 0; i < count; i++) {
        struct pairs some = pairs_draw(family, &cells[i], pairs, SEED);
        double sum = 0;
        for (size_t k = 0; k < some.count; k++) {
            const double us = cost_of(contender, &some.pair[k], &spread);
            spread.worst = us > spread.worst ? us : spread.worst;
            sum += us;
        }
        const double mean = sum / (double) pairs;
        spread.kind = mean > spread.kind ? mean : spread.kind;
        spread.mean += mean / count;
        pairs_free(&some);
    }
    return spread;
}

static void print_spread(const char *name, const char *what, struct spread spread)
{
    printf("%-16s %-20s %10.1f %10.1f %10.1f\n", name, what, spread.mean, spread.kind,
           spread.worst);
    fflush(stdout);
}

static void worst_of_family(const char *name, size_t pairs)
{
    const struct family *family = family_by_name(name);
    const struct fmb_method *certified = fmb_method_by_name("certified");
    const struct contender verdict = {run_verdict, NULL}, query = {run_method, certified},
                           box = {run_box, certified};
    print_spread(name, "verdict", spread_of(family, &verdict, pairs));
    print_spread("", "with the interval", spread_of(family, &query, pairs));
    print_spread("", "and with the box", spread_of(family, &box, pairs));
}

static void section_worst(void)
{
    printf(
        "\ncertified where exponents differ most, microseconds a query: mean of all, mean of the\n"
        "kind of pair that costs most, worst pair.\n\n");
    printf("%-16s %-20s %10s %10s %10s\n", "", "", "mean", "kind", "worst");
    worst_of_family("exponents-200", 2000);
    worst_of_family("exponents-all", 300);
}

int main(void)
{
    stopwatch_pin();
    section_random();
    section_grids();
    section_worst();
    section_unsure(1 << 18);
    return 0;
}
