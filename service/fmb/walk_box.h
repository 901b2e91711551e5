/* The box of the intersection of a pair at rest, of LANES pairs at once.
 *
 * Method. The vertices of the intersection are the ends of what is left of the edges of each frame
 * when the faces of the other have cut them. An edge is start + s direction, s in [-1, 1] (cuboids,
 * seen from the middle of the edge) or [0, 1]; a face of the other frame, low <= n . x <= high,
 * leaves s between (low - n . start) / n . direction and (high - n . start) / n . direction. With
 * bounds that are a little too far out all of that is an outer part of the edge, with bounds a
 * little too far in an inner one, which is surely there. The outer box, of all outer parts, is
 * the answer where the inner box is near enough.
 *
 * Accuracy. As in slabs.c, the error of n . x - low for a point x of an edge is a sum over
 * monomials of at most 13 roundings each: 4 in the offset between the reference points of two
 * cuboids, 3 where one is a tetrahedron; 5 in a triple product; 2 for the sum of three normals,
 * which a cuboid does not have; 2 for the way to an edge of a cuboid, or 1 each for the start and
 * the direction of one that is a difference; 1 for the difference with the bound. For each of the
 * vectors w that x and the bound are made of, the sum of the magnitudes of its monomials is W .
 * |w|, where W = (|c_i| |c_j| + |c_j| |c_i|) is the cross product with all signs positive, summed
 * over three normals for the face across from the origin. These w are the offset of the origins;
 * the components of a cuboid, once in the way to its reference point and once in that to the edge
 * and along it; those of a tetrahedron that the edge starts at (in start and direction, so twice)
 * and ends at; and one component of the frame of the face, for the bound, which is the volume of
 * that frame. So the error is at most 13.01 u times their sum, and 14 u leaves room for the
 * rounding of this bound and for a direction made longer by 2^-10 of it, so that no quotient
 * overflows (bound_times). Quotients and what is made of them are rounded a few times within [-1,
 * 1]: 2^-49 covers it. A coordinate is made of the origin, the components and s times one by 8
 * roundings at most: 2^-50 of the sum of the magnitudes.
 *
 * In 2D the products [x y] take the place of the triple ones, with fewer roundings. The errors of
 * the frames themselves are counted in addition (placing_weight()). */
#ifndef FMB_WALK_BOX_H
#define FMB_WALK_BOX_H

#include "rotation.h"
#include "walk.h"

#define BOX_ROUNDING (14 * 0x1p-53)
#define BOX_POINT_ROUNDING 0x1p-50
#define BOX_CUT_ROUNDING 0x1p-49

/* Of the largest coordinate; the limit that fmb.h states is 1e-12. */
#define BOX_LIMIT 0.9e-12

/* Farther away nothing is said, for fear of overflow. */
#define BOX_FARTHEST 0x1p500

/* What a linear function, along the normal of a face or along an axis, is at the reference point of
 * a frame and on its components. */
struct box_function {
    lanes at, component[3];
};

/* A face of the other frame. weight: the sum of the magnitudes of the monomials of function, and of
 * the bounds. */
struct box_face {
    struct box_function function, weight;
    lanes low, high;
};

/* A frame to be cut. Lengths are those of walk_pair. */
struct box_frame {
    int faces;
    struct box_face face[4];     /* of the other frame */
    struct box_function axis[3]; /* places in the world */
    lanes slack[3];              /* of places */
};

struct box_found {
    lanes outer[2][3], inner[2][3]; /* [lower, upper][axis] */
};

/* An edge, seen along a function: start + s direction. */
struct box_line {
    lanes start, direction;
};

/* ---- Faces ---- */

/* Magnitudes of what the offset between reference points is made of. */
INLINE void set_way(const struct walk_pair *pair, const struct walk_kind kind,
                    const lanes origin[2][3], lanes way[3])
{
    UNROLL(3)
    for (int axis = 0; axis < kind.dim; axis++) {
        const lanes apart = lanes_magnitude(origin[1][axis] - origin[0][axis]);
        lanes of[2] = {lanes_of(0), lanes_of(0)};
        UNROLL(2)
        for (int f = 0; f < 2; f++)
            UNROLL(3)
        for (int i = 0; i < kind.dim; i++)
            if (!kind.simplex[f])
                of[f] += lanes_magnitude(pair->component[f][i][axis]);
        way[axis] = (of[0] + of[1]) + (is_doubled(kind) ? apart + apart : apart);
    }
}

