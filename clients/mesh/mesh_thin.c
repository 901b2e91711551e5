#include "mesh_thin.h"

#include "allocate.h"

#include <stdlib.h>
#include <string.h>

static const unsigned none = (unsigned) -1; /* no vertex: there are fewer (mesh.h) */

/* Of each role but the last: of so many faces one is kept. */
struct steps {
    size_t of[MESH_THIN_NEEDED];
};

/* Faces that are kept, by their roles. */
struct tally {
    size_t of[MESH_THIN_NEEDED + 1];
};

static void keep_vertices(const unsigned face[3], struct mesh_thinned *kept)
{
    for (int corner = 0; corner < 3; corner++) {
        unsigned *place = &kept->place[face[corner]];
        if (*place != none)
            continue;
        *place = (unsigned) kept->vertex_count;
        kept->vertex[kept->vertex_count++] = face[corner];
    }
}

static void keep(const struct mesh *mesh, const unsigned char *role, const struct steps *steps,
                 struct mesh_thinned *kept, struct tally *tally)
{
    size_t seen[MESH_THIN_NEEDED] = {0};
    kept->face_count = kept->vertex_count = 0;
    memset(kept->place, 0xff, mesh->vertex_count * sizeof *kept->place);
    for (size_t f = 0; f < mesh->face_count; f++) {
        if (role[f] != MESH_THIN_NEEDED && seen[role[f]]++ % steps->of[role[f]] != 0)
            continue;
        kept->face[kept->face_count++] = (unsigned) f;
        keep_vertices(mesh->face[f], kept);
        tally->of[role[f]]++;
    }
}

static size_t bytes(const struct mesh *mesh, const struct mesh_thinned *kept,
                    const struct mesh_thin_cost *cost)
{
    const size_t number = kept->face_count < mesh->face_count ? cost->number : 0;
    return kept->face_count * (cost->face + number) + kept->vertex_count * cost->vertex;
}

/* What takes so many times too much is taken so many times less often. Faces that are further apart
 * have fewer vertices in common, and what is not thinned stays, so that it seldom goes too far. */
static size_t longer(size_t step, size_t used, size_t limit)
{
    const double times = (double) used / (double) (limit + 1);
    return step + 1 + (size_t) ((times > 1 ? times - 1 : 0) * (double) step * 0.9);
}

/* What is thinned next: what matters least and is not yet as thin as it may get. One face of each
 * mesh is always kept. */
static int next_to_thin(const struct tally *tally)
{
    static const size_t least[] = {
        [MESH_THIN_REST] = 20000, [MESH_THIN_BESIDE] = 2, [MESH_THIN_MET] = 2};
    int role = MESH_THIN_REST;
    while (role < MESH_THIN_NEEDED && tally->of[role] <= least[role])
        role++;
    return role;
}

void mesh_thin(const struct mesh *const mesh[2], int count, unsigned char *const role[2],
               const struct mesh_thin_cost *cost, size_t limit, struct mesh_thinned kept[2])
{
    struct steps steps = {{1, 1, 1}};
    for (int m = 0; m < count; m++) {
        kept[m].face = allocate(mesh[m]->face_count, sizeof *kept[m].face);
        kept[m].vertex = allocate(mesh[m]->vertex_count, sizeof *kept[m].vertex);
        kept[m].place = allocate(mesh[m]->vertex_count, sizeof *kept[m].place);
    }
    for (;;) {
        struct tally tally = {{0}};
        size_t used = 0;
        for (int m = 0; m < count; m++) {
            keep(mesh[m], role[m], &steps, &kept[m], &tally);
            used += bytes(mesh[m], &kept[m], cost);
        }
        const int thinner = next_to_thin(&tally);
        if (used <= limit || thinner == MESH_THIN_NEEDED)
            return;
        steps.of[thinner] = longer(steps.of[thinner], used, limit);
    }
}

void mesh_thinned_free(struct mesh_thinned *kept)
{
    free(kept->face);
    free(kept->vertex);
    free(kept->place);
    memset(kept, 0, sizeof *kept);
}
