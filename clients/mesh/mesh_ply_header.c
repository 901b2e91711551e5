#include "mesh_ply.h"

#include <string.h>

/* A line of the header, divided into words. */
struct header_line {
    const unsigned char *begin;
    const unsigned char *word[6]; /* the first ones; after them, the end of the line */
    size_t count;                 /* total number */
};

static bool is_word(const struct mesh_source *source, const unsigned char *at, const char *text)
{
    const size_t length = strlen(text);
    return strncmp((const char *) at, text, length) == 0 && mesh_ends_word(source, at + length);
}

/* Reads the next line. */
static bool take_line(struct mesh_source *source, struct header_line *out)
{
    const unsigned char *at = source->at;
    const unsigned char *end = memchr(at, '\n', mesh_left(source));
    if (!end)
        return mesh_refuse_line(source, at, "the file ends before the header does: no end_header");
    memset(out, 0, sizeof *out);
    out->begin = at;
    for (size_t i = 0; i < sizeof out->word / sizeof *out->word; i++)
        out->word[i] = end;
    while ((at = mesh_skip_blanks(at)) < end) {
        if (out->count < sizeof out->word / sizeof *out->word)
            out->word[out->count] = at;
        out->count++;
        while (!mesh_is_space(*at))
            at++;
    }
    source->at = end + 1;
    return true;
}

/* ---- Words ----------------------------------------------------------------------------------- */

static enum ply_type type_of(const struct mesh_source *source, const unsigned char *word)
{
    static const char *const names[][2] = {
        [PLY_INT8] = {"char", "int8"},        [PLY_UINT8] = {"uchar", "uint8"},
        [PLY_INT16] = {"short", "int16"},     [PLY_UINT16] = {"ushort", "uint16"},
        [PLY_INT32] = {"int", "int32"},       [PLY_UINT32] = {"uint", "uint32"},
        [PLY_FLOAT32] = {"float", "float32"}, [PLY_FLOAT64] = {"double", "float64"},
    };
    for (enum ply_type type = PLY_INT8; type <= PLY_FLOAT64; type++)
        if (is_word(source, word, names[type][0]) || is_word(source, word, names[type][1]))
            return type;
    return PLY_NONE;
}

size_t ply_size(enum ply_type type)
{
    static const size_t sizes[] = {
        [PLY_NONE] = 0,  [PLY_INT8] = 1,   [PLY_UINT8] = 1,   [PLY_INT16] = 2,  [PLY_UINT16] = 2,
        [PLY_INT32] = 4, [PLY_UINT32] = 4, [PLY_FLOAT32] = 4, [PLY_FLOAT64] = 8};
    return sizes[type];
}

static bool read_count(struct mesh_source *source, const unsigned char *word, size_t *out)
{
    char text[MESH_WORD_MAX];
    uint64_t count = 0;
    const unsigned char *at = word;
    for (; *at >= '0' && *at <= '9'; at++)
        count = count < MESH_COUNT_MAX ? 10 * count + (unsigned) (*at - '0') : count;
    *out = (size_t) count;
    if (at > word && mesh_ends_word(source, at) && count <= MESH_COUNT_MAX)
        return true;
    return mesh_refuse_line(source, word, "'%s' is no count from 0 to %u",
                            mesh_word(source, word, text), MESH_COUNT_MAX);
}

/* ---- Lines ----------------------------------------------------------------------------------- */

static bool read_format(struct ply *ply, const struct header_line *line)
{
    static const char *const names[] = {
        [PLY_ASCII] = "ascii",
        [PLY_LITTLE_ENDIAN] = "binary_little_endian",
        [PLY_BIG_ENDIAN] = "binary_big_endian",
    };
    if (line->count == 3 && is_word(ply->source, line->word[2], "1.0"))
        for (ply->format = PLY_ASCII; ply->format <= PLY_BIG_ENDIAN; ply->format++)
            if (is_word(ply->source, line->word[1], names[ply->format]))
                return true;
    return mesh_refuse_line(ply->source, line->begin,
                            "the format is not ascii 1.0, binary_little_endian 1.0 or "
                            "binary_big_endian 1.0");
}

