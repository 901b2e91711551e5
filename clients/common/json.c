/* text.c splits the input into objects. cJSON parses each into a tree; what it accepts beyond JSON
 * is refused here (tokens_end()). The tree is checked, copied into a scene, and freed.
 *
 * Properties of cJSON 1.7 that matter here: access to an array by index traverses its list, so each
 * list is traversed once. The look-up of a key takes the first match and ignores case, so keys are
 * compared here. 1e999 reads as infinite, so every number is checked. Numbers are read by strtod(),
 * rounded correctly, in the C locale. */
#include "json.h"

#include "allocate.h"
#include "enclosure.h"
#include "fmb_client.h"
#include "keyed_hash.h"
#include "number.h"
#include "text.h"
#include "query.h"
#include "turn.h"
#include "turned_box.h"
#include "utf8.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ERROR_MAX = 320, QUOTED_MAX = 32 };

static const double id_max = 9007199254740991.0; /* 2^53 - 1 */

/* A body in the tables by id and, if it is the first one with its name, by name. */
struct body_id {
    UT_hash_handle hh, by_name;
    int64_t id;
    unsigned index;
    unsigned namesake; /* index of another body with this name; 0: there is none */
};

struct json_reader {
    struct text text;
    bool links_allowed;
    size_t scene_number;       /* of the object that is being read, from 1 */
    struct owned_scene *scene; /* what has been read of it */
    struct body_id *ids;       /* table of its bodies; the entries are those of entry */
    struct body_id *names;     /* the same by name */
    struct body_id *entry;     /* owned, [body] */
    char error[ERROR_MAX];
};

/* ---- Places in the tree: printed only if something is wrong there ---------------------------- */

/* A value, and its path in the one that contains it: a key, or an index where key is NULL. */
struct place {
    struct json_reader *reader;
    const struct place *parent; /* NULL: the scene itself */
    const cJSON *item;          /* NULL: an optional member that is missing */
    const char *key;
    size_t index;
};

static struct place first_element(const struct place *array)
{
    return (struct place){array->reader, array, array->item->child, NULL, 0};
}

static void next_element(struct place *at)
{
    at->item = at->item->next;
    at->index++;
}

static void write_path(FILE *out, const struct place *at)
{
    if (!at->parent)
        return;
    write_path(out, at->parent);
    if (!at->key)
        fprintf(out, "[%zu]", at->index);
    else
        fprintf(out, "%s%s", at->parent->parent ? "." : "", at->key);
}

/* Sets the reader's error. Always returns false. */
__attribute__((format(printf, 2, 3))) static bool refuse(const struct place *at, const char *format,
                                                         ...)
{
    struct json_reader *reader = at->reader;
    memset(reader->error, 0, sizeof reader->error);
    FILE *out = fmemopen(reader->error, sizeof reader->error - 1, "w");
    if (!out)
        allocate_failed();
    if (reader->scene_number > 1)
        fprintf(out, "scene %zu: ", reader->scene_number);
    write_path(out, at);
    if (at->parent)
        fputs(": ", out);
    va_list list;
    va_start(list, format);
    vfprintf(out, format, list);
    va_end(list);
    fclose(out);
    return false;
}

/* Copies text of the input for a message: at most QUOTED_MAX characters, in printable ASCII. */
static const char *quoted(const char *text, char out[QUOTED_MAX + 4])
{
    size_t i = 0;
    for (; text[i] && i < QUOTED_MAX; i++)
        out[i] = text[i] >= 0x20 && text[i] < 0x7f ? text[i] : '?';
    strcpy(out + i, text[i] ? "..." : "");
    return out;
}

static const char *kind_name(const cJSON *item)
{
    if (cJSON_IsNumber(item))
        return "a number";
    if (cJSON_IsString(item))
        return "a string";
    if (cJSON_IsArray(item))
        return "an array";
    if (cJSON_IsObject(item))
        return "an object";
    return cJSON_IsNull(item) ? "null" : "a boolean";
}

static bool refuse_kind(const struct place *at, const char *expected)
{
    return refuse(at, "expected %s, found %s", expected, kind_name(at->item));
}

/* ---- Objects --------------------------------------------------------------------------------- */

/* Reads a value into what out points to. Returns false if the value is refused. */
typedef bool read_function(const struct place *at, void *out);

struct key {
    const char *name;
    bool required;
    read_function *read; /* NULL: read_members() skips the key */
    size_t offset;       /* of the value in the struct of the object */
};

static bool check_present(const struct place *member)
{
    return member->item || refuse(member->parent, "missing key \"%s\"", member->key);
}

static bool refuse_key(const struct place *at, const char *found, const struct key *keys, int count)
{
    char text[QUOTED_MAX + 4], list[ERROR_MAX / 2] = "";
    for (int i = 0; i < count; i++)
        snprintf(list + strlen(list), sizeof list - strlen(list), "%s%s", i > 0 ? ", " : "",
                 keys[i].name);
    return refuse(at, "unknown key \"%s\" (there are %s)", quoted(found, text), list);
}

