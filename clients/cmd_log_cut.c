/* fmb log cut: copies a part of a log into a new log. */
#include "commands.h"

#include "args.h"
#include "complain.h"
#include "json_write.h"
#include "log_cut.h"
#include "number.h"
#include "progress.h"

#include <inttypes.h>
#include <stdio.h>

static const char usage[] =
    "usage: fmb log cut [OPTIONS] LOG... -o FILE\n"
    "\n"
    "Copies chosen events of one or more LCM event logs into a new log. 'fmb replay'\n"
    "of the new log reports the same for each of its queries. Several logs are read\n"
    "as one, in the order given, as rotation wrote them. Damage is reported with its\n"
    "offset and left out: without further options this repairs a log.\n"
    "\n"
    "  -o, --output FILE    the new log\n"
    "  --force              FILE may exist already\n"
    "  --from S, --to S     events logged from S on and before S, in seconds since\n"
    "                       the first event, as in 'fmb replay'\n"
    "  --channel REGEX      events on channels whose whole name matches the POSIX\n"
    "                       extended regular expression\n"
    "  --json               one line of JSON in place of the text\n"
    "  -p, --prefix P       the service's channels begin with P\n"
    "  -h, --help\n"
    "\n"
    "An event is copied if it meets all conditions given. A result is copied with its\n"
    "query, if its channel is chosen. Events are copied unchanged, with their log\n"
    "times, and renumbered. A query that names a body by handle is preceded by its\n"
    "definition, from anywhere in the logs, unless a copied event defines it earlier.\n"
    "Handles that the logs do not define are counted. A part of a log begins with the\n"
    "names of all its bodies.\n"
    "\n"
    "Exit codes: 0 everything chosen was copied; 1 damage was left out, or nothing\n"
    "was chosen; 2 wrong usage, or a file cannot be read or written. FILE is not\n"
    "written with 2, or if nothing was chosen.\n";

struct log_cut_arguments {
    struct log_cut_options cut;
    bool json;
};

/* ---- Reports ---- */

/* Most damaged places that are printed; the others are counted. */
enum { COMPLAINTS_MAX = 20 };

struct cut_run {
    const struct log_cut_arguments *options;
    int64_t complaints;
};

static void on_damage(void *user, int log, const struct log_damage *damage)
{
    struct cut_run *run = user;
    if (run->complaints++ < COMPLAINTS_MAX)
        complain("%s: offset %" PRId64 ": %" PRId64 " bytes: %s; left out",
                 run->options->cut.log[log], damage->offset, damage->length, damage->what);
}

static const struct {
    const char *json, *one, *more;
} kinds[LOG_KINDS] = {
    [LOG_PAIR_QUERY] = {"pair_queries", "query of a pair", "queries of pairs"},
    [LOG_PAIR_RESULT] = {"pair_results", "result of a pair", "results of pairs"},
    [LOG_SCENE_QUERY] = {"scene_queries", "query of a scene", "queries of scenes"},
    [LOG_SCENE_RESULT] = {"scene_results", "result of a scene", "results of scenes"},
    [LOG_STATUS] = {"statuses", "heartbeat", "heartbeats"},
    [LOG_DEFINITION_QUERY] = {"definition_queries", "query of definitions",
                              "queries of definitions"},
    [LOG_DEFINITION] = {"definitions", "definition", "definitions"},
    [LOG_NAMES] = {"names", "list of names", "lists of names"},
    [LOG_OTHER] = {"other_events", "on other channels", "on other channels"},
};

static void print_count(const char *name, int64_t count, const char *one, const char *more)
{
    char text[NUMBER_TEXT_MAX];
    if (count > 0)
        printf("%-13s %12s %s\n", name, number_grouped(count, text), count == 1 ? one : more);
}

