/* The kernels of the filter, compiled with numbers that carry bounds on their errors, and what is
 * checked where they use a bound.
 *
 * A bound is a constant times some lengths. At each use this asserts, with the derivation of the
 * value (number.hpp):
 *
 *     error    |value - exact value| is at most each of its derived bounds; 0 where the bound is 0
 *     derived  the worst error that its own monomials allow is at most the bound
 *     sizes    the sum of the magnitudes of its monomials is at most what the proof argues: `sizes`
 *              times the lengths
 *     counted  the roundings that it has passed, times `sizes`, are at most the constant. This does
 *              not depend on the numbers of the pair: any pair of the kind finds a constant that is
 *              too small
 *
 * `later` roundings of the result, in units of u times the lengths, are added to both. */
#define INLINED_NOT
#include "checked_bounds.h"

#include "checked_gaps.h"
#include "checked_hulls.h"
#include "checked_rotations.h"
#include "kernel_box.h"

#include <stdlib.h>

#include <initializer_list>

/* ---- The constants ---- */

/* What the derived error of a value follows from: sizes; the values at hand, where nearly nothing
 * rounds; nothing, where the value holds the errors of others. */
enum kind { OF_SIZES, AT_HAND, UNDERIVED };

struct constant {
    const char *name;
    long double value;        /* 0: from the hook */
    long double sizes, later; /* as above; sizes is 0: nothing is counted */
    enum kind kind;
    int last;                /* roundings of a vector that `later` counts */
    long double lowered = 1; /* less where a test lowers the constant */
    /* The most of each. */
    long double error = 0, derived = 0, argued = 0, counted = 0;
    long uses = 0, failed = 0;
    /* The first that failed. */
    const char *what = NULL;
    long double is = 0, most = 0;
};

/* Of a slab in 3D: Hadamard's inequality for the permanent (slabs.c), and the sum of the gap, which
 * is at most the lengths, with its bound. */
static struct constant constants[] = {
    {"SLABS_ROUNDING", SLABS_ROUNDING, 1.154700539L, 1.01L},
    {"SLABS_ROUNDING_2D", SLABS_ROUNDING_2D, 1, 1.01L},
    {"SLABS_ROUNDING_AXES", SLABS_ROUNDING_AXES, 1, 1.01L},
    /* A dividend of at most twice the divisor, and a bound of at most three times of it. */
    {"SLABS_TIMES_SLACK", SLABS_TIMES_SLACK, 5, 2.01L},
    {"EXACT_SUM_ROUNDING", EXACT_SUM_ROUNDING, 0, 0, UNDERIVED},
    {"TIMES_ROUNDING", TIMES_ROUNDING, 1, 0},
    {"NORM_ERROR", 0, 1, 0},
    /* All entries have one factor, whose product is rounded last, by 1.01 u each; of a product with
     * a vector, coordinates below 2^-60 are left out. */
    {"MATRIX_ERROR", 0, 1, 1.01L * 1.732050808L, OF_SIZES, 1},
    {"PRODUCT_ERROR", 0, 1, 0.02L},
    {"BOX_ROUNDING", BOX_ROUNDING},
    {"BOX_PLACE_ROUNDING", BOX_PLACE_ROUNDING, 1, 1},
    /* f, and the direction of unit length. */
    {"GAP_ROUNDING", 0, 1, 2},
    /* Sums of weights, by which the points of a cuboid and of a simplex are off. */
    {"GAP_WITNESS_ROUNDING", 0, 1, 4},
    {"GAP_SLIP", 1},
    /* |e|^2 >= 2^-7 (|A_p|^2 + |A_q|^2), so these are at most 8.51 times as long as e. The sum of
     * two products, each at most 2 / sqrt(3) times its lengths, is divided by at least 2^-4; |n| is
     * off by (14.1 2^8 + 1) u / 2 of itself. */
    {"GAP_BOUNDS_MARGIN", 0, 16 * 2 * 8.51L * 1.154700539L, 1806},
    {"BOX_PLACE_ROUNDING_EXACT", BOX_PLACE_ROUNDING_EXACT, 0, 0, AT_HAND},
    {"SUPPORT_ROUNDING", 0, 0, 0, AT_HAND},
    /* Relative to the error of a value, u reach. Both values are at most reach / 9, and the
     * direction is off by 2 u of itself. */
    {"SUPPORT_ORDERED", 0, 2 / 9.L * 0x1p53L, 4 / 9.L * 0x1p53L},
    /* The matrix, 13 u; sums of weights, 8 u; the difference of the points. */
    {"SUPPORT_WITNESS", 0, 1, 22},
    {"SUPPORT_DETERMINANT", 0, 0, 0, AT_HAND},
    {"SUPPORT_HEIGHT", 0, 0, 0, AT_HAND},
    {"POLYTOPE_ERROR", 0, 0, 0, AT_HAND},
    {"ORIENTATION_ERROR", 0, 0, 0, AT_HAND},
    {"MOTION_BOX_ERROR", 0, 0, 0, AT_HAND},
    {"TURN_ERROR", 0, 0, 0, AT_HAND},
};

