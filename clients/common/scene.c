#include "scene.h"

#include "allocate.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Bodies ---- */

struct scene_body scene_body_copy(const struct scene_body *body)
{
    struct scene_body copy = *body;
    if (!body->frames)
        return copy;
    copy.frames = allocate(body->body.frame_count, sizeof *copy.frames);
    memcpy(copy.frames, body->frames, body->body.frame_count * sizeof *copy.frames);
    copy.body.frames = copy.frames;
    return copy;
}

void scene_body_clear(struct scene_body *body)
{
    free(body->frames);
    memset(body, 0, sizeof *body);
}

struct fmb_placement scene_placement(const struct scene_body *body)
{
    struct fmb_placement placement = {.body = &body->body,
                                      .orientation_count = body->orientation_count};
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
        if (kept == 0 || compare_pairs(&ignored[i], &ignored[kept - 1]) != 0)
            ignored[kept++] = ignored[i];
    scene->ignored_count = kept;
}

bool scene_ignores(const struct scene *scene, struct scene_pair pair)
{
    const struct scene_pair key = in_order(pair);
    return scene->ignored_count > 0 &&
           bsearch(&key, scene->ignored, scene->ignored_count, sizeof key, compare_pairs) != NULL;
}

uint64_t scene_count_pairs(const struct scene *scene)
{
    uint64_t count = scene->body_count;
    if (!scene->all_pairs)
        return scene->pair_count;
    return count < 2 ? 0 : count * (count - 1) / 2 - scene->ignored_count;
}

/* Whether the pair is ignored. Ignored pairs are in the order of the iteration. */
static bool is_next_ignored(const struct scene *scene, const struct scene_cursor *cursor)
{
    return cursor->next < scene->ignored_count && scene->ignored[cursor->next].a == cursor->a &&
           scene->ignored[cursor->next].b == cursor->b;
}

bool scene_next_pair(const struct scene *scene, struct scene_cursor *cursor, struct scene_pair *out)
{
    if (!scene->all_pairs) {
        if (cursor->next == scene->pair_count)
            return false;
        *out = scene->pair[cursor->next++];
        return true;
    }
    do {
        if (++cursor->b >= scene->body_count)
            cursor->b = ++cursor->a + 1;
        if (cursor->b >= scene->body_count)
            return false;
    } while (is_next_ignored(scene, cursor) && ++cursor->next);
    *out = (struct scene_pair){cursor->a, cursor->b};
    return true;
}
