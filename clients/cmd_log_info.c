/* fmb log info: prints the contents of event logs. Memory grows with the number of channels. */
#include "commands.h"

#include "args.h"
#include "big_endian.h"
#include "complain.h"
#include "escape.h"
#include "json_write.h"
#include "keyed_hash.h"
#include "log_read.h"
#include "number.h"
#include "progress.h"
#include "wire_type.h"

#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const char usage[] =
    "usage: fmb log info [OPTIONS] LOG...\n"
    "\n"
    "Reads event logs and prints for each: its size, the time it covers, its channels\n"
    "with the types, count and size of their messages, and the places that are\n"
    "damaged. A type that does not belong to the service is printed as the\n"
    "fingerprint of its messages. 'fmb log results' prints the recorded results.\n"
    "\n"
    "  --json               one line of JSON for each log, with all times in\n"
    "                       microseconds\n"
    "  -h, --help\n"
    "\n"
    "Exit codes: 0 all logs are intact; 1 one is damaged, and what could be read is\n"
    "printed; 2 wrong usage, or a file that cannot be read or is not a log.\n";

enum { MICROSECONDS = 1000000, DAMAGES_LISTED = 20 };

/* The events of one channel and type. */
struct row {
    UT_hash_handle hh;
    int64_t events, bytes; /* bytes: of the data of all events */
    const char *type;      /* its name, or `text`; NULL: messages of fewer than 8 bytes */
    char text[24];         /* of the fingerprint */
    size_t length;         /* of the channel */
    unsigned char key[];   /* the first 8 bytes of its messages, or fewer; then the channel */
};

/* Bytes of a key before the channel: those of the data, and how many these are. */
enum { TYPE_BYTES = 8 + 1 };

struct info {
    const char *path;
    int64_t size;
    const char *error;     /* why it could not be read to its end; NULL: no error */
    int64_t events, bytes; /* of all rows */
    int64_t begin, end;    /* earliest and latest time, in any order in the log, microseconds */
    int64_t damages, damaged;
    struct log_damage damage[DAMAGES_LISTED]; /* the first ones */
    struct row *rows;                         /* owned */
};

/* ---- Events ---- */

static struct row *row_of(struct info *info, const struct log_event *event)
{
    unsigned char key[TYPE_BYTES + LOG_CHANNEL_MAX] = {0};
    const size_t size = TYPE_BYTES + event->channel_length;
    struct row *row;
    if (event->kept >= 8) {
        memcpy(key, event->data, 8);
        key[8] = 8;
    }
    memcpy(key + TYPE_BYTES, event->channel, event->channel_length);
    HASH_FIND(hh, info->rows, key, size, row);
    if (row)
        return row;
    row = allocate(1, sizeof *row + size);
    memcpy(row->key, key, size);
    row->length = event->channel_length;
    if (event->kept >= 8) {
        const uint64_t fingerprint = big_endian_64(event->data);
        snprintf(row->text, sizeof row->text, "0x%016" PRIx64, fingerprint);
        row->type = wire_type_name((int64_t) fingerprint);
        row->type = row->type ? row->type : row->text;
    }
    HASH_ADD_KEYPTR(hh, info->rows, row->key, size, row);
    return row;
}

static void take_event(struct info *info, const struct log_event *event)
{
    struct row *row = row_of(info, event);
    row->events++;
    row->bytes += (int64_t) event->size;
    info->bytes += (int64_t) event->size;
    if (info->events++ == 0)
        info->begin = info->end = event->utime;
    info->begin = event->utime < info->begin ? event->utime : info->begin;
    info->end = event->utime > info->end ? event->utime : info->end;
}

static void take_damage(struct info *info, const struct log_damage *damage)
{
    if (info->damages < DAMAGES_LISTED)
        info->damage[info->damages] = *damage;
    info->damages++;
    info->damaged += damage->length;
}

/* By channel, then by type. */
static int compare(const struct row *a, const struct row *b)
{
    const size_t both = a->length < b->length ? a->length : b->length;
    const int order = memcmp(a->key + TYPE_BYTES, b->key + TYPE_BYTES, both);
    if (order != 0 || a->length != b->length)
        return order ? order : a->length < b->length ? -1 : 1;
    return memcmp(a->key, b->key, TYPE_BYTES);
}

static void read_all(struct log_reader *reader, struct info *info)
{
    struct log_event event;
    struct log_damage damage;
    enum log_outcome outcome;
    progress_begin("bytes");
    while ((outcome = log_next(reader, &event, &damage)) < LOG_END) {
        if (outcome == LOG_EVENT)
            take_event(info, &event);
        else
            take_damage(info, &damage);
        progress_to(outcome == LOG_EVENT ? event.offset : damage.offset, info->size);
    }
    if (outcome == LOG_FAILED)
        info->error = errno == ENODATA ? "it has become shorter" : strerror(errno);
    progress_end();
    HASH_SORT(info->rows, compare);
}

/* ---- For people ---- */

static void print_channels(const struct info *info)
{
    char events[NUMBER_TEXT_MAX], bytes[NUMBER_TEXT_MAX];
    printf("  %10s %14s  %-27s %s\n", "events", "bytes", "type", "channel");
    for (const struct row *row = info->rows; row; row = row->hh.next) {
        printf("  %10s %14s  %-27s ", number_grouped(row->events, events),
               number_grouped(row->bytes, bytes), row->type ? row->type : "(too short)");
        escape(stdout, ESCAPE_TERMINAL, (const char *) row->key + TYPE_BYTES, row->length);
        putchar('\n');
    }
}

