/* Width. Let all lengths of a pair be below 2^t units, with 64 L limbs and t <= 64 L - 3 (a
 * component with its rest is the difference of two vertices: rest is at most half a unit in the
 * last place of it, so that what a component below 2^t was rounded from is at most 2^t). Their
 * differences (offset, drift, edges of a tetrahedron) are below 2^(t+1) and fit L limbs. An entry
 * of a normal is a difference of two products of those, below 2^(2t+3) <= 2^(128L-3), and fits
 * 2 L limbs. With a component its dot product is a sum of three, below 3 2^(3t+3); with an offset
 * or a drift, below 3 2^(3t+4). A gap sums at most one offset, one drift and six components:
 * 3 2^(3t+3) (2 + 2 + 6) < 2^(3t+8) <= 2^(192L-1): all of it fits 3 L limbs with a sign. In 2D the
 * normal is an edge, and everything is smaller. */
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

struct dyadic_span limbs_span_of(const struct fmb_pair *pair)
{
    const struct fmb_frame *frames[2] = {&pair->a, &pair->b};
    const struct dyadic window = dyadic_of(pair->duration);
    struct dyadic_span span = dyadic_span_begin(), speed = dyadic_span_begin();
    struct dyadic_span length = dyadic_span_begin();
    dyadic_span_add(&length, window);
    for (int f = 0; f < 2; f++) {
        const struct fmb_body *body = frames[f]->body;
        span.unit = integer_lower_unit(span.unit, body->bits[0]);
        span.top = -integer_lower_unit(-span.top, -body->bits[1]);
        for (int axis = 0; axis < body->dim; axis++) {
            dyadic_span_add(&span, dyadic_of(frames[f]->origin[axis]));
            if (frames[f]->moving)
                dyadic_span_add(&speed, dyadic_of(frames[f]->velocity[axis]));
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
    if (span.top - span.unit > 50 || pair->a->rounded || pair->b->rounded)
        return false;
    const bool cuboids = pair->a->shape == FMB_CUBOID && pair->b->shape == FMB_CUBOID;
    double largest = pair->drift_size;
    for (int i = 0; i < pair->a->dim; i++)
        largest = greatest(largest, greatest(pair->a->size[i], pair->b->size[i]));
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

/* out := sign x 2^-unit, of n limbs. A number of one limb is below 2^61 units, and units of numbers
 * in range are within 2^-261 and 2^200: the product is exact, and so is its conversion. */
static void set_length(int n, limbs_length out, double x, int sign, struct unit unit)
{
    static const struct dyadic one[2] = {{-1, 0}, {1, 0}};
    if (n == 1)
        out[0] = (uint64_t) (int64_t) (sign * x * unit.inverse);
    else
        set_product(n, out, dyadic_of(x), one[sign > 0], unit.exponent);
}

/* What one frame brings to the pair: the first with sign -1, the second with +1. */
static void add_frame(const struct fmb_frame *frame, int f, struct dyadic window, struct unit unit,
                      struct limbs_pair *out)
{
    const int n = out->limbs, sign = f ? 1 : -1;
    out->body[f] = frame->body;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        const bool there = axis < frame->body->dim;
        limbs_length term;
        for (int i = 0; i < frame->body->count; i++)
            set_length(n, out->component[f][i][axis], frame->body->component[i][axis], 1, unit);
        for (int i = 0; i < 2 && frame->body->rounded; i++) {
            set_length(n, term, frame->body->rest[i][axis], 1, unit);
            add(n, out->component[f][i][axis], term);
        }
        set_length(n, term, there ? frame->origin[axis] : 0, sign, unit);
        add(n, out->offset[axis], term);
        if (!frame->moving || !there)
            continue;
        struct dyadic speed = dyadic_of(frame->velocity[axis]);
        speed.mantissa *= sign;
        set_product(n, term, speed, window, unit.exponent);
        add(n, out->drift[axis], term);
    }
}

bool limbs_prepare(const struct fmb_pair *pair, struct dyadic_span span, struct limbs_pair *out)
{
    const struct dyadic window = dyadic_of(pair->duration);
    const long bits = span.top - span.unit;
    if (bits > 64 * LIMBS_MAX - 3)
        return false;
    out->limbs = bits <= 64 - 3 ? 1 : bits <= 128 - 3 ? 2 : bits <= 256 - 3 ? 4 : 8;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        memset(out->offset[axis], 0, (size_t) out->limbs * sizeof *out->offset[axis]);
        memset(out->drift[axis], 0, (size_t) out->limbs * sizeof *out->drift[axis]);
    }
    const struct unit unit = {span.unit, out->limbs == 1 ? ldexp(1, (int) -span.unit) : 0};
    add_frame(&pair->a, 0, window, unit, out);
    add_frame(&pair->b, 1, window, unit, out);
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
    const int dim = pair->body[f]->dim;
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
    if (pair->body[0]->dim == 2) {
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
    const struct fmb_body *body = pair->body[f];
    memset(range->low, 0, size);
    memset(range->high, 0, size);
    for (int i = 0; i < body->count; i++) {
        uint64_t at[VALUE_MAX];
        dot(n, normal, pair->component[f][i], at);
        if (body->shape == FMB_CUBOID)
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