/* On output: member[i] is the value of keys[i]; its item is NULL if it is missing. */
static bool find_members(const struct place *at, const struct key *keys, int count,
                         struct place *member)
{
    if (!cJSON_IsObject(at->item))
        return refuse_kind(at, "an object");
    for (int i = 0; i < count; i++)
        member[i] = (struct place){at->reader, at, NULL, keys[i].name, 0};
    for (const cJSON *child = at->item->child; child; child = child->next) {
        int i = 0;
        while (i < count && strcmp(keys[i].name, child->string) != 0)
            i++;
        if (i == count)
            return refuse_key(at, child->string, keys, count);
        if (member[i].item)
            return refuse(at, "repeated key \"%s\"", keys[i].name);
        member[i].item = child;
    }
    for (int i = 0; i < count; i++)
        if (keys[i].required && !check_present(&member[i]))
            return false;
    return true;
}

/* Reads the members that are present, in the order of the keys, into the struct. */
static bool read_members(const struct place *member, const struct key *keys, int count, void *out)
{
    for (int i = 0; i < count; i++)
        if (member[i].item && keys[i].read &&
            !keys[i].read(&member[i], (char *) out + keys[i].offset))
            return false;
    return true;
}

/* ---- Arrays and numbers ---------------------------------------------------------------------- */

static int dim_of(const struct place *at)
{
    return at->reader->scene->dim;
}

/* Reads the elements of an array into out, an array of elements of size bytes. what: "numbers". */
static bool read_each(const struct place *array, size_t count, const char *what,
                      read_function *read, void *out, size_t size)
{
    if (!cJSON_IsArray(array->item))
        return refuse(array, "expected %zu %s, found %s", count, what, kind_name(array->item));
    const size_t found = (size_t) cJSON_GetArraySize(array->item);
    if (found != count)
        return refuse(array, "expected %zu %s, found %zu", count, what, found);
    for (struct place at = first_element(array); at.item; next_element(&at))
        if (!read(&at, (char *) out + at.index * size))
            return false;
    return true;
}

/* Returns the number of elements of an array of any length; SIZE_MAX if it is refused. */
static size_t count_elements(const struct place *at)
{
    if (cJSON_IsArray(at->item))
        return (size_t) cJSON_GetArraySize(at->item);
    refuse_kind(at, "an array");
    return SIZE_MAX;
}

/* Refuses a number. */
static bool refuse_value(const struct place *at, double value, const char *expected)
{
    char text[NUMBER_TEXT_MAX];
    if (isfinite(value))
        return refuse(at, "expected %s, found %s", expected, number_exact(value, text));
    return refuse(at, "expected %s, found %sinfinity (doubles end at 1.8e308)", expected,
                  value < 0 ? "-" : "");
}

static bool read_number(const struct place *at, void *out)
{
    if (!cJSON_IsNumber(at->item))
        return refuse_kind(at, "a number");
    const double value = *(double *) out = at->item->valuedouble;
    return isfinite(value) || refuse_value(at, value, "a finite number");
}

static bool read_from_0(const struct place *at, void *out)
{
    const double *value = out;
    return read_number(at, out) &&
           (*value >= 0 || refuse_value(at, *value, "a number of at least 0"));
}

static bool read_vector(const struct place *at, void *out)
{
    return read_each(at, (size_t) dim_of(at), "numbers", read_number, out, sizeof(double));
}

static bool read_dim(const struct place *at, void *out)
{
    const double dim = at->item->valuedouble;
    if (!cJSON_IsNumber(at->item))
        return refuse_kind(at, "2 or 3");
    *(int *) out = dim == 2 ? 2 : 3;
    return dim == 2 || dim == 3 || refuse_value(at, dim, "2 or 3");
}

/* Reads an integer other than 0, of magnitude up to id_max: beyond that its digits are lost. */
static bool read_integer(const struct place *at, double low, const char *expected, int64_t *out)
{
    const double value = at->item->valuedouble;
    if (!cJSON_IsNumber(at->item))
        return refuse_kind(at, expected);
    if (fabs(value) > id_max)
        return refuse(at, "expected %s, found a larger number", expected);
    if (!(value >= low && value != 0 && value == floor(value)))
        return refuse_value(at, value, expected);
    *out = (int64_t) value;
    return true;
}

static bool read_id(const struct place *at, void *out)
{
    return read_integer(at, 1, "an integer from 1 to 9007199254740991", out);
}

static bool read_group(const struct place *at, void *out)
{
    return read_integer(at, -id_max, "an integer other than 0, of magnitude up to 9007199254740991",
                        out);
}

/* Reads a name or a label. */
static bool read_name(const struct place *at, void *out)
{
    const char *name = at->item->valuestring;
    if (!cJSON_IsString(at->item))
        return refuse_kind(at, "a string");
    if (strlen(name) > QUERY_NAME_MAX)
        return refuse(at, "expected at most %d bytes, found %zu", (int) QUERY_NAME_MAX,
                      strlen(name));
    if (!utf8_is_text(name))
        return refuse(at, "expected UTF-8 without control characters");
    *(const char **) out = scene_text(at->reader->scene, name);
    return true;
}

