/* Width. Let all lengths of a pair be below 2^t units, with 64 L limbs and t <= 64 L - 3. Their
 * differences (offset, drift, edges of a tetrahedron) are below 2^(t+1) and fit L limbs. An entry
 * of a normal is a difference of two products of those, below 2^(2t+3) <= 2^(128L-3), and fits
 * 2 L limbs. With a component its dot product is a sum of three, below 3 2^(3t+3); with an offset
 * or a drift, below 3 2^(3t+4). A gap sums at most one offset, one drift and six components:
 * 3 2^(3t+3) (2 + 2 + 6) < 2^(3t+8) <= 2^(192L-1): all of it fits 3 L limbs with a sign. In 2D the
 * normal is an edge, and everything is smaller. */
#include "limbs.h"

#include <math.h>
#include <string.h>

#define INLINE static inline __attribute__((always_inline))

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
#pragma GCC unroll 12
    for (int i = 0; i < n; i++) {
        two_limbs sum = (two_limbs) x[i] + y[i] + carry;
        x[i] = (uint64_t) sum;
        carry = (uint64_t) (sum >> 64);
    }
}

INLINE void subtract(const int n, uint64_t *x, const uint64_t *y)
{
    uint64_t borrow = 0;
#pragma GCC unroll 12
    for (int i = 0; i < n; i++) {
        two_limbs difference = (two_limbs) x[i] - y[i] - borrow;
        x[i] = (uint64_t) difference;
        borrow = (uint64_t) (difference >> 64) & 1;
    }
}

/* out := x y, of nx + ny limbs. As unsigned numbers, x is 2^(64 nx) more than it means where it is
 * negative, and so the product y 2^(64 nx) too much; y likewise. */
INLINE void multiply(const int nx, const uint64_t *x, const int ny, const uint64_t *y,
                     uint64_t *out)
{
    memset(out, 0, (size_t) (nx + ny) * sizeof *out);
#pragma GCC unroll 4
    for (int j = 0; j < ny; j++) {
        uint64_t carry = 0;
#pragma GCC unroll 8
        for (int i = 0; i < nx; i++) {
            two_limbs sum = (two_limbs) x[i] * y[j] + out[i + j] + carry;
            out[i + j] = (uint64_t) sum;
            carry = (uint64_t) (sum >> 64);
        }
        out[nx + j] = carry;
    }
    if (is_negative(nx, x))
        subtract(ny, out + nx, y);
    if (is_negative(ny, y))
        subtract(nx, out + ny, x);
}

enum { NORMAL_MAX = 2 * LIMBS_MAX, VALUE_MAX = 3 * LIMBS_MAX };

/* out := normal . w. Axes in which either is 0, as in every scene of boxes along the axes, cost
 * next to nothing. */
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

/* A gap of slabs.c is a sum of monomials u_i v_j w_k of lengths, integers in units; its partial
 * sums are integers of at most 6 |u| |v| T (slabs.c), with |u| and |v| at most twice the largest
 * size. Integers up to 2^53 are doubles, and so are smaller multiples of larger units. The same
 * holds for what offset, drift and extents are computed from. */
bool limbs_never_round(const struct slabs_pair *pair, struct dyadic_span span)
{
    if (span.top - span.unit > 50)
        return false;
    double largest = pair->drift_size;
    for (int i = 0; i < pair->a->dim; i++)
        largest = greatest(largest, greatest(pair->a->size[i], pair->b->size[i]));
    const double scaled = ldexp(largest, (int) -span.unit);
    return 32 * scaled * scaled * ldexp(pair->reach, (int) -span.unit) < 0x1p53;
}

/* out := x y 2^-unit, of n limbs. */
static void set_product(int n, limbs_length out, struct dyadic x, struct dyadic y, long unit)
{
    memset(out, 0, sizeof(limbs_length));
    if (x.mantissa == 0 || y.mantissa == 0)
        return;
    const __int128 product = (__int128) x.mantissa * y.mantissa;
    const two_limbs magnitude = (two_limbs) (product < 0 ? -product : product);
    const long shift = x.exponent + y.exponent - unit;
    const int word = (int) (shift / 64), bit = (int) (shift % 64);
    const uint64_t part[3] = {(uint64_t) magnitude << bit, (uint64_t) (magnitude >> (64 - bit)),
                              bit ? (uint64_t) (magnitude >> 64) >> (64 - bit) : 0};
    for (int i = 0; i < 3 && word + i < n; i++)
        out[word + i] = part[i];
    if (product < 0) {
        limbs_length negative = {0};
        subtract(LIMBS_MAX, negative, out);
        memcpy(out, negative, sizeof negative);
    }
}

