/* The box of the intersection of a pair in contact, in doubles.
 *
 * Method. The box is that of the points (exact_box.c derives them)
 *   1. where an edge of one frame, cut by the other, ends: at both ends of the window;
 *   2. where the path of a vertex of one, cut by the other, ends;
 *   3. where an edge of one crosses an edge of the other in the course of the window.
 * A face (FMB_FACE) cuts nothing, and is pierced by edges of the other frame in 1, and by paths of
 * its vertices in 2: an edge or path parallel to it that lies in it brings nothing that another one
 * from the same vertex does not, which there is where the other frame is solid, or a face of
 * another plane (with one of a parallel plane the drift is no such path). And where the frames do
 * not drift, of 1 at the start alone, swept by their common displacement. Each is cut twice
 * (clip.h): what might belong to the intersection widens the outer box, what surely does the inner
 * one. The true box lies between; where the two are close enough the outer one is the answer.
 *
 * Accuracy. Cuts: weighed.h bounds the error of normal . w for vertices w of one frame seen from
 * the other. Where nothing rounds (limbs_never_round) there is none but that of quotients and of
 * the points made with them.
 */
#include "certified.h"

#include "clip.h"
#include "part.h"

#include <float.h>
#include <string.h>

/* Of the largest coordinate; the limit that fmb.h states is 1e-12. */
static const double limit = 0.9e-12;

/* What the faces of the other frame say of one of these: two inequalities for each. */
struct cuts {
    int count;
    struct inequality cut[2 * PART_FACES];
};

struct boxing {
    const struct slabs_pair *slabs;
    bool rounds;
    struct part part[2];
    struct weighed offset, drift; /* of part 1 against part 0 */
    double reach[FMB_DIM_MAX];    /* sum of the magnitudes of offset, drift, all components */
    double outer[2][FMB_DIM_MAX], inner[2][FMB_DIM_MAX]; /* [0] lower, [1] upper ends */
    double largest; /* coordinate of a vertex of either over the window */
};

/* ---- Points ---- */

/* Widens the box by a point known to lie in x: the outer one by all of that, and the inner one by
 * what is sure, if the point is surely one of the intersection. */
static void include(struct boxing *boxing, int axis, struct range x, bool outer, bool inner)
{
    double(*out)[FMB_DIM_MAX] = boxing->outer, (*in)[FMB_DIM_MAX] = boxing->inner;
    if (outer) {
        out[0][axis] = range_least(out[0][axis], x.low);
        out[1][axis] = range_greatest(out[1][axis], x.high);
    }
    if (inner) {
        in[0][axis] = range_least(in[0][axis], x.high);
        in[1][axis] = range_greatest(in[1][axis], x.low);
    }
}

/* An edge at an end of the window, or the path of a vertex. */
struct segment {
    const struct range *from, *to; /* places */
    const double *path;            /* to - from, rounded */
};

/* from + s path: a vertex where the segment is not cut. Where nothing rounds, from and path are
 * exact. */
static struct range point_at(const struct boxing *boxing, const struct part *part,
                             const struct segment *segment, double s, int axis)
{
    const struct range from = segment->from[axis];
    if (s == 0 || s == 1)
        return s == 0 ? from : segment->to[axis];
    if (!boxing->rounds)
        return range_sum(from, range_product(s, segment->path[axis]));
    const double x = from.low + s * segment->path[axis];
    return (struct range){x - part->slack[axis], x + part->slack[axis]};
}

static void include_part(struct boxing *boxing, const struct part *part,
                         const struct segment *segment, struct clip clip, bool outer)
{
    if (clip.low > clip.high)
        return;
    for (int axis = 0; axis < part->dim; axis++) {
        include(boxing, axis, point_at(boxing, part, segment, clip.low, axis), outer, !outer);
        include(boxing, axis, point_at(boxing, part, segment, clip.high, axis), outer, !outer);
    }
}

/* ---- Kinds 1 and 2: segments cut by the faces of the other frame ---- */

/* Widens the box by what is left of a segment of a part. */
static void include_segment(struct boxing *boxing, const struct part *part,
                            const struct segment *segment, const struct cuts *cuts)
{
    struct clip outer = {0, 1}, inner = {0, 1};
    for (int i = 0; i < cuts->count; i++)
        if (never_holds(&cuts->cut[i]))
            return;
    for (int i = 0; i < cuts->count; i++)
        clip_both(&outer, &inner, &cuts->cut[i], boxing->rounds);
    include_part(boxing, part, segment, outer, true);
    include_part(boxing, part, segment, inner, false);
}