static bool is_there(const struct ply *ply, enum ply_kind kind)
{
    for (size_t i = 0; i < ply->element_count; i++)
        if (ply->element[i].kind == kind)
            return true;
    return false;
}

static bool read_element(struct ply *ply, const struct header_line *line)
{
    struct mesh_source *source = ply->source;
    if (line->count != 3)
        return mesh_refuse_line(source, line->begin, "an element has a name and a count");
    if (ply->element_count == PLY_ELEMENTS_MAX)
        return mesh_refuse_line(source, line->begin, "more than %d elements", PLY_ELEMENTS_MAX);
    struct ply_element *element = &ply->element[ply->element_count];
    *element = (struct ply_element){
        .kind = PLY_OTHERS, .name = "element", .line = line->begin, .first = ply->property_count};
    if (is_word(source, line->word[1], "vertex")) {
        element->kind = PLY_VERTICES;
        element->name = "vertex";
    } else if (is_word(source, line->word[1], "face")) {
        element->kind = PLY_FACES;
        element->name = "face";
    }
    if (element->kind != PLY_OTHERS && is_there(ply, element->kind))
        return mesh_refuse_line(source, line->begin, "a second element %s", element->name);
    if (!read_count(source, line->word[2], &element->count))
        return false;
    if (is_word(source, line->word[1], "tristrips") && element->count > 0)
        return mesh_refuse_line(source, line->begin,
                                "strips of triangles are not read: write them as faces first");
    if (element->kind == PLY_VERTICES)
        ply->vertex_count = element->count;
    ply->element_count++;
    return true;
}

static enum ply_role role_of(const struct mesh_source *source, enum ply_kind kind,
                             const unsigned char *name)
{
    static const char *const axes[] = {"x", "y", "z"};
    if (kind == PLY_FACES &&
        (is_word(source, name, "vertex_indices") || is_word(source, name, "vertex_index")))
        return PLY_INDICES;
    for (enum ply_role axis = PLY_X; kind == PLY_VERTICES && axis <= PLY_Z; axis++)
        if (is_word(source, name, axes[axis]))
            return axis;
    return PLY_UNUSED;
}

/* Reads "property TYPE NAME" or "property list TYPE TYPE NAME". */
static bool read_property(struct ply *ply, const struct header_line *line)
{
    struct mesh_source *source = ply->source;
    char text[MESH_WORD_MAX];
    const bool list = line->count == 5 && is_word(source, line->word[1], "list");
    if (line->count != 3 && !list)
        return mesh_refuse_line(source, line->begin,
                                "a property is 'TYPE NAME' or 'list TYPE TYPE NAME'");
    if (ply->element_count == 0)
        return mesh_refuse_line(source, line->begin, "a property before any element");
    if (ply->property_count == PLY_PROPERTIES_MAX)
        return mesh_refuse_line(source, line->begin, "more than %d properties", PLY_PROPERTIES_MAX);
    for (size_t word = 1; word < line->count - 1; word++)
        if (!(list && word == 1) && type_of(source, line->word[word]) == PLY_NONE)
            return mesh_refuse_line(source, line->begin, "'%s' is no type of PLY",
                                    mesh_word(source, line->word[word], text));
    struct ply_element *element = &ply->element[ply->element_count - 1];
    struct ply_property *property = &ply->property[ply->property_count++];
    property->count = list ? type_of(source, line->word[2]) : PLY_NONE;
    property->type = type_of(source, line->word[list ? 3 : 1]);
    property->role = role_of(source, element->kind, line->word[line->count - 1]);
    element->property_count++;
    if (property->role == PLY_UNUSED)
        return true;
    if (element->roles >> property->role & 1)
        return mesh_refuse_line(source, line->begin, "%s has this property already", element->name);
    if (list != (property->role == PLY_INDICES))
        return mesh_refuse_line(source, line->begin, "'%s' is %s list",
                                mesh_word(source, line->word[line->count - 1], text),
                                list ? "a" : "no");
    element->roles |= 1u << property->role;
    return true;
}

