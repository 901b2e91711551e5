#include "scene_frames.h"

#include "motion.h"
#include "rotation.h"

enum {
    WORK_MAX = 30000,   /* nanoseconds, roughly, as the others; the search pauses above it */
    WORK_PREPARE = 400, /* of a chunk */
    WORK_SELECT = 200,  /* of the frames of two chunks */
    WORK_TEST = 4       /* of two boxes */
};

/* ---- Boxes of bodies ---- */

/* Returns one axis of the box of a rotated body, {low, -high}. row is the row of the rotation
 * matrix, m the centre and h the half extents of the box in body coordinates, sum = S below.
 *
 * A point of the box is m + y, |y_j| <= h_j. Its world coordinate on the axis is
 *
 *     p + R m + R y,  |R y| <= sum_j |R_j| h_j     for the row R of the axis.
 *
 * Accuracy, with u = 2^-53 and S = sum_j (|m_j| + h_j), which bounds the length of m + y:
 *
 *     13 u S    a row is off by less than 13 u (rotation.h)
 *     3.01 u S  R m and sum |R_j| h_j are off by 3.01 u times the magnitudes of their terms
 *     u S       the sum of the two
 *     u S       half
 *
 * ROTATION_ERROR S = 21 u S covers all of them. The sum with p is moved outward by a unit in the
 * last place, and by 2^-1060 for underflow. A NaN, from infinite numbers, becomes -infinity: the
 * box is unbounded on that side. */
static lanes rotated_axis(const double *row, const double m[FMB_DIM_MAX],
                          const double h[FMB_DIM_MAX], double sum, double position)
{
    const double centre = (row[0] * m[0] + row[1] * m[1]) + row[2] * m[2];
    const double reach = (fabs(row[0]) * h[0] + fabs(row[1]) * h[1]) + fabs(row[2]) * h[2];
    const double half = reach + ROTATION_ERROR * sum;
    const double low = position + (centre - half), high = -position - (centre + half);
    const double below = low - (fabs(low) * 0x1p-52 + 0x1p-1060);
    const double above = high - (fabs(high) * 0x1p-52 + 0x1p-1060);
    return (lanes){below > -INFINITY ? below : -INFINITY, above > -INFINITY ? above : -INFINITY};
}

static struct aabb rotated_box(const struct fmb_placement *placement, double duration)
{
    const struct fmb_body *body = placement->body;
    struct rotation_matrix rotation;
    struct aabb out = {{{0}}};
    double m[FMB_DIM_MAX], h[FMB_DIM_MAX], sum = 0;
    if (motion_turns(placement, duration))
        return motion_box(placement, body->box, body->reach);
    rotation_of(placement, body->dim, &rotation);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        const double low = body->box[0][axis], high = body->box[1][axis];
        m[axis] = 0.5 * low + 0.5 * high;
        const double above = high - m[axis], below = m[axis] - low;
        h[axis] = (above > below ? above : below) * (1 + 0x1p-51);
        sum += fabs(m[axis]) + h[axis];
    }
    for (int axis = 0; axis < body->dim; axis++) {
        const double row[FMB_DIM_MAX] = {rotation_entry(&rotation, axis, 0),
                                         rotation_entry(&rotation, axis, 1),
                                         rotation_entry(&rotation, axis, 2)};
        out.end[axis] = aabb_sweep_axis(rotated_axis(row, m, h, sum, placement->position[axis]),
                                        placement->velocity[axis], duration);
    }
    return out;
}

static struct aabb unbounded_box(int dim)
{
    struct aabb out = {{{0}}};
    for (int axis = 0; axis < dim; axis++)
        out.end[axis] = lanes_of(-INFINITY);
    return out;
}

/* ---- Chunks ---- */

static struct scene_chunk *chunk_of(const struct scene_frames *frames, unsigned body, size_t k)
{
    return &frames->chunk[frames->first_chunk[body] + k];
}

static unsigned chunk_size(const struct scene_frames *frames, unsigned body, size_t k)
{
    const size_t left = frames->placement[body].body->frame_count - k * SCENE_CHUNK;
    return (unsigned) (left < SCENE_CHUNK ? left : SCENE_CHUNK);
}

/* Returns whether the frames of a chunk are in their slots. */
static bool is_prepared(const struct scene_frames *frames, const struct scene_chunk *chunk)
{
    return chunk->generation == frames->generation;
}

/* Sets the boxes of a chunk of count frames. turns: motion_turns() of its body. */
INLINE void set_chunk_boxes(struct scene_frames *frames, struct scene_chunk *chunk, unsigned count,
                            const bool turns)
{
    const unsigned first = chunk->slot;
    for (unsigned i = first; i < first + count; i++) {
        if (turns)
            frames->frame_box[i] = motion_box_of(&frames->slot[i]);
        else
            frames->frame_box[i] = aabb_of(&frames->slot[i], frames->duration);
        chunk->box =
            i == first ? frames->frame_box[i] : aabb_union(chunk->box, frames->frame_box[i]);
    }
}

