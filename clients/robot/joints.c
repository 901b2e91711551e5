#include "joints.h"

#include "allocate.h"
#include "complain.h"
#include "escape.h"
#include "number.h"
#include "turn.h"
#include "utf8.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* Whether a joint that moves is neither given nor a mimic joint. */
static bool needs_value(const struct joints *joints, size_t j)
{
    const struct robot_joint *joint = &joints->robot->joints[j];
    return joint->type != ROBOT_FIXED && !joint->mimic_name && !joints->given[j];
}

/* Whether a joint has a given value, or follows a joint that has one. */
static bool is_chosen(const struct joints *joints, size_t j)
{
    const struct robot_joint *joint = &joints->robot->joints[j];
    return joints->given[j] || (joint->mimic_name && joints->given[joint->mimic]);
}

/* Whether a value that is outside the limits of joint j, by this much, is refused. Limits apply to
 * the joints that a controller moves. The value of a mimic joint that follows is only reported:
 * MoveIt accepts it. */
static bool is_refused(const struct joints *joints, size_t j, double by)
{
    return isinf(by) || (joints->given[j] && by > joints->slack);
}

/* Records the value of joint j if it is outside the limits. */
static void check_value(struct joints *joints, size_t j, const char *path, unsigned long line)
{
    static const double full_turn = 6.2831853071795862;
    const struct robot_joint *joint = &joints->robot->joints[j];
    const bool turns = joint->type != ROBOT_PRISMATIC;
    struct joint_report found = {joints->value[j], 0, j, path, line};
    found.by = fmax(joint->limit[0] - found.value, found.value - joint->limit[1]);
    if (robot_refuse_value(joint, found.value))
        found.by = INFINITY;
    else if (turns && fabs(found.value) > fmax(full_turn, fabs(joints->full.value)) &&
             (found.by > joints->slack || joint->type == ROBOT_CONTINUOUS))
        joints->full = found;
    if (!(found.by > 0) || (!isinf(found.by) && !is_chosen(joints, j)))
        return;
    joints->outside_count++;
    joints->refused = joints->refused || is_refused(joints, j, found.by);
    if (found.by > joints->outside[j].by)
        joints->outside[j] = found;
}

static const char degrees[] = "is more than a full turn: is it in degrees? Values are in radians";

/* Prints a value. what: why it is reported. */
static void report_value(const struct joints *joints, const struct joint_report *at,
                         const char *what)
{
    const struct robot_joint *joint = &joints->robot->joints[at->joint];
    const bool follows = !joints->given[at->joint] && joint->mimic_name;
    char line[32] = "", value[NUMBER_TEXT_MAX];
    if (at->line > 0)
        snprintf(line, sizeof line, ": line %lu", at->line);
    complain("%s%s: joint '%s'%s%s%s: %s %s", at->path, line, joint->name->name,
             follows ? " (a mimic of '" : "", follows ? joint->mimic_name : "", follows ? "')" : "",
             number_or_inf(at->value, value), what);
}

bool joints_check(const struct joints *joints)
{
    char what[2 * NUMBER_TEXT_MAX + 64], low[NUMBER_TEXT_MAX], high[NUMBER_TEXT_MAX];
    for (size_t j = 0; joints->refused && j < joints->robot->joint_count; j++) {
        const struct robot_joint *joint = &joints->robot->joints[j];
        const struct joint_report *at = &joints->outside[j];
        const bool turns = joint->type != ROBOT_PRISMATIC;
        if (!is_refused(joints, j, at->by))
            continue;
        if (turns && fabs(at->value) > TURN_RADIANS_MAX)
            snprintf(what, sizeof what, "is beyond %.0f radians", TURN_RADIANS_MAX);
        else
            snprintf(what, sizeof what, "is outside its limits, %s to %s%s",
                     number_or_inf(joint->limit[0], low), number_or_inf(joint->limit[1], high),
                     turns ? " radians" : "");
        report_value(joints, at, what);
    }
    if (joints->refused && joints->full.value != 0)
        report_value(joints, &joints->full, degrees);
    return !joints->refused;
}

