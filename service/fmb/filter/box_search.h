/* The box of the intersection of a pair in contact, at rest or moving, of LANES pairs at once.
 *
 * In: struct pair_lanes; struct box_places, which has the numbers of the frames as prepared, and
 * the duration.
 *
 * Out: the box in world coordinates, [lower, upper][axis], and the lanes in which it is good: it
 * contains the exact box, and each end is within the limit of fmb.h.
 *
 * Steps (search_box()):
 *   1. begin_box(), which comes before: frames about the middle of the window, slack, how far apart
 *      ends may be; begin_search(): errors, tolerance
 *   2. set_extents(): the vertices y = 0 and y = e_k, the extents of the frames
 *   3. add_plane_normals() in 2D, or add_space_normals() in 3D: vertices on the normals of the
 *      faces; each line in add_normal_line(), each vertex in add_edge_vertex() or
 *      add_drift_vertex()
 *   4. add_crossings(): vertices of an edge of A, one of B, and the drift
 *   5. find_ends(): ends from the least bounds; put_box(): cut_to_extent() cuts the box to both
 *      frames
 *   6. are_near(): whether inner ends are as near as the limit
 *   7. all of it once more (box_refine.h) where they are not, or a vertex that is not certain was
 *      left out
 *
 * The method, and the proof of both ends, follow. Frames are seen about the middle of the
 * window, displaced by -travel to travel; u = 2^-53.
 *
 * THE METHOD
 *
 * 1. Every y bounds coordinate k of the intersection. With h_A(y) = max { y . a : a in A }, the
 *    support function, and H = travel_B - travel_A,
 *
 *    x_k = y . x + (e_k - y) . x
 *            <= c(y) = h_A(y) + h_B(e_k - y) + |travel_B[k] - y . H|,
 *
 *    since x is a point of A and of B at the same time. With -y the same bounds hold for -x_k.
 * 2. Where the frames meet, the least of these bounds is the end of the box: duality of linear
 *    programs. It is the article's elimination of all coordinates but one, and of the time, done
 *    on paper.
 * 3. c is convex, and linear between the walls
 *
 *    y . a = 0                  for the edges a of A
 *
 *    (e_k - y) . b = 0          for the edges b of B
 *
 *    travel_B[k] - y . H = 0    where the pair drifts.
 *
 *    If the normals of the walls span the space, c is least at a vertex: a point in which three
 *    walls with independent normals meet (in 2D two). Two walls of A meet in the line of a
 *    normal of A, three in 0; the same holds for B. So the vertices are
 *
 *    y = 0, y = e_k    c is the end of the extent of B, of A
 *
 *    y = l n           n a normal of A, on a wall of B: l = b[k] / (n . b), or that of the drift
 *
 *    e_k - y = l n     n a normal of B, on a wall of A or that of the drift
 *
 *    y = (b[k] (H x a) + travel_B[k] (a x b)) / [a b H]
 *
 *    The last is a crossing: on a wall of A, one of B and that of the drift.
 *
 *    Which of them are corners of the polytope in space and time does not matter, by 1.
 * 4. Along a normal of a simplex with a volume, h bends at the outward one only: opposite to it
 *    the maximum is at one corner. So l n, n outward, is a vertex for the upper end if l > 0,
 *    and for the lower end if l < 0 (set_candidate()). All that follows holds for the half line
 *    l >= 0, which ends in y = 0 or e_k. A volume that may be 0 has no outward side: the pair is
 *    left to the exact method (turn_outward()).
 *
 * OUTER ENDS
 *
 * c is computed for the l at hand, or for the two factors of a crossing, and so is a bound by 1,
 * except for these errors. Those of 1 to 3 are multiplied with |l| (value_error()); they are
 * part of own in struct box_line.
 *
 * 1. Products with n. Let W be n with the magnitudes of its monomials. A monomial of a triple
 *    product is rounded 5 times, twice more in a sum of three normals. The wall of the vertex is
 *    left out of c; its term is at most what its determinant is off by, times l: 8 u more for a
 *    difference of two edges, which is rounded once more. Together at most 17 u (8 u without a
 *    simplex) times W . (the magnitudes of the vectors at hand).
 * 2. The offset is rounded 4 times before: 5 u times |n| . (the magnitudes of what it is made
 *    of).
 * 3. The products, at most slope together, are rounded 8 times on their way into c: 9 u.
 * 4. Coordinates that are not multiplied with l belong to the frame from whose centre c is seen.
 *    None is rounded more than 8 times (its travel, and components at a crossing): 9 u times the
 *    sum of their magnitudes, the slack.
 * 5. The errors of the frames, e together, widen h by at most |y| e and |e_k - y| e. |y| is at
 *    most |l| S for the scale S of n. At a crossing m (H x a) and n (a x b) take the place of l
 *    n, one after the other.
 *
 * Where nothing rounds (slabs_exact.h), 1 and 2 are 0: determinants and all products with n are
 * exact, and only l is rounded, twice. What is left of the wall then is at most 3 u of its
 * product with n, times l, within the 9 u that 3 counts for that product.
 *
 * INNER ENDS
 *
 * The true end is the true c at some true vertex. At each true vertex c is at least the value at
 * hand less the errors of 1 to 4.
 *
 * 1. The determinant d of a vertex (n . b, n . H, [a b H]) is off by at most 8 u W . |b|, or 10
 *    u where a frame is a simplex (5 roundings, 2 of the drift, 1 of each difference, or 2 of
 *    the sum of three normals); and by 3.1 t times its scale, the product of the lengths, for
 *    components that are off by t. If d is more than 16 times its error, the vertex is certain.
 *    The true l is then l / (1 + r), |r| at most 1.1 times the relative error of d and 5 u.
 * 2. Let f - l d be the terms of c (f coordinates, d products with n). Those of the true vertex
 *    are V = (f - l d + r f) / (1 + r). The sum of the |f| is at most R, the extent of the frame
 *    from its centre. If V > R the bound is no less than that of y = 0 or y = e_k. Else |V| <=
 *    R, since the pair is in contact and the bound that of a point of the frame. The value at
 *    hand is V (1 + r) - r f, off by at most |r| (R + |V|); or, from the value at hand, by 1.1
 *    |r| (R + its magnitude). The lesser of these counts (add_candidate()).
 * 3. Coordinates of the wall's edge that are off by t |b| move l by 1.1 t |b| / |d|, and c by
 *    the slope times as much.
 * 4. n is off by at most (2 t + t^2) S, which moves c by as much times all lengths at hand. At
 *    the true vertex this is multiplied with l / (1 + r), which is at most 1.07 l: 2.2 t times
 *    these lengths, times |l| S. The same holds for e, of which |l| S e counts already, so that a
 *    tenth of e remains (frame_error). Likewise 1.1 e stands in the slack.
 *
 * Frames that are in contact as prepared (in_contact): frame_error seldom counts. Let E be the
 * end of the box of these frames, so that c(y) >= E for all y.
 *
 * 5. The numbers of these frames are exact, so that 1 and 2 with t = 0 bound E: E >= (the value at
 *    hand) - w_j for some vertex j, where w is twice the error of rounding, |l| S e, and what r
 *    makes of it.
 * 6. Let y be the true vertex i that gives the true end. The support functions of the true frames
 *    differ from those of the prepared ones by at most |y| e and |e_k - y| e, and c(y) >= E for
 *    every y, whether a vertex of these frames or not. So the true end is at least E less 1.1
 *    |l_i| S e and 1.1 e. The latter is part of the slack.
 * 7. Let W be the largest w + |l| S e of all vertices within the tolerance. Twice |l| S e is part
 *    of it. If i and j are within the tolerance, the true end is at least the value at hand less W
 *    + 1.1 W / 2 = 1.55 W. The tolerance for W is 0.64 of the whole, and 0.64 * 1.55 < 1. If only
 *    j is beyond it, 1 to 4 bound E, and 0.55 * 0.64 < 0.36 remains for i (shared). If i is beyond
 *    it, 1 to 4 bound the true end. The changes by bends (8) count twice: at j for E, at i for the
 *    true end. Along a single axis |l| is that of this axis, to which the error of b[k] adds up to
 *    1.1 t |b| / |d| (rounded in struct box_candidate).
 *
 * Vertices that are not certain:
 *
 * 8. Such a vertex v may be left out if c surely grows along a line through it, the line of the
 *    other two walls: N = n, a x b, H x a or H x b. The slope of c at both ends of the line is
 *    -gap(N), the gap of the slab of N. Take a point of the line as its base, and in place of the
 *    term of each wall that is not certain there the linear function that it is at the base. The
 *    result, c', is c at the base, and nowhere more. At the distance y from the base it is less by
 *    at most 2 |d y| / |N|, with the determinant d of the wall. Where gap(N) is below minus twice
 *    the sum of the |d|, c' grows at both ends, and is least at a vertex that is certain, or at 0.
 *    So c(v) is at least the least c' of these.
 *
 *    On the line of a normal, in 3D, the base is 0 (or e_k, for one of B): y = l n, and the
 *    changes 2 |d l| are added up, with d at most the value at hand and its error
 *    (open_of_line()).
 *
 *    On other lines, and in 2D, the base is the point of the line that is nearest to 0. So the
 *    distance is at most |y|, at most S |l| for what is seen from A, and S |l| + 1 from B, since
 *    e_k - y is what is seen there. Now |d| is at most 17 times its error, 17 (18 u + 4 t) of the
 *    product of its lengths, S of N one of them. The lengths of all walls that a line crosses have
 *    a sum of at most 2 T; of two cuboids T / 2, since their components are half of what T has of
 *    them. So all bends change c by at most 4 T 17 (18 u + 4 t) (S / |N|) (S |l| + 1): bend_error
 *    (S |l| + 1). The line with the least S / |N| is the one that is looked at; the largest of
 *    these counts (stretch). bend_error itself is taken from all ends, the extents among them, and
 *    bend_error S |l| is part of the widths (bends in struct box_search).
 *
 *    Of two cuboids every d is the determinant of some vertex, since any two edges of a frame have
 *    a normal: the largest that a first pass meets takes the place of 17 (18 u + 4 t) in the
 *    second.
 * 9. A determinant that is exactly 0, each of its monomials having a factor 0, is no vertex at
 *    all. One vertex that is certain makes the normals span the space.
 * 10. If coordinate k is 0 for all edges of A whose walls a vertex is on, and for travel_A if it
 *    is on that of the drift, then the vertex is y = e_k: it is on these walls, and the only one.
 *    If that holds for B, it is y = 0. The extents have its c, so that it needs no inner end,
 *    whatever the error of its determinant. The second pass looks for such vertices. One thing
 *    they do not have: what 8 takes from c on the line of a normal of A that is open, of which e_k
 *    is a point other than the base; for B, 0. There such a vertex keeps its inner end.
 *
 * Widths, the sums of these errors, are bounded once for all axes. Within the tolerance they are
 * allowed for at the end; few vertices need them one by one. NAN bounds nothing, and stands for
 * what is not certain. Underflow: as in slabs.c; some component is at least 2^-200, and 2^-49 of
 * it far above all that is lost. */
