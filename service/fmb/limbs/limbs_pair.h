/* A pair in integers of n limbs.
 *
 *   In     struct limbs_question
 *   Out    struct limbs_pair, from which limbs_slab.h computes slabs
 *
 * Steps (limbs_prepare()): offset and drift, add_place(); frames, set_frame(); the matrices between
 * the coordinate systems, set_same_turn() or set_turns().
 *
 * Coordinates. With q scaled to integers, n R(q) is a matrix of integers, n = |q|^2. Components and
 * origins stay in the coordinates of their frame; positions and displacements stay in those of the
 * world. All are integers times the unit of the pair. The normal of a slab is computed three times:
 * in the coordinates of A, of B and of the world. Each time it is multiplied by a positive factor,
 * which differs. The extents of A and of B are taken along the first two normals, the offset and
 * the drift along the third. Let M_f = n_f R_f, n = n_a n_b, and let K_f = M_g^T M_f map from f to
 * the other frame g. Each normal is followed by its factor:
 *
 *     normal of                 in f               in g                   in the world
 *     edges u of f, v of g      u x K_g v    n     K_f u x v          n   M_f u x M_g v  n
 *     face u x v of f           u x v        1     K_f (u x v)        n   M_f (u x v)    n_f
 *     edge u of f, the drift h  u x M_f^T h  n_f   M_g^T (M_f u x h)  n   M_f u x h      n_f
 *
 * Each result is multiplied by n over its factor, so that the numbers of a slab are n times those
 * of the pair. In 2D a normal is an edge rotated by a right angle. That of an edge of f is treated
 * as the face of f; that of the drift has the factor 1 in the world and n_f in f.
 *
 * Frames of equal orientation are decided in their own coordinates, in which neither is rotated.
 * Offset and drift are M^T d and M^T h, n times their values, and extents are multiplied by n. The
 * numbers of a slab are n times those of the pair, or n^2 times if the drift is in its normal.
 *
 * Only the direction of an edge matters. The edges of a box are unit vectors in its coordinates, or
 * 0 on an axis of size 0. A box is described by its centre and half its components. */
#ifndef FMB_LIMBS_PAIR_H
#define FMB_LIMBS_PAIR_H

#include "limbs_rotation.h"
#include "slabs.h"

#include <math.h>

/* The coordinates of an edge: those of its frame, of the other frame, and of the world. */
enum limbs_view { LIMBS_OWN, LIMBS_ACROSS, LIMBS_WORLD, LIMBS_VIEWS };

/* A pair. Lengths are integers times 2^unit of its span. Contains pointers into itself: must not be
 * copied. */
struct limbs_pair {
    struct kernel_traits traits; /* dimension and shapes of both frames; .box is set */
    const struct fmb_frame *frame[2];
    int limbs; /* of a number */
    /* For a box: half of its components, and its centre as the origin. */
    struct limbs_vector component[2][FMB_DIM_MAX], origin[2];
    struct limbs_vector offset, drift; /* of the positions */
    /* Matrices by rows, NULL for the identity: from a frame to the world and back, and to the other
     * frame. */
    const struct limbs_vector *to_world[2], *from_world[2], *across[2];
    const struct limbs_factor *norm[2], *all; /* factors of these matrices; NULL: 1 */
    const struct limbs_factor *common;        /* of equal orientations; otherwise NULL */
    struct limbs_rotation rotation[2], relative;
    /* Edges, computed when they are needed, and their storage. */
    const struct limbs_vector *view[2][SLABS_EDGES][LIMBS_VIEWS];
    struct limbs_vector storage[2][SLABS_EDGES][LIMBS_VIEWS];
};

/* The scale of all lengths of a pair. */
struct scale {
    struct dyadic window;
    long unit;
    double inverse; /* 2^-unit; 0 if a length may need more than one limb */
};

/* out := x 2^-unit, in n limbs; returns how many it needs. If inverse is not 0, the product is
 * exact, since it is below 2^62, and so is its conversion. */
LIMBS_FUNCTION int set_length(int n, uint64_t *out, double x, const struct scale *scale)
{
    static const struct dyadic one = {1, 0};
    if (scale->inverse == 0) {
        limbs_set_product(n, out, dyadic_of(x), one, scale->unit);
        return limbs_needed(n, out);
    }
    const int64_t whole = (int64_t) (x * scale->inverse);
    out[0] = (uint64_t) whole;
    for (int i = 1; i < n; i++)
        out[i] = whole < 0 ? UINT64_MAX : 0;
    return whole != 0;
}

LIMBS_FUNCTION void set_lengths(int n, struct limbs_vector *out, const double x[FMB_DIM_MAX],
                                const struct scale *scale)
{
    out->limbs = 0;
    out->other_than_0 = 0;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        const int limbs = set_length(n, out->at[axis], x[axis], scale);
        out->limbs = limbs > out->limbs ? limbs : out->limbs;
        out->other_than_0 |= (unsigned) (limbs > 0) << axis;
    }
}

/* ---- Pairs ---- */