/* Prepares chunk k of a body into its slots, and sets its boxes. */
static void fill_chunk(struct scene_frames *frames, unsigned body, size_t k)
{
    struct scene_chunk *chunk = chunk_of(frames, body, k);
    const unsigned count = chunk_size(frames, body, k);
    prepared_place(&frames->placement[body], (unsigned) k * SCENE_CHUNK, count,
                   &frames->slot[chunk->slot]);
    frames->work += WORK_PREPARE;
    if (!frames->boxed)
        return;
    if (motion_turns(&frames->placement[body], frames->duration))
        set_chunk_boxes(frames, chunk, count, true);
    else
        set_chunk_boxes(frames, chunk, count, false);
}

/* The same, into the next slots. In: they suffice. */
static void prepare_chunk(struct scene_frames *frames, unsigned body, size_t k)
{
    struct scene_chunk *chunk = chunk_of(frames, body, k);
    chunk->generation = frames->generation;
    chunk->slot = (unsigned) frames->used;
    frames->used += chunk_size(frames, body, k);
    fill_chunk(frames, body, k);
}

/* Prepares the chunks of a body that has moved anew: those in slots at once. */
static void renew_chunks(struct scene_frames *frames, unsigned body)
{
    const size_t count = scene_chunks(frames->placement[body].body->frame_count);
    for (size_t k = 0; k < count; k++) {
        struct scene_chunk *chunk = chunk_of(frames, body, k);
        if (is_prepared(frames, chunk))
            fill_chunk(frames, body, k);
        else
            chunk->generation = 0;
    }
}

/* Makes sure that count slots are free. Returns false if the slots do not suffice and may not be
 * released. */
static bool reserve_slots(struct scene_frames *frames, size_t count, bool may_reuse)
{
    if (count <= frames->slots - frames->used)
        return true;
    if (may_reuse) {
        frames->used = 0;
        frames->generation++;
    }
    return may_reuse;
}

/* Prepares the current chunks of a cursor. Returns as reserve_slots(). */
static bool prepare_both(struct scene_frames *frames, const struct frame_pair_cursor *cursor,
                         bool may_reuse)
{
    const unsigned body[2] = {cursor->a, cursor->b};
    const size_t k[2] = {cursor->chunk_a, cursor->chunk_b};
    size_t missing = 0;
    for (int side = 0; side < 2; side++)
        if (!is_prepared(frames, chunk_of(frames, body[side], k[side])))
            missing += chunk_size(frames, body[side], k[side]);
    if (!reserve_slots(frames, missing, may_reuse))
        return false;
    for (int side = 0; side < 2; side++)
        if (!is_prepared(frames, chunk_of(frames, body[side], k[side])))
            prepare_chunk(frames, body[side], k[side]);
    return true;
}

/* Sets the box of a chunk, by preparing it. Returns as reserve_slots(). */
static bool set_chunk_box(struct scene_frames *frames, unsigned body, size_t k, bool may_reuse)
{
    if (chunk_of(frames, body, k)->generation > 0)
        return true;
    if (!reserve_slots(frames, chunk_size(frames, body, k), may_reuse))
        return false;
    prepare_chunk(frames, body, k);
    return true;
}

/* Expands the box of a body by half of the margin, and a little more. If two such boxes do not
 * overlap, their bodies are farther apart on an axis than the margin plus 1e-12 of the largest
 * coordinate. A computed bound of the gap then also exceeds the margin (gap.h). */
static void expand(struct aabb *box, double margin)
{
    const double by = 0.5 * margin + (0x1p-39 * aabb_max_coordinate(box) + 0x1p-1070);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        box->end[axis] = aabb_sum_down(box->end[axis], lanes_of(-by));
}

void scene_frames_add(struct scene_frames *frames, unsigned i, bool bounded)
{
    const struct fmb_placement *placement = &frames->placement[i];
    renew_chunks(frames, i);
    if (frames->direct) {
        set_chunk_box(frames, i, 0, true);
        frames->body_box[i] = chunk_of(frames, i, 0)->box;
    } else {
        frames->body_box[i] = bounded ? rotated_box(placement, frames->duration)
                                      : unbounded_box(placement->body->dim);
    }
    if (frames->margin > 0)
        expand(&frames->body_box[i], frames->margin);
}

/* ---- Pairs of frames ---- */

/* Returns whether two boxes are within reach. */
static bool is_within_reach(const struct aabb *a, const struct aabb *b, double reach)
{
    const struct aabb probe = aabb_probe_within(b, reach);
    return aabb_overlaps(a, &probe);
}

/* out := the slots of the frames of a chunk whose boxes are within reach of a box. Returns their
 * number. */
