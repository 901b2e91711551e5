#include "mesh_build.h"

#include <stdlib.h>
#include <string.h>

enum { ROOM_MIN = 64 };

/* On output: room for one more than count; or NULL and the error, and the memory is as it was. */
static void *grow(struct mesh_source *source, void *memory, size_t *room, size_t count, size_t size,
                  const char *what)
{
    const size_t wanted = *room < ROOM_MIN ? ROOM_MIN : 2 * *room;
    if (count < *room)
        return memory;
    if (count >= MESH_COUNT_MAX) {
        mesh_refuse_byte(source, source->at, NULL, 0, "more than %u %s", MESH_COUNT_MAX, what);
        return NULL;
    }
    void *grown = wanted > SIZE_MAX / size ? NULL : realloc(memory, wanted * size);
    if (grown)
        *room = wanted;
    else
        mesh_refuse_room(source, wanted, what);
    return grown;
}

bool mesh_add_vertex(struct mesh_build *build, const double position[3])
{
    struct mesh *mesh = build->mesh;
    void *room = grow(build->source, mesh->vertex, &build->vertex_room, mesh->vertex_count,
                      sizeof *mesh->vertex, "vertices");
    if (!room)
        return false;
    mesh->vertex = room;
    memcpy(mesh->vertex[mesh->vertex_count++], position, sizeof *mesh->vertex);
    return true;
}

bool mesh_add_face(struct mesh_build *build, const unsigned corner[3])
{
    struct mesh *mesh = build->mesh;
    void *room = grow(build->source, mesh->face, &build->face_room, mesh->face_count,
                      sizeof *mesh->face, "faces");
    if (!room)
        return false;
    mesh->face = room;
    memcpy(mesh->face[mesh->face_count++], corner, sizeof *mesh->face);
    return true;
}

/* Where it cannot be moved, it stays. */
static void *fit(void *memory, size_t count, size_t size)
{
    void *fitting = count > 0 ? realloc(memory, count * size) : NULL;
    return fitting ? fitting : memory;
}

void mesh_fit(struct mesh_build *build)
{
    struct mesh *mesh = build->mesh;
    mesh->vertex = fit(mesh->vertex, mesh->vertex_count, sizeof *mesh->vertex);
    mesh->face = fit(mesh->face, mesh->face_count, sizeof *mesh->face);
    build->vertex_room = mesh->vertex_count;
    build->face_room = mesh->face_count;
}