/* Writes the separator of the next part: *before at first, then a semicolon. */
static void separate(const char **before, FILE *out)
{
    fputs(*before, out);
    *before = "; ";
}

void joints_describe(const struct joints *joints, const char *before, FILE *out)
{
    const struct robot *robot = joints->robot;
    const struct joint_report *farthest = joints->outside, *mimic = &joints->mimic;
    char value[NUMBER_TEXT_MAX], slack[NUMBER_TEXT_MAX];
    const char *comma = NULL;
    for (size_t j = 0; j < robot->joint_count; j++) {
        const struct joint_report *at = &joints->outside[j];
        farthest = at->by > farthest->by ? at : farthest;
        if (!needs_value(joints, j) || robot_home(&robot->joints[j]) == 0)
            continue;
        if (!comma)
            separate(&before, out);
        fprintf(out, "%s%s", comma ? comma : "in the middle of their limits, as 0 is outside: ",
                robot->joints[j].name->name);
        comma = ", ";
    }
    if (joints->outside_count > 0) {
        separate(&before, out);
        fprintf(
            out,
            "values outside limits, within --limit-slack %s or of mimic joints: %zu, the farthest "
            "%s of '%s'",
            number_or_inf(joints->slack, slack), joints->outside_count,
            number_or_inf(farthest->value, value), robot->joints[farthest->joint].name->name);
        if (farthest->line > 0)
            fprintf(out, " in line %lu", farthest->line);
    }
    if (mimic->by > 0) {
        separate(&before, out);
        fprintf(out, "mimic '%s' differs from what it follows by up to %s",
                robot->joints[mimic->joint].name->name, number_short(mimic->by, value));
        if (mimic->line > 0)
            fprintf(out, " (line %lu)", mimic->line);
    }
    if (joints->full.value != 0) {
        separate(&before, out);
        fprintf(out, "joint '%s': %s %s", robot->joints[joints->full.joint].name->name,
                number_or_inf(joints->full.value, value), degrees);
    }
}

static bool set_value(struct joints *joints, unsigned j, const char *text, const char *path,
                      unsigned long line, const char *place)
{
    const bool good = robot_numbers(text, 1, &joints->value[j]);
    if (good)
        check_value(joints, j, path, line);
    else
        complain("%s: joint '%s': expected a finite number, found '%.64s'", place,
                 joints->robot->joints[j].name->name, text);
    return good;
}

/* Finds a joint that moves and is not given yet. Returns UINT32_MAX after an error. */
static unsigned take_joint(struct joints *joints, const char *name, const char *place)
{
    const struct robot_joint *joint = robot_find_joint(joints->robot, name);
    if (!joint || joint->type == ROBOT_FIXED) {
        complain("%s: '%.64s' is %s of %s", place, name, joint ? "a fixed joint" : "not a joint",
                 joints->robot->path);
        return UINT32_MAX;
    }
    const unsigned j = joint->name->index;
    if (joints->given[j]) {
        complain("%s: joint '%s' is given twice", place, name);
        return UINT32_MAX;
    }
    joints->given[j] = true;
    return j;
}

bool joints_open(const struct robot *robot, const char *text, double slack, struct joints *out)
{
    static const char place[] = "--joints";
    *out = (struct joints){.robot = robot,
                           .slack = slack,
                           .value = allocate(robot->joint_count, sizeof *out->value),
                           .outside = allocate(robot->joint_count, sizeof *out->outside),
                           .given = allocate(robot->joint_count, sizeof *out->given)};
    char *copy = allocate(strlen(text ? text : "") + 1, 1);
    bool good = true;
    strcpy(copy, text ? text : "");
    for (char *at = text ? copy : NULL, *next; at; at = next) {
        next = strchr(at, ',');
        if (next)
            *next++ = '\0';
        char *value = strrchr(at, '=');
        if (value)
            *value++ = '\0';
        else
            complain("%s: expected name=value,..., found '%.64s'", place, at);
        const unsigned j = value ? take_joint(out, at, place) : UINT32_MAX;
        good = j != UINT32_MAX && set_value(out, j, value, place, 0, place) && good;
    }
    free(copy);
    for (size_t j = 0; j < robot->joint_count; j++)
        if (!out->given[j])
            out->value[j] = robot_home(&robot->joints[j]);
    return good;
}