static void print_time(const char *name, int64_t utime)
{
    char text[64];
    struct tm parts;
    const time_t seconds = (time_t) (utime / MICROSECONDS - (utime % MICROSECONDS < 0));
    const int64_t part = utime % MICROSECONDS + (utime % MICROSECONDS < 0 ? MICROSECONDS : 0);
    if (!gmtime_r(&seconds, &parts) || strftime(text, sizeof text, "%F %T", &parts) == 0)
        snprintf(text, sizeof text, "%" PRId64 " s since 1970", (int64_t) seconds);
    printf("  %-5s %s.%06" PRId64 " UTC\n", name, text, part);
}

static void print_damage(const struct info *info)
{
    char text[NUMBER_TEXT_MAX];
    fputs("  damage: ", stdout);
    number_count(stdout, info->damages, "place, ", "places, ");
    number_count(stdout, info->damaged, "byte\n", "bytes\n");
    for (int64_t i = 0; i < info->damages && i < DAMAGES_LISTED; i++) {
        printf("    at %s, ", number_grouped(info->damage[i].offset, text));
        number_count(stdout, info->damage[i].length, "byte", "bytes");
        printf(": %s\n", info->damage[i].what);
    }
    if (info->damages > DAMAGES_LISTED)
        printf("    and %s more\n", number_grouped(info->damages - DAMAGES_LISTED, text));
}

static void print_text(const struct info *info)
{
    escape_text(stdout, info->path);
    fputs(": ", stdout);
    if (info->size == 0) {
        puts("empty, a log of no events");
        return;
    }
    number_count(stdout, info->size, "byte, ", "bytes, ");
    number_count(stdout, info->events, "event\n", "events\n");
    if (info->events > 0) {
        const uint64_t span = (uint64_t) info->end - (uint64_t) info->begin; /* no overflow */
        print_time("from", info->begin);
        print_time("to", info->end);
        printf("  %" PRIu64 ".%06" PRIu64 " s\n", span / MICROSECONDS, span % MICROSECONDS);
        print_channels(info);
    }
    if (info->damages > 0)
        print_damage(info);
    if (info->error)
        printf("  not read to its end: %s\n", info->error);
    else if (info->damages == 0)
        puts("  no damage");
}

/* ---- For programs ---- */

static void write_damage(struct json_writer *json, const struct info *info)
{
    json_begin(json, "damage", '{');
    json_integer(json, "places", info->damages);
    json_integer(json, "bytes", info->damaged);
    json_begin(json, "first", '[');
    for (int64_t i = 0; i < info->damages && i < DAMAGES_LISTED; i++) {
        json_begin(json, NULL, '{');
        json_integer(json, "offset", info->damage[i].offset);
        json_integer(json, "length", info->damage[i].length);
        json_string(json, "what", info->damage[i].what);
        json_end(json, '}');
    }
    json_end(json, ']');
    json_end(json, '}');
}

static void print_json(const struct info *info)
{
    struct json_writer json = json_object(stdout);
    json_string(&json, "log", info->path);
    json_integer(&json, "size", info->size);
    json_integer(&json, "events", info->events);
    json_integer(&json, "bytes", info->bytes);
    if (info->events > 0) {
        json_integer(&json, "begin", info->begin);
        json_integer(&json, "end", info->end);
    }
    json_begin(&json, "channels", '[');
    for (const struct row *row = info->rows; row; row = row->hh.next) {
        json_begin(&json, NULL, '{');
        json_bytes(&json, "channel", (const char *) row->key + TYPE_BYTES, row->length);
        json_string(&json, "type", row->type);
        json_integer(&json, "events", row->events);
        json_integer(&json, "bytes", row->bytes);
        json_end(&json, '}');
    }
    json_end(&json, ']');
    write_damage(&json, info);
    if (info->error)
        json_string(&json, "error", info->error);
    json_object_end(&json);
}

/* ---- The command ---- */

static int refuse(const char *path, const char *why)
{
    fflush(stdout);
    complain("%s: %s", path, why);
    return ARGS_USAGE;
}

static int report(bool json, const struct info *info)
{
    if (!info->error && info->events == 0 && info->size > 0)
        return refuse(info->path, "no event log: there is no event in it");
    (json ? print_json : print_text)(info);
    if (info->error)
        return refuse(info->path, info->error);
    return info->damages > 0 ? ARGS_FAILED : ARGS_ANSWERED;
}

static int run_info(bool json, const char *path)
{
    char why[LOG_WHY_MAX];
    struct log_reader *reader = log_open(path, why);
    if (!reader)
        return refuse(path, why);
    struct info info = {.path = path, .size = log_size(reader)};
    read_all(reader, &info);
    const int code = report(json, &info);
    HASH_FREE(info.rows);
    log_close(reader);
    return code;
}

int cmd_log_info(int argc, char **argv)
{
    bool json = false;
    const struct args_option own[] = {{"json", ARGS_FLAG, .out = &json}, {.name = NULL}};
    struct args args = {
        "log info", usage, own, .operand = "LOG", .operands_min = 1, .operands_max = INT_MAX};
    int code = args_parse(&args, argc, argv);
    if (code != ARGS_RUN)
        return code;
    code = ARGS_ANSWERED;
    for (int i = 0; i < args.operand_count; i++) {
        if (i > 0 && !json)
            putchar('\n');
        const int one = run_info(json, args.operands[i]);
        code = one > code ? one : code;
    }
    return output_flush() || code != ARGS_ANSWERED ? code : ARGS_FAILED;
}
