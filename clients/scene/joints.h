/* Values of the joints of a robot: from a text, and from the rows of a CSV file. A value outside
 * the limits of its joint is an error. Errors are reported on stderr in one line. */
#ifndef JOINTS_H
#define JOINTS_H

#include "query.h"
#include "robot.h"

#include <stdio.h>

struct joints {
    const struct robot *robot;
    double *value; /* [joint_count]; 0 unless given or that of a mimic joint */
    bool *given;   /* [joint_count], private: by the text, or in a column */
};

/* In: text: "name=value,name=value"; NULL: none. Returns false after an error. The caller passes
 * the joints to joints_clear() in either case. */
bool joints_open(const struct robot *robot, const char *text, struct joints *out);
void joints_clear(struct joints *joints);

/* Checks that 0 is within the limits of all joints that are neither given nor mimic joints. */
bool joints_check(const struct joints *joints);

/* Sets the mimic joints that are not given, from the values of the joints that they follow. place:
 * where these are given, for messages. Returns false after an error. joint_table_next() does it for
 * each row. */
bool joints_follow(struct joints *joints, const char *place);

/* A CSV file (RFC 4180, without line breaks in fields). Its first line has the names of columns, in
 * any order: one for each joint that moves and has no value in joints; optional are those of mimic
 * joints, "time", in seconds, and "label". Memory holds one line. */
struct joint_table {
    /* Of the current row. */
    bool has_time;
    double time;                    /* not before that of the previous row */
    char label[QUERY_NAME_MAX + 1]; /* "label (t = 0.5)", "label", "t = 0.5" or "" */
    unsigned long line;             /* in the file, from 1 */
    char *place;                    /* the file and line, for messages */
    /* Private. */
    struct joints *joints;
    const char *path;
    FILE *file;
    char *text, **field; /* owned: of the line; field: [columns] */
    unsigned *column;    /* owned: [columns], the joint */
    size_t columns;
};

/* Opens a regular file, and reads its first line. joints: receives the values of rows. Returns
 * false after an error. The caller passes the table to joint_table_close() in either case. */
bool joint_table_open(const char *path, struct joints *joints, struct joint_table *out);
void joint_table_close(struct joint_table *table);

/* Reads the next row. */
enum joint_row { JOINT_ROW, JOINT_ROW_END, JOINT_ROW_BAD /* after an error */ };
enum joint_row joint_table_next(struct joint_table *table);

/* Goes back to the first row. */
bool joint_table_rewind(struct joint_table *table);

#endif