#ifndef FMB_BOX_SEARCH_H
#define FMB_BOX_SEARCH_H

#include "rotation.h"
#include "slabs_evaluate.h"
#include "slabs_exact.h"

/* u; tests plant a smaller one. */
#ifndef BOX_UNIT
#define BOX_UNIT 0x1p-53
#endif

/* Of the largest coordinate; the limit that fmb.h states is 1e-12. */
#define BOX_LIMIT 0.9e-12

/* Farther away nothing is said, for fear of overflow. */
#define BOX_FARTHEST 0x1p500

/* Roundings of a monomial of a triple product, those of the wall that is left out included. */
INLINE double product_rounding(const struct kernel_traits traits)
{
    return (traits.simplex[0] || traits.simplex[1] ? 17 : 8) * BOX_UNIT;
}

INLINE double determinant_rounding(const struct kernel_traits traits)
{
    return (traits.simplex[0] || traits.simplex[1] ? 10 : 8) * BOX_UNIT;
}

/* What the boxes need of the frames besides struct pair_lanes: as they stand in prepared frames. */
struct box_places {
    lanes_bits summary[2];
    lanes origin[2][3], velocity[2][3]; /* velocities are read where the kind drifts */
    lanes error[2];
    lanes_mask exact; /* nothing rounds (slabs_exact.h) */
    double duration;
    bool in_contact; /* as prepared; else the true frames are, which are off by the errors */
};

/* A frame; lengths are those of pair_lanes. Edges by number (slabs.h). */
struct box_frame {
    lanes edge[6][3];
    lanes length[6][3];            /* magnitudes of the components that an edge is made of */
    lanes_bits summary;            /* prepared.h */
    lanes centre[3];               /* of the reference point, in the middle of the window */
    lanes travel[3];               /* half of the displacement */
    lanes sum[3];                  /* of the magnitudes of all that a coordinate is made of */
    lanes own_sum[3];              /* of those of the components and travel */
    lanes own_sum_max, travel_max; /* the largest of own_sum, of the magnitudes of travel */
};

/* A normal n of a frame, and what it makes of the pair. */
struct box_normal {
    lanes scale;                   /* S */
    lanes magnitude[3], weight[3]; /* of n, and of its monomials */
    lanes own;    /* n . c of the component that is not across n, or of all of them */
    lanes at[6];  /* n . edges of the other frame */
    lanes middle; /* n . (reference point of the other frame - that of this one) */
    lanes swing;  /* n . (travel of the other frame - that of this one) */
};

/* The determinant of a vertex. */
struct box_vertex {
    lanes inverse;        /* NAN where it may be 0 */
    lanes_mask uncertain; /* it may be 0 */
    lanes bend;           /* no less than its magnitude there, else 0 */
};

/* What c gives at a vertex: how far the intersection reaches from the centre of a frame at most,
 * and how much less it may be that c gives at the true vertex. */
struct box_candidate {
    lanes at[2][3]; /* [below, above][axis] */
    /* relative: to at, no more than own_sum of the frame. rounded: of frames in contact, w and what
     * relative is for them. */
    lanes width[3], relative, rounded[3], relative_rounded;
};

/* The least of these. inner: less the width, where that is beyond the tolerance. */
struct box_bounds {
    lanes outer[2][3], inner[2][3];
};

/* What the first pass leaves out. */
struct box_left_out {
    lanes_mask open; /* a vertex whose line has vertices of other lines */
    lanes bend;      /* the largest |d| of vertices that are not certain, for scale 1 */
    lanes stretch;   /* no less than S / |N| of the lines that are looked at for these, and 1 */
};

struct box_search {
    struct box_frame frame[2];
    lanes_mask drift[3];  /* where the drift may not be 0 */
    lanes_mask exact;     /* no triple product rounds */
    lanes unit;           /* of the small numbers that ends are made of; 0: they are not */
    lanes relative_error; /* t */
    lanes frame_error;    /* 2.2 t times all lengths, and e / 10 */
    lanes bend;           /* the largest |d| of vertices that are not certain, for scale 1 */
    lanes bend_limit;     /* 17 (18 u + 4 t) */
    lanes stretch;        /* as in struct box_left_out */
    lanes bend_error;     /* what bends change c by for |y| = 1, and for S |l| = 1 */
    lanes bend_count;     /* 2, or 4 where they count twice */
    lanes size[3],
        offset_sum[3]; /* magnitudes: of all vectors at hand; of what the offset is made of */
    lanes slack[2][3]; /* of what is seen from the centre of each frame */
    lanes determinant; /* error of a determinant of scale 1 */
    lanes rounding;    /* the part of it that w has: in_contact without t */
    lanes largest;     /* coordinate, or a little less */
    lanes whole;       /* what ends may be apart, without the slack on both sides */
    lanes tolerance;   /* the part of it for the width of a bound */
    lanes shared;      /* the part of the tolerance for the errors of frames in contact */
    bool in_contact;
    struct box_bounds bounds[2]; /* about the centre of each frame */
    lanes_mask usable;           /* a box can be found */
    lanes_mask spans, good;
    lanes_mask open;             /* a vertex is left out whose line has vertices of other lines */
    lanes_mask left_out;         /* where errors are to allow for that */
    lanes bends;                 /* bend_error there, else 0 */
    bool careful;                /* the second pass */
    lanes_mask nonzero[2][6][3]; /* there: coordinates of edges that may not be 0 */
};

/* ---- Masks ---- */

INLINE lanes_mask is_not(lanes_mask mask)
{
    return mask == 0;
}

/* Whether a monomial of u x v, of u . v, may not be 0. */
INLINE void cross_nonzero(const lanes_mask u[3], const lanes_mask v[3], lanes_mask out[3])
{
    out[0] = (u[1] & v[2]) | (u[2] & v[1]);
    out[1] = (u[2] & v[0]) | (u[0] & v[2]);
    out[2] = (u[0] & v[1]) | (u[1] & v[0]);
}

INLINE lanes_mask dot_nonzero(const struct kernel_traits traits, const lanes_mask u[3],
                              const lanes_mask v[3])
{
    const lanes_mask plane = (u[0] & v[0]) | (u[1] & v[1]);
    return traits.dim == 2 ? plane : plane | (u[2] & v[2]);
}

/* ---- Frames ---- */

/* The components from whose ends an edge that is a difference goes, and to which. */
INLINE int edge_from(const struct kernel_traits traits, int e)
{
    return traits.dim == 2 ? 0 : next(e % 3);
}

INLINE int edge_to(const struct kernel_traits traits, int e)
{
    return traits.dim == 2 ? 1 : next(next(e % 3));
}

INLINE bool has_edge(const struct kernel_traits traits, int which, int e)
{
    return e < 3 ? e < component_count(traits, which) : has_difference(traits, which, e - 3);
}

INLINE lanes_mask has_bit(lanes_bits summary, unsigned bit)
{
    return (summary & (UINT64_C(1) << 3 * PREPARED_SIZE_BITS) * bit) != 0;
}

/* The sum of the magnitudes of the components along an axis. */
INLINE lanes magnitudes_along(const struct pair_lanes *pair, const struct kernel_traits traits,
                              int which, int axis)
{
    lanes sum = lanes_abs(pair->component[which][0][axis]);
    UNROLL(2)
    for (int i = 1; i < component_count(traits, which); i++)
        sum += lanes_abs(pair->component[which][i][axis]);
    return sum;
}

/* Zeros become positive, those of differences too: their sign decides to which end a vertex at l =
 * 0 belongs. */
