/* 80 bytes of anything, the number of facets as 32 bits, then 50 bytes for each facet: its normal
 * and three vertices, each of three floats of 32 bits, and 16 bits of anything. All little-endian.
 */
#include "mesh_bits.h"
#include "mesh_formats.h"
#include "mesh_join.h"

#include <inttypes.h>
#include <math.h>

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
        return mesh_refuse_byte(source, source->end, NULL, 0,
                                "the file ends within the %d bytes that begin a binary STL file",
                                HEADER_BYTES);
    const uint32_t facets = word_at(source->begin + COUNT_AT);
    return mesh_refuse_byte(source, source->begin + COUNT_AT, NULL, 0,
                            "%" PRIu32 " facets of binary STL are %" PRIu64
                            " bytes with their header, the file has %zu: it is cut off, or the "
                            "count is wrong",
                            facets, size_of(facets), size);
}

static bool read_vertex(struct mesh_join *join, size_t facet, unsigned *index)
{
    struct mesh_source *source = join->build->source;
    double position[3];
    for (int axis = 0; axis < 3; axis++) {
        position[axis] = mesh_float(word_at(source->at));
        if (!isfinite(position[axis]))
            return mesh_refuse_byte(source, source->at, "face", facet, "%c is not finite",
                                    "xyz"[axis]);
        source->at += FLOAT_BYTES;
    }
    return mesh_join_vertex(join, position, index);
}

static bool read_facets(struct mesh_join *join)
{
    struct mesh_source *source = join->build->source;
    source->at = source->begin + HEADER_BYTES;
    for (size_t facet = 0; source->at < source->end; facet++) {
        const unsigned char *begin = source->at;
        unsigned corner[3];
        source->at += NORMAL_BYTES;
        for (int i = 0; i < 3; i++)
            if (!read_vertex(join, facet, &corner[i]))
                return false;
        if (!mesh_add_face(join->build, corner))
            return false;
        source->at = begin + FACET_BYTES;
        mesh_tell(source);
    }
    return true;
}

bool mesh_stl_binary(struct mesh_source *source, struct mesh *out)
{
    struct mesh_build build = {.source = source, .mesh = out};
    struct mesh_join join;
    if (!mesh_is_stl_binary(source))
        return refuse_size(source);
    mesh_join_open(&join, &build);
    const bool good = read_facets(&join);
    mesh_join_close(&join);
    mesh_fit(&build);
    return good;
}
