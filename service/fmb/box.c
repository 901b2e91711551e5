/* The box of the intersection of a pair in contact, in doubles.
 *
 * Method. The box is that of the points (exact_box.c derives them)
 *   1. where an edge of one frame, cut by the other, ends: at both ends of the window;
 *   2. where the path of a vertex of one, cut by the other, ends;
 *   3. where an edge of one crosses an edge of the other in the course of the window,
 * and where the frames do not drift, of 1 at the start alone, swept by their common displacement.
 * Each is cut twice (clip.h): what might belong to the intersection widens the outer box, what
 * surely does the inner one. The true box lies between; where the two are close enough the outer
 * one is the answer.
 *
 * Accuracy. Cuts: weighed.h bounds the error of normal . w for vertices w of one frame seen from the
 * other. Where nothing rounds (limbs_never_round) there is none but that of quotients and of the
 * points made with them.
 *
 * Coordinates: o + sum x_i c_i + tau v T with x or tau in [0,1] is rounded at most 8 times, to
 * within 2^-49 of the sum of the magnitudes. */
#include "certified.h"

#include "clip.h"
#include "weighed.h"

#include <float.h>
#include <string.h>

enum { VERTICES_MAX = 8, FACES_MAX = 4, DIRECTIONS_MAX = 6, EDGES_MAX = 12 };

/* Of the largest coordinate; the limit that fmb.h states is 1e-12. */
static const double limit = 0.9e-12;

/* Of the magnitudes. */
static const double point_error = 0x1p-49;
/* Beyond this, of a place or a displacement, the exact method is asked. */
static const double largest_place = 0x1p300;

struct edge {
    int direction, start; /* number of its direction and of the vertex in which it starts */
};

/* A frame: its vertices and edges, and its faces, which cut those of the other one. */
struct part {
    enum fmb_shape shape;
    int dim, vertices, directions, edges, faces;
    struct weighed component[FMB_DIM_MAX];
    struct weighed direction[DIRECTIONS_MAX];
    struct edge edge[EDGES_MAX];
    double vertex[VERTICES_MAX][FMB_DIM_MAX]; /* with the origin at 0 */
    double place[VERTICES_MAX][FMB_DIM_MAX];  /* in the world, at the start */
    double displacement[FMB_DIM_MAX];         /* v T */
    double slack[FMB_DIM_MAX];                /* error of a point of the frame */
    /* Points x of the frame have normal . x between 0 and its volume, whatever its sign. */
    struct weighed normal[FACES_MAX];
    double low, high;
};

/* What the faces of the other frame say of one of these: c + s g >= 0 inside, twice for each face.
 */
struct cuts {
    double c[2 * FACES_MAX], c_error[FACES_MAX];
    double g[FACES_MAX], g_error[FACES_MAX]; /* -g[face] for the second */
};

struct boxing {
    const struct slabs_pair *slabs;
    bool rounds;
    struct part part[2];
    struct weighed offset, drift;                        /* of part 1 against part 0 */
    double outer[2][FMB_DIM_MAX], inner[2][FMB_DIM_MAX]; /* [0] lower, [1] upper ends */
    double largest; /* coordinate of a vertex of either over the window */
};

static double least(double x, double y)
{
    return x < y ? x : y;
}

static double greatest(double x, double y)
{
    return x > y ? x : y;
}

/* ---- A frame ---- */

static void add_edge(struct part *part, int direction, int start)
{
    part->edge[part->edges++] = (struct edge){direction, start};
}

/* Vertex v of a cuboid is the sum of the components whose bits are set in v; of a simplex the
 * origin, then the end of each component. Edges go by direction. */
static void set_cuboid(struct part *part)
{
    part->vertices = 1 << part->dim;
    for (int i = 0; i < part->dim; i++) {
        const int bit = 1 << i;
        part->direction[part->directions++] = part->component[i];
        for (int v = 0; v < part->vertices; v++) {
            if (!(v & bit))
                add_edge(part, i, v);
            for (int axis = 0; v & bit && axis < part->dim; axis++)
                part->vertex[v][axis] += part->component[i].at[axis];
        }
    }
}

