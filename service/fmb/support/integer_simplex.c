#include "integer_simplex.h"

#include "integer.h"

#include <assert.h>
#include <math.h>
#include <string.h>

void integer_simplex_each(struct integer_simplex *simplex, void (*call)(mpz_ptr))
{
    for (int i = 0; i <= INTEGER_CORNERS; i++)
        integer_each(simplex->pool[i].at, sizeof simplex->pool[i].at, call);
    INTEGER_EACH_FROM(normal, simplex, call);
}

static void subtract(mpz_t out[3], mpz_t x[3], mpz_t y[3])
{
    for (int axis = 0; axis < 3; axis++)
        mpz_sub(out[axis], x[axis], y[axis]);
}

/* weight[0] := total - all others. False if one of them is not positive. */
static bool complete_weights(struct integer_simplex *simplex, int count)
{
    mpz_set(simplex->weight[0], simplex->total);
    for (int i = 1; i < count; i++)
        mpz_sub(simplex->weight[0], simplex->weight[0], simplex->weight[i]);
    for (int i = 0; i < count; i++)
        if (mpz_sgn(simplex->weight[i]) <= 0)
            return false;
    return true;
}

/* w - (w . e / e . e) e, times e . e; the weight of w + e is -w . e. */
static bool set_of_two(struct integer_simplex *simplex, mpz_t w[3])
{
    mpz_t *e = simplex->edge[0];
    integer_dot(simplex->total, e, e, simplex->t[0]);
    integer_dot(simplex->weight[1], w, e, simplex->t[0]);
    mpz_neg(simplex->weight[1], simplex->weight[1]);
    if (!complete_weights(simplex, 2))
        return false;
    for (int axis = 0; axis < 3; axis++) {
        mpz_mul(simplex->normal[axis], w[axis], simplex->total);
        mpz_addmul(simplex->normal[axis], simplex->weight[1], e[axis]);
    }
    return true;
}

/* With n = d x e: the weights of w + d and w + e are (-w x e) . n and (d x -w) . n over n . n. */
static bool set_of_three(struct integer_simplex *simplex, mpz_t w[3])
{
    mpz_t *d = simplex->edge[0], *e = simplex->edge[1], *n = simplex->normal;
    integer_cross(n, d, e, simplex->t[0]);
    integer_dot(simplex->total, n, n, simplex->t[0]);
    integer_cross(simplex->other, e, w, simplex->t[0]);
    integer_dot(simplex->weight[1], simplex->other, n, simplex->t[0]);
    integer_cross(simplex->other, w, d, simplex->t[0]);
    integer_dot(simplex->weight[2], simplex->other, n, simplex->t[0]);
    if (mpz_sgn(simplex->total) == 0 || !complete_weights(simplex, 3))
        return false;
    integer_dot(simplex->t[1], n, w, simplex->t[0]);
    if (mpz_sgn(simplex->t[1]) == 0)
        subtract(n, n, n);
    for (int axis = 0; axis < 3 && mpz_sgn(simplex->t[1]) < 0; axis++)
        mpz_neg(n[axis], n[axis]);
    return true;
}

/* The origin in a tetrahedron: Cramer's rule. */
static bool set_of_four(struct integer_simplex *simplex, mpz_t w[3])
{
    for (int i = 0; i < 3; i++) {
        mpz_t *e = simplex->edge[(i + 1) % 3], *f = simplex->edge[(i + 2) % 3];
        integer_cross(simplex->other, e, f, simplex->t[0]);
        integer_dot(simplex->weight[1 + i], simplex->other, w, simplex->t[0]);
        integer_dot(simplex->total, simplex->other, simplex->edge[i], simplex->t[0]);
    }
    for (int i = 1; i < 4; i++)
        if (mpz_sgn(simplex->total) >= 0)
            mpz_neg(simplex->weight[i], simplex->weight[i]);
    mpz_abs(simplex->total, simplex->total);
    subtract(simplex->normal, w, w);
    return mpz_sgn(simplex->total) != 0 && complete_weights(simplex, 4);
}

