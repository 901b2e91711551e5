/* The gap of a pair by its vertices: its order, its bounds, and the choice of step (support_gap.h).
 *
 * Accuracy, with u = 2^-53.
 *
 * Lower bound of a distance: support_search.c. On the grid it is taken from support_farthest().
 *
 * Upper bound of a distance: support_witness.c. */
#include "support_gap.h"

#include "integer_simplex.h"
#include "memory.h"
#include "support_round.h"

#include <math.h>
#include <string.h>

/* ---- Scale ---- */

/* Returns a lower bound, up to rounding, of the largest coordinate of a vertex of a frame over the
 * window, plus its radius: the largest coordinate of its vertices (of a hull, of two of them), or
 * half of the displacement, which is the difference of two points, if that is larger. */
static double least_of(const struct support_gap *gap, int f)
{
    const struct support_view *view = &gap->pair->view[f];
    const bool hull = view->placed.frame->shape == FMB_HULL;
    double least = 0.5 * vec3_largest(gap->pair->path[f]);
    for (unsigned i = 0; i < (hull ? 2 : view->vertices.count); i++) {
        double at[FMB_DIM_MAX];
        support_place(view, hull && i == 1 ? view->placed.frame->spanning[1] : i, at);
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            at[axis] += gap->pair->position[f][axis];
        least = fmax(least, vec3_largest(at));
    }
    return least + view->placed.frame->radius;
}

/* The limit on the width, relative to the largest coordinate; fmb.h states 1e-12. The tenth that is
 * left covers the rounding of that coordinate: a width is at least error, 32 u reach. Where it is
 * within the limit, numbers that cancel in the coordinate are therefore less than 2^12 times as
 * large, and their roundings less than 2^-36 of it. */
static const double limit = 0.9e-12;

/* Sets the bounds of a gap. least: a lower bound of the largest coordinate of a vertex over the
 * window. */
static void set_bounds(struct support_gap *gap, double least)
{
    const struct support_pair *pair = gap->pair;
    const double duration = pair->frames->duration;
    int exponent;
    gap->far = gap->late = 0;
    for (int f = 0; f < 2; f++) {
        const double way = vec3_sum(gap->pair->path[f]);
        gap->far += vec3_sum(gap->pair->position[f]) + way + pair->view[f].reach;
        gap->late += way;
    }
    gap->late *= duration < 0x1p-900 && duration > 0 ? fmin(0x1p-1073 / duration, 1) : 0;
    gap->tight = limit * least;
    frexp(pair->reach * (1 + 0x1p-40), &exponent);
    gap->scale = ldexp(1, POLYTOPE_BITS - (exponent > -200 ? exponent : -200));
}

/* ---- Distance ---- */

/* Sets the lower bound that the direction proves. */
static void set_lower(const struct support_gap *gap, struct fmb_gap *out)
{
    const double outward[FMB_DIM_MAX] = {-out->direction[0], -out->direction[1],
                                         -out->direction[2]};
    struct support_column column;
    out->bounds[0] = -(support_farthest(gap->pair, outward, &column) + 2 * gap->pair->error);
}

/* Whether the witness points are a deepest pair, within the limit of fmb.h. */
static bool is_deepest(const struct support_gap *gap, const struct fmb_gap *out)
{
    return gap_stray(out) + support_witness_error(gap) <= gap->tight;
}

/* deepest: the witness points have to be a deepest pair. */
static enum gap_outcome outcome_of(const struct support_gap *gap, bool deepest,
                                   const struct fmb_gap *out)
{
    const bool tight = out->bounds[1] - out->bounds[0] <= gap->tight;
    return tight && (!deepest || is_deepest(gap, out)) ? GAP_KNOWN : GAP_UNSURE;
}

static enum gap_outcome distance(const struct support_gap *gap,
                                 const struct support_nearest *nearest, bool deepest,
                                 struct fmb_gap *out)
{
    if (nearest->outcome != GAP_KNOWN)
        return nearest->outcome;
    memcpy(out->direction, nearest->direction, sizeof out->direction);
    out->bounds[0] = nearest->least - 4 * gap->pair->error;
    support_witness(gap, nearest, out);
    return outcome_of(gap, deepest, out);
}

/* ---- Distance on the grid ---- */

/* D on the grid, translated by -at. */
struct translated_grid {
    const struct support_gap *gap;
    const double *at;
};