/* ---- Frames ---------------------------------------------------------------------------------- */

/* What is read of a body; or of an element of "frames", whose position and orientation are those in
 * its body. */
struct body {
    struct fmb_placement placement;
    const char *link; /* that carries it, or NULL */
    /* The frame, unless there are several. */
    int shape; /* enum fmb_shape, or one of the text */
    double radius, length, sides;
    double origin[FMB_DIM_MAX];            /* or centre */
    double components[FMB_COMPONENTS_MAX]; /* [component * dim + axis]; of a box its size */
    double *vertices;                      /* [vertex_count * dim]; NULL: by components */
    size_t vertex_count;
};

/* Shapes that the text has besides; all of them become hulls. */
enum { SPHERE = FMB_HULL + 1, CAPSULE, CYLINDER, SHAPES };

static bool read_shape(const struct place *at, void *out)
{
    static const char *const more[] = {"sphere", "capsule", "cylinder"};
    const int dim = dim_of(at);
    char text[QUOTED_MAX + 4];
    if (!cJSON_IsString(at->item))
        return refuse_kind(at, "a string");
    for (int shape = FMB_CUBOID; shape < SHAPES; shape++) {
        const char *name = shape < SPHERE ? fmb_shape_name(shape) : more[shape - SPHERE];
        if (strcmp(at->item->valuestring, name) != 0)
            continue;
        *(int *) out = shape;
        return dim == 3 || (shape != FMB_FACE && shape != CYLINDER) ||
               refuse(at, "there is no %s in %dD", name, dim);
    }
    return refuse(at,
                  "unknown shape \"%s\" (there are cuboid, tetrahedron, face, box, hull, sphere, "
                  "capsule, cylinder)",
                  quoted(at->item->valuestring, text));
}

static bool read_components(const struct place *at, void *out)
{
    struct body *body = out;
    const size_t dim = (size_t) dim_of(at);
    return read_each(at, (size_t) fmb_component_count((int) dim, body->shape), "vectors",
                     read_vector, body->components, dim * sizeof(double));
}

static bool read_vertices(const struct place *at, void *out)
{
    struct body *body = out;
    const size_t dim = (size_t) dim_of(at);
    body->vertex_count = (size_t) fmb_component_count((int) dim, body->shape) + 1;
    if (body->shape == FMB_HULL) {
        body->vertex_count = count_elements(at);
        if (body->vertex_count == SIZE_MAX)
            return false;
        if (body->vertex_count == 0 || body->vertex_count > FMB_HULL_VERTICES_MAX)
            return refuse(at, "expected 1 to %d vertices, found %zu", (int) FMB_HULL_VERTICES_MAX,
                          body->vertex_count);
    }
    body->vertices = scene_alloc(at->reader->scene, dim * body->vertex_count, sizeof(double));
    return read_each(at, body->vertex_count, "vertices", read_vector, body->vertices,
                     dim * sizeof(double));
}

static bool read_size(const struct place *at, void *out)
{
    return read_each(at, (size_t) dim_of(at), "numbers", read_from_0, out, sizeof(double));
}

static bool read_sides(const struct place *at, void *out)
{
    const double *sides = out;
    return read_number(at, out) &&
           ((*sides >= 4 && *sides <= ENCLOSURE_SIDES_MAX && fmod(*sides, 4) == 0) ||
            refuse_value(at, *sides, "a multiple of 4 up to 512"));
}

/* Whether any number of a quaternion beyond the first is not 0. */
static bool turns(const struct fmb_placement *placement)
{
    for (int i = 1; i < placement->orientation_count; i++)
        if (placement->orientation[i] != 0)
            return true;
    return false;
}

static bool read_orientation(const struct place *at, void *out)
{
    struct fmb_placement *placement = out, checked;
    struct fmb_body any;
    const int dim = dim_of(at);
    double *q = placement->orientation;
    placement->orientation_count = dim == 2 ? 2 : 4;
    if (!read_each(at, (size_t) placement->orientation_count, "numbers", read_number, q,
                   sizeof(double)))
        return false;
    if (strcmp(at->key, "orientation_xyzw") == 0)
        memcpy(q, (const double[]){q[3], q[0], q[1], q[2]}, sizeof placement->orientation);
    if (placement->orientation[0] == 0 && !turns(placement))
        return refuse(at, "a quaternion of zeros is no rotation");
    fmb_body_make(dim, FMB_BOX, (const double[FMB_DIM_MAX]){1, 1, 1}, (size_t) dim, &any);
    checked = *placement;
    checked.body = &any;
    return fmb_placement_check(&checked) == FMB_OK ||
           refuse(at, "the numbers differ in size by more than 2^200");
}

static read_function read_frames;

/* In the order of reading. A frame has the keys from SHAPE to ORIENTATION_XYZW; an end has the last
 * three of these. */
