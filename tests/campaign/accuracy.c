/* The accuracy campaign: families of hard pairs, in every cell of dimension, motion and shapes,
 * decided by every method in both orders and held against the oracle, which shares no code with the
 * engine. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "family.h"
#include "measure.h"
#include "campaign_options.h"
#include "campaign_report.h"
#include "posed.h"
#include "round.h"
#include "workers.h"

static const long usual_pairs = 20000;

static const struct option option_list[] = {{"pairs", required_argument, NULL, OPTION_PAIRS},
                                            {"family", required_argument, NULL, OPTION_FAMILY},
                                            {"seed", required_argument, NULL, OPTION_SEED},
                                            {"every", required_argument, NULL, OPTION_EVERY},
                                            {"workers", required_argument, NULL, OPTION_WORKERS},
                                            {"json", required_argument, NULL, OPTION_JSON},
                                            {"help", no_argument, NULL, OPTION_HELP},
                                            {NULL, 0, NULL, 0}};

static void help(void)
{
    printf(
        "usage: accuracy [OPTIONS]\n"
        "\n"
        "Draws pairs that are hard for a reason, puts them to every method in both orders and\n"
        "counts what is wrong, by an oracle that shares no code with the engine.\n"
        "\n"
        "  --pairs N      of each family and cell: dimension, motion, shapes (%ld)\n"
        "  --family NAME  this family, or those whose names begin so up to a dash; may be\n"
        "                 repeated (all)\n"
        "  --every N      one cell in N of each family (1: all)\n"
        "  --seed S       what to draw from\n"
        "  --workers N    threads (one a processor); the counts do not depend on it\n"
        "  --json FILE    write the counts and times of all methods there\n"
        "  --help\n"
        "\n"
        "Exit codes: 0 the methods that are never wrong were not, 1 one was, 2 wrong usage.\n"
        "\n"
        "Families:\n",
        usual_pairs);
    for (size_t i = 0; family_all_at(i); i++)
        printf("  %-20s  %s\n", family_all_at(i)->name, family_all_at(i)->summary);
}

struct campaign {
    const struct options *options;
    struct measure *measure;
    size_t measures;
};

static void add_cells(struct campaign *campaign, const struct family *family)
{
    struct cell cell[CELL_OF_ALL_SHAPES];
    const int count = family_cells(family, cell);
    for (int i = 0; i < count; i += (int) campaign->options->every) {
        struct measure *measure = &campaign->measure[campaign->measures++];
        measure->family = family;
        measure->cell = cell[i];
    }
}

/* False if there is no memory. */
static bool list_cells(struct campaign *campaign)
{
    const struct options *options = campaign->options;
    size_t families = (size_t) options->families;
    if (families == 0)
        while (family_all_at(families))
            families++;
    campaign->measure = calloc(families * CELL_OF_ALL_SHAPES, sizeof *campaign->measure);
    if (!campaign->measure)
        return false;
    for (size_t i = 0; i < families; i++)
        add_cells(campaign, options->families ? options->family[i] : family_all_at(i));
    return true;
}

static void run_cell(void *context, size_t job)
{
    struct campaign *campaign = context;
    measure_cell(&campaign->measure[job], campaign->options->pairs, campaign->options->seed);
}

/* Returns the exit code. */
static int print_report(const struct campaign *campaign)
{
    const struct report report = {campaign->options, campaign->measure, campaign->measures};
    const char *json = campaign->options->json;
    report_print(&report, stdout);
    if (json && !report_write_json(&report, json)) {
        fprintf(stderr, "accuracy: %s: %s\n", json, strerror(errno));
        return EXIT_USAGE;
    }
    const bool wrong = report_broken(&report) > 0 || report_not_as_made(&report) > 0;
    return wrong ? EXIT_FOUND : EXIT_NONE_WRONG;
}

int main(int argc, char **argv)
{
    static const struct options_program program = {"accuracy", option_list, help, usual_pairs};
    struct options options;
    struct campaign campaign = {.options = &options};
    int code = options_parse(&program, argc, argv, &options);
    if (code != OPTIONS_RUN)
        return code;
    if (!list_cells(&campaign)) {
        fprintf(stderr, "accuracy: out of memory\n");
        return EXIT_FOUND;
    }
    workers_do("accuracy", options.workers, campaign.measures, run_cell, &campaign);
    code = print_report(&campaign);
    free(campaign.measure);
    return code;
}
