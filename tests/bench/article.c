/* The article's own qualification (section 6.2, Table 1): a pair is decided again and again, A-B
 * and B-A, with the inverse computed in the call; of each pair the ratio of the times of FMB and
 * SAT is taken, and of these the mean. Repeating hides what mispredicted branches cost, so these
 * times are not those of a scene. */
#include "bench.h"

#include <string.h>

enum timed {
    FMB_TIME,
    FMB_CACHED_TIME,
    SAT_TIME,
    SAT_QUERY_TIME,
    CERTIFIED_TIME,
    QUERY_TIME,
    TIMED
};

static const enum contender timed[TIMED] = {CONTENDER_FMB_COMPUTED, CONTENDER_FMB,
                                            CONTENDER_SAT,          CONTENDER_SAT_QUERY,
                                            CONTENDER_SINGLE,       CONTENDER_QUERY};

static const char *const keys[TIMED] = {"fmb_ns",       "fmb_cached_ns", "sat_ns",
                                        "sat_query_ns", "certified_ns",  "certified_query_ns"};

/* Table 1: FMB to SAT, [2D static, 3D static, 2D moving, 3D moving][CC, CT, TT][in contact,
 * separated]. Pairs of both shapes are one column there. */
static const double table_1[4][3][2] = {{{2.58, 1.22}, {1.86, 1.29}, {1.33, 1.32}},
                                        {{0.72, 0.50}, {0.41, 0.66}, {0.24, 0.89}},
                                        {{3.12, 1.50}, {2.22, 1.50}, {1.67, 1.50}},
                                        {{2.58, 0.71}, {1.37, 0.81}, {0.54, 0.95}}};

struct means {
    double ns[TIMED];
    double fmb_to_sat, fmb_to_sat_query, certified_to_sat;
};

enum { REPEATS_LEAST = 16, REPEATS_MOST = 1024 };

/* Nanoseconds a call of the same pair. */
static double time_of(enum contender contender, const struct scene *scene, const unsigned pair[2],
                      double budget)
{
    static unsigned same[REPEATS_MOST][2];
    static unsigned char verdicts[REPEATS_MOST];
    struct work work = {.scene = scene, .pair = (const unsigned(*)[2]) same, .verdicts = verdicts};
    for (int i = 0; i < REPEATS_MOST; i++)
        memcpy(same[i], pair, sizeof same[i]);
    double ns = 0;
    for (int round = 0; round < 2; round++) { /* the first one says how many */
        const double most = round == 0 ? 0 : budget / ns;
        work.count = most > REPEATS_MOST    ? REPEATS_MOST
                     : most > REPEATS_LEAST ? (size_t) most
                                            : REPEATS_LEAST;
        const double start = stopwatch_now();
        contender_run(contender, &work);
        ns = (stopwatch_now() - start) / (double) work.count;
    }
    return ns;
}

static void add_pair(const struct scene *scene, const unsigned pair[2], double budget,
                     struct means *sum)
{
    double ns[TIMED];
    for (int i = 0; i < TIMED; i++) {
        ns[i] = time_of(timed[i], scene, pair, budget);
        sum->ns[i] += ns[i];
    }
    sum->fmb_to_sat += ns[FMB_TIME] / ns[SAT_TIME];
    sum->fmb_to_sat_query += ns[FMB_TIME] / ns[SAT_QUERY_TIME];
    sum->certified_to_sat += ns[CERTIFIED_TIME] / ns[SAT_TIME];
}

static struct means means_of(const struct bench *bench, const struct cell *cell, bool in_contact)
{
    const double budget = bench->quick ? 2e3 : 2e4;
    const size_t most = bench->quick ? 16 : 256;
    struct arena arena;
    arena_open(bench, cell, in_contact, &arena);
    const size_t count = arena.work.count < most ? arena.work.count : most;
    struct means means = {{0}, 0, 0, 0};
    for (size_t i = 0; i < count; i++) {
        const unsigned *at = arena.work.pair[i];
        stopwatch_calibrate();
        add_pair(&arena.scene, at, budget, &means);
        add_pair(&arena.scene, (const unsigned[2]){at[1], at[0]}, budget, &means);
    }
    const double samples = 2 * (double) count;
    for (int i = 0; i < TIMED; i++)
        means.ns[i] /= samples;
    means.fmb_to_sat /= samples;
    means.fmb_to_sat_query /= samples;
    means.certified_to_sat /= samples;
    arena_close(&arena);
    return means;
}

static void put(struct json_writer *json, const struct cell *cell, bool in_contact, double article,
                const struct means *means)
{
    json_begin(json, NULL, '{');
    bench_put_cell(json, cell);
    json_bool(json, "contact", in_contact);
    json_number(json, "article_ratio", article);
    for (int i = 0; i < TIMED; i++)
        json_number(json, keys[i], means->ns[i]);
    json_number(json, "fmb_to_sat", means->fmb_to_sat);
    json_number(json, "fmb_to_sat_query", means->fmb_to_sat_query);
    json_number(json, "certified_to_sat", means->certified_to_sat);
    json_end(json, '}');
}

static void cell_run(struct bench *bench, const struct cell *cell)
{
    const int row = 2 * cell->moving + (cell->dim == 3);
    const int column = (cell->shape[0] == FMB_TETRAHEDRON) + (cell->shape[1] == FMB_TETRAHEDRON);
    char text[CELL_TEXT_MAX];
    bench_progress(cell_text(cell, text));
    for (int contact = 1; contact >= 0; contact--) {
        const double article = table_1[row][column][!contact];
        const struct means means = means_of(bench, cell, contact);
        bench_progress(NULL);
        printf("%-13s %-10s %9.2f %9.2f %9.2f %9.2f", cell_text(cell, text),
               contact ? "in contact" : "separated", article, means.fmb_to_sat_query,
               means.fmb_to_sat, means.certified_to_sat);
        for (int i = 0; i < TIMED; i++)
            printf(" %9.1f", means.ns[i]);
        putchar('\n');
        put(&bench->json, cell, contact, article, &means);
    }
}

void article_run(struct bench *bench)
{
    struct cell cells[CELL_WITH_FACES];
    const int count = cell_list(false, cells);
    if (!bench_wants(bench, "article"))
        return;
    printf(
        "\nThe article's protocol: a pair again and again, A-B and B-A, the inverse computed in "
        "the\n"
        "call. Mean ratios FMB to SAT: of its Table 1; of the methods fmb and sat; of fmb to the\n"
        "yardstick; and of certified (single) to the yardstick. Then nanoseconds, means.\n\n"
        "%-24s %9s %9s %9s %9s %9s %9s %9s %9s %9s %9s\n",
        "", "article", "fmb/query", "fmb/sat", "cert/sat", "fmb", "cached", "sat", "sat query",
        "certified", "query");
    json_begin(&bench->json, "article", '[');
    for (int i = 0; i < count; i++)
        if (cells[i].shape[0] <= cells[i].shape[1]) /* CT stands for TC, decided as B-A */
            cell_run(bench, &cells[i]);
    json_end(&bench->json, ']');
}
