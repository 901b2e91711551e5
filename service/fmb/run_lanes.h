/* What run.c and alone.c have in common: prepared frames into lanes, and what a walk found into
 * outcomes and times; and the table of functions, one for each kind of pair, that each of them
 * makes. RUN_NAME names the table; RUN_TIMES: outcomes with the times of contact; RUN_BOXES: boxes,
 * of pairs at rest; the bits of both are promised. RUN_ALONE: one pair, in all lanes. */
#ifndef FMB_RUN_LANES_H
#define FMB_RUN_LANES_H

#include "run.h"
#include "walk.h"
#include "walk_box.h"

#ifdef RUN_TIMES
enum { TIMES = 1, ORDERED = 1 };
#else
enum { TIMES = 0, ORDERED = 0 };
#endif

/* ---- The gather: words[w] holds word w of LANES frames ---- */

enum { WORDS = sizeof(struct fmb_prepared) / sizeof(double) };

#if LANES == 1 || defined(RUN_ALONE)

enum { GATHERED = 1 }; /* frames */

INLINE void gather_four(const double *const frame[LANES], int first, lanes *words)
{
    UNROLL(4)
    for (int w = 0; w < 4; w++)
        words[w] = lanes_of(frame[0][first + w]);
}

#elif LANES == 2

enum { GATHERED = 2 };

INLINE lanes two_at(const double *from)
{
    lanes out;
    memcpy(&out, from, sizeof out);
    return out;
}

INLINE void gather_four(const double *const frame[LANES], int first, lanes *words)
{
    UNROLL(2)
    for (int w = 0; w < 4; w += 2) {
        const lanes x = two_at(frame[0] + first + w), y = two_at(frame[1] + first + w);
        words[w] = __builtin_shufflevector(x, y, 0, 2);
        words[w + 1] = __builtin_shufflevector(x, y, 1, 3);
    }
}

#else

enum { GATHERED = LANES };

typedef double four __attribute__((vector_size(32)));

INLINE four four_at(const double *from)
{
    four out;
    memcpy(&out, from, sizeof out);
    return out;
}

/* The transpose of a square. */
INLINE void transpose(const double *const frame[4], int first, four out[4])
{
    const four x = four_at(frame[0] + first), y = four_at(frame[1] + first);
    const four z = four_at(frame[2] + first), w = four_at(frame[3] + first);
    const four xy_even = __builtin_shufflevector(x, y, 0, 4, 2, 6);
    const four xy_odd = __builtin_shufflevector(x, y, 1, 5, 3, 7);
    const four zw_even = __builtin_shufflevector(z, w, 0, 4, 2, 6);
    const four zw_odd = __builtin_shufflevector(z, w, 1, 5, 3, 7);
    out[0] = __builtin_shufflevector(xy_even, zw_even, 0, 1, 4, 5);
    out[1] = __builtin_shufflevector(xy_odd, zw_odd, 0, 1, 4, 5);
    out[2] = __builtin_shufflevector(xy_even, zw_even, 2, 3, 6, 7);
    out[3] = __builtin_shufflevector(xy_odd, zw_odd, 2, 3, 6, 7);
}

INLINE void gather_four(const double *const frame[LANES], int first, lanes *words)
{
#if LANES == 4
    transpose(frame, first, (four *) words);
#else
    four low[4], high[4];
    transpose(frame, first, low);
    transpose(frame + 4, first, high);
    UNROLL(4)
    for (int w = 0; w < 4; w++)
        words[w] = __builtin_shufflevector(low[w], high[w], 0, 1, 2, 3, 4, 5, 6, 7);
#endif
}

#endif

/* A frame of each lane. */
struct run_frame {
    lanes origin[3], component[3][3], size[3], velocity[3]; /* 2D: the first two of each */
    lanes error;
};

INLINE void set_run_frame(const struct walk_kind kind, const lanes words[WORDS],
                          struct run_frame *out)
{
    const lanes_bits head = lanes_as_bits(words[0]);
    out->origin[2] = lanes_of(0);
    UNROLL(3)
    for (int axis = 0; axis < kind.dim; axis++) {
        out->origin[axis] = words[1 + axis];
        out->size[axis] =
            lanes_from_bits((head << (48 - PREPARED_SIZE_BITS * axis)) & 0xffff000000000000);
        UNROLL(3)
        for (int i = 0; i < kind.dim; i++)
            out->component[i][axis] = words[1 + kind.dim * (1 + i) + axis];
    }
    out->error = words[kind.dim == 2 ? PREPARED_ERROR_2D : PREPARED_ERROR_3D];
}