enum { ID, NAME, GROUP, VELOCITY, LINK, SHAPE, ORIGIN, COMPONENTS, VERTICES, SIZE, RADIUS, LENGTH };
enum { SIDES = LENGTH + 1, POSITION, ORIENTATION, ORIENTATION_XYZW, FRAMES, END, BODY_KEYS };

static const struct key body_keys[BODY_KEYS] = {
    [ID] = {"id", true, read_id, offsetof(struct body, placement.id)},
    [NAME] = {"name", false, read_name, offsetof(struct body, placement.name)},
    [GROUP] = {"group", false, read_group, offsetof(struct body, placement.group)},
    [VELOCITY] = {"velocity", false, read_vector, offsetof(struct body, placement.velocity)},
    [LINK] = {"link", false, read_name, offsetof(struct body, link)},
    [SHAPE] = {"shape", false, read_shape, offsetof(struct body, shape)},
    [ORIGIN] = {"origin", false, read_vector, offsetof(struct body, origin)},
    [COMPONENTS] = {"components", false, read_components, 0},
    [VERTICES] = {"vertices", false, read_vertices, 0},
    [SIZE] = {"size", false, read_size, offsetof(struct body, components)},
    [RADIUS] = {"radius", false, read_from_0, offsetof(struct body, radius)},
    [LENGTH] = {"length", false, read_from_0, offsetof(struct body, length)},
    [SIDES] = {"sides", false, read_sides, offsetof(struct body, sides)},
    [POSITION] = {"position", false, read_vector, offsetof(struct body, placement.position)},
    [ORIENTATION] = {"orientation", false, read_orientation, offsetof(struct body, placement)},
    [ORIENTATION_XYZW] = {"orientation_xyzw", false, read_orientation,
                          offsetof(struct body, placement)},
    [FRAMES] = {"frames", false, read_frames, offsetof(struct body, placement.body)},
    [END] = {"end", false, NULL, 0},
};

/* Refuses the first of these keys that is present. keys: sum of 1 << key. what: the kind of object,
 * which has none. */
static bool check_absent(const struct place *member, unsigned keys, const char *what)
{
    for (int i = 0; i < BODY_KEYS; i++)
        if ((keys >> i & 1) != 0 && member[i].item)
            return refuse(member[i].parent, "%s has no \"%s\"", what, member[i].key);
    return true;
}

/* The keys of the frames of a kind, besides "shape": sums of 1 << key. */
struct kind {
    const char *what;
    unsigned required, optional;
};

/* Checks which keys a body or a frame of this shape has. */
static bool check_keys(const struct place *member, int shape, bool within_frames)
{
    enum { POSE = 1 << POSITION | 1 << ORIENTATION, ROUND = 1 << RADIUS };
    static const struct kind kinds[SHAPES] = {
        {"a frame of components", 1 << COMPONENTS, 1 << ORIGIN | ROUND},
        [FMB_BOX] = {"a box", 1 << SIZE, POSE | ROUND},
        [FMB_HULL] = {"a hull", 1 << VERTICES, ROUND},
        [SPHERE] = {"a sphere", ROUND, 1 << POSITION},
        [CAPSULE] = {"a capsule", ROUND | 1 << LENGTH, POSE},
        [CYLINDER] = {"a cylinder", ROUND | 1 << LENGTH, POSE | 1 << SIDES},
    };
    static const struct kind of_vertices = {"a frame of vertices", 1 << VERTICES, ROUND};
    static const struct kind of_frames = {"a body of \"frames\"", 0, POSE};
    const struct kind *kind = &kinds[shape >= FMB_BOX ? shape : 0];
    if (member[FRAMES].item)
        kind = &of_frames;
    else if (!check_present(&member[SHAPE]) ||
             (shape == FMB_CUBOID && !check_absent(member, 1 << VERTICES, "a cuboid")))
        return false;
    else if (kind == kinds && member[VERTICES].item)
        kind = &of_vertices;
    unsigned others = ~(kind->required | kind->optional) & ((1u << FRAMES) - (1u << ORIGIN));
    if (!within_frames) /* the body has a pose anyway */
        others &= ~(unsigned) POSE;
    if (!check_absent(member, others | (kind == &of_frames ? 1 << SHAPE : 0), kind->what))
        return false;
    for (int i = 0; i < BODY_KEYS; i++)
        if ((kind->required >> i & 1) != 0 && !check_present(&member[i]))
            return false;
    return kind != kinds || within_frames || member[POSITION].item || member[ORIENTATION].item ||
           check_present(&member[ORIGIN]);
}

/* Finds the members with keys `first` to `end` - 1. */
static bool find_keys(const struct place *at, int first, int end, struct place member[BODY_KEYS])
{
    memset(member, 0, BODY_KEYS * sizeof *member);
    if (!find_members(at, body_keys + first, end - first, member + first))
        return false;
    if (!member[ORIENTATION_XYZW].item)
        return true;
    if (member[ORIENTATION].item)
        return refuse(at, "both \"orientation\" and \"orientation_xyzw\"");
    if (dim_of(at) == 2)
        return refuse(&member[ORIENTATION_XYZW], "in 2D use \"orientation\"");
    member[ORIENTATION] = member[ORIENTATION_XYZW];
    member[ORIENTATION_XYZW].item = NULL;
    return true;
}

