#include "replay_output.h"

#include "number.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- One difference ---- */

/* Bytes of one side of a difference, for example "touching". */
enum { SIDE_MAX = 320 };

static const char *end_text(double value, char text[NUMBER_TEXT_MAX])
{
    if (!isinf(value))
        return number_exact(value, text);
    return strcpy(text, value < 0 ? "-inf" : "inf");
}

static void interval_text(const struct fmb_answer *answer, char text[SIDE_MAX])
{
    char ends[2][NUMBER_TEXT_MAX];
    if (answer->has_contact)
        snprintf(text, SIDE_MAX, "%s to %s s", end_text(answer->contact[0], ends[0]),
                 end_text(answer->contact[1], ends[1]));
    else
        strcpy(text, "none");
}

static void box_text(const struct fmb_answer *answer, int dim, char text[SIDE_MAX])
{
    static const char axis_name[] = "xyz";
    char ends[2][NUMBER_TEXT_MAX];
    size_t used = 0;
    strcpy(text, "none");
    for (int axis = 0; axis < dim && answer->has_box; axis++)
        used += (size_t) snprintf(text + used, SIDE_MAX - used, "%s%c %s..%s", axis ? "  " : "",
                                  axis_name[axis], end_text(answer->box[0][axis], ends[0]),
                                  end_text(answer->box[1][axis], ends[1]));
}

static void gap_text(const struct fmb_answer *answer, int dim, char text[SIDE_MAX])
{
    char number[2][NUMBER_TEXT_MAX];
    const struct fmb_gap *gap = &answer->gap;
    strcpy(text, "none");
    if (!answer->has_gap)
        return;
    size_t used =
        (size_t) snprintf(text, SIDE_MAX, "%s..%s along", end_text(gap->bounds[0], number[0]),
                          end_text(gap->bounds[1], number[1]));
    for (int axis = 0; axis < dim; axis++)
        used += (size_t) snprintf(text + used, SIDE_MAX - used, " %s",
                                  number_exact(gap->direction[axis], number[0]));
}

static void status_text(const struct difference_side *side, char text[SIDE_MAX])
{
    const char *verdict = fmb_verdict_name((int) side->answer.verdict);
    const char *said = side->status == FMB_OK ? "decided" : fmb_status_text(side->status);
    snprintf(text, SIDE_MAX, "%s", side->status == FMB_OK && verdict ? verdict : said);
}

static void side_text(const struct difference *difference, const struct difference_side *side,
                      char text[SIDE_MAX])
{
    const char *verdict = fmb_verdict_name((int) side->answer.verdict);
    switch (difference->kind) {
    case DIFFERENT_INTERVAL: interval_text(&side->answer, text); break;
    case DIFFERENT_BOX: box_text(&side->answer, difference->dim, text); break;
    case DIFFERENT_GAP: gap_text(&side->answer, difference->dim, text); break;
    case DIFFERENT_CERTIFICATE:
        snprintf(text, SIDE_MAX, "%.200s", side->certificate ? side->certificate : "none");
        break;
    case DIFFERENT_VERDICT:
        snprintf(text, SIDE_MAX, "%s", verdict ? verdict : "not decided");
        break;
    default: status_text(side, text); break;
    }
}

void replay_line(const struct difference *difference, const struct body_names *names,
                 const char *log, int64_t first_utime, char line[REPLAY_LINE_MAX])
{
    char then[SIDE_MAX], now[SIDE_MAX], bodies[160] = "the scene", body[2][BODY_NAMES_TEXT_MAX];
    side_text(difference, &difference->then, then);
    side_text(difference, &difference->now, now);
    if (!difference->whole)
        snprintf(bodies, sizeof bodies, "bodies %s %s",
                 body_names_text(names, difference->client_id, difference->body_id[0], body[0]),
                 body_names_text(names, difference->client_id, difference->body_id[1], body[1]));
    snprintf(line, REPLAY_LINE_MAX, "%.200s%sevent %" PRId64 "  %.6f s  %s  %s: %s, now %s",
             log ? log : "", log ? ": " : "", difference->place.number,
             ((double) difference->place.utime - (double) first_utime) / 1e6, bodies,
             difference_name[difference->kind], then, now);
}

/* ---- Counts ---- */

