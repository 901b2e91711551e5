/* fmb replay: the queries of a log, answered again. */
#include "commands.h"

#include "allocate.h"
#include "args.h"
#include "cache.h"
#include "input.h"
#include "output.h"
#include "progress.h"
#include "replay_bus.h"
#include "replay_jobs.h"
#include "replay_json.h"
#include "replay_junit.h"
#include "replay_text.h"
#include "listing.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

static const char usage[] =
    "usage: fmb replay [OPTIONS] LOG...\n"
    "\n"
    "Answers every query of one or more LCM event logs again, in this process, and compares with\n"
    "the results recorded there: verdicts, intervals, boxes and certificates have to be the same\n"
    "bits. Queries and results belong together by client id and sequence number, wherever they\n"
    "stand. Several logs are taken as one, in the order given, as rotation wrote them. Frames\n"
    "that came by key get the components that the log tells for the key. Definitions of keys,\n"
    "which 'fmb log cut' writes into logs, are taken as such: nothing was asked there.\n"
    "\n"
    "  --golden FILE        compare with the results in FILE, not with those recorded\n"
    "  --write-golden FILE  write the results, as an event log, to compare with later\n"
    "  --force              FILE may be there already\n"
    "  --tolerance T        numbers need not be the same bits: ends of intervals may differ by T\n"
    "                       times the duration, ends of boxes by T times the largest coordinate;\n"
    "                       certificates are not compared. For logs of other versions\n"
    "  --from S, --to S     only queries of this time of the log, in seconds since its first\n"
    "                       event, from S on and before S; the rest is read for what these need\n"
    "  -j, --jobs N         on N cores, each with a part of the bytes\n"
    "  --bodies N           bodies that are kept, as fmbd --bodies (65536)\n"
    "  --bus                the service on the bus answers, not this process\n"
    "  --speed X            with --bus: ask X times as fast as was logged, 1 for real time;\n"
    "                       without it, or 0, as fast as the service answers\n"
    "  --timeout SECONDS    with --bus: wait so long before a query is sent again (0.5)\n"
    "  --retries N          with --bus: after N more such times without any answer, one after the\n"
    "                       other, the service is given up (9)\n"
    "  --json               one line of JSON in place of the text\n"
    "  --junit FILE         write JUnit XML as well, for CI systems\n"
    "  --limit N            tell N differences, and only count the others (1000)\n"
    "  --html FILE          write a page that shows what happened\n" ARGS_COMMON_USAGE
    "\n"
    "With --bus a live fmbd is asked, and nothing else changes: what the log holds is compared\n"
    "with what it says now. It is asked under a client id of its own, many queries at once, none\n"
    "is lost, and a service that dies and comes back is waited for. Keys of the log become keys\n"
    "of this service, or components. (Where it serves others too, bodies of the same ids replace\n"
    "theirs, and they have to send them again.) SIGINT ends it with what was answered so far.\n"
    "\n"
    "Results of the moment are counted apart, not compared: that the service was busy, or did\n"
    "not hold a body, then; or that the log does not have the components of a key. Times are\n"
    "not compared; microseconds taken to decide are shown, then and now.\n"
    "\n"
    "Exit codes: 0 all the same, 1 something is different, 2 unusable: a log cannot be read or\n"
    "is damaged (which is told with its offset; 'fmb log cut' copies what can be read), a\n"
    "message of the service's channels cannot be read, there is nothing to compare, or the\n"
    "service on the bus does not answer all.\n";

struct options {
    struct replay_options replay;
    struct answer_bus_options bus;
    struct args_bus where;
    long jobs, bodies, limit, retries;
    bool json, live;
    const char *junit, *html;
};

enum { GOLDEN = 1, WRITE_GOLDEN, FORCE, TOLERANCE, FROM, TO, BODIES, JSON, JUNIT, HTML, LIMIT };
enum { BUS = LIMIT + 1, SPEED, TIMEOUT, RETRIES };

