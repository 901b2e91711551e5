#include "report.h"

static void write_interval(struct json_writer *json, const char *key, const double ends[2])
{
    json_begin(json, key, '[');
    json_number(json, NULL, ends[0]);
    json_number(json, NULL, ends[1]);
    json_end(json, ']');
}

static void write_gap(struct json_writer *json, int dim, const struct fmb_gap *gap,
                      bool names_frames)
{
    write_interval(json, "gap", gap->bounds);
    if (names_frames)
        json_integers(json, "frames", (const int64_t[]){gap->frame[0], gap->frame[1]}, 2);
    json_numbers(json, "direction", gap->direction, dim);
    if (!gap->has_witness)
        return;
    json_begin(json, "witness", '{');
    json_number(json, "time", gap->time);
    json_numbers(json, "a", gap->witness[0], dim);
    json_numbers(json, "b", gap->witness[1], dim);
    json_end(json, '}');
}

void report_answer_json(struct json_writer *json, int dim, bool names_frames,
                        const struct fmb_client_answer *of)
{
    const struct fmb_answer *answer = &of->answer;
    if (of->status != FMB_OK) {
        json_string(json, "error", of->text);
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
        write_gap(json, dim, &answer->gap, names_frames);
    if (of->certificate)
        json_string(json, "certificate", of->certificate);
}

static void begin_scene(struct report *report)
{
    struct json_writer *json = &((struct report_json *) report)->json;
    json_begin(json, NULL, '{');
    if (report->scene->scene.label)
        json_string(json, "label", report->scene->scene.label);
    json_begin(json, "pairs", '[');
}

static void write_pair(struct report *report, const struct fmb_client_answer *answer)
{
    struct json_writer *json = &((struct report_json *) report)->json;
    const struct fmb_placement *placements = report->scene->scene.placements;
    const struct fmb_placement *a = &placements[answer->a], *b = &placements[answer->b];
    json_begin(json, NULL, '{');
    json_integer(json, "a", a->id);
    json_integer(json, "b", b->id);
    report_answer_json(json, report->scene->dim,
                       a->body->frame_count > 1 || b->body->frame_count > 1, answer);
    json_end(json, '}');
}

static void end_scene(struct report *report)
{
    struct json_writer *json = &((struct report_json *) report)->json;
    json_end(json, ']');
    json_object_end(json);
    fflush(json->out);
}

struct report_json report_json(FILE *out)
{
    return (struct report_json){.report = {begin_scene, write_pair, end_scene, NULL},
                                .json = {.out = out}};
}
