/* fmb watch: the results that pass on the bus. */
#include "commands.h"

#include "args.h"
#include "listen.h"
#include "report.h"
#include "wire.h"

#include <inttypes.h>
#include <stdio.h>

static const char usage[] =
    "usage: fmb watch [OPTIONS]\n"
    "\n"
    "Prints the results that pass on the bus, whoever asked, one line each, until SIGINT or\n"
    "SIGTERM. Body 0 is one without an id.\n"
    "\n"
    "  --json               one line of JSON for each result, exact, with its certificate\n"
    "                       where it has one\n"
    "  --count N            end after N results\n" ARGS_COMMON_USAGE;

struct options {
    bool json;
    long count; /* 0: no end */
};

struct watch {
    const struct options *options;
    struct report_columns columns;
    long seen;
    uint64_t malformed;
    bool enough;
};

enum { JSON = 1, COUNT };

static const struct option own_options[] = {
    {"json", no_argument, NULL, JSON},
    {"count", required_argument, NULL, COUNT},
    {NULL, 0, NULL, 0},
};

static bool take_option(const struct args *args, int option, void *out)
{
    struct options *options = out;
    switch (option) {
    case JSON: options->json = true; break;
    case COUNT: return args_integer(args, 1, INT32_MAX, &options->count);
    }
    return true;
}

static void print_json(const struct pair_result *result)
{
    const struct outcome outcome = {.error = report_refusal(result),
                                    .answer = result->answer,
                                    .certificate = result->certificate};
    printf("{\"utime\": %" PRId64 ", \"client_id\": %" PRId64 ", \"sequence_number\": %" PRId64
           ", \"server_id\": %" PRId64 ", \"compute_ns\": %" PRId64 ", \"a\": %" PRId64
           ", \"b\": %" PRId64 ", ",
           result->utime, result->client_id, result->sequence_number, result->server_id,
           result->compute_ns, result->body_id[0], result->body_id[1]);
    report_answer_json(stdout, result->dim, &outcome);
    puts("}");
}

static void print_text(const struct pair_result *result, struct report_columns *columns)
{
    printf("%16" PRId64 " #%-6" PRId64 " %6.1f us  %4" PRId64 " %4" PRId64 "  ", result->client_id,
           result->sequence_number, 1e-3 * (double) result->compute_ns, result->body_id[0],
           result->body_id[1]);
    if (result->status == FMB_OK)
        report_answer_text(stdout, result->dim, &result->answer, columns);
    else
        printf("not decided: %s", report_refusal(result));
    putchar('\n');
}

static void on_result(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct watch *watch = user;
    struct pair_result result;
    (void) channel;
    if (wire_read_pair_result(buffer->data, buffer->data_size, &result)) {
        watch->malformed++;
        return;
    }
    if (watch->options->json)
        print_json(&result);
    else
        print_text(&result, &watch->columns);
    watch->seen++;
    if (fflush(stdout) != 0 || watch->seen == watch->options->count)
        watch->enough = true;
}

static int end_of_watch(const struct watch *watch, enum listen_end end)
{
    if (watch->malformed > 0)
        fprintf(stderr, "fmb: %" PRIu64 " messages could not be read\n", watch->malformed);
    if (ferror(stdout))
        perror("fmb: standard output");
    return end == LISTEN_FAILED || ferror(stdout) ? ARGS_FAILED : ARGS_ANSWERED;
}

int cmd_watch(int argc, char **argv)
{
    struct args args = {"watch", usage, own_options, take_option, .takes_file = false};
    struct options options = {.count = 0};
    struct watch watch = {.options = &options, .columns = report_columns()};
    struct listener listener;
    int code = args_parse(&args, argc, argv, &options);
    if (code != ARGS_RUN)
        return code;
    if (!listen_open(&args.bus, WIRE_PAIR_RESULT, on_result, &watch, &listener))
        return ARGS_FAILED;
    enum listen_end end = listen_until(&listener, &watch.enough, -1);
    listen_close(&listener);
    return end_of_watch(&watch, end);
}
