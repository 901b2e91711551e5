/* Orientations. With q scaled to integers, n R(q) is a matrix of integers, n = |q|^2. All lengths
 * of a pair are multiplied by a common positive factor, which changes no sign and no time: by the
 * product n_a n_b, or by n_a if that is n_b. With the unit of the pair they are integers then:
 * vectors of frame a are (n_a R_a v) n_b, positions are p n_a n_b.
 *
 * Width. Let all lengths of a pair be below 2^t units, with L limbs of 64 bits and t <= 64 L - 3 (a
 * component with its rest is the difference of two vertices: rest is at most half a unit in the
 * last place of it, so that what a component below 2^t was rounded from is at most 2^t). Lengths
 * that are multiplied are sums modulo 2^(64 L) of products modulo 2^(64 L), and right because they
 * are in range at the end: coordinates of numbers below 2^s become less than sqrt(3) n 2^s when
 * they are turned, n R(q) being n times a rotation, and p + R o is the sum of two such: t = s + 3
 * and the bits of the factor. Their differences (offset, drift, edges of a tetrahedron) are below
 * 2^(t+1) and fit L limbs. An entry of a normal is a difference of two products of those, below
 * 2^(2t+3) <= 2^(128L-3), and fits 2 L limbs. With a component its dot product is a sum of three,
 * below 3 2^(3t+3); with an offset or a drift, below 3 2^(3t+4). A gap sums at most one offset, one
 * drift and six components: 3 2^(3t+3) (2 + 2 + 6) < 2^(3t+8) <= 2^(192L-1): all of it fits 3 L
 * limbs with a sign. In 2D the normal is an edge, and everything is smaller. */
#include "limbs.h"

#include "inlined.h"

#include <math.h>
#include <string.h>

typedef unsigned __int128 two_limbs;

/* ---- Arithmetic: n is a constant wherever these are used ---- */

INLINE bool is_negative(const int n, const uint64_t *x)
{
    return x[n - 1] >> 63;
}

INLINE bool is_zero(const int n, const uint64_t *x)
{
    uint64_t bits = 0;
    for (int i = 0; i < n; i++)
        bits |= x[i];
    return bits == 0;
}

INLINE void add(const int n, uint64_t *x, const uint64_t *y)
{
    uint64_t carry = 0;
    for (int i = 0; i < n; i++) {
        two_limbs sum = (two_limbs) x[i] + y[i] + carry;
        x[i] = (uint64_t) sum;
        carry = (uint64_t) (sum >> 64);
    }
}

INLINE void subtract(const int n, uint64_t *x, const uint64_t *y)
{
    uint64_t borrow = 0;
    for (int i = 0; i < n; i++) {
        two_limbs difference = (two_limbs) x[i] - y[i] - borrow;
        x[i] = (uint64_t) difference;
        borrow = (uint64_t) (difference >> 64) & 1;
    }
}

/* out := x y as unsigned numbers, of nx + ny limbs. */
INLINE void multiply_limbs(const int nx, const uint64_t *x, const int ny, const uint64_t *y,
                           uint64_t *out)
{
    for (int i = 0; i < nx + ny; i++)
        out[i] = 0;
    UNROLL(2)
    for (int j = 0; j < ny; j++) {
        uint64_t carry = 0;
        UNROLL(4)
        for (int i = 0; i < nx; i++) {
            two_limbs sum = (two_limbs) x[i] * y[j] + out[i + j] + carry;
            out[i + j] = (uint64_t) sum;
            carry = (uint64_t) (sum >> 64);
        }
        out[nx + j] = carry;
    }
}

/* The same, made once for all larger widths. */
static __attribute__((noinline)) void multiply_many(int nx, const uint64_t *x, int ny,
                                                    const uint64_t *y, uint64_t *out)
{
    multiply_limbs(nx, x, ny, y, out);
}

/* out := x y, of nx + ny limbs. As an unsigned number, x is 2^(64 nx) more than it means where it
 * is negative, and so the product y 2^(64 nx) too much; y likewise. */
INLINE void multiply(const int nx, const uint64_t *x, const int ny, const uint64_t *y,
                     uint64_t *out)
{
    if (is_zero(nx, x) || is_zero(ny, y)) { /* often, where boxes lie along the axes */
        memset(out, 0, (size_t) (nx + ny) * sizeof *out);
        return;
    }
    if (nx + ny <= 6)
        multiply_limbs(nx, x, ny, y, out);
    else
        multiply_many(nx, x, ny, y, out);
    if (is_negative(nx, x))
        subtract(ny, out + nx, y);
    if (is_negative(ny, y))
        subtract(nx, out + ny, x);
}

