/* Reads URDF. Expat's events become a tree of elements; links and joints are read from it, and
 * all else (<visual>, <inertial>, <gazebo>, ...) is ignored.
 *
 * Files are not trusted. A document type declaration is refused, so that entities are neither
 * declared nor loaded, and nothing expands. Bytes, links, joints and elements are bounded
 * (robot.h); nothing recurses. */
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

#if XML_MAJOR_VERSION == 2 && XML_MINOR_VERSION < 9
#define XML_GetCurrentLineNumber64 XML_GetCurrentLineNumber /* which later versions deprecate */
#endif

struct node {
    const char *name;
    const char **attributes; /* name, value (NULL: ""), ..., NULL */
    unsigned long line;
    struct node *parent, *child, *last, *next; /* first and last child; next sibling */
};

/* After the first error, functions report nothing more, and their results are not used. */
struct reader {
    XML_Parser xml;
    struct robot *robot;
    struct node document, *at;       /* at: the open element */
    const char *kind;                /* "link" or "joint", which is being read; NULL: neither */
    const struct robot_name *within; /* its name */
    bool failed;
};

/* Reports the first error. */
__attribute__((format(printf, 3, 4))) static void refuse(struct reader *reader, unsigned long line,
                                                         const char *format, ...)
{
    char place[COMPLAIN_PLACE_MAX];
    va_list list;
    if (reader->failed)
        return;
    const int length = snprintf(place, sizeof place, "%s: line %lu", reader->robot->path, line);
    if (reader->kind && length < COMPLAIN_PLACE_MAX)
        snprintf(place + length, sizeof place - (size_t) length, ": %s '%s'", reader->kind,
                 reader->within->name);
    va_start(list, format);
    complain_at(place, format, list);
    va_end(list);
    reader->failed = true;
}

/* ---- The tree ---- */

/* As refuse(), and stops the parser. */
static void stop(struct reader *reader, const char *name, const char *why)
{
    refuse(reader, XML_GetCurrentLineNumber64(reader->xml), "<%.64s>: %s", name, why);
    XML_StopParser(reader->xml, XML_FALSE);
}

static void XMLCALL on_begin(void *user, const XML_Char *name, const XML_Char **attributes)
{
    struct reader *reader = user;
    struct owned_scene *memory = &reader->robot->memory;
    struct node *parent = reader->at, *node = scene_alloc(memory, 1, sizeof *node);
    size_t count = 0;
    while (attributes[count])
        count++;
    *node = (struct node){.name = scene_text(memory, name),
                          .attributes = scene_alloc(memory, count + 1, sizeof *node->attributes),
                          .line = XML_GetCurrentLineNumber64(reader->xml),
                          .parent = parent};
    for (size_t i = 0; i < count; i++)
        node->attributes[i] = scene_text(memory, attributes[i]);
    *(parent->last ? &parent->last->next : &parent->child) = node;
    reader->at = parent->last = node;
    if (strncmp(name, "xacro:", 6) == 0)
        stop(reader, name, "expand the file with xacro first");
}

static void XMLCALL on_end(void *user, const XML_Char *name)
{
    struct reader *reader = user;
    (void) name;
    reader->at = reader->at->parent;
}

static void XMLCALL on_doctype(void *user, const XML_Char *name, const XML_Char *system,
                               const XML_Char *public, int internal)
{
    (void) name, (void) system, (void) public, (void) internal;
    stop(user, "!DOCTYPE", "document types and entities are not supported: remove the declaration");
}

/* What to do about errors whose text in Expat does not say it. */
static const char *xml_remedy(enum XML_Error error)
{
    switch (error) {
    case XML_ERROR_MISPLACED_XML_PI: return ": move <?xml ...?> to the start of the file";
    case XML_ERROR_XML_DECL: return ": write <?xml version=\"1.0\"?>";
    case XML_ERROR_UNKNOWN_ENCODING: return ": save the file as UTF-8, and say so in <?xml ...?>";
    case XML_ERROR_INVALID_TOKEN: return ": a stray < or &, or text that is not UTF-8";
    case XML_ERROR_NO_ELEMENTS: return ": the file ends too early";
    default: return "";
    }
}