static void grid_support(void *context, mpz_t n[3], struct integer_corner *out)
{
    const struct translated_grid *of = context;
    const struct support_gap *gap = of->gap;
    double direction[FMB_DIM_MAX];
    struct support_vertex vertex;
    integer_direction(n, direction);
    support_lowest(gap->pair, direction, &vertex);
    out->column = vertex.column;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        mpz_set_d(out->at[axis], (vertex.at[axis] - of->at[axis]) * gap->scale);
}

/* Finds a direction in which the distance is 0, up to the width of an enclosure. */
static void set_direction(const struct support_gap *gap, struct fmb_gap *out)
{
    struct support_depth depth;
    if (support_depth_begin(&depth, gap, NULL))
        while (!support_depth_step(&depth, 1))
            ;
    support_depth_end(&depth, out);
}

/* Finds the point of D nearest to the point at, with every vertex rounded to the grid, and sets the
 * direction from at to it. If they are equal, returns false, and sets no direction. */
static bool nearest_on_grid(const struct support_gap *gap, const double at[FMB_DIM_MAX],
                            struct support_nearest *out)
{
    struct translated_grid of = {gap, at};
    struct integer_simplex simplex;
    integer_simplex_each(&simplex, mpz_init);
    mpz_set_ui(simplex.other[0], 1);
    integer_simplex_begin(&simplex, simplex.other, grid_support, &of);
    while (!integer_simplex_step(&simplex, grid_support, &of))
        ;
    out->simplex.count = (unsigned) simplex.count;
    for (int c = 0; c < simplex.count; c++) {
        out->simplex.vertex[c].column = simplex.corner[c]->column;
        out->weight[c] = mpz_get_d(simplex.weight[c]) / mpz_get_d(simplex.total);
    }
    const bool apart = !simplex.zero;
    if (apart)
        integer_direction(simplex.normal, out->direction);
    integer_simplex_each(&simplex, mpz_clear);
    return apart;
}

/* Finds the point of D nearest to the origin. If that is the origin, the depth gives the direction.
 */
static enum gap_outcome distance_on_grid(const struct support_gap *gap, bool deepest,
                                         struct fmb_gap *out)
{
    const double origin[FMB_DIM_MAX] = {0};
    struct support_nearest nearest;
    if (nearest_on_grid(gap, origin, &nearest))
        memcpy(out->direction, nearest.direction, sizeof out->direction);
    else
        set_direction(gap, out);
    set_lower(gap, out);
    support_witness(gap, &nearest, out);
    return outcome_of(gap, deepest, out);
}

/* ---- Deepest pair ---- */

/* Sets the witness points that the weights give. Returns whether they are a deepest pair. */
static bool take_deepest(const struct support_gap *gap, const struct support_nearest *nearest,
                         struct fmb_gap *out)
{
    const double upper = out->bounds[1];
    support_witness(gap, nearest, out);
    out->bounds[1] = upper;
    return is_deepest(gap, out);
}

/* Sets the witness points of a pair that overlaps and does not drift, whose bounds and direction
 * are known. The upper bound times the direction is a point on the boundary of D, so the nearest
 * point of D is the same up to rounding; its weights give the deepest pair. bounded: the grid,
 * which allocates, is not used. */
static enum gap_outcome set_deepest(const struct support_gap *gap, bool bounded,
                                    struct fmb_gap *out)
{
    struct support_nearest nearest;
    double at[FMB_DIM_MAX];
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        at[axis] = out->bounds[1] * out->direction[axis];
    support_search_near(gap->pair, at, out->direction, &nearest);
    if (take_deepest(gap, &nearest, out))
        return GAP_KNOWN;
    if (bounded)
        return GAP_UNSURE;
    nearest_on_grid(gap, at, &nearest);
    return take_deepest(gap, &nearest, out) ? GAP_KNOWN : GAP_UNSURE;
}

/* ---- Pairs ---- */

/* It points into itself. */
struct support_gap_work {
    const struct support_pair *pair;
    bool swapped;
    enum fmb_verdict verdict, of_pair; /* of the cores, and of the pair */
    double farthest;
    enum { GAP_DEPTH, GAP_PLACING, GAP_PLACED_DEPTH } stage; /* what comes next */
    bool flat;                                               /* the depth needs no step */
    struct support_gap gap;
    struct support_placed placed;
    struct support_nearest nearest;
    struct support_depth depth;
};

