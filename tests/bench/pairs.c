#include "pairs.h"

#include "trial.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *get(size_t count, size_t size)
{
    void *memory = calloc(count ? count : 1, size);
    if (!memory) {
        fputs("bench: no memory\n", stderr);
        exit(1);
    }
    return memory;
}

struct pairs pairs_draw(const struct family *family, const struct cell *cell, size_t count,
                        uint64_t seed)
{
    struct pairs out = {count, get(count, sizeof *out.pair), get(2 * count, sizeof *out.body)};
    struct draw draw = cell_draw(seed, family->name, cell, 0);
    for (size_t i = 0; i < count; i++) {
        struct question question;
        struct trial trial;
        family_draw(family, cell, &draw, &question);
        trial_begin(&question, &trial);
        out.pair[i] = trial.pair[0];
        memcpy(&out.body[2 * i], trial.body, sizeof trial.body);
        out.pair[i].a.body = &out.body[2 * i];
        out.pair[i].b.body = &out.body[2 * i + 1];
    }
    return out;
}

/* The neighbours (i, j, k) that come after (0, 0, 0) in the order of rows. */
static bool comes_after(int i, int j, int k)
{
    return i > 0 || (i == 0 && (j > 0 || (j == 0 && k > 0)));
}

static struct fmb_frame cube_at(const struct fmb_body *cube, double pitch, int i, int j, int k)
{
    return (struct fmb_frame){.body = cube, .origin = {i * pitch, j * pitch, k * pitch}};
}

static void add_neighbours(struct pairs *pairs, double pitch, int side, const int at[3])
{
    for (int i = 0; i < 2; i++)
        for (int j = -1; j < 2; j++)
            for (int k = -1; k < 2; k++) {
                const int to[3] = {at[0] + i, at[1] + j, at[2] + k};
                bool inside = comes_after(i, j, k);
                for (int axis = 0; axis < 3; axis++)
                    inside = inside && to[axis] >= 0 && to[axis] < side;
                if (inside)
                    pairs->pair[pairs->count++] =
                        (struct fmb_pair){.a = cube_at(pairs->body, pitch, at[0], at[1], at[2]),
                                          .b = cube_at(pairs->body, pitch, to[0], to[1], to[2])};
            }
}

struct pairs pairs_of_grid(double pitch, int side)
{
    const double edges[9] = {pitch, 0, 0, 0, pitch, 0, 0, 0, pitch};
    const size_t cubes = (size_t) (side * side * side);
    struct pairs out = {0, get(13 * cubes, sizeof *out.pair), get(1, sizeof *out.body)};
    fmb_body_make(3, FMB_CUBOID, edges, 9, out.body);
    for (int i = 0; i < side; i++)
        for (int j = 0; j < side; j++)
            for (int k = 0; k < side; k++)
                add_neighbours(&out, pitch, side, (const int[3]){i, j, k});
    return out;
}

struct pairs pairs_in_contact(const struct pairs *pairs, bool in_contact)
{
    struct pairs out = {0, get(pairs->count, sizeof *out.pair), NULL};
    for (size_t i = 0; i < pairs->count; i++) {
        struct fmb_answer answer;
        fmb_decide(fmb_method_by_name("certified"), &pairs->pair[i], 0, &answer);
        if ((answer.verdict != FMB_SEPARATED) == in_contact)
            out.pair[out.count++] = pairs->pair[i];
    }
    return out;
}

void pairs_free(struct pairs *pairs)
{
    free(pairs->pair);
    free(pairs->body);
    *pairs = (struct pairs){0};
}
