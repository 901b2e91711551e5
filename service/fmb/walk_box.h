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
 * monomials of at most 14 roundings each; there are 4 for the offset between the reference points,
 * 5 for a triple product, 2 for the sum of three normals, 2 for the way from the reference point to
 * the start of the edge, 1 for the difference with the bound. The sum of the magnitudes of the
 * monomials is at most W . X, where W = (|c_i| |c_j| + |c_j| |c_i|) is the cross product with all
 * signs positive, summed over three normals for the face across from the origin, and X the sum,
 * axis by axis, of the magnitudes of the offset of the origins and twice all components (of a
 * cuboid once in the way to its reference point, once in that to a point of the edge; of a
 * tetrahedron in the start of an edge and in its direction). So the error is at most 14.01 u W . X,
 * and 16 u W . X leaves room for the rounding of this bound and for a direction made longer by
 * 2^-10 of it, so that no quotient overflows (slabs.c has the same). Quotients and what is made of
 * them are rounded a few times within [-1, 1]: 2^-49 covers it. A coordinate is made of the origin,
 * the components and s times one by 8 roundings at most: 2^-50 of the sum of the magnitudes.
 *
 * In 2D the products [x y] take the place of the triple ones, with fewer roundings. */
#ifndef FMB_WALK_BOX_H
#define FMB_WALK_BOX_H

#include "walk.h"

#define BOX_ROUNDING 0x1p-49
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

