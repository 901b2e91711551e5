/* libfmb: do two frames meet, when, and in which box?
 *
 * A frame is the set of points
 *
 *     o + t v + sum_i x_i c_i
 *
 * with an origin o, a velocity v and component vectors c_i (article, equations 1 and 2).
 * The parameters x_i run over [0,1] for a cuboid; over x_i >= 0, sum x_i <= 1 for a
 * tetrahedron and a face. The time t runs over the window [0, T] of the pair, T seconds.
 * The set is meant exactly, over the reals, from the doubles given: nothing is rounded
 * before it is compared, neither o + c nor v T.
 *
 * What touching means: two frames OVERLAP when at some time of the window (its ends
 * included) their relative interiors have a point in common; they TOUCH when the closed
 * sets have a point in common, but never so; else they are SEPARATED. So a plate through a
 * box overlaps it, coplanar plates that share area overlap, faces that share an edge touch.
 * The verdict does not depend on the order of the pair (that of the inexact method fmb may).
 *
 * Use:
 *
 *     struct fmb_body cube;
 *     static const double edges[9] = {1,0,0, 0,1,0, 0,0,1};
 *     fmb_body_make(3, FMB_CUBOID, edges, 9, &cube);
 *     struct fmb_pair pair = {.a = {.body = &cube}, .b = {.body = &cube, .origin = {1, 0, 0}}};
 *     struct fmb_answer answer;
 *     fmb_decide(fmb_method_default(), &pair, FMB_WANT_BOX, &answer);
 *     // answer.verdict is FMB_TOUCHING, the box is [1,1] x [0,1] x [0,1]
 *
 * Link with -lfmb -lgmp -lm (pkg-config fmb).
 *
 * All functions are reentrant and keep nothing between calls. No input is written to.
 * Memory is allocated where exact arithmetic is needed (by the exact method, by the certified one
 * for the few pairs that need it, by certificates), and by fmb_body_make() for a body that is
 * nearly flat: through GMP, which ends the process if there is none; it is freed before they
 * return. The stack holds up to 100 kB at a time.
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
    X(DIMENSIONS_DIFFER, 8, "a 2D frame against a 3D one")                                \
    X(BAD_DURATION, 9, "the duration is negative or not finite")                          \
    X(BAD_ID, 10, "id out of range")                                                      \
    X(UNKNOWN_METHOD, 11, "unknown method")                                               \
    X(UNKNOWN_WANT, 12, "wants what this version does not give")                          \
    X(CANNOT_DECIDE, 13,                                                                  \
      "this method cannot decide this pair (a flat frame, or numbers out of its range)")  \
    X(NOT_SUPPORTED, 14, "this machine, or this build, does not have what was asked for") \
    X(BAD_PAIR, 15, "indices that name no two frames")                                    \
    X(BAD_ORIENTATION, 16, "an orientation that is no rotation")                          \
    X(BAD_SIZE, 17, "a box of negative size")                                             \
    X(NO_FRAMES, 18, "a body without frames")

enum fmb_status {
#define X(name, number, text) FMB_##name = number,
    FMB_STATUS_MAP(X)
#undef X
        FMB_STATUS_COUNT
};

/* The text of a status, or "unknown status"; static, for people. */
const char *fmb_status_text(int status);

/* The numbers of shapes, verdicts and methods stand in messages and logs too. */
enum fmb_shape { FMB_CUBOID = 1, FMB_TETRAHEDRON = 2, FMB_FACE = 3 };
enum fmb_verdict { FMB_SEPARATED = 1, FMB_TOUCHING = 2, FMB_OVERLAPPING = 3 };

/* "cuboid", "tetrahedron", "face"; "separated", "touching", "overlapping"; NULL for another
 * number. Static. */
const char *fmb_shape_name(int shape);
const char *fmb_verdict_name(int verdict);

/* How many components a frame of this shape and dimension (2 or 3) has: dim; 2 for a face.
 * 0 where the two do not go together (a face in 2D) or one of them is unknown. */