static const struct option own_options[] = {
    {"golden", required_argument, NULL, GOLDEN},
    {"write-golden", required_argument, NULL, WRITE_GOLDEN},
    {"force", no_argument, NULL, FORCE},
    {"tolerance", required_argument, NULL, TOLERANCE},
    {"from", required_argument, NULL, FROM},
    {"to", required_argument, NULL, TO},
    {"jobs", required_argument, NULL, 'j'},
    {"bodies", required_argument, NULL, BODIES},
    {"json", no_argument, NULL, JSON},
    {"junit", required_argument, NULL, JUNIT},
    {"html", required_argument, NULL, HTML},
    {"limit", required_argument, NULL, LIMIT},
    {"bus", no_argument, NULL, BUS},
    {"speed", required_argument, NULL, SPEED},
    {"timeout", required_argument, NULL, TIMEOUT},
    {"retries", required_argument, NULL, RETRIES},
    {NULL, 0, NULL, 0},
};

static bool take_option(const struct args *args, int option, void *out)
{
    struct options *options = out;
    struct replay_options *replay = &options->replay;
    switch (option) {
    case GOLDEN: replay->golden = optarg; break;
    case WRITE_GOLDEN: replay->write_golden = optarg; break;
    case FORCE: replay->force = true; break;
    case TOLERANCE: return args_number(args, 0, 1, &replay->compare.tolerance);
    case FROM: return args_number(args, 0, 1e12, &replay->from);
    case TO: return args_number(args, 0, 1e12, &replay->to);
    case 'j': return args_integer(args, 1, REPLAY_JOBS_MAX, &options->jobs);
    case BODIES: return args_integer(args, 1, CACHE_BODIES_MAX, &options->bodies);
    case JSON: options->json = true; break;
    case JUNIT: options->junit = optarg; break;
    case HTML: options->html = optarg; break;
    case LIMIT: return args_integer(args, 0, INT32_MAX, &options->limit);
    case BUS: options->live = true; break;
    case SPEED: return args_number(args, 0, 1e9, &options->bus.speed);
    case TIMEOUT: return args_number(args, 0.001, 1e6, &options->bus.timeout);
    case RETRIES: return args_integer(args, 0, 1000000, &options->retries);
    }
    return true;
}

/* ---- While it goes ---- */

/* Complaints of one kind that are printed; the rest is counted. */
enum { COMPLAINTS_MAX = 20 };

struct run {
    const struct options *options;
    struct progress progress;
    int64_t first_utime;
    struct listing *told;
    int64_t complaints;
    struct replay_json json;
};

static const char *log_name(const struct run *run, int log)
{
    return run->options->replay.log[log];
}

static void on_found(void *user, const struct found *found)
{
    struct run *run = user;
    listing_put(run->told, found);
}

/* Whether one more may be printed. */
static bool complains(struct run *run)
{
    progress_end(&run->progress);
    return run->complaints++ < COMPLAINTS_MAX;
}

static void on_unreadable(void *user, const struct match_place *place, const char *channel,
                          const char *what)
{
    struct run *run = user;
    if (complains(run))
        fprintf(stderr, "fmb: %s: event %" PRId64 " (offset %" PRId64 "): %s: %s\n",
                log_name(run, place->log), place->number, place->offset, channel, what);
}

static void on_damage(void *user, int log, const struct log_damage *damage)
{
    struct run *run = user;
    if (complains(run))
        fprintf(stderr, "fmb: %s: offset %" PRId64 ": %" PRId64 " bytes: %s\n", log_name(run, log),
                damage->offset, damage->length, damage->what);
}

static void on_progress(void *user, int64_t bytes)
{
    struct run *run = user;
    progress_to(&run->progress, (uint64_t) bytes);
}

/* ---- Before and after ---- */

/* As many files at a time as the system grants: each log is one. */
static void open_many(void)
{
    struct rlimit limit;
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0)
        return;
    limit.rlim_cur = limit.rlim_max;
    setrlimit(RLIMIT_NOFILE, &limit);
}

