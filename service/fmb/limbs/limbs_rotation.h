/* Rotations in integers of n limbs: the matrix m R(q), m = |q|^2, of a quaternion q scaled to
 * integers. */
#ifndef FMB_LIMBS_ROTATION_H
#define FMB_LIMBS_ROTATION_H

#include "limbs_number.h"

/* A factor > 0. */
struct limbs_factor {
    int limbs; /* number of limbs that hold it with a sign */
    limbs_number at;
};

/* A matrix of integers m R, R a rotation. */
struct limbs_rotation {
    struct limbs_vector row[2][FMB_DIM_MAX]; /* of m R; of m R^-1, its transpose */
    struct limbs_factor norm;                /* m */
};

/* Sets the rows of the transposed matrix. */
LIMBS_FUNCTION void set_inverse(int n, struct limbs_vector row[FMB_DIM_MAX],
                                struct limbs_vector out[FMB_DIM_MAX])
{
    for (int i = 0; i < 3; i++) {
        limbs_trim(n, &row[i]);
        for (int j = 0; j < 3; j++)
            memcpy(out[i].at[j], row[j].at[i], (size_t) n * sizeof(uint64_t));
        limbs_trim(n, &out[i]);
    }
}

/* Computes m R(q). */
LIMBS_FUNCTION void limbs_set_rotation(int n, const struct limbs_quaternion *quaternion,
                                       struct limbs_rotation *out)
{
    static const struct dyadic one = {1, 0};
    const size_t size = (size_t) n * sizeof(uint64_t);
    const int limbs = quaternion->bits / 64 + 1; /* that hold a component */
    limbs_number q[4], product;
    for (int i = 0; i < 4; i++)
        limbs_set_product(n, q[i], quaternion->at[i], one, quaternion->unit);
    memset(out->norm.at, 0, size);
    for (int i = 0; i < 3; i++)
        memset(out->row[0][i].at[i], 0, size);
    for (int k = 0; k < 4; k++) { /* ww, and v_k v_k: + in row k, else - */
        memset(product, 0, size);
        limbs_add_product(n, product, false, q[k], limbs, q[k]);
        add(n, out->norm.at, product);
        for (int i = 0; i < 3; i++) {
            uint64_t *entry = out->row[0][i].at[i];
            (k == 0 || k == 1 + i ? add : subtract)(n, entry, product);
        }
    }
    for (int i = 0; i < 3; i++) { /* 2 (v_i v_j - w v_k) and 2 (v_i v_j + w v_k), cyclic */
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        uint64_t *less = out->row[0][i].at[j], *more = out->row[0][j].at[i];
        memset(less, 0, size);
        limbs_add_product(n, less, false, q[1 + i], limbs, q[1 + j]);
        add(n, less, less);
        memcpy(more, less, size);
        memset(product, 0, size);
        limbs_add_product(n, product, false, q[0], limbs, q[1 + k]);
        add(n, product, product);
        subtract(n, less, product);
        add(n, more, product);
    }
    out->norm.limbs = limbs_needed(n, out->norm.at);
    set_inverse(n, out->row[0], out->row[1]);
}

/* Computes the rotation of b relative to a: m_a m_b R_a^-1 R_b. Its columns are the columns of R_b,
 * transformed by R_a^-1. */
LIMBS_FUNCTION void limbs_set_relative(int n, const struct limbs_rotation *a,
                                       const struct limbs_rotation *b, struct limbs_rotation *out)
{
    for (int i = 0; i < 3; i++)
        limbs_transform(n, a->row[1], &b->row[1][i], &out->row[1][i]);
    set_inverse(n, out->row[1], out->row[0]);
    memset(out->norm.at, 0, sizeof out->norm.at);
    limbs_add_product(n, out->norm.at, false, a->norm.at, b->norm.limbs, b->norm.at);
    out->norm.limbs = limbs_needed(n, out->norm.at);
}

#endif