INLINE void set_box_frame(const struct pair_lanes *pair, const struct kernel_traits traits,
                          int which, const struct box_places *places, struct box_frame *out)
{
    const lanes(*c)[3] = pair->component[which];
    const double twice = is_doubled(traits) ? 2 : 1;
    out->summary = places->summary[which];
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++) {
        const lanes at = twice * places->origin[which][axis];
        out->travel[axis] =
            traits.drifts
                ? (0.5 * twice) * (places->velocity[which][axis] * lanes_of(places->duration)) + 0.0
                : lanes_of(0);
        out->centre[axis] =
            (traits.simplex[which] ? at : at + shift_of(traits, c, axis)) + out->travel[axis];
        out->own_sum[axis] = magnitudes_along(pair, traits, which, axis);
        if (traits.drifts)
            out->own_sum[axis] += lanes_abs(out->travel[axis]);
        out->sum[axis] = lanes_abs(at) + 2 * out->own_sum[axis];
        UNROLL(6)
        for (int index = 0; index < edge_count(traits, which); index++) {
            const int e = edge_at(traits, which, index);
            const lanes from = e < traits.dim ? lanes_of(0) : c[edge_from(traits, e)][axis];
            const lanes to = e < traits.dim ? c[e][axis] : c[edge_to(traits, e)][axis];
            out->edge[e][axis] = (e < traits.dim ? to : to - from) + 0.0;
        }
    }
}

INLINE void set_lengths(const struct pair_lanes *pair, const struct kernel_traits traits, int which,
                        struct box_frame *out)
{
    const lanes(*c)[3] = pair->component[which];
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++) {
        out->own_sum_max = axis ? lanes_max(out->own_sum[axis], out->own_sum_max) : out->own_sum[0];
        const lanes way = lanes_abs(out->travel[axis]);
        out->travel_max = axis ? lanes_max(way, out->travel_max) : way;
        UNROLL(6)
        for (int index = 0; index < edge_count(traits, which); index++) {
            const int e = edge_at(traits, which, index);
            out->length[e][axis] =
                lanes_abs(e < traits.dim ? c[e][axis] : c[edge_to(traits, e)][axis]);
            if (e >= traits.dim)
                out->length[e][axis] += lanes_abs(c[edge_from(traits, e)][axis]);
        }
    }
}

/* The largest magnitude of a coordinate of a vertex over the window, or a little less. */
INLINE lanes largest_place(const struct pair_lanes *pair, const struct kernel_traits traits,
                           int which, const struct box_frame *frame)
{
    lanes largest = lanes_of(0);
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++) {
        const lanes centre = frame->centre[axis];
        lanes farthest = lanes_abs(centre);
        if (!traits.simplex[which]) {
            largest = lanes_max(farthest + frame->own_sum[axis], largest);
            continue;
        }
        UNROLL(3)
        for (int i = 0; i < component_count(traits, which); i++)
            farthest = lanes_max(lanes_abs(centre + pair->component[which][i][axis]), farthest);
        largest = lanes_max(farthest + lanes_abs(frame->travel[axis]), largest);
    }
    return (1 - 0x1p-40) * largest;
}

/* ---- Candidates ---- */

/* Takes what c gives at a vertex; what is not a number bounds nothing. */
INLINE void add_outer(const struct kernel_traits traits, const struct box_candidate *candidate,
                      int which, struct box_search *search)
{
    struct box_bounds *bounds = &search->bounds[which];
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++)
        UNROLL(2)
    for (int end = 0; end < 2; end++)
        bounds->outer[end][axis] = lanes_min(candidate->at[end][axis], bounds->outer[end][axis]);
}

/* Takes a vertex that may be beyond the tolerance along the axes wide[]. The same for a lane
 * whatever the others hold. */
INLINE void add_inner(const struct kernel_traits traits, const struct box_candidate *candidate,
                      const lanes_mask wide[3], int which, struct box_search *search)
{
    struct box_bounds *bounds = &search->bounds[which];
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++)
        UNROLL(2)
    for (int end = 0; end < 2; end++) {
        const lanes at = candidate->at[end][axis], sum = search->frame[which].own_sum[axis];
        const lanes size = sum + lanes_min(lanes_abs(at), sum);
        const lanes inner = at - (candidate->width[axis] + candidate->relative * size);
        lanes_mask counts = wide[axis];
        if (search->careful && search->in_contact)
            counts &=
                candidate->rounded[axis] + candidate->relative_rounded * size > search->tolerance;
        bounds->inner[end][axis] =
            lanes_min(lanes_select(counts, inner, lanes_of(INFINITY)), bounds->inner[end][axis]);
    }
}

INLINE lanes dot_of(const struct kernel_traits traits, const lanes u[3], const lanes v[3])
{
    return traits.dim == 2 ? u[0] * v[0] + u[1] * v[1] : dot(u, v);
}

INLINE lanes weight_of(const struct kernel_traits traits, const lanes weight[3], const lanes v[3])
{
    const lanes plane = weight[0] * lanes_abs(v[0]) + weight[1] * lanes_abs(v[1]);
    return traits.dim == 2 ? plane : plane + weight[2] * lanes_abs(v[2]);
}

/* The error of a determinant, from its monomials and from t. weight: of the vector whose product
 * with v it is; scale: the product of the lengths. */
INLINE lanes determinant_error(const struct kernel_traits traits, lanes scale,
                               const lanes weight[3], const lanes v[3], lanes t,
                               const struct box_search *search)
{
    return lanes_select(
        search->exact, lanes_of(0),
        determinant_rounding(traits) * weight_of(traits, weight, v) + (3.1 * t) * scale);
}

/* Sets what the error of a determinant makes of a candidate; arguments as above. */
INLINE void set_relative(const struct kernel_traits traits, lanes inverse, lanes scale,
                         const lanes weight[3], const lanes v[3], const struct box_search *search,
                         struct box_candidate *out)
{
    const lanes size = 1.2 * lanes_abs(inverse);
    out->relative =
        size * determinant_error(traits, scale, weight, v, search->relative_error, search) +
        0x1p-50;
    out->relative_rounded =
        size * determinant_error(traits, scale, weight, v, lanes_of(0), search) + 0x1p-50;
}

INLINE struct box_vertex vertex_of(const struct kernel_traits traits, lanes det, lanes scale,
                                   const lanes weight[3], const lanes v[3],
                                   struct box_search *search)
{
    struct box_vertex out;
    out.uncertain = (lanes_mask){0};
    out.bend = lanes_of(0);
    const lanes error = (16 * search->determinant) * scale;
    if (lanes_greater_bits(lanes_abs(det), error) == (1u << LANES) - 1) {
        search->spans = is_not((lanes_mask){0});
    } else {
        const lanes fine =
            determinant_error(traits, scale, weight, v, search->relative_error, search);
        const lanes_mask certain = lanes_abs(det) > 16 * fine;
        search->spans |= certain;
        out.uncertain = is_not(certain);
        out.bend = lanes_select(certain, lanes_of(0), lanes_abs(det) + fine);
        const lanes bend = 1.3 * (out.bend / scale);
        const lanes_mask known = (bend <= search->bend_limit) & (scale >= 0x1p-900);
        if (traits.simplex[0] || traits.simplex[1])
            search->bend = search->bend_limit;
        else
            search->bend = lanes_max(lanes_select(known, bend, search->bend_limit), search->bend);
        det = lanes_select(certain, det, lanes_of(NAN));
    }
    out.inverse = 1 / det;
    return out;
}

/* Where the coordinates of an edge may not be 0. Of a component of a frame that is rotated about an
 * axis, the two coordinates that may be off are 0 if both are so as prepared (prepared.h). In
 * numbers: gcc 12 does not compile the masks. */
INLINE void edge_nonzero(const struct kernel_traits traits, const struct box_frame *frame, int e,
                         lanes_mask out[3])
{
    const lanes *edge = frame->edge[e];
    lanes inexact[3], all = lanes_of(1), off = lanes_of(e < traits.dim ? 0 : 1);
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++) {
        inexact[axis] =
            lanes_select(has_bit(frame->summary, (unsigned) PREPARED_COMPONENTS_EXACT_X << axis),
                         lanes_of(0), lanes_of(1));
        all *= inexact[axis];
        off += lanes_abs(edge[axis]) * inexact[axis];
    }
    off += all;
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++)
        out[axis] = lanes_abs(edge[axis]) + off * inexact[axis] != 0;
}

/* Where the coordinates of a normal may not be 0: in 2D of edge k, in 3D of face k, of which 3 is
 * the one across from the origin. */
INLINE void normal_nonzero(const struct kernel_traits traits, int which,
                           const struct box_frame *frame, int k, lanes_mask out[3])
{
    lanes_mask u[3], v[3], own[3];
    if (traits.dim == 2) {
        edge_nonzero(traits, frame, k, u);
        out[0] = u[1];
        out[1] = u[0];
        return;
    }
    out[0] = out[1] = out[2] = (lanes_mask){0};
    UNROLL(3)
    for (int face = first_plane(traits, which); face < 3; face++) {
        if (k != face && k != 3)
            continue;
        edge_nonzero(traits, frame, next(face), u);
        edge_nonzero(traits, frame, next(next(face)), v);
        cross_nonzero(u, v, own);
        for (int axis = 0; axis < 3; axis++)
            out[axis] |= own[axis];
    }
}

/* Where a coordinate of an edge of a face may not be 0; in 2D of edge k. */
INLINE lanes_mask face_nonzero(const struct kernel_traits traits, int which, int k, int axis,
                               const struct box_search *search)
{
    const int first = k == 3 ? 3 : next(k), second = k == 3 ? 4 : next(next(k));
    const lanes_mask(*nonzero)[3] = search->nonzero[which];
    return traits.dim == 2 ? nonzero[k][axis] : nonzero[first][axis] | nonzero[second][axis];
}