/* What the faces of the other frame say of the motion and of each vertex and direction of a
 * part. */
struct seen {
    int faces;
    double vertex[PART_FACES][PART_VERTICES]; /* normal . vertex, at the start */
    double motion[PART_FACES], motion_error[PART_FACES];
    double direction[PART_DIRECTIONS][PART_FACES], direction_error[PART_DIRECTIONS][PART_FACES];
    double error[PART_FACES]; /* of vertex, and of what is taken from it */
};

/* Of normal . w, weights and placing included: twice the latter (parameter_of()). */
static double error_of(const struct boxing *boxing, const struct weighed *normal,
                       const double weight[FMB_DIM_MAX])
{
    const struct slabs_pair *slabs = boxing->slabs;
    const double placing = slabs->inexact ? 2 * normal->length * slabs->placing : 0;
    return boxing->rounds ? weighed_error(weighed_dot(normal->weight, weight)) + placing : 0;
}

/* Seen from frame 1 - f, the origin of frame f is at offset + tau drift (f = 1), or at minus that.
 */
static void set_seen(const struct boxing *boxing, int f, struct seen *out)
{
    const struct part *part = &boxing->part[f], *other = &boxing->part[1 - f];
    const double sign = f ? 1 : -1;
    out->faces = other->faces;
    for (int face = 0; face < other->faces; face++) {
        const struct weighed *normal = &other->normal[face];
        const double start = sign * weighed_dot(normal->at, boxing->offset.at);
        out->error[face] = error_of(boxing, normal, boxing->reach);
        out->motion[face] = sign * weighed_dot(normal->at, boxing->drift.at);
        out->motion_error[face] = error_of(boxing, normal, boxing->drift.weight);
        for (int v = 0; v < part->vertices; v++)
            out->vertex[face][v] = start + weighed_dot(normal->at, part->vertex[v]);
        for (int i = 0; i < part->directions; i++) {
            out->direction[i][face] = weighed_dot(normal->at, part->direction[i].at);
            out->direction_error[i][face] = error_of(boxing, normal, part->direction[i].weight);
        }
    }
}

/* The cuts of a segment that starts in a vertex at an end of the window, and on which
 * normal . point changes by change[face]. */
static struct cuts cuts_of(const struct boxing *boxing, int f, const struct seen *seen, int vertex,
                           int end, const double *change, const double *change_error)
{
    const struct part *other = &boxing->part[1 - f];
    struct cuts out = {.count = 2 * seen->faces};
    for (int face = 0; face < seen->faces; face++) {
        const double at = seen->vertex[face][vertex] + (end ? seen->motion[face] : 0);
        out.cut[2 * face] = (struct inequality){at - other->low, change[face], seen->error[face],
                                                change_error[face]};
        out.cut[2 * face + 1] = (struct inequality){other->high - at, -change[face],
                                                    seen->error[face], change_error[face]};
    }
    return out;
}

/* Kind 1, at an end of the window. */
static void include_edges(struct boxing *boxing, int f, const struct seen *seen, int end)
{
    const struct part *part = &boxing->part[f];
    for (int e = 0; e < part->edges; e++) {
        const struct part_edge edge = part->edge[e];
        const struct cuts cuts =
            cuts_of(boxing, f, seen, edge.start, end, seen->direction[edge.direction],
                    seen->direction_error[edge.direction]);
        const struct segment segment = {part->place[end][edge.start], part->place[end][edge.end],
                                        part->direction[edge.direction].at};
        include_segment(boxing, part, &segment, &cuts);
    }
}

/* Kind 2. */
static void include_paths(struct boxing *boxing, int f, const struct seen *seen)
{
    const struct part *part = &boxing->part[f];
    for (int v = 0; v < part->vertices; v++) {
        const struct cuts cuts = cuts_of(boxing, f, seen, v, 0, seen->motion, seen->motion_error);
        const struct segment segment = {part->place[0][v], part->place[1][v], part->displacement};
        include_segment(boxing, part, &segment, &cuts);
    }
}

