/* Scenes by handle, as many pairs as a datagram holds, one query after the other or a few under
 * way: pairs a second from bus to bus; beside the bytes that the echo carries at the same sizes,
 * and beside the engine's own batch of the same pairs. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "clock.h"
#include "duel.h"
#include "guard.h"
#include "wire.h"
#include "workload.h"

enum { BLOCKS_MAX = 64, PAIRS_DRAWN = 15000 };

static const double block_seconds = 5;

struct load {
    const char *name;
    int bodies;
    bool moving;
    int32_t which, want;
};

static const struct load loads[] = {
    {"100 bodies, listed", 100, false, FMB_PAIRS_LISTED, 0},
    {"500 bodies, listed", 500, false, FMB_PAIRS_LISTED, 0},
    {"500 bodies, listed, boxes", 500, false, FMB_PAIRS_LISTED, FMB_WANT_BOX},
    {"400 moving, listed, times", 400, true, FMB_PAIRS_LISTED, FMB_WANT_TIMES},
    {"500 bodies, all pairs", 500, false, FMB_PAIRS_ALL, 0},
};

/* Queries a second, with so many under way. NAN: something was lost. */
static double run_block(struct line *line, struct datagram *datagram, int queries, int window)
{
    bool good = true;
    const int64_t begin = clock_ns(), first = line->sequence + 1;
    guard_begin(block_seconds);
    for (int sent = 0; sent < window && sent < queries && good; sent++)
        good = line_send(line, datagram);
    for (int got = 0; got < queries && good; got++) {
        good = line_await(line, first + got);
        if (got + window < queries && good)
            good = line_send(line, datagram);
    }
    guard_end();
    return good ? queries / ((double) (clock_ns() - begin) / 1e9) : NAN;
}

/* ---- The engine by itself ---- */

struct engine {
    const struct workload_scene *scene;
    const struct load *load;
    size_t pairs;
    unsigned char *verdicts;
    double (*times)[2];
    double (*boxes)[2][FMB_DIM_MAX];
};

static struct engine engine_of(const struct workload_scene *scene, const struct load *load,
                               size_t pairs)
{
    return (struct engine){scene,
                           load,
                           pairs,
                           scene_allocate(pairs, 1),
                           scene_allocate(pairs, 2 * sizeof(double)),
                           scene_allocate(pairs, 2 * FMB_DIM_MAX * sizeof(double))};
}

static void engine_free(struct engine *engine)
{
    free(engine->verdicts);
    free(engine->times);
    free(engine->boxes);
}

/* Pairs a second of this thread's own time. */
static double engine_rate(const struct engine *engine)
{
    const struct fmb_batch batch = {
        .frames = engine->scene->scene.prepared,
        .frame_count = engine->scene->scene.count,
        .pairs = (const unsigned(*)[2]) engine->scene->pairs.at,
        .pair_count = engine->pairs,
        .duration = 1,
        .verdicts = engine->verdicts,
        .contacts = engine->load->want & FMB_WANT_TIMES ? engine->times : NULL,
        .boxes = engine->load->want & FMB_WANT_BOX ? engine->boxes : NULL,
    };
    const double begin = stopwatch_now();
    fmb_decide_batch(&batch);
    return (double) engine->pairs / ((stopwatch_now() - begin) / 1e9);
}

/* The last result holds the verdicts of the engine. */
static void compare(const struct bus_bench *bench, const struct engine *engine)
{
    static struct scene_result result;
    if (wire_read_scene_result(bench->service.bytes, (uint32_t) bench->service.size, &result) ||
        result.verdict_count != (int32_t) engine->pairs ||
        memcmp(result.verdict, engine->verdicts, engine->pairs) != 0)
        bus_bench_fail("the verdicts on the bus are not those of the batch");
}

/* ---- Blocks ---- */

struct flow {
    size_t pairs;
    int window, queries, lost;
    double contacts;             /* share of the pairs; NAN: not known */
    struct spread service, echo; /* queries a second */
    struct spread engine;        /* pairs a second; all 0: not measured */
    struct spread compute;       /* microseconds of the last query of each block */
};