static bool parse(struct reader *reader, FILE *file)
{
    enum { PIECE = 1 << 16 };
    size_t bytes = 0, size;
    do {
        void *piece = XML_GetBuffer(reader->xml, PIECE);
        if (!piece)
            allocate_failed();
        size = fread(piece, 1, PIECE, file);
        bytes += size;
        if (ferror(file) || bytes > ROBOT_BYTES_MAX) {
            complain("%s: %s", reader->robot->path,
                     ferror(file) ? strerror(errno) : "more than 8 MB");
            return false;
        }
        if (XML_ParseBuffer(reader->xml, (int) size, size == 0) != XML_STATUS_OK) {
            const enum XML_Error error = XML_GetErrorCode(reader->xml);
            refuse(reader, XML_GetCurrentLineNumber64(reader->xml), "XML: %s%s",
                   XML_ErrorString(error), xml_remedy(error));
        }
    } while (size > 0 && !reader->failed);
    return !reader->failed;
}

/* ---- Elements and attributes ---- */

static bool is(const struct node *node, const char *name)
{
    return strcmp(node->name, name) == 0;
}

/* Returns the only element of this name in a parent, or NULL. */
static const struct node *find_child(struct reader *reader, const struct node *parent,
                                     const char *name)
{
    const struct node *found = NULL;
    for (const struct node *node = parent->child; node; node = node->next) {
        if (is(node, name) && found)
            refuse(reader, node->line, "there is a second <%s>", name);
        found = is(node, name) ? node : found;
    }
    return found;
}

/* Returns the value of an attribute; NULL if it is missing, which is an error if it is required. An
 * empty value and an expression of xacro are errors. */
static const char *find_attribute(struct reader *reader, const struct node *node, const char *name,
                                  bool required)
{
    for (const char **at = node->attributes; *at; at += 2)
        if (strcmp(at[0], name) == 0) {
            if (!at[1])
                refuse(reader, node->line, "<%s>: %s is empty", node->name, name);
            else if (strstr(at[1], "${") || strstr(at[1], "$("))
                refuse(reader, node->line, "<%s>: %s is '%.64s': expand the file with xacro first",
                       node->name, name, at[1]);
            return at[1];
        }
    if (required)
        refuse(reader, node->line, "<%s> has no %s", node->name, name);
    return NULL;
}

/* Reads count numbers. A missing attribute leaves out unchanged. */
static void read_numbers(struct reader *reader, const struct node *node, const char *name,
                         bool required, int count, double *out)
{
    const char *value = find_attribute(reader, node, name, required);
    if (value && !robot_numbers(value, count, out))
        refuse(reader, node->line, "<%s>: %s is '%.64s', expected %d finite number%s", node->name,
               name, value, count, count > 1 ? "s, separated by spaces" : "");
}

static void read_sizes(struct reader *reader, const struct node *node, const char *name, int count,
                       double *out)
{
    read_numbers(reader, node, name, true, count, out);
    for (int i = 0; i < count; i++)
        if (out[i] < 0)
            refuse(reader, node->line, "<%s>: %s is negative", node->name, name);
}

static void read_origin(struct reader *reader, const struct node *parent, struct pose *out)
{
    const struct node *node = find_child(reader, parent, "origin");
    double rpy[3] = {0};
    *out = POSE_IDENTITY;
    if (!node)
        return;
    for (const char **at = node->attributes; *at; at += 2) /* quat_xyzw of URDF 1.1, and others */
        if (strcmp(at[0], "xyz") != 0 && strcmp(at[0], "rpy") != 0)
            refuse(reader, node->line, "<origin>: %.64s is not supported: give xyz and rpy", at[0]);
    read_numbers(reader, node, "xyz", false, 3, out->p);
    read_numbers(reader, node, "rpy", false, 3, rpy);
    for (int i = 0; i < 3; i++)
        if (fabs(rpy[i]) > TURN_RADIANS_MAX)
            refuse(reader, node->line, "<origin>: rpy is beyond %.0f radians", TURN_RADIANS_MAX);
    if (!reader->failed)
        pose_turn_rpy(rpy, out->q);
}

/* Begins to read a link or a joint: adds its name to the table. Returns NULL after an error. */
static const struct robot_name *begin(struct reader *reader, const struct node *node,
                                      struct robot_name **table)
{
    const char *name = find_attribute(reader, node, "name", true);
    const struct robot_name *first;
    struct robot_name *added = NULL;
    if (!name)
        return NULL;
    if (HASH_COUNT(*table) == ROBOT_COUNT_MAX)
        refuse(reader, node->line, "more than %d <%s> elements", (int) ROBOT_COUNT_MAX, node->name);
    else if (!query_name_ok(name))
        refuse(reader, node->line,
               "<%s>: the name '%.80s' has more than %d bytes, or is not UTF-8 without "
               "control characters",
               node->name, name, (int) QUERY_NAME_MAX);
    else if (!(added = robot_add_name(reader->robot, table, name, &first)))
        refuse(reader, node->line, "there is already a %s '%s', in line %lu", node->name, name,
               first->line);
    if (!added)
        return NULL;
    added->line = node->line;
    reader->kind = node->name;
    reader->within = added;
    return added;
}

