#include "scene.h"

#include "allocate.h"
#include "pair_number.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Bodies ---- */

enum fmb_status scene_body_make(int dim, size_t count, struct scene_body *body, size_t *bad)
{
    double number[GEOMETRY_FRAME_NUMBERS_MAX];
    *bad = 0;
    if (count == 1) {
        const struct geometry_frame *given = body->given;
        const size_t used = geometry_frame_numbers(dim, given, number);
        return (given->by_vertices ? fmb_body_make_vertices : fmb_body_make)(
            dim, given->shape, number, used, &body->body);
    }
    body->frames = allocate(count, sizeof *body->frames);
    for (; *bad < count; ++*bad) {
        const struct geometry_frame *given = &body->given[*bad];
        const size_t used = geometry_frame_numbers(dim, given, number);
        const enum fmb_status status =
            (given->by_vertices ? fmb_frame_make_vertices : fmb_frame_make)(
                dim, given->shape, number, used, &body->frames[*bad]);
        if (status != FMB_OK)
            return status;
    }
    return fmb_body_make_frames(body->frames, count, &body->body);
}

struct scene_body scene_body_copy(const struct scene_body *body)
{
    struct scene_body copy = *body;
    copy.given = NULL;
    if (!body->frames)
        return copy;
    copy.frames = allocate(body->body.frame_count, sizeof *copy.frames);
    memcpy(copy.frames, body->frames, body->body.frame_count * sizeof *copy.frames);
    copy.body.frames = copy.frames;
    return copy;
}

void scene_body_clear(struct scene_body *body)
{
    free(body->given);
    free(body->frames);
    memset(body, 0, sizeof *body);
}

struct fmb_placement scene_placement(const struct scene_body *body)
{
    struct fmb_placement placement = {
        .body = &body->body, .orientation_count = body->orientation_count, .group = body->group};
    memcpy(placement.position, body->position, sizeof placement.position);
    memcpy(placement.velocity, body->velocity, sizeof placement.velocity);
    memcpy(placement.orientation, body->orientation, sizeof placement.orientation);
    return placement;
}

const char *scene_label(const struct scene_body *body, char text[SCENE_LABEL_MAX])
{
    if (body->name[0])
        return body->name;
    snprintf(text, SCENE_LABEL_MAX, "%" PRId64, body->id);
    return text;
}

void scene_clear(struct scene *scene)
{
    for (size_t i = 0; i < scene->body_count; i++)
        scene_body_clear(&scene->body[i]);
    free(scene->body);
    free(scene->pair);
    free(scene->ignored);
    memset(scene, 0, sizeof *scene);
}

/* ---- Pairs ---- */

static int compare_pairs(const void *left, const void *right)
{
    const struct scene_pair *p = left, *q = right;
    if (p->a != q->a)
        return p->a < q->a ? -1 : 1;
    return (p->b > q->b) - (p->b < q->b);
}

static struct scene_pair in_order(struct scene_pair pair)
{
    return pair.a < pair.b ? pair : (struct scene_pair){pair.b, pair.a};
}

bool scene_is_within_group(const struct scene *scene, struct scene_pair pair)
{
    const int64_t group = scene->body[pair.a].group;
    return group != 0 && group == scene->body[pair.b].group;
}

void scene_sort_ignored(struct scene *scene)
{
    struct scene_pair *ignored = scene->ignored;
    size_t kept = 0;
    if (scene->ignored_count == 0)
        return;
    for (size_t i = 0; i < scene->ignored_count; i++)
        ignored[i] = in_order(ignored[i]);
    qsort(ignored, scene->ignored_count, sizeof *ignored, compare_pairs);
    for (size_t i = 0; i < scene->ignored_count; i++)
        if (!scene_is_within_group(scene, ignored[i]) &&
            (kept == 0 || compare_pairs(&ignored[i], &ignored[kept - 1]) != 0))
            ignored[kept++] = ignored[i];
    scene->ignored_count = kept;
}

bool scene_ignores(const struct scene *scene, struct scene_pair pair)
{
    const struct scene_pair key = in_order(pair);
    return scene_is_within_group(scene, pair) ||
           (scene->ignored_count > 0 &&
            bsearch(&key, scene->ignored, scene->ignored_count, sizeof key, compare_pairs) != NULL);
}

static int compare_groups(const void *left, const void *right)
{
    const int64_t a = *(const int64_t *) left, b = *(const int64_t *) right;
    return (a > b) - (a < b);
}

/* Returns the number of pairs within a group. */
static uint64_t count_grouped(const struct scene *scene)
{
    int64_t *group = allocate(scene->body_count, sizeof *group);
    uint64_t pairs = 0, before = 0;
    for (size_t i = 0; i < scene->body_count; i++)
        group[i] = scene->body[i].group;
    qsort(group, scene->body_count, sizeof *group, compare_groups);
    for (size_t i = 1; i < scene->body_count; i++) {
        before = group[i] != 0 && group[i] == group[i - 1] ? before + 1 : 0;
        pairs += before; /* of the bodies before this one, those of its group */
    }
    free(group);
    return pairs;
}

uint64_t scene_count_pairs(const struct scene *scene)
{
    const struct pair_numbers all = {.n = scene->body_count};
    if (!scene->all_pairs)
        return scene->pair_count;
    return pairs_total(all) - scene->ignored_count - count_grouped(scene);
}

/* Whether the pair is ignored; advances past it. Ignored pairs are in the order of the iteration.
 */
static bool skip_ignored(const struct scene *scene, struct scene_cursor *cursor,
                         struct scene_pair pair)
{
    const bool ignored = cursor->next < scene->ignored_count &&
                         compare_pairs(&scene->ignored[cursor->next], &pair) == 0;
    cursor->next += ignored;
    return ignored;
}

bool scene_next_pair(const struct scene *scene, struct scene_cursor *cursor, struct scene_pair *out)
{
    if (!scene->all_pairs) {
        if (cursor->next == scene->pair_count)
            return false;
        *out = scene->pair[cursor->next++];
        return true;
    }
    const struct pair_numbers all = {.n = scene->body_count};
    while (pair_find(all, &cursor->a, &cursor->b)) {
        *out = (struct scene_pair){cursor->a, cursor->b++};
        if (!skip_ignored(scene, cursor, *out) && !scene_is_within_group(scene, *out))
            return true;
    }
    return false;
}
