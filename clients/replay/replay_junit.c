#include "replay_output.h"

#include "number.h"

#include <glib.h>
#include <inttypes.h>
#include <string.h>

/* Lines in a failed test case. */
enum { LINES_MAX = 100 };

/* The report, and the case that is being written. */
struct junit {
    FILE *out;
    const struct replay_options *options;
    int64_t first_utime;
    int log, channel, lines;
    const char *label; /* of the scenes of the case; "": they have none */
};

static void write_xml(FILE *out, const char *text)
{
    escape(out, ESCAPE_XML, text, strlen(text));
}

static void begin_case(struct junit *junit, const char *name)
{
    fputs("    <testcase classname=\"", junit->out);
    write_xml(junit->out, junit->options->log[junit->log]);
    fputs("\" name=\"", junit->out);
    write_xml(junit->out, name);
    fputs("\">\n", junit->out);
}

static void write_line(void *user, const struct difference *difference)
{
    struct junit *junit = user;
    if (difference->place.log != junit->log ||
        tally_channel_of(difference->query_kind) != junit->channel ||
        strcmp(difference->label, junit->label) != 0 || junit->lines++ >= LINES_MAX)
        return;
    replay_line(junit->out, ESCAPE_XML, difference, junit->options->names, NULL,
                junit->first_utime);
}

/* Writes a case: the scenes with a label, or the queries of a channel without one. */
static void write_queries(struct junit *junit, struct listing *list, const char *label,
                          const struct tally_channel *channel)
{
    FILE *out = junit->out;
    int64_t differences = 0;
    for (int kind = 0; kind < DIFFERENT_KINDS; kind++)
        differences += channel->differences[kind];
    junit->label = label;
    begin_case(junit, *label ? label : tally_channel_name[junit->channel]);
    if (channel->outcome[REPLAY_DIFFERENT] > 0) {
        fprintf(out, "      <failure message=\"%" PRId64 " of ",
                channel->outcome[REPLAY_DIFFERENT]);
        number_count(out, channel->queries, "query is", "queries are");
        fputs(" answered differently: ", out);
        number_count(out, differences, "difference\">", "differences\">");
        junit->lines = 0;
        listing_each(list, write_line, junit);
        fputs("</failure>\n", out);
    }
    fputs("      <system-out>", out);
    for (int i = 0; i < TALLY_COUNTS; i++)
        if (tally_count[i].junit)
            fprintf(out, "%s%" PRId64, tally_count[i].junit, tally_counts(channel)[i]);
    fputs("</system-out>\n    </testcase>\n", out);
}

static void write_log(struct junit *junit, struct listing *list, struct tally *tally)
{
    FILE *out = junit->out;
    const struct tally_channel both = tally_both(tally);
    const struct tally_bus *bus = &tally->bus;
    const int64_t left_out = both.outcome[REPLAY_UNDEFINED] + both.outcome[REPLAY_NOT_HELD];
    const bool is_whole = tally->damages == 0 && tally_unreadable(tally) == 0 &&
                          both.contradictions == 0 && both.left_over == 0 && left_out == 0;
    const bool ended_early = bus->used && bus->end != TALLY_NO_END;
    int failures = tally->channel[TALLY_PAIRS].outcome[REPLAY_DIFFERENT] > 0;
    tally_label(tally, ""); /* the case of scenes without a label comes first, and always */
    GList *labels = g_list_sort(g_hash_table_get_keys(tally->labels), (GCompareFunc) g_strcmp0);
    for (const GList *at = labels; at; at = at->next)
        failures += tally_label(tally, at->data)->outcome[REPLAY_DIFFERENT] > 0;
    fputs("  <testsuite name=\"", out);
    write_xml(out, junit->options->log[junit->log]);
    fprintf(out, "\" tests=\"%d\" failures=\"%d\" errors=\"%d\">\n",
            2 + (int) g_list_length(labels) + (int) bus->used, failures, !is_whole + ended_early);
    junit->channel = TALLY_PAIRS;
    write_queries(junit, list, "", &tally->channel[TALLY_PAIRS]);
    junit->channel = TALLY_SCENES;
    for (const GList *at = labels; at; at = at->next)
        write_queries(junit, list, at->data, tally_label(tally, at->data));
    g_list_free(labels);
    begin_case(junit, "the log is whole");
    if (!is_whole) {
        fputs("      <error message=\"", out);
        number_count(out, tally->damages, "damaged place, ", "damaged places, ");
        number_count(out, tally_unreadable(tally), "message that cannot be read, ",
                     "messages that cannot be read, ");
        number_count(out, both.contradictions, "result that contradicts an earlier one, ",
                     "results that contradict earlier ones, ");
        number_count(out, left_out, "query left out, ", "queries left out, ");
        number_count(out, both.left_over, "query in one recording only\"/>\n",
                     "queries in one recording only\"/>\n");
    }
    fputs("    </testcase>\n", out);
    if (bus->used)
        begin_case(junit, "the service answered all");
    if (ended_early) {
        fputs("      <error message=\"it answered ", out);
        number_count(out, bus->answered, "query\"/>\n", "queries\"/>\n");
    }
    fputs(bus->used ? "    </testcase>\n  </testsuite>\n" : "  </testsuite>\n", out);
}

void replay_junit(FILE *out, const struct replay_options *options, struct listing *list,
                  struct tally *tally, int64_t first_utime)
{
    struct junit junit = {.out = out, .options = options, .first_utime = first_utime};
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"fmb replay\">\n", out);
    for (; junit.log < options->log_count; junit.log++)
        write_log(&junit, list, &tally[junit.log]);
    fputs("</testsuites>\n", out);
}