static void set_simplex(struct part *part)
{
    part->vertices = part->dim + 1;
    for (int i = 0; i < part->dim; i++) {
        memcpy(part->vertex[i + 1], part->component[i].at, sizeof part->vertex[i + 1]);
        add_edge(part, part->directions, 0);
        part->direction[part->directions++] = part->component[i];
        for (int j = i + 1; j < part->dim; j++) {
            add_edge(part, part->directions, i + 1);
            part->direction[part->directions++] =
                weighed_sum(&part->component[j], -1, &part->component[i]);
        }
    }
}

/* normal[k] . c_k is the volume, normal[k] . c_i is 0 for other i; the face across from the origin
 * of a simplex has their sum. In 2D these are the components turned by a right angle. */
static void set_faces(struct part *part)
{
    const struct weighed *c = part->component;
    part->faces = part->dim;
    if (part->dim == 2) {
        const struct weighed turned = weighed_turn(&c[1]), zero = {{0}, {0}};
        part->normal[0] = weighed_sum(&zero, -1, &turned);
        part->normal[1] = weighed_turn(&c[0]);
    } else {
        for (int k = 0; k < 3; k++)
            part->normal[k] = weighed_cross(&c[(k + 1) % 3], &c[(k + 2) % 3]);
    }
    const double volume = weighed_dot(part->normal[0].at, c[0].at);
    part->low = least(0, volume);
    part->high = greatest(0, volume);
    if (part->shape == FMB_CUBOID)
        return;
    part->normal[part->faces] = weighed_sum(&part->normal[0], 1, &part->normal[1]);
    if (part->dim == 3)
        part->normal[part->faces] = weighed_sum(&part->normal[part->faces], 1, &part->normal[2]);
    part->faces++;
}

/* False if a place is too far away. */
static bool set_places(const struct fmb_frame *frame, double duration, struct part *part)
{
    bool near = true;
    for (int axis = 0; axis < part->dim; axis++) {
        part->displacement[axis] = frame->moving ? frame->velocity[axis] * duration : 0;
        double magnitude = fabs(frame->origin[axis]) + fabs(part->displacement[axis]);
        near = near && magnitude <= largest_place;
        for (int i = 0; i < part->dim; i++)
            magnitude += part->component[i].weight[axis];
        part->slack[axis] = point_error * magnitude;
        for (int v = 0; v < part->vertices; v++)
            part->place[v][axis] = frame->origin[axis] + part->vertex[v][axis];
    }
    return near;
}

static bool set_part(const struct fmb_frame *frame, double duration, struct part *part)
{
    memset(part, 0, sizeof *part);
    part->shape = frame->body->shape;
    part->dim = frame->body->dim;
    for (int i = 0; i < part->dim; i++)
        part->component[i] = weigh(frame->body->component[i]);
    if (part->shape == FMB_CUBOID)
        set_cuboid(part);
    else
        set_simplex(part);
    set_faces(part);
    return set_places(frame, duration, part);
}

/* ---- Points ---- */

/* point + s path, and how far off it may be: not at all where it is found to be exact. */
static double point_at(const struct boxing *boxing, double point, double s, double path,
                       double slack, double *error)
{
    const double way = s * path, x = point + way;
    const bool exact =
        !boxing->rounds && fma(s, path, -way) == 0 && x - point == way && x - way == point;
    *error = exact ? 0 : slack;
    return x;
}

/* Widens ends by a point known to lie in [x - error, x + error]: side 1 the outer ones, by all of
 * that; side -1 the inner ones, by what is sure. */
static void include(double ends[2][FMB_DIM_MAX], int axis, double x, double error, int side)
{
    ends[0][axis] = least(ends[0][axis], x - side * error);
    ends[1][axis] = greatest(ends[1][axis], x + side * error);
}

static void include_part(struct boxing *boxing, const struct part *part, const double *point,
                         const double *path, struct clip clip, bool outer)
{
    if (clip.low > clip.high)
        return;
    for (int axis = 0; axis < part->dim; axis++)
        for (int end = 0; end < 2; end++) {
            double error;
            const double x = point_at(boxing, point[axis], end ? clip.high : clip.low, path[axis],
                                      part->slack[axis], &error);
            include(outer ? boxing->outer : boxing->inner, axis, x, error, outer ? 1 : -1);
        }
}

