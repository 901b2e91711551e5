/* fmb watch: the results that pass on the bus. */
#include "commands.h"

#include "args.h"
#include "listen.h"
#include "report.h"
#include "wire.h"

#include <getopt.h>
#include <inttypes.h>
#include <stdio.h>

static const char usage[] =
    "usage: fmb watch [OPTIONS]\n"
    "\n"
    "Prints the results that pass on the bus, whoever asked, one line each, until SIGINT or\n"
    "SIGTERM. Body 0 is one without an id.\n"
    "\n"
    "  --json               one line of JSON for each result, exact\n"
    "  --count N            end after N results\n"
    "  -l, --lcm-url URL    the bus; else LCM_DEFAULT_URL, else this host\n"
    "  -p, --prefix P       the service's channels begin with P\n"
    "  -h, --help\n";

struct options {
    bool json, help;
    long count; /* 0: no end */
    struct args_bus bus;
};

struct watch {
    const struct options *options;
    long seen;
    uint64_t malformed;
    bool enough;
};

enum { JSON = 1, COUNT };

static const struct option long_options[] = {
    {"json", no_argument, NULL, JSON},         {"count", required_argument, NULL, COUNT},
    {"lcm-url", required_argument, NULL, 'l'}, {"prefix", required_argument, NULL, 'p'},
    {"help", no_argument, NULL, 'h'},          {NULL, 0, NULL, 0},
};

static bool parse_option(int option, char **argv, struct options *out)
{
    switch (option) {
    case JSON: out->json = true; return true;
    case COUNT: return args_integer("watch", "--count", optarg, 1, INT32_MAX, &out->count);
    case 'l': out->bus.url = optarg; return true;
    case 'p': return args_prefix("watch", optarg, &out->bus);
    case 'h': out->help = true; return true;
    }
    return args_refuse("watch", option, argv);
}

static bool parse_options(int argc, char **argv, struct options *out)
{
    int option;
    *out = (struct options){.bus = {.prefix = ""}};
    args_restart();
    while ((option = getopt_long(argc, argv, ":l:p:h", long_options, NULL)) != -1)
        if (!parse_option(option, argv, out))
            return false;
    return optind == argc || args_error("watch", "unknown argument '%s'", argv[optind]);
}

static const char *error_of(const struct pair_result *result)
{
    if (result->status == FMB_OK)
        return NULL;
    return result->detail[0] ? result->detail : fmb_status_text(result->status);
}

static void print_json(const struct pair_result *result)
{
    printf("{\"utime\": %" PRId64 ", \"client_id\": %" PRId64 ", \"sequence_number\": %" PRId64
           ", \"server_id\": %" PRId64 ", \"compute_ns\": %" PRId64 ", \"a\": %" PRId64
           ", \"b\": %" PRId64 ", ",
           result->utime, result->client_id, result->sequence_number, result->server_id,
           result->compute_ns, result->body_id[0], result->body_id[1]);
    report_answer_json(stdout, result->dim, error_of(result), &result->answer);
    puts("}");
}

static void print_text(const struct pair_result *result)
{
    printf("%16" PRId64 " #%-6" PRId64 " %6.1f us  %4" PRId64 " %4" PRId64 "  ", result->client_id,
           result->sequence_number, 1e-3 * (double) result->compute_ns, result->body_id[0],
           result->body_id[1]);
    if (result->status == FMB_OK)
        report_answer_text(stdout, result->dim, &result->answer);
    else
        printf("not decided: %s", error_of(result));
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
        print_text(&result);
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
    struct options options;
    struct listener listener;
    struct watch watch = {.options = &options};
    if (!parse_options(argc, argv, &options))
        return ARGS_USAGE;
    if (options.help) {
        fputs(usage, stdout);
        return ARGS_ANSWERED;
    }
    if (!listen_open(&options.bus, WIRE_PAIR_RESULT, on_result, &watch, &listener))
        return ARGS_FAILED;
    enum listen_end end = listen_until(&listener, &watch.enough, -1);
    listen_close(&listener);
    return end_of_watch(&watch, end);
}
