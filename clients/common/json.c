/* text.c splits the input into objects; cJSON parses each into a tree, and decides what is JSON;
 * the tree is checked and copied into a scene, and freed.
 *
 * Properties of cJSON 1.7 that matter here: access to an array by index walks its list, so lists
 * are walked once; the look-up of a key takes the first match and ignores case, so keys are
 * compared here; 1e999 reads as infinite, so every number is checked. Numbers are read by strtod(),
 * rounded correctly, in the C locale. */
#include "json.h"

#include "allocate.h"
#include "escape.h"
#include "fmb_client.h"
#include "number.h"
#include "text.h"
#include "turned_box.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ERROR_MAX = 320, QUOTED_MAX = 32 };

static const double id_max = 9007199254740991.0; /* 2^53 - 1 */
#define EXPECTED_ID "an integer from 1 to 9007199254740991"

struct json_reader {
    struct text text;
    size_t scene_number; /* of the object that is being read, from 1 */
    char error[ERROR_MAX];
};

/* ---- Where in the tree: printed only if something is wrong there ----------------------------- */

/* A value's path in the one that holds it: a key, or an index where key is NULL. */
struct json_path {
    const struct json_path *parent; /* NULL: the scene itself */
    const char *key;
    size_t index;
};

static void write_path(FILE *out, const struct json_path *path)
{
    if (path->parent)
        write_path(out, path->parent);
    if (!path->key)
        fprintf(out, "[%zu]", path->index);
    else
        fprintf(out, "%s%s", path->parent ? "." : "", path->key);
}

static bool refuse(struct json_reader *reader, const struct json_path *path, const char *format,
                   ...) __attribute__((format(printf, 3, 4)));

/* Always false. path: NULL for the scene itself. */
static bool refuse(struct json_reader *reader, const struct json_path *path, const char *format,
                   ...)
{
    memset(reader->error, 0, sizeof reader->error);
    FILE *out = fmemopen(reader->error, sizeof reader->error - 1, "w");
    if (!out)
        allocate_failed();
    if (reader->scene_number > 1)
        fprintf(out, "scene %zu: ", reader->scene_number);
    if (path) {
        write_path(out, path);
        fputs(": ", out);
    }
    va_list list;
    va_start(list, format);
    vfprintf(out, format, list);
    va_end(list);
    fclose(out);
    return false;
}

/* Text of the input, fit for a line on any terminal: cut, and in printable ASCII. */
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

static bool refuse_kind(struct json_reader *reader, const struct json_path *path, const cJSON *item,
                        const char *expected)
{
    return refuse(reader, path, "expected %s, found %s", expected, kind_name(item));
}

/* ---- Objects --------------------------------------------------------------------------------- */

struct key {
    const char *name;
    bool optional;
};

static int key_index(const struct key *keys, int count, const char *name)
{
    for (int i = 0; i < count; i++)
        if (strcmp(keys[i].name, name) == 0)
            return i;
    return -1;
}

/* On output: found[i] is the value of keys[i], NULL where an optional one is missing. */
static bool read_object(struct json_reader *reader, const struct json_path *path, const cJSON *item,
                        const struct key *keys, int count, const cJSON **found)
{
    char text[QUOTED_MAX + 4];
    if (!cJSON_IsObject(item))
        return refuse_kind(reader, path, item, "an object");
    for (int i = 0; i < count; i++)
        found[i] = NULL;
    for (const cJSON *child = item->child; child; child = child->next) {
        int i = key_index(keys, count, child->string);
        if (i < 0)
            return refuse(reader, path, "unknown key \"%s\"", quoted(child->string, text));
        if (found[i])
            return refuse(reader, path, "repeated key \"%s\"", keys[i].name);
        found[i] = child;
    }
    for (int i = 0; i < count; i++)
        if (!found[i] && !keys[i].optional)
            return refuse(reader, path, "missing key \"%s\"", keys[i].name);
    return true;
}

/* ---- Arrays and numbers ---------------------------------------------------------------------- */

static bool check_array(struct json_reader *reader, const struct json_path *path, const cJSON *item,
                        size_t count, const char *what)
{
    if (!cJSON_IsArray(item))
        return refuse(reader, path, "expected %zu %s, found %s", count, what, kind_name(item));
    size_t found = (size_t) cJSON_GetArraySize(item);
    return found == count || refuse(reader, path, "expected %zu %s, found %zu", count, what, found);
}

