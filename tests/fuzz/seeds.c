/* Writes what fuzzing begins with into FOLDER/TARGET/: good messages of every type, each with
 * something that the others lack; talks with the service; logs; meshes; robots. Scenes in JSON are
 * copied from the tree. */
#include "seeds.h"

#include "fuzz.h"
#include "geometry_write.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char *folder;

void seeds_write(const char *target, const char *name, const unsigned char *bytes, size_t size)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, target);
    mkdir(path, 0777); /* it may exist */
    snprintf(path, sizeof path, "%s/%s/%s", folder, target, name);
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file) != 0) {
        perror(path);
        exit(1);
    }
}

/* ---- Placements ---- */

/* [dim] */
static const double edges[][FMB_COMPONENTS_MAX] = {
    [2] = {1, 0, 0, 1},
    [3] = {1, 0, 0, 0, 1, 0, 0, 0, 1},
};

/* Memory of geometries, never reused. */
static unsigned char *take_bytes(void)
{
    static unsigned char bytes[4096][4 * GEOMETRY_FRAME_BYTES_MAX];
    static size_t used;
    FUZZ_CHECK(used < sizeof bytes / sizeof *bytes);
    return bytes[used++];
}

struct query_placement seeds_body(int64_t id, int shape, int dim, const double *components)
{
    unsigned char *bytes = take_bytes();
    const int numbers = geometry_number_count(dim, shape, 0);
    struct plain_frame frame = {.shape = shape};
    memcpy(frame.components, components, (size_t) (numbers - dim) * sizeof(double));
    return (struct query_placement){.placed.id = id, .body = geometry_write(dim, &frame, bytes)};
}

/* A body of a box and two frames more, away from its origin. */
static struct query_placement several(int64_t id, int dim)
{
    unsigned char *bytes = take_bytes();
    struct query_placement out = {.placed.id = id, .body.dim = dim, .body.frame_count = 3};
    struct plain_frame frames[3] = {{.shape = FMB_BOX, .components = {1, 0.5, 0}},
                                    {.shape = FMB_CUBOID, .origin = {0, 1}},
                                    {.shape = FMB_TETRAHEDRON, .origin = {-2, 0.25}}};
    for (int i = 0; i < 3; i++) {
        if (i > 0)
            memcpy(frames[i].components, edges[dim], (size_t) (dim * dim) * sizeof(double));
        out.body.number_count += geometry_number_count(dim, frames[i].shape, 0);
    }
    out.body = geometry_write_frames(dim, frames, 3, bytes);
    return out;
}

struct query_placement seeds_placement(int64_t id, int shape, int dim, double at, double speed)
{
    static const double size[FMB_DIM_MAX] = {1, 1, 1};
    struct query_placement out = seeds_body(id, shape, dim, shape == FMB_BOX ? size : edges[dim]);
    for (int axis = 0; axis < dim; axis++)
        out.placed.position[axis] = at;
    out.velocity_count = speed != 0 ? dim : 0;
    out.placed.velocity[0] = speed;
    return out;
}

struct handle seeds_handle(const struct query_placement *placement)
{
    struct hasher *hasher = hasher_create();
    FUZZ_CHECK(hasher);
    const struct handle handle = hasher_handle(hasher, placement->body.bytes, placement->body.size);
    hasher_destroy(hasher);
    return handle;
}

struct query_placement seeds_by_handle(struct query_placement placement)
{
    const struct handle handle = seeds_handle(&placement);
    placement.body = geometry_named(placement.body.dim, &handle);
    return placement;
}

/* ---- Queries ---- */

struct pair_query seeds_pair(struct query_placement a, struct query_placement b, int32_t method,
                             int32_t want)
{
    static int64_t sequence_number;
    return (struct pair_query){.utime = 1,
                               .client_id = 2,
                               .sequence_number = ++sequence_number,
                               .duration = 1,
                               .method = method,
                               .want = want,
                               .placement = {a, b}};
}

enum { BOX = FMB_WANT_BOX, CERTIFICATE = FMB_WANT_CERTIFICATE };

/* In place of a shape. */
enum { SEVERAL = 0 };

