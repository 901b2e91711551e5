#include "replay_output.h"

#include "number.h"
#include "report.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- One difference ---- */

/* Texts may be any bytes, and are truncated. */
static void put_text(FILE *out, enum escape form, const char *text)
{
    enum { TEXT_MAX = 200 };
    escape(out, form, text, strnlen(text, TEXT_MAX));
}

/* One side has no such numbers, so that those of the other need few digits. */
static void put_box(FILE *out, int dim, const struct fmb_answer *answer)
{
    char text[2][NUMBER_TEXT_MAX];
    for (int axis = 0; axis < dim; axis++)
        fprintf(out, "%s%c %s..%s", axis ? "  " : "", "xyz"[axis],
                number_short(answer->box[0][axis], text[0]),
                number_short(answer->box[1][axis], text[1]));
}

/* both: both sides have a gap. They then differ in whether they have witness points. */
static void put_gap(FILE *out, const struct fmb_gap *gap, bool both)
{
    char text[2][NUMBER_TEXT_MAX];
    fprintf(out, "%s..%s", number_short(gap->bounds[0], text[0]),
            number_short(gap->bounds[1], text[1]));
    if (both)
        fputs(gap->has_witness ? " with witness points" : " without", out);
}

static void put_side(FILE *out, enum escape form, const struct difference *difference,
                     const struct fmb_client_answer *side)
{
    const struct fmb_answer *answer = &side->answer;
    const char *verdict = fmb_verdict_name((int) answer->verdict);
    char text[2][NUMBER_TEXT_MAX], point[REPORT_POINT_MAX];
    if (difference->kind == DIFFERENT_INTERVAL && answer->has_contact)
        fprintf(out, "%s to %s s", number_short(answer->contact[0], text[0]),
                number_short(answer->contact[1], text[1]));
    else if (difference->kind == DIFFERENT_BOX && answer->has_box)
        put_box(out, difference->dim, answer);
    else if (difference->kind == DIFFERENT_POINT && answer->has_point)
        fputs(report_point(difference->dim, answer->point, point), out);
    else if (difference->kind == DIFFERENT_GAP && answer->has_gap)
        put_gap(out, &answer->gap,
                difference->then.answer.has_gap && difference->now.answer.has_gap);
    else if (difference->kind == DIFFERENT_CERTIFICATE && side->certificate)
        put_text(out, form, side->certificate);
    else if (difference->kind == DIFFERENT_VERDICT)
        fputs(verdict ? verdict : "not decided", out);
    else if (difference->kind == DIFFERENT_STATUS)
        fputs(side->status != FMB_OK ? fmb_status_text(side->status)
              : verdict              ? verdict
                                     : "decided",
              out);
    else
        fputs("none", out);
}

/* ---- The number that has changed most ---- */

/* Numbers of an answer that are next to each other. */
struct numbers {
    const char *name[3]; /* [number / dim], or [number] if each has its own */
    const double *then, *now;
    int count;
    bool axes; /* dim numbers for each name */
};

struct change {
    int differing; /* numbers in all */
    const char *name;
    int axis; /* -1: none */
    double then, now;
};

static void find_change(const struct numbers *of, int dim, struct change *out)
{
    for (int i = 0; i < of->count; i++) {
        const double then = of->then[i], now = of->now[i];
        const double by = fabs(now - then);
        if (memcmp(&then, &now, sizeof then) == 0)
            continue;
        if (out->differing++ > 0 && !(by > fabs(out->now - out->then)))
            continue;
        out->name = of->name[of->axes ? i / dim : i];
        out->axis = of->axes ? i % dim : -1;
        out->then = then;
        out->now = now;
    }
}

/* Of a gap the bounds come first: only they are compared with a tolerance. */
static struct change change_of(const struct difference *difference)
{
    const struct fmb_answer *then = &difference->then.answer, *now = &difference->now.answer;
    const struct fmb_gap *a = &then->gap, *b = &now->gap;
    const int dim = difference->dim;
    const double frame[2][2] = {{a->frame[0], a->frame[1]}, {b->frame[0], b->frame[1]}};
    const struct numbers contact = {{"begin", "end"}, then->contact, now->contact, 2, false};
    const struct numbers box[] = {{{"min"}, then->box[0], now->box[0], dim, true},
                                  {{"max"}, then->box[1], now->box[1], dim, true}};
    const struct numbers point[] = {{{"time"}, then->point, now->point, 1, false},
                                    {{"position"}, then->point + 1, now->point + 1, dim, true}};
    const struct numbers gap[] = {
        {{"lower bound", "upper bound"}, a->bounds, b->bounds, 2, false},
        {{"direction"}, a->direction, b->direction, dim, true},
        {{"time"}, &a->time, &b->time, 1, false},
        {{"witness point of the first body"}, a->witness[0], b->witness[0], dim, true},
        {{"witness point of the second body"}, a->witness[1], b->witness[1], dim, true},
        {{"frame of the first body", "frame of the second body"}, frame[0], frame[1], 2, false}};
    struct change change = {.axis = -1}, other = {.axis = -1};
    if (difference->kind == DIFFERENT_INTERVAL && then->has_contact && now->has_contact)
        find_change(&contact, dim, &change);
    for (int i = 0; i < 2 && difference->kind == DIFFERENT_BOX; i++)
        if (then->has_box && now->has_box)
            find_change(&box[i], dim, &change);
    for (int i = 0; i < 2 && difference->kind == DIFFERENT_POINT; i++)
        if (then->has_point && now->has_point)
            find_change(&point[i], dim, &change);
    if (difference->kind != DIFFERENT_GAP || !then->has_gap || !now->has_gap)
        return change;
    find_change(&gap[0], dim, &change);
    for (size_t i = 1; i < sizeof gap / sizeof *gap && a->has_witness == b->has_witness; i++)
        find_change(&gap[i], dim, &other);
    if (change.differing == 0)
        return other;
    change.differing += other.differing;
    return change;
}