/* Reads the members with keys `first` to `end` - 1, which include all keys of a frame. */
static bool read_keys(const struct place *at, int first, int end, struct place member[BODY_KEYS],
                      struct body *out)
{
    memset(out, 0, sizeof *out);
    return find_keys(at, first, end, member) &&
           read_members(member + first, body_keys + first, SHAPE + 1 - first, out) &&
           check_keys(member, out->shape, first == SHAPE) &&
           read_members(member + ORIGIN, body_keys + ORIGIN, end - ORIGIN, out);
}

/* Sets the vertices of the core of a sphere, which has no length, or of a capsule. */
static void set_core(int dim, const struct fmb_placement *placed, struct body *body)
{
    double origin[FMB_DIM_MAX] = {0}, axis[FMB_COMPONENTS_MAX] = {[0] = 0};
    axis[dim - 1] = body->length;
    const bool turned = turns(placed);
    if (turned)
        turned_box(dim, placed->orientation, origin, axis);
    body->vertex_count = body->length > 0 ? 2 : 1;
    for (int i = 0; i < dim; i++) {
        const double half = axis[(turned ? dim * (dim - 1) : 0) + i] / 2;
        body->vertices[i] = placed->position[i] - half;
        if (body->length > 0)
            body->vertices[dim + i] = placed->position[i] + half;
    }
}

static void set_cylinder(struct owned_scene *scene, const struct fmb_placement *placed,
                         struct body *body)
{
    struct pose pose = POSE_IDENTITY;
    struct cylinder cylinder = {body->radius, body->length, &pose};
    memcpy(pose.p, placed->position, sizeof pose.p);
    if (turns(placed)) {
        memcpy(pose.q, placed->orientation, sizeof pose.q);
        turn_scale(pose.q);
    }
    const double outside =
        enclose_cylinder(&cylinder, (int) body->sides, (double(*)[FMB_DIM_MAX]) body->vertices);
    scene->outside = fmax(scene->outside, outside);
    body->radius = 0;
}

/* Makes a sphere, a capsule or a cylinder the hull that it is. placed: its pose in the body. */
static void make_hull(const struct place *at, const struct fmb_placement *placed, struct body *body)
{
    struct owned_scene *scene = at->reader->scene;
    if (body->shape < SPHERE)
        return;
    body->sides = body->sides > 0 ? body->sides : ENCLOSURE_SIDES;
    body->vertex_count = 2 * (size_t) body->sides;
    body->vertices = scene_alloc(scene, FMB_DIM_MAX * body->vertex_count, sizeof(double));
    if (body->shape == CYLINDER)
        set_cylinder(scene, placed, body);
    else
        set_core(dim_of(at), placed, body);
    body->shape = FMB_HULL;
}

static struct given_frame frame_of(const struct place *at, const struct body *body)
{
    const size_t dim = (size_t) dim_of(at);
    const size_t components = (size_t) fmb_component_count((int) dim, body->shape);
    if (body->vertices)
        return (struct given_frame){body->shape, true, dim * body->vertex_count, body->vertices,
                                    body->radius};
    const size_t count = body->shape == FMB_BOX ? dim : dim * components;
    double *numbers = scene_alloc(at->reader->scene, dim + count, sizeof *numbers);
    memcpy(numbers, body->origin, dim * sizeof *numbers);
    memcpy(numbers + dim, body->components, count * sizeof *numbers);
    return (struct given_frame){body->shape, false, dim + count, numbers, body->radius};
}

/* Reads an element of "frames". */
static bool read_frame(const struct place *at, struct given_frame *out)
{
    struct place member[BODY_KEYS];
    struct body body;
    if (!read_keys(at, SHAPE, FRAMES, member, &body))
        return false;
    if (body.shape == FMB_BOX)
        memcpy(body.origin, body.placement.position, sizeof body.origin);
    make_hull(at, &body.placement, &body);
    if (body.shape == FMB_BOX && turns(&body.placement)) {
        turned_box(dim_of(at), body.placement.orientation, body.origin, body.components);
        body.shape = FMB_CUBOID;
    }
    *out = frame_of(at, &body);
    return true;
}

/* Makes a body of frames, whose bytes in a message are limited. */
static bool make_body(const struct place *at, const struct given_frame *given, size_t count,
                      const struct fmb_body **out)
{
    const size_t bytes = scene_body_bytes(given, count);
    size_t bad;
    if (bytes > FMB_CLIENT_BODY_BYTES_MAX)
        return refuse(at,
                      "%s: %zu bytes in a message, which has space for %d: divide it into bodies "
                      "of one group",
                      fmb_status_text(FMB_OVER_LIMIT), bytes, (int) FMB_CLIENT_BODY_BYTES_MAX);
    const enum fmb_status status = scene_make_body(at->reader->scene, given, count, out, &bad);
    const struct place frame = {at->reader, at, NULL, NULL, bad};
    return status == FMB_OK ||
           refuse(count > 1 && bad < count ? &frame : at, "%s", fmb_status_text(status));
}

