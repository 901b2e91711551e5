#include "nearest.h"

#include <stdbool.h>

/* Solves the symmetric system m x = r of count unknowns, positive definite or singular; false if it
 * is singular. */
static bool solve(mpq_t m[NEAREST_MAX][NEAREST_MAX], mpq_t r[NEAREST_MAX], int count)
{
    mpq_t factor;
    mpq_init(factor);
    bool regular = true;
    for (int k = 0; k < count && regular; k++) {
        regular = mpq_sgn(m[k][k]) != 0;
        for (int i = 0; i < count && regular; i++) {
            if (i == k || mpq_sgn(m[i][k]) == 0)
                continue;
            mpq_div(factor, m[i][k], m[k][k]);
            for (int j = k; j < count; j++)
                rational_add_product(m[i][j], -1, factor, m[k][j]);
            rational_add_product(r[i], -1, factor, r[k]);
        }
    }
    for (int k = 0; k < count && regular; k++)
        mpq_div(r[k], r[k], m[k][k]);
    mpq_clear(factor);
    return regular;
}

/* least := the least |w + sum x_i column_i|^2 where it is less, over the face in which state[i] is
 * 0, 1, or 2: free; face_sum[s]: the parameters of simplex s sum up to 1. The last of these that is
 * free is then 1 minus the others. */
static void try_face(const struct nearest *box, rational_vector w, const int state[],
                     const bool face_sum[2], mpq_t least)
{
    mpq_t m[NEAREST_MAX][NEAREST_MAX], r[NEAREST_MAX], sum, at;
    rational_vector base, column[NEAREST_MAX];
    int index[NEAREST_MAX], free_count = 0, last[2] = {-1, -1};
    bool legal = true;
    mpq_inits(sum, at, NULL);
    rational_vector_init(base);
    for (int i = 0; i < NEAREST_MAX; i++) {
        rational_vector_init(column[i]);
        mpq_init(r[i]);
        for (int j = 0; j < NEAREST_MAX; j++)
            mpq_init(m[i][j]);
    }
    for (int axis = 0; axis < 3; axis++)
        mpq_set(base[axis], w[axis]);
    for (int s = 0; s < 2; s++) {
        for (int i = box->simplex[s]; i < box->simplex_end[s]; i++)
            if (state[i] == 2)
                last[s] = i;
        if (face_sum[s] && last[s] < 0)
            legal = false;
    }
    for (int i = 0; i < box->count && legal; i++) {
        const bool dependent = (face_sum[0] && i == last[0]) || (face_sum[1] && i == last[1]);
        for (int axis = 0; axis < 3; axis++)
            if (state[i] == 1 || dependent)
                mpq_add(base[axis], base[axis], box->column[i][axis]);
        if (state[i] != 2 || dependent)
            continue;
        for (int axis = 0; axis < 3; axis++) {
            mpq_set(column[free_count][axis], box->column[i][axis]);
            for (int s = 0; s < 2; s++)
                if (face_sum[s] && i >= box->simplex[s] && i < box->simplex_end[s])
                    mpq_sub(column[free_count][axis], column[free_count][axis],
                            box->column[last[s]][axis]);
        }
        index[free_count++] = i;
    }
    for (int i = 0; i < free_count; i++) {
        rational_dot(r[i], column[i], base);
        mpq_neg(r[i], r[i]);
        for (int j = 0; j < free_count; j++)
            rational_dot(m[i][j], column[i], column[j]);
    }
    legal = legal && free_count <= 3 && solve(m, r, free_count);
    for (int i = 0; i < free_count && legal; i++)
        legal = mpq_sgn(r[i]) >= 0 && mpq_cmp_ui(r[i], 1, 1) <= 0;
    for (int s = 0; s < 2 && legal; s++) {
        mpq_set_ui(sum, 0, 1);
        for (int i = 0; i < free_count; i++)
            if (index[i] >= box->simplex[s] && index[i] < box->simplex_end[s])
                mpq_add(sum, sum, r[i]);
        legal = mpq_cmp_ui(sum, 1, 1) <= 0;
    }
    if (legal) {
        for (int axis = 0; axis < 3; axis++)
            for (int i = 0; i < free_count; i++)
                rational_add_product(base[axis], 1, r[i], column[i][axis]);
        rational_dot(at, base, base);
        if (mpq_sgn(least) < 0 || mpq_cmp(at, least) < 0)
            mpq_set(least, at);
    }
    for (int i = 0; i < NEAREST_MAX; i++) {
        rational_vector_clear(column[i]);
        mpq_clear(r[i]);
        for (int j = 0; j < NEAREST_MAX; j++)
            mpq_clear(m[i][j]);
    }
    rational_vector_clear(base);
    mpq_clears(sum, at, NULL);
}

void nearest_square(const struct nearest *box, rational_vector w, mpq_t square)
{
    int state[NEAREST_MAX] = {0};
    mpq_set_si(square, -1, 1);
    for (;;) {
        for (int sums = 0; sums < 4; sums++) {
            const bool face_sum[2] = {sums & 1, sums & 2};
            bool exists = true;
            for (int s = 0; s < 2; s++)
                exists = exists && (!face_sum[s] || box->simplex[s] < box->simplex_end[s]);
            if (exists)
                try_face(box, w, state, face_sum, square);
        }
        int i = 0;
        for (; i < box->count; i++) {
            bool simplex = false;
            for (int s = 0; s < 2; s++)
                simplex = simplex || (i >= box->simplex[s] && i < box->simplex_end[s]);
            state[i] += simplex && state[i] == 0 ? 2 : 1;
            if (state[i] <= 2)
                break;
            state[i] = 0;
        }
        if (i == box->count)
            return;
    }
}