INLINE lanes weight_of(const lanes weight[3], const lanes v[3])
{
    return weight[0] * lanes_magnitude(v[0]) + weight[1] * lanes_magnitude(v[1]) +
           weight[2] * lanes_magnitude(v[2]);
}

/* The cross product with all signs positive. */
INLINE void cross_weight(const lanes u[3], const lanes v[3], lanes out[3])
{
    UNROLL(3)
    for (int k = 0; k < 3; k++) {
        const int i = next(k), j = next(i);
        out[k] = lanes_magnitude(u[i] * v[j]) + lanes_magnitude(u[j] * v[i]);
    }
}

INLINE void set_bounds(const struct walk_kind kind, int of, lanes size, struct box_face *face)
{
    const struct walk_extent own = extent_of_one(kind.simplex[of], size);
    face->low = kind.simplex[of] ? own.low : -own.radius;
    face->high = kind.simplex[of] ? own.high : own.radius;
}

INLINE lanes sum_of_three(const struct box_function function[3], int i)
{
    return i < 0 ? (function[0].at + function[1].at) + function[2].at
                 : (function[0].component[i] + function[1].component[i]) + function[2].component[i];
}

/* What frames with errors add to the weights of a slab of scale 1, as slabs_pair.placing does to
 * its error: with t = ROTATION_ERROR, 4 t times all lengths, and the errors. */
INLINE lanes placing_weight(const struct walk_pair *pair)
{
    const lanes placing = (4 * ROTATION_ERROR) * pair->reach + pair->error;
    return lanes_choose(pair->error != 0, placing * (1 / BOX_ROUNDING), lanes_of(0));
}

/* The offset is that of b from a. */
INLINE void set_space_faces(const struct walk_pair *pair, const struct walk_kind kind, int which,
                            const lanes way[3], struct box_frame *out)
{
    const int other = !which;
    const lanes(*c)[3] = pair->component[other];
    struct walk_side side;
    struct box_function function[3], weight[3];
    const lanes placing = placing_weight(pair);
    const lanes *size = pair->size[other];
    lanes own = lanes_of(0);
    set_side(pair, kind, other, &side);
    out->faces = kind.simplex[other] ? 4 : 3;
    UNROLL(3)
    for (int k = 0; k < 3; k++) {
        lanes normal_weight[3];
        cross_weight(c[next(k)], c[next(next(k))], normal_weight);
        if (k == 0)
            own = weight_of(normal_weight, c[0]);
        function[k].at = which ? side.middle[k] : -side.middle[k];
        weight[k].at =
            (weight_of(normal_weight, way) + own) + placing * (size[next(k)] * size[next(next(k))]);
        UNROLL(3)
        for (int i = 0; i < 3; i++) {
            function[k].component[i] = side.other[k][i];
            weight[k].component[i] = weight_of(normal_weight, pair->component[which][i]);
        }
        out->face[k].function = function[k];
        out->face[k].weight = weight[k];
        set_bounds(kind, other, side.volume, &out->face[k]);
    }
    if (!kind.simplex[other])
        return;
    struct box_face *face = &out->face[3];
    face->function.at = sum_of_three(function, -1);
    face->weight.at = sum_of_three(weight, -1);
    UNROLL(3)
    for (int i = 0; i < 3; i++) {
        face->function.component[i] = sum_of_three(function, i);
        face->weight.component[i] = sum_of_three(weight, i);
    }
    set_bounds(kind, other, side.volume, face);
}

INLINE lanes plane_weight(const lanes e[3], const lanes v[3])
{
    return lanes_magnitude(e[0] * v[1]) + lanes_magnitude(e[1] * v[0]);
}

INLINE void set_plane_faces(const struct walk_pair *pair, const struct walk_kind kind, int which,
                            const lanes way[3], struct box_frame *out)
{
    const int other = !which;
    const lanes(*c)[3] = pair->component[other];
    const lanes area = product(c[0], c[1]), own = plane_weight(c[0], c[1]);
    const lanes placing = placing_weight(pair);
    struct walk_plane_edges edges;
    struct box_function weight[2];
    set_plane_edges(pair, kind, other, &edges);
    out->faces = edge_count(kind, other);
    UNROLL(2)
    for (int e = 0; e < 2; e++) {
        weight[e].at = (plane_weight(c[e], way) + own) + placing * pair->size[other][e];
        UNROLL(2)
        for (int i = 0; i < 2; i++)
            weight[e].component[i] = plane_weight(c[e], pair->component[which][i]);
    }
    UNROLL(3)
    for (int e = 0; e < edge_count(kind, other); e++) {
        struct box_face *face = &out->face[e];
        face->function.at = which ? edges.middle[e] : -edges.middle[e];
        face->weight.at = e < 2 ? weight[e].at : weight[0].at + weight[1].at;
        UNROLL(2)
        for (int i = 0; i < 2; i++) {
            face->function.component[i] = edges.other[e][i];
            face->weight.component[i] =
                e < 2 ? weight[e].component[i] : weight[0].component[i] + weight[1].component[i];
        }
        set_bounds(kind, other, e == 0 ? area : -area, face);
    }
}