/* Always false. */
static bool refuse_value(struct json_reader *reader, const struct json_path *path, double value,
                         const char *expected)
{
    char text[NUMBER_TEXT_MAX];
    if (isfinite(value))
        return refuse(reader, path, "expected %s, found %s", expected, number_exact(value, text));
    return refuse(reader, path, "expected %s, found %sinfinity (doubles end at 1.8e308)", expected,
                  value < 0 ? "-" : "");
}

static bool read_number(struct json_reader *reader, const struct json_path *path, const cJSON *item,
                        double *out)
{
    if (!cJSON_IsNumber(item))
        return refuse_kind(reader, path, item, "a number");
    *out = item->valuedouble;
    return isfinite(*out) || refuse_value(reader, path, *out, "a finite number");
}

static bool read_vector(struct json_reader *reader, const struct json_path *path, const cJSON *item,
                        int dim, double *out)
{
    if (!check_array(reader, path, item, (size_t) dim, "numbers"))
        return false;
    struct json_path at = {path, NULL, 0};
    for (const cJSON *child = item->child; child; child = child->next, at.index++)
        if (!read_number(reader, &at, child, &out[at.index]))
            return false;
    return true;
}

static bool read_id(struct json_reader *reader, const struct json_path *path, const cJSON *item,
                    int64_t *out)
{
    if (!cJSON_IsNumber(item))
        return refuse_kind(reader, path, item, EXPECTED_ID);
    double id = item->valuedouble;
    if (id > id_max) /* its digits are lost */
        return refuse(reader, path, "expected " EXPECTED_ID ", found a larger number");
    if (!(id >= 1 && id <= id_max && id == floor(id)))
        return refuse_value(reader, path, id, EXPECTED_ID);
    *out = (int64_t) id;
    return true;
}

/* ---- Frames ---------------------------------------------------------------------------------- */

static bool read_shape(struct json_reader *reader, const struct json_path *path, const cJSON *item,
                       int dim, int *out)
{
    char text[QUOTED_MAX + 4];
    if (!cJSON_IsString(item))
        return refuse_kind(reader, path, item, "a string");
    for (int shape = FMB_CUBOID; fmb_shape_name(shape); shape++) {
        if (strcmp(item->valuestring, fmb_shape_name(shape)) != 0)
            continue;
        *out = shape;
        return fmb_component_count(dim, shape) > 0 ||
               refuse(reader, path, "there is no %s in %dD", fmb_shape_name(shape), dim);
    }
    return refuse(reader, path, "unknown shape \"%s\" (there are cuboid, tetrahedron, face, box)",
                  quoted(item->valuestring, text));
}

static bool read_components(struct json_reader *reader, const struct json_path *path,
                            const cJSON *item, int dim, int shape, double *out)
{
    size_t count = (size_t) fmb_component_count(dim, shape);
    if (!check_array(reader, path, item, count, "vectors"))
        return false;
    struct json_path at = {path, NULL, 0};
    for (const cJSON *child = item->child; child; child = child->next, at.index++)
        if (!read_vector(reader, &at, child, dim, out + at.index * (size_t) dim))
            return false;
    return true;
}

static bool read_size(struct json_reader *reader, const struct json_path *path, const cJSON *item,
                      int dim, double *out)
{
    if (!read_vector(reader, path, item, dim, out))
        return false;
    for (int axis = 0; axis < dim; axis++) {
        struct json_path at = {path, NULL, (size_t) axis};
        if (out[axis] < 0)
            return refuse_value(reader, &at, out[axis], "a number of at least 0");
    }
    return true;
}

/* Whether the engine takes it. item: NULL for none. */
static bool read_orientation(struct json_reader *reader, const struct json_path *path,
                             const cJSON *item, int dim, double out[4], int *count)
{
    static const double size[FMB_DIM_MAX] = {1, 1, 1};
    struct fmb_body body;
    *count = item ? (dim == 2 ? 2 : 4) : 0;
    if (item && !read_vector(reader, path, item, *count, out))
        return false;
    if (item && out[0] == 0 && out[1] == 0 && (dim == 2 || (out[2] == 0 && out[3] == 0)))
        return refuse(reader, path, "a quaternion of zeros is no rotation");
    fmb_body_make(dim, FMB_BOX, size, (size_t) dim, &body);
    struct fmb_placement placement = {.body = &body, .orientation_count = *count};
    memcpy(placement.orientation, out, (size_t) *count * sizeof *out);
    return fmb_placement_check(&placement) == FMB_OK ||
           refuse(reader, path, "the numbers differ in size by more than 2^200");
}

