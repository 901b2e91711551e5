/* The gap of two frames: the order of the pair, the preparation in doubles, and the choice of step.
 *
 *   In     two prepared frames, the window, their verdict
 *   Out    struct fmb_gap; GAP_FAR if the gap is surely greater than farthest; GAP_UNSURE if
 *          doubles do not suffice: support_gap.h then computes it from the vertices of both frames
 *
 * Steps (gap_of()):
 *
 *   1. gap_frames_swap()  puts the pair into an order that depends on its numbers only
 *   2. gap_pair_set()     collects offset, vectors, error and scale in doubles
 *   3. gap_in_doubles()   gap_axis_aligned(), then gap_distance() or gap_depth() by the verdict
 *
 * Each file proves its own bounds: gap_axis_aligned.c, gap_distance.c, and gap_depth.c with
 * gap_bounds.c. The functions for bodies of several frames take the least gap of their frames.
 */
#include "gap.h"

#include "interval.h"

#include <math.h>
#include <string.h>

/* ---- Order ---- */

static int compare(const double *x, const double *y, int count)
{
    for (int i = 0; i < count; i++)
        if (x[i] != y[i])
            return x[i] < y[i] ? -1 : 1;
    return 0;
}

static int compare_placements(const struct fmb_placement *x, const struct fmb_placement *y)
{
    const int dim = x->body->dim;
    int order = compare(x->position, y->position, dim);
    order = order ? order : compare(x->velocity, y->velocity, dim);
    order = order ? order : x->orientation_count - y->orientation_count;
    order = order ? order : compare(x->orientation, y->orientation, x->orientation_count);
    order = order ? order : x->end_count - y->end_count;
    if (order || x->end_count == 0)
        return order;
    order = compare(x->end_position, y->end_position, dim);
    return order ? order : compare(x->end_orientation, y->end_orientation, x->orientation_count);
}

static int compare_frames(const struct fmb_frame *x, const struct fmb_frame *y)
{
    int order = (int) x->shape - (int) y->shape;
    order = order ? order : (int) x->vertex_count - (int) y->vertex_count;
    if (order == 0 && x->vertices != y->vertices)
        order = compare(x->vertices, y->vertices, x->dim * (int) x->vertex_stride);
    order = order ? order : compare(x->origin, y->origin, FMB_DIM_MAX);
    order = order ? order : compare(x->centre, y->centre, FMB_DIM_MAX);
    order = order ? order : compare(x->component[0], y->component[0], FMB_COMPONENTS_MAX);
    order = order ? order : compare(x->remainder[0], y->remainder[0], FMB_COMPONENTS_MAX);
    return order ? order : compare(&x->radius, &y->radius, 1);
}

bool gap_swaps(const struct fmb_placement *a, const struct fmb_placement *b)
{
    int order = compare_placements(a, b);
    if (order == 0 && a->body->frame_count != b->body->frame_count)
        order = a->body->frame_count < b->body->frame_count ? -1 : 1;
    for (unsigned i = 0; order == 0 && i < a->body->frame_count; i++)
        order = compare_frames(fmb_body_frame(a->body, i), fmb_body_frame(b->body, i));
    return order > 0;
}

/* Equal frames in equal placements have the order of their bodies. */
bool gap_frames_swap(const struct placed_frame *a, const struct placed_frame *b)
{
    int order = compare_placements(a->placement, b->placement);
    order = order ? order : compare_frames(a->frame, b->frame);
    return order == 0 ? gap_swaps(a->placement, b->placement) : order > 0;
}

void gap_turn_round(struct fmb_gap *gap)
{
    double first[FMB_DIM_MAX];
    memcpy(first, gap->witness[0], sizeof first);
    memcpy(gap->witness[0], gap->witness[1], sizeof first);
    memcpy(gap->witness[1], first, sizeof first);
    const unsigned frame = gap->frame[0];
    gap->frame[0] = gap->frame[1];
    gap->frame[1] = frame;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        gap->direction[axis] = 0 - gap->direction[axis];
}

/* ---- Numbers ---- */

/* Bounds the coordinates of a frame over the window; at least several times their magnitude. */
INLINE double far_of(const int dim, const struct fmb_prepared *frame, double duration)
{
    const double *number = frame->number;
    const double origin[FMB_DIM_MAX] = {number[0], number[1], dim == 3 ? number[2] : 0};
    const double sizes = (prepared_size(frame->summary, 0) + prepared_size(frame->summary, 1)) +
                         prepared_size(frame->summary, 2);
    const double far = vec3_sum(origin) + 2 * sizes;
    if (!(prepared_kind(frame) & PREPARED_MOVING))
        return far;
    const double *v = prepared_velocity(frame);
    return far + ((fabs(v[0]) + fabs(v[1])) + (dim == 3 ? fabs(v[2]) : 0)) * duration;
}