/* ---- Crossings: of two things that have one point in common, each with a parameter in [0,1] ----
 */

enum { CROSSING_PARAMETERS = 4 };

/* Parameter i is normal[i] . r / det, of a vector r. */
struct crossing {
    int parameters;
    double normal[CROSSING_PARAMETERS][FMB_DIM_MAX]; /* signs turned so that det >= 0 */
    double error[CROSSING_PARAMETERS];
    double det, det_error;
};

/* From normals that are to be multiplied with +1 or -1, and det = normal[0] . of. */
static void set_crossing(const struct boxing *boxing, int parameters,
                         const struct weighed *const normal[], const int sign[],
                         const struct weighed *of, struct crossing *out)
{
    const double det = weighed_dot(of->at, normal[0]->at);
    out->parameters = parameters;
    for (int i = 0; i < parameters; i++) {
        out->error[i] = error_of(boxing, normal[i], boxing->reach);
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            out->normal[i][axis] = (det < 0 ? -sign[i] : sign[i]) * normal[i]->at[axis];
    }
    out->det = fabs(det);
    out->det_error = error_of(boxing, normal[0], of->weight);
}

/* Where a parameter in [0,1], num / det, may lie.
 *
 * Where the sign of det is not known it may have been turned the wrong way, and num with it; the
 * true det is then no larger than what det is off by. That is less than 10/32 of det_error, and
 * what num is off by less than 14/32 of error (of the 32 u in weighed_error(), so many are
 * roundings of these), and half of what both have for placing; and det_error <= error, whose weight
 * has all of the monomials of det in it: the reach holds edges and drift. So a true num / det in
 * [0,1] has |num| < error as it is found here, and is possible. */
struct parameter {
    struct clip outer;
    bool possible, sure; /* in [0,1] */
};

static struct parameter parameter_of(const struct boxing *boxing, const struct crossing *crossing,
                                     double num, double error)
{
    const double most = crossing->det + crossing->det_error;
    const double least_det = crossing->det - crossing->det_error;
    struct parameter out = {.outer = {0, 1}};
    out.possible = num + error >= 0 && num - error <= most;
    out.sure = num - error >= 0 && num + error <= least_det;
    if (least_det <= 0 || !out.possible)
        return out;
    if (num - error > 0)
        out.outer.low = range_least(1, quotient_below(num - error, most, boxing->rounds));
    if (num + error < least_det)
        out.outer.high = range_least(1, quotient_above(num + error, least_det, boxing->rounds));
    return out;
}

static struct range scaled(struct clip s, double x)
{
    return range_hull(range_product(s.low, x), range_product(s.high, x));
}

enum crossing_outcome { CROSSING_NONE, CROSSING_SOMEWHERE, CROSSING_POSSIBLE, CROSSING_SURE };

/* SOMEWHERE: there may be one, but nothing can be said of where. */
static enum crossing_outcome crossing_at(const struct boxing *boxing,
                                         const struct crossing *crossing,
                                         const double r[FMB_DIM_MAX],
                                         struct clip where[CROSSING_PARAMETERS])
{
    bool sure = true;
    for (int i = 0; i < crossing->parameters; i++) {
        const struct parameter parameter =
            parameter_of(boxing, crossing, weighed_dot(crossing->normal[i], r), crossing->error[i]);
        if (!parameter.possible)
            return CROSSING_NONE;
        where[i] = parameter.outer;
        sure = sure && parameter.sure;
    }
    if (crossing->det <= crossing->det_error)
        return CROSSING_SOMEWHERE;
    return sure ? CROSSING_SURE : CROSSING_POSSIBLE;
}

/* at and steps from there, each as long as a parameter says. */
static struct range walked(const struct boxing *boxing, struct range at, double slack, int steps,
                           const struct clip parameter[], const double step[])
{
    double low = 0, high = 0;
    for (int i = 0; i < steps && !boxing->rounds; i++)
        at = range_sum(at, scaled(parameter[i], step[i]));
    if (!boxing->rounds)
        return at;
    for (int i = 0; i < steps; i++) {
        const double one = parameter[i].low * step[i], other = parameter[i].high * step[i];
        low += range_least(one, other);
        high += range_greatest(one, other);
    }
    return (struct range){at.low + low - slack, at.high + high + slack};
}