static bool read_frames(const struct place *array, void *out)
{
    const size_t count = count_elements(array);
    if (count == SIZE_MAX)
        return false;
    struct given_frame *given = scene_alloc(array->reader->scene, count, sizeof *given);
    for (struct place at = first_element(array); at.item; next_element(&at))
        if (!read_frame(&at, &given[at.index]))
            return false;
    return make_body(array, given, count, out);
}

/* ---- Bodies ---------------------------------------------------------------------------------- */

static const struct body_id *find_id(const struct json_reader *reader, int64_t id)
{
    const struct body_id *found;
    HASH_FIND(hh, reader->ids, &id, sizeof id, found);
    return found;
}

/* Adds body `index` to the tables. at: its id. */
static bool add_id(const struct place *at, int64_t id, const char *name, size_t index)
{
    struct json_reader *reader = at->reader;
    const struct body_id *first = find_id(reader, id);
    struct body_id *entry = &reader->entry[index], *named = NULL;
    if (first)
        return refuse(at, "%lld is the id of bodies[%u] already", (long long) id, first->index);
    *entry = (struct body_id){.id = id, .index = (unsigned) index};
    HASH_ADD(hh, reader->ids, id, sizeof entry->id, entry);
    if (!name)
        return true;
    HASH_FIND(by_name, reader->names, name, strlen(name), named);
    if (named)
        named->namesake = (unsigned) index;
    else
        HASH_ADD_KEYPTR(by_name, reader->names, name, strlen(name), entry);
    return true;
}

/* Reads the end of a body whose other fields are complete. A missing member of the end has the
 * value at the start of the window. */
static bool read_end(const struct place *at, struct fmb_placement *placement)
{
    struct place member[BODY_KEYS];
    struct body end = {.placement = *placement};
    if (!find_keys(at, POSITION, FRAMES, member) ||
        !read_members(member + POSITION, body_keys + POSITION, FRAMES - POSITION, &end))
        return false;
    if (at->reader->scene->scene.duration == 0)
        return refuse(at, "\"duration\" is 0: the window has no end of its own");
    if (placement->orientation_count == 0 && member[ORIENTATION].item)
        placement->orientation[0] = 1;
    placement->orientation_count = end.placement.orientation_count;
    placement->end_count = dim_of(at) + placement->orientation_count;
    memcpy(placement->end_position, end.placement.position, sizeof placement->end_position);
    memcpy(placement->end_orientation, end.placement.orientation,
           sizeof placement->end_orientation);
    return fmb_placement_check(placement) == FMB_OK ||
           refuse(&member[ORIENTATION],
                  "half a turn away, which takes two windows, or not from 1/4 to 4 times as long");
}

/* Reads a body. The "origin" of one that is a frame of components is its position, if it has
 * neither "position" nor "orientation". */
static bool read_body(const struct place *at, void *out)
{
    struct owned_scene *scene = at->reader->scene;
    struct place member[BODY_KEYS];
    struct body body;
    struct fmb_placement *placement = &body.placement;
    if (!read_keys(at, ID, BODY_KEYS, member, &body) ||
        !add_id(&member[ID], placement->id, placement->name, at->index))
        return false;
    if (!member[FRAMES].item) {
        if (member[COMPONENTS].item && !member[POSITION].item && !member[ORIENTATION].item) {
            memcpy(placement->position, body.origin, sizeof placement->position);
            memset(body.origin, 0, sizeof body.origin);
        }
        static const struct fmb_placement unmoved;
        make_hull(at, &unmoved, &body);
        const struct given_frame given = frame_of(at, &body);
        if (!make_body(at, &given, 1, &placement->body))
            return false;
    }
    if (member[END].item && member[VELOCITY].item)
        return refuse(at, "both \"velocity\" and \"end\"");
    if (member[END].item && !read_end(&member[END], placement))
        return false;
    *(struct fmb_placement *) out = *placement;
    if (!member[LINK].item)
        return true;
    if (!at->reader->links_allowed)
        return refuse(&member[LINK],
                      "only bodies that are added to a robot may have it (fmb scene --with)");
    if (!scene->links)
        scene->links = scene_alloc(scene, scene->scene.placement_count, sizeof *scene->links);
    scene->links[at->index] = body.link ? body.link : "";
    return true;
}

static bool read_bodies(const struct place *array, void *out)
{
    struct fmb_scene *scene = out;
    const size_t count = count_elements(array);
    if (count == SIZE_MAX)
        return false;
    struct fmb_placement *placements = scene_alloc(array->reader->scene, count, sizeof *placements);
    array->reader->entry = allocate(count, sizeof *array->reader->entry);
    scene->placements = placements;
    scene->placement_count = count;
    return read_each(array, count, "bodies", read_body, placements, sizeof *placements);
}

