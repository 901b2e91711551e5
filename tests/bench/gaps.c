/* The cost of gaps: distance and depth of pairs with chosen gaps, beside other libraries, and how
 * often the results of these are off. */
#include "batch.h"
#include "bench.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "gap_pairs.h"

enum { OWN_RUNS = 3, RUNS_MAX = 12, BLOCKS_MAX = 64 };

/* Pairs that are timed come first, then those for warming up. */
struct gaps {
    enum instructions instructions;
    size_t timed, warm;
    struct gap_pairs pairs;
    unsigned char *verdict;
    struct fmb_gap *gap;
    struct peers *peers;
    double *peer_gap;
};

static void gaps_open(const struct bench *bench, const struct cell *cell, double target,
                      struct gaps *out)
{
    const size_t warm = bench->pairs / 4, count = bench->pairs + warm;
    *out = (struct gaps){.instructions = bench->instructions,
                         .timed = bench->pairs,
                         .warm = warm,
                         .verdict = scene_allocate(count, 1),
                         .gap = scene_allocate(count, sizeof *out->gap),
                         .peer_gap = scene_allocate(count, sizeof *out->peer_gap)};
    gap_pairs_draw(cell, target, count, bench->seed, &out->pairs);
    out->peers = peers_open(out->pairs.solid, 2 * count);
}

static void gaps_close(struct gaps *gaps)
{
    peers_close(gaps->peers);
    gap_pairs_free(&gaps->pairs);
    free(gaps->verdict);
    free(gaps->gap);
    free(gaps->peer_gap);
}

/* ---- Runs ---- */

static void batch(struct gaps *gaps, size_t first, size_t count)
{
    const struct fmb_batch batch = {.frames = gaps->pairs.scene.prepared,
                                    .frame_count = gaps->pairs.scene.count,
                                    .pairs = (const unsigned(*)[2]) gaps->pairs.pair + first,
                                    .pair_count = count,
                                    .instant = true,
                                    .verdicts = gaps->verdict + first,
                                    .gaps = gaps->gap + first};
    batch_decide(&batch, gaps->instructions, INFINITY);
}

static void single(struct gaps *gaps, size_t first, size_t count)
{
    for (size_t i = first; i < first + count; i++)
        batch(gaps, i, 1);
}

static void query(struct gaps *gaps, size_t first, size_t count)
{
    const struct fmb_placement *placement = gaps->pairs.scene.placement;
    struct fmb_answer answer;
    for (size_t i = first; i < first + count; i++) {
        fmb_decide(fmb_method_default(), &placement[i], &placement[gaps->pairs.count + i], 0,
                   FMB_WANT_GAP, &answer);
        gaps->gap[i] = answer.gap;
        gaps->verdict[i] = (unsigned char) answer.verdict;
    }
}

static const struct {
    const char *name;
    void (*run)(struct gaps *gaps, size_t first, size_t count);
} own[OWN_RUNS] = {{"batch", batch}, {"single", single}, {"query", query}};

static const char *run_name(int k)
{
    return k < OWN_RUNS ? own[k].name : peer_name(k - OWN_RUNS);
}

/* The runs that give what a pair has. Returns how many. */
static int runs_of(bool separated, int run[RUNS_MAX])
{
    int count = 0;
    for (int k = 0; run_name(k) && count < RUNS_MAX; k++) {
        const int gap = separated ? PEER_DISTANCE : PEER_DEPTH;
        if (k < OWN_RUNS || peer_answers(k - OWN_RUNS) & gap)
            run[count++] = k;
    }
    return count;
}

static void run(struct gaps *gaps, int k, size_t first, size_t count)
{
    if (k < OWN_RUNS)
        own[k].run(gaps, first, count);
    else
        peer_run(gaps->peers, k - OWN_RUNS, (const unsigned(*)[2]) gaps->pairs.pair + first, count,
                 gaps->peer_gap + first);
}

/* ---- Times and errors ---- */

/* Nanoseconds a pair, the runs in turn within each block. */
static void time_runs(const struct bench *bench, struct gaps *gaps, const int *runs, int count,
                      double out[RUNS_MAX])
{
    double times[RUNS_MAX][BLOCKS_MAX];
    const int blocks = bench->race.blocks < BLOCKS_MAX ? bench->race.blocks : BLOCKS_MAX;
    for (int block = 0; block < blocks; block++) {
        stopwatch_calibrate();
        for (int k = 0; k < count; k++) {
            run(gaps, runs[k], gaps->timed, gaps->warm);
            const double start = stopwatch_now();
            run(gaps, runs[k], 0, gaps->timed);
            times[k][block] = (stopwatch_now() - start) / (double) gaps->timed;
        }
    }
    for (int k = 0; k < count; k++)
        out[k] = spread_of(times[k], blocks).median;
}

