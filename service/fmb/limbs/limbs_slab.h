/* Slabs in integers: their normals from edges and drift, the products of these with the vectors of
 * a pair, their bounds, and the sign of their gaps.
 *
 * Each scalar product n . v is computed in the coordinates in which v is given: those of frame 0,
 * of frame 1, or of the world. So a normal is computed in up to three coordinate systems. The three
 * vectors may differ by positive factors, norms of rotations; a product is multiplied by the
 * missing factors, so that all numbers of a slab have one common factor. */
#ifndef FMB_LIMBS_SLAB_H
#define FMB_LIMBS_SLAB_H

#include "limbs_pair.h"

/* ---- Normals ---- */

/* Returns an edge, numbered as in slabs.h, in the coordinates of its frame, of the other frame, or
 * of the world. With p, q, r cyclic, edge 3 + r is c_q - c_p. An edge is computed when it is first
 * needed, and kept. */
LIMBS_FUNCTION const struct limbs_vector *edge_in_view(struct limbs_pair *pair, int edge,
                                                       enum limbs_view view)
{
    const int f = edge >= SLABS_EDGE_OF_B, e = edge % SLABS_EDGES, dim = pair->frame[f]->dim;
    const struct limbs_vector **at = pair->view[f][e];
    struct limbs_vector *own = &pair->storage[f][e][LIMBS_OWN];
    if (!at[LIMBS_OWN] && pair->frame[f]->shape == FMB_BOX) {
        memset(own, 0, sizeof *own);
        own->limbs = pair->component[f][e].limbs > 0;
        own->at[e][0] = (uint64_t) own->limbs;
        own->other_than_0 = (unsigned) own->limbs << e;
        at[LIMBS_OWN] = own;
    }
    if (!at[LIMBS_OWN] && e < dim)
        at[LIMBS_OWN] = &pair->component[f][e];
    if (!at[LIMBS_OWN]) {
        const int p = dim == 2 ? 0 : (e + 1) % 3, q = dim == 2 ? 1 : (e + 2) % 3;
        *own = pair->component[f][q];
        for (int axis = 0; axis < FMB_DIM_MAX; axis++)
            subtract(pair->limbs, own->at[axis], pair->component[f][p].at[axis]);
        limbs_trim(pair->limbs, own);
        at[LIMBS_OWN] = own;
    }
    if (at[view])
        return at[view];
    at[view] =
        limbs_transform(pair->limbs, view == LIMBS_ACROSS ? pair->across[f] : pair->to_world[f],
                        at[LIMBS_OWN], &pair->storage[f][e][view]);
    if (view == LIMBS_WORLD && at[view] != at[LIMBS_OWN])
        limbs_trim(pair->limbs, &pair->storage[f][e][view]);
    return at[view];
}

enum { WORLD = 2 }; /* after frames 0 and 1 */

/* The normal of a slab in the coordinates of the two frames and of the world, and the missing
 * factor of products in each of these; NULL: 1. */
struct normal {
    const struct limbs_vector *at[3];
    const struct limbs_factor *factor[3];
    struct limbs_vector storage[3];
};

/* u x v, u an edge of frame 0 and v one of frame 1. */
LIMBS_FUNCTION void set_normal_of_edges(struct limbs_pair *pair, int u, int v, struct normal *out)
{
    const int n = pair->limbs;
    limbs_cross(n, edge_in_view(pair, v, LIMBS_ACROSS), edge_in_view(pair, u, LIMBS_OWN), true,
                &out->storage[0]);
    out->at[0] = out->at[1] = out->at[WORLD] = &out->storage[0];
    if (!pair->all)
        return;
    limbs_cross(n, edge_in_view(pair, u, LIMBS_ACROSS), edge_in_view(pair, v, LIMBS_OWN), false,
                &out->storage[1]);
    out->at[1] = &out->storage[1];
    if (!pair->to_world[0] || !pair->to_world[1]) {
        out->at[WORLD] = out->at[pair->to_world[0] != NULL];
        return;
    }
    limbs_cross(n, edge_in_view(pair, u, LIMBS_WORLD), edge_in_view(pair, v, LIMBS_WORLD), false,
                &out->storage[WORLD]);
    out->at[WORLD] = &out->storage[WORLD];
}

/* out := v rotated by a right angle, counterclockwise: (-v_y, v_x, 0). */
LIMBS_FUNCTION void set_plane_normal(int n, const struct limbs_vector *v, struct limbs_vector *out)
{
    memset(out, 0, sizeof *out);
    subtract(n, out->at[0], v->at[1]);
    memcpy(out->at[1], v->at[0], (size_t) n * sizeof *out->at[1]);
}

/* Completes a normal that is known in the coordinates of frame f, in out->storage[f]. */
LIMBS_FUNCTION void spread_normal(struct limbs_pair *pair, int f, struct normal *out)
{
    const int n = pair->limbs, other = !f;
    out->at[f] = &out->storage[f];
    out->at[other] = limbs_transform(n, pair->across[f], out->at[f], &out->storage[other]);
    out->at[WORLD] = pair->to_world[other]
                         ? limbs_transform(n, pair->to_world[f], out->at[f], &out->storage[WORLD])
                         : out->at[other];
    out->factor[f] = pair->all;
    out->factor[WORLD] = pair->norm[other];
}

