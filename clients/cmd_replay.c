/* fmb replay: answers the queries of a log again. */
#include "commands.h"

#include "allocate.h"
#include "args.h"
#include "cache.h"
#include "complain.h"
#include "escape.h"
#include "input.h"
#include "listing.h"
#include "number.h"
#include "page.h"
#include "progress.h"
#include "replay_output.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "usage: fmb replay [OPTIONS] LOG...\n"
    "\n"
    "Answers every query of one or more LCM event logs again, in this process, and\n"
    "compares with the recorded results: verdicts, intervals, boxes, points, gaps\n"
    "with their directions and witness points, and certificates must be the same\n"
    "bits. A result belongs to the query with the same client id and sequence number,\n"
    "anywhere in the logs. Several logs are read as one, in the order given, as\n"
    "rotation wrote them. Handles are resolved by definitions, and by bodies with an\n"
    "id that were sent whole, before or after the query.\n"
    "\n"
    "  --golden FILE        compare with the results in FILE, not with the recorded\n"
    "                       ones. A client without any result in FILE is paired with\n"
    "                       one of FILE, by first appearance, and its queries by\n"
    "                       their order within type, label and first pair (of pair\n"
    "                       queries: both body ids); if FILE has results only,\n"
    "                       within their type. Queries without a counterpart are\n"
    "                       listed. A scene with other bodies, the same bodies in\n"
    "                       another order, or other pairs is one difference, and its\n"
    "                       pairs are not compared. Bodies are the same if their\n"
    "                       names are or, where one has none, their ids\n"
    "  --write-golden FILE  write the results, as an event log, to compare with later\n"
    "  --force              overwrite any FILE; a page that replaces a page, and a\n"
    "                       JUnit report that replaces one, need no --force\n"
    "  --tolerance T        for logs of other versions: times of intervals and points\n"
    "                       may differ by T times the duration, points and ends of\n"
    "                       boxes and gaps by T times the largest coordinate of the\n"
    "                       query: of the position of a body, at the beginning or the\n"
    "                       end, plus its reach. Directions, witness points and\n"
    "                       certificates are not compared\n"
    "  --frames N           capacity of the cache, in frames, as fmbd --frames\n"
    "                       (65536)\n"
    "  --bus                the service on the bus answers, not this process, as fast\n"
    "                       as it can\n"
    "  --log-prefix P       the channels in the logs begin with P, if not with that\n"
    "                       of --prefix, which is then that of the service on the bus\n"
    "  --timeout SECONDS    with --bus: longest time before a query is sent again\n"
    "                       (0.5)\n"
    "  --retries N          with --bus: give a query up, and end, after N + 1\n"
    "                       timeouts (9)\n"
    "  --json               one line of JSON in place of the text\n"
    "  --junit FILE         also write JUnit XML, for CI systems: a case for each\n"
    "                       label of scenes, and one for the other queries of each\n"
    "                       channel\n"
    "  --limit N            list N differences, and only count the others (1000);\n"
    "                       changes of scenes and verdicts come first\n"
    "  --html FILE          write a page that plays the queries, with the "
    "differences\n" ARGS_COMMON_USAGE
    "\n"
    "With --bus a running fmbd answers, many queries at a time, under a new client\n"
    "id. Bodies that it does not hold are sent with frames. SIGINT ends the replay\n"
    "with what was answered so far.\n"
    "\n"
    "Not compared, but counted: results that say the service was busy or did not hold\n"
    "a body, and queries that are left out: the logs do not define their handles, or\n"
    "their bodies do not fit into the cache. Second results of a query that\n"
    "contradict the first are reported and counted as different. Times to decide are\n"
    "shown, not compared.\n"
    "\n"
    "To replay a part of a log, copy it with 'fmb log cut'. The logs are read twice.\n"
    "Memory: some 300 bytes for each distinct body, and 100 bytes for each query and\n"
    "each result, also of a golden log, for whose results it is 200; with a golden\n"
    "log of other clients, 1 kB for each query.\n"
    "\n"
    "Exit codes: 0 all the same; 1 something differs; 2 unusable: a log cannot be\n"
    "read or is damaged ('fmb log cut' copies what is intact), a message on the\n"
    "service's channels cannot be read, a query is left out, there is nothing to\n"
    "compare, or the service on the bus does not answer all queries.\n";