void joints_clear(struct joints *joints)
{
    free(joints->value);
    free(joints->given);
    free(joints->outside);
}

void joints_follow(struct joints *joints, const char *path, unsigned long line)
{
    const struct robot *robot = joints->robot;
    robot_follow(robot, joints->given, joints->value);
    for (size_t j = 0; j < robot->joint_count; j++) {
        const struct robot_joint *joint = &robot->joints[j];
        if (!joint->mimic_name)
            continue;
        const double by = fabs(joints->value[j] - robot_mimic(joint, joints->value));
        if (!joints->given[j])
            check_value(joints, j, path, line);
        else if (by > joints->mimic.by)
            joints->mimic = (struct joint_report){joints->value[j], by, j, path, line};
    }
}

/* ---- Lines of CSV ---- */

enum { LINE_BYTES_MAX = 1 << 20 }; /* of a buffer: a line and its line feed take fewer */

/* Columns that are not of joints. */
#define COLUMN_IGNORED (UINT32_MAX - 3)
#define COLUMN_TIME (UINT32_MAX - 2)
#define COLUMN_LABEL (UINT32_MAX - 1)

static const char *set_place(struct joint_table *table, unsigned long line)
{
    snprintf(table->place, COMPLAIN_PLACE_MAX, "%s: line %lu", table->path, line);
    return table->place;
}

/* Reports an error of the current line. Returns false. */
__attribute__((format(printf, 2, 3))) static bool refuse(struct joint_table *table,
                                                         const char *format, ...)
{
    va_list list;
    va_start(list, format);
    complain_at(set_place(table, table->line), format, list);
    va_end(list);
    return false;
}

/* Splits the line into fields without the spaces around them, in place, and stores pointers to at
 * most `capacity` of them. Returns the number of fields; SIZE_MAX if quotes are wrong. */
static size_t split(char *at, char **field, size_t capacity)
{
    for (size_t count = 0;; at++) {
        at += strspn(at, " \t");
        const bool quoted = *at == '"';
        char *const begin = at += quoted, *out = begin;
        if (count < capacity)
            field[count] = begin;
        count++;
        while (quoted ? *at && (*at != '"' || at[1] == '"') : *at && *at != ',') {
            at += quoted && *at == '"';
            *out++ = *at++;
        }
        if (quoted && *at++ != '"')
            return SIZE_MAX;
        at += strspn(at, " \t");
        while (!quoted && out > begin && strchr(" \t", out[-1]))
            out--;
        const char end = *at;
        *out = '\0';
        if (end != ',')
            return end ? SIZE_MAX : count;
    }
}

/* Reads the next line that is not blank, and divides it into fields: those of the columns, once
 * these are known. Out: *found: their number; 0: the file has ended. Returns false after an error.
 */
static bool read_line(struct joint_table *table, size_t *found)
{
    static const char mark[] = "\xef\xbb\xbf"; /* UTF-8 byte order mark */
    char *text;
    *found = 0;
    do {
        size_t size = 0;
        int byte;
        table->line++;
        text = table->text;
        do {
            byte = getc(table->file);
            if (byte > 0)
                text[size++] = (char) byte;
        } while (byte > 0 && byte != '\n' && size < LINE_BYTES_MAX);
        if (ferror(table->file))
            return refuse(table, "%s", strerror(errno));
        if (byte == EOF && size == 0)
            return true;
        if (byte == 0 || size == LINE_BYTES_MAX)
            return refuse(table,
                          "has a zero byte (save the table as UTF-8), or more than %d bytes (give "
                          "fewer columns)",
                          LINE_BYTES_MAX - 1);
        char *end = text + size;
        end -= end > text && end[-1] == '\n';
        end -= end > text && end[-1] == '\r';
        *end = '\0';
        if (strchr(text, '\r'))
            return refuse(table, "a carriage return within the line: end lines by line feeds");
        text += table->line == 1 && strncmp(text, mark, strlen(mark)) == 0 ? strlen(mark) : 0;
    } while (text[strspn(text, " \t")] == '\0');
    if (!table->field) {
        size_t most = 1;
        for (const char *at = text; (at = strchr(at, ',')); at++)
            most++;
        table->field = allocate(most, sizeof *table->field);
        table->column = allocate(most, sizeof *table->column);
        table->columns = most;
    }
    *found = split(text, table->field, table->columns);
    return *found != SIZE_MAX || refuse(table, "a quote is misplaced or missing");
}

