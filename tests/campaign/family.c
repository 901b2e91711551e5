#include "family.h"

#include <float.h>
#include <math.h>
#include <string.h>

static void random_pair(struct draw *draw, const struct family *family, const struct cell *cell,
                        struct question *out)
{
    (void) family;
    family_draw_random(draw, cell, out);
}

/* clang-format off */
static const struct family families[] = {
    {"random", "uniform numbers, as in the article", random_pair, .cells = 0},

    {"touch-vertex-vertex", "touching exactly, vertex on vertex", touching,
     .features = {0, 0, false}, .verdict = FMB_TOUCHING},
    {"touch-vertex-edge", "touching exactly, vertex on edge", touching,
     .features = {1, 0, false}, .verdict = FMB_TOUCHING},
    {"touch-vertex-face", "touching exactly, vertex on face", touching,
     .features = {2, 0, false}, .cells = FAMILY_3D, .verdict = FMB_TOUCHING},
    {"touch-edge-edge", "touching exactly, edge on edge", touching,
     .features = {1, 1, false}, .verdict = FMB_TOUCHING},
    {"touch-parallel-edges", "touching exactly, edges on one line", touching,
     .features = {1, 1, true}, .cells = FAMILY_3D, .verdict = FMB_TOUCHING},
    {"touch-edge-face", "touching exactly, edge on face", touching,
     .features = {2, 1, false}, .cells = FAMILY_3D, .verdict = FMB_TOUCHING},
    {"touch-face-face", "touching exactly, face on face", touching,
     .features = {2, 2, false}, .cells = FAMILY_3D, .verdict = FMB_TOUCHING},

    {"slide", "touching while it slides along an edge or a face", sliding,
     .cells = FAMILY_MOVING, .verdict = FMB_TOUCHING},
    {"graze", "touching in an instant, in passing", grazing,
     .cells = FAMILY_MOVING, .verdict = FMB_TOUCHING},
    {"arrive", "touching as the window ends", arriving,
     .cells = FAMILY_MOVING, .verdict = FMB_TOUCHING},
    {"leave", "touching as the window begins, then receding", leaving,
     .cells = FAMILY_MOVING, .verdict = FMB_TOUCHING},
    {"recede", "overlapping a little as the window begins, then receding", receding,
     .cells = FAMILY_MOVING},
    {"window-zero", "touching or nearly, T = 0", zero_window, .cells = FAMILY_MOVING},

    {"gap-1e-3", "a gap of 1e-3 of the size", apart, .amount = 1e-3},
    {"gap-1e-6", "a gap of 1e-6 of the size", apart, .amount = 1e-6},
    {"gap-1e-9", "a gap of 1e-9 of the size", apart, .amount = 1e-9},
    {"gap-1e-12", "a gap of 1e-12 of the size", apart, .amount = 1e-12},
    {"gap-1e-15", "a gap of 1e-15 of the size", apart, .amount = 1e-15},
    {"gap-1e-16", "a gap of 1e-16 of the size", apart, .amount = 1e-16},
    {"gap-ulp", "touching, then moved apart by 1 to 3 ulps of one number", ulps_apart,
     .amount = +1},

    {"overlap-1e-3", "an overlap of 1e-3 of the size", apart, .amount = -1e-3},
    {"overlap-1e-6", "an overlap of 1e-6 of the size", apart, .amount = -1e-6},
    {"overlap-1e-9", "an overlap of 1e-9 of the size", apart, .amount = -1e-9},
    {"overlap-1e-12", "an overlap of 1e-12 of the size", apart, .amount = -1e-12},
    {"overlap-1e-15", "an overlap of 1e-15 of the size", apart, .amount = -1e-15},
    {"overlap-1e-16", "an overlap of 1e-16 of the size", apart, .amount = -1e-16},
    {"overlap-ulp", "touching, then moved together by 1 to 3 ulps of one number", ulps_apart,
     .amount = -1},

    {"sliver-1e3", "thin plates, aspect 1e3, with small gaps and overlaps", slivers,
     .amount = 0x1p10, .features = {2, 0, false}},
    {"sliver-1e6", "thin plates, aspect 1e6, with small gaps and overlaps", slivers,
     .amount = 0x1p20, .features = {2, 0, false}},
    {"sliver-1e9", "thin plates, aspect 1e9, with small gaps and overlaps", slivers,
     .amount = 0x1p30, .features = {2, 0, false}},
    {"sliver-1e12", "thin plates, aspect 1e12, with small gaps and overlaps", slivers,
     .amount = 0x1p40, .features = {2, 0, false}},
    {"needle-1e3", "needles, aspect 1e3, with small gaps and overlaps", slivers,
     .amount = 0x1p10, .features = {1, 0, false}, .cells = FAMILY_3D},
    {"needle-1e6", "needles, aspect 1e6, with small gaps and overlaps", slivers,
     .amount = 0x1p20, .features = {1, 0, false}, .cells = FAMILY_3D},
    {"needle-1e9", "needles, aspect 1e9, with small gaps and overlaps", slivers,
     .amount = 0x1p30, .features = {1, 0, false}, .cells = FAMILY_3D},
    {"needle-1e12", "needles, aspect 1e12, with small gaps and overlaps", slivers,
     .amount = 0x1p40, .features = {1, 0, false}, .cells = FAMILY_3D},

    {"parallel-edges", "edges nearly parallel, touching or nearly", parallel,
     .features = {1, 1, true}},
    {"parallel-faces", "faces nearly parallel, touching or nearly", parallel,
     .features = {2, 2, false}, .cells = FAMILY_3D},

    {"far-1e3", "touching or nearly, 1e3 from the origin", far_out, .amount = 0x1p10},
    {"far-1e6", "touching or nearly, 1e6 from the origin", far_out, .amount = 0x1p20},
    {"far-1e9", "touching or nearly, 1e9 from the origin", far_out, .amount = 0x1p30},
    {"far-1e12", "touching or nearly, 1e12 from the origin", far_out, .amount = 0x1p40},
    {"size-1e-9", "touching or nearly, of size 1e-9", of_size, .amount = 0x1p-30},
    {"size-1e9", "touching or nearly, of size 1e9", of_size, .amount = 0x1p30},
    {"sizes-1e9-apart", "touching or nearly, one 1e9 times the other", of_two_sizes,
     .amount = 0x1p30},
    {"exponents-200", "numbers from 2^-100 to 2^100, in contact or not", exponents, .amount = 100},
    {"exponents-all", "numbers from 2^-1000 to 2^1000, in contact or not", exponents,
     .amount = 1000},

    {"fast-thin", "a fast body (1e9) and a thin plate in its way", fast_and_thin,
     .amount = 1e9, .cells = FAMILY_MOVING},
    {"drift-1e-9", "touching or nearly, relative velocity 1e-9", no_drift,
     .amount = 1e-9, .cells = FAMILY_MOVING},
    {"drift-zero", "touching or nearly, velocities the same bits", no_drift,
     .cells = FAMILY_MOVING},

    {"flat-dependent", "flat frames, by components that depend on each other", dependent,
     .cells = FAMILY_FACES},
    {"flat-one-plane", "flat frames in one plane (2D: on one line)", in_one_plane,
     .cells = FAMILY_FACES},
    {"flat-points", "points and segments", points_and_segments, .cells = FAMILY_FACES},
    {"faces", "faces, in contact or nearly", faces, .cells = FAMILY_FACES | FAMILY_A_FACE},

    {"stack-tilted", "equal tilted boxes, one on the other, 0 to 3 ulps off", tilted_stack,
     .cells = 0},
    {"grid-integer", "neighbours in an integer grid: face, edge, corner", integer_grid,
     .cells = 0},
    {"grid-0.1", "neighbours in a grid of pitch 0.1", decimal_grid, .amount = 0.1},
};
/* clang-format on */

