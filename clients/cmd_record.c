/* fmb record: writes the messages on the bus to a log. */
#include "commands.h"

#include "args.h"
#include "clock.h"
#include "complain.h"
#include "escape.h"
#include "fmb_client_raw.h"
#include "json_write.h"
#include "log_choice.h"
#include "log_parts.h"
#include "number.h"
#include "process.h"
#include "progress.h"
#include "record_bodies.h"

#include <errno.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char usage[] =
    "usage: fmb record [OPTIONS] FILE\n"
    "\n"
    "Writes the queries, results and heartbeats of a service that pass on the bus,\n"
    "byte for byte, to an LCM event log, until SIGINT or SIGTERM. lcm-logplayer and\n"
    "other programs can read it. Messages that cannot be decoded are recorded too,\n"
    "and counted.\n"
    "\n"
    "  --force              overwrite FILE\n"
    "  --json               report at the end as one line of JSON\n"
    "  --duration SECONDS   end after this time\n"
    "  --count N            end after N messages\n"
    "  --split-mb N         write FILE.000, FILE.001, ... of at most N MB (1,048,576\n"
    "                       bytes) each; with --force all files with such names are\n"
    "                       removed first\n"
    "  --max-files K        keep only the newest K of these files\n"
    "  --channel REGEX      also record the channels whose whole name matches\n"
    "  --all                record all channels\n" ARGS_COMMON_USAGE
    "\n"
    "When it receives, it prints 'recording to FILE': scripts wait for this line\n"
    "before they publish.\n"
    "\n"
    "Each file also defines the bodies that its queries name by handle, and names\n"
    "them. Definitions that no message contains are requested from the service.\n"
    "Bodies are kept in up to 64 MB of memory. Messages of more than one datagram are\n"
    "not recorded.\n"
    "\n"
    "The report at the end counts what was lost: datagrams that the kernel dropped,\n"
    "queries missing by their sequence numbers, and handles whose bodies could not be\n"
    "obtained. To enlarge the receive buffer, and to raise the priority:\n"
    "  sudo sysctl net.core.rmem_max=4194304\n"
    "  sudo chrt -f 10 fmb record ...\n"
    "\n"
    "Exit codes: 0 recorded, even if messages were lost; 1 the bus or the log failed\n"
    "(the disk is full, FILE was deleted), and what was recorded before is valid; 2\n"
    "wrong usage, or FILE exists or cannot be created.\n";

struct record_options {
    bool json, all;
    double duration;          /* seconds; 0: no end */
    long count;               /* 0: no end */
    struct log_choice others; /* channels that are recorded too */
    double split_mb;          /* 0: one file */
    struct log_parts_options parts;
};

struct recording {
    const struct record_options *options;
    struct args_bus bus;
    struct fmb_client *client;
    struct log_channels channels;
    struct log_parts parts;
    struct record_bodies *bodies;
    int64_t begin_ns;
    int64_t utime;    /* when the newest message was received */
    int64_t messages; /* that were written */
    int error;        /* why the log cannot be written; 0: it can */
    bool enough;
    /* What is reported at the end. */
    int64_t received[LOG_KINDS]; /* [kind] messages, written or not */
    int64_t malformed;           /* messages of the service that cannot be decoded */
    int64_t events, bytes;       /* of the log */
    double seconds;
    struct record_bodies_counts of_bodies;
    struct bus_counts of_bus; /* dropped: messages missing from the log */
};

/* ---- Options --------------------------------------------------------------------------------- */

/* Checks what depends on several options. */
static int complete(const struct args *args, struct record_options *options)
{
    if (args->operand_count == 0)
        args_error(args, "expected a FILE to write");
    else if (options->parts.keep > 0 && options->split_mb == 0)
        args_error(args, "--max-files: there is one file only without --split-mb");
    else if (options->all && options->others.has_channel)
        args_error(args, "--channel: --all records all channels");
    else {
        options->parts.path = args->operands[0];
        options->parts.part_bytes = (int64_t) (options->split_mb * (1 << 20));
        return ARGS_RUN;
    }
    return ARGS_USAGE;
}

/* ---- Messages -------------------------------------------------------------------------------- */

/* Writes an event with the time of the newest message. */
static bool write_event(struct recording *recording, const char *channel, const void *bytes,
                        size_t size)
{
    if (recording->error)
        return false;
    if (log_append(recording->parts.writer, recording->utime, channel, strlen(channel), bytes,
                   size)) {
        recording->events++;
        return true;
    }
    recording->error = errno;
    return false;
}

