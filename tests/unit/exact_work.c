#include "exact_work.h"

#include <gmp.h>

#include "integer.h"

double exact_work;
long exact_ends, exact_terms;

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

void __real___gmpz_mul_si(mpz_ptr out, mpz_srcptr x, long y);
void __wrap___gmpz_mul_si(mpz_ptr out, mpz_srcptr x, long y);
void __wrap___gmpz_mul_si(mpz_ptr out, mpz_srcptr x, long y)
{
    exact_work += (double) mpz_size(x);
    exact_terms++;
    __real___gmpz_mul_si(out, x, y);
}

void __real___gmpz_mul_2exp(mpz_ptr out, mpz_srcptr x, mp_bitcnt_t bits);
void __wrap___gmpz_mul_2exp(mpz_ptr out, mpz_srcptr x, mp_bitcnt_t bits);
void __wrap___gmpz_mul_2exp(mpz_ptr out, mpz_srcptr x, mp_bitcnt_t bits)
{
    __real___gmpz_mul_2exp(out, x, bits);
    exact_work += (double) mpz_size(out);
}

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

double __real_integer_ratio_round(const mpz_t num, const mpz_t den, long unit,
                                  enum round_direction direction, mpz_t scratch[2]);
double __wrap_integer_ratio_round(const mpz_t num, const mpz_t den, long unit,
                                  enum round_direction direction, mpz_t scratch[2]);
double __wrap_integer_ratio_round(const mpz_t num, const mpz_t den, long unit,
                                  enum round_direction direction, mpz_t scratch[2])
{
    exact_ends++;
    return __real_integer_ratio_round(num, den, unit, direction, scratch);
}