/* A face of the other frame. */
struct box_face {
    struct box_function function;
    lanes low, high, error;
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

INLINE lanes dot_magnitudes(const lanes u[3], const lanes v[3])
{
    return lanes_magnitude(u[0]) * v[0] + lanes_magnitude(u[1]) * v[1] +
           lanes_magnitude(u[2]) * v[2];
}

/* W . X for the face with c_i and c_j. */
INLINE lanes face_weight(const lanes u[3], const lanes v[3], const lanes sum[3])
{
    lanes weight[3];
    UNROLL(3)
    for (int k = 0; k < 3; k++) {
        const int i = next(k), j = next(i);
        weight[k] = lanes_magnitude(u[i] * v[j]) + lanes_magnitude(u[j] * v[i]);
    }
    return dot(weight, sum);
}

INLINE void set_bounds(const struct walk_kind kind, int of, lanes size, lanes weight,
                       struct box_face *face)
{
    const struct walk_extent own = extent_of_one(kind.tetrahedron[of], size);
    face->low = kind.tetrahedron[of] ? own.low : -own.radius;
    face->high = kind.tetrahedron[of] ? own.high : own.radius;
    face->error = BOX_ROUNDING * weight;
}

/* The offset is that of b from a. */
INLINE void set_space_faces(const struct walk_pair *pair, const struct walk_kind kind, int which,
                            const lanes sum[3], struct box_frame *out)
{
    const int other = !which;
    struct walk_side side;
    lanes weight[3];
    set_side(pair, kind, other, &side);
    out->faces = kind.tetrahedron[other] ? 4 : 3;
    UNROLL(3)
    for (int k = 0; k < 3; k++) {
        struct box_face *face = &out->face[k];
        face->function.at = which ? side.middle[k] : -side.middle[k];
        UNROLL(3)
        for (int i = 0; i < 3; i++)
            face->function.component[i] = side.other[k][i];
        weight[k] = face_weight(pair->component[other][next(k)],
                                pair->component[other][next(next(k))], sum);
        set_bounds(kind, other, side.volume, weight[k], face);
    }
    if (!kind.tetrahedron[other])
        return;
    struct box_face *face = &out->face[3];
    const struct box_face *first = out->face;
    face->function.at = (first[0].function.at + first[1].function.at) + first[2].function.at;
    UNROLL(3)
    for (int i = 0; i < 3; i++)
        face->function.component[i] =
            (first[0].function.component[i] + first[1].function.component[i]) +
            first[2].function.component[i];
    set_bounds(kind, other, side.volume, (weight[0] + weight[1]) + weight[2], face);
}

INLINE void set_plane_faces(const struct walk_pair *pair, const struct walk_kind kind, int which,
                            const lanes sum[3], struct box_frame *out)
{
    const int other = !which;
    const lanes area = product(pair->component[other][0], pair->component[other][1]);
    struct walk_plane_edges edges;
    lanes weight[2];
    set_plane_edges(pair, kind, other, &edges);
    out->faces = edge_count(kind, other);
    UNROLL(3)
    for (int e = 0; e < edge_count(kind, other); e++) {
        struct box_face *face = &out->face[e];
        face->function.at = which ? edges.middle[e] : -edges.middle[e];
        face->function.component[0] = edges.other[e][0];
        face->function.component[1] = edges.other[e][1];
        if (e < 2) {
            const lanes *c = pair->component[other][e];
            weight[e] = lanes_magnitude(c[0]) * sum[1] + lanes_magnitude(c[1]) * sum[0];
        }
        set_bounds(kind, other, e == 0 ? area : -area, e < 2 ? weight[e] : weight[0] + weight[1],
                   face);
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
        function->at =
            kind.tetrahedron[which] ? at : at + shift_of(kind, pair->component[which], axis);
        out->slack[axis] = BOX_POINT_ROUNDING * (lanes_magnitude(at) + (sum + sum));
    }
}

/* ---- Edges ---- */

/* What the faces leave of an edge. */
struct box_part {
    lanes outer[2], inner[2];
};

/* inverse: of face . direction, made a little longer; error in s. */
struct box_cut {
    lanes inverse, slack;
};

INLINE struct box_cut cut_of(lanes direction, lanes error)
{
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

INLINE void add_cuboid_edges(const struct walk_kind kind, const struct box_frame *frame, int i,
                             struct box_found *found)
{
    const int edges = kind.dim == 2 ? 2 : 4;
    struct box_cut cut[4];
    UNROLL(4)
    for (int k = 0; k < frame->faces; k++)
        cut[k] = cut_of(frame->face[k].function.component[i], frame->face[k].error);
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

INLINE void add_simplex_edge(const struct walk_kind kind, const struct box_frame *frame, int e,
                             struct box_found *found)
{
    struct box_part part = {{lanes_of(0), lanes_of(1)}, {lanes_of(0), lanes_of(1)}};
    struct box_line line[3];
    UNROLL(4)
    for (int k = 0; k < frame->faces; k++) {
        const struct box_face *face = &frame->face[k];
        const struct box_line along = simplex_line(kind, &face->function, e);
        cut_edge(face, cut_of(along.direction, face->error), along.start, &part);
    }
    UNROLL(3)
    for (int axis = 0; axis < kind.dim; axis++)
        line[axis] = simplex_line(kind, &frame->axis[axis], e);
    widen_both(kind, &part, line, frame->slack, found);
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
            farthest = kind.tetrahedron[which]
                           ? lanes_greatest(lanes_magnitude(function->at + function->component[i]),
                                            farthest)
                           : farthest + lanes_magnitude(function->component[i]);
        largest = lanes_greatest(farthest, largest);
    }
    return (1 - 0x1p-40) * largest;
}

/* X, and boxes of nothing. */
INLINE void begin_box(const struct walk_pair *pair, const struct walk_kind kind,
                      const lanes origin[2][3], lanes sum[3], struct box_found *found)
{
    UNROLL(3)
    for (int axis = 0; axis < kind.dim; axis++) {
        const lanes apart = lanes_magnitude(origin[1][axis] - origin[0][axis]);
        lanes of[2] = {lanes_of(0), lanes_of(0)};
        UNROLL(2)
        for (int f = 0; f < 2; f++)
            UNROLL(3)
        for (int i = 0; i < kind.dim; i++)
            of[f] += lanes_magnitude(pair->component[f][i][axis]);
        const lanes both = of[0] + of[1];
        sum[axis] = (both + both) + (is_doubled(kind) ? apart + apart : apart);
        found->outer[0][axis] = found->inner[0][axis] = lanes_of(INFINITY);
        found->outer[1][axis] = found->inner[1][axis] = lanes_of(-INFINITY);
    }
}

INLINE void add_edges_of(const struct walk_kind kind, int which, const struct box_frame *frame,
                         struct box_found *found)
{
    UNROLL(6)
    for (int e = 0; e < edge_count(kind, which); e++) {
        if (kind.tetrahedron[which])
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
    lanes sum[3], largest = lanes_of(0);
    begin_box(pair, kind, origin, sum, &found);
    UNROLL(2)
    for (int which = 0; which < 2; which++) {
        struct box_frame frame;
        if (kind.dim == 3)
            set_space_faces(pair, kind, which, sum, &frame);
        else
            set_plane_faces(pair, kind, which, sum, &frame);
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
            box[end][axis] = (is_doubled(kind) ? 0.5 : 1.0) * found.outer[end][axis] + 0.0;
    }
    return good;
}

#endif