/* The keys of a frame come first: a body may be one. */
enum { SHAPE, ORIGIN, COMPONENTS, SIZE, POSITION, ORIENTATION, FRAME_KEYS };
enum { ID = FRAME_KEYS, NAME, VELOCITY, FRAMES, BODY_KEYS };

static const struct key body_keys[BODY_KEYS] = {
    [SHAPE] = {"shape", true},
    [ORIGIN] = {"origin", true},
    [COMPONENTS] = {"components", true},
    [SIZE] = {"size", true},
    [POSITION] = {"position", true},
    [ORIENTATION] = {"orientation", true},
    [ID] = {"id", false},
    [NAME] = {"name", true},
    [VELOCITY] = {"velocity", true},
    [FRAMES] = {"frames", true},
};

/* An object, its values by key, and their places. */
struct members {
    struct json_path path[BODY_KEYS];
    const cJSON *value[BODY_KEYS];
};

static bool read_members(struct json_reader *reader, const struct json_path *path,
                         const cJSON *item, int keys, struct members *out)
{
    for (int i = 0; i < keys; i++)
        out->path[i] = (struct json_path){path, body_keys[i].name, 0};
    return read_object(reader, path, item, body_keys, keys, out->value);
}

/* Refuses the first of the keys that is there: of things that have no such member. */
static bool check_absent(struct json_reader *reader, const struct json_path *path,
                         const struct members *of, const int *keys, int count, const char *what)
{
    for (int i = 0; i < count; i++)
        if (of->value[keys[i]])
            return refuse(reader, path, "%s has no \"%s\"", what, body_keys[keys[i]].name);
    return true;
}

static bool check_present(struct json_reader *reader, const struct json_path *path,
                          const struct members *of, int key)
{
    return of->value[key] || refuse(reader, path, "missing key \"%s\"", body_keys[key].name);
}

/* A frame being read: its shape, and its numbers as fmb_frame_make() takes them. */
struct frame_numbers {
    int shape;
    double number[FMB_DIM_MAX + FMB_COMPONENTS_MAX]; /* origin, components | centre, size */
    size_t count;
};

static bool read_box(struct json_reader *reader, const struct json_path *path,
                     const struct members *of, int dim, struct frame_numbers *out)
{
    static const int others[] = {ORIGIN, COMPONENTS};
    out->count = 2 * (size_t) dim;
    return check_absent(reader, path, of, others, 2, "a box") &&
           check_present(reader, path, of, SIZE) &&
           read_size(reader, &of->path[SIZE], of->value[SIZE], dim, out->number + dim);
}

/* Of a frame of components. Without "origin" it is 0. */
static bool read_parts(struct json_reader *reader, const struct json_path *path,
                       const struct members *of, int dim, struct frame_numbers *out)
{
    static const int others[] = {SIZE};
    out->count = (size_t) (dim + dim * fmb_component_count(dim, out->shape));
    if (!check_absent(reader, path, of, others, 1, "a frame of components") ||
        !check_present(reader, path, of, COMPONENTS))
        return false;
    return (!of->value[ORIGIN] ||
            read_vector(reader, &of->path[ORIGIN], of->value[ORIGIN], dim, out->number)) &&
           read_components(reader, &of->path[COMPONENTS], of->value[COMPONENTS], dim, out->shape,
                           out->number + dim);
}

static bool read_numbers(struct json_reader *reader, const struct json_path *path,
                         const struct members *of, int dim, struct frame_numbers *out)
{
    *out = (struct frame_numbers){.shape = 0};
    if (!check_present(reader, path, of, SHAPE) ||
        !read_shape(reader, &of->path[SHAPE], of->value[SHAPE], dim, &out->shape))
        return false;
    return (out->shape == FMB_BOX ? read_box : read_parts)(reader, path, of, dim, out);
}

/* Whether any number beyond the first is not 0. */
static bool turns(const double *orientation, int count)
{
    for (int i = 1; i < count; i++)
        if (orientation[i] != 0)
            return true;
    return false;
}