/* ---- Kinds 1 and 2: segments cut by the faces of the other frame ---- */

/* Widens the box by what is left of the segment point + s path of a part. */
static void include_segment(struct boxing *boxing, const struct part *part, const double *point,
                            const double *path, const struct cuts *cuts, int faces)
{
    struct clip outer = {0, 1}, inner = {0, 1};
    for (int face = 0; face < faces; face++) {
        const double e = cuts->c_error[face], f = cuts->g_error[face], g = cuts->g[face];
        const double c = cuts->c[2 * face], d = cuts->c[2 * face + 1];
        clip_cut(&outer, c + e, g + f, true, boxing->rounds);
        clip_cut(&outer, d + e, -g + f, true, boxing->rounds);
        clip_cut(&inner, c - e, g - f, false, boxing->rounds);
        clip_cut(&inner, d - e, -g - f, false, boxing->rounds);
    }
    include_part(boxing, part, point, path, outer, true);
    include_part(boxing, part, point, path, inner, false);
}

/* What the faces of the other frame say of the motion and of each vertex and direction of a
 * part. */
struct seen {
    int faces;
    double vertex[FACES_MAX][VERTICES_MAX]; /* normal . vertex, at the start */
    double motion[FACES_MAX], motion_error[FACES_MAX];
    double direction[FACES_MAX][DIRECTIONS_MAX], direction_error[FACES_MAX][DIRECTIONS_MAX];
    double error[FACES_MAX]; /* of vertex, and of what is taken from it */
};

static double error_of(const struct boxing *boxing, double weight)
{
    return boxing->rounds ? weighed_error(weight) : 0;
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
        double weight = weighed_dot(normal->weight, boxing->offset.weight) +
                        weighed_dot(normal->weight, boxing->drift.weight);
        for (int i = 0; i < part->dim; i++)
            weight += weighed_dot(normal->weight, part->component[i].weight) +
                      weighed_dot(normal->weight, other->component[i].weight);
        out->error[face] = error_of(boxing, weight);
        out->motion[face] = sign * weighed_dot(normal->at, boxing->drift.at);
        out->motion_error[face] =
            error_of(boxing, weighed_dot(normal->weight, boxing->drift.weight));
        for (int v = 0; v < part->vertices; v++)
            out->vertex[face][v] = start + weighed_dot(normal->at, part->vertex[v]);
        for (int i = 0; i < part->directions; i++) {
            out->direction[face][i] = weighed_dot(normal->at, part->direction[i].at);
            out->direction_error[face][i] =
                error_of(boxing, weighed_dot(normal->weight, part->direction[i].weight));
        }
    }
}

/* Sets c for a vertex at an end of the window. */
static void cut_from(const struct boxing *boxing, int f, const struct seen *seen, int vertex,
                     int end, struct cuts *out)
{
    const struct part *other = &boxing->part[1 - f];
    for (int face = 0; face < seen->faces; face++) {
        const double at = seen->vertex[face][vertex] + (end ? seen->motion[face] : 0);
        out->c[2 * face] = at - other->low;
        out->c[2 * face + 1] = other->high - at;
        out->c_error[face] = seen->error[face];
    }
}

/* Kind 1, at an end of the window. */
static void include_edges(struct boxing *boxing, int f, const struct seen *seen, int end)
{
    const struct part *part = &boxing->part[f];
    for (int e = 0; e < part->edges; e++) {
        const struct edge edge = part->edge[e];
        struct cuts cuts;
        double point[FMB_DIM_MAX];
        cut_from(boxing, f, seen, edge.start, end, &cuts);
        for (int face = 0; face < seen->faces; face++) {
            cuts.g[face] = seen->direction[face][edge.direction];
            cuts.g_error[face] = seen->direction_error[face][edge.direction];
        }
        for (int axis = 0; axis < part->dim; axis++)
            point[axis] = part->place[edge.start][axis] + (end ? part->displacement[axis] : 0);
        include_segment(boxing, part, point, part->direction[edge.direction].at, &cuts,
                        seen->faces);
    }
}

