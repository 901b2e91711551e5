/* The filter over many pairs of one kind: prepared frames in, outcomes out, as many side by side as
 * the instruction set has lanes. many.c, and single.c for pairs alone, are compiled once for each
 * set, and once more for the times of contact, whose bits are promised (Makefile, kernel_lanes.h).
 */
#ifndef FMB_KERNEL_H
#define FMB_KERNEL_H

#include "prepared.h"
#include "slabs.h"

#include <assert.h>
#include <stddef.h>

/* Kinds of pairs that the filter can be asked. Two frames of different shapes come with the cuboid
 * first, and with the face last. */
enum kernel_kind {
    KERNEL_TETRAHEDRON = 1 << 0, /* one is a tetrahedron: b, or with a face a */
    KERNEL_SAME_SHAPE = 1 << 1,  /* both are tetrahedra, or faces */
    KERNEL_3D = 1 << 2,
    KERNEL_DRIFTS = 1 << 3,       /* the velocities differ and the window is not empty */
    KERNEL_AXIS_ALIGNED = 1 << 4, /* 3D: edges or drift may be parallel to the same axis */
    KERNEL_FACE = 1 << 5,         /* b is a face */
    KERNEL_KINDS = 1 << 6,
    KERNEL_UNUSABLE = KERNEL_KINDS, /* doubles can say nothing of it */
    KERNEL_REFUSED                  /* cannot be asked */
};

/* What the summaries of two frames say of their pair. Inline, as all that follows, for the inner
 * loop of a batch. */
struct kernel_kinds {
    enum kernel_kind at_rest,
        drifting; /* where the velocities are the same, and where they differ */
    bool swapped; /* a and b change places */
    bool moving;  /* the velocities have to be looked at */
};

/* The bits of a frame that its pair takes over stand where they do there. */
static inline struct kernel_kinds kernel_kinds_of(unsigned kind_a, unsigned kind_b, double duration)
{
    const unsigned both = kind_a & kind_b, any = kind_a | kind_b;
    if (!(both & PREPARED_VALID) || ((kind_a ^ kind_b) & PREPARED_3D))
        return (struct kernel_kinds){KERNEL_REFUSED, KERNEL_REFUSED, false, false};
    if (!(both & PREPARED_USABLE))
        return (struct kernel_kinds){KERNEL_UNUSABLE, KERNEL_UNUSABLE, false, false};
    const unsigned shapes = PREPARED_TETRAHEDRON | PREPARED_FACE, space = both & PREPARED_3D;
    const unsigned alike = (both & PREPARED_TETRAHEDRON) << 1 | (both & PREPARED_FACE);
    const unsigned kind = (any & PREPARED_TETRAHEDRON) | alike | (any & PREPARED_FACE) << 4 | space;
    const unsigned along = space / PREPARED_3D * PREPARED_AXIS_ALIGNED;
    return (struct kernel_kinds){
        .at_rest = (enum kernel_kind)(kind | (both & along)),
        .drifting = (enum kernel_kind)(kind | KERNEL_DRIFTS | (any & along)),
        .swapped = (kind_a & shapes) > (kind_b & shapes),
        .moving = any & PREPARED_MOVING && duration > 0};
}

static_assert((int) KERNEL_TETRAHEDRON == (int) PREPARED_TETRAHEDRON &&
                  (int) KERNEL_SAME_SHAPE == PREPARED_TETRAHEDRON << 1 &&
                  (int) KERNEL_SAME_SHAPE == (int) PREPARED_FACE &&
                  (int) KERNEL_FACE == PREPARED_FACE << 4 && (int) KERNEL_3D == (int) PREPARED_3D &&
                  (int) KERNEL_AXIS_ALIGNED == (int) PREPARED_AXIS_ALIGNED,
              "kernel_kinds_of() takes bits over as they are");

static inline bool kernel_pair_drifts(const struct fmb_prepared *a, const struct fmb_prepared *b)
{
    const double *v = prepared_velocity(a), *w = prepared_velocity(b);
    return v[0] != w[0] || v[1] != w[1] || (prepared_kind(a) & PREPARED_3D && v[2] != w[2]);
}

