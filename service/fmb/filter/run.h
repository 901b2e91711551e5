/* The filter over many pairs of one kind: prepared frames in, outcomes out, as many side by side as
 * the instruction set has lanes. run.c, and alone.c for pairs alone, are compiled once for each
 * set, and once more for the times of contact, whose bits are promised (Makefile, run_lanes.h). */
#ifndef FMB_RUN_H
#define FMB_RUN_H

#include "prepared.h"
#include "slabs.h"

#include <assert.h>
#include <stddef.h>

/* Kinds of pairs that the filter can be asked. Two frames of different shapes come with the cuboid
 * first, and with the face last. */
enum run_kind {
    RUN_TETRAHEDRON = 1 << 0, /* one is a tetrahedron: b, or with a face a */
    RUN_SAME_SHAPE = 1 << 1,  /* both are tetrahedra, or faces */
    RUN_SPACE = 1 << 2,
    RUN_DRIFTS = 1 << 3,       /* the velocities differ and the window is not empty */
    RUN_AXIS_ALIGNED = 1 << 4, /* 3D: edges or drift may be parallel to the same axis */
    RUN_FACE = 1 << 5,         /* b is a face */
    RUN_KINDS = 1 << 6,
    RUN_ODD = RUN_KINDS, /* doubles can say nothing of it */
    RUN_REFUSED          /* cannot be asked */
};

/* What the summaries of two frames say of their pair. Inline, as all that follows, for the inner
 * loop of a batch. */
struct run_kinds {
    enum run_kind at_rest, drifting; /* where the velocities are the same, and where they differ */
    bool swapped;                    /* a and b change places */
    bool moving;                     /* the velocities have to be looked at */
};

/* The bits of a frame that its pair takes over stand where they do there. */
static inline struct run_kinds run_kinds_of(unsigned kind_a, unsigned kind_b, double duration)
{
    const unsigned both = kind_a & kind_b, any = kind_a | kind_b;
    if (!(both & PREPARED_VALID) || ((kind_a ^ kind_b) & PREPARED_3D))
        return (struct run_kinds){RUN_REFUSED, RUN_REFUSED, false, false};
    if (!(both & PREPARED_USABLE))
        return (struct run_kinds){RUN_ODD, RUN_ODD, false, false};
    const unsigned shapes = PREPARED_TETRAHEDRON | PREPARED_FACE, space = both & PREPARED_3D;
    const unsigned alike = (both & PREPARED_TETRAHEDRON) << 1 | (both & PREPARED_FACE);
    const unsigned kind = (any & PREPARED_TETRAHEDRON) | alike | (any & PREPARED_FACE) << 4 | space;
    const unsigned along = space / PREPARED_3D * PREPARED_AXIS_ALIGNED;
    return (struct run_kinds){.at_rest = (enum run_kind)(kind | (both & along)),
                              .drifting = (enum run_kind)(kind | RUN_DRIFTS | (any & along)),
                              .swapped = (kind_a & shapes) > (kind_b & shapes),
                              .moving = any & PREPARED_MOVING && duration > 0};
}

static_assert((int) RUN_TETRAHEDRON == (int) PREPARED_TETRAHEDRON &&
                  (int) RUN_SAME_SHAPE == PREPARED_TETRAHEDRON << 1 &&
                  (int) RUN_SAME_SHAPE == (int) PREPARED_FACE &&
                  (int) RUN_FACE == PREPARED_FACE << 4 && (int) RUN_SPACE == (int) PREPARED_3D &&
                  (int) RUN_AXIS_ALIGNED == (int) PREPARED_AXIS_ALIGNED,
              "run_kinds_of() takes bits over as they are");

static inline bool run_drifts(const struct fmb_prepared *a, const struct fmb_prepared *b)
{
    const double *v = prepared_velocity(a), *w = prepared_velocity(b);
    return v[0] != w[0] || v[1] != w[1] || (prepared_kind(a) & PREPARED_3D && v[2] != w[2]);
}

static inline enum run_kind run_kind_of(const struct fmb_prepared *a, const struct fmb_prepared *b,
                                        double duration, bool *swapped)
{
    const struct run_kinds kinds = run_kinds_of(prepared_kind(a), prepared_kind(b), duration);
    *swapped = kinds.swapped;
    return kinds.moving && run_drifts(a, b) ? kinds.drifting : kinds.at_rest;
}

/* An order of two frames of one shape that does not depend on their places in a query: whether b
 * comes before a. Frames that are equal in all numbers are in order both ways. */
static inline bool run_is_turned(const struct fmb_prepared *a, const struct fmb_prepared *b)
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

/* The kind of a pair for its box: RUN_DRIFTS says that a frame moves, even if both move alike. The
 * kernels of boxes are not symmetric: frames of one shape are put in order. On input: frames that
 * may be compared. */
static inline enum run_kind run_box_kind(const struct fmb_prepared *a, const struct fmb_prepared *b,
                                         double duration, bool *swapped)
{
    const struct run_kinds kinds = run_kinds_of(prepared_kind(a), prepared_kind(b), duration);
    const unsigned shapes = PREPARED_TETRAHEDRON | PREPARED_FACE;
    const bool alike = ((prepared_kind(a) ^ prepared_kind(b)) & shapes) == 0;
    *swapped = alike ? run_is_turned(a, b) : kinds.swapped;
    return kinds.moving ? kinds.drifting : kinds.at_rest;
}

struct kernel_call {
    /* [count][a, b]. Up to RUN_LANES - 1 more are read, and have to be frames of some kind. */
    const struct fmb_prepared *(*pairs)[2];
    size_t count; /* at least 1 */
    double duration;
    /* What is written has room for RUN_LANES - 1 more; NULL where the function does not write it.
     * [count]: enum slabs_outcome. */
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

enum { RUN_LANES = 8 };

typedef void run_function(const struct kernel_call *run);

/* Tables have a function for each kind, NULL for combinations that do not exist. verdicts write
 * outcomes, of all kinds; times outcomes and contacts, of kinds that drift; boxes boxes, of all
 * kinds, where RUN_DRIFTS says that a frame moves.
 *
 * exact: the second pass, for pairs that another one leaves unsure. It decides all that verdicts
 * does, pairs that touch along coordinate axes, and those on whose numbers nothing rounds
 * (walk_exact.h). What it leaves unsure is the same with every instruction set. TOUCHING of two
 * faces: they are neither separated nor do they overlap unless their planes are parallel. */
struct run_set {
    run_function *const *verdicts, *const *exact, *const *times, *const *boxes;
};

/* By enum fmb_instructions; false if this machine does not have them, or they were not compiled. */
bool run_set_of(int instructions, struct run_set *out);

/* The same for a pair alone, of any instruction set. out: the contact, from times. */
typedef enum slabs_outcome run_single_function(const struct fmb_prepared *a,
                                               const struct fmb_prepared *b, double duration,
                                               double *out);

run_single_function *const *run_verdicts_single(void);
run_single_function *const *run_exact_single(void);
run_single_function *const *run_times_single(void);

/* Boxes of a pair alone: the kernels that take least time for it. */
run_function *const *run_boxes_single(void);

#endif
