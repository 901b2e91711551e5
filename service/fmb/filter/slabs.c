/* Slabs in doubles, for single pairs; and the derivation for the kernels of all widths.
 *
 * Method. Let [x y z] = (x x y) . z, the triple product. Every number of a slab of a pair in 3D is
 * a triple product of vectors among the components a_i and b_j, the offset q and
 * half the drift H, or a sum of a few. With n_k = a_i x a_j (i, j, k cyclic) for the faces:
 *
 *     faces of A          n_k . a_k, n_k . b_j, n_k . q, n_k . H
 *     edges a_i, b_j      [a_i b_j w] for w = q, H; and [a_i b_j a_k] = b_j . (a_k x a_i) and
 *                         [a_i b_j b_k] = a_i . (b_j x b_k), known from the faces
 *     edge a_i, drift     [a_i H a_k] = H . (a_k x a_i) and [a_i H b_j] = -[a_i b_j H];
 *                         [a_i H q]
 *
 * Edges of a tetrahedron that are not components are differences of two, and all of this is
 * linear in each edge. With p, q, r cyclic, e = a_q - a_p and any x:
 *
 *     [e x a_p] = [e x a_q] = x . (a_p x a_q) = x . n_r
 *     [e x a_r] = x . (a_r x a_q) - x . (a_r x a_p) = -x . n_p - x . n_q
 *
 * and the normal of the face across from the origin is n_0 + n_1 + n_2. In 2D the products
 * [x y] = x_0 y_1 - x_1 y_0 take the place of these.
 *
 * A cuboid is seen from its centre: along a normal it reaches equally far to either side, by the
 * sum of the magnitudes of the products with halves of its components, which saves half of the
 * work. Instead of halving components, all lengths of a pair with a cuboid are doubled
 * (pair_lanes). The offset is that of the middle of the window, and the drift widens D by its half
 * to either side.
 *
 * Accuracy, with u = 2^-53, for any order of summation and with or without fused operations. Let
 * |x| be the length of x (2-norm) or more: 1-norms of the offset d and of H, sizes from the
 * summaries of frames, |a_p| + |a_q| for an edge that is a difference; and
 *
 *     T = |d| + 2 |H| + sum over cuboids of 2 |c_i| + sum over tetrahedra of |c_i|
 *
 * in the lengths of pair_lanes. The gap of the slab u x v is a sum of products [u v w], and the
 * lengths of these w have a sum of at most T: H stands in the offset and in the swing, a component
 * of a cuboid in the offset and in the radius, that of a tetrahedron in its extent. Each
 * product is a sum of six monomials, and for the sum of their magnitudes, with p_k = |u_i| |v_j| +
 * |u_j| |v_i| (i, j, k cyclic),
 *
 *     sum_k |w_k| p_k <= |w| |p|,
 *     |p|^2 = |u|^2 |v|^2 + (sum |u_i| |v_i|)^2 - 2 sum (u_i v_i)^2
 *          <= |u|^2 |v|^2 + (sum |u_i| |v_i|)^2 / 3  <=  4/3 |u|^2 |v|^2
 *
 * (Cauchy's inequality three times). A monomial is rounded at most 14 times: 'make checked' counts
 * that, and that the magnitudes of the monomials sum to no more than this, at each slab.
 *
 * So the share of a monomial in the result has a factor within (1 +- u)^14, and the sum an error of
 * at most 14.01 (2 / sqrt(3)) u |u| |v| T < 16.2 u |u| |v| T. Maxima and minima do not round, and
 * move by no more than the numbers that they choose from. The sum of a gap, which is at most
 * |u| |v| T (Hadamard), and its bound rounds by 1.01 u |u| |v| T more. That uses 17.3 of the 18 u
 * of SLABS_ROUNDING; what remains covers the bound itself, computed with 15 roundings. Times make
 * no such sum, and need less than that for their own operations (bound_times()). In 2D a product is
 * two monomials, of magnitudes at most |u| |w|; they are rounded at most 10 times, and 10.01 + 1.01
 * leaves enough of 12 u.
 *
 * The face across from the origin has |u| |v| = sum over i < j of |a_i| |a_j|: its normal is the
 * sum of these three cross products.
 *
 * A face is a simplex of two components; of the products above it needs those without a_2, and its
 * own normal n_2, along which it has no extent.
 *
 * Two passes. Let R be the bound on rounding, and F that on the errors of the frames. The gaps that
 * two kernels compute of the same rounded frames differ by at most 2 R. A first pass decides a slab
 * where its gap is beyond 4 R + F: that of any other kernel then is beyond 2 R + F, and R + F is
 * enough for it (SLABS_ROUGH).
 *
 * Overflow and underflow: components and a drift that is not 0 have sizes between 2^-200 and 2^200,
 * offsets are below 2^200 (slabs_prepare, pair_lanes.in_range), so that nothing overflows. Entries
 * and products may underflow: each of at most 100 operations then adds less than 2^-1074, to cross
 * products and H before they are multiplied by at most 2^405, while |u| |v| T 2^-53 is at least
 * 2^-653: the remaining part of the bound covers that many times over.
 *
 * A coordinate of H may underflow to 0, and with it a normal whose true value is not zero. Its slab
 * then does not count, as if the frames moved without that coordinate. Let S' be swept by this
 * other drift. Its bounds differ from those of S by less than 2^-1072 along every unit vector, and
 * the list without the slab is complete for S'. So the proof of the filter (slabs.h) holds with an
 * error of the frames that is larger by 2^-1072: all other slabs hold the offset farther inside
 * than that, since the unused part of the bound is more than 2^-53 T > 2^-260 of a distance. Such a
 * pair spans too many bits for integers (limbs_prepare), so that its slabs are never decided one by
 * one. Along axes with known signs (slabs_second.h) the velocities are equal, and nothing
 * underflows. */