/* ---- Checking ---- */

mpf_t scratch[2];

enum { BITS = 2560, BLOCK = 1024, BLOCKS_MAX = 1024 };

static derivation *block[BLOCKS_MAX];
static size_t taken;

derivation *arena_take()
{
    derivation *&own = block[taken / BLOCK];
    if (!own) {
        own = (derivation *) malloc(BLOCK * sizeof *own);
        for (int i = 0; i < BLOCK; i++)
            mpf_init2(own[i].exact, BITS);
    }
    derivation *out = &own[taken++ % BLOCK];
    out->size = out->worst = out->running = 0;
    out->roundings = 0;
    return out;
}

void arena_clear()
{
    taken = 0;
}

/* The kernel that runs. */
static struct {
    struct kernel_traits traits;
} at;

static struct constant *constant_of(const char *name)
{
    for (struct constant &each : constants)
        if (strcmp(each.name, name) == 0)
            return &each;
    return NULL;
}

/* |value - exact value|. */
static long double error_of(number x)
{
    if (!x.from)
        return 0;
    mpf_set_d(scratch[0], x.value);
    mpf_sub(scratch[0], scratch[0], x.from->exact);
    mpf_abs(scratch[0], scratch[0]);
    long exponent;
    const double error = mpf_get_d_2exp(&exponent, scratch[0]);
    return ldexpl(error, (int) exponent);
}

static void fail(struct constant *constant, const char *what, long double is, long double most)
{
    if (constant->failed++ > 0)
        return;
    constant->what = what;
    constant->is = is;
    constant->most = most;
}

static void expect(struct constant *constant, const char *what, long double is, long double most,
                   long double *largest)
{
    if (!(is <= most))
        fail(constant, what, is, most);
    if (most > 0)
        *largest = fmaxl(is / most, *largest);
}

void check_bound(const char *name, double own, number value, number bound)
{
    struct constant *constant = constant_of(name);
    if (at.traits.dim == 2 && strcmp(name, "SLABS_ROUNDING") == 0)
        constant = constant_of("SLABS_ROUNDING_2D");
    else
        constant->value = own;
    const long double whole = bound.value / (at.traits.rough ? SLABS_ROUGH : 1);
    const long double most = whole * constant->lowered, lengths = whole / constant->value;
    long double unused = 0;
    if (!value.from || !isfinite(value.value))
        return; /* given; no span, or no crossing */
    const long double error = error_of(value);
    constant->uses++;
    expect(constant, "error", error, most, &constant->error);
    if (constant->kind == UNDERIVED)
        return;
    if (bound.value == 0 || constant->kind == AT_HAND) {
        expect(constant, "derived at hand", running_of(value), most, &constant->derived);
        return;
    }
    const long double u = unit_roundoff, k = roundings_of(value);
    const long double later = constant->later * u, counted = k * u / (1 - k * u) * constant->sizes;
    expect(constant, "error, by the values at hand,", error, running_of(value), &unused);
    expect(constant, "error, by sizes,", error, worst_of(value), &unused);
    expect(constant, "derived", worst_of(value) + later * lengths, most, &constant->derived);
    if (constant->sizes == 0)
        return;
    expect(constant, "sizes", size_of(value), constant->sizes * lengths * (1 + 0x1p-40L),
           &constant->argued);
    expect(constant, "counted", counted + later, constant->value * constant->lowered,
           &constant->counted);
}