/* A point that lies in both ranges. */
static void include_both(struct boxing *boxing, int axis, struct range x, struct range y, bool sure)
{
    const struct range both = {range_greatest(x.low, y.low), range_least(x.high, y.high)};
    include(boxing, axis, both, true, sure);
}

/* ---- Kinds 1 and 2, of a face: pierced by an edge at an end of the window, or by a path ----
 *
 * With p + s e of the segment, seen from the origin of the face, n = c0 x c1 and det = n . e,
 *
 *     s = -p . n / det,   x_0 = p . (c1 x e) / det,   x_1 = p . (e x c0) / det,
 *
 * as dot products of p + s e = x_0 c0 + x_1 c1 with n, c1 x e and e x c0 show; and x_0 + x_1 =
 * p . (e x (c0 - c1)) / det. */

static void set_piercing(const struct boxing *boxing, const struct part *face,
                         const struct weighed *e, struct crossing *out)
{
    static const int sign[] = {-1, 1, 1, 1};
    const struct weighed *c0 = &face->component[0], *c1 = &face->component[1];
    const struct weighed edge = weighed_sum(c0, -1, c1);
    const struct weighed normal[] = {weighed_cross(c0, c1), weighed_cross(c1, e),
                                     weighed_cross(e, c0), weighed_cross(e, &edge)};
    const struct weighed *const normals[] = {&normal[0], &normal[1], &normal[2], &normal[3]};
    set_crossing(boxing, 4, normals, sign, e, out);
}

/* A segment of frame 1 - f, from a vertex at an end of the window; where it is a path, s is the
 * time. step: the whole of it. */
struct piercer {
    int vertex, end;
    bool path;
    const double *step;
};

static void include_pierced(struct boxing *boxing, int f, const struct piercer *piercer,
                            const struct clip where[CROSSING_PARAMETERS], bool sure)
{
    const struct part *face = &boxing->part[f], *other = &boxing->part[1 - f];
    const struct clip of_face[3] = {where[1], where[2], where[0]};
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        const double step[3] = {face->component[0].at[axis], face->component[1].at[axis],
                                face->displacement[axis]};
        const struct range on_segment =
            walked(boxing, other->place[piercer->end][piercer->vertex][axis], other->slack[axis], 1,
                   where, &piercer->step[axis]);
        const struct range on_face =
            walked(boxing, face->place[piercer->end][0][axis], face->slack[axis],
                   piercer->path ? 3 : 2, of_face, step);
        include_both(boxing, axis, on_segment, on_face, sure);
    }
}

static bool include_piercing(struct boxing *boxing, int f, const struct crossing *crossing,
                             const struct piercer *piercer)
{
    const struct part *other = &boxing->part[1 - f];
    struct clip where[CROSSING_PARAMETERS];
    double r[FMB_DIM_MAX];
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        const double way = piercer->end ? boxing->drift.at[axis] : 0;
        const double apart = boxing->offset.at[axis] + way;
        r[axis] = other->vertex[piercer->vertex][axis] + (f == 0 ? apart : -apart);
    }
    const enum crossing_outcome outcome = crossing_at(boxing, crossing, r, where);
    if (outcome == CROSSING_POSSIBLE || outcome == CROSSING_SURE)
        include_pierced(boxing, f, piercer, where, outcome == CROSSING_SURE);
    return outcome != CROSSING_SOMEWHERE;
}

/* Edges of which det is exactly 0 are parallel to the face. */
static bool include_piercing_edges(struct boxing *boxing, int f, int end)
{
    const struct part *face = &boxing->part[f], *other = &boxing->part[1 - f];
    const int each = other->edges / other->directions;
    for (int i = 0; i < other->directions; i++) {
        struct crossing crossing;
        set_piercing(boxing, face, &other->direction[i], &crossing);
        if (!boxing->rounds && crossing.det == 0)
            continue;
        for (int k = i * each; k < (i + 1) * each; k++) {
            const struct piercer edge = {other->edge[k].start, end, false, other->direction[i].at};
            if (!include_piercing(boxing, f, &crossing, &edge))
                return false;
        }
    }
    return true;
}

