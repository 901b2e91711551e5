#include "limbs_rotation.h"

#include <stdlib.h>

/* Returns the greatest common divisor, by the binary algorithm; of 0 and y, y. */
static uint64_t common_divisor_of(uint64_t x, uint64_t y)
{
    if (x == 0 || y == 0)
        return x | y;
    const int twos = __builtin_ctzll(x | y);
    x >>= __builtin_ctzll(x);
    while (y) {
        y >>= __builtin_ctzll(y);
        const uint64_t least = x < y ? x : y;
        y = x < y ? y - x : x - y;
        x = least;
    }
    return x << twos;
}

/* Sets reduced and bits: the smallest integers proportional to the components. In: the given
 * components span at most 62 bits, and are not all 0. */
static void reduce(struct limbs_quaternion *q)
{
    uint64_t divisor = 0, all = 0;
    for (int i = 0; i < 4; i++) {
        const struct dyadic x = dyadic_of(q->given[i]);
        q->reduced[i] = x.mantissa ? x.mantissa * ((int64_t) 1 << (x.exponent - q->unit)) : 0;
        if (divisor != 1)
            divisor = common_divisor_of((uint64_t) llabs(q->reduced[i]), divisor);
    }
    for (int i = 0; i < 4; i++) {
        if (divisor > 1)
            q->reduced[i] /= (int64_t) divisor;
        all |= (uint64_t) llabs(q->reduced[i]);
    }
    q->bits = 64 - __builtin_clzll(all);
}

void limbs_set_quaternion(const struct fmb_placement *placement, struct limbs_quaternion *out)
{
    const double *q = placement->orientation;
    const bool plane = placement->orientation_count == 2;
    *out = (struct limbs_quaternion){
        .given = {q[0], plane ? 0 : q[1], plane ? 0 : q[2], q[plane ? 1 : 3]}};
    out->turned = out->given[1] != 0 || out->given[2] != 0 || out->given[3] != 0;
    if (!out->turned)
        return;
    struct dyadic_span span = dyadic_span_begin();
    for (int i = 0; i < 4; i++)
        dyadic_span_add(&span, dyadic_of(out->given[i]));
    out->bits = (int) (span.top - span.unit);
    out->unit = span.unit;
    if (out->bits <= 62)
        reduce(out);
}

bool limbs_same_rotation(const struct limbs_quaternion *a, const struct limbs_quaternion *b)
{
    const bool small = a->bits <= 62 && b->bits <= 62;
    bool equal = true, opposite = true;
    for (int i = 0; i < 4; i++) {
        equal = equal && (small ? a->reduced[i] == b->reduced[i] : a->given[i] == b->given[i]);
        opposite =
            opposite && (small ? a->reduced[i] == -b->reduced[i] : a->given[i] == -b->given[i]);
    }
    return equal || opposite;
}

/* A quaternion in integers of as many limbs as they need. */
struct quaternion_limbs {
    int limbs;
    limbs_number at[4];
};

static void set_quaternion_limbs(int n, const struct limbs_quaternion *q,
                                 struct quaternion_limbs *out)
{
    static const struct dyadic one = {1, 0};
    out->limbs = q->bits / 64 + 1;
    for (int i = 0; i < 4; i++) {
        if (q->bits > 62) {
            limbs_set_product(n, out->at[i], dyadic_of(q->given[i]), one, q->unit);
            continue;
        }
        for (int limb = 1; limb < n; limb++)
            out->at[i][limb] = q->reduced[i] < 0 ? UINT64_MAX : 0;
        out->at[i][0] = (uint64_t) q->reduced[i];
    }
}

/* Sets the rows of the transposed matrix. */
static void set_inverse(int n, const struct limbs_vector row[FMB_DIM_MAX],
                        struct limbs_vector out[FMB_DIM_MAX])
{
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            memcpy(out[i].at[j], row[j].at[i], (size_t) n * sizeof(uint64_t));
        limbs_trim(n, &out[i]);
    }
}

void limbs_set_rotation(int n, const struct limbs_quaternion *quaternion,
                        struct limbs_rotation *out)
{
    const size_t size = (size_t) n * sizeof(uint64_t);
    struct quaternion_limbs components;
    const struct quaternion_limbs *q = &components;
    limbs_number product;
    set_quaternion_limbs(n, quaternion, &components);
    memset(out->norm.at, 0, size);
    for (int i = 0; i < 3; i++)
        memset(out->row[0][i].at[i], 0, size);
    for (int k = 0; k < 4; k++) { /* ww, and v_k v_k: + in row k, else - */
        memset(product, 0, size);
        limbs_add_product(n, product, false, q->at[k], q->limbs, q->at[k]);
        add(n, out->norm.at, product);
        for (int i = 0; i < 3; i++) {
            uint64_t *entry = out->row[0][i].at[i];
            if (k == 0 || k == 1 + i)
                add(n, entry, product);
            else
                subtract(n, entry, product);
        }
    }
    for (int i = 0; i < 3; i++) { /* 2 (v_i v_j - w v_k) and 2 (v_i v_j + w v_k), cyclic */
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        uint64_t *less = out->row[0][i].at[j], *more = out->row[0][j].at[i];
        memset(less, 0, size);
        limbs_add_product(n, less, false, q->at[1 + i], q->limbs, q->at[1 + j]);
        add(n, less, less);
        memcpy(more, less, size);
        memset(product, 0, size);
        limbs_add_product(n, product, false, q->at[0], q->limbs, q->at[1 + k]);
        add(n, product, product);
        subtract(n, less, product);
        add(n, more, product);
    }
    out->norm.limbs = limbs_needed(n, out->norm.at);
    set_inverse(n, out->row[0], out->row[1]);
}

/* The columns of R_a^-1 R_b are the columns of R_b, transformed by R_a^-1. */
void limbs_set_relative(int n, const struct limbs_rotation *a, const struct limbs_rotation *b,
                        struct limbs_rotation *out)
{
    for (int i = 0; i < 3; i++)
        limbs_transform(n, a->row[1], &b->row[1][i], &out->row[1][i]);
    set_inverse(n, out->row[1], out->row[0]);
    memset(out->norm.at, 0, sizeof out->norm.at);
    limbs_add_product(n, out->norm.at, false, a->norm.at, b->norm.limbs, b->norm.at);
    out->norm.limbs = limbs_needed(n, out->norm.at);
}