/* ---- Links ---- */

static void read_shape(struct reader *reader, const struct node *node, struct robot_element *out)
{
    if (is(node, "box")) {
        out->shape = ROBOT_BOX;
        read_sizes(reader, node, "size", 3, out->size);
    } else if (is(node, "cylinder") || is(node, "capsule")) {
        out->shape = is(node, "cylinder") ? ROBOT_CYLINDER : ROBOT_CAPSULE;
        read_sizes(reader, node, "radius", 1, &out->size[0]);
        read_sizes(reader, node, "length", 1, &out->size[1]);
    } else if (is(node, "sphere")) {
        out->shape = ROBOT_CAPSULE;
        read_sizes(reader, node, "radius", 1, out->size);
    } else if (is(node, "mesh")) {
        out->shape = ROBOT_MESH;
        out->file = find_attribute(reader, node, "filename", true);
        out->size[0] = out->size[1] = out->size[2] = 1;
        read_numbers(reader, node, "scale", false, 3, out->size);
    } else {
        refuse(reader, node->line, "<%.64s>: expected a box, cylinder, sphere, capsule or mesh",
               node->name);
    }
}

/* Returns the first of a list of elements whose name has no prefix of another namespace, or NULL.
 */
static const struct node *skip_foreign(const struct node *node)
{
    while (node && strchr(node->name, ':'))
        node = node->next;
    return node;
}

static void read_collision(struct reader *reader, const struct node *node)
{
    struct robot *robot = reader->robot;
    const struct node *geometry = find_child(reader, node, "geometry");
    const struct node *first = geometry ? geometry->child : NULL, *own = skip_foreign(first);
    const struct node *second = own ? skip_foreign(own->next) : NULL, *shape = own ? own : first;
    if (robot->element_count == ROBOT_COUNT_MAX)
        refuse(reader, node->line, "more than %d <collision> elements", (int) ROBOT_COUNT_MAX);
    if (!shape)
        refuse(reader, node->line, "<collision> has no <geometry> with a shape");
    else if (second)
        refuse(reader, second->line, "<%.64s>: there is already a shape", second->name);
    if (reader->failed)
        return;
    robot->elements = allocate_grow(robot->elements, &robot->element_capacity,
                                    robot->element_count + 1, sizeof *robot->elements);
    struct robot_element *element = &robot->elements[robot->element_count++];
    *element = (struct robot_element){.line = node->line};
    read_origin(reader, node, &element->origin);
    read_shape(reader, shape, element);
}

static void read_link(struct reader *reader, const struct node *node)
{
    struct robot *robot = reader->robot;
    const struct robot_name *name = begin(reader, node, &robot->link_names);
    const size_t first = robot->element_count;
    if (!name)
        return;
    for (const struct node *child = node->child; child; child = child->next)
        if (is(child, "collision"))
            read_collision(reader, child);
    robot->links = allocate_grow(robot->links, &robot->link_capacity, robot->link_count + 1,
                                 sizeof *robot->links);
    robot->links[robot->link_count++] =
        (struct robot_link){.name = name,
                            .element = first,
                            .element_count = robot->element_count - first,
                            .joint = ROBOT_ROOT};
}

/* ---- Joints ---- */

static void read_type(struct reader *reader, const struct node *node, struct robot_joint *out)
{
    static const char *const types[] = {"revolute", "continuous", "prismatic", "fixed"};
    const char *type = find_attribute(reader, node, "type", true);
    for (int i = 0; type && i < 4; i++)
        if (strcmp(types[i], type) == 0) {
            out->type = (enum robot_joint_type) i;
            return;
        }
    refuse(reader, node->line,
           "its type is '%.64s', expected revolute, continuous, prismatic or fixed (in place of "
           "planar or floating: a chain of these)",
           type ? type : "");
}

