/* libfmb: what scenes (fmb.h) are built from, for programs that choose the pairs themselves:
 * prepared frames, batches of pairs of frames, and trees of their boxes.
 *
 * This header is unstable: these functions and structs may change in any version, patch versions
 * included, and programs that use them have to be compiled again. The answers have the same bits as
 * with fmb.h.
 */
#ifndef FMB_BATCH_H
#define FMB_BATCH_H

#include "fmb.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Many pairs of frames at once ----
 *
 * Each frame is prepared once for its placement. Pairs are then decided by index, thousands at a
 * time:
 *
 *     struct fmb_prepared *frames = aligned_alloc(64, count * sizeof *frames);
 *     for (size_t i = 0; i < count; i++)
 *         fmb_prepare(&placement[i], 0, 1, &frames[i]);
 *     struct fmb_batch batch = {.frames = frames, .frame_count = count, .pairs = pairs,
 *                               .pair_count = n, .duration = 1, .verdicts = verdicts};
 *     fmb_decide_batch(&batch);
 *
 * The answers have the same bits as those of the method certified. */

/* A frame of a placed body: its rounded world coordinates and a bound on their error (prepared.h).
 * Filled by fmb_prepare() only. It points to the frame and the placement, which must stay valid and
 * unchanged while it is used. Any alignment that is valid for doubles will do; at a multiple of 64
 * bytes it occupies exactly two cache lines. */
struct fmb_prepared {
    unsigned long long summary; /* flags, and upper bounds of the lengths of the components */
    /* 3D: origin, components in order, error. 2D: the same with two numbers for each vector, then
     * the velocity, then zeros. */
    double number[13];
    const struct fmb_frame *frame; /* NULL: not prepared */
    const struct fmb_placement *placement;
};

/* Prepares frames first to first + count - 1 of a placed body.
 *
 * In:  placement  must outlive the prepared frames
 * Out: out        [count]; all 0 if the status is not FMB_OK, and pairs with such frames are
 *                 invalid
 * Returns FMB_OK; a status of fmb_placement_check(); FMB_BAD_PAIR if the body has no such frames.
 * Cost: less than 30 ns a frame. */
enum fmb_status fmb_prepare(const struct fmb_placement *placement, unsigned first, unsigned count,
                            struct fmb_prepared *out);

/* Decides the verdict of one pair of frames by the method certified.
 *
 * In:  a, b      prepared frames of one dimension
 *      duration  T, seconds
 * Out: *verdict  unchanged if the status is not FMB_OK
 * Returns FMB_OK; FMB_NOT_FINITE for a frame that is not prepared; FMB_DIMENSIONS_DIFFER;
 * FMB_BAD_DURATION. */
enum fmb_status fmb_decide_prepared(const struct fmb_prepared *a, const struct fmb_prepared *b,
                                    double duration, enum fmb_verdict *verdict);

/* Decides a pair of placed bodies of one frame each, like fmb_decide() by the method certified with
 * FMB_WANT_TIMES, if this allocates no memory and needs only the work that a batch does for a pair.
 *
 * In:  arguments that fmb_decide() accepts; they are not checked
 * Returns true if the answer is complete; if false, *answer is unspecified. Reentrant. */
bool fmb_decide_at_once(const struct fmb_placement *a, const struct fmb_placement *b,
                        double duration, unsigned want, struct fmb_answer *answer);

/* In and out of fmb_decide_batch(). The caller owns all arrays. Frames and pairs are read only; the
 * others are written. */
struct fmb_batch {
    const struct fmb_prepared *frames; /* [frame_count]; huge pages help if there are many */
    size_t frame_count;
    const unsigned (*pairs)[2]; /* [pair_count][a, b], indices of frames */
    size_t pair_count;
    double duration; /* T of all pairs, seconds; 0 only if all frames are at rest, or if instant */
    bool instant;    /* the window is [0, 0] even if frames move; the duration is 0 */
    /* [pair_count]: enum fmb_verdict; 0 for a pair that is listed in open, and for an invalid pair:
     * fmb_decide_prepared() of its frames returns why. */
    unsigned char *verdicts;
    /* [pair_count][first, last], seconds, or NULL; as fmb_answer.contact. NAN for pairs that are
     * separated or have no verdict. */
    double (*contacts)[2];
    /* [pair_count][lower, upper][axis], or NULL; as fmb_answer.box. NAN for the same pairs. */
    double (*boxes)[2][FMB_DIM_MAX];
    /* [pair_count][time, coordinates], or NULL; as fmb_answer.point. NAN for the same pairs. */
    double (*points)[1 + FMB_DIM_MAX];
    /* [pair_count], or NULL; as fmb_answer.gap. Bounds of NAN for pairs without a verdict. */
    struct fmb_gap *gaps;
    /* Both NULL; or [pair_count] positions and their count, which bound the time of a call.
     *
     * Both NULL: every pair is decided.
     *
     * Otherwise a pair is left open if its verdict or its box needs more than integers of 512 bits,
     * if its contact needs integers at all, or if the first search in doubles does not give its
     * gap or its point; of a pair with a hull or a radius, if doubles do not give all that is
     * wanted. A pair that the filter in doubles does not decide is also left open if 32 of the same
     * 128 pairs have already been decided after the filter; or, if it has a hull or a radius, if
     * the pairs of this kind among these 128 already had so many vertices that their scans take
     * some hundred microseconds. Which pairs are left open does not depend on the machine. open[0]
     * to open[*open_count - 1] are the positions in pairs of those left open, ascending.
     *
     * A pair that is left open may take as long as fmb_decide() of one pair; any other takes tens
     * of microseconds at most and allocates no memory. A batch of that one pair with both NULL
     * gives its answer: the same bits as in a batch of all pairs with both NULL. */
    size_t *open;
    size_t *open_count;
};