/* u x v of two edges of frame f; in 2D u, an edge of frame f, rotated by a right angle. */
LIMBS_FUNCTION void set_normal_of_face(struct limbs_pair *pair, int f, struct slab_normal edges,
                                       struct normal *out)
{
    const int n = pair->limbs;
    const struct limbs_vector *u = edge_in_view(pair, edges.u, LIMBS_OWN);

    if (pair->frame[0]->dim == 2)
        set_plane_normal(n, u, &out->storage[f]);
    else
        limbs_cross(n, u, edge_in_view(pair, edges.v, LIMBS_OWN), false, &out->storage[f]);
    limbs_trim(n, &out->storage[f]);
    spread_normal(pair, f, out);
}

/* u x drift, in 3D. */
LIMBS_FUNCTION void set_normal_of_drift(struct limbs_pair *pair, int u, struct normal *out)
{
    const int n = pair->limbs, f = u >= SLABS_EDGE_OF_B, other = !f;
    struct limbs_vector drift;
    limbs_cross(n, edge_in_view(pair, u, LIMBS_WORLD), &pair->drift, false, &out->storage[WORLD]);
    limbs_trim(n, &out->storage[WORLD]);
    out->at[0] = out->at[1] = out->at[WORLD] = &out->storage[WORLD];
    if (pair->from_world[f]) {
        limbs_cross(n, limbs_transform(n, pair->from_world[f], &pair->drift, &drift),
                    edge_in_view(pair, u, LIMBS_OWN), true, &out->storage[f]);
        out->at[f] = &out->storage[f];
    }
    out->at[other] =
        limbs_transform(n, pair->from_world[other], out->at[WORLD], &out->storage[other]);
    out->factor[f] = out->factor[WORLD] = pair->norm[other];
}

/* Completes a normal that is known in the coordinates of the world, in out->storage[WORLD]. */
LIMBS_FUNCTION void spread_from_world(struct limbs_pair *pair, struct normal *out)
{
    limbs_trim(pair->limbs, &out->storage[WORLD]);
    out->at[WORLD] = &out->storage[WORLD];
    out->factor[WORLD] = pair->all;
    for (int f = 0; f < 2; f++) {
        out->at[f] =
            limbs_transform(pair->limbs, pair->from_world[f], out->at[WORLD], &out->storage[f]);
        out->factor[f] = pair->common ? pair->common : pair->norm[!f];
    }
}

/* Computes the normal of a slab. Returns false if it is zero. */
LIMBS_FUNCTION bool set_normal(struct limbs_pair *pair, struct slab_normal edges,
                               struct normal *out)
{
    const bool plane = pair->frame[0]->dim == 2;
    const int f = edges.u >= SLABS_EDGE_OF_B;
    out->factor[0] = out->factor[1] = out->factor[WORLD] = NULL;
    if (plane && edges.u == SLABS_DRIFT) {
        set_plane_normal(pair->limbs, &pair->drift, &out->storage[WORLD]);
        spread_from_world(pair, out);
    } else if (!plane && edges.v == SLABS_DRIFT)
        set_normal_of_drift(pair, edges.u, out);
    else if (plane || f == (edges.v >= SLABS_EDGE_OF_B))
        set_normal_of_face(pair, f, edges, out);
    else
        set_normal_of_edges(pair, edges.u, edges.v, out);
    if (pair->common)
        out->factor[0] = out->factor[1] = pair->common;
    const limbs_number *at = out->at[0]->at;
    return !is_zero(pair->limbs, at[0]) || !is_zero(pair->limbs, at[1]) ||
           !is_zero(pair->limbs, at[2]);
}

/* ---- Products ---- */

/* Products of a normal with the vectors of a pair, without the missing factors. */
struct limbs_products {
    limbs_number component[2][FMB_DIM_MAX]; /* [frame][component]; of a box, of half of it */
    limbs_number origin[2];                 /* of a box, its centre; unset if that is 0 */
    limbs_number offset, drift;
    const struct limbs_factor *factor[3]; /* missing factors: of frame 0, of frame 1, of the rest */
};

LIMBS_INLINE void limbs_products_for(const int n, const struct limbs_pair *pair,
                                     const struct normal *normal, struct limbs_products *out)
{
    memcpy(out->factor, normal->factor, sizeof out->factor);
    dot_limbs(n, normal->at[WORLD], &pair->offset, out->offset);
    dot_limbs(n, normal->at[WORLD], &pair->drift, out->drift);
    for (int f = 0; f < 2; f++) {
        for (int i = 0; i < pair->frame[f]->count; i++)
            dot_limbs(n, normal->at[f], &pair->component[f][i], out->component[f][i]);
        if (pair->origin[f].limbs > 0)
            dot_limbs(n, normal->at[f], &pair->origin[f], out->origin[f]);
    }
}