static unsigned select_frames(const struct scene_frames *frames, unsigned body, size_t k,
                              const struct aabb *box, double reach, unsigned out[SCENE_CHUNK])
{
    const struct aabb probe = aabb_probe_within(box, reach);
    const unsigned first = chunk_of(frames, body, k)->slot, size = chunk_size(frames, body, k);
    unsigned count = 0;
    for (unsigned slot = first; slot < first + size; slot++) {
        out[count] = slot;
        count += aabb_overlaps(&frames->frame_box[slot], &probe);
    }
    return count;
}

/* Selects the frames of each current chunk that are within reach of the other chunk. In: both
 * chunks are prepared. */
static void select_candidates(struct scene_frames *frames, struct frame_pair_cursor *cursor)
{
    const struct aabb *a = &chunk_of(frames, cursor->a, cursor->chunk_a)->box;
    const struct aabb *b = &chunk_of(frames, cursor->b, cursor->chunk_b)->box;
    cursor->count_a =
        select_frames(frames, cursor->a, cursor->chunk_a, b, cursor->reach, cursor->of_a);
    cursor->count_b =
        select_frames(frames, cursor->b, cursor->chunk_b, a, cursor->reach, cursor->of_b);
    cursor->i = cursor->j = 0;
    cursor->inside = true;
    frames->work += WORK_SELECT;
}

/* Writes the next pairs of the selected frames to out; returns their number, at most max. */
static size_t candidate_pairs(const struct scene_frames *frames, struct frame_pair_cursor *cursor,
                              unsigned (*out)[2], size_t max)
{
    unsigned i = cursor->i, j = cursor->j;
    size_t count = 0;
    for (; i < cursor->count_a; i++, j = 0) {
        const struct aabb probe =
            aabb_probe_within(&frames->frame_box[cursor->of_a[i]], cursor->reach);
        for (; j < cursor->count_b && count < max; j++) {
            out[count][0] = cursor->of_a[i];
            out[count][1] = cursor->of_b[j];
            count += aabb_overlaps(&frames->frame_box[cursor->of_b[j]], &probe);
        }
        if (count == max)
            break;
    }
    cursor->i = i;
    cursor->j = j;
    cursor->inside = i < cursor->count_a;
    return count;
}

/* Advances to the next two chunks whose boxes are within reach, and prepares them. Returns false if
 * there are none (*done is then true), or if the search has to pause. */
static bool find_chunks(struct scene_frames *frames, struct frame_pair_cursor *cursor,
                        bool may_reuse, bool *done)
{
    const size_t count_a = scene_chunks(frames->placement[cursor->a].body->frame_count);
    const size_t count_b = scene_chunks(frames->placement[cursor->b].body->frame_count);
    const struct aabb *body_b = &frames->body_box[cursor->b];
    for (; cursor->chunk_a < count_a; cursor->chunk_a++, cursor->chunk_b = 0) {
        if (!set_chunk_box(frames, cursor->a, cursor->chunk_a, may_reuse))
            return false;
        const struct aabb *a = &chunk_of(frames, cursor->a, cursor->chunk_a)->box;
        frames->work += WORK_TEST;
        for (bool skip = !is_within_reach(a, body_b, cursor->reach);
             !skip && cursor->chunk_b < count_b; cursor->chunk_b++) {
            if (frames->work > WORK_MAX ||
                !set_chunk_box(frames, cursor->b, cursor->chunk_b, may_reuse))
                return false;
            frames->work += WORK_TEST;
            if (is_within_reach(a, &chunk_of(frames, cursor->b, cursor->chunk_b)->box,
                                cursor->reach))
                return prepare_both(frames, cursor, may_reuse);
        }
        if (frames->work > WORK_MAX)
            return false;
    }
    *done = true;
    return false;
}

/* The pair of two bodies of one frame each. Returns 0 if the slots do not suffice. */
static size_t single_pair(struct scene_frames *frames, const struct frame_pair_cursor *cursor,
                          bool may_reuse, unsigned (*out)[2], bool *done)
{
    if (!prepare_both(frames, cursor, may_reuse))
        return 0;
    out[0][0] = chunk_of(frames, cursor->a, 0)->slot;
    out[0][1] = chunk_of(frames, cursor->b, 0)->slot;
    *done = true;
    return 1;
}

size_t scene_frames_pairs(struct scene_frames *frames, struct frame_pair_cursor *cursor,
                          bool may_reuse, unsigned (*out)[2], size_t max, bool *done)
{
    size_t count = 0;
    *done = false;
    if (frames->placement[cursor->a].body->frame_count == 1 &&
        frames->placement[cursor->b].body->frame_count == 1)
        return single_pair(frames, cursor, may_reuse, out, done);
    while (count < max) {
        if (!cursor->inside) {
            if (!find_chunks(frames, cursor, may_reuse && count == 0, done))
                break;
            select_candidates(frames, cursor);
        }
        count += candidate_pairs(frames, cursor, out + count, max - count);
        if (!cursor->inside)
            cursor->chunk_b++;
    }
    return count;
}