/* ---- Vertices y = 0 and y = e_k: extents ---- */

/* The bounds to begin with. */
INLINE void set_extents(const struct kernel_traits traits, const struct pair_lanes *pair, int which,
                        struct box_search *search)
{
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++) {
        lanes at[3];
        UNROLL(3)
        for (int i = 0; i < component_count(traits, which); i++)
            at[i] = pair->component[which][i][axis];
        const struct slab_extent own = extent_of_frame(traits, which, at);
        const lanes way = lanes_abs(search->frame[which].travel[axis]);
        const lanes below = reach_below(traits, which, own),
                    above = reach_above(traits, which, own);
        search->bounds[which].outer[0][axis] = traits.drifts ? below + way : below;
        search->bounds[which].outer[1][axis] = traits.drifts ? above + way : above;
        search->bounds[which].inner[0][axis] = search->bounds[which].inner[1][axis] =
            lanes_of(INFINITY);
    }
}

INLINE const lanes *magnitudes(const lanes v[3], lanes out[3])
{
    UNROLL(3)
    for (int axis = 0; axis < 3; axis++)
        out[axis] = lanes_abs(v[axis]);
    return out;
}

/* The cross product with all signs positive. */
INLINE void cross_weight(const lanes u[3], const lanes v[3], lanes out[3])
{
    UNROLL(3)
    for (int k = 0; k < 3; k++) {
        const int i = next(k), j = next(i);
        out[k] = lanes_abs(u[i] * v[j]) + lanes_abs(u[j] * v[i]);
    }
}

/* ---- Vertices on the line of a normal ---- */

/* Which components of a frame, besides 0, differ along what is 0 on its edge e: those that e does
 * not come from, or one end of e, and the component across from it. */
INLINE int across_first(const struct kernel_traits traits, int which, int e)
{
    if (component_count(traits, which) == 2)
        return e == 0;
    return e < 3 ? next(e) : e - 3;
}

INLINE int across_second(int e)
{
    return e < 3 ? next(next(e)) : next(e - 3);
}

/* The extent of a frame along what is 0 on its edge e, and at[] on its components. */
INLINE struct slab_extent extent_across(const struct kernel_traits traits, int which, int e,
                                        const lanes at[3])
{
    const lanes first = at[across_first(traits, which, e)];
    return component_count(traits, which) == 2
               ? extent_of_one(traits.simplex[which], first)
               : extent_of_two(traits.simplex[which], first, at[across_second(e)]);
}

/* No less than S / |N|, for the scale S of N; of an edge in 2D. */
INLINE lanes stretch_of(const struct kernel_traits traits, lanes scale, const lanes normal[3])
{
    lanes longest = lanes_max(lanes_abs(normal[0]), lanes_abs(normal[1]));
    if (traits.dim == 3)
        longest = lanes_max(lanes_abs(normal[2]), longest);
    return 1.1 * (scale / longest);
}

/* Whether the offset surely is so far inside a slab that c grows at both ends of its line. */
INLINE lanes_mask is_inside(const struct kernel_traits traits, struct slab_extent d, lanes middle,
                            lanes swing, lanes scale, const struct pair_lanes *pair,
                            const struct box_search *search)
{
    return gap_of(traits, d, middle, swing) + scale * (2 * search->bend_error + 2 * pair->unit) < 0;
}

/* The length of the extent of D along a normal; of two cuboids half of it. */
INLINE lanes breadth_of(const struct kernel_traits traits, struct slab_extent d)
{
    if (!traits.simplex[0] && !traits.simplex[1])
        return d.radius;
    const lanes between = d.high - d.low;
    return traits.simplex[0] && traits.simplex[1] ? between : between + d.radius;
}

/* The largest magnitude of the offset along a normal over the window. */
INLINE lanes offset_reach(const struct kernel_traits traits, lanes middle, lanes swing)
{
    return traits.drifts ? lanes_abs(middle) + lanes_abs(swing) : lanes_abs(middle);
}

/* What c is off by on the line of a vector n, for the parameter 1: products with n, those of the
 * offset, and what is made of them; sum: of the magnitudes of these products. */
INLINE lanes value_error(const struct kernel_traits traits, const lanes weight[3],
                         const lanes normal[3], lanes sum, const struct box_search *search)
{
    const lanes rounded = product_rounding(traits) * dot_of(traits, weight, search->size) +
                          (5 * BOX_UNIT) * dot_of(traits, normal, search->offset_sum);
    return lanes_select(search->exact, lanes_of(0), rounded) + (9 * BOX_UNIT) * sum;
}

/* A line and what is the same for all of its vertices. */
struct box_line {
    const struct box_normal *normal;
    int k;        /* its number, as in normal_nonzero() */
    lanes middle; /* what the offset takes from the end above for l = 1, adds to that below */
    lanes own;    /* what the frame of the normal adds to both, its error included */
    lanes width;  /* of what c gives, for l = 1, frame_error left out */
    lanes frame_error, slope; /* for l = 1; no less than the slope of c */
    lanes relative;           /* what the error of the determinant adds to the width, for l = 1 */
    lanes_mask open;          /* a vertex of its own is left out */
};

/* Whether only one of n and -n is the normal of a face with points of its frame behind it: that of
 * a simplex with a volume. */
INLINE bool is_one_sided(const struct kernel_traits traits, int which)
{
    return traits.simplex[which] && component_count(traits, which) == traits.dim;
}

/* Where the sign of x is minus one, else the other; of -0 too. */
INLINE lanes choose_by_sign(lanes x, lanes negative, lanes other)
{
#if LANES == 8 && defined(__AVX512DQ__)
    return (lanes) _mm512_mask_blend_pd(_mm512_movepi64_mask((__m512i) x), (__m512d) other,
                                        (__m512d) negative);
#elif LANES == 4 && defined(__AVX__)
    return (lanes) _mm256_blendv_pd((__m256d) other, (__m256d) negative, (__m256d) x);
#elif LANES == 1
    return signbit(x) ? negative : other;
#else
    return lanes_select((lanes_mask) x >> 63, negative, other);
#endif
}

INLINE lanes with_sign_of(lanes x, lanes sign)
{
#if LANES == 1
    return signbit(sign) ? -x : x;
#else
    return (lanes) ((lanes_mask) x ^ ((lanes_mask) sign & INT64_MIN));
#endif
}

/* What c gives along an axis at the vertex l of a line; d: the extent of the other frame along
 * e_k - l n, turned over with it where the normal is one-sided; both: what is added at both ends.
 */
INLINE void set_candidate(const struct kernel_traits traits, int which, const struct box_line *line,
                          lanes l, struct slab_extent d, lanes both, int axis,
                          struct box_candidate *out)
{
    if (is_one_sided(traits, which)) {
        const lanes candidate = reach_above(traits, !which, d) + both;
        out->at[0][axis] = choose_by_sign(l, candidate, lanes_of(INFINITY));
        out->at[1][axis] = choose_by_sign(l, lanes_of(INFINITY), candidate);
        return;
    }
    const lanes offset_term = l * line->middle;
    out->at[0][axis] = (reach_below(traits, !which, d) + both) + offset_term;
    out->at[1][axis] = (reach_above(traits, !which, d) + both) - offset_term;
}

/* What e_k - l n makes of component i of the other frame. */
INLINE lanes product_at(const struct kernel_traits traits, int which, const struct box_frame *other,
                        const struct box_normal *normal, int i, int axis, lanes l)
{
    const lanes at = other->edge[i][axis] - l * normal->at[i];
    return is_one_sided(traits, which) && traits.simplex[!which] ? with_sign_of(at, l) : at;
}

/* The vertex of a line on the wall of an edge of the other frame. */
INLINE void add_edge_vertex(const struct pair_lanes *pair, const struct kernel_traits traits,
                            int which, const struct box_line *line, int index,
                            const struct box_vertex *vertex, struct box_search *search)
{
    const int other = !which, e = edge_at(traits, other, index);
    const int p = across_first(traits, other, e), q = across_second(e);
    const bool two = component_count(traits, other) == 3;
    const struct box_normal *normal = line->normal;
    const struct box_frame *frame = &search->frame[other];
    const lanes l_max = pair->size[other][e] * lanes_abs(vertex->inverse);
    const lanes edge_error = (1.2 * search->relative_error) * line->slope;
    struct box_candidate candidate;
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++) {
        const lanes l = frame->edge[e][axis] * vertex->inverse;
        const lanes x = product_at(traits, which, frame, normal, p, axis, l);
        const struct slab_extent d =
            two ? extent_of_two(traits.simplex[other], x,
                                product_at(traits, which, frame, normal, q, axis, l))
                : extent_of_one(traits.simplex[other], x);
        lanes both = lanes_abs(l) * line->own;
        if (traits.drifts)
            both += lanes_abs(frame->travel[axis] - l * normal->swing);
        set_candidate(traits, which, line, l, d, both, axis, &candidate);
        candidate.width[axis] =
            lanes_abs(l) * (line->width + line->frame_error) + edge_error * l_max;
        candidate.rounded[axis] =
            (lanes_abs(l) + (1.2 * search->relative_error) * l_max) * line->width;
    }
    set_relative(traits, vertex->inverse, normal->scale * pair->size[other][e], normal->weight,
                 frame->length[e], search, &candidate);
    lanes width = line->width + line->relative;
    if (!search->in_contact)
        width += line->frame_error + edge_error;
    width = l_max * width + 0x1p-49 * frame->own_sum_max;
    add_outer(traits, &candidate, other, search);
    if (!lanes_greater_bits(width, search->tolerance))
        return;
    lanes_mask wide[3];
    for (int axis = 0; axis < traits.dim; axis++) {
        wide[axis] = width > search->tolerance;
        if (search->careful)
            wide[axis] &= search->nonzero[other][e][axis] &
                          (face_nonzero(traits, which, line->k, axis, search) | line->open);
    }
    add_inner(traits, &candidate, wide, other, search);
}

