#include "report.h"

#include "escape.h"

#include <math.h>
#include <string.h>

enum { VERDICT_WIDTH = 11, CONTACT_WIDTH = 20, GAP_WIDTH = 12 };

/* Characters of a certificate that are printed. Most are shorter; some have thousands of digits. */
enum { CERTIFICATE_WIDTH = 200 };

/* Widths of one end of a box: for small numbers, and for those that %g prints with an exponent. */
enum { END_WIDTH = 8, LARGE_END_WIDTH = 12 };
static const double large_end = 1e5;

struct report_columns report_columns(void)
{
    struct report_columns columns = {.contact = CONTACT_WIDTH, .gap = GAP_WIDTH};
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        columns.box[axis][0] = columns.box[axis][1] = END_WIDTH;
    return columns;
}

/* A table of large coordinates, such as those of maps, has wide columns from its first row on. */
static struct report_columns columns_for(const struct owned_scene *scene)
{
    struct report_columns columns = report_columns();
    for (size_t i = 0; i < scene->scene.placement_count; i++)
        for (int axis = 0; axis < scene->dim; axis++)
            if (fabs(scene->scene.placements[i].position[axis]) >= large_end)
                columns.box[axis][0] = columns.box[axis][1] = LARGE_END_WIDTH;
    return columns;
}

/* Returns the width to print text with. If it has more digits than usual, the rows below probably
 * have too: the column becomes wider. Any other text that is too long exceeds its column. */
static int widen(int *width, int digits, const char *text)
{
    int length = (int) strlen(text);
    if (digits > NUMBER_SHORT_DIGITS && length > *width)
        *width = length;
    return *width;
}

int report_contact_text(const struct fmb_answer *answer, char text[REPORT_TEXT_MAX])
{
    char first[NUMBER_TEXT_MAX], last[NUMBER_TEXT_MAX];
    int digits = number_ends(answer->contact[0], answer->contact[1], first, last);
    snprintf(text, REPORT_TEXT_MAX, "%s to %s s", first, last);
    return digits;
}

/* Writes one number if the bounds have the same digits. */
static int write_gap(const struct fmb_gap *gap, char text[REPORT_TEXT_MAX])
{
    char low[NUMBER_TEXT_MAX], high[NUMBER_TEXT_MAX];
    number_short(gap->bounds[0], low);
    number_short(gap->bounds[1], high);
    const bool same = strcmp(low, high) == 0;
    snprintf(text, REPORT_TEXT_MAX, same ? "%s" : "%s .. %s", low, high);
    return same ? NUMBER_SHORT_DIGITS : NUMBER_SHORT_DIGITS + 1;
}

/* The ends are aligned in columns, so that boxes in successive rows can be compared. There are no
 * blanks at the end of the line. */
static void write_box(FILE *out, int dim, const struct fmb_answer *answer,
                      struct report_columns *columns)
{
    char low[NUMBER_TEXT_MAX], high[NUMBER_TEXT_MAX];
    for (int axis = 0; axis < dim; axis++) {
        bool last = axis == dim - 1;
        int digits = number_ends(answer->box[0][axis], answer->box[1][axis], low, high);
        fprintf(out, "  %c %*s .. %-*s", "xyz"[axis], widen(&columns->box[axis][0], digits, low),
                low, last ? 0 : widen(&columns->box[axis][1], digits, high), high);
    }
}

void report_answer_text(FILE *out, int dim, const struct fmb_answer *answer,
                        struct report_columns *columns)
{
    char text[REPORT_TEXT_MAX] = "";
    const char *verdict = fmb_verdict_name((int) answer->verdict);
    if (!answer->has_contact && !answer->has_gap) {
        fputs(verdict, out);
        return;
    }
    int digits = answer->has_contact ? report_contact_text(answer, text) : 0;
    fprintf(out, "%-*s  %-*s", VERDICT_WIDTH, verdict,
            answer->has_gap || answer->has_box ? widen(&columns->contact, digits, text) : 0, text);
    if (answer->has_gap) {
        digits = write_gap(&answer->gap, text);
        fprintf(out, "  %-*s", answer->has_box ? widen(&columns->gap, digits, text) : 0, text);
    }
    if (answer->has_box)
        write_box(out, dim, answer, columns);
}

