/* Questions about pairs in integers.
 *
 *   In     a pair of frames, and what is needed
 *   Out    struct limbs_question, with the number of limbs (limbs_answers.c answers it)
 *
 * limbs_never_round() is separate: it tells whether doubles are exact. Not here: the numbers
 * (limbs_pair.h) and slabs (limbs_slab.h) of a pair.
 *
 * Width. Let all lengths of a pair be below 2^t units. (A component with its rest is the difference
 * of two vertices. The rest is at most half a unit in the last place of the component, so that the
 * exact value of a component below 2^t is at most 2^t.) In lengths of r = sqrt(3) 2^t, a component
 * is at most 1, an edge that is a difference 2, offset and drift 2 each, an origin 1. A number of a
 * slab is at most |u| |v| times the sum of one offset, one drift, two origins, and all components
 * of a cuboid or one of a simplex:
 *
 *     two cuboids             1 2 (2 + 2 + 2 + 6) = 24 r^3 < 125 2^(3t)
 *     cuboid and simplex      2 2 (2 + 2 + 2 + 4) = 40 r^3 < 208 2^(3t)
 *     two simplices           2 2 (2 + 2 + 2 + 2) = 32 r^3 < 167 2^(3t)
 *
 * All are below 2^(3t+8); the largest are slabs of the drift. For two boxes, whose edges have
 * length 1, a slab is below 2^(t+8), and one of the drift below 2^(2t+8). Rotations preserve
 * lengths. With a factor of at most 2^s, every number of a slab and every intermediate factor is
 * below 2^(3t+8+s). L limbs hold it with a sign if 3t + 8 + s < 64 L. All results are sums
 * of products modulo 2^(64 L); they are correct because their final values are in range. A
 * quaternion of integers below 2^b has n < 2^(2b+2). In 2D all bounds are smaller.
 *
 * Normals of flat frames in the plane of two edges have one edge and one axis of the world as
 * factors. The edge comes from its frame to the world, by n_f, and to the coordinates of both: such
 * products are below 2^(2t+8), times n n_f. (limbs_decide.h) */
#include "limbs.h"

#include "interval.h"
#include "slabs.h"

#include <math.h>
#include <stdlib.h>

/* ---- Lengths ---- */

/* x / 2 */
static struct dyadic half_of(double x)
{
    struct dyadic half = dyadic_of(x);
    half.exponent -= half.mantissa != 0;
    return half;
}

/* Adds the origin of a frame; that of a box is given by its centre and size. */
static void add_origin(struct dyadic_span *span, const struct fmb_frame *frame, int axis)
{
    if (frame->shape != FMB_BOX) {
        dyadic_span_add(span, dyadic_of(frame->origin[axis]));
        return;
    }
    dyadic_span_add(span, dyadic_of(frame->centre[axis]));
    dyadic_span_add(span, half_of(frame->component[axis][axis]));
}

struct dyadic_span limbs_span_of(const struct frame_pair *pair)
{
    const struct placed_frame *placed[2] = {&pair->a, &pair->b};
    const struct dyadic window = dyadic_of(pair->duration);
    struct dyadic_span span = dyadic_span_begin(), speed = dyadic_span_begin();
    struct dyadic_span length = dyadic_span_begin();
    dyadic_span_add(&length, window);
    for (int f = 0; f < 2; f++) {
        const struct fmb_frame *frame = placed[f]->frame;
        const struct fmb_placement *placement = placed[f]->placement;
        dyadic_span_extend(&span, frame->bits[0], frame->bits[1]);
        dyadic_span_add(&span, dyadic_of(frame->radius));
        for (int axis = 0; axis < frame->dim; axis++) {
            add_origin(&span, frame, axis);
            dyadic_span_add(&span, dyadic_of(placement->position[axis]));
            dyadic_span_add(&speed, dyadic_of(placement->velocity[axis]));
        }
    }
    if (speed.unit < INTEGER_NO_EXPONENT && window.mantissa)
        dyadic_span_extend(&span, speed.unit + length.unit, speed.top + length.top);
    return span;
}

/* A gap of slabs.c is a sum of monomials u_i v_j w_k of lengths. Its partial sums are at most 6 |u|
 * |v| T, in largest magnitudes. Count in units of the pair; let s be the largest size and R the sum
 * of all (reach). For two cuboids |u|, |v| <= s and T <= 2 R, and all of them are integers.
 * Otherwise edges may be differences of doubled components, with |u|, |v| <= 4 s, or half of a
 * drift may not be an integer. In halves of the unit all are integers, and there too |u|, |v| <= 4
 * s and T <= 2 R. Integers up to 2^53 are doubles, and so are smaller multiples of larger units.
 * The same holds for the numbers from which offset, drift and extents are computed. */
