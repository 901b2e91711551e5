/* Reads URDF with expat. Known elements are listed in a table by the element that contains them;
 * all others (<visual>, <inertial>, <gazebo>, ...) are skipped with what they contain.
 *
 * A file is not trusted. A document type declaration is refused: so entities are neither declared
 * nor loaded, and nothing expands. Bytes, links, joints and elements are bounded (robot.h); expat
 * does not recurse. */
#include "robot.h"

#include "allocate.h"
#include "complain.h"
#include "query.h"
#include "turn.h"
#include "utf8.h"

#include <errno.h>
#include <expat.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum place {
    DOCUMENT,
    IN_ROBOT,
    IN_LINK,
    IN_COLLISION,
    IN_ORIGIN,
    IN_GEOMETRY,
    IN_SHAPE,
    IN_JOINT,
    IN_JOINT_ORIGIN,
    IN_PARENT,
    IN_CHILD,
    IN_AXIS,
    IN_LIMIT
};

struct reader {
    XML_Parser xml;
    struct robot *robot;
    bool failed;
    enum place place;
    unsigned skipped;       /* depth within an unknown element */
    unsigned seen;          /* set of places, in the current joint or collision */
    const char *element;    /* the current one */
    const XML_Char **found; /* its attributes: name, value, ..., NULL */
};

/* Reports an error, and ends the parser. Returns false. */
__attribute__((format(printf, 2, 3))) static bool refuse(struct reader *reader, const char *format,
                                                         ...)
{
    const struct robot *robot = reader->robot;
    char text[1024];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    const bool in_joint = reader->place >= IN_JOINT, in_link = reader->place >= IN_LINK;
    const struct robot_name *name = in_joint  ? robot->joints[robot->joint_count - 1].name
                                    : in_link ? robot->links[robot->link_count - 1].name
                                              : NULL;
    complain("%s: line %lu: %s%s%s%s", robot->path, XML_GetCurrentLineNumber(reader->xml),
             !name      ? ""
             : in_joint ? "joint '"
                        : "link '",
             name ? name->name : "", name ? "': " : "", text);
    reader->failed = true;
    XML_StopParser(reader->xml, XML_FALSE);
    return false;
}

/* ---- Attributes ---- */

/* Returns the value of an attribute, or NULL. */
static const char *find(const struct reader *reader, const char *name)
{
    for (const XML_Char **at = reader->found; *at; at += 2)
        if (strcmp(at[0], name) == 0)
            return at[1];
    return NULL;
}

/* Returns the value of an attribute, or NULL after an error. */
static const char *require(struct reader *reader, const char *name)
{
    const char *value = find(reader, name);
    if (!value || !*value)
        refuse(reader, "<%s> has no %s", reader->element, name);
    return value && *value ? value : NULL;
}

/* Reads count numbers. required: a missing attribute is an error; otherwise *out is unchanged. */
static bool read_numbers(struct reader *reader, const char *name, bool required, int count,
                         double *out)
{
    const char *value = required ? require(reader, name) : find(reader, name);
    if (!value)
        return !required;
    if (robot_numbers(value, count, out))
        return true;
    return refuse(reader, "<%s>: %s is '%.64s', expected %d finite number%s%s", reader->element,
                  name, value, count, count > 1 ? "s" : "",
                  strstr(value, "${") ? " (expand the file by xacro first)" : "");
}

static bool read_sizes(struct reader *reader, const char *name, int count, double *out)
{
    if (!read_numbers(reader, name, true, count, out))
        return false;
    for (int i = 0; i < count; i++)
        if (out[i] < 0)
            return refuse(reader, "<%s>: %s is negative", reader->element, name);
    return true;
}

static bool read_origin(struct reader *reader, struct pose *out)
{
    double rpy[3] = {0};
    if (!read_numbers(reader, "xyz", false, 3, out->p) ||
        !read_numbers(reader, "rpy", false, 3, rpy))
        return false;
    for (int i = 0; i < 3; i++)
        if (fabs(rpy[i]) > TURN_RADIANS_MAX)
            return refuse(reader, "<origin>: rpy is beyond %.0f radians", TURN_RADIANS_MAX);
    pose_turn_rpy(rpy, out->q);
    return true;
}

/* ---- Elements ---- */

static struct robot_link *current_link(struct reader *reader)
{
    return &reader->robot->links[reader->robot->link_count - 1];
}

static struct robot_joint *current_joint(struct reader *reader)
{
    return &reader->robot->joints[reader->robot->joint_count - 1];
}

static struct robot_element *current_element(struct reader *reader)
{
    return &reader->robot->elements[reader->robot->element_count - 1];
}