static void print_row(FILE *out, const char *name, const struct tally_channel *channel)
{
    char text[NUMBER_TEXT_MAX];
    fprintf(out, "%-16s", name);
    for (int i = 0; i < TALLY_COUNTS; i++)
        if (tally_count[i].column)
            fprintf(out, " %12s", number_grouped(tally_counts(channel)[i], text));
    fprintf(out, " %12s\n", number_grouped(channel->unreadable[0] + channel->unreadable[1], text));
}

static void print_channels(FILE *out, const struct tally *tally)
{
    fprintf(out, "%-16s", "");
    for (int i = 0; i < TALLY_COUNTS; i++)
        if (tally_count[i].column)
            fprintf(out, " %12s", tally_count[i].column);
    fprintf(out, " %12s\n", "unreadable");
    for (int i = 0; i < TALLY_CHANNELS; i++)
        print_row(out, tally_channel_name[i], &tally->channel[i]);
}

static void print_kinds(FILE *out, const struct tally_channel *both)
{
    const char *before = "different in: ";
    for (int kind = 0; kind < DIFFERENT_KINDS; kind++) {
        char text[NUMBER_TEXT_MAX];
        if (both->differences[kind] == 0)
            continue;
        fprintf(out, "%s%s %s", before, number_grouped(both->differences[kind], text),
                difference_name[kind]);
        before = ", ";
    }
    if (before[0] == ',')
        putc('\n', out);
}

static void print_times(FILE *out, const char *name, const struct histogram *times)
{
    if (times->count > 0)
        fprintf(out, "%-16s %12.1f %12.1f %12.1f\n", name,
                1e-3 * (double) histogram_quantile(times, 0.5),
                1e-3 * (double) histogram_quantile(times, 0.99), 1e-3 * (double) times->max);
}

static void print_log(FILE *out, const struct tally *tally, const struct tally_channel *both)
{
    char events[NUMBER_TEXT_MAX], unmatched[NUMBER_TEXT_MAX], other[NUMBER_TEXT_MAX];
    fprintf(out,
            "%s events, %.1f MB; %s on other channels; %s results of queries that are not here",
            number_grouped(tally->events, events), 1e-6 * (double) tally->bytes,
            number_grouped(tally->other_events, other), number_grouped(both->unmatched, unmatched));
    if (both->contradictions > 0)
        fprintf(out, "; %" PRId64 " results that contradict earlier ones", both->contradictions);
    if (both->left_over > 0)
        fprintf(out, "; %" PRId64 " queries in one recording only", both->left_over);
    if (tally->damages > 0)
        fprintf(out, "; %" PRId64 " damaged places, %" PRId64 " bytes", tally->damages,
                tally->damaged_bytes);
    putc('\n', out);
}

/* "fmbd answered 300,000 queries in 9.72 s (30,864 a second), 3 sent again": counts that are not 0.
 */
static void print_bus(FILE *out, const struct tally_bus *bus)
{
    const struct {
        int64_t count;
        const char *what;
    } more[] = {{bus->resent, "sent again"},
                {bus->whole, "sent once more with frames"},
                {bus->not_sent, "that cannot be sent"},
                {bus->supplied, "more that carried bodies"},
                {bus->services > 1 ? bus->services - 1 : 0, "changes of the service"},
                {bus->malformed, "results that could not be read"}};
    const double seconds = 1e-9 * (double) bus->ns;
    char text[NUMBER_TEXT_MAX];
    fprintf(out, "fmbd answered %s queries in %.3f s", number_grouped(bus->answered, text),
            seconds);
    if (bus->ns > 0)
        fprintf(out, " (%s a second)",
                number_grouped((int64_t) ((double) bus->answered / seconds), text));
    if (bus->late_ns > 0)
        fprintf(out, ", at most %.1f ms late", 1e-6 * (double) bus->late_ns);
    for (size_t i = 0; i < sizeof more / sizeof *more; i++)
        if (more[i].count > 0)
            fprintf(out, ", %s %s", number_grouped(more[i].count, text), more[i].what);
    putc('\n', out);
}

void replay_text_summary(FILE *out, const struct tally *tally)
{
    const struct tally_channel both = tally_both(tally);
    print_channels(out, tally);
    print_kinds(out, &both);
    fprintf(out, "%-16s %12s %12s %12s\n", "microseconds", "p50", "p99", "max");
    print_times(out, "then", &tally->then);
    print_times(out, "now", &tally->now);
    print_log(out, tally, &both);
    if (tally->bus.used)
        print_bus(out, &tally->bus);
}