int fmb_component_count(int dim, int shape);

/* What does not change while a rigid body moves without turning: worth keeping by id.
 * Fill it with fmb_body_make() or fmb_body_make_triangle() only. Axes beyond dim and components
 * beyond the shape's count hold 0. */
struct fmb_body {
    int dim; /* 2 or 3 */
    enum fmb_shape shape;
    int count;     /* of components */
    bool flat;     /* exactly zero volume (every face is): no inverse */
    bool inverted; /* the inverse is there: not flat, and all its entries finite */
    /* Whether doubles can say anything of it: not flat, or a face with an area, and no number so
     * large or so small that a product of a few of them might overflow or vanish. */
    bool in_range;
    bool rounded;            /* not all of rest is 0 */
    int bits[2];             /* all components are multiples of 2^bits[0] below 2^bits[1] */
    unsigned long long head; /* of frames with this body at rest, prepared (below) */
    double component[FMB_DIM_MAX][FMB_DIM_MAX]; /* [component][axis] */
    double size[FMB_DIM_MAX];                   /* the largest magnitude in each component */
    /* [axis][component], rounded, of a nearly flat body too: x_i = sum_axis inverse[axis][i]
     * p[axis] for p = sum x_i c_i. The article's invComp (Listing 1, PROJ). Zero where not
     * inverted. */
    double inverse[FMB_DIM_MAX][FMB_DIM_MAX];
    /* Of a face made by fmb_body_make_triangle(): its components are component + rest, exactly. */
    double rest[2][FMB_DIM_MAX];
};

/* On input: dim; shape; count numbers, components one after the other, number
 * [component * dim + axis], any finite doubles.
 * On output: *out, or a status (WRONG_DIMENSION, UNKNOWN_SHAPE, WRONG_COUNT, NOT_FINITE) and
 * *out unspecified. components may be NULL if count is 0. */
enum fmb_status fmb_body_make(int dim, int shape, const double *components, size_t count,
                              struct fmb_body *out);

/* A face by its vertices, which need not be the sums of two doubles: vertex[0] is the origin of its
 * frames, and the others are vertex[0] + component + rest exactly. So faces that share vertices do
 * so exactly.
 * On input: [vertex][axis], any finite doubles.
 * On output: *out, or NOT_FINITE, where a difference is beyond the doubles too, and *out
 * unspecified. */
enum fmb_status fmb_body_make_triangle(const double vertex[3][FMB_DIM_MAX], struct fmb_body *out);

/* A body at a place. Axes beyond the body's dim are not read. */
struct fmb_frame {
    const struct fmb_body *body; /* not owned; must outlive the call */
    double origin[FMB_DIM_MAX];
    double velocity[FMB_DIM_MAX]; /* per second; read only where moving */
    bool moving;                  /* carries a velocity, zero included */
};

/* The question. The pair is moving when a or b is; else it is static, and the window only
 * has to be legal. */
struct fmb_pair {
    struct fmb_frame a, b;
    double duration; /* T, seconds, >= 0; 0 is a window too. The article's equations have T = 1 */
};

/* On output: OK, or DIMENSIONS_DIFFER, NOT_FINITE, BAD_DURATION. Every function that takes a
 * pair from outside checks it so first. */
enum fmb_status fmb_pair_check(const struct fmb_pair *pair);

enum fmb_want { FMB_WANT_BOX = 1 };

/* The answer. The box is that of the intersection, in world coordinates; of a moving pair, of the
 * union of its intersections over the window.
 *
 * Intervals and boxes of the methods certified and exact contain the exact ones. Those of exact are
 * the smallest of doubles that do: no end is farther off than the next double. Of those of
 * certified, an end of an interval is at most 1e-12 T too far out, and one of a box 1e-12 of the
 * largest magnitude of a coordinate of any vertex of either frame over the window; in
 * scenes of small whole numbers, halves and quarters most are the tightest. Both are the same bits
 * for the pair the other way round and on every machine; another version of the library may give
 * other ones within these limits. An end of a box beyond the largest double is infinite, with its
 * sign. No number is -0. Those of fmb and sat are rounded as they come. */
