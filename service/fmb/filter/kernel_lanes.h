/* A kernel of the filter: what many.h (many pairs) and single.h (a single pair) share.
 *
 *   In     prepared frames (prepared.h), read as arrays of doubles, and the duration of the window
 *   Out    for each lane an outcome (enum slabs_outcome); times of contact where requested
 *
 * Steps:
 *
 *   1. gather()           loads the words of LANES frames; words[w] holds word w of each
 *   2. set_frame_lanes()  splits the words into fields: origin, components, sizes, error
 *   3. set_pair()         sets offset, drift and error of the pair (pair_lanes.h)
 *   4. evaluate_pair()    evaluates the slabs (slabs_evaluate.h) into a struct slabs_result
 *   5. outcomes_of()      separated, touching, overlapping, or unsure; times_of(): seconds
 *
 * Macros that the includer of many.h defines select the job. None: the first pass, verdicts.
 * KERNEL_SECOND: the second pass (kernel_second.h). KERNEL_TIMES: verdicts and times. The
 * last two promise their bits, and so do boxes (KERNEL_BOX), which boxes.h computes from steps 1 to
 * 3. The includer defines one function for each kind of pair (dimension, shapes, motion:
 * kernel.h), with the traits as a constant, by KERNEL_ALL at the end of this file. KERNEL_TABLE
 * lists these functions in the order of the kinds, in a table whose name ends in KERNEL_NAME. A
 * file that defines INLINED_NOT is neither inlined nor unrolled (inlined.h).
 *
 * Order of the headers; each includes only headers before it: slabs.h, pair_lanes.h (a pair in
 * lanes), slabs_lanes.h (one slab), slabs_2d.h and slabs_3d.h (all slabs), slabs_evaluate.h, this
 * file, kernel_second.h. slabs_second.h holds the mathematics of the last one.
 *
 * Proofs: the bounds of slabs in slabs.c, of times in slabs_lanes.h, of frames in prepared.h. */
#ifndef FMB_KERNEL_LANES_H
#define FMB_KERNEL_LANES_H

#include "kernel.h"
#include "slabs_evaluate.h"

#ifdef KERNEL_TIMES
enum { TIMES = 1 };
#else
enum { TIMES = 0 };
#endif
#ifdef KERNEL_SECOND
enum { SECOND = 1 };
#else
enum { SECOND = 0 };
#endif
#ifdef KERNEL_BOX
enum { BOX = 1 };
#else
enum { BOX = 0 };
#endif

/* The traits of a kind of pairs for the job of this file. For boxes, KERNEL_DRIFTS means that a
 * frame moves. */
INLINE struct kernel_traits traits_of(enum kernel_kind kind)
{
    const bool face = kind & KERNEL_FACE, same = kind & KERNEL_SAME_SHAPE,
               tetrahedron = kind & KERNEL_TETRAHEDRON;
    return (struct kernel_traits){.dim = kind & KERNEL_3D ? 3 : 2,
                                  .simplex = {same || (face && tetrahedron), tetrahedron || face},
                                  .face = {face && same, face},
                                  .drifts = (kind & KERNEL_DRIFTS) != 0,
                                  .axis_aligned = !BOX && kind & KERNEL_AXIS_ALIGNED,
                                  .swap_invariant = TIMES || SECOND,
                                  .times = TIMES,
                                  .box = BOX,
                                  .rough = !TIMES && !SECOND && !BOX,
                                  .second = SECOND};
}

/* ---- The gather ----
 *
 * gather_four() loads the words first to first + 3 of all frames: words[w] holds word first + w,
 * lane i that of frame i. */

enum { WORDS = sizeof(struct fmb_prepared) / sizeof(double) };

#if LANES == 1

INLINE void gather_four(const double *const frame[LANES], int first, lanes *words)
{
    UNROLL(4)
    for (int w = 0; w < 4; w++)
        words[w] = frame[0][first + w]; /* lanes_of() would lose the sign of -0 */
}

#elif LANES == 2

INLINE void gather_four(const double *const frame[LANES], int first, lanes *words)
{
    UNROLL(2)
    for (int w = 0; w < 4; w += 2) {
        const lanes x = lanes_load(frame[0] + first + w), y = lanes_load(frame[1] + first + w);
        words[w] = SHUFFLED(x, y, 0, 2);
        words[w + 1] = SHUFFLED(x, y, 1, 3);
    }
}

#elif LANES == 4

