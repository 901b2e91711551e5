#include "mesh_report.h"

#include "escape.h"
#include "json_write.h"
#include "number.h"

/* ---- For people ------------------------------------------------------------------------------ */

static void put_count(FILE *out, uint64_t count, const char *what)
{
    char text[NUMBER_TEXT_MAX];
    fprintf(out, "%14s  %s\n", number_grouped((int64_t) count, text), what);
}

static void put_faces(FILE *out, const struct mesh_report *report, int which)
{
    char in_pairs[NUMBER_TEXT_MAX], all[NUMBER_TEXT_MAX];
    fprintf(out, "%14s  of %s faces of ",
            number_grouped((int64_t) report->intersection->faces[which], in_pairs),
            number_grouped((int64_t) report->mesh[which]->face_count, all));
    escape_text(out, report->name[which]);
    putc('\n', out);
}

/* The first and the last time at which any two faces are in contact. */
static void put_times(FILE *out, const struct mesh_intersection *intersection)
{
    double first = intersection->pair[0].contact[0], last = intersection->pair[0].contact[1];
    char first_text[NUMBER_TEXT_MAX], last_text[NUMBER_TEXT_MAX];
    for (size_t i = 1; i < intersection->count; i++) {
        const double *contact = intersection->pair[i].contact;
        first = contact[0] < first ? contact[0] : first;
        last = contact[1] > last ? contact[1] : last;
    }
    number_ends(first, last, first_text, last_text);
    fprintf(out, "faces meet first at %s s, and last at %s s\n", first_text, last_text);
}

void mesh_report_text(FILE *out, const struct mesh_report *report)
{
    const struct mesh_intersection *intersection = report->intersection;
    put_count(out, intersection->count,
              intersection->count == 1 ? "pair of faces meets:" : "pairs of faces meet:");
    put_count(out, intersection->overlapping, "overlap");
    put_count(out, intersection->touching, "touch");
    fputs("in them are\n", out);
    put_faces(out, report, 0);
    put_faces(out, report, 1);
    if (intersection->moving && intersection->count > 0)
        put_times(out, intersection);
    if (intersection->count == 0)
        fputs("only surfaces are compared: one mesh may lie inside the other\n", out);
}

/* ---- JSON ------------------------------------------------------------------------------------ */

static void put_pair_json(struct json_writer *json, const struct mesh_pair *pair, bool moving)
{
    json_begin(json, NULL, '[');
    json_integer(json, NULL, pair->a);
    json_integer(json, NULL, pair->b);
    json_string(json, NULL, fmb_verdict_name((int) pair->verdict));
    if (moving) {
        json_begin(json, NULL, '[');
        json_number(json, NULL, pair->contact[0]);
        json_number(json, NULL, pair->contact[1]);
        json_end(json, ']');
    }
    json_end(json, ']');
}

void mesh_report_json(FILE *out, const struct mesh_report *report)
{
    const struct mesh_intersection *intersection = report->intersection;
    struct json_writer json = json_object(out);
    json_integer(&json, "overlapping", (int64_t) intersection->overlapping);
    json_integer(&json, "touching", (int64_t) intersection->touching);
    json_integer(&json, "faces_a", (int64_t) intersection->faces[0]);
    json_integer(&json, "faces_b", (int64_t) intersection->faces[1]);
    json_begin(&json, "pairs", '[');
    for (size_t i = 0; i < intersection->count; i++)
        put_pair_json(&json, &intersection->pair[i], intersection->moving);
    json_end(&json, ']');
    json_object_end(&json);
}