/* Adds the name of the current link or joint to the table. Returns NULL after an error. */
static const struct robot_name *add_name(struct reader *reader, struct robot_name **table)
{
    const char *name = require(reader, "name");
    const struct robot_name *first;
    struct robot_name *added;
    if (!name)
        return NULL;
    if (strlen(name) > QUERY_NAME_MAX || !utf8_is_text(name)) {
        refuse(reader, "<%s>: the name '%.80s' has more than %d bytes, or control characters",
               reader->element, name, (int) QUERY_NAME_MAX);
        return NULL;
    }
    added = robot_add_name(reader->robot, table, name, &first);
    if (!added)
        refuse(reader, "there is a %s '%s' already, in line %lu", reader->element, name,
               first->line);
    else
        added->line = XML_GetCurrentLineNumber(reader->xml);
    return added;
}

/* Whether one more fits. */
static bool has_space(struct reader *reader, size_t count)
{
    return count < ROBOT_COUNT_MAX ||
           refuse(reader, "more than %d elements <%s>", (int) ROBOT_COUNT_MAX, reader->element);
}

static bool begin_link(struct reader *reader)
{
    struct robot *robot = reader->robot;
    const struct robot_name *name;
    if (!has_space(reader, robot->link_count) || !(name = add_name(reader, &robot->link_names)))
        return false;
    robot->links = allocate_grow(robot->links, &robot->link_capacity, robot->link_count + 1,
                                 sizeof *robot->links);
    robot->links[robot->link_count++] =
        (struct robot_link){.name = name, .element = robot->element_count, .joint = ROBOT_ROOT};
    return true;
}

static bool begin_collision(struct reader *reader)
{
    struct robot *robot = reader->robot;
    if (!has_space(reader, robot->element_count))
        return false;
    robot->elements = allocate_grow(robot->elements, &robot->element_capacity,
                                    robot->element_count + 1, sizeof *robot->elements);
    robot->elements[robot->element_count++] =
        (struct robot_element){.line = XML_GetCurrentLineNumber(reader->xml), .origin = POSE_NONE};
    current_link(reader)->element_count++;
    reader->seen = 0;
    return true;
}

static bool end_collision(struct reader *reader)
{
    return (reader->seen >> IN_SHAPE & 1) != 0 ||
           refuse(reader, "<collision> has no <geometry> with a shape");
}

static bool begin_origin(struct reader *reader)
{
    return read_origin(reader, &current_element(reader)->origin);
}

static bool begin_box(struct reader *reader)
{
    current_element(reader)->shape = ROBOT_BOX;
    return read_sizes(reader, "size", 3, current_element(reader)->size);
}

static bool begin_cylinder(struct reader *reader)
{
    current_element(reader)->shape = ROBOT_CYLINDER;
    return read_sizes(reader, "radius", 1, &current_element(reader)->size[0]) &&
           read_sizes(reader, "length", 1, &current_element(reader)->size[1]);
}

static bool begin_sphere(struct reader *reader)
{
    current_element(reader)->shape = ROBOT_SPHERE;
    return read_sizes(reader, "radius", 1, current_element(reader)->size);
}

static bool begin_mesh(struct reader *reader)
{
    struct robot_element *element = current_element(reader);
    const char *file = require(reader, "filename");
    if (!file)
        return false;
    element->shape = ROBOT_MESH;
    element->file = scene_text(&reader->robot->memory, file);
    element->size[0] = element->size[1] = element->size[2] = 1;
    return read_numbers(reader, "scale", false, 3, element->size);
}

static bool begin_joint(struct reader *reader)
{
    static const char *const types[] = {"revolute", "continuous", "prismatic", "fixed"};
    struct robot *robot = reader->robot;
    const struct robot_name *name;
    const char *type;
    unsigned i = 0;
    if (!has_space(reader, robot->joint_count) || !(name = add_name(reader, &robot->joint_names)) ||
        !(type = require(reader, "type")))
        return false;
    while (i < sizeof types / sizeof *types && strcmp(types[i], type) != 0)
        i++;
    if (i == sizeof types / sizeof *types)
        return refuse(reader,
                      "joint '%s': its type is '%.64s', expected revolute, continuous, "
                      "prismatic or fixed",
                      name->name, type);
    robot->joints = allocate_grow(robot->joints, &robot->joint_capacity, robot->joint_count + 1,
                                  sizeof *robot->joints);
    robot->joints[robot->joint_count++] = (struct robot_joint){.name = name,
                                                               .type = (enum robot_joint_type) i,
                                                               .origin = POSE_NONE,
                                                               .axis = {1, 0, 0},
                                                               .limit = {-INFINITY, INFINITY}};
    reader->seen = 0;
    return true;
}

