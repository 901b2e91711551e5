#include "report.h"

#include "escape.h"

#include <inttypes.h>
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

static void begin_json(struct report_rows *rows)
{
    json_begin(&rows->printer.json, NULL, '{');
    if (rows->scene->scene.label)
        json_string(&rows->printer.json, "label", rows->scene->scene.label);
    json_begin(&rows->printer.json, "pairs", '[');
}

static void begin_table(struct report_rows *rows)
{
    const struct fmb_scene *scene = &rows->scene->scene;
    const uint64_t count = scene_count_pairs(rows->scene);
    char duration[NUMBER_TEXT_MAX], pairs[NUMBER_TEXT_MAX];
    rows->begun = true;
    rows->printer.columns = columns_for(rows->scene);
    fprintf(rows->printer.out, "%sscene %" PRId64, rows->scenes > rows->apart + 1 ? "\n" : "",
            rows->scenes);
    if (scene->label) {
        fputs(" (", rows->printer.out);
        escape_text(rows->printer.out, scene->label);
        putc(')', rows->printer.out);
    }
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
    if (rows->printer.form == REPORT_JSON)
        begin_json(rows);
    else if (rows->printer.form == REPORT_TABLE && !rows->contacts)
        begin_table(rows);
}

void report_end_scene(struct report_rows *rows)
{
    if (rows->printer.form == REPORT_JSON) {
        json_end(&rows->printer.json, ']');
        json_object_end(&rows->printer.json);
    } else if (rows->printer.form == REPORT_TABLE && rows->begun) {
        end_table(rows);
    }
    rows->apart += !rows->begun;
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

void report_pair(struct report_rows *rows, const struct fmb_client_answer *of)
{
    const bool near = report_is_near(rows->scene->scene.margin, &of->answer);
    const bool apart = of->answer.verdict == FMB_SEPARATED && !near;
    const struct report_row row = row_of(rows, of);
    rows->count[of->answer.verdict]++;
    rows->near += near;
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

void report_end(const struct report_rows *rows)
{
    char apart[NUMBER_TEXT_MAX], scenes[NUMBER_TEXT_MAX];
    if (rows->printer.form != REPORT_TABLE || rows->apart == 0)
        return;
    if (rows->scenes == 1)
        fputs("no contacts\n", rows->printer.out);
    else
        fprintf(rows->printer.out, "%sno contacts in %s of %s scenes\n",
                rows->apart < rows->scenes ? "\n" : "", number_grouped(rows->apart, apart),
                number_grouped(rows->scenes, scenes));
}

void report_begin(struct report_rows *rows)
{
    rows->printer.json = (struct json_writer){.out = rows->printer.out};
    if (rows->printer.form == REPORT_CSV)
        report_csv_begin(rows->printer.out);
}
