#include "report.h"

#include "escape.h"

#include <inttypes.h>
#include <string.h>

bool report_is_near(double margin, const struct fmb_answer *answer)
{
    return margin > 0 && answer->verdict == FMB_SEPARATED && answer->has_gap &&
           answer->gap.bounds[0] <= margin;
}

static bool has_text(const char *text)
{
    return text && *text;
}

/* ---- JSON ---- */

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
    if (answer->has_point) {
        json_begin(json, "point", '{');
        json_number(json, "time", answer->point[0]);
        json_numbers(json, "position", answer->point + 1, dim);
        json_end(json, '}');
    }
    if (answer->has_gap)
        write_gap(json, dim, &answer->gap, names_frames);
    if (of->certificate)
        json_string(json, "certificate", of->certificate);
}

void report_names_json(struct json_writer *json, const char *const name[2])
{
    if (!has_text(name[0]) && !has_text(name[1]))
        return;
    json_begin(json, "names", '[');
    for (int i = 0; i < 2; i++)
        json_string(json, NULL, has_text(name[i]) ? name[i] : NULL);
    json_end(json, ']');
}

/* ---- CSV ---- */

void report_csv_begin(FILE *out)
{
    fputs(
        "utime,scene,label,a,b,name_a,name_b,verdict,contact_first,contact_last,gap_low,gap_high,"
        "min_x,min_y,min_z,max_x,max_y,max_z,error,point_time,point_x,point_y,point_z\n",
        out);
}

/* A log has millions of rows, most of them without numbers. So integers are not printed by
 * fprintf(), and single characters not with a lock. */
static void csv_integer(FILE *out, int64_t integer)
{
    char text[NUMBER_TEXT_MAX], *digit = text + sizeof text;
    uint64_t rest = integer < 0 ? -(uint64_t) integer : (uint64_t) integer;
    *--digit = ',';
    if (integer != REPORT_NONE) {
        do
            *--digit = (char) ('0' + rest % 10);
        while (rest /= 10);
        if (integer < 0)
            *--digit = '-';
    }
    fwrite(digit, 1, (size_t) (text + sizeof text - digit), out);
}

/* Without the comma after it. */
static void csv_text(FILE *out, const char *text)
{
    if (!has_text(text))
        return;
    putc_unlocked('"', out);
    escape(out, ESCAPE_CSV, text, strlen(text));
    putc_unlocked('"', out);
}

/* Writes a comma and a number for each column; columns from count on are empty. number: [count];
 * NULL: all columns are empty. */
static void csv_numbers(FILE *out, const double *number, int count, int columns)
{
    char text[NUMBER_TEXT_MAX];
    for (int i = 0; i < columns; i++) {
        putc_unlocked(',', out);
        if (number && i < count)
            fputs(number_or_inf(number[i], text), out);
    }
}

void report_row_csv(FILE *out, const struct report_row *row)
{
    const struct fmb_answer *answer = &row->of->answer;
    csv_integer(out, row->utime);
    csv_integer(out, row->scene);
    csv_text(out, row->label);
    putc_unlocked(',', out);
    csv_integer(out, row->id[0]);
    csv_integer(out, row->id[1]);
    for (int i = 0; i < 2; i++) {
        csv_text(out, row->name[i]);
        putc_unlocked(',', out);
    }
    if (row->of->status == FMB_OK)
        fputs(fmb_verdict_name((int) answer->verdict), out);
    csv_numbers(out, answer->has_contact ? answer->contact : NULL, 2, 2);
    csv_numbers(out, answer->has_gap ? answer->gap.bounds : NULL, 2, 2);
    for (int end = 0; end < 2; end++)
        csv_numbers(out, answer->has_box ? answer->box[end] : NULL, row->dim, FMB_DIM_MAX);
    putc_unlocked(',', out);
    csv_text(out, row->of->status == FMB_OK ? "" : row->of->text);
    csv_numbers(out, answer->has_point ? answer->point : NULL, 1 + row->dim, 1 + FMB_DIM_MAX);
    putc_unlocked('\n', out);
}

/* ---- Tables ---- */

enum { BODY_WIDTH = 4, VERDICT_WIDTH = 11, CONTACT_WIDTH = 20, GAP_WIDTH = 12, POINT_WIDTH = 42 };

/* Width of one end of a box. */
enum { END_WIDTH = 8 };

/* Characters of a certificate that are printed. Most are shorter; some have thousands of digits. */
enum { CERTIFICATE_WIDTH = 200 };

/* Bytes of the text of an interval. */
enum { TEXT_MAX = 2 * NUMBER_TEXT_MAX + 8 };

struct report_columns report_columns(void)
{
    struct report_columns columns = {
        .body = BODY_WIDTH, .contact = CONTACT_WIDTH, .gap = GAP_WIDTH, .point = POINT_WIDTH};
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        columns.box[axis][0] = columns.box[axis][1] = END_WIDTH;
    return columns;
}

void report_headings(FILE *out, const struct report_columns *columns, bool gap, bool point,
                     bool box)
{
    fprintf(out, "  %*s  %*s  %-*s  %-*s", columns->body, "a", columns->body, "b", VERDICT_WIDTH,
            "verdict", gap || point || box ? columns->contact : 0, "contact");
    if (gap)
        fprintf(out, "  %-*s", point || box ? columns->gap : 0, "gap");
    if (point)
        fprintf(out, "  %-*s", box ? columns->point : 0, "point");
    fputs(box ? "  box\n" : "\n", out);
}