enum { NORMAL_MAX = 2 * LIMBS_MAX, VALUE_MAX = 3 * LIMBS_MAX };

/* out := normal . w */
INLINE void dot(const int n, uint64_t normal[FMB_DIM_MAX][NORMAL_MAX],
                const limbs_length w[FMB_DIM_MAX], uint64_t out[VALUE_MAX])
{
    uint64_t term[VALUE_MAX];
    memset(out, 0, (size_t) (3 * n) * sizeof *out);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        if (is_zero(2 * n, normal[axis]) || is_zero(n, w[axis]))
            continue;
        multiply(2 * n, normal[axis], n, w[axis], term);
        add(3 * n, out, term);
    }
}

/* ---- From doubles ---- */

/* x / 2 */
static struct dyadic half_of(double x)
{
    struct dyadic half = dyadic_of(x);
    half.exponent -= half.mantissa != 0;
    return half;
}

/* The origin of a frame, which of a box is given by the centre and the size. */
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

static double greatest(double x, double y)
{
    return x > y ? x : y;
}

/* A gap of slabs.c is a sum of monomials u_i v_j w_k of lengths; its partial sums are at most
 * 6 |u| |v| T, in largest magnitudes. In units of the pair, with s the largest size and R the sum
 * of all (reach): two cuboids have |u|, |v| <= s and T <= 2 R, all of them integers. Else edges may
 * be differences of doubled components, |u|, |v| <= 4 s, or the half of a drift not an integer:
 * in halves of the unit all are integers, and |u|, |v| <= 4 s, T <= 2 R there too. Integers up to
 * 2^53 are doubles, and so are smaller multiples of larger units. The same holds for what offset,
 * drift and extents are computed from. */
bool limbs_never_round(const struct slabs_pair *pair, struct dyadic_span span)
{
    if (span.top - span.unit > 50 || pair->inexact)
        return false;
    const bool cuboids = pair->a.shape == FMB_CUBOID && pair->b.shape == FMB_CUBOID;
    double largest = pair->drift_size;
    for (int i = 0; i < pair->a.dim; i++)
        largest = greatest(largest, greatest(pair->a.size[i], pair->b.size[i]));
    const double scaled = ldexp(largest, (int) -span.unit);
    const double sum = 2 * ldexp(pair->reach, (int) -span.unit);
    return (cuboids ? 6 : 6 * 16) * scaled * scaled * sum < 0x1p53;
}

/* out := x y 2^-unit, of n limbs. */
static void set_product(int n, limbs_length out, struct dyadic x, struct dyadic y, long unit)
{
    const __int128 product = (__int128) x.mantissa * y.mantissa;
    const long shift = x.exponent + y.exponent - unit;
    memset(out, 0, (size_t) n * sizeof *out);
    if (product == 0)
        return;
    const two_limbs magnitude = (two_limbs) (product < 0 ? -product : product);
    const int word = (int) (shift / 64), bit = (int) (shift % 64);
    const uint64_t part[3] = {(uint64_t) magnitude << bit, (uint64_t) (magnitude >> (64 - bit)),
                              bit ? (uint64_t) (magnitude >> 64) >> (64 - bit) : 0};
    for (int i = 0; i < 3 && word + i < n; i++)
        out[word + i] = part[i];
    if (product < 0) {
        limbs_length negative = {0};
        subtract(n, negative, out);
        memcpy(out, negative, (size_t) n * sizeof *out);
    }
}

struct unit {
    long exponent;
    double inverse; /* 2^-exponent, if lengths have one limb */
};

/* out := x 2^-unit, of n limbs. A number of one limb is below 2^61 units, and units of numbers in
 * range are within 2^-261 and 2^200: the product is exact, and so is its conversion. */
static void set_length(int n, limbs_length out, double x, struct unit unit)
{
    static const struct dyadic one = {1, 0};
    if (n == 1)
        out[0] = (uint64_t) (int64_t) (x * unit.inverse);
    else
        set_product(n, out, dyadic_of(x), one, unit.exponent);
}

/* ---- Orientations ---- */

typedef __int128 wide;

enum { FACTOR_LIMBS = 4 };

/* n R(q), and n. */
struct turn {
    bool turned;
    wide row[FMB_DIM_MAX][FMB_DIM_MAX];
    two_limbs norm; /* 1 where it is not turned */
};

