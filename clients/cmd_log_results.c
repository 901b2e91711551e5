/* fmb log results: prints the results of a log. */
#include "commands.h"

#include "args.h"
#include "complain.h"
#include "input.h"
#include "progress.h"
#include "results.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

static const char usage[] =
    "usage: fmb log results [OPTIONS] LOG...\n"
    "\n"
    "Prints the results of LCM event logs: the pairs that touch, overlap or are near,\n"
    "with the ids and names of their bodies. Several logs are read as one, in the\n"
    "order given. Nothing is decided again.\n"
    "\n"
    "  --csv                a line for each pair, exact, below a line of column names\n"
    "  --json               a line for each result, as 'fmb watch --json', with the\n"
    "                       number of the scene\n"
    "  --all                print separated pairs too\n"
    "  -p, --prefix P       the service's channels begin with P\n"
    "  -h, --help\n"
    "\n"
    "The columns of CSV are the same for every log, and empty without a value: utime\n"
    "(of the query, microseconds since 1970), scene (the number of its event, as 'fmb\n"
    "log scene --event' takes it), label, a, b, name_a, name_b, verdict,\n"
    "contact_first, contact_last (seconds), gap_low, gap_high (bounds of the\n"
    "distance), min_x to max_z (box of the intersection), error (why there is no\n"
    "verdict). Any log takes the same memory, some 25 MB.\n"
    "\n"
    "Exit codes: 0 all results are printed; 1 the output failed; 2 wrong usage, a log\n"
    "that cannot be read, is damaged or was recorded by an old version, a message\n"
    "that cannot be read, no results, or results whose query is not in the logs.\n";

/* Most messages that are reported; the others are counted. */
enum { COMPLAINTS_MAX = 20 };

struct printing {
    const struct args *args;
    struct results *results;
    struct log_channels channels;
    struct input input;
    struct progress progress;
    int64_t unreadable; /* messages */
    /* Results of scenes whose query is missing, and the place of the first one. */
    int64_t without_query, first_offset;
    int first_log;
};

/* Reports what is wrong at a place. Returns ARGS_USAGE. */
static int complain_at(struct printing *printing, int log, int64_t offset, const char *what)
{
    progress_end(&printing->progress);
    fflush(stdout);
    complain("%s: offset %" PRId64 ": %s", printing->args->operands[log], offset, what);
    return ARGS_USAGE;
}

/* Returns ARGS_RUN; or the exit code if the next events are not to be read. */
static int take_event(struct printing *printing, const struct log_event *event)
{
    const enum log_kind kind = log_kind_of(&printing->channels, event);
    const int log = printing->input.log;
    char what[96];
    if (kind == LOG_OTHER)
        return ARGS_RUN;
    const int version = log_kind_old_version(kind, event);
    if (version) {
        snprintf(what, sizeof what, "recorded by version %d, whose messages are others", version);
        return complain_at(printing, log, event->offset, what);
    }
    const char *error =
        results_take(printing->results, kind, event->number, event->data, (uint32_t) event->kept);
    if (error == results_no_query && printing->without_query++ == 0) {
        printing->first_log = log;
        printing->first_offset = event->offset;
    } else if (error && error != results_no_query && printing->unreadable++ < COMPLAINTS_MAX) {
        snprintf(what, sizeof what, "event %" PRId64 ": %s", event->number, error);
        complain_at(printing, log, event->offset, what);
    }
    return ARGS_RUN;
}

/* Damage ends the run, with the rows before it. */
static int take_all(struct printing *printing)
{
    struct log_event event;
    struct log_damage damage;
    enum log_outcome outcome;
    int code = ARGS_RUN;
    printing->progress = progress_begin("bytes", input_size(&printing->input));
    while (code == ARGS_RUN && !ferror(stdout) &&
           (outcome = input_next(&printing->input, &event, &damage)) != LOG_END) {
        if (outcome == LOG_EVENT)
            code = take_event(printing, &event);
        else if (outcome == LOG_DAMAGE)
            code = complain_at(printing, printing->input.log, damage.offset, damage.what);
        else
            code =
                complain_at(printing, printing->input.log, printing->input.passed, strerror(errno));
        progress_to(&printing->progress, printing->input.passed, printing->progress.total);
    }
    progress_end(&printing->progress);
    return code;
}

/* Reports what is missing. Returns the exit code. */
static int report_missing(struct printing *printing)
{
    char what[128];
    if (printing->unreadable > COMPLAINTS_MAX)
        complain("%" PRId64 " more messages could not be read",
                 printing->unreadable - COMPLAINTS_MAX);
    if (printing->without_query > 0) {
        snprintf(what, sizeof what,
                 "the queries of %" PRId64
                 " results, of this one first, did not come before them: give the earlier log, too",
                 printing->without_query);
        return complain_at(printing, printing->first_log, printing->first_offset, what);
    }
    if (results_count(printing->results) == 0)
        complain("%s: no results of this service (--prefix chooses it)",
                 printing->args->operands[0]);
    else if (printing->unreadable == 0)
        return ARGS_ANSWERED;
    return ARGS_USAGE;
}

static int run_results(const struct args *args, const struct results_options *options)
{
    struct printing printing = {.args = args, .channels = log_channels(args->bus.prefix)};
    int code = ARGS_USAGE;
    if (input_open(&printing.input, args->operands, args->operand_count)) {
        printing.results = results_open(options);
        code = take_all(&printing);
        if (code == ARGS_RUN)
            code = report_missing(&printing);
        results_close(printing.results);
    }
    input_close(&printing.input);
    return output_flush() ? code : ARGS_FAILED;
}

int cmd_log_results(int argc, char **argv)
{
    bool csv = false, json = false, all = false;
    const struct args_option own[] = {
        {"csv", ARGS_FLAG, .out = &csv},
        {"json", ARGS_FLAG, .out = &json},
        {"all", ARGS_FLAG, .out = &all},
        {.name = NULL},
    };
    struct args args = {"log results",       usage, own, .operand = "LOG", .operands_min = 1,
                        .operands_max = 4096};
    const int code = args_parse(&args, argc, argv);
    if (code != ARGS_RUN)
        return code;
    if (!args_exclude(&args, csv, json, "--csv and --json"))
        return ARGS_USAGE;
    const struct results_options options = {.out = stdout,
                                            .form = csv    ? REPORT_CSV
                                                    : json ? REPORT_JSON
                                                           : REPORT_TABLE,
                                            .pairs = all ? RESULTS_ALL : RESULTS_CONTACTS};
    return run_results(&args, &options);
}
