#include "polynomial.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

void polynomial_init(struct polynomial *p)
{
    p->degree = -1;
    for (int i = 0; i <= DEGREE_MAX; i++)
        mpz_init(p->c[i]);
}

void polynomial_clear(struct polynomial *p)
{
    for (int i = 0; i <= DEGREE_MAX; i++)
        mpz_clear(p->c[i]);
}

static void trim(struct polynomial *p, int degree)
{
    while (degree >= 0 && mpz_sgn(p->c[degree]) == 0)
        degree--;
    p->degree = degree;
}

void polynomial_set(struct polynomial *p, const struct polynomial *x)
{
    for (int i = 0; i <= DEGREE_MAX; i++)
        mpz_set(p->c[i], x->c[i]);
    p->degree = x->degree;
}

void polynomial_set_line(struct polynomial *p, const mpz_t x, const mpz_t y)
{
    mpz_set(p->c[0], x);
    mpz_sub(p->c[1], y, x);
    for (int i = 2; i <= p->degree; i++)
        mpz_set_ui(p->c[i], 0);
    trim(p, 1);
}

static int larger(int x, int y)
{
    return x > y ? x : y;
}

void polynomial_add(struct polynomial *p, int sign, const struct polynomial *x,
                    const struct polynomial *y)
{
    for (int i = 0; i <= x->degree; i++)
        for (int j = 0; j <= y->degree; j++)
            (sign > 0 ? mpz_addmul : mpz_submul)(p->c[i + j], x->c[i], y->c[j]);
    trim(p, larger(p->degree, x->degree + y->degree));
}

void polynomial_add_times(struct polynomial *p, const struct polynomial *x, const mpz_t y)
{
    for (int i = 0; i <= x->degree; i++)
        mpz_addmul(p->c[i], x->c[i], y);
    trim(p, larger(p->degree, x->degree));
}

void polynomial_divide(struct polynomial *p, const struct polynomial *y)
{
    struct polynomial quotient;
    polynomial_init(&quotient);
    for (int i = p->degree - y->degree; i >= 0; i--) {
        mpz_fdiv_q(quotient.c[i], p->c[i + y->degree], y->c[y->degree]);
        for (int j = 0; j <= y->degree; j++)
            mpz_submul(p->c[i + j], quotient.c[i], y->c[j]);
    }
    trim(p, p->degree);
    if (p->degree >= 0) {
        fprintf(stderr, "a polynomial is not a multiple of another\n");
        exit(EXIT_FAILURE);
    }
    trim(&quotient, DEGREE_MAX);
    polynomial_set(p, &quotient);
    polynomial_clear(&quotient);
}

int polynomial_sign(const struct polynomial *p, const mpz_t i, unsigned k)
{
    mpz_t sum, term;
    mpz_inits(sum, term, NULL);
    for (int d = p->degree; d >= 0; d--) {
        mpz_mul(sum, sum, i);
        mpz_mul_2exp(term, p->c[d], (mp_bitcnt_t) k * (unsigned) (p->degree - d));
        mpz_add(sum, sum, term);
    }
    const int sign = mpz_sgn(sum);
    mpz_clears(sum, term, NULL);
    return sign;
}

/* The sign is certain if |p(m)| > sum |p_j| h^j over j >= 1. Here m is the midpoint,
 * h = 2^-(k + 1), and p_j are the coefficients of p(m + x). */
int polynomial_sign_over(const struct polynomial *p, const mpz_t i, unsigned k)
{
    mpz_t c[DEGREE_MAX + 1], middle;
    mpz_init(middle);
    mpz_mul_2exp(middle, i, 1);
    mpz_add_ui(middle, middle, 1);
    for (int d = 0; d <= p->degree; d++) {
        mpz_init(c[d]);
        mpz_mul_2exp(c[d], p->c[d], (mp_bitcnt_t) (k + 1) * (unsigned) (p->degree - d));
    }
    for (int d = 0; d < p->degree; d++)
        for (int j = p->degree - 1; j >= d; j--)
            mpz_addmul(c[j], c[j + 1], middle);
    const int sign = p->degree < 0 ? 0 : mpz_sgn(c[0]);
    mpz_set_ui(middle, 0);
    for (int d = 1; d <= p->degree; d++) {
        mpz_abs(c[d], c[d]);
        mpz_add(middle, middle, c[d]);
    }
    const bool sure = p->degree < 0 || mpz_cmpabs(c[0], middle) > 0;
    for (int d = 0; d <= p->degree; d++)
        mpz_clear(c[d]);
    mpz_clear(middle);
    return sure ? sign : 2;
}

