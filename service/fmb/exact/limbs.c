/* A pair in integers of fixed width.
 *
 *   In     a pair of frames and its span: the powers of two that bound its lengths
 *   Out    struct limbs_pair, from which limbs_slab.c computes slabs; false if it needs more than
 *          LIMBS_MAX limbs
 *
 * Steps (limbs_prepare()): quaternions to integers (limbs_rotation.c); the number of limbs,
 * bits_of(); offset and drift, add_place(); frames, set_frame(); the matrices between the
 * coordinate systems, set_same_turn() or set_turns(). limbs_never_round() is separate: it tells
 * whether doubles are exact.
 *
 * Coordinates. With q scaled to integers, n R(q) is a matrix of integers, n = |q|^2. Components and
 * origins stay in the coordinates of their frame; positions and displacements stay in those of the
 * world. All are integers times the unit of the pair. The normal of a slab is computed three times:
 * in the coordinates of A, of B and of the world. Each time it is multiplied by a positive factor,
 * which differs. The extents of A and of B are taken along the first two normals, the offset and
 * the drift along the third. Let M_f = n_f R_f, n = n_a n_b, and let K_f = M_g^T M_f map from f to
 * the other frame g. Each normal is followed by its factor:
 *
 *     normal of                 in f               in g                   in the world
 *     edges u of f, v of g      u x K_g v    n     K_f u x v          n   M_f u x M_g v  n
 *     face u x v of f           u x v        1     K_f (u x v)        n   M_f (u x v)    n_f
 *     edge u of f, the drift h  u x M_f^T h  n_f   M_g^T (M_f u x h)  n   M_f u x h      n_f
 *
 * Each result is multiplied by n over its factor, so that the numbers of a slab are n times those
 * of the pair. In 2D a normal is an edge rotated by a right angle. That of an edge of f is treated
 * as the face of f; that of the drift has the factor 1 in the world and n_f in f.
 *
 * Frames of equal orientation are decided in their own coordinates, in which neither is rotated.
 * Offset and drift are M^T d and M^T h, n times their values, and extents are multiplied by n. The
 * numbers of a slab are n times those of the pair, or n^2 times if the drift is in its normal.
 *
 * Only the direction of an edge matters. The edges of a box are unit vectors in its coordinates, or
 * 0 on an axis of size 0. A box is described by its centre and half its components.
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
 * below 2^(3t+8+s). L limbs hold it with a sign if 3t + 8 + s < 64 L. A normal in the plane of a
 * face has one more edge of at most 2 r < 2^(t+2) as a factor. All results are sums of products
 * modulo 2^(64 L); they are correct because their final values are in range. A quaternion of
 * integers below 2^b has n < 2^(2b+2). In 2D all bounds are smaller. */
#include "limbs.h"

#include "interval.h"

#include <math.h>

/* ---- From doubles ---- */

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
        span.unit = integer_lower_unit(span.unit, frame->bits[0]);
        span.top = -integer_lower_unit(-span.top, -frame->bits[1]);
        for (int axis = 0; axis < frame->dim; axis++) {
            add_origin(&span, frame, axis);
            dyadic_span_add(&span, dyadic_of(placement->position[axis]));
            dyadic_span_add(&speed, dyadic_of(placement->velocity[axis]));
        }
    }
    if (speed.unit < INTEGER_NO_EXPONENT && window.mantissa) {
        span.unit = integer_lower_unit(span.unit, speed.unit + length.unit);
        span.top = -integer_lower_unit(-span.top, -(speed.top + length.top));
    }
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

/* The scale of all lengths of a pair. */
struct scale {
    struct dyadic window;
    long unit;
    double inverse; /* 2^-unit; 0 if a length may need more than one limb */
};

/* out := x 2^-unit, in n limbs; returns how many it needs. If inverse is not 0, the product is
 * exact, since it is below 2^62, and so is its conversion. */
static int set_length(int n, uint64_t *out, double x, const struct scale *scale)
{
    static const struct dyadic one = {1, 0};
    if (scale->inverse == 0) {
        limbs_set_product(n, out, dyadic_of(x), one, scale->unit);
        return limbs_needed(n, out);
    }
    const int64_t whole = (int64_t) (x * scale->inverse);
    out[0] = (uint64_t) whole;
    for (int i = 1; i < n; i++)
        out[i] = whole < 0 ? UINT64_MAX : 0;
    return whole != 0;
}

static void set_lengths(int n, struct limbs_vector *out, const double x[FMB_DIM_MAX],
                        const struct scale *scale)
{
    out->limbs = 0;
    out->other_than_0 = 0;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        const int limbs = set_length(n, out->at[axis], x[axis], scale);
        out->limbs = limbs > out->limbs ? limbs : out->limbs;
        out->other_than_0 |= (unsigned) (limbs > 0) << axis;
    }
}

/* ---- Pairs ---- */

/* Adds the position and velocity of a frame to offset and drift, or subtracts them. */
static void add_place(const struct placed_frame *placed, bool minus, const struct scale *scale,
                      struct limbs_pair *out)
{
    const int n = out->limbs;
    const struct fmb_placement *placement = placed->placement;
    limbs_number term;
    for (int axis = 0; axis < placed->frame->dim; axis++) {
        set_length(n, term, placement->position[axis], scale);
        (minus ? subtract : add)(n, out->offset.at[axis], term);
        if (placement->velocity[axis] == 0)
            continue;
        limbs_set_product(n, term, dyadic_of(placement->velocity[axis]), scale->window,
                          scale->unit);
        (minus ? subtract : add)(n, out->drift.at[axis], term);
    }
}