/* Kind 2. */
static void include_paths(struct boxing *boxing, int f, const struct seen *seen)
{
    const struct part *part = &boxing->part[f];
    for (int v = 0; v < part->vertices; v++) {
        struct cuts cuts;
        cut_from(boxing, f, seen, v, 0, &cuts);
        memcpy(cuts.g, seen->motion, sizeof cuts.g);
        memcpy(cuts.g_error, seen->motion_error, sizeof cuts.g_error);
        include_segment(boxing, part, part->place[v], part->displacement, &cuts, seen->faces);
    }
}

/* ---- Kind 3: an edge of each ----
 *
 * With p + s e of A, q + u f of B, all seen from A, r = q + offset - p and
 * det = drift . (e x f) (exact_box.c):
 *
 *     tau = -r . (e x f) / det,   s = r . (f x drift) / det,   u = r . (e x drift) / det. */

struct crossing {
    double normal[3][FMB_DIM_MAX]; /* of tau, s, u; signs turned so that det >= 0 */
    double error[3];
    double det, det_error;
};

static void set_crossing(const struct boxing *boxing, const struct weighed *e,
                         const struct weighed *f, struct crossing *out)
{
    const struct weighed ef = weighed_cross(e, f), fd = weighed_cross(f, &boxing->drift),
                         ed = weighed_cross(e, &boxing->drift);
    const struct weighed *normals[3] = {&ef, &fd, &ed};
    const double det = weighed_dot(boxing->drift.at, ef.at);
    for (int i = 0; i < 3; i++) {
        double weight[2] = {0, 0};
        for (int part = 0; part < 2; part++)
            for (int c = 0; c < FMB_DIM_MAX; c++)
                weight[part] +=
                    weighed_dot(normals[i]->weight, boxing->part[part].component[c].weight);
        out->error[i] =
            error_of(boxing, weighed_dot(normals[i]->weight, boxing->offset.weight) +
                                 (weight[0] + weight[1]));
        const double sign = (det < 0 ? -1 : 1) * (i == 0 ? -1 : 1);
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            out->normal[i][axis] = sign * normals[i]->at[axis];
    }
    out->det = fabs(det);
    out->det_error = error_of(boxing, weighed_dot(ef.weight, boxing->drift.weight));
}

/* Where a parameter in [0,1], num / det, may lie. */
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
        out.outer.low = least(1, quotient_below(num - error, most, boxing->rounds));
    if (num + error < least_det)
        out.outer.high = least(1, quotient_above(num + error, least_det, boxing->rounds));
    return out;
}

/* The range of start + s edge + tau displacement along an axis. */
static struct clip point_range(const struct part *part, int vertex, const struct weighed *edge,
                               struct clip s, struct clip tau, int axis)
{
    const double e = edge->at[axis], v = part->displacement[axis];
    const double at = part->place[vertex][axis], slack = part->slack[axis];
    return (struct clip){at + (least(s.low * e, s.high * e) + least(tau.low * v, tau.high * v)) -
                             slack,
                         at +
                             (greatest(s.low * e, s.high * e) +
                              greatest(tau.low * v, tau.high * v)) +
                             slack};
}

/* The point lies on both edges, and so in both ranges. */
static void include_crossing(struct boxing *boxing, struct edge a, struct edge b,
                             const struct parameter parameter[3])
{
    const struct part *part = boxing->part;
    const bool sure = parameter[0].sure && parameter[1].sure && parameter[2].sure;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        const struct clip on_a = point_range(&part[0], a.start, &part[0].direction[a.direction],
                                             parameter[1].outer, parameter[0].outer, axis);
        const struct clip on_b = point_range(&part[1], b.start, &part[1].direction[b.direction],
                                             parameter[2].outer, parameter[0].outer, axis);
        const double low = greatest(on_a.low, on_b.low), high = least(on_a.high, on_b.high);
        include(boxing->outer, axis, low, 0, 1);
        include(boxing->outer, axis, high, 0, 1);
        if (!sure)
            continue;
        boxing->inner[0][axis] = least(boxing->inner[0][axis], high);
        boxing->inner[1][axis] = greatest(boxing->inner[1][axis], low);
    }
}