/* ---- Places ---- */

/* origin: in the world, of the frame as it is. */
INLINE void set_places(const struct walk_pair *pair, const struct walk_kind kind, int which,
                       const lanes origin[3], struct box_frame *out)
{
    UNROLL(3)
    for (int axis = 0; axis < kind.dim; axis++) {
        struct box_function *function = &out->axis[axis];
        const lanes at = is_doubled(kind) ? origin[axis] + origin[axis] : origin[axis];
        lanes sum = lanes_of(0);
        UNROLL(3)
        for (int i = 0; i < kind.dim; i++) {
            function->component[i] = pair->component[which][i][axis];
            sum += lanes_magnitude(function->component[i]);
        }
        function->at = kind.simplex[which] ? at : at + shift_of(kind, pair->component[which], axis);
        out->slack[axis] = BOX_POINT_ROUNDING * (lanes_magnitude(at) + (sum + sum)) + pair->error;
    }
}

/* ---- Edges ---- */

/* What the faces leave of an edge. */
struct box_part {
    lanes outer[2], inner[2];
};

/* inverse: of face . direction, made a little longer; slack: error in s. */
struct box_cut {
    lanes inverse, slack;
};

INLINE struct box_cut cut_of(lanes direction, lanes weight)
{
    const lanes error = BOX_ROUNDING * weight;
    struct box_cut cut;
    cut.inverse = 1 / (direction + lanes_with_sign(0x1p-10 * error, direction));
    cut.slack = error * lanes_magnitude(cut.inverse) + BOX_CUT_ROUNDING;
    return cut;
}

INLINE void cut_edge(const struct box_face *face, struct box_cut cut, lanes start,
                     struct box_part *part)
{
    const lanes one = (face->low - start) * cut.inverse;
    const lanes other = (face->high - start) * cut.inverse;
    const lanes enter = lanes_least(one, other), leave = lanes_greatest(one, other);
    part->outer[0] = lanes_greatest(enter - cut.slack, part->outer[0]);
    part->outer[1] = lanes_least(leave + cut.slack, part->outer[1]);
    part->inner[0] = lanes_greatest(enter + cut.slack, part->inner[0]);
    part->inner[1] = lanes_least(leave - cut.slack, part->inner[1]);
}

/* Widens a box by a part, along an axis; nothing where there is none. */
INLINE void widen(const lanes part[2], struct box_line line, lanes slack, int axis, lanes box[2][3])
{
    const lanes_mask empty = part[0] > part[1];
    const lanes x = part[0] * line.direction, y = part[1] * line.direction;
    const lanes low = line.start + (lanes_least(x, y) + slack);
    const lanes high = line.start + (lanes_greatest(x, y) - slack);
    box[0][axis] = lanes_least(lanes_choose(empty, lanes_of(INFINITY), low), box[0][axis]);
    box[1][axis] = lanes_greatest(lanes_choose(empty, lanes_of(-INFINITY), high), box[1][axis]);
}

INLINE void widen_both(const struct walk_kind kind, const struct box_part *part,
                       const struct box_line line[3], const lanes slack[3], struct box_found *found)
{
    UNROLL(3)
    for (int axis = 0; axis < kind.dim; axis++) {
        widen(part->outer, line[axis], -slack[axis], axis, found->outer);
        widen(part->inner, line[axis], slack[axis], axis, found->inner);
    }
}

/* The four (2D: two) edges of direction i of a cuboid, each with the signs of the others. */
INLINE lanes cuboid_start(const struct walk_kind kind, const struct box_function *function, int i,
                          int signs)
{
    const int j = kind.dim == 2 ? !i : next(i), k = next(next(i));
    const lanes at =
        signs & 1 ? function->at + function->component[j] : function->at - function->component[j];
    if (kind.dim == 2)
        return at;
    return signs & 2 ? at + function->component[k] : at - function->component[k];
}

