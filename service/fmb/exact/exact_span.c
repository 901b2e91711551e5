#include "exact.h"
#include "integer.h"

void ratio_each(struct ratio *r, void (*call)(mpz_ptr))
{
    call(r->num);
    call(r->den);
}

int ratio_compare(const struct ratio *x, const struct ratio *y, mpz_t scratch[2])
{
    return integer_compare_products(x->num, y->den, y->num, x->den, scratch);
}

void ratio_cross(struct ratio *out, const mpz_t f0, const mpz_t f1, const mpz_t bound)
{
    mpz_sub(out->num, bound, f0);
    mpz_sub(out->den, f1, f0);
    if (mpz_sgn(out->den) < 0) {
        mpz_neg(out->num, out->num);
        mpz_neg(out->den, out->den);
    }
}

void ratio_tighten(struct ratio *end, bool bounded, int side, const struct ratio *at,
                   mpz_t scratch[2])
{
    const int sign = bounded ? ratio_compare(at, end, scratch) : 0;
    if (bounded && (side == 0 ? sign <= 0 : sign >= 0))
        return;
    mpz_set(end->num, at->num);
    mpz_set(end->den, at->den);
}

static void clipped_segment_each(struct clipped_segment *span, void (*call)(mpz_ptr))
{
    for (int i = 0; i < 2; i++) {
        ratio_each(&span->window[i], call);
        ratio_each(&span->open[i], call);
        call(span->scratch[i]);
    }
    ratio_each(&span->at, call);
}

void clipped_segment_init(struct clipped_segment *span)
{
    clipped_segment_each(span, mpz_init);
    for (int i = 0; i < 2; i++) {
        mpz_set_ui(span->window[i].num, (unsigned long) i);
        mpz_set_ui(span->window[i].den, 1);
        span->bounded[i] = false;
    }
    span->interior = true;
}

void clipped_segment_clear(struct clipped_segment *span)
{
    clipped_segment_each(span, mpz_clear);
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
    for (int side = 0; side < 2; side++) {
        ratio_cross(&span->at, f0, f1, (slope > 0) == (side == 0) ? low : high);
        ratio_tighten(pins ? &span->window[side] : &span->open[side], pins || span->bounded[side],
                      side, &span->at, span->scratch);
        span->bounded[side] = span->bounded[side] || !pins;
    }
    return ratio_compare(clipped_segment_end(span, 0), clipped_segment_end(span, 1),
                         span->scratch) <= 0;
}

const struct ratio *clipped_segment_end(struct clipped_segment *span, int side)
{
    const struct ratio *open = &span->open[side], *window = &span->window[side];
    const int sign = span->bounded[side] ? ratio_compare(open, window, span->scratch) : 0;
    return (side == 0 ? sign > 0 : sign < 0) ? open : window;
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