/* A word by itself. */
INLINE lanes gather_one(const double *const frame[LANES], int word)
{
#if LANES == 1 || defined(RUN_ALONE)
    return lanes_of(frame[0][word]);
#elif LANES == 2
    return (lanes){frame[0][word], frame[1][word]};
#elif LANES == 4
    return (lanes){frame[0][word], frame[1][word], frame[2][word], frame[3][word]};
#else
    return (lanes){frame[0][word], frame[1][word], frame[2][word], frame[3][word],
                   frame[4][word], frame[5][word], frame[6][word], frame[7][word]};
#endif
}

/* Of head, origin, components and error. */
INLINE int word_count(const struct walk_kind kind)
{
    return 1 + (kind.dim == 2 ? PREPARED_ERROR_2D : PREPARED_ERROR_3D);
}

/* Velocities are in the placements, where more numbers follow. */
INLINE void gather_velocity(const double *const frame[LANES], struct run_frame *out)
{
    const double *velocity[LANES];
    lanes words[4];
    UNROLL(8)
    for (int lane = 0; lane < GATHERED; lane++)
        velocity[lane] = prepared_velocity((const struct fmb_prepared *) frame[lane]);
    gather_four(velocity, 0, words);
    UNROLL(3)
    for (int axis = 0; axis < 3; axis++)
        out->velocity[axis] = words[axis];
}

INLINE void gather(const struct walk_kind kind, const double *const frame[LANES],
                   struct run_frame *out)
{
    lanes words[WORDS];
    const int used = word_count(kind);
    const int in_fours = used - used % 4 + (used % 4 > 1 ? 4 : 0);
    UNROLL(4)
    for (int w = 0; w < in_fours; w += 4)
        gather_four(frame, w, &words[w]);
    if (in_fours < used)
        words[used - 1] = gather_one(frame, used - 1);
    set_run_frame(kind, words, out);
    if (kind.drifts)
        gather_velocity(frame, out);
}

INLINE void set_pair(const struct walk_kind kind, const struct run_frame *a,
                     const struct run_frame *b, double duration, struct walk_pair *out)
{
    lanes component[2][3][3], size[2][3], offset[3], drift[3];
    UNROLL(3)
    for (int axis = 0; axis < kind.dim; axis++) {
        offset[axis] = b->origin[axis] - a->origin[axis];
        if (kind.drifts)
            drift[axis] = (b->velocity[axis] - a->velocity[axis]) * duration;
        size[0][axis] = a->size[axis];
        size[1][axis] = b->size[axis];
        UNROLL(3)
        for (int i = 0; i < kind.dim; i++) {
            component[0][i][axis] = a->component[i][axis];
            component[1][i][axis] = b->component[i][axis];
        }
    }
    walk_pair_set(kind, component, size, offset, drift, a->error + b->error, out);
}

INLINE void walk_pair_of(const struct walk_kind kind, const struct walk_pair *pair,
                         struct walk_found *found)
{
    walk_begin(found);
#if LANES == 1
    found->next = NULL;
#endif
    walk(pair, kind, found);
}

/* ---- Outcomes ---- */

/* Bit i of each: lane i. Lanes of neither are unsure. */
struct outcomes {
    unsigned separated, overlapping;
};

INLINE struct outcomes outcomes_of(const struct walk_pair *pair, const struct walk_found *found)
{
    const lanes_mask separated = pair->in_range & (found->surely > 0);
    const lanes_mask overlapping = pair->in_range & (found->possibly < 0) & (found->surely <= 0);
    return (struct outcomes){lanes_mask_bits(separated), lanes_mask_bits(overlapping)};
}

INLINE enum slabs_outcome outcome_at(struct outcomes outcomes, int lane)
{
    return (enum slabs_outcome)((outcomes.separated >> lane & 1) * SLABS_SEPARATED +
                                (outcomes.overlapping >> lane & 1) * SLABS_OVERLAPPING);
}

