/* fmb log cut: copies a part of a log into a new log. */
#include "commands.h"

#include "args.h"
#include "complain.h"
#include "json_write.h"
#include "log_cut.h"
#include "number.h"
#include "progress.h"

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
    "                       the first event\n"
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

/* Prints the rows that are not 0. */
static void print_count(const char *name, int64_t count)
{
    if (count > 0)
        number_print(name, count);
}

static void print_text(const struct log_cut_counts *counts)
{
    char kept[NUMBER_TEXT_MAX], events[NUMBER_TEXT_MAX];
    printf("kept %s of %s events; %.1f MB, of %.1f\n", number_grouped(counts->kept_events, kept),
           number_grouped(counts->events, events), 1e-6 * (double) counts->kept_bytes,
           1e-6 * (double) counts->bytes);
    for (int kind = 0; kind < LOG_KINDS; kind++)
        print_count(log_kind_name[kind].text, counts->kept[kind]);
    print_count("bodies defined", counts->defined);
    print_count("bodies named", counts->names);
    print_count("unknown handles", counts->unknown);
    print_count("damaged bytes", counts->damaged_bytes);
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
        json_integer(&json, log_kind_name[kind].json, counts->kept[kind]);
    json_integer(&json, "added_bodies", counts->defined);
    json_integer(&json, "added_names", counts->names);
    json_integer(&json, "unknown_handles", counts->unknown);
    json_integer(&json, "damages", counts->damages);
    json_integer(&json, "damaged_bytes", counts->damaged_bytes);
    json_object_end(&json);
}

static int run_cut(const struct log_cut_options *options, bool json)
{
    struct log_cut_counts counts;
    int code = ARGS_USAGE;
    progress_begin("bytes");
    const bool good = log_cut(options, &counts);
    progress_end();
    if (good && counts.kept_events == 0)
        complain("nothing was chosen: %s is not written", options->output.path);
    if (good)
        code = counts.damages > 0 || counts.kept_events == 0 ? ARGS_FAILED : ARGS_ANSWERED;
    if (good && json)
        print_json(&counts, code);
    else if (good)
        print_text(&counts);
    return output_flush() ? code : ARGS_USAGE;
}

int cmd_log_cut(int argc, char **argv)
{
    struct output_rules rules = {.force = false};
    struct log_cut_options options = {.choice = log_choice_all(),
                                      .output = {.kind = OUTPUT_LOG, .rules = &rules}};
    struct log_choice *choice = &options.choice;
    bool json = false;
    const struct args_option own[] = {
        {"output", ARGS_TEXT, &options.output.path, .letter = 'o'},
        {"force", ARGS_FLAG, .out = &rules.force},
        {"from", ARGS_NUMBER, &choice->from, .high = 1e12},
        {"to", ARGS_NUMBER, &choice->to, .high = 1e12},
        {"channel", ARGS_OTHER, choice, .take = log_choice_take_channel},
        {"json", ARGS_FLAG, .out = &json},
        {.name = NULL},
    };
    struct args args = {"log cut",           usage, own, .operand = "LOG", .operands_min = 1,
                        .operands_max = 4096};
    int code = args_parse(&args, argc, argv);
    if (code == ARGS_RUN && ((!options.output.path && !args_error(&args, "expected -o FILE")) ||
                             (choice->from >= choice->to &&
                              !args_error(&args, "--to: expected more than --from, %g, found %g",
                                          choice->from, choice->to))))
        code = ARGS_USAGE;
    if (code == ARGS_RUN) {
        options.log = rules.input = args.operands;
        options.log_count = rules.input_count = args.operand_count;
        options.prefix = args.bus.prefix;
        code = run_cut(&options, json);
    }
    log_choice_clear(&options.choice);
    return code;
}
