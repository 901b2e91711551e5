/* Method. The unknowns are the coordinates of a point in A's components, each in [0, 1], and of
 * moving pairs the time as a share of the window, which is one more of the kind. The rows a x <= b
 * are B's faces, and the last face of a simplex A. They are added in random order. The optimum so
 * far stays if it satisfies the next row; else the new optimum is on that row's hyperplane, where
 * one unknown less is left, and is found among the rows before it in the same way. The pair meets
 * if and only if the rows have a solution; what is maximised does not matter.
 *
 * Each row is violated with a probability of at most n / i, so that the expected time is linear in
 * the rows. */
#include "seidel.h"

#include <math.h>
#include <stdint.h>

#ifndef __OPTIMIZE__
#define INLINED_NOT
#endif
#include "inlined.h"

/* At most 6 of B and 1 of A; each level but the last adds the bounds of an unknown. */
enum { UNKNOWNS = 4, ROWS_MAX = 6 + 1 + 2 * (UNKNOWNS - 1) };

struct row {
    double a[UNKNOWNS], b;
};

/* Of a row's numbers. Rows of a simplex A imply each other, and those of parallel faces differ by a
 * constant; eliminated they contradict each other by rounding. */
static const double tolerance = 0x1p-40;

typedef bool solver(const struct row *row, int count, const double *gain, double *x);

/* Maximises gain x over [0, 1]. */
static bool solve_1(const struct row *row, int count, const double *gain, double *x)
{
    double low = 0, high = 1;
    for (int i = 0; i < count; i++) {
        const double a = row[i].a[0], b = row[i].b;
        if (a > tolerance && b < a * high)
            high = b / a;
        else if (a < -tolerance && b < a * low)
            low = b / a;
        else if (fabs(a) <= tolerance && b < -tolerance)
            return false;
    }
    *x = *gain > 0 ? high : low;
    return low <= high + tolerance;
}

/* The row without unknown k, which equals (pivot->b - other terms) / pivot->a[k]. */
INLINE struct row eliminate(const int n, const struct row *row, const struct row *pivot, int k)
{
    const double factor = row->a[k] / pivot->a[k];
    struct row out = {.b = row->b - factor * pivot->b};
    for (int j = 0; j < n - 1; j++)
        out.a[j] = row->a[j + (j >= k)] - factor * pivot->a[j + (j >= k)];
    return out;
}

/* Solves on the hyperplane of row[last] for the rows before it. */
INLINE bool solve_on(const int n, solver *below, const struct row *row, int last,
                     const double *gain, double *x)
{
    const struct row *pivot = &row[last];
    struct row rest[ROWS_MAX], bound = {.b = 1}, objective = {.b = 0};
    int k = 0, count = 0;
    for (int j = 0; j < n; j++) {
        k = fabs(pivot->a[j]) > fabs(pivot->a[k]) ? j : k;
        objective.a[j] = gain[j];
    }
    if (pivot->a[k] == 0)
        return false;
    for (int sign = 1; sign >= -1; sign -= 2) { /* x[k] <= 1, -x[k] <= 0 */
        bound.a[k] = sign;
        bound.b = sign > 0;
        rest[count++] = eliminate(n, &bound, pivot, k);
    }
    for (int i = 0; i < last; i++)
        rest[count++] = eliminate(n, &row[i], pivot, k);
    objective = eliminate(n, &objective, pivot, k);
    double found[UNKNOWNS], sum = pivot->b;
    if (!below(rest, count, objective.a, found))
        return false;
    for (int j = 0; j < n - 1; j++) {
        x[j + (j >= k)] = found[j];
        sum -= pivot->a[j + (j >= k)] * found[j];
    }
    x[k] = sum / pivot->a[k];
    return true;
}

INLINE bool solve(const int n, solver *below, const struct row *row, int count, const double *gain,
                  double *x)
{
    for (int j = 0; j < n; j++)
        x[j] = gain[j] > 0;
    for (int i = 0; i < count; i++) {
        double excess = -row[i].b, size = 1 + fabs(row[i].b);
        for (int j = 0; j < n; j++) {
            excess += row[i].a[j] * x[j];
            size += fabs(row[i].a[j]);
        }
        if (excess > tolerance * size && !solve_on(n, below, row, i, gain, x))
            return false;
    }
    return true;
}