/* Shares of the timed pairs: off, a failure or a gap farther from the enclosure than 1e-9 of the
 * size; wrong, a sign that contradicts the verdict. */
struct errors {
    double off, wrong;
};

static struct errors errors_of(const struct gaps *gaps)
{
    size_t off = 0, wrong = 0;
    for (size_t i = 0; i < gaps->timed; i++) {
        const double peer = gaps->peer_gap[i], *bounds = gaps->gap[i].bounds;
        const double far = 1e-9 * gaps->pairs.size[i];
        const bool separated = gaps->verdict[i] == FMB_SEPARATED;
        wrong += separated ? peer <= 0 : peer > 0;
        off += !(peer >= bounds[0] - far && peer <= bounds[1] + far);
    }
    return (struct errors){(double) off / (double) gaps->timed,
                           (double) wrong / (double) gaps->timed};
}

/* ---- Tables ---- */

static const struct kind {
    const char *name;
    struct cell cell;
} kinds[] = {{"cuboids", {3, false, {FMB_CUBOID, FMB_CUBOID}}},
             {"tetrahedra", {3, false, {FMB_TETRAHEDRON, FMB_TETRAHEDRON}}},
             {"mixed", {3, false, {FMB_CUBOID, FMB_TETRAHEDRON}}},
             {"boxes", {3, false, {FMB_BOX, FMB_BOX}}}};

static void put_run(struct bench *bench, struct gaps *gaps, int k, double ns)
{
    json_begin(&bench->json, NULL, '{');
    json_string(&bench->json, "name", run_name(k));
    json_number(&bench->json, "ns", ns);
    printf(" %7.0f", ns);
    if (k >= OWN_RUNS) {
        run(gaps, k, 0, gaps->timed);
        const struct errors errors = errors_of(gaps);
        json_number(&bench->json, "off", errors.off);
        json_number(&bench->json, "wrong", errors.wrong);
        printf(" %5.1f %5.1f", 100 * errors.off, 100 * errors.wrong);
    }
    json_end(&bench->json, '}');
}

static void row(struct bench *bench, const struct kind *kind, double target)
{
    struct gaps gaps;
    int runs[RUNS_MAX];
    double ns[RUNS_MAX];
    const int count = runs_of(target > 0, runs);
    bench_progress(kind->name);
    gaps_open(bench, &kind->cell, target, &gaps);
    time_runs(bench, &gaps, runs, count, ns);
    bench_progress(NULL);
    printf("%-10s %6.0e", kind->name, target);
    json_begin(&bench->json, NULL, '{');
    json_string(&bench->json, "kind", kind->name);
    json_number(&bench->json, "gap", target);
    json_begin(&bench->json, "runs", '[');
    for (int k = 0; k < count; k++)
        put_run(bench, &gaps, runs[k], ns[k]);
    json_end(&bench->json, ']');
    json_end(&bench->json, '}');
    for (int k = 0; k < OWN_RUNS && count > OWN_RUNS; k++)
        printf(" %6.2f", ns[k] / ns[OWN_RUNS]);
    putchar('\n');
    gaps_close(&gaps);
}

static void table(struct bench *bench, bool separated)
{
    static const double sizes[] = {1, 1e-3, 1e-6, 1e-9}, depths[] = {-1e-9, -1e-6, -1e-3, -0.1};
    int runs[RUNS_MAX];
    const int count = runs_of(separated, runs);
    printf("\n%-17s", separated ? "separated" : "overlapping");
    for (int k = 0; k < count; k++)
        printf(" %*s", runs[k] < OWN_RUNS ? 7 : 19, run_name(runs[k]));
    if (count > OWN_RUNS)
        printf("  batch single  query / %s", run_name(runs[OWN_RUNS]));
    putchar('\n');
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        for (int k = 0; k < 4; k++)
            row(bench, &kinds[i], separated ? sizes[k] : depths[k]);
}

void gaps_run(struct bench *bench)
{
    if (!bench_wants(bench, "gaps"))
        return;
    printf(
        "\nGaps, nanoseconds a pair, of distinct pairs at the gap in the first column. batch:\n"
        "verdicts and gaps of prepared frames; single: a batch of one pair; query:\n"
        "fmb_decide() of placements. Others are given the vertices in world coordinates.\n"
        "After the time of each comes the percentage of its gaps that are missing or off by\n"
        "more than 1e-9 of the size of the larger body, then that of its wrong verdicts. Last:\n"
        "ratios of batch, single and query to the first of the others.\n");
    peers_help();
    json_begin(&bench->json, "gaps", '[');
    table(bench, true);
    table(bench, false);
    json_end(&bench->json, ']');
}