static bool write_own(void *user, enum log_kind kind, const void *bytes, size_t size)
{
    struct recording *recording = user;
    return write_event(recording, recording->channels.name[kind], bytes, size);
}

/* Begins a new file if there is no space for the message and the definitions that must precede it
 * in its file, and writes these. */
static bool prepare(struct recording *recording, size_t channel_length, size_t size)
{
    const long number = recording->parts.number;
    const int64_t bytes =
        log_event_bytes(channel_length, size) + (int64_t) record_bodies_needed(recording->bodies);
    if (!log_parts_prepare(&recording->parts, bytes)) {
        recording->error = errno;
        return false;
    }
    return (recording->parts.number == number ||
            record_bodies_begin_file(recording->bodies, recording->utime, write_own, recording)) &&
           record_bodies_define(recording->bodies, write_own, recording);
}

static void on_message(void *user, const struct bus_message *message)
{
    struct recording *recording = user;
    const struct log_event event = {.channel = message->channel,
                                    .channel_length = strlen(message->channel)};
    const enum log_kind kind = log_kind_of(&recording->channels, &event);
    if (recording->enough || recording->error ||
        (kind == LOG_OTHER &&
         !log_choice_has_channel(&recording->options->others, message->channel)))
        return;
    const char *wrong = record_bodies_read(recording->bodies, kind, message->bytes, message->size);
    const enum record_bodies_owner owner = record_bodies_owner(recording->bodies);
    recording->utime = message->utime;
    if (owner == RECORD_OTHERS) {
        recording->received[kind]++;
        recording->malformed += wrong != NULL;
    }
    if (owner == RECORD_OWN || !prepare(recording, event.channel_length, message->size) ||
        !write_event(recording, message->channel, message->bytes, message->size))
        return;
    record_bodies_keep(recording->bodies);
    if (owner == RECORD_OTHERS)
        recording->enough = ++recording->messages == recording->options->count;
}

/* ---- Recording ------------------------------------------------------------------------------- */

static const int64_t line_ns = 250000000;

static bool bus_failed(void)
{
    complain("the bus has failed: %s", strerror(errno));
    return false;
}

/* Waits for messages until a time or a signal, records them, and passes them to the system. Ends
 * the recording if another program has deleted or truncated the file: what follows could name
 * bodies that its beginning defined. */
static bool step(struct recording *recording, int signals, int64_t until_ns)
{
    const int64_t left_ns = until_ns - clock_ns();
    if (fmb_client_raw_step(recording->client, signals, left_ns > 0 ? 1e-9 * (double) left_ns : 0) <
        0)
        return false;
    if (!recording->error &&
        (!log_check(recording->parts.writer) || !log_flush(recording->parts.writer)))
        recording->error = errno;
    return true;
}

/* Records until the recording is complete, the log fails, or a signal arrives. Returns false if the
 * bus has failed, which was reported: a request that cannot be sent is followed by a step that
 * fails. */
static bool run(struct recording *recording, int signals)
{
    const double duration = recording->options->duration;
    const int64_t end_ns =
        duration > 0 ? recording->begin_ns + (int64_t) (1e9 * duration) : INT64_MAX;
    int64_t now_ns = recording->begin_ns, line_at_ns = now_ns;
    struct pollfd signal = {.fd = signals, .events = POLLIN};
    unsigned char request[QUERY_BYTES_MAX];
    char text[3][NUMBER_TEXT_MAX];
    while (!recording->enough && !recording->error && now_ns < end_ns) {
        const size_t size = record_bodies_request(recording->bodies, now_ns, request);
        if (size > 0)
            fmb_client_raw_send(recording->client, FMB_CLIENT_DEFINITION, request, size,
                                sizeof request, record_bodies_take_result, recording->bodies);
        const int64_t due_ns = record_bodies_due(recording->bodies);
        if (!step(recording, signals, clock_earlier(clock_earlier(due_ns, end_ns), line_at_ns)))
            return bus_failed();
        if (poll(&signal, 1, 0) > 0)
            return true;
        now_ns = clock_ns();
        if (now_ns < line_at_ns)
            continue;
        line_at_ns = now_ns + line_ns;
        if (stderr_ready())
            progress_show(
                "%s messages, %s MB, %s lost", number_grouped(recording->messages, text[0]),
                number_grouped(log_parts_written(&recording->parts) / 1000000, text[1]),
                number_grouped((int64_t) fmb_client_raw_bus_counts(recording->client).dropped,
                               text[2]));
    }
    return true;
}

