#include "scene.h"

#include "allocate.h"
#include "complain.h"
#include "frame_numbers.h"
#include "keyed_hash.h"
#include "number.h"

#include <stdlib.h>
#include <string.h>

/* ---- Memory ---- */

void *scene_alloc(struct owned_scene *scene, size_t count, size_t size)
{
    scene->memory = allocate_grow(scene->memory, &scene->memory_capacity, scene->memory_count + 1,
                                  sizeof *scene->memory);
    return scene->memory[scene->memory_count++] = allocate(count, size);
}

const char *scene_text(struct owned_scene *scene, const char *text)
{
    return text && *text ? strcpy(scene_alloc(scene, strlen(text) + 1, 1), text) : NULL;
}

void scene_report_outside(const char *file, double outside)
{
    char text[NUMBER_TEXT_MAX];
    if (outside > 0) /* rounded up */
        complain("%s: hulls enclose its cylinders, and extend beyond them by at most %s", file,
                 number_short(outside * (1 + 1e-5), text));
}

void scene_clear(struct owned_scene *scene)
{
    for (size_t i = 0; i < scene->memory_count; i++)
        free(scene->memory[i]);
    free(scene->memory);
    memset(scene, 0, sizeof *scene);
}

/* ---- Bodies ---- */

static enum fmb_status make_frame(struct owned_scene *scene, const struct given_frame *given,
                                  struct fmb_frame *out)
{
    double *memory = NULL;
    if (given->shape == FMB_HULL)
        memory =
            scene_alloc(scene, fmb_hull_doubles(scene->dim, given->count / (size_t) scene->dim),
                        sizeof *memory);
    return frame_of_numbers(scene->dim, given->shape, given->by_vertices, given->radius,
                            given->numbers, given->count, &memory, out);
}

size_t scene_body_bytes(const struct given_frame *given, size_t count)
{
    size_t bytes = 0;
    for (size_t i = 0; i < count; i++)
        bytes += 1 + (given[i].by_vertices ? 4 : 0) + 8 * (given[i].count + (given[i].radius != 0));
    return bytes;
}

enum fmb_status scene_make_body(struct owned_scene *scene, const struct given_frame *given,
                                size_t count, const struct fmb_body **out, size_t *bad)
{
    struct fmb_body *body = scene_alloc(scene, 1, sizeof *body);
    struct fmb_frame one, *frames = count == 1 ? &one : scene_alloc(scene, count, sizeof one);
    *out = body;
    for (*bad = 0; *bad < count; ++*bad, given++) {
        const enum fmb_status status = make_frame(scene, given, &frames[*bad]);
        if (status != FMB_OK)
            return status;
    }
    return fmb_body_make_frames(frames, count, body);
}

/* ---- Ids ---- */

struct taken_id {
    int64_t id;
    bool changes; /* the placement gets another */
    UT_hash_handle hh;
};

size_t scene_free_ids(struct fmb_placement *placements, size_t count, bool anonymous)
{
    struct taken_id *taken = allocate(count, sizeof *taken), *table = NULL, *found;
    int64_t next = 1;
    size_t changed = 0;
    for (size_t i = 0; i < count; i++) {
        const int64_t id = taken[i].id = placements[i].id;
        HASH_FIND(hh, table, &taken[i].id, sizeof id, found);
        taken[i].changes = found || (id == 0 && anonymous);
        if (id != 0 && !found)
            HASH_ADD(hh, table, id, sizeof id, &taken[i]);
    }
    for (size_t i = 0; i < count; i++) {
        if (!taken[i].changes)
            continue;
        do
            HASH_FIND(hh, table, &next, sizeof next, found);
        while (found && next++);
        placements[i].id = next++;
        changed++;
    }
    HASH_CLEAR(hh, table);
    free(taken);
    return changed;
}

/* ---- Pairs ---- */

void scene_begin_ignored(struct owned_scene *scene)
{
    const size_t capacity =
        ignored_capacity(scene->scene.placement_count, scene->scene.ignored_count);
    ignored_begin(&scene->scene, scene_alloc(scene, capacity, sizeof(unsigned)), &scene->ignored);
}

bool scene_leaves_out(struct owned_scene *scene, unsigned a, unsigned b)
{
    return pair_is_within_group(&scene->scene, a, b) ||
           ignored_has(&scene->ignored, a < b ? a : b, a < b ? b : a);
}

bool scene_next_pair(struct owned_scene *scene, struct pair_cursor *cursor, unsigned out[2])
{
    return pair_next(&scene->scene, &scene->ignored, cursor, out);
}

bool scene_next_pair_before(struct owned_scene *scene, struct pair_cursor *cursor,
                            const unsigned until[2], unsigned out[2])
{
    const struct pair_cursor here = *cursor;
    if (!scene_next_pair(scene, cursor, out))
        return false;
    if (!until || (out[0] == until[0] && out[1] == until[1]))
        return !until;
    const bool is_past = scene->scene.which != FMB_PAIRS_LISTED &&
                         (out[0] > until[0] || (out[0] == until[0] && out[1] > until[1]));
    if (is_past)
        *cursor = here;
    return !is_past;
}

uint64_t scene_count_pairs(struct owned_scene *scene)
{
    struct pair_cursor cursor = {0};
    unsigned pair[2];
    uint64_t count = 0;
    if (scene->scene.which == FMB_PAIRS_LISTED)
        return scene->scene.pair_count;
    while (scene_next_pair(scene, &cursor, pair))
        count++;
    return count;
}
