/* fmb log results: prints the results of a log. */
#include "commands.h"

#include "args.h"
#include "complain.h"
#include "input.h"
#include "progress.h"
#include "result_rows.h"

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
    "verdict), point_time to point_z (a point of both bodies at that time). Any log\n"
    "takes the same memory, some 25 MB.\n"
    "\n"
    "Exit codes: 0 all results are printed; 1 the output failed; 2 wrong usage, a log\n"
    "that cannot be read or is damaged, a message that cannot be read, no results,\n"
    "or results whose query is not in the logs.\n";

/* The first of the messages with the same flaw. */
struct flaw {
    int64_t count;
    int log;
    int64_t offset;
    const char *what;
};

struct printing {
    struct result_rows *results;
    struct log_channels channels;
    struct input input;
    struct flaw unreadable, no_query;
};

static void note(struct flaw *flaw, int log, int64_t offset, const char *what)
{
    if (flaw->count++ == 0) {
        flaw->log = log;
        flaw->offset = offset;
        flaw->what = what;
    }
}

/* Damage ends the run, with the rows before it. */
static void take_all(struct printing *printing)
{
    struct log_event event;
    struct log_damage damage;
    enum log_outcome outcome;
    bool more = true;
    progress_begin("bytes");
    while (more && !ferror(stdout) &&
           (outcome = input_next(&printing->input, &event, &damage)) != LOG_END) {
        const char *error = NULL;
        more = outcome == LOG_EVENT;
        if (more)
            error = result_rows_take(printing->results, log_kind_of(&printing->channels, &event),
                                     event.number, event.data, (uint32_t) event.kept);
        if (error)
            note(error == result_rows_no_query ? &printing->no_query : &printing->unreadable,
                 printing->input.log, event.offset, error);
        else if (!more)
            note(&printing->unreadable, printing->input.log,
                 outcome == LOG_DAMAGE ? damage.offset : printing->input.passed,
                 outcome == LOG_DAMAGE ? damage.what : strerror(errno));
        progress_to(printing->input.passed, input_size(&printing->input));
    }
    progress_end();
}

/* Returns whether there are none. */
static bool report_flaws(const struct args *args, const struct flaw *flaw, const char *remedy)
{
    char count[64] = "";
    if (flaw->count > 1)
        snprintf(count, sizeof count, ", the first of %" PRId64, flaw->count);
    if (flaw->count > 0)
        complain("%s: offset %" PRId64 ": %s%s%s", args->operands[flaw->log], flaw->offset,
                 flaw->what, count, remedy);
    return flaw->count == 0;
}

static int run_results(const struct args *args, enum report_form form, enum result_rows_pairs pairs)
{
    struct printing printing = {.channels = log_channels(args->bus.prefix)};
    int code = ARGS_USAGE;
    if (input_open(&printing.input, args->operands, args->operand_count)) {
        printing.results = result_rows_open(stdout, form, pairs);
        take_all(&printing);
        fflush(stdout);
        bool good = report_flaws(args, &printing.unreadable, "");
        if (good && result_rows_count(printing.results) == 0)
            complain("%s: no results of this service (--prefix chooses it)", args->operands[0]);
        good = report_flaws(args, &printing.no_query, ": give the log before it, too") && good;
        code = good && result_rows_count(printing.results) > 0 ? ARGS_ANSWERED : ARGS_USAGE;
        result_rows_close(printing.results);
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
    return run_results(&args,
                       csv    ? REPORT_CSV
                       : json ? REPORT_JSON
                              : REPORT_TABLE,
                       all ? RESULT_ROWS_ALL : RESULT_ROWS_CONTACTS);
}
