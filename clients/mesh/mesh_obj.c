/* OBJ parser. A statement is a line, continued on the next one by a backslash at its end. v defines
 * a vertex, f a face. Statements that define no surface are skipped; those that define a surface
 * other than f are an error. */
#include "mesh_source.h"

#include "allocate.h"

#include <math.h>
#include <string.h>

enum what { VERTEX, FACE, OBJECT, SKIPPED, SURFACE };

/* The most frequent statements come first. The first DETECTED identify a file without an extension.
 */
enum { DETECTED = 10 };
static const struct {
    const char *word;
    enum what what;
} statements[] = {
    {"v", VERTEX},          {"f", FACE},           {"vn", SKIPPED},       {"vt", SKIPPED},
    {"o", OBJECT},          {"g", SKIPPED},        {"s", SKIPPED},        {"usemtl", SKIPPED},
    {"mtllib", SKIPPED},    {"vp", SKIPPED},       {"l", SKIPPED},        {"p", SKIPPED},
    {"mg", SKIPPED},        {"maplib", SKIPPED},   {"usemap", SKIPPED},   {"bevel", SKIPPED},
    {"lod", SKIPPED},       {"c_interp", SKIPPED}, {"d_interp", SKIPPED}, {"shadow_obj", SKIPPED},
    {"trace_obj", SKIPPED}, {"ctech", SKIPPED},    {"stech", SKIPPED},    {"cstype", SKIPPED},
    {"deg", SKIPPED},       {"bmat", SKIPPED},     {"step", SKIPPED},     {"parm", SKIPPED},
    {"trim", SKIPPED},      {"hole", SKIPPED},     {"scrv", SKIPPED},     {"sp", SKIPPED},
    {"end", SKIPPED},       {"con", SKIPPED},      {"fo", FACE},          {"surf", SURFACE},
    {"curv", SURFACE},      {"curv2", SURFACE},    {"bzp", SURFACE},      {"bsp", SURFACE},
    {"cdc", SURFACE},       {"cdp", SURFACE},      {"res", SURFACE},      {"call", SURFACE},
    {"csh", SURFACE},
};
enum { STATEMENTS = sizeof statements / sizeof *statements };

/* Exceeds any valid index. */
#define INDEX_MAX INT64_C(10000000000)

struct obj {
    struct mesh_build build;
    size_t object_capacity;
    /* The largest index used, from 1, and its position: the vertex may follow its first use. */
    uint64_t largest;
    const unsigned char *largest_at;
};

/* ---- Words of a statement -------------------------------------------------------------------- */

/* Length of a line continuation, a backslash and the end of its line; 0: none. */
static size_t continuation(const unsigned char *at)
{
    if (*at != '\\')
        return 0;
    return at[1] == '\n' ? 2 : at[1] == '\r' && at[2] == '\n' ? 3 : 0;
}

static const unsigned char *skip(const unsigned char *at)
{
    size_t length = 0;
    do
        at = mesh_skip_blanks(at + length);
    while ((length = continuation(at)) > 0);
    return at;
}

static bool ends_word(const struct mesh_source *source, const unsigned char *at)
{
    return mesh_ends_word(source, at) || continuation(at) > 0;
}

/* Advances to the next word of the statement. Returns false at its end. */
static bool has_word(struct mesh_source *source)
{
    source->at = skip(source->at);
    return source->at < source->end && *source->at != '\n' && *source->at != '#';
}

/* Skips the statement with its continuation lines. */
static void skip_statement(struct mesh_source *source)
{
    while (has_word(source))
        while (!ends_word(source, source->at))
            source->at++;
}

/* Returns the index of the statement, and the length of its word; -1: there is none. */
static int find_statement(const struct mesh_source *source, const unsigned char *at, size_t *length)
{
    for (int i = 0; i < STATEMENTS; i++) {
        *length = strlen(statements[i].word);
        if (strncmp((const char *) at, statements[i].word, *length) == 0 &&
            ends_word(source, at + *length))
            return i;
    }
    return -1;
}

bool mesh_is_obj_statement(const struct mesh_source *source, const unsigned char *at)
{
    size_t length;
    const int statement = find_statement(source, at, &length);
    return statement >= 0 && statement < DETECTED;
}

/* ---- Vertices -------------------------------------------------------------------------------- */

static bool read_number(struct mesh_source *source, size_t axis, double *out)
{
    char text[MESH_WORD_MAX];
    const unsigned char *begin = source->at, *end = mesh_number(begin, out);
    if (!end || !ends_word(source, end))
        return mesh_refuse(source, begin, "'%s' is not a number", mesh_word(source, begin, text));
    if (axis < 3 && !isfinite(*out))
        return mesh_refuse(source, begin, "%c is not finite", "xyz"[axis]);
    source->at = end;
    return true;
}

/* Reads three coordinates, and skips what some programs add: a weight, a colour, both, or a colour
 * of four numbers. */
