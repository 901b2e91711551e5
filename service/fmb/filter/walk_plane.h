/* The slabs of a pair in 2D. */
#ifndef FMB_WALK_PLANE_H
#define FMB_WALK_PLANE_H

#include "walk_slab.h"

struct walk_plane_edges {
    lanes middle[3], swing[3]; /* [e offset], [e half] */
    lanes other[3][2];         /* [e, component of the other frame] */
};

/* On input: out->other of the components. */
INLINE void complete_plane_edges(const struct walk_pair *pair, const struct walk_kind kind,
                                 int which, struct walk_plane_edges *out)
{
    UNROLL(2)
    for (int i = 0; i < 2; i++) {
        const lanes *e = pair->component[which][i];
        out->middle[i] = product(e, pair->offset);
        out->swing[i] = kind.drifts ? product(e, pair->half) : lanes_of(0);
    }
    if (!kind.simplex[which])
        return;
    out->middle[2] = out->middle[1] - out->middle[0];
    out->swing[2] = out->swing[1] - out->swing[0];
    out->other[2][0] = out->other[1][0] - out->other[0][0];
    out->other[2][1] = out->other[1][1] - out->other[0][1];
}

INLINE void set_plane_edges(const struct walk_pair *pair, const struct walk_kind kind, int which,
                            struct walk_plane_edges *out)
{
    UNROLL(2)
    for (int i = 0; i < 2; i++)
        UNROLL(2)
    for (int j = 0; j < 2; j++)
        out->other[i][j] = product(pair->component[which][i], pair->component[!which][j]);
    complete_plane_edges(pair, kind, which, out);
}

/* The edges of b, from those of a: [b a] = -[a b], rounded alike. */
INLINE void set_plane_edges_of_b(const struct walk_pair *pair, const struct walk_kind kind,
                                 struct walk_plane_edges side[2])
{
    UNROLL(2)
    for (int i = 0; i < 2; i++)
        UNROLL(2)
    for (int j = 0; j < 2; j++)
        side[1].other[i][j] = -side[0].other[j][i];
    complete_plane_edges(pair, kind, 1, &side[1]);
}

/* Along the edge c_0 the component c_1 is at area = [c_0 c_1]; along c_1, c_0 at -area; along
 * c_1 - c_0 both at -area. */
INLINE void add_plane_edges(const struct walk_pair *pair, const struct walk_kind kind, int which,
                            const struct walk_plane_edges *edges, struct walk_found *found)
{
    const lanes area = product(pair->component[which][0], pair->component[which][1]);
    UNROLL(3)
    for (int e = 0; e < edge_count(kind, which); e++) {
        const struct walk_extent own =
            extent_of_one(kind.simplex[which], kind.simplex[which] && e > 0 ? -area : area);
        const struct walk_extent other =
            extent_of_two(kind.simplex[!which], edges->other[e][0], edges->other[e][1]);
        add_slab(kind, (struct slab_normal){(which ? SLABS_EDGE_OF_B : 0) + e, 0},
                 extent_difference(kind, which ? other : own, which ? own : other),
                 pair->size[which][e], pair->unit, edges->middle[e], edges->swing[e], false,
                 is_along_axis(kind, pair->across[which][e], pair->across[which][e]), found);
    }
}

INLINE void add_plane_drift(const struct walk_pair *pair, const struct walk_kind kind,
                            const struct walk_plane_edges side[2], struct walk_found *found)
{
    const struct walk_extent a =
        extent_of_two(kind.simplex[0], -side[0].swing[0], -side[0].swing[1]);
    const struct walk_extent b =
        extent_of_two(kind.simplex[1], -side[1].swing[0], -side[1].swing[1]);
    add_slab(kind, (struct slab_normal){SLABS_DRIFT, 0}, extent_difference(kind, a, b),
             pair->half_size, pair->unit, product(pair->half, pair->offset), lanes_of(0), true,
             is_along_axis(kind, pair->signed_axes, pair->signed_axes), found);
}

INLINE void walk_plane(const struct walk_pair *pair, const struct walk_kind kind,
                       struct walk_found *found)
{
    struct walk_plane_edges side[2];
    set_plane_edges(pair, kind, 0, &side[0]);
    add_plane_edges(pair, kind, 0, &side[0], found);
    if (LANES <= 2 && is_enough(kind, found)) /* seldom all of more lanes */
        return;
    if (kind.mirrored) {
        set_plane_edges(pair, kind, 1, &side[1]);
    } else {
        set_plane_edges_of_b(pair, kind, side);
        add_plane_edges(pair, kind, 1, &side[1], found);
    }
    if (kind.drifts)
        add_plane_drift(pair, kind, side, found);
}

#endif
