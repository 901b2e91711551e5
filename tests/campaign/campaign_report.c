#include "campaign_report.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "table.h"

enum { REPRODUCERS_MAX = 8 };

/* ---- Sums ---- */

/* Adds up a family's cells. Times: the mean of the cells'. */
static void add_measure(struct measure *into, const struct measure *from, double share)
{
    into->pairs += from->pairs;
    into->not_as_made += from->not_as_made;
    for (int v = 0; v < TALLY_VERDICTS; v++)
        into->truth[v] += from->truth[v];
    for (int p = 0; p < MEASURE_PATHS; p++)
        into->path[p] += from->path[p];
    for (int m = 0; m < trial_methods(); m++) {
        tally_merge(&into->method[m].tally, &from->method[m].tally);
        into->method[m].ns_verdict += share * from->method[m].ns_verdict;
        into->method[m].ns_box += share * from->method[m].ns_box;
        into->method[m].ns_gap += share * from->method[m].ns_gap;
    }
}

static size_t cells_of_family(const struct report *report, size_t first)
{
    size_t count = 1;
    while (first + count < report->measures &&
           report->measure[first + count].family == report->measure[first].family)
        count++;
    return count;
}

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

/* ---- The table ---- */

static const char *const heads[] = {
    "family",   "cell",   "truth s/t/o", "method",   "queries", "f.sep",    "f.con",
    "f.kind",   "order",  "refused",     "box miss", "median",  "p99",      "max",
    "int miss", "median", "p99",         "max",      "gaps",    "unproven", "widest",
    "unsure",   "ns",     "ns+box",      "ns+gap",   NULL};

static const char legend[] =
    "truth: percent of the pairs separated, touching, overlapping. queries: two a pair, one an\n"
    "order. Wrong verdicts: f.sep, in contact and called separated; f.con, separated and said\n"
    "to be in contact; f.kind, touching and overlapping confused. order: pairs whose two orders\n"
    "differ in the verdict. refused: 'cannot decide'. box, int(erval): those that do not contain\n"
    "the true one; then how far out their worst ends lie, relative to the largest coordinate\n"
    "of any vertex over the window, and to T. gaps: of (A, B); unproven: by rational numbers;\n"
    "widest: enclosure, relative to the limit. unsure: pairs that the filter of the certified\n"
    "method left open. ns: a query without the box, with the box, with the gap.\n";

static void add_ends(struct table *table, const struct tally_ends *ends)
{
    const uint64_t count = ends->out.count;
    if (count == 0) {
        for (int i = 0; i < 4; i++)
            table_text(table, "-");
        return;
    }
    table_share(table, ends->misses, count);
    table_small(table, spread_quantile(&ends->out, 0.5));
    table_small(table, spread_quantile(&ends->out, 0.99));
    table_small(table, ends->out.max);
}

static void add_gaps(struct table *table, const struct tally_gaps *gaps)
{
    if (gaps->width.count == 0) {
        for (int i = 0; i < 3; i++)
            table_text(table, "-");
        return;
    }
    table_count(table, gaps->width.count);
    table_count(table, gaps->unproven);
    table_small(table, gaps->width.max);
}

static void add_truth(struct table *table, const struct measure *measure)
{
    char text[TABLE_TEXT_MAX];
    double share[TALLY_VERDICTS];
    for (int v = 0; v < TALLY_VERDICTS; v++)
        share[v] = 100 * (double) measure->truth[v] / (double) measure->pairs;
    snprintf(text, sizeof text, "%.0f/%.0f/%.0f", share[FMB_SEPARATED], share[FMB_TOUCHING],
             share[FMB_OVERLAPPING]);
    table_text(table, text);
}

static void add_unsure(struct table *table, const struct measure *measure, const char *method)
{
    if (strcmp(method, "certified") == 0)
        table_share(table, measure->pairs - measure->path[0], measure->pairs);
    else
        table_text(table, "-");
}

static void add_row(struct table *table, const struct measure *measure, const char *cell, int m)
{
    const struct measure_method *method = &measure->method[m];
    const struct tally *tally = &method->tally;
    const char *name = fmb_method_at((size_t) m)->name;
    const bool first = m == 0;
    table_text(table, first ? measure->family->name : "");
    table_text(table, first ? cell : "");
    if (first)
        add_truth(table, measure);
    else
        table_text(table, "");
    table_text(table, name);
    table_count(table, tally->queries);
    table_count(table, tally_false_separated(tally));
    table_count(table, tally_false_contact(tally));
    table_count(table, tally_false_kind(tally));
    table_count(table, tally->order_verdict);
    table_count(table, tally->refused);
    add_ends(table, &tally->box);
    add_ends(table, &tally->contact);
    add_gaps(table, &tally->gap);
    add_unsure(table, measure, name);
    table_time(table, method->ns_verdict);
    table_time(table, method->ns_box);
    if (method->ns_gap > 0)
        table_time(table, method->ns_gap);
    else
        table_text(table, "-");
}

static void add_rows(struct table *table, const struct measure *measure, const char *cell)
{
    for (int m = 0; m < trial_methods(); m++)
        add_row(table, measure, cell, m);
}

static void add_family(struct table *table, const struct report *report, size_t first, size_t cells)
{
    struct measure *sum = calloc(1, sizeof *sum);
    char text[TABLE_TEXT_MAX];
    if (!sum)
        return;
    sum->family = report->measure[first].family;
    for (size_t i = first; i < first + cells; i++)
        add_measure(sum, &report->measure[i], 1 / (double) cells);
    snprintf(text, sizeof text, "%zu cells", cells);
    add_rows(table, sum, text);
    free(sum);
}

static void print_table(const struct report *report, FILE *out)
{
    struct table table;
    table_begin(&table, heads, 4);
    for (size_t i = 0, cells; i < report->measures; i += cells) {
        char text[CELL_TEXT_MAX];
        cells = report->options->cells ? 1 : cells_of_family(report, i);
        if (report->options->cells)
            add_rows(&table, &report->measure[i], cell_text(&report->measure[i].cell, text));
        else
            add_family(&table, report, i, cells);
    }
    table_print(&table, out);
    table_end(&table);
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
        spread_merge(&gap.width, &tally->gap.width);
    }
    fprintf(out,
            "%s: %" PRIu64 " queries, %" PRIu64 " wrong verdicts, %" PRIu64
            " pairs with another verdict in the other order, %" PRIu64 " refused, %" PRIu64
            " answers that break a promise (verdict, interval, box, gap)\n"
            "%s: %" PRIu64 " gaps, %" PRIu64 " unproven, the widest %.2g of the limit\n",
            fmb_method_at((size_t) m)->name, queries, wrong, order, refused, broken,
            fmb_method_at((size_t) m)->name, gap.width.count, gap.unproven, gap.width.max);
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
    fprintf(out, "%s\n", legend);
    print_table(report, out);
    fprintf(out, "\nseed %" PRIu64 ", %ld pairs a cell\n", report->options->seed,
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
