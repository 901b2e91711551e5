#include "exact.h"
#include "integer.h"

void ratio_init(struct ratio *r)
{
    mpz_inits(r->num, r->den, NULL);
}

void ratio_clear(struct ratio *r)
{
    mpz_clears(r->num, r->den, NULL);
}

void ratio_copy(struct ratio *out, const struct ratio *r)
{
    mpz_set(out->num, r->num);
    mpz_set(out->den, r->den);
}

int ratio_compare(const struct ratio *x, const struct ratio *y, mpz_t scratch[2])
{
    return integer_compare_products(x->num, y->den, y->num, x->den, scratch);
}

void clipped_segment_init(struct clipped_segment *span)
{
    for (int i = 0; i < 2; i++) {
        ratio_init(&span->window[i]);
        ratio_init(&span->open[i]);
        mpz_init(span->scratch[i]);
    }
    ratio_init(&span->at);
    for (int i = 0; i < 2; i++) {
        mpz_set_ui(span->window[i].num, (unsigned long) i);
        mpz_set_ui(span->window[i].den, 1);
        span->bounded[i] = false;
    }
    span->interior = true;
}

void clipped_segment_clear(struct clipped_segment *span)
{
    for (int i = 0; i < 2; i++) {
        ratio_clear(&span->window[i]);
        ratio_clear(&span->open[i]);
        mpz_clear(span->scratch[i]);
    }
    ratio_clear(&span->at);
}

/* span->at := (bound - f0) / (f1 - f0), where the segment crosses the bound. */
static void cross_bound(struct clipped_segment *span, const mpz_t f0, const mpz_t f1,
                        const mpz_t bound)
{
    mpz_sub(span->at.num, bound, f0);
    mpz_sub(span->at.den, f1, f0);
    if (mpz_sgn(span->at.den) < 0) {
        mpz_neg(span->at.num, span->at.num);
        mpz_neg(span->at.den, span->at.den);
    }
}

/* Raises (side 0) or lowers (side 1) an end to span->at if that is the tighter one. */
static void tighten(struct clipped_segment *span, struct ratio *end, int side)
{
    int sign = ratio_compare(&span->at, end, span->scratch);
    if (side == 0 ? sign > 0 : sign < 0)
        ratio_copy(end, &span->at);
}

static void tighten_open(struct clipped_segment *span, int side)
{
    if (span->bounded[side]) {
        tighten(span, &span->open[side], side);
    } else {
        ratio_copy(&span->open[side], &span->at);
        span->bounded[side] = true;
    }
}

/* Method: along the segment, f = normal . w is affine in s. A segment that lies strictly
 * between the bounds at both ends does so in between, and one that has both ends beyond one
 * bound is outside: both are seen without a division, and are nearly all of them. Else f
 * enters the slab at one bound and leaves it at the other. */
bool clipped_segment_apply(struct clipped_segment *span, const mpz_t f0, const mpz_t f1,
                           const mpz_t low, const mpz_t high, bool pins)
{
    int low0 = mpz_cmp(f0, low), low1 = mpz_cmp(f1, low);
    int high0 = mpz_cmp(f0, high), high1 = mpz_cmp(f1, high);
    if ((low0 < 0 && low1 < 0) || (high0 > 0 && high1 > 0))
        return false;
    if (low0 > 0 && low1 > 0 && high0 < 0 && high1 < 0)
        return true;

    int slope = mpz_cmp(f1, f0);
    if (slope == 0) { /* on a bound all along */
        if (!pins)
            span->interior = false;
        return true;
    }
    cross_bound(span, f0, f1, slope > 0 ? low : high);
    if (pins)
        tighten(span, &span->window[0], 0);
    else
        tighten_open(span, 0);
    cross_bound(span, f0, f1, slope > 0 ? high : low);
    if (pins)
        tighten(span, &span->window[1], 1);
    else
        tighten_open(span, 1);
    return ratio_compare(clipped_segment_lower(span), clipped_segment_upper(span), span->scratch) <=
           0;
}

const struct ratio *clipped_segment_lower(struct clipped_segment *span)
{
    if (span->bounded[0] && ratio_compare(&span->open[0], &span->window[0], span->scratch) > 0)
        return &span->open[0];
    return &span->window[0];
}

const struct ratio *clipped_segment_upper(struct clipped_segment *span)
{
    if (span->bounded[1] && ratio_compare(&span->open[1], &span->window[1], span->scratch) < 0)
        return &span->open[1];
    return &span->window[1];
}

/* The open interval (p, q) meets the closed interval [u, v], u <= v, if and only if p < q, p < v
 * and u < q. */
bool clipped_segment_has_interior(struct clipped_segment *span)
{
    const struct ratio *p = &span->open[0], *q = &span->open[1];
    if (!span->interior)
        return false;
    if (span->bounded[0] && span->bounded[1] && ratio_compare(p, q, span->scratch) >= 0)
        return false;
    if (span->bounded[0] && ratio_compare(p, &span->window[1], span->scratch) >= 0)
        return false;
    return !span->bounded[1] || ratio_compare(&span->window[0], q, span->scratch) < 0;
}
