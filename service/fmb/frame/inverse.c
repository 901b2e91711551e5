#include "inverse.h"

#include "integer.h"

#include <gmp.h>

/* The components in integers; a frame in 2D gets the unit vector along z as third. Returns the
 * unit. */
static long set_components(const struct fmb_frame *frame, mpz_t out[3][3])
{
    const int dim = frame->dim;
    struct dyadic_span span = dyadic_span_begin();
    for (int k = 0; k < dim * dim; k++) {
        dyadic_span_add(&span, dyadic_of(frame->component[k / dim][k % dim]));
        dyadic_span_add(&span, dyadic_of(frame->remainder[k / dim][k % dim]));
    }
    for (int i = 0; i < dim; i++)
        for (int axis = 0; axis < dim; axis++)
            integer_set_sum(out[i][axis], frame->component[i][axis], frame->remainder[i][axis],
                            span.unit);
    if (dim == 2)
        mpz_set_ui(out[2][2], 1);
    return span.unit;
}

/* With k_0 = c_1 x c_2 and so on around: x_i = k_i . p / (c_2 . k_2). In integers, k is of one
 * degree less than the determinant, so that one unit is left below. */
bool inverse_set(struct fmb_frame *frame)
{
    const int dim = frame->dim;
    mpz_t c[3][3], k[3][3], determinant, scratch[2];
    mpz_inits(determinant, scratch[0], scratch[1], NULL);
    integer_each(c, sizeof c, mpz_init);
    integer_each(k, sizeof k, mpz_init);

    const long unit = set_components(frame, c);
    for (int i = 0; i < 3; i++)
        integer_cross(k[i], c[(i + 1) % 3], c[(i + 2) % 3], scratch[0]);
    integer_dot(determinant, c[2], k[2], scratch[0]);
    int sign = mpz_sgn(determinant);
    mpz_abs(determinant, determinant);
    for (int i = 0; sign && i < dim; i++)
        for (int axis = 0; axis < dim; axis++) {
            if (sign < 0)
                mpz_neg(k[i][axis], k[i][axis]);
            frame->inverse[axis][i] =
                integer_ratio_round(k[i][axis], determinant, -unit, ROUND_DOWN, scratch);
        }

    mpz_clears(determinant, scratch[0], scratch[1], NULL);
    integer_each(c, sizeof c, mpz_clear);
    integer_each(k, sizeof k, mpz_clear);
    return sign != 0;
}
