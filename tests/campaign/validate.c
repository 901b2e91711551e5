/* The article's validation (section 6.1): random pairs of each of 2D/3D, static/dynamic, through
 * all combinations of shapes, each in both orders, by every method. The article compared its method
 * with SAT; here all are compared with the exact one. Then the same for random poses and all
 * shapes, with certificates: of some pairs the exact verdict is compared with the oracle's, and its
 * certificate with both. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cell.h"
#include "family.h"
#include "campaign_options.h"
#include "posed.h"
#include "campaign_tally.h"
#include "trial.h"
#include "workers.h"

/* A cell is drawn in parts, so that all workers have something to do till the end. */
enum {
    PARTS = 16,
    CELLS = CELL_ORDINARY + CELL_OF_ALL_SHAPES + CELL_WITH_A_HULL,
    JOBS = CELLS * PARTS
};

/* Each so many pairs of placed bodies, one of a hard family gets a certificate. */
enum { CERTIFIED_ONE_IN = 64 };

static const long usual_pairs = 1000000;

struct validation {
    long pairs; /* of each space, and of each with poses: their combinations of shapes share them */
    uint64_t seed;
    struct cell cell[CELLS];                  /* from CELL_ORDINARY on: with poses */
    struct tally (*tally)[TRIAL_METHODS_MAX]; /* [cell * PARTS + part][method] */
    uint64_t certificates[JOBS];
};

static bool is_posed(size_t cell)
{
    return cell >= CELL_ORDINARY;
}

/* ---- Measuring ---- */

