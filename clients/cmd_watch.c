/* fmb watch: prints the results on the bus. */
#include "commands.h"

#include "args.h"
#include "complain.h"
#include "listen.h"
#include "result_rows.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static const char usage[] =
    "usage: fmb watch [OPTIONS]\n"
    "\n"
    "Prints the results on the bus, of all clients, until SIGINT or SIGTERM. Bodies\n"
    "have the last name that their client sent since then, or else their id (0:\n"
    "anonymous). The result of a pair is one line. The result of a scene holds the\n"
    "answers of one datagram, up to the pair that its line names; below it are the\n"
    "pairs that touch, overlap or are near, or all that the query listed.\n"
    "\n"
    "  --json               one line of JSON for each result, exact, with its\n"
    "                       certificate where it has one\n"
    "  --count N            end after N results\n" ARGS_COMMON_USAGE
    "\n"
    "A scene whose query was sent before the watch began has its counts only.\n"
    "\n"
    "Exit codes: 0 ended by a signal or --count, 1 no bus, or the output failed, 2\n"
    "wrong usage.\n";

struct watch {
    struct result_rows *results;
    struct log_channels channels;
    long count; /* results until the end; 0: no end */
    uint64_t malformed;
    bool enough;
};

static void on_message(void *user, const struct bus_message *message)
{
    struct watch *watch = user;
    const struct log_event event = {.channel = message->channel,
                                    .channel_length = strlen(message->channel)};
    const enum log_kind kind = log_kind_of(&watch->channels, &event);
    if (watch->enough)
        return;
    const char *error = result_rows_take(watch->results, kind, REPORT_NONE, message->bytes,
                                         (uint32_t) message->size);
    watch->malformed += error && error != result_rows_no_query;
    if (log_kind_is_result(kind) && fflush(stdout) != 0)
        watch->enough = true;
    if (watch->count > 0 && result_rows_count(watch->results) == watch->count)
        watch->enough = true;
}

int cmd_watch(int argc, char **argv)
{
    struct watch watch = {.count = 0};
    bool json = false;
    const struct args_option own[] = {
        {"json", ARGS_FLAG, .out = &json},
        {"count", ARGS_INTEGER, &watch.count, .low = 1, .high = INT32_MAX},
        {.name = NULL},
    };
    struct args args = {"watch", usage, own, .operand = NULL};
    int code = args_parse(&args, argc, argv);
    if (code != ARGS_RUN)
        return code;
    watch.results = result_rows_open(stdout, json ? REPORT_JSON : REPORT_TABLE, RESULT_ROWS_NAMED);
    watch.channels = log_channels(args.bus.prefix);
    const enum listen_end end =
        listen_until(&args.bus, NULL, on_message, &watch, &watch.enough, -1);
    result_rows_close(watch.results);
    if (watch.malformed > 0)
        complain("%" PRIu64 " messages could not be read", watch.malformed);
    if (ferror(stdout))
        perror("fmb: standard output");
    return end == LISTEN_FAILED || ferror(stdout) ? ARGS_FAILED : ARGS_ANSWERED;
}
