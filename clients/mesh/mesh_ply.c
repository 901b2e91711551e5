/* PLY parser. First the header: the elements and their properties, in the order of the values. Then
 * the elements of each kind, one kind after the other. */
#include "mesh_source.h"

#include <math.h>
#include <string.h>

enum { ELEMENTS_MAX = 64, PROPERTIES_MAX = 256, WORDS_MAX = 6 };

enum format { ASCII, LITTLE_ENDIAN_BINARY, BIG_ENDIAN_BINARY };

enum type { NONE, INT8, UINT8, INT16, UINT16, INT32, UINT32, FLOAT32, FLOAT64, TYPES };

static const struct {
    const char *name[2];
    size_t size; /* bytes */
} types[TYPES] = {
    [INT8] = {{"char", "int8"}, 1},        [UINT8] = {{"uchar", "uint8"}, 1},
    [INT16] = {{"short", "int16"}, 2},     [UINT16] = {{"ushort", "uint16"}, 2},
    [INT32] = {{"int", "int32"}, 4},       [UINT32] = {{"uint", "uint32"}, 4},
    [FLOAT32] = {{"float", "float32"}, 4}, [FLOAT64] = {{"double", "float64"}, 8},
};

/* The meaning of a property. X, Y, Z are 0, 1, 2. */
enum role { X, Y, Z, INDICES, UNUSED };

struct property {
    enum type type;  /* of the value, or of a list's elements */
    enum type count; /* of a list's length; NONE: not a list */
    enum role role;
};

enum kind { VERTICES, FACES, OTHERS };
static const char *const kind_name[] = {"vertex", "face", "element"};

struct element {
    enum kind kind;
    const unsigned char *line; /* its line in the header */
    size_t count;
    size_t first, property_count; /* its range of ply.property */
    unsigned roles;               /* set of enum role, one bit each */
};

struct ply {
    struct mesh_source *source;
    enum format format;
    bool has_format;
    size_t element_count, property_count, vertex_count;
    struct element element[ELEMENTS_MAX];
    struct property property[PROPERTIES_MAX];
    const unsigned char *value_at; /* of the last value that was read */
    double position[3];            /* of the vertex that is being read */
};

/* A line of the header, divided into words. */
struct header_line {
    const unsigned char *begin;
    const unsigned char *word[WORDS_MAX]; /* the first ones; after them, the end of the line */
    size_t count;                         /* total number */
};

/* ---- Words of the header --------------------------------------------------------------------- */

static bool is_word(const struct mesh_source *source, const unsigned char *at, const char *text)
{
    const size_t length = strlen(text);
    return strncmp((const char *) at, text, length) == 0 && mesh_ends_word(source, at + length);
}

/* Reads the next line. */
static bool take_line(struct mesh_source *source, struct header_line *out)
{
    const unsigned char *at = source->at, *end = memchr(at, '\n', mesh_left(source));
    if (!end)
        return mesh_refuse(source, at, "the file ends before the header does: no end_header");
    *out = (struct header_line){.begin = at};
    for (size_t i = 0; i < WORDS_MAX; i++)
        out->word[i] = end;
    while ((at = mesh_skip_blanks(at)) < end) {
        if (out->count < WORDS_MAX)
            out->word[out->count] = at;
        out->count++;
        while (!mesh_is_space(*at))
            at++;
    }
    source->at = end + 1;
    return true;
}

static enum type type_of(const struct mesh_source *source, const unsigned char *word)
{
    enum type type = INT8;
    while (type < TYPES && !is_word(source, word, types[type].name[0]) &&
           !is_word(source, word, types[type].name[1]))
        type++;
    return type < TYPES ? type : NONE;
}

static enum role role_of(const struct mesh_source *source, enum kind kind,
                         const unsigned char *name)
{
    static const char *const names[] = {"x", "y", "z", "vertex_indices", "vertex_index"};
    const int end = kind == VERTICES ? INDICES : kind == FACES ? INDICES + 2 : 0;
    for (int i = kind == VERTICES ? X : INDICES; i < end; i++)
        if (is_word(source, name, names[i]))
            return i < INDICES ? (enum role) i : INDICES;
    return UNUSED;
}

