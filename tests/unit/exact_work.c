#include "exact_work.h"

#include <gmp.h>

#include "limbs.h"

double exact_work;
long exact_slabs;

static double larger(size_t x, size_t y)
{
    return (double) (x > y ? x : y);
}

static void count_product(mpz_srcptr x, mpz_srcptr y)
{
    exact_work += (double) mpz_size(x) * (double) mpz_size(y);
}

static void count_sum(mpz_srcptr x, mpz_srcptr y)
{
    exact_work += larger(mpz_size(x), mpz_size(y));
}

static void count_quotient(mpz_srcptr num, mpz_srcptr den)
{
    if (mpz_size(num) >= mpz_size(den))
        exact_work += (double) (mpz_size(num) - mpz_size(den) + 1) * (double) mpz_size(den);
}

static double size_of(mpq_srcptr x)
{
    return larger(mpz_size(mpq_numref(x)), mpz_size(mpq_denref(x)));
}

static void count_fractions(mpq_srcptr x, mpq_srcptr y)
{
    const double size = size_of(x) > size_of(y) ? size_of(x) : size_of(y);
    exact_work += size * size;
}

/* Wraps a function of two operands, which count() adds to the work. */
#define WRAP(name, type, count)                                           \
    void __real_##name(type##_ptr out, type##_srcptr x, type##_srcptr y); \
    void __wrap_##name(type##_ptr out, type##_srcptr x, type##_srcptr y); \
    void __wrap_##name(type##_ptr out, type##_srcptr x, type##_srcptr y)  \
    {                                                                     \
        count(x, y);                                                      \
        __real_##name(out, x, y);                                         \
    }
WRAP(__gmpz_mul, mpz, count_product)
WRAP(__gmpz_addmul, mpz, count_product)
WRAP(__gmpz_submul, mpz, count_product)
WRAP(__gmpz_add, mpz, count_sum)
WRAP(__gmpz_sub, mpz, count_sum)
WRAP(__gmpz_fdiv_q, mpz, count_quotient)
WRAP(__gmpz_tdiv_q, mpz, count_quotient)
WRAP(__gmpq_mul, mpq, count_fractions)
WRAP(__gmpq_div, mpq, count_fractions)
WRAP(__gmpq_add, mpq, count_fractions)
WRAP(__gmpq_sub, mpq, count_fractions)

void __real___gmpq_canonicalize(mpq_ptr x);
void __wrap___gmpq_canonicalize(mpq_ptr x);
void __wrap___gmpq_canonicalize(mpq_ptr x)
{
    count_fractions(x, x);
    __real___gmpq_canonicalize(x);
}

void __real___gmpz_tdiv_qr(mpz_ptr q, mpz_ptr r, mpz_srcptr num, mpz_srcptr den);
void __wrap___gmpz_tdiv_qr(mpz_ptr q, mpz_ptr r, mpz_srcptr num, mpz_srcptr den);
void __wrap___gmpz_tdiv_qr(mpz_ptr q, mpz_ptr r, mpz_srcptr num, mpz_srcptr den)
{
    count_quotient(num, den);
    __real___gmpz_tdiv_qr(q, r, num, den);
}

/* A slab of n limbs: 3 normals of 6 products; 8 extents and origins, offset and drift, of 3
 * products each; and 6 factors. Each product costs n^2. */
static void count_slab(const struct limbs_pair *pair)
{
    exact_work += (3 * 6 + (8 + 2) * 3 + 6) * (double) pair->limbs * pair->limbs;
}

int __real_limbs_gap_sign(struct limbs_pair *pair, struct slab_normal normal);
int __wrap_limbs_gap_sign(struct limbs_pair *pair, struct slab_normal normal);
int __wrap_limbs_gap_sign(struct limbs_pair *pair, struct slab_normal normal)
{
    count_slab(pair);
    return __real_limbs_gap_sign(pair, normal);
}

void __real_limbs_slab(struct limbs_pair *pair, struct slab_normal normal, mpz_t low, mpz_t high,
                       mpz_t start, mpz_t slope);
void __wrap_limbs_slab(struct limbs_pair *pair, struct slab_normal normal, mpz_t low, mpz_t high,
                       mpz_t start, mpz_t slope);
void __wrap_limbs_slab(struct limbs_pair *pair, struct slab_normal normal, mpz_t low, mpz_t high,
                       mpz_t start, mpz_t slope)
{
    count_slab(pair);
    exact_slabs++;
    __real_limbs_slab(pair, normal, low, high, start, slope);
}
