/* Rational vectors and the reading of text, for the checker of certificates only. */
#ifndef FMB_CERTIFICATE_CHECK_H
#define FMB_CERTIFICATE_CHECK_H

#include "fmb.h"

#include <gmp.h>

enum { AXES = 3 }; /* in 2D all lies in the plane z = 0 */

void check_each_axis(mpq_t vector[AXES], void (*call)(mpq_ptr));
void check_copy(mpq_t out[AXES], mpq_t v[AXES]);
void check_subtract(mpq_t out[AXES], mpq_t u[AXES], mpq_t v[AXES]);

/* out := v, of dim numbers. In: the others of out are 0. */
void check_set(mpq_t out[AXES], int dim, const double *v);

/* out := out + factor v. factor is none of the numbers of out. */
void check_add_multiple(mpq_t *out, const mpq_t factor, mpq_t *v, int numbers);

void check_dot(mpq_t out, mpq_t u[AXES], mpq_t v[AXES]);

/* v := R(q) v, as fmb.h defines it, with the plane of 2D in space. */
void check_turn(const struct fmb_placement *placement, mpq_t v[AXES]);

/* Each of these takes something from the beginning of *at, and returns false if that does not begin
 * so; *at is then somewhere within the text. */
bool check_take(const char **at, const char *word);
bool check_is_digit(char c);
bool check_take_digits(const char **at, mpz_t out); /* a natural number without leading zeros */
bool check_take_number(const char **at, mpq_t out); /* in lowest terms */
bool check_take_point(const char **at, int dim, mpq_t out[AXES]);

/* Checks a certificate of a legal pair with a hull. Returns what is wrong, or NULL. */
const char *check_hulls(const struct fmb_placement *a, const struct fmb_placement *b,
                        double duration, enum fmb_verdict verdict, const char *text);

#endif
