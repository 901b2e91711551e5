/* The slabs of LANES pairs in 3D: along the normals of faces, of two edges, and of an edge and the
 * drift.
 *
 *   In     struct pair_lanes: components, offset of the reference points, half the drift, error
 *   Out    struct slabs_result, to which add_slab() adds each slab (slabs_lanes.h)
 *
 * Steps (evaluate_slabs_3d()):
 *
 *   1. set_face_products()  the face normals of a frame, and their products with the offset, the
 *                           drift and the edges of the other frame
 *   2. add_faces()          slabs of the faces of each frame; stops if that is enough for all lanes
 *   3. set_products()       triple products of an edge of A, one of B, and the offset or the drift
 *   4. add_edges()          slabs of an edge of A and one of B; 1 gives products with components
 *   5. add_drift()          if the pair drifts: slabs of an edge and the drift
 *
 * Proof: the top of slabs.c derives these formulas and the error bound of each kind of slab. */
#ifndef FMB_SLABS_3D_H
#define FMB_SLABS_3D_H

#include "slabs_lanes.h"

/* The face normals of a frame, and all products with them. */
struct face_products {
    lanes normal[3][3];        /* normal[k] = c_i x c_j, i, j, k cyclic; of a face only k = 2 */
    lanes volume;              /* normal[k] . c_k, any k */
    lanes other[3][6];         /* [k][edge]: normal[k] . edges of the other frame */
    lanes middle[3], swing[3]; /* normal[k] . offset, normal[k] . half_drift */
};

/* Completes value[edge], linear in the edges of a frame, from its components. */
INLINE void add_differences(const struct kernel_traits traits, int which, lanes value[6])
{
    UNROLL(3)
    for (int i = 0; i < 3; i++)
        if (has_difference(traits, which, i))
            value[3 + i] = value[next(next(i))] - value[next(i)];
}

/* The first k for which normal[k] is that of a face of the frame. */
INLINE int first_plane(const struct kernel_traits traits, int which)
{
    return traits.face[which] ? 2 : 0;
}

INLINE void set_face_products(const struct pair_lanes *pair, const struct kernel_traits traits,
                              int which, struct face_products *out)
{
    if (traits.face[which]) /* a face has normal[2] only */
        memset(out, 0, sizeof *out);
    UNROLL(3)
    for (int k = first_plane(traits, which); k < 3; k++) {
        cross(pair->component[which][next(k)], pair->component[which][next(next(k))],
              out->normal[k]);
        out->middle[k] = dot(out->normal[k], pair->offset);
        out->swing[k] = traits.drifts ? dot(out->normal[k], pair->half_drift) : lanes_of(0);
        UNROLL(3)
        for (int j = 0; j < component_count(traits, !which); j++)
            out->other[k][j] = dot(out->normal[k], pair->component[!which][j]);
        add_differences(traits, !which, out->other[k]);
    }
    out->volume = traits.face[which] ? lanes_of(0) : dot(out->normal[0], pair->component[which][0]);
}

/* Adds the slab of a face of a (which = 0) or of b. at[]: the components of the other frame along
 * its normal. The extent of a frame along the normal of its own face is that of one component;
 * along that of the face across from the origin all three components are at the same value. */
INLINE void add_face(const struct pair_lanes *pair, const struct kernel_traits traits, int which,
                     struct slab_normal normal, const struct face_products *side, const lanes at[3],
                     lanes scale, lanes middle, lanes swing, struct slabs_result *result)
{
    const struct slab_extent own = extent_of_one(traits.simplex[which], side->volume);
    const struct slab_extent other = extent_of_frame(traits, !which, at);
    const lanes_mask along = is_known_axis(traits, pair->across[which][normal.u % SLABS_EDGES],
                                           pair->across[which][normal.v % SLABS_EDGES]);
    add_slab(traits, normal, extent_difference(traits, which ? other : own, which ? own : other),
             scale, pair->unit, middle, swing, false, along, result);
}