/* Components are first divided by the largest one, so that the length does not overflow. */
static void read_axis(struct reader *reader, const struct node *node, struct robot_joint *out)
{
    double most = 0, square = 0;
    read_numbers(reader, node, "xyz", true, 3, out->axis);
    for (int i = 0; i < 3; i++)
        most = fmax(most, fabs(out->axis[i]));
    for (int i = 0; i < 3; i++)
        square += (out->axis[i] / most) * (out->axis[i] / most);
    for (int i = 0; i < 3; i++)
        out->axis[i] = out->axis[i] / most / sqrt(square);
    if (most == 0 && out->type != ROBOT_FIXED)
        refuse(reader, node->line, "<axis>: xyz is 0");
}

static void read_joint(struct reader *reader, const struct node *node)
{
    static const char *const ends[2] = {"parent", "child"};
    struct robot *robot = reader->robot;
    struct robot_joint joint = {.name = begin(reader, node, &robot->joint_names),
                                .axis = {1, 0, 0},
                                .limit = {-INFINITY, INFINITY},
                                .multiplier = 1};
    if (!joint.name)
        return;
    read_type(reader, node, &joint);
    read_origin(reader, node, &joint.origin);
    const struct node *axis = find_child(reader, node, "axis"),
                      *limit = find_child(reader, node, "limit"),
                      *mimic = find_child(reader, node, "mimic");
    for (int end = 0; end < 2; end++) {
        const struct node *link = find_child(reader, node, ends[end]);
        const char *name = link ? find_attribute(reader, link, "link", true) : NULL;
        if (!link)
            refuse(reader, node->line, "there is no <%s>", ends[end]);
        else if (name && !utf8_is_text(name))
            refuse(reader, link->line, "<%s>: the link '%.80s' has control characters", ends[end],
                   name);
        joint.link_names[end] = name;
    }
    if (axis)
        read_axis(reader, axis, &joint);
    if (mimic && joint.type != ROBOT_FIXED) {
        joint.mimic_name = find_attribute(reader, mimic, "joint", true);
        read_numbers(reader, mimic, "multiplier", false, 1, &joint.multiplier);
        read_numbers(reader, mimic, "offset", false, 1, &joint.offset);
    }
    if (joint.type == ROBOT_REVOLUTE || joint.type == ROBOT_PRISMATIC) {
        joint.limit[0] = joint.limit[1] = 0;
        if (!limit) {
            refuse(reader, node->line, "there is no <limit>, which a joint of this type needs");
            return;
        }
        read_numbers(reader, limit, "lower", false, 1, &joint.limit[0]);
        read_numbers(reader, limit, "upper", false, 1, &joint.limit[1]);
        if (!(joint.limit[0] <= joint.limit[1]))
            refuse(reader, limit->line, "<limit>: lower is above upper");
    }
    robot->joints = allocate_grow(robot->joints, &robot->joint_capacity, robot->joint_count + 1,
                                  sizeof *robot->joints);
    robot->joints[robot->joint_count++] = joint;
}

/* ---- The file ---- */

static void read_robot(struct reader *reader, const struct node *robot)
{
    static const char *const srdf[] = {"group", "group_state", "virtual_joint",
                                       "disable_collisions"};
    if (!is(robot, "robot"))
        refuse(reader, robot->line,
               "expected <robot>, found <%.64s>: SDF and others are not supported: give the robot "
               "as URDF",
               robot->name);
    for (const struct node *node = robot->child; node && !reader->failed; node = node->next) {
        reader->kind = NULL;
        for (size_t i = 0; i < sizeof srdf / sizeof *srdf; i++)
            if (is(node, srdf[i]))
                refuse(reader, node->line, "<%s>: SRDF is not supported: give the robot as URDF",
                       node->name);
        if (is(node, "link"))
            read_link(reader, node);
        else if (is(node, "joint"))
            read_joint(reader, node);
    }
    reader->kind = NULL;
    if (reader->robot->link_count == 0)
        refuse(reader, robot->line, "<robot> has no <link>");
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
    struct reader reader = {.xml = XML_ParserCreate(NULL), .robot = out, .at = &reader.document};
    if (!reader.xml)
        allocate_failed();
    XML_SetUserData(reader.xml, &reader);
    XML_SetElementHandler(reader.xml, on_begin, on_end);
    XML_SetStartDoctypeDeclHandler(reader.xml, on_doctype);
    if (parse(&reader, file))
        read_robot(&reader, reader.document.child);
    else
        reader.failed = true;
    XML_ParserFree(reader.xml);
    if (named)
        fclose(file);
    return !reader.failed && robot_connect(out);
}
