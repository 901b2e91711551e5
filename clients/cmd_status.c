/* fmb status: prints the next heartbeat of the service. */
#include "commands.h"

#include "args.h"
#include "complain.h"
#include "json_write.h"
#include "listen.h"
#include "number.h"

#include <inttypes.h>
#include <stdio.h>

static const char usage[] =
    "usage: fmb status [OPTIONS]\n"
    "\n"
    "Waits for the next heartbeat of the service, which comes once a second, and\n"
    "prints it.\n"
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

static void print_json(const struct fmb_client_heartbeat *status)
{
    struct json_writer json = json_object(stdout);
    json_integer(&json, "utime", status->utime);
    json_integer(&json, "server_id", status->server_id);
    json_string(&json, "version", status->version);
#define X(name) json_integer(&json, #name, status->name);
    FMB_COUNTERS(X)
#undef X
    json_begin(&json, "results", '{');
#define X(name, number, text) json_integer(&json, #name, status->results[number]);
    FMB_STATUS_MAP(X)
#undef X
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
    for (int i = 0; i < FMB_STATUS_COUNT; i++)
        if (i != FMB_OK && status->results[i] > 0)
            printf("  %-16s %15" PRId64 "  %s\n", "  refused", status->results[i],
                   fmb_status_text(i));
}

static void print_text(const struct fmb_client_heartbeat *status)
{
    printf("fmbd %s, server %" PRId64 ", up ", status->version, status->server_id);
    print_duration(status->uptime_us);
    puts("\nqueries");
    number_print("received", status->received);
    number_print("  scenes", status->scenes);
    number_print("  definitions", status->definitions);
    number_print("answered", status->answered);
    number_print("pairs decided", status->pairs);
    print_refusals(status);
    number_print("not sent", status->unsent);
    number_print("  expired", status->expired);
    number_print("  refusals", status->refusals_unsent);
    number_print("malformed", status->malformed);
    number_print("in fragments", status->fragmented);
    number_print("waiting", status->waiting);
    number_print("  at most", status->most_waiting);
    puts("bodies");
    number_print("held", status->bodies);
    number_print("frames", status->frames);
    number_print("  at most", status->frame_capacity);
    number_print("ids", status->ids);
    number_print("hits", status->hits);
    number_print("misses", status->misses);
    number_print("evicted", status->evictions);
    puts("time to decide");
    printf("  %-16s %15.1f us\n", "p50", 1e-3 * (double) status->compute_p50_ns);
    printf("  %-16s %15.1f us\n", "p99", 1e-3 * (double) status->compute_p99_ns);
    printf("  %-16s %15.1f us\n", "longest", 1e-3 * (double) status->compute_max_ns);
    puts("bus");
    number_print("receive buffer", status->receive_buffer);
    number_print("dropped", status->dropped);
    number_print("own and foreign", status->foreign);
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
