/* libfmb: do two rigid bodies meet, when, and in which box?
 *
 * A frame is the set of points o + sum_i x_i c_i with an origin o and component vectors c_i
 * (article, equations 1 and 2), in body coordinates. The parameters x_i run over [0,1] for a
 * cuboid and a box; over x_i >= 0, sum x_i <= 1 for a tetrahedron and a face. A body is one or more
 * frames of one dimension. A placement puts it into the world: its set is exactly
 *
 *     { p + R(q) (o + sum_i x_i c_i) + t v }
 *
 * of all its frames, over the reals, from the doubles given: position p, orientation q, velocity v.
 * The time t runs over the window [0, T], T the duration in seconds. Nothing is rounded before it
 * is compared: not the rotation matrix, not o + c, not v T. The quaternion q = (w, x, y, z) may
 * have any length but 0, and stands for the rotation of q / |q|:
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
 * Verdicts. Two frames OVERLAP if at some time of the window (its ends included) their relative
 * interiors have a point in common; they TOUCH if the closed sets have a point in common at some
 * time, but the relative interiors never do; otherwise they are SEPARATED. So a plate through a box
 * overlaps it, coplanar plates that share area overlap, faces that share an edge touch. The verdict
 * of two bodies is the strongest of those of their frames. It does not depend on the order of the
 * pair (that of the inexact method fmb may).
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
 * All functions are reentrant and keep nothing between calls. No input is written to. Memory is
 * allocated where exact arithmetic is needed (by the method exact, by certified for the few pairs
 * that need it, by certificates, and by fmb_frame_make() for a frame that is nearly flat): through
 * GMP, which ends the process if there is none; it is freed before the function returns. The stack
 * holds up to 100 kB at a time.
 *
 * The answers are the same bits on every machine with 64-bit longs whose doubles are IEEE 754
 * binary64, rounded to nearest; the library is compiled without contraction. The caller must
 * not change the rounding mode or flush subnormals. */
#ifndef FMB_H
#define FMB_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { FMB_DIM_MAX = 3, FMB_COMPONENTS_MAX = FMB_DIM_MAX * FMB_DIM_MAX };

/* What can be said of a question; the numbers stand in messages and logs: a code is retired
 * rather than used again. */
#define FMB_STATUS_MAP(X)                                                                 \
    X(OK, 0, "ok")                                                                        \
    X(UNKNOWN_BODY, 1, "unknown body")                                                    \
    X(BUSY, 2, "busy")                                                                    \
    X(OVER_LIMIT, 3, "over the limit")                                                    \
    X(UNKNOWN_SHAPE, 4, "unknown shape")                                                  \
    X(WRONG_DIMENSION, 5, "wrong dimension")                                              \
    X(WRONG_COUNT, 6, "wrong count of numbers")                                           \
    X(NOT_FINITE, 7, "not a finite number")                                               \
    X(DIMENSIONS_DIFFER, 8, "a 2D body against a 3D one")                                 \
    X(BAD_DURATION, 9, "the duration is negative or not finite")                          \
    X(BAD_ID, 10, "id out of range")                                                      \
    X(UNKNOWN_METHOD, 11, "unknown method")                                               \
    X(UNKNOWN_WANT, 12, "wants what this version does not give")                          \
    X(CANNOT_DECIDE, 13, "this method cannot decide this pair")                           \
    X(NOT_SUPPORTED, 14, "this machine, or this build, does not have what was asked for") \
    X(BAD_PAIR, 15, "indices that name no two frames")                                    \
    X(BAD_ORIENTATION, 16, "an orientation that is no rotation")                          \
    X(BAD_SIZE, 17, "a box of negative size")                                             \
    X(NO_FRAMES, 18, "a body without frames")                                             \
    X(BAD_MARGIN, 19, "the margin is negative or not finite")

enum fmb_status {
#define X(name, number, text) FMB_##name = number,
    FMB_STATUS_MAP(X)
#undef X
        FMB_STATUS_COUNT
};

/* The text of a status, or "unknown status"; static, for people. */
const char *fmb_status_text(int status);

/* The numbers of shapes, verdicts and methods stand in messages and logs too. */
enum fmb_shape { FMB_CUBOID = 1, FMB_TETRAHEDRON = 2, FMB_FACE = 3, FMB_BOX = 4 };
enum fmb_verdict { FMB_SEPARATED = 1, FMB_TOUCHING = 2, FMB_OVERLAPPING = 3 };