INLINE void add_faces(const struct pair_lanes *pair, const struct kernel_traits traits, int which,
                      const struct face_products *side, struct slabs_result *result)
{
    const int first = which ? SLABS_EDGE_OF_B : 0;
    const lanes *size = pair->size[which];
    UNROLL(3)
    for (int k = first_plane(traits, which); k < 3; k++) {
        const int i = next(k), j = next(i);
        add_face(pair, traits, which, (struct slab_normal){first + i, first + j}, side,
                 side->other[k], size[i] * size[j], side->middle[k], side->swing[k], result);
    }
    if (!traits.simplex[which] || traits.face[which])
        return;
    lanes at[3];
    UNROLL(3)
    for (int j = 0; j < component_count(traits, !which); j++)
        at[j] = (side->other[0][j] + side->other[1][j]) + side->other[2][j];
    add_face(pair, traits, which, (struct slab_normal){first + 3, first + 4}, side, at,
             (size[0] * size[1] + size[1] * size[2]) + size[2] * size[0],
             (side->middle[0] + side->middle[1]) + side->middle[2],
             (side->swing[0] + side->swing[1]) + side->swing[2], result);
}

/* Products with an edge of each frame, [edge of a][edge of b]: [a b offset], [a b half_drift]. */
struct edge_products {
    lanes middle[6][6], swing[6][6];
};

/* Completes value[edge of a][edge of b] from the components. Where swap_invariant, differences of a
 * tetrahedron's components enter in the same way by either index, so that the pair with its frames
 * swapped has the same bits. */
INLINE void add_product_differences(const struct kernel_traits traits, lanes value[6][6])
{
    UNROLL(3)
    for (int i = 0; i < 3; i++) {
        const int p = next(i), q = next(p);
        UNROLL(3)
        for (int j = 0; j < 3; j++) {
            if (has_difference(traits, 1, i) && j < component_count(traits, 0))
                value[j][3 + i] = value[j][q] - value[j][p];
            if (has_difference(traits, 0, i) && j < component_count(traits, 1))
                value[3 + i][j] = value[q][j] - value[p][j];
        }
    }
    UNROLL(3)
    for (int i = 0; i < 3; i++) {
        const int p = next(i), q = next(p);
        UNROLL(3)
        for (int j = 0; j < 3; j++) {
            if (!has_difference(traits, 0, i) || !has_difference(traits, 1, j))
                continue;
            const int r = next(j), s = next(r);
            value[3 + i][3 + j] = traits.swap_invariant
                                      ? (value[q][s] + value[p][r]) - (value[q][r] + value[p][s])
                                      : value[3 + i][s] - value[3 + i][r];
        }
    }
}

/* A product of edges i of a and j of b in a mirrored pair, from that of j and i. */
INLINE lanes mirrored(lanes x)
{
#if LANES == 2
    return lanes_swap(x);
#else
    return x;
#endif
}

/* Sets the products of the faces of b that add_edges() needs, in a mirrored pair, from those of a.
 */
INLINE void mirror_side(const struct kernel_traits traits, const struct face_products *side,
                        struct face_products *out)
{
    UNROLL(3)
    for (int k = 0; k < 3; k++)
        UNROLL(6)
    for (int j = 0; j < 6; j++)
        if (j < component_count(traits, 0) || (j >= 3 && has_difference(traits, 0, j - 3)))
            out->other[k][j] = mirrored(side->other[k][j]);
}

/* Sets [a_i b_j w] for all edges. (a_i x b_j) . w has the same bits for the pair with its frames
 * swapped; (w x a_i) . b_j takes fewer operations. */