/* Receives the messages that are under way at the end: until a message arrives that was sent later,
 * or none arrives for 20 ms, but for a second at most. */
static bool receive_remaining(struct recording *recording)
{
    const int64_t quiet_ns = 20000000, begin_utime = clock_utime(), begin_ns = clock_ns();
    int64_t now_ns = begin_ns, until_ns = now_ns + quiet_ns;
    uint64_t received = 0;
    while (!recording->enough && !recording->error && recording->utime <= begin_utime &&
           now_ns < until_ns) {
        if (!step(recording, -1, until_ns))
            return bus_failed();
        const uint64_t before = received;
        received = fmb_client_raw_bus_counts(recording->client).received;
        now_ns = clock_ns();
        if (received != before)
            until_ns = clock_earlier(now_ns + quiet_ns, begin_ns + 1000000000);
    }
    return true;
}

/* ---- The report at the end ------------------------------------------------------------------- */

static void write_files(struct json_writer *json, const struct log_parts *parts)
{
    json_begin(json, "files", '[');
    if (parts->options.part_bytes == 0)
        json_string(json, NULL, parts->options.path);
    else
        for (long number = parts->first; number <= parts->number; number++) {
            char *name = log_parts_name(parts->options.path, number);
            json_string(json, NULL, name ? name : "");
            free(name);
        }
    json_end(json, ']');
}

static void report_json(const struct recording *recording)
{
    struct json_writer json = json_object(stdout);
    write_files(&json, &recording->parts);
    json_integer(&json, "events", recording->events);
    json_integer(&json, "bytes", recording->bytes);
    json_number(&json, "seconds", round(recording->seconds * 1e3) / 1e3);
    json_begin(&json, "received", '{');
    for (int kind = 0; kind < LOG_KINDS; kind++)
        json_integer(&json, log_kind_name[kind].json, recording->received[kind]);
    json_end(&json, '}');
    json_integer(&json, "malformed", recording->malformed);
    json_integer(&json, "lost", (int64_t) recording->of_bus.dropped);
    json_integer(&json, "skipped", recording->of_bodies.skipped);
    json_integer(&json, "defined_bodies", recording->of_bodies.defined);
    json_integer(&json, "dropped_bodies", recording->of_bodies.dropped);
    json_integer(&json, "unresolved_handles", recording->of_bodies.unresolved);
    json_integer(&json, "receive_buffer", recording->of_bus.receive_buffer);
    json_object_end(&json);
}

static void report_text(const struct recording *recording)
{
    char events[NUMBER_TEXT_MAX], bytes[NUMBER_TEXT_MAX];
    const struct log_parts *parts = &recording->parts;
    escape_text(stdout, parts->options.path);
    if (parts->options.part_bytes > 0)
        printf(".%03ld", parts->first);
    if (parts->first < parts->number)
        printf(" to .%03ld", parts->number);
    printf(": %s messages in %.1f s, %s bytes\n", number_grouped(recording->events, events),
           recording->seconds, number_grouped(recording->bytes, bytes));
    for (int kind = 0; kind < LOG_KINDS; kind++)
        if (recording->received[kind] > 0 || kind <= LOG_STATUS)
            number_print(log_kind_name[kind].text, recording->received[kind]);
    if (recording->malformed > 0)
        number_print("malformed", recording->malformed);
    if (recording->of_bodies.defined > 0)
        number_print("bodies defined", recording->of_bodies.defined);
    number_print("lost", (int64_t) recording->of_bus.dropped);
}

/* Reports what is missing, if anything, in one line. */
static void report_losses(const struct recording *recording)
{
    char text[4][NUMBER_TEXT_MAX];
    const struct record_bodies_counts *bodies = &recording->of_bodies;
    if (recording->of_bus.dropped > 0 || bodies->skipped > 0 || bodies->unresolved > 0)
        complain(
            "lost: %s datagrams that the kernel dropped (receive buffer of %s bytes), %s queries "
            "by their sequence numbers, bodies of %s handles",
            number_grouped((int64_t) recording->of_bus.dropped, text[0]),
            number_grouped(recording->of_bus.receive_buffer, text[1]),
            number_grouped(bodies->skipped, text[2]), number_grouped(bodies->unresolved, text[3]));
}

