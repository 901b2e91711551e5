#include "replay_output.h"

#include "report.h"

struct json_writer replay_json_begin(FILE *out)
{
    struct json_writer json = json_object(out);
    json_begin(&json, "differences", '[');
    return json;
}

static void write_status(struct json_writer *json, const char *key, int status)
{
    json_begin(json, key, '{');
    json_string(json, "status", fmb_status_text(status));
    json_end(json, '}');
}

static void write_side(struct json_writer *json, const char *key, int dim, bool names_frames,
                       const struct fmb_client_answer *side)
{
    struct fmb_client_answer answer = *side;
    if (answer.status == FMB_OK && answer.answer.verdict == 0)
        answer.status = FMB_CANNOT_DECIDE;
    answer.text = fmb_status_text(answer.status);
    json_begin(json, key, '{');
    report_answer_json(json, dim, names_frames, &answer);
    json_end(json, '}');
}

static void write_difference(struct json_writer *json, const struct body_names *names,
                             const struct difference *difference)
{
    const int64_t *id = difference->body_id;
    const char *name[2] = {body_names_find(names, difference->client_id, id[0]),
                           body_names_find(names, difference->client_id, id[1])};
    if (!difference->whole) {
        json_integer(json, "a", id[0]);
        json_integer(json, "b", id[1]);
        json_integers(json, "placements",
                      (const int64_t[]){difference->placement[0], difference->placement[1]}, 2);
        report_names_json(json, name);
    }
    json_string(json, "kind", difference_name[difference->kind]);
    if (difference->detail) {
        json_string(json, "detail", difference->detail);
    } else if (difference->whole) {
        write_status(json, "then", difference->then.status);
        write_status(json, "now", difference->now.status);
    } else {
        write_side(json, "then", difference->dim, difference->names_frames[0], &difference->then);
        write_side(json, "now", difference->dim, difference->names_frames[1], &difference->now);
    }
}

void replay_json_found(struct json_writer *json, const struct difference *difference,
                       const struct body_names *names, const char *log, int64_t first_utime)
{
    json_begin(json, NULL, '{');
    json_string(json, "log", log);
    json_integer(json, "event", difference->place.number);
    json_integer(json, "offset", difference->place.offset);
    json_integer(json, "utime", difference->place.utime);
    json_number(json, "time", ((double) difference->place.utime - (double) first_utime) / 1e6);
    json_string(json, "channel", tally_channel_name[tally_channel_of(difference->query_kind)]);
    json_integer(json, "client_id", difference->client_id);
    json_integer(json, "sequence_number", difference->sequence_number);
    if (*difference->label)
        json_string(json, "label", difference->label);
    write_difference(json, names, difference);
    json_end(json, '}');
}

static void write_counts(struct json_writer *json, const struct tally_channel *channel)
{
    for (int i = 0; i < TALLY_COUNTS; i++)
        json_integer(json, tally_count[i].key, tally_counts(channel)[i]);
    json_begin(json, "different_in", '{');
    for (int kind = 0; kind < DIFFERENT_KINDS; kind++)
        json_integer(json, difference_name[kind], channel->differences[kind]);
    json_end(json, '}');
}

static void write_times(struct json_writer *json, const char *key, const struct histogram *times)
{
    json_begin(json, key, '{');
    json_integer(json, "count", times->count);
    json_integer(json, "p50_ns", histogram_quantile(times, 0.5));
    json_integer(json, "p99_ns", histogram_quantile(times, 0.99));
    json_integer(json, "max_ns", times->max);
    json_end(json, '}');
}

static void write_bus(struct json_writer *json, const struct tally_bus *bus)
{
    static const char *const end[] = {[TALLY_NO_END] = NULL,
                                      [TALLY_SIGNAL] = "signal",
                                      [TALLY_NO_SERVICE] = "no service answers",
                                      [TALLY_BUS_FAILED] = "the bus has failed"};
    json_begin(json, "bus", '{');
    json_integer(json, "answered", bus->answered);
    json_integer(json, "ns", bus->ns);
    json_integer(json, "sent_again", bus->resent);
    json_integer(json, "sent_whole", bus->whole);
    json_integer(json, "not_sent", bus->not_sent);
    json_integer(json, "supplied", bus->supplied);
    json_integer(json, "services", bus->services);
    json_integer(json, "unreadable", bus->malformed);
    json_string(json, "end", end[bus->end]);
    json_end(json, '}');
}

void replay_json_end(struct json_writer *json, const struct tally *tally, int64_t not_listed,
                     int exit_code)
{
    json_end(json, ']');
    json_integer(json, "not_listed", not_listed);
    json_integer(json, "exit", exit_code);
    json_integer(json, "events", tally->events);
    json_integer(json, "bytes", tally->bytes);
    json_integer(json, "other_events", tally->other_events);
    json_integer(json, "statuses", tally->statuses);
    json_integer(json, "definitions", tally->definitions);
    json_integer(json, "unreadable_definitions", tally->unreadable_definitions);
    json_integer(json, "damages", tally->damages);
    json_integer(json, "damaged_bytes", tally->damaged_bytes);
    const struct tally_channel both = tally_both(tally);
    write_counts(json, &both);
    json_begin(json, "channels", '{');
    for (int i = 0; i < TALLY_CHANNELS; i++) {
        json_begin(json, tally_channel_name[i], '{');
        write_counts(json, &tally->channel[i]);
        json_end(json, '}');
    }
    json_end(json, '}');
    json_begin(json, "compute", '{');
    json_string(json, "unit", "ns");
    write_times(json, "then", &tally->then);
    write_times(json, "now", &tally->now);
    json_end(json, '}');
    if (tally->bus.used)
        write_bus(json, &tally->bus);
    json_object_end(json);
}