/* ---- Pairs ----------------------------------------------------------------------------------- */

/* Finds the body with a name. Returns NULL if it is refused: there is none, or there are two. */
static const struct body_id *find_named(const struct place *at)
{
    const char *name = at->item->valuestring;
    const struct body_id *found;
    char text[QUOTED_MAX + 4];
    HASH_FIND(by_name, at->reader->names, name, strlen(name), found);
    if (!found)
        refuse(at, "no body has the name \"%s\"", quoted(name, text));
    else if (found->namesake)
        refuse(at, "bodies[%u] and bodies[%u] both have the name \"%s\": use ids", found->index,
               found->namesake, quoted(name, text));
    return found && !found->namesake ? found : NULL;
}

/* Reads an id or a name as the index of its body. */
static bool read_index(const struct place *at, void *out)
{
    int64_t id;
    if (cJSON_IsString(at->item)) {
        const struct body_id *named = find_named(at);
        *(unsigned *) out = named ? named->index : 0;
        return named;
    }
    if (!read_id(at, &id))
        return false;
    const struct body_id *body = find_id(at->reader, id);
    if (!body)
        return refuse(at, "no body has the id %lld", (long long) id);
    *(unsigned *) out = body->index;
    return true;
}

static bool read_pair(const struct place *at, void *out)
{
    const unsigned *pair = out;
    if (!read_each(at, 2, "ids", read_index, out, sizeof *pair))
        return false;
    return pair[0] != pair[1] ||
           refuse(at, "a body is no pair with itself (%lld)",
                  (long long) at->reader->scene->scene.placements[pair[0]].id);
}

/* Reads a list of pairs. Returns NULL if it is refused. */
static unsigned (*read_list(const struct place *array, size_t *count))[2]
{
    *count = count_elements(array);
    if (*count == SIZE_MAX)
        return NULL;
    unsigned(*list)[2] = scene_alloc(array->reader->scene, *count, sizeof *list);
    return read_each(array, *count, "pairs", read_pair, list, sizeof *list) ? list : NULL;
}

static bool read_pairs(const struct place *array, void *out)
{
    struct fmb_scene *scene = out;
    scene->which = FMB_PAIRS_LISTED;
    scene->pairs = (const unsigned(*)[2]) read_list(array, &scene->pair_count);
    return scene->pairs != NULL;
}

static bool read_ignored(const struct place *array, void *out)
{
    struct fmb_scene *scene = out;
    scene->ignored = (const unsigned(*)[2]) read_list(array, &scene->ignored_count);
    return scene->ignored != NULL;
}

/* Refuses listed pairs that are left out. at: the list. */
static bool check_listed(const struct place *at, struct owned_scene *owner)
{
    const struct fmb_scene *scene = &owner->scene;
    for (size_t i = 0; i < scene->pair_count; i++) {
        const struct place pair = {at->reader, at, NULL, NULL, i};
        const unsigned a = scene->pairs[i][0], b = scene->pairs[i][1];
        if (pair_is_within_group(scene, a, b))
            return refuse(&pair, "both bodies are of group %lld",
                          (long long) scene->placements[a].group);
        if (scene_leaves_out(owner, a, b))
            return refuse(&pair, "\"ignore\" has this pair too");
    }
    return true;
}

/* ---- The scene ------------------------------------------------------------------------------- */

enum { LABEL, DIM, DURATION, MARGIN, BODIES, PAIRS, IGNORE, SCENE_KEYS };

static const struct key scene_keys[SCENE_KEYS] = {
    [LABEL] = {"label", false, read_name, offsetof(struct owned_scene, scene.label)},
    [DIM] = {"dim", true, read_dim, offsetof(struct owned_scene, dim)},
    [DURATION] = {"duration", false, read_from_0, offsetof(struct owned_scene, scene.duration)},
    [MARGIN] = {"margin", false, read_from_0, offsetof(struct owned_scene, scene.margin)},
    [BODIES] = {"bodies", true, read_bodies, offsetof(struct owned_scene, scene)},
    [PAIRS] = {"pairs", false, read_pairs, offsetof(struct owned_scene, scene)},
    [IGNORE] = {"ignore", false, read_ignored, offsetof(struct owned_scene, scene)},
};

static bool read_scene(struct json_reader *reader, const cJSON *item)
{
    const struct place root = {.reader = reader, .item = item};
    struct place member[SCENE_KEYS];
    struct fmb_scene *scene = &reader->scene->scene;
    scene->duration = 1;
    if (!find_members(&root, scene_keys, SCENE_KEYS, member) ||
        !read_members(member, scene_keys, SCENE_KEYS, reader->scene))
        return false;
    scene_begin_ignored(reader->scene);
    if (!check_listed(&member[PAIRS], reader->scene))
        return false;
    scene->instant = scene->duration == 0;
    if (scene->which == FMB_PAIRS_LISTED)
        scene->ignored_count = 0;
    return true;
}

/* ---- The input ------------------------------------------------------------------------------- */