/* "cuboid", "tetrahedron", "face", "box"; "separated", "touching", "overlapping"; NULL for another
 * number. Static. */
const char *fmb_shape_name(int shape);
const char *fmb_verdict_name(int verdict);

/* The number of components of a frame of this shape and dimension (2 or 3): dim; 2 for a face.
 * 0 if the two do not go together (a face in 2D) or one of them is unknown. */
int fmb_component_count(int dim, int shape);

/* ---- Bodies ---- */

/* A frame in body coordinates, with what does not change while its body moves: the inverse of its
 * components among it. Fill it with fmb_frame_make() or fmb_frame_make_vertices(); the fields may
 * be read. Axes beyond dim and components beyond count hold 0. */
struct fmb_frame {
    int dim;                 /* 2 or 3 */
    enum fmb_shape shape;    /* FMB_BOX: components along the axes, component[i][i] the size */
    int count;               /* of components */
    bool flat;               /* exactly zero volume (every face is): no inverse */
    bool inverted;           /* the inverse is present: not flat, and all its entries finite */
    bool in_range;           /* doubles can decide pairs with it where it has no orientation, */
    bool sturdy;             /* and with any orientation (frame.c) */
    bool rounded;            /* not all of rest is 0 */
    int bits[2];             /* all components are multiples of 2^bits[0] below 2^bits[1] */
    unsigned long long head; /* of its prepared frames, without orientation and at rest */
    double radius;           /* no vertex is farther from the origin of the body; may be infinite */
    double slack;      /* nor farther from where origin and component have it; 0: those are exact */
    double turn_error; /* what an orientation that rounds adds to that */
    /* Rounded for a box, whose origin is exactly centre - size / 2. */
    double origin[FMB_DIM_MAX];
    double component[FMB_DIM_MAX][FMB_DIM_MAX]; /* [component][axis] */
    double size[FMB_DIM_MAX];                   /* largest magnitude in each component */
    /* [axis][component], rounded: x_i = sum_axis inverse[axis][i] p[axis] for p = sum x_i c_i. The
     * article's invComp (Listing 1, PROJ). 0 where not inverted. */
    double inverse[FMB_DIM_MAX][FMB_DIM_MAX];
    /* Of a frame given by its vertices: its components are component + rest, exactly. */
    double rest[FMB_DIM_MAX][FMB_DIM_MAX];
    double centre[FMB_DIM_MAX]; /* of a box */
};

/* In: dim; shape; count numbers: the origin, then the components one after the other; of a box its
 * centre, then its full size along the axes (0: a flat frame). The first dim numbers may be left
 * out: the origin, or centre, is then 0. numbers may be NULL if count is 0.
 * Returns FMB_OK, or WRONG_DIMENSION, UNKNOWN_SHAPE, WRONG_COUNT, NOT_FINITE, BAD_SIZE (negative),
 * and *out is unspecified. */
enum fmb_status fmb_frame_make(int dim, int shape, const double *numbers, size_t count,
                               struct fmb_frame *out);

/* A tetrahedron (2D: a triangle) from dim + 1 vertices, or a face from three vertices in 3D.
 * Vertices are exact: frames that share vertices share them exactly, although the differences of
 * doubles need not be doubles.
 * In: vertices [vertex][axis], count = vertices * dim numbers, finite.
 * Returns FMB_OK, or WRONG_DIMENSION, UNKNOWN_SHAPE (no tetrahedron or face), WRONG_COUNT,
 * NOT_FINITE (also where a difference is beyond the largest double), and *out is unspecified. */
enum fmb_status fmb_frame_make_vertices(int dim, int shape, const double *vertices, size_t count,
                                        struct fmb_frame *out);

/* A rigid body: what does not change while it moves and turns. Fill it with one of the functions
 * below; it may be copied. A body of one frame holds it; the frames of others are the caller's. */
struct fmb_body {
    double radius; /* no vertex is farther from the origin of the body; may be infinite */
    double box[2][FMB_DIM_MAX]; /* [0] lower, [1] upper: holds all frames, body coordinates */
    int dim;
    unsigned frame_count;
    const struct fmb_frame *frames; /* [frame_count]; NULL: the frame is one */
    struct fmb_frame one;
};

/* Frame i of a body. */
static inline const struct fmb_frame *fmb_body_frame(const struct fmb_body *body, unsigned i)
{
    return body->frames ? &body->frames[i] : &body->one;
}