void check_quotient(const char *name, number dividend, number divisor, number inverse,
                    number quotient, number bound)
{
    struct constant *constant = constant_of(name);
    const long double u = unit_roundoff, width = 1 / fabsl(inverse.value);
    const long double q = fabsl(quotient.value), t = bound.value / width;
    const long double most = constant->value * constant->lowered;
    /* Of its own: one in the inverse, one in each product with it. */
    const int k = roundings_of(quotient) - roundings_of(dividend) - roundings_of(inverse) + 1;
    if (fabsl(q - t) > 1)
        return; /* both ends are beyond those of the window */
    constant->uses++;
    const long double own = k * u / (1 - k * u) * (q + t) + constant->later * u;
    const long double of_both = worst_of(dividend) + worst_of(divisor);
    const long double longer = fabsl(width - fabsl(divisor.value)) * (1 + 0x1p-40L);
    /* What of_both leaves of the bound counts only where the divisor is small. */
    const long double unused = (of_both + longer - bound.value) / width;
    expect(constant, "derived", own + (q > 2 || unused > 0 ? unused : 0), most, &constant->derived);
    expect(constant, "counted", k * u / (1 - k * u) * constant->sizes + constant->later * u, most,
           &constant->counted);
    if (q <= 2)
        expect(constant, "sizes", q + t, constant->sizes * (1 + 0x1p-40L), &constant->argued);
}

void check_vector(const char *name, double own, const number *vector, int count, number bound)
{
    struct constant *constant = constant_of(name);
    constant->value = own;
    const long double u = unit_roundoff, length = bound.value / constant->value;
    long double derived = 0, error = 0, sum = 0, counted = 0;
    for (int i = 0; i < count; i++) {
        const long double k = roundings_of(vector[i]) - constant->last;
        counted = hypotl(k > 0 ? k * u / (1 - k * u) : 0, counted);
        if (constant->sizes > 0)
            expect(constant, "sizes", size_of(vector[i]), length * (1 + 0x1p-40L),
                   &constant->argued);
        derived = hypotl(running_of(vector[i]), derived);
        error = hypotl(error_of(vector[i]), error);
        sum += fabsl(vector[i].value);
    }
    constant->uses++;
    if (sum > 0) {
        expect(constant, "error", error, bound.value * constant->lowered, &constant->error);
        expect(constant, "derived", derived, bound.value * constant->lowered, &constant->derived);
    }
    if (constant->sizes > 0)
        expect(constant, "counted", counted * constant->sizes + constant->later * u,
               constant->value * constant->lowered, &constant->counted);
}

/* From here on the normal is what it is. */
void give_normal(const number normal[3], number &square)
{
    for (int axis = 0; axis < 3; axis++)
        const_cast<number &>(normal[axis]) = given(normal[axis]);
    square = (normal[0] * normal[0] + normal[1] * normal[1]) + normal[2] * normal[2];
}

/* By the roundings of n. Where the monomials have products p_i and q_i, sum (|p_i| + |q_i|)^2 is at
 * most 4 / 3 of the square of the lengths of the edges (slabs.c). */
void check_slip(const char *name, const number n[3], number longer, number factor, number slip)
{
    struct constant *constant = constant_of(name);
    int k = 0;
    for (int axis = 0; axis < 3; axis++)
        k = roundings_of(n[axis]) > k ? roundings_of(n[axis]) : k;
    const long double u = unit_roundoff, off = k * u / (1 - k * u) * 1.154700539L * longer.value;
    expect(constant, "counted", factor.value * off, slip.value * constant->lowered,
           &constant->counted);
}

/* Vectors that differ by x, one of length n, have directions that differ by at most 2 x / n, and by
 * less than 1.01 x / n where that is small (gap_depth.c). */
void check_normal(const char *name, const number normal[3], number &square, number slip)
{
    struct constant *constant = constant_of(name);
    long double off = 0;
    for (int axis = 0; axis < 3; axis++)
        off += running_of(normal[axis]) * running_of(normal[axis]);
    off = sqrtl(off / square.value);
    constant->uses++;
    expect(constant, "derived", (off < 0.1L ? 1.01L : 2) * off, slip.value * constant->lowered,
           &constant->derived);
    give_normal(normal, square);
}

/* The segment from a vertex along a direction is at a bound of the slab where dividend + t divisor
 * is 0, t in [0, 1]: both errors count, and the roundings of the quotient. */