enum { FAMILIES = sizeof families / sizeof *families };

const struct family *family_at(size_t index)
{
    return index < FAMILIES ? &families[index] : NULL;
}

const struct family *family_by_name(const char *name)
{
    for (size_t i = 0; i < FAMILIES; i++)
        if (strcmp(families[i].name, name) == 0)
            return &families[i];
    return NULL;
}

static bool is_simplex(enum fmb_shape shape)
{
    return shape == FMB_TETRAHEDRON || shape == FMB_FACE;
}

bool family_has_cell(const struct family *family, const struct cell *cell)
{
    const bool simplices = is_simplex(cell->shape[0]) && is_simplex(cell->shape[1]);
    const bool a_face = cell->shape[0] == FMB_FACE || cell->shape[1] == FMB_FACE;
    return !(family->cells & FAMILY_3D && cell->dim != 3) &&
           !(family->cells & FAMILY_MOVING && !cell->moving) &&
           !(family->cells & FAMILY_A_FACE && !a_face) &&
           !(family->cells & FAMILY_SIMPLICES && !simplices) &&
           !(family->cells & FAMILY_A_HULL) == !cell_has_hull(cell);
}

int family_cells(const struct family *family, struct cell *out)
{
    const int all = family->cells & FAMILY_A_HULL  ? cell_list_hulls(out)
                    : family->cells & FAMILY_POSED ? cell_list_all(out)
                                                   : cell_list(family->cells & FAMILY_FACES, out);
    int count = 0;
    for (int i = 0; i < all; i++)
        if (family_has_cell(family, &out[i]))
            out[count++] = out[i];
    return count;
}