/* gcc 13 warns that loops over the 2 or 3 axes could exceed their array. */
#if __GNUC__ == 13
#pragma GCC diagnostic ignored "-Warray-bounds"
#pragma GCC diagnostic ignored "-Wstringop-overread"
#endif

#define INLINED_NOT
#define SLABS_LIST
#include "slabs.h"

#include "prepared.h"
#include "slabs_evaluate.h"
#include "vector.h"

#include <math.h>

bool relative_motion_of(const struct world_frame *a, const struct world_frame *b, double duration,
                        struct relative_motion *out)
{
    *out = (struct relative_motion){.drifts = false};
    bool finite = true;
    for (int axis = 0; axis < a->dim; axis++) {
        out->offset[axis] = b->origin[axis] - a->origin[axis];
        const double speed = b->velocity[axis] - a->velocity[axis];
        out->drift[axis] = speed * duration;
        out->drifts = out->drifts || (speed != 0 && duration > 0);
        finite = finite && isfinite(out->offset[axis]) && isfinite(out->drift[axis]);
    }
    return finite;
}

/* The condition of fmb_frame.in_range for components: no product of two coordinates underflows, nor
 * one of halves. */
static bool are_not_tiny(const double v[3])
{
    for (int axis = 0; axis < 3; axis++)
        if (v[axis] != 0 && fabs(v[axis]) < 2 * PREPARED_LEAST_NUMBER)
            return false;
    return true;
}

/* Sets the errors of a pair. Placing: let t bound the errors of components relative to their
 * lengths, and so of edges relative to the lengths in the scale of a slab. The normal u x v is off
 * by at most (2 t + t^2) |u| |v|, and the gap along it by that times all lengths; along the rounded
 * normal, the bounds of D are off by the errors of the frames, times |u| |v|. In 2D the normal is
 * off by t |u|. A product [u v w] of edges is off by (3 t + 3 t^2 + t^3) |u| |v| |w|. 4 t is more
 * than each of these factors. */
static void set_placing(struct slabs_pair *out)
{
    double lengths = 0;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        lengths += prepared_size(out->a.summary, axis) + prepared_size(out->b.summary, axis);
        lengths += fabs(out->motion.offset[axis]) + fabs(out->motion.drift[axis]);
    }
    out->error = out->a.error + out->b.error;
    out->inexact = out->error != 0;
    out->placing = (4 * fmax(out->a.relative_error, out->b.relative_error) * lengths + out->error) *
                   (1 + 0x1p-30);
}

bool slabs_prepare(const struct fmb_prepared *a, const struct fmb_prepared *b, double duration,
                   struct slabs_pair *out)
{
    world_frame_of(a, &out->a);
    world_frame_of(b, &out->b);
    out->duration = duration;
    if (!(prepared_kind(a) & prepared_kind(b) & PREPARED_USABLE) ||
        !relative_motion_of(&out->a, &out->b, duration, &out->motion))
        return false;
    set_placing(out);
    double offset = vec3_largest(out->motion.offset);
    double drift = vec3_largest(out->motion.drift);
    out->drift_size = drift;
    out->reach = (offset + drift) + ((out->a.size[0] + out->a.size[1] + out->a.size[2]) +
                                     (out->b.size[0] + out->b.size[1] + out->b.size[2]));
    if (!out->motion.drifts)
        return offset <= PREPARED_LARGEST;
    return offset <= PREPARED_LARGEST && drift <= PREPARED_LARGEST && drift >= PREPARED_LEAST &&
           are_not_tiny(out->motion.drift);
}

/* ---- The list of slabs of a single pair ---- */

INLINE void set_pair(const struct slabs_pair *pair, const struct kernel_traits traits,
                     struct pair_lanes *out)
{
    const struct world_frame *frame[2] = {&pair->a, &pair->b};
    double component[2][3][3], size[2][3];
    for (int f = 0; f < 2; f++)
        for (int i = 0; i < 3; i++) {
            size[f][i] = prepared_size(frame[f]->summary, i);
            for (int axis = 0; axis < 3; axis++)
                component[f][i][axis] = frame[f]->component[i][axis];
        }
    pair_lanes_set(traits, (const double(*)[3][3]) component, (const double(*)[3]) size,
                   pair->motion.offset, pair->motion.drift, pair->placing, out);
    out->signed_axes = 0;
    memset(out->across, 0, sizeof out->across);
}

int slabs_list(const struct slabs_pair *pair, bool rounds, struct slab_value out[SLABS_MAX])
{
    const struct kernel_traits traits = {
        .dim = pair->a.dim,
        .simplex = {pair->a.shape != FMB_CUBOID, pair->b.shape != FMB_CUBOID},
        .face = {pair->a.shape == FMB_FACE, pair->b.shape == FMB_FACE},
        .drifts = pair->motion.drifts,
        .axis_aligned = pair->a.dim == 3,
        .swap_invariant = true,
        .second = true};
    struct pair_lanes one;
    struct slabs_result result;
    set_pair(pair, traits, &one);
    if (!rounds)
        one.unit = one.reach = one.error = 0;
    slabs_result_begin(&result);
    result.next = out;
    evaluate_slabs(&one, traits, &result);
    return (int) (result.next - out);
}

void slab_inequalities(const struct slab_value *slab, struct inequality out[2])
{
    const double start = slab->middle - slab->swing, slope = 2 * slab->swing;
    out[0] = (struct inequality){start - slab->low, slope, slab->error};
    out[1] = (struct inequality){slab->high - start, -slope, slab->error};
}