/* "gap lower bound: 0.25, now 0.5 (+0.25), and 3 more numbers" */
static void put_change(FILE *out, const struct difference *difference, const struct change *change)
{
    char text[2][NUMBER_TEXT_MAX];
    const double by = change->now - change->then;
    fprintf(out, "  %s %s", difference_name[difference->kind], change->name);
    if (change->axis >= 0)
        fprintf(out, " %c", "xyz"[change->axis]);
    fprintf(out, ": %s, now %s", number_or_inf(change->then, text[0]),
            number_or_inf(change->now, text[1]));
    if (isfinite(by))
        fprintf(out, " (%+.3g)", by);
    if (change->differing > 1) {
        fputs(", and ", out);
        number_count(out, change->differing - 1, "more number", "more numbers");
    }
    putc('\n', out);
}

static void put_both(FILE *out, enum escape form, const struct difference *difference)
{
    const struct change change = change_of(difference);
    if (change.differing > 0) {
        put_change(out, difference, &change);
        return;
    }
    fprintf(out, "  %s: ", difference_name[difference->kind]);
    put_side(out, form, difference, &difference->then);
    fputs(", now ", out);
    put_side(out, form, difference, &difference->now);
    putc('\n', out);
}

void replay_line(FILE *out, enum escape form, const struct difference *difference,
                 const struct body_names *names, const char *log, int64_t first_utime)
{
    char text[NUMBER_TEXT_MAX];
    if (log) {
        put_text(out, form, log);
        fputs(": ", out);
    }
    fprintf(out, "event %" PRId64, difference->place.number);
    fputs(*difference->label ? " (" : "", out);
    put_text(out, form, difference->label);
    fprintf(out, "%s  %.6f s  ", *difference->label ? ")" : "",
            ((double) difference->place.utime - (double) first_utime) / 1e6);
    fputs(!difference->whole                         ? "bodies"
          : difference->query_kind == LOG_PAIR_QUERY ? "the pair"
                                                     : "the scene",
          out);
    for (int i = 0; i < 2 && !difference->whole; i++) {
        const int64_t id = difference->body_id[i];
        putc(' ', out);
        put_text(out, form,
                 report_body(body_names_find(names, difference->client_id, id), id, text));
    }
    if (difference->detail) {
        fputs(": ", out);
        put_text(out, form, difference->detail);
        putc('\n', out);
        return;
    }
    put_both(out, form, difference);
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
    char text[NUMBER_TEXT_MAX];
    number_count(out, tally->events, "event", "events");
    fprintf(out, ", %.1f MB; %s on other channels; ", 1e-6 * (double) tally->bytes,
            number_grouped(tally->other_events, text));
    number_count(out, both->unmatched, "result of a query that is not here",
                 "results of queries that are not here");
    if (both->contradictions > 0) {
        fputs("; ", out);
        number_count(out, both->contradictions, "result that contradicts an earlier one",
                     "results that contradict earlier ones");
    }
    if (both->left_over > 0) {
        fputs("; ", out);
        number_count(out, both->left_over, "query", "queries");
        fputs(" in one recording only", out);
    }
    if (tally->damages > 0) {
        fputs("; ", out);
        number_count(out, tally->damages, "damaged place, ", "damaged places, ");
        number_count(out, tally->damaged_bytes, "byte", "bytes");
    }
    putc('\n', out);
}

/* "fmbd answered 300,000 queries in 9.72 s (30,864 a second), 3 sent again": counts that are not 0.
 */
static void print_bus(FILE *out, const struct tally_bus *bus)
{
    const struct {
        int64_t count;
        const char *one, *more;
    } counts[] = {
        {bus->resent, "sent again", "sent again"},
        {bus->whole, "sent once more with frames", "sent once more with frames"},
        {bus->not_sent, "that cannot be sent", "that cannot be sent"},
        {bus->supplied, "more that carried bodies", "more that carried bodies"},
        {bus->services > 1 ? bus->services - 1 : 0, "change of the service",
         "changes of the service"},
        {bus->malformed, "result that could not be read", "results that could not be read"}};
    const double seconds = 1e-9 * (double) bus->ns;
    char text[NUMBER_TEXT_MAX];
    fputs("fmbd answered ", out);
    number_count(out, bus->answered, "query", "queries");
    fprintf(out, " in %.3f s", seconds);
    if (bus->ns > 0)
        fprintf(out, " (%s a second)",
                number_grouped((int64_t) ((double) bus->answered / seconds), text));
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        if (counts[i].count == 0)
            continue;
        fputs(", ", out);
        number_count(out, counts[i].count, counts[i].one, counts[i].more);
    }
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
