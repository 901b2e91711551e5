#include "report.h"

#include "escape.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

/* The columns of bodies are wide enough for all from the first row on. */
static struct report_columns columns_for(const struct owned_scene *scene)
{
    struct report_columns columns = report_columns();
    columns.body = 1;
    for (size_t i = 0; i < scene->scene.placement_count; i++) {
        const struct fmb_placement *body = &scene->scene.placements[i];
        const int width = report_body_width(body->name, body->id);
        columns.body = width > columns.body ? width : columns.body;
    }
    return columns;
}

/* ---- The beginning and the end of a scene ---- */

/* Writes a label in parentheses; NULL: writes nothing. */
static void put_label(FILE *out, const char *label)
{
    if (!label)
        return;
    fputs(" (", out);
    escape_text(out, label);
    putc(')', out);
}

static void begin_table(struct report_rows *rows)
{
    const struct fmb_scene *scene = &rows->scene->scene;
    const uint64_t count = scene_count_pairs(rows->scene);
    char duration[NUMBER_TEXT_MAX], pairs[NUMBER_TEXT_MAX];
    rows->begun = true;
    rows->printer.columns = columns_for(rows->scene);
    fprintf(rows->printer.out, "%sscene %" PRId64, rows->shown ? "\n" : "", rows->scenes);
    put_label(rows->printer.out, scene->label);
    fprintf(rows->printer.out, ": %zu bod%s in %dD, %s pair%s, 0 to %s s\n", scene->placement_count,
            scene->placement_count == 1 ? "y" : "ies", rows->scene->dim,
            number_grouped((int64_t) count, pairs), count == 1 ? "" : "s",
            number_short(scene->duration, duration));
    if (count > 0)
        report_headings(rows->printer.out, &rows->printer.columns, rows->gap || scene->margin > 0,
                        rows->point, rows->box);
}

static void end_table(const struct report_rows *rows)
{
    static const enum fmb_verdict order[] = {FMB_OVERLAPPING, FMB_TOUCHING, FMB_SEPARATED};
    char count[NUMBER_TEXT_MAX];
    if (rows->left_out > 0)
        fprintf(rows->printer.out, "  ... and %s more separated (--all shows them)\n",
                number_grouped((int64_t) rows->left_out, count));
    for (int i = 0; i < 3; i++)
        fprintf(rows->printer.out, "%s%s %s", i ? ", " : "",
                number_grouped((int64_t) rows->count[order[i]], count),
                fmb_verdict_name((int) order[i]));
    if (rows->scene->scene.margin > 0)
        fprintf(rows->printer.out, " (%s near)", number_grouped((int64_t) rows->near, count));
    if (rows->count[0] > 0)
        fprintf(rows->printer.out, ", %s not decided",
                number_grouped((int64_t) rows->count[0], count));
    putc('\n', rows->printer.out);
}

void report_begin_scene(struct report_rows *rows, struct owned_scene *scene)
{
    rows->scene = scene;
    rows->scenes++;
    memset(rows->count, 0, sizeof rows->count);
    rows->near = rows->left_out = 0;
    rows->begun = false;
    if (rows->printer.form == REPORT_JSON) {
        json_begin(&rows->printer.json, NULL, '{');
        if (scene->scene.label)
            json_string(&rows->printer.json, "label", scene->scene.label);
        json_begin(&rows->printer.json, "pairs", '[');
    } else if (rows->printer.form == REPORT_TABLE && !rows->contacts) {
        begin_table(rows);
    }
}

void report_end_scene(struct report_rows *rows)
{
    if (rows->printer.form == REPORT_JSON) {
        json_end(&rows->printer.json, ']');
        json_object_end(&rows->printer.json);
    } else if (rows->printer.form == REPORT_TABLE && rows->begun) {
        end_table(rows);
    }
    rows->shown = rows->shown || rows->begun;
    rows->summary.count += rows->count[rows->summary.all] > 0;
    fflush(rows->printer.out);
}