/* What the lengths of a frame, once turned, and those of none are multiplied by. */
struct factor {
    int bits; /* of all that lengths are multiplied by */
    uint64_t frame[2][2], all[FACTOR_LIMBS];
};

static uint64_t divisor_of(uint64_t x, uint64_t y)
{
    while (y) {
        const uint64_t rest = x % y;
        x = y;
        y = rest;
    }
    return x;
}

/* The quaternion in the least integers; false if they have more than 62 bits. Products of two and
 * sums of four of those fit 128 bits with a sign. */
static bool set_integers(const struct fmb_placement *placement, int64_t q[4])
{
    memset(q, 0, 4 * sizeof *q);
    struct dyadic_span span = dyadic_span_begin();
    const int count = placement->orientation_count;
    uint64_t divisor = 0;
    for (int i = 0; i < count; i++)
        dyadic_span_add(&span, dyadic_of(placement->orientation[i]));
    if (span.top - span.unit > 62)
        return false;
    for (int i = 0; i < count; i++) {
        const struct dyadic x = dyadic_of(placement->orientation[i]);
        q[i] = x.mantissa ? x.mantissa * ((int64_t) 1 << (x.exponent - span.unit)) : 0;
        if (divisor != 1)
            divisor = divisor_of((uint64_t) (q[i] < 0 ? -q[i] : q[i]), divisor);
    }
    for (int i = 0; i < count; i++)
        q[i] /= (int64_t) divisor;
    return true;
}

static bool set_turn(const struct fmb_placement *placement, struct turn *out)
{
    int64_t q[4];
    out->turned = placement->orientation_count != 0;
    out->norm = 1;
    if (!out->turned)
        return true;
    if (!set_integers(placement, q))
        return false;
    const bool plane = placement->orientation_count == 2;
    const wide w = q[0], x = plane ? 0 : q[1], y = plane ? 0 : q[2], z = plane ? q[1] : q[3];
    const wide row[FMB_DIM_MAX][FMB_DIM_MAX] = {
        {w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
        {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
        {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}};
    memcpy(out->row, row, sizeof row);
    out->norm = (two_limbs) (w * w + x * x + y * y + z * z);
    return true;
}

static int bits_of(int n, const uint64_t *x)
{
    while (n > 0 && x[n - 1] == 0)
        n--;
    return n == 0 ? 0 : 64 * n - __builtin_clzll(x[n - 1]);
}

static void set_factor(const struct turn turn[2], struct factor *out)
{
    memset(out, 0, sizeof *out);
    const bool same = turn[0].norm == turn[1].norm;
    for (int f = 0; f < 2; f++) {
        const two_limbs norm = same ? 1 : turn[!f].norm;
        out->frame[f][0] = (uint64_t) norm;
        out->frame[f][1] = (uint64_t) (norm >> 64);
    }
    const uint64_t norm[2] = {(uint64_t) turn[0].norm, (uint64_t) (turn[0].norm >> 64)};
    multiply_limbs(2, norm, 2, out->frame[0], out->all);
    out->bits = bits_of(FACTOR_LIMBS, out->all);
}

/* x := x y modulo 2^(64 n), y of ny limbs without a sign. */
static void scale(int n, uint64_t *x, int ny, const uint64_t *y)
{
    uint64_t product[LIMBS_MAX] = {0};
    if (bits_of(ny, y) == 1)
        return;
    for (int j = 0; j < ny && j < n; j++) {
        uint64_t carry = 0;
        for (int i = 0; i + j < n && y[j]; i++) {
            two_limbs sum = (two_limbs) x[i] * y[j] + product[i + j] + carry;
            product[i + j] = (uint64_t) sum;
            carry = (uint64_t) (sum >> 64);
        }
    }
    memcpy(x, product, (size_t) n * sizeof *x);
}

/* v := n R(q) v, and times the factor of its frame. */
static void turn_vector(int n, limbs_length v[FMB_DIM_MAX], const struct turn *turn,
                        const uint64_t factor[2])
{
    limbs_length out[FMB_DIM_MAX];
    for (int axis = 0; axis < FMB_DIM_MAX && turn->turned; axis++) {
        memset(out[axis], 0, (size_t) n * sizeof *out[axis]);
        for (int j = 0; j < FMB_DIM_MAX; j++) {
            const wide entry = turn->row[axis][j];
            const two_limbs magnitude = (two_limbs) (entry < 0 ? -entry : entry);
            const uint64_t limbs[2] = {(uint64_t) magnitude, (uint64_t) (magnitude >> 64)};
            limbs_length term;
            if (entry == 0 || is_zero(n, v[j]))
                continue;
            memcpy(term, v[j], (size_t) n * sizeof *term);
            scale(n, term, 2, limbs);
            if (entry < 0)
                subtract(n, out[axis], term);
            else
                add(n, out[axis], term);
        }
    }
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        if (turn->turned)
            memcpy(v[axis], out[axis], (size_t) n * sizeof *out[axis]);
        scale(n, v[axis], 2, factor);
    }
}

/* ---- Pairs ---- */

/* The origin of the frame in body coordinates. */
static void set_origin(int n, const struct fmb_frame *frame, struct unit unit,
                       limbs_length out[FMB_DIM_MAX])
{
    static const struct dyadic minus_one = {-1, 0};
    limbs_length term;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        const bool box = frame->shape == FMB_BOX;
        set_length(n, out[axis], box ? frame->centre[axis] : frame->origin[axis], unit);
        if (!box || axis >= frame->dim)
            continue;
        set_product(n, term, half_of(frame->component[axis][axis]), minus_one, unit.exponent);
        add(n, out[axis], term);
    }
}