/* When the logs begin. */
static int64_t first_utime(const struct replay_options *options)
{
    char why[LOG_WHY_MAX];
    struct input input;
    struct log_event event = {.utime = 0};
    struct log_damage damage;
    enum log_outcome outcome;
    if (!input_open(&input, options->log, options->log_count, why))
        return 0;
    while ((outcome = input_next(&input, &event, &damage)) == LOG_DAMAGE)
        continue;
    input_close(&input);
    return outcome == LOG_EVENT ? event.utime : 0;
}

static bool write_junit(const struct run *run, const struct tally *tally)
{
    const struct options *options = run->options;
    FILE *file = output_open(options->junit);
    if (!file)
        return false;
    replay_junit(file, &options->replay, run->told, tally, run->first_utime);
    return output_close(file, options->junit);
}

static bool write_page(const struct options *options)
{
    FILE *file = output_open(options->html);
    if (!file)
        return false;
    page_write(options->replay.page, file);
    return output_close(file, options->html);
}

/* Why nothing was compared, for people; NULL: something was, or nothing had to be. */
static const char *why_nothing(const struct options *options, const struct tally *all)
{
    const bool in_part = isfinite(options->replay.from) || isfinite(options->replay.to);
    if (tally_queries(all) == 0)
        return in_part ? NULL : "there are no queries of this service";
    if (tally_compared(all) > 0 || options->replay.write_golden)
        return NULL;
    return "there are no results to compare with";
}

/* The exit code, of a replay that went well as such. */
static int code_of(const struct options *options, const struct tally *all)
{
    const char *nothing = why_nothing(options, all);
    if (tally_outcome(all, REPLAY_DIFFERENT) > 0)
        return ARGS_FAILED;
    if (nothing)
        fprintf(stderr,
                "fmb: %s: neither the same nor different; --prefix chooses the service, --golden\n"
                "FILE the results, --write-golden FILE writes some\n",
                nothing);
    return nothing || all->damages > 0 || tally_unreadable(all) > 0 ? ARGS_USAGE : ARGS_ANSWERED;
}

static void tell_one(void *user, const struct found *found)
{
    struct run *run = user;
    const bool several = run->options->replay.log_count > 1;
    const char *log = log_name(run, found->place.log);
    char line[REPLAY_LINE_MAX];
    if (run->options->json) {
        replay_json_found(&run->json, found, log, run->first_utime);
        return;
    }
    replay_line(found, several ? log : NULL, run->first_utime, line);
    puts(line);
}

/* Where there was no bus, or nobody on it, counts say nothing. */
static bool has_counts(const struct run *run, const struct tally *all)
{
    return !run->options->live || all->bus.answered > 0 ||
           (all->bus.used && all->bus.end == ANSWER_BUS_NO_END);
}

static void tell_all(struct run *run, const struct tally *all, int code)
{
    const int64_t beyond = listing_beyond(run->told);
    if (run->complaints > COMPLAINTS_MAX)
        fprintf(stderr, "fmb: and %" PRId64 " more that could not be read\n",
                run->complaints - COMPLAINTS_MAX);
    if (run->options->json)
        run->json = replay_json_begin(stdout);
    listing_each(run->told, tell_one, run);
    if (run->options->json) {
        replay_json_end(&run->json, all, beyond, code);
        return;
    }
    if (beyond > 0)
        printf("and %" PRId64 " more differences (--limit)\n", beyond);
    if (has_counts(run, all))
        replay_text_summary(stdout, all);
}

/* ---- The run ---- */

static int replay(struct run *run, int64_t size, struct tally *tally)
{
    const struct options *options = run->options;
    const struct replay_sink sink = {on_found, on_unreadable, on_damage, on_progress, run};
    struct tally all = {.events = 0};
    run->progress = progress_begin_bytes((uint64_t) size);
    run->progress.enabled = isatty(STDERR_FILENO); /* what is printed comes when it has ended */
    bool good = replay_jobs(&options->replay, (int) options->jobs, size, &sink, tally);
    progress_end(&run->progress);
    for (int log = 0; log < options->replay.log_count; log++)
        tally_add(&all, &tally[log]);
    replay_bus_end(&all.bus, &options->bus, options->replay.log);
    int code = good ? code_of(options, &all) : ARGS_USAGE;
    if (options->junit && !write_junit(run, tally))
        code = ARGS_USAGE;
    if (options->html && !write_page(options))
        code = ARGS_USAGE;
    tell_all(run, &all, code);
    return output_flush() ? code : ARGS_USAGE;
}