struct replay_arguments {
    struct replay_options replay;
    struct fmb_client_options bus;
    const char *log_prefix; /* NULL: that of the bus */
    long frames, limit, retries;
    bool json, live;
    struct output_options junit, html;
};

/* ---- Callbacks ---- */

/* Most complaints that are printed; the others are counted. */
enum { COMPLAINTS_MAX = 20 };

struct replay_run {
    const struct replay_arguments *options;
    bool begun; /* the logs were opened, */
    bool good;  /* and read to their end */
    int64_t first_utime;
    struct listing *differences;
    int64_t complaints;
    struct json_writer json;
};

/* The path of a log; the golden log comes after the others. */
static const char *log_name(const struct replay_run *run, int log)
{
    const struct replay_options *replay = &run->options->replay;
    return log < replay->log_count ? replay->log[log] : replay->golden;
}

static void on_found(void *user, const struct difference *found)
{
    struct replay_run *run = user;
    listing_put(run->differences, found);
}

/* Counts a complaint. Returns whether it may be printed. */
static bool complains(struct replay_run *run)
{
    return run->complaints++ < COMPLAINTS_MAX;
}

static void on_unreadable(void *user, const struct match_place *place, const char *channel,
                          const char *what)
{
    struct replay_run *run = user;
    if (complains(run))
        complain("%s: event %" PRId64 " (offset %" PRId64 "): %s: %s", log_name(run, place->log),
                 place->number, place->offset, channel, what);
}

static void on_damage(void *user, int log, const struct log_damage *damage)
{
    struct replay_run *run = user;
    if (complains(run))
        complain("%s: offset %" PRId64 ": %" PRId64 " bytes: %s", log_name(run, log),
                 damage->offset, damage->length, damage->what);
}

static void on_progress(void *user, int64_t bytes, int64_t of)
{
    (void) user;
    progress_to(bytes, of);
}

/* ---- Files and outcome ---- */

static bool write_junit(const struct replay_run *run, struct tally *tally)
{
    struct output *output;
    if (!output_open(&run->options->junit, &output))
        return false;
    if (output)
        replay_junit(output->file, &run->options->replay, run->differences, tally,
                     run->first_utime);
    return output_close(output, true);
}

/* Reports why nothing was compared, if so, and what to do. Returns false if something was, or
 * results were written. */
static bool complain_nothing(const struct replay_arguments *options, const struct tally *all,
                             const struct tally_channel *both)
{
    if (all->events == 0)
        complain("%s holds no events: is it an event log?", options->replay.log[0]);
    else if (both->queries == 0)
        complain(
            "there are no queries of this service; 'fmb log info' lists the channels of a log, "
            "and --prefix chooses them");
    else if (tally_compared(both) == 0 && !options->replay.write_golden.path)
        complain(
            "there are no results to compare with; --golden FILE takes them from another log, "
            "and --write-golden FILE writes them");
    else
        return false;
    return true;
}

/* Reports how many queries were not answered, and what would help. Returns false if all were. */
static bool complain_left_out(const struct replay_arguments *options,
                              const struct tally_channel *both)
{
    const int64_t undefined = both->outcome[REPLAY_UNDEFINED];
    const int64_t not_held = both->outcome[REPLAY_NOT_HELD];
    char text[NUMBER_TEXT_MAX];
    if (undefined > 0)
        complain("queries left out because the logs do not define their handles: %s",
                 number_grouped(undefined, text));
    if (not_held > 0)
        complain("queries left out because their bodies do not fit into the cache (%s--frames): %s",
                 options->live ? "fmbd " : "", number_grouped(not_held, text));
    return undefined + not_held > 0;
}

/* Returns the exit code of a replay that reached its end. */
static int code_of(const struct replay_arguments *options, const struct tally *all)
{
    const struct tally_channel both = tally_both(all);
    const bool left_out = complain_left_out(options, &both);
    if (both.outcome[REPLAY_DIFFERENT] + both.contradictions + both.left_over > 0)
        return ARGS_FAILED;
    return left_out || complain_nothing(options, all, &both) || all->damages > 0 ||
                   tally_unreadable(all) > 0
               ? ARGS_USAGE
               : ARGS_ANSWERED;
}