/* A body of one frame. In and Returns: as fmb_frame_make() and fmb_frame_make_vertices(). */
enum fmb_status fmb_body_make(int dim, int shape, const double *numbers, size_t count,
                              struct fmb_body *out);
enum fmb_status fmb_body_make_vertices(int dim, int shape, const double *vertices, size_t count,
                                       struct fmb_body *out);

/* A body of several frames, all of one dimension, which must outlive it and all its copies. They
 * may overlap: frames of one body are never tested against each other.
 * Returns FMB_OK, NO_FRAMES, DIMENSIONS_DIFFER or OVER_LIMIT (more than FMB_FRAMES_MAX), and *out
 * is unspecified. */
enum { FMB_FRAMES_MAX = 65536 };
enum fmb_status fmb_body_make_frames(const struct fmb_frame *frames, size_t count,
                                     struct fmb_body *out);

/* A body at a place. All 0 but body: at the origin, not turned, at rest. Axes beyond the body's
 * dim are not read. */
struct fmb_placement {
    const struct fmb_body *body;  /* not owned */
    double position[FMB_DIM_MAX]; /* world coordinates of the body's origin, at time 0 */
    double velocity[FMB_DIM_MAX]; /* per second */
    double orientation[4];        /* w, x, y, z (2D: w, z); of any length but 0 */
    int orientation_count;        /* 0: not turned; 4 (2D: 2) */
};

/* Returns FMB_OK; NO_FRAMES (body is NULL or was not made), NOT_FINITE (position or velocity),
 * WRONG_COUNT (orientation_count is neither 0 nor that of the dimension; or it is 0, but
 * orientation is not), BAD_ORIENTATION: all 0, not finite, or a component other than 0 that is more
 * than 2^200 times smaller than the largest. Every function that takes a placement checks it so. */
enum fmb_status fmb_placement_check(const struct fmb_placement *placement);

/* ---- Two bodies ---- */

enum fmb_want { FMB_WANT_BOX = 1, FMB_WANT_GAP = 2 };

/* An enclosure of the gap, the signed distance of two bodies over the window: separated, their
 * least distance; touching, 0; overlapping, minus the depth: the length of the shortest translation
 * after which the bodies do not overlap at any time of the window. Of bodies of several frames: the
 * least of their frames' gaps, with its direction and points.
 *
 * The direction n proves the lower bound: for all points a of the first frame and b of the second
 * at the same time of the window, n . (b - a) >= bounds[0] |n|. The witness points prove the upper
 * bound of a separated pair: |b - a| plus the distances of the two from their frames at that time
 * is at most bounds[1]. bounds[1] of an overlapping pair is minus the smallest depth over all
 * facets of the swept difference of the two.
 *
 * bounds[1] - bounds[0] is at most 1e-12 of the largest magnitude of a coordinate of any vertex of
 * either body over the window, or a few of the least doubles. (In a window shorter than 2^-1000 s
 * the time of the least distance may be no double: bounds[1] then has the way of the frames in as
 * long as time is off.) Touching: both are 0, and the direction proves 0 but for as much. A bound
 * beyond the largest double is infinite, with its sign. The pair the other way round has the same
 * bounds, the negated direction and the points exchanged; two placements that are equal in all
 * numbers are the same pair both ways. */
struct fmb_gap {
    double bounds[2];               /* lower and upper */
    double direction[FMB_DIM_MAX];  /* from a to b, of unit length but for rounding */
    bool has_witness;               /* separated */
    double time;                    /* of the least distance, seconds, within [0, T] */
    double witness[2][FMB_DIM_MAX]; /* [0] of a, [1] of b, world coordinates */
};

/* The answer. The contact is the interval from the first to the last time at which the closed sets
 * meet; of a pair with equal velocities the whole window. The box is that of the intersection, in
 * world coordinates, over the window. Of bodies of several frames both are the hulls of those of
 * their frames.
 *
 * Contacts and boxes of the methods certified and exact contain the exact ones. Those of exact are
 * the smallest of doubles that do: no end is farther off than the next double. Of those of
 * certified, an end of a contact is at most 1e-12 T too far out, and one of a box 1e-12 of the
 * largest magnitude of a coordinate of any vertex of either body over the window;
 * ends that are those of a frame, and small numbers in scenes of such numbers, are exact. Both are
 * the same bits for the pair the other way round and on every machine; another version of the
 * library may give other ones within these limits. An end of a box beyond the largest double is
 * infinite, with its sign. No number is -0. Those of fmb and sat are rounded as they come. */