/* Where a box lies in its body. One that is turned there becomes a cuboid. */
static bool read_box_place(struct json_reader *reader, const struct members *of, int dim,
                           struct frame_numbers *box)
{
    double orientation[4] = {0}, centre_size[2 * FMB_DIM_MAX];
    int count;
    if (of->value[POSITION] &&
        !read_vector(reader, &of->path[POSITION], of->value[POSITION], dim, box->number))
        return false;
    if (!read_orientation(reader, &of->path[ORIENTATION], of->value[ORIENTATION], dim, orientation,
                          &count))
        return false;
    if (!turns(orientation, count))
        return true;
    memcpy(centre_size, box->number, sizeof centre_size);
    turned_box(dim, centre_size, centre_size + dim, orientation, box->number);
    box->shape = FMB_CUBOID;
    box->count = (size_t) (dim + dim * dim);
    return true;
}

/* An element of "frames". */
static bool read_frame(struct json_reader *reader, const struct json_path *path, const cJSON *item,
                       int dim, struct fmb_frame *out)
{
    static const int others[] = {POSITION, ORIENTATION};
    struct members members;
    struct frame_numbers frame;
    if (!read_members(reader, path, item, FRAME_KEYS, &members) ||
        !read_numbers(reader, path, &members, dim, &frame))
        return false;
    if (frame.shape == FMB_BOX
            ? !read_box_place(reader, &members, dim, &frame)
            : !check_absent(reader, path, &members, others, 2, "a frame of components"))
        return false;
    const enum fmb_status status = fmb_frame_make(dim, frame.shape, frame.number, frame.count, out);
    return status == FMB_OK || refuse(reader, path, "%s", fmb_status_text(status));
}

/* ---- Bodies ---------------------------------------------------------------------------------- */

/* Bytes in a message: a shape, and 8 for each number. */
static size_t frames_bytes(const struct fmb_frame *frames, size_t count)
{
    size_t bytes = 0;
    for (size_t i = 0; i < count; i++) {
        const int vectors = frames[i].shape == FMB_BOX ? 2 : 1 + frames[i].count;
        bytes += 1 + 8 * (size_t) (vectors * frames[i].dim);
    }
    return bytes;
}

static bool read_frames(struct json_reader *reader, const struct json_path *path, const cJSON *item,
                        int dim, struct scene_body *out)
{
    if (!cJSON_IsArray(item))
        return refuse_kind(reader, path, item, "an array");
    const size_t count = (size_t) cJSON_GetArraySize(item);
    out->frames = allocate(count, sizeof *out->frames);
    struct json_path at = {path, NULL, 0};
    for (const cJSON *child = item->child; child; child = child->next, at.index++)
        if (!read_frame(reader, &at, child, dim, &out->frames[at.index]))
            return false;
    const size_t bytes = frames_bytes(out->frames, count);
    if (bytes > FMB_CLIENT_BODY_BYTES_MAX)
        return refuse(reader, path, "%s: %zu bytes in a message, which has space for %d",
                      fmb_status_text(FMB_OVER_LIMIT), bytes, (int) FMB_CLIENT_BODY_BYTES_MAX);
    const enum fmb_status status = fmb_body_make_frames(out->frames, count, &out->body);
    return status == FMB_OK || refuse(reader, path, "%s", fmb_status_text(status));
}

/* A body that is one frame. Its "origin", if it has neither "position" nor "orientation", is its
 * position. */
static bool read_only_frame(struct json_reader *reader, const struct json_path *path,
                            const struct members *of, int dim, struct scene_body *out)
{
    struct frame_numbers frame;
    if (!read_numbers(reader, path, of, dim, &frame))
        return false;
    if (frame.shape != FMB_BOX && !of->value[POSITION] && !of->value[ORIENTATION]) {
        if (!check_present(reader, path, of, ORIGIN))
            return false;
        memcpy(out->position, frame.number, (size_t) dim * sizeof *frame.number);
        memset(frame.number, 0, (size_t) dim * sizeof *frame.number);
    }
    const enum fmb_status status =
        fmb_body_make(dim, frame.shape, frame.number, frame.count, &out->body);
    return status == FMB_OK || refuse(reader, path, "%s", fmb_status_text(status));
}

static bool read_name(struct json_reader *reader, const struct json_path *path, const cJSON *item,
                      char out[SCENE_NAME_MAX + 1])
{
    if (!item)
        return true;
    if (!cJSON_IsString(item))
        return refuse_kind(reader, path, item, "a string");
    if (strlen(item->valuestring) > SCENE_NAME_MAX)
        return refuse(reader, path, "expected at most %d bytes, found %zu", (int) SCENE_NAME_MAX,
                      strlen(item->valuestring));
    if (!escape_is_text(item->valuestring))
        return refuse(reader, path, "expected UTF-8 without control characters");
    strcpy(out, item->valuestring);
    return true;
}