static void report_one(void *user, const struct difference *found)
{
    struct replay_run *run = user;
    const bool several = run->options->replay.log_count > 1;
    const char *log = log_name(run, found->place.log);
    if (run->options->json) {
        replay_json_found(&run->json, found, run->options->replay.names, log, run->first_utime);
        return;
    }
    replay_line(stdout, ESCAPE_TERMINAL, found, run->options->replay.names, several ? log : NULL,
                run->first_utime);
}

static void report_all(struct replay_run *run, const struct tally *all, int code)
{
    const int64_t beyond = listing_beyond(run->differences);
    const struct tally_bus *bus = &all->bus;
    const bool any = run->good ? all->events > 0 : tally_both(all).queries > 0;
    const bool answered = bus->answered > 0 || (bus->used && bus->end == TALLY_NO_END);
    if (run->complaints > COMPLAINTS_MAX)
        complain("and %" PRId64 " more of these", run->complaints - COMPLAINTS_MAX);
    if (run->options->json)
        run->json = replay_json_begin(stdout);
    listing_each(run->differences, report_one, run);
    if (run->options->json) {
        replay_json_end(&run->json, all, beyond, code);
        return;
    }
    if (beyond > 0)
        printf("and %" PRId64 " more differences (--limit)\n", beyond);
    /* Counts have no meaning without an event or an answer, nor without a service on the bus. */
    if (run->begun && any && (!run->options->live || answered))
        replay_text_summary(stdout, all);
}

/* ---- The end of a replay through a live service ---- */

/* No service has answered at all, or none does any more. */
static void report_no_service(const struct tally_bus *bus, const struct fmb_client_options *options,
                              char *const *log)
{
    const double patience = options->timeout * options->tries;
    const struct args_bus where = {options->url, options->prefix};
    char answered[NUMBER_TEXT_MAX];
    if (bus->services == 0)
        complain("no fmbd answered on %sFMB_PAIR_RESULT and %sFMB_SCENE_RESULT of %s within %g s",
                 options->prefix, options->prefix, args_bus_name(&where), patience);
    else
        complain(
            "fmbd answered %s queries, and then nothing for %g s; the next one is event %" PRId64
            " (offset %" PRId64 ") of %s",
            number_grouped(bus->answered, answered), patience, bus->number, bus->offset,
            log[bus->log]);
    if (bus->malformed > 0)
        complain("%" PRId64 " results could not be read: another version of fmbd?", bus->malformed);
    args_advise_service(&where, ", or replay in this process: leave out --bus");
}

/* Reports why not all queries were answered, if so, and what to do. */
static void report_end(const struct tally_bus *bus, const struct fmb_client_options *options,
                       char *const *log)
{
    char answered[NUMBER_TEXT_MAX];
    switch ((enum tally_end) bus->end) {
    case TALLY_NO_END: break;
    case TALLY_SIGNAL:
        complain("ended by a signal; counts are of %s queries, answered so far",
                 number_grouped(bus->answered, answered));
        break;
    case TALLY_NO_SERVICE: report_no_service(bus, options, log); break;
    case TALLY_BUS_FAILED: complain("the bus has failed"); break;
    }
}

/* ---- The run ---- */

static int replay(struct replay_run *run, struct tally *tally)
{
    const struct replay_arguments *options = run->options;
    const struct replay_sink sink = {on_found, on_unreadable, on_damage, on_progress, run};
    struct tally all = {.events = 0};
    progress_begin("bytes");
    bool good = replay_run(&options->replay, &sink, tally);
    progress_end();
    for (int log = 0; log < options->replay.log_count; log++)
        tally_add(&all, &tally[log]);
    run->begun = good || all.events + all.damages > 0;
    run->good = good;
    run->first_utime = tally->first_utime;
    report_end(&all.bus, &options->bus, options->replay.log);
    int code = good ? code_of(options, &all) : ARGS_USAGE;
    if (run->begun &&
        (!write_junit(run, tally) || !page_save(options->replay.page, &options->html)))
        code = ARGS_USAGE;
    report_all(run, &all, code);
    return output_flush() ? code : ARGS_USAGE;
}