/* ---- Rows ---- */

static struct report_row row_of(const struct report_rows *rows, const struct fmb_client_answer *of)
{
    const struct fmb_scene *scene = &rows->scene->scene;
    const struct fmb_placement *a = &scene->placements[of->a], *b = &scene->placements[of->b];
    return (struct report_row){
        .utime = REPORT_NONE,
        .scene = rows->scenes,
        .label = scene->label,
        .id = {a->id, b->id},
        .name = {a->name, b->name},
        .dim = rows->scene->dim,
        .names_frames = a->body->frame_count > 1 || b->body->frame_count > 1,
        .of = of,
    };
}

static void note_answer(struct report_rows *rows, const struct fmb_client_answer *of)
{
    struct report_summary *summary = &rows->summary;
    const struct fmb_scene *scene = &rows->scene->scene;
    if (of->answer.has_gap)
        summary->gap = fmin(summary->gap, of->answer.gap.bounds[1]);
    if (of->answer.verdict <= summary->all)
        return;
    *summary = (struct report_summary){
        .all = of->answer.verdict, .first = rows->scenes, .gap = summary->gap};
    snprintf(summary->label, sizeof summary->label, "%s", scene->label ? scene->label : "");
    for (int k = 0; k < 2; k++) {
        const struct fmb_placement *body = &scene->placements[k ? of->b : of->a];
        char id[NUMBER_TEXT_MAX];
        snprintf(summary->names[k], sizeof summary->names[k], "%s",
                 report_body(body->name, body->id, id));
    }
}

void report_pair(struct report_rows *rows, const struct fmb_client_answer *of)
{
    const bool near = report_is_near(rows->scene->scene.margin, &of->answer);
    const bool apart = of->answer.verdict == FMB_SEPARATED && !near;
    const struct report_row row = row_of(rows, of);
    rows->count[of->answer.verdict]++;
    rows->near += near;
    note_answer(rows, of);
    if (apart && rows->contacts)
        return;
    if (apart && rows->printer.form == REPORT_TABLE && !rows->all &&
        rows->count[FMB_SEPARATED] - rows->near > REPORT_SEPARATED_MAX) {
        rows->left_out++;
        return;
    }
    if (rows->printer.form == REPORT_TABLE && !rows->begun)
        begin_table(rows);
    report_row_print(&rows->printer, 0, &row);
}

/* ---- The line about all scenes ---- */

void report_end(const struct report_rows *rows)
{
    const struct report_summary *summary = &rows->summary;
    char count[2][NUMBER_TEXT_MAX], gap[NUMBER_TEXT_MAX];
    FILE *out = rows->printer.out;
    const bool met = summary->all > FMB_SEPARATED;
    if (rows->printer.form != REPORT_TABLE || rows->scenes == 0 ||
        (rows->scenes == 1 && rows->shown))
        return;
    fputs(rows->shown ? "\n" : "", out);
    fputs(met ? fmb_verdict_name((int) summary->all) : "no contact", out);
    if (rows->scenes > 1 && met)
        fprintf(out, " in %s of %s scenes, first in scene %" PRId64,
                number_grouped(summary->count, count[0]), number_grouped(rows->scenes, count[1]),
                summary->first);
    else if (rows->scenes > 1)
        fprintf(out, " in %s scenes", number_grouped(rows->scenes, count[1]));
    put_label(out, met && *summary->label ? summary->label : NULL);
    for (int k = 0; k < 2 && met; k++) {
        fputs(k ? " and " : ": ", out);
        escape_text(out, summary->names[k]);
    }
    if (summary->gap < INFINITY)
        fprintf(out, "; least gap %s", number_short(summary->gap, gap));
    putc('\n', out);
}

void report_begin(struct report_rows *rows)
{
    rows->printer.json = (struct json_writer){.out = rows->printer.out};
    rows->summary.gap = INFINITY;
    if (rows->printer.form == REPORT_CSV)
        report_csv_begin(rows->printer.out);
}