bool limbs_prepare(const struct fmb_pair *pair, struct dyadic_span span, struct limbs_pair *out)
{
    static const struct dyadic one = {1, 0}, minus_one = {-1, 0};
    const struct fmb_frame *frames[2] = {&pair->a, &pair->b};
    const struct dyadic window = dyadic_of(pair->duration);
    const long bits = span.top - span.unit;
    if (bits > 64 * LIMBS_MAX - 3)
        return false;
    out->limbs = bits <= 64 - 3 ? 1 : bits <= 128 - 3 ? 2 : 4;
    memset(out->offset, 0, sizeof out->offset);
    memset(out->drift, 0, sizeof out->drift);
    memset(out->component, 0, sizeof out->component);
    out->drifts = false;
    for (int f = 0; f < 2; f++) {
        const struct fmb_body *body = frames[f]->body;
        limbs_length term;
        out->body[f] = body;
        for (int axis = 0; axis < body->dim; axis++) {
            for (int i = 0; i < body->count; i++)
                set_product(out->limbs, out->component[f][i][axis],
                            dyadic_of(body->component[i][axis]), one, span.unit);
            set_product(out->limbs, term, dyadic_of(frames[f]->origin[axis]), f ? one : minus_one,
                        span.unit);
            add(LIMBS_MAX, out->offset[axis], term);
            if (!frames[f]->moving)
                continue;
            struct dyadic speed = dyadic_of(frames[f]->velocity[axis]);
            speed.mantissa = f ? speed.mantissa : -speed.mantissa;
            set_product(out->limbs, term, speed, window, span.unit);
            add(LIMBS_MAX, out->drift[axis], term);
        }
    }
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out->drifts = out->drifts || !is_zero(LIMBS_MAX, out->drift[axis]);
    return true;
}

/* ---- Slabs ---- */

struct value_range {
    uint64_t low[VALUE_MAX], high[VALUE_MAX];
};

/* Difference edges as slabs.h numbers them: with p, q, r cyclic, number 3 + r is c_q - c_p. */
INLINE void set_edge(const int n, const struct limbs_pair *pair, int edge,
                     limbs_length out[FMB_DIM_MAX])
{
    if (edge == SLABS_DRIFT) {
        memcpy(out, pair->drift, sizeof pair->drift);
        return;
    }
    const int f = edge >= SLABS_EDGE_OF_B, e = f ? edge - SLABS_EDGE_OF_B : edge;
    const int dim = pair->body[f]->dim;
    if (e < dim) {
        memcpy(out, pair->component[f][e], sizeof pair->component[f][e]);
        return;
    }
    const int p = dim == 2 ? 0 : (e + 1) % 3, q = dim == 2 ? 1 : (e + 2) % 3;
    memcpy(out, pair->component[f][q], sizeof pair->component[f][q]);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        subtract(n, out[axis], pair->component[f][p][axis]);
}

INLINE void set_plane_normal(const int n, limbs_length e[FMB_DIM_MAX],
                             uint64_t normal[FMB_DIM_MAX][NORMAL_MAX])
{
    static const uint64_t zero[LIMBS_MAX], plus[LIMBS_MAX] = {1};
    const uint64_t minus[LIMBS_MAX] = {~UINT64_C(0), ~UINT64_C(0), ~UINT64_C(0), ~UINT64_C(0)};
    multiply(n, e[1], n, minus, normal[0]);
    multiply(n, e[0], n, plus, normal[1]);
    multiply(n, zero, n, zero, normal[2]);
}

INLINE void set_normal(const int n, const struct limbs_pair *pair, struct slab_normal edges,
                       uint64_t normal[FMB_DIM_MAX][NORMAL_MAX])
{
    limbs_length u[FMB_DIM_MAX], v[FMB_DIM_MAX];
    uint64_t term[NORMAL_MAX];
    set_edge(n, pair, edges.u, u);
    if (pair->body[0]->dim == 2) {
        set_plane_normal(n, u, normal);
        return;
    }
    set_edge(n, pair, edges.v, v);
#pragma GCC unroll 3
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

INLINE struct value_range extent(const int n, const struct limbs_pair *pair, int f,
                                 uint64_t normal[FMB_DIM_MAX][NORMAL_MAX])
{
    struct value_range range = {{0}, {0}};
    const struct fmb_body *body = pair->body[f];
    for (int i = 0; i < body->count; i++) {
        uint64_t at[VALUE_MAX];
        dot(n, normal, pair->component[f][i], at);
        if (body->shape == FMB_CUBOID)
            add(3 * n, is_negative(3 * n, at) ? range.low : range.high, at);
        else if (less(3 * n, at, range.low))
            memcpy(range.low, at, (size_t) (3 * n) * sizeof *at);
        else if (less(3 * n, range.high, at))
            memcpy(range.high, at, (size_t) (3 * n) * sizeof *at);
    }
    return range;
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
    set_normal(n, pair, edges, normal);
    if (is_zero(2 * n, normal[0]) && is_zero(2 * n, normal[1]) && is_zero(2 * n, normal[2]))
        return false;
    struct value_range b = extent(n, pair, 1, normal);
    out->between = extent(n, pair, 0, normal);
    subtract(3 * n, out->between.low, b.high);
    subtract(3 * n, out->between.high, b.low);
    dot(n, normal, pair->offset, out->start);
    memset(out->slope, 0, sizeof out->slope);
    if (pair->drifts)
        dot(n, normal, pair->drift, out->slope);
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
    memcpy(above, slab.start, sizeof above);
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
    default: return gap_sign(4, pair, normal);
    }
}

static void to_mpz(int n, uint64_t *x, mpz_t out)
{
    const bool negative = is_negative(n, x);
    uint64_t magnitude[VALUE_MAX] = {0};
    if (negative)
        subtract(VALUE_MAX, magnitude, x);
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
    memset(&slab, 0, sizeof slab);
    switch (pair->limbs) {
    case 1: set_slab(1, pair, normal, &slab); break;
    case 2: set_slab(2, pair, normal, &slab); break;
    default: set_slab(4, pair, normal, &slab); break;
    }
    const int n = 3 * pair->limbs;
    to_mpz(n, slab.between.low, low);
    to_mpz(n, slab.between.high, high);
    to_mpz(n, slab.start, start);
    to_mpz(n, slab.slope, slope);
}
