#include "record_report.h"

#include "complain.h"
#include "escape.h"
#include "json_write.h"
#include "number.h"
#include "process.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <stdlib.h>
#include <unistd.h>

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
        json_integer(&json, log_kind_name[kind].json, recorded->received[kind]);
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
    escape_text(stdout, path);
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
            number_print(log_kind_name[kind].text, recorded->received[kind]);
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

/* ---- The progress line ----------------------------------------------------------------------- */

/* Shorter than any terminal is wide: a line that wraps could not be replaced. */
void record_line_show(bool *shown, int64_t events, int64_t bytes, int64_t lost)
{
    char text[3][NUMBER_TEXT_MAX];
    if (!isatty(STDERR_FILENO) || !stderr_ready())
        return;
    *shown = true;
    fprintf(stderr, "\rfmb: %s messages, %s MB, %s lost\033[K", number_grouped(events, text[0]),
            number_grouped(bytes / 1000000, text[1]), number_grouped(lost, text[2]));
    fflush(stderr);
}

void record_line_end(bool *shown)
{
    if (*shown)
        fputs("\r\033[K", stderr);
    *shown = false;
}