bool limbs_never_round(const struct slabs_pair *pair, struct dyadic_span span)
{
    if (span.top - span.unit > 50 || pair->inexact)
        return false;
    const bool cuboids = pair->a.shape == FMB_CUBOID && pair->b.shape == FMB_CUBOID;
    double largest = pair->drift_size;
    for (int i = 0; i < pair->a.dim; i++)
        largest = interval_max(largest, interval_max(pair->a.size[i], pair->b.size[i]));
    const double scaled = ldexp(largest, (int) -span.unit);
    const double sum = 2 * ldexp(pair->reach, (int) -span.unit);
    return (cuboids ? 6 : 6 * 16) * scaled * scaled * sum < 0x1p53;
}

/* ---- Orientations ---- */

/* Returns the greatest common divisor, by the binary algorithm; of 0 and y, y. In: x is 0 or odd.
 */
static uint64_t common_divisor_of(uint64_t x, uint64_t y)
{
    if (x == 0 || y == 0)
        return x | y;
    while (y) {
        y >>= __builtin_ctzll(y);
        const uint64_t least = x < y ? x : y;
        y = x < y ? y - x : x - y;
        x = least;
    }
    return x;
}

/* The mantissas of dyadic numbers are odd: a common
 * divisor of the integers, which are multiples of these by powers of two, divides all mantissas. */
void limbs_quaternion_set(const struct fmb_placement *placement, struct limbs_quaternion *out)
{
    const double *q = placement->orientation;
    const bool plane = placement->orientation_count == 2;
    const double given[4] = {q[0], plane ? 0 : q[1], plane ? 0 : q[2], q[plane ? 1 : 3]};
    struct dyadic_span span = dyadic_span_begin();
    uint64_t divisor = 0;
    memset(out, 0, sizeof *out);
    out->turned = given[1] != 0 || given[2] != 0 || given[3] != 0;
    for (int i = 0; i < 4 && out->turned; i++) {
        out->at[i] = dyadic_of(given[i]);
        if (divisor != 1)
            divisor = common_divisor_of((uint64_t) llabs(out->at[i].mantissa), divisor);
    }
    for (int i = 0; i < 4 && out->turned; i++) {
        if (divisor > 1)
            out->at[i].mantissa /= (long long) divisor;
        dyadic_span_add(&span, out->at[i]);
    }
    out->unit = out->turned ? span.unit : 0;
    out->bits = out->turned ? (int) (span.top - span.unit) : 0;
}

/* Whether both are the same rotation. */
static bool are_same(const struct limbs_quaternion *a, const struct limbs_quaternion *b)
{
    bool equal = true, opposite = true;
    for (int i = 0; i < 4; i++) {
        const struct dyadic x = a->at[i], y = b->at[i];
        const bool same = x.mantissa == 0 || x.exponent - a->unit == y.exponent - b->unit;
        equal = equal && same && x.mantissa == y.mantissa;
        opposite = opposite && same && x.mantissa == -y.mantissa;
    }
    return equal || opposite;
}

/* ---- Questions ---- */

void limbs_question_set(const struct frame_pair *pair, struct dyadic_span span, enum limbs_use use,
                        struct limbs_question *out)
{
    const bool moves = pair_moves(pair);
    const bool boxes = pair->a.frame->shape == FMB_BOX && pair->b.frame->shape == FMB_BOX;
    const long length = span.top > span.unit ? span.top - span.unit : 0;
    const bool flat = use == LIMBS_FLAT && pair->a.frame->flat + pair->b.frame->flat > 0;
    long norms = 0, most = 0;
    out->pair = pair;
    out->span = span;
    limbs_quaternion_set(pair->a.placement, &out->q[0]);
    limbs_quaternion_set(pair->b.placement, &out->q[1]);
    out->same = are_same(&out->q[0], &out->q[1]);
    for (int f = 0; f < 2; f++) {
        const long norm = out->q[f].turned ? 2 * out->q[f].bits + 2 : 0;
        most = norm > most ? norm : most;
        if (!(f == 1 && out->same && !moves))
            norms += norm;
    }
    long bits = (!boxes || flat ? 3 : moves ? 2 : 1) * length + 8 + norms;
    if (flat && bits < 2 * length + 8 + norms + most)
        bits = 2 * length + 8 + norms + most;
    out->limbs = bits < 128 ? 2 : (int) (bits / 64) + 1;
}
