/* The first pass for a single pair. The includer defines LANES and KERNEL_NAME. With two lanes the
 * pair is in both: an instruction takes as long for two doubles as for one, and the vector
 * instructions include minima and maxima. If both frames have the same shape, the second lane holds
 * the pair with its frames swapped, so that half of the slabs do for all of them
 * (kernel_traits.mirrored). */
#include "kernel_lanes.h"

INLINE bool is_mirrored(const struct kernel_traits traits)
{
    return LANES == 2 && traits.simplex[0] == traits.simplex[1] && traits.face[0] == traits.face[1];
}

/* x in the first lane, y in the second. */
INLINE lanes side_by_side(double x, double y)
{
#if LANES == 1
    (void) y;
    return x;
#else
    return (lanes){x, y};
#endif
}

INLINE const double *velocity_of(const struct kernel_traits traits,
                                 const struct fmb_prepared *frame)
{
    return traits.dim == 3 ? frame->placement->velocity
                           : (const double *) frame + PREPARED_VELOCITY_2D;
}

/* Loads a and b: of_a holds a in the first lane and b in the second, of_b the opposite. */
INLINE void gather_mirrored(const struct kernel_traits traits, const struct fmb_prepared *a,
                            const struct fmb_prepared *b, struct frame_lanes *of_a,
                            struct frame_lanes *of_b)
{
    const double *x = (const double *) a, *y = (const double *) b;
    lanes words[2][WORDS];
    UNROLL(16)
    for (int w = 0; w < word_count(traits); w++) {
        words[0][w] = side_by_side(x[w], y[w]);
        words[1][w] = lanes_swap(words[0][w]);
    }
    set_frame_lanes(traits, words[0], of_a);
    set_frame_lanes(traits, words[1], of_b);
    if (!traits.drifts)
        return;
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++) {
        of_a->velocity[axis] =
            side_by_side(velocity_of(traits, a)[axis], velocity_of(traits, b)[axis]);
        of_b->velocity[axis] = lanes_swap(of_a->velocity[axis]);
    }
}

/* Both lanes hold x, which is hidden from the compiler: gcc would otherwise compute in scalars, and
 * copy each of them into a vector before a minimum or a maximum. */
INLINE lanes in_all_lanes(double x)
{
    lanes out = side_by_side(x, x);
#if LANES == 2 && defined(__x86_64__)
    __asm__("" : "+x"(out));
#endif
    return out;
}

/* Loads a frame into all lanes. */
INLINE void gather_frame(const struct kernel_traits traits, const struct fmb_prepared *frame,
                         struct frame_lanes *out)
{
    lanes words[WORDS];
    UNROLL(16)
    for (int w = 0; w < word_count(traits); w++)
        words[w] = in_all_lanes(((const double *) frame)[w]);
    set_frame_lanes(traits, words, out);
    for (int lane = 0; lane < LANES; lane++)
        out->prepared[lane] = frame;
    if (!traits.drifts)
        return;
    UNROLL(3)
    for (int axis = 0; axis < traits.dim; axis++)
        out->velocity[axis] = in_all_lanes(velocity_of(traits, frame)[axis]);
}

/* From lanes that hold the same pair. Mirrored, each lane knows half of the slabs: one that
 * separates is enough, and both have to overlap. */
INLINE enum slabs_outcome outcome_of(const struct kernel_traits traits, struct outcomes outcomes)
{
    if (!traits.mirrored)
        return outcome_at(outcomes, 0);
    return outcomes.separated          ? SLABS_SEPARATED
           : outcomes.overlapping == 3 ? SLABS_OVERLAPPING
                                       : SLABS_UNSURE;
}

INLINE enum slabs_outcome evaluate_single(struct kernel_traits traits, const struct fmb_prepared *a,
                                          const struct fmb_prepared *b, double duration)
{
    struct frame_lanes frame[2];
    struct pair_lanes pair;
    traits.mirrored = is_mirrored(traits);
    if (traits.mirrored) {
        gather_mirrored(traits, a, b, &frame[0], &frame[1]);
    } else {
        gather_frame(traits, a, &frame[0]);
        gather_frame(traits, b, &frame[1]);
    }
    set_pair(traits, &frame[0], &frame[1], duration, &pair);
    struct slabs_result result;
    evaluate_pair(traits, &pair, &result);
    return outcome_of(traits, outcomes_of(&pair, &result));
}

#define KERNEL_FUNCTION(name, kind)                                                            \
    static enum slabs_outcome name(const struct fmb_prepared *a, const struct fmb_prepared *b, \
                                   double duration)                                            \
    {                                                                                          \
        return evaluate_single(traits_of(kind), a, b, duration);                               \
    }

KERNEL_ALL(KERNEL_FUNCTION, KERNEL_FUNCTION)

kernel_single_function *const KERNEL_PASTE(kernel, KERNEL_NAME)[KERNEL_KINDS] = KERNEL_TABLE;
