#define _DEFAULT_SOURCE
#include "bench_scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <string.h>

#include "family.h"
#include "posed.h"

static void *or_end(void *memory)
{
    if (memory)
        return memory;
    fputs("bench: no memory\n", stderr);
    exit(EXIT_FAILURE);
}

void *scene_allocate(size_t count, size_t size)
{
    return or_end(calloc(count ? count : 1, size));
}

/* Many of them in huge pages, where the system has them: what is looked up at random is then not
 * looked for in the tables of pages too. */
static void *allocate_frames(size_t count, size_t frame)
{
    const size_t huge = (size_t) 1 << 21, size = (count ? count : 1) * frame;
    if (size < huge)
        return or_end(aligned_alloc(64, size));
    const size_t whole = (size + huge - 1) / huge * huge;
    void *frames = or_end(aligned_alloc(huge, whole));
#ifdef MADV_HUGEPAGE
    madvise(frames, whole, MADV_HUGEPAGE);
#endif
    return frames;
}

struct scene scene_empty(size_t count)
{
    return (struct scene){.count = count,
                          .prepared = allocate_frames(count, sizeof(struct fmb_prepared)),
                          .placement = scene_allocate(count, sizeof(struct fmb_placement)),
                          .body = scene_allocate(count, sizeof(struct fmb_body)),
                          .lean = allocate_frames(count, sizeof(struct lean_frame)),
                          .oriented = allocate_frames(count, sizeof(struct oriented))};
}

void scene_free(struct scene *scene)
{
    free(scene->prepared);
    free(scene->placement);
    free(scene->body);
    free(scene->lean);
    free(scene->oriented);
    *scene = (struct scene){.count = 0};
}

static void prepare(const struct scene *scene, size_t at)
{
    if (fmb_prepare(&scene->placement[at], 0, 1, &scene->prepared[at]) != FMB_OK) {
        fputs("bench: a frame is refused\n", stderr);
        exit(EXIT_FAILURE);
    }
    const struct fmb_placement *placement = &scene->placement[at];
    const struct fmb_frame *frame = fmb_body_frame(placement->body, 0);
    lean_place(frame, placement, &scene->lean[at]);
    if (frame->shape == FMB_BOX && frame->dim == 3)
        oriented_place(frame, placement, &scene->oriented[at]);
}

static void add(const struct solid *solid, struct scene *scene, size_t at)
{
    double number[SOLID_NUMBERS_MAX];
    const int count = solid_numbers(solid, number);
    fmb_body_make(solid->dim, solid->shape, number, (size_t) count, &scene->body[at]);
    scene->placement[at] = solid_placement(solid, &scene->body[at]);
    prepare(scene, at);
}

static struct scene draw_scene(const struct cell *cell, size_t bodies, uint64_t seed, bool posed)
{
    struct draw draw = cell_draw(seed, "scene", cell, 0);
    struct scene scene = scene_empty(bodies);
    const size_t half = bodies / 2;
    for (size_t i = 0; i < half; i++) {
        struct question question;
        if (posed)
            family_draw_posed(&draw, cell, &question);
        else
            family_draw_random(&draw, cell, &question);
        add(&question.a, &scene, i);
        add(&question.b, &scene, i + half);
    }
    return scene;
}

struct scene scene_draw(const struct cell *cell, size_t bodies, uint64_t seed)
{
    return draw_scene(cell, bodies, seed, false);
}

struct scene scene_draw_posed(const struct cell *cell, size_t bodies, uint64_t seed)
{
    return draw_scene(cell, bodies, seed, true);
}

struct scene scene_of_corners(const struct scene *posed)
{
    struct scene scene = scene_empty(posed->count);
    for (size_t at = 0; at < posed->count; at++) {
        const struct lean_frame *lean = &posed->lean[at];
        struct solid solid = {.dim = posed->body[at].dim,
                              .shape = lean->kind & LEAN_SIMPLEX ? FMB_TETRAHEDRON : FMB_CUBOID,
                              .moving = lean->kind & LEAN_MOVING};
        memcpy(solid.component, lean->component, sizeof solid.component);
        memcpy(solid.origin, lean->origin, sizeof solid.origin);
        memcpy(solid.velocity, lean->velocity, sizeof solid.velocity);
        add(&solid, &scene, at);
    }
    return scene;
}

struct scene scene_of_questions(const struct question *questions, size_t count)
{
    struct scene scene = scene_empty(2 * count);
    for (size_t i = 0; i < count; i++) {
        add(&questions[i].a, &scene, i);
        add(&questions[i].b, &scene, i + count);
    }
    return scene;
}