static bool read_vertex(struct obj *obj)
{
    struct mesh_source *source = obj->build.source;
    const unsigned char *begin = source->at;
    double position[3], ignored;
    size_t count = 0;
    for (; has_word(source); count++)
        if (!read_number(source, count, count < 3 ? &position[count] : &ignored))
            return false;
    if (count != 3 && count != 4 && count != 6 && count != 7)
        return mesh_refuse(source, begin,
                           "a vertex of %zu numbers: it has 3, and 1 more for a weight, 3 "
                           "more for a colour",
                           count);
    return mesh_add_vertex(&obj->build, position);
}

/* ---- Faces ----------------------------------------------------------------------------------- */

/* Returns the position after the integer; NULL: there is none. */
static const unsigned char *read_integer(const unsigned char *at, int64_t *out)
{
    const bool negative = *at == '-';
    at += *at == '-' || *at == '+';
    const unsigned char *begin = at;
    for (*out = 0; *at >= '0' && *at <= '9'; at++)
        *out = *out < INDEX_MAX ? 10 * *out + (*at - '0') : INDEX_MAX;
    if (negative)
        *out = -*out;
    return at > begin ? at : NULL;
}

/* Reads V, V/T, V/T/N or V//N, and returns V. NULL: none of these. */
static const unsigned char *read_corner(const unsigned char *at, int64_t *out)
{
    int64_t ignored;
    at = read_integer(at, out);
    if (!at || *at != '/')
        return at;
    if (*++at != '/' && !(at = read_integer(at, &ignored)))
        return NULL;
    return *at == '/' ? read_integer(at + 1, &ignored) : at;
}

/* Converts an index of the file, from 1 or relative to the last vertex so far, to an index from 0.
 * Whether the vertex exists is checked at the end. */
static bool take_index(struct obj *obj, int64_t index, unsigned *out)
{
    struct mesh_source *source = obj->build.source;
    const size_t count = obj->build.mesh->vertex_count;
    char text[MESH_WORD_MAX];
    if (index == 0)
        return mesh_refuse(source, source->at, "index 0 is no vertex: they count from 1");
    if (index < 0 && (uint64_t) -index > count)
        return mesh_refuse(source, source->at, "index %s is no vertex: there are %zu before it",
                           mesh_word(source, source->at, text), count);
    if (index > 0 && (uint64_t) index > obj->largest) {
        obj->largest = (uint64_t) index;
        obj->largest_at = source->at;
    }
    *out = index < 0 ? (unsigned) (count - (uint64_t) -index) : (unsigned) (index - 1);
    return true;
}

static bool read_face(struct obj *obj)
{
    struct mesh_source *source = obj->build.source;
    const unsigned char *begin = source->at;
    char text[MESH_WORD_MAX];
    size_t count = 0;
    for (; has_word(source); count++) {
        int64_t index;
        unsigned next = 0;
        const unsigned char *end = read_corner(source->at, &index);
        if (!end || !ends_word(source, end))
            return mesh_refuse(source, source->at, "'%s' is no corner of a face",
                               mesh_word(source, source->at, text));
        if (!take_index(obj, index, &next) || !mesh_add_corner(&obj->build, count, next))
            return false;
        source->at = end;
    }
    return mesh_check_face(source, begin, count);
}

static void add_object(struct obj *obj)
{
    struct mesh *mesh = obj->build.mesh;
    mesh->object = allocate_grow(mesh->object, &obj->object_capacity, mesh->object_count + 1,
                                 sizeof *mesh->object);
    mesh->object[mesh->object_count++] = mesh->face_count;
}

/* ---- The file -------------------------------------------------------------------------------- */

static bool read_statement(struct obj *obj)
{
    struct mesh_source *source = obj->build.source;
    const unsigned char *begin = source->at;
    char text[MESH_WORD_MAX];
    size_t length;
    const int statement = find_statement(source, begin, &length);
    if (statement < 0)
        return mesh_refuse(source, begin, "'%s' is no statement of OBJ",
                           mesh_word(source, begin, text));
    const enum what what = statements[statement].what;
    if (what == SURFACE)
        return mesh_refuse(source, begin,
                           "%s defines what is no triangle: make triangles of it first",
                           mesh_word(source, begin, text));
    source->at += length;
    if (what == VERTEX || what == FACE)
        return what == VERTEX ? read_vertex(obj) : read_face(obj);
    if (what == OBJECT)
        add_object(obj);
    skip_statement(source);
    return true;
}

static bool read_statements(struct obj *obj)
{
    struct mesh_source *source = obj->build.source;
    while ((source->at = mesh_skip_spaces(skip(source->at))) < source->end) {
        if (*source->at != '#' && !read_statement(obj))
            return false;
        mesh_skip_line(source); /* the remainder of the line is a comment */
        mesh_report_progress(source);
    }
    return true;
}

bool mesh_obj(struct mesh_source *source, struct mesh *out)
{
    struct obj obj = {.build = {.source = source, .mesh = out}};
    char text[MESH_WORD_MAX];
    source->text = true;
    if (!read_statements(&obj))
        return false;
    if (obj.largest > out->vertex_count)
        return mesh_refuse(source, obj.largest_at,
                           "index %s is no vertex: there are %zu, counted from 1",
                           mesh_word(source, obj.largest_at, text), out->vertex_count);
    return true;
}