/* The vertex of a line on the wall of the drift. */
INLINE void add_drift_vertex(const struct pair_lanes *pair, const struct kernel_traits traits,
                             int which, const struct box_line *line,
                             const struct box_vertex *vertex, struct box_search *search)
{
    const int other = !which;
    const struct box_frame *frame = &search->frame[other];
    struct box_candidate candidate;
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++) {
        const lanes l = frame->travel[axis] * vertex->inverse;
        lanes at[3];
        UNROLL(3)
        for (int i = 0; i < component_count(traits, other); i++)
            at[i] = product_at(traits, which, frame, line->normal, i, axis, l);
        set_candidate(traits, which, line, l, extent_of_frame(traits, other, at),
                      lanes_abs(l) * line->own, axis, &candidate);
        candidate.width[axis] = lanes_abs(l) * (line->width + line->frame_error);
        candidate.rounded[axis] = lanes_abs(l) * line->width;
    }
    set_relative(traits, vertex->inverse, line->normal->scale * pair->half_drift_size,
                 line->normal->weight, pair->half_drift, search, &candidate);
    lanes width = search->in_contact ? line->width : line->width + line->frame_error;
    width = lanes_abs(vertex->inverse) *
                (frame->travel_max * width + pair->half_drift_size * line->relative) +
            0x1p-49 * frame->own_sum_max;
    add_outer(traits, &candidate, other, search);
    if (!lanes_greater_bits(width, search->tolerance))
        return;
    lanes_mask wide[3];
    for (int axis = 0; axis < traits.dim; axis++) {
        wide[axis] = width > search->tolerance;
        if (search->careful)
            wide[axis] &= (face_nonzero(traits, which, line->k, axis, search) | line->open |
                           (search->frame[which].travel[axis] != 0)) &
                          (frame->travel[axis] != 0);
    }
    add_inner(traits, &candidate, wide, other, search);
}

/* Turns the normal of a simplex outward: its frame does not reach beyond 0 along it, or is as far
 * as all of own. */
INLINE void turn_outward(const struct pair_lanes *pair, const struct kernel_traits traits,
                         int which, bool across, struct box_normal *normal,
                         struct box_search *search)
{
    const lanes *size = pair->size[which];
    const lanes scale = traits.dim == 2 ? size[0] * size[1] : (size[0] * size[1]) * size[2];
    const lanes sign = across ? normal->own : -normal->own;
    search->good &= lanes_abs(normal->own) > search->determinant * scale;
    normal->middle = with_sign_of(normal->middle, sign);
    normal->swing = with_sign_of(normal->swing, sign);
    normal->own = across ? lanes_abs(normal->own) : -lanes_abs(normal->own);
    UNROLL(6)
    for (int e = 0; e < 6; e++)
        if (e < 3 || has_edge(traits, !which, e))
            normal->at[e] = with_sign_of(normal->at[e], sign);
}

/* Of the vertices of a line, on walls of the other frame and that of the drift: the lanes in which
 * a determinant may be 0, and is not surely 0. k: the number of the normal, as in normal_nonzero().
 * Out: bends, what the bends of c by all walls that are not certain change it by at most, for l
 * = 1.
 */
INLINE lanes_mask open_of_line(const struct kernel_traits traits, int which, int k, int walls,
                               const struct box_vertex vertex[7], const struct box_search *search,
                               lanes *bends)
{
    const struct box_frame *other = &search->frame[!which];
    lanes_mask nonzero[3], edge[3], open = {0};
    lanes sum = lanes_of(0);
    normal_nonzero(traits, which, &search->frame[which], k, nonzero);
    for (int index = 0; index < walls; index++) {
        edge_nonzero(traits, other, edge_at(traits, !which, index), edge);
        open |= vertex[index].uncertain & dot_nonzero(traits, nonzero, edge);
        sum += vertex[index].bend;
    }
    if (traits.drifts) {
        open |= vertex[walls].uncertain & dot_nonzero(traits, nonzero, search->drift);
        sum += vertex[walls].bend;
    }
    open &= is_not(search->exact);
    *bends = lanes_select(open, search->bend_count * sum, lanes_of(0));
    return open;
}

/* k: the number of the normal, as in normal_nonzero(). across: the face does not hold the origin of
 * its frame. */
INLINE void add_normal_line(const struct pair_lanes *pair, const struct kernel_traits traits,
                            int which, int k, bool across, struct box_normal *normal,
                            struct box_search *search)
{
    const int other = !which, walls = traits.dim == 2 && which ? 0 : edge_count(traits, other);
    const struct box_frame *frame = &search->frame[other];
    struct box_vertex vertex[7];
    lanes_mask uncertain = {0}, open = {0};
    if (is_one_sided(traits, which))
        turn_outward(pair, traits, which, across, normal, search);
    UNROLL(6)
    for (int index = 0; index < walls; index++) {
        const int e = edge_at(traits, other, index);
        vertex[index] = vertex_of(traits, normal->at[e], normal->scale * pair->size[other][e],
                                  normal->weight, frame->length[e], search);
        uncertain |= vertex[index].uncertain;
    }
    if (traits.drifts) {
        vertex[walls] = vertex_of(traits, normal->swing, normal->scale * pair->half_drift_size,
                                  normal->weight, pair->half_drift, search);
        uncertain |= vertex[walls].uncertain;
    }
    lanes bends = lanes_of(0);
    if (lanes_mask_bits(uncertain))
        open = open_of_line(traits, which, k, walls, vertex, search, &bends);
    const struct slab_extent own = extent_of_one(traits.simplex[which], normal->own);
    const struct slab_extent of_other = extent_of_frame(traits, other, normal->at);
    const struct slab_extent d =
        extent_difference(traits, which ? of_other : own, which ? own : of_other);
    if (traits.dim == 2) {
        const lanes stretch = stretch_of(traits, normal->scale, search->frame[which].edge[k]);
        search->stretch = lanes_max(lanes_select(open, stretch, lanes_of(1)), search->stretch);
        search->open |= open;
    }
    if (lanes_mask_bits(open))
        search->good &=
            is_not(open) | is_inside(traits, d, which ? -normal->middle : normal->middle,
                                     normal->swing, normal->scale, pair, search);
    struct box_line line = {.normal = normal, .k = k, .open = open};
    line.slope = breadth_of(traits, d) + offset_reach(traits, normal->middle, normal->swing);
    const lanes error = value_error(traits, normal->weight, normal->magnitude, line.slope, search) +
                        normal->scale * pair->error;
    line.frame_error = normal->scale * search->frame_error;
    line.width =
        (error + error) + lanes_select(search->left_out, normal->scale * search->bends, bends);
    line.relative = (2.4 * search->rounding) * normal->scale * frame->own_sum_max;
    line.middle = normal->middle;
    line.own = error + reach_above(traits, which, own);
    if (is_one_sided(traits, which))
        line.own -= normal->middle;
    if (traits.drifts) { /* many vertices: unrolled they gain nothing */
        for (int index = 0; index < walls; index++)
            add_edge_vertex(pair, traits, which, &line, index, &vertex[index], search);
        add_drift_vertex(pair, traits, which, &line, &vertex[walls], search);
        return;
    }
    UNROLL(6)
    for (int index = 0; index < walls; index++)
        add_edge_vertex(pair, traits, which, &line, index, &vertex[index], search);
}

/* Sets the normals of the edges of a frame in 2D, by number. Its lengths are set. */
INLINE void set_plane_normals(const struct pair_lanes *pair, const struct kernel_traits traits,
                              int which, const struct box_frame *frame, struct box_normal out[3])
{
    struct edge_products_2d edges;
    const lanes area = product(pair->component[which][0], pair->component[which][1]);
    set_edge_products_2d(pair, traits, which, &edges);
    UNROLL(3)
    for (int e = 0; e < edge_count(traits, which); e++) {
        const lanes *length = frame->length[e];
        out[e] = (struct box_normal){.scale = pair->size[which][e],
                                     .magnitude = {length[1], length[0]},
                                     .weight = {length[1], length[0]},
                                     .own = e == 0 ? area : -area,
                                     .at = {edges.other[e][0], edges.other[e][1]},
                                     .middle = which ? -edges.middle[e] : edges.middle[e],
                                     .swing = which ? -edges.swing[e] : edges.swing[e]};
        out[e].at[2] = out[e].at[1] - out[e].at[0];
    }
}

INLINE void add_plane_normals(const struct pair_lanes *pair, const struct kernel_traits traits,
                              struct box_search *search)
{
    UNROLL(2)
    for (int which = 0; which < 2; which++) {
        struct box_normal normals[3];
        set_plane_normals(pair, traits, which, &search->frame[which], normals);
        UNROLL(3)
        for (int e = 0; e < edge_count(traits, which); e++)
            add_normal_line(pair, traits, which, e, e == 2, &normals[e], search);
    }
}