static bool end_joint(struct reader *reader)
{
    const struct robot_joint *joint = current_joint(reader);
    const bool limited = joint->type == ROBOT_REVOLUTE || joint->type == ROBOT_PRISMATIC;
    if (!joint->link_names[0] || !joint->link_names[1])
        return refuse(reader, "there is no <%s>", joint->link_names[0] ? "child" : "parent");
    return !limited || (reader->seen >> IN_LIMIT & 1) != 0 ||
           refuse(reader, "there is no <limit>, which a joint of this type has");
}

static bool begin_joint_origin(struct reader *reader)
{
    return read_origin(reader, &current_joint(reader)->origin);
}

static bool begin_end(struct reader *reader)
{
    const char *link = require(reader, "link");
    if (link)
        current_joint(reader)->link_names[reader->element[0] == 'c'] =
            scene_text(&reader->robot->memory, link);
    return link != NULL;
}

/* Divided by the largest component first, the length does not overflow. */
static bool begin_axis(struct reader *reader)
{
    double *axis = current_joint(reader)->axis, most = 0, square = 0;
    if (!read_numbers(reader, "xyz", true, 3, axis))
        return false;
    for (int i = 0; i < 3; i++)
        most = fmax(most, fabs(axis[i]));
    if (most == 0)
        return current_joint(reader)->type == ROBOT_FIXED || refuse(reader, "<axis>: xyz is 0");
    for (int i = 0; i < 3; i++) {
        axis[i] /= most;
        square += axis[i] * axis[i];
    }
    for (int i = 0; i < 3; i++)
        axis[i] /= sqrt(square);
    return true;
}

/* The limits of a continuous joint are those of its effort and velocity. */
static bool begin_limit(struct reader *reader)
{
    struct robot_joint *joint = current_joint(reader);
    double limit[2] = {0, 0};
    if (joint->type == ROBOT_CONTINUOUS || joint->type == ROBOT_FIXED)
        return true;
    if (!read_numbers(reader, "lower", false, 1, &limit[0]) ||
        !read_numbers(reader, "upper", false, 1, &limit[1]))
        return false;
    memcpy(joint->limit, limit, sizeof limit);
    return limit[0] <= limit[1] || refuse(reader, "<limit>: lower is above upper");
}

/* Elements by the one that contains them. With end, begin may be NULL. Elements with a remedy are
 * refused. */
static const struct element {
    enum place within;
    const char *name;
    enum place place;
    bool (*begin)(struct reader *reader), (*end)(struct reader *reader);
    const char *remedy;
} elements[] = {
    {DOCUMENT, "robot", IN_ROBOT, NULL, NULL, NULL},
    {DOCUMENT, "sdf", 0, NULL, NULL, "SDF is not supported: give the robot as URDF"},
    {IN_ROBOT, "link", IN_LINK, begin_link, NULL, NULL},
    {IN_LINK, "collision", IN_COLLISION, begin_collision, end_collision, NULL},
    {IN_COLLISION, "origin", IN_ORIGIN, begin_origin, NULL, NULL},
    {IN_COLLISION, "geometry", IN_GEOMETRY, NULL, NULL, NULL},
    {IN_GEOMETRY, "box", IN_SHAPE, begin_box, NULL, NULL},
    {IN_GEOMETRY, "cylinder", IN_SHAPE, begin_cylinder, NULL, NULL},
    {IN_GEOMETRY, "sphere", IN_SHAPE, begin_sphere, NULL, NULL},
    {IN_GEOMETRY, "mesh", IN_SHAPE, begin_mesh, NULL, NULL},
    {IN_ROBOT, "joint", IN_JOINT, begin_joint, end_joint, NULL},
    {IN_JOINT, "origin", IN_JOINT_ORIGIN, begin_joint_origin, NULL, NULL},
    {IN_JOINT, "parent", IN_PARENT, begin_end, NULL, NULL},
    {IN_JOINT, "child", IN_CHILD, begin_end, NULL, NULL},
    {IN_JOINT, "axis", IN_AXIS, begin_axis, NULL, NULL},
    {IN_JOINT, "limit", IN_LIMIT, begin_limit, NULL, NULL},
    {IN_JOINT, "mimic", 0, NULL, NULL,
     "mimic joints are not supported: remove <mimic>, and give the joint its value"},
#define SRDF "SRDF is not supported: give the robot as URDF"
    {IN_ROBOT, "group", 0, NULL, NULL, SRDF},
    {IN_ROBOT, "group_state", 0, NULL, NULL, SRDF},
    {IN_ROBOT, "virtual_joint", 0, NULL, NULL, SRDF},
    {IN_ROBOT, "disable_collisions", 0, NULL, NULL, SRDF},
};