static double pull_back(double number)
{
    return fmax(-DBL_MAX, fmin(DBL_MAX, number)); /* NaN becomes -DBL_MAX */
}

void family_draw(const struct family *family, const struct cell *cell, struct draw *draw,
                 struct question *out)
{
    family->draw(draw, family, cell, out);
    family_pull_back(out);
}

void family_pull_back(struct question *out)
{
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(out, side);
        for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
            solid->origin[axis] = pull_back(solid->origin[axis]);
            solid->velocity[axis] = pull_back(solid->velocity[axis]);
            for (int i = 0; i < FMB_DIM_MAX; i++)
                solid->component[i][axis] = pull_back(solid->component[i][axis]);
            for (int v = 0; v < solid->vertex_count; v++)
                solid->vertex[v][axis] = pull_back(solid->vertex[v][axis]);
        }
        solid->radius = pull_back(solid->radius);
    }
}

static double determinant(const struct solid *solid)
{
    const double(*c)[FMB_DIM_MAX] = solid->component;
    double across[3];
    if (solid->dim == 2)
        return c[0][0] * c[1][1] - c[0][1] * c[1][0];
    vector_cross(c[0], c[1], across);
    return vector_dot(across, c[2]);
}

static void draw_hundreds(struct draw *draw, int dim, double *vector)
{
    for (int axis = 0; axis < dim; axis++)
        vector[axis] = draw_uniform(draw, -100, 100);
}

void family_draw_random(struct draw *draw, const struct cell *cell, struct question *out)
{
    *out = (struct question){.duration = 1};
    for (int side = 0; side < 2; side++) {
        struct solid *solid = question_solid(out, side);
        solid->dim = cell->dim;
        solid->shape = cell->shape[side];
        solid->moving = cell->moving;
        draw_hundreds(draw, cell->dim, solid->origin);
        if (cell->moving)
            draw_hundreds(draw, cell->dim, solid->velocity);
        do {
            for (int i = 0; i < cell->dim; i++)
                draw_hundreds(draw, cell->dim, solid->component[i]);
        } while (fabs(determinant(solid)) < 0.1);
    }
}
