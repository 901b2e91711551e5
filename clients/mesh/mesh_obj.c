/* OBJ parser. A statement is a line, continued on the next one by a backslash at its end. v defines
 * a vertex, f a face. Statements that define no surface are skipped; those that define a surface
 * other than f are an error. */
#include "mesh_source.h"

#include "allocate.h"

#include <math.h>
#include <string.h>

/* skipped: statements that define no surface; the first DETECTED identify a file without an
 * extension, as v and f do. surfaces: statements other than f that define a surface. */
enum { DETECTED = 8 };
static const char *const skipped[] = {
    "vn",       "vt",         "o",         "g",      "s",      "usemtl", "mtllib", "vp",
    "l",        "p",          "mg",        "maplib", "usemap", "bevel",  "lod",    "c_interp",
    "d_interp", "shadow_obj", "trace_obj", "ctech",  "stech",  "cstype", "deg",    "bmat",
    "step",     "parm",       "trim",      "hole",   "scrv",   "sp",     "end",    "con"};
static const char *const surfaces[] = {"surf", "curv", "curv2", "bzp",  "bsp",
                                       "cdc",  "cdp",  "res",   "call", "csh"};

/* Exceeds any valid index. */
#define INDEX_MAX INT64_C(10000000000)

struct obj {
    struct mesh_source *source;
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

/* Whether this word is at this position. */
static bool is_word(const struct mesh_source *source, const unsigned char *at, const char *word)
{
    const size_t length = strlen(word);
    return strncmp((const char *) at, word, length) == 0 && ends_word(source, at + length);
}

/* Whether one of the words is at this position. */
static bool is_any(const struct mesh_source *source, const unsigned char *at,
                   const char *const *words, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (is_word(source, at, words[i]))
            return true;
    return false;
}

bool mesh_is_obj_statement(const struct mesh_source *source, const unsigned char *at)
{
    return is_word(source, at, "v") || is_word(source, at, "f") ||
           is_any(source, at, skipped, DETECTED);
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
static bool read_vertex(struct mesh_source *source)
{
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
    return mesh_add_vertex(source, position);
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
    struct mesh_source *source = obj->source;
    const size_t count = source->mesh.vertex_count;
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
    struct mesh_source *source = obj->source;
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
        if (!take_index(obj, index, &next) || !mesh_add_corner(source, count, next))
            return false;
        source->at = end;
    }
    return mesh_check_face(source, begin, count);
}

static void add_object(struct mesh_source *source)
{
    struct mesh *mesh = &source->mesh;
    mesh->object = allocate_grow(mesh->object, &source->object_capacity, mesh->object_count + 1,
                                 sizeof *mesh->object);
    mesh->object[mesh->object_count++] = mesh->face_count;
}

/* ---- The file -------------------------------------------------------------------------------- */

static bool read_statement(struct obj *obj)
{
    struct mesh_source *source = obj->source;
    const unsigned char *begin = source->at;
    const bool vertex = is_word(source, begin, "v");
    char text[MESH_WORD_MAX];
    if (vertex || is_word(source, begin, "f") || is_word(source, begin, "fo")) {
        while (!ends_word(source, source->at))
            source->at++;
        return vertex ? read_vertex(source) : read_face(obj);
    }
    if (is_any(source, begin, surfaces, sizeof surfaces / sizeof *surfaces))
        return mesh_refuse(source, begin,
                           "%s defines what is no triangle: make triangles of it first",
                           mesh_word(source, begin, text));
    if (!is_any(source, begin, skipped, sizeof skipped / sizeof *skipped))
        return mesh_refuse(source, begin, "'%s' is no statement of OBJ",
                           mesh_word(source, begin, text));
    if (is_word(source, begin, "o"))
        add_object(source);
    skip_statement(source);
    return true;
}

static bool read_statements(struct obj *obj)
{
    struct mesh_source *source = obj->source;
    while ((source->at = mesh_skip_spaces(skip(source->at))) < source->end) {
        if (*source->at != '#' && !read_statement(obj))
            return false;
        mesh_skip_line(source); /* the remainder of the line is a comment */
        mesh_report_progress(source);
    }
    return true;
}

bool mesh_obj(struct mesh_source *source)
{
    struct obj obj = {.source = source};
    char text[MESH_WORD_MAX];
    source->text = true;
    if (!read_statements(&obj))
        return false;
    return obj.largest <= source->mesh.vertex_count ||
           mesh_refuse(source, obj.largest_at,
                       "index %s is no vertex: there are %zu, counted from 1",
                       mesh_word(source, obj.largest_at, text), source->mesh.vertex_count);
}