/* One method against the exact one's verdict. */
static void compare(const struct trial *trial, const struct fmb_method *method, int truth,
                    struct tally *tally)
{
    struct reply reply[2];
    for (int order = 0; order < 2; order++) {
        reply[order] = trial_decide(trial, method, order, 0);
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

/* A hard pair of placed bodies of one frame each. */
static void draw_hard(struct draw *draw, const struct cell *cell, struct question *out)
{
    int families = 0;
    while (family_posed_at((size_t) families))
        families++;
    do {
        const struct family *family = family_posed_at((size_t) draw_int(draw, 0, families - 1));
        if (family_has_cell(family, cell))
            family_draw(family, cell, draw, out);
        else
            out->a.frames = 2; /* drawn again */
    } while (solid_frames(&out->a) > 1 || solid_frames(&out->b) > 1);
}

/* Of a hard pair the exact method, the oracle and a certificate agree. */
static void check_certificate(struct draw *draw, const struct cell *cell, struct tally *tally)
{
    char text[FMB_CERTIFICATE_MAX], why[TALLY_WHY_MAX];
    struct oracle_answer truth;
    struct question question;
    struct trial trial;
    size_t length;
    draw_hard(draw, cell, &question);
    trial_begin(&question, &trial);
    oracle_init(&truth);
    oracle_decide(&trial.pair[0], 0, &truth);
    const struct reply reply = trial_decide(&trial, fmb_method_by_name("exact"), 0, 0);
    const enum fmb_status status = pair_certificate(&trial.pair[0], text, sizeof text, &length);
    if (reply.status != FMB_OK || reply.answer.verdict != truth.verdict)
        tally_broken(tally, &question, "not the verdict of the oracle");
    else if (status != FMB_OK)
        tally_broken(tally, &question, fmb_status_text(status));
    else if (length > 0 &&
             !pair_certificate_holds(&trial.pair[0], truth.verdict, text, why, sizeof why))
        tally_broken(tally, &question, why);
    trial_end(&trial);
    oracle_clear(&truth);
}

/* How many cells share the pairs of a space. */
static int cells_of_space(const struct validation *validation, size_t cell)
{
    const struct cell *of = &validation->cell[cell];
    const size_t first = is_posed(cell) ? CELL_ORDINARY : 0;
    const size_t last = is_posed(cell) ? CELLS : CELL_ORDINARY;
    int count = 0;
    for (size_t i = first; i < last; i++)
        count += validation->cell[i].dim == of->dim && validation->cell[i].moving == of->moving;
    return count;
}

/* So many of the cell's pairs fall to the part. */
static long pairs_of_part(const struct validation *validation, size_t cell, int part)
{
    const int cells = cells_of_space(validation, cell);
    const long pairs = (validation->pairs + cells - 1) / cells;
    return pairs * (part + 1) / PARTS - pairs * part / PARTS;
}

static void validate_part(void *context, size_t job)
{
    struct validation *validation = context;
    const size_t at = job / PARTS;
    const struct cell *cell = &validation->cell[at];
    const int part = (int) (job % PARTS);
    const struct fmb_method *exact = fmb_method_by_name("exact");
    const char *name = is_posed(at) ? "validate poses" : "validate";
    struct draw draw = cell_draw(validation->seed, name, cell, part);
    for (long n = pairs_of_part(validation, at, part); n > 0; n--) {
        struct question question;
        struct trial trial;
        if (is_posed(at))
            family_draw_posed(&draw, cell, &question);
        else
            family_draw_random(&draw, cell, &question);
        trial_begin(&question, &trial);
        const int truth = (int) trial_decide(&trial, exact, 0, 0).answer.verdict;
        for (int m = 0; m < trial_methods(); m++)
            compare(&trial, fmb_method_at((size_t) m), truth, &validation->tally[job][m]);
        if (is_posed(at) && (n - 1) % CERTIFIED_ONE_IN == 0) {
            validation->certificates[job]++;
            check_certificate(&draw, cell, &validation->tally[job][0]);
        }
        trial_end(&trial);
    }
}

/* ---- Report ---- */

static void print_row(const struct validation *validation, int at, const char *method,
                      const struct tally *tally)
{
    char text[CELL_TEXT_MAX];
    printf("%s%s, %s: %" PRIu64 " queries, called separated in contact %" PRIu64
           ", in contact separated %" PRIu64 ", touching and overlapping confused %" PRIu64
           ", orders differ %" PRIu64 ", refused %" PRIu64 "\n",
           cell_text(&validation->cell[at], text), is_posed((size_t) at) ? " posed" : "", method,
           tally->queries, tally_false_separated(tally), tally_false_contact(tally),
           tally_false_kind(tally), tally->order_verdict, tally->refused);
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
    uint64_t broken = 0;
    printf("Random pairs, each in both orders, against the exact method.\n\n");
    for (int cell = 0; cell < CELLS; cell++)
        for (int m = 0; m < trial_methods(); m++) {
            const char *name = fmb_method_at((size_t) m)->name;
            struct tally sum = cell_sum(validation, cell, m);
            print_row(validation, cell, name, &sum);
            broken += sum.broken;
            if (sum.broken == 0)
                continue;
            printf("# %s: %s\n", name, sum.first.why);
            question_print(&sum.first.question);
        }
    uint64_t certificates = 0;
    for (size_t job = 0; job < JOBS; job++)
        certificates += validation->certificates[job];
    printf("\n%ld pairs of each space, %llu certificates, seed %llu: ", validation->pairs,
           (unsigned long long) certificates, (unsigned long long) validation->seed);
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
        "orders, by every method, and counts where these disagree with the exact one. Then random\n"
        "poses of all shapes; some of these have certificates, which are checked, and answers "
        "of the oracle.\n"
        "\n"
        "  --pairs N     of each of the four spaces, and of each with poses (%ld)\n"
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
    static struct validation validation;
    struct options options;
    int code = options_parse(&program, argc, argv, &options);
    if (code != OPTIONS_RUN)
        return code;
    validation.pairs = options.pairs;
    validation.seed = options.seed;
    validation.tally = calloc(JOBS, sizeof *validation.tally);
    if (!validation.tally) {
        fprintf(stderr, "validate: out of memory\n");
        return EXIT_FOUND;
    }
    cell_list(false, validation.cell);
    cell_list_all(validation.cell + CELL_ORDINARY);
    cell_list_hulls(validation.cell + CELL_ORDINARY + CELL_OF_ALL_SHAPES);
    workers_do("validate", options.workers, JOBS, validate_part, &validation);
    uint64_t broken = print_report(&validation);
    free(validation.tally);
    return broken ? EXIT_FOUND : EXIT_NONE_WRONG;
}
