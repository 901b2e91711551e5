/* Rotations in fixed-width integers: the matrix n R(q), n = |q|^2, of a quaternion q scaled to
 * integers. n of the functions is the number of limbs of all integers. No shared state. */
#ifndef FMB_LIMBS_ROTATION_H
#define FMB_LIMBS_ROTATION_H

#include "limbs_number.h"

/* A quaternion scaled to integers: given / 2^unit, or the smallest integers proportional to it if
 * given spans at most 62 bits. */
struct limbs_quaternion {
    bool turned;        /* R is not the identity */
    int bits;           /* the magnitudes of all integers are below 2^bits */
    double given[4];    /* w, x, y, z */
    long unit;          /* all of given are multiples of 2^unit */
    int64_t reduced[4]; /* the components, if bits <= 62 */
};

/* A factor > 0. */
struct limbs_factor {
    int limbs; /* number of limbs that hold it with a sign */
    limbs_number at;
};

/* A matrix of integers n R, R a rotation. */
struct limbs_rotation {
    struct limbs_vector row[2][FMB_DIM_MAX]; /* of n R; of n R^-1, its transpose */
    struct limbs_factor norm;                /* n */
};

/* Converts the orientation of a placement. If the rotation is the identity, only given and turned
 * are set; other fields are 0. */
void limbs_set_quaternion(const struct fmb_placement *placement, struct limbs_quaternion *out);

/* Returns true only if both are the same rotation; may return false for equal ones whose integers
 * have more than 62 bits. */
bool limbs_same_rotation(const struct limbs_quaternion *a, const struct limbs_quaternion *b);

/* Computes n R(q). */
void limbs_set_rotation(int n, const struct limbs_quaternion *q, struct limbs_rotation *out);

/* Computes the rotation of b relative to a: n_a n_b R_a^-1 R_b. */
void limbs_set_relative(int n, const struct limbs_rotation *a, const struct limbs_rotation *b,
                        struct limbs_rotation *out);

#endif
