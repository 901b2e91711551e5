#include "replay_output.h"

#include "escape.h"

#include <inttypes.h>
#include <string.h>

/* Lines in a failed test case. */
enum { LINES_MAX = 100 };

static void write_xml(FILE *out, const char *text)
{
    escape(out, ESCAPE_XML, text, strlen(text));
}

/* ---- Cases ---- */

static void begin_case(FILE *out, const char *log, const char *name)
{
    fputs("    <testcase classname=\"", out);
    write_xml(out, log);
    fprintf(out, "\" name=\"%s\">\n", name);
}

/* The lines of one case. */
struct lines {
    FILE *out;
    int log, channel, count;
    int64_t first_utime;
};

static void write_line(void *user, const struct located_difference *located)
{
    struct lines *lines = user;
    char line[REPLAY_LINE_MAX];
    if (located->place.log != lines->log || tally_channel_of(located->kind) != lines->channel ||
        lines->count == LINES_MAX)
        return;
    replay_line(located, NULL, lines->first_utime, line);
    write_xml(lines->out, line);
    putc('\n', lines->out);
    lines->count++;
}

static int64_t differences_of(const struct tally_channel *channel)
{
    int64_t sum = 0;
    for (int kind = 0; kind < DIFFERENT_KINDS; kind++)
        sum += channel->differences[kind];
    return sum;
}

static void write_channel(FILE *out, const char *log, int index, int channel_index,
                          struct listing *list, const struct tally_channel *channel,
                          int64_t first_utime)
{
    begin_case(out, log, tally_channel_name[channel_index]);
    if (channel->outcome[REPLAY_DIFFERENT] > 0) {
        fprintf(out,
                "      <failure message=\"%" PRId64 " of %" PRId64
                " queries are answered differently, in %" PRId64 " pairs\">",
                channel->outcome[REPLAY_DIFFERENT], channel->queries, differences_of(channel));
        struct lines lines = {out, index, channel_index, 0, first_utime};
        listing_each(list, write_line, &lines);
        fputs("</failure>\n", out);
    }
    fprintf(out,
            "      <system-out>%" PRId64 " queries: %" PRId64 " same, %" PRId64
            " different, %" PRId64 " busy, %" PRId64 " unknown body, %" PRId64
            " not defined, %" PRId64 " without result</system-out>\n    </testcase>\n",
            channel->queries, channel->outcome[REPLAY_SAME], channel->outcome[REPLAY_DIFFERENT],
            channel->outcome[REPLAY_BUSY], channel->outcome[REPLAY_UNKNOWN],
            channel->outcome[REPLAY_UNDEFINED], channel->outcome[REPLAY_UNRECORDED]);
}

static bool is_whole(const struct tally *tally)
{
    return tally->damages == 0 && tally_unreadable(tally) == 0 &&
           tally_contradictions(tally) == 0 && tally_left_over(tally) == 0;
}

/* Counts of a replay by a live service. */
static bool ended_early(const struct tally *tally)
{
    return tally->bus.used && tally->bus.end != ANSWER_BUS_NO_END;
}

static void write_bus(FILE *out, const char *log, const struct tally *tally)
{
    if (!tally->bus.used)
        return;
    begin_case(out, log, "the service answered all");
    if (ended_early(tally))
        fprintf(out, "      <error message=\"it answered %" PRId64 " queries\"/>\n",
                tally->bus.answered);
    fputs("    </testcase>\n", out);
}

static void write_log(FILE *out, const char *log, int index, struct listing *list,
                      const struct tally *tally, int64_t first_utime)
{
    int failures = 0;
    for (int i = 0; i < TALLY_CHANNELS; i++)
        failures += tally->channel[i].outcome[REPLAY_DIFFERENT] > 0;
    fputs("  <testsuite name=\"", out);
    write_xml(out, log);
    fprintf(out, "\" tests=\"%d\" failures=\"%d\" errors=\"%d\">\n",
            TALLY_CHANNELS + 1 + (int) tally->bus.used, failures,
            !is_whole(tally) + ended_early(tally));
    for (int i = 0; i < TALLY_CHANNELS; i++)
        write_channel(out, log, index, i, list, &tally->channel[i], first_utime);
    begin_case(out, log, "the log is whole");
    if (!is_whole(tally))
        fprintf(out,
                "      <error message=\"%" PRId64 " damaged places, %" PRId64
                " messages that cannot be read, %" PRId64
                " results that contradict earlier ones, %" PRId64
                " queries in one recording only\"/>\n",
                tally->damages, tally_unreadable(tally), tally_contradictions(tally),
                tally_left_over(tally));
    fputs("    </testcase>\n", out);
    write_bus(out, log, tally);
    fputs("  </testsuite>\n", out);
}

void replay_junit(FILE *out, const struct replay_options *options, struct listing *list,
                  const struct tally *tally, int64_t first_utime)
{
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"fmb replay\">\n", out);
    for (int i = 0; i < options->log_count; i++)
        write_log(out, options->log[i], i, list, &tally[i], first_utime);
    fputs("</testsuites>\n", out);
}
