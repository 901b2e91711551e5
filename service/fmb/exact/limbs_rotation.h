/* Orientations in integers: n R(q), n = |q|^2, for a quaternion scaled to integers. */
#ifndef FMB_LIMBS_ROTATION_H
#define FMB_LIMBS_ROTATION_H

#include "limbs_number.h"

/* A quaternion in integers: the smallest integer multiple if its components have at most 62 bits.
 */
struct limbs_quaternion {
    bool turned;     /* not the identity */
    int bits;        /* all components are below 2^bits */
    double given[4]; /* w, x, y, z */
    long unit;       /* bits count in units of 2^unit; that of given if bits > 62 */
    int64_t least[4];
};

struct limbs_factor {
    int limbs; /* that hold it with a sign */
    limbs_number at;
};

/* A matrix n R of integers, R a rotation; that of its inverse; and n. */
struct limbs_rotation {
    struct limbs_vector row[2][FMB_DIM_MAX];
    struct limbs_factor norm;
};

void limbs_set_quaternion(const struct fmb_placement *placement, struct limbs_quaternion *out);

/* Returns whether they are surely the same rotation. */
bool limbs_same_rotation(const struct limbs_quaternion *a, const struct limbs_quaternion *b);

void limbs_set_rotation(int n, const struct limbs_quaternion *q, struct limbs_rotation *out);

/* The rotation of b relative to a: n_a n_b R_a^-1 R_b. */
void limbs_set_relative(int n, const struct limbs_rotation *a, const struct limbs_rotation *b,
                        struct limbs_rotation *out);

#endif
