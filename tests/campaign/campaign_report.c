#include "campaign_report.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

enum { REPRODUCERS_MAX = 8 };

/* ---- Sums ---- */

static uint64_t broken_of(const struct measure *measure)
{
    uint64_t sum = 0;
    for (int m = 0; m < trial_methods(); m++)
        if (trial_never_wrong(fmb_method_at((size_t) m)))
            sum += measure->method[m].tally.broken + measure->method[m].tally.order_verdict;
    return sum;
}

uint64_t report_broken(const struct report *report)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < report->measures; i++)
        sum += broken_of(&report->measure[i]);
    return sum;
}

uint64_t report_not_as_made(const struct report *report)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < report->measures; i++)
        sum += report->measure[i].not_as_made;
    return sum;
}

/* ---- Methods that are never wrong ---- */

static void print_reproducers(const struct report *report, int m)
{
    int shown = 0;
    for (size_t i = 0; i < report->measures && shown < REPRODUCERS_MAX; i++) {
        const struct measure *measure = &report->measure[i];
        const struct tally *tally = &measure->method[m].tally;
        char text[CELL_TEXT_MAX];
        if (tally->broken == 0)
            continue;
        printf("# %s, %s, %" PRIu64 " times. First: %s\n", measure->family->name,
               cell_text(&measure->cell, text), tally->broken, tally->first.why);
        question_print(&tally->first.question);
        shown++;
    }
}

static void print_never_wrong(const struct report *report, int m, FILE *out)
{
    uint64_t queries = 0, wrong = 0, order = 0, refused = 0, broken = 0;
    struct tally_gaps gap = {0};
    for (size_t i = 0; i < report->measures; i++) {
        const struct tally *tally = &report->measure[i].method[m].tally;
        queries += tally->queries;
        wrong += tally_wrong_verdicts(tally);
        order += tally->order_verdict;
        refused += tally->refused;
        broken += tally->broken;
        gap.unproven += tally->gap.unproven;
        gap.count += tally->gap.count;
        gap.width_most = fmax(gap.width_most, tally->gap.width_most);
    }
    fprintf(out,
            "%s: %" PRIu64 " queries, %" PRIu64 " wrong verdicts, %" PRIu64
            " pairs with another verdict in the other order, %" PRIu64 " refused, %" PRIu64
            " answers that break a promise (verdict, interval, box, gap)\n"
            "%s: %" PRIu64 " gaps, %" PRIu64 " unproven, the widest %.2g of the limit\n",
            fmb_method_at((size_t) m)->name, queries, wrong, order, refused, broken,
            fmb_method_at((size_t) m)->name, gap.count, gap.unproven, gap.width_most);
}

static void print_paths(const struct report *report, FILE *out)
{
    uint64_t pairs = 0, path[MEASURE_PATHS] = {0};
    for (size_t i = 0; i < report->measures; i++) {
        pairs += report->measure[i].pairs;
        for (int p = 0; p < MEASURE_PATHS; p++)
            path[p] += report->measure[i].path[p];
    }
    fprintf(out, "certified decided by");
    for (int p = 0; p < MEASURE_PATHS; p++)
        fprintf(out, "%s %s %.2f %%", p ? "," : "", measure_path_name(p),
                100 * (double) path[p] / (double) pairs);
    fprintf(out, "\n");
}

void report_print(const struct report *report, FILE *out)
{
    fprintf(out, "seed %" PRIu64 ", %ld pairs a cell\n", report->options->seed,
            report->options->pairs);
    print_paths(report, out);
    for (int m = 0; m < trial_methods(); m++)
        if (trial_never_wrong(fmb_method_at((size_t) m))) {
            print_never_wrong(report, m, out);
            fflush(out);
            print_reproducers(report, m);
        }
    if (report_not_as_made(report) > 0)
        fprintf(out, "%" PRIu64 " pairs are not what their family made them for\n",
                report_not_as_made(report));
}
