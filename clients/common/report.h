/* Prints answers: a row is a pair of bodies and its answer, in a table, in JSON or in CSV. */
#ifndef REPORT_H
#define REPORT_H

#include "fmb_client.h"
#include "json_write.h"
#include "number.h"
#include "query.h"
#include "scene.h"

#include <stdio.h>

/* ---- Rows ---- */

enum report_form { REPORT_TABLE, REPORT_JSON, REPORT_CSV };

/* The value of an integer that a row does not have. */
#define REPORT_NONE INT64_MIN

/* Texts may be any bytes, zero-terminated; NULL or "": none. */
struct report_row {
    int64_t utime;     /* of the query, microseconds since 1970; REPORT_NONE: not known */
    int64_t scene;     /* its number; REPORT_NONE: not known */
    const char *label; /* of the scene */
    int64_t id[2];     /* 0: anonymous; REPORT_NONE: not known */
    const char *name[2];
    int dim;                            /* of box, point and gap */
    bool names_frames;                  /* of the gap: a body has several frames */
    const struct fmb_client_answer *of; /* a and b are not used */
};

/* Whether a separated pair is near: its scene has a margin, and the gap is no larger. */
bool report_is_near(double margin, const struct fmb_answer *answer);

/* Write members of a row in JSON (report_row_print()): those from the verdict on, and "names". */
void report_answer_json(struct json_writer *json, int dim, bool names_frames,
                        const struct fmb_client_answer *answer);
void report_names_json(struct json_writer *json, const char *const name[2]);

/* Write CSV: the line of column names, and a row. RFC 4180, but lines end in a line feed alone.
 * Columns without a value are empty; texts are quoted and have no control characters; doubles read
 * back bit for bit, infinite ones are inf and -inf. */
void report_csv_begin(FILE *out);
void report_row_csv(FILE *out, const struct report_row *row);

/* The widths of the columns of a table. A row with longer texts widens them for the rows below it.
 */
struct report_columns {
    int body, contact, gap, point;
    int box[FMB_DIM_MAX][2]; /* [axis][low, high] */
};

/* Writes a point of a contact for readers, such as "(0.75, 0.5, 0) at 0.25 s". Returns text. In:
 * point: the time, then dim coordinates. */
enum { REPORT_POINT_MAX = (1 + FMB_DIM_MAX) * NUMBER_TEXT_MAX + 16 };
const char *report_point(int dim, const double *point, char text[REPORT_POINT_MAX]);

/* Returns the name, or else the id, which is written into text. */
const char *report_body(const char *name, int64_t id, char text[NUMBER_TEXT_MAX]);

/* Returns the number of characters of a name, or else of an id. */
int report_body_width(const char *name, int64_t id);

/* Returns the widths for ids of up to four digits and numbers of up to six. */
struct report_columns report_columns(void);

/* Prints the line of column names. gap, point, box: whether rows have them. */
void report_headings(FILE *out, const struct report_columns *columns, bool gap, bool point,
                     bool box);

/* A destination of rows. */
struct report_printer {
    FILE *out; /* not owned */
    enum report_form form;
    struct json_writer json;       /* with the same out */
    struct report_columns columns; /* of the table */
};

/* Prints a row.
 *
 * In JSON it is an element of an array:
 *
 *     {"a": 1, "b": 2, "names": ["table", null], "verdict": "overlapping", "contact": [0, 1],
 *      "box": {"min": [0.5,0,0], "max": [1,1,1]},
 *      "point": {"time": 0.5, "position": [0.75,0.5,0.5]}, "gap": [-0.25, -0.25],
 *      "frames": [0, 3], "direction": [0,0,1]}
 *
 *     {"a": 1, "b": 3, "verdict": "separated", "gap": [2, 2], "direction": [1,0,0],
 *      "witness": {"time": 0, "a": [1,0,0], "b": [3,0,0]}}
 *
 * "names" is present if a body has a name, "witness" if the gap has one (fmb.h). frames are the
 * indices, from 0, of the frames of a and b that have the gap, where a or b has several. Doubles
 * read back bit for bit. null is an infinite end of a box, outward; an infinite bound of a gap,
 * positive if the pair is separated, negative if it overlaps; or an infinite coordinate of a point.
 * A "certificate" comes last; a pair that could not be decided has an "error" in place of the
 * verdict.
 *
 * In a table it is a line for people; a certificate, which is shortened if it is long, has a line
 * of its own. indent: the columns of the line that are printed already.
 *
 *      table  cube  overlapping  0.25 to 0.5 s         -0.5          x        0 .. 1 ... */
void report_row_print(struct report_printer *printer, int indent, const struct report_row *row);

/* ---- Scenes ---- */

/* Most rows of separated pairs that are not near in the table of a scene, unless all are wanted. */
enum { REPORT_SEPARATED_MAX = 20 };

/* What the last line says of all scenes. */
struct report_summary {
    enum fmb_verdict all; /* the strongest; 0: none */
    int64_t count, first; /* scenes that have it, and the first of them */
    char label[QUERY_NAME_MAX + 1], names[2][QUERY_NAME_MAX + 1]; /* of the first, and its pair */
    double gap;                                                   /* least upper bound */
};

/* Prints the rows of scenes, which are numbered from 1: one line of JSON for each, {"label": ...,
 * "pairs": [...]}; or CSV; or tables, each with counts at its end. Numbers in tables have six
 * digits, or more where the ends of an interval would have the same digits. Flushed at the end of
 * each scene. */
struct report_rows {
    /* Set by the caller. */
    struct report_printer printer; /* out and form */
    bool box, gap, point;          /* wanted: columns of tables */
    bool contacts, all;            /* rows: no separated pairs but near ones; in tables all */
    /* Private. */
    struct owned_scene *scene;
    int64_t scenes;
    bool begun;                          /* the table of this scene has begun */
    bool shown;                          /* an earlier scene had a table */
    uint64_t count[FMB_OVERLAPPING + 1]; /* [verdict] of the scene; [0]: not decided */
    uint64_t near, left_out;             /* of those separated */
    struct report_summary summary;
};

/* For CSV, writes the column names. In: the members of rows that the caller sets. */
void report_begin(struct report_rows *rows);

/* For each scene: its begin, each answer in the order of the pairs, and its end. */
void report_begin_scene(struct report_rows *rows, struct owned_scene *scene);
void report_pair(struct report_rows *rows, const struct fmb_client_answer *answer);
void report_end_scene(struct report_rows *rows);

/* To be called after the last scene. After tables of several scenes, and where no scene had a
 * table, prints how many scenes have a contact and the first of them. */
void report_end(const struct report_rows *rows);

#endif