/* The normal of the face across from the origin. */
INLINE void add_far_face(const struct box_normal normals[3], struct box_normal *out)
{
    out->scale = (normals[0].scale + normals[1].scale) + normals[2].scale;
    out->own = normals[0].own;
    out->middle = (normals[0].middle + normals[1].middle) + normals[2].middle;
    out->swing = (normals[0].swing + normals[1].swing) + normals[2].swing;
    UNROLL(6)
    for (int i = 0; i < 6; i++)
        out->at[i] = (normals[0].at[i] + normals[1].at[i]) + normals[2].at[i];
    UNROLL(3)
    for (int axis = 0; axis < 3; axis++) {
        out->weight[axis] =
            (normals[0].weight[axis] + normals[1].weight[axis]) + normals[2].weight[axis];
        out->magnitude[axis] =
            (normals[0].magnitude[axis] + normals[1].magnitude[axis]) + normals[2].magnitude[axis];
    }
}

/* Sets the normals of the faces of a frame: those of two components at their numbers, that of the
 * face across from the origin at 3. */
INLINE void set_normals(const struct pair_lanes *pair, const struct kernel_traits traits, int which,
                        const struct face_products *side, struct box_normal normals[4])
{
    UNROLL(3)
    for (int k = first_plane(traits, which); k < 3; k++) {
        struct box_normal *normal = &normals[k];
        const int i = next(k), j = next(i);
        normal->scale = pair->size[which][i] * pair->size[which][j];
        normal->own = side->volume;
        normal->middle = which ? -side->middle[k] : side->middle[k];
        normal->swing = which ? -side->swing[k] : side->swing[k];
        cross_weight(pair->component[which][i], pair->component[which][j], normal->weight);
        UNROLL(3)
        for (int axis = 0; axis < 3; axis++)
            normal->magnitude[axis] = lanes_abs(side->normal[k][axis]);
        UNROLL(6)
        for (int e = 0; e < 6; e++)
            normal->at[e] = has_edge(traits, !which, e) ? side->other[k][e] : lanes_of(0);
    }
    if (traits.simplex[which] && !traits.face[which])
        add_far_face(normals, &normals[3]);
}

INLINE void add_space_normals(const struct pair_lanes *pair, const struct kernel_traits traits,
                              int which, const struct face_products *side,
                              struct box_search *search)
{
    struct box_normal normals[4];
    set_normals(pair, traits, which, side, normals);
    for (int k = first_plane(traits, which); k < 3; k++)
        add_normal_line(pair, traits, which, k, false, &normals[k], search);
    if (traits.simplex[which] && !traits.face[which])
        add_normal_line(pair, traits, which, 3, true, &normals[3], search);
}

/* ---- Vertices on a wall of each frame and that of the drift ---- */

/* What is linear in an edge of each, and what in an edge and the drift. */
struct box_products {
    struct edge_products edges;
    lanes drift_middle[6];   /* [a half offset], of edges of A */
    lanes error[6];          /* on the line of H x a: value_error() */
    lanes_mask inside[2][6]; /* the slab of an edge and the drift surely has the offset inside */
};

INLINE void set_drift_slabs(const struct pair_lanes *pair, const struct kernel_traits traits,
                            int which, const struct face_products *own,
                            struct box_products *products, struct box_search *search)
{
    lanes middle[6];
    set_drift_middles(pair, traits, which, middle);
    for (int index = 0; index < edge_count(traits, which); index++) {
        const int e = edge_at(traits, which, index);
        lanes at[3];
        UNROLL(3)
        for (int j = 0; j < component_count(traits, !which); j++)
            at[j] = which ? products->edges.swing[j][e] : -products->edges.swing[e][j];
        const struct slab_extent of_own =
            extent_at_edge(traits, which, e, own->swing[0], own->swing[1], own->swing[2]);
        const struct slab_extent of_other = extent_of_frame(traits, !which, at);
        const struct slab_extent d =
            extent_difference(traits, which ? of_other : of_own, which ? of_own : of_other);
        products->inside[which][e] =
            is_inside(traits, d, middle[e], lanes_of(0),
                      pair->size[which][e] * pair->half_drift_size, pair, search);
        if (which)
            continue;
        lanes normal[3], weight[3];
        cross(pair->half_drift, search->frame[0].edge[e], normal);
        cross_weight(pair->half_drift, search->frame[0].length[e], weight);
        products->drift_middle[e] = middle[e];
        products->error[e] = value_error(traits, weight, magnitudes(normal, normal),
                                         breadth_of(traits, d) + lanes_abs(middle[e]), search);
    }
}

/* y = m (H x a) + n (a x b): what it makes of the components of both frames. a = edge i of A,
 * b = edge j of B. */
INLINE struct slab_extent extent_of_crossing(const struct kernel_traits traits, int i, int j,
                                             lanes m, lanes n, const struct face_products side[2],
                                             const struct box_products *products,
                                             const lanes component[3])
{
    const struct face_products *a = &side[0], *b = &side[1];
    const struct slab_extent of_a =
        extent_at_edge(traits, 0, i, n * a->other[0][j] - m * a->swing[0],
                       n * a->other[1][j] - m * a->swing[1], n * a->other[2][j] - m * a->swing[2]);
    /* (a x b) . c for the components c of B, a and b as above: those of extent_at_edge() */
    const lanes *across[3] = {b->other[0], b->other[1], b->other[2]};
    const int p = next(j % 3), q = next(p);
    lanes product[3];
    if (j < 3) {
        product[j] = lanes_of(0);
        product[p] = across[q][i];
        product[q] = -across[p][i];
    } else { /* b = c_q - c_p */
        product[p] = product[q] = -across[j % 3][i];
        product[j % 3] = across[p][i] + across[q][i];
    }
    lanes at[3];
    UNROLL(3)
    for (int k = 0; k < component_count(traits, 1); k++)
        at[k] = component[k] - (m * products->edges.swing[i][k] + n * product[k]);
    return extent_sum(traits, of_a, extent_across(traits, 1, j, at));
}

/* The vertex on the walls of edge i of A, edge j of B and the drift. */
INLINE void add_crossing(const struct pair_lanes *pair, const struct kernel_traits traits, int i,
                         int j, const struct face_products side[2],
                         const struct box_products *products, struct box_search *search)
{
    const struct box_frame *a = &search->frame[0], *b = &search->frame[1];
    const lanes length_a = pair->size[0][i], length_b = pair->size[1][j];
    const lanes scale = length_a * length_b;
    lanes normal[3], weight[3];
    cross(a->edge[i], b->edge[j], normal);
    cross_weight(a->length[i], b->length[j], weight);
    const struct box_vertex vertex =
        vertex_of(traits, products->edges.swing[i][j], scale * pair->half_drift_size, weight,
                  pair->half_drift, search);
    const struct slab_extent d = extent_sum(
        traits,
        extent_at_edge(traits, 0, i, side[0].other[0][j], side[0].other[1][j], side[0].other[2][j]),
        extent_at_edge(traits, 1, j, side[1].other[0][i], side[1].other[1][i],
                       side[1].other[2][i]));
    if (lanes_mask_bits(vertex.uncertain)) {
        lanes_mask nonzero_a[3], nonzero_b[3], nonzero[3];
        edge_nonzero(traits, a, i, nonzero_a);
        edge_nonzero(traits, b, j, nonzero_b);
        cross_nonzero(nonzero_a, nonzero_b, nonzero);
        const lanes_mask open =
            vertex.uncertain & dot_nonzero(traits, nonzero, search->drift) & is_not(search->exact);
        lanes drift_a[3], drift_b[3];
        cross(pair->half_drift, a->edge[i], drift_a);
        cross(pair->half_drift, b->edge[j], drift_b);
        const lanes stretch[3] = {stretch_of(traits, length_a * pair->half_drift_size, drift_a),
                                  stretch_of(traits, length_b * pair->half_drift_size, drift_b),
                                  stretch_of(traits, scale, normal)};
        const lanes_mask inside[3] = {products->inside[0][i], products->inside[1][j],
                                      is_inside(traits, d, products->edges.middle[i][j],
                                                products->edges.swing[i][j], scale, pair, search)};
        lanes least = lanes_of(0x1p30);
        lanes_mask any = {0};
        for (int line = 0; line < 3; line++)
            least = lanes_min(stretch[line], least);
        for (int line = 0; line < 3; line++)
            any |= inside[line] & (stretch[line] <= least);
        search->stretch = lanes_max(lanes_select(open, least, lanes_of(1)), search->stretch);
        search->good &= is_not(open) | any;
        search->open |= open;
    }
    /* Errors for m = 1 and n = 1. */
    const lanes drift_scale = length_a * pair->half_drift_size;
    const lanes sum = breadth_of(traits, d) + offset_reach(traits, products->edges.middle[i][j],
                                                           products->edges.swing[i][j]);
    const lanes of_m = products->error[i] + drift_scale * pair->error;
    const lanes of_n =
        value_error(traits, weight, magnitudes(normal, normal), sum, search) + scale * pair->error;
    const lanes size = lanes_abs(vertex.inverse);
    const lanes edge_error =
        ((1.2 * search->relative_error) * length_b) * ((drift_scale * pair->reach) * size);
    const lanes width_of_m = (of_m + of_m) + drift_scale * search->bends;
    const lanes width_of_n = (of_n + of_n) + scale * search->bends;
    struct box_candidate candidate;
    UNROLL(3)
    for (int axis = 0; axis < 3; axis++) {
        const lanes m = b->edge[j][axis] * vertex.inverse, n = b->travel[axis] * vertex.inverse;
        const lanes m_size = lanes_abs(m), n_size = lanes_abs(n);
        lanes component[3];
        UNROLL(3)
        for (int k = 0; k < component_count(traits, 1); k++)
            component[k] = pair->component[1][k][axis];
        const struct slab_extent at =
            extent_of_crossing(traits, i, j, m, n, side, products, component);
        const lanes offset_term = n * products->edges.middle[i][j] - m * products->drift_middle[i];
        const lanes error = m_size * of_m + n_size * of_n;
        candidate.at[0][axis] = ((at.radius - at.low) + error) + offset_term;
        candidate.at[1][axis] = ((at.radius + at.high) + error) - offset_term;
        candidate.width[axis] = (m_size * (width_of_m + drift_scale * search->frame_error) +
                                 n_size * (width_of_n + scale * search->frame_error)) +
                                edge_error;
        candidate.rounded[axis] =
            (m_size + (1.2 * search->relative_error) * (length_b * size)) * width_of_m +
            n_size * width_of_n;
    }
    set_relative(traits, vertex.inverse, scale * pair->half_drift_size, weight, pair->half_drift,
                 search, &candidate);
    const lanes error = (1.2 * search->rounding * (scale * pair->half_drift_size)) * size + 0x1p-50;
    lanes width = ((length_b * size) * width_of_m + (b->travel_max * size) * width_of_n) +
                  (2 * error) * b->own_sum_max;
    if (!search->in_contact)
        width += (((length_b * size) * drift_scale + (b->travel_max * size) * scale) *
                  search->frame_error) +
                 edge_error;
    add_outer(traits, &candidate, 1, search);
    if (!lanes_greater_bits(width, search->tolerance))
        return;
    lanes_mask wide[3];
    for (int axis = 0; axis < 3; axis++) {
        wide[axis] = width > search->tolerance;
        if (search->careful)
            wide[axis] &= (search->nonzero[0][i][axis] | (a->travel[axis] != 0)) &
                          (search->nonzero[1][j][axis] | (b->travel[axis] != 0));
    }
    add_inner(traits, &candidate, wide, 1, search);
}

