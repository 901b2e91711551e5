#include "same_scene.h"

#include "same.h"

#include <stdlib.h>
#include <string.h>

static bool same_frame(const struct fmb_frame *a, const struct fmb_frame *b)
{
    bool vertices[2];
    const size_t count = fmb_frame_numbers(a, &vertices[0], NULL, 0);
    if (a->dim != b->dim || a->shape != b->shape || !same_doubles(&a->radius, &b->radius, 1) ||
        fmb_frame_numbers(b, &vertices[1], NULL, 0) != count || vertices[0] != vertices[1])
        return false;
    double *numbers[2];
    for (int i = 0; i < 2; i++) {
        numbers[i] = fuzz_room(count * sizeof *numbers[i]);
        fmb_frame_numbers(i ? b : a, &vertices[i], numbers[i], count);
    }
    bool same = same_doubles(numbers[0], numbers[1], count);
    free(numbers[0]);
    free(numbers[1]);
    if (a->shape == FMB_HULL)
        return same;
    same = same && a->count == b->count && same_doubles(a->origin, b->origin, FMB_DIM_MAX) &&
           same_doubles(a->centre, b->centre, FMB_DIM_MAX);
    for (int i = 0; i < FMB_DIM_MAX; i++)
        same = same && same_doubles(a->component[i], b->component[i], FMB_DIM_MAX);
    return same;
}

static bool same_name(const char *a, const char *b)
{
    return a && b ? strcmp(a, b) == 0 : a == b;
}

static bool same_placed(const struct fmb_placement *a, const struct fmb_placement *b)
{
    bool same = a->id == b->id && same_name(a->name, b->name) && a->group == b->group &&
                a->body->dim == b->body->dim && a->body->frame_count == b->body->frame_count &&
                a->orientation_count == b->orientation_count &&
                same_doubles(a->position, b->position, FMB_DIM_MAX) &&
                same_doubles(a->velocity, b->velocity, FMB_DIM_MAX) &&
                same_doubles(a->orientation, b->orientation, 4) && a->end_count == b->end_count &&
                same_doubles(a->end_position, b->end_position, FMB_DIM_MAX) &&
                same_doubles(a->end_orientation, b->end_orientation, 4);
    for (unsigned i = 0; same && i < a->body->frame_count; i++)
        same = same_frame(fmb_body_frame(a->body, i), fmb_body_frame(b->body, i));
    return same;
}

/* Whether both have the same pairs that are to be decided. */
static bool same_decided(struct owned_scene *a, struct owned_scene *b)
{
    struct pair_cursor of_a = {0}, of_b = {0};
    unsigned p[2], q[2];
    while (scene_next_pair(a, &of_a, p))
        if (!scene_next_pair(b, &of_b, q) || p[0] != q[0] || p[1] != q[1])
            return false;
    return !scene_next_pair(b, &of_b, q);
}

bool same_scene(struct owned_scene *left, struct owned_scene *right)
{
    const struct fmb_scene *a = &left->scene, *b = &right->scene;
    bool same = same_name(a->label, b->label) && left->dim == right->dim &&
                same_doubles(&a->duration, &b->duration, 1) && a->margin == b->margin &&
                a->placement_count == b->placement_count && a->which == b->which;
    for (size_t i = 0; same && i < a->placement_count; i++)
        same = same_placed(&a->placements[i], &b->placements[i]);
    return same && same_decided(left, right);
}
