/* The kernels of the filter: prepared frames in, outcomes, times of contact or boxes out. A kernel
 * decides pairs of one kind, as many side by side as its instruction set has lanes. Each job and
 * instruction set has a file (verdicts_avx2.c) that includes many.h (many pairs), single.h (one
 * pair) or boxes.h. Only the first pass uses fused operations: the bits of all other jobs are
 * promised. No function here has shared state. */
#ifndef FMB_KERNEL_H
#define FMB_KERNEL_H

#include "prepared.h"
#include "slabs.h"

#include <assert.h>
#include <stddef.h>

/* The kinds of pairs: sums of these bits, which are indices of the tables of kernels. Of two frames
 * of different shapes the cuboid comes first, and the face last. */
enum kernel_kind {
    KERNEL_TETRAHEDRON = 1 << 0, /* at least one frame is a tetrahedron: b, or a if b is a face */
    KERNEL_SAME_SHAPE = 1 << 1,  /* both are tetrahedra, or both are faces */
    KERNEL_3D = 1 << 2,
    KERNEL_DRIFTS = 1 << 3,       /* the velocities differ and the window is not empty */
    KERNEL_AXIS_ALIGNED = 1 << 4, /* 3D: edges or drift may be parallel to the same axis */
    KERNEL_FACE = 1 << 5,         /* b is a face */
    KERNEL_KINDS = 1 << 6,
    KERNEL_UNUSABLE = KERNEL_KINDS, /* slabs in doubles cannot decide the pair */
    KERNEL_REFUSED                  /* a frame is not valid, or the dimensions differ */
};

/* What the summaries of two frames (prepared.h) say about their pair. Inline, like all functions
 * below, for the inner loop of a batch. */
struct kernel_kinds {
    enum kernel_kind at_rest;  /* the kind if the velocities are equal */
    enum kernel_kind drifting; /* the kind if they differ */
    bool swapped;              /* a and b have to be swapped */
    bool moving;               /* the velocities have to be compared; else the kind is at_rest */
};

/* In: prepared_kind() of both frames, and the duration of the window in seconds. The bits that a
 * pair takes over from its frames are copied without a test of each: the assertion below checks
 * their positions. */
static inline struct kernel_kinds kernel_kinds_of(unsigned kind_a, unsigned kind_b, double duration)
{
    const unsigned both = kind_a & kind_b, any = kind_a | kind_b;
    if (!(both & PREPARED_VALID) || ((kind_a ^ kind_b) & PREPARED_3D))
        return (struct kernel_kinds){KERNEL_REFUSED, KERNEL_REFUSED, false, false};
    if (!(both & PREPARED_USABLE) || any & PREPARED_VERTICES)
        return (struct kernel_kinds){KERNEL_UNUSABLE, KERNEL_UNUSABLE, false, false};
    const unsigned shapes = PREPARED_TETRAHEDRON | PREPARED_FACE, space = both & PREPARED_3D;
    const unsigned same_shape = (both & PREPARED_TETRAHEDRON) << 1 | (both & PREPARED_FACE);
    const unsigned kind =
        (any & PREPARED_TETRAHEDRON) | same_shape | (any & PREPARED_FACE) << 4 | space;
    const unsigned aligned = space / PREPARED_3D * PREPARED_AXIS_ALIGNED;
    return (struct kernel_kinds){
        .at_rest = (enum kernel_kind)(kind | (both & aligned)),
        .drifting = (enum kernel_kind)(kind | KERNEL_DRIFTS | (any & aligned)),
        .swapped = (kind_a & shapes) > (kind_b & shapes),
        .moving = any & PREPARED_MOVING && duration > 0};
}

static_assert((int) KERNEL_TETRAHEDRON == (int) PREPARED_TETRAHEDRON &&
                  (int) KERNEL_SAME_SHAPE == PREPARED_TETRAHEDRON << 1 &&
                  (int) KERNEL_SAME_SHAPE == (int) PREPARED_FACE &&
                  (int) KERNEL_FACE == PREPARED_FACE << 4 && (int) KERNEL_3D == (int) PREPARED_3D &&
                  (int) KERNEL_AXIS_ALIGNED == (int) PREPARED_AXIS_ALIGNED,
              "kernel_kinds_of() copies bits");

/* Whether the velocities of two frames of one dimension differ. */
static inline bool kernel_pair_drifts(const struct fmb_prepared *a, const struct fmb_prepared *b)
{
    const double *v = prepared_velocity(a), *w = prepared_velocity(b);
    return v[0] != w[0] || v[1] != w[1] || (prepared_kind(a) & PREPARED_3D && v[2] != w[2]);
}

/* The kind of a pair for its verdict and times. *swapped: the kernel takes b first. */
static inline enum kernel_kind kernel_kind_of(const struct fmb_prepared *a,
                                              const struct fmb_prepared *b, double duration,
                                              bool *swapped)
{
    const struct kernel_kinds kinds = kernel_kinds_of(prepared_kind(a), prepared_kind(b), duration);
    *swapped = kinds.swapped;
    return kinds.moving && kernel_pair_drifts(a, b) ? kinds.drifting : kinds.at_rest;
}

/* kernel_kind_of() with each hull replaced by the cuboid that contains it, and each radius added to
 * the error of its frame. If the kernel separates these, the frames are separated. */