INLINE void add_crossings(const struct pair_lanes *pair, const struct kernel_traits traits,
                          const struct face_products side[2], struct box_search *search)
{
    struct box_products products;
    set_products(pair, traits, pair->offset, products.edges.middle);
    set_products(pair, traits, pair->half_drift, products.edges.swing);
    UNROLL(2)
    for (int which = 0; which < 2; which++)
        set_drift_slabs(pair, traits, which, &side[which], &products, search);
    for (int i = 0; i < edge_count(traits, 0); i++)
        UNROLL(6)
    for (int j = 0; j < edge_count(traits, 1); j++)
        add_crossing(pair, traits, edge_at(traits, 0, i), edge_at(traits, 1, j), side, &products,
                     search);
}

/* ---- Ends that are exact ----
 *
 * Where the ends of an extent are those of the box (boxes along the axes, a frame within the other)
 * they are as near as doubles go: a sum or product is rounded outward, if it rounds. Subtracting
 * the term of larger magnitude from a sum is exact, and shows which way it was rounded (Dekker).
 * The error of a product above 2^-900 is found from halves of the factors (Dekker); 2^-52 of a
 * normal number is between one and two units in its last place; sums that are not normal are exact.
 */

INLINE lanes sum_above(lanes x, lanes y)
{
    const lanes sum = x + y;
    const lanes_mask below = (sum - x < y) | (sum - y < x);
    return lanes_select(below, sum + 0x1p-52 * lanes_abs(sum), sum);
}

INLINE lanes upper_half(lanes x)
{
    const lanes large = 134217729 * x;
    return large - (large - x);
}

/* What a product is off by at most, 0 where it is exact. Factors beyond 2^900 count as inexact: NAN
 * is not 0. */
INLINE lanes product_slack(lanes x, lanes y, lanes product)
{
    const lanes x_high = upper_half(x), y_high = upper_half(y);
    const lanes x_low = x - x_high, y_low = y - y_high;
    const lanes error =
        ((x_high * y_high - product) + x_high * y_low + x_low * y_high) + x_low * y_low;
    const lanes_mask exact =
        ((error == 0) & (lanes_abs(product) >= 0x1p-900)) | (x == 0) | (y == 0);
    return lanes_select(exact, lanes_of(0), 0x1p-52 * lanes_abs(product) + 0x1p-950);
}

/* Adds the end of a component, at x from the origin, to the ends of a frame: [0] how far it reaches
 * below 0, [1] above. Of a cuboid, x is added to the end on its side. */
INLINE void add_component(bool simplex, lanes origin, lanes x, lanes ends[2])
{
    const lanes from = simplex ? with_sign_of(origin, x) : choose_by_sign(x, ends[0], ends[1]);
    const lanes to = sum_above(from, lanes_abs(x));
    ends[0] = choose_by_sign(x, simplex ? lanes_max(to, ends[0]) : to, ends[0]);
    ends[1] = choose_by_sign(x, ends[1], simplex ? lanes_max(to, ends[1]) : to);
}

/* Cuts the box, in the lengths of the world; ends: as in add_component(). */
INLINE void cut_to_extent(const struct pair_lanes *pair, const struct kernel_traits traits,
                          int which, const struct box_places *places, int axis, lanes ends[2])
{
    const bool twice = is_doubled(traits) && traits.simplex[which];
    const lanes origin = places->origin[which][axis];
    lanes own[2] = {-origin, origin};
    UNROLL(3)
    for (int i = 0; i < component_count(traits, which); i++) {
        const lanes c = pair->component[which][i][axis];
        add_component(traits.simplex[which], origin, twice ? 0.5 * c : c, own);
    }
    if (traits.drifts) {
        const lanes velocity = places->velocity[which][axis], time = lanes_of(places->duration);
        const lanes way = velocity * time, slack = product_slack(velocity, time, way);
        own[0] = sum_above(own[0], lanes_max(slack - way, lanes_of(0)));
        own[1] = sum_above(own[1], lanes_max(way + slack, lanes_of(0)));
    }
    const lanes_mask inexact =
        is_not(has_bit(places->summary[which], (unsigned) PREPARED_EXACT_X << axis));
    if (lanes_mask_bits(inexact)) {
        const lanes error = lanes_select(inexact, places->error[which], lanes_of(0));
        own[0] = sum_above(own[0], error);
        own[1] = sum_above(own[1], error);
    }
    ends[0] = lanes_min(own[0], ends[0]);
    ends[1] = lanes_min(own[1], ends[1]);
}

/* ---- All of it ---- */

/* Sums of magnitudes along an axis. */
INLINE void set_sizes(const struct pair_lanes *pair, const struct kernel_traits traits,
                      const struct box_places *places, int axis, struct box_search *search)
{
    const lanes apart = lanes_abs(places->origin[1][axis] - places->origin[0][axis]);
    const lanes half = lanes_abs(pair->half_drift[axis]);
    const lanes sum[2] = {magnitudes_along(pair, traits, 0, axis),
                          magnitudes_along(pair, traits, 1, axis)};
    lanes size = sum[0] + sum[1], offset_sum = is_doubled(traits) ? apart + apart : apart;
    if (traits.drifts) {
        size += half;
        offset_sum += 2 * half;
    }
    search->size[axis] = size + lanes_abs(pair->offset[axis]);
    search->offset_sum[axis] = offset_sum;
    UNROLL(2)
    for (int which = 0; which < 2; which++)
        if (!traits.simplex[which])
            search->offset_sum[axis] += sum[which];
}

/* Of lanes in which nothing rounds: whether all numbers of the pair are multiples of g, with at =
 * 2^52 g, and the frames' own travels do not round either. */
INLINE lanes_mask are_multiples(const struct pair_lanes *pair, const struct kernel_traits traits,
                                const struct box_places *places, const struct box_search *search,
                                lanes at)
{
    lanes_mask all = search->exact;
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++)
        UNROLL(2)
    for (int which = 0; which < 2; which++) {
        if (lanes_mask_bits(all) == 0)
            break;
        all &= is_multiple(places->origin[which][axis], at);
        UNROLL(3)
        for (int i = 0; i < component_count(traits, which); i++)
            all &= is_multiple(pair->component[which][i][axis], at);
        if (!traits.drifts)
            continue;
        const lanes v = places->velocity[which][axis], time = lanes_of(places->duration);
        all &= is_multiple(search->frame[which].travel[axis], at) &
               (product_slack(v, time, v * time) == 0);
    }
    return all;
}

/* Sets bend_error. bend: the largest |d| of walls that are not certain, for scale 1. */
INLINE void set_bend_error(const struct pair_lanes *pair, const struct kernel_traits traits,
                           lanes bend, struct box_search *search)
{
    const double lengths = traits.simplex[0] || traits.simplex[1] ? 2 : 0.5;
    search->bend_error = (lengths * search->bend_count) * ((bend * search->stretch) * pair->reach);
}

