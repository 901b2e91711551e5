/* The article's algorithm (section 4, Listing 1), for all dimensions, static and moving.
 *
 * Method: the pair becomes rows M x <= y (rows.c). Fourier-Motzkin elimination removes the
 * variables one by one, from the first. Each row in which the variable has a positive coefficient
 * is added to each row in which it has a negative one, scaled so that the variable cancels. Rows
 * without the variable stay. Each new row is checked at once against inequality 11. The last
 * variable is the time of a moving pair, or else the last parameter, and its bounds are tight. The
 * box follows by back substitution: with the bounds of the later variables inserted, the rows from
 * before a variable was eliminated bound it too, but no longer tightly. The article's box is
 * therefore loose.
 *
 * Differences from Listing 1, which correct its errors: the row of a tetrahedron includes all its
 * variables; bounds that coincide mean touching, not 'no intersection'; and each row is marked as
 * strict or not, which distinguishes touching from overlapping. Inequality 11 is checked for all
 * given rows, not only those of a. All comparisons are with 0 or between computed values: there is
 * no epsilon.
 *
 * Accuracy: none is guaranteed. Rounding decides near contact. */
#include "inexact.h"
#include "rows.h"

#include <assert.h>
#include <math.h>

/* Bounds of the number of rows, for any signs of the coefficients. Of n rows with p positive,
 * q negative and z zero coefficients p q + z are left; for p + q + z = n >= 4 this is largest
 * where z is as small as it can be, and p and q differ by at most one. Two cuboids in 3D have
 * the most rows of all pairs of shapes at each step:
 *
 *     given                      a 6, b 6, window 2                                14 rows
 *     x_0 is in a's 6, b's 2     4 * 4 = 16 new; b's 4, window 2 stay              22
 *     x_1 is in the 16, b's 2    9 * 9 = 81 new; b's 2, window 2 stay              85
 *     x_2 is in the 81, b's 2    41 * 42 = 1722 new; window 2 stay                 1724
 *
 * (Mixed: 8 and 17 rows with x_0 and x_1 where b is the tetrahedron, 6 and 11 where a is; two
 * tetrahedra: 6 and 10. Without motion the window's rows and the last step are missing, in 2D
 * the last variable.) All steps together: 1845. */
enum { TOTAL_ROWS_MAX = 14 + 22 + 85 + 1724 };

struct elimination {
    int vars;
    int begin[ROWS_VARS_MAX + 1]; /* rows [begin[k], begin[k + 1]): variables before k are gone */
    struct row rows[TOTAL_ROWS_MAX];
    bool no_interior; /* some strict row holds only as an equation */
    bool overflow;    /* some row is no longer finite */
};

/* Inequality 11: all variables lie in [0,1], so a row's left side is at least the sum of its
 * negative coefficients. False if the row cannot hold, or has overflowed. */
static bool check_row(struct elimination *system, const struct row *row, int first)
{
    double least = 0, sum = row->y;
    for (int i = first; i < system->vars; i++) {
        sum += row->a[i];
        if (row->a[i] < 0)
            least += row->a[i];
    }
    system->overflow = !isfinite(sum);
    if (row->strict && row->y == least)
        system->no_interior = true;
    return !system->overflow && !(row->y < least);
}

static struct row *next_row(struct elimination *system, int step)
{
    assert(system->begin[step] < TOTAL_ROWS_MAX);
    return &system->rows[system->begin[step]++];
}

/* row / |its a[k]| + other / |its a[k]|: a[k] cancels. */
static void combine(struct row *out, const struct row *row, const struct row *other, int k,
                    int vars)
{
    double p = fabs(row->a[k]), q = fabs(other->a[k]);
    for (int i = 0; i <= k; i++)
        out->a[i] = 0;
    for (int i = k + 1; i < vars; i++)
        out->a[i] = row->a[i] / p + other->a[i] / q;
    out->y = row->y / p + other->y / q;
    out->strict = row->strict || other->strict;
}

/* Takes variable k out; false if a new row cannot hold. */
static bool eliminate(struct elimination *system, int k)
{
    int begin = system->begin[k], end = system->begin[k + 1];
    system->begin[k + 2] = end;
    for (int r = begin; r < end; r++) {
        if (system->rows[r].a[k] == 0)
            continue;
        for (int s = r + 1; s < end; s++) {
            if (!(system->rows[r].a[k] < 0 ? system->rows[s].a[k] > 0 : system->rows[s].a[k] < 0))
                continue;
            struct row *row = next_row(system, k + 2);
            combine(row, &system->rows[r], &system->rows[s], k, system->vars);
            if (!check_row(system, row, k + 1))
                return false;
        }
    }
    for (int r = begin; r < end; r++)
        if (system->rows[r].a[k] == 0)
            *next_row(system, k + 2) = system->rows[r];
    return true;
}

