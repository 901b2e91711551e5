/* Method. Let e be a coordinate axis along which the coordinates of all vertices are exact in both
 * frames, even where the frames have errors (a box that turned about this axis), and along which
 * the pair does not drift. If the sums of these coordinates are exact too, so is the gap along e:
 * where it is positive, the frames are apart. Where it is 0 and the offset is farther inside the
 * bounds of all other slabs than their errors, the frames touch:
 *
 * The offset w lies on the bound of S along e, and so no relative interiors meet. Let F be the part
 * of the rounded S on that bound: a polygon (in 2D an edge) that contains w. Each edge of it lies
 * in another facet of S, whose slab is farther from w than the error of the frames is; the way to
 * it within the plane of F is no shorter. The true S has the same vertices on the bound, since
 * their coordinates along e are exact, each moved within the plane by no more than that error. So w
 * lies in the true polygon, and the closed frames meet. A polygon that is a segment or a point has
 * no such w.
 *
 * Slabs whose normal is parallel to e say what the gap along e says. */
#include "axis.h"

#include "range.h"

#include <math.h>

/* From lower to upper end of a frame along an axis, each known within a range. */
struct ends {
    struct range low, high;
};

static struct ends ends_of(const struct world_frame *frame, int axis)
{
    struct ends out = {range_of(frame->origin[axis]), range_of(frame->origin[axis])};
    double least = 0, greatest = 0;
    for (int i = 0; i < frame->count; i++) {
        const double c = frame->component[i][axis];
        if (frame->shape == FMB_CUBOID) {
            out.low = range_sum(out.low, range_of(range_least(c, 0)));
            out.high = range_sum(out.high, range_of(range_greatest(c, 0)));
        } else {
            least = range_least(c, least);
            greatest = range_greatest(c, greatest);
        }
    }
    out.low = range_sum(out.low, range_of(least));
    out.high = range_sum(out.high, range_of(greatest));
    return out;
}

static bool is_zero(struct range x)
{
    return x.low == 0 && x.high == 0;
}

/* TOUCHING: the gap along the axis is exactly 0. */
static enum fmb_verdict verdict_along(const struct slabs_pair *pair, int axis)
{
    const unsigned long long exact = (unsigned long long) PREPARED_EXACT_X
                                     << (3 * PREPARED_SIZE_BITS + axis);
    if (!(pair->a.head & pair->b.head & exact) ||
        (pair->duration > 0 && pair->a.velocity[axis] != pair->b.velocity[axis]))
        return 0;
    const struct ends a = ends_of(&pair->a, axis), b = ends_of(&pair->b, axis);
    const struct range above = {b.low.low - a.high.high, b.low.high - a.high.low};
    const struct range below = {a.low.low - b.high.high, a.low.high - b.high.low};
    if (above.low > 0 || below.low > 0)
        return FMB_SEPARATED;
    return is_zero(above) || is_zero(below) ? FMB_TOUCHING : 0;
}

/* Whether an edge has no extent along an axis. */
static bool is_across(const struct slabs_pair *pair, int number, int axis)
{
    if (number == SLABS_DRIFT)
        return true;
    const struct world_frame *frame = number < SLABS_EDGE_OF_B ? &pair->a : &pair->b;
    const int e = number % SLABS_EDGES, dim = frame->dim;
    if (e < dim)
        return frame->component[e][axis] == 0;
    const int p = dim == 2 ? 0 : (e + 1) % 3, q = dim == 2 ? 1 : (e + 2) % 3;
    return frame->component[p][axis] == frame->component[q][axis];
}

/* In 2D the normal of an edge is parallel to the axis that the edge does not extend along. */
static bool is_parallel(const struct slabs_pair *pair, struct slab_normal normal, int axis)
{
    return is_across(pair, normal.u, axis) && (pair->a.dim == 2 || is_across(pair, normal.v, axis));
}

static bool surely_inside(const struct slabs_pair *pair, const struct slab_value *slab)
{
    if (slab->error == 0 || slab_gap(slab) < -slab->error)
        return true;
    struct inequality side[2];
    slabs_refine(pair, slab->normal, side);
    return surely_holds(&side[0]) && surely_holds(&side[1]);
}

enum fmb_verdict axis_verdict(const struct slabs_pair *pair)
{
    int touching = -1;
    for (int axis = 0; axis < pair->a.dim; axis++) {
        const enum fmb_verdict verdict = verdict_along(pair, axis);
        if (verdict == FMB_SEPARATED)
            return verdict;
        if (verdict == FMB_TOUCHING)
            touching = axis;
    }
    if (touching < 0)
        return 0;
    struct slab_value slab[SLABS_MAX];
    const int count = slabs_list(pair, true, slab);
    for (int i = 0; i < count; i++)
        if (!is_parallel(pair, slab[i].normal, touching) && !surely_inside(pair, &slab[i]))
            return 0;
    return FMB_TOUCHING;
}
