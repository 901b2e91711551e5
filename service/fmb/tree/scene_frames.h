/* The frames of a scene, prepared on demand, and the pairs of frames of two bodies.
 *
 * The frames of a body are divided into chunks of up to SCENE_CHUNK consecutive frames. The frames
 * of a chunk are prepared together, into consecutive slots. When the slots run out, all are
 * released at once, and a chunk that is needed again is prepared again. The boxes of chunks and
 * bodies are kept.
 *
 * All memory belongs to the caller. A struct scene_frames must not be used by two threads at the
 * same time. */
#ifndef FMB_SCENE_FRAMES_H
#define FMB_SCENE_FRAMES_H

#include "aabb.h"

enum { SCENE_CHUNK = 16 };

struct scene_chunk {
    struct aabb box;               /* contains the frames over the window */
    unsigned long long generation; /* of its slots; 0: never prepared, and box is not set */
    unsigned slot;                 /* of the first frame */
};

struct scene_frames {
    const struct fmb_placement *placement;
    double duration;           /* T, seconds */
    double margin;             /* between bodies: each box is expanded by half of it */
    bool boxed;                /* boxes of frames and chunks are needed */
    bool direct;               /* every body has one frame; slot i is that of placement i */
    unsigned *first_chunk;     /* [placement], index into chunk */
    struct scene_chunk *chunk; /* [chunk] */
    struct aabb *body_box;     /* [placement], over the window */
    struct fmb_prepared *slot; /* [slots] */
    struct aabb *frame_box;    /* [slots] */
    size_t slots, used;
    unsigned long long generation; /* of the slots in use, from 1 */
    long work;                     /* nanoseconds, roughly; reset by the caller */
};

/* Returns the number of chunks of a body with this number of frames. */
static inline size_t scene_chunks(size_t frames)
{
    return (frames + SCENE_CHUNK - 1) / SCENE_CHUNK;
}

/* Adds placement i, or one that was added and has moved. Placements are added in order at first.
 * Sets its box, expanded by half of the margin, and, if direct, prepares its frame. bounded: the
 * box contains the frames as the method computes them. Otherwise the box is unbounded, since an
 * inexact method may place a frame outside. */
void scene_frames_add(struct scene_frames *frames, unsigned i, bool bounded);

/* The position of the enumeration of the frame pairs of a pair of bodies. */
struct frame_pair_cursor {
    unsigned a, b;           /* placements */
    double reach;            /* largest distance of the boxes of two frames, on every axis */
    size_t chunk_a, chunk_b; /* current chunks of the bodies, from 0 */
    /* inside: of_a[count_a] and of_b[count_b] are set, the slots of the frames of each chunk that
     * are within reach of the other chunk; the next pair is of_a[i], of_b[j]. */
    bool inside;
    unsigned i, j, count_a, count_b;
    unsigned of_a[SCENE_CHUNK], of_b[SCENE_CHUNK];
};

/* Starts the enumeration for placements a and b. reach: >= 0, as for aabb_probe_within(). */
static inline void frame_pair_cursor_begin(struct frame_pair_cursor *cursor, unsigned a, unsigned b,
                                           double reach)
{
    cursor->reach = reach;
    cursor->a = a;
    cursor->b = b;
    cursor->chunk_a = cursor->chunk_b = 0;
    cursor->inside = false;
}

/* Enumerates the pairs of frames of two bodies whose boxes are within reach. The only pair of two
 * bodies of one frame each is always included.
 *
 * In:  may_reuse  the caller uses no slot, so that all slots may be released
 *      max        capacity of out
 * Out: out        [count][a, b], the next pairs, as slots
 *      *done      true if these bodies have no more pairs; otherwise out is full, the work is at
 *                 its limit, or the slots ran out
 * Returns count, at most max. */
size_t scene_frames_pairs(struct scene_frames *frames, struct frame_pair_cursor *cursor,
                          bool may_reuse, unsigned (*out)[2], size_t max, bool *done);

#endif