static bool has_origin(const struct fmb_frame *frame)
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        if (frame->origin[axis] != 0 || frame->centre[axis] != 0)
            return true;
    return false;
}

static void add_signed(int n, uint64_t *x, int f, const uint64_t *y)
{
    if (f)
        add(n, x, y);
    else
        subtract(n, x, y);
}

/* What one frame brings to offset and drift: the first with sign -1, the second with +1. */
static void add_place(const struct placed_frame *placed, int f, struct dyadic window,
                      struct unit unit, const struct turn *turn, const struct factor *factor,
                      struct limbs_pair *out)
{
    const int n = out->limbs;
    const struct fmb_placement *placement = placed->placement;
    limbs_length origin[FMB_DIM_MAX], term;
    for (int axis = 0; axis < placed->frame->dim; axis++) {
        set_length(n, term, placement->position[axis], unit);
        scale(n, term, FACTOR_LIMBS, factor->all);
        add_signed(n, out->offset[axis], f, term);
        set_product(n, term, dyadic_of(placement->velocity[axis]), window, unit.exponent);
        scale(n, term, FACTOR_LIMBS, factor->all);
        add_signed(n, out->drift[axis], f, term);
    }
    if (!has_origin(placed->frame))
        return;
    set_origin(n, placed->frame, unit, origin);
    turn_vector(n, origin, turn, factor->frame[f]);
    for (int axis = 0; axis < placed->frame->dim; axis++)
        add_signed(n, out->offset[axis], f, origin[axis]);
}

static void set_components(const struct fmb_frame *frame, int f, struct unit unit,
                           const struct turn *turn, const struct factor *factor,
                           struct limbs_pair *out)
{
    const int n = out->limbs;
    limbs_length term;
    for (int i = 0; i < frame->count; i++) {
        limbs_length *component = out->component[f][i];
        for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
            set_length(n, component[axis], frame->component[i][axis], unit);
            if (!frame->rounded)
                continue;
            set_length(n, term, frame->rest[i][axis], unit);
            add(n, component[axis], term);
        }
        turn_vector(n, component, turn, factor->frame[f]);
    }
}

bool limbs_prepare(const struct frame_pair *pair, struct dyadic_span span, struct limbs_pair *out)
{
    const struct placed_frame *placed[2] = {&pair->a, &pair->b};
    const struct dyadic window = dyadic_of(pair->duration);
    struct turn turn[2];
    struct factor factor;
    if (!set_turn(placed[0]->placement, &turn[0]) || !set_turn(placed[1]->placement, &turn[1]))
        return false;
    set_factor(turn, &factor);
    const bool origins = has_origin(placed[0]->frame) || has_origin(placed[1]->frame);
    const long bits = span.top - span.unit + factor.bits - 1 +
                      (turn[0].turned || turn[1].turned ? 3
                       : origins                        ? 2
                                                        : 0);
    if (bits > 64 * LIMBS_MAX - 3)
        return false;
    out->limbs = bits <= 64 - 3 ? 1 : bits <= 128 - 3 ? 2 : bits <= 256 - 3 ? 4 : 8;
    memset(out->offset, 0, sizeof out->offset);
    memset(out->drift, 0, sizeof out->drift);
    const struct unit unit = {span.unit, out->limbs == 1 ? ldexp(1, (int) -span.unit) : 0};
    for (int f = 0; f < 2; f++) {
        out->frame[f] = placed[f]->frame;
        add_place(placed[f], f, window, unit, &turn[f], &factor, out);
        set_components(placed[f]->frame, f, unit, &turn[f], &factor, out);
    }
    out->drifts = false;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out->drifts = out->drifts || !is_zero(out->limbs, out->drift[axis]);
    return true;
}

