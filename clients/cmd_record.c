/* fmb record: what passes on the bus, into a log. */
#include "commands.h"

#include "args.h"
#include "clock.h"
#include "log_spool.h"
#include "output.h"
#include "record_bus.h"
#include "record_line.h"
#include "record_report.h"
#include "signals.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char usage[] =
    "usage: fmb record [OPTIONS] FILE\n"
    "\n"
    "Writes the queries, the results and the heartbeats of a service that pass on the bus, byte\n"
    "for byte, to an LCM event log, for lcm-logplayer and all that reads such logs; until SIGINT\n"
    "or SIGTERM. What cannot be read is recorded too, and counted.\n"
    "\n"
    "  --force              overwrite FILE\n"
    "  --json               say at the end what was recorded as one line of JSON\n"
    "  --duration SECONDS   end after that time\n"
    "  --count N            end after N messages\n"
    "  --split-mb N         write FILE.000, FILE.001, ... of at most N MB (1,048,576 bytes) each;\n"
    "                       with --force all files of such names are removed first\n"
    "  --max-files K        of those keep the newest K\n"
    "  --channel REGEX      record what passes on other channels too whose whole name matches\n"
    "  --all                record all channels\n" ARGS_COMMON_USAGE
    "\n"
    "Without --channel and --all the system passes on nothing but the service's own channels, and\n"
    "whole datagrams: other messages take no room, and what can crash LCM is kept from it.\n"
    "\n"
    "At the end it says how many messages were lost, at least: sequence numbers that clients\n"
    "skipped, results that the service counts in its heartbeats and that did not come, messages\n"
    "that waited for the disk in vain, and with --channel and --all datagrams that the system\n"
    "threw away. For a larger receive buffer, and to be served before others:\n"
    "  sudo sysctl net.core.rmem_max=4194304\n"
    "  sudo chrt -f 10 fmb record ...\n"
    "\n"
    "Exit codes: 0 recorded, also where messages were lost; 1 the bus or the log failed (the disk\n"
    "is full), and what was recorded before is good; 2 wrong usage, FILE exists or cannot be\n"
    "created.\n";

struct options {
    bool json, all;
    double duration; /* seconds; 0: no end */
    long count;      /* 0: no end */
    const char *channel;
    double split_mb; /* 0: one file */
    struct log_parts_options parts;
};

struct recording {
    const struct options *options;
    struct record_bus bus;
    struct log_parts parts;
    struct log_spool *spool;
    struct tally tally;
    struct record_line line;
    int64_t begin_ns;
    int64_t taken;   /* messages that went to the spool */
    int64_t refused; /* and that did not */
    int64_t utime;   /* when the newest was received */
    bool enough;
};

/* ---- Options --------------------------------------------------------------------------------- */

enum { FORCE = 1, JSON, DURATION, COUNT, SPLIT, MAX_FILES, CHANNEL, ALL };

static const struct option own_options[] = {
    {"force", no_argument, NULL, FORCE},
    {"json", no_argument, NULL, JSON},
    {"duration", required_argument, NULL, DURATION},
    {"count", required_argument, NULL, COUNT},
    {"split-mb", required_argument, NULL, SPLIT},
    {"max-files", required_argument, NULL, MAX_FILES},
    {"channel", required_argument, NULL, CHANNEL},
    {"all", no_argument, NULL, ALL},
    {NULL, 0, NULL, 0},
};

static bool take_option(const struct args *args, int option, void *out)
{
    struct options *options = out;
    switch (option) {
    case FORCE: options->parts.force = true; break;
    case JSON: options->json = true; break;
    case DURATION: return args_number(args, 0.001, 1e8, &options->duration);
    case COUNT: return args_integer(args, 1, 1000000000000, &options->count);
    case SPLIT: return args_number(args, 0.001, 1e6, &options->split_mb);
    case MAX_FILES: return args_integer(args, 1, 1000000, &options->parts.keep);
    case CHANNEL: options->channel = optarg; break;
    case ALL: options->all = true; break;
    }
    return true;
}