/* Lengths are sizes (2-norms, at most a fifteenth too large) and sums of magnitudes. The sum of
 * magnitudes of a component is less than twice its size, and its largest magnitude is more than
 * half its size.
 *
 * The largest coordinate of a vertex is bounded from below as follows. The origin is a vertex. Of
 * two vertices that differ by a component, or by the displacement over the window, one has a
 * coordinate of at least half of that difference. */
INLINE void set_frame(const int dim, int f, struct gap_pair *pair)
{
    const struct fmb_prepared *frame = pair->frame[f];
    const unsigned kind = prepared_kind(frame);
    const double *number = frame->number, *velocity = prepared_velocity(frame);
    const double x = prepared_size(frame->summary, 0), y = prepared_size(frame->summary, 1);
    const double z = prepared_size(frame->summary, 2), sizes = (x + y) + z;
    const double origin[FMB_DIM_MAX] = {number[0], number[1], dim == 3 ? number[2] : 0};
    pair->simplex[f] = kind & (PREPARED_TETRAHEDRON | PREPARED_FACE);
    pair->count[f] = kind & PREPARED_FACE ? 2 : dim;
    pair->error += number[(dim == 3 ? PREPARED_ERROR_3D : PREPARED_ERROR_2D) - 1];
    pair->reach += sizes;
    pair->far[f] = far_of(dim, frame, pair->duration);
    pair->least = interval_max(pair->least, vec3_largest(origin));
    pair->least = interval_max(pair->least, 0.25 * interval_max(x, interval_max(y, z)));
    if (!(kind & PREPARED_MOVING))
        return;
    const double way[FMB_DIM_MAX] = {velocity[0] * pair->duration, velocity[1] * pair->duration,
                                     dim == 3 ? velocity[2] * pair->duration : 0};
    pair->least = interval_max(pair->least, 0.5 * vec3_largest(way));
}

/* As slabs_prepare(): tiny drifts are left to integers. */
INLINE bool set_drift(const int dim, struct gap_pair *pair, double drift[FMB_DIM_MAX])
{
    const unsigned kinds = prepared_kind(pair->frame[0]) | prepared_kind(pair->frame[1]);
    const double *v = prepared_velocity(pair->frame[0]), *w = prepared_velocity(pair->frame[1]);
    bool good = true;
    pair->drifts = false;
    if (!(kinds & PREPARED_MOVING) || pair->duration == 0)
        return true;
    for (int axis = 0; axis < dim; axis++) {
        const double speed = w[axis] - v[axis];
        drift[axis] = speed * pair->duration;
        pair->drifts = pair->drifts || speed != 0;
        good = good && (speed == 0 || fabs(drift[axis]) >= 2 * PREPARED_LEAST_NUMBER);
    }
    const double largest = vec3_largest(drift);
    pair->reach += vec3_sum(drift);
    return !pair->drifts || (good && largest >= PREPARED_LEAST && largest <= PREPARED_LARGEST);
}

/* Components that a face lacks are 0. */
INLINE bool set_numbers(const int dim, struct gap_pair *pair)
{
    double drift[FMB_DIM_MAX] = {0};
    set_frame(dim, 0, pair);
    set_frame(dim, 1, pair);
    const bool good = set_drift(dim, pair, drift);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        const double *a = pair->frame[0]->number + axis, *b = pair->frame[1]->number + axis;
        const bool has = axis < dim;
        pair->offset[axis] = has ? b[0] - a[0] : 0;
        pair->vector[axis][0] = has ? -(lanes){a[dim], a[2 * dim]} : lanes_of(0);
        pair->vector[axis][1] = has ? (lanes){dim == 3 ? -a[9] : 0, b[dim]} : lanes_of(0);
        pair->vector[axis][2] = has ? (lanes){b[2 * dim], dim == 3 ? b[9] : 0} : lanes_of(0);
        pair->vector[axis][3] = (lanes){drift[axis], 0};
    }
    pair->reach += vec3_sum(pair->offset);
    pair->least = pair->least * (1 - 0x1p-40) - pair->error;
    /* Bodies may move together, so that only their displacements are large or infinite. */
    return good && vec3_largest(pair->offset) <= PREPARED_LARGEST && pair->least <= 0x1p1000;
}

bool gap_pair_set(const struct fmb_prepared *a, const struct fmb_prepared *b, double duration,
                  struct gap_pair *out)
{
    const unsigned both = prepared_kind(a) & prepared_kind(b);
    if (!(both & PREPARED_USABLE) || (prepared_kind(a) | prepared_kind(b)) & PREPARED_VERTICES)
        return false;
    out->frame[0] = a;
    out->frame[1] = b;
    out->duration = duration;
    out->error = out->reach = out->least = 0;
    out->dim = both & PREPARED_3D ? 3 : 2;
    return out->dim == 3 ? set_numbers(3, out) : set_numbers(2, out);
}

bool gap_is_tight(const struct gap_pair *pair, const double bounds[2])
{
    return bounds[1] - bounds[0] <= GAP_LIMIT * pair->least;
}