/* Sets the gap in doubles. Returns false if doubles cannot bound it. */
static bool set_gap(const struct support_pair *pair, struct support_gap *out)
{
    out->pair = pair;
    if (!(pair->reach >= 0x1p-200 && pair->reach <= 0x1p200))
        return false;
    set_bounds(out, fmax(least_of(out, 0), least_of(out, 1)));
    return out->far <= 0x1p900;
}

/* ---- Point of contact ----
 *
 * The weights of a search give points a and b of the cores at one time, x = b - a a point of D.
 *
 * If the distance of x from the origin is at most the sum R of the radii, the point
 * a + (b - a) r_A / R is within r_A of a and within r_B of b.
 *
 * Otherwise let the origin be inside the simplex of the search, at least h from its facets. The
 * simplex then contains -x h / |x|, with other weights. The weighted mean of both points, with the
 * share |x| / (h + |x|) for the second one, is the origin: its weights give one point that both
 * cores contain at one time. The share is less than |x| / h. So on each axis that point is at most
 * this share of the spread of a core (spread_of()) from a or b, and its time at most this share of
 * the window from theirs. */

/* Returns an upper bound, on every axis, of the distance between any two points of frame f that
 * weights of the simplex of a search give: the extent of its vertices, plus the travel of the frame
 * over the window. */
static double spread_of(const struct support_gap *gap, const struct support_simplex *simplex, int f)
{
    double ends[2][FMB_DIM_MAX], spread = 0;
    for (unsigned c = 0; c < simplex->count; c++) {
        double at[FMB_DIM_MAX];
        support_place(&gap->pair->view[f], simplex->vertex[c].column.vertex[f], at);
        for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
            ends[0][axis] = c == 0 ? at[axis] : fmin(ends[0][axis], at[axis]);
            ends[1][axis] = c == 0 ? at[axis] : fmax(ends[1][axis], at[axis]);
        }
    }
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        spread = fmax(spread, ends[1][axis] - ends[0][axis] + fabs(gap->pair->path[f][axis]));
    return spread + support_witness_error(gap);
}

/* The largest error of a time, as a fraction of the window. fmb.h allows 1e-12; the remainder
 * covers the rounding to seconds. */
static const double time_limit = 0.9e-12;

/* Returns the error of the point relative to the limits of fmb.h, for a simplex whose facets are at
 * least depth from the origin. share: 1 if the point is taken from b, 0 if it is taken from a. */
static double relative_error(const struct support_gap *gap, const struct support_nearest *nearest,
                             double depth, double *share)
{
    const double part = support_distance_above(gap->pair, nearest) / depth;
    const double spread[2] = {spread_of(gap, &nearest->simplex, 0),
                              spread_of(gap, &nearest->simplex, 1)};
    const double allowed = gap->tight - support_witness_error(gap);
    *share = spread[0] > spread[1];
    if (!(allowed > 0))
        return INFINITY;
    return fmax(part * fmin(spread[0], spread[1]) / allowed,
                gap->pair->drifts ? part / time_limit : 0);
}

bool support_common_point(const struct support_pair *pair, const struct support_nearest *found,
                          double point[1 + FMB_DIM_MAX])
{
    struct support_nearest nearest = *found;
    struct support_gap gap;
    struct fmb_gap at;
    double share;
    if (!set_gap(pair, &gap))
        return false;
    if (pair->rounded && support_distance_above(pair, &nearest) <= pair->radius[0]) {
        const double a = 0.5 * pair->frames->a.frame->radius;
        share = a / (a + 0.5 * pair->frames->b.frame->radius);
        if (!(support_witness_error(&gap) <= gap.tight))
            return false;
    } else {
        double depth = support_simplex_depth(pair, &nearest.simplex), error;
        if (depth == 0)
            return false;
        error = relative_error(&gap, &nearest, depth, &share);
        if (error > 1 && error < INFINITY) {
            support_widen(pair, 2 * depth * error, &nearest);
            depth = support_simplex_depth(pair, &nearest.simplex);
            error = relative_error(&gap, &nearest, depth, &share);
        }
        if (!(error <= 1))
            return false;
    }
    support_witness(&gap, &nearest, &at);
    point[0] = at.time + 0.0;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        point[1 + axis] =
            at.witness[0][axis] + share * (at.witness[1][axis] - at.witness[0][axis]) + 0.0;
    return true;
}

/* Searches for the point of D nearest to the origin, of a separated pair up to farthest. */
static void search(const struct support_gap *gap, enum fmb_verdict verdict, double farthest,
                   struct support_nearest *out)
{
    const double near = support_separating_distance(gap->pair), far = farthest + near + gap->tight;
    support_search(gap->pair, verdict != FMB_SEPARATED ? INFINITY : fmax(far, near), out);
}

