/* The frames of a scene, prepared when a pair needs them.
 *
 * The frames of a body are divided into chunks of up to SCENE_CHUNK consecutive frames. The frames
 * of a chunk are prepared together, into consecutive slots. When the slots run out, all are
 * released at once, and a chunk that is needed again is prepared again. The boxes of chunks and
 * bodies are kept. */
#ifndef FMB_SCENE_FRAMES_H
#define FMB_SCENE_FRAMES_H

#include "aabb.h"

enum { SCENE_CHUNK = 16 };

struct scene_chunk {
    struct aabb box;               /* contains its frames over the window */
    unsigned long long generation; /* of its slots; 0: never prepared, and box is not set */
    unsigned slot;                 /* of its first frame */
};

struct scene_frames {
    const struct fmb_placement *placement;
    double duration;
    double margin;             /* of bodies: half of it is added to the box of each */
    bool boxed;                /* boxes are needed */
    bool direct;               /* every body has one frame, slot i that of placement i */
    unsigned *first_chunk;     /* [placement] */
    struct scene_chunk *chunk; /* [chunk] */
    struct aabb *body_box;     /* [placement], over the window */
    struct fmb_prepared *slot; /* [slots] */
    struct aabb *frame_box;    /* [slots] */
    size_t slots, used;
    unsigned long long generation; /* of the slots in use, from 1 */
    long work;                     /* nanoseconds, roughly; reset by the caller */
};

/* Number of chunks of a body of so many frames. */
static inline size_t scene_chunks(size_t frames)
{
    return (frames + SCENE_CHUNK - 1) / SCENE_CHUNK;
}

/* Adds the next placement: sets its box, widened by the margin, and, if direct, prepares its frame.
 * bounded: the box contains the frames as the method sees them. Otherwise it is set to be
 * unbounded, since an inexact method may place a frame beyond it. */
void scene_frames_add(struct scene_frames *frames, unsigned i, bool bounded);

/* The position of the enumeration of the frame pairs of a pair of bodies. */
struct frame_pair_cursor {
    unsigned a, b;           /* placements */
    double reach;            /* largest distance of the boxes of frames on an axis */
    size_t chunk_a, chunk_b; /* of the bodies, from 0 */
    /* The frames of two chunks that may meet: slots [of_a[i], of_b[j]] is the next pair. */
    bool inside;
    unsigned i, j, count_a, count_b;
    unsigned of_a[SCENE_CHUNK], of_b[SCENE_CHUNK];
};

static inline void frame_pair_cursor_begin(struct frame_pair_cursor *cursor, unsigned a, unsigned b,
                                           double reach)
{
    cursor->reach = reach;
    cursor->a = a;
    cursor->b = b;
    cursor->chunk_a = cursor->chunk_b = 0;
    cursor->inside = false;
}

/* Writes the next pairs of frames whose boxes are within reach to out, as slots; of two bodies of
 * one frame each, that pair in any case. Returns how many, at most max. *done: these bodies have no
 * more pairs. Otherwise out is full, the work is at its limit, or the slots ran out. may_reuse: no
 * slot is in use, so that the slots may be released. */
size_t scene_frames_pairs(struct scene_frames *frames, struct frame_pair_cursor *cursor,
                          bool may_reuse, unsigned (*out)[2], size_t max, bool *done);

#endif
