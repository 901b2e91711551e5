#include "scene.h"

#include "allocate.h"

#include <stdlib.h>
#include <string.h>

struct scene_id {
    int64_t id;
    size_t index;
};

void scene_clear(struct scene *scene)
{
    free(scene->body);
    free(scene->pair);
    memset(scene, 0, sizeof *scene);
}

uint64_t scene_count_pairs(const struct scene *scene)
{
    uint64_t count = scene->body_count;
    if (!scene->all_pairs)
        return scene->pair_count;
    return count < 2 ? 0 : count * (count - 1) / 2;
}

static bool next_of_all(const struct scene *scene, struct scene_cursor *cursor)
{
    if (++cursor->b < scene->body_count)
        return true;
    cursor->b = ++cursor->a + 1;
    return cursor->b < scene->body_count;
}

bool scene_next_pair(const struct scene *scene, struct scene_cursor *cursor, struct scene_pair *out)
{
    if (!scene->all_pairs) {
        if (cursor->next == scene->pair_count)
            return false;
        *out = scene->pair[cursor->next++];
        return true;
    }
    if (!next_of_all(scene, cursor))
        return false;
    *out = (struct scene_pair){cursor->a, cursor->b};
    return true;
}

static struct fmb_frame fmb_frame_of(const struct scene_body *body)
{
    struct fmb_frame frame = {.body = &body->body, .moving = body->moving};
    memcpy(frame.origin, body->origin, sizeof frame.origin);
    memcpy(frame.velocity, body->velocity, sizeof frame.velocity);
    return frame;
}

struct fmb_pair scene_fmb_pair(const struct scene *scene, struct scene_pair pair)
{
    return (struct fmb_pair){.a = fmb_frame_of(&scene->body[pair.a]),
                             .b = fmb_frame_of(&scene->body[pair.b]),
                             .duration = scene->duration};
}

/* By id, then by index: of equal ids the first body comes first. */
static int compare(const void *left, const void *right)
{
    const struct scene_id *a = left, *b = right;
    if (a->id != b->id)
        return a->id < b->id ? -1 : 1;
    return (a->index > b->index) - (a->index < b->index);
}

void scene_ids_make(const struct scene *scene, struct scene_ids *out)
{
    out->count = scene->body_count;
    out->sorted = allocate(out->count, sizeof *out->sorted);
    for (size_t i = 0; i < out->count; i++)
        out->sorted[i] = (struct scene_id){scene->body[i].id, i};
    qsort(out->sorted, out->count, sizeof *out->sorted, compare);
}

void scene_ids_clear(struct scene_ids *ids)
{
    free(ids->sorted);
    memset(ids, 0, sizeof *ids);
}

bool scene_ids_find(const struct scene_ids *ids, int64_t id, size_t *index)
{
    size_t low = 0, high = ids->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (ids->sorted[middle].id < id)
            low = middle + 1;
        else
            high = middle;
    }
    if (low == ids->count || ids->sorted[low].id != id)
        return false;
    *index = ids->sorted[low].index;
    return true;
}

bool scene_ids_repeated(const struct scene_ids *ids, size_t *first, size_t *second)
{
    bool found = false;
    for (size_t i = 1; i < ids->count; i++) {
        const struct scene_id *before = &ids->sorted[i - 1], *here = &ids->sorted[i];
        if (before->id != here->id || (found && here->index > *second))
            continue;
        *first = before->index;
        *second = here->index;
        found = true;
    }
    return found;
}