/* Seen from frame f, the other one moves by the drift, or by what is opposite to it. */
static bool include_piercing_paths(struct boxing *boxing, int f)
{
    const struct part *other = &boxing->part[1 - f];
    const struct weighed zero = {{0}, {0}, 0};
    const struct weighed way = weighed_sum(&zero, f == 0 ? 1 : -1, &boxing->drift);
    struct crossing crossing;
    set_piercing(boxing, &boxing->part[f], &way, &crossing);
    for (int v = 0; v < other->vertices && (boxing->rounds || crossing.det != 0); v++) {
        const struct piercer path = {v, 0, true, other->displacement};
        if (!include_piercing(boxing, f, &crossing, &path))
            return false;
    }
    return true;
}

/* ---- Kind 3: an edge of each ----
 *
 * With p + s e of A, q + u f of B, all seen from A, r = q + offset - p and
 * det = drift . (e x f) (exact_box.c):
 *
 *     tau = -r . (e x f) / det,   s = r . (f x drift) / det,   u = r . (e x drift) / det. */

static void set_edge_crossing(const struct boxing *boxing, const struct weighed *e,
                              const struct weighed *f, struct crossing *out)
{
    static const int sign[] = {-1, 1, 1};
    const struct weighed normal[] = {weighed_cross(e, f), weighed_cross(f, &boxing->drift),
                                     weighed_cross(e, &boxing->drift)};
    const struct weighed *const normals[] = {&normal[0], &normal[1], &normal[2]};
    set_crossing(boxing, 3, normals, sign, &boxing->drift, out);
}

/* Along an axis, a point of an edge, at tau. */
static struct range point_range(const struct boxing *boxing, const struct part *part,
                                struct part_edge edge, struct clip s, struct clip tau, int axis)
{
    const struct clip where[2] = {s, tau};
    const double step[2] = {part->direction[edge.direction].at[axis], part->displacement[axis]};
    return walked(boxing, part->place[0][edge.start][axis], part->slack[axis], 2, where, step);
}

/* False where edges may cross, but nothing can be said of where. */
static bool include_crossing_at(struct boxing *boxing, const struct crossing *crossing,
                                struct part_edge a, struct part_edge b)
{
    const struct part *part = boxing->part;
    double r[FMB_DIM_MAX];
    struct clip where[CROSSING_PARAMETERS]; /* tau, s, u */
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        r[axis] = (part[1].vertex[b.start][axis] - part[0].vertex[a.start][axis]) +
                  boxing->offset.at[axis];
    const enum crossing_outcome outcome = crossing_at(boxing, crossing, r, where);
    if (outcome == CROSSING_NONE || outcome == CROSSING_SOMEWHERE)
        return outcome == CROSSING_NONE;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        include_both(boxing, axis, point_range(boxing, &part[0], a, where[1], where[0], axis),
                     point_range(boxing, &part[1], b, where[2], where[0], axis),
                     outcome == CROSSING_SURE);
    return true;
}

/* The edges of direction i of A and j of B: each direction has as many, one after the other. */
static bool include_parallel_crossings(struct boxing *boxing, int i, int j,
                                       const struct crossing *crossing)
{
    const struct part *a = &boxing->part[0], *b = &boxing->part[1];
    const int each_a = a->edges / a->directions, each_b = b->edges / b->directions;
    for (int k = i * each_a; k < (i + 1) * each_a; k++)
        for (int l = j * each_b; l < (j + 1) * each_b; l++)
            if (!include_crossing_at(boxing, crossing, a->edge[k], b->edge[l]))
                return false;
    return true;
}

/* Edges of which det is exactly 0 have no vertex of this kind. */
static bool include_crossings(struct boxing *boxing)
{
    const struct part *a = &boxing->part[0], *b = &boxing->part[1];
    for (int i = 0; i < a->directions; i++)
        for (int j = 0; j < b->directions; j++) {
            struct crossing crossing;
            set_edge_crossing(boxing, &a->direction[i], &b->direction[j], &crossing);
            if (!boxing->rounds && crossing.det == 0)
                continue;
            if (!include_parallel_crossings(boxing, i, j, &crossing))
                return false;
        }
    return true;
}

/* ---- All of it ---- */

/* Frames that do not drift have the same displacement, and their intersection moves by it. The
 * union holds the place where it starts too: an end only moves outward. (The inner ends are
 * rounded, by less than the tenth of the limit that is left to such things.) */