/* For a box: half of its components, and its centre as the origin. */
static void set_frame(int f, const struct fmb_frame *frame, const struct scale *scale,
                      struct limbs_pair *out)
{
    const int n = out->limbs;
    const bool box = frame->shape == FMB_BOX;
    const struct scale half = {scale->window, scale->unit + 1, scale->inverse / 2};
    limbs_number term;
    out->frame[f] = frame;
    set_lengths(n, &out->origin[f], box ? frame->centre : frame->origin, scale);
    for (int i = 0; i < frame->count; i++) {
        struct limbs_vector *component = &out->component[f][i];
        set_lengths(n, component, frame->component[i], box ? &half : scale);
        if (!frame->rounded)
            continue;
        for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
            set_length(n, term, frame->remainder[i][axis], scale);
            add(n, component->at[axis], term);
        }
        limbs_trim(n, component);
    }
}

/* In: offset and drift in world coordinates. */
static void set_same_turn(const struct limbs_quaternion *q, struct limbs_pair *out)
{
    const int n = out->limbs;
    struct limbs_rotation *rotation = &out->rotation[0];
    const struct limbs_vector offset = out->offset, drift = out->drift;
    limbs_set_rotation(n, q, rotation);
    limbs_transform(n, rotation->row[1], &offset, &out->offset);
    limbs_transform(n, rotation->row[1], &drift, &out->drift);
    limbs_trim(n, &out->offset);
    limbs_trim(n, &out->drift);
    out->common = &rotation->norm;
}

static void set_turns(const struct limbs_quaternion q[2], struct limbs_pair *out)
{
    struct limbs_rotation *rotation = out->rotation;
    for (int f = 0; f < 2; f++) {
        if (!q[f].turned)
            continue;
        limbs_set_rotation(out->limbs, &q[f], &rotation[f]);
        out->to_world[f] = out->across[f] = rotation[f].row[0];
        out->from_world[f] = out->across[!f] = rotation[f].row[1];
        out->norm[f] = out->all = &rotation[f].norm;
    }
    if (!q[0].turned || !q[1].turned)
        return;
    limbs_set_relative(out->limbs, &rotation[0], &rotation[1], &out->relative);
    out->across[1] = out->relative.row[0];
    out->across[0] = out->relative.row[1];
    out->all = &out->relative.norm;
}

/* Bounds the bits of the numbers of slabs, without a sign. Derived at the top of this file. */
static long bits_of(const struct frame_pair *pair, struct dyadic_span span,
                    const struct limbs_quaternion q[2], bool same, bool in_faces)
{
    const bool moves = pair_moves(pair);
    const bool boxes = pair->a.frame->shape == FMB_BOX && pair->b.frame->shape == FMB_BOX;
    const long length = span.top > span.unit ? span.top - span.unit : 0;
    long bits = (!boxes ? 3 : moves ? 2 : 1) * length + 8;
    if (in_faces)
        bits += length + 2;
    for (int f = 0; f < 2; f++)
        if (q[f].turned && !(f == 1 && same && !moves))
            bits += 2 * q[f].bits + 2;
    return bits;
}

static bool prepare(const struct frame_pair *pair, struct dyadic_span span, bool in_faces,
                    struct limbs_pair *out)
{
    const struct placed_frame *placed[2] = {&pair->a, &pair->b};
    struct limbs_quaternion q[2];
    limbs_set_quaternion(placed[0]->placement, &q[0]);
    limbs_set_quaternion(placed[1]->placement, &q[1]);
    const bool same = limbs_same_rotation(&q[0], &q[1]);
    const long limbs = bits_of(pair, span, q, same, in_faces) / 64 + 1;
    if (limbs > LIMBS_MAX)
        return false;
    const int n = out->limbs = limbs < 2 ? 2 : (int) limbs;
    const bool one = span.top - span.unit <= 61 && span.unit >= -1000 && span.unit <= 1000;
    const struct scale scale = {dyadic_of(pair->duration), span.unit,
                                one ? ldexp(1, (int) -span.unit) : 0};
    out->common = out->all = out->norm[0] = out->norm[1] = NULL;
    memset(out->to_world, 0, sizeof out->to_world);
    memset(out->from_world, 0, sizeof out->from_world);
    memset(out->across, 0, sizeof out->across);
    memset(out->view, 0, sizeof out->view);
    memset(&out->offset, 0, sizeof out->offset);
    memset(&out->drift, 0, sizeof out->drift);
    for (int f = 0; f < 2; f++) {
        add_place(placed[f], f == 0, &scale, out);
        set_frame(f, placed[f]->frame, &scale, out);
    }
    limbs_trim(n, &out->offset);
    limbs_trim(n, &out->drift);
    if (same && q[0].turned)
        set_same_turn(&q[0], out);
    else
        set_turns(q, out);
    return true;
}

bool limbs_prepare(const struct frame_pair *pair, struct dyadic_span span, struct limbs_pair *out)
{
    return prepare(pair, span, false, out);
}

bool limbs_prepare_faces(const struct frame_pair *pair, struct dyadic_span span,
                         struct limbs_pair *out)
{
    return prepare(pair, span, pair->a.frame->shape == FMB_FACE || pair->b.frame->shape == FMB_FACE,
                   out);
}
