/* The contents of a prepared frame. No function here has shared state.
 *
 * Its numbers are the world coordinates of the frame, rounded. They describe a rounded frame near
 * the true one: no vertex, and so no point, is farther than error from where it truly is (2-norm).
 * If error is 0, the two are the same. The bounds of the filter hold for the rounded frame, whose
 * numbers are exact; slabs.h derives bounds for the true one.
 *
 * The numbers of a hull describe a cuboid that contains it: its box in body coordinates, placed.
 * The numbers of a frame with a radius describe its core, and the radius is part of the error: no
 * point of the frame is farther than error from the rounded core. So what the filter separates with
 * this error is separated.
 *
 * The summary holds, from its least significant bit: the sizes of components 0, 1 and 2, 16 bits
 * each, then the flags below. A size is the 16 most significant bits of a double, rounded up.
 * Shifted to the top of 64 bits it is a double that is no smaller than the length of the component
 * (its 2-norm), whether rotated and rounded or not, and at most a fifteenth larger. It is 0 if the
 * component is 0 or does not exist.
 *
 * The internal fields of struct fmb_frame, which frame.c computes:
 *
 *   in_range    doubles can decide pairs with it in a placement not rotated
 *   sturdy      doubles can decide pairs with it in any placement
 *   rounded     some number of remainder is not 0
 *   bits        all components are multiples of 2^bits[0] below 2^bits[1]
 *   summary     as above, of this frame unrotated and at rest
 *   slack       bounds the distance of each vertex from the rounded one of origin and component; 0:
 *               those are exact
 *   spread      slack and radius: bounds the distance of each point from that rounded core
 *   turn_error  what a rotation that rounds adds to slack and to spread
 *   core_reach  the reach without the radius
 *   size        largest magnitude in each component */
#ifndef FMB_PREPARED_H
#define FMB_PREPARED_H

#include "fmb_batch.h"
#include "pair.h"

#include <string.h>

enum {
    PREPARED_SIZE_BITS = 16,
    PREPARED_TETRAHEDRON = 1 << 0,
    PREPARED_FACE = 1 << 1,         /* neither bit: a cuboid */
    PREPARED_3D = 1 << 2,           /* else 2D */
    PREPARED_MOVING = 1 << 3,       /* the velocity is not 0 */
    PREPARED_AXIS_ALIGNED = 1 << 4, /* an edge is parallel to a coordinate axis */
    PREPARED_USABLE = 1 << 5,       /* doubles can decide pairs with the frame */
    PREPARED_PLAIN = 1 << 6,        /* error is 0, and the components span at most 24 bits */
    PREPARED_VALID = 1 << 7,        /* the frame is prepared */
    /* The error does not affect the x coordinates: they are exact. The next two bits: y and z. */
    PREPARED_EXACT_X = 1 << 8,
    /* The x coordinates of the components are exact. The next two bits: y and z. If some of the
     * three bits are set, and not all, the frame is rotated about that axis, and no coordinate was
     * trimmed. The other two coordinates of a component are then off by less than 18.3 u of the
     * length that the two have together (rotation.h, 4 and 5): if both are 0, they truly are. */
    PREPARED_COMPONENTS_EXACT_X = 1 << 11,
    /* A box whose origin is rounded along an axis of exact components. Along each axis of exact
     * components it extends from position + centre, which are those of its placement and of its
     * frame, by half of a component to either side. */
    PREPARED_CENTRED = 1 << 14,
    /* Decided by its vertices (support_pair.h): a hull, whose numbers describe a cuboid that
     * contains it, or a frame with a radius, whose numbers describe its core. Also set, with
     * PREPARED_MOVING and without PREPARED_USABLE, for every frame whose placement has an end; its
     * numbers then describe the frame at the beginning of the window. */
    PREPARED_VERTICES = 1 << 15
};

/* The range of the filter. For sizes within these bounds, products of four, sums of a few dozen
 * such products, and 2^-53 times these sums neither overflow nor lose bits to underflow. No product
 * of two coordinates of PREPARED_LEAST_NUMBER, or of their halves, underflows. */
#define PREPARED_LEAST 0x1p-200
#define PREPARED_LARGEST 0x1p200
#define PREPARED_LEAST_NUMBER 0x1p-400

/* Factor on a bound, for the roundings of computing it. */
#define PREPARED_MARGIN (1 + 0x1p-40)

/* Indices of the 8-byte words of struct fmb_prepared; the summary is word 0. In 2D the velocity
 * follows the first eight words, which are all that a pair at rest reads. */