struct fmb_answer {
    enum fmb_verdict verdict;
    bool has_contact;           /* moving pair, touching or overlapping */
    bool has_box;               /* wanted, touching or overlapping, and the method gives boxes */
    double contact[2];          /* first and last time of contact, seconds, within [0, T] */
    double box[2][FMB_DIM_MAX]; /* [0] lower and [1] upper ends, world coordinates; axes beyond
                                   dim hold 0 */
};

/* A way to decide. One table holds them all, in the order of fmb_method_at(). */
struct fmb_method {
    const char *name;
    int number;          /* stands in messages; 0 is not used: it asks for the default */
    const char *summary; /* one line, for people */
    bool certain;        /* never wrong */
    bool boxes;          /* gives boxes of contacts */
    /* On input: a checked pair, *answer all 0. On output: OK and *answer, or CANNOT_DECIDE. Not to
     * be called directly: fmb_decide() checks. */
    enum fmb_status (*decide)(const struct fmb_pair *pair, unsigned want,
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
 * exponents go from one end of the doubles to the other. That bounds the time of certified too. */
const struct fmb_method *fmb_method_default(void);
const struct fmb_method *fmb_method_at(size_t index);          /* NULL past the last */
const struct fmb_method *fmb_method_by_name(const char *name); /* NULL: none of that name */
const struct fmb_method *fmb_method_by_number(int number);     /* 0: the default; NULL: none */

/* On input: method is not NULL; want is a sum of FMB_WANT_ values.
 * On output: OK and *answer; or a status and *answer all 0: those of fmb_pair_check(),
 * UNKNOWN_WANT, CANNOT_DECIDE. */
enum fmb_status fmb_decide(const struct fmb_method *method, const struct fmb_pair *pair,
                           unsigned want, struct fmb_answer *answer);

/* ---- Many pairs at once ----
 *
 * Frames are prepared once, and then pairs of them asked by index, thousands at a time:
 *
 *     struct fmb_prepared *frames = aligned_alloc(64, count * sizeof *frames);
 *     for (size_t i = 0; i < count; i++)
 *         fmb_prepare(&frame[i], &frames[i]);
 *     struct fmb_batch batch = {.frames = frames, .frame_count = count, .pairs = pairs,
 *                               .pair_count = n, .duration = 1, .verdicts = verdicts};
 *     fmb_decide_batch(&batch);
 *
 * The answers are those of the method certified, bit for bit, whatever the instructions and the
 * number of threads. */

/* A frame made ready: all that is asked of it in two cache lines, if it lies at a multiple of 64
 * bytes (any address that doubles may have is good). It holds no pointer: the body need not
 * outlive it. Fill it with fmb_prepare() only. */
struct fmb_prepared {
    unsigned long long head; /* its kind and sizes (prepared.h) */
    /* 3D: origin, components one after the other, velocity; 2D the same with two numbers for three,
     * and the rest 0. Of a frame that is not moving, the velocity is 0. */
    double number[15];
};

/* There is no room for the rest of a body that is rounded: pairs with it that doubles leave open,
 * few but where they touch or nearly, get the verdict 0; and where boxes are wanted, all that are
 * not surely separated. fmb_decide() is to be asked of them.
 * On output: OK, or NOT_FINITE and *out all 0: pairs with it are refused. */
enum fmb_status fmb_prepare(const struct fmb_frame *frame, struct fmb_prepared *out);

/* The verdict of one pair, certified; 0 where it is refused: dimensions that differ, a duration
 * that is negative or not finite, a frame that was not prepared; and where it is left open. */
enum fmb_verdict fmb_meet(const struct fmb_prepared *a, const struct fmb_prepared *b,
                          double duration);

/* Instruction sets that the batch is compiled for. FMB_BEST: the best that this machine has, asked
 * at run time. */
enum fmb_instructions { FMB_BEST = 0, FMB_PLAIN = 1, FMB_SSE2 = 2, FMB_AVX2 = 3, FMB_AVX512 = 4 };

/* "best", "plain", "sse2", "avx2", "avx512"; NULL for another number. Static. */
const char *fmb_instructions_name(int instructions);

/* Whether this machine has them, and the library was compiled for them. */
bool fmb_instructions_supported(int instructions);

/* What fmb_decide_batch() is asked, and where it puts the answers. Arrays are the caller's. */
struct fmb_batch {
    const struct fmb_prepared *frames; /* [frame_count]; huge pages help where there are many */
    size_t frame_count;
    const unsigned (*pairs)[2]; /* [pair_count][a, b], indices of frames */
    size_t pair_count;
    double duration; /* T of all pairs, seconds */
    /* [pair_count]: enum fmb_verdict; 0 where the pair is refused, or left open (fmb_prepare()). */
    unsigned char *verdicts;
    /* [pair_count][first, last], or NULL; as fmb_answer.contact. NAN where there is none: separated
     * pairs, static ones, refused ones, moving ones left open. */
    double (*contacts)[2];
    /* [pair_count][lower, upper][axis], or NULL; as fmb_answer.box. NAN where there is none. */
    double (*boxes)[2][FMB_DIM_MAX];
    /* Both NULL, or a bound on the time of a call: [pair_count], and where the count goes. Pairs
     * whose verdict, contact or box (as far as these are wanted) needs integers of more than 128
     * bits are then not decided but listed: open[0] to open[*open_count - 1] are their positions in
     * pairs, ascending; their verdict is 0, their contact and box NAN. Each of them may take as
     * long as fmb_decide() of a pair; any other takes tens of microseconds at most, and no memory
     * is allocated. Where no boxes are wanted, pairs that need more than the filter in doubles are
     * listed too if 32 of the same 128 pairs have been decided before. A batch of one such pair,
     * with both NULL, gives its answer: the same bits as in a batch of all pairs with both NULL.
     * Pairs that are refused, and pairs with a body that is rounded (fmb_prepare()), are not
     * listed. */
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
 *                      c_2 - c_1; of a tetrahedron in 2D and of a face a2 = c_1 - c_0
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

/* On input: text has room for size bytes; it may be NULL if size is 0.
 * On output: OK, the certificate of the verdict of the exact method, ended by a 0, in text, and
 * its length without the 0 in *length. FMB_OVER_LIMIT if there is no room for it; *length then
 * tells its length. Or a status of fmb_pair_check(), and *length is 0. Where it is not OK, the
 * text is empty if size > 0.
 *
 * Most are shorter than 200 bytes. Coordinates of flat frames, and of frames that touch, can need
 * many digits where the numbers of the pair do: up to some 60,000 bytes where exponents go from one
 * end of the doubles to the other. The point is the simplest on its way where the numbers of the
 * pair span at most 512 bits; else it is whatever takes least time. A certificate takes 50
 * microseconds for numbers of like size, and 6 ms at most. Memory is allocated as by the exact
 * method. */
enum fmb_status fmb_certificate(const struct fmb_pair *pair, char *text, size_t size,
                                size_t *length);

/* On input: any pair of bodies made by fmb_body_make() or fmb_body_make_triangle(), any number for
 * a verdict, any text ended by a 0.
 * On output: whether the text proves that this is the verdict of this pair. It is checked in
 * rational numbers, by code that shares nothing with fmb_certificate(), nor with any method. If
 * not, why says in one line what is wrong; it has room for size bytes, and may be NULL if that
 * is 0. The certificate need not be the one that fmb_certificate() gives. Memory is allocated
 * through GMP; the time is bounded by a power of the length of the text. */
bool fmb_certificate_holds(const struct fmb_pair *pair, enum fmb_verdict verdict, const char *text,
                           char *why, size_t size);

/* "major.minor.patch" of the library. */
const char *fmb_version(void);

#ifdef __cplusplus
}
#endif
#endif