/* Whether a pair with this verdict has a deepest pair of points. */
static bool has_deepest(const struct support_pair *pair, enum fmb_verdict verdict)
{
    return verdict == FMB_OVERLAPPING && !pair->drifts && !pair->posed;
}

/* In: verdict, of the pair; bounded: the grid, which allocates, is not used. */
static enum gap_outcome solve_distance(const struct support_gap *gap,
                                       const struct support_nearest *nearest,
                                       enum fmb_verdict verdict, bool bounded, struct fmb_gap *out)
{
    const bool deepest = has_deepest(gap->pair, verdict);
    const enum gap_outcome outcome = distance(gap, nearest, deepest, out);
    return outcome == GAP_UNSURE && !bounded ? distance_on_grid(gap, deepest, out) : outcome;
}

/* In: the verdicts of the cores and of the pair; bounded: as above. */
static enum gap_outcome end_depth(struct support_depth *depth, enum fmb_verdict cores,
                                  enum fmb_verdict verdict, bool bounded, struct fmb_gap *out)
{
    const struct support_gap *gap = depth->gap;
    memset(out, 0, sizeof *out);
    const bool known = support_depth_end(depth, out);
    if (cores == FMB_TOUCHING)
        out->bounds[0] = out->bounds[1] = 0;
    if (known && has_deepest(gap->pair, verdict))
        return set_deepest(gap, bounded, out);
    return known ? GAP_KNOWN : GAP_UNSURE;
}

/* Completes a gap of the ordered pair: no number is -0. */
static enum gap_outcome complete(enum gap_outcome outcome, bool swapped, struct fmb_gap *out)
{
    out->time += 0.0;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        out->direction[axis] += 0.0;
        for (int f = 0; f < 2; f++)
            out->witness[f][axis] += 0.0;
    }
    if (outcome == GAP_KNOWN && swapped)
        gap_turn_round(out);
    return outcome;
}

/* Scales lengths by 2^exponent. Numbers that become subnormal are rounded: each coordinate of a
 * witness point, and a bound, by less than 2^-1074. */
static void scale_lengths(struct fmb_gap *gap, int exponent)
{
    const bool separated = gap->bounds[1] > 0;
    for (int f = 0; f < 2; f++)
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            gap->witness[f][axis] = ldexp(gap->witness[f][axis], exponent);
    const double lower = ldexp(gap->bounds[0], exponent), upper = ldexp(gap->bounds[1], exponent);
    if (gap->bounds[0] != 0)
        gap->bounds[0] = lower - 0x1p-1074;
    if (gap->bounds[1] != 0)
        gap->bounds[1] = upper + (separated ? 8 : 1) * 0x1p-1074;
    if (!separated && gap->bounds[1] > 0)
        gap->bounds[1] = 0;
}

/* ---- Steps ---- */

/* Facets raised, and vertices placed, in one step: of 2,048 vertices, less than a millisecond. */
enum { RAISED_AT_ONCE = 128, PLACED_AT_ONCE = 128 };

/* In doubles, a depth in one step. *late: it takes more. */
static enum gap_outcome solve_at_once(const struct support_gap *gap,
                                      const struct support_nearest *nearest, enum fmb_verdict cores,
                                      enum fmb_verdict verdict, bool bounded, bool *late,
                                      struct fmb_gap *out)
{
    struct support_depth depth;
    if (cores == FMB_SEPARATED)
        return solve_distance(gap, nearest, verdict, bounded, out);
    *late =
        support_depth_begin(&depth, gap, nearest) && !support_depth_step(&depth, RAISED_AT_ONCE);
    return end_depth(&depth, cores, verdict, bounded, out);
}

static void begin_placing(struct support_gap_work *work)
{
    work->stage = GAP_PLACING;
    support_placed_begin(work->pair, &work->placed);
}