/* Prints a certificate below its verdict. */
static void write_certificate(FILE *out, int column, const char *certificate)
{
    char length[NUMBER_TEXT_MAX];
    size_t characters = strlen(certificate);
    fprintf(out, "%*s%.*s", column, "", CERTIFICATE_WIDTH, certificate);
    if (characters > CERTIFICATE_WIDTH)
        fprintf(out, "... (%s characters)", number_grouped((int64_t) characters, length));
    putc('\n', out);
}

/* Returns the width of the name or id of a body, in characters. */
static int label_width(const struct fmb_placement *body)
{
    char text[SCENE_LABEL_MAX];
    return (int) escape_characters(scene_label(body, text));
}

static void write_label(FILE *out, int width, const struct fmb_placement *body)
{
    char text[SCENE_LABEL_MAX];
    fprintf(out, "  %*s%s", width - label_width(body), "", scene_label(body, text));
}

static void write_headings(const struct report_text *text, bool gap)
{
    fprintf(text->out, "  %*s  %*s  %-*s  %-*s", text->id_width, "a", text->id_width, "b",
            VERDICT_WIDTH, "verdict", gap || text->box ? text->columns.contact : 0, "contact");
    if (gap)
        fprintf(text->out, "  %-*s", text->box ? text->columns.gap : 0, "gap");
    fputs(text->box ? "  box\n" : "\n", text->out);
}

static void text_begin(struct report *report)
{
    struct report_text *text = (struct report_text *) report;
    const struct fmb_scene *scene = &report->scene->scene;
    char duration[NUMBER_TEXT_MAX], pairs[NUMBER_TEXT_MAX];
    memset(text->count, 0, sizeof text->count);
    text->near = 0;
    text->columns = columns_for(report->scene);
    text->id_width = 1;
    for (size_t i = 0; i < scene->placement_count; i++) {
        const int width = label_width(&scene->placements[i]);
        text->id_width = width > text->id_width ? width : text->id_width;
    }
    uint64_t count = scene_count_pairs(report->scene);
    fprintf(text->out, "%sscene %zu: %zu bod%s in %dD, %s pair%s, 0 to %s s\n",
            text->scenes > 0 ? "\n" : "", text->scenes + 1, scene->placement_count,
            scene->placement_count == 1 ? "y" : "ies", report->scene->dim,
            number_grouped((int64_t) count, pairs), count == 1 ? "" : "s",
            number_short(scene->duration, duration));
    text->scenes++;
    if (count > 0)
        write_headings(text, text->gap || scene->margin > 0);
}

static void text_pair(struct report *report, const struct fmb_client_answer *of)
{
    struct report_text *text = (struct report_text *) report;
    const struct fmb_scene *scene = &report->scene->scene;
    const struct fmb_answer *answer = &of->answer;
    write_label(text->out, text->id_width, &scene->placements[of->a]);
    write_label(text->out, text->id_width, &scene->placements[of->b]);
    fputs("  ", text->out);
    if (of->status != FMB_OK)
        fprintf(text->out, "not decided: %s", of->text);
    else
        report_answer_text(text->out, report->scene->dim, answer, &text->columns);
    putc('\n', text->out);
    if (of->certificate)
        write_certificate(text->out, 2 * text->id_width + 6, of->certificate);
    text->count[answer->verdict]++;
    text->near += answer->verdict == FMB_SEPARATED && answer->has_gap &&
                  answer->gap.bounds[0] <= scene->margin;
}

static void text_end(struct report *report)
{
    struct report_text *text = (struct report_text *) report;
    static const enum fmb_verdict order[] = {FMB_OVERLAPPING, FMB_TOUCHING, FMB_SEPARATED};
    char count[NUMBER_TEXT_MAX];
    for (int i = 0; i < 3; i++)
        fprintf(text->out, "%s%s %s", i ? ", " : "",
                number_grouped((int64_t) text->count[order[i]], count),
                fmb_verdict_name((int) order[i]));
    if (report->scene->scene.margin > 0)
        fprintf(text->out, " (%s near)", number_grouped((int64_t) text->near, count));
    if (text->count[0] > 0)
        fprintf(text->out, ", %s not decided", number_grouped((int64_t) text->count[0], count));
    putc('\n', text->out);
    fflush(text->out);
}

struct report_text report_text(FILE *out, bool box, bool gap)
{
    return (struct report_text){
        .report = {text_begin, text_pair, text_end, NULL}, .out = out, .box = box, .gap = gap};
}