static void make_primitive(struct polynomial *p)
{
    mpz_t content;
    mpz_init(content);
    for (int i = 0; i <= p->degree; i++)
        mpz_gcd(content, content, p->c[i]);
    for (int i = 0; i <= p->degree; i++)
        mpz_divexact(p->c[i], p->c[i], content);
    mpz_clear(content);
}

/* x := a positive multiple of the remainder of x divided by y. */
static void reduce(struct polynomial *x, const struct polynomial *y)
{
    mpz_t lead, factor;
    mpz_inits(lead, factor, NULL);
    mpz_abs(factor, y->c[y->degree]);
    while (x->degree >= y->degree) {
        const int shift = x->degree - y->degree;
        mpz_mul_si(lead, x->c[x->degree], mpz_sgn(y->c[y->degree]));
        for (int i = 0; i <= x->degree; i++)
            mpz_mul(x->c[i], x->c[i], factor);
        for (int i = 0; i <= y->degree; i++)
            mpz_submul(x->c[i + shift], lead, y->c[i]);
        trim(x, x->degree);
    }
    if (x->degree >= 0)
        make_primitive(x);
    mpz_clears(lead, factor, NULL);
}

void polynomial_gcd(struct polynomial *p, const struct polynomial *x)
{
    struct polynomial other;
    polynomial_init(&other);
    polynomial_set(&other, x);
    while (other.degree >= 0) {
        struct polynomial swapped = *p;
        reduce(&swapped, &other);
        *p = other;
        other = swapped;
    }
    make_primitive(p);
    polynomial_clear(&other);
}

void sturm_init(struct sturm *sturm, const struct polynomial *p)
{
    struct polynomial *at = sturm->p;
    for (int i = 0; i <= DEGREE_MAX; i++)
        polynomial_init(&at[i]);
    polynomial_set(&at[0], p);
    make_primitive(&at[0]);
    for (int i = 1; i <= p->degree; i++)
        mpz_mul_ui(at[1].c[i - 1], at[0].c[i], (unsigned long) i);
    trim(&at[1], p->degree - 1);
    make_primitive(&at[1]);
    sturm->count = 1;
    for (int n = 1; n <= DEGREE_MAX && at[n].degree >= 0; n++) {
        sturm->count++;
        if (at[n].degree == 0 || n == DEGREE_MAX)
            break;
        polynomial_set(&at[n + 1], &at[n - 1]);
        reduce(&at[n + 1], &at[n]);
        for (int i = 0; i <= at[n + 1].degree; i++)
            mpz_neg(at[n + 1].c[i], at[n + 1].c[i]);
    }
    struct polynomial last;
    polynomial_init(&last);
    polynomial_set(&last, &at[sturm->count - 1]);
    for (int n = 0; n < sturm->count && last.degree > 0; n++)
        polynomial_divide(&at[n], &last);
    polynomial_clear(&last);
}

void sturm_clear(struct sturm *sturm)
{
    for (int i = 0; i <= DEGREE_MAX; i++)
        polynomial_clear(&sturm->p[i]);
}

static int variations(const struct sturm *sturm, const mpz_t i, unsigned k)
{
    int count = 0, before = 0;
    for (int n = 0; n < sturm->count; n++) {
        const int sign = polynomial_sign(&sturm->p[n], i, k);
        count += sign * before < 0;
        before = sign ? sign : before;
    }
    return count;
}

int sturm_between(const struct sturm *sturm, const mpz_t from, const mpz_t to, unsigned k)
{
    return variations(sturm, from, k) - variations(sturm, to, k) -
           (polynomial_sign(&sturm->p[0], to, k) == 0);
}