/* Of all edges alike. */
INLINE lanes cuboid_weight(const struct walk_kind kind, const struct box_function *weight)
{
    const lanes sum = weight->component[0] + weight->component[1];
    return weight->at + (kind.dim == 2 ? sum : sum + weight->component[2]);
}

INLINE void add_cuboid_edges(const struct walk_kind kind, const struct box_frame *frame, int i,
                             struct box_found *found)
{
    const int edges = kind.dim == 2 ? 2 : 4;
    struct box_cut cut[4];
    UNROLL(4)
    for (int k = 0; k < frame->faces; k++)
        cut[k] = cut_of(frame->face[k].function.component[i],
                        cuboid_weight(kind, &frame->face[k].weight));
    UNROLL(4)
    for (int signs = 0; signs < edges; signs++) {
        struct box_part part = {{lanes_of(-1), lanes_of(1)}, {lanes_of(-1), lanes_of(1)}};
        struct box_line line[3];
        UNROLL(4)
        for (int k = 0; k < frame->faces; k++)
            cut_edge(&frame->face[k], cut[k],
                     cuboid_start(kind, &frame->face[k].function, i, signs), &part);
        UNROLL(3)
        for (int axis = 0; axis < kind.dim; axis++)
            line[axis] = (struct box_line){cuboid_start(kind, &frame->axis[axis], i, signs),
                                           frame->axis[axis].component[i]};
        widen_both(kind, &part, line, frame->slack, found);
    }
}

/* Edge e: of a component from the origin, or from the end of one to that of another. */
INLINE struct box_line simplex_line(const struct walk_kind kind,
                                    const struct box_function *function, int e)
{
    if (e < kind.dim)
        return (struct box_line){function->at, function->component[e]};
    const int p = kind.dim == 2 ? 0 : next(e - 3), q = kind.dim == 2 ? 1 : next(p);
    return (struct box_line){function->at + function->component[p],
                             function->component[q] - function->component[p]};
}

INLINE lanes simplex_weight(const struct walk_kind kind, const struct box_function *weight, int e)
{
    if (e < kind.dim)
        return weight->at + weight->component[e];
    const int p = kind.dim == 2 ? 0 : next(e - 3), q = kind.dim == 2 ? 1 : next(p);
    return weight->at + ((weight->component[p] + weight->component[p]) + weight->component[q]);
}

INLINE void add_simplex_edge(const struct walk_kind kind, const struct box_frame *frame, int e,
                             struct box_found *found)
{
    struct box_part part = {{lanes_of(0), lanes_of(1)}, {lanes_of(0), lanes_of(1)}};
    struct box_line line[3];
    UNROLL(4)
    for (int k = 0; k < frame->faces; k++) {
        const struct box_face *face = &frame->face[k];
        const struct box_line along = simplex_line(kind, &face->function, e);
        cut_edge(face, cut_of(along.direction, simplex_weight(kind, &face->weight, e)), along.start,
                 &part);
    }
    UNROLL(3)
    for (int axis = 0; axis < kind.dim; axis++)
        line[axis] = simplex_line(kind, &frame->axis[axis], e);
    widen_both(kind, &part, line, frame->slack, found);
}

/* ---- Extents ----
 *
 * The intersection lies in the extents of both frames. Where these are ends of it (boxes along the
 * axes, a frame within the other) they are as near as doubles go: a sum is rounded outward, if it
 * rounds. The error of a sum is a double (Knuth, The Art of Computer Programming, volume 2, 4.2.2,
 * theorem B), and 2^-52 of a normal number is between one and two units in its last place; sums
 * that are not normal are exact. */

INLINE lanes sum_error(lanes x, lanes y, lanes sum)
{
    const lanes part = sum - x;
    return (x - (sum - part)) + (y - part);
}

INLINE lanes sum_below(lanes x, lanes y)
{
    const lanes sum = x + y;
    return lanes_choose(sum_error(x, y, sum) < 0, sum - 0x1p-52 * lanes_magnitude(sum), sum);
}

INLINE lanes sum_above(lanes x, lanes y)
{
    const lanes sum = x + y;
    return lanes_choose(sum_error(x, y, sum) > 0, sum + 0x1p-52 * lanes_magnitude(sum), sum);
}