/* Returns the width to print text with. A longer text widens the column for the rows below it. */
static int widen(int *width, const char *text)
{
    const int length = (int) strlen(text);
    *width = length > *width ? length : *width;
    return *width;
}

const char *report_point(int dim, const double *point, char text[REPORT_POINT_MAX])
{
    char number[1 + FMB_DIM_MAX][NUMBER_TEXT_MAX];
    for (int i = 0; i <= dim; i++)
        number_short(point[i], number[i]);
    snprintf(text, REPORT_POINT_MAX, "(%s, %s%s%s) at %s s", number[1], number[2],
             dim > 2 ? ", " : "", dim > 2 ? number[3] : "", number[0]);
    return text;
}

/* The ends are aligned in columns, so that boxes in successive rows can be compared. There are no
 * blanks at the end of the line. */
static void text_box(FILE *out, int dim, const struct fmb_answer *answer,
                     struct report_columns *columns)
{
    char low[NUMBER_TEXT_MAX], high[NUMBER_TEXT_MAX];
    for (int axis = 0; axis < dim; axis++) {
        bool last = axis == dim - 1;
        number_ends(answer->box[0][axis], answer->box[1][axis], low, high);
        fprintf(out, "  %c %*s .. %-*s", "xyz"[axis], widen(&columns->box[axis][0], low), low,
                last ? 0 : widen(&columns->box[axis][1], high), high);
    }
}

static void text_answer(FILE *out, int dim, const struct fmb_answer *answer,
                        struct report_columns *columns)
{
    char text[TEXT_MAX] = "", point[REPORT_POINT_MAX];
    char low[NUMBER_TEXT_MAX], high[NUMBER_TEXT_MAX];
    const bool beyond = answer->has_point || answer->has_box;
    const char *verdict = fmb_verdict_name((int) answer->verdict);
    if (!answer->has_contact && !answer->has_gap) {
        fputs(verdict, out);
        return;
    }
    if (answer->has_contact) {
        number_ends(answer->contact[0], answer->contact[1], low, high);
        snprintf(text, TEXT_MAX, "%s to %s s", low, high);
    }
    fprintf(out, "%-*s  %-*s", VERDICT_WIDTH, verdict,
            answer->has_gap || beyond ? widen(&columns->contact, text) : 0, text);
    if (answer->has_gap) { /* one number if both have the same digits */
        number_short(answer->gap.bounds[0], low);
        number_short(answer->gap.bounds[1], high);
        snprintf(text, TEXT_MAX, strcmp(low, high) == 0 ? "%s" : "%s .. %s", low, high);
        fprintf(out, "  %-*s", beyond ? widen(&columns->gap, text) : 0, text);
    }
    if (answer->has_point) {
        report_point(dim, answer->point, point);
        const int width = widen(&columns->point, point);
        fprintf(out, "  %-*s", answer->has_box ? width : 0, point);
    }
    if (answer->has_box)
        text_box(out, dim, answer, columns);
}

static void text_certificate(FILE *out, int indent, const char *certificate)
{
    char length[NUMBER_TEXT_MAX];
    size_t characters = strlen(certificate);
    fprintf(out, "%*s%.*s", indent, "", CERTIFICATE_WIDTH, certificate);
    if (characters > CERTIFICATE_WIDTH)
        fprintf(out, "... (%s characters)", number_grouped((int64_t) characters, length));
    putc('\n', out);
}

const char *report_body(const char *name, int64_t id, char text[NUMBER_TEXT_MAX])
{
    snprintf(text, NUMBER_TEXT_MAX, "%" PRId64, id);
    return has_text(name) ? name : text;
}

int report_body_width(const char *name, int64_t id)
{
    char text[NUMBER_TEXT_MAX];
    return (int) escape_characters(report_body(name, id, text));
}

static void row_text(FILE *out, int indent, const struct report_row *row,
                     struct report_columns *columns)
{
    for (int i = 0; i < 2; i++) {
        char text[NUMBER_TEXT_MAX];
        const char *name = report_body(row->name[i], row->id[i], text);
        const int width = report_body_width(row->name[i], row->id[i]);
        columns->body = width > columns->body ? width : columns->body;
        fprintf(out, "  %*s", columns->body - width, "");
        escape_text(out, name);
    }
    fputs("  ", out);
    if (row->of->status != FMB_OK)
        fprintf(out, "not decided: %s", row->of->text);
    else
        text_answer(out, row->dim, &row->of->answer, columns);
    putc('\n', out);
    if (row->of->certificate)
        text_certificate(out, indent + 2 * columns->body + 6, row->of->certificate);
}

void report_row_print(struct report_printer *printer, int indent, const struct report_row *row)
{
    if (printer->form == REPORT_TABLE) {
        row_text(printer->out, indent, row, &printer->columns);
    } else if (printer->form == REPORT_CSV) {
        report_row_csv(printer->out, row);
    } else {
        struct json_writer *json = &printer->json;
        json_begin(json, NULL, '{');
        json_integer(json, "a", row->id[0]);
        json_integer(json, "b", row->id[1]);
        report_names_json(json, row->name);
        report_answer_json(json, row->dim, row->names_frames, row->of);
        json_end(json, '}');
    }
}