LIMBS_FUNCTION void limbs_set_products(const struct limbs_pair *pair, const struct normal *normal,
                                       struct limbs_products *out)
{
    WITH_LIMBS(pair->limbs, limbs_products_for, pair, normal, out);
}

/* Computes the products of the normal of a slab. Returns false if it is zero. */
LIMBS_FUNCTION bool limbs_products_of(struct limbs_pair *pair, struct slab_normal edges,
                                      struct limbs_products *out)
{
    struct normal normal;
    const bool exists = set_normal(pair, edges, &normal);
    if (exists)
        limbs_set_products(pair, &normal, out);
    return exists;
}

/* [low, high] := the extent of frame f along the normal, from its origin; of a box, its centre.
 *
 * A simplex: the minimum and the maximum of 0 and the products with the components. A cuboid: the
 * sums of the negative and of the positive products. A box is given by half of its components and
 * its centre: it extends to either side by the sum of the magnitudes of the products. */
LIMBS_INLINE void limbs_extent(const int n, const struct limbs_pair *pair,
                               const struct limbs_products *of, int f, uint64_t *low,
                               uint64_t *high)
{
    const size_t size = (size_t) n * sizeof *low;
    const bool simplex = frame_is_simplex(pair->frame[f]);
    memset(low, 0, size);
    memset(high, 0, size);
    for (int i = 0; i < pair->frame[f]->count; i++) {
        const uint64_t *at = of->component[f][i];
        if (!simplex)
            add(n, is_negative(n, at) ? low : high, at);
        else if (is_less(n, at, low))
            memcpy(low, at, size);
        else if (is_less(n, high, at))
            memcpy(high, at, size);
    }
    if (pair->frame[f]->shape != FMB_BOX)
        return;
    subtract(n, high, low);
    memset(low, 0, size);
    subtract(n, low, high);
}

/* x := x times a missing factor; NULL: 1. */
LIMBS_INLINE void scale_by(const int n, const struct limbs_factor *factor, uint64_t *x)
{
    limbs_number product;
    if (!factor || is_zero(n, x))
        return;
    memset(product, 0, (size_t) n * sizeof *x);
    limbs_add_product(n, product, false, x, factor->limbs, factor->at);
    memcpy(x, product, (size_t) n * sizeof *x);
}

/* ---- Slabs ---- */

/* A slab of the difference a - b: the bounds of normal . w, and its value along the path of the
 * offset, start + tau slope, tau in [0,1]. */
struct limbs_slab {
    limbs_number low, high, start, slope;
};

LIMBS_INLINE void set_slab_of(const int n, const struct limbs_pair *pair,
                              const struct limbs_products *of, struct limbs_slab *out)
{
    const size_t size = (size_t) n * sizeof *out->low;
    limbs_number low[2], high[2];
    for (int f = 0; f < 2; f++) {
        limbs_extent(n, pair, of, f, low[f], high[f]);
        if (pair->origin[f].limbs > 0) {
            add(n, low[f], of->origin[f]);
            add(n, high[f], of->origin[f]);
        }
        scale_by(n, of->factor[f], low[f]);
        scale_by(n, of->factor[f], high[f]);
    }
    memcpy(out->low, low[0], size);
    memcpy(out->high, high[0], size);
    subtract(n, out->low, high[1]);
    subtract(n, out->high, low[1]);
    memcpy(out->start, of->offset, size);
    memcpy(out->slope, of->drift, size);
    scale_by(n, of->factor[WORLD], out->start);
    scale_by(n, of->factor[WORLD], out->slope);
}

LIMBS_FUNCTION void limbs_set_slab(const struct limbs_pair *pair, const struct limbs_products *of,
                                   struct limbs_slab *out)
{
    WITH_LIMBS(pair->limbs, set_slab_of, pair, of, out);
}

/* The sign of the gap of a slab, the larger of start + min(0, slope) - high and low - (start +
 * max(0, slope)). The slab is overwritten. */
LIMBS_FUNCTION int limbs_sign_of_gap(int n, struct limbs_slab *slab)
{
    limbs_number last;
    memcpy(last, slab->start, (size_t) n * sizeof *last);
    add(n, is_negative(n, slab->slope) ? last : slab->start, slab->slope);
    subtract(n, slab->high, last); /* now last is the lower end of the path, start the upper one */
    subtract(n, slab->low, slab->start);
    const int above = -sign_of(n, slab->high), below = sign_of(n, slab->low);
    return above > below ? above : below;
}

/* ---- To GMP ---- */

/* out := |x|, as a number without a sign. In: out is not x. */
LIMBS_FUNCTION void set_magnitude(int n, const uint64_t *x, uint64_t *out)
{
    memset(out, 0, (size_t) n * sizeof *x);
    (is_negative(n, x) ? subtract : add)(n, out, x);
}

LIMBS_FUNCTION void limbs_to_mpz(int n, const uint64_t *x, mpz_t out)
{
    limbs_number magnitude;
    set_magnitude(n, x, magnitude);
    mpz_import(out, (size_t) n, -1, sizeof *x, 0, 0, magnitude);
    if (is_negative(n, x))
        mpz_neg(out, out);
}

#endif