/* To bytes. */
INLINE void put_outcomes(struct outcomes outcomes, unsigned char out[LANES])
{
#if LANES >= 4 && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    UNROLL(2)
    for (int lane = 0; lane < LANES; lane += 4) { /* bits 0 to 3 of a number to its four bytes */
        const uint32_t separated = (outcomes.separated >> lane & 15) * 0x00204081 & 0x01010101;
        const uint32_t overlapping = (outcomes.overlapping >> lane & 15) * 0x00204081 & 0x01010101;
        const uint32_t bytes = separated * SLABS_SEPARATED + overlapping * SLABS_OVERLAPPING;
        memcpy(out + lane, &bytes, sizeof bytes);
    }
#else
    for (int lane = 0; lane < LANES; lane++)
        out[lane] = (unsigned char) outcome_at(outcomes, lane);
#endif
}

/* Seconds: below this a product with a time may underflow. */
#define LEAST_DURATION 0x1p-900

/* Between outer and inner ends, of a window of length 2: leaves a tenth of 1e-12 of it to what is
 * rounded after. */
#define TIMES_LIMIT 1.8e-12

/* From outer and inner ends, in [-1, 1], to seconds; NAN where they are too far apart. Quotients,
 * slack and this are rounded a few times, each by less than 2^-52 where it matters, within [-1, 1]:
 * 2^-49 covers all. The product with the duration rounds once more. */
INLINE void times_of(const struct walk_pair *pair, const struct walk_found *found, double window,
                     lanes times[2])
{
    const lanes slack = lanes_of(0x1p-49), one = lanes_of(1), duration = lanes_of(window);
    const lanes enter = lanes_greatest(found->enter[0] - slack, -one);
    const lanes leave = lanes_least(found->leave[0] + slack, one);
    const lanes enter_inner = lanes_greatest(found->enter[1] + slack, -one);
    const lanes leave_inner = lanes_least(found->leave[1] - slack, one);
    const lanes first = (0.5 + 0.5 * enter) * duration * (1 - 0x1p-51);
    const lanes last = lanes_least((0.5 + 0.5 * leave) * duration * (1 + 0x1p-51), duration);
    const lanes_mask good = pair->in_range & (enter_inner - enter <= TIMES_LIMIT) &
                            (leave - leave_inner <= TIMES_LIMIT) & (duration >= LEAST_DURATION);
    times[0] = lanes_choose(good, first, lanes_of(NAN));
    times[1] = lanes_choose(good, last, lanes_of(NAN));
}

/* NAN where doubles do not give it within its limit, and in axes that are not there. */
INLINE void boxes_of(const struct walk_kind kind, const struct walk_pair *pair,
                     const struct run_frame *a, const struct run_frame *b, lanes box[2][3])
{
    lanes origin[2][3];
    UNROLL(3)
    for (int axis = 0; axis < 3; axis++) {
        origin[0][axis] = a->origin[axis];
        origin[1][axis] = b->origin[axis];
    }
    const lanes_mask good = walk_box(pair, kind, origin, box);
    UNROLL(2)
    for (int end = 0; end < 2; end++)
        UNROLL(3)
    for (int axis = 0; axis < 3; axis++)
        box[end][axis] =
            axis < kind.dim ? lanes_choose(good, box[end][axis], lanes_of(NAN)) : lanes_of(0);
}

/* ---- The table ----
 *
 * FUNCTION(name, kind) defines a function for a struct walk_kind. */

enum run_shape { RUN_C, RUN_T, RUN_F }; /* cuboid, tetrahedron, face */

#define RUN_KIND(FUNCTION, name, dimension, a, b, drift, parallel)          \
    FUNCTION(name, ((struct walk_kind){.dim = dimension,                    \
                                       .simplex = {a != RUN_C, b != RUN_C}, \
                                       .face = {a == RUN_F, b == RUN_F},    \
                                       .drifts = drift,                     \
                                       .along = parallel,                   \
                                       .ordered = ORDERED,                  \
                                       .times = TIMES}))