/* What the options say together. */
static int complete(const struct args *args, struct options *options)
{
    if (args->operand_count == 0)
        args_error(args, "expected a FILE to write");
    else if (options->parts.keep > 0 && options->split_mb == 0)
        args_error(args, "--max-files: there is one file only without --split-mb");
    else if (options->all && options->channel)
        args_error(args, "--channel: --all records all channels");
    else {
        if (options->all)
            options->channel = ".*";
        options->parts.path = args->operands[0];
        options->parts.part_bytes = (int64_t) (options->split_mb * (1 << 20));
        return ARGS_RUN;
    }
    return ARGS_USAGE;
}

/* ---- Messages -------------------------------------------------------------------------------- */

/* What no log has room for: a channel without a name, and a size that is a negative number. */
static bool put(struct recording *recording, const char *channel, size_t channel_length,
                const lcm_recv_buf_t *message)
{
    return channel_length > 0 && message->data_size <= INT32_MAX &&
           log_spool_put(recording->spool, message->recv_utime, channel, channel_length,
                         message->data, message->data_size);
}

static void on_message(void *user, enum log_kind kind, const char *channel,
                       const lcm_recv_buf_t *message)
{
    struct recording *recording = user;
    const size_t channel_length = strlen(channel);
    if (recording->enough)
        return;
    tally_note(&recording->tally, kind, channel_length, message->data, message->data_size);
    if (put(recording, channel, channel_length, message))
        recording->taken++;
    else
        recording->refused++;
    recording->utime = message->recv_utime;
    recording->enough = recording->taken == recording->options->count;
}

/* ---- The run --------------------------------------------------------------------------------- */

enum end { END_ENOUGH, END_ASKED, END_BUS_FAILED, END_LOG_FAILED };

/* How often it is looked whether the log can still be written, and the line is shown. */
static const int64_t tick_ns = 250000000;

static void show_line(struct recording *recording, long part, int64_t now_ns)
{
    const int64_t dropped = record_bus_dropped(&recording->bus);
    char *name = recording->options->parts.part_bytes > 0
                     ? log_parts_name(recording->options->parts.path, part)
                     : NULL;
    record_line_show(&recording->line, now_ns, name ? name : recording->options->parts.path,
                     &recording->tally,
                     record_lost(&recording->tally, recording->refused, dropped));
    free(name);
}

static bool tick(struct recording *recording, int64_t now_ns)
{
    const struct log_spool_state state = log_spool_state(recording->spool);
    show_line(recording, state.part, now_ns);
    return state.error == 0;
}

static enum end bus_failed(struct recording *recording)
{
    const int error = errno;
    record_line_end(&recording->line);
    fprintf(stderr, "fmb: the bus has failed: %s\n",
            error ? strerror(error) : "nothing more comes");
    return END_BUS_FAILED;
}

static enum end run(struct recording *recording, int signals)
{
    const double duration = recording->options->duration;
    const int64_t end_ns =
        duration > 0 ? recording->begin_ns + (int64_t) (1e9 * duration) : INT64_MAX;
    int64_t now_ns = recording->begin_ns, tick_at_ns = now_ns;
    struct pollfd source[2] = {
        {.fd = lcm_get_fileno(recording->bus.lcm), .events = POLLIN},
        {.fd = signals, .events = POLLIN},
    };
    while (!recording->enough && now_ns < end_ns) {
        const int64_t until_ns = tick_at_ns < end_ns ? tick_at_ns : end_ns;
        const int wait_ms = until_ns > now_ns ? (int) ((until_ns - now_ns + 999999) / 1000000) : 0;
        if (poll(source, 2, wait_ms) < 0 && errno != EINTR)
            return bus_failed(recording);
        if (source[1].revents)
            return END_ASKED;
        if (!record_bus_drain(&recording->bus))
            return bus_failed(recording);
        now_ns = clock_ns();
        if (now_ns < tick_at_ns)
            continue;
        if (!tick(recording, now_ns))
            return END_LOG_FAILED;
        tick_at_ns = now_ns + tick_ns;
    }
    return recording->enough ? END_ENOUGH : END_ASKED;
}

