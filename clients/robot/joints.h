/* Values of the joints of a robot: from a text, and from the rows of a CSV file. Values outside the
 * limits of their joints are used unchanged, and reported or refused at the end. Errors are
 * reported on stderr, each in one line. */
#ifndef JOINTS_H
#define JOINTS_H

#include "query.h"
#include "robot.h"

#include <stdio.h>

/* A value to be reported: of which joint, and where it is given. */
struct joint_report {
    double value, by; /* by: a length or angle, such as that by which it is outside its limits */
    size_t joint;
    const char *path;
    unsigned long line; /* 0: none */
};

struct joints {
    const struct robot *robot;
    double *value; /* [joint_count]; robot_home() if neither given nor of a mimic joint */
    /* Whether a value exceeds its limits by more than the slack, or is too large for an angle. If
     * so, robot_place() must not be called. */
    bool refused;
    /* Private. */
    bool *given;                  /* [joint_count]: by the text, or in a column */
    double slack;                 /* by which values may exceed limits */
    struct joint_report *outside; /* [joint_count]: farthest value of each joint; by is 0: none */
    size_t outside_count;         /* number of values */
    struct joint_report full;     /* largest value that may be in degrees */
    struct joint_report mimic; /* difference between a given mimic joint and what it would follow */
};

/* In: text: "name=value,name=value"; NULL: none. slack: at least 0. Returns false after an error.
 * The caller passes the joints to joints_clear() in either case. */
bool joints_open(const struct robot *robot, const char *text, double slack, struct joints *out);
void joints_clear(struct joints *joints);

/* Sets the mimic joints that are not given, from the values of the joints that they follow. path
 * and line: place of these values, for messages. joint_table_read() calls it for each row. */
void joints_follow(struct joints *joints, const char *path, unsigned long line);

/* Returns whether all values are within the slack. If not, reports the farthest value of each joint
 * that exceeds it, and whether values seem to be in degrees: more than a full turn of a joint
 * without limits, or outside the limits. */
bool joints_check(const struct joints *joints);

/* Describes values that joints_check() accepts: joints that are not at 0 although no value is
 * given, values outside the limits, values that seem to be in degrees, and mimic joints that do not
 * follow. Writes nothing if there are none. before: text before the first part; semicolons separate
 * the parts. */
void joints_describe(const struct joints *joints, const char *before, FILE *out);

struct joint_row {
    unsigned long line;  /* in the file, from 1 */
    double time;         /* not before the time of the previous row; NAN: there is no column */
    const char *label;   /* "label (t = 0.5)", "label", "t = 0.5"; or NULL */
    const double *value; /* [joint_count], of all joints of the tree */
};

/* A CSV file (RFC 4180, without line breaks in fields). Its first line has the names of columns, in
 * any order: one for each joint that moves and has no value in joints. Columns of mimic joints,
 * "time", in seconds, and "label" are optional; others are ignored. */
struct joint_table {
    const char *path; /* or "standard input" */
    bool has_time;
    struct joint_row *rows; /* owned, [row_count]; at least one if joint_table_read() succeeded */
    size_t row_count;
    /* Private. */
    struct joints *joints;
    FILE *file;
    unsigned long line; /* the last one that was read */
    char *text, *place; /* owned: of this line, and where it is, for messages */
    char **field;       /* owned: of the line; [columns] */
    unsigned *column;   /* owned: [columns], the joint */
    size_t columns, row_capacity;
    size_t fixed, unknown;                 /* columns that are ignored */
    char unknown_name[QUERY_NAME_MAX + 1]; /* of the first one */
    struct joint_report step;              /* largest step of a joint from row to row */
    struct owned_scene memory;             /* of values and labels */
};

/* Reads a file; "-" is standard input. joints: receives the values of each row; at the end it has
 * the values of the last row. Memory: all rows, and 1 MB for a line. Returns false after an error.
 * The caller passes the table to joint_table_clear() in either case. */
bool joint_table_read(const char *path, struct joints *joints, struct joint_table *out);
void joint_table_clear(struct joint_table *table);

/* Returns where a row is, for messages: its file and line. Valid until the next call. */
const char *joint_table_place(struct joint_table *table, const struct joint_row *row);

/* Writes "PATH: rows: N, largest step ...", the joints without a column, and how many columns were
 * ignored. */
void joint_table_describe(const struct joint_table *table, FILE *out);

#endif
