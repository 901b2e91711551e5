#include "mesh_thin.h"

#include "allocate.h"

#include <stdlib.h>
#include <string.h>

static const unsigned none = (unsigned) -1; /* no vertex: there are fewer (mesh.h) */

/* One mesh while it is thinned. */
struct thinning {
    const struct mesh *mesh;
    const unsigned char *role;
    size_t step[MESH_THIN_NEEDED];      /* of so many faces of a role one is kept */
    size_t tally[MESH_THIN_NEEDED + 1]; /* that are, of each role */
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

static void keep(struct thinning *of, struct mesh_thinned *kept)
{
    size_t seen[MESH_THIN_NEEDED] = {0};
    kept->face_count = kept->vertex_count = 0;
    memset(of->tally, 0, sizeof of->tally);
    memset(kept->place, 0xff, of->mesh->vertex_count * sizeof *kept->place);
    for (size_t f = 0; f < of->mesh->face_count; f++) {
        const unsigned role = of->role[f];
        if (role != MESH_THIN_NEEDED && seen[role]++ % of->step[role] != 0)
            continue;
        kept->face[kept->face_count++] = (unsigned) f;
        keep_vertices(of->mesh->face[f], kept);
        of->tally[role]++;
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

/* Makes one step longer, of what matters least and is not yet as thin as it may get, in the mesh
 * that has more of it; false: all is as thin. One face of each role is always kept. */
static bool thin_more(struct thinning of[2], int count, size_t used, size_t limit)
{
    static const size_t least[] = {
        [MESH_THIN_REST] = 10000, [MESH_THIN_BESIDE] = 1, [MESH_THIN_MET] = 1};
    for (int role = MESH_THIN_REST; role < MESH_THIN_NEEDED; role++) {
        const int more = count > 1 && of[1].tally[role] > of[0].tally[role];
        if (of[more].tally[role] <= least[role])
            continue;
        of[more].step[role] = longer(of[more].step[role], used, limit);
        return true;
    }
    return false;
}

void mesh_thin(const struct mesh *const mesh[2], int count, unsigned char *const role[2],
               const struct mesh_thin_cost *cost, size_t limit, struct mesh_thinned kept[2])
{
    struct thinning of[2];
    size_t used;
    for (int m = 0; m < count; m++) {
        of[m] = (struct thinning){.mesh = mesh[m], .role = role[m], .step = {1, 1, 1}};
        kept[m].face = allocate(mesh[m]->face_count, sizeof *kept[m].face);
        kept[m].vertex = allocate(mesh[m]->vertex_count, sizeof *kept[m].vertex);
        kept[m].place = allocate(mesh[m]->vertex_count, sizeof *kept[m].place);
    }
    do {
        used = 0;
        for (int m = 0; m < count; m++) {
            keep(&of[m], &kept[m]);
            used += bytes(mesh[m], &kept[m], cost);
        }
    } while (used > limit && thin_more(of, count, used, limit));
}

void mesh_thinned_free(struct mesh_thinned *kept)
{
    free(kept->face);
    free(kept->vertex);
    free(kept->place);
    memset(kept, 0, sizeof *kept);
}
