/* The highest rate at which nothing is lost: of datagrams that nobody answers, that the echo
 * answers, and that fmbd decides and answers. The sender waits for each one's moment on the other
 * core; its bus has no subscription, and so nothing to read. */
#include <stdio.h>

#include "ask.h"
#include "bus.h"
#include "clock.h"
#include "echo.h"
#include "guard.h"
#include "wire.h"

enum { TRIES = 3, PATIENCE_MS = 2000 };

enum receiver { SILENT, ECHO, SERVICE, RECEIVERS };
static const char *const receiver_names[RECEIVERS] = {"echo that is silent", "echo", "fmbd"};

/* Sends at a rate for some time. Returns how many, and in *reached the rate that it was. */
static int64_t send_paced(lcm_t *lcm, struct line *line, struct datagram *datagram, double rate,
                          double seconds, double *reached)
{
    const int64_t begin = clock_ns(), count = (int64_t) (rate * seconds);
    for (int64_t i = 0; i < count; i++) {
        datagram_next(datagram, ++line->sequence);
        while (clock_ns() < begin + (int64_t) ((double) i * 1e9 / rate))
            ;
        lcm_publish(lcm, line->query_channel, datagram->bytes, (unsigned) datagram->size);
    }
    *reached = (double) count / ((double) (clock_ns() - begin) / 1e9);
    return count;
}

/* What the service could not keep in its queues, as its next heartbeat says. */
struct hearing {
    bool heard;
    int64_t busy;
};

static void on_status(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct hearing *hearing = user;
    struct wire_status status;
    (void) channel;
    if (wire_read_status(buffer->data, buffer->data_size, &status))
        return;
    hearing->heard = true;
    hearing->busy = status.results[FMB_BUSY];
}

static int64_t busy_so_far(const char *url)
{
    struct hearing hearing = {false, -1};
    lcm_t *lcm = bus_open("bench-bus", url, NULL);
    guard_begin(3);
    if (lcm && bus_subscribe(lcm, WIRE_STATUS, on_status, &hearing, 4))
        while (!hearing.heard && lcm_handle(lcm) == 0)
            ;
    guard_end();
    if (lcm)
        lcm_destroy(lcm);
    if (!hearing.heard)
        bus_bench_fail("no heartbeat");
    return hearing.busy;
}

/* ---- A rate ---- */

struct rating {
    double rate; /* of those asked for, the highest without loss; 0: none */
    double reached;
    double lossy; /* the next one, which lost; 0: not tried */
    int64_t lost; /* datagrams at that one, of so many: */
    int64_t sent;
};

/* How many were lost: of the service, numbers skipped; of the echo, what it has not seen. -1: not
 * to be known, since it did not answer. */
static int64_t lost_in_try(struct bus_bench *bench, enum receiver receiver,
                           struct datagram *datagram, double rate, double *reached, int64_t *sent)
{
    struct line *line = receiver == SERVICE ? &bench->service : &bench->echo;
    const char *url = receiver == SERVICE ? bench->parties.service_url : bench->parties.echo_url;
    const int64_t before = line_count(line, PATIENCE_MS);
    line_close(line);
    lcm_t *sender = bus_open("bench-bus", url, NULL);
    if (!sender)
        bus_bench_fail("no bus to send on");
    *sent = send_paced(sender, line, datagram, rate, bench->seconds, reached);
    lcm_destroy(sender);
    if (!line_reopen(url, line))
        bus_bench_fail("no bus");
    const int64_t after = line_count(line, PATIENCE_MS);
    if (before < 0 || after < 0)
        return -1;
    return receiver == SERVICE ? after - before : before + *sent + 1 - after;
}

/* True: none of the tries lost anything. */
static bool try_rate(struct bus_bench *bench, enum receiver receiver, struct datagram *datagram,
                     double rate, struct rating *out)
{
    const char *url = bench->parties.service_url;
    const int64_t busy = receiver == SERVICE ? busy_so_far(url) : 0;
    int64_t lost = 0, sent = 0, more;
    double reached = 0;
    for (int i = 0; i < TRIES && lost == 0; i++) {
        lost = lost_in_try(bench, receiver, datagram, rate, &reached, &more);
        sent += more;
    }
    if (receiver == SERVICE && lost == 0)
        lost = busy_so_far(url) - busy;
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
static struct rating rate_of(struct bus_bench *bench, enum receiver receiver,
                             struct datagram *datagram, double slowest)
{
    struct rating out = {0, 0, 0, 0, 0};
    const double step = bench->quick ? 4 : 1.3;
    const int steps = bench->quick ? 2 : 16;
    double rate = slowest;
    for (int i = 0; i < steps && try_rate(bench, receiver, datagram, rate, &out); i++, rate *= step)
        if (out.reached < 0.9 * rate)
            break;
    return out;
}

static void put(struct bus_bench *bench, const char *what, enum receiver receiver, size_t bytes,
                const struct rating *rating)
{
    struct json *json = &bench->json;
    const double most = rating->reached < rating->rate ? rating->reached : rating->rate;
    json_open(json, NULL, '{');
    json_text(json, "what", what);
    json_text(json, "receiver", receiver_names[receiver]);
    json_number(json, "bytes", (double) bytes);
    json_number(json, "rate", most);
    json_number(json, "bytes_per_second", most * (double) bytes);
    json_number(json, "rate_that_lost", rating->lossy);
    json_number(json, "lost", (double) rating->lost);
    json_number(json, "sent", (double) rating->sent);
    json_close(json, '}');
    printf("%-22s %-20s %6zu %9.0f /s %8.1f MB/s", what, receiver_names[receiver], bytes, most,
           most * (double) bytes / 1e6);
    if (rating->lossy > 0)
        printf("   %.0f /s lost %lld of %lld", rating->lossy, (long long) rating->lost,
               (long long) rating->sent);
    else
        printf("   the sender is no faster");
    putchar('\n');
    fflush(stdout);
}

/* The datagram, and what a result of it takes. */
static void rate_all(struct bus_bench *bench, const char *what, struct datagram *query,
                     size_t result, double slowest)
{
    static struct datagram request;
    for (int receiver = 0; receiver < RECEIVERS; receiver++) {
        datagram_of_echo(query->size, receiver == ECHO ? result : 0, &request);
        const struct rating rating =
            rate_of(bench, (enum receiver) receiver, receiver == SERVICE ? query : &request,
                    receiver == SERVICE ? slowest / 4 : slowest);
        put(bench, what, (enum receiver) receiver, query->size, &rating);
    }
}

void oneway_run(struct bus_bench *bench)
{
    static struct datagram query;
    struct ask_scene scene = ask_scene_draw(500, false, 15000, bench->seed);
    ask_pair(bench, FORM_HELD, &query);
    rate_all(bench, "pair, whole", &query, bench->service.size, 10000);
    ask_scene(bench, &scene, FORM_BY_KEY, QUERY_PAIRS_LISTED, 0, &query);
    rate_all(bench, "scene of 500, by key", &query, bench->service.size, 1000);
    ask_scene_free(&scene);
}