static bool read_count(struct mesh_source *source, const unsigned char *word, size_t *out)
{
    char text[MESH_WORD_MAX];
    uint64_t count = 0;
    const unsigned char *at = word;
    for (; *at >= '0' && *at <= '9'; at++)
        count = count < MESH_COUNT_MAX ? 10 * count + (unsigned) (*at - '0') : count;
    *out = (size_t) count;
    return (at > word && mesh_ends_word(source, at) && count <= MESH_COUNT_MAX) ||
           mesh_refuse(source, word, "'%s' is no count from 0 to %u", mesh_word(source, word, text),
                       MESH_COUNT_MAX);
}

/* ---- Lines of the header --------------------------------------------------------------------- */

static bool read_format(struct ply *ply, const struct header_line *line)
{
    static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    if (ply->has_format)
        return mesh_refuse(ply->source, line->begin, "a second format");
    ply->has_format = true;
    if (line->count == 3 && is_word(ply->source, line->word[2], "1.0"))
        for (ply->format = ASCII; ply->format <= BIG_ENDIAN_BINARY; ply->format++)
            if (is_word(ply->source, line->word[1], names[ply->format]))
                return true;
    return mesh_refuse(ply->source, line->begin,
                       "the format is not ascii 1.0, binary_little_endian 1.0 or "
                       "binary_big_endian 1.0");
}

static bool read_element_line(struct ply *ply, const struct header_line *line)
{
    struct mesh_source *source = ply->source;
    struct element *element = &ply->element[ply->element_count];
    if (line->count != 3)
        return mesh_refuse(source, line->begin, "an element has a name and a count");
    if (ply->element_count == ELEMENTS_MAX)
        return mesh_refuse(source, line->begin, "more than %d elements", ELEMENTS_MAX);
    *element = (struct element){.line = line->begin, .first = ply->property_count};
    while (element->kind < OTHERS && !is_word(source, line->word[1], kind_name[element->kind]))
        element->kind++;
    for (size_t i = 0; i < ply->element_count && element->kind != OTHERS; i++)
        if (ply->element[i].kind == element->kind)
            return mesh_refuse(source, line->begin, "a second element %s",
                               kind_name[element->kind]);
    if (!read_count(source, line->word[2], &element->count))
        return false;
    if (is_word(source, line->word[1], "tristrips") && element->count > 0)
        return mesh_refuse(source, line->begin,
                           "strips of triangles are not read: write them as faces first");
    if (element->kind == VERTICES)
        ply->vertex_count = element->count;
    ply->element_count++;
    return true;
}

/* Reads "property TYPE NAME" or "property list TYPE TYPE NAME". */
static bool read_property_line(struct ply *ply, const struct header_line *line)
{
    struct mesh_source *source = ply->source;
    char text[MESH_WORD_MAX];
    const bool list = line->count == 5 && is_word(source, line->word[1], "list");
    const unsigned char *name = line->word[line->count < WORDS_MAX ? line->count - 1 : 0];
    if (line->count != 3 && !list)
        return mesh_refuse(source, line->begin,
                           "a property is 'TYPE NAME' or 'list TYPE TYPE NAME'");
    if (ply->element_count == 0)
        return mesh_refuse(source, line->begin, "a property before any element");
    if (ply->property_count == PROPERTIES_MAX)
        return mesh_refuse(source, line->begin, "more than %d properties", PROPERTIES_MAX);
    for (size_t word = list ? 2 : 1; word < line->count - 1; word++)
        if (type_of(source, line->word[word]) == NONE)
            return mesh_refuse(source, line->begin, "'%s' is no type of PLY",
                               mesh_word(source, line->word[word], text));
    struct element *element = &ply->element[ply->element_count - 1];
    const enum role role = role_of(source, element->kind, name);
    ply->property[ply->property_count++] =
        (struct property){.type = type_of(source, line->word[list ? 3 : 1]),
                          .count = list ? type_of(source, line->word[2]) : NONE,
                          .role = role};
    element->property_count++;
    if (role == UNUSED)
        return true;
    if (element->roles >> role & 1)
        return mesh_refuse(source, line->begin, "%s has this property already",
                           kind_name[element->kind]);
    element->roles |= 1u << role;
    return list == (role == INDICES) ||
           mesh_refuse(source, line->begin, "'%s' is %s list", mesh_word(source, name, text),
                       list ? "a" : "no");
}