struct fmb_answer {
    enum fmb_verdict verdict;
    bool has_contact;           /* touching or overlapping */
    bool has_box;               /* wanted, touching or overlapping, and the method gives boxes */
    bool has_gap;               /* wanted, and the method is certain */
    double contact[2];          /* first and last time of contact, seconds, within [0, T] */
    double box[2][FMB_DIM_MAX]; /* [0] lower and [1] upper ends, world coordinates; axes beyond
                                   dim hold 0 */
    struct fmb_gap gap;         /* all 0 without has_gap */
};

/* A way to decide. One table holds them all, in the order of fmb_method_at(). */
struct frame_pair; /* internal */
struct fmb_method {
    const char *name;
    int number;          /* stands in messages; 0 is not used: it asks for the default */
    const char *summary; /* one line, for people */
    bool certain;        /* never wrong */
    bool boxes;          /* gives boxes of contacts */
    /* Internal: decides one pair of frames. */
    enum fmb_status (*decide)(const struct frame_pair *pair, unsigned want,
                              struct fmb_answer *answer);
};

/*   certified  the default: never wrong. Doubles with bounds on their errors decide nearly all
 *              pairs; exact arithmetic those that are too close for doubles, and flat frames that
 *              are no faces with an area
 *   exact      never wrong either, and all of it in exact arithmetic (GMP)
 *   fmb        the article's elimination in doubles: verdict, interval, the article's loose box
 *   sat        the separating axis theorem in doubles: verdict and interval, no box
 * fmb and sat are inexact and cannot decide flat frames.
 *
 * exact takes tens of microseconds for numbers of like size, and a bounded time for any (exact.c
 * derives the bound): about 0.2 ms for a verdict and 1.5 ms with interval and box where the
 * exponents go from one end of the doubles to the other; a gap takes 0.1 ms more. That bounds the
 * time of certified too. */
const struct fmb_method *fmb_method_default(void);
const struct fmb_method *fmb_method_at(size_t index);          /* NULL past the last */
const struct fmb_method *fmb_method_by_name(const char *name); /* NULL: none of that name */
const struct fmb_method *fmb_method_by_number(int number);     /* 0: the default; NULL: none */

/* Decides one pair of bodies over the window [0, duration], in seconds; 0 is a window too.
 * In: method is not NULL; want is a sum of FMB_WANT_ values.
 * Returns FMB_OK and *answer; or a status and *answer all 0: those of fmb_placement_check(),
 * DIMENSIONS_DIFFER, BAD_DURATION (negative or not finite), UNKNOWN_WANT, CANNOT_DECIDE (also a gap
 * by a method that is not certain). */
enum fmb_status fmb_decide(const struct fmb_method *method, const struct fmb_placement *a,
                           const struct fmb_placement *b, double duration, unsigned want,
                           struct fmb_answer *answer);

/* ---- Many pairs of frames at once ----
 *
 * Frames are prepared once for their placement, then pairs are decided by index, thousands at a
 * time:
 *
 *     struct fmb_prepared *frames = aligned_alloc(64, count * sizeof *frames);
 *     for (size_t i = 0; i < count; i++)
 *         fmb_prepare(&placement[i], 0, 1, &frames[i]);
 *     struct fmb_batch batch = {.frames = frames, .frame_count = count, .pairs = pairs,
 *                               .pair_count = n, .duration = 1, .verdicts = verdicts};
 *     fmb_decide_batch(&batch);
 *
 * The answers are those of the method certified, bit for bit, whatever the instructions and the
 * number of threads. */

/* A frame of a placed body: its world coordinates, rounded, with a bound on that error
 * (prepared.h), in two cache lines if it lies at a multiple of 64 bytes (any address that doubles
 * may have is good). Fill it with fmb_prepare() only. It refers to the frame and the placement,
 * which must not change or go while it is used. */
struct fmb_prepared {
    unsigned long long head; /* its kind and sizes */
    /* 3D: origin, components one after the other, error; 2D the same with two numbers for three,
     * then the velocity, and the rest 0. */
    double number[13];
    const struct fmb_frame *frame; /* NULL: not prepared */
    const struct fmb_placement *placement;
};

/* Prepares frames first to first + count - 1 of a placed body. Less than 30 ns a frame.
 * Returns FMB_OK; a status of fmb_placement_check(), or BAD_PAIR where the body has no such frames:
 * all of out is then 0, and pairs with it are refused. */
enum fmb_status fmb_prepare(const struct fmb_placement *placement, unsigned first, unsigned count,
                            struct fmb_prepared *out);

