/* Method: P. Wolfe, Finding the nearest point in a polytope, Mathematical Programming 11 (1976).
 *
 * A corral is a set of vertices, affinely independent, whose affine hull is nearest to the origin
 * in a point x inside of their hull. x is the answer if no vertex p has x . p < x . x. Otherwise
 * the p of least x . p joins them; it is independent of them, as x . s = x . x for all of these.
 * The point of the new affine hull next to the origin is the new x if it has positive weights only;
 * otherwise x moves towards it until the first weight is 0, and that vertex leaves. Each corral is
 * nearer than the one before: none returns, and there are finitely many. */
#include <stdbool.h>

#include "difference.h"

enum { CORRAL_MAX = FMB_DIM_MAX + 1 };

struct corral {
    int count;
    rational_vector point[CORRAL_MAX];
    mpq_t weight[CORRAL_MAX];
    rational_vector x;
};

/* Solves m x = r, m symmetric and positive definite; m and r are used up. r := x. */
static void solve(mpq_t m[CORRAL_MAX][CORRAL_MAX], mpq_t r[CORRAL_MAX], int count)
{
    mpq_t factor;
    mpq_init(factor);
    for (int k = 0; k < count; k++)
        for (int i = 0; i < count; i++) {
            if (i == k)
                continue;
            mpq_div(factor, m[i][k], m[k][k]);
            for (int j = k; j < count; j++)
                rational_add_product(m[i][j], -1, factor, m[k][j]);
            rational_add_product(r[i], -1, factor, r[k]);
        }
    for (int k = 0; k < count; k++)
        mpq_div(r[k], r[k], m[k][k]);
    mpq_clear(factor);
}

/* weight := that of the point of the affine hull next to the origin. */
static void affine_weights(struct corral *corral, mpq_t weight[CORRAL_MAX])
{
    mpq_t m[CORRAL_MAX][CORRAL_MAX], r[CORRAL_MAX];
    rational_vector edge[CORRAL_MAX];
    const int count = corral->count - 1; /* of edges, from the last point */
    for (int i = 0; i < CORRAL_MAX; i++) {
        rational_vector_init(edge[i]);
        mpq_init(r[i]);
        for (int j = 0; j < CORRAL_MAX; j++)
            mpq_init(m[i][j]);
    }
    for (int i = 0; i < count; i++)
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            mpq_sub(edge[i][axis], corral->point[i][axis], corral->point[count][axis]);
    for (int i = 0; i < count; i++) {
        rational_dot(r[i], edge[i], corral->point[count]);
        mpq_neg(r[i], r[i]);
        for (int j = 0; j < count; j++)
            rational_dot(m[i][j], edge[i], edge[j]);
    }
    solve(m, r, count);
    mpq_set_ui(weight[count], 1, 1);
    for (int i = 0; i < count; i++) {
        mpq_set(weight[i], r[i]);
        mpq_sub(weight[count], weight[count], r[i]);
    }
    for (int i = 0; i < CORRAL_MAX; i++) {
        rational_vector_clear(edge[i]);
        mpq_clear(r[i]);
        for (int j = 0; j < CORRAL_MAX; j++)
            mpq_clear(m[i][j]);
    }
}

/* Moves the weights towards those, until the first one is 0, which leaves. Returns false if none
 * did: all are positive. */
static bool step(struct corral *corral, mpq_t to[CORRAL_MAX])
{
    int leaving = -1;
    mpq_t share, least;
    mpq_inits(share, least, NULL);
    for (int i = 0; i < corral->count; i++) {
        if (mpq_sgn(to[i]) > 0)
            continue;
        mpq_sub(share, corral->weight[i], to[i]);
        if (mpq_sgn(share) != 0) /* else both are 0: it was to leave together with another */
            mpq_div(share, corral->weight[i], share);
        if (leaving < 0 || mpq_cmp(share, least) < 0) {
            leaving = i;
            mpq_set(least, share);
        }
    }
    if (leaving < 0)
        mpq_set_ui(least, 1, 1);
    for (int i = 0; i < corral->count; i++) {
        mpq_sub(share, to[i], corral->weight[i]);
        rational_add_product(corral->weight[i], 1, least, share);
    }
    if (leaving >= 0) {
        const int last = --corral->count;
        mpq_swap(corral->weight[leaving], corral->weight[last]);
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            mpq_swap(corral->point[leaving][axis], corral->point[last][axis]);
    }
    mpq_clears(share, least, NULL);
    return leaving >= 0;
}

/* Makes a corral of the points again, after one more. */
static void settle(struct corral *corral)
{
    mpq_t to[CORRAL_MAX];
    for (int i = 0; i < CORRAL_MAX; i++)
        mpq_init(to[i]);
    do
        affine_weights(corral, to);
    while (step(corral, to));
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        mpq_set_ui(corral->x[axis], 0, 1);
        for (int i = 0; i < corral->count; i++)
            rational_add_product(corral->x[axis], 1, corral->weight[i], corral->point[i][axis]);
    }
    for (int i = 0; i < CORRAL_MAX; i++)
        mpq_clear(to[i]);
}

void difference_nearest(const struct difference *difference, mpq_t square, mpq_t *point)
{
    struct corral corral = {.count = 0};
    mpq_t at;
    mpq_init(at);
    rational_vector_init(corral.x);
    for (int i = 0; i < CORRAL_MAX; i++) {
        rational_vector_init(corral.point[i]);
        mpq_init(corral.weight[i]);
    }
    difference_end(difference, difference->offset, -1, at, corral.point[0]);
    mpq_set_ui(corral.weight[0], 1, 1);
    corral.count = 1;
    for (settle(&corral);; settle(&corral)) {
        rational_dot(square, corral.x, corral.x);
        if (mpq_sgn(square) == 0)
            break;
        difference_end(difference, corral.x, -1, at, corral.point[corral.count]);
        if (mpq_cmp(at, square) >= 0)
            break;
        mpq_set_ui(corral.weight[corral.count++], 0, 1);
    }
    for (int axis = 0; axis < FMB_DIM_MAX && point; axis++)
        mpq_set(point[axis], corral.x[axis]);
    rational_vector_clear(corral.x);
    for (int i = 0; i < CORRAL_MAX; i++) {
        rational_vector_clear(corral.point[i]);
        mpq_clear(corral.weight[i]);
    }
    mpq_clear(at);
}