/* What was on its way when the end came: until something comes that was sent later, or nothing for
 * some time, but no longer than a second. */
static enum end take_rest(struct recording *recording)
{
    enum { QUIET_MS = 20 };
    const int64_t asked_utime = clock_utime(), end_ns = clock_ns() + 1000000000;
    while (!recording->enough && recording->utime <= asked_utime && clock_ns() < end_ns &&
           record_bus_has_more(&recording->bus, QUIET_MS))
        if (!record_bus_drain(&recording->bus))
            return bus_failed(recording);
    return END_ASKED;
}

/* ---- Begin and end --------------------------------------------------------------------------- */

/* Room for messages that wait for the disk, twice: seconds of tens of thousands of pairs each, and
 * half a second of the most that the bus carries of the largest scenes. */
enum { HALF_BYTES = 128 << 20 };

static void say_begin(const struct recording *recording)
{
    fprintf(stderr, "fmb: recording to %s", recording->parts.name);
    if (recording->bus.receive_buffer > 0)
        fprintf(stderr, ", with a receive buffer of %ld bytes", recording->bus.receive_buffer);
    fputc('\n', stderr);
}

static int end_of_recording(struct recording *recording, enum end end)
{
    const int64_t end_ns = clock_ns(), dropped = record_bus_dropped(&recording->bus);
    const struct log_spool_state state = log_spool_finish(recording->spool);
    const struct recorded recorded = {
        .tally = &recording->tally,
        .parts = &recording->parts,
        .events = state.events,
        .bytes = state.bytes,
        .unwritten = recording->refused + recording->taken - state.events,
        .dropped = dropped,
        .receive_buffer = recording->bus.receive_buffer,
        .seconds = 1e-9 * (double) (end_ns - recording->begin_ns),
        .error = state.error,
    };
    record_line_end(&recording->line);
    if (state.error)
        log_write_complain(recording->parts.name, state.error);
    record_report_losses(&recorded);
    (recording->options->json ? record_report_json : record_report_text)(&recorded);
    const bool good = output_flush() && !state.error && end != END_BUS_FAILED;
    return good ? ARGS_ANSWERED : ARGS_FAILED;
}

/* The thread that writes must be begun behind the signals, lest it be the one that gets them. A
 * file that may not grow shall be an error, not a signal. */
static int record(struct recording *recording, int signals)
{
    signal(SIGXFSZ, SIG_IGN);
    recording->spool = log_spool_start(&recording->parts, HALF_BYTES);
    if (!recording->spool) {
        perror("fmb: cannot begin to write");
        return ARGS_FAILED;
    }
    recording->begin_ns = clock_ns();
    recording->line = record_line_begin(recording->begin_ns);
    say_begin(recording);
    enum end end = run(recording, signals);
    if (end == END_ASKED)
        end = take_rest(recording);
    return end_of_recording(recording, end);
}

/* The bus is open, and what comes waits there. */
static int record_from_bus(struct recording *recording)
{
    int code = ARGS_FAILED;
    const int signals = signals_open();
    if (signals < 0) {
        perror("fmb: signals");
    } else if (!log_parts_open(&recording->options->parts, &recording->parts)) {
        log_write_complain(
            recording->parts.name ? recording->parts.name : recording->options->parts.path, errno);
        code = ARGS_USAGE;
    } else {
        code = record(recording, signals);
    }
    if (signals >= 0) {
        log_parts_close(&recording->parts);
        close(signals);
    }
    return code;
}

int cmd_record(int argc, char **argv)
{
    struct args args = {"record",         usage, own_options, take_option, .operand = "FILE",
                        .operands_max = 1};
    static struct recording recording;
    struct options options = {.json = false};
    recording.options = &options;
    int code = args_parse(&args, argc, argv, &options);
    if (code == ARGS_RUN)
        code = complete(&args, &options);
    if (code != ARGS_RUN)
        return code;
    code = record_bus_open(&args.bus, options.channel, on_message, &recording, &recording.bus);
    if (code != ARGS_RUN)
        return code;
    code = record_from_bus(&recording);
    record_bus_close(&recording.bus);
    return code;
}
