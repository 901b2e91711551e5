#include "report.h"

static void write_interval(struct json_writer *json, const char *key, const double ends[2])
{
    json_begin(json, key, '[');
    json_number(json, NULL, ends[0]);
    json_number(json, NULL, ends[1]);
    json_end(json, ']');
}

static void write_gap(struct json_writer *json, int dim, const struct fmb_gap *gap)
{
    write_interval(json, "gap", gap->bounds);
    json_numbers(json, "direction", gap->direction, dim);
    if (!gap->has_witness)
        return;
    json_begin(json, "witness", '{');
    json_number(json, "time", gap->time);
    json_numbers(json, "a", gap->witness[0], dim);
    json_numbers(json, "b", gap->witness[1], dim);
    json_end(json, '}');
}

void report_answer_json(struct json_writer *json, int dim, const struct outcome *outcome)
{
    const struct fmb_answer *answer = &outcome->answer;
    if (outcome->error) {
        json_string(json, "error", outcome->error);
        return;
    }
    json_string(json, "verdict", fmb_verdict_name((int) answer->verdict));
    if (answer->has_contact)
        write_interval(json, "contact", answer->contact);
    if (answer->has_box) {
        json_begin(json, "box", '{');
        json_numbers(json, "min", answer->box[0], dim);
        json_numbers(json, "max", answer->box[1], dim);
        json_end(json, '}');
    }
    if (answer->has_gap)
        write_gap(json, dim, &answer->gap);
    if (outcome->certificate)
        json_string(json, "certificate", outcome->certificate);
}

static void begin_scene(struct report *report, const struct scene *scene)
{
    struct json_writer *json = &((struct report_json *) report)->json;
    (void) scene;
    json_begin(json, NULL, '{');
    json_begin(json, "pairs", '[');
}

static void write_pair(struct report *report, const struct scene *scene,
                       const struct outcome *outcome)
{
    struct json_writer *json = &((struct report_json *) report)->json;
    json_begin(json, NULL, '{');
    json_integer(json, "a", scene->body[outcome->pair.a].id);
    json_integer(json, "b", scene->body[outcome->pair.b].id);
    report_answer_json(json, scene->dim, outcome);
    json_end(json, '}');
}

static void end_scene(struct report *report, const struct scene *scene)
{
    struct json_writer *json = &((struct report_json *) report)->json;
    (void) scene;
    json_end(json, ']');
    json_object_end(json);
    fflush(json->out);
}

struct report_json report_json(FILE *out)
{
    return (struct report_json){.report = {begin_scene, write_pair, end_scene},
                                .json = {.out = out}};
}
