/* solid NAME, then for each facet
 *
 *     facet normal NX NY NZ
 *       outer loop
 *         vertex X Y Z            three times
 *       endloop
 *     endfacet
 *
 * and endsolid NAME; words in letters of any size, with any white space between them. There may be
 * several solids, one behind the other: they become one mesh. */
#include "mesh_formats.h"
#include "mesh_join.h"
#include "mesh_number.h"

#include <math.h>
#include <string.h>
#include <strings.h>

static bool is_next(struct mesh_source *source, const char *word)
{
    const size_t length = strlen(word);
    source->at = mesh_skip_spaces(source->at);
    return strncasecmp((const char *) source->at, word, length) == 0 &&
           mesh_ends_word(source, source->at + length);
}

static bool refuse_next(struct mesh_source *source, const char *expected)
{
    char text[MESH_WORD_MAX];
    source->at = mesh_skip_spaces(source->at);
    if (source->at == source->end)
        return mesh_refuse_line(source, source->at, "the file ends where %s should stand",
                                expected);
    return mesh_refuse_line(source, source->at, "'%s' stands where %s should",
                            mesh_word(source, source->at, text), expected);
}

static bool take(struct mesh_source *source, const char *word)
{
    if (!is_next(source, word))
        return refuse_next(source, word);
    source->at += strlen(word);
    return true;
}

/* Any numbers: some programs write normals that are not. */
static bool skip_normal(struct mesh_source *source)
{
    for (int axis = 0; axis < 3; axis++) {
        source->at = mesh_skip_spaces(source->at);
        const unsigned char *end = mesh_number_end(source->at);
        if (!end || !mesh_ends_word(source, end))
            return refuse_next(source, "a number");
        source->at = end;
    }
    return true;
}

static bool read_position(struct mesh_source *source, double out[3])
{
    for (int axis = 0; axis < 3; axis++) {
        source->at = mesh_skip_spaces(source->at);
        const unsigned char *end = mesh_number(source->at, &out[axis]);
        if (!end || !mesh_ends_word(source, end))
            return refuse_next(source, "a number");
        if (!isfinite(out[axis]))
            return mesh_refuse_line(source, source->at, "%c is not finite", "xyz"[axis]);
        source->at = end;
    }
    return true;
}

static bool read_loop(struct mesh_join *join)
{
    struct mesh_source *source = join->build->source;
    unsigned corner[3];
    for (int i = 0; i < 3; i++) {
        double position[3];
        if (i > 0 && is_next(source, "endloop"))
            return mesh_refuse_line(source, source->at, "a facet of %d vertices: remove it first",
                                    i);
        if (!take(source, "vertex") || !read_position(source, position) ||
            !mesh_join_vertex(join, position, &corner[i]))
            return false;
    }
    if (is_next(source, "vertex"))
        return mesh_refuse_line(source, source->at,
                                "a facet of more than 3 vertices: triangulate it first");
    return mesh_add_face(join->build, corner);
}

static bool read_facet(struct mesh_join *join)
{
    struct mesh_source *source = join->build->source;
    return take(source, "facet") && take(source, "normal") && skip_normal(source) &&
           take(source, "outer") && take(source, "loop") && read_loop(join) &&
           take(source, "endloop") && take(source, "endfacet");
}

static bool read_solid(struct mesh_join *join)
{
    struct mesh_source *source = join->build->source;
    if (!take(source, "solid"))
        return false;
    mesh_skip_line(source);
    while (!is_next(source, "endsolid")) {
        if (!is_next(source, "facet"))
            return refuse_next(source, "facet or endsolid");
        if (!read_facet(join))
            return false;
        mesh_tell(source);
    }
    mesh_skip_line(source);
    return true;
}

bool mesh_stl_ascii(struct mesh_source *source, struct mesh *out)
{
    struct mesh_build build = {.source = source, .mesh = out};
    struct mesh_join join;
    bool good;
    mesh_join_open(&join, &build);
    do {
        good = read_solid(&join);
        source->at = mesh_skip_spaces(source->at);
    } while (good && source->at < source->end);
    mesh_join_close(&join);
    mesh_fit(&build);
    return good;
}
