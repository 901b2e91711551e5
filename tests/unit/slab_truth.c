#include "slab_truth.h"

#include <math.h>

static void each(struct slab_truth *truth, void (*call)(mpz_ptr))
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        for (int i = 0; i < FMB_DIM_MAX; i++) {
            call(truth->component[0][i][axis]);
            call(truth->component[1][i][axis]);
        }
        call(truth->offset[axis]);
        call(truth->drift[axis]);
        call(truth->shift[axis]);
        call(truth->normal[axis]);
        call(truth->edge[0][axis]);
        call(truth->edge[1][axis]);
    }
    call(truth->low);
    call(truth->high);
    call(truth->start);
    call(truth->slope);
    call(truth->gap);
    call(truth->seen_low);
    call(truth->seen_high);
    call(truth->middle);
    call(truth->swing);
    call(truth->side[0]);
    call(truth->side[1]);
    call(truth->rise[0]);
    call(truth->rise[1]);
    call(truth->scratch[0]);
    call(truth->scratch[1]);
}

void slab_truth_init(struct slab_truth *truth)
{
    each(truth, mpz_init);
}

void slab_truth_clear(struct slab_truth *truth)
{
    each(truth, mpz_clear);
}

/* ---- Doubles as integers ---- */

/* x = mantissa 2^exponent, the mantissa odd or 0. */
static long mantissa_of(double x, long *exponent)
{
    int e;
    long mantissa = (long) ldexp(frexp(x, &e), 53);
    *exponent = e - 53;
    while (mantissa != 0 && mantissa % 2 == 0) {
        mantissa /= 2;
        ++*exponent;
    }
    return mantissa;
}

static void lower(long *unit, double x, double y)
{
    long of_x, of_y;
    if (mantissa_of(x, &of_x) != 0 && mantissa_of(y, &of_y) != 0 && of_x + of_y < *unit)
        *unit = of_x + of_y;
}

/* out += sign x y 2^-unit */
static void add_product(struct slab_truth *truth, mpz_t out, int sign, double x, double y)
{
    long of_x, of_y;
    mpz_set_si(truth->scratch[0], sign * mantissa_of(x, &of_x));
    mpz_mul_si(truth->scratch[0], truth->scratch[0], mantissa_of(y, &of_y));
    if (mpz_sgn(truth->scratch[0]) == 0)
        return;
    mpz_mul_2exp(truth->scratch[0], truth->scratch[0], (mp_bitcnt_t) (of_x + of_y - truth->unit));
    mpz_add(out, out, truth->scratch[0]);
}

static void lower_to_placed(long *unit, const struct fmb_placement *placement, double duration)
{
    const struct fmb_frame *frame = fmb_body_frame(placement->body, 0);
    for (int axis = 0; axis < frame->dim; axis++) {
        lower(unit, placement->position[axis], 1);
        lower(unit, placement->velocity[axis], duration);
        for (int i = 0; i < frame->count; i++)
            lower(unit, frame->component[i][axis], 1);
    }
}

static void set_frame(struct slab_truth *truth, int f, const struct fmb_placement *placement,
                      double duration)
{
    const struct fmb_frame *frame = fmb_body_frame(placement->body, 0);
    const int sign = f ? 1 : -1;
    truth->shape[f] = frame->shape;
    for (int axis = 0; axis < truth->dim; axis++) {
        add_product(truth, truth->offset[axis], sign, placement->position[axis], 1);
        add_product(truth, truth->drift[axis], sign, placement->velocity[axis], duration);
        for (int i = 0; i < truth->dim; i++)
            add_product(truth, truth->component[f][i][axis], 1, frame->component[i][axis], 1);
    }
}

/* From the origin of a frame to its reference point: half of the way across a cuboid. The unit is
 * half of what the numbers need. */
static void add_shift(struct slab_truth *truth, int f)
{
    for (int axis = 0; axis < truth->dim && truth->shape[f] == FMB_CUBOID; axis++)
        for (int i = 0; i < truth->dim; i++) {
            mpz_tdiv_q_2exp(truth->scratch[0], truth->component[f][i][axis], 1);
            (f ? mpz_add : mpz_sub)(truth->shift[axis], truth->shift[axis], truth->scratch[0]);
        }
}

static void zero(mpz_ptr x)
{
    mpz_set_ui(x, 0);
}