enum {
    PREPARED_ERROR_2D = 7,
    PREPARED_VELOCITY_2D = 8,
    PREPARED_ERROR_3D = 13,
    PREPARED_FRAME = 14,
    PREPARED_PLACEMENT = 15
};

/* Returns the flags: PREPARED_TETRAHEDRON and so on. */
static inline unsigned prepared_kind(const struct fmb_prepared *frame)
{
    return (unsigned) (frame->summary >> 3 * PREPARED_SIZE_BITS);
}

/* Returns whether both frames are plain. */
static inline bool prepared_both_plain(const struct fmb_prepared *a, const struct fmb_prepared *b)
{
    return prepared_kind(a) & prepared_kind(b) & PREPARED_PLAIN;
}

/* Returns the velocity, [dim]. In: the frame is valid. */
static inline const double *prepared_velocity(const struct fmb_prepared *frame)
{
    return prepared_kind(frame) & PREPARED_3D ? frame->placement->velocity
                                              : &frame->number[PREPARED_VELOCITY_2D - 1];
}

/* Returns whether the placement of a frame has an end. In: the frame is valid. */
static inline bool prepared_has_end(const struct fmb_prepared *frame)
{
    const unsigned bits = PREPARED_VERTICES | PREPARED_MOVING | PREPARED_USABLE;
    return (prepared_kind(frame) & bits) == (PREPARED_VERTICES | PREPARED_MOVING) &&
           frame->placement->end_count != 0;
}

/* Returns the error of a frame, in the unit of its coordinates. */
static inline double prepared_error(const struct fmb_prepared *frame)
{
    return frame
        ->number[(prepared_kind(frame) & PREPARED_3D ? PREPARED_ERROR_3D : PREPARED_ERROR_2D) - 1];
}

/* Returns an upper bound of the length of component i, 0 to 2. */
static inline double prepared_size(unsigned long long summary, int i)
{
    const unsigned long long bits = summary << (64 - PREPARED_SIZE_BITS * (1 + i));
    const unsigned long long upper = bits >> 48 << 48;
    double size = 0;
    memcpy(&size, &upper, sizeof upper);
    return size;
}

/* Returns whether x + y is sum exactly. In: sum is x + y, rounded; its error is a double (Knuth,
 * The Art of Computer Programming, volume 2, 4.2.2, theorem B). */
static inline bool prepared_exact_sum(double x, double y, double sum)
{
    const double part = sum - x;
    return (x - (sum - part)) + (y - part) == 0;
}

/* Makes a tetrahedron in 2D, a triangle, at the origin and without its inverse.
 *
 * In: components  [component][axis], each number 0 or of a magnitude in [2^-400, 2^200], so that
 *                 doubles decide exactly whether the triangle is flat */
void frame_set_plane_triangle(const double components[2][2], struct fmb_frame *out);

/* Sets the fields of a hull that describe a cuboid, as if the cuboid between two corners were the
 * frame. The slack is infinite if numbers might overflow.
 *
 * In:  bounds  [lower, upper][axis], finite: contains the hull
 *      *out    its dim and shape, otherwise 0 */
void frame_set_bounds(const double bounds[2][FMB_DIM_MAX], struct fmb_frame *out);

/* Returns whether a duration in seconds is legal: finite and not negative. */
bool prepared_is_duration(double duration);

/* Returns the summary of a frame, not rotated and at rest. In: its shape, dimensions, components,
 * rounded, slack, bits and in_range are set. */
unsigned long long prepared_summary_of(const struct fmb_frame *frame);

/* As fmb_prepare() of one frame, without its checks. */
void prepared_set(struct placed_frame placed, struct fmb_prepared *out);

/* As fmb_prepare(), without its checks. */
void prepared_place(const struct fmb_placement *placement, unsigned first, unsigned count,
                    struct fmb_prepared *out);

/* An unpacked prepared frame, for the steps that decide one pair. A box is a cuboid here. */
struct world_frame {
    const struct fmb_frame *frame;
    enum fmb_shape shape;
    int dim, count;
    unsigned long long summary;
    double origin[FMB_DIM_MAX], component[FMB_DIM_MAX][FMB_DIM_MAX]; /* beyond dim: 0 */
    double velocity[FMB_DIM_MAX];                                    /* per second, exact */
    double size[FMB_DIM_MAX]; /* largest magnitude in each component */
    double error;             /* of the frame, as above */
    double relative_error;    /* bounds the error of a component, relative to its length */
};

/* Unpacks a valid prepared frame. */
void world_frame_of(const struct fmb_prepared *prepared, struct world_frame *out);

#endif