static int run_replay(struct replay_arguments *options)
{
    struct replay_run run = {.options = options};
    if (!output_check(&options->replay.write_golden) || !output_check(&options->junit) ||
        !output_check(&options->html))
        return ARGS_USAGE;
    if (options->html.path)
        options->replay.page = page_open(&(struct page_options){
            .kind = PAGE_REPLAY,
            .title = options->replay.log[0],
            .sides = {options->replay.golden ? options->replay.golden : "the recording",
                      options->live ? "answered again by the service" : "answered again"}});
    options->replay.labels = options->junit.path != NULL;
    options->replay.names = body_names_open();
    run.differences = listing_open(options->limit);
    struct tally *tally = allocate((size_t) options->replay.log_count, sizeof *tally);
    const int code = replay(&run, tally);
    for (int log = 0; log < options->replay.log_count; log++)
        tally_clear(&tally[log]);
    free(tally);
    page_close(options->replay.page);
    listing_close(run.differences);
    body_names_close(options->replay.names);
    return code;
}

/* Sets the options that were not given. */
static void complete(struct replay_arguments *options, const struct args_bus *where)
{
    struct fmb_client_options *bus = &options->bus;
    options->frames = options->frames > 0 ? options->frames : 65536;
    bus->url = where->url;
    bus->prefix = where->prefix;
    bus->timeout = bus->timeout > 0 ? bus->timeout : 0.5;
    bus->tries = options->retries >= 0 ? (int) options->retries + 1 : 10;
    options->replay.bus = options->live ? bus : NULL;
    options->replay.prefix = options->log_prefix ? options->log_prefix : where->prefix;
    options->replay.frames = (size_t) options->frames;
}

int cmd_replay(int argc, char **argv)
{
    struct output_rules rules = {.force = false};
    struct replay_arguments options = {
        .replay.write_golden = {.kind = OUTPUT_LOG, .rules = &rules},
        .junit = {.kind = OUTPUT_REPORT, .rules = &rules, .other = &options.replay.write_golden},
        .html = {.kind = OUTPUT_PAGE, .rules = &rules, .other = &options.junit},
        .limit = 1000,
        .retries = -1,
    };
    struct replay_options *replay = &options.replay;
    const struct args_option own[] = {
        {"golden", ARGS_TEXT, .out = &replay->golden},
        {"write-golden", ARGS_TEXT, .out = &replay->write_golden.path},
        {"force", ARGS_FLAG, .out = &rules.force},
        {"tolerance", ARGS_NUMBER, &replay->compare.tolerance, .high = 1},
        {"frames", ARGS_INTEGER, &options.frames, .low = 1, .high = CACHE_FRAMES_MAX},
        {"json", ARGS_FLAG, .out = &options.json},
        {"junit", ARGS_TEXT, .out = &options.junit.path},
        {"html", ARGS_TEXT, .out = &options.html.path},
        {"limit", ARGS_INTEGER, &options.limit, .high = INT32_MAX},
        {"bus", ARGS_FLAG, .out = &options.live},
        {"log-prefix", ARGS_OTHER, &options.log_prefix, .take = args_prefix},
        {"timeout", ARGS_NUMBER, &options.bus.timeout, .low = 0.001, .high = 1e6},
        {"retries", ARGS_INTEGER, &options.retries, .high = 1000000},
        {.name = NULL},
    };
    struct args args = {
        "replay", usage, own, .operand = "LOG", .operands_min = 1, .operands_max = 4096};
    const int code = args_parse(&args, argc, argv);
    if (code != ARGS_RUN)
        return code;
    const bool of_bus = options.bus.timeout > 0 || options.retries >= 0 || args.bus.url;
    if ((options.live && options.frames > 0 &&
         !args_error(&args, "--frames does not go with --bus")) ||
        (!options.live && of_bus &&
         !args_error(&args, "--timeout, --retries and --lcm-url go with --bus")))
        return ARGS_USAGE;
    options.replay.log = args.operands;
    options.replay.log_count = args.operand_count;
    rules.input = args.operands;
    rules.input_count = args.operand_count;
    rules.other_input = replay->golden;
    complete(&options, &args.bus);
    return run_replay(&options);
}
