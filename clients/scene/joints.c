#include "joints.h"

#include "allocate.h"
#include "complain.h"
#include "number.h"
#include "turn.h"
#include "utf8.h"

#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Where the value of a joint is from. */
enum from { NOWHERE, TEXT, TABLE };

/* place: of the value, for messages. */
static bool check_value(const struct robot_joint *joint, double value, const char *place)
{
    char found[NUMBER_TEXT_MAX], low[NUMBER_TEXT_MAX], high[NUMBER_TEXT_MAX];
    number_exact(value, found);
    if (!(value >= joint->limit[0] && value <= joint->limit[1])) {
        complain("%s: joint '%s': %s is beyond its limits, %s to %s", place, joint->name->name,
                 found, number_exact(joint->limit[0], low), number_exact(joint->limit[1], high));
        return false;
    }
    if (joint->type != ROBOT_PRISMATIC && fabs(value) > TURN_RADIANS_MAX) {
        complain("%s: joint '%s': %s is beyond %.0f radians", place, joint->name->name, found,
                 TURN_RADIANS_MAX);
        return false;
    }
    return true;
}

static bool set_value(struct joints *joints, unsigned j, const char *text, const char *place)
{
    const struct robot_joint *joint = &joints->robot->joints[j];
    if (!robot_numbers(text, 1, &joints->value[j])) {
        complain("%s: joint '%s': expected a finite number, found '%.64s'", place,
                 joint->name->name, text);
        return false;
    }
    return check_value(joint, joints->value[j], place);
}

/* Finds a joint that moves and is not given yet. Returns UINT32_MAX after an error. */
static unsigned take_joint(struct joints *joints, const char *name, enum from from,
                           const char *place)
{
    const struct robot_joint *joint = robot_find_joint(joints->robot, name);
    if (!joint || joint->type == ROBOT_FIXED) {
        complain("%s: '%.64s' is %s of %s", place, name, joint ? "a fixed joint" : "no joint",
                 joints->robot->path);
        return UINT32_MAX;
    }
    const unsigned j = joint->name->index;
    if (joints->from[j] != NOWHERE) {
        complain("%s: joint '%s' is given twice", place, name);
        return UINT32_MAX;
    }
    joints->from[j] = (unsigned char) from;
    return j;
}

bool joints_open(const struct robot *robot, const char *text, struct joints *out)
{
    static const char place[] = "--joints";
    *out = (struct joints){.robot = robot,
                           .value = allocate(robot->joint_count, sizeof *out->value),
                           .from = allocate(robot->joint_count, sizeof *out->from)};
    char *copy = allocate(strlen(text ? text : "") + 1, 1);
    bool good = true;
    strcpy(copy, text ? text : "");
    for (char *at = text ? copy : NULL, *next; good && at; at = next) {
        next = strchr(at, ',');
        if (next)
            *next++ = '\0';
        char *value = strrchr(at, '=');
        if (value)
            *value++ = '\0';
        else
            complain("%s: expected name=value,..., found '%.64s'", place, at);
        const unsigned j = value ? take_joint(out, at, TEXT, place) : UINT32_MAX;
        good = j != UINT32_MAX && set_value(out, j, value, place);
    }
    free(copy);
    return good;
}

void joints_clear(struct joints *joints)
{
    free(joints->value);
    free(joints->from);
}

bool joints_check(const struct joints *joints)
{
    for (size_t j = 0; j < joints->robot->joint_count; j++)
        if (joints->robot->joints[j].type != ROBOT_FIXED && joints->from[j] == NOWHERE &&
            !check_value(&joints->robot->joints[j], 0, "without a value by --joints"))
            return false;
    return true;
}

/* ---- Lines of CSV ---- */

enum { LINE_MAX_BYTES = 1 << 20, PLACE_MAX = 4200 };

/* Columns that are no joints. */
#define COLUMN_TIME (UINT32_MAX - 2)
#define COLUMN_LABEL (UINT32_MAX - 1)

static const char *place_of(const struct joint_table *table, char place[PLACE_MAX])
{
    snprintf(place, PLACE_MAX, "%s: line %lu", table->path, table->line);
    return place;
}

static enum joint_row refuse(const struct joint_table *table, const char *why)
{
    char place[PLACE_MAX];
    complain("%s: %s", place_of(table, place), why);
    return JOINT_ROW_BAD;
}

/* Reads the next line that is not empty, without its end. */
static enum joint_row read_line(struct joint_table *table)
{
    size_t size;
    do {
        table->line++;
        if (!fgets(table->text, LINE_MAX_BYTES, table->file))
            return ferror(table->file) ? refuse(table, strerror(errno)) : JOINT_ROW_END;
        size = strlen(table->text);
        if ((size == 0 || table->text[size - 1] != '\n') && !feof(table->file))
            return refuse(table, "a zero byte, or more than 1048575 bytes");
        table->text[strcspn(table->text, "\r\n")] = '\0';
    } while (table->text[0] == '\0');
    return JOINT_ROW;
}

/* Divides the line into fields, in place. Returns their number, of which the first `capacity` are
 * set; SIZE_MAX if quotes are wrong. */
static size_t split(char *at, char **field, size_t capacity)
{
    for (size_t count = 0;; at++) {
        at += strspn(at, " \t");
        const bool quoted = *at == '"';
        char *out = at += quoted;
        if (count < capacity)
            field[count] = out;
        count++;
        while (quoted ? *at && (*at != '"' || at[1] == '"') : *at && *at != ',') {
            at += quoted && *at == '"';
            *out++ = *at++;
        }
        if (quoted && *at++ != '"')
            return SIZE_MAX;
        const char end = *at;
        *out = '\0';
        if (end != ',')
            return end ? SIZE_MAX : count;
    }
}