INLINE void set_products(const struct pair_lanes *pair, const struct kernel_traits traits,
                         const lanes w[3], lanes value[6][6])
{
    UNROLL(3)
    for (int i = 0; i < component_count(traits, 0); i++) {
        lanes normal[3];
        if (!traits.swap_invariant)
            cross(w, pair->component[0][i], normal);
        UNROLL(3)
        for (int j = 0; j < component_count(traits, 1); j++) {
            if (traits.mirrored && j < i) {
                value[i][j] = mirrored(value[j][i]);
            } else if (traits.swap_invariant) {
                cross(pair->component[0][i], pair->component[1][j], normal);
                value[i][j] = dot(normal, w);
            } else {
                value[i][j] = dot(normal, pair->component[1][j]);
            }
        }
    }
    add_product_differences(traits, value);
}

/* The extent of a frame along e x f, where e is an edge of its own; at[k] = normal[k] . f. Of a
 * face it is that of one component: along c_0 x f, c_1 is at -at[2]; along c_1 x f and (c_1 - c_0)
 * x f, c_0 is at at[2], and along the last of them c_1 too. */
INLINE struct slab_extent extent_at_edge(const struct kernel_traits traits, int which, int e,
                                         lanes at0, lanes at1, lanes at2)
{
    const lanes at[3] = {at0, at1, at2};
    if (traits.face[which])
        return extent_of_one(true, e == 0 ? -at2 : at2);
    if (e < 3)
        return extent_of_two(traits.simplex[which],
                             traits.simplex[which] ? -at[next(next(e))] : at[next(next(e))],
                             at[next(e)]);
    const int r = e - 3, p = next(r), q = next(p);
    return extent_of_two(true, at[r], -(at[p] + at[q]));
}

/* The lanes in which u x v is exactly 0 because each product in it has a factor 0. No product of
 * two numbers other than 0 is small enough to underflow to 0. */
INLINE lanes_mask cross_is_zero(const lanes u[3], const lanes v[3])
{
    const lanes x = lanes_abs(u[0]) * (lanes_abs(v[1]) + lanes_abs(v[2]));
    const lanes y = lanes_abs(u[1]) * (lanes_abs(v[2]) + lanes_abs(v[0]));
    const lanes z = lanes_abs(u[2]) * (lanes_abs(v[0]) + lanes_abs(v[1]));
    return (x + y) + z == 0;
}

/* traits.second: the lanes in which nothing rounds (unit = 0) and the normal of two edges is zero:
 * neither frame has an extent along it. Two faces in parallel planes have no extent along the
 * normal of the planes either, but that normal is the one of a face, which has its own slab. */
INLINE lanes_mask extent_is_zero(const struct kernel_traits traits, lanes unit,
                                 struct slab_extent d)
{
    if (traits.second)
        return (lanes_mask) ((unit == 0) & (d.low == d.high) & (d.radius == 0));
    return (lanes_mask){0};
}

INLINE void add_edges(const struct pair_lanes *pair, const struct kernel_traits traits,
                      const struct face_products side[2], const struct edge_products *edges,
                      struct slabs_result *result)
{
    const struct face_products *a = &side[0], *b = &side[1];
    UNROLL(6)
    for (int edge_a = 0; edge_a < edge_count(traits, 0); edge_a++) {
        const int i = edge_at(traits, 0, edge_a);
        const lanes unit = traits.swap_invariant ? pair->unit : pair->size[0][i] * pair->unit;
        lanes u[3], v[3];
        lanes_mask ignored = {0};
        if (traits.axis_aligned)
            edge_vector(traits, pair, 0, i, u);
        UNROLL(6)
        for (int edge_b = traits.mirrored ? edge_a : 0; edge_b < edge_count(traits, 1); edge_b++) {
            const int j = edge_at(traits, 1, edge_b);
            const struct slab_extent of_a =
                extent_at_edge(traits, 0, i, a->other[0][j], a->other[1][j], a->other[2][j]);
            const struct slab_extent of_b =
                extent_at_edge(traits, 1, j, b->other[0][i], b->other[1][i], b->other[2][i]);
            if (traits.axis_aligned) {
                edge_vector(traits, pair, 1, j, v);
                ignored = cross_is_zero(u, v);
            }
            const lanes scale =
                traits.swap_invariant ? pair->size[0][i] * pair->size[1][j] : pair->size[1][j];
            const struct slab_extent d = extent_sum(traits, of_a, of_b);
            ignored |= extent_is_zero(traits, unit, d) |
                       is_known_axis(traits, pair->across[0][i], pair->across[1][j]);
            add_slab(traits, (struct slab_normal){i, SLABS_EDGE_OF_B + j}, d, scale, unit,
                     edges->middle[i][j], edges->swing[i][j], false, ignored, result);
        }
    }
}