/* ---- The header ------------------------------------------------------------------------------ */

static bool check_element(struct ply *ply, const struct ply_element *element)
{
    static const char axes[] = "xyz";
    if (element->count == 0)
        return true;
    for (int axis = 0; element->kind == PLY_VERTICES && axis < 3; axis++)
        if (!(element->roles >> axis & 1))
            return mesh_refuse_line(ply->source, element->line, "vertices without %c", axes[axis]);
    if (element->kind == PLY_FACES && !(element->roles >> PLY_INDICES & 1))
        return mesh_refuse_line(ply->source, element->line,
                                "faces without vertex_indices or vertex_index");
    return true;
}

/* Least bytes of an element. In ASCII files each value takes a digit and a separator. A triangle
 * has a count and three indices. */
static size_t least_size(const struct ply *ply, const struct ply_element *element)
{
    size_t values = 0, bytes = 0;
    for (size_t i = element->first; i < element->first + element->property_count; i++) {
        const struct ply_property *property = &ply->property[i];
        const size_t triangle = property->role == PLY_INDICES ? 3 : property->count ? 0 : 1;
        values += triangle + (property->count != PLY_NONE);
        bytes += triangle * ply_size(property->type) + ply_size(property->count);
    }
    return ply->format == PLY_ASCII ? 2 * values : bytes;
}

/* Checks that the file is large enough for the counts of the header. The last line may lack its
 * end. */
static bool check_promises(struct ply *ply)
{
    size_t left = mesh_left(ply->source) + (ply->format == PLY_ASCII);
    for (size_t i = 0; i < ply->element_count; i++) {
        const struct ply_element *element = &ply->element[i];
        const size_t size = least_size(ply, element);
        if (!check_element(ply, element))
            return false;
        if (size > 0 && element->count > left / size)
            return mesh_refuse_line(ply->source, element->line,
                                    "the file is cut off, or this count is wrong: there is room "
                                    "for %zu at most",
                                    left / size);
        left -= element->count * size;
    }
    return true;
}

static bool read_line(struct ply *ply, const struct header_line *line, bool *has_format)
{
    struct mesh_source *source = ply->source;
    char text[MESH_WORD_MAX];
    const unsigned char *keyword = line->word[0];
    if (line->count == 0 || is_word(source, keyword, "comment") ||
        is_word(source, keyword, "obj_info"))
        return true;
    if (is_word(source, keyword, "element"))
        return read_element(ply, line);
    if (is_word(source, keyword, "property"))
        return read_property(ply, line);
    if (!is_word(source, keyword, "format"))
        return mesh_refuse_line(source, line->begin, "'%s' is no keyword of a PLY header",
                                mesh_word(source, keyword, text));
    if (*has_format)
        return mesh_refuse_line(source, line->begin, "a second format");
    *has_format = true;
    return read_format(ply, line);
}

static bool is_magic(const struct mesh_source *source, const struct header_line *line)
{
    return line->count == 1 && line->word[0] == line->begin && is_word(source, line->begin, "ply");
}

static bool ends_lines_with_returns(const struct mesh_source *source)
{
    const char *text = (const char *) source->at;
    return strncmp(text, "ply\r", 4) == 0 && text[4] != '\n';
}

bool ply_header(struct ply *ply)
{
    struct header_line line;
    bool has_format = false;
    if (ends_lines_with_returns(ply->source))
        return mesh_refuse_line(ply->source, ply->source->at,
                                "lines end in carriage returns alone: convert them first");
    if (!take_line(ply->source, &line))
        return false;
    if (!is_magic(ply->source, &line))
        return mesh_refuse_line(ply->source, line.begin, "a PLY file begins with a line 'ply'");
    while (true) {
        if (!take_line(ply->source, &line))
            return false;
        if (line.count == 1 && is_word(ply->source, line.word[0], "end_header"))
            break;
        if (!read_line(ply, &line, &has_format))
            return false;
    }
    if (!has_format)
        return mesh_refuse_line(ply->source, line.begin, "the header names no format");
    return check_promises(ply);
}