static void print_text(const struct log_cut_counts *counts)
{
    char kept[NUMBER_TEXT_MAX], events[NUMBER_TEXT_MAX];
    printf("kept %s of %s events; %.1f MB, of %.1f\n", number_grouped(counts->kept_events, kept),
           number_grouped(counts->events, events), 1e-6 * (double) counts->kept_bytes,
           1e-6 * (double) counts->bytes);
    for (int kind = 0; kind < LOG_KINDS; kind++)
        print_count("", counts->kept[kind], kinds[kind].one, kinds[kind].more);
    print_count("defined", counts->defined, "body in front of them", "bodies in front of them");
    print_count("named", counts->names, "body in front of them", "bodies in front of them");
    print_count("unknown", counts->unknown, "handle that the logs do not define",
                "handles that the logs do not define");
    print_count("left out", counts->damaged_bytes, "damaged byte", "damaged bytes");
}

static void print_json(const struct log_cut_counts *counts, int code)
{
    struct json_writer json = json_object(stdout);
    json_integer(&json, "exit", code);
    json_integer(&json, "events", counts->events);
    json_integer(&json, "bytes", counts->bytes);
    json_integer(&json, "kept_events", counts->kept_events);
    json_integer(&json, "kept_bytes", counts->kept_bytes);
    for (int kind = 0; kind < LOG_KINDS; kind++)
        json_integer(&json, kinds[kind].json, counts->kept[kind]);
    json_integer(&json, "added_definitions", counts->definitions);
    json_integer(&json, "added_bodies", counts->defined);
    json_integer(&json, "added_names", counts->names);
    json_integer(&json, "unknown_handles", counts->unknown);
    json_integer(&json, "damages", counts->damages);
    json_integer(&json, "damaged_bytes", counts->damaged_bytes);
    json_object_end(&json);
}

static int code_of(const struct cut_run *run, const struct log_cut_counts *counts)
{
    if (run->complaints > COMPLAINTS_MAX)
        complain("and %" PRId64 " more damaged places", run->complaints - COMPLAINTS_MAX);
    if (counts->kept_events == 0)
        complain("nothing was chosen: %s is not written", run->options->cut.output.path);
    return counts->damages > 0 || counts->kept_events == 0 ? ARGS_FAILED : ARGS_ANSWERED;
}

/* ---- The command ---- */

static int run_cut(const struct log_cut_arguments *options)
{
    struct cut_run run = {.options = options};
    const struct log_cut_sink sink = {on_damage, &run};
    struct log_cut_counts counts;
    progress_begin("bytes");
    const bool good = log_cut(&options->cut, &sink, &counts);
    progress_end();
    const int code = good ? code_of(&run, &counts) : ARGS_USAGE;
    if (good && options->json)
        print_json(&counts, code);
    else if (good)
        print_text(&counts);
    return output_flush() ? code : ARGS_USAGE;
}

int cmd_log_cut(int argc, char **argv)
{
    struct output_rules rules = {.force = false};
    struct log_cut_arguments options = {
        .cut = {.choice = log_choice_all(), .output = {.kind = OUTPUT_LOG, .rules = &rules}}};
    struct log_choice *choice = &options.cut.choice;
    const struct args_option own[] = {
        {"output", ARGS_TEXT, &options.cut.output.path, .letter = 'o'},
        {"force", ARGS_FLAG, .out = &rules.force},
        {"from", ARGS_NUMBER, &choice->from, .high = 1e12},
        {"to", ARGS_NUMBER, &choice->to, .high = 1e12},
        {"channel", ARGS_OTHER, choice, .take = log_choice_take_channel},
        {"json", ARGS_FLAG, .out = &options.json},
        {.name = NULL},
    };
    struct args args = {"log cut",           usage, own, .operand = "LOG", .operands_min = 1,
                        .operands_max = 4096};
    int code = args_parse(&args, argc, argv);
    if (code == ARGS_RUN && ((!options.cut.output.path && !args_error(&args, "expected -o FILE")) ||
                             !args_check_span(&args, choice->from, choice->to)))
        code = ARGS_USAGE;
    if (code == ARGS_RUN) {
        options.cut.log = rules.input = args.operands;
        options.cut.log_count = rules.input_count = args.operand_count;
        options.cut.prefix = args.bus.prefix;
        code = run_cut(&options);
    }
    log_choice_clear(&options.cut.choice);
    return code;
}