void check_segment(const char *name, const struct clip_values *values, int slab, int vertex,
                   int direction)
{
    struct constant *constant = constant_of(name);
    const number along = values->along[slab][direction], inverse = values->inverse[slab][direction];
    const int k = roundings_of(inverse) - roundings_of(along) + 1;
    const long double own = k * unit_roundoff * fabsl(along.value) * (1 + 0x1p-40L);
    for (auto both : {&values->low, &values->high}) {
        const number outer = (*both)[CLIP_OUTER][slab][vertex];
        const number inner = (*both)[CLIP_INNER][slab][vertex];
        const long double bound = fabsl(inner.value - outer.value) / 2;
        constant->uses++;
        if (bound == 0)
            expect(constant, "error", running_of(outer) + running_of(along), 0, &constant->derived);
        else
            for (number end : {outer, inner})
                expect(constant, "derived", worst_of(end) + worst_of(along) + own,
                       bound * constant->lowered, &constant->derived);
    }
}

/* ---- Pairs ---- */

static void gather_without_errors(const struct kernel_traits traits,
                                  const struct fmb_prepared *const pair[2],
                                  struct frame_lanes out[2])
{
    for (int which = 0; which < 2; which++) {
        struct fmb_prepared frame = *pair[which];
        const double *words = (const double *) &frame;
        frame.number[(traits.dim == 2 ? PREPARED_ERROR_2D : PREPARED_ERROR_3D) - 1] = 0;
        gather(traits, &words, &out[which]);
        out[which].prepared[0] = pair[which];
    }
}

static void check_job(struct kernel_traits traits, const struct fmb_prepared *const both[2],
                      double duration)
{
    struct frame_lanes frame[2];
    struct pair_lanes pair;
    struct slabs_result result;
    number times[2];
    at.traits = traits;
    gather_without_errors(traits, both, frame);
    set_pair(traits, &frame[0], &frame[1], duration, &pair);
    if (pair.in_range && traits.second)
        second_outcomes(traits, &frame[0], &frame[1], duration, &pair);
    else if (pair.in_range)
        evaluate_pair(traits, &pair, &result);
    if (pair.in_range && traits.times && result.gap_low <= 0)
        times_of(&pair, &result, duration, times);
    arena_clear();
}

static void check_box(const struct kernel_traits traits, const struct fmb_prepared *const both[2],
                      double duration)
{
    struct frame_lanes frame[2];
    struct pair_lanes pair;
    struct box_places places = {};
    struct box_pair box;
    struct box_ends ends;
    struct clip_wire wire[2];
    at.traits = traits;
    gather_without_errors(traits, both, frame);
    set_places(traits, frame, duration, &pair, &places);
    for (int which = 0; which < 2; which++)
        set_wire(traits, which, &wire[which]);
    if (pair.in_range) {
        places.exact = nothing_rounds(traits, &frame[0], &frame[1], duration, &pair);
        begin_box(&pair, traits, &places, &box);
        clip_box(&pair, traits, wire, &places, &box, &ends, NULL);
    }
    arena_clear();
}

static void check_gaps(const struct fmb_prepared *const both[2], double duration)
{
    struct checked_frame frame[2] = {};
    at.traits = {};
    for (int f = 0; f < 2; f++) {
        const int error =
            prepared_kind(both[f]) & PREPARED_3D ? PREPARED_ERROR_3D : PREPARED_ERROR_2D;
        frame[f].summary = both[f]->summary;
        memcpy(frame[f].number, both[f]->number, sizeof frame[f].number);
        frame[f].number[error - 1] = 0;
        memcpy(frame[f].position, both[f]->placement->position, sizeof frame[f].position);
        memcpy(frame[f].velocity, both[f]->placement->velocity, sizeof frame[f].velocity);
    }
    check_gap(frame, duration);
}

static void check_rotations(const struct fmb_prepared *frame)
{
    const struct fmb_placement *placement = frame->placement;
    for (int i = 0; i < frame->frame->count && placement->orientation_count; i++)
        check_rotation(placement->orientation, placement->orientation_count, frame->frame->dim,
                       frame->frame->component[i]);
}

