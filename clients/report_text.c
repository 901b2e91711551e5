#include "report.h"

#include "number.h"

#include <inttypes.h>
#include <string.h>

enum { VERDICT_WIDTH = 11, CONTACT_WIDTH = 20 };

const char *report_contact_text(const struct fmb_answer *answer, char text[REPORT_TEXT_MAX])
{
    char first[NUMBER_TEXT_MAX], last[NUMBER_TEXT_MAX];
    snprintf(text, REPORT_TEXT_MAX, "%s to %s s", number_short(answer->contact[0], first),
             number_short(answer->contact[1], last));
    return text;
}

/* The ends stand in columns, so that boxes below each other can be compared. */
static const char *box_text(int dim, const struct fmb_answer *answer, char text[REPORT_TEXT_MAX])
{
    char low[NUMBER_TEXT_MAX], high[NUMBER_TEXT_MAX];
    int used = 0;
    for (int axis = 0; axis < dim; axis++)
        used += snprintf(text + used, REPORT_TEXT_MAX - (size_t) used,
                         axis < dim - 1 ? "%c %8s .. %-8s  " : "%c %8s .. %s", "xyz"[axis],
                         number_short(answer->box[0][axis], low),
                         number_short(answer->box[1][axis], high));
    return text;
}

/* No blanks at the end of a line. */
void report_answer_text(FILE *out, int dim, const struct fmb_answer *answer)
{
    char contact[REPORT_TEXT_MAX] = "", box[REPORT_TEXT_MAX];
    const char *verdict = fmb_verdict_name((int) answer->verdict);
    if (answer->has_contact)
        report_contact_text(answer, contact);
    if (answer->has_box)
        fprintf(out, "%-*s  %-*s  %s", VERDICT_WIDTH, verdict, CONTACT_WIDTH, contact,
                box_text(dim, answer, box));
    else if (answer->has_contact)
        fprintf(out, "%-*s  %s", VERDICT_WIDTH, verdict, contact);
    else
        fputs(verdict, out);
}

static int width_of(int64_t id)
{
    return snprintf(NULL, 0, "%" PRId64, id);
}

static const char *plural(uint64_t count)
{
    return count == 1 ? "" : "s";
}

static void text_begin(struct report *report, const struct scene *scene)
{
    struct report_text *text = (struct report_text *) report;
    char duration[NUMBER_TEXT_MAX], pairs[NUMBER_TEXT_MAX];
    memset(text->count, 0, sizeof text->count);
    text->id_width = 1;
    for (size_t i = 0; i < scene->body_count; i++)
        if (width_of(scene->body[i].id) > text->id_width)
            text->id_width = width_of(scene->body[i].id);
    uint64_t count = scene_count_pairs(scene);
    fprintf(text->out, "%sscene %zu: %zu bod%s in %dD, %s pair%s, 0 to %s s\n",
            text->scenes > 0 ? "\n" : "", text->scenes + 1, scene->body_count,
            scene->body_count == 1 ? "y" : "ies", scene->dim,
            number_grouped((int64_t) count, pairs), plural(count),
            number_short(scene->duration, duration));
    text->scenes++;
    if (count > 0)
        fprintf(text->out, "  %*s  %*s  %-*s  %-*s%s\n", text->id_width, "a", text->id_width, "b",
                VERDICT_WIDTH, "verdict", text->box ? CONTACT_WIDTH : 0, "contact",
                text->box ? "  box" : "");
}

static void text_pair(struct report *report, const struct scene *scene,
                      const struct outcome *outcome)
{
    struct report_text *text = (struct report_text *) report;
    fprintf(text->out, "  %*" PRId64 "  %*" PRId64 "  ", text->id_width,
            scene->body[outcome->pair.a].id, text->id_width, scene->body[outcome->pair.b].id);
    if (outcome->error)
        fprintf(text->out, "not decided: %s", outcome->error);
    else
        report_answer_text(text->out, scene->dim, &outcome->answer);
    putc('\n', text->out);
    text->count[outcome->answer.verdict]++;
}

static void text_end(struct report *report, const struct scene *scene)
{
    struct report_text *text = (struct report_text *) report;
    static const enum fmb_verdict order[] = {FMB_OVERLAPPING, FMB_TOUCHING, FMB_SEPARATED};
    char count[NUMBER_TEXT_MAX];
    (void) scene;
    for (int i = 0; i < 3; i++)
        fprintf(text->out, "%s%s %s", i ? ", " : "",
                number_grouped((int64_t) text->count[order[i]], count),
                fmb_verdict_name((int) order[i]));
    if (text->count[0] > 0)
        fprintf(text->out, ", %s not decided", number_grouped((int64_t) text->count[0], count));
    putc('\n', text->out);
    fflush(text->out);
}

struct report_text report_text(FILE *out, bool box)
{
    return (struct report_text){
        .report = {text_begin, text_pair, text_end}, .out = out, .box = box};
}