static inline enum kernel_kind kernel_kind_of(const struct fmb_prepared *a,
                                              const struct fmb_prepared *b, double duration,
                                              bool *swapped)
{
    const struct kernel_kinds kinds = kernel_kinds_of(prepared_kind(a), prepared_kind(b), duration);
    *swapped = kinds.swapped;
    return kinds.moving && kernel_pair_drifts(a, b) ? kinds.drifting : kinds.at_rest;
}

/* An order of two frames of one shape that does not depend on their places in a query: whether b
 * comes before a. Frames that are equal in all numbers are in order both ways. */
static inline bool kernel_order_is_reversed(const struct fmb_prepared *a,
                                            const struct fmb_prepared *b)
{
    if (a->summary != b->summary)
        return b->summary < a->summary;
    for (int i = 0; i < PREPARED_ERROR_3D; i++)
        if (a->number[i] != b->number[i])
            return b->number[i] < a->number[i];
    const double *v = prepared_velocity(a), *w = prepared_velocity(b);
    for (int axis = 0; axis < (prepared_kind(a) & PREPARED_3D ? 3 : 2); axis++)
        if (v[axis] != w[axis])
            return w[axis] < v[axis];
    return false;
}

/* The kind of a pair for its box: KERNEL_DRIFTS says that a frame moves, even if both move alike.
 * The kernels of boxes are not symmetric: frames of one shape are put in order. On input: frames
 * that may be compared. */
static inline enum kernel_kind kernel_box_kind(const struct fmb_prepared *a,
                                               const struct fmb_prepared *b, double duration,
                                               bool *swapped)
{
    const struct kernel_kinds kinds = kernel_kinds_of(prepared_kind(a), prepared_kind(b), duration);
    const unsigned shapes = PREPARED_TETRAHEDRON | PREPARED_FACE;
    const bool alike = ((prepared_kind(a) ^ prepared_kind(b)) & shapes) == 0;
    *swapped = alike ? kernel_order_is_reversed(a, b) : kinds.swapped;
    return kinds.moving ? kinds.drifting : kinds.at_rest;
}

struct kernel_call {
    /* [count][a, b]. Up to KERNEL_LANES - 1 more are read, and have to be frames of some kind. */
    const struct fmb_prepared *(*pairs)[2];
    size_t count; /* at least 1 */
    double duration;
    /* What is written has room for KERNEL_LANES - 1 more; NULL where the function does not write
     * it. [count]: enum slabs_outcome. */
    unsigned char *outcomes;
    /* [count][first, last], of pairs in contact: seconds; NAN where they are not known well enough.
     */
    double (*contacts)[2];
    /* [count][lower, upper][axis], of pairs in contact; NAN where they are not known well enough.
     */
    double (*boxes)[2][FMB_DIM_MAX];
    /* For boxes: the frames of every pair are in contact as they are prepared, as is certain where
     * the filter decides so. Gives more boxes of frames with an error. */
    bool in_contact;
};

enum { KERNEL_LANES = 8 };

typedef void kernel_function(const struct kernel_call *run);

/* Tables have a function for each kind, NULL for combinations that do not exist. verdicts write
 * outcomes, of all kinds; times outcomes and contacts, of kinds that drift; boxes boxes, of all
 * kinds, where KERNEL_DRIFTS says that a frame moves.
 *
 * exact: the second pass, for pairs that another one leaves unsure. It decides all that verdicts
 * does, pairs that touch along coordinate axes, and those on whose numbers nothing rounds
 * (slabs_exact.h). What it leaves unsure is the same with every instruction set. TOUCHING of two
 * faces: they are neither separated nor do they overlap unless their planes are parallel. */
struct kernel_set {
    kernel_function *const *verdicts, *const *exact, *const *times, *const *boxes;
};

/* By enum fmb_instructions; false if this machine does not have them, or they were not compiled. */
bool kernel_set_of(int instructions, struct kernel_set *out);

/* The same for a pair alone, of any instruction set. out: the contact, from times. */
typedef enum slabs_outcome kernel_single_function(const struct fmb_prepared *a,
                                                  const struct fmb_prepared *b, double duration,
                                                  double *out);

kernel_single_function *const *kernel_verdicts_single(void);
kernel_single_function *const *kernel_exact_single(void);
kernel_single_function *const *kernel_times_single(void);

/* Boxes of a pair alone: the kernels that take least time for it. */
kernel_function *const *kernel_boxes_single(void);

#endif