static void measure(struct bus_bench *bench, struct datagram *query, const struct engine *engine,
                    struct flow *flow)
{
    static struct datagram request;
    double service[BLOCKS_MAX], echo[BLOCKS_MAX], batch[BLOCKS_MAX], compute[BLOCKS_MAX];
    int count = 0;
    const int blocks = bench->blocks / 6 + 1;
    datagram_of_echo(query->size, bench->service.size, &request);
    for (int block = 0; block < blocks; block++) {
        service[count] = run_block(&bench->service, query, flow->queries, flow->window);
        compute[count] = (double) bench->service.compute_ns / 1e3;
        echo[count] = run_block(&bench->echo, &request, flow->queries, flow->window);
        batch[count] = engine ? engine_rate(engine) : 0;
        const bool good = !isnan(service[count]) && !isnan(echo[count]);
        count += good;
        flow->lost += !good;
    }
    bench->lost += flow->lost;
    if (count == 0)
        bus_bench_fail("every block of a flow lost something");
    if (engine)
        compare(bench, engine);
    flow->service = spread_of(service, count);
    flow->echo = spread_of(echo, count);
    flow->engine = spread_of(batch, engine ? count : 0);
    flow->compute = spread_of(compute, count);
}

static struct spread times(struct spread spread, double factor)
{
    return (struct spread){factor * spread.median, factor * spread.low, factor * spread.high};
}

static void put(struct bus_bench *bench, const struct load *load, const struct flow *flow,
                size_t query_bytes)
{
    struct json_writer *json = &bench->json;
    const double pairs = (double) flow->pairs;
    const double bytes = (double) (query_bytes + bench->service.size);
    json_begin(json, NULL, '{');
    json_string(json, "name", load->name);
    json_number(json, "bodies", load->bodies);
    json_number(json, "pairs", pairs);
    json_number(json, "contacts", flow->contacts);
    json_number(json, "window", flow->window);
    json_number(json, "query_bytes", (double) query_bytes);
    json_number(json, "result_bytes", (double) bench->service.size);
    bus_bench_put(json, "pairs_per_second", times(flow->service, pairs));
    bus_bench_put(json, "bytes_per_second", times(flow->service, bytes));
    bus_bench_put(json, "echo_bytes_per_second", times(flow->echo, bytes));
    if (flow->engine.median > 0)
        bus_bench_put(json, "engine_pairs_per_second", flow->engine);
    bus_bench_put(json, "compute_us", flow->compute);
    json_number(json, "lost", flow->lost);
    json_end(json, '}');
    printf("%-28s %6d %7zu %7zu %7zu %8.2f (%.2f-%.2f)", load->name, flow->window, flow->pairs,
           query_bytes, bench->service.size, flow->service.median * pairs / 1e6,
           flow->service.low * pairs / 1e6, flow->service.high * pairs / 1e6);
    printf(" %9.0f %9.0f", flow->service.median * bytes / 1e6, flow->echo.median * bytes / 1e6);
    if (flow->engine.median > 0)
        printf(" %10.2f", flow->engine.median / 1e6);
    putchar('\n');
    fflush(stdout);
}

static double share_of_contacts(const struct engine *engine)
{
    size_t contacts = 0;
    for (size_t i = 0; i < engine->pairs; i++)
        contacts += engine->verdicts[i] != FMB_SEPARATED;
    return (double) contacts / (double) engine->pairs;
}

static void run_load(struct bus_bench *bench, const struct load *load)
{
    static struct datagram query;
    static const int windows[] = {1, 2, 4};
    struct workload_scene scene =
        workload_scene_draw(load->bodies, load->moving, PAIRS_DRAWN, bench->seed);
    const size_t pairs =
        workload_scene(bench, &scene, FORM_BY_HANDLE, load->which, load->want, &query);
    const bool listed = load->which == FMB_PAIRS_LISTED;
    struct engine engine = engine_of(&scene, load, listed ? pairs : 1);
    engine_rate(&engine);
    for (size_t i = 0; i < sizeof windows / sizeof *windows; i++) {
        struct flow flow = {.pairs = pairs,
                            .window = windows[i],
                            .queries = bench->scene_trips,
                            .contacts = listed ? share_of_contacts(&engine) : NAN};
        measure(bench, &query, listed ? &engine : NULL, &flow);
        put(bench, load, &flow, query.size);
    }
    engine_free(&engine);
    workload_scene_free(&scene);
}

void flow_run(struct bus_bench *bench)
{
    printf("%-28s %6s %7s %7s %7s %-22s %9s %9s %10s\n", "", "window", "pairs", "query", "result",
           "  million pairs/s", "MB/s", "echo MB/s", "engine");
    for (size_t i = 0; i < sizeof loads / sizeof *loads; i++)
        run_load(bench, &loads[i]);
}