/* ---- The table ---- */

static bool take_column(struct joint_table *table, size_t i)
{
    static const char *const others[] = {"time", "label"};
    const char *name = table->field[i];
    char place[PLACE_MAX];
    for (unsigned other = 0; other < 2; other++) {
        if (strcmp(name, others[other]) != 0)
            continue;
        table->column[i] = COLUMN_TIME + other;
        table->has_time = table->has_time || other == 0;
        for (size_t k = 0; k < i; k++)
            if (table->column[k] == table->column[i]) {
                complain("%s: column '%s' is there twice", place_of(table, place), name);
                return false;
            }
        return true;
    }
    table->column[i] = take_joint(table->joints, name, TABLE, place_of(table, place));
    return table->column[i] != UINT32_MAX;
}

static bool read_columns(struct joint_table *table)
{
    static const char mark[] = "\xef\xbb\xbf"; /* UTF-8 byte order mark */
    char place[PLACE_MAX];
    switch (read_line(table)) {
    case JOINT_ROW: break;
    case JOINT_ROW_END: complain("%s: there is no line of joint names", table->path); return false;
    default: return false;
    }
    char *text = table->text + (strncmp(table->text, mark, strlen(mark)) == 0 ? strlen(mark) : 0);
    size_t most = 1;
    for (const char *at = text; (at = strchr(at, ',')); at++)
        most++;
    table->field = allocate(most, sizeof *table->field);
    table->column = allocate(most, sizeof *table->column);
    table->columns = split(text, table->field, most);
    if (table->columns == SIZE_MAX)
        return refuse(table, "a quote stands where it should not, or is missing") == JOINT_ROW;
    for (size_t i = 0; i < table->columns; i++)
        if (!take_column(table, i))
            return false;
    const struct robot *robot = table->joints->robot;
    for (size_t j = 0; j < robot->joint_count; j++)
        if (robot->joints[j].type != ROBOT_FIXED && table->joints->from[j] == NOWHERE) {
            complain("%s: there is no column for joint '%s': add it, or give the joint by --joints",
                     place_of(table, place), robot->joints[j].name->name);
            return false;
        }
    return true;
}

bool joint_table_open(const char *path, struct joints *joints, struct joint_table *out)
{
    struct stat about;
    *out =
        (struct joint_table){.path = path, .joints = joints, .file = fopen(path, "r"), .time = NAN};
    if (!out->file || fstat(fileno(out->file), &about) != 0) {
        complain("%s: %s", path, strerror(errno));
        return false;
    }
    if (!S_ISREG(about.st_mode)) {
        complain("%s: no regular file: it is read twice, so that an error prints no scene", path);
        return false;
    }
    out->text = allocate(LINE_MAX_BYTES, 1);
    return read_columns(out);
}

bool joint_table_rewind(struct joint_table *table)
{
    rewind(table->file);
    table->line = 0;
    table->time = NAN;
    return read_line(table) == JOINT_ROW;
}

void joint_table_close(struct joint_table *table)
{
    if (table->file)
        fclose(table->file);
    free(table->text);
    free(table->field);
    free(table->column);
}

/* Adds to the label of the row. Returns false after an error. */
static bool add_label(struct joint_table *table, const char *text)
{
    const size_t used = strlen(table->label), size = strlen(text) + (used > 0 ? 2 : 0);
    if (used + size > QUERY_NAME_MAX || !utf8_is_text(text))
        return refuse(table,
                      "the label, with the time, has more than 64 bytes, or control "
                      "characters") == JOINT_ROW;
    snprintf(table->label + used, sizeof table->label - used, "%s%s", used > 0 ? ", " : "", text);
    return true;
}

static bool take_time(struct joint_table *table, const char *text)
{
    double time;
    if (!robot_numbers(text, 1, &time))
        return refuse(table, "column 'time': expected a finite number") == JOINT_ROW;
    if (time < table->time || time - table->time > DBL_MAX)
        return refuse(table, "column 'time': earlier than in the row before, or too much later") ==
               JOINT_ROW;
    table->time = time;
    return true;
}

enum joint_row joint_table_next(struct joint_table *table)
{
    char place[PLACE_MAX], time[NUMBER_TEXT_MAX], text[NUMBER_TEXT_MAX + 8];
    const enum joint_row outcome = read_line(table);
    if (outcome != JOINT_ROW)
        return outcome;
    const size_t found = split(table->text, table->field, table->columns);
    if (found == SIZE_MAX)
        return refuse(table, "a quote stands where it should not, or is missing");
    if (found != table->columns) {
        complain("%s: %zu columns, where the first line has %zu", place_of(table, place), found,
                 table->columns);
        return JOINT_ROW_BAD;
    }
    table->label[0] = '\0';
    place_of(table, place);
    for (size_t i = 0; i < found; i++) {
        const unsigned column = table->column[i];
        if (!(column == COLUMN_TIME    ? take_time(table, table->field[i])
              : column == COLUMN_LABEL ? add_label(table, table->field[i])
                                       : set_value(table->joints, column, table->field[i], place)))
            return JOINT_ROW_BAD;
    }
    if (!table->has_time)
        return JOINT_ROW;
    snprintf(text, sizeof text, "t = %s", number_exact(table->time, time));
    return add_label(table, text) ? JOINT_ROW : JOINT_ROW_BAD;
}
