#include "record_report.h"

#include "number.h"
#include "report.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

/* What the kernel grants where it lets LCM have all that is asked for, bytes; and what to set for
 * that. */
enum { RECEIVE_BUFFER_ENOUGH = 8 << 20, RECEIVE_BUFFER_TO_SET = 4 << 20 };

/* What the system threw away may be the queries and results that are missing, or others. */
int64_t record_lost(const struct tally *tally, int64_t unwritten, int64_t dropped)
{
    const int64_t missing = tally->gaps.missing + answered_missing(&tally->answered);
    return (missing > dropped ? missing : dropped) + unwritten;
}

static int64_t lost(const struct recorded *recorded)
{
    return record_lost(recorded->tally, recorded->unwritten, recorded->dropped);
}

/* ---- For programs ---------------------------------------------------------------------------- */

static void print_files(const struct log_parts *parts)
{
    fputs("\"files\": [", stdout);
    if (parts->options.part_bytes == 0)
        report_string_json(stdout, parts->options.path);
    else
        for (long number = parts->first; number <= parts->number; number++) {
            char *name = log_parts_name(parts->options.path, number);
            fputs(number > parts->first ? ", " : "", stdout);
            report_string_json(stdout, name ? name : "");
            free(name);
        }
    putchar(']');
}

static void print_heard(const struct tally *tally)
{
    fputs(", \"heard\": {", stdout);
    for (int kind = 0; kind < LOG_KINDS; kind++)
        printf("%s\"%s\": %" PRId64, kind ? ", " : "", tally_kind_name((enum log_kind) kind),
               tally->heard[kind]);
    putchar('}');
}

static void print_known(const char *name, int64_t value, bool known)
{
    if (known)
        printf(", \"%s\": %" PRId64, name, value);
    else
        printf(", \"%s\": null", name);
}

void record_report_json(const struct recorded *recorded)
{
    const struct tally *tally = recorded->tally;
    putchar('{');
    print_files(recorded->parts);
    printf(", \"events\": %" PRId64 ", \"bytes\": %" PRId64 ", \"seconds\": %.3f", recorded->events,
           recorded->bytes, recorded->seconds);
    print_heard(tally);
    printf(", \"malformed\": %" PRId64 ", \"lost\": %" PRId64 ", \"queries_missing\": %" PRId64
           ", \"results_missing\": %" PRId64 ", \"unwritten\": %" PRId64,
           tally->malformed, lost(recorded), tally->gaps.missing,
           answered_missing(&tally->answered), recorded->unwritten);
    print_known("dropped", recorded->dropped, recorded->dropped >= 0);
    print_known("receive_buffer", recorded->receive_buffer, recorded->receive_buffer > 0);
    puts("}");
}

/* ---- For people ------------------------------------------------------------------------------ */

static void print_count(const char *name, int64_t count)
{
    char text[NUMBER_TEXT_MAX];
    printf("  %-16s %15s\n", name, number_grouped(count, text));
}

static void print_where(const struct log_parts *parts)
{
    const char *path = parts->options.path;
    if (parts->options.part_bytes == 0)
        printf("%s: ", path);
    else if (parts->first == parts->number)
        printf("%s.%03ld: ", path, parts->number);
    else
        printf("%s.%03ld to .%03ld: ", path, parts->first, parts->number);
}

void record_report_text(const struct recorded *recorded)
{
    static const char *const names[LOG_KINDS] = {"pair queries",  "pair results", "scene queries",
                                                 "scene results", "heartbeats",   "others"};
    char events[NUMBER_TEXT_MAX], bytes[NUMBER_TEXT_MAX];
    print_where(recorded->parts);
    printf("%s messages in %.1f s, %s bytes\n", number_grouped(recorded->events, events),
           recorded->seconds, number_grouped(recorded->bytes, bytes));
    for (int kind = 0; kind < LOG_KINDS; kind++)
        if (recorded->tally->heard[kind] > 0 || kind < LOG_OTHER)
            print_count(names[kind], recorded->tally->heard[kind]);
    if (recorded->tally->malformed > 0)
        print_count("malformed", recorded->tally->malformed);
    print_count("lost", lost(recorded));
}

/* ---- Losses ---------------------------------------------------------------------------------- */

static void say_count(int64_t count, const char *what)
{
    char text[NUMBER_TEXT_MAX];
    if (count > 0)
        fprintf(stderr, "fmb: %s %s\n", number_grouped(count, text), what);
}

static void say_remedy(long receive_buffer)
{
    char text[NUMBER_TEXT_MAX];
    if (receive_buffer > 0 && receive_buffer < RECEIVE_BUFFER_ENOUGH)
        fprintf(stderr,
                "fmb: the receive buffer has %s bytes only; to grant more, run:\n"
                "fmb:   sudo sysctl net.core.rmem_max=%d\n",
                number_grouped(receive_buffer, text), RECEIVE_BUFFER_TO_SET);
    else
        fputs(
            "fmb: this machine was too busy, or a client left numbers out; to be served before\n"
            "fmb: others, run: sudo chrt -f 10 fmb record ...\n",
            stderr);
}

void record_report_losses(const struct recorded *recorded)
{
    const int64_t missing_results = answered_missing(&recorded->tally->answered);
    say_count(recorded->tally->gaps.missing, "queries did not come, by their sequence numbers");
    say_count(missing_results, "results did not come, by the service's count");
    say_count(recorded->dropped, "datagrams found no room in the receive buffer");
    if (lost(recorded) > recorded->unwritten)
        say_remedy(recorded->receive_buffer);
    if (!recorded->error)
        say_count(recorded->unwritten, "messages found no room in memory: the disk was too slow");
}