/* The verdict of one pair of frames, certified.
 * Returns FMB_OK; or NOT_FINITE for a frame that was not prepared, DIMENSIONS_DIFFER, BAD_DURATION,
 * and *verdict is unchanged. */
enum fmb_status fmb_meet(const struct fmb_prepared *a, const struct fmb_prepared *b,
                         double duration, enum fmb_verdict *verdict);

/* Instruction sets that the batch is compiled for. FMB_BEST: the best that this machine has, asked
 * at run time. */
enum fmb_instructions { FMB_BEST = 0, FMB_PLAIN = 1, FMB_SSE2 = 2, FMB_AVX2 = 3, FMB_AVX512 = 4 };

/* "best", "plain", "sse2", "avx2", "avx512"; NULL for another number. Static. */
const char *fmb_instructions_name(int instructions);

/* Whether this machine has them, and the library was compiled for them. */
bool fmb_instructions_supported(int instructions);

/* In verdicts of a batch: a pair that was refused, and one that is listed in open. */
enum { FMB_REFUSED = 0, FMB_LEFT_OPEN = 255 };

/* Queries and answers of fmb_decide_batch(). Arrays are the caller's. */
struct fmb_batch {
    const struct fmb_prepared *frames; /* [frame_count]; huge pages help where there are many */
    size_t frame_count;
    const unsigned (*pairs)[2]; /* [pair_count][a, b], indices of frames */
    size_t pair_count;
    double duration; /* T of all pairs, seconds */
    /* [pair_count]: enum fmb_verdict; or FMB_REFUSED, FMB_LEFT_OPEN. */
    unsigned char *verdicts;
    /* [pair_count][first, last], or NULL; as fmb_answer.contact. NAN for pairs that are separated,
     * refused or left open. */
    double (*contacts)[2];
    /* [pair_count][lower, upper][axis], or NULL; as fmb_answer.box; NAN for the same pairs. */
    double (*boxes)[2][FMB_DIM_MAX];
    /* [pair_count], or NULL; as fmb_answer.gap; bounds of NAN for pairs refused or left open. */
    struct fmb_gap *gaps;
    /* Both NULL, or a bound on the time of a call: [pair_count], and the count. Pairs whose verdict
     * or contact (where wanted) needs integers of more than 512 bits, or whose box or gap needs
     * integers, are then left open and listed: open[0] to open[*open_count - 1] are their positions
     * in pairs, ascending. Each of them may take as long as fmb_decide() of a pair; any other takes
     * tens of microseconds at most, and no memory is allocated. Pairs that need more than the
     * filter in doubles are left open too if 32 of the same 128 pairs have been decided before.
     * Which pairs are left open does not depend on the instructions. A batch of one such pair, with
     * both NULL, gives its answer: the same bits as in a batch of all pairs with both NULL. */
    size_t *open;
    size_t *open_count;
    enum fmb_instructions instructions; /* 0: the best */
    /* 0 or 1: the calling one alone. More need a library built with OPENMP=1, and batches of some
     * thousands of pairs to be of use. */
    int threads;
};

/* On output: OK; or the status of the first pair that was refused (DIMENSIONS_DIFFER, NOT_FINITE
 * for a frame that is not prepared, OVER_LIMIT for an index beyond frame_count), all others having
 * been decided; or a status of the whole, and nothing written: BAD_DURATION, NOT_SUPPORTED for
 * instructions or threads that are not there. */
enum fmb_status fmb_decide_batch(const struct fmb_batch *batch);

/* ---- Which pairs may meet ----
 *
 * Most pairs of a large scene are far from each other. A tree of boxes finds those that are not,
 * without asking every one:
 *
 *     struct fmb_tree tree;
 *     void *memory = malloc(fmb_tree_bytes(count));
 *     fmb_tree_build(frames, count, 1, memory, &tree);
 *     for (unsigned i = 0; i < count; i++) {
 *         fmb_tree_ask(&tree, &frames[i], i + 1, found, &n);
 *         ... decide the pairs of i and found[0] to found[n - 1] ...
 *     }
 *
 * or, several times faster and in an order of its own,
 *
 *     struct fmb_tree_place place = {0};
 *     while (fmb_tree_pairs(&tree, &tree, &place, pairs, room, &n) == FMB_OK && n > 0)
 *         ... decide pairs[0] to pairs[n - 1] ...
 *
 * The box of a frame holds all its points at all times of the window. It is the smallest one where
 * no sum of its numbers rounds, and else larger by a few units in the last place of the largest of
 * them. A pair that touches or overlaps is never left out: the boxes have a point in common then;
 * those that merely touch have, too. What is found is the same on every machine. */