INLINE void gather_four(const double *const frame[LANES], int first, lanes *words)
{
    UNROLL(2)
    for (int odd = 0; odd < 2; odd++) {
        const lanes x = lanes_load(frame[0] + first), y = lanes_load(frame[1] + first);
        const lanes z = lanes_load(frame[2] + first), w = lanes_load(frame[3] + first);
        const lanes xy = odd ? SHUFFLED(x, y, 1, 5, 3, 7) : SHUFFLED(x, y, 0, 4, 2, 6);
        const lanes zw = odd ? SHUFFLED(z, w, 1, 5, 3, 7) : SHUFFLED(z, w, 0, 4, 2, 6);
        words[odd] = SHUFFLED(xy, zw, 0, 1, 4, 5);
        words[2 + odd] = SHUFFLED(xy, zw, 2, 3, 6, 7);
    }
}

#else

/* Four words of two frames: the second half is inserted as it is loaded, which saves a shuffle. */
INLINE lanes four_of_two(const double *low, const double *high)
{
#ifdef __AVX512F__
    return (lanes) _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_loadu_pd(low)),
                                      _mm256_loadu_pd(high), 1);
#else
    return (lanes){low[0], low[1], low[2], low[3], high[0], high[1], high[2], high[3]};
#endif
}

/* Frames are two apart in a register: shuffles of two registers then put the words into the order
 * of the lanes. */
INLINE void gather_four(const double *const frame[LANES], int first, lanes *words)
{
    const lanes x = four_of_two(frame[0] + first, frame[2] + first);
    const lanes y = four_of_two(frame[1] + first, frame[3] + first);
    const lanes z = four_of_two(frame[4] + first, frame[6] + first);
    const lanes w = four_of_two(frame[5] + first, frame[7] + first);
    const lanes xy_even = SHUFFLED(x, y, 0, 8, 2, 10, 4, 12, 6, 14);
    const lanes xy_odd = SHUFFLED(x, y, 1, 9, 3, 11, 5, 13, 7, 15);
    const lanes zw_even = SHUFFLED(z, w, 0, 8, 2, 10, 4, 12, 6, 14);
    const lanes zw_odd = SHUFFLED(z, w, 1, 9, 3, 11, 5, 13, 7, 15);
    words[0] = SHUFFLED(xy_even, zw_even, 0, 1, 4, 5, 8, 9, 12, 13);
    words[1] = SHUFFLED(xy_odd, zw_odd, 0, 1, 4, 5, 8, 9, 12, 13);
    words[2] = SHUFFLED(xy_even, zw_even, 2, 3, 6, 7, 10, 11, 14, 15);
    words[3] = SHUFFLED(xy_odd, zw_odd, 2, 3, 6, 7, 10, 11, 14, 15);
}

#endif

/* A prepared frame of each lane. */
struct frame_lanes {
    lanes origin[3], component[3][3], size[3], velocity[3]; /* 2D: the first two of each */
    lanes error;
    lanes_bits summary;
    const struct fmb_prepared *prepared[LANES]; /* of the second pass and boxes */
};

/* Splits the words of prepared frames (prepared.h) into fields. */
INLINE void set_frame_lanes(const struct kernel_traits traits, const lanes words[WORDS],
                            struct frame_lanes *out)
{
    const lanes_bits summary = lanes_as_bits(words[0]);
    out->summary = summary;
    out->origin[2] = lanes_of(0);
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++) {
        out->origin[axis] = words[1 + axis];
        out->size[axis] =
            lanes_from_bits((summary << (48 - PREPARED_SIZE_BITS * axis)) & 0xffff000000000000);
        UNROLL(3)
        for (int i = 0; i < traits.dim; i++)
            out->component[i][axis] = words[1 + traits.dim * (1 + i) + axis];
    }
    out->error = words[traits.dim == 2 ? PREPARED_ERROR_2D : PREPARED_ERROR_3D];
}

/* The number of words of summary, origin, components and error. */
INLINE int word_count(const struct kernel_traits traits)
{
    return 1 + (traits.dim == 2 ? PREPARED_ERROR_2D : PREPARED_ERROR_3D);
}

/* In 3D velocities are in the placements, followed by more numbers, so that reading four is safe.
 */
INLINE void gather_velocity(const struct kernel_traits traits, const double *const frame[LANES],
                            struct frame_lanes *out)
{
    const double *velocity[LANES];
    lanes words[4];
    UNROLL(8)
    for (int lane = 0; lane < LANES; lane++)
        velocity[lane] = traits.dim == 2
                             ? frame[lane] + PREPARED_VELOCITY_2D
                             : ((const struct fmb_prepared *) frame[lane])->placement->velocity;
    gather_four(velocity, 0, words);
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++)
        out->velocity[axis] = words[axis];
}

/* Loads the frame of each lane, words four at a time. */
INLINE void gather(const struct kernel_traits traits, const double *const frame[LANES],
                   struct frame_lanes *out)
{
    lanes words[WORDS];
    UNROLL(4)
    for (int w = 0; w < word_count(traits); w += 4)
        gather_four(frame, w, &words[w]);
    set_frame_lanes(traits, words, out);
    if (traits.second || traits.box)
        memcpy(out->prepared, frame, sizeof out->prepared);
    if (traits.drifts)
        gather_velocity(traits, frame, out);
}