enum gap_outcome support_gap_of_pair(const struct support_pair *pair, bool swapped,
                                     const struct support_nearest *nearest, enum fmb_verdict cores,
                                     enum fmb_verdict verdict, double farthest, struct fmb_gap *out,
                                     struct support_gap_work **work)
{
    struct support_nearest searched;
    struct support_gap gap;
    bool late = false;
    enum gap_outcome outcome = GAP_UNSURE;
    if (set_gap(pair, &gap)) {
        if (!nearest)
            search(&gap, cores, farthest, &searched);
        nearest = nearest ? nearest : &searched;
        outcome = solve_at_once(&gap, nearest, cores, verdict, !work, &late, out);
    }
    if (outcome == GAP_KNOWN && pair->rounded)
        support_round_gap(pair->frames, 0, verdict, has_deepest(pair, verdict), out);
    if (outcome != GAP_UNSURE)
        return complete(outcome, swapped, out);
    if (!work)
        return GAP_UNSURE;
    struct support_gap_work *begun = memory_allocate(sizeof *begun);
    begun->pair = pair;
    begun->swapped = swapped;
    begun->verdict = cores;
    begun->of_pair = verdict;
    begun->farthest = farthest;
    begun->flat = false;
    if (late) {
        begun->stage = GAP_DEPTH;
        set_gap(pair, &begun->gap);
        support_depth_begin(&begun->depth, &begun->gap, nearest);
    } else {
        begin_placing(begun);
    }
    *work = begun;
    return GAP_UNSURE;
}

/* With vertices that are placed exactly the enclosure is tight. With L the largest coordinate of a
 * vertex, or half a displacement, reach is below 10.4 L and far below 17 L, and
 *
 *     a distance is enclosed within   5 error + 2^-47 far + rounding   < 3000 u L,
 *     a depth within                  3 error + 56 units               < 4000 u L,
 *
 * where error is below 36 u reach, and a unit of the grid below 4 u reach. The limit is 8100 u L.
 */
static void begin_placed(struct support_gap_work *work)
{
    /* scale_lengths() lowers the bound by at most 1.5 * 2^-1074. */
    const double farthest = ldexp(work->farthest + 2 * 0x1p-1074, (int) -work->placed.exponent);
    work->gap.pair = &work->placed.pair;
    set_bounds(&work->gap, work->placed.least);
    if (work->placed.least == 0)
        return;
    search(&work->gap, work->verdict, farthest, &work->nearest);
    if (work->verdict == FMB_SEPARATED)
        return;
    work->stage = GAP_PLACED_DEPTH;
    work->flat = !support_depth_begin(&work->depth, &work->gap, &work->nearest);
}

static enum gap_outcome solve_placed(struct support_gap_work *work, struct fmb_gap *out)
{
    if (work->placed.least == 0) { /* two points at the origin of the world */
        memset(out, 0, sizeof *out);
        out->direction[0] = 1;
        out->has_witness = has_deepest(work->pair, work->of_pair);
        return GAP_KNOWN;
    }
    const enum gap_outcome outcome =
        solve_distance(&work->gap, &work->nearest, work->of_pair, false, out);
    return outcome == GAP_FAR ? GAP_FAR : GAP_KNOWN;
}

void support_gap_end(struct support_gap_work *work)
{
    if (work->stage != GAP_PLACING)
        polytope_end(&work->depth.mesh);
    if (work->stage != GAP_DEPTH)
        support_placed_end(&work->placed);
    memory_release(work, sizeof *work);
}

enum gap_outcome support_gap_step(struct support_gap_work *work, struct fmb_gap *out)
{
    enum gap_outcome outcome = GAP_UNSURE;
    if (work->stage == GAP_PLACING && support_placed_step(&work->placed, PLACED_AT_ONCE)) {
        begin_placed(work);
        if (work->verdict == FMB_SEPARATED || work->placed.least == 0)
            outcome = solve_placed(work, out);
    } else if (work->stage != GAP_PLACING &&
               (work->flat || support_depth_step(&work->depth, RAISED_AT_ONCE))) {
        outcome = end_depth(&work->depth, work->verdict, work->of_pair, false, out);
        if (outcome == GAP_UNSURE && work->stage == GAP_DEPTH)
            begin_placing(work);
        else
            outcome = GAP_KNOWN;
    }
    if (outcome == GAP_UNSURE)
        return GAP_UNSURE;
    const bool scaled = work->stage != GAP_DEPTH && work->placed.least > 0;
    const int exponent = scaled ? (int) work->placed.exponent : 0;
    if (outcome == GAP_KNOWN && work->pair->rounded)
        support_round_gap(work->pair->frames, exponent, work->of_pair,
                          has_deepest(work->pair, work->of_pair), out);
    if (outcome == GAP_KNOWN && scaled)
        scale_lengths(out, exponent);
    complete(outcome, work->swapped, out);
    support_gap_end(work);
    return outcome;
}