/* Where frames are, in memory of the caller's. Fill it with fmb_tree_build() only. */
struct fmb_tree {
    size_t frame_count;
    size_t node_count;
    int dim;
    double duration;
    struct fmb_tree_node *nodes; /* [node_count] */
    struct fmb_tree_box *boxes;  /* [frame_count], in the order below */
    /* [frame_count]: the indices of the frames, neighbours in space near each other. */
    unsigned *order;
};

/* How many bytes a tree of so many frames needs: 76 a frame, and 256 more. SIZE_MAX where
 * that is not a number of bytes, or fmb_tree_build() refuses so many. */
size_t fmb_tree_bytes(size_t count);

/* On input: frames of one dimension, which need not outlive the call; T of all that will be asked;
 * fmb_tree_bytes(count) bytes at any address, which the tree uses from now on. count may be 0, and
 * frames and memory NULL then.
 * On output: OK and *out. Or BAD_DURATION, NOT_FINITE for a frame that is not prepared,
 * DIMENSIONS_DIFFER, OVER_LIMIT for UINT_MAX frames or more, and *out is a tree of no frames.
 *
 * Takes a time that grows as n log n, whatever the frames are. */
enum fmb_status fmb_tree_build(const struct fmb_prepared *frames, size_t count, double duration,
                               void *memory, struct fmb_tree *out);

/* Boxes of anything, for a tree of them. */
struct fmb_boxes {
    int dim; /* 2 or 3 */
    /* Puts box number index, where it is at the start of the window, into box: [lower,
     * upper][axis], no NaN, lower <= upper. */
    void (*at)(const void *context, unsigned index, double box[2][FMB_DIM_MAX]);
    const void *context;
    const double *velocity; /* [dim], finite: of all of them; NULL: at rest */
};

/* The same for boxes, which come one by one and need not be kept.
 * On output: OK, BAD_DURATION, OVER_LIMIT, or WRONG_DIMENSION. */
enum fmb_status fmb_tree_build_boxes(const struct fmb_boxes *boxes, size_t count, double duration,
                                     void *memory, struct fmb_tree *out);

/* The box of a prepared frame over a window, as trees have it: [lower, upper][axis]. */
void fmb_box_of(const struct fmb_prepared *frame, double duration, double box[2][FMB_DIM_MAX]);

/* The same tree for frames that have moved since, or changed. What is found is exactly what a new
 * tree finds; it takes longer to find as frames go far from where they were when the tree was
 * built.
 * On input: tree->frame_count frames.
 * On output: OK; or a status of fmb_tree_build(), and the tree is as it was. */
enum fmb_status fmb_tree_refit(struct fmb_tree *tree, const struct fmb_prepared *frames,
                               double duration);

/* On input: a frame, of the tree or not; out has room for all frames of the tree.
 * On output: OK, and in out[0] to out[*count - 1] the indices of all frames of the tree whose boxes
 * meet that of this one, it itself included, and that are at least from, in ascending order. Or
 * NOT_FINITE for a frame that is not prepared, DIMENSIONS_DIFFER, and *count is 0. The rest of out
 * may be written to. */
enum fmb_status fmb_tree_ask(const struct fmb_tree *tree, const struct fmb_prepared *frame,
                             unsigned from, unsigned *out, size_t *count);

/* How far fmb_tree_pairs() has come; all 0 to begin with. */
struct fmb_tree_place {
    unsigned leaf, node;
    bool inside;
};

/* The least room for pairs. */
enum { FMB_TREE_ROOM = 64 };

/* All pairs of a frame of one tree and a frame of another whose boxes meet; or, of a tree with
 * itself (a == b), all pairs of two of its frames, each once and the smaller index first. Some at a
 * time: each call goes on from *place, and the trees must not change between.
 * On input: out has room for so many pairs.
 * On output: OK, and in out[0] to out[*count - 1] pairs [index in a, index in b], each once;
 * *count is 0 just if there are no more. Or DIMENSIONS_DIFFER, BAD_DURATION for trees of different
 * windows, OVER_LIMIT for less than FMB_TREE_ROOM, and *count is 0. The rest of out may be written
 * to. */
enum fmb_status fmb_tree_pairs(const struct fmb_tree *a, const struct fmb_tree *b,
                               struct fmb_tree_place *place, unsigned (*out)[2], size_t room,
                               size_t *count);