static bool read_body(struct json_reader *reader, const struct json_path *path, const cJSON *item,
                      int dim, struct scene_body *out)
{
    static const int of_frames[] = {SHAPE, ORIGIN, COMPONENTS, SIZE};
    struct members members;
    if (!read_members(reader, path, item, BODY_KEYS, &members))
        return false;
    const struct json_path *at = members.path;
    const cJSON *const *value = members.value;
    if (!read_id(reader, &at[ID], value[ID], &out->id) ||
        !read_name(reader, &at[NAME], value[NAME], out->name))
        return false;
    const bool good = value[FRAMES] ? check_absent(reader, path, &members, of_frames, 4,
                                                   "a body of \"frames\"") &&
                                          read_frames(reader, &at[FRAMES], value[FRAMES], dim, out)
                                    : read_only_frame(reader, path, &members, dim, out);
    return good &&
           (!value[POSITION] ||
            read_vector(reader, &at[POSITION], value[POSITION], dim, out->position)) &&
           read_orientation(reader, &at[ORIENTATION], value[ORIENTATION], dim, out->orientation,
                            &out->orientation_count) &&
           (!value[VELOCITY] ||
            read_vector(reader, &at[VELOCITY], value[VELOCITY], dim, out->velocity));
}

static bool read_bodies(struct json_reader *reader, const cJSON *item, struct scene *out)
{
    struct json_path path = {NULL, "bodies", 0};
    if (!cJSON_IsArray(item))
        return refuse_kind(reader, &path, item, "an array");
    out->body = allocate((size_t) cJSON_GetArraySize(item), sizeof *out->body);
    struct json_path at = {&path, NULL, 0};
    for (const cJSON *child = item->child; child; child = child->next, at.index++) {
        out->body_count++;
        if (!read_body(reader, &at, child, out->dim, &out->body[at.index]))
            return false;
    }
    return true;
}

/* ---- Pairs ----------------------------------------------------------------------------------- */

static bool read_pair(struct json_reader *reader, const struct json_path *path, const cJSON *item,
                      const struct scene_ids *ids, struct scene_pair *out)
{
    if (!check_array(reader, path, item, 2, "ids"))
        return false;
    size_t index[2];
    int64_t id = 0;
    struct json_path at = {path, NULL, 0};
    for (const cJSON *child = item->child; child; child = child->next, at.index++) {
        if (!read_id(reader, &at, child, &id))
            return false;
        if (!scene_ids_find(ids, id, &index[at.index]))
            return refuse(reader, &at, "no body has the id %lld", (long long) id);
    }
    *out = (struct scene_pair){index[0], index[1]};
    return out->a != out->b ||
           refuse(reader, path, "a body is no pair with itself (%lld)", (long long) id);
}

static bool read_list(struct json_reader *reader, const struct json_path *path, const cJSON *item,
                      const struct scene_ids *ids, struct scene_pair **list, size_t *count)
{
    if (!cJSON_IsArray(item))
        return refuse_kind(reader, path, item, "an array");
    *list = allocate((size_t) cJSON_GetArraySize(item), sizeof **list);
    struct json_path at = {path, NULL, 0};
    for (const cJSON *child = item->child; child; child = child->next, at.index++) {
        if (!read_pair(reader, &at, child, ids, &(*list)[at.index]))
            return false;
        ++*count;
    }
    return true;
}

/* No listed pair is ignored. */
static bool check_listed(struct json_reader *reader, const struct json_path *pairs,
                         const struct scene *scene)
{
    for (size_t i = 0; i < scene->pair_count; i++) {
        struct json_path at = {pairs, NULL, i};
        if (scene_ignores(scene, scene->pair[i]))
            return refuse(reader, &at, "\"ignore\" has this pair too");
    }
    return true;
}

static bool read_pairs(struct json_reader *reader, const cJSON *pairs, const cJSON *ignore,
                       const struct scene_ids *ids, struct scene *out)
{
    const struct json_path of_pairs = {NULL, "pairs", 0}, of_ignore = {NULL, "ignore", 0};
    out->all_pairs = !pairs;
    if (pairs && !read_list(reader, &of_pairs, pairs, ids, &out->pair, &out->pair_count))
        return false;
    if (ignore && !read_list(reader, &of_ignore, ignore, ids, &out->ignored, &out->ignored_count))
        return false;
    scene_sort_ignored(out);
    if (!check_listed(reader, &of_pairs, out))
        return false;
    out->ignored_count = out->all_pairs ? out->ignored_count : 0;
    return true;
}

