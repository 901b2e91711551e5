/* fmb status: prints the next heartbeat of the service. */
#include "commands.h"

#include "args.h"
#include "complain.h"
#include "json_write.h"
#include "listen.h"
#include "number.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static const char usage[] =
    "usage: fmb status [OPTIONS]\n"
    "\n"
    "Waits for the next heartbeat of the service, which comes once a second, and\n"
    "prints it.\n"
    "\n"
    "A service that has sent a heartbeat receives queries: scripts that start it wait\n"
    "with this command.\n"
    "\n"
    "  --json               as one line of JSON\n"
    "  --timeout SECONDS    longest time to wait (3)\n" ARGS_COMMON_USAGE
    "\n"
    "'own and foreign' (in JSON 'foreign') counts datagrams on channels that the\n"
    "service does not receive, its own results included, and datagrams that are no\n"
    "message.\n"
    "\n"
    "Exit codes: 0 printed, 1 no heartbeat came, 2 wrong usage.\n";

struct status {
    bool json;
    double timeout;
    bool printed;
    const char *malformed; /* error of the last heartbeat that could not be read; NULL: none */
};

/* ---- Printing ---- */

/* What the counters of results begin with, before the name of the status. */
#define RESULT "result_"

/* results: the counters of results, by the names of their statuses; else the others. */
static void write_counters(struct json_writer *json, const struct fmb_client_heartbeat *status,
                           bool results)
{
    for (size_t i = 0; i < status->counter_count; i++) {
        const char *name = status->counters[i].name;
        const bool result = strncmp(name, RESULT, strlen(RESULT)) == 0;
        if (result == results)
            json_integer(json, name + (result ? strlen(RESULT) : 0), status->counters[i].value);
    }
}

static void print_json(const struct fmb_client_heartbeat *status)
{
    struct json_writer json = json_object(stdout);
    json_integer(&json, "utime", status->utime);
    json_integer(&json, "server_id", status->server_id);
    json_string(&json, "version", status->version);
    write_counters(&json, status, false);
    json_begin(&json, "results", '{');
    write_counters(&json, status, true);
    json_end(&json, '}');
    json_object_end(&json);
}

static void print_duration(int64_t microseconds)
{
    int64_t seconds = microseconds / 1000000;
    if (seconds >= 86400)
        printf("%" PRId64 " d ", seconds / 86400);
    if (seconds >= 3600)
        printf("%" PRId64 " h ", seconds / 3600 % 24);
    if (seconds >= 60)
        printf("%" PRId64 " min ", seconds / 60 % 60);
    printf("%" PRId64 " s", seconds % 60);
}

static void print_refusals(const struct fmb_client_heartbeat *status)
{
    static const char *const counters[] = {
#define X(name, number, text) [number] = RESULT #name,
        FMB_STATUS_MAP(X)
#undef X
    };
    for (int i = FMB_OK + 1; i < FMB_STATUS_COUNT; i++) {
        const int64_t refused = fmb_client_get_counter(status, counters[i]);
        if (refused > 0)
            printf("  %-16s %15" PRId64 "  %s\n", "  refused", refused, fmb_status_text(i));
    }
}

static void print_counter(const char *label, const struct fmb_client_heartbeat *status,
                          const char *name)
{
    number_print(label, fmb_client_get_counter(status, name));
}

static void print_time(const char *label, const struct fmb_client_heartbeat *status,
                       const char *name)
{
    printf("  %-16s %15.1f us\n", label, 1e-3 * (double) fmb_client_get_counter(status, name));
}

static void print_text(const struct fmb_client_heartbeat *status)
{
    printf("fmbd %s, server %" PRId64 ", up ", status->version, status->server_id);
    print_duration(fmb_client_get_counter(status, "uptime_us"));
    puts("\nqueries");
    print_counter("received", status, "received");
    print_counter("  scenes", status, "scenes");
    print_counter("  definitions", status, "definitions");
    print_counter("answered", status, "answered");
    print_counter("pairs decided", status, "pairs");
    print_refusals(status);
    print_counter("not sent", status, "unsent");
    print_counter("  expired", status, "expired");
    print_counter("  refusals", status, "refusals_unsent");
    print_counter("malformed", status, "malformed");
    print_counter("in fragments", status, "fragmented");
    print_counter("waiting", status, "waiting");
    print_counter("  at most", status, "most_waiting");
    puts("bodies");
    print_counter("held", status, "bodies");
    print_counter("frames", status, "frames");
    print_counter("  at most", status, "frame_capacity");
    print_counter("ids", status, "ids");
    print_counter("hits", status, "hits");
    print_counter("misses", status, "misses");
    print_counter("evicted", status, "evictions");
    puts("time to decide");
    print_time("p50", status, "compute_p50_ns");
    print_time("p99", status, "compute_p99_ns");
    print_time("longest", status, "compute_max_ns");
    puts("bus");
    print_counter("receive buffer", status, "receive_buffer");
    print_counter("dropped", status, "dropped");
    print_counter("own and foreign", status, "foreign");
}

/* ---- The command ---- */

static void on_heartbeat(void *user, const struct fmb_client_heartbeat *heartbeat)
{
    struct status *status = user;
    if (!status->printed)
        (status->json ? print_json : print_text)(heartbeat);
    status->printed = true;
}

static void on_malformed(void *user, const char *what)
{
    struct status *status = user;
    status->malformed = what;
}

static void advise(const struct status *status, const struct args_bus *bus)
{
    complain("no heartbeat on channel %sFMB_STATUS of %s within %g s", bus->prefix,
             args_bus_name(bus), status->timeout);
    if (status->malformed)
        complain("but one that could not be read (%s): another version of fmbd?",
                 status->malformed);
    else
        args_advise_service(bus, "");
}

int cmd_status(int argc, char **argv)
{
    struct status status = {.timeout = 3};
    const struct args_option own[] = {
        {"json", ARGS_FLAG, .out = &status.json},
        {"timeout", ARGS_NUMBER, &status.timeout, .low = 0.001, .high = 3600},
        {.name = NULL},
    };
    struct args args = {"status", usage, own, .operand = NULL};
    const struct fmb_client_watcher watcher = {
        .heartbeat = on_heartbeat, .malformed = on_malformed, .user = &status};
    int code = args_parse(&args, argc, argv);
    if (code != ARGS_RUN)
        return code;
    const enum listen_end end =
        listen_until(&args.bus, &watcher, NULL, NULL, &status.printed, status.timeout);
    if (end == LISTEN_TIMEOUT)
        advise(&status, &args.bus);
    return end == LISTEN_ENOUGH && output_flush() ? ARGS_ANSWERED : ARGS_FAILED;
}