/* Returns whether the nearest point is that of the corners member[0], ..., member[count - 1]. */
static bool try_subset(struct integer_simplex *simplex, const int member[], int count)
{
    mpz_t *w = simplex->corner[member[0]]->at;
    for (int i = 1; i < count; i++)
        subtract(simplex->edge[i - 1], simplex->corner[member[i]]->at, w);
    if (count == 1) {
        mpz_set_ui(simplex->total, 1);
        mpz_set_ui(simplex->weight[0], 1);
        for (int axis = 0; axis < 3; axis++)
            mpz_set(simplex->normal[axis], w[axis]);
    } else if (!(count == 2   ? set_of_two(simplex, w)
                 : count == 3 ? set_of_three(simplex, w)
                              : set_of_four(simplex, w))) {
        return false;
    }
    for (int i = 0; i < simplex->count; i++) {
        subtract(simplex->other, simplex->corner[i]->at, w);
        integer_dot(simplex->t[1], simplex->normal, simplex->other, simplex->t[0]);
        if (mpz_sgn(simplex->t[1]) < 0)
            return false;
    }
    return true;
}

/* Tries the next subset of the corners; the last corner is in all of them. If the nearest point is
 * inside this subset, reduces the simplex to it. Returns whether it is. After the last subset,
 * which fails only for corners that were given, the first corner alone is kept. */
static bool reduce(struct integer_simplex *simplex)
{
    const int last = simplex->count - 1;
    const unsigned mask = simplex->subset++;
    struct integer_corner *corner[INTEGER_CORNERS + 1];
    int member[INTEGER_CORNERS] = {last}, count = 1;
    assert(mask < 1U << last);
    for (int i = 0; i < last; i++)
        if (mask >> i & 1)
            member[count++] = i;
    if (!try_subset(simplex, member, count)) {
        if (simplex->subset == 1U << last) {
            simplex->count = 1;
            simplex->subset = 0;
        }
        return false;
    }
    memcpy(corner, simplex->corner, sizeof corner);
    simplex->count = count;
    for (int i = 0; i < count; i++)
        simplex->corner[i] = corner[member[i]];
    for (int i = 0; i <= INTEGER_CORNERS; i++)
        if (i != last && !(i < last && mask >> i & 1))
            simplex->corner[count++] = corner[i];
    return true;
}

void integer_simplex_begin_near(struct integer_simplex *simplex, int count)
{
    for (int i = 0; i <= INTEGER_CORNERS; i++)
        simplex->corner[i] = &simplex->pool[i];
    simplex->count = count;
    simplex->subset = (1U << (count - 1)) - 1; /* all of them */
}

void integer_simplex_begin(struct integer_simplex *simplex, mpz_t toward[3],
                           integer_support *support, void *context)
{
    support(context, toward, &simplex->pool[0]);
    integer_simplex_begin_near(simplex, 1);
}

bool integer_simplex_step(struct integer_simplex *simplex, integer_support *support, void *context)
{
    if (!reduce(simplex))
        return false;
    simplex->zero = integer_is_zero(simplex->normal);
    if (simplex->zero)
        return true;
    struct integer_corner *next = simplex->corner[simplex->count];
    support(context, simplex->normal, next);
    subtract(simplex->other, next->at, simplex->corner[0]->at);
    integer_dot(simplex->t[1], simplex->normal, simplex->other, simplex->t[0]);
    if (mpz_sgn(simplex->t[1]) >= 0)
        return true;
    simplex->count++;
    simplex->subset = 0;
    return false;
}

/* integer_round() makes the largest coordinate at least 2^-5. */
void integer_direction(mpz_t n[3], double out[3])
{
    integer_round(n, 3, out);
    for (int axis = 0; axis < 3; axis++)
        if (fabs(out[axis]) < 0x1p-105)
            out[axis] = 0;
    const double length = sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
    for (int axis = 0; axis < 3; axis++)
        out[axis] /= length;
}