static bool read_line(struct ply *ply, const struct header_line *line)
{
    struct mesh_source *source = ply->source;
    char text[MESH_WORD_MAX];
    const unsigned char *keyword = line->word[0];
    if (line->count == 0 || is_word(source, keyword, "comment") ||
        is_word(source, keyword, "obj_info"))
        return true;
    if (is_word(source, keyword, "element"))
        return read_element_line(ply, line);
    if (is_word(source, keyword, "property"))
        return read_property_line(ply, line);
    return is_word(source, keyword, "format")
               ? read_format(ply, line)
               : mesh_refuse(source, line->begin, "'%s' is no keyword of a PLY header",
                             mesh_word(source, keyword, text));
}

/* Checks that the elements have what a mesh needs. */
static bool check_elements(const struct ply *ply)
{
    for (size_t i = 0; i < ply->element_count; i++) {
        const struct element *element = &ply->element[i];
        for (int axis = 0; element->kind == VERTICES && element->count > 0 && axis < 3; axis++)
            if (!(element->roles >> axis & 1))
                return mesh_refuse(ply->source, element->line, "vertices without %c", "xyz"[axis]);
        if (element->kind == FACES && element->count > 0 && !(element->roles >> INDICES & 1))
            return mesh_refuse(ply->source, element->line,
                               "faces without vertex_indices or vertex_index");
    }
    return true;
}

/* Reads the header, and advances the source past it. */
static bool read_header(struct ply *ply)
{
    struct mesh_source *source = ply->source;
    struct header_line line;
    source->text = true;
    if (strncmp((const char *) source->at, "ply\r", 4) == 0 && source->at[4] != '\n')
        return mesh_refuse(source, source->at,
                           "lines end in carriage returns alone: convert them first");
    if (!take_line(source, &line))
        return false;
    if (line.count != 1 || line.word[0] != line.begin || !is_word(source, line.begin, "ply"))
        return mesh_refuse(source, line.begin, "a PLY file begins with a line 'ply'");
    while (true) {
        if (!take_line(source, &line))
            return false;
        if (line.count == 1 && is_word(source, line.word[0], "end_header"))
            break;
        if (!read_line(ply, &line))
            return false;
    }
    if (!ply->has_format)
        return mesh_refuse(source, line.begin, "the header names no format");
    if (!check_elements(ply))
        return false;
    source->text = ply->format == ASCII;
    return true;
}

/* ---- Values ---------------------------------------------------------------------------------- */

static bool read_text(struct mesh_source *source, double *value)
{
    const unsigned char *begin = source->at, *end = mesh_number(begin, value);
    char text[MESH_WORD_MAX];
    if (end && mesh_ends_word(source, end)) {
        source->at = end;
        return true;
    }
    if (begin == source->end)
        return mesh_refuse(source, begin, "the file ends within %s %zu", source->within,
                           source->index);
    if (*begin == '\n')
        return mesh_refuse(source, begin, "the line ends before all numbers of %s %zu",
                           source->within, source->index);
    return mesh_refuse(source, begin, "'%s' is not a number", mesh_word(source, begin, text));
}

/* Every value of each type is a double. */
static double value_of(uint64_t bits, enum type type)
{
    switch (type) {
    case INT8: return (int8_t) bits;
    case INT16: return (int16_t) bits;
    case INT32: return (int32_t) bits;
    case FLOAT32: return mesh_float((uint32_t) bits);
    case FLOAT64: return mesh_double(bits);
    default: return (double) bits;
    }
}

