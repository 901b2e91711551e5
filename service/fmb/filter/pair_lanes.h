/* LANES pairs of frames side by side, in the form in which kernels compute: seen from reference
 * points, in lengths that need no halves. */
#ifndef FMB_PAIR_LANES_H
#define FMB_PAIR_LANES_H

#include "lanes.h"
#include "slabs.h"

/* A pair, seen from the reference point of a: the centre of a cuboid, the origin of a simplex. If a
 * frame is a cuboid, all lengths of the pair are doubled, so that half an edge of the cuboid is its
 * component. */
struct pair_lanes {
    lanes component[2][3][3]; /* [frame][component][axis]; of a cuboid half of it, in the doubled
                                 lengths */
    lanes size[2][6];         /* [frame][edge]: no smaller than the length of the edge */
    lanes offset[3];          /* of the reference point of b, in the middle of the window */
    lanes half_drift[3];      /* the offset moves from offset - half_drift to offset + half_drift */
    lanes half_drift_size;
    lanes reach;         /* T of the derivation in slabs.c */
    lanes unit;          /* error of the gap of a slab of scale 1, errors of the frames included */
    lanes error;         /* sum of the errors of both frames (prepared.h) */
    lanes_mask in_range; /* doubles can decide the pair */
    lanes_mask tiny;     /* products with the drift may underflow to 0 */
    /* traits.second only (slabs_second.h). signed_axes, bit i: the sign of the gap along axis i is
     * known exactly. across[frame][edge], bit i: in addition, the edge has no extent along axis i.
     */
    lanes_bits signed_axes, across[2][6];
};

INLINE int next(int i)
{
    return i == 2 ? 0 : i + 1;
}

/* Whether a frame in 3D has the edge 3 + i, a difference of components. */
INLINE bool has_difference(const struct kernel_traits traits, int which, int i)
{
    return traits.simplex[which] && (!traits.face[which] || i == 2);
}

INLINE lanes dot(const lanes u[3], const lanes v[3])
{
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

INLINE void cross(const lanes u[3], const lanes v[3], lanes out[3])
{
    out[0] = u[1] * v[2] - u[2] * v[1];
    out[1] = u[2] * v[0] - u[0] * v[2];
    out[2] = u[0] * v[1] - u[1] * v[0];
}

/* The product [x y] of vectors in 2D. */
INLINE lanes product(const lanes x[3], const lanes y[3])
{
    return x[0] * y[1] - x[1] * y[0];
}

/* ---- Setting a pair ---- */

/* Bound on the error of a gap, and of all numbers that it is made of, relative to the scale of the
 * slab and T: derived in slabs.c. */
INLINE double slab_rounding(const struct kernel_traits traits)
{
    return (traits.rough ? SLABS_ROUGH : 1) *
           (traits.dim == 2 ? SLABS_ROUNDING_2D : SLABS_ROUNDING);
}

/* Whether the lengths of the pair are doubled. */
INLINE bool is_doubled(const struct kernel_traits traits)
{
    return !traits.simplex[0] || !traits.simplex[1];
}

/* Sets components and sizes of a frame; returns its share of the reach. */
INLINE lanes set_components(const struct kernel_traits traits, int which,
                            const lanes component[3][3], const lanes size[3],
                            struct pair_lanes *out)
{
    const bool twice = is_doubled(traits) && traits.simplex[which];
    lanes sum = size[0] + size[1];
    UNROLL(3)
    for (int i = 0; i < component_count(traits, which); i++) {
        UNROLL(3)
        for (int axis = 0; axis < traits.dim; axis++)
            out->component[which][i][axis] =
                twice ? component[i][axis] + component[i][axis] : component[i][axis];
        out->size[which][i] = twice ? size[i] + size[i] : size[i];
    }
    if (component_count(traits, which) == 3)
        sum += size[2];
    lanes *own = out->size[which];
    UNROLL(3)
    for (int i = 0; i < 3; i++)
        if (traits.dim == 3 && has_difference(traits, which, i))
            own[3 + i] = own[next(i)] + own[next(next(i))];
    if (traits.simplex[which] && traits.dim == 2)
        own[2] = own[0] + own[1];
    return is_doubled(traits) ? sum + sum : sum;
}

/* From the origin of a cuboid to its centre, along an axis, in the doubled lengths. */
INLINE lanes shift_of(const struct kernel_traits traits, const lanes component[3][3], int axis)
{
    const lanes sum = component[0][axis] + component[1][axis];
    return traits.dim == 2 ? sum : sum + component[2][axis];
}

/* The offset of the reference points in the middle of the window, along an axis. For the pair with
 * its frames swapped it is exactly the negative. */
INLINE lanes offset_of(const struct kernel_traits traits, const lanes component[2][3][3],
                       lanes offset, lanes half, int axis)
{
    const lanes at = traits.drifts ? offset + half : offset;
    if (traits.simplex[0])
        return traits.simplex[1] ? at : at + shift_of(traits, component[1], axis);
    if (traits.simplex[1])
        return at - shift_of(traits, component[0], axis);
    return at + (shift_of(traits, component[1], axis) - shift_of(traits, component[0], axis));
}

/* Sets a pair. In, as the frames have them, not doubled: component[frame][component][axis],
 * size[frame][component], the offset of the origins, the drift, and the sum of the errors. */
INLINE void pair_lanes_set(const struct kernel_traits traits, const lanes component[2][3][3],
                           const lanes size[2][3], const lanes offset[3], const lanes drift[3],
                           lanes error, struct pair_lanes *out)
{
    const lanes reach_a = set_components(traits, 0, component[0], size[0], out);
    const lanes reach_b = set_components(traits, 1, component[1], size[1], out);
    lanes offset_size = lanes_of(0), half_size = lanes_of(0);
    out->tiny = (lanes_mask){0};
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++) {
        const lanes at = is_doubled(traits) ? offset[axis] + offset[axis] : offset[axis];
        const lanes half = !traits.drifts       ? lanes_of(0)
                           : is_doubled(traits) ? drift[axis]
                                                : 0.5 * drift[axis];
        out->half_drift[axis] = half;
        out->offset[axis] = offset_of(traits, component, at, half, axis);
        offset_size += lanes_abs(at);
        half_size += lanes_abs(half);
        out->tiny |= (half != 0) & (lanes_abs(half) < PREPARED_LEAST_NUMBER);
    }
    out->half_drift_size = half_size;
    out->reach = (reach_a + reach_b) + (offset_size + (half_size + half_size));
    out->error = is_doubled(traits) ? error + error : error;
    out->unit = slab_rounding(traits) * out->reach + out->error;
    out->in_range = offset_size <= PREPARED_LARGEST;
    if (!traits.drifts)
        return;
    lanes_mask usable = half_size >= PREPARED_LEAST;
    if (traits.box)
        usable |= half_size == 0;
    out->in_range &= usable & (half_size <= PREPARED_LARGEST);
}

/* Computes an edge by number (slabs.h). A difference that is 0 is exact, and no difference is tiny.
 */
INLINE void edge_vector(const struct kernel_traits traits, const struct pair_lanes *pair, int which,
                        int e, lanes out[3])
{
    const int p = traits.dim == 2 ? 0 : next(e % 3), q = traits.dim == 2 ? 1 : next(p);
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++)
        out[axis] = e < traits.dim
                        ? pair->component[which][e][axis]
                        : pair->component[which][q][axis] - pair->component[which][p][axis];
}

#endif
