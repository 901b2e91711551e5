#include "replay_json.h"

#include "../report.h"
#include "number.h"
#include "wire.h"

#include <inttypes.h>

static const char *const channel_name[TALLY_CHANNELS] = {WIRE_PAIR_QUERY, WIRE_SCENE_QUERY};

struct replay_json replay_json_begin(FILE *out)
{
    fputs("{\"differences\": [", out);
    return (struct replay_json){.out = out, .first = true};
}

static void write_side(FILE *out, const char *name, int dim, const struct difference_side *side)
{
    const bool decided = side->status == FMB_OK && side->answer.verdict != 0;
    const struct outcome outcome = {
        .error = decided ? NULL : fmb_status_text(side->status ? side->status : FMB_CANNOT_DECIDE),
        .answer = side->answer,
        .certificate = side->certificate};
    fprintf(out, ", \"%s\": {", name);
    report_answer_json(out, dim, &outcome);
    putc('}', out);
}

void replay_json_found(struct replay_json *json, const struct found *found, const char *log,
                       int64_t first_utime)
{
    FILE *out = json->out;
    const struct difference *difference = &found->difference;
    char time[NUMBER_TEXT_MAX];
    fputs(json->first ? "{\"log\": " : ", {\"log\": ", out);
    json->first = false;
    report_string_json(out, log);
    fprintf(out,
            ", \"event\": %" PRId64 ", \"offset\": %" PRId64 ", \"utime\": %" PRId64
            ", \"time\": %s, \"channel\": \"%s\", \"client_id\": %" PRId64
            ", \"sequence_number\": %" PRId64,
            found->place.number, found->place.offset, found->place.utime,
            number_exact(((double) found->place.utime - (double) first_utime) / 1e6, time),
            channel_name[tally_channel_of(found->kind)], found->ids.client_id,
            found->ids.sequence_number);
    if (!difference->whole)
        fprintf(out, ", \"a\": %" PRId64 ", \"b\": %" PRId64 ", \"frames\": [%u,%u]",
                difference->body_id[0], difference->body_id[1], difference->frame[0],
                difference->frame[1]);
    fprintf(out, ", \"kind\": \"%s\"", difference_name(difference->kind));
    if (difference->whole) {
        fputs(", \"then\": {\"status\": ", out);
        report_string_json(out, fmb_status_text(difference->then.status));
        fputs("}, \"now\": {\"status\": ", out);
        report_string_json(out, fmb_status_text(difference->now.status));
        putc('}', out);
    } else {
        write_side(out, "then", difference->dim, &difference->then);
        write_side(out, "now", difference->dim, &difference->now);
    }
    putc('}', out);
}

static void write_counts(FILE *out, const struct tally_channel *channel)
{
    static const char *const outcome[REPLAY_ALONE + 1] = {"same", "different", "busy",
                                                          "unknown_body", "no_result"};
    fprintf(out, "\"queries\": %" PRId64 ", \"pairs\": %" PRId64, channel->queries, channel->pairs);
    for (int i = 0; i <= REPLAY_ALONE; i++)
        fprintf(out, ", \"%s\": %" PRId64, outcome[i], channel->outcome[i]);
    fprintf(out,
            ", \"results\": %" PRId64 ", \"results_alone\": %" PRId64
            ", \"unreadable_queries\": %" PRId64 ", \"unreadable_results\": %" PRId64
            ", \"different_in\": {",
            channel->results, channel->results_alone, channel->unreadable[0],
            channel->unreadable[1]);
    for (int kind = 0; kind < DIFFERENT_KINDS; kind++)
        fprintf(out, "%s\"%s\": %" PRId64, kind ? ", " : "",
                difference_name((enum difference_kind) kind), channel->differences[kind]);
    putc('}', out);
}

static void write_times(FILE *out, const char *name, const struct histogram *times)
{
    fprintf(out,
            ", \"%s\": {\"count\": %" PRId64 ", \"p50_ns\": %" PRId64 ", \"p99_ns\": %" PRId64
            ", \"max_ns\": %" PRId64 "}",
            name, times->count, histogram_quantile(times, 0.5), histogram_quantile(times, 0.99),
            times->max);
}

static void write_bus(FILE *out, const struct tally_bus *bus)
{
    static const char *const end[] = {[ANSWER_BUS_NO_END] = "null",
                                      [ANSWER_BUS_SIGNAL] = "\"signal\"",
                                      [ANSWER_BUS_NOBODY] = "\"nobody answers\"",
                                      [ANSWER_BUS_FAILED] = "\"the bus has failed\""};
    fprintf(out,
            ", \"bus\": {\"answered\": %" PRId64 ", \"ns\": %" PRId64 ", \"late_ns\": %" PRId64
            ", \"sent_again\": %" PRId64 ", \"busy\": %" PRId64 ", \"dead_keys\": %" PRId64
            ", \"brought_bodies\": %" PRId64 ", \"too_long\": %" PRId64 ", \"services\": %" PRId64
            ", \"unreadable\": %" PRId64 ", \"end\": %s}",
            bus->answered, bus->ns, bus->late_ns, bus->again, bus->busy, bus->deaths, bus->lessons,
            bus->too_long, bus->services, bus->nonsense, end[bus->end]);
}

void replay_json_end(struct replay_json *json, const struct tally *tally, int64_t untold,
                     int exit_code)
{
    FILE *out = json->out;
    fprintf(out,
            "], \"untold\": %" PRId64 ", \"exit\": %d, \"events\": %" PRId64 ", \"bytes\": %" PRId64
            ", \"other_events\": %" PRId64 ", \"statuses\": %" PRId64 ", \"damages\": %" PRId64
            ", \"damaged_bytes\": %" PRId64 ", ",
            untold, exit_code, tally->events, tally->bytes, tally->other_events, tally->statuses,
            tally->damages, tally->damaged_bytes);
    struct tally_channel all = tally->channel[TALLY_PAIRS];
    tally_add_channel(&all, &tally->channel[TALLY_SCENES]);
    write_counts(out, &all);
    fputs(", \"channels\": {", out);
    for (int i = 0; i < TALLY_CHANNELS; i++) {
        fprintf(out, "%s\"%s\": {", i ? ", " : "", channel_name[i]);
        write_counts(out, &tally->channel[i]);
        putc('}', out);
    }
    fputs("}, \"compute\": {\"unit\": \"ns\"", out);
    write_times(out, "then", &tally->then);
    write_times(out, "now", &tally->now);
    putc('}', out);
    if (tally->bus.used)
        write_bus(out, &tally->bus);
    fputs("}\n", out);
}
