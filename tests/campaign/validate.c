/* The article's validation (section 6.1): random pairs of each of 2D/3D, static/dynamic, through
 * all combinations of shapes, each in both orders, by every method. The article compared its method
 * with SAT; here all are compared with the exact one. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cell.h"
#include "family.h"
#include "options.h"
#include "table.h"
#include "tally.h"
#include "trial.h"
#include "workers.h"

/* A cell is drawn in parts, so that all workers have something to do till the end. */
enum { PARTS = 16, SHAPES = 4, CELLS = CELL_ORDINARY, JOBS = CELLS * PARTS };

static const long usual_pairs = 1000000;

struct validation {
    long pairs; /* of a cell: all combinations of shapes of a space share the pairs asked for */
    uint64_t seed;
    struct cell cell[CELLS];
    struct tally (*tally)[TRIAL_METHODS_MAX]; /* [cell * PARTS + part][method] */
};

/* ---- Measuring ---- */

/* One method against the exact one's verdict. */
static void compare(const struct trial *trial, const struct fmb_method *method, int truth,
                    struct tally *tally)
{
    struct reply reply[2];
    for (int order = 0; order < 2; order++) {
        reply[order] = trial_ask(trial, method, order, 0);
        const int said = reply[order].answer.verdict;
        tally->queries++;
        if (reply[order].status != FMB_OK)
            tally->refused++;
        else
            tally->count[truth][said]++;
        if (trial_never_wrong(method) && (reply[order].status != FMB_OK || said != truth))
            tally_broken(tally, &trial->question, "not the verdict of the exact method");
    }
    tally_orders(tally, &reply[0], &reply[1]);
}

/* So many of the cell's pairs fall to the part. */
static long pairs_of_part(const struct validation *validation, int part)
{
    return validation->pairs * (part + 1) / PARTS - validation->pairs * part / PARTS;
}

static void validate_part(void *context, size_t job)
{
    struct validation *validation = context;
    const struct cell *cell = &validation->cell[job / PARTS];
    const int part = (int) (job % PARTS);
    struct draw draw = cell_draw(validation->seed, "validate", cell, part);
    for (long n = pairs_of_part(validation, part); n > 0; n--) {
        struct question question;
        struct trial trial;
        family_draw_random(&draw, cell, &question);
        trial_begin(&question, &trial);
        const struct fmb_method *exact = fmb_method_by_name("exact");
        const int truth = (int) trial_ask(&trial, exact, 0, 0).answer.verdict;
        for (int m = 0; m < trial_methods(); m++)
            compare(&trial, fmb_method_at((size_t) m), truth, &validation->tally[job][m]);
    }
}

/* ---- Telling ---- */

static void add_row(struct table *table, const struct cell *cell, const char *method,
                    const struct tally *tally)
{
    static const enum fmb_verdict then[][2] = {
        {FMB_SEPARATED, FMB_TOUCHING},    {FMB_SEPARATED, FMB_OVERLAPPING},
        {FMB_TOUCHING, FMB_SEPARATED},    {FMB_TOUCHING, FMB_OVERLAPPING},
        {FMB_OVERLAPPING, FMB_SEPARATED}, {FMB_OVERLAPPING, FMB_TOUCHING}};
    char text[CELL_TEXT_MAX];
    table_text(table, cell_text(cell, text));
    table_text(table, method);
    table_count(table, tally->queries);
    for (size_t i = 0; i < sizeof then / sizeof *then; i++)
        table_count(table, tally->count[then[i][1]][then[i][0]]);
    table_count(table, tally->order_verdict);
    table_count(table, tally->refused);
}

static struct tally cell_sum(const struct validation *validation, int cell, int method)
{
    struct tally sum = {0};
    for (int part = 0; part < PARTS; part++)
        tally_merge(&sum, &validation->tally[cell * PARTS + part][method]);
    return sum;
}

/* Returns how many replies were wrong of methods that never must be. */
static uint64_t print_report(const struct validation *validation)
{
    static const char *const heads[] = {"cell",    "method",  "queries", "sep/tou",
                                        "sep/ovl", "tou/sep", "tou/ovl", "ovl/sep",
                                        "ovl/tou", "order",   "refused", NULL};
    uint64_t broken = 0;
    struct table table;
    table_begin(&table, heads, 2);
    for (int cell = 0; cell < CELLS; cell++)
        for (int m = 0; m < trial_methods(); m++) {
            const char *name = fmb_method_at((size_t) m)->name;
            struct tally sum = cell_sum(validation, cell, m);
            add_row(&table, &validation->cell[cell], name, &sum);
            broken += sum.broken;
            if (sum.broken == 0)
                continue;
            printf("# %s: %s\n", name, sum.first.why);
            question_print(&sum.first.question);
        }
    printf(
        "Random pairs, each in both orders, against the exact method. sep/tou: said to be\n"
        "separated, and touching in truth. order: pairs whose two orders differ.\n\n");
    table_print(&table, stdout);
    table_end(&table);
    printf("\n%ld pairs of each space, seed %llu: ", SHAPES * validation->pairs,
           (unsigned long long) validation->seed);
    if (broken > 0)
        printf("%llu wrong verdicts of methods that are never wrong\n",
               (unsigned long long) broken);
    else
        printf("no wrong verdict of a method that is never wrong\n");
    return broken;
}

/* ---- The program ---- */

static const struct option option_list[] = {{"pairs", required_argument, NULL, OPTION_PAIRS},
                                            {"seed", required_argument, NULL, OPTION_SEED},
                                            {"workers", required_argument, NULL, OPTION_WORKERS},
                                            {"help", no_argument, NULL, OPTION_HELP},
                                            {NULL, 0, NULL, 0}};

static void help(void)
{
    printf(
        "usage: validate [OPTIONS]\n"
        "\n"
        "Decides random pairs of cuboids and tetrahedra, 2D and 3D, static and moving, in both\n"
        "orders, by every method, and counts where these disagree with the exact one.\n"
        "\n"
        "  --pairs N     of each of the four spaces (%ld)\n"
        "  --seed S      what to draw from\n"
        "  --workers N   threads (one a processor); the counts do not depend on it\n"
        "  --help\n"
        "\n"
        "Exit codes: 0 the methods that are never wrong were not, 1 one was, 2 wrong usage.\n",
        usual_pairs);
}

int main(int argc, char **argv)
{
    static const struct options_program program = {"validate", option_list, help, usual_pairs};
    struct validation validation = {0};
    struct options options;
    int code = options_parse(&program, argc, argv, &options);
    if (code != OPTIONS_RUN)
        return code;
    validation.pairs = (options.pairs + SHAPES - 1) / SHAPES;
    validation.seed = options.seed;
    validation.tally = calloc(JOBS, sizeof *validation.tally);
    if (!validation.tally) {
        fprintf(stderr, "validate: out of memory\n");
        return EXIT_FOUND;
    }
    cell_list(false, validation.cell);
    workers_do("validate", options.workers, JOBS, validate_part, &validation);
    uint64_t broken = print_report(&validation);
    free(validation.tally);
    return broken ? EXIT_FOUND : EXIT_NONE_WRONG;
}
