/* Polynomials with integer coefficients, and how many real roots they have between two numbers
 * (Sturm's theorem). Numbers are i / 2^k. */
#ifndef POLYNOMIAL_H
#define POLYNOMIAL_H

#include <gmp.h>

enum { DEGREE_MAX = 11 };

struct polynomial {
    int degree; /* -1: the polynomial is 0 */
    mpz_t c[DEGREE_MAX + 1];
};

void polynomial_init(struct polynomial *p); /* 0 */
void polynomial_clear(struct polynomial *p);
void polynomial_set(struct polynomial *p, const struct polynomial *x);

/* p := x + s (y - x), for constants x and y. */
void polynomial_set_line(struct polynomial *p, const mpz_t x, const mpz_t y);

/* p += sign * x * y; and p += x * y for a constant y. p is neither x nor y. */
void polynomial_add(struct polynomial *p, int sign, const struct polynomial *x,
                    const struct polynomial *y);
void polynomial_add_times(struct polynomial *p, const struct polynomial *x, const mpz_t y);

/* p := p / y. Ends the program if there is a remainder. */
void polynomial_divide(struct polynomial *p, const struct polynomial *y);

/* The first returns the sign of p at i / 2^k. The second returns the sign of p on the closed
 * interval from i / 2^k to (i + 1) / 2^k, or 2 if p may have a root there. */
int polynomial_sign(const struct polynomial *p, const mpz_t i, unsigned k);
int polynomial_sign_over(const struct polynomial *p, const mpz_t i, unsigned k);

/* p := the greatest common divisor of p and x. Neither is 0. */
void polynomial_gcd(struct polynomial *p, const struct polynomial *x);

/* The Sturm sequence of p, without the repetitions of its roots. */
struct sturm {
    int count;
    struct polynomial p[DEGREE_MAX + 1];
};

void sturm_init(struct sturm *sturm, const struct polynomial *p); /* not 0 */
void sturm_clear(struct sturm *sturm);

/* How many roots lie strictly between from / 2^k and to / 2^k. */
int sturm_between(const struct sturm *sturm, const mpz_t from, const mpz_t to, unsigned k);

#endif