static bool read_value(struct ply *ply, enum type type, double *value)
{
    struct mesh_source *source = ply->source;
    if (ply->format == ASCII) {
        ply->value_at = source->at = mesh_skip_blanks(source->at);
        return read_text(source, value);
    }
    const size_t size = types[type].size;
    if (mesh_left(source) < size)
        return mesh_refuse(
            source, source->end,
            "the file ends here: it is cut off, or a count in its header is too large");
    ply->value_at = source->at;
    source->at += size;
    *value = value_of(mesh_bits(ply->value_at, size, ply->format == BIG_ENDIAN_BINARY), type);
    return true;
}

/* Reads a list: the indices of a face; or another one, which is skipped. Each value takes at least
 * a byte, so a false length ends with the file. */
static bool read_list(struct ply *ply, const struct property *property)
{
    const bool face = property->role == INDICES;
    double length, index;
    if (!read_value(ply, property->count, &length))
        return false;
    if (!(length >= 0 && length <= UINT32_MAX && length == floor(length)))
        return mesh_refuse(ply->source, ply->value_at, "a list of %.10g values", length);
    if (face && !mesh_check_face(ply->source, ply->value_at, (size_t) length))
        return false;
    for (uint32_t i = 0; i < (uint32_t) length; i++) {
        if (!read_value(ply, property->type, &index))
            return false;
        if (!face)
            continue;
        if (!(index >= 0 && index < (double) ply->vertex_count && index == floor(index)))
            return mesh_refuse(ply->source, ply->value_at,
                               "index %.10g is no vertex: there are %zu, counted from 0", index,
                               ply->vertex_count);
        if (!mesh_add_corner(ply->source, i, (unsigned) index))
            return false;
    }
    return true;
}

static bool read_property(struct ply *ply, const struct property *property)
{
    double value;
    if (property->count != NONE)
        return read_list(ply, property);
    if (!read_value(ply, property->type, &value))
        return false;
    if (property->role == UNUSED)
        return true;
    ply->position[property->role] = value;
    return isfinite(value) ||
           mesh_refuse(ply->source, ply->value_at, "%c is not finite", "xyz"[property->role]);
}

/* ---- Elements ------------------------------------------------------------------------------- */

/* Reads a vertex, a face or another element; in ASCII files it is a line. */
static bool read_record(struct ply *ply, const struct element *element)
{
    struct mesh_source *source = ply->source;
    char text[MESH_WORD_MAX];
    if (source->text && (source->at = mesh_skip_spaces(source->at)) == source->end)
        return mesh_refuse(source, source->at, "the file ends before %s %zu of %zu", source->within,
                           source->index, element->count);
    for (size_t i = 0; i < element->property_count; i++)
        if (!read_property(ply, &ply->property[element->first + i]))
            return false;
    if (element->kind == VERTICES && !mesh_add_vertex(source, ply->position))
        return false;
    mesh_report_progress(source);
    if (!source->text)
        return true;
    source->at = mesh_skip_blanks(source->at);
    return *source->at == '\n' || source->at == source->end ||
           mesh_refuse(source, source->at, "'%s' after the last number of %s %zu",
                       mesh_word(source, source->at, text), source->within, source->index);
}

/* Elements without properties take no bytes, whatever their count. */
static bool read_element(struct ply *ply, const struct element *element)
{
    struct mesh_source *source = ply->source;
    source->within = kind_name[element->kind];
    source->index = 0;
    for (; element->property_count > 0 && source->index < element->count; source->index++)
        if (!read_record(ply, element))
            return false;
    source->within = NULL;
    return true;
}

static bool read_end(struct mesh_source *source)
{
    static const char wrong[] = "after the last element: a count is wrong, or something was added";
    const unsigned char *at = mesh_skip_spaces(source->at);
    char text[MESH_WORD_MAX];
    if (at == source->end)
        return true;
    return source->text ? mesh_refuse(source, at, "'%s' %s", mesh_word(source, at, text), wrong)
                        : mesh_refuse(source, source->at, "%zu bytes %s", mesh_left(source), wrong);
}

bool mesh_ply(struct mesh_source *source)
{
    struct ply ply = {.source = source};
    if (!read_header(&ply))
        return false;
    for (size_t i = 0; i < ply.element_count; i++)
        if (!read_element(&ply, &ply.element[i]))
            return false;
    return read_end(source);
}