/* Loads the frames of LANES pairs, [pair][a, b]. */
INLINE void gather_pairs(const struct kernel_traits traits, const struct fmb_prepared *(*pairs)[2],
                         struct frame_lanes out[2])
{
    UNROLL(2)
    for (int which = 0; which < 2; which++) {
        const double *frame[LANES];
        UNROLL(8)
        for (size_t lane = 0; lane < LANES; lane++)
            frame[lane] = (const double *) pairs[lane][which];
        gather(traits, frame, &out[which]);
    }
}

/* Sets the pairs of the frames; duration of the window in seconds. */
INLINE void set_pair(const struct kernel_traits traits, const struct frame_lanes *a,
                     const struct frame_lanes *b, double duration, struct pair_lanes *out)
{
    lanes component[2][3][3], size[2][3], offset[3], drift[3];
    size[0][2] = size[1][2] = lanes_of(0);
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++) {
        offset[axis] = b->origin[axis] - a->origin[axis];
        if (traits.drifts)
            drift[axis] = (b->velocity[axis] - a->velocity[axis]) * duration;
        size[0][axis] = a->size[axis];
        size[1][axis] = b->size[axis];
        UNROLL(3)
        for (int i = 0; i < traits.dim; i++) {
            component[0][i][axis] = a->component[i][axis];
            component[1][i][axis] = b->component[i][axis];
        }
    }
    pair_lanes_set(traits, component, size, offset, drift, a->error + b->error, out);
}

/* Evaluates the slabs of the pairs. */
INLINE void evaluate_pair(const struct kernel_traits traits, const struct pair_lanes *pair,
                          struct slabs_result *result)
{
    slabs_result_begin(result);
    evaluate_slabs(pair, traits, result);
}

/* Writes lane i to out[i * stride]. */
INLINE void put_lanes(lanes x, double *out, int stride)
{
    double at[LANES];
    memcpy(at, &x, sizeof at);
    UNROLL(8)
    for (int lane = 0; lane < LANES; lane++)
        out[lane * stride] = at[lane];
}

/* ---- Outcomes ---- */

/* Bit i of each: lane i. A lane without a bit is unsure. */
struct outcomes {
    unsigned separated, touching, overlapping;
};

/* The outcomes of the first pass, and of kernels of times. */
INLINE struct outcomes outcomes_of(const struct pair_lanes *pair, const struct slabs_result *result)
{
    const unsigned in_range = lanes_mask_bits(pair->in_range);
    const unsigned separated = lanes_greater_bits(result->gap_low, lanes_of(0));
    const unsigned overlapping = lanes_greater_bits(lanes_of(0), result->gap_high);
    return (struct outcomes){in_range & separated, 0, in_range & overlapping & ~separated};
}

INLINE enum slabs_outcome outcome_at(struct outcomes outcomes, int lane)
{
    return (enum slabs_outcome)((outcomes.separated >> lane & 1) * SLABS_SEPARATED +
                                (outcomes.touching >> lane & 1) * SLABS_TOUCHING +
                                (outcomes.overlapping >> lane & 1) * SLABS_OVERLAPPING);
}

/* Byte i is 1 where bit i of the eight is set, else 0. */
INLINE uint64_t bits_to_bytes(unsigned bits)
{
    const uint64_t one_each = UINT64_C(0x0101010101010101);
    const uint64_t own = bits * one_each & UINT64_C(0x8040201008040201); /* bit i of byte i */
    return (own + 0x7f * one_each) >> 7 & one_each;
}

INLINE void put_outcomes(struct outcomes outcomes, unsigned char out[LANES])
{
#if LANES >= 4 && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    const uint64_t bytes = bits_to_bytes(outcomes.separated) * SLABS_SEPARATED +
                           bits_to_bytes(outcomes.touching) * SLABS_TOUCHING +
                           bits_to_bytes(outcomes.overlapping) * SLABS_OVERLAPPING;
    memcpy(out, &bytes, LANES);
#else
    for (int lane = 0; lane < LANES; lane++)
        out[lane] = (unsigned char) outcome_at(outcomes, lane);
#endif
}

/* ---- Times and boxes ---- */

/* Seconds: a product with a shorter duration may underflow. */
#define DURATION_MIN 0x1p-900

/* The largest distance of an outer and an inner end, in a window of length 2. Leaves a tenth of the
 * limit, 1e-12 of the window, to the roundings that follow. */
#define TIMES_LIMIT 1.8e-12

/* A time in seconds is rounded three times, each time by less than 2^-53 of itself. */
#define TIMES_ROUNDING 0x1p-51

