/* Prints answers. A struct report is an output format. */
#ifndef REPORT_H
#define REPORT_H

#include "fmb_client.h"
#include "json_write.h"
#include "number.h"
#include "scene.h"

#include <stdio.h>

/* For each scene, the caller sets scene, and calls begin, then pair for each answer in the order of
 * the pairs, then end. */
struct report {
    void (*begin)(struct report *report);
    void (*pair)(struct report *report, const struct fmb_client_answer *answer);
    void (*end)(struct report *report);
    struct owned_scene *scene;
};

/* One line, one JSON object, for each scene; flushed at its end:
 *
 *     {"label": "shelf",
 *      "pairs": [{"a": 1, "b": 2, "verdict": "overlapping", "contact": [0, 1],
 *                 "box": {"min": [0.5,0,0], "max": [1,1,1]},
 *                 "gap": [-0.25, -0.25], "frames": [0, 3], "direction": [0,0,1]},
 *                {"a": 1, "b": 3, "verdict": "separated", "gap": [2, 2], "direction": [1,0,0],
 *                 "witness": {"time": 0, "a": [1,0,0], "b": [3,0,0]}}]}
 *
 * label is that of the scene, where it has one. frames are the indices, from 0, of the frames of a
 * and b that have the gap, where a or b has several. Doubles read back bit for bit. null is an
 * infinite end of a box, outward; or an infinite bound of a gap, positive where separated, else
 * negative. A "certificate" comes last; a pair that could not be decided has an "error" in place of
 * the verdict. */
struct report_json {
    struct report report;
    struct json_writer json;
};

struct report_json report_json(FILE *out);

/* The widths of the columns of a table. A row with numbers of more digits than usual widens them
 * for the rows below it. */
struct report_columns {
    int contact, gap;
    int box[FMB_DIM_MAX][2]; /* [axis][low, high] */
};

/* Returns the widths for numbers of up to six digits. */
struct report_columns report_columns(void);

/* A table for people, and counts at its end. Numbers have six digits, or more where the ends of an
 * interval would have the same digits. Certificates are printed below their rows, long ones
 * shortened. */
struct report_text {
    struct report report;
    FILE *out;
    bool box, gap; /* wanted; each has a column */
    size_t scenes;
    int id_width;                        /* of names, or else ids */
    struct report_columns columns;       /* of the scene */
    uint64_t count[FMB_OVERLAPPING + 1]; /* [verdict] of the scene; [0]: not decided */
    uint64_t near;                       /* of those separated, where the scene has a margin */
};

struct report_text report_text(FILE *out, bool box, bool gap);

/* Writes the members of an answer as report_json does, without braces: "verdict": ..., or
 * "error": ... a and b are not used. names_frames: a body has several frames. */
void report_answer_json(struct json_writer *json, int dim, bool names_frames,
                        const struct fmb_client_answer *answer);

/* Prints verdict, contact, gap and box for people, in columns, without a line feed:
 *
 *     overlapping  0.25 to 0.5 s         -0.5          x        0 .. 1         y     -0.5 .. 0.5 */
void report_answer_text(FILE *out, int dim, const struct fmb_answer *answer,
                        struct report_columns *columns);

/* Writes the contact interval, such as "0.25 to 0.5 s", into text. Returns the number of digits. */
enum { REPORT_TEXT_MAX = 2 * NUMBER_TEXT_MAX + 8 };
int report_contact_text(const struct fmb_answer *answer, char text[REPORT_TEXT_MAX]);

#endif
