/* The highest rate at which nothing is lost: of messages that are not answered, that the echo
 * answers, and that fmbd decides and answers. The sender, on the other core, waits actively for the
 * moment of each, and listens to nothing meanwhile. */
#include <stdio.h>

#include "clock.h"
#include "workload.h"

enum { TRIES = 3 };

enum receiver { SILENT, ECHO, SERVICE, RECEIVERS };
static const char *const receiver_names[RECEIVERS] = {"echo that is silent", "echo", "fmbd"};

/* Messages of one kind to one receiver. */
struct shots {
    struct line *line;
    struct datagram *datagram;
    int64_t pairs; /* that each of them is counted as, see line_count() */
};

/* Sends at a rate for some time. Returns the count, and in *reached the rate. */
static int64_t send_paced(const struct shots *shots, double rate, double seconds, double *reached)
{
    const int64_t begin = clock_ns(), count = (int64_t) (rate * seconds);
    for (int64_t i = 0; i < count; i++) {
        while (clock_ns() < begin + (int64_t) ((double) i * 1e9 / rate))
            ;
        line_send(shots->line, shots->datagram);
    }
    *reached = (double) count / ((double) (clock_ns() - begin) / 1e9);
    return count;
}

struct rating {
    double rate; /* requested, the highest without loss; 0: none */
    double reached;
    double lossy; /* the next one, which lost; 0: not tried */
    int64_t lost; /* messages at that one, of so many: */
    int64_t sent;
};

/* How many were lost. -1: the receiver does not answer. */
static int64_t lost_in_try(const struct shots *shots, double rate, double seconds, double *reached,
                           int64_t *sent)
{
    struct line *line = shots->line;
    const int64_t before = line_count(line);
    if (!line_reopen(line, false))
        bus_bench_fail("no bus to send on");
    *sent = send_paced(shots, rate, seconds, reached);
    if (!line_reopen(line, true))
        bus_bench_fail("no bus");
    const int64_t after = line_count(line);
    return before < 0 || after < 0 ? -1 : *sent - (after - before) / shots->pairs;
}

/* True: none of the tries lost anything. */
static bool try_rate(const struct shots *shots, double rate, double seconds, struct rating *out)
{
    int64_t lost = 0, sent = 0, more;
    double reached = 0;
    for (int i = 0; i < TRIES && lost == 0; i++) {
        lost = lost_in_try(shots, rate, seconds, &reached, &more);
        sent += more;
    }
    if (lost != 0) {
        out->lossy = rate;
        out->lost = lost;
        out->sent = sent;
        return false;
    }
    out->rate = rate;
    out->reached = reached;
    return true;
}

/* From slow to fast, until something is lost, or the sender is no faster. */
static struct rating rate_of(const struct bus_bench *bench, const struct shots *shots,
                             double slowest)
{
    struct rating out = {0, 0, 0, 0, 0};
    const double step = bench->quick ? 4 : 1.3;
    const int steps = bench->quick ? 2 : 16;
    double rate = slowest;
    for (int i = 0; i < steps && try_rate(shots, rate, bench->seconds, &out); i++, rate *= step)
        if (out.reached < 0.9 * rate)
            break;
    return out;
}

static void put(struct bus_bench *bench, const char *what, enum receiver receiver, size_t bytes,
                const struct rating *rating)
{
    struct json_writer *json = &bench->json;
    const double most = rating->reached < rating->rate ? rating->reached : rating->rate;
    json_begin(json, NULL, '{');
    json_string(json, "what", what);
    json_string(json, "receiver", receiver_names[receiver]);
    json_number(json, "bytes", (double) bytes);
    json_number(json, "rate", most);
    json_number(json, "bytes_per_second", most * (double) bytes);
    json_number(json, "rate_that_lost", rating->lossy);
    json_number(json, "lost", (double) rating->lost);
    json_number(json, "sent", (double) rating->sent);
    json_end(json, '}');
    printf("%-24s %-20s %6zu %9.0f /s %8.1f MB/s", what, receiver_names[receiver], bytes, most,
           most * (double) bytes / 1e6);
    if (rating->lossy > 0)
        printf("   %.0f /s lost %lld of %lld", rating->lossy, (long long) rating->lost,
               (long long) rating->sent);
    else
        printf("   the sender is no faster");
    putchar('\n');
    fflush(stdout);
}

/* A query of so many pairs, and requests and replies of the same sizes. */
static void rate_all(struct bus_bench *bench, const char *what, struct datagram *query,
                     size_t pairs, double slowest)
{
    static struct datagram request;
    const size_t result = bench->service.size;
    for (int receiver = 0; receiver < RECEIVERS; receiver++) {
        datagram_of_echo(query->size, receiver == ECHO ? result : 0, &request);
        const struct shots shots = receiver == SERVICE
                                       ? (struct shots){&bench->service, query, (int64_t) pairs}
                                       : (struct shots){&bench->echo, &request, 1};
        const struct rating rating =
            rate_of(bench, &shots, receiver == SERVICE ? slowest / 4 : slowest);
        put(bench, what, (enum receiver) receiver, query->size, &rating);
    }
}

void oneway_run(struct bus_bench *bench)
{
    static struct datagram query;
    struct workload_scene scene = workload_scene_draw(500, false, 15000, bench->seed);
    workload_pair(bench, FORM_HELD, &query);
    rate_all(bench, "pair, whole", &query, 1, 10000);
    const size_t pairs = workload_scene(bench, &scene, FORM_BY_HANDLE, FMB_PAIRS_LISTED, 0, &query);
    rate_all(bench, "scene of 500, by handle", &query, pairs, 1000);
    workload_scene_free(&scene);
}
