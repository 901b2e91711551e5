/* The article's scene of meshes: one against its mirror image, mirrored in x and moved by (50, -10,
 * 0), from the file to the answer.
 *
 * On one core, in turns; medians. The whole is that of the program fmb, CPU time and elapsed; the
 * parts are those of this process. */
#include "child.h"
#include "machine.h"
#include "mesh_face.h"
#include "mesh_intersect.h"
#include "mesh_transform.h"
#include "stopwatch.h"
#include "sweep.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 15, SAMPLE = 4000000, BLOCK = 4096 };

static _Noreturn void fail(const char *what)
{
    fprintf(stderr, "bench-mesh: %s\n", what);
    exit(1);
}

/* ---- The scene ---- */

struct scene {
    const char *path, *scale;
    struct mesh mesh[2];
    double read_ns[ROUNDS];
};

static void place(const char *scale, int which, struct mesh *mesh)
{
    struct mesh_transform transform = {.count = which ? 3 : 1,
                                       .step = {{.kind = MESH_SCALE},
                                                {.kind = MESH_MIRROR, .axis = 0},
                                                {.kind = MESH_TRANSLATE, .number = {50, -10, 0}}}};
    for (int axis = 0; axis < 3; axis++)
        transform.step[0].number[axis] = strtod(scale, NULL);
    if (mesh_transform(&transform, mesh) != SIZE_MAX)
        fail("the mesh is too far out");
}

static void read_scene(struct scene *scene)
{
    char error[MESH_ERROR_MAX];
    for (int round = 0; round < ROUNDS; round++) {
        const double begin = stopwatch_now();
        for (int which = 0; which < 2; which++) {
            mesh_free(&scene->mesh[which]);
            if (!mesh_read(scene->path, MESH_TRIANGLES, NULL, &scene->mesh[which], error))
                fail(error);
            place(scene->scale, which, &scene->mesh[which]);
        }
        scene->read_ns[round] = stopwatch_now() - begin;
    }
}

static struct mesh_query question_of(const struct scene *scene, enum mesh_as as)
{
    return (struct mesh_query){.a = &scene->mesh[0], .b = &scene->mesh[1], .as = as, .duration = 1};
}

/* ---- Parts ---- */

static void expect_same(const struct mesh_intersection *x, const struct mesh_intersection *y)
{
    bool same = x->count == y->count;
    for (size_t i = 0; same && i < x->count; i++)
        same = x->pair[i].a == y->pair[i].a && x->pair[i].b == y->pair[i].b &&
               x->pair[i].verdict == y->pair[i].verdict;
    if (!same)
        fail("the exact method says otherwise");
}

static void meet(const struct mesh_query *question, struct mesh_intersection *out)
{
    if (mesh_intersect(question, out) != FMB_OK)
        fail("the meshes could not be queried");
}

static void bench_parts(const struct scene *scene, const char *name, enum mesh_as as)
{
    struct mesh_query question = question_of(scene, as);
    struct mesh_intersection meeting, exact;
    double build[ROUNDS], query[ROUNDS];
    for (int round = 0; round < ROUNDS; round++) {
        meet(&question, &meeting);
        build[round] = (double) meeting.build_ns;
        query[round] = (double) meeting.query_ns;
        if (round < ROUNDS - 1)
            mesh_intersection_free(&meeting);
    }
    question.method = fmb_method_by_name("exact");
    meet(&question, &exact);
    expect_same(&meeting, &exact);
    printf("%-12s  build %6.1f ms   query %6.1f ms   candidates %7" PRIu64
           "   pairs %5zu (%zu touch)   faces of A that meet B %zu   exact: the same\n",
           name, spread_of(build, ROUNDS).median / 1e6, spread_of(query, ROUNDS).median / 1e6,
           meeting.candidates, meeting.count, meeting.touching, meeting.faces[0]);
    mesh_intersection_free(&meeting);
    mesh_intersection_free(&exact);
}

static void bench_sweep(const struct scene *scene)
{
    double took[ROUNDS];
    uint64_t found = 0;
    for (int round = 0; round < ROUNDS; round++) {
        const double begin = stopwatch_now();
        found = sweep_pairs(&scene->mesh[0], &scene->mesh[1]);
        took[round] = stopwatch_now() - begin;
    }
    printf("sorted along x, of faces: %.1f ms for %" PRIu64 " candidates, none decided\n",
           spread_of(took, ROUNDS).median / 1e6, found);
}

/* ---- Every pair ---- */

/* The faces of both meshes. */
struct faces {
    struct mesh_placed_face *placed; /* the prepared frames refer to them */
    struct fmb_prepared *prepared;
};