/* Adds the position and velocity of a frame to offset and drift, or subtracts them. */
LIMBS_FUNCTION void add_place(const struct placed_frame *placed, bool minus,
                              const struct scale *scale, struct limbs_pair *out)
{
    const int n = out->limbs;
    const struct fmb_placement *placement = placed->placement;
    limbs_number term;
    for (int axis = 0; axis < placed->frame->dim; axis++) {
        set_length(n, term, placement->position[axis], scale);
        (minus ? subtract : add)(n, out->offset.at[axis], term);
        if (placement->velocity[axis] == 0)
            continue;
        limbs_set_product(n, term, dyadic_of(placement->velocity[axis]), scale->window,
                          scale->unit);
        (minus ? subtract : add)(n, out->drift.at[axis], term);
    }
}

/* For a box: half of its components, and its centre as the origin. */
LIMBS_FUNCTION void set_frame(int f, const struct fmb_frame *frame, const struct scale *scale,
                              struct limbs_pair *out)
{
    const int n = out->limbs;
    const bool box = frame->shape == FMB_BOX;
    const struct scale half = {scale->window, scale->unit + 1, scale->inverse / 2};
    limbs_number term;
    out->frame[f] = frame;
    set_lengths(n, &out->origin[f], box ? frame->centre : frame->origin, scale);
    for (int i = 0; i < frame->count; i++) {
        struct limbs_vector *component = &out->component[f][i];
        set_lengths(n, component, frame->component[i], box ? &half : scale);
        if (!frame->rounded)
            continue;
        for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
            set_length(n, term, frame->remainder[i][axis], scale);
            add(n, component->at[axis], term);
        }
        limbs_trim(n, component);
    }
}

/* In: offset and drift in world coordinates. */
LIMBS_FUNCTION void set_same_turn(const struct limbs_quaternion *q, struct limbs_pair *out)
{
    const int n = out->limbs;
    struct limbs_rotation *rotation = &out->rotation[0];
    const struct limbs_vector offset = out->offset, drift = out->drift;
    limbs_set_rotation(n, q, rotation);
    limbs_transform(n, rotation->row[1], &offset, &out->offset);
    limbs_transform(n, rotation->row[1], &drift, &out->drift);
    limbs_trim(n, &out->offset);
    limbs_trim(n, &out->drift);
    out->common = &rotation->norm;
}

LIMBS_FUNCTION void set_turns(const struct limbs_quaternion q[2], struct limbs_pair *out)
{
    struct limbs_rotation *rotation = out->rotation;
    for (int f = 0; f < 2; f++) {
        if (!q[f].turned)
            continue;
        limbs_set_rotation(out->limbs, &q[f], &rotation[f]);
        out->to_world[f] = out->across[f] = rotation[f].row[0];
        out->from_world[f] = out->across[!f] = rotation[f].row[1];
        out->norm[f] = out->all = &rotation[f].norm;
    }
    if (!q[0].turned || !q[1].turned)
        return;
    limbs_set_relative(out->limbs, &rotation[0], &rotation[1], &out->relative);
    out->across[1] = out->relative.row[0];
    out->across[0] = out->relative.row[1];
    out->all = &out->relative.norm;
}

LIMBS_FUNCTION struct kernel_traits traits_of_frames(const struct frame_pair *pair)
{
    const struct fmb_frame *a = pair->a.frame, *b = pair->b.frame;
    return (struct kernel_traits){.dim = a->dim,
                                  .simplex = {frame_is_simplex(a), frame_is_simplex(b)},
                                  .face = {a->shape == FMB_FACE, b->shape == FMB_FACE},
                                  .drifts = pair->duration > 0 && pair_moves(pair),
                                  .box = true};
}

LIMBS_FUNCTION void limbs_prepare(const struct limbs_question *question, struct limbs_pair *out)
{
    const struct frame_pair *pair = question->pair;
    const struct placed_frame *placed[2] = {&pair->a, &pair->b};
    const struct dyadic_span span = question->span;
    const struct limbs_quaternion *q = question->q;
    const bool one = span.top - span.unit <= 61 && span.unit >= -1000 && span.unit <= 1000;
    const struct scale scale = {dyadic_of(pair->duration), span.unit,
                                one ? ldexp(1, (int) -span.unit) : 0};
    out->traits = traits_of_frames(pair);
    out->limbs = question->limbs;
    out->common = out->all = out->norm[0] = out->norm[1] = NULL;
    memset(out->to_world, 0, sizeof out->to_world);
    memset(out->from_world, 0, sizeof out->from_world);
    memset(out->across, 0, sizeof out->across);
    memset(out->view, 0, sizeof out->view);
    memset(&out->offset, 0, sizeof out->offset);
    memset(&out->drift, 0, sizeof out->drift);
    for (int f = 0; f < 2; f++) {
        add_place(placed[f], f == 0, &scale, out);
        set_frame(f, placed[f]->frame, &scale, out);
    }
    limbs_trim(out->limbs, &out->offset);
    limbs_trim(out->limbs, &out->drift);
    if (question->same && q[0].turned)
        set_same_turn(&q[0], out);
    else
        set_turns(q, out);
}

#endif