static bool refuse_repeated_id(struct json_reader *reader, const struct scene *scene, size_t first,
                               size_t second)
{
    struct json_path bodies = {NULL, "bodies", 0};
    struct json_path body = {&bodies, NULL, second};
    struct json_path id = {&body, "id", 0};
    return refuse(reader, &id, "%lld is the id of bodies[%zu] already",
                  (long long) scene->body[second].id, first);
}

static bool link_pairs(struct json_reader *reader, const cJSON *pairs, const cJSON *ignore,
                       struct scene *out)
{
    struct scene_ids ids;
    size_t first, second;
    scene_ids_make(out, &ids);
    bool unique = !scene_ids_repeated(&ids, &first, &second);
    bool good = unique ? read_pairs(reader, pairs, ignore, &ids, out)
                       : refuse_repeated_id(reader, out, first, second);
    scene_ids_clear(&ids);
    return good;
}

/* ---- The scene ------------------------------------------------------------------------------- */

static bool read_dim(struct json_reader *reader, const cJSON *item, struct scene *out)
{
    struct json_path path = {NULL, "dim", 0};
    if (!cJSON_IsNumber(item))
        return refuse_kind(reader, &path, item, "2 or 3");
    if (item->valuedouble != 2 && item->valuedouble != 3)
        return refuse_value(reader, &path, item->valuedouble, "2 or 3");
    out->dim = (int) item->valuedouble;
    return true;
}

/* On input: *out is its value where it is left out. */
static bool read_from_0(struct json_reader *reader, const char *key, const cJSON *item, double *out)
{
    struct json_path path = {NULL, key, 0};
    if (!item)
        return true;
    return read_number(reader, &path, item, out) &&
           (*out >= 0 || refuse_value(reader, &path, *out, "a number of at least 0"));
}

enum { DIM, DURATION, MARGIN, BODIES, PAIRS, IGNORE, SCENE_KEYS };

static const struct key scene_keys[SCENE_KEYS] = {
    [DIM] = {"dim", false},       [DURATION] = {"duration", true}, [MARGIN] = {"margin", true},
    [BODIES] = {"bodies", false}, [PAIRS] = {"pairs", true},       [IGNORE] = {"ignore", true},
};

static bool read_scene(struct json_reader *reader, const cJSON *item, struct scene *out)
{
    const cJSON *value[SCENE_KEYS];
    out->duration = 1;
    return read_object(reader, NULL, item, scene_keys, SCENE_KEYS, value) &&
           read_dim(reader, value[DIM], out) &&
           read_from_0(reader, "duration", value[DURATION], &out->duration) &&
           read_from_0(reader, "margin", value[MARGIN], &out->margin) &&
           read_bodies(reader, value[BODIES], out) &&
           link_pairs(reader, value[PAIRS], value[IGNORE], out);
}

/* ---- The input ------------------------------------------------------------------------------- */

/* Without memory the program ends; to the parser it would be invalid JSON. */
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

static enum json_outcome bad_text(struct json_reader *reader, enum json_outcome outcome)
{
    refuse(reader, NULL, "%s", reader->text.error);
    return outcome;
}

static enum json_outcome read_object_text(struct json_reader *reader, const char *object,
                                          size_t length, struct scene *out)
{
    const char *end = object;
    cJSON *root = cJSON_ParseWithLengthOpts(object, length, &end, false);
    const bool parsed = root && end == object + length;
    const bool good = parsed && read_scene(reader, root, out);
    cJSON_Delete(root);
    if (good) {
        reader->scene_number++;
        return JSON_SCENE;
    }
    scene_clear(out);
    if (parsed)
        return JSON_BAD;
    text_refuse(&reader->text, (size_t) (end - object), "invalid JSON");
    return bad_text(reader, JSON_BAD);
}

enum json_outcome json_next(struct json_reader *reader, struct scene *out)
{
    const char *object = NULL;
    size_t length = 0;
    memset(out, 0, sizeof *out);
    switch (text_next(&reader->text, &object, &length)) {
    case TEXT_OBJECT: return read_object_text(reader, object, length, out);
    case TEXT_FAILED: return bad_text(reader, JSON_FAILED);
    case TEXT_BAD: return bad_text(reader, JSON_BAD);
    case TEXT_END: break;
    }
    if (reader->scene_number > 1)
        return JSON_END;
    refuse(reader, NULL, "the input is empty: expected a scene");
    return JSON_BAD;
}