/* False where edges may cross, but nothing can be said of where. */
static bool include_crossing_at(struct boxing *boxing, const struct crossing *crossing,
                                struct edge a, struct edge b)
{
    double r[FMB_DIM_MAX];
    struct parameter parameter[3];
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        r[axis] = (boxing->part[1].vertex[b.start][axis] - boxing->part[0].vertex[a.start][axis]) +
                  boxing->offset.at[axis];
    for (int i = 0; i < 3; i++) {
        parameter[i] =
            parameter_of(boxing, crossing, weighed_dot(crossing->normal[i], r), crossing->error[i]);
        if (!parameter[i].possible)
            return true;
    }
    if (crossing->det <= crossing->det_error)
        return false;
    include_crossing(boxing, a, b, parameter);
    return true;
}

/* Edges of which det is exactly 0 have no vertex of this kind. */
static bool include_crossings(struct boxing *boxing)
{
    const struct part *a = &boxing->part[0], *b = &boxing->part[1];
    for (int i = 0; i < a->edges; i++) {
        struct crossing crossing;
        int direction = -1;
        for (int j = 0; j < b->edges; j++) {
            if (b->edge[j].direction != direction) {
                direction = b->edge[j].direction;
                set_crossing(boxing, &a->direction[a->edge[i].direction], &b->direction[direction],
                             &crossing);
            }
            if (!boxing->rounds && crossing.det == 0)
                continue;
            if (!include_crossing_at(boxing, &crossing, a->edge[i], b->edge[j]))
                return false;
        }
    }
    return true;
}

/* ---- All of it ---- */

static void find_largest(struct boxing *boxing)
{
    boxing->largest = 0;
    for (int f = 0; f < 2; f++) {
        const struct part *part = &boxing->part[f];
        for (int v = 0; v < part->vertices; v++)
            for (int axis = 0; axis < part->dim; axis++) {
                const double x = part->place[v][axis], y = x + part->displacement[axis];
                boxing->largest = greatest(boxing->largest, greatest(fabs(x), fabs(y)));
            }
    }
}

/* Frames that do not drift have the same displacement, and their intersection moves by it. */
static void sweep(struct boxing *boxing)
{
    const struct part *part = boxing->part;
    for (int axis = 0; axis < part[0].dim; axis++) {
        const double way = part[0].displacement[axis];
        const double slack = greatest(part[0].slack[axis], part[1].slack[axis]);
        const int end = way > 0, side = end ? 1 : -1;
        double error, *outer = &boxing->outer[end][axis];
        *outer = point_at(boxing, *outer, 1, way, slack, &error);
        *outer += side * error;
        boxing->inner[end][axis] += way;
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

static bool include_all(struct boxing *boxing)
{
    const bool drifts = boxing->slabs->motion.drifts;
    for (int f = 0; f < 2; f++) {
        struct seen seen;
        set_seen(boxing, f, &seen);
        include_edges(boxing, f, &seen, 0);
        if (!drifts)
            continue;
        include_edges(boxing, f, &seen, 1);
        include_paths(boxing, f, &seen);
    }
    return !drifts || boxing->part[0].dim == 2 || include_crossings(boxing);
}

bool box_of(const struct fmb_pair *pair, const struct slabs_pair *slabs, bool rounds,
            double box[2][FMB_DIM_MAX])
{
    struct boxing boxing = {.slabs = slabs,
                            .rounds = rounds,
                            .offset = weigh(slabs->motion.offset),
                            .drift = weigh(slabs->motion.drift)};
    if (!set_part(&pair->a, pair->duration, &boxing.part[0]) ||
        !set_part(&pair->b, pair->duration, &boxing.part[1]))
        return false;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        boxing.outer[0][axis] = boxing.inner[0][axis] = INFINITY;
        boxing.outer[1][axis] = boxing.inner[1][axis] = -INFINITY;
    }
    if (!include_all(&boxing))
        return false;
    if (!slabs->motion.drifts)
        sweep(&boxing);
    find_largest(&boxing);
    if (!is_tight(&boxing))
        return false;
    for (int axis = 0; axis < boxing.part[0].dim; axis++)
        for (int end = 0; end < 2; end++)
            box[end][axis] = boxing.outer[end][axis] + 0.0;
    return true;
}
