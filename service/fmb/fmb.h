/* libfmb: decides whether two rigid bodies meet, when, and in which box.
 *
 * A frame is the set of points o + sum_i x_i c_i with an origin o and component vectors c_i
 * (article, equations 1 and 2), in body coordinates. The parameters x_i run over [0,1] for a
 * cuboid and a box; over x_i >= 0, sum x_i <= 1 for a tetrahedron and a face. A hull is the convex
 * hull of 1 to FMB_HULL_VERTICES_MAX vertices; in 2D it is a convex polygon. Vertices inside it and
 * repeated ones are legal, and it may be flat, a segment or a point. A frame may have a radius: it
 * is then the set of all points within that distance of this set, its core. A body is one or more
 * frames of one dimension. A placement puts it into the world: without radii, its set is exactly
 *
 *     { p + R(q) (o + sum_i x_i c_i) + t v }
 *
 * over all its frames, with position p, orientation q and velocity v. These doubles are taken as
 * the real numbers they represent. The time t runs over the window [0, T], T the duration in
 * seconds. The definition involves no rounding: not of the rotation matrix, of o + c or of v T. The
 * quaternion q = (w, x, y, z) may have any length but 0, and stands for the rotation of q / |q|:
 *
 *            [ ww + xx - yy - zz   2 (xy - wz)         2 (xz + wy)       ]
 *     R(q) = [ 2 (xy + wz)         ww - xx + yy - zz   2 (yz - wx)       ] / (ww + xx + yy + zz)
 *            [ 2 (xz - wy)         2 (yz + wx)         ww - xx - yy + zz ]
 *
 * In 2D q = (w, z), with w = cos(angle / 2) and z = sin(angle / 2):
 *
 *     R(q) = [ ww - zz   -2 wz   ] / (ww + zz)
 *            [ 2 wz      ww - zz ]
 *
 * A placement may have an end in place of a velocity: the body then moves and turns to another pose
 * (struct fmb_placement).
 *
 * Verdicts. Two frames OVERLAP if at some time of the window (its ends included) their relative
 * interiors have a point in common; they TOUCH if the closed sets have a point in common at some
 * time, but the relative interiors never do; otherwise they are SEPARATED. Thus a plate through a
 * box overlaps it, coplanar plates that share area overlap, and faces that share an edge touch. The
 * verdict of two bodies is the strongest of those of their frames. It does not depend on the order
 * of the pair, except that of the inexact method fmb, which may.
 *
 * Use:
 *
 *     struct fmb_body cube;
 *     static const double size[3] = {1, 1, 1};
 *     fmb_body_make(3, FMB_BOX, size, 3, &cube);
 *     struct fmb_placement a = {.body = &cube}, b = {.body = &cube, .position = {1, 0, 0}};
 *     struct fmb_answer answer;
 *     fmb_decide(fmb_method_default(), &a, &b, 0, FMB_WANT_BOX, &answer);
 *     // answer.verdict is FMB_TOUCHING, the box is [0.5,0.5] x [-0.5,0.5] x [-0.5,0.5]
 *
 * Link with -lfmb -lgmp -lm (pkg-config fmb).
 *
 * Thread safety: all functions are reentrant and keep no state between calls. Any number of threads
 * may read the same input. Inputs are never modified.
 *
 * Memory is allocated only by
 *   - exact arithmetic: in the method exact, in certified for the few pairs that need it, in
 *     certificates and their check, and in fmb_frame_make() for a frame that is nearly flat;
 *   - fmb_decide() of bodies of several frames: that of a scene of two placements, 60 kB for up to
 *     32 frames;
 *   - the gap of a pair with a hull or a radius that is rounded by more than the limit, or whose
 *     depth takes more than a hundred vertices of the Minkowski difference, as of concentric balls:
 *     50 kB, 24 bytes for each vertex, and 200 bytes for each facet that is found.
 * All is allocated through GMP, which ends the process if memory is exhausted. It is freed before
 * the function, or the scene, returns its last answer; that of a certificate in steps by
 * fmb_certificate_end(). Functions use up to 100 kB of stack.
 *
 * Determinism: the answers are the same bits on every machine with 64-bit longs whose doubles are
 * IEEE 754 binary64, rounded to nearest. The library is compiled without contraction. The caller
 * must not change the rounding mode or flush subnormals to zero. */
#ifndef FMB_H
#define FMB_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if UINTPTR_MAX < 0xFFFFFFFFFFFFFFFF
#error "libfmb needs a 64-bit machine: exact arithmetic relies on 64-bit longs"
#endif

/* The version of this header; fmb_version() returns the version of the library. Until 1.0, a new
 * minor version may change the API and the ABI, and has its own soname, libfmb.so.MAJOR.MINOR. A
 * new patch version changes neither, except in fmb_batch.h. Two headers are unstable: fmb_batch.h
 * and fmb_robot.h. */
#define FMB_VERSION_MAJOR 0
#define FMB_VERSION_MINOR 1
#define FMB_VERSION_PATCH 0