/* Decides the pairs of a batch.
 *
 * Returns one of:
 *   FMB_OK            every pair was decided or left open
 *   FMB_BAD_DURATION  negative, not finite, 0 although a frame moves and instant is not set, or
 *                     not 0 although it is; nothing was written
 *   status of a pair  the status of the first invalid pair: FMB_DIMENSIONS_DIFFER, FMB_NOT_FINITE
 *                     (a frame that is not prepared), FMB_OVER_LIMIT (an index of frame_count or
 *                     more). All other pairs were decided or left open.
 * Thread safety: calls may run at the same time if they write to different arrays. */
enum fmb_status fmb_decide_batch(const struct fmb_batch *batch);

/* ---- Which pairs may meet ----
 *
 * Most pairs of a large scene are far apart. A tree of axis-aligned bounding boxes finds the others
 * without testing every pair:
 *
 *     struct fmb_tree tree;
 *     void *memory = malloc(fmb_tree_bytes(count));
 *     fmb_tree_build(&boxes, count, 1, memory, &tree);
 *     struct fmb_tree_cursor cursor = {0};
 *     while (fmb_tree_pairs(&tree, &tree, &cursor, pairs, capacity, &n) == FMB_OK && n > 0)
 *         ... decide pairs[0] to pairs[n - 1] ...
 *
 * The order of the pairs is unspecified, but the same in every run.
 *
 * The box of a frame contains all its points at all times of the window. It is the smallest such
 * box if no sum of the frame's numbers rounds; otherwise it is larger by a few units in the last
 * place of the largest of them. Boxes are closed: those that only touch overlap. A pair that
 * touches or overlaps is therefore never left out. The results are the same on every machine.
 *
 * Thread safety: functions that take a const tree may run at the same time on one tree. */

/* A tree over the boxes of frames, in the caller's memory. Filled by fmb_tree_build() only. */
struct fmb_tree {
    size_t frame_count;
    size_t node_count;
    int dim;
    double duration;             /* T, seconds */
    struct fmb_tree_node *nodes; /* [node_count] */
    struct fmb_tree_box *boxes;  /* [frame_count], in the order of the leaves */
    unsigned *order;             /* [frame_count], in the same order: the indices of the frames */
};

/* Returns the number of bytes that a tree of count frames needs: 76 a frame, plus 256. Returns
 * SIZE_MAX if that number is not representable, or if fmb_tree_build() refuses so many frames. */
size_t fmb_tree_bytes(size_t count);

/* A source of boxes for fmb_tree_build(). */
struct fmb_boxes {
    int dim; /* 2 or 3 */
    /* Writes box number index, at the start of the window, to box: [lower, upper][axis]. No end is
     * NaN; lower <= upper. fmb_box_of() gives the box of a prepared frame. */
    void (*at)(const void *context, unsigned index, double box[2][FMB_DIM_MAX]);
    const void *context;    /* passed to at() */
    const double *velocity; /* [dim], finite, per second, of all boxes; NULL: at rest */
};

/* Builds a tree of boxes. at() is called once for each index, in ascending order; the boxes need
 * not be stored by the caller.
 *
 * In:  duration  T of all queries, seconds
 *      memory    fmb_tree_bytes(count) bytes at any address; the tree uses them until the caller
 *                frees them; may be NULL if count is 0
 * Out: *out      the tree; a tree of no frames if the status is not FMB_OK
 * Returns FMB_OK; FMB_BAD_DURATION; FMB_WRONG_DIMENSION; FMB_OVER_LIMIT for UINT_MAX boxes or more.
 * Cost: O(n log n) for any boxes. */
enum fmb_status fmb_tree_build(const struct fmb_boxes *boxes, size_t count, double duration,
                               void *memory, struct fmb_tree *out);

/* Computes the box of a prepared frame over the window [0, duration].
 * Out: box  [lower, upper][axis] */
void fmb_box_of(const struct fmb_prepared *frame, double duration, double box[2][FMB_DIM_MAX]);

/* The position of an enumeration by fmb_tree_pairs(). All 0: the beginning. */
struct fmb_tree_cursor {
    unsigned leaf, node;
    bool inside;
};

/* The least capacity that fmb_tree_pairs() accepts, in pairs. */
enum { FMB_TREE_CAPACITY_MIN = 64 };

/* Enumerates the pairs of a frame of a and a frame of b whose boxes overlap. If a == b, these are
 * the pairs of two different frames of the tree, each once and with the smaller index first. Each
 * call continues where the last one ended; the trees must not change in between.
 *
 * In:  capacity  pairs that out can hold, at least FMB_TREE_CAPACITY_MIN
 *      *cursor   all 0 in the first call, then as the last call left it
 * Out: out       out[0] to out[*count - 1] are pairs [index in a, index in b], each once. The
 *                elements after them are unspecified.
 *      *count    0 if and only if there are no more pairs or the status is not FMB_OK
 * Returns FMB_OK; FMB_DIMENSIONS_DIFFER; FMB_BAD_DURATION for trees of different windows;
 * FMB_OVER_LIMIT if capacity is less than FMB_TREE_CAPACITY_MIN. */
enum fmb_status fmb_tree_pairs(const struct fmb_tree *a, const struct fmb_tree *b,
                               struct fmb_tree_cursor *cursor, unsigned (*out)[2], size_t capacity,
                               size_t *count);

#ifdef __cplusplus
}
#endif
#endif
