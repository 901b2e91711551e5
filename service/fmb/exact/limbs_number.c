#include "limbs_number.h"

int limbs_needed(int n, const uint64_t *x)
{
    while (n > 0 && x[n - 1] == (n > 1 && is_negative(n - 1, x) ? UINT64_MAX : 0))
        n--;
    return n;
}

void limbs_trim(int n, struct limbs_vector *v)
{
    v->limbs = 0;
    v->other_than_0 = 0;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        const int limbs = limbs_needed(n, v->at[axis]);
        v->limbs = limbs > v->limbs ? limbs : v->limbs;
        v->other_than_0 |= (unsigned) (limbs > 0) << axis;
    }
}

void limbs_set_product(int n, uint64_t *out, struct dyadic x, struct dyadic y, long unit)
{
    const __int128 product = (__int128) x.mantissa * y.mantissa;
    const long shift = x.exponent + y.exponent - unit;
    memset(out, 0, (size_t) n * sizeof *out);
    if (product == 0)
        return;
    const two_limbs magnitude = (two_limbs) (product < 0 ? -product : product);
    const int word = (int) (shift / 64), bit = (int) (shift % 64);
    const uint64_t part[3] = {(uint64_t) magnitude << bit, (uint64_t) (magnitude >> (64 - bit)),
                              bit ? (uint64_t) (magnitude >> 64) >> (64 - bit) : 0};
    for (int i = 0; i < 3 && word + i < n; i++)
        out[word + i] = part[i];
    if (product < 0) {
        limbs_number negative = {0};
        subtract(n, negative, out);
        memcpy(out, negative, (size_t) n * sizeof *out);
    }
}

void limbs_add_product(int n, uint64_t *out, bool minus, const uint64_t *x, int ny,
                       const uint64_t *y)
{
    WITH_LIMBS(n, add_product, out, minus, x, ny, y);
}

/* out := x x y, or y x x where swapped. */
INLINE void cross(const int n, const struct limbs_vector *x, const struct limbs_vector *y,
                  bool swapped, struct limbs_vector *out)
{
    for (int i = 0; i < 3; i++)
        memset(out->at[i], 0, (size_t) n * sizeof *out->at[i]);
    for (int k = 0; k < 3; k++) {
        const int i = k == 2 ? 0 : k + 1, j = 3 - i - k;
        if (!(y->other_than_0 >> k & 1))
            continue;
        add_product(n, out->at[j], !swapped, x->at[i], y->limbs, y->at[k]);
        add_product(n, out->at[i], swapped, x->at[j], y->limbs, y->at[k]);
    }
}

void limbs_cross(int n, const struct limbs_vector *x, const struct limbs_vector *y, bool swapped,
                 struct limbs_vector *out)
{
    WITH_LIMBS(n, cross, x, y, swapped, out);
}

INLINE void transform(const int n, const struct limbs_vector row[FMB_DIM_MAX],
                      const struct limbs_vector *v, struct limbs_vector *out)
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        dot_limbs(n, &row[axis], v, out->at[axis]);
}

const struct limbs_vector *limbs_transform(int n, const struct limbs_vector *row,
                                           const struct limbs_vector *v, struct limbs_vector *out)
{
    if (!row)
        return v;
    WITH_LIMBS(n, transform, row, v, out);
    return out;
}