static bool eliminate_all(struct elimination *system)
{
    for (int r = 0; r < system->begin[1]; r++)
        if (!check_row(system, &system->rows[r], 0))
            return false;
    for (int k = 0; k < system->vars - 1; k++)
        if (!eliminate(system, k))
            return false;
    return true;
}

/* Bounds of the last variable, from the rows that are left. */
static struct bounds bound_last(const struct elimination *system)
{
    struct bounds bounds = {.strict = {-INFINITY, INFINITY},
                            .closed = {-INFINITY, INFINITY},
                            .no_interior = system->no_interior};
    int last = system->vars - 1;
    for (int r = system->begin[last]; r < system->begin[last + 1]; r++) {
        const struct row *row = &system->rows[r];
        double *bound = row->strict ? bounds.strict : bounds.closed;
        if (row->a[last] > 0)
            bound[1] = fmin(bound[1], row->y / row->a[last]);
        else if (row->a[last] < 0)
            bound[0] = fmax(bound[0], row->y / row->a[last]);
    }
    return bounds;
}

/* range[k] := bounds of variable k, from those of the later ones. */
static void bound_variable(const struct elimination *system, int k, double range[][2])
{
    range[k][0] = 0;
    range[k][1] = 1;
    for (int r = system->begin[k]; r < system->begin[k + 1]; r++) {
        const struct row *row = &system->rows[r];
        double rest = row->y;
        for (int i = k + 1; i < system->vars; i++)
            rest -= row->a[i] * range[i][row->a[i] < 0];
        if (row->a[k] > 0)
            range[k][1] = fmin(range[k][1], rest / row->a[k]);
        else if (row->a[k] < 0)
            range[k][0] = fmax(range[k][0], rest / row->a[k]);
    }
}

/* The box of { origin of b + tau displacement of b + sum x_i c_i } over the ranges. Rounding may
 * have turned a box of no width inside out: the ends are put in order. False if one is no
 * number: infinities met on the way. */
static bool answer_box(const struct inexact_pair *pair, const double range[][2],
                       struct fmb_answer *answer)
{
    const struct world_frame *b = &pair->b;
    answer->has_box = true;
    for (int axis = 0; axis < b->dim; axis++) {
        double low = b->origin[axis], high = low;
        const double moved = b->velocity[axis] * pair->duration;
        for (int i = 0; i < b->dim + pair->moving; i++) {
            double c = i < b->dim ? b->component[i][axis] : moved;
            low += c * range[i][c < 0];
            high += c * range[i][c >= 0];
        }
        answer->box[0][axis] = fmin(low, high) + 0.0; /* + 0.0: never -0 */
        answer->box[1][axis] = fmax(low, high) + 0.0;
        if (isnan(low) || isnan(high))
            return false;
    }
    return true;
}

enum fmb_status eliminate_decide(const struct frame_pair *frames, unsigned want,
                                 struct fmb_answer *answer)
{
    struct inexact_pair pair;
    struct elimination system;
    if (!frames->a.frame->inverted || !inexact_pair_of(frames, &pair))
        return FMB_CANNOT_DECIDE;
    system.vars = pair.a.dim + pair.moving;
    system.begin[0] = 0;
    system.no_interior = system.overflow = false;
    if (!rows_of_pair(&pair, system.rows, &system.begin[1]))
        return FMB_CANNOT_DECIDE;

    answer->verdict = FMB_SEPARATED;
    if (!eliminate_all(&system))
        return system.overflow ? FMB_CANNOT_DECIDE : FMB_OK;
    struct bounds bounds = bound_last(&system);
    answer->verdict = bounds_verdict(&bounds);
    if (answer->verdict == FMB_SEPARATED)
        return FMB_OK;
    answer->has_contact = true;
    answer->contact[1] = pair.duration + 0.0; /* never -0 */
    if (pair.moving)
        bounds_answer_contact(&bounds, pair.duration, answer);
    if (want & FMB_WANT_BOX) {
        double range[ROWS_VARS_MAX][2];
        int last = system.vars - 1;
        bounds_range(&bounds, range[last]);
        for (int k = last - 1; k >= 0; k--)
            bound_variable(&system, k, range);
        if (!answer_box(&pair, (const double(*)[2]) range, answer))
            return FMB_CANNOT_DECIDE;
    }
    return FMB_OK;
}