#define SOLVER(n, below)                                                                   \
    static bool solve_##n(const struct row *row, int count, const double *gain, double *x) \
    {                                                                                      \
        return solve(n, solve_##below, row, count, gain, x);                               \
    }
SOLVER(2, 1)
SOLVER(3, 2)
SOLVER(4, 3)
#undef SOLVER

/* ---- Rows ---- */

static double dot(int dim, const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + (dim == 3 ? a[2] * b[2] : 0);
}

/* At a right angle to all components but c, whose product with it is 1. */
static void set_normal(const struct lean_frame *frame, int dim, int c, double out[3])
{
    const double *next = frame->component[(c + 1) % dim];
    const double *last = frame->component[(c + 2) % dim];
    if (dim == 2) {
        out[0] = next[1];
        out[1] = -next[0];
    } else {
        out[0] = next[1] * last[2] - next[2] * last[1];
        out[1] = next[2] * last[0] - next[0] * last[2];
        out[2] = next[0] * last[1] - next[1] * last[0];
    }
    const double volume = dot(dim, out, frame->component[c]);
    for (int axis = 0; axis < dim; axis++)
        out[axis] /= volume;
}

/* The coordinate of the point along component c of B is a x - b. */
static struct row coordinate_of(const struct lean_frame *a, const struct lean_frame *b, int dim,
                                double duration, int c)
{
    double normal[3], offset[3], drift[3];
    struct row out = {.b = 0};
    set_normal(b, dim, c, normal);
    for (int axis = 0; axis < dim; axis++) {
        offset[axis] = b->origin[axis] - a->origin[axis];
        drift[axis] = (a->velocity[axis] - b->velocity[axis]) * duration;
    }
    for (int j = 0; j < dim; j++)
        out.a[j] = dot(dim, normal, a->component[j]);
    out.a[dim] = dot(dim, normal, drift);
    out.b = dot(dim, normal, offset);
    return out;
}

static void add(struct row *to, double times, const struct row *row)
{
    for (int j = 0; j < UNKNOWNS; j++)
        to->a[j] += times * row->a[j];
    to->b += times * row->b;
}

static int set_rows(const struct lean_frame *a, const struct lean_frame *b, int dim,
                    double duration, struct row row[ROWS_MAX])
{
    int count = 0;
    struct row sum = {.b = 1};
    for (int c = 0; c < dim; c++) {
        struct row coordinate = coordinate_of(a, b, dim, duration, c), negative = {.b = 0};
        add(&negative, -1, &coordinate);
        add(&sum, 1, &coordinate);
        row[count++] = negative;
        coordinate.b += 1;
        if (!(b->kind & LEAN_SIMPLEX))
            row[count++] = coordinate;
    }
    if (b->kind & LEAN_SIMPLEX)
        row[count++] = sum;
    if (a->kind & LEAN_SIMPLEX)
        row[count++] = (struct row){{1, 1, dim == 3, 0}, 1};
    return count;
}

/* Of SplitMix64's kind: good enough for orders. */
static unsigned below(unsigned count)
{
    static uint64_t state;
    uint64_t bits = state += 0x9e3779b97f4a7c15;
    bits = (bits ^ bits >> 30) * 0xbf58476d1ce4e5b9;
    return (unsigned) ((bits >> 32) * count >> 32);
}

bool seidel_meets(const struct lean_frame *a, const struct lean_frame *b, double duration)
{
    static solver *const solvers[] = {solve_2, solve_3, solve_4};
    static const double gain[UNKNOWNS] = {1, 1, 1, 1};
    const int dim = a->kind & LEAN_SPACE ? 3 : 2;
    const bool moving = (a->kind | b->kind) & LEAN_MOVING;
    struct row row[ROWS_MAX];
    double x[UNKNOWNS];
    const int count = set_rows(a, b, dim, duration, row);
    for (int i = count - 1; i > 0; i--) {
        const unsigned other = below((unsigned) i + 1);
        const struct row taken = row[i];
        row[i] = row[other];
        row[other] = taken;
    }
    return solvers[dim - 2 + moving](row, count, gain, x);
}