/* Sets middle[e] to (e x half_drift) . offset = (half_drift x offset) . e, for the edges e of a
 * frame. */
INLINE void set_drift_middles(const struct pair_lanes *pair, const struct kernel_traits traits,
                              int which, lanes middle[6])
{
    lanes plane[3];
    cross(pair->half_drift, pair->offset, plane);
    UNROLL(3)
    for (int i = 0; i < component_count(traits, which); i++)
        middle[i] = dot(plane, pair->component[which][i]);
    add_differences(traits, which, middle);
}

/* Adds the slabs of the edges of a (which = 0) or of b with the drift; their normals are e x
 * half_drift. own: the face products of that frame. The offset in the middle of the window stands
 * for the offset at any time. [a half_drift b] = -[a b half_drift], [b half_drift a] = [a b
 * half_drift]. */
INLINE void add_drift(const struct pair_lanes *pair, const struct kernel_traits traits, int which,
                      const struct face_products *own, const struct edge_products *edges,
                      struct slabs_result *result)
{
    lanes middle[6];
    set_drift_middles(pair, traits, which, middle);
    const lanes unit = pair->half_drift_size * pair->unit;
    UNROLL(6)
    for (int own_edge = 0; own_edge < edge_count(traits, which); own_edge++) {
        const int i = edge_at(traits, which, own_edge);
        lanes at[3], edge[3];
        lanes_mask ignored = {0};
        UNROLL(3)
        for (int j = 0; j < component_count(traits, !which); j++)
            at[j] = which ? edges->swing[j][i] : -edges->swing[i][j];
        if (traits.axis_aligned) {
            edge_vector(traits, pair, which, i, edge);
            ignored = cross_is_zero(edge, pair->half_drift) & ~pair->tiny;
        }
        const struct slab_extent of_own =
            extent_at_edge(traits, which, i, own->swing[0], own->swing[1], own->swing[2]);
        const struct slab_extent of_other = extent_of_frame(traits, !which, at);
        const struct slab_extent d =
            extent_difference(traits, which ? of_other : of_own, which ? of_own : of_other);
        ignored |= extent_is_zero(traits, unit, d) |
                   is_known_axis(traits, pair->across[which][i], pair->signed_axes);
        add_slab(traits, (struct slab_normal){(which ? SLABS_EDGE_OF_B : 0) + i, SLABS_DRIFT}, d,
                 pair->size[which][i], unit, middle[i], lanes_of(0), true, ignored, result);
    }
}

INLINE void evaluate_slabs_3d(const struct pair_lanes *pair, const struct kernel_traits traits,
                              struct slabs_result *result)
{
    struct face_products side[2];
    struct edge_products edges;
    UNROLL(2)
    for (int which = 0; which < 2; which++) {
        if (which == 1 && traits.mirrored) {
            mirror_side(traits, &side[0], &side[1]);
            break;
        }
        set_face_products(pair, traits, which, &side[which]);
        add_faces(pair, traits, which, &side[which], result);
        if (is_enough(traits, result))
            return;
    }
    set_products(pair, traits, pair->offset, edges.middle);
    if (traits.drifts)
        set_products(pair, traits, pair->half_drift, edges.swing);
    else
        memset(edges.swing, 0, sizeof edges.swing);
    add_edges(pair, traits, side, &edges, result);
    if (!traits.drifts || is_enough(traits, result))
        return;
    add_drift(pair, traits, 0, &side[0], &edges, result);
    if (!traits.mirrored)
        add_drift(pair, traits, 1, &side[1], &edges, result);
}

#endif