/* Outer and inner ends, in [-1, 1], to seconds; NAN where they are too far apart. SLABS_TIMES_SLACK
 * covers the rounding of the ends (slabs_lanes.h). */
INLINE void times_of(const struct pair_lanes *pair, const struct slabs_result *result,
                     double window, lanes times[2])
{
    const lanes slack = lanes_of(SLABS_TIMES_SLACK), one = lanes_of(1), duration = lanes_of(window);
    const lanes enter = lanes_max(result->enter[0] - slack, -one);
    const lanes leave = lanes_min(result->leave[0] + slack, one);
    const lanes enter_inner = lanes_max(result->enter[1] + slack, -one);
    const lanes leave_inner = lanes_min(result->leave[1] - slack, one);
    const lanes first = (0.5 + 0.5 * CHECK_GIVEN(enter)) * duration * (1 - TIMES_ROUNDING);
    const lanes last = (0.5 + 0.5 * CHECK_GIVEN(leave)) * duration * (1 + TIMES_ROUNDING);
    CHECK_BOUND(TIMES_ROUNDING, duration < DURATION_MIN, first, TIMES_ROUNDING * first);
    CHECK_BOUND(TIMES_ROUNDING, duration < DURATION_MIN, last, TIMES_ROUNDING * last);
    const lanes_mask good = pair->in_range & (enter_inner - enter <= TIMES_LIMIT) &
                            (leave - leave_inner <= TIMES_LIMIT) & (duration >= DURATION_MIN);
    times[0] = lanes_select(good, first, lanes_of(NAN));
    times[1] = lanes_select(good, lanes_min(last, duration), lanes_of(NAN));
}

/* ---- The table ----
 *
 * KERNEL_ALL(X, Y) expands to X(name, kind) for each kind of pairs of the job, and to Y(name, kind)
 * for a kind with KERNEL_AXIS_ALIGNED whose function also serves the kind without it: kinds with
 * faces, which are often parallel to something; and all kinds in the second pass, which always
 * looks for zero normals. */

#define KERNEL_SOLIDS(X, name, kind)            \
    X(name##_cc, kind)                          \
    X(name##_ct, ((kind) + KERNEL_TETRAHEDRON)) \
    X(name##_tt, ((kind) + KERNEL_TETRAHEDRON + KERNEL_SAME_SHAPE))
#define KERNEL_FACES(X, name, kind)                           \
    X(name##_cf, ((kind) + KERNEL_FACE))                      \
    X(name##_tf, ((kind) + KERNEL_FACE + KERNEL_TETRAHEDRON)) \
    X(name##_ff, ((kind) + KERNEL_FACE + KERNEL_SAME_SHAPE))

/* drifts: 0 or KERNEL_DRIFTS. */
#define KERNEL_MOTION(X, Y, name, drifts)                                             \
    KERNEL_SOLIDS(X, plane##name, drifts)                                             \
    KERNEL_SOLIDS(X, space##name, KERNEL_3D + (drifts))                               \
    KERNEL_SOLIDS(X, space_aligned##name, KERNEL_3D + KERNEL_AXIS_ALIGNED + (drifts)) \
    KERNEL_FACES(Y, space##name, KERNEL_3D + KERNEL_AXIS_ALIGNED + (drifts))
#define KERNEL_SECOND_MOTION(X, Y, name, drifts)                              \
    KERNEL_SOLIDS(X, plane##name, drifts)                                     \
    KERNEL_SOLIDS(Y, space##name, KERNEL_3D + KERNEL_AXIS_ALIGNED + (drifts)) \
    KERNEL_FACES(Y, space##name, KERNEL_3D + KERNEL_AXIS_ALIGNED + (drifts))

#if defined(KERNEL_TIMES)
#define KERNEL_ALL(X, Y) KERNEL_MOTION(X, Y, _drifts, KERNEL_DRIFTS)
#elif defined(KERNEL_SECOND)
#define KERNEL_ALL(X, Y)            \
    KERNEL_SECOND_MOTION(X, Y, , 0) \
    KERNEL_SECOND_MOTION(X, Y, _drifts, KERNEL_DRIFTS)
#else
#define KERNEL_ALL(X, Y)     \
    KERNEL_MOTION(X, Y, , 0) \
    KERNEL_MOTION(X, Y, _drifts, KERNEL_DRIFTS)
#endif

#define KERNEL_ENTRY(name, kind) [kind] = name,
#define KERNEL_ENTRIES(name, kind) [kind] = name, [(kind) ^ KERNEL_AXIS_ALIGNED] = name,
#define KERNEL_TABLE                             \
    {                                            \
        KERNEL_ALL(KERNEL_ENTRY, KERNEL_ENTRIES) \
    }

#define KERNEL_PASTE_(x, y) x##_##y
#define KERNEL_PASTE(x, y) KERNEL_PASTE_(x, y)

#endif