/* ---- Begin and end --------------------------------------------------------------------------- */

/* Reports a bus without a service: neither a heartbeat, which is sent once a second, nor a result
 * was received. */
static void report_no_service(const struct recording *recording)
{
    const int64_t *received = recording->received;
    if (received[LOG_STATUS] + received[LOG_PAIR_RESULT] + received[LOG_SCENE_RESULT] > 0)
        return;
    complain("no heartbeat on channel %sFMB_STATUS of %s within %.1f s", recording->bus.prefix,
             args_bus_name(&recording->bus), recording->seconds);
    args_advise_service(&recording->bus, "");
}

static int end_of_recording(struct recording *recording, bool good)
{
    const int64_t end_ns = clock_ns();
    const int error = log_parts_finish(&recording->parts);
    if (!recording->error)
        recording->error = error;
    recording->bytes = log_parts_written(&recording->parts);
    recording->seconds = 1e-9 * (double) (end_ns - recording->begin_ns);
    recording->of_bodies = record_bodies_counts(recording->bodies);
    recording->of_bus = fmb_client_raw_bus_counts(recording->client);
    if (recording->error)
        output_complain(recording->parts.name, recording->error);
    report_losses(recording);
    report_no_service(recording);
    (recording->options->json ? report_json : report_text)(recording);
    return output_flush() && !recording->error && good ? ARGS_ANSWERED : ARGS_FAILED;
}

/* With SIGXFSZ ignored, a file that may not grow is an error. */
static int record(struct recording *recording, int signals)
{
    signal(SIGXFSZ, SIG_IGN);
    recording->bodies = record_bodies_open(fmb_client_raw_id(recording->client));
    recording->begin_ns = clock_ns();
    complain("recording to %s, with a receive buffer of %ld bytes", recording->parts.name,
             fmb_client_raw_bus_counts(recording->client).receive_buffer);
    progress_begin("messages");
    const bool good = run(recording, signals) && receive_remaining(recording);
    progress_end();
    const int code = end_of_recording(recording, good);
    record_bodies_close(recording->bodies);
    return code;
}

/* To be called with the bus open: messages wait in its receive buffer. */
static int record_from_bus(struct recording *recording)
{
    int code = ARGS_FAILED;
    const int signals = signals_open();
    if (signals < 0) {
        perror("fmb: signals");
    } else if (!log_parts_open(&recording->options->parts, &recording->parts)) {
        output_complain(
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

static bool open_bus(struct recording *recording, const struct args_bus *args)
{
    const bool others = recording->options->all || recording->options->others.has_channel;
    recording->bus = *args;
    recording->channels = log_channels(args->prefix);
    recording->client = args_open_client(args, (struct fmb_client_options){0});
    if (!recording->client)
        return false;
    const bool good = fmb_client_raw_listen(recording->client, others, on_message, recording);
    if (!good)
        complain("%s", fmb_client_why(recording->client));
    return good;
}

int cmd_record(int argc, char **argv)
{
    static struct recording recording;
    struct record_options options = {.others = log_choice_all()};
    const struct args_option own[] = {
        {"force", ARGS_FLAG, .out = &options.parts.force},
        {"json", ARGS_FLAG, .out = &options.json},
        {"duration", ARGS_NUMBER, &options.duration, .low = 0.001, .high = 1e8},
        {"count", ARGS_INTEGER, &options.count, .low = 1, .high = 1e12},
        {"split-mb", ARGS_NUMBER, &options.split_mb, .low = 0.001, .high = 1e6},
        {"max-files", ARGS_INTEGER, &options.parts.keep, .low = 1, .high = 1e6},
        {"channel", ARGS_OTHER, &options.others, .take = log_choice_take_channel},
        {"all", ARGS_FLAG, .out = &options.all},
        {.name = NULL},
    };
    struct args args = {"record", usage, own, .operand = "FILE", .operands_max = 1};
    recording.options = &options;
    int code = args_parse(&args, argc, argv);
    if (code == ARGS_RUN)
        code = complete(&args, &options);
    if (code == ARGS_RUN)
        code = open_bus(&recording, &args.bus) ? record_from_bus(&recording) : ARGS_FAILED;
    fmb_client_close(recording.client);
    log_choice_clear(&options.others);
    return code;
}
