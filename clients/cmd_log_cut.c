/* fmb log cut: a part of a log, as a log. */
#include "commands.h"

#include "args.h"
#include "log_cut.h"
#include "number.h"
#include "output.h"
#include "progress.h"
#include "query.h"

#include <inttypes.h>
#include <stdio.h>

static const char usage[] =
    "usage: fmb log cut [OPTIONS] LOG... -o FILE\n"
    "\n"
    "Copies the events that are chosen out of one or more LCM event logs into a new one, so that\n"
    "'fmb replay' says of each of its queries what it says of it in the whole. Several logs are\n"
    "taken as one, in the order given, as rotation wrote them. What is no event of a log, or is\n"
    "damaged, is told with its offset and left out: with no further options a log is repaired so.\n"
    "\n"
    "  -o, --output FILE    the new log\n"
    "  --force              FILE may be there already\n"
    "  --from S, --to S     what was logged from S on and before S, in seconds since the first\n"
    "                       event, as in 'fmb replay'\n"
    "  --channel NAME       what was sent on this channel; or NAME is an extended regular\n"
    "                       expression of POSIX that is to match the whole name. May be given\n"
    "                       several times\n"
    "  --body ID            queries that have a frame with this body id, and their results; no\n"
    "                       other events. May be given several times\n"
    "  --json               one line of JSON in place of the text\n"
    "  -p, --prefix P       the service's channels begin with P\n"
    "  -h, --help\n"
    "\n"
    "All conditions that are given have to hold. Results go with their queries, wherever they\n"
    "stand, as far as their channel is chosen. Events are the same bytes, with the same log "
    "times,\n"
    "and are numbered anew; but a frame that came by key, where the cut does not tell what that\n"
    "stands for, gets the components written back beside its key: it is a whole one to a service,\n"
    "and one by key to 'fmb replay'. A scene that would be too long for a datagram so is left as\n"
    "it is: in front of it stand definitions, which are scene queries with client_id 0 and no\n"
    "pairs, of frames that have both, components and key. Keys that the logs do not tell are\n"
    "counted, and stay.\n"
    "\n"
    "Exit codes: 0 all that was chosen is there, 1 damage was left out or nothing was chosen,\n"
    "2 wrong usage, or a file cannot be read or written: FILE is not whole then.\n";

struct options {
    struct log_cut_options cut;
    bool json;
};

enum { FORCE = 1, FROM, TO, CHANNEL, BODY, JSON };

static const struct option own_options[] = {
    {"output", required_argument, NULL, 'o'},
    {"force", no_argument, NULL, FORCE},
    {"from", required_argument, NULL, FROM},
    {"to", required_argument, NULL, TO},
    {"channel", required_argument, NULL, CHANNEL},
    {"body", required_argument, NULL, BODY},
    {"json", no_argument, NULL, JSON},
    {NULL, 0, NULL, 0},
};

static bool take_channel(const struct args *args, struct log_choice *choice)
{
    char why[LOG_CHOICE_WHY_MAX];
    return log_choice_add_channel(choice, optarg, why) ||
           args_error(args, "--channel: '%s' is no regular expression: %s", optarg, why);
}

static bool take_body(const struct args *args, struct log_choice *choice)
{
    long id;
    if (!args_integer(args, 1, QUERY_ID_MAX, &id))
        return false;
    log_choice_add_body(choice, id);
    return true;
}

static bool take_option(const struct args *args, int option, void *out)
{
    struct options *options = out;
    struct log_choice *choice = &options->cut.choice;
    switch (option) {
    case 'o': options->cut.output = optarg; break;
    case FORCE: options->cut.force = true; break;
    case FROM: return args_number(args, 0, 1e12, &choice->from);
    case TO: return args_number(args, 0, 1e12, &choice->to);
    case CHANNEL: return take_channel(args, choice);
    case BODY: return take_body(args, choice);
    case JSON: options->json = true; break;
    }
    return true;
}

/* ---- While it goes ---- */

/* Damaged places that are printed; the rest is counted. */
enum { COMPLAINTS_MAX = 20 };

struct run {
    const struct options *options;
    struct progress progress;
    int64_t complaints;
};

static void on_damage(void *user, int log, const struct log_damage *damage)
{
    struct run *run = user;
    progress_end(&run->progress);
    if (run->complaints++ < COMPLAINTS_MAX)
        fprintf(stderr, "fmb: %s: offset %" PRId64 ": %" PRId64 " bytes: %s; left out\n",
                run->options->cut.log[log], damage->offset, damage->length, damage->what);
}

static void on_progress(void *user, int64_t bytes, int64_t of)
{
    struct run *run = user;
    run->progress.total = (uint64_t) of;
    progress_to(&run->progress, (uint64_t) bytes);
}