static struct faces prepare_all(const struct scene *scene, enum mesh_as as)
{
    const size_t count = scene->mesh[0].face_count;
    const struct faces out = {malloc(2 * count * sizeof *out.placed),
                              aligned_alloc(64, 2 * count * sizeof *out.prepared)};
    if (!out.placed || !out.prepared)
        fail("no memory");
    for (size_t i = 0; i < 2 * count; i++)
        if (!mesh_face_place(&scene->mesh[i / count], as, (unsigned) (i % count), NULL,
                             &out.placed[i]) ||
            fmb_prepare(&out.placed[i].placement, 0, 1, &out.prepared[i]) != FMB_OK)
            fail("a face cannot be prepared");
    return out;
}

/* Faces of A one after the other, each with so many of B that follow each other: what going through
 * all of them is like. */
static double every_pair_ns(const struct scene *scene, enum mesh_as as)
{
    static unsigned pair[BLOCK][2];
    static unsigned char verdict[BLOCK];
    const size_t count = scene->mesh[0].face_count;
    const struct faces faces = prepare_all(scene, as);
    double took = 0;
    size_t b = 0, a = 0;
    for (size_t done = 0; done < SAMPLE; done += BLOCK) {
        for (size_t i = 0; i < BLOCK; i++, b = (b + 1) % count) {
            pair[i][0] = (unsigned) a;
            pair[i][1] = (unsigned) (count + b);
        }
        a = (a + count / 977 + 1) % count;
        const struct fmb_batch batch = {.frames = faces.prepared,
                                        .frame_count = 2 * count,
                                        .pairs = (const unsigned(*)[2]) pair,
                                        .pair_count = BLOCK,
                                        .duration = 1,
                                        .verdicts = verdict};
        const double begin = stopwatch_now();
        if (fmb_decide_batch(&batch) != FMB_OK)
            fail("the batch refused");
        took += stopwatch_now() - begin;
    }
    free(faces.prepared);
    free(faces.placed);
    return took / (double) ((SAMPLE + BLOCK - 1) / BLOCK * BLOCK);
}

static void bench_every_pair(const struct scene *scene, const char *name, enum mesh_as as)
{
    const double each = every_pair_ns(scene, as), count = (double) scene->mesh[0].face_count;
    printf(
        "every pair, as %s: %.2f ns each in the batch, of %d pairs that were decided: %.1f s for "
        "all %.3g\n",
        name, each, (int) SAMPLE, each * count * count / 1e9, count * count);
}

/* ---- The whole ---- */

static void bench_whole(const char *name, const char *const *arguments, double faces)
{
    double cpu[ROUNDS], elapsed[ROUNDS], most = 0;
    for (int round = 0; round < ROUNDS; round++) {
        const struct child child = child_run(arguments);
        cpu[round] = child.cpu_ns;
        elapsed[round] = child.elapsed_ns;
        most = child.most_bytes;
    }
    printf("fmb mesh, %-12s %7.1f ms of CPU, %7.1f ms elapsed, %6.0f bytes a face at most\n", name,
           spread_of(cpu, ROUNDS).median / 1e6, spread_of(elapsed, ROUNDS).median / 1e6,
           most / faces);
}

/* The program's own pages are in it: the smallest first. */
static void bench_wholes(const char *fmb, const struct scene *scene)
{
    const double faces = (double) scene->mesh[0].face_count;
    const char *path = scene->path, *scale = scene->scale;
    const char *of_faces[] = {fmb,   "mesh",     path, "--scale",     scale,      path, "--scale",
                              scale, "--mirror", "x",  "--translate", "50,-10,0", NULL};
    const char *tetrahedra[] = {fmb,        "mesh", "--as",        "tetrahedra", path,
                                "--scale",  scale,  path,          "--scale",    scale,
                                "--mirror", "x",    "--translate", "50,-10,0",   NULL};
    bench_whole("faces", of_faces, 2 * faces);
    bench_whole("tetrahedra", tetrahedra, 2 * faces);
}

int main(int argc, char **argv)
{
    char cpu[MACHINE_TEXT_MAX];
    if (argc != 4) {
        fprintf(stderr, "usage: bench-mesh FMB MESH SCALE\n");
        return 2;
    }
    struct scene scene = {.path = argv[2], .scale = argv[3]};
    stopwatch_pin();
    read_scene(&scene);
    printf("%s, %s\n%s, %zu faces, against its mirror image\n", machine_cpu(cpu),
           machine_compiler(), scene.path, scene.mesh[0].face_count);
    bench_wholes(argv[1], &scene);
    printf("read and placed, both: %.1f ms\n", spread_of(scene.read_ns, ROUNDS).median / 1e6);
    bench_parts(&scene, "faces", MESH_FACES);
    bench_parts(&scene, "tetrahedra", MESH_TETRAHEDRA);
    bench_sweep(&scene);
    bench_every_pair(&scene, "faces", MESH_FACES);
    bench_every_pair(&scene, "tetrahedra", MESH_TETRAHEDRA);
    mesh_free(&scene.mesh[0]);
    mesh_free(&scene.mesh[1]);
    return 0;
}
