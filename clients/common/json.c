/* text.c splits the input into objects. cJSON parses each into a tree; what it accepts beyond JSON
 * is refused here (tokens_end()). The tree is checked, copied into a scene, and freed.
 *
 * Properties of cJSON 1.7 that matter here: access to an array by index traverses its list, so each
 * list is traversed once. The look-up of a key takes the first match and ignores case, so keys are
 * compared here. 1e999 reads as infinite, so every number is checked. Numbers are read by strtod(),
 * rounded correctly, in the C locale. */
#include "json.h"

#include "allocate.h"
#include "fmb_client.h"
#include "keyed_hash.h"
#include "number.h"
#include "text.h"
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
#define EXPECTED_ID "an integer from 1 to 9007199254740991"
#define EXPECTED_GROUP "an integer other than 0, of magnitude up to 9007199254740991"

struct json_reader {
    struct text text;
    size_t scene_number; /* of the object that is being read, from 1 */
    int dim;             /* of its scene, once that is known */
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

struct key {
    const char *name;
    bool optional;
};

static bool check_present(const struct place *member)
{
    return member->item || refuse(member->parent, "missing key \"%s\"", member->key);
}

/* On output: member[i] is the value of keys[i]; its item is NULL if an optional one is missing. */
static bool read_object(const struct place *at, const struct key *keys, int count,
                        struct place *member)
{
    char text[QUOTED_MAX + 4];
    if (!cJSON_IsObject(at->item))
        return refuse_kind(at, "an object");
    for (int i = 0; i < count; i++)
        member[i] = (struct place){at->reader, at, NULL, keys[i].name, 0};
    for (const cJSON *child = at->item->child; child; child = child->next) {
        int i = 0;
        while (i < count && strcmp(keys[i].name, child->string) != 0)
            i++;
        if (i == count)
            return refuse(at, "unknown key \"%s\"", quoted(child->string, text));
        if (member[i].item)
            return refuse(at, "repeated key \"%s\"", keys[i].name);
        member[i].item = child;
    }
    for (int i = 0; i < count; i++)
        if (!keys[i].optional && !check_present(&member[i]))
            return false;
    return true;
}

/* ---- Arrays and numbers ---------------------------------------------------------------------- */

static bool check_array(const struct place *at, size_t count, const char *what)
{
    if (!cJSON_IsArray(at->item))
        return refuse(at, "expected %zu %s, found %s", count, what, kind_name(at->item));
    size_t found = (size_t) cJSON_GetArraySize(at->item);
    return found == count || refuse(at, "expected %zu %s, found %zu", count, what, found);
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

static bool read_number(const struct place *at, double *out)
{
    if (!cJSON_IsNumber(at->item))
        return refuse_kind(at, "a number");
    *out = at->item->valuedouble;
    return isfinite(*out) || refuse_value(at, *out, "a finite number");
}

static bool read_numbers(const struct place *array, int count, double *out)
{
    if (!check_array(array, (size_t) count, "numbers"))
        return false;
    for (struct place at = first_element(array); at.item; next_element(&at))
        if (!read_number(&at, &out[at.index]))
            return false;
    return true;
}

static bool read_vector(const struct place *at, double *out)
{
    return read_numbers(at, at->reader->dim, out);
}

/* An optional vector: if it is missing, *out is unchanged. */
static bool maybe_vector(const struct place *at, double *out)
{
    return !at->item || read_vector(at, out);
}

static bool read_id(const struct place *at, int64_t *out)
{
    if (!cJSON_IsNumber(at->item))
        return refuse_kind(at, EXPECTED_ID);
    double id = at->item->valuedouble;
    if (id > id_max) /* its digits are lost */
        return refuse(at, "expected " EXPECTED_ID ", found a larger number");
    if (!(id >= 1 && id <= id_max && id == floor(id)))
        return refuse_value(at, id, EXPECTED_ID);
    *out = (int64_t) id;
    return true;
}

/* ---- Frames ---------------------------------------------------------------------------------- */

static bool read_shape(const struct place *at, int *out)
{
    const int dim = at->reader->dim;
    char text[QUOTED_MAX + 4];
    if (!cJSON_IsString(at->item))
        return refuse_kind(at, "a string");
    for (int shape = FMB_CUBOID; fmb_shape_name(shape); shape++) {
        if (strcmp(at->item->valuestring, fmb_shape_name(shape)) != 0)
            continue;
        *out = shape;
        if (shape == FMB_HULL)
            return refuse(at, "hulls are not supported by this version");
        return fmb_component_count(dim, shape) > 0 ||
               refuse(at, "there is no %s in %dD", fmb_shape_name(shape), dim);
    }
    return refuse(at, "unknown shape \"%s\" (there are cuboid, tetrahedron, face, box)",
                  quoted(at->item->valuestring, text));
}

static bool read_components(const struct place *array, struct geometry_frame *out)
{
    const int dim = array->reader->dim;
    if (!check_array(array, (size_t) fmb_component_count(dim, out->shape), "vectors"))
        return false;
    for (struct place at = first_element(array); at.item; next_element(&at))
        if (!read_vector(&at, out->components + at.index * (size_t) dim))
            return false;
    return true;
}

static bool read_vertices(const struct place *array, struct geometry_frame *out)
{
    const int dim = array->reader->dim;
    out->by_vertices = true;
    if (!check_array(array, (size_t) fmb_component_count(dim, out->shape) + 1, "vertices"))
        return false;
    for (struct place at = first_element(array); at.item; next_element(&at))
        if (!read_vector(
                &at, at.index == 0 ? out->origin : out->components + (at.index - 1) * (size_t) dim))
            return false;
    return true;
}

static bool read_size(const struct place *array, double *out)
{
    if (!read_vector(array, out))
        return false;
    for (struct place at = first_element(array); at.item; next_element(&at))
        if (out[at.index] < 0)
            return refuse_value(&at, out[at.index], "a number of at least 0");
    return true;
}

/* Reads an optional quaternion that the engine accepts. */
static bool read_orientation(const struct place *at, double out[4], int *count)
{
    static const double size[FMB_DIM_MAX] = {1, 1, 1};
    const int dim = at->reader->dim;
    struct fmb_body body;
    *count = at->item ? (dim == 2 ? 2 : 4) : 0;
    if (!at->item)
        return true;
    if (!read_numbers(at, *count, out))
        return false;
    if (out[0] == 0 && out[1] == 0 && (dim == 2 || (out[2] == 0 && out[3] == 0)))
        return refuse(at, "a quaternion of zeros is no rotation");
    fmb_body_make(dim, FMB_BOX, size, (size_t) dim, &body);
    struct fmb_placement placement = {.body = &body, .orientation_count = *count};
    memcpy(placement.orientation, out, (size_t) *count * sizeof *out);
    return fmb_placement_check(&placement) == FMB_OK ||
           refuse(at, "the numbers differ in size by more than 2^200");
}

/* The keys of a frame come first: a body may be one. */
enum { SHAPE, ORIGIN, COMPONENTS, VERTICES, SIZE, POSITION, ORIENTATION, FRAME_KEYS };
enum { ID = FRAME_KEYS, NAME, GROUP, VELOCITY, FRAMES, BODY_KEYS };

static const struct key body_keys[BODY_KEYS] = {
    [SHAPE] = {"shape", true},
    [ORIGIN] = {"origin", true},
    [COMPONENTS] = {"components", true},
    [VERTICES] = {"vertices", true},
    [SIZE] = {"size", true},
    [POSITION] = {"position", true},
    [ORIENTATION] = {"orientation", true},
    [ID] = {"id", false},
    [NAME] = {"name", true},
    [GROUP] = {"group", true},
    [VELOCITY] = {"velocity", true},
    [FRAMES] = {"frames", true},
};

/* Refuses the first of these keys that is present. what: the kind of object, which has none. */
static bool check_absent(const struct place *member, const int *keys, int count, const char *what)
{
    for (int i = 0; i < count; i++)
        if (member[keys[i]].item)
            return refuse(member->parent, "%s has no \"%s\"", what, member[keys[i]].key);
    return true;
}

static bool read_box(const struct place *member, struct geometry_frame *out)
{
    static const int others[] = {ORIGIN, COMPONENTS, VERTICES};
    return check_absent(member, others, 3, "a box") && check_present(&member[SIZE]) &&
           read_size(&member[SIZE], out->components);
}

static bool read_parts(const struct place *member, struct geometry_frame *out)
{
    static const int others[] = {SIZE};
    return check_absent(member, others, 1, "a frame of components") &&
           check_present(&member[COMPONENTS]) && maybe_vector(&member[ORIGIN], out->origin) &&
           read_components(&member[COMPONENTS], out);
}

static bool read_by_vertices(const struct place *member, struct geometry_frame *out)
{
    static const int others[] = {ORIGIN, COMPONENTS, SIZE};
    if (out->shape == FMB_CUBOID)
        return refuse(member->parent, "a cuboid has no \"vertices\"");
    return check_absent(member, others, 3, "a frame of vertices") &&
           read_vertices(&member[VERTICES], out);
}

static bool read_shape_and_numbers(const struct place *member, struct geometry_frame *out)
{
    *out = (struct geometry_frame){.shape = 0};
    if (!check_present(&member[SHAPE]) || !read_shape(&member[SHAPE], &out->shape))
        return false;
    if (out->shape == FMB_BOX)
        return read_box(member, out);
    return (member[VERTICES].item ? read_by_vertices : read_parts)(member, out);
}

/* Whether a quaternion turns: any number beyond the first is not 0. */
static bool turns(const double *orientation, int count)
{
    for (int i = 1; i < count; i++)
        if (orientation[i] != 0)
            return true;
    return false;
}

/* Reads the pose of a box in its body. A box that is turned there becomes a cuboid. */
static bool read_box_pose(const struct place *member, struct geometry_frame *box)
{
    const int dim = member->reader->dim;
    double orientation[4] = {0}, cuboid[GEOMETRY_FRAME_NUMBERS_MAX];
    int count;
    if (!maybe_vector(&member[POSITION], box->origin) ||
        !read_orientation(&member[ORIENTATION], orientation, &count))
        return false;
    if (!turns(orientation, count))
        return true;
    turned_box(dim, box->origin, box->components, orientation, cuboid);
    box->shape = FMB_CUBOID;
    memcpy(box->origin, cuboid, (size_t) dim * sizeof *cuboid);
    memcpy(box->components, cuboid + dim, (size_t) (dim * dim) * sizeof *cuboid);
    return true;
}

/* Returns true if the engine accepted what was read at this place. */
static bool accept(const struct place *at, enum fmb_status status)
{
    return status == FMB_OK || refuse(at, "%s", fmb_status_text(status));
}

/* Reads an element of "frames". */
static bool read_frame(const struct place *at, struct geometry_frame *out)
{
    static const int others[] = {POSITION, ORIENTATION};
    struct place member[FRAME_KEYS];
    if (!read_object(at, body_keys, FRAME_KEYS, member) || !read_shape_and_numbers(member, out))
        return false;
    return out->shape == FMB_BOX
               ? read_box_pose(member, out)
               : check_absent(member, others, 2,
                              out->by_vertices ? "a frame of vertices" : "a frame of components");
}

/* ---- Bodies ---------------------------------------------------------------------------------- */

/* Returns bytes in a message: 1 for each shape, 4 for each count, and 8 for each number. */
static size_t frames_bytes(int dim, const struct geometry_frame *frames, size_t count)
{
    size_t bytes = 0;
    for (size_t i = 0; i < count; i++)
        bytes += 1 + (frames[i].by_vertices ? 4 : 0) +
                 8 * (size_t) geometry_number_count(dim, frames[i].shape, 0);
    return bytes;
}

static bool read_frames(const struct place *array, struct scene_body *out)
{
    if (!cJSON_IsArray(array->item))
        return refuse_kind(array, "an array");
    const size_t count = (size_t) cJSON_GetArraySize(array->item);
    const int dim = array->reader->dim;
    size_t bad;
    out->given = allocate(count, sizeof *out->given);
    for (struct place at = first_element(array); at.item; next_element(&at))
        if (!read_frame(&at, &out->given[at.index]))
            return false;
    const size_t bytes = frames_bytes(dim, out->given, count);
    if (bytes > FMB_CLIENT_BODY_BYTES_MAX)
        return refuse(array, "%s: %zu bytes in a message, which has space for %d",
                      fmb_status_text(FMB_OVER_LIMIT), bytes, (int) FMB_CLIENT_BODY_BYTES_MAX);
    const enum fmb_status status = scene_body_make(dim, count, out, &bad);
    const struct place frame = {array->reader, array, NULL, NULL, bad};
    return accept(bad < count ? &frame : array, status);
}

/* Reads a body that is one frame. Its "origin", if it has neither "position" nor "orientation", is
 * its position. */
static bool read_only_frame(const struct place *member, struct scene_body *out)
{
    const int dim = member->reader->dim;
    size_t bad;
    out->given = allocate(1, sizeof *out->given);
    struct geometry_frame *frame = out->given;
    if (!read_shape_and_numbers(member, frame))
        return false;
    if (frame->shape != FMB_BOX && !frame->by_vertices && !member[POSITION].item &&
        !member[ORIENTATION].item) {
        if (!check_present(&member[ORIGIN]))
            return false;
        memcpy(out->position, frame->origin, sizeof out->position);
        memset(frame->origin, 0, sizeof frame->origin);
    }
    return accept(member->parent, scene_body_make(dim, 1, out, &bad));
}

static bool read_name(const struct place *at, char out[SCENE_NAME_MAX + 1])
{
    if (!at->item)
        return true;
    if (!cJSON_IsString(at->item))
        return refuse_kind(at, "a string");
    const char *name = at->item->valuestring;
    if (strlen(name) > SCENE_NAME_MAX)
        return refuse(at, "expected at most %d bytes, found %zu", (int) SCENE_NAME_MAX,
                      strlen(name));
    if (!utf8_is_text(name))
        return refuse(at, "expected UTF-8 without control characters");
    strcpy(out, name);
    return true;
}

/* Reads an optional group. */
static bool read_group(const struct place *at, int64_t *out)
{
    if (!at->item)
        return true;
    if (!cJSON_IsNumber(at->item))
        return refuse_kind(at, EXPECTED_GROUP);
    const double group = at->item->valuedouble;
    if (group == 0 || group != floor(group) || fabs(group) > id_max)
        return refuse(at, "expected " EXPECTED_GROUP);
    *out = (int64_t) group;
    return true;
}

static bool read_body(const struct place *at, struct scene_body *out)
{
    static const int of_frames[] = {SHAPE, ORIGIN, COMPONENTS, VERTICES, SIZE};
    struct place member[BODY_KEYS];
    if (!read_object(at, body_keys, BODY_KEYS, member) || !read_id(&member[ID], &out->id) ||
        !read_name(&member[NAME], out->name) || !read_group(&member[GROUP], &out->group))
        return false;
    const bool good = member[FRAMES].item
                          ? check_absent(member, of_frames, 5, "a body of \"frames\"") &&
                                read_frames(&member[FRAMES], out)
                          : read_only_frame(member, out);
    return good && maybe_vector(&member[POSITION], out->position) &&
           read_orientation(&member[ORIENTATION], out->orientation, &out->orientation_count) &&
           maybe_vector(&member[VELOCITY], out->velocity);
}

static bool read_bodies(const struct place *array, struct scene *out)
{
    if (!cJSON_IsArray(array->item))
        return refuse_kind(array, "an array");
    out->body = allocate((size_t) cJSON_GetArraySize(array->item), sizeof *out->body);
    for (struct place at = first_element(array); at.item; next_element(&at)) {
        out->body_count++;
        if (!read_body(&at, &out->body[at.index]))
            return false;
    }
    return true;
}

/* ---- Pairs ----------------------------------------------------------------------------------- */

/* A table of the bodies by id. */
struct body_id {
    UT_hash_handle hh;
    int64_t id;
    size_t index;
};

static const struct body_id *find_id(const struct body_id *ids, int64_t id)
{
    const struct body_id *found;
    HASH_FIND(hh, ids, &id, sizeof id, found);
    return found;
}

/* Fills the table with entries, which has as many as there are bodies. Refuses a repeated id. */
static bool add_ids(const struct place *bodies, const struct scene *scene, struct body_id *entry,
                    struct body_id **ids)
{
    for (size_t i = 0; i < scene->body_count; i++) {
        const struct body_id *first = find_id(*ids, scene->body[i].id);
        if (first) {
            const struct place body = {bodies->reader, bodies, NULL, NULL, i};
            const struct place id = {bodies->reader, &body, NULL, "id", 0};
            return refuse(&id, "%lld is the id of bodies[%zu] already", (long long) first->id,
                          first->index);
        }
        entry[i].id = scene->body[i].id;
        entry[i].index = i;
        HASH_ADD(hh, *ids, id, sizeof entry[i].id, &entry[i]);
    }
    return true;
}

static bool read_pair(const struct place *array, const struct body_id *ids, struct scene_pair *out)
{
    if (!check_array(array, 2, "ids"))
        return false;
    size_t index[2];
    int64_t id = 0;
    for (struct place at = first_element(array); at.item; next_element(&at)) {
        if (!read_id(&at, &id))
            return false;
        const struct body_id *body = find_id(ids, id);
        if (!body)
            return refuse(&at, "no body has the id %lld", (long long) id);
        index[at.index] = body->index;
    }
    *out = (struct scene_pair){index[0], index[1]};
    return out->a != out->b ||
           refuse(array, "a body is no pair with itself (%lld)", (long long) id);
}

/* Reads an optional list. */
static bool read_list(const struct place *array, const struct body_id *ids,
                      struct scene_pair **list, size_t *count)
{
    if (!array->item)
        return true;
    if (!cJSON_IsArray(array->item))
        return refuse_kind(array, "an array");
    *list = allocate((size_t) cJSON_GetArraySize(array->item), sizeof **list);
    for (struct place at = first_element(array); at.item; next_element(&at), ++*count)
        if (!read_pair(&at, ids, &(*list)[at.index]))
            return false;
    return true;
}

static bool read_pairs(const struct place *pairs, const struct place *ignore,
                       const struct body_id *ids, struct scene *out)
{
    out->all_pairs = !pairs->item;
    if (!read_list(pairs, ids, &out->pair, &out->pair_count) ||
        !read_list(ignore, ids, &out->ignored, &out->ignored_count))
        return false;
    scene_sort_ignored(out);
    for (size_t i = 0; i < out->pair_count; i++) {
        const struct place at = {pairs->reader, pairs, NULL, NULL, i};
        if (scene_is_within_group(out, out->pair[i]))
            return refuse(&at, "both bodies are of group %lld",
                          (long long) out->body[out->pair[i].a].group);
        if (scene_ignores(out, out->pair[i]))
            return refuse(&at, "\"ignore\" has this pair too");
    }
    out->ignored_count = out->all_pairs ? out->ignored_count : 0;
    return true;
}

/* ---- The scene ------------------------------------------------------------------------------- */

static bool read_dim(const struct place *at, int *out)
{
    if (!cJSON_IsNumber(at->item))
        return refuse_kind(at, "2 or 3");
    if (at->item->valuedouble != 2 && at->item->valuedouble != 3)
        return refuse_value(at, at->item->valuedouble, "2 or 3");
    *out = (int) at->item->valuedouble;
    return true;
}

/* Reads an optional number of at least 0: if it is missing, *out is unchanged. */
static bool read_from_0(const struct place *at, double *out)
{
    if (!at->item)
        return true;
    return read_number(at, out) && (*out >= 0 || refuse_value(at, *out, "a number of at least 0"));
}

enum { LABEL, DIM, DURATION, MARGIN, BODIES, PAIRS, IGNORE, SCENE_KEYS };

static const struct key scene_keys[SCENE_KEYS] = {
    [LABEL] = {"label", true},   [DIM] = {"dim", false},       [DURATION] = {"duration", true},
    [MARGIN] = {"margin", true}, [BODIES] = {"bodies", false}, [PAIRS] = {"pairs", true},
    [IGNORE] = {"ignore", true},
};

static bool read_scene(struct json_reader *reader, const cJSON *item, struct scene *out)
{
    const struct place root = {.reader = reader, .item = item};
    struct place member[SCENE_KEYS];
    out->duration = 1;
    if (!read_object(&root, scene_keys, SCENE_KEYS, member) ||
        !read_name(&member[LABEL], out->label) || !read_dim(&member[DIM], &reader->dim) ||
        !read_from_0(&member[DURATION], &out->duration) ||
        !read_from_0(&member[MARGIN], &out->margin))
        return false;
    out->dim = reader->dim;
    if (!read_bodies(&member[BODIES], out))
        return false;
    struct body_id *ids = NULL, *entry = allocate(out->body_count, sizeof *entry);
    const bool good = add_ids(&member[BODIES], out, entry, &ids) &&
                      read_pairs(&member[PAIRS], &member[IGNORE], ids, out);
    HASH_CLEAR(hh, ids);
    free(entry);
    return good;
}

/* ---- The input ------------------------------------------------------------------------------- */

/* Exits if memory is exhausted; the parser would report invalid JSON. */
static void *allocate_bytes(size_t size)
{
    return allocate(size, 1);
}

struct json_reader *json_open(int fd)
{
    cJSON_InitHooks(&(cJSON_Hooks){allocate_bytes, free});
    struct json_reader *reader = allocate(1, sizeof *reader);
    text_open(fd, &reader->text);
    reader->scene_number = 1;
    return reader;
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

static bool is_unicode_escape(const char *at)
{
    return strspn(at + 2, "0123456789abcdefABCDEF") >= 4 && strncmp(at + 2, "0000", 4) != 0;
}

static bool skip_string(const char **at)
{
    while (*++*at != '"') {
        if ((unsigned char) **at < ' ' ||
            ((*at)[0] == '\\' && (*at)[1] == 'u' && !is_unicode_escape(*at)))
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
                                          size_t length, struct scene *out)
{
    const char *end = object, *bad = tokens_end(object, object + length);
    cJSON *root = cJSON_ParseWithLengthOpts(object, length, &end, false);
    const bool parsed = root && end == object + length && bad == end;
    const bool good = parsed && read_scene(reader, root, out);
    cJSON_Delete(root);
    if (good) {
        reader->scene_number++;
        return JSON_SCENE;
    }
    scene_clear(out);
    if (parsed)
        return JSON_BAD;
    bad = bad < end ? bad : end;
    text_refuse(&reader->text, (size_t) (bad - object), "%s",
                strncmp(bad, "\\u0000", 6) == 0 ? "a string contains \\u0000" : "invalid JSON");
    return fail(reader, JSON_BAD, reader->text.error);
}

enum json_outcome json_next(struct json_reader *reader, struct scene *out)
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
