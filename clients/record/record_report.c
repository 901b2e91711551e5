#include "record_report.h"

#include "complain.h"
#include "escape.h"
#include "json_write.h"
#include "number.h"
#include "process.h"
#include "utf8.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <unistd.h>

static const struct {
    const char *json, *text;
} names[LOG_KINDS] = {
    [LOG_PAIR_QUERY] = {"pair_queries", "pair queries"},
    [LOG_PAIR_RESULT] = {"pair_results", "pair results"},
    [LOG_SCENE_QUERY] = {"scene_queries", "scene queries"},
    [LOG_SCENE_RESULT] = {"scene_results", "scene results"},
    [LOG_STATUS] = {"heartbeats", "heartbeats"},
    [LOG_DEFINITION_QUERY] = {"definition_queries", "definition queries"},
    [LOG_DEFINITION] = {"definitions", "definitions"},
    [LOG_NAMES] = {"names", "names"},
    [LOG_OTHER] = {"others", "others"},
};

/* ---- For programs ---------------------------------------------------------------------------- */

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

void record_report_json(const struct recorded *recorded, const struct log_parts *parts)
{
    struct json_writer json = json_object(stdout);
    write_files(&json, parts);
    json_integer(&json, "events", recorded->events);
    json_integer(&json, "bytes", recorded->bytes);
    json_number(&json, "seconds", round(recorded->seconds * 1e3) / 1e3);
    json_begin(&json, "received", '{');
    for (int kind = 0; kind < LOG_KINDS; kind++)
        json_integer(&json, names[kind].json, recorded->received[kind]);
    json_end(&json, '}');
    json_integer(&json, "malformed", recorded->malformed);
    json_integer(&json, "lost", (int64_t) recorded->bus.dropped);
    json_integer(&json, "skipped", recorded->bodies.skipped);
    json_integer(&json, "defined_bodies", recorded->bodies.defined);
    json_integer(&json, "dropped_bodies", recorded->bodies.dropped);
    json_integer(&json, "unresolved_handles", recorded->bodies.unresolved);
    json_integer(&json, "receive_buffer", recorded->bus.receive_buffer);
    json_object_end(&json);
}

/* ---- For people ------------------------------------------------------------------------------ */

static void print_where(const struct log_parts *parts)
{
    const char *path = parts->options.path;
    escape(stdout, ESCAPE_TERMINAL, path, strlen(path));
    if (parts->options.part_bytes == 0)
        printf(": ");
    else if (parts->first == parts->number)
        printf(".%03ld: ", parts->number);
    else
        printf(".%03ld to .%03ld: ", parts->first, parts->number);
}

void record_report_text(const struct recorded *recorded, const struct log_parts *parts)
{
    char events[NUMBER_TEXT_MAX], bytes[NUMBER_TEXT_MAX];
    print_where(parts);
    printf("%s messages in %.1f s, %s bytes\n", number_grouped(recorded->events, events),
           recorded->seconds, number_grouped(recorded->bytes, bytes));
    for (int kind = 0; kind < LOG_KINDS; kind++)
        if (recorded->received[kind] > 0 || kind <= LOG_STATUS)
            number_print(names[kind].text, recorded->received[kind]);
    if (recorded->malformed > 0)
        number_print("malformed", recorded->malformed);
    if (recorded->bodies.defined > 0)
        number_print("bodies defined", recorded->bodies.defined);
    number_print("lost", (int64_t) recorded->bus.dropped);
}

/* ---- Losses ---------------------------------------------------------------------------------- */

void record_report_losses(const struct recorded *recorded)
{
    char text[4][NUMBER_TEXT_MAX];
    const struct record_bodies_counts *bodies = &recorded->bodies;
    if (recorded->bus.dropped > 0 || bodies->skipped > 0 || bodies->unresolved > 0)
        complain(
            "lost: %s datagrams that the kernel dropped (receive buffer of %s bytes), %s queries "
            "by their sequence numbers, bodies of %s handles",
            number_grouped((int64_t) recorded->bus.dropped, text[0]),
            number_grouped(recorded->bus.receive_buffer, text[1]),
            number_grouped(bodies->skipped, text[2]), number_grouped(bodies->unresolved, text[3]));
}

/* ---- The progress line
 * --------------------------------------------------------------------------- */

static const int64_t every_ns = 250000000;

enum { LINE_MAX_CHARACTERS = 512, USUAL_WIDTH = 80 };

struct record_line record_line_begin(int64_t now_ns)
{
    return (struct record_line){.enabled = isatty(STDERR_FILENO), .at_ns = now_ns};
}

static int terminal_width(void)
{
    struct winsize size;
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col
                                                                           : USUAL_WIDTH;
}

/* Shortened to the width of the terminal: a line that wraps could not be replaced. */
static void show(const char *text)
{
    fprintf(stderr, "\r%.*s\033[K", terminal_width() - 1, text);
    fflush(stderr);
}

void record_line_show(struct record_line *line, int64_t now_ns, const char *path, int64_t events,
                      int64_t bytes, int64_t lost)
{
    const int64_t passed = now_ns - line->at_ns;
    if (!line->enabled || passed < every_ns || !stderr_ready())
        return;
    char text[LINE_MAX_CHARACTERS], number[4][NUMBER_TEXT_MAX];
    const double seconds = 1e-9 * (double) passed;
    snprintf(text, sizeof text, "fmb: %s messages, %s/s, %.2f MB/s, %s lost, %s MB: %s",
             number_grouped(events, number[0]),
             number_grouped((int64_t) ((double) (events - line->events) / seconds), number[1]),
             1e-6 * (double) (bytes - line->bytes) / seconds, number_grouped(lost, number[2]),
             number_grouped(bytes / 1000000, number[3]), utf8_is_text(path) ? path : "?");
    show(text);
    *line = (struct record_line){true, true, now_ns, events, bytes};
}

void record_line_end(struct record_line *line)
{
    if (line->shown)
        fputs("\r\033[K", stderr);
    line->shown = false;
}