/* ---- The table ---- */

/* Returns the joint of column i, or one of the above; UINT32_MAX after an error. */
static unsigned take_column(struct joint_table *table, size_t i)
{
    const char *name = table->field[i];
    const unsigned column = strcmp(name, "time") == 0    ? COLUMN_TIME
                            : strcmp(name, "label") == 0 ? COLUMN_LABEL
                                                         : UINT32_MAX;
    const struct robot_joint *joint = robot_find_joint(table->joints->robot, name);
    if (column == UINT32_MAX && joint && joint->type != ROBOT_FIXED)
        return take_joint(table->joints, name, set_place(table, table->line));
    if (column == UINT32_MAX) {
        table->fixed += joint != NULL;
        if (!joint && table->unknown++ == 0)
            snprintf(table->unknown_name, sizeof table->unknown_name, "%s", name);
        return COLUMN_IGNORED;
    }
    for (size_t k = 0; k < i; k++)
        if (table->column[k] == column) {
            refuse(table, "column '%s' appears twice", name);
            return UINT32_MAX;
        }
    table->has_time = table->has_time || column == COLUMN_TIME;
    return column;
}

static bool read_columns(struct joint_table *table)
{
    bool good = read_line(table, &table->columns);
    if (good && table->columns == 0)
        complain("%s: expected a line of joint names, found none", table->path);
    if (!good || table->columns == 0)
        return false;
    for (size_t i = 0; i < table->columns; i++)
        good = (table->column[i] = take_column(table, i)) != UINT32_MAX && good;
    const struct robot *robot = table->joints->robot;
    for (size_t j = 0; j < robot->joint_count; j++)
        if (needs_value(table->joints, j)) {
            refuse(table, "no column for joint '%s': add one, or give its value by --joints",
                   robot->joints[j].name->name);
            good = false;
        }
    return good;
}

static bool take_time(struct joint_table *table, const char *text, double before, double *time)
{
    char number[NUMBER_TEXT_MAX];
    if (!robot_numbers(text, 1, time))
        return refuse(table, "column 'time': expected a finite number, found '%.64s'", text);
    return (!(*time < before) && !(*time - before > DBL_MAX)) ||
           refuse(table, "column 'time': %s the previous row, %s",
                  *time < before ? "earlier than in" : "more than doubles hold after",
                  number_exact(before, number));
}

/* Sets the label: the text of its column, or "", and the time. */
static bool set_label(struct joint_table *table, const char *text, struct joint_row *row)
{
    char time[NUMBER_TEXT_MAX], label[QUERY_NAME_MAX + 1];
    const bool both = table->has_time && *text;
    const size_t size = (size_t) snprintf(
        label, sizeof label, "%s%s%s%s%s", text, both ? " (" : "", table->has_time ? "t = " : "",
        table->has_time ? number_exact(row->time, time) : "", both ? ")" : "");
    row->label = scene_text(&table->memory, label);
    return (size <= QUERY_NAME_MAX && utf8_is_text(label)) ||
           refuse(table,
                  "the label, time included, has more than %d bytes, or is not UTF-8 without "
                  "control characters",
                  (int) QUERY_NAME_MAX);
}

