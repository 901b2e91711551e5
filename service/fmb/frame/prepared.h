/* What a prepared frame holds.
 *
 * The numbers are those of a frame near the true one: its world coordinates, rounded. No point of
 * either is farther from the other frame than error (2-norm), and where error is 0 the two are the
 * same. Bounds of the filter hold for the rounded frame, whose numbers are exact; slabs.h says what
 * follows for the true one.
 *
 * The summary, from its least significant bit: the sizes of components 0, 1 and 2, 16 bits each,
 * then the bits below. A size is the upper half of a double's upper half, rounded up: a shift to
 * the top of 64 bits makes it a double that is no smaller than the length of the component (its
 * 2-norm), turned and rounded or not, and at most a fifteenth larger. 0 for a component that is not
 * there, or is 0. */
#ifndef FMB_PREPARED_H
#define FMB_PREPARED_H

#include "pair.h"

#include <stdint.h>
#include <string.h>

enum {
    PREPARED_SIZE_BITS = 16,
    PREPARED_TETRAHEDRON = 1 << 0, /* neither: a cuboid */
    PREPARED_FACE = 1 << 1,
    PREPARED_3D = 1 << 2,           /* 3D */
    PREPARED_MOVING = 1 << 3,       /* its velocity is not 0 */
    PREPARED_AXIS_ALIGNED = 1 << 4, /* an edge is parallel to a coordinate axis */
    PREPARED_USABLE = 1 << 5,       /* doubles can decide pairs with it */
    PREPARED_PLAIN = 1 << 6,        /* the error is 0, and the components have few bits */
    PREPARED_VALID = 1 << 7,        /* it was prepared */
    /* The error does not reach the x coordinates. The next two bits: y and z. */
    PREPARED_EXACT_X = 1 << 8,
    /* The components are exact along x. The next two bits: along y and z. */
    PREPARED_COMPONENTS_EXACT_X = 1 << 11
};

/* Words of struct fmb_prepared, the summary being word 0. In 2D a pair at rest reads the first
 * eight alone, and the velocity follows. */
enum {
    PREPARED_ERROR_2D = 7,
    PREPARED_VELOCITY_2D = 8,
    PREPARED_ERROR_3D = 13,
    PREPARED_FRAME = 14,
    PREPARED_PLACEMENT = 15
};

/* The bits of the kind. */
static inline unsigned prepared_kind(const struct fmb_prepared *frame)
{
    return (unsigned) (frame->summary >> 3 * PREPARED_SIZE_BITS);
}

/* Of a pair: both frames plain. */
static inline bool prepared_both_plain(const struct fmb_prepared *a, const struct fmb_prepared *b)
{
    return prepared_kind(a) & prepared_kind(b) & PREPARED_PLAIN;
}

/* On input: a frame that is prepared. */
static inline const double *prepared_velocity(const struct fmb_prepared *frame)
{
    return prepared_kind(frame) & PREPARED_3D ? frame->placement->velocity
                                              : &frame->number[PREPARED_VELOCITY_2D - 1];
}

static inline double prepared_error(const struct fmb_prepared *frame)
{
    return frame
        ->number[(prepared_kind(frame) & PREPARED_3D ? PREPARED_ERROR_3D : PREPARED_ERROR_2D) - 1];
}

/* No smaller than the length of component i. */
static inline double prepared_size(unsigned long long summary, int i)
{
    const unsigned long long bits = summary << (64 - PREPARED_SIZE_BITS * (1 + i));
    const unsigned long long upper = bits >> 48 << 48;
    double size;
    memcpy(&size, &upper, sizeof size);
    return size;
}

/* The error of a sum is a double (Knuth, The Art of Computer Programming, volume 2, 4.2.2, theorem
 * B): whether it is 0. */
static inline bool prepared_exact_sum(double x, double y, double sum)
{
    const double part = sum - x;
    return (x - (sum - part)) + (y - part) == 0;
}

/* A tetrahedron in 2D without its inverse, [component][axis]. Its numbers are 0 or at least 2^-400
 * and at most 2^200, so that doubles tell exactly whether it is flat. */
void frame_set_plane_triangle(const double components[2][2], struct fmb_frame *out);

/* Whether a window may last so long, in seconds: not negative, and finite. */
bool prepared_is_duration(double duration);

/* The summary of a frame whose other fields are set, without orientation and at rest. */
unsigned long long prepared_summary_of(const struct fmb_frame *frame);

/* As fmb_prepare() of one frame, without a check. */
void prepared_set(struct placed_frame placed, struct fmb_prepared *out);

/* As fmb_prepare(), without a check. */
void prepared_place(const struct fmb_placement *placement, unsigned first, unsigned count,
                    struct fmb_prepared *out);

/* A prepared frame as doubles see it: for steps that decide one pair. A box is a cuboid here. */
struct world_frame {
    const struct fmb_frame *frame;
    enum fmb_shape shape;
    int dim, count;
    unsigned long long summary;
    double origin[FMB_DIM_MAX], component[FMB_DIM_MAX][FMB_DIM_MAX]; /* beyond dim: 0 */
    double velocity[FMB_DIM_MAX];                                    /* exact */
    double size[FMB_DIM_MAX]; /* largest magnitude in each component */
    double error;
    double relative_error; /* bounds the error of a component, relative to its length */
};

void world_frame_of(const struct fmb_prepared *prepared, struct world_frame *out);

#endif
