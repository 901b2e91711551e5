#include "log_info.h"

#include "cursor.h"
#include "escape.h"
#include "json_write.h"
#include "number.h"
#include "wire_type.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MICROSECONDS = 1000000 };

/* From the first to the last event, microseconds; does not overflow. */
static uint64_t span_of(const struct log_tally *tally)
{
    return (uint64_t) tally->end - (uint64_t) tally->begin;
}

/* Events a second. The first event does not count: time begins with it. */
static double rate_of(const struct log_tally *tally)
{
    return (double) (tally->events - 1) / (1e-6 * (double) span_of(tally));
}

enum { TYPE_TEXT_MAX = 32 };

/* The name of the type, or its fingerprint; NULL: none. */
static const char *type_text(struct log_type type, char text[TYPE_TEXT_MAX])
{
    const char *name = type.known ? wire_type_name(type.fingerprint) : NULL;
    if (!type.known || name)
        return name;
    snprintf(text, TYPE_TEXT_MAX, "0x%016" PRIx64, (uint64_t) type.fingerprint);
    return text;
}

/* ---- For people ------------------------------------------------------------------------------ */

enum { CHANNEL, TYPE, EVENTS, BYTES, LEAST, MOST, FIRST, LAST, COLUMNS };

/* Longer channel names are truncated. LCM publishes names of at most 63 characters. */
enum { CELL_MAX = 63 + sizeof "\\x00..." };

struct table_line {
    char cell[COLUMNS][CELL_MAX];
};

/* Writes bytes that are not printable, and backslashes, as \xNN. */
static void write_channel(const struct log_row *row, char out[CELL_MAX])
{
    size_t used = 0, i = 0;
    for (; i < row->channel_length && used + strlen("\\x00...") < CELL_MAX; i++) {
        const unsigned char byte = (unsigned char) row->channel[i];
        const bool plain = cursor_is_printable(byte) && byte != '\\';
        used += (size_t) sprintf(out + used, plain ? "%c" : "\\x%02x", byte);
    }
    strcpy(out + used, i < row->channel_length ? "..." : "");
}

/* Seconds since the beginning of the log: "956.022 s". */
static void write_seconds(int64_t begin, int64_t utime, char out[CELL_MAX])
{
    const uint64_t span = (uint64_t) utime - (uint64_t) begin;
    snprintf(out, CELL_MAX, "%" PRIu64 ".%03" PRIu64 " s", span / MICROSECONDS,
             span % MICROSECONDS / 1000);
}

static void write_tally(const struct log_tally *tally, int64_t begin, struct table_line *out)
{
    number_grouped(tally->events, out->cell[EVENTS]);
    number_grouped(tally->bytes, out->cell[BYTES]);
    number_grouped((int64_t) tally->least, out->cell[LEAST]);
    number_grouped((int64_t) tally->most, out->cell[MOST]);
    write_seconds(begin, tally->begin, out->cell[FIRST]);
    write_seconds(begin, tally->end, out->cell[LAST]);
}

static void print_channels(FILE *out, const struct log_info *info)
{
    static const struct table_line heading = {
        {"channel", "type", "events", "bytes", "least", "most", "first", "last"}};
    const int count = 1 + (int) HASH_COUNT(info->rows);
    struct table_line *line = allocate((size_t) count, sizeof *line), *next = line;
    int width[COLUMNS] = {0};
    *next++ = heading;
    for (const struct log_row *row = info->rows; row; row = row->hh.next, next++) {
        char text[TYPE_TEXT_MAX];
        const char *type = type_text(row->type, text);
        write_channel(row, next->cell[CHANNEL]);
        strcpy(next->cell[TYPE], type ? type : "(too short)");
        write_tally(&row->tally, info->all.begin, next);
    }
    for (int i = 0; i < count * COLUMNS; i++) {
        const int length = (int) strlen(line[i / COLUMNS].cell[i % COLUMNS]);
        width[i % COLUMNS] = length > width[i % COLUMNS] ? length : width[i % COLUMNS];
    }
    for (int i = 0; i < count; i++) {
        for (int column = 0; column < COLUMNS; column++)
            fprintf(out, "  %*s", column <= TYPE ? -width[column] : width[column],
                    line[i].cell[column]);
        putc('\n', out);
    }
    free(line);
}

enum { NAME_LINES = 100 };

static void print_names(FILE *out, struct body_names *names)
{
    char text[NUMBER_TEXT_MAX];
    const int32_t count = body_names_count(names);
    const struct body_name *name = body_names_sorted(names);
    if (count > 0)
        fputs("  names:\n", out);
    for (int i = 0; name && i < NAME_LINES; i++, name = name->hh.next) {
        fprintf(out, "    client %" PRId64 ", body %" PRId64 ": ", name->key.client_id,
                name->key.body_id);
        escape_text(out, name->name);
        putc('\n', out);
    }
    if (count > NAME_LINES)
        fprintf(out, "    and %s more\n", number_grouped(count - NAME_LINES, text));
}

static void print_time(FILE *out, const char *name, int64_t utime)
{
    char text[64];
    struct tm parts;
    const time_t seconds = (time_t) (utime / MICROSECONDS - (utime % MICROSECONDS < 0));
    const int64_t part = utime % MICROSECONDS + (utime % MICROSECONDS < 0 ? MICROSECONDS : 0);
    if (!gmtime_r(&seconds, &parts) || strftime(text, sizeof text, "%F %T", &parts) == 0)
        snprintf(text, sizeof text, "%" PRId64 " s since 1970", (int64_t) seconds);
    fprintf(out, "  %-5s %s.%06" PRId64 " UTC\n", name, text, part);
}