#define RUN_SOLIDS(FUNCTION, name, dimension, drift, parallel)              \
    RUN_KIND(FUNCTION, name##_cc, dimension, RUN_C, RUN_C, drift, parallel) \
    RUN_KIND(FUNCTION, name##_ct, dimension, RUN_C, RUN_T, drift, parallel) \
    RUN_KIND(FUNCTION, name##_tt, dimension, RUN_T, RUN_T, drift, parallel)
/* Of faces, which are often parallel to something, one function for both. */
#define RUN_FACES(FUNCTION, name, drift)                     \
    RUN_KIND(FUNCTION, name##_cf, 3, RUN_C, RUN_F, drift, 1) \
    RUN_KIND(FUNCTION, name##_tf, 3, RUN_T, RUN_F, drift, 1) \
    RUN_KIND(FUNCTION, name##_ff, 3, RUN_F, RUN_F, drift, 1)
#define RUN_DRIFTING(FUNCTION)                        \
    RUN_SOLIDS(FUNCTION, plane_drifts, 2, 1, 0)       \
    RUN_SOLIDS(FUNCTION, space_drifts, 3, 1, 0)       \
    RUN_SOLIDS(FUNCTION, space_drifts_along, 3, 1, 1) \
    RUN_FACES(FUNCTION, space_drifts, 1)
#define RUN_AT_REST(FUNCTION)                  \
    RUN_SOLIDS(FUNCTION, plane, 2, 0, 0)       \
    RUN_SOLIDS(FUNCTION, space, 3, 0, 0)       \
    RUN_SOLIDS(FUNCTION, space_along, 3, 0, 1) \
    RUN_FACES(FUNCTION, space, 0)

#define RUN_SOLID_ENTRIES(name, kind)                           \
    [kind] = name##_cc, [(kind) + RUN_TETRAHEDRON] = name##_ct, \
    [(kind) + RUN_TETRAHEDRON + RUN_ALIKE] = name##_tt
#define RUN_FACE_ENTRIES(name, kind)                                                    \
    [(kind) + RUN_FACE] = name##_cf, [(kind) + RUN_FACE + RUN_TETRAHEDRON] = name##_tf, \
              [(kind) + RUN_FACE + RUN_ALIKE] = name##_ff
#define RUN_DRIFTING_ENTRIES                                                       \
    RUN_SOLID_ENTRIES(plane_drifts, RUN_DRIFTS),                                   \
        RUN_SOLID_ENTRIES(space_drifts, RUN_SPACE + RUN_DRIFTS),                   \
        RUN_SOLID_ENTRIES(space_drifts_along, RUN_SPACE + RUN_DRIFTS + RUN_ALONG), \
        RUN_FACE_ENTRIES(space_drifts, RUN_SPACE + RUN_DRIFTS),                    \
        RUN_FACE_ENTRIES(space_drifts, RUN_SPACE + RUN_DRIFTS + RUN_ALONG)
#define RUN_AT_REST_ENTRIES                                                                        \
    RUN_SOLID_ENTRIES(plane, 0), RUN_SOLID_ENTRIES(space, RUN_SPACE),                              \
        RUN_SOLID_ENTRIES(space_along, RUN_SPACE + RUN_ALONG), RUN_FACE_ENTRIES(space, RUN_SPACE), \
        RUN_FACE_ENTRIES(space, RUN_SPACE + RUN_ALONG)

#if defined(RUN_TIMES)
#define RUN_FUNCTIONS(FUNCTION) RUN_DRIFTING(FUNCTION)
#define RUN_TABLE            \
    {                        \
        RUN_DRIFTING_ENTRIES \
    }
#elif defined(RUN_BOXES) /* of solid frames; normals that are zero do not matter */
#define RUN_FUNCTIONS(FUNCTION)          \
    RUN_SOLIDS(FUNCTION, plane, 2, 0, 0) \
    RUN_SOLIDS(FUNCTION, space, 3, 0, 0)
#define RUN_TABLE                                                         \
    {                                                                     \
        RUN_SOLID_ENTRIES(plane, 0), RUN_SOLID_ENTRIES(space, RUN_SPACE), \
            RUN_SOLID_ENTRIES(space, RUN_SPACE + RUN_ALONG)               \
    }
#else
#define RUN_FUNCTIONS(FUNCTION) RUN_AT_REST(FUNCTION) RUN_DRIFTING(FUNCTION)
#define RUN_TABLE                                 \
    {                                             \
        RUN_AT_REST_ENTRIES, RUN_DRIFTING_ENTRIES \
    }
#endif

#define RUN_PASTE_(x, y) x##_##y
#define RUN_PASTE(x, y) RUN_PASTE_(x, y)

#endif