static int run_replay(struct options *options)
{
    struct run run = {.options = options};
    open_many();
    const int64_t size = replay_size(&options->replay);
    if (size < 0)
        return ARGS_USAGE;
    run.first_utime = first_utime(&options->replay);
    if (options->html)
        options->replay.page = page_open(options->replay.log[0], run.first_utime);
    run.told = listing_open(options->limit);
    struct tally *tally = allocate((size_t) options->replay.log_count, sizeof *tally);
    const int code = replay(&run, size, tally);
    free(tally);
    page_close(options->replay.page);
    listing_close(run.told);
    return code;
}

/* A report goes where no log is, lest 'fmb replay --junit *.log' costs one. */
static bool check_report(const struct args *args, const char *option, const char *path)
{
    static const unsigned char begin[] = {0xed, 0xa1, 0xda, 0x01};
    unsigned char found[sizeof begin];
    FILE *file = path ? fopen(path, "rb") : NULL;
    if (!file)
        return true;
    const bool is_log = fread(found, 1, sizeof found, file) == sizeof found &&
                        memcmp(found, begin, sizeof begin) == 0;
    fclose(file);
    return !is_log || args_error(args, "--%s: %s is an event log", option, path);
}

static bool check_options(const struct args *args, const struct options *options)
{
    if (args->operand_count == 0)
        return args_error(args, "expected a LOG");
    if (options->jobs > 1 && (options->html || options->replay.write_golden))
        return args_error(args, "--jobs does not go with --html and --write-golden");
    return check_report(args, "junit", options->junit) && check_report(args, "html", options->html);
}

/* What goes with answers of this process, and what with those of a service. */
static bool check_bus(const struct args *args, const struct options *options)
{
    if (options->live && (options->jobs > 1 || options->bodies > 0))
        return args_error(args, "--%s does not go with --bus",
                          options->jobs > 1 ? "jobs" : "bodies");
    if (!options->live && (options->bus.speed >= 0 || options->bus.timeout > 0 ||
                           options->retries >= 0 || args->bus.url))
        return args_error(args, "--speed, --timeout, --retries and --lcm-url go with --bus");
    return true;
}

/* Those that were not given. */
static void complete(struct options *options)
{
    struct answer_bus_options *bus = &options->bus;
    options->bodies = options->bodies > 0 ? options->bodies : 65536;
    options->retries = options->retries >= 0 ? options->retries : 9;
    bus->url = options->where.url;
    bus->prefix = options->where.prefix;
    bus->speed = bus->speed >= 0 ? bus->speed : 0;
    bus->timeout = bus->timeout > 0 ? bus->timeout : 0.5;
    bus->retries = (int) options->retries;
    options->replay.bus = options->live ? bus : NULL;
    options->replay.prefix = options->where.prefix;
    options->replay.bodies = (size_t) options->bodies;
}

int cmd_replay(int argc, char **argv)
{
    struct args args = {
        "replay", usage, own_options, take_option, .operand = "LOG", .operands_max = 4096};
    struct options options = {.replay = {.from = -INFINITY, .to = INFINITY},
                              .bus = {.speed = -1},
                              .jobs = 1,
                              .limit = 1000,
                              .retries = -1};
    const int code = args_parse(&args, argc, argv, &options);
    if (code != ARGS_RUN)
        return code;
    if (!check_options(&args, &options) || !check_bus(&args, &options))
        return ARGS_USAGE;
    options.replay.log = args.operands;
    options.replay.log_count = args.operand_count;
    options.where = args.bus;
    complete(&options);
    return run_replay(&options);
}
