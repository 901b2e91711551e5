#include "duel.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "echo.h"
#include "guard.h"

enum { BLOCKS_MAX = 256, TRIPS_MAX = 2048 };

/* A block takes milliseconds; one that takes so long has lost a message. */
static const double block_seconds = 3;

struct block {
    double p50, p99, max, compute; /* microseconds */
};

static int by_size(const void *one, const void *other)
{
    const double x = *(const double *) one, y = *(const double *) other;
    return (x > y) - (x < y);
}

/* The smallest value that is not exceeded by the share of them. In order already. */
static double quantile(const double *values, int count, double share)
{
    const int at = (int) ceil(share * count) - 1;
    return values[at < 0 ? 0 : at];
}

/* False: something was lost, and the block counts for nothing. */
static bool run_block(struct line *line, struct datagram *datagram, int trips, struct block *out)
{
    static double times[TRIPS_MAX], computes[TRIPS_MAX];
    int count = 0;
    guard_begin(block_seconds);
    for (double ns; count < trips && !isnan(ns = line_round_trip(line, datagram)); count++) {
        times[count] = ns / 1e3;
        computes[count] = (double) line->compute_ns / 1e3;
    }
    guard_end();
    if (count < trips)
        return false;
    qsort(times, (size_t) count, sizeof *times, by_size);
    qsort(computes, (size_t) count, sizeof *computes, by_size);
    *out = (struct block){quantile(times, count, 0.5), quantile(times, count, 0.99),
                          times[count - 1], quantile(computes, count, 0.5)};
    return true;
}

/* Spreads of a field of all blocks. */
#define SPREAD_OF(block, count, field) spread_of_field(&(block)->field, count)
static struct spread spread_of_field(const double *first, int count)
{
    double values[BLOCKS_MAX];
    for (int i = 0; i < count; i++)
        values[i] = first[i * (int) (sizeof(struct block) / sizeof(double))];
    return spread_of(values, count);
}

static struct duel_side side_of(const struct block *block, int count)
{
    return (struct duel_side){SPREAD_OF(block, count, p50), SPREAD_OF(block, count, p99),
                              SPREAD_OF(block, count, max)};
}

static struct duel sum_up(const struct block *service, const struct block *echo, int count)
{
    double p50[BLOCKS_MAX], p99[BLOCKS_MAX];
    for (int i = 0; i < count; i++) {
        p50[i] = service[i].p50 / echo[i].p50;
        p99[i] = service[i].p99 / echo[i].p99;
    }
    return (struct duel){.service = side_of(service, count),
                         .echo = side_of(echo, count),
                         .ratio_p50 = spread_of(p50, count),
                         .ratio_p99 = spread_of(p99, count),
                         .compute = SPREAD_OF(service, count, compute)};
}

static void query_once(struct bus_bench *bench, struct datagram *query)
{
    guard_begin(block_seconds);
    const double ns = line_round_trip(&bench->service, query);
    guard_end();
    if (isnan(ns))
        bus_bench_fail("a query was not answered");
    if (bench->service.status != FMB_OK)
        bus_bench_fail(fmb_status_text(bench->service.status));
}

/* The side that begins changes with each pair of blocks. A pair in which either lost something is
 * left out. */
struct duel duel_run(struct bus_bench *bench, struct datagram *query, int blocks, int trips)
{
    static struct datagram request;
    static struct block service[BLOCKS_MAX], echo[BLOCKS_MAX];
    int count = 0, lost = 0;
    query_once(bench, query);
    const size_t result = bench->service.size;
    datagram_of_echo(query->size, result, &request);
    for (int block = 0; block < blocks; block++) {
        bool good = true;
        for (int turn = 0; turn < 2; turn++)
            good =
                ((block + turn) % 2 ? run_block(&bench->echo, &request, trips, &echo[count])
                                    : run_block(&bench->service, query, trips, &service[count])) &&
                good;
        count += good;
        lost += !good;
    }
    bench->lost += lost;
    if (count == 0)
        bus_bench_fail("every block of a comparison lost something");
    if (bench->service.status != FMB_OK || bench->service.size != result)
        bus_bench_fail("a query got another answer than at first");
    struct duel duel = sum_up(service, echo, count);
    duel.query_bytes = query->size;
    duel.result_bytes = result;
    duel.lost = lost;
    return duel;
}

static void put_side(struct json_writer *json, const char *key, const struct duel_side *side)
{
    json_begin(json, key, '{');
    bus_bench_put(json, "p50_us", side->p50);
    bus_bench_put(json, "p99_us", side->p99);
    bus_bench_put(json, "max_us", side->max);
    json_end(json, '}');
}

void duel_put(struct json_writer *json, const struct duel *duel)
{
    json_number(json, "query_bytes", (double) duel->query_bytes);
    json_number(json, "result_bytes", (double) duel->result_bytes);
    put_side(json, "service", &duel->service);
    put_side(json, "echo", &duel->echo);
    bus_bench_put(json, "ratio_p50", duel->ratio_p50);
    bus_bench_put(json, "ratio_p99", duel->ratio_p99);
    bus_bench_put(json, "compute_us", duel->compute);
    json_number(json, "bus_us", duel->service.p50.median - duel->compute.median);
    json_number(json, "lost", duel->lost);
}

void duel_print_head(void)
{
    printf("%-36s %6s %6s  %-22s %-22s %-17s %-17s %8s %8s\n", "", "query", "result",
           "fmbd p50/p99/max", "echo p50/p99/max", "p50 / echo's", "p99 / echo's", "compute",
           "bus");
}

static void print_side(const struct duel_side *side)
{
    char text[64];
    snprintf(text, sizeof text, "%.1f/%.1f/%.0f", side->p50.median, side->p99.median,
             side->max.median);
    printf("  %-21s", text);
}

static void print_ratio(struct spread ratio)
{
    printf(" %.2f (%.2f-%.2f)", ratio.median, ratio.low, ratio.high);
}

void duel_print(const char *name, const struct duel *duel)
{
    printf("%-36s %6zu %6zu", name, duel->query_bytes, duel->result_bytes);
    print_side(&duel->service);
    print_side(&duel->echo);
    print_ratio(duel->ratio_p50);
    print_ratio(duel->ratio_p99);
    printf(" %8.2f %8.1f\n", duel->compute.median, duel->service.p50.median - duel->compute.median);
    fflush(stdout);
}