static void get_vertices(const struct fmb_prepared *const both[2], struct checked_vertices out[2])
{
    at.traits = {};
    for (int f = 0; f < 2; f++) {
        out[f] = {};
        const struct fmb_frame *frame = both[f]->frame;
        const struct fmb_placement *placement = both[f]->placement;
        out[f].shape = frame->shape;
        out[f].dim = frame->dim;
        out[f].count = frame->count;
        out[f].flat = frame->flat;
        out[f].orientation_count = placement->orientation_count;
        out[f].vertices = frame->vertices;
        out[f].vertex_count = frame->vertex_count;
        out[f].vertex_stride = frame->vertex_stride;
        out[f].slack = frame->slack;
        out[f].reach = frame->core_reach;
        memcpy(out[f].spanning, frame->spanning, sizeof frame->spanning);
        memcpy(out[f].origin, frame->origin, sizeof frame->origin);
        memcpy(out[f].component, frame->component, sizeof frame->component);
        memcpy(out[f].position, placement->position, sizeof placement->position);
        memcpy(out[f].velocity, placement->velocity, sizeof placement->velocity);
        memcpy(out[f].orientation, placement->orientation, sizeof placement->orientation);
        out[f].end_count = placement->end_count;
        memcpy(out[f].end_position, placement->end_position, sizeof placement->end_position);
        memcpy(out[f].end_orientation, placement->end_orientation,
               sizeof placement->end_orientation);
    }
}

static void begin_scratch()
{
    if (!scratch[0]->_mp_d)
        for (auto &each : scratch)
            mpf_init2(each, BITS);
}

void check_turning_pair(const struct fmb_prepared *a, const struct fmb_prepared *b, double duration)
{
    const struct fmb_prepared *const both[2] = {a, b};
    struct checked_vertices vertices[2];
    begin_scratch();
    get_vertices(both, vertices);
    check_turns(vertices, duration);
}

void check_pair(const struct fmb_prepared *a, const struct fmb_prepared *b, double duration)
{
    bool swapped;
    const enum kernel_kind kind = kernel_kind_of_bounds(a, b, duration, &swapped);
    if (kind >= KERNEL_KINDS)
        return;
    begin_scratch();
    const struct fmb_prepared *const pair[2] = {swapped ? b : a, swapped ? a : b};
    struct kernel_traits traits = traits_of(kind);
    struct checked_vertices vertices[2];
    check_rotations(a);
    check_rotations(b);
    check_gaps(pair, duration);
    get_vertices(pair, vertices);
    check_hulls(vertices, duration);
    check_box(traits, pair, duration);
    traits.box = false;
    traits.axis_aligned = traits.dim == 3;
    traits.rough = true;
    check_job(traits, pair, duration);
    traits.rough = false;
    traits.swap_invariant = true;
    traits.times = traits.drifts;
    check_job(traits, pair, duration);
    traits.times = false;
    traits.second = true;
    check_job(traits, pair, duration);
}

/* ---- Report ---- */

void check_begin(void)
{
    for (struct constant &each : constants)
        each = {.name = each.name,
                .value = each.value,
                .sizes = each.sizes,
                .later = each.later,
                .kind = each.kind,
                .last = each.last};
}

const char *check_constant(int index)
{
    return index < (int) (sizeof constants / sizeof *constants) ? constants[index].name : NULL;
}

void check_lower(int index, double factor)
{
    constants[index].lowered = factor;
}

bool check_failed(int index)
{
    return constants[index].failed > 0;
}

static const char not_checked[] =
    "\n"
    "Not checked here: errors of origins and vertices (prepared.c, frame.c), sums rounded\n"
    "outward (aabb.h, box_ends.h), boxes of level cuboids (BOXES.md, 7), points of contact\n"
    "(BOXES.md, 12; support_gap.c), depths of hulls (support_depth.c), positions within a window\n"
    "(turn_decision.c), and computations in integers. The filter and gaps take frames as given,\n"
    "without errors, and pairs that turn take vertices and directions as given.\n";

/* A fraction of a constant. */
static void print_share(FILE *out, long double share)
{
    if (share > 0)
        fprintf(out, " %9.4Lf", share);
    else
        fprintf(out, " %9s", "-");
}

bool check_report(FILE *out)
{
    bool good = true;
    fprintf(out, "%-24s %9s %9s %9s %9s\n", "constant", "counted", "derived", "error", "uses");
    for (const struct constant &each : constants) {
        fprintf(out, "%-24s", each.name);
        print_share(out, each.counted);
        print_share(out, each.derived);
        print_share(out, each.error);
        fprintf(out, " %9ld", each.uses);
        if (each.failed)
            fprintf(out, "  FAILED: %s %.6Lg, more than %.6Lg\n", each.what, each.is, each.most);
        else
            fprintf(out, "%s\n", each.uses ? "" : "  not used");
        good = good && !each.failed;
    }
    fprintf(out, "%s", not_checked);
    return good;
}
