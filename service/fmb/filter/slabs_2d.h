/* The slabs of LANES pairs in 2D: along the normals of the edges of both frames, and of the drift.
 *
 *   In     struct pair_lanes
 *   Out    struct slabs_result, to which add_slab() adds each slab (slabs_lanes.h)
 *
 * Proof: the top of slabs.c derives the products and the bounds of their errors. */
#ifndef FMB_SLABS_2D_H
#define FMB_SLABS_2D_H

#include "slabs_lanes.h"

/* The products of the edges e of a frame, by number (slabs.h). */
struct edge_products_2d {
    lanes middle[3], swing[3]; /* [e offset], [e half_drift] */
    lanes other[3][2];         /* [e, component of the other frame] */
};

/* Sets all other products. On input, out->other of the components is set. */
INLINE void complete_edge_products_2d(const struct pair_lanes *pair,
                                      const struct kernel_traits traits, int which,
                                      struct edge_products_2d *out)
{
    UNROLL(2)
    for (int i = 0; i < 2; i++) {
        const lanes *e = pair->component[which][i];
        out->middle[i] = product(e, pair->offset);
        out->swing[i] = traits.drifts ? product(e, pair->half_drift) : lanes_of(0);
    }
    if (!traits.simplex[which])
        return;
    out->middle[2] = out->middle[1] - out->middle[0];
    out->swing[2] = out->swing[1] - out->swing[0];
    out->other[2][0] = out->other[1][0] - out->other[0][0];
    out->other[2][1] = out->other[1][1] - out->other[0][1];
}

INLINE void set_edge_products_2d(const struct pair_lanes *pair, const struct kernel_traits traits,
                                 int which, struct edge_products_2d *out)
{
    UNROLL(2)
    for (int i = 0; i < 2; i++)
        UNROLL(2)
    for (int j = 0; j < 2; j++)
        out->other[i][j] = product(pair->component[which][i], pair->component[!which][j]);
    complete_edge_products_2d(pair, traits, which, out);
}

/* Sets the products of b from those of a: [b a] = -[a b], which rounds to the same magnitude. */
INLINE void set_edge_products_2d_of_b(const struct pair_lanes *pair,
                                      const struct kernel_traits traits,
                                      struct edge_products_2d side[2])
{
    UNROLL(2)
    for (int i = 0; i < 2; i++)
        UNROLL(2)
    for (int j = 0; j < 2; j++)
        side[1].other[i][j] = -side[0].other[j][i];
    complete_edge_products_2d(pair, traits, 1, &side[1]);
}

/* Adds the slabs of the edges of a (which = 0) or of b. Along the normal of edge c_0 the component
 * c_1 is at area = [c_0 c_1]; along that of c_1, c_0 is at -area; along that of c_1 - c_0 both are
 * at -area. */
INLINE void add_edges_2d(const struct pair_lanes *pair, const struct kernel_traits traits,
                         int which, const struct edge_products_2d *edges,
                         struct slabs_result *result)
{
    const lanes area = product(pair->component[which][0], pair->component[which][1]);
    UNROLL(3)
    for (int e = 0; e < edge_count(traits, which); e++) {
        const struct slab_extent own =
            extent_of_one(traits.simplex[which], traits.simplex[which] && e > 0 ? -area : area);
        const struct slab_extent other =
            extent_of_two(traits.simplex[!which], edges->other[e][0], edges->other[e][1]);
        add_slab(traits, (struct slab_normal){(which ? SLABS_EDGE_OF_B : 0) + e, 0},
                 extent_difference(traits, which ? other : own, which ? own : other),
                 pair->size[which][e], pair->unit, edges->middle[e], edges->swing[e], false,
                 is_known_axis(traits, pair->across[which][e], pair->across[which][e]), result);
    }
}

/* Adds the slab whose normal is orthogonal to the drift. */
INLINE void add_drift_2d(const struct pair_lanes *pair, const struct kernel_traits traits,
                         const struct edge_products_2d side[2], struct slabs_result *result)
{
    const struct slab_extent a =
        extent_of_two(traits.simplex[0], -side[0].swing[0], -side[0].swing[1]);
    const struct slab_extent b =
        extent_of_two(traits.simplex[1], -side[1].swing[0], -side[1].swing[1]);
    add_slab(traits, (struct slab_normal){SLABS_DRIFT, 0}, extent_difference(traits, a, b),
             pair->half_drift_size, pair->unit, product(pair->half_drift, pair->offset),
             lanes_of(0), true, is_known_axis(traits, pair->signed_axes, pair->signed_axes),
             result);
}

INLINE void evaluate_slabs_2d(const struct pair_lanes *pair, const struct kernel_traits traits,
                              struct slabs_result *result)
{
    struct edge_products_2d side[2];
    set_edge_products_2d(pair, traits, 0, &side[0]);
    add_edges_2d(pair, traits, 0, &side[0], result);
    if (LANES <= 2 && is_enough(traits, result)) /* of more lanes rarely all are */
        return;
    if (traits.mirrored) {
        set_edge_products_2d(pair, traits, 1, &side[1]);
    } else {
        set_edge_products_2d_of_b(pair, traits, side);
        add_edges_2d(pair, traits, 1, &side[1], result);
    }
    if (traits.drifts)
        add_drift_2d(pair, traits, side, result);
}

#endif