bool slab_truth_prepare(const struct pair *pair, struct slabs_pair *out)
{
    const struct frame_pair frames = pair_frames(pair);
    struct fmb_prepared a, b;
    prepared_set(frames.a, &a);
    prepared_set(frames.b, &b);
    return slabs_prepare(&a, &b, pair->duration, out);
}

void slab_truth_set(struct slab_truth *truth, const struct pair *pair)
{
    each(truth, zero);
    truth->dim = pair->a.body->dim;
    truth->unit = 2000;
    lower_to_placed(&truth->unit, &pair->a, pair->duration);
    lower_to_placed(&truth->unit, &pair->b, pair->duration);
    truth->unit--;
    set_frame(truth, 0, &pair->a, pair->duration);
    set_frame(truth, 1, &pair->b, pair->duration);
    add_shift(truth, 0);
    add_shift(truth, 1);
}

/* ---- Slabs ---- */

static void set_edge(struct slab_truth *truth, int number, mpz_t out[FMB_DIM_MAX])
{
    static const int of_plane[][2] = {{1, 0}}, of_space[][2] = {{2, 1}, {0, 2}, {1, 0}};
    const int f = number >= SLABS_EDGE_OF_B, e = f ? number - SLABS_EDGE_OF_B : number;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        if (number == SLABS_DRIFT) {
            mpz_set(out[axis], truth->drift[axis]);
        } else if (e < truth->dim) {
            mpz_set(out[axis], truth->component[f][e][axis]);
        } else {
            const int *ends = truth->dim == 2 ? of_plane[0] : of_space[e - 3];
            mpz_sub(out[axis], truth->component[f][ends[0]][axis],
                    truth->component[f][ends[1]][axis]);
        }
    }
}

static void set_normal(struct slab_truth *truth, struct slab_normal normal)
{
    mpz_t *u = truth->edge[0], *v = truth->edge[1];
    set_edge(truth, normal.u, u);
    if (truth->dim == 2) {
        mpz_neg(truth->normal[0], u[1]);
        mpz_set(truth->normal[1], u[0]);
        mpz_set_ui(truth->normal[2], 0);
        return;
    }
    set_edge(truth, normal.v, v);
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        mpz_mul(truth->normal[i], u[j], v[k]);
        mpz_submul(truth->normal[i], u[k], v[j]);
    }
}

static void dot(struct slab_truth *truth, mpz_t w[FMB_DIM_MAX], mpz_t out)
{
    mpz_set_ui(out, 0);
    for (int axis = 0; axis < truth->dim; axis++)
        mpz_addmul(out, truth->normal[axis], w[axis]);
}

/* Of a frame with its origin at 0: the sums of what is below and above 0, or the ends of it. */
static void add_extent(struct slab_truth *truth, int f, mpz_t low, mpz_t high)
{
    mpz_t least, most, at;
    mpz_inits(least, most, at, NULL);
    for (int i = 0; i < truth->dim; i++) {
        dot(truth, truth->component[f][i], at);
        mpz_ptr end = mpz_sgn(at) < 0 ? least : most;
        if (truth->shape[f] == FMB_CUBOID)
            mpz_add(end, end, at);
        else if (mpz_cmpabs(at, end) > 0)
            mpz_set(end, at);
    }
    /* low and high are those of A - B: of B the ends change their places */
    if (f == 0) {
        mpz_add(low, low, least);
        mpz_add(high, high, most);
    } else {
        mpz_sub(low, low, most);
        mpz_sub(high, high, least);
    }
    mpz_clears(least, most, at, NULL);
}

static void set_gap(struct slab_truth *truth)
{
    mpz_ptr above = truth->scratch[0], below = truth->scratch[1];
    mpz_sub(above, truth->start, truth->high);
    mpz_sub(below, truth->low, truth->start);
    if (mpz_sgn(truth->slope) < 0)
        mpz_add(above, above, truth->slope);
    else
        mpz_sub(below, below, truth->slope);
    mpz_set(truth->gap, mpz_cmp(above, below) > 0 ? above : below);
}

/* A pair with a cuboid is walked in doubled lengths, its edges being those of a doubled tetrahedron
 * and halves of those of a doubled cuboid. The drift's edge is its half. */
static int factor_of_edge(const struct slab_truth *truth, int number, bool doubled)
{
    if (number == SLABS_DRIFT)
        return doubled ? 0 : -1;
    return doubled && truth->shape[number >= SLABS_EDGE_OF_B] != FMB_CUBOID ? 1 : 0;
}

