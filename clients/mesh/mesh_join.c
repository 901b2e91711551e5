#include "mesh_join.h"

#include "query.h"
#include "random_id.h"

#include <stdlib.h>
#include <string.h>

enum { SLOTS_MIN = 256 };

static uint64_t bits_of(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* Coordinates of meshes differ in few bits, often the first ones: a product moves what differs to
 * the front, from where a shift takes it back to the bits that slots are counted with. */
static size_t hash_of(uint64_t factor, const double position[3])
{
    uint64_t hash = 0;
    for (int axis = 0; axis < 3; axis++) {
        hash = (hash ^ bits_of(position[axis])) * factor;
        hash ^= hash >> 32;
    }
    return (size_t) hash;
}

/* The slot of that position, or the free one where it belongs. */
static size_t find(const struct mesh_join *join, const double position[3])
{
    const double(*vertex)[3] = (const double(*)[3]) join->build->mesh->vertex;
    size_t at = hash_of(join->factor, position) & (join->slot_count - 1);
    while (join->slot[at] != 0 && memcmp(vertex[join->slot[at] - 1], position, sizeof *vertex) != 0)
        at = (at + 1) & (join->slot_count - 1);
    return at;
}

static bool make_slots(struct mesh_join *join)
{
    const struct mesh *mesh = join->build->mesh;
    if (!join->slot)
        join->factor = query_id_mix(random_id()) | 1;
    if (join->slot && mesh->vertex_count < join->slot_count / 2)
        return true;
    const size_t wanted = join->slot ? 2 * join->slot_count : SLOTS_MIN;
    unsigned *slot = wanted > SIZE_MAX / sizeof *slot ? NULL : calloc(wanted, sizeof *slot);
    if (!slot)
        return mesh_refuse_room(join->build->source, wanted, "vertices");
    free(join->slot);
    join->slot = slot;
    join->slot_count = wanted;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        slot[find(join, mesh->vertex[i])] = (unsigned) i + 1;
    return true;
}

bool mesh_join_vertex(struct mesh_join *join, const double position[3], unsigned *index)
{
    /* -0 + 0 is 0; all else plus 0 is what it was. */
    const double clean[3] = {position[0] + 0.0, position[1] + 0.0, position[2] + 0.0};
    if (!make_slots(join))
        return false;
    const size_t at = find(join, clean);
    if (join->slot[at] == 0) {
        if (!mesh_add_vertex(join->build, clean))
            return false;
        join->slot[at] = (unsigned) join->build->mesh->vertex_count;
    }
    *index = join->slot[at] - 1;
    return true;
}

void mesh_join_free(struct mesh_join *join)
{
    free(join->slot);
    join->slot = NULL;
    join->slot_count = 0;
}