/* ---- Slabs ---- */

struct value_range {
    uint64_t low[VALUE_MAX], high[VALUE_MAX];
};

typedef const limbs_length *limbs_vector; /* of FMB_DIM_MAX */

/* Difference edges as slabs.h numbers them: with p, q, r cyclic, number 3 + r is c_q - c_p. */
INLINE limbs_vector edge_of(const int n, const struct limbs_pair *pair, int edge,
                            limbs_length scratch[FMB_DIM_MAX])
{
    if (edge == SLABS_DRIFT)
        return pair->drift;
    const int f = edge >= SLABS_EDGE_OF_B, e = f ? edge - SLABS_EDGE_OF_B : edge;
    const int dim = pair->frame[f]->dim;
    if (e < dim)
        return pair->component[f][e];
    const int p = dim == 2 ? 0 : (e + 1) % 3, q = dim == 2 ? 1 : (e + 2) % 3;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        memcpy(scratch[axis], pair->component[f][q][axis], (size_t) n * sizeof *scratch[axis]);
        subtract(n, scratch[axis], pair->component[f][p][axis]);
    }
    return (limbs_vector) scratch;
}

INLINE void set_plane_normal(const int n, limbs_vector e, uint64_t normal[FMB_DIM_MAX][NORMAL_MAX])
{
    static const uint64_t zero[LIMBS_MAX], plus[LIMBS_MAX] = {1};
    uint64_t minus[LIMBS_MAX];
    memset(minus, 0xff, sizeof minus);
    multiply(n, e[1], n, minus, normal[0]);
    multiply(n, e[0], n, plus, normal[1]);
    multiply(n, zero, n, zero, normal[2]);
}

INLINE void set_normal(const int n, const struct limbs_pair *pair, struct slab_normal edges,
                       uint64_t normal[FMB_DIM_MAX][NORMAL_MAX])
{
    limbs_length scratch[2][FMB_DIM_MAX];
    uint64_t term[NORMAL_MAX];
    const limbs_vector u = edge_of(n, pair, edges.u, scratch[0]);
    if (pair->frame[0]->dim == 2) {
        set_plane_normal(n, u, normal);
        return;
    }
    const limbs_vector v = edge_of(n, pair, edges.v, scratch[1]);
    UNROLL(3)
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        multiply(n, u[j], n, v[k], normal[i]);
        multiply(n, u[k], n, v[j], term);
        subtract(2 * n, normal[i], term);
    }
}

INLINE bool less(const int n, const uint64_t *x, const uint64_t *y)
{
    uint64_t difference[VALUE_MAX];
    memcpy(difference, x, (size_t) n * sizeof *x);
    subtract(n, difference, y);
    return is_negative(n, difference);
}

INLINE void set_extent(const int n, const struct limbs_pair *pair, int f,
                       uint64_t normal[FMB_DIM_MAX][NORMAL_MAX], struct value_range *range)
{
    const size_t size = (size_t) (3 * n) * sizeof *range->low;
    const struct fmb_frame *frame = pair->frame[f];
    memset(range->low, 0, size);
    memset(range->high, 0, size);
    for (int i = 0; i < frame->count; i++) {
        uint64_t at[VALUE_MAX];
        dot(n, normal, pair->component[f][i], at);
        if (!frame_is_simplex(frame))
            add(3 * n, is_negative(3 * n, at) ? range->low : range->high, at);
        else if (less(3 * n, at, range->low))
            memcpy(range->low, at, size);
        else if (less(3 * n, range->high, at))
            memcpy(range->high, at, size);
    }
}

struct slab_limbs {
    struct value_range between; /* low and high */
    uint64_t start[VALUE_MAX], slope[VALUE_MAX];
};