/* Sets what any way to find a box needs: frames, sizes, slack, and how far apart ends may be. */
INLINE void begin_box(const struct pair_lanes *pair, const struct kernel_traits traits,
                      const struct box_places *places, struct box_search *search)
{
    lanes largest = lanes_of(0), slack = lanes_of(0);
    lanes_mask lost = {0};
    UNROLL(2)
    for (int which = 0; which < 2; which++) {
        set_box_frame(pair, traits, which, places, &search->frame[which]);
        largest = lanes_max(largest_place(pair, traits, which, &search->frame[which]), largest);
    }
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++) {
        set_sizes(pair, traits, places, axis, search);
        UNROLL(2)
        for (int which = 0; which < 2; which++) {
            search->slack[which][axis] =
                (9 * BOX_UNIT) * search->frame[which].sum[axis] + 1.1 * pair->error;
            slack = lanes_max(search->slack[which][axis], slack);
        }
        if (!traits.drifts)
            continue;
        search->drift[axis] = places->velocity[0][axis] != places->velocity[1][axis];
        lost |= search->drift[axis] & (pair->half_drift[axis] == 0);
    }
    search->exact = places->exact;
    search->largest = largest;
    const lanes power = lanes_from_bits(lanes_as_bits(pair->reach) & UINT64_C(0x7ff0000000000000));
    search->unit = lanes_select(are_multiples(pair, traits, places, search, 0x1p45 * power),
                                0x1p-7 * power, lanes_of(0));
    const lanes tolerance = (0.95 * BOX_LIMIT) * largest - 2.1 * slack;
    search->whole = lanes_select((search->unit != 0) | (tolerance < 0), lanes_of(0), tolerance);
    search->usable = is_not(lost) & (largest <= BOX_FARTHEST);
}

/* Sets what vertices need besides, and divides the tolerance. */
INLINE void begin_search(const struct pair_lanes *pair, const struct kernel_traits traits,
                         const struct box_places *places, struct box_search *search)
{
    const unsigned all_true = PREPARED_COMPONENTS_EXACT_X * (traits.dim == 2 ? 3u : 7u);
    lanes_mask inexact = {0};
    lanes lengths = pair->half_drift_size;
    UNROLL(2)
    for (int which = 0; which < 2; which++) {
        set_lengths(pair, traits, which, &search->frame[which]);
        inexact |= (places->summary[which] & (UINT64_C(1) << 3 * PREPARED_SIZE_BITS) * all_true) !=
                   (UINT64_C(1) << 3 * PREPARED_SIZE_BITS) * all_true;
        UNROLL(3)
        for (int i = 0; i < component_count(traits, which); i++)
            lengths += pair->size[which][i];
    }
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++)
        lengths += lanes_abs(pair->offset[axis]);
    search->relative_error = lanes_select(inexact, lanes_of(ROTATION_ERROR), lanes_of(0));
    const lanes_mask shares = places->in_contact ? pair->error != 0 : (lanes_mask){0};
    search->frame_error = (2.2 * search->relative_error) * lengths + 0.1 * pair->error;
    search->bend_count = lanes_select(shares, lanes_of(4), lanes_of(2));
    search->bend = lanes_of(0);
    search->bend_limit = 17 * (slab_rounding(traits) + 4 * search->relative_error);
    search->stretch = lanes_of(1);
    set_bend_error(pair, traits, search->bend_limit, search);
    search->rounding =
        lanes_select(search->exact, lanes_of(0), lanes_of(1.2 * determinant_rounding(traits)));
    search->determinant = search->rounding + 3.1 * search->relative_error;
    if (!places->in_contact)
        search->rounding = search->determinant;
    search->in_contact = places->in_contact;
    search->shared = lanes_select(shares, 0.36 * search->whole, lanes_of(0));
    search->tolerance = search->whole - search->shared;
    search->good = search->usable;
    search->spans = search->open = search->left_out = (lanes_mask){0};
    search->bends = lanes_of(0);
    search->careful = false;
}

/* Ends that are small numbers, to the last bit. With the numbers of the pair multiples of a unit g,
 * and T < 2^8 g, a determinant is at most 4 T^3 / 81 < 2^20 g^3 (T^3 / 27 but for the normal of a
 * far face, a sum of three), and an end a fraction of g with a denominator below that. Two such
 * fractions, or one and a multiple of 2^-20 g, are 2^-40 g apart if they differ: where the end is
 * within 2^-41 g of such a multiple, it is that. */
INLINE lanes snapped(lanes outer, lanes inner, lanes unit)
{
    const lanes large = (0x1.8p52 * 0x1p-20) * unit, middle = 0.5 * (outer + inner);
    const lanes snap = (middle + large) - large;
    const lanes near = 0x1p-41 * unit;
    lanes_mask is_end = unit != 0;
    is_end &= lanes_abs(snap - outer) <= near;
    is_end &= lanes_abs(snap - inner) <= near;
    is_end &= lanes_abs(middle) <= 0x1p30 * unit;
    return lanes_select(is_end, snap, outer);
}

/* Begins the second pass: what the first left out, how far c may bend there, and which coordinates
 * of edges may not be 0. */
INLINE void begin_second_pass(const struct pair_lanes *pair, const struct kernel_traits traits,
                              const struct box_left_out *left_out, struct box_search *search)
{
    search->careful = true;
    search->left_out = left_out->open;
    search->stretch = left_out->stretch;
    set_bend_error(pair, traits, left_out->bend, search);
    search->bends = lanes_select(left_out->open, search->bend_error, lanes_of(0));
    const lanes whole = (search->tolerance + search->shared) - search->bends;
    const lanes rest = lanes_select(whole > 0, whole, lanes_of(0));
    search->good &= is_not(left_out->open) | (whole > 0);
    const lanes shared = lanes_select(search->shared != 0, 0.36 * rest, lanes_of(0));
    search->shared = lanes_select(left_out->open, shared, search->shared);
    search->tolerance = lanes_select(left_out->open, rest - shared, search->tolerance);
    UNROLL(2)
    for (int which = 0; which < 2; which++)
        for (int index = 0; index < edge_count(traits, which); index++) {
            const int e = edge_at(traits, which, index);
            edge_nonzero(traits, &search->frame[which], e, search->nonzero[which][e]);
        }
}

INLINE void add_all(const struct pair_lanes *pair, const struct kernel_traits traits,
                    struct box_search *search)
{
    UNROLL(2)
    for (int which = 0; which < 2; which++)
        set_extents(traits, pair, which, search);
    if (traits.dim == 2) {
        add_plane_normals(pair, traits, search);
        return;
    }
    struct face_products side[2];
    UNROLL(2)
    for (int which = 0; which < 2; which++) {
        set_face_products(pair, traits, which, &side[which]);
        add_space_normals(pair, traits, which, &side[which], search);
    }
    if (traits.drifts)
        add_crossings(pair, traits, side, search);
}

/* How far the box reaches, [below 0, above][axis]: outer at most, inner surely, or with an error
 * that is known to be within the limit (box_clip.h). */
struct box_ends {
    lanes outer[2][3], inner[2][3];
};

INLINE void find_ends(const struct kernel_traits traits, const struct box_search *search,
                      struct box_ends *out)
{
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++)
        UNROLL(2)
    for (int end = 0; end < 2; end++) {
        lanes outer = lanes_of(INFINITY), inner = lanes_of(INFINITY);
        UNROLL(2)
        for (int which = 0; which < 2; which++) {
            const lanes centre =
                end ? search->frame[which].centre[axis] : -search->frame[which].centre[axis];
            const lanes slack = search->slack[which][axis];
            const lanes at = centre + search->bounds[which].outer[end][axis];
            const lanes least = centre + search->bounds[which].inner[end][axis];
            outer = lanes_min(at + slack, outer);
            const lanes beyond = slack + (search->shared + search->bends);
            inner = lanes_min(lanes_min(at - search->tolerance, least) - beyond, inner);
        }
        out->outer[end][axis] = outer;
        out->inner[end][axis] = inner;
    }
}

/* The lanes in which both ends along all axes are within the limit. */
INLINE lanes_mask are_near(const struct kernel_traits traits, const struct box_search *search,
                           const struct box_ends *ends)
{
    lanes_mask good = search->usable;
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++)
        UNROLL(2)
    for (int end = 0; end < 2; end++)
        good &= ends->outer[end][axis] - ends->inner[end][axis] <= BOX_LIMIT * search->largest;
    return good;
}

/* Puts the ends in the lengths of the world, cut to both frames. */
INLINE void put_box(const struct pair_lanes *pair, const struct kernel_traits traits,
                    const struct box_places *places, const struct box_search *search,
                    const struct box_ends *found, lanes box[2][3])
{
    const bool any_unit = lanes_mask_bits(search->unit != 0);
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++) {
        lanes ends[2];
        UNROLL(2)
        for (int end = 0; end < 2; end++) {
            ends[end] = found->outer[end][axis];
            if (any_unit)
                ends[end] = snapped(ends[end], found->inner[end][axis], search->unit);
            if (is_doubled(traits))
                ends[end] *= 0.5;
        }
        UNROLL(2)
        for (int which = 0; which < 2; which++)
            cut_to_extent(pair, traits, which, places, axis, ends);
        box[0][axis] = 0.0 - ends[0]; /* never -0 */
        box[1][axis] = ends[1] + 0.0;
    }
}

/* Boxes, and in which lanes they are good. search: as begin_box() leaves it. second: the second
 * pass, which gives all boxes of the first, and more. left_out: written by the first. */
INLINE lanes_mask search_box(const struct pair_lanes *pair, const struct kernel_traits traits,
                             const struct box_places *places, bool second,
                             struct box_search *search, struct box_left_out *left_out,
                             lanes box[2][3])
{
    struct box_ends ends;
    begin_search(pair, traits, places, search);
    if (second)
        begin_second_pass(pair, traits, left_out, search);
    add_all(pair, traits, search);
    find_ends(traits, search, &ends);
    put_box(pair, traits, places, search, &ends, box);
    const lanes_mask good = are_near(traits, search, &ends) & search->good & search->spans;
    if (second)
        return good;
    *left_out = (struct box_left_out){search->open, search->bend, search->stretch};
    return good & is_not(search->open);
}

#endif