double gap_far_threshold(const struct fmb_prepared *a, const struct fmb_prepared *b,
                         double duration, double farthest)
{
    const int dim = prepared_kind(a) & PREPARED_3D ? 3 : 2;
    return farthest + GAP_FAR_MARGIN * (far_of(dim, a, duration) + far_of(dim, b, duration));
}

/* ---- Pairs of frames ---- */

/* Computes the gap of an ordered pair in doubles. */
static enum gap_outcome gap_in_doubles(const struct fmb_prepared *a, const struct fmb_prepared *b,
                                       double duration, enum fmb_verdict verdict, double farthest,
                                       struct fmb_gap *out)
{
    struct gap_pair pair;
    memset(out, 0, sizeof *out);
    if (!gap_pair_set(a, b, duration, &pair))
        return GAP_UNSURE;
    if (gap_axis_aligned(&pair, verdict, out) == GAP_KNOWN)
        return GAP_KNOWN;
    enum gap_outcome outcome = verdict == FMB_SEPARATED ? gap_distance(&pair, farthest, out)
                                                        : gap_depth(&pair, verdict, out);
    if (outcome == GAP_KNOWN && verdict == FMB_OVERLAPPING && !pair.drifts)
        outcome = gap_deepest(&pair, out);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out->direction[axis] += 0.0;
    return outcome;
}

enum gap_outcome gap_of(const struct fmb_prepared *a, const struct fmb_prepared *b, double duration,
                        enum fmb_verdict verdict, double farthest, struct fmb_gap *out)
{
    const struct placed_frame first = {a->frame, a->placement}, second = {b->frame, b->placement};
    const bool swaps = gap_frames_swap(&first, &second);
    enum gap_outcome outcome =
        gap_in_doubles(swaps ? b : a, swaps ? a : b, duration, verdict, farthest, out);
    if (outcome == GAP_KNOWN && swaps)
        gap_turn_round(out);
    return outcome;
}

/* ---- Bodies of several frames ---- */

struct fmb_gap gap_none(void)
{
    return (struct fmb_gap){.bounds = {NAN, NAN}};
}

bool gap_is_known(const struct fmb_gap *gap)
{
    return !isnan(gap->bounds[0]);
}

/* Raises the lower bound to the distance of the boxes on an axis, rounded down, if that is greater.
 */
static void raise(struct fmb_gap *gap, const struct aabb *a, const struct aabb *b)
{
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        for (int side = 0; side < 2; side++) {
            const struct aabb *low = side ? a : b, *high = side ? b : a;
            const double apart = low->end[axis][0] + high->end[axis][1];
            const double below = apart - apart * 0x1p-52;
            if (!(apart > 0 && below > gap->bounds[0]))
                continue;
            gap->bounds[0] = below;
            memset(gap->direction, 0, sizeof gap->direction);
            gap->direction[axis] = side ? -1 : 1;
        }
}

/* Compares upper bounds, then the fields that belong to them, then the frames. */
static int compare_gaps(const struct fmb_gap *x, const struct fmb_gap *y)
{
    int order = compare(&x->bounds[1], &y->bounds[1], 1);
    order = order ? order : (int) y->has_witness - (int) x->has_witness;
    order = order ? order : compare(&x->time, &y->time, 1);
    order = order ? order : compare(x->witness[0], y->witness[0], 2 * FMB_DIM_MAX);
    order = order ? order : compare(x->direction, y->direction, FMB_DIM_MAX);
    for (int side = 0; order == 0 && side < 2; side++)
        order = (x->frame[side] > y->frame[side]) - (x->frame[side] < y->frame[side]);
    return order;
}

void gap_include(struct fmb_gap *all, const struct fmb_gap *one, const struct aabb *a,
                 const struct aabb *b, bool swaps)
{
    struct fmb_gap raised = *one, x, y = *all;
    raise(&raised, a, b);
    x = raised;
    if (swaps) {
        gap_turn_round(&x);
        gap_turn_round(&y);
    }
    const bool first = !gap_is_known(all);
    const double lower = first ? -x.bounds[0] : interval_max(-x.bounds[0], -y.bounds[0]);
    if (first || compare_gaps(&x, &y) < 0)
        *all = raised;
    all->bounds[0] = 0 - lower;
}

void gap_end(enum fmb_verdict verdict, struct fmb_gap *gap)
{
    if (verdict == FMB_TOUCHING)
        gap->bounds[0] = 0;
}

/* The lower bound of frames is raised to the distance of their boxes, so that only the rounding of
 * that matters. Where a product with the margin underflows, coordinates are multiples of 2^-1074
 * below 2^-1035, and the distance is exact. */
double gap_reach(double upper, const struct aabb *a, const struct aabb *b)
{
    const double least = isnan(upper) ? INFINITY : upper > 0 ? upper : 0;
    return least + GAP_FAR_MARGIN * (aabb_max_coordinate(a) + aabb_max_coordinate(b));
}