/* False, and nothing set, where the normal is zero. */
INLINE bool set_slab(const int n, const struct limbs_pair *pair, struct slab_normal edges,
                     struct slab_limbs *out)
{
    uint64_t normal[FMB_DIM_MAX][NORMAL_MAX];
    struct value_range b;
    set_normal(n, pair, edges, normal);
    if (is_zero(2 * n, normal[0]) && is_zero(2 * n, normal[1]) && is_zero(2 * n, normal[2]))
        return false;
    set_extent(n, pair, 0, normal, &out->between);
    set_extent(n, pair, 1, normal, &b);
    subtract(3 * n, out->between.low, b.high);
    subtract(3 * n, out->between.high, b.low);
    dot(n, normal, pair->offset, out->start);
    if (pair->drifts)
        dot(n, normal, pair->drift, out->slope);
    else
        memset(out->slope, 0, (size_t) (3 * n) * sizeof *out->slope);
    return true;
}

INLINE int sign(const int n, const uint64_t *x)
{
    return is_negative(n, x) ? -1 : !is_zero(n, x);
}

/* The gap is the larger of start + min(0, slope) - high and low - start - max(0, slope). */
INLINE int gap_sign(const int n, const struct limbs_pair *pair, struct slab_normal edges)
{
    struct slab_limbs slab;
    if (!set_slab(n, pair, edges, &slab))
        return -1;
    uint64_t above[VALUE_MAX];
    uint64_t *below = slab.between.low;
    memcpy(above, slab.start, (size_t) (3 * n) * sizeof *above);
    add(3 * n, is_negative(3 * n, slab.slope) ? above : slab.start, slab.slope);
    subtract(3 * n, above, slab.between.high);
    subtract(3 * n, below, slab.start);
    const int sign_above = sign(3 * n, above), sign_below = sign(3 * n, below);
    return sign_above > sign_below ? sign_above : sign_below;
}

int limbs_gap_sign(const struct limbs_pair *pair, struct slab_normal normal)
{
    switch (pair->limbs) {
    case 1: return gap_sign(1, pair, normal);
    case 2: return gap_sign(2, pair, normal);
    case 4: return gap_sign(4, pair, normal);
    default: return gap_sign(8, pair, normal);
    }
}

/* Planes are parallel where the normal of a has no extent along the other face. */
INLINE struct limbs_planes planes_of(const int n, const struct limbs_pair *pair)
{
    uint64_t normal[FMB_DIM_MAX][NORMAL_MAX], at[4][VALUE_MAX];
    set_normal(n, pair, (struct slab_normal){0, 1}, normal);
    dot(n, normal, pair->component[1][0], at[0]);
    dot(n, normal, pair->component[1][1], at[1]);
    dot(n, normal, pair->offset, at[2]);
    dot(n, normal, pair->drift, at[3]);
    const bool parallel = is_zero(3 * n, at[0]) && is_zero(3 * n, at[1]);
    return (struct limbs_planes){
        .parallel = parallel, .shared = parallel && is_zero(3 * n, at[2]) && is_zero(3 * n, at[3])};
}

struct limbs_planes limbs_planes_of(const struct limbs_pair *pair)
{
    switch (pair->limbs) {
    case 1: return planes_of(1, pair);
    case 2: return planes_of(2, pair);
    case 4: return planes_of(4, pair);
    default: return planes_of(8, pair);
    }
}

static void to_mpz(int n, uint64_t *x, mpz_t out)
{
    const bool negative = is_negative(n, x);
    uint64_t magnitude[VALUE_MAX] = {0};
    if (negative)
        subtract(n, magnitude, x);
    else
        memcpy(magnitude, x, (size_t) n * sizeof *x);
    mpz_import(out, (size_t) n, -1, sizeof *x, 0, 0, magnitude);
    if (negative)
        mpz_neg(out, out);
}

void limbs_slab(const struct limbs_pair *pair, struct slab_normal normal, mpz_t low, mpz_t high,
                mpz_t start, mpz_t slope)
{
    struct slab_limbs slab;
    bool says_something = false;
    switch (pair->limbs) {
    case 1: says_something = set_slab(1, pair, normal, &slab); break;
    case 2: says_something = set_slab(2, pair, normal, &slab); break;
    case 4: says_something = set_slab(4, pair, normal, &slab); break;
    default: says_something = set_slab(8, pair, normal, &slab); break;
    }
    if (!says_something)
        memset(&slab, 0, sizeof slab);
    const int n = 3 * pair->limbs;
    to_mpz(n, slab.between.low, low);
    to_mpz(n, slab.between.high, high);
    to_mpz(n, slab.start, start);
    to_mpz(n, slab.slope, slope);
}
