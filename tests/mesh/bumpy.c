/* Points of the grid are the integers (i, j, k) with |i| + |j| + |k| = n, as they lie on the faces
 * of an octahedron. Each is pushed to the sphere, and out or in by bumps: waves across a few
 * directions that the seed draws, each a polynomial of Chebyshev's, 1 at most where its argument
 * is. */
#include "bumpy.h"

#include "allocate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WAVES = 6, DEGREE_MIN = 7 };

/* So that all of them are 0.3 at most. */
static const double height = 0.05;

struct grid {
    int n;
    double wave[WAVES][3]; /* its direction, of a length of 1 at most */
    unsigned *index[2];    /* [k < 0][(i + n) (2 n + 1) + j + n], of the vertex there */
    struct mesh *mesh;
};

/* From -1 to 1, in 2^21 steps. */
static double draw(uint64_t *state)
{
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double) (*state >> 43) / (1 << 20) - 1;
}

static double chebyshev(int degree, double x)
{
    double before = 1, now = x;
    for (int i = 1; i < degree; i++) {
        const double next = 2 * x * now - before;
        before = now;
        now = next;
    }
    return now;
}

static double radius(const struct grid *grid, const double direction[3])
{
    double sum = 0;
    for (int w = 0; w < WAVES; w++) {
        const double *wave = grid->wave[w];
        sum += chebyshev(DEGREE_MIN + w,
                         wave[0] * direction[0] + wave[1] * direction[1] + wave[2] * direction[2]);
    }
    return 1 + height * sum;
}

static void place(const struct grid *grid, const int point[3], double out[3])
{
    const double i = point[0], j = point[1], k = point[2];
    const double length = sqrt(i * i + j * j + k * k);
    const double direction[3] = {i / length, j / length, k / length};
    const double r = radius(grid, direction);
    for (int axis = 0; axis < 3; axis++)
        out[axis] = floor(direction[axis] * r * 1e6 + 0.5) / 1e6;
}

static unsigned *slot(const struct grid *grid, const int point[3])
{
    const size_t row = 2 * (size_t) grid->n + 1;
    return &grid->index[point[2] < 0]
                       [(size_t) (point[0] + grid->n) * row + (size_t) (point[1] + grid->n)];
}

static void add_vertex(struct grid *grid, int i, int j, int k)
{
    const int point[3] = {i, j, k};
    *slot(grid, point) = (unsigned) grid->mesh->vertex_count;
    place(grid, point, grid->mesh->vertex[grid->mesh->vertex_count++]);
}

static void add_vertices(struct grid *grid)
{
    const int n = grid->n;
    for (int i = -n; i <= n; i++) {
        const int most = n - abs(i);
        for (int j = -most; j <= most; j++) {
            const int k = most - abs(j);
            add_vertex(grid, i, j, k);
            if (k > 0)
                add_vertex(grid, i, j, -k);
        }
    }
}

/* In the octant of these signs, of which an odd number of negative ones turns faces round. */
static void add_face(struct grid *grid, const int sign[3], int corner[3][3])
{
    const bool turned = sign[0] * sign[1] * sign[2] < 0;
    unsigned *face = grid->mesh->face[grid->mesh->face_count++];
    for (int c = 0; c < 3; c++) {
        for (int axis = 0; axis < 3; axis++)
            corner[c][axis] *= sign[axis];
        face[turned ? 2 - c : c] = *slot(grid, corner[c]);
    }
}

static void add_octant(struct grid *grid, const int sign[3])
{
    const int n = grid->n;
    for (int a = 0; a < n; a++) {
        for (int b = 0; a + b < n; b++) {
            const int c = n - 1 - a - b;
            int upright[3][3] = {{a + 1, b, c}, {a, b + 1, c}, {a, b, c + 1}};
            add_face(grid, sign, upright);
            if (c == 0)
                continue;
            int other[3][3] = {{a, b + 1, c}, {a + 1, b, c}, {a + 1, b + 1, c - 1}};
            add_face(grid, sign, other);
        }
    }
}

void bumpy_make(unsigned faces, uint64_t seed, struct mesh *out)
{
    struct grid grid = {.n = (int) (sqrt(faces / 8.0) + 0.5), .mesh = out};
    const size_t n = (size_t) grid.n;
    for (int w = 0; w < WAVES; w++)
        for (int axis = 0; axis < 3; axis++)
            grid.wave[w][axis] = 0.57 * draw(&seed); /* 0.57^2 * 3 < 1 */
    *out = (struct mesh){0};
    out->vertex = allocate(4 * n * n + 2, sizeof *out->vertex);
    out->face = allocate(8 * n * n, sizeof *out->face);
    for (int below = 0; below < 2; below++)
        grid.index[below] = allocate((2 * n + 1) * (2 * n + 1), sizeof *grid.index[below]);
    add_vertices(&grid);
    for (int octant = 0; octant < 8; octant++) {
        const int sign[3] = {octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1};
        add_octant(&grid, sign);
    }
    free(grid.index[0]);
    free(grid.index[1]);
}
