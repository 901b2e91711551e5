#include "gap_pairs.h"

#include <math.h>
#include <stdlib.h>

enum { SHIFTS = 8 }; /* depths: the shortest way out may change on the way in */

static void solid_draw(struct draw *draw, enum fmb_shape shape, double x, struct solid *out)
{
    *out = (struct solid){.dim = 3, .shape = shape};
    for (int axis = 0; axis < 3; axis++) {
        out->origin[axis] = draw_uniform(draw, -0.5, 0.5);
        for (int c = 0; c < 3 && shape != FMB_BOX; c++)
            out->component[c][axis] = draw_uniform(draw, -0.5, 0.5);
        if (shape == FMB_BOX)
            out->component[axis][axis] = draw_uniform(draw, 0.1, 1);
    }
    out->origin[0] += x;
    if (shape != FMB_BOX)
        return;
    out->orientation_count = 4;
    for (int k = 0; k < 4; k++)
        out->orientation[k] = draw_uniform(draw, -1, 1);
}

static struct fmb_gap gap_of(const struct question *question)
{
    const struct solid *solid[2] = {&question->a, &question->b};
    struct fmb_body body[2];
    struct fmb_placement placement[2];
    struct fmb_answer answer;
    for (int side = 0; side < 2; side++) {
        double number[SOLID_NUMBERS_MAX];
        const int count = solid_numbers(solid[side], number);
        fmb_body_make(3, solid[side]->shape, number, (size_t) count, &body[side]);
        placement[side] = solid_placement(solid[side], &body[side]);
    }
    fmb_decide(fmb_method_default(), &placement[0], &placement[1], 0, FMB_WANT_GAP, &answer);
    return answer.gap;
}

/* Shifts b along the direction of the gap, which brings a separated pair to any distance at once.
 * Returns whether the target is reached. */
static bool shift(struct question *question, double target)
{
    for (int round = 0;; round++) {
        const struct fmb_gap gap = gap_of(question);
        if (fabs(gap.bounds[0] - target) <= 0.01 * fabs(target) &&
            fabs(gap.bounds[1] - target) <= 0.01 * fabs(target))
            return true;
        if (round == SHIFTS)
            return false;
        for (int axis = 0; axis < 3; axis++)
            question->b.origin[axis] += (target - gap.bounds[0]) * gap.direction[axis];
    }
}

static double diameter(const struct peer_solid *solid)
{
    double most = 0;
    for (int i = 0; i < solid->count; i++)
        for (int j = 0; j < i; j++) {
            double square = 0;
            for (int axis = 0; axis < 3; axis++) {
                const double way = solid->vertex[i][axis] - solid->vertex[j][axis];
                square += way * way;
            }
            most = square > most ? square : most;
        }
    return sqrt(most);
}

void gap_pairs_draw(const struct cell *cell, double target, size_t count, uint64_t seed,
                    struct gap_pairs *out)
{
    struct draw draw = cell_draw(seed, "gaps", cell, 0);
    struct question *question = scene_allocate(count, sizeof *question);
    for (size_t i = 0; i < count; i++)
        do {
            question[i].duration = 0;
            solid_draw(&draw, cell->shape[0], 0, &question[i].a);
            solid_draw(&draw, cell->shape[1], 3, &question[i].b);
        } while (!shift(&question[i], target));
    *out = (struct gap_pairs){.count = count,
                              .scene = scene_of_questions(question, count),
                              .pair = scene_allocate(count, sizeof *out->pair),
                              .size = scene_allocate(count, sizeof *out->size)};
    free(question);
    out->solid = scene_solids(&out->scene);
    for (size_t i = 0; i < count; i++) {
        out->pair[i][0] = (unsigned) i;
        out->pair[i][1] = (unsigned) (count + i);
        out->size[i] = fmax(diameter(&out->solid[i]), diameter(&out->solid[count + i]));
    }
}

void gap_pairs_free(struct gap_pairs *pairs)
{
    scene_free(&pairs->scene);
    free(pairs->pair);
    free(pairs->solid);
    free(pairs->size);
}