static int factor_of(const struct slab_truth *truth, struct slab_normal normal)
{
    const bool doubled = truth->shape[0] == FMB_CUBOID || truth->shape[1] == FMB_CUBOID;
    int factor = (doubled ? 1 : 0) + factor_of_edge(truth, normal.u, doubled);
    if (truth->dim == 3)
        factor += factor_of_edge(truth, normal.v, doubled);
    return factor;
}

/* The unit is half of what the numbers need, so that half a slope is an integer too. */
static void set_seen(struct slab_truth *truth)
{
    mpz_ptr shift = truth->scratch[0];
    dot(truth, truth->shift, shift);
    mpz_add(truth->seen_low, truth->low, shift);
    mpz_add(truth->seen_high, truth->high, shift);
    mpz_tdiv_q_2exp(truth->swing, truth->slope, 1);
    mpz_add(truth->middle, truth->start, truth->swing);
    mpz_add(truth->middle, truth->middle, shift);
}

/* Of its normal: low, high, start and slope. */
static void set_along_normal(struct slab_truth *truth)
{
    mpz_set_ui(truth->low, 0);
    mpz_set_ui(truth->high, 0);
    add_extent(truth, 0, truth->low, truth->high);
    add_extent(truth, 1, truth->low, truth->high);
    dot(truth, truth->offset, truth->start);
    dot(truth, truth->drift, truth->slope);
}

void slab_truth_compute(struct slab_truth *truth, struct slab_normal normal)
{
    truth->factor = factor_of(truth, normal);
    set_normal(truth, normal);
    truth->zero = mpz_sgn(truth->normal[0]) == 0 && mpz_sgn(truth->normal[1]) == 0 &&
                  mpz_sgn(truth->normal[2]) == 0;
    set_along_normal(truth);
    mpz_sub(truth->side[0], truth->start, truth->low);
    mpz_sub(truth->side[1], truth->high, truth->start);
    mpz_set(truth->rise[0], truth->slope);
    mpz_neg(truth->rise[1], truth->slope);
    set_seen(truth);
    set_gap(truth);
}

/* |value - exact 2^unit| / bound */
static double ratio_of(struct slab_truth *truth, const mpz_t exact, long unit, double value,
                       double bound)
{
    mpz_ptr error = truth->scratch[0], of_value = truth->scratch[1];
    long e, of_error;
    int of_bound;
    mpz_set_si(of_value, mantissa_of(value, &e));
    const long shift = mpz_sgn(of_value) == 0 ? 0 : e - unit;
    mpz_mul_2exp(error, exact, shift < 0 ? (mp_bitcnt_t) -shift : 0);
    mpz_mul_2exp(of_value, of_value, shift > 0 ? (mp_bitcnt_t) shift : 0);
    mpz_sub(error, error, of_value);
    if (mpz_sgn(error) == 0)
        return 0;
    const double size = fabs(mpz_get_d_2exp(&of_error, error));
    const double of_size = frexp(bound, &of_bound);
    of_error += unit + (shift < 0 ? shift : 0) - of_bound;
    return bound == 0 ? HUGE_VAL : ldexp(size / of_size, (int) of_error);
}

static double slab_truth_ratio(struct slab_truth *truth, const mpz_t exact, int factor,
                               double value, double bound)
{
    return ratio_of(truth, exact, truth->dim * truth->unit + factor, value, bound);
}

double slab_truth_worst(struct slab_truth *truth, const struct slab_value *slab)
{
    const double bound = slab->error;
    struct inequality side[2];
    slab_truth_compute(truth, slab->normal);
    const int factor = truth->factor;
    double worst = slab_truth_ratio(truth, truth->seen_low, factor, slab->low, bound);
    worst = fmax(worst, slab_truth_ratio(truth, truth->seen_high, factor, slab->high, bound));
    worst = fmax(worst, slab_truth_ratio(truth, truth->middle, factor, slab->middle, bound));
    worst = fmax(worst, slab_truth_ratio(truth, truth->swing, factor, slab->swing, bound));
    worst = fmax(worst, slab_truth_ratio(truth, truth->gap, factor, slab_gap(slab), bound));
    slab_inequalities(slab, side);
    for (int i = 0; i < 2; i++) {
        worst = fmax(worst, slab_truth_ratio(truth, truth->side[i], factor, side[i].c, bound));
        worst = fmax(worst, slab_truth_ratio(truth, truth->rise[i], factor, side[i].g, bound));
    }
    return worst;
}