/* ---- Scenes ----
 *
 * Many placed bodies, of one or more frames: which of them meet, when, and in which boxes.
 *
 *     struct fmb_scene scene = {.placements = placements, .placement_count = n,
 *                               .duration = 1, .which = FMB_PAIRS_ALL,
 *                               .ignored = neighbours, .ignored_count = m};
 *     const struct fmb_scene_limits limits = fmb_scene_limits_of(&scene);
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
 * tested against each other. Nothing is allocated except by exact arithmetic. */

/* Which pairs, and how they are numbered from 0: listed ones in their order; the others in the
 * order of (a, b), a < b, ignored ones included. */
enum fmb_pairs {
    FMB_PAIRS_LISTED = 0,
    FMB_PAIRS_ALL = 1,   /* each placement with each later one */
    FMB_PAIRS_ACROSS = 2 /* each of the first split placements with each of the others */
};

/* All arrays are the caller's, and are needed until the last step. */
struct fmb_scene {
    const struct fmb_placement *placements; /* [placement_count], of one dimension */
    size_t placement_count;
    double duration;                 /* T, seconds */
    const struct fmb_method *method; /* NULL: the default; not certain: only FMB_PAIRS_LISTED */
    bool contacts, boxes;            /* wanted, of pairs that meet */
    bool gaps;                       /* wanted, of all pairs in the answers */
    /* Separated pairs whose lower bound is at most the margin are near: they are among the answers.
     * They and pairs that meet have their gaps. Not negative, finite; 0: no pair is near. */
    double margin;
    enum fmb_pairs which;
    size_t split; /* FMB_PAIRS_ACROSS: at most placement_count; else 0 */
    const unsigned (
        *pairs)[2]; /* FMB_PAIRS_LISTED: [pair_count][a, b], two placements; else none */
    size_t pair_count;
    /* [ignored_count], two placements each, in any order, repeats allowed: bodies that may always
     * meet. None with FMB_PAIRS_LISTED. */
    const unsigned (*ignored)[2];
    size_t ignored_count;
    unsigned long long first_pair; /* the answers begin with this pair; at most the total */
};

/* What memory has to hold. */
struct fmb_scene_limits {
    size_t placements;
    size_t frames; /* of the bodies of all placements together */
    size_t ignored;
    /* Frames placed at a time, at least FMB_SCENE_SLOTS_MIN, 176 bytes each. Where a scene needs
     * more, frames are placed again. */
    size_t slots;
};

enum { FMB_SCENE_SLOTS_MIN = 32, FMB_SCENE_SLOTS = 8192 };

/* Those of a scene, with a slot for each frame but at most FMB_SCENE_SLOTS. */
struct fmb_scene_limits fmb_scene_limits_of(const struct fmb_scene *scene);

/* Bytes of memory that a scene within limits needs; SIZE_MAX where that is not a number of bytes.
 */
size_t fmb_scene_bytes(const struct fmb_scene_limits *limits);

/* Answers of one step. Arrays belong to the scene's memory or to the query, and are valid until
 * the next step. */
struct fmb_scene_answers {
    size_t count;
    const unsigned (*pairs)[2];    /* [count][a, b] */
    const unsigned char *verdicts; /* [count], enum fmb_verdict; FMB_REFUSED: CANNOT_DECIDE */
    const double (*contacts)[2];   /* [count], where wanted; NAN: separated or refused */
    const double (*boxes)[2][FMB_DIM_MAX]; /* [count], where wanted, likewise */
    /* [count], where gaps are wanted or the margin is not 0; bounds of NAN: refused, or, with
     * FMB_PAIRS_LISTED and gaps not wanted, separated and farther apart than the margin. */
    const struct fmb_gap *gaps;
};

struct fmb_scene_state;

/* In: memory of fmb_scene_bytes(limits) bytes, at any address.
 * Returns FMB_OK and *out, in memory; or OVER_LIMIT (the scene is not within limits, or slots below
 * the minimum), a status of fmb_placement_check(), DIMENSIONS_DIFFER, BAD_DURATION, BAD_MARGIN,
 * BAD_PAIR (an index that is no placement, a placement with itself, split, first_pair), WRONG_COUNT
 * (pairs that are listed where none are, or ignored where they are listed), CANNOT_DECIDE (a method
 * that is not certain, with gaps, with a margin or without FMB_PAIRS_LISTED). */
enum fmb_status fmb_scene_begin(const struct fmb_scene *scene,
                                const struct fmb_scene_limits *limits, void *memory,
                                struct fmb_scene_state **out);