static void *allocate_bytes(size_t size)
{
    return allocate(size, 1);
}

void json_exit_without_memory(void)
{
    cJSON_InitHooks(&(cJSON_Hooks){allocate_bytes, free});
}

struct json_reader *json_open(int fd)
{
    struct json_reader *reader = allocate(1, sizeof *reader);
    text_open(fd, &reader->text);
    reader->scene_number = 1;
    return reader;
}

void json_allow_links(struct json_reader *reader)
{
    reader->links_allowed = true;
}

void json_close(struct json_reader *reader)
{
    text_close(&reader->text);
    free(reader);
}

const char *json_error(const struct json_reader *reader)
{
    return reader->error;
}

static enum json_outcome fail(struct json_reader *reader, enum json_outcome outcome,
                              const char *why)
{
    refuse(&(struct place){.reader = reader}, "%s", why);
    return outcome;
}

/* ---- Tokens ----
 *
 * cJSON accepts numbers such as 01, 1. and -.5, control characters in strings and outside of them,
 * and \u before characters that are not hexadecimal digits; and it ends a string at \u0000. Each
 * function below moves *at past a token and returns true, or moves it to the first invalid byte and
 * returns false. The bracket that ends the object stops them, since it is outside all strings. */

static bool skip_digits(const char **at)
{
    const size_t count = strspn(*at, "0123456789");
    *at += count;
    return count > 0;
}

static bool skip_number(const char **at)
{
    *at += **at == '-';
    if (**at == '0')
        ++*at;
    else if (!skip_digits(at))
        return false;
    if (**at == '.' && (++*at, !skip_digits(at)))
        return false;
    if (**at != 'e' && **at != 'E')
        return !strchr("+-.0123456789", **at); /* false for a byte 0 too */
    ++*at;
    *at += **at == '+' || **at == '-';
    return skip_digits(at) && !strchr("+-.eE", **at);
}

/* Whether these are four hexadecimal digits, and not 0000. */
static bool are_unicode_digits(const char *digits)
{
    return strspn(digits, "0123456789abcdefABCDEF") >= 4 && strncmp(digits, "0000", 4) != 0;
}

static bool skip_string(const char **at)
{
    while (*++*at != '"') {
        const bool is_unicode = strncmp(*at, "\\u", 2) == 0;
        if ((unsigned char) **at < ' ' || (is_unicode && !are_unicode_digits(*at + 2)))
            return false;
        *at += **at == '\\';
    }
    ++*at;
    return true;
}

/* Returns the first byte at which a string, a number or white space is invalid; `end` if none is.
 */
static const char *tokens_end(const char *at, const char *end)
{
    bool good = true;
    while (good && at < end) {
        if (*at == '"')
            good = skip_string(&at);
        else if (*at == '-' || (*at >= '0' && *at <= '9'))
            good = skip_number(&at);
        else if ((unsigned char) *at >= ' ' || (*at && strchr("\t\n\r", *at)))
            at++;
        else
            break;
    }
    return at;
}

/* ---- Objects of the input ---- */

static enum json_outcome read_object_text(struct json_reader *reader, const char *object,
                                          size_t length, struct owned_scene *out)
{
    reader->scene = out;
    const char *end = object, *bad = tokens_end(object, object + length);
    cJSON *root = cJSON_ParseWithLengthOpts(object, length, &end, false);
    const bool parsed = root && end == object + length && bad == end;
    const bool good = parsed && read_scene(reader, root);
    cJSON_Delete(root);
    HASH_CLEAR(hh, reader->ids);
    HASH_CLEAR(by_name, reader->names);
    free(reader->entry);
    reader->entry = NULL;
    if (good) {
        reader->scene_number++;
        return JSON_SCENE;
    }
    scene_clear(out);
    if (parsed)
        return JSON_BAD;
    bad = bad < end ? bad : end;
    const char *word = bad + (*bad == '-');
    const bool not_finite = strncmp(word, "NaN", 3) == 0 || strncmp(word, "Infinity", 8) == 0;
    text_refuse(&reader->text, (size_t) (bad - object), "%s",
                strncmp(bad, "\\u0000", 6) == 0 ? "a string contains \\u0000"
                : not_finite
                    ? "NaN and Infinity are not JSON, though json.dumps of Python writes them"
                    : "invalid JSON");
    return fail(reader, JSON_BAD, reader->text.error);
}

enum json_outcome json_next(struct json_reader *reader, struct owned_scene *out)
{
    const char *object = NULL;
    size_t length = 0;
    memset(out, 0, sizeof *out);
    switch (text_next(&reader->text, &object, &length)) {
    case TEXT_OBJECT: return read_object_text(reader, object, length, out);
    case TEXT_FAILED: return fail(reader, JSON_FAILED, reader->text.error);
    case TEXT_BAD: return fail(reader, JSON_BAD, reader->text.error);
    case TEXT_END: break;
    }
    if (reader->scene_number > 1)
        return JSON_END;
    return fail(reader, JSON_BAD, "the input is empty: expected a scene");
}