static void set_vertices(struct peer_solid *solid)
{
    const bool simplex = solid->count == solid->dim + 1;
    for (int v = 0; v < solid->count; v++) {
        memcpy(solid->vertex[v], solid->origin, sizeof solid->origin);
        for (int c = 0; c < solid->dim; c++)
            for (int axis = 0; axis < 3; axis++)
                if (simplex ? v == c + 1 : v >> c & 1)
                    solid->vertex[v][axis] += solid->component[c][axis];
    }
}

static void set_box(struct peer_solid *solid)
{
    memcpy(solid->centre, solid->origin, sizeof solid->origin);
    for (int c = 0; c < solid->dim; c++) {
        const double *component = solid->component[c];
        solid->size[c] = vector_length(component);
        for (int axis = 0; axis < solid->dim; axis++) {
            solid->axis[c][axis] = component[axis] / solid->size[c];
            solid->centre[axis] += component[axis] / 2;
        }
    }
}

struct peer_solid *scene_solids(const struct scene *scene)
{
    struct peer_solid *solids = scene_allocate(scene->count, sizeof *solids);
    for (size_t i = 0; i < scene->count; i++) {
        const struct lean_frame *lean = &scene->lean[i];
        const struct fmb_frame *frame = fmb_body_frame(scene->placement[i].body, 0);
        solids[i].dim = frame->dim;
        solids[i].box = frame->shape == FMB_BOX;
        solids[i].count = lean->kind & LEAN_SIMPLEX ? frame->dim + 1 : 1 << frame->dim;
        memcpy(solids[i].component, lean->component, sizeof lean->component);
        memcpy(solids[i].origin, lean->origin, sizeof lean->origin);
        memcpy(solids[i].velocity, lean->velocity, sizeof lean->velocity);
        set_vertices(&solids[i]);
        set_box(&solids[i]);
    }
    return solids;
}

static struct pairs pairs_of_size(size_t count)
{
    return (struct pairs){0, scene_allocate(count, 2 * sizeof(unsigned))};
}

struct pairs pairs_copy(const struct pairs *pairs)
{
    struct pairs copy = pairs_of_size(pairs->count);
    memcpy(copy.at, pairs->at, pairs->count * sizeof *pairs->at);
    copy.count = pairs->count;
    return copy;
}

void pairs_free(struct pairs *pairs)
{
    free(pairs->at);
    *pairs = (struct pairs){0, NULL};
}

struct pairs pairs_side_by_side(size_t count)
{
    struct pairs pairs = {2 * count, scene_allocate(2 * count, sizeof *pairs.at)};
    for (size_t i = 0; i < 2 * count; i++) {
        pairs.at[i][0] = (unsigned) (i % count);
        pairs.at[i][1] = (unsigned) (count + (i < count ? i : i + 1) % count);
    }
    return pairs;
}

static void draw_pair(const struct scene *scene, struct draw *draw, unsigned pair[2])
{
    const uint64_t half = scene->count / 2;
    pair[0] = (unsigned) (draw_bits(draw) % half);
    pair[1] = (unsigned) (half + draw_bits(draw) % half);
}

struct pairs pairs_draw(const struct scene *scene, size_t count, uint64_t seed)
{
    struct draw draw = {seed};
    struct pairs pairs = pairs_of_size(count);
    for (; pairs.count < count; pairs.count++)
        draw_pair(scene, &draw, pairs.at[pairs.count]);
    return pairs;
}

/* Random pairs in 3D are rarely in contact: one in dozens. */
struct pairs pairs_draw_of(const struct scene *scene, bool in_contact, size_t count, uint64_t seed)
{
    enum { CHUNK = 4096 };
    static unsigned char verdict[CHUNK];
    struct pairs out = pairs_of_size(count);
    while (out.count < count) {
        struct pairs some = pairs_draw(scene, CHUNK, seed++);
        const struct fmb_batch batch = {.frames = scene->prepared,
                                        .frame_count = scene->count,
                                        .pairs = (const unsigned(*)[2]) some.at,
                                        .pair_count = CHUNK,
                                        .duration = 1,
                                        .verdicts = verdict};
        fmb_decide_batch(&batch);
        for (size_t i = 0; i < CHUNK && out.count < count; i++)
            if ((verdict[i] != FMB_SEPARATED) == in_contact)
                memcpy(out.at[out.count++], some.at[i], sizeof some.at[i]);
        pairs_free(&some);
    }
    return out;
}