static void print_rate(FILE *out, double rate)
{
    char text[NUMBER_TEXT_MAX];
    const bool large = rate >= 1000 && rate < 1e15;
    fprintf(out, ", %s events a second",
            large ? number_grouped((int64_t) rate, text) : number_short(rate, text));
}

static void print_span(FILE *out, const struct log_info *info)
{
    const uint64_t span = span_of(&info->all);
    print_time(out, "from", info->all.begin);
    print_time(out, "to", info->all.end);
    fprintf(out, "  %" PRIu64 ".%06" PRIu64 " s", span / MICROSECONDS, span % MICROSECONDS);
    if (span > 0)
        print_rate(out, rate_of(&info->all));
    if (info->backward > 0) {
        fputs("; time goes back ", out);
        number_count(out, info->backward, "time", "times");
    }
    putc('\n', out);
}

enum { DAMAGE_LINES = 20 };

static void print_damage(FILE *out, const struct log_info *info)
{
    char offset[NUMBER_TEXT_MAX];
    fputs("  damage: ", out);
    number_count(out, info->damages, "place", "places");
    fputs(", ", out);
    number_count(out, info->damaged, "byte", "bytes");
    putc('\n', out);
    for (int64_t i = 0; i < info->damages && i < DAMAGE_LINES; i++) {
        fprintf(out, "    at %s, ", number_grouped(info->damage[i].offset, offset));
        number_count(out, info->damage[i].length, "byte", "bytes");
        fprintf(out, ": %s\n", info->damage[i].what);
    }
    if (info->damages > DAMAGE_LINES)
        fprintf(out, "    and %s more\n", number_grouped(info->damages - DAMAGE_LINES, offset));
}

void log_report_text(FILE *out, const struct log_report *report)
{
    const struct log_info *info = report->info;
    escape_text(out, report->path);
    fputs(": ", out);
    if (report->size == 0) {
        fputs("empty, a log of no events\n", out);
        return;
    }
    number_count(out, report->size, "byte", "bytes");
    fputs(", ", out);
    number_count(out, info->all.events, "event", "events");
    putc('\n', out);
    if (info->all.events > 0) {
        print_span(out, info);
        print_channels(out, info);
        print_names(out, info->names);
    }
    if (info->damages > 0)
        print_damage(out, info);
    if (report->error)
        fprintf(out, "  not read to its end: %s\n", report->error);
    else if (info->damages == 0)
        fputs("  no damage\n", out);
}

/* ---- For programs ---------------------------------------------------------------------------- */

static void write_times(struct json_writer *json, const struct log_tally *tally)
{
    if (tally->events > 0) {
        json_integer(json, "begin", tally->begin);
        json_integer(json, "end", tally->end);
    } else {
        json_null(json, "begin");
        json_null(json, "end");
    }
}

static void write_row(struct json_writer *json, const struct log_row *row)
{
    char text[TYPE_TEXT_MAX];
    json_begin(json, NULL, '{');
    json_bytes(json, "channel", row->channel, row->channel_length);
    json_string(json, "type", type_text(row->type, text));
    json_integer(json, "events", row->tally.events);
    json_integer(json, "bytes", row->tally.bytes);
    json_integer(json, "least", (int64_t) row->tally.least);
    json_integer(json, "most", (int64_t) row->tally.most);
    write_times(json, &row->tally);
    json_end(json, '}');
}

static void write_channels(struct json_writer *json, const struct log_info *info)
{
    json_begin(json, "channels", '[');
    for (const struct log_row *row = info->rows; row; row = row->hh.next)
        write_row(json, row);
    json_end(json, ']');
}

static void write_names(struct json_writer *json, struct body_names *names)
{
    const struct body_name *name = body_names_sorted(names);
    if (!name)
        return;
    json_begin(json, "names", '[');
    for (; name; name = name->hh.next) {
        json_begin(json, NULL, '{');
        json_integer(json, "client_id", name->key.client_id);
        json_integer(json, "body_id", name->key.body_id);
        json_string(json, "name", name->name);
        json_end(json, '}');
    }
    json_end(json, ']');
}

static void write_damage(struct json_writer *json, const struct log_info *info)
{
    json_begin(json, "damage", '{');
    json_integer(json, "places", info->damages);
    json_integer(json, "bytes", info->damaged);
    json_begin(json, "first", '[');
    for (int64_t i = 0; i < info->damages && i < LOG_INFO_DAMAGES_MAX; i++) {
        json_begin(json, NULL, '{');
        json_integer(json, "offset", info->damage[i].offset);
        json_integer(json, "length", info->damage[i].length);
        json_string(json, "what", info->damage[i].what);
        json_end(json, '}');
    }
    json_end(json, ']');
    json_end(json, '}');
}

void log_report_json(FILE *out, const struct log_report *report)
{
    const struct log_tally *all = &report->info->all;
    struct json_writer json = json_object(out);
    json_string(&json, "log", report->path);
    json_integer(&json, "size", report->size);
    json_integer(&json, "events", all->events);
    json_integer(&json, "bytes", all->bytes);
    write_times(&json, all);
    json_number(&json, "rate", span_of(all) > 0 ? rate_of(all) : NAN);
    json_integer(&json, "backward", report->info->backward);
    write_channels(&json, report->info);
    write_names(&json, report->info->names);
    write_damage(&json, report->info);
    if (report->error)
        json_string(&json, "error", report->error);
    json_object_end(&json);
}