static inline enum kernel_kind kernel_kind_of_bounds(const struct fmb_prepared *a,
                                                     const struct fmb_prepared *b, double duration,
                                                     bool *swapped)
{
    const unsigned kind_a = prepared_kind(a) & ~(unsigned) PREPARED_VERTICES;
    const unsigned kind_b = prepared_kind(b) & ~(unsigned) PREPARED_VERTICES;
    const struct kernel_kinds kinds = kernel_kinds_of(kind_a, kind_b, duration);
    *swapped = kinds.swapped;
    return kinds.moving && kernel_pair_drifts(a, b) ? kinds.drifting : kinds.at_rest;
}

/* An order of two frames of one shape that does not depend on their positions in a query. Returns
 * whether b comes before a; false both ways for frames that are equal in all numbers. */
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

/* The kind of a pair for the kernel of its box. There KERNEL_DRIFTS means that a frame moves, even
 * if both have the same velocity. *swapped: the kernel takes b first. The kernels of boxes are not
 * swap-invariant: frames of one shape are put in the order of kernel_order_is_reversed(). On input,
 * the frames are valid and of one dimension. */
static inline enum kernel_kind kernel_box_kind(const struct fmb_prepared *a,
                                               const struct fmb_prepared *b, double duration,
                                               bool *swapped)
{
    const struct kernel_kinds kinds = kernel_kinds_of(prepared_kind(a), prepared_kind(b), duration);
    const unsigned shapes = PREPARED_TETRAHEDRON | PREPARED_FACE;
    const bool same_shape = ((prepared_kind(a) ^ prepared_kind(b)) & shapes) == 0;
    *swapped = same_shape ? kernel_order_is_reversed(a, b) : kinds.swapped;
    return kinds.moving ? kinds.drifting : kinds.at_rest;
}

/* A call of a kernel of many pairs. All memory belongs to the caller. Each output has capacity for
 * KERNEL_LANES - 1 more entries than count, and may be NULL if the kernel does not write it. */
struct kernel_call {
    /* [count][a, b]. Up to KERNEL_LANES - 1 more entries are read, and have to point to frames of
     * some kind. */
    const struct fmb_prepared *(*pairs)[2];
    size_t count;    /* at least 1 */
    double duration; /* of the window, in seconds */
    /* [count]: enum slabs_outcome. */
    unsigned char *outcomes;
    /* [count][first, last], of pairs in contact: seconds since the start of the window; NAN where
     * doubles do not prove the limit of fmb.h. */
    double (*contacts)[2];
    /* [count][lower, upper][axis], of pairs in contact; NAN where doubles do not prove the limit
     * of fmb.h. */
    double (*boxes)[2][FMB_DIM_MAX];
    /* [count][time, coordinates], of pairs in contact, or NULL. The time is NAN where doubles do
     * not prove the limits of fmb.h. */
    double (*points)[1 + FMB_DIM_MAX];
};

enum { KERNEL_LANES = 8 };

typedef void kernel_function(const struct kernel_call *call);

/* Writes the boxes of pairs in contact of a kind of kernel_box_kind(), and their points unless
 * points is NULL. */
typedef void kernel_box_function(const struct kernel_call *call, enum kernel_kind kind);

/* Kernels of a single pair, for its verdict. */
typedef enum slabs_outcome kernel_single_function(const struct fmb_prepared *a,
                                                  const struct fmb_prepared *b, double duration);

/* Tables of kernels, [KERNEL_KINDS], NULL for combinations of bits that do not exist.
 *
 *     verdicts  the first pass, of all kinds: writes outcomes
 *     second    the second pass, of all kinds: writes outcomes
 *     times     of the kinds that drift: writes outcomes and contacts
 *     single    the first pass for a single pair, of all kinds
 *
 * The second pass is for pairs that another kernel leaves unsure. It decides all that verdicts
 * decides, and in addition pairs that touch along coordinate axes, and pairs whose numbers do not
 * round (slabs_second.h). The pairs that it leaves unsure are the same on every instruction set.
 * TOUCHING of two faces means only that they are not separated, and do not overlap unless their
 * planes are parallel. */
struct kernel_set {
    kernel_function *const *verdicts, *const *second, *const *times;
    kernel_box_function *boxes;
    kernel_single_function *const *single;
};

/* Sets *out to the tables of an instruction set (enum instructions). Returns false if this
 * machine does not have it, or its kernels were not compiled. */
bool kernel_set_of(int instructions, struct kernel_set *out);

/* The tables of the best instruction set that this machine has. */
const struct kernel_set *kernel_set_best(void);

/* A call of a kernel of many pairs for one, which element 0 of each output is of. */
struct kernel_one {
    struct kernel_call call; /* to the arrays below: the struct is not copied */
    const struct fmb_prepared *pairs[KERNEL_LANES][2];
    unsigned char outcome[KERNEL_LANES];
    double contact[KERNEL_LANES][2], box[KERNEL_LANES][2][FMB_DIM_MAX];
    double point[KERNEL_LANES][1 + FMB_DIM_MAX];
};

/* Sets a call for one pair. In: a and b in the order that the kernel takes. */
static inline void kernel_set_one(const struct fmb_prepared *a, const struct fmb_prepared *b,
                                  double duration, struct kernel_one *out)
{
    for (int lane = 0; lane < KERNEL_LANES; lane++) {
        out->pairs[lane][0] = a;
        out->pairs[lane][1] = b;
    }
    out->call = (struct kernel_call){.pairs = out->pairs,
                                     .count = 1,
                                     .duration = duration,
                                     .outcomes = out->outcome,
                                     .contacts = out->contact,
                                     .boxes = out->box};
}

#endif