#ifdef __cplusplus
extern "C" {
#endif

enum { FMB_DIM_MAX = 3, FMB_COMPONENTS_MAX = FMB_DIM_MAX * FMB_DIM_MAX };

/* Status codes. Their numbers are used in messages and logs: a retired number is never reused. */
#define FMB_STATUS_MAP(X)                                                                  \
    X(OK, 0, "ok")                                                                         \
    X(UNKNOWN_BODY, 1, "unknown body")                                                     \
    X(BUSY, 2, "busy")                                                                     \
    X(OVER_LIMIT, 3, "over the limit")                                                     \
    X(UNKNOWN_SHAPE, 4, "unknown shape")                                                   \
    X(WRONG_DIMENSION, 5, "wrong dimension")                                               \
    X(WRONG_COUNT, 6, "wrong count of numbers")                                            \
    X(NOT_FINITE, 7, "not a finite number")                                                \
    X(DIMENSIONS_DIFFER, 8, "a 2D body against a 3D one")                                  \
    X(BAD_DURATION, 9, "the duration is negative, not finite, or 0 although a body moves") \
    X(BAD_ID, 10, "id out of range")                                                       \
    X(UNKNOWN_METHOD, 11, "unknown method")                                                \
    X(UNKNOWN_WANT, 12, "wants what this version does not give")                           \
    X(CANNOT_DECIDE, 13, "this method cannot decide this pair")                            \
    X(NOT_SUPPORTED, 14, "not supported yet; hulls are made by fmb_body_make_hull()")      \
    X(BAD_PAIR, 15, "indices that name no two frames")                                     \
    X(BAD_ORIENTATION, 16, "an orientation that is no rotation")                           \
    X(BAD_SIZE, 17, "a negative size or radius")                                           \
    X(NO_FRAMES, 18, "a body without frames")                                              \
    X(BAD_MARGIN, 19, "the margin is negative or not finite")                              \
    X(BAD_NAME, 20, "a name that is not UTF-8 of at most 64 bytes without controls")

enum fmb_status {
#define X(name, number, text) FMB_##name = number,
    FMB_STATUS_MAP(X)
#undef X
        FMB_STATUS_COUNT
};

/* Returns the text of a status, for people; "unknown status" for any other number. The string is
 * static. */
const char *fmb_status_text(int status);

/* The numbers of shapes and verdicts, and those of methods, are also used in messages and logs. */
enum fmb_shape { FMB_CUBOID = 1, FMB_TETRAHEDRON = 2, FMB_FACE = 3, FMB_BOX = 4, FMB_HULL = 5 };
enum fmb_verdict { FMB_SEPARATED = 1, FMB_TOUCHING = 2, FMB_OVERLAPPING = 3 };

/* Return "cuboid", "tetrahedron", "face", "box" or "hull", and "separated", "touching" or
 * "overlapping"; NULL for any other number. The strings are static. */
const char *fmb_shape_name(int shape);
const char *fmb_verdict_name(int verdict);

/* Returns the number of components of a frame of this shape and dimension (2 or 3): 2 for a face,
 * dim for the others. Returns 0 for a face in 2D, for a hull, which has none, and if the shape or
 * the dimension is unknown. */
int fmb_component_count(int dim, int shape);

/* ---- Bodies ---- */

/* A frame in body coordinates, and what is computed from it once, such as the inverse of its
 * components. Filled by fmb_frame_make(), fmb_frame_make_vertices() or fmb_frame_make_hull() only,
 * and changed by fmb_frame_inflate() only; the caller may read the fields, and copy the frame. Axes
 * beyond dim and components beyond count are 0. */
struct fmb_frame {
    /* The frame is the set of points within this distance of its core, the shape described by the
     * other fields. 0 unless fmb_frame_inflate() set it. */
    double radius;
    int dim;              /* 2 or 3 */
    enum fmb_shape shape; /* FMB_BOX: components along the axes, component[i][i] the size */
    int count;            /* number of components */
    bool flat;            /* the volume of the core is exactly zero, as of every face; no inverse.
                             Of a hull: unless doubles prove that it is not */
    bool inverted;        /* the inverse is present: not flat, and all its entries are finite */
    double reach;         /* bounds the distance of each point from the origin of the body; may be
                             infinite */
    /* Of a box it is rounded: the exact origin is centre - size / 2. Of a hull, origin and
     * components are those of its box in body coordinates, sizes rounded up: a cuboid that contains
     * it. */
    double origin[FMB_DIM_MAX];
    double component[FMB_DIM_MAX][FMB_DIM_MAX]; /* [component][axis] */
    /* [axis][component], rounded: x_i = sum_axis inverse[axis][i] p[axis] for p = sum x_i c_i. The
     * article's invComp (Listing 1, PROJ). All 0 if not inverted. */
    double inverse[FMB_DIM_MAX][FMB_DIM_MAX];
    /* [component][axis]: the rounding errors of the components of a frame made from vertices. The
     * exact components are component + remainder. */
    double remainder[FMB_DIM_MAX][FMB_DIM_MAX];
    double centre[FMB_DIM_MAX]; /* of a box; otherwise 0 */
    /* Of a hull, otherwise 0 and NULL: its distinct vertices in the order given, x of all, then y,
     * then z, each padded with the first one to vertex_stride numbers, a multiple of 8. In the
     * memory given to fmb_frame_make_hull(). */
    unsigned vertex_count, vertex_stride;
    const double *vertices;
    /* Internal (prepared.h). */
    bool in_range, sturdy, rounded;
    int bits[2];
    unsigned spanning[FMB_DIM_MAX + 1];
    unsigned long long summary;
    double slack, spread, turn_error, core_reach, size[FMB_DIM_MAX];
};

/* Makes a frame of numbers.
 *
 * In:  numbers  [count], finite: the origin, then the components one after the other; of a box the
 *               centre, then the full sizes along the axes (a size of 0 makes a flat frame). The
 *               first dim numbers may be omitted: the origin, or the centre, is then 0. May be NULL
 *               if count is 0.
 * Out: *out     unspecified if the status is not FMB_OK
 * Returns FMB_OK, FMB_WRONG_DIMENSION, FMB_UNKNOWN_SHAPE, FMB_WRONG_COUNT, FMB_NOT_FINITE,
 * FMB_BAD_SIZE for a negative size, or FMB_NOT_SUPPORTED for a hull, which is made by
 * fmb_frame_make_hull(). */
enum fmb_status fmb_frame_make(int dim, int shape, const double *numbers, size_t count,
                               struct fmb_frame *out);

/* Makes a tetrahedron (in 2D a triangle) of dim + 1 vertices, or in 3D a face of three vertices.
 * The vertices of the frame are exactly the given ones, although their differences, the components,
 * need not be doubles. Frames that share vertices therefore share them exactly.
 *
 * In:  vertices  [vertex][axis], finite
 *      count     the number of vertices times dim
 * Out: *out      unspecified if the status is not FMB_OK
 * Returns FMB_OK, FMB_WRONG_DIMENSION, FMB_UNKNOWN_SHAPE (a shape that has no vertices),
 * FMB_WRONG_COUNT, FMB_NOT_FINITE (also if a difference exceeds the largest double), or
 * FMB_NOT_SUPPORTED for a hull, which is made by fmb_frame_make_hull(). */
enum fmb_status fmb_frame_make_vertices(int dim, int shape, const double *vertices, size_t count,
                                        struct fmb_frame *out);

/* The largest number of vertices of a hull. */
enum { FMB_HULL_VERTICES_MAX = 1024 };

/* Returns the number of doubles of memory that fmb_frame_make_hull() needs. In: any numbers; out of
 * range: 0. */
size_t fmb_hull_doubles(int dim, size_t vertex_count);

/* Makes a hull of its vertices. Of equal vertices (-0 equals 0) the first is kept.
 *
 * In:  vertices  [vertex][axis], finite; not used after the call
 *      count     the number of vertices times dim
 *      memory    [fmb_hull_doubles(dim, count / dim)], owned by the caller; must outlive the frame
 *                and all its copies
 * Out: *out      unspecified if the status is not FMB_OK
 * Returns FMB_OK, FMB_WRONG_DIMENSION, FMB_WRONG_COUNT (none, or not a multiple of dim),
 * FMB_OVER_LIMIT (more than FMB_HULL_VERTICES_MAX), or FMB_NOT_FINITE.
 * Cost: O(n log n). */
enum fmb_status fmb_frame_make_hull(int dim, const double *vertices, size_t count, double *memory,
                                    struct fmb_frame *out);

/* Sets the radius of a frame of any shape. A sphere is a hull of one vertex with a radius, a
 * capsule a hull of two. A frame of radius 0 is the frame without one, bit for bit.
 *
 * In:  *frame  made by one of the functions above, with or without a radius
 *      radius  finite, not negative; replaces the radius that the frame has
 * Out: *frame  with this radius, and the fields that depend on it
 * Returns FMB_OK; or FMB_NOT_FINITE or FMB_BAD_SIZE, with the frame unchanged. */
enum fmb_status fmb_frame_inflate(struct fmb_frame *frame, double radius);

/* Returns the numbers that a frame was made of, without its radius.
 *
 * In:  capacity      of numbers; FMB_FRAME_NUMBERS_MAX suffices for every shape but a hull, which
 *                    has dim times vertex_count
 * Out: *by_vertices  whether they are its vertices, as fmb_frame_make_vertices() takes them; else
 *                    they are those of fmb_frame_make(), the first dim included. A frame that was
 *                    made of vertices has vertices only if a component is rounded; otherwise its
 *                    origin and components describe it as well.
 *      numbers       [capacity]: as many of the numbers as fit, in order. A zero may have another
 *                    sign. May be NULL if capacity is 0
 * Returns how many there are, also beyond the capacity. A frame made of them gives the same
 * answers, bit for bit. */
enum { FMB_FRAME_NUMBERS_MAX = FMB_DIM_MAX + FMB_COMPONENTS_MAX };
size_t fmb_frame_numbers(const struct fmb_frame *frame, bool *by_vertices, double *numbers,
                         size_t capacity);

/* A rigid body: one or more frames in body coordinates. Filled by one of the functions below only;
 * it may be copied. A body of one frame may contain it; other frames belong to the caller. */
struct fmb_body {
    double reach; /* bounds the distance of each point from the origin; may be infinite */
    double box[2][FMB_DIM_MAX]; /* [lower, upper][axis]: contains all frames */
    int dim;
    unsigned frame_count;
    const struct fmb_frame *frames; /* [frame_count], not owned; NULL: the only frame is one */
    struct fmb_frame one;
};

/* Returns frame i of a body. In: i < body->frame_count. */
static inline const struct fmb_frame *fmb_body_frame(const struct fmb_body *body, unsigned i)
{
    return body->frames ? &body->frames[i] : &body->one;
}

/* Make a body of one frame, which the body contains. In, Out, Returns: as fmb_frame_make(),
 * fmb_frame_make_vertices() and fmb_frame_make_hull(). */
enum fmb_status fmb_body_make(int dim, int shape, const double *numbers, size_t count,
                              struct fmb_body *out);
enum fmb_status fmb_body_make_vertices(int dim, int shape, const double *vertices, size_t count,
                                       struct fmb_body *out);
enum fmb_status fmb_body_make_hull(int dim, const double *vertices, size_t count, double *memory,
                                   struct fmb_body *out);

/* Sets the radius of a body of one frame. In, Out, Returns: as fmb_frame_inflate(); or
 * FMB_WRONG_COUNT for a body of several frames, which have radii of their own. */
enum fmb_status fmb_body_inflate(struct fmb_body *body, double radius);

/* Makes a body of several frames. They may overlap: frames of one body are never tested against
 * each other.
 *
 * In:  frames  [count], of one dimension; not copied: they must outlive the body and all its copies
 * Out: *out    unspecified if the status is not FMB_OK
 * Returns FMB_OK, FMB_NO_FRAMES, FMB_DIMENSIONS_DIFFER, or FMB_OVER_LIMIT (more than
 * FMB_FRAMES_MAX). */
enum { FMB_FRAMES_MAX = 65536 };
enum fmb_status fmb_body_make_frames(const struct fmb_frame *frames, size_t count,
                                     struct fmb_body *out);

/* A body with a pose and a velocity. If all fields but body are 0, it is at the origin, not rotated
 * and at rest. Axes beyond the dimension of the body are not read. */
struct fmb_placement {
    const struct fmb_body *body;  /* not owned */
    double position[FMB_DIM_MAX]; /* world coordinates of the body's origin, at time 0 */
    double velocity[FMB_DIM_MAX]; /* per second */
    double orientation[4];        /* w, x, y, z (2D: w, z); of any length but 0 */
    int orientation_count;        /* 0: not rotated; 4 (2D: 2) */
    /* The pose at the end of the window, in place of a velocity. The body then moves and turns from
     * its pose to this one. With s = t / T:
     *
     *     p(s) = (1 - s) p0 + s p1,    q(s) = (1 - s) q0 + s c q1,    c the sign of q0 . q1
     *
     * where p0 and q0 are position and orientation, and p1 and q1 are end_position and
     * end_orientation; these doubles are exact too. A body that begins without a rotation and turns
     * has the orientation (1, 0, 0, 0). Windows that share a pose join exactly. A turn is less than
     * 180 degrees; a longer turn takes several windows. */
    double end_position[FMB_DIM_MAX], end_orientation[4];
    int end_count; /* 0: none; otherwise the dimension plus orientation_count */
    /* Not 0: in a scene, placements of one group are not tested against each other. */
    int64_t group;
    /* Not read by the engine; the client library and its messages use them. */
    int64_t id;       /* of the body, 1 to 2^53 - 1; 0: anonymous */
    const char *name; /* for people: UTF-8, at most 64 bytes, no control characters; NULL: none */
};

/* Checks a placement. Every function that takes placements applies this check.
 *
 * Returns one of:
 *   FMB_OK
 *   FMB_NO_FRAMES        body is NULL or was not made
 *   FMB_WRONG_COUNT      orientation_count is neither 0 nor 4 (2D: 2); it is 0 and orientation is
 *                        not all 0; end_count is neither 0 nor the dimension plus
 *                        orientation_count; or there are both an end and a velocity
 *   FMB_NOT_FINITE       position, velocity, or the position of the end
 *   FMB_BAD_ORIENTATION  the orientation, or the orientation of the end, is all 0, is not finite,
 *                        or has a component other than 0 whose magnitude is less than 2^-200 of
 *                        the largest; or the two quaternions are at right angles, or their lengths
 *                        differ by more than a factor of 4; all are tested exactly */
enum fmb_status fmb_placement_check(const struct fmb_placement *placement);

/* Sets *out to a placement at rest in the pose at the given time. The pose is rounded: use it for
 * pictures. At time 0 and at the duration, bodies with an end have the given pose, bit for bit.
 * Times outside the window are clamped to it. In a window of 0 s every time counts as 0.
 *
 * In: placement  fmb_placement_check() accepts it; may be out
 *     duration   T, seconds; legal
 *     time       seconds, not NaN */
void fmb_pose_at(const struct fmb_placement *placement, double duration, double time,
                 struct fmb_placement *out);

/* ---- Two bodies ---- */

/* Bits of want. fmb_decide() and fmb_scene_begin() accept all but CERTIFICATE; messages and the
 * client library accept all. */
enum fmb_want {
    FMB_WANT_BOX = 1,
    FMB_WANT_CERTIFICATE = 2,
    FMB_WANT_TIMES = 4, /* contact intervals; fmb_decide() always gives them */
    FMB_WANT_GAP = 8,   /* refused by methods that are not certain */
    FMB_WANT_POINT = 16 /* a point of each contact, of methods that are certain */
};

/* An enclosure of the gap, the signed distance of two bodies over the window:
 *
 *   separated    their least distance
 *   touching     0
 *   overlapping  minus the depth, the length of the shortest translation after which the bodies do
 *                not overlap at any time of the window; if a placement has an end, minus the
 *                greatest depth at any one time
 *
 * Of bodies of several frames it is the least gap of a pair of their frames, with its direction and
 * points; frame names that pair. If doubles cannot distinguish the gaps of several pairs, one of
 * these pairs is named. Its gap exceeds the least one by at most the width.
 *
 * Lower bound. The direction n proves it: n . (b - a) >= bounds[0] |n| for all points a of the
 * first frame and b of the second at the same time of the window. If a placement has an end, this
 * holds only at the time of the least distance or the greatest depth; the certificate proves that a
 * pair is separated over the window.
 *
 * Upper bound. For a separated pair the witness points prove it: |b - a| plus the distances of the
 * two points from their frames at that time is at most bounds[1]. For an overlapping pair,
 * bounds[1] is minus the smallest depth over all facets of the Minkowski difference of the two,
 * swept over the window; of a pair with a hull, of a polytope inside of it.
 *
 * Witness points. Those of a separated pair are its nearest points, at the time of the least
 * distance. Those of an overlapping pair without relative motion are a deepest pair: a point a of
 * the first frame and a point b of the second, such that a - b is the depth times the direction. A
 * translation of the second body by a - b separates the two. All of this holds up to the greatest
 * width of an enclosure. The midpoint of a and b may be outside either frame. Pairs that touch, and
 * overlapping pairs that move relative to each other, have no witness points.
 *
 * Frames with a radius: the gap is that of their cores less both radii, and each bound is proven as
 * that of the cores is. The largest coordinate of a vertex, here and in struct fmb_answer, is then
 * that of the cores plus the radius of the frame.
 *
 * Width. bounds[1] - bounds[0] is at most 1e-12 of the largest magnitude of a coordinate of any
 * vertex of either body over the window, plus 32 * 2^-1074. (In a window shorter than 2^-1000 s the
 * time of the least distance may not be a double. bounds[1] then includes the distance that the
 * frames travel in the error of the time.) The lower bound of a separated pair may therefore be
 * below 0, by less than the width: it is what the direction proves; the verdict is exact. If the
 * bodies touch, both bounds are 0. If the frames that are named touch, the direction proves the
 * lower bound up to the same width. A bound, or a coordinate of a witness point, whose magnitude
 * exceeds the largest double is infinite, with its sign: the points then prove no upper bound.
 *
 * Pairs in which a placement has an end: the gap is the least at any one time, so an overlapping
 * pair has minus its greatest depth at one time. time is the time of the least gap, for all
 * verdicts and without witness points too. The direction proves the lower bound at this time only;
 * the witness points of a separated pair prove the upper bound. The enclosure is wider if
 * the search reaches its limit of work, if lengths exceed 2^200, or if all are below 2^-200.
 *
 * Order. The swapped pair has the same bounds, the negated direction, and the points and frames
 * exchanged. If two placements are equal in all numbers, both orders are the same pair and have the
 * same gap. */
struct fmb_gap {
    double bounds[2];               /* lower and upper */
    double direction[FMB_DIM_MAX];  /* from a to b, a unit vector up to rounding */
    bool has_witness;               /* time and witness are set */
    double time;                    /* of the points, or of the least gap, seconds in [0, T] */
    double witness[2][FMB_DIM_MAX]; /* [0] in a, [1] in b, world coordinates */
    unsigned frame[2]; /* [0] of a, [1] of b: the pair of frames; 0 for a body of one frame */
};

/* An answer.
 *
 * The contact is the interval from the first to the last time at which the closed sets meet; the
 * whole window if the velocities are equal. The box is the axis-aligned bounding box of the
 * intersection over the window, in world coordinates. Of bodies of several frames, both are the
 * smallest that contain those of all pairs of frames.
 *
 * Contacts and boxes of the methods certified and exact contain the exact ones.
 *
 *   exact      They are the smallest with ends that are doubles, unless a frame has a radius.
 *   certified  An end of a contact is at most 1e-12 T too far out. An end of a box is too far out
 *              by at most 1e-12 of the largest magnitude of a coordinate of any vertex of either
 *              body over the window. Where that is less than 2^-1074, the least double, an end is
 *              at most one double too far out.
 *
 * Frames with a radius: of both methods, an end of a contact is at most 1e-12 T too far out. The
 * box is not tight: it is the intersection of the boxes of both frames over the contact. An end of
 * either of these is too far out by at most 1e-12 of the largest coordinate, or of the reach of its
 * body if that is larger. It may be infinite if a vertex is a sum of components that exceeds the
 * largest double.
 *
 * Pairs in which a placement has an end: an end of a contact is at most 1e-12 T too far out. The
 * box contains the exact box and is not tight. The contact is divided into sixteen parts; the boxes
 * of both frames over each part are intersected, and the box is the union of these intersections.
 * Both methods give the same contact and box.
 *
 * Only the methods certified and exact give a point. At some time, at most 1e-12 T from the time of
 * the point, both bodies contain a point that differs from it on each axis by at most 1e-12 of the
 * largest such magnitude. A coordinate beyond the largest double is infinite, with its sign. For
 * frames that are neither hulls nor rounded, if doubles suffice, the point is near the middle of
 * the intersection over the window: of axis-aligned cuboids at rest it is the centre; of others the
 * mean of the middles of the parts of edges, and of paths of vertices, of each frame that are
 * within the other, and of the points where edges cross. For bodies of several frames, it belongs
 * to a pair of frames that has the verdict of the bodies.
 *
 * Both methods give the same bits for the swapped pair and on every machine; another version of the
 * library may give different bits within these limits. An end of a box whose magnitude exceeds the
 * largest double is infinite, with its sign. No number is -0. The methods fmb and sat round without
 * such guarantees. */
struct fmb_answer {
    enum fmb_verdict verdict;
    bool has_contact;           /* touching or overlapping */
    bool has_box;               /* wanted, touching or overlapping, and the method gives boxes */
    bool has_gap;               /* wanted, and the method is certain */
    bool has_point;             /* wanted, touching or overlapping, and the method is certain */
    double contact[2];          /* first and last time of contact, seconds, within [0, T] */
    double box[2][FMB_DIM_MAX]; /* [lower, upper][axis], world coordinates; axes beyond dim are 0 */
    double point[1 + FMB_DIM_MAX]; /* a time, seconds, and a point of both bodies at that time */
    struct fmb_gap gap;            /* all 0 if not has_gap */
};

/* A method of deciding. All methods are in one table, in the order of fmb_method_at(). */
struct frame_pair; /* internal */
struct fmb_method {
    const char *name;
    int number;          /* used in messages; never 0, which selects the default */
    const char *summary; /* one line, for people */
    bool certain;        /* never wrong */
    bool boxes;          /* gives boxes of contacts */
    /* Internal: decides one pair of frames. */
    enum fmb_status (*decide)(const struct frame_pair *pair, unsigned want,
                              struct fmb_answer *answer);
};

/* The methods:
 *
 *   certified  The default. Never wrong. Doubles with bounds on their errors decide nearly all
 *              pairs. Exact arithmetic decides those that are too close for doubles, and flat
 *              frames that are not faces with an area.
 *   exact      Never wrong. Uses exact arithmetic throughout.
 *   fmb        The article's elimination in doubles: verdict, interval, the article's loose box.
 *   sat        The separating axis theorem in doubles: verdict and interval, no box.
 *
 * fmb and sat are inexact and cannot decide flat frames, hulls, frames with a radius, or placements
 * with an end.
 *
 * Placements with an end. certified and exact decide these pairs in the same way. It is never
 * wrong, but leaves some pairs without a verdict (FMB_CANNOT_DECIDE): frames whose contact is, or
 * begins or ends with, a single time that is not a multiple of 2^-50 of the window; two flat frames
 * that cross, or stay in one plane, if doubles do not decide them; frames with a radius that stay
 * in contact while the direction of the contact turns relative to both; and pairs that exceed a
 * limit of work. Frames that rest, slide, roll, hang on a hinge, land, lift off or turn together
 * have a verdict if their numbers describe this exactly. Scenes and batches that request only
 * verdicts decide a few more pairs: fmb_decide() always encloses the contact too.
 *
 * Cost: exact takes tens to hundreds of microseconds for numbers of similar size. Its time is
 * bounded for any numbers, as the time of certified is: among pairs whose exponents span the whole
 * range of doubles, a search found none that takes more than 72 million products of 64-bit limbs
 * with box and gap, about 36 ms. Doubles decide most pairs with a hull or a radius by a few scans
 * of all vertices. Exact arithmetic takes some milliseconds for the largest hulls, and up to 60 ms
 * with box and gap if their exponents span that range. The same holds for moving frames with a
 * radius. A scene divides exact work into steps of less than a millisecond.
 *
 * If a placement has an end, doubles give the verdict in microseconds, the contact in tens and the
 * gap in hundreds of microseconds. Exact arithmetic takes tenths of a millisecond for boxes at rest
 * on each other. The limit of work is reached after some ten milliseconds for numbers of similar
 * size, and after 0.7 s for boxes with exponents that span the whole range of doubles. */

/* Return a method from a static table, valid for the life of the program. Thread safe.
 * fmb_method_at() returns NULL if index is past the last method; fmb_method_by_name() and
 * fmb_method_by_number() return NULL if there is no such method. Number 0 is the default. */
const struct fmb_method *fmb_method_default(void);
const struct fmb_method *fmb_method_at(size_t index);
const struct fmb_method *fmb_method_by_name(const char *name);
const struct fmb_method *fmb_method_by_number(int number);

/* Decides one pair of bodies over a window.
 *
 * In:  method    not NULL
 *      a, b      two placements of bodies of one dimension
 *      duration  T of the window [0, T], seconds; finite, not negative; 0 is valid
 *      want      a sum of FMB_WANT_ values
 * Out: *answer   the answer; all 0 if the status is not FMB_OK
 * Returns FMB_OK; a status of fmb_placement_check(); FMB_DIMENSIONS_DIFFER; FMB_BAD_DURATION
 * (negative, not finite, or 0 although a placement has an end); FMB_UNKNOWN_WANT; FMB_CANNOT_DECIDE
 * (the method cannot decide the pair, or a gap is wanted from a method that is not certain).
 * Cost: see the methods above, per pair of frames. */
enum fmb_status fmb_decide(const struct fmb_method *method, const struct fmb_placement *a,
                           const struct fmb_placement *b, double duration, unsigned want,
                           struct fmb_answer *answer);

/* ---- Scenes ----
 *
 * A scene is a set of placed bodies of one or more frames. It is decided in short steps:
 *
 *     struct fmb_scene scene = {.placements = placements, .placement_count = n,
 *                               .duration = 1, .ignored = neighbours, .ignored_count = m};
 *     struct fmb_scene_limits limits;
 *     fmb_scene_limits_of(&scene, &limits);
 *     void *memory = malloc(fmb_scene_bytes(&limits));
 *     struct fmb_scene_state *state;
 *     struct fmb_scene_answers answers;
 *     bool done = fmb_scene_begin(&scene, &limits, memory, &state) != FMB_OK;
 *     while (!done) {
 *         done = fmb_scene_step(state, &answers);
 *         ... answers.pairs[k] meet, k = 0 to answers.count - 1 ...
 *     }
 *
 * The answers are those of fmb_decide() for each pair, bit for bit. Frames of one body are never
 * tested against each other, nor are placements of one group. Memory is allocated only by exact
 * arithmetic and for gaps of pairs with a hull or a radius, as stated at the top. The last step
 * leaves none; fmb_scene_end() frees it if a scene is abandoned before that.
 *
 * Thread safety: one state must not be used by two threads at the same time. Different states share
 * nothing. */

/* Which pairs are decided. Pairs are numbered from 0. Listed pairs have their positions in the
 * list; the others are numbered in the order of (a, b), a < b, ignored pairs and those
 * within a group included. */
enum fmb_pairs {
    FMB_PAIRS_ALL = 0, /* each placement with each later one */
    FMB_PAIRS_LISTED = 1,
    FMB_PAIRS_ACROSS = 2 /* each of the first split placements with each of the others */
};

/* A query. The caller owns all arrays, which must stay valid and unchanged until the last step.
 * With all fields 0 but the placements, which are then at rest, it is for the verdicts of all
 * pairs. */
struct fmb_scene {
    const struct fmb_placement *placements; /* [placement_count], of one dimension */
    size_t placement_count;
    double duration; /* T, seconds; 0 only if all placements are at rest, or if instant */
    bool instant;    /* the window is [0, 0] even if placements move; the duration is 0 */
    /* NULL: the default. A method that is not certain requires FMB_PAIRS_LISTED. */
    const struct fmb_method *method;
    /* Sum of FMB_WANT_ bits; 0: verdicts only. Times and boxes are of pairs that meet, gaps of all
     * pairs in the answers. */
    unsigned want;
    /* Separated pairs whose lower bound of the gap is at most the margin are near. They are
     * included in the answers, and they and the pairs that meet have gaps. Finite, not negative; 0:
     * no pair is near. */
    double margin;
    enum fmb_pairs which;
    size_t split; /* FMB_PAIRS_ACROSS: at most placement_count, 0: no pairs; otherwise 0 */
    /* FMB_PAIRS_LISTED: [pair_count][a, b], indices of two different placements that are not of one
     * group; otherwise none. */
    const unsigned (*pairs)[2];
    size_t pair_count;
    /* [ignored_count][a, b], indices of two different placements in any order; repetitions are
     * allowed. These pairs are not decided. None with FMB_PAIRS_LISTED. */
    const unsigned (*ignored)[2];
    size_t ignored_count;
    unsigned long long first_pair; /* the first pair to decide; at most the number of pairs */
    const char *label; /* for people, not read by the engine: at most 64 bytes; NULL: none */
};

/* Capacities of the memory of a scene. */
struct fmb_scene_limits {
    size_t placements;
    size_t frames; /* of the bodies of all placements together */
    size_t ignored;
    /* Frames that are prepared at the same time, at least FMB_SCENE_SLOTS_MIN; 176 bytes each. If a
     * scene needs more, frames are prepared repeatedly. */
    size_t slots;
};

enum { FMB_SCENE_SLOTS_MIN = 32, FMB_SCENE_SLOTS = 8192 };

/* Sets the limits that hold a scene, with a slot for each frame but no more than
 * FMB_SCENE_SLOTS. */
void fmb_scene_limits_of(const struct fmb_scene *scene, struct fmb_scene_limits *out);

/* Returns the number of bytes that a scene within these limits needs; SIZE_MAX if the limits are
 * too large. */
size_t fmb_scene_bytes(const struct fmb_scene_limits *limits);

/* The answers of one step. The arrays belong to the memory of the scene or to the query, and are
 * valid until the next step. Arrays that were not wanted are NULL. */
struct fmb_scene_answers {
    size_t count;
    const unsigned (*pairs)[2];            /* [count][a, b] */
    const unsigned char *verdicts;         /* [count], enum fmb_verdict; 0: FMB_CANNOT_DECIDE */
    const double (*contacts)[2];           /* [count][first, last], NAN: separated, or no verdict */
    const double (*boxes)[2][FMB_DIM_MAX]; /* [count][lower, upper][axis], NAN: the same pairs */
    const double (*points)[1 + FMB_DIM_MAX]; /* [count][time, coordinates], NAN: the same pairs */
    /* [count], if gaps are wanted or the margin is not 0. Bounds of NAN: no verdict; or, with
     * FMB_PAIRS_LISTED and gaps not wanted, separated and farther apart than the margin. */
    const struct fmb_gap *gaps;
};

struct fmb_scene_state;

/* Checks a scene.
 *
 * In:  size  capacity of why in bytes
 * Out: why   if the status is not FMB_OK, one line that names the place and the reason:
 *            "placements[3]: not a finite number"; may be NULL if size is 0
 * Returns one of:
 *   FMB_OK
 *   FMB_BAD_DURATION       negative, not finite, 0 although a placement moves and instant is not
 *                          set, or not 0 although it is
 *   FMB_BAD_MARGIN, FMB_UNKNOWN_WANT
 *   a status of fmb_placement_check()
 *   FMB_DIMENSIONS_DIFFER  placements of different dimensions
 *   FMB_BAD_PAIR           which is unknown; a pair has an index out of range or the same index
 *                          twice; a listed pair is within a group; split or first_pair is out of
 *                          range
 *   FMB_WRONG_COUNT        pairs without FMB_PAIRS_LISTED, or ignored pairs with it
 *   FMB_CANNOT_DECIDE      a method that is not certain, with gaps, with a margin, or without
 *                          FMB_PAIRS_LISTED
 * Cost: O(placements + pairs). */
enum fmb_status fmb_scene_check(const struct fmb_scene *scene, char *why, size_t size);

/* Checks a scene and begins it.
 *
 * In:  memory  fmb_scene_bytes(limits) bytes at any address; owned by the caller, in use until the
 *              last step
 * Out: *out    the state, in memory; unchanged if the status is not FMB_OK
 * Returns FMB_OK; FMB_OVER_LIMIT if the scene is not within limits, or limits->slots is below the
 * minimum; or a status of fmb_scene_check().
 * Cost: O(placements + frames + pairs). */
enum fmb_status fmb_scene_begin(const struct fmb_scene *scene,
                                const struct fmb_scene_limits *limits, void *memory,
                                struct fmb_scene_state **out);

/* Performs the next part of the work. Answers come in the order of the pairs. With FMB_PAIRS_ALL
 * and FMB_PAIRS_ACROSS, only pairs that meet, are near or have no verdict are answered. A step may
 * have no answers.
 *
 * Out: *answers  the answers of this step
 * Returns whether the scene is complete.
 * Cost: tens of microseconds, except for a step that decides one pair of frames in exact
 * arithmetic, and for the step that finds which placements may meet. The exact decision of a pair
 * with a hull or a radius is divided into several steps. */
bool fmb_scene_step(struct fmb_scene_state *state, struct fmb_scene_answers *answers);

/* Begins a scene again in which only the first placements have other poses: of a robot, then, among
 * obstacles that stand where they are. What others need is kept. If they are of one group, as
 * obstacles that are not tested against each other, they cost next to nothing.
 *
 * In:  state  begun by fmb_scene_begin(), complete or not; not ended
 *      moved  the first `moved` elements of the same array of placements may have a new position,
 *             orientation, velocity and end; nothing else of the query may have changed
 * Returns FMB_OK; FMB_WRONG_COUNT for more than there are; FMB_BAD_DURATION or a status of
 * fmb_placement_check(). Unless it is FMB_OK, the scene is as before the call.
 * Cost: O(moved), with FMB_PAIRS_ALL and FMB_PAIRS_ACROSS O(n log n) of all n placements the first
 * time, and again whenever moved grows. Answers are those of fmb_scene_begin(), bit for bit. */
enum fmb_status fmb_scene_again(struct fmb_scene_state *state, size_t moved);

/* Ends a scene. Required only of one that is abandoned: a decision in exact arithmetic that a step
 * has left unfinished holds memory. The state must not be used any more. */
void fmb_scene_end(struct fmb_scene_state *state);

/* Sets *out to answer k of a step, as fmb_decide() sets it; all 0 if there is no verdict. It has
 * the contact, the box and the gap that were wanted and that the pair has. In: k < answers->count.
 */
void fmb_scene_answer(const struct fmb_scene_answers *answers, size_t k, struct fmb_answer *out);

/* Returns the number of the first pair that has not been answered. It equals the number of pairs if
 * the scene is complete. */
unsigned long long fmb_scene_next_pair(const struct fmb_scene_state *state);

/* Returns the number of the pair of answer k of the last step. In: k < answers.count. */
unsigned long long fmb_scene_number(const struct fmb_scene_state *state, size_t k);

/* Returns the number of pairs of a scene, those that cannot meet included. In: split is at most
 * placement_count. */
unsigned long long fmb_scene_pair_count(const struct fmb_scene *scene);

/* ---- Certificates ----
 *
 * A certificate proves the verdict of a pair; checking it requires no trust in the engine. It is
 * one line of ASCII, in one of the forms
 *
 *     separated normal (X Y Z)
 *     touching normal (X Y Z) at TIME a WEIGHTS b WEIGHTS
 *     overlapping at TIME a WEIGHTS b WEIGHTS
 *
 * TIME (seconds, in [0, T]; 0 for a static pair) and the coordinates X Y Z (X Y in 2D) of the
 * normal N are exact rational numbers in lowest terms: 3, -3, 0, 22/7.
 *
 * WEIGHTS are one or more of INDEX:WEIGHT and INDEX, in ascending order of the indices, separated
 * by spaces: vertices of the frame, and positive rational numbers. Vertex 0 of a tetrahedron or a
 * face is its origin, vertex i + 1 the end of c_i; vertex k of a cuboid or a box is the origin plus
 * the c_i for which bit i of k is set. The vertices of a hull are those of struct fmb_frame, from
 * 0. The vertices of a frame at TIME times their weights sum to a point. The weights of each frame
 * sum to 1, and the points are equal. Weights that these equations determine are left out.
 *
 * The certificate states:
 *   separated    N . (b - a) > 0 for all points a of the first frame and b of the second, at all
 *                times of the window.
 *   touching     N . (b - a) >= 0 for all those points and times, and N is not constant on at least
 *                one of the frames, so that no point is ever in both relative interiors. At TIME
 *                the frames have a point in common.
 *   overlapping  At TIME the frames have a point in common, and the vertices named of each have the
 *                same affine hull as the frame: so the point is in both relative interiors.
 *
 * Of frames with radii, R > 0 their sum, the points and vertices are those of the cores. The two
 * sums need not be the same point, so that only one weight of each frame is left out. The
 * certificate then states:
 *   separated    N . (b - a) > R |N| for all those points and times.
 *   touching     N . (b - a) >= R |N| for all those points and times. At TIME the two points are at
 *                most R apart.
 *   overlapping  At TIME the two points are less than R apart.
 *
 * "overlapping at 0 a 0 1 2:1/16 4 b 0 1:1/16 2 4:1/16" of two cubes: three weights are stated, and
 * five follow from five equations.
 *
 * If a placement has an end, a certificate has one of the forms
 *
 *     separated from LO to HI DIRECTION from LO to HI DIRECTION ...
 *     overlapping at TIME a WEIGHTS b WEIGHTS
 *
 * LO and HI are rational numbers, fractions of the window. The first LO is 0, every other LO is the
 * HI before it, and the last HI is 1: the intervals [LO, HI] cover the window. A DIRECTION n is one
 * of
 *
 *     normal a (X Y Z)           R_A (X Y Z), a vector that turns with A
 *     normal b (X Y Z)           R_B (X Y Z)
 *     product (X Y Z) (U V W)    R_A (X Y Z) x R_B (U V W), in 3D only
 *
 * The certificate states that n . (b - a) > 0, or with radii n . (b - a) > R |n|, for all points a
 * and b at all times of the interval, where n is the direction at the same time. The second form
 * states the same as above, with the poses at TIME. Pairs that turn and touch have no certificate.
 *
 * "separated from 0 to 1/2 normal a (1 0 0) from 1/2 to 1 product (0 1 0) (3 0 -1)"
 */

/* The capacity that every certificate fits into, its terminating 0 included. */
enum { FMB_CERTIFICATE_MAX = 16384 };

/* Writes the certificate of the verdict of the exact method.
 *
 * In:  a, b      bodies of one frame each
 *      duration  T, seconds
 *      size      capacity of text in bytes
 * Out: text      the certificate and a terminating 0; empty if the status is not FMB_OK and size >
 *                0; may be NULL if size is 0
 *      *length   the length of the certificate without the terminating 0, also if the status is
 *                FMB_OVER_LIMIT; 0 for every other failure
 * Returns FMB_OK; FMB_OVER_LIMIT if the certificate does not fit; a status of fmb_decide();
 * FMB_CANNOT_DECIDE for bodies of several frames, and for a pair that turns and has no verdict.
 *
 * A pair whose numbers span more than 512 bits has no certificate: the status is FMB_OK and the
 * text is empty. The span is measured as follows. Let 2^e be the largest power of two that divides
 * every coordinate of every component, origin, vertex of a hull, position and v T of the pair,
 * every radius, and half of every size of a box. Let 2^f be the least power of two above the
 * magnitudes of all these, where the product of such a power for the coordinates of v and one for T
 * stands for v T. Let n be |q|^2 for the smallest integers q that are proportional to the
 * orientation, or 1 without an orientation. Let m be the product of both n, or n itself if they are
 * equal. The pair spans f - e bits plus the number of bits of m.
 *
 * If a placement has an end, the span is measured only for an overlap, at its TIME. There, all
 * lengths are multiples of 2^e / m; 2^f is the least power of two above a bound of all lengths over
 * the window. The limit is 1024 bits. The status is FMB_OK and the text is empty also if such a
 * pair touches, or if more than 256 intervals would be needed.
 *
 * Half of all certificates are shorter than 100 bytes. Those with times in windows of
 * extreme length, and those with normals of touching pairs, are longer. The text is also empty if
 * it would exceed the capacity above; no such pair is known.
 * Cost: about that of the verdict by the exact method. Memory is allocated as by the exact method.
 */
enum fmb_status fmb_certificate(const struct fmb_placement *a, const struct fmb_placement *b,
                                double duration, char *text, size_t size, size_t *length);

/* The same in steps, each of less than a millisecond.
 *
 * fmb_certificate_begin() allocates *state. The placements must outlive it. Returns the status of
 * fmb_certificate(), but never FMB_OVER_LIMIT; *state is NULL if the status is not FMB_OK.
 *
 * fmb_certificate_step() performs a step. Returns NULL until the certificate is complete, then its
 * text, valid until fmb_certificate_end(); an empty text if the pair has no certificate.
 *
 * fmb_certificate_end() frees the state, complete or not; it may be NULL.
 *
 * Thread safety: a state is used by one thread at a time. */
struct fmb_certificate_state;
enum fmb_status fmb_certificate_begin(const struct fmb_placement *a, const struct fmb_placement *b,
                                      double duration, struct fmb_certificate_state **state);
const char *fmb_certificate_step(struct fmb_certificate_state *state);
void fmb_certificate_end(struct fmb_certificate_state *state);

/* Checks a certificate, in rational numbers, by code that shares nothing with fmb_certificate() or
 * with any method. The certificate need not be the one that fmb_certificate() writes.
 *
 * In:  a, b      any placements that fmb_placement_check() accepts
 *      verdict   any number
 *      text      any text ended by a 0
 *      size      capacity of why in bytes
 * Out: why       if false is returned, one line that states what is wrong; may be NULL if size is 0
 * Returns whether the text proves that this is the verdict of this pair. An empty text proves
 * nothing.
 * Cost: polynomial in the length of the text. Memory is allocated through GMP. */
bool fmb_certificate_holds(const struct fmb_placement *a, const struct fmb_placement *b,
                           double duration, enum fmb_verdict verdict, const char *text, char *why,
                           size_t size);

/* Returns the version of the library, "major.minor.patch". The string is static. */
const char *fmb_version(void);

#ifdef __cplusplus
}
#endif
#endif
