/* STL parser. ASCII: solid NAME, then for each facet
 *
 *     facet normal NX NY NZ
 *       outer loop
 *         vertex X Y Z            three times
 *       endloop
 *     endfacet
 *
 * and endsolid NAME; in any case, with any white space between words. Several solids in one file
 * become one mesh. */
#include "keyed_hash.h"
#include "mesh_source.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* ---- Vertices of equal coordinates are one --------------------------------------------------- */

struct welded {
    double position[3];
    unsigned index;
    UT_hash_handle hh;
};

struct weld {
    struct mesh_source *source; /* all vertices are added by weld_vertex() */
    struct welded *vertex;      /* owned: hash table by coordinates; NULL: empty */
};

static bool weld_vertex(struct weld *weld, const double position[3], unsigned *index)
{
    /* -0 + 0 is 0; every other number plus 0 is unchanged */
    const double clean[3] = {position[0] + 0.0, position[1] + 0.0, position[2] + 0.0};
    struct welded *welded;
    HASH_FIND(hh, weld->vertex, clean, sizeof clean, welded);
    if (!welded) {
        if (!mesh_add_vertex(weld->source, clean))
            return false;
        welded = allocate(1, sizeof *welded);
        memcpy(welded->position, clean, sizeof clean);
        welded->index = (unsigned) weld->source->mesh.vertex_count - 1;
        HASH_ADD(hh, weld->vertex, position, sizeof clean, welded);
    }
    *index = welded->index;
    return true;
}

/* ---- ASCII ----------------------------------------------------------------------------------- */

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
        return mesh_refuse(source, source->at, "the file ends where %s should stand", expected);
    return mesh_refuse(source, source->at, "'%s' stands where %s should",
                       mesh_word(source, source->at, text), expected);
}

static bool take(struct mesh_source *source, const char *word)
{
    if (!is_next(source, word))
        return refuse_next(source, word);
    source->at += strlen(word);
    return true;
}

/* Reads three numbers. finite: others are an error. */
static bool read_numbers(struct mesh_source *source, bool finite, double out[3])
{
    for (int axis = 0; axis < 3; axis++) {
        source->at = mesh_skip_spaces(source->at);
        const unsigned char *end = mesh_number(source->at, &out[axis]);
        if (!end || !mesh_ends_word(source, end))
            return refuse_next(source, "a number");
        if (finite && !isfinite(out[axis]))
            return mesh_refuse(source, source->at, "%c is not finite", "xyz"[axis]);
        source->at = end;
    }
    return true;
}

static bool read_loop(struct weld *weld)
{
    struct mesh_source *source = weld->source;
    unsigned corner[3];
    for (int i = 0; i < 3; i++) {
        double position[3];
        if (i > 0 && is_next(source, "endloop"))
            return mesh_refuse(source, source->at, "a facet of %d vertices: remove it first", i);
        if (!take(source, "vertex") || !read_numbers(source, true, position) ||
            !weld_vertex(weld, position, &corner[i]))
            return false;
    }
    if (is_next(source, "vertex"))
        return mesh_refuse(source, source->at,
                           "a facet of more than 3 vertices: triangulate it first");
    return mesh_add_face(source, corner);
}

/* The normal is ignored: some programs write NaN. */
static bool read_facet(struct weld *weld)
{
    struct mesh_source *source = weld->source;
    double normal[3];
    return take(source, "facet") && take(source, "normal") && read_numbers(source, false, normal) &&
           take(source, "outer") && take(source, "loop") && read_loop(weld) &&
           take(source, "endloop") && take(source, "endfacet");
}

static bool read_solid(struct weld *weld)
{
    struct mesh_source *source = weld->source;
    if (!take(source, "solid"))
        return false;
    mesh_skip_line(source);
    while (!is_next(source, "endsolid")) {
        if (!is_next(source, "facet"))
            return refuse_next(source, "facet or endsolid");
        if (!read_facet(weld))
            return false;
        mesh_report_progress(source);
    }
    mesh_skip_line(source);
    return true;
}

bool mesh_stl_ascii(struct mesh_source *source)
{
    struct weld weld = {.source = source};
    bool good;
    source->text = true;
    do {
        good = read_solid(&weld);
        source->at = mesh_skip_spaces(source->at);
    } while (good && source->at < source->end);
    HASH_FREE(weld.vertex);
    return good;
}

/* ---- Binary ---------------------------------------------------------------------------------- */

/* Binary, little-endian: 80 bytes of any content, the number of facets (32 bits), then 50 bytes for
 * each facet: its normal and three vertices, three floats (32 bits) each, and 16 bits of any
 * content. */
enum { COUNT_AT = 80, HEADER_BYTES = 84, FACET_BYTES = 50, NORMAL_BYTES = 12, FLOAT_BYTES = 4 };

static uint32_t word_at(const unsigned char *bytes)
{
    return (uint32_t) mesh_bits(bytes, sizeof(uint32_t), false);
}

static uint64_t size_of(uint32_t facets)
{
    return HEADER_BYTES + (uint64_t) FACET_BYTES * facets;
}

bool mesh_is_stl_binary(const struct mesh_source *source)
{
    const size_t size = (size_t) (source->end - source->begin);
    return size >= HEADER_BYTES && size == size_of(word_at(source->begin + COUNT_AT));
}

static bool refuse_size(struct mesh_source *source)
{
    const size_t size = (size_t) (source->end - source->begin);
    if (size < HEADER_BYTES)
        return mesh_refuse(source, source->end,
                           "the file ends within the %d bytes that begin a binary STL file",
                           HEADER_BYTES);
    const uint32_t facets = word_at(source->begin + COUNT_AT);
    return mesh_refuse(source, source->begin + COUNT_AT,
                       "%" PRIu32 " facets of binary STL are %" PRIu64
                       " bytes with their header, the file has %zu: it is cut off, or the "
                       "count is wrong",
                       facets, size_of(facets), size);
}

static bool read_vertex(struct weld *weld, unsigned *index)
{
    struct mesh_source *source = weld->source;
    double position[3];
    for (int axis = 0; axis < 3; axis++) {
        position[axis] = mesh_float(word_at(source->at));
        if (!isfinite(position[axis]))
            return mesh_refuse(source, source->at, "%c is not finite", "xyz"[axis]);
        source->at += FLOAT_BYTES;
    }
    return weld_vertex(weld, position, index);
}

static bool read_facets(struct weld *weld)
{
    struct mesh_source *source = weld->source;
    source->at = source->begin + HEADER_BYTES;
    source->within = "face";
    for (; source->at < source->end; source->index++) {
        const unsigned char *begin = source->at;
        unsigned corner[3];
        source->at += NORMAL_BYTES;
        for (int i = 0; i < 3; i++)
            if (!read_vertex(weld, &corner[i]))
                return false;
        if (!mesh_add_face(source, corner))
            return false;
        source->at = begin + FACET_BYTES;
        mesh_report_progress(source);
    }
    return true;
}

bool mesh_stl_binary(struct mesh_source *source)
{
    struct weld weld = {.source = source};
    if (!mesh_is_stl_binary(source))
        return refuse_size(source);
    const bool good = read_facets(&weld);
    HASH_FREE(weld.vertex);
    return good;
}