static void sweep(struct boxing *boxing)
{
    const struct part *part = boxing->part;
    for (int axis = 0; axis < part->dim; axis++) {
        const struct range low = range_sum(range_of(boxing->outer[0][axis]), part->way[axis]);
        const struct range high = range_sum(range_of(boxing->outer[1][axis]), part->way[axis]);
        boxing->outer[0][axis] = range_least(boxing->outer[0][axis], low.low);
        boxing->outer[1][axis] = range_greatest(boxing->outer[1][axis], high.high);
        boxing->inner[0][axis] += fmin(part->displacement[axis], 0);
        boxing->inner[1][axis] += fmax(part->displacement[axis], 0);
    }
}

/* The intersection lies in the extents of both frames: where these are ends of it, in boxes along
 * the axes say, they are as near as doubles go. Also finds the largest coordinate. */
static void cut_to_extents(struct boxing *boxing)
{
    boxing->largest = 0;
    for (int f = 0; f < 2; f++)
        for (int axis = 0; axis < boxing->part[f].dim; axis++) {
            const struct range extent = boxing->part[f].extent[axis];
            boxing->outer[0][axis] = range_greatest(boxing->outer[0][axis], extent.low);
            boxing->outer[1][axis] = range_least(boxing->outer[1][axis], extent.high);
            boxing->largest = range_greatest(boxing->largest,
                                             range_greatest(fabs(extent.low), fabs(extent.high)));
        }
}

static bool is_tight(const struct boxing *boxing)
{
    for (int axis = 0; axis < boxing->part[0].dim; axis++) {
        const double most = limit * boxing->largest;
        if (!(boxing->inner[0][axis] - boxing->outer[0][axis] <= most &&
              boxing->outer[1][axis] - boxing->inner[1][axis] <= most))
            return false;
    }
    return true;
}

/* Kinds 1 and 2: segments of frame f, cut by the faces of the other one, or piercing it. */
static bool include_segments(struct boxing *boxing, int f, bool drifts)
{
    struct seen seen;
    if (boxing->part[1 - f].shape == FMB_FACE)
        return include_piercing_edges(boxing, 1 - f, 0) &&
               (!drifts || (include_piercing_edges(boxing, 1 - f, 1) &&
                            include_piercing_paths(boxing, 1 - f)));
    set_seen(boxing, f, &seen);
    include_edges(boxing, f, &seen, 0);
    if (drifts) {
        include_edges(boxing, f, &seen, 1);
        include_paths(boxing, f, &seen);
    }
    return true;
}

static bool include_all(struct boxing *boxing)
{
    const bool drifts = boxing->slabs->motion.drifts;
    if (!include_segments(boxing, 0, drifts) || !include_segments(boxing, 1, drifts))
        return false;
    return !drifts || boxing->part[0].dim == 2 || include_crossings(boxing);
}

bool box_of(const struct slabs_pair *slabs, bool rounds, double box[2][FMB_DIM_MAX])
{
    struct boxing boxing = {.slabs = slabs,
                            .rounds = rounds,
                            .offset = weigh(slabs->motion.offset),
                            .drift = weigh(slabs->motion.drift)};
    if (!part_set(&slabs->a, slabs->duration, &boxing.part[0]) ||
        !part_set(&slabs->b, slabs->duration, &boxing.part[1]))
        return false;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        double size[2] = {0, 0};
        for (int f = 0; f < 2; f++)
            for (int i = 0; i < FMB_DIM_MAX; i++)
                size[f] += boxing.part[f].component[i].weight[axis];
        boxing.reach[axis] =
            (boxing.offset.weight[axis] + boxing.drift.weight[axis]) + (size[0] + size[1]);
        boxing.outer[0][axis] = boxing.inner[0][axis] = INFINITY;
        boxing.outer[1][axis] = boxing.inner[1][axis] = -INFINITY;
    }
    if (!include_all(&boxing))
        return false;
    if (!slabs->motion.drifts)
        sweep(&boxing);
    cut_to_extents(&boxing);
    if (!is_tight(&boxing))
        return false;
    for (int axis = 0; axis < boxing.part[0].dim; axis++)
        for (int end = 0; end < 2; end++)
            box[end][axis] = boxing.outer[end][axis] + 0.0;
    return true;
}
