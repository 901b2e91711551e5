/* Slabs in fixed-width integers: their normals from edges and drift, their bounds, and the sign of
 * their gaps.
 *
 * Each scalar product n . v is computed in the coordinates in which v is given: those of frame 0,
 * of frame 1, or of the world. So a normal is computed in up to three coordinate systems. The three
 * vectors may differ by positive factors, norms of rotations; a product is multiplied by the
 * missing factors, so that all numbers of a slab have one common factor. */
#include "limbs.h"

/* ---- Normals ---- */

/* Returns an edge, numbered as in slabs.h, in the coordinates of its frame, of the other frame, or
 * of the world. With p, q, r cyclic, edge 3 + r is c_q - c_p. An edge is computed when it is first
 * needed, and kept. */
static const struct limbs_vector *edge_in_view(struct limbs_pair *pair, int edge,
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
static void set_normal_of_edges(struct limbs_pair *pair, int u, int v, struct normal *out)
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
static void set_plane_normal(int n, const struct limbs_vector *v, struct limbs_vector *out)
{
    memset(out, 0, sizeof *out);
    subtract(n, out->at[0], v->at[1]);
    memcpy(out->at[1], v->at[0], (size_t) n * sizeof *out->at[1]);
}

/* Completes a normal that is known in the coordinates of frame f, in out->storage[f]. */
static void spread_normal(struct limbs_pair *pair, int f, struct normal *out)
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
static void set_normal_of_face(struct limbs_pair *pair, int f, struct slab_normal edges,
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

/* The normal of a face of frame f, times an edge of the same frame: it lies in the plane. */
static void set_normal_in_face(struct limbs_pair *pair, int f, int edge, struct normal *out)
{
    struct limbs_vector normal;
    const int first = f ? SLABS_EDGE_OF_B : 0;
    set_normal_of_face(pair, f, (struct slab_normal){first, first + 1}, out);
    normal = out->storage[f];
    limbs_cross(pair->limbs, &normal, edge_in_view(pair, first + edge, LIMBS_OWN), false,
                &out->storage[f]);
    limbs_trim(pair->limbs, &out->storage[f]);
    spread_normal(pair, f, out);
}

/* u x drift, in 3D. */
static void set_normal_of_drift(struct limbs_pair *pair, int u, struct normal *out)
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

/* The drift rotated by a right angle, in 2D. */
static void set_normal_of_plane_drift(struct limbs_pair *pair, struct normal *out)
{
    set_plane_normal(pair->limbs, &pair->drift, &out->storage[WORLD]);
    limbs_trim(pair->limbs, &out->storage[WORLD]);
    out->at[WORLD] = &out->storage[WORLD];
    out->factor[WORLD] = pair->all;
    for (int f = 0; f < 2; f++) {
        out->at[f] =
            limbs_transform(pair->limbs, pair->from_world[f], out->at[WORLD], &out->storage[f]);
        out->factor[f] = pair->norm[!f];
    }
}

/* Computes the normal of a slab. Returns false if it is zero. */
static bool set_normal(struct limbs_pair *pair, struct slab_normal edges, struct normal *out)
{
    const bool plane = pair->frame[0]->dim == 2;
    const int f = edges.u >= SLABS_EDGE_OF_B;
    out->factor[0] = out->factor[1] = out->factor[WORLD] = NULL;
    if (plane && edges.u == SLABS_DRIFT)
        set_normal_of_plane_drift(pair, out);
    else if (!plane && edges.v == SLABS_DRIFT)
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

/* ---- Slabs ---- */

struct value_interval {
    limbs_number low, high;
};

/* A slab: the bounds of normal . w, and its value along the path of the offset, start + tau slope,
 * tau in [0,1]. */
struct slab_limbs {
    struct value_interval bounds;
    limbs_number start, slope;
};

/* x < y */
INLINE bool less(const int n, const uint64_t *x, const uint64_t *y)
{
    limbs_number difference;
    memcpy(difference, x, (size_t) n * sizeof *x);
    subtract(n, difference, y);
    return is_negative(n, difference);
}

/* x := x times a factor; NULL: 1. */
INLINE void scale_by(const int n, const struct limbs_factor *factor, uint64_t *x)
{
    limbs_number product;
    if (!factor || is_zero(n, x))
        return;
    memset(product, 0, (size_t) n * sizeof *x);
    limbs_add_product(n, product, false, x, factor->limbs, factor->at);
    memcpy(x, product, (size_t) n * sizeof *x);
}

/* *interval := the interval of normal . x over frame f, seen from the position of its body.
 *
 * A simplex: the minimum and the maximum of 0 and the products with the components. A cuboid: the
 * sums of the negative and of the positive products. A box is given by half of its components and
 * its centre: it extends to either side by the sum of the magnitudes of the products. */
INLINE void set_extent(const int n, const struct limbs_pair *pair, int f,
                       const struct normal *normal, struct value_interval *interval)
{
    const size_t size = (size_t) n * sizeof *interval->low;
    const struct fmb_frame *frame = pair->frame[f];
    const bool simplex = frame_is_simplex(frame);
    limbs_number at;
    memset(interval->low, 0, size);
    memset(interval->high, 0, size);
    for (int i = 0; i < frame->count; i++) {
        dot_limbs(n, normal->at[f], &pair->component[f][i], at);
        if (!simplex)
            add(n, is_negative(n, at) ? interval->low : interval->high, at);
        else if (less(n, at, interval->low))
            memcpy(interval->low, at, size);
        else if (less(n, interval->high, at))
            memcpy(interval->high, at, size);
    }
    if (frame->shape == FMB_BOX) {
        subtract(n, interval->high, interval->low);
        memset(interval->low, 0, size);
        subtract(n, interval->low, interval->high);
    }
    if (pair->origin[f].limbs > 0) {
        dot_limbs(n, normal->at[f], &pair->origin[f], at);
        add(n, interval->low, at);
        add(n, interval->high, at);
    }
    scale_by(n, normal->factor[f], interval->low);
    scale_by(n, normal->factor[f], interval->high);
}

/* The numbers of a slab: bounds of the difference a - b, and normal . (offset + tau drift). */
INLINE void set_values(const int n, const struct limbs_pair *pair, const struct normal *normal,
                       struct slab_limbs *out)
{
    struct value_interval b;
    set_extent(n, pair, 0, normal, &out->bounds);
    set_extent(n, pair, 1, normal, &b);
    subtract(n, out->bounds.low, b.high);
    subtract(n, out->bounds.high, b.low);
    dot_limbs(n, normal->at[WORLD], &pair->offset, out->start);
    scale_by(n, normal->factor[WORLD], out->start);
    dot_limbs(n, normal->at[WORLD], &pair->drift, out->slope);
    scale_by(n, normal->factor[WORLD], out->slope);
}

/* Computes a slab. Returns false, with all numbers 0, if its normal is zero. */
static bool set_slab(struct limbs_pair *pair, struct slab_normal edges, struct slab_limbs *out)
{
    struct normal normal;
    if (!set_normal(pair, edges, &normal)) {
        memset(out, 0, sizeof *out);
        return false;
    }
    WITH_LIMBS(pair->limbs, set_values, pair, &normal, out);
    return true;
}

/* -1, 0 or 1 */
static int sign(const int n, const uint64_t *x)
{
    return is_negative(n, x) ? -1 : !is_zero(n, x);
}

/* The gap is the larger of start + min(0, slope) - high and low - (start + max(0, slope)). */
int limbs_gap_sign(struct limbs_pair *pair, struct slab_normal normal)
{
    struct slab_limbs slab;
    const int n = pair->limbs;
    if (!set_slab(pair, normal, &slab))
        return -1;
    uint64_t *above = slab.bounds.high, *below = slab.bounds.low;
    limbs_number last;
    memcpy(last, slab.start, (size_t) n * sizeof *last);
    add(n, is_negative(n, slab.slope) ? last : slab.start, slab.slope);
    subtract(n, above, last); /* now last is the lower end of the path, start the upper one */
    subtract(n, below, slab.start);
    const int sign_above = -sign(n, above), sign_below = sign(n, below);
    return sign_above > sign_below ? sign_above : sign_below;
}

/* Along the normal of a, the extent of a is 0. So the slab of this normal has an extent of 0 if and
 * only if b has none along it, that is, if the planes are parallel. */
struct limbs_planes limbs_planes_of(struct limbs_pair *pair)
{
    struct slab_limbs slab;
    const int n = pair->limbs;
    set_slab(pair, (struct slab_normal){0, 1}, &slab);
    subtract(n, slab.bounds.high, slab.bounds.low);
    subtract(n, slab.start, slab.bounds.low);
    const bool parallel = is_zero(n, slab.bounds.high);
    return (struct limbs_planes){
        .parallel = parallel,
        .shared = parallel && is_zero(n, slab.start) && is_zero(n, slab.slope)};
}

static void set_dot(int n, const struct limbs_vector *x, const struct limbs_vector *y,
                    uint64_t *out)
{
    WITH_LIMBS(n, dot_limbs, x, y, out);
}

/* out->offset includes the origins of the frames. */
static void set_products(struct limbs_pair *pair, const struct normal *normal,
                         struct limbs_products *out)
{
    const int n = pair->limbs;
    limbs_number origin;
    set_dot(n, normal->at[WORLD], &pair->offset, out->offset);
    scale_by(n, normal->factor[WORLD], out->offset);
    set_dot(n, normal->at[WORLD], &pair->drift, out->drift);
    scale_by(n, normal->factor[WORLD], out->drift);
    for (int f = 0; f < 2; f++) {
        for (int i = 0; i < pair->frame[f]->count; i++) {
            set_dot(n, normal->at[f], &pair->component[f][i], out->component[f][i]);
            scale_by(n, normal->factor[f], out->component[f][i]);
        }
        if (pair->origin[f].limbs == 0)
            continue;
        set_dot(n, normal->at[f], &pair->origin[f], origin);
        scale_by(n, normal->factor[f], origin);
        (f == 0 ? subtract : add)(n, out->offset, origin);
    }
}

bool limbs_products_of(struct limbs_pair *pair, struct slab_normal edges,
                       struct limbs_products *out)
{
    struct normal normal;
    if (!set_normal(pair, edges, &normal))
        return false;
    set_products(pair, &normal, out);
    return true;
}

void limbs_products_in_face(struct limbs_pair *pair, int f, int edge, struct limbs_products *out)
{
    struct normal normal = {.factor = {NULL}};
    set_normal_in_face(pair, f, edge, &normal);
    if (pair->common)
        normal.factor[0] = normal.factor[1] = pair->common;
    set_products(pair, &normal, out);
}

static void to_mpz(int n, uint64_t *x, mpz_t out)
{
    const bool negative = is_negative(n, x);
    limbs_number magnitude = {0};
    if (negative)
        subtract(n, magnitude, x);
    else
        memcpy(magnitude, x, (size_t) n * sizeof *x);
    mpz_import(out, (size_t) n, -1, sizeof *x, 0, 0, magnitude);
    if (negative)
        mpz_neg(out, out);
}

void limbs_slab(struct limbs_pair *pair, struct slab_normal normal, mpz_t low, mpz_t high,
                mpz_t start, mpz_t slope)
{
    struct slab_limbs slab;
    set_slab(pair, normal, &slab);
    to_mpz(pair->limbs, slab.bounds.low, low);
    to_mpz(pair->limbs, slab.bounds.high, high);
    to_mpz(pair->limbs, slab.start, start);
    to_mpz(pair->limbs, slab.slope, slope);
}