/* ---- What became of it ---- */

static void print_count(const char *name, int64_t count, const char *what)
{
    char text[NUMBER_TEXT_MAX];
    if (count > 0)
        printf("%-13s %12s %s\n", name, number_grouped(count, text), what);
}

static void print_text(const struct log_cut_counts *counts)
{
    char kept[NUMBER_TEXT_MAX], events[NUMBER_TEXT_MAX];
    printf("kept %s of %s events; %.1f MB, of %.1f\n", number_grouped(counts->kept_events, kept),
           number_grouped(counts->events, events), 1e-6 * (double) counts->kept_bytes,
           1e-6 * (double) counts->bytes);
    print_count("", counts->kept[LOG_PAIR_QUERY], "queries of pairs");
    print_count("", counts->kept[LOG_PAIR_RESULT], "results of pairs");
    print_count("", counts->kept[LOG_SCENE_QUERY], "queries of scenes");
    print_count("", counts->kept[LOG_SCENE_RESULT], "results of scenes");
    print_count("", counts->kept[LOG_STATUS], "heartbeats");
    print_count("", counts->kept[LOG_OTHER], "on other channels");
    print_count("written back", counts->frames, "frames whose keys are told outside of the cut");
    print_count("defined", counts->defined, "keys of scenes that have no room for components");
    print_count("unknown", counts->unknown_frames, "frames by keys that the logs do not tell");
    print_count("left out", counts->damaged_bytes, "damaged bytes");
}

static void print_json(const struct log_cut_counts *counts, int code)
{
    static const char *const name[LOG_KINDS] = {"pair_queries",  "pair_results", "scene_queries",
                                                "scene_results", "statuses",     "other_events"};
    printf("{\"exit\": %d, \"events\": %" PRId64 ", \"bytes\": %" PRId64
           ", \"kept_events\": %" PRId64 ", \"kept_bytes\": %" PRId64,
           code, counts->events, counts->bytes, counts->kept_events, counts->kept_bytes);
    for (int kind = 0; kind < LOG_KINDS; kind++)
        printf(", \"%s\": %" PRId64, name[kind], counts->kept[kind]);
    printf(", \"rewritten_queries\": %" PRId64 ", \"rewritten_frames\": %" PRId64
           ", \"definitions\": %" PRId64 ", \"defined_keys\": %" PRId64
           ", \"unknown_queries\": %" PRId64 ", \"unknown_frames\": %" PRId64
           ", \"damages\": %" PRId64 ", \"damaged_bytes\": %" PRId64 "}\n",
           counts->queries, counts->frames, counts->definitions, counts->defined,
           counts->unknown_queries, counts->unknown_frames, counts->damages, counts->damaged_bytes);
}

static int code_of(const struct run *run, const struct log_cut_counts *counts)
{
    if (run->complaints > COMPLAINTS_MAX)
        fprintf(stderr, "fmb: and %" PRId64 " more damaged places\n",
                run->complaints - COMPLAINTS_MAX);
    if (counts->kept_events == 0)
        fprintf(stderr, "fmb: nothing was chosen: %s has no events\n", run->options->cut.output);
    return counts->damages > 0 || counts->kept_events == 0 ? ARGS_FAILED : ARGS_ANSWERED;
}

/* ---- The run ---- */

static int run_cut(const struct options *options)
{
    struct run run = {.options = options, .progress = progress_begin_bytes(0)};
    const struct log_cut_sink sink = {on_damage, on_progress, &run};
    struct log_cut_counts counts;
    const bool good = log_cut(&options->cut, &sink, &counts);
    progress_end(&run.progress);
    const int code = good ? code_of(&run, &counts) : ARGS_USAGE;
    if (good && options->json)
        print_json(&counts, code);
    else if (good)
        print_text(&counts);
    return output_flush() ? code : ARGS_USAGE;
}

static bool check_options(const struct args *args, const struct options *options)
{
    if (args->operand_count == 0)
        return args_error(args, "expected a LOG");
    if (!options->cut.output)
        return args_error(args, "where to? -o FILE");
    return true;
}

int cmd_log_cut(int argc, char **argv)
{
    struct args args = {"log cut",           usage, own_options, take_option, .operand = "LOG",
                        .operands_max = 4096};
    struct options options = {.cut = {.choice = log_choice_all()}};
    int code = args_parse(&args, argc, argv, &options);
    if (code == ARGS_RUN && !check_options(&args, &options))
        code = ARGS_USAGE;
    if (code == ARGS_RUN) {
        options.cut.log = args.operands;
        options.cut.log_count = args.operand_count;
        options.cut.prefix = args.bus.prefix;
        code = run_cut(&options);
    }
    log_choice_clear(&options.cut.choice);
    return code;
}