/* Does the next part of the work: tens of microseconds, except a step that decides one pair of
 * frames in exact arithmetic, and the one that finds which placements may meet. The answers come
 * in the order of the pairs; of FMB_PAIRS_ALL and FMB_PAIRS_ACROSS those that meet, and
 * near ones.
 * Returns whether the scene is complete. */
bool fmb_scene_step(struct fmb_scene_state *state, struct fmb_scene_answers *answers);

/* The first pair that has not been answered. The total number of pairs: the scene is complete. */
unsigned long long fmb_scene_next_pair(const struct fmb_scene_state *state);

/* The number of the pair of answer k of the last step. */
unsigned long long fmb_scene_number(const struct fmb_scene_state *state, size_t k);

/* How many pairs there are, whether they can meet or not. In: split at most placement_count. */
unsigned long long fmb_scene_pair_count(const struct fmb_scene *scene);

/* ---- Certificates ----
 *
 * What proves the verdict of a pair to one who does not believe the engine: a line of ASCII, in
 * one of the forms
 *
 *     separated NORMAL
 *     touching NORMAL at TIME (X Y Z)
 *     overlapping at TIME (X Y Z)
 *
 * TIME (seconds, in [0, T]; 0 for a static pair) and the world coordinates X Y Z (X Y in 2D) are
 * exact, in lowest terms: 3, -3, 0, 22/7. NORMAL is a sign and a direction: "+ " or "- ", then U,
 * U x V or (U x V) x W, cross products of vectors with these names:
 *
 *     a0..a5, b0..b5   edges of the first frame and of the second: a0, a1, a2 the components c_0,
 *                      c_1, c_2; of a tetrahedron in 3D a3, a4, a5 = c_1 - c_0, c_2 - c_0,
 *                      c_2 - c_1; of a tetrahedron in 2D and of a face a2 = c_1 - c_0; all of
 *                      them turned by the orientation, R(q) c
 *     v                velocity of the second minus that of the first, a missing one being 0
 *     d                origin of the second minus that of the first
 *     z                (0, 0, 1), in 2D only: such pairs lie in the plane z = 0
 *
 * With N the direction times the sign:
 *   separated    N . (b - a) > 0 for all points a of the first frame and b of the second, at all
 *                times of the window;
 *   touching     N . (b - a) >= 0 for them, and N is not constant on at least one of the frames,
 *                so that no point is ever in both relative interiors; and at TIME the point is in
 *                both frames;
 *   overlapping  at TIME the point is in the relative interiors of both frames. */

/* On input: both bodies have one frame; text has room for size bytes, and may be NULL if size is 0.
 * On output: OK, the certificate of the verdict of the exact method, ended by a 0, in text, and
 * its length without the 0 in *length. FMB_OVER_LIMIT if there is no room for it; *length then
 * tells its length. Or a status of fmb_decide(), CANNOT_DECIDE for bodies of several frames,
 * and *length is 0. Where it is not OK, the text is empty if size > 0.
 *
 * Most are shorter than 200 bytes. Coordinates of flat frames, and of frames that touch, can need
 * many digits where the numbers of the pair do: up to some 60,000 bytes where exponents go from one
 * end of the doubles to the other. The point is the simplest on its way where the numbers of the
 * pair span at most 512 bits; else it is whatever takes least time. A certificate takes 50
 * microseconds for numbers of like size, and 6 ms at most. Memory is allocated as by the exact
 * method. */
enum fmb_status fmb_certificate(const struct fmb_placement *a, const struct fmb_placement *b,
                                double duration, char *text, size_t size, size_t *length);

/* On input: any placements that fmb_placement_check() accepts, any number for a verdict, any text
 * ended by a 0.
 * On output: whether the text proves that this is the verdict of this pair. It is checked in
 * rational numbers, by code that shares nothing with fmb_certificate(), nor with any method. If
 * not, why says in one line what is wrong; it has room for size bytes, and may be NULL if that
 * is 0. The certificate need not be the one that fmb_certificate() gives. Memory is allocated
 * through GMP; the time is bounded by a power of the length of the text. */
bool fmb_certificate_holds(const struct fmb_placement *a, const struct fmb_placement *b,
                           double duration, enum fmb_verdict verdict, const char *text, char *why,
                           size_t size);

/* "major.minor.patch" of the library. */
const char *fmb_version(void);

#ifdef __cplusplus
}
#endif
#endif