/* Keeps the values of a row, and records the largest step of a joint. */
static void keep_values(struct joint_table *table, struct joint_row *row)
{
    const size_t count = table->joints->robot->joint_count;
    double *value = scene_alloc(&table->memory, count, sizeof *value);
    if (count > 0)
        memcpy(value, table->joints->value, count * sizeof *value);
    for (size_t j = 0; j < count && table->row_count > 0; j++) {
        const double by = fabs(value[j] - row[-1].value[j]);
        if (by > table->step.by)
            table->step = (struct joint_report){value[j], by, j, table->path, table->line};
    }
    row->value = value;
}

/* Adds a row of this number of fields. */
static bool add_row(struct joint_table *table, size_t found)
{
    const char *label = "";
    bool good = true;
    if (found != table->columns)
        return refuse(table, "%zu columns, but the first line has %zu", found, table->columns);
    table->rows =
        allocate_grow(table->rows, &table->row_capacity, table->row_count + 1, sizeof *table->rows);
    struct joint_row *row = &table->rows[table->row_count];
    *row = (struct joint_row){.line = table->line, .time = NAN};
    for (size_t i = 0; good && i < found; i++) {
        const unsigned column = table->column[i];
        if (column == COLUMN_LABEL)
            label = table->field[i];
        else if (column == COLUMN_TIME)
            good = take_time(table, table->field[i], table->row_count > 0 ? row[-1].time : NAN,
                             &row->time);
        else if (column != COLUMN_IGNORED)
            good = set_value(table->joints, column, table->field[i], table->path, table->line,
                             set_place(table, table->line));
    }
    if (!good)
        return false;
    joints_follow(table->joints, table->path, table->line);
    keep_values(table, row);
    table->row_count++;
    return set_label(table, label, row);
}

bool joint_table_read(const char *path, struct joints *joints, struct joint_table *out)
{
    const bool named = strcmp(path, "-") != 0;
    size_t found;
    *out = (struct joint_table){.path = named ? path : "standard input",
                                .joints = joints,
                                .file = named ? fopen(path, "r") : stdin,
                                .text = allocate(LINE_BYTES_MAX, 1),
                                .place = allocate(COMPLAIN_PLACE_MAX, 1)};
    if (!out->file)
        complain("%s: %s", path, strerror(errno));
    bool good = out->file && read_columns(out);
    while (good && (good = read_line(out, &found)) && found > 0)
        good = add_row(out, found);
    return good &&
           (out->row_count > 0 || refuse(out, "expected a row of joint values, found none"));
}

void joint_table_clear(struct joint_table *table)
{
    if (table->file && table->file != stdin)
        fclose(table->file);
    free(table->rows);
    free(table->text);
    free(table->place);
    free(table->field);
    free(table->column);
    scene_clear(&table->memory);
}

const char *joint_table_place(struct joint_table *table, const struct joint_row *row)
{
    return set_place(table, row->line);
}

void joint_table_describe(const struct joint_table *table, FILE *out)
{
    enum { NAMED = 8 };
    const struct robot *robot = table->joints->robot;
    char by[NUMBER_TEXT_MAX];
    escape_text(out, table->path);
    fprintf(out, ": rows: %zu", table->row_count);
    if (table->step.by > 0)
        fprintf(out, ", largest step %s of '%s' to line %lu", number_short(table->step.by, by),
                robot->joints[table->step.joint].name->name, table->step.line);
    for (size_t j = 0, named = 0; j < robot->joint_count && named <= NAMED; j++) {
        size_t i = 0;
        while (i < table->columns && table->column[i] != j)
            i++;
        if (robot->joints[j].type == ROBOT_FIXED || i < table->columns)
            continue;
        fprintf(out, "%s%s", named == 0 ? "; not in it: " : ", ",
                named < NAMED ? robot->joints[j].name->name : "...");
        named++;
    }
    if (table->fixed > 0)
        fprintf(out, "; ignored: columns of fixed joints: %zu", table->fixed);
    if (table->unknown > 0)
        fprintf(out, "; ignored: columns of no joint: %zu ('%s')", table->unknown,
                table->unknown_name);
}