enum { ELEMENTS = sizeof elements / sizeof *elements };

static const struct element *find_element(const struct reader *reader, const char *name)
{
    for (size_t i = 0; i < ELEMENTS; i++)
        if (elements[i].within == reader->place && strcmp(elements[i].name, name) == 0)
            return &elements[i];
    return NULL;
}

/* Of elements within one place at most one may stand there. */
static bool check_once(struct reader *reader, const struct element *element)
{
    const unsigned bit = 1u << element->place;
    const bool many = element->within < IN_COLLISION;
    if (!many && (reader->seen & bit) != 0)
        return refuse(reader,
                      element->place == IN_SHAPE ? "<%s>: there is a shape already"
                                                 : "there is a second <%s>",
                      element->name);
    reader->seen |= many ? 0 : bit;
    return true;
}

static void XMLCALL on_begin(void *user, const XML_Char *name, const XML_Char **attributes)
{
    struct reader *reader = user;
    const struct element *element = reader->skipped > 0 ? NULL : find_element(reader, name);
    if (reader->failed)
        return;
    reader->element = name;
    reader->found = attributes;
    if (strncmp(name, "xacro:", 6) == 0)
        refuse(reader, "<%.64s>: expand the file by xacro first", name);
    else if (!element && reader->place == DOCUMENT)
        refuse(reader, "<%.64s> is no <robot>: give the robot as URDF", name);
    else if (!element && reader->place == IN_GEOMETRY)
        refuse(reader, "<%.64s>: expected a box, cylinder, sphere or mesh", name);
    else if (!element)
        reader->skipped++;
    else if (element->remedy)
        refuse(reader, "<%s>: %s", name, element->remedy);
    else if (check_once(reader, element) && (!element->begin || element->begin(reader)))
        reader->place = element->place;
}

static void XMLCALL on_end(void *user, const XML_Char *name)
{
    struct reader *reader = user;
    const struct element *element = elements;
    (void) name;
    if (reader->failed)
        return;
    if (reader->skipped > 0) {
        reader->skipped--;
        return;
    }
    while (element->place != reader->place)
        element++;
    if (!element->end || element->end(reader))
        reader->place = element->within;
}

static void XMLCALL on_doctype(void *user, const XML_Char *name, const XML_Char *system,
                               const XML_Char *public, int internal)
{
    (void) name, (void) system, (void) public, (void) internal;
    refuse(user, "<!DOCTYPE>: document types and entities are not supported: remove it");
}

/* ---- The file ---- */

static bool parse(struct reader *reader, FILE *file)
{
    const char *path = reader->robot->path;
    size_t bytes = 0, size;
    do {
        enum { PIECE = 1 << 20 };
        void *piece = XML_GetBuffer(reader->xml, PIECE);
        if (!piece)
            allocate_failed();
        size = fread(piece, 1, PIECE, file);
        if (ferror(file)) {
            complain("%s: %s", path, strerror(errno));
            return false;
        }
        bytes += size;
        if (bytes > ROBOT_BYTES_MAX) {
            complain("%s: more than %d bytes", path, (int) ROBOT_BYTES_MAX);
            return false;
        }
        if (XML_ParseBuffer(reader->xml, (int) size, size == 0) != XML_STATUS_OK) {
            if (!reader->failed)
                complain("%s: line %lu: XML: %s", path, XML_GetCurrentLineNumber(reader->xml),
                         XML_ErrorString(XML_GetErrorCode(reader->xml)));
            return false;
        }
    } while (size > 0);
    if (reader->robot->link_count == 0)
        complain("%s: there is no <link> in <robot>", path);
    return reader->robot->link_count > 0;
}

bool robot_read(const char *path, struct robot *out)
{
    const bool named = strcmp(path, "-") != 0;
    FILE *file = named ? fopen(path, "r") : stdin;
    *out = (struct robot){.path = named ? path : "standard input"};
    if (!file) {
        complain("%s: %s", path, strerror(errno));
        return false;
    }
    struct reader reader = {.xml = XML_ParserCreate(NULL), .robot = out};
    if (!reader.xml)
        allocate_failed();
    XML_SetUserData(reader.xml, &reader);
    XML_SetElementHandler(reader.xml, on_begin, on_end);
    XML_SetStartDoctypeDeclHandler(reader.xml, on_doctype);
    const bool good = parse(&reader, file);
    XML_ParserFree(reader.xml);
    if (named)
        fclose(file);
    return good && robot_connect(out);
}