/* Cuts the box, in the lengths of the world. */
INLINE void cut_to_extent(const struct walk_pair *pair, const struct walk_kind kind, int which,
                          const lanes origin[3], int axis, lanes box[2][3])
{
    const bool twice = is_doubled(kind) && kind.simplex[which];
    lanes low = origin[axis], high = origin[axis];
    UNROLL(3)
    for (int i = 0; i < kind.dim; i++) {
        const lanes c = (twice ? 0.5 : 1.0) * pair->component[which][i][axis];
        if (kind.simplex[which]) {
            low = lanes_least(sum_below(origin[axis], c), low);
            high = lanes_greatest(sum_above(origin[axis], c), high);
        } else {
            low = sum_below(low, lanes_least(c, lanes_of(0)));
            high = sum_above(high, lanes_greatest(c, lanes_of(0)));
        }
    }
    const lanes error = (is_doubled(kind) ? 0.5 : 1.0) * pair->error;
    box[0][axis] = lanes_greatest(sum_below(low, -error), box[0][axis]);
    box[1][axis] = lanes_least(sum_above(high, error), box[1][axis]);
}

/* ---- All of it ---- */

/* Of a vertex along an axis, in the lengths of walk_pair: the largest magnitude, or a little less.
 */
INLINE lanes largest_place(const struct walk_kind kind, int which, const struct box_frame *frame)
{
    lanes largest = lanes_of(0);
    UNROLL(3)
    for (int axis = 0; axis < kind.dim; axis++) {
        const struct box_function *function = &frame->axis[axis];
        lanes farthest = lanes_magnitude(function->at);
        UNROLL(3)
        for (int i = 0; i < kind.dim; i++)
            farthest = kind.simplex[which]
                           ? lanes_greatest(lanes_magnitude(function->at + function->component[i]),
                                            farthest)
                           : farthest + lanes_magnitude(function->component[i]);
        largest = lanes_greatest(farthest, largest);
    }
    return (1 - 0x1p-40) * largest;
}

INLINE void begin_box(const struct walk_kind kind, struct box_found *found)
{
    UNROLL(3)
    for (int axis = 0; axis < kind.dim; axis++) {
        found->outer[0][axis] = found->inner[0][axis] = lanes_of(INFINITY);
        found->outer[1][axis] = found->inner[1][axis] = lanes_of(-INFINITY);
    }
}

INLINE void add_edges_of(const struct walk_kind kind, int which, const struct box_frame *frame,
                         struct box_found *found)
{
    UNROLL(6)
    for (int e = 0; e < edge_count(kind, which); e++) {
        if (kind.simplex[which])
            add_simplex_edge(kind, frame, e, found);
        else
            add_cuboid_edges(kind, frame, e, found);
    }
}

/* Boxes and which of them are good. On input: the pair at rest; the origins of its frames. */
INLINE lanes_mask walk_box(const struct walk_pair *pair, const struct walk_kind kind,
                           const lanes origin[2][3], lanes box[2][3])
{
    struct box_found found;
    lanes way[3], largest = lanes_of(0);
    begin_box(kind, &found);
    set_way(pair, kind, origin, way);
    UNROLL(2)
    for (int which = 0; which < 2; which++) {
        struct box_frame frame;
        if (kind.dim == 3)
            set_space_faces(pair, kind, which, way, &frame);
        else
            set_plane_faces(pair, kind, which, way, &frame);
        set_places(pair, kind, which, origin[which], &frame);
        largest = lanes_greatest(largest_place(kind, which, &frame), largest);
        add_edges_of(kind, which, &frame, &found);
    }
    lanes_mask good = pair->in_range & (largest <= BOX_FARTHEST);
    UNROLL(3)
    for (int axis = 0; axis < kind.dim; axis++) {
        good &= (found.inner[0][axis] - found.outer[0][axis] <= BOX_LIMIT * largest) &
                (found.outer[1][axis] - found.inner[1][axis] <= BOX_LIMIT * largest);
        UNROLL(2)
        for (int end = 0; end < 2; end++)
            box[end][axis] = (is_doubled(kind) ? 0.5 : 1.0) * found.outer[end][axis];
        UNROLL(2)
        for (int which = 0; which < 2; which++)
            cut_to_extent(pair, kind, which, origin[which], axis, box);
        UNROLL(2)
        for (int end = 0; end < 2; end++)
            box[end][axis] += 0.0; /* never -0 */
    }
    return good;
}

#endif