static const struct {
    const char *name;
    int shape[2], dim;
    double at, speed;
    int32_t method, want;
    double turn; /* z of the second orientation; 0: none */
} pairs[SEEDS_PAIRS] = {
    {"cubes", {FMB_CUBOID, FMB_CUBOID}, 3, 0.5, 0, 0, 0, 0},
    {"touching", {FMB_CUBOID, FMB_TETRAHEDRON}, 3, 1, 0, 0, BOX, 0},
    {"moving", {FMB_TETRAHEDRON, FMB_TETRAHEDRON}, 3, 0.25, -2, 4, BOX | CERTIFICATE, 0},
    {"faces", {FMB_FACE, FMB_FACE}, 3, 0, 0, 1, BOX | CERTIFICATE, 0},
    {"plate", {FMB_FACE, FMB_CUBOID}, 3, -0.5, 3, 0, BOX, 0},
    {"apart", {FMB_CUBOID, FMB_CUBOID}, 3, 5, 0, 2, BOX, 0},
    {"squares", {FMB_CUBOID, FMB_CUBOID}, 2, 0.5, 1, 3, 0, 0},
    {"triangles", {FMB_TETRAHEDRON, FMB_TETRAHEDRON}, 2, 0.5, 0, 0, BOX | CERTIFICATE, 0},
    {"boxes", {FMB_BOX, FMB_BOX}, 3, 0.5, 0, 0, BOX | CERTIFICATE, 1},
    {"rectangles", {FMB_BOX, FMB_TETRAHEDRON}, 2, 0.5, 1, 0, BOX, -0.1},
    {"several", {SEVERAL, FMB_FACE}, 3, 0.5, 1, 0, BOX, 0.3},
    {"both-several", {SEVERAL, SEVERAL}, 2, 0.5, 0, 1, 0, 1e-9},
};

static struct query_placement place(int i, int f)
{
    const int shape = pairs[i].shape[f], dim = pairs[i].dim;
    struct query_placement out =
        shape == SEVERAL ? several(1 + f, dim) : seeds_placement(1 + f, shape, dim, 0, 0);
    if (f == 0)
        return out;
    for (int axis = 0; axis < dim; axis++)
        out.placed.position[axis] = pairs[i].at;
    out.velocity_count = pairs[i].speed != 0 ? dim : 0;
    out.placed.velocity[0] = pairs[i].speed;
    out.placed.orientation_count = pairs[i].turn != 0 ? 2 * (dim - 1) : 0;
    out.placed.orientation[0] = out.placed.orientation_count ? 1 : 0;
    out.placed.orientation[dim == 2 ? 1 : 3] = pairs[i].turn;
    return out;
}

struct pair_query seeds_pair_number(int i)
{
    return seeds_pair(place(i, 0), place(i, 1), pairs[i].method, pairs[i].want);
}

const char *seeds_pair_name(int i)
{
    return pairs[i].name;
}

const struct scene_query *seeds_scene(int placements, int32_t which, int32_t want)
{
    static struct scene_query query;
    static int64_t sequence_number = 100;
    const int dim = placements % 2 ? 2 : 3;
    memset(&query, 0, sizeof query);
    query.client_id = 2;
    query.sequence_number = ++sequence_number;
    query.duration = 1;
    query.which = which;
    query.want = want;
    query.placement_count = placements;
    query.split = which == FMB_PAIRS_ACROSS ? placements / 2 : 0;
    for (int i = 0; i < placements; i++)
        query.placement[i] = seeds_placement(i, 1 + i % dim, dim, i * 0.5, i % 3 == 2);
    query.index_count = which == FMB_PAIRS_LISTED && placements > 0 ? 2 * (placements - 1) : 0;
    for (int i = 0; i < query.index_count / 2; i++) {
        query.pair[i][0] = (unsigned) i;
        query.pair[i][1] = (unsigned) i + 1;
    }
    query.ignored_count = which != FMB_PAIRS_LISTED && placements > 3 ? 4 : 0;
    query.ignored[0][0] = 2;
    query.ignored[0][1] = 3;
    query.ignored[1][0] = 1; /* these overlap */
    return &query;
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: %s FOLDER\n", argv[0]);
        return 2;
    }
    folder = argv[1];
    seeds_messages();
    seeds_talks();
    seeds_replays();
    seeds_logs();
    seeds_meshes();
    seeds_robots();
    return 0;
}
