/* Which pairs may meet: a binary tree of boxes.
 *
 * Method. Boxes of the frames are split in two halves, along an axis and by their centres, until
 * there are few enough for a leaf. The halves are full leaves but for the last one, so the shape of
 * the tree, its depth and where each node stands follow from the number of frames alone, whatever
 * the boxes are; boxes decide only who goes where. Time: a bounded number of passes over the boxes
 * a level (select_first() says how many), and as many levels as the number of leaves has bits.
 *
 * Nothing here can lose a pair: centres and axes are rounded, or no number at all, and only make a
 * tree good or bad. */
#include "tree.h"

#include <float.h>
#include <limits.h>
#include <stdint.h>
#include <string.h>

enum { CACHE_LINE = 64, DEPTH_MAX = 33 };

_Static_assert(sizeof(struct fmb_tree_node) == CACHE_LINE, "a node is a cache line");

static size_t leaves_of(size_t frames)
{
    return frames / TREE_LEAF + (frames % TREE_LEAF != 0);
}

static size_t nodes_of(size_t frames)
{
    return frames ? 2 * leaves_of(frames) - 1 : 0;
}

/* The nodes are fewer than frames / 2 + 2: no sum here overflows where that of the first line does
 * not. */
size_t fmb_tree_bytes(size_t count)
{
    const size_t each = sizeof(struct fmb_tree_box) + sizeof(unsigned) + CACHE_LINE / 2;
    if (count >= UINT_MAX || count > (SIZE_MAX - 3 * CACHE_LINE) / each)
        return SIZE_MAX;
    return CACHE_LINE + nodes_of(count) * sizeof(struct fmb_tree_node) +
           count * (sizeof(struct fmb_tree_box) + sizeof(unsigned));
}

/* ---- Centres ---- */

/* Of an axis, or 0 of a box without ends; may be infinite. */
static inline double centre_of(const struct fmb_tree_box *box, int axis)
{
    const lanes end = box->box.end[axis];
    const double centre = end[0] * 0.5 - end[1] * 0.5;
    return centre == centre ? centre : 0;
}

/* The least and the greatest centre of boxes on each axis; as a box, {least, -greatest}. */
static struct swept centres_of(const struct fmb_tree_box *box, size_t count)
{
    struct swept out;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out.end[axis] = lanes_of(INFINITY);
    for (size_t i = 0; i < count; i++)
        for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
            const lanes half = box[i].box.end[axis] * 0.5;
            const lanes centre = half - (lanes){half[1], half[0]};
            out.end[axis] = lanes_least(centre, out.end[axis]); /* that, where it is no number */
        }
    return out;
}

/* How far the centres reach on an axis; finite. */
static double reach_of(lanes centres)
{
    const lanes ends = lanes_greatest(centres, lanes_of(-DBL_MAX / 4));
    const double reach = -ends[0] - ends[1];
    return reach > 0 ? reach : 0;
}

/* ---- The axis ---- */

/* How large boxes are against the reach of their centres, each at most 1: the part of them that
 * would be in both halves. Of large numbers of them, a few are asked. least: what is added to each,
 * so that of small boxes the longest axis is best. */
static double share_in_both(const struct fmb_tree_box *box, size_t count, int axis, double reach,
                            double least)
{
    enum { ASKED = 16 };
    const size_t stride = count / ASKED + 1;
    double sum = 0, asked = 0;
    for (size_t i = 0; i < count; i += stride, asked++) {
        const lanes end = box[i].box.end[axis];
        const double size = (-end[0] - end[1] + least) / reach;
        sum += size < 1 ? size : 1;
    }
    return sum / asked;
}

/* The axis on which halves have the fewest boxes in common, of equal ones the longest; -1 if all
 * centres are the same. */
static int axis_of(const struct fmb_tree_box *box, size_t count)
{
    const struct swept centres = centres_of(box, count);
    double reach[FMB_DIM_MAX], best = 2;
    int longest = 0, out = -1;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        reach[axis] = reach_of(centres.end[axis]);
        longest = reach[axis] > reach[longest] ? axis : longest;
    }
    for (int k = 0; k < FMB_DIM_MAX; k++) {
        const int axis = (longest + k) % FMB_DIM_MAX;
        if (reach[axis] == 0)
            continue;
        const double share = share_in_both(box, count, axis, reach[axis], reach[longest] * 0x1p-10);
        if (share < best) {
            best = share;
            out = axis;
        }
    }
    return out;
}

/* ---- Halves ---- */

/* Boxes with the indices of their frames, and what they are put in order by. */
struct items {
    struct fmb_tree_box *box; /* [count] */
    unsigned *order;          /* [count] */
    size_t count;
    int axis;
    bool by_end; /* by their lower ends: the centres are all the same */
};

static inline double key_of(const struct items *items, size_t i)
{
    return items->by_end ? items->box[i].box.end[items->axis][0]
                         : centre_of(&items->box[i], items->axis);
}

static inline void swap_items(const struct items *items, size_t i, size_t j)
{
    const struct fmb_tree_box box = items->box[i];
    const unsigned index = items->order[i];
    items->box[i] = items->box[j];
    items->box[j] = box;
    items->order[i] = items->order[j];
    items->order[j] = index;
}

/* Few of them. Their ranks are counted, equal ones in the order they are in, and then those that
 * are on the wrong side change places. */
enum { FEW = 12 };

static void select_few(const struct items *items, size_t target)
{
    double key[FEW];
    unsigned char rank[FEW];
    for (size_t i = 0; i < items->count; i++)
        key[i] = key_of(items, i);
    for (size_t i = 0; i < items->count; i++) {
        unsigned before = 0;
        for (size_t j = 0; j < i; j++)
            before += key[j] <= key[i];
        for (size_t j = i + 1; j < items->count; j++)
            before += key[j] < key[i];
        rank[i] = (unsigned char) before;
    }
    for (size_t i = 0, j = target; i < target; i++) {
        if (rank[i] < target)
            continue;
        while (rank[j] >= target)
            j++;
        swap_items(items, i, j++);
    }
}

/* Two ends of what is not parted yet: [first, end). */
struct rest {
    size_t first, end;
};

/* Parts blocks from both ends until there is less than two of them: which boxes are on the wrong
 * side is written down first, and they change places then, so that no branch is guessed. */
static struct rest part_blocks(const struct items *items, double pivot)
{
    enum { BLOCK = 64 };
    unsigned char left[BLOCK], right[BLOCK];
    size_t left_count = 0, right_count = 0, left_done = 0, right_done = 0;
    struct rest rest = {0, items->count};
    while (rest.end - rest.first >= 2 * BLOCK) {
        if (left_done == left_count) {
            left_done = left_count = 0;
            for (size_t i = 0; i < BLOCK; i++) {
                left[left_count] = (unsigned char) i;
                left_count += key_of(items, rest.first + i) >= pivot;
            }
        }
        if (right_done == right_count) {
            right_done = right_count = 0;
            for (size_t i = 0; i < BLOCK; i++) {
                right[right_count] = (unsigned char) i;
                right_count += key_of(items, rest.end - 1 - i) <= pivot;
            }
        }
        while (left_done < left_count && right_done < right_count)
            swap_items(items, rest.first + left[left_done++], rest.end - 1 - right[right_done++]);
        rest.first += left_done == left_count ? BLOCK : 0;
        rest.end -= right_done == right_count ? BLOCK : 0;
    }
    return rest;
}

/* Puts those at most as large as the pivot before those at least as large, and returns how many are
 * before. Neither side is empty if the least is not above and the greatest not below the pivot:
 * equal ones go to both sides. */
static size_t part(const struct items *items, double pivot)
{
    struct rest rest = part_blocks(items, pivot);
    for (;; rest.first++, rest.end--) {
        while (rest.first < rest.end && key_of(items, rest.first) < pivot)
            rest.first++;
        while (rest.first < rest.end && key_of(items, rest.end - 1) > pivot)
            rest.end--;
        if (rest.end - rest.first <= 1) /* none, or an equal one, which may be on either */
            return rest.end < items->count ? rest.end : rest.first;
        swap_items(items, rest.first, rest.end - 1);
    }
}

/* The middle one of a few. */
static double middle_key(const struct items *items)
{
    enum { ASKED = 9 };
    double key[ASKED];
    for (size_t k = 0; k < ASKED; k++) {
        const double x = key_of(items, (2 * k + 1) * (items->count / (2 * ASKED)));
        size_t to = k;
        for (; to > 0 && key[to - 1] > x; to--)
            key[to] = key[to - 1];
        key[to] = x;
    }
    return key[ASKED / 2];
}

/* Doubles as integers in the same order. */
static int64_t ordered(double x)
{
    int64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits < 0 ? INT64_MIN - bits : bits;
}

static double from_ordered(int64_t bits)
{
    double x;
    bits = bits < 0 ? INT64_MIN - bits : bits;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* Between the least and the greatest, with as many doubles to either side. */
static double halfway_key(const struct items *items)
{
    double least = INFINITY, greatest = -INFINITY;
    for (size_t i = 0; i < items->count; i++) {
        const double key = key_of(items, i);
        least = key < least ? key : least;
        greatest = key > greatest ? key : greatest;
    }
    const int64_t from = ordered(least), to = ordered(greatest);
    return from_ordered((from >> 1) + (to >> 1) + (from & to & 1));
}

/* Puts the first target of them, by their keys, before the others. Passes over them: middle keys
 * halve what is left, or nearly so, of all but odd sequences; after GUESSES of them, halfway keys
 * halve the doubles that are left, which are below 2^64. */
static void select_first(struct items items, size_t target)
{
    enum { GUESSES = 24 };
    for (int round = 0; items.count > FEW; round++) {
        if (target == 0 || target == items.count)
            return;
        const size_t before =
            part(&items, round < GUESSES ? middle_key(&items) : halfway_key(&items));
        if (before > target) {
            items.count = before;
            continue;
        }
        items.box += before;
        items.order += before;
        items.count -= before;
        target -= before;
    }
    select_few(&items, target);
}

/* ---- The tree ---- */

struct range_of_frames {
    size_t first, count;
};

/* Which frames are below which node, from the root on; the boxes are put in order. */
static void set_nodes(struct fmb_tree *tree)
{
    struct range_of_frames later[DEPTH_MAX], now = {0, tree->frame_count};
    size_t depth = 0;
    for (size_t at = 0; at < tree->node_count; at++) {
        struct fmb_tree_node *node = &tree->nodes[at];
        node->skip = (unsigned) (at + nodes_of(now.count));
        node->first = (unsigned) now.first;
        node->count = now.count <= TREE_LEAF ? (unsigned) now.count : 0;
        if (node->count) {
            now = depth ? later[--depth] : now;
            continue;
        }
        const size_t half = leaves_of(now.count) / 2 * TREE_LEAF;
        struct fmb_tree_box *box = tree->boxes + now.first;
        const int axis = axis_of(box, now.count);
        select_first(
            (struct items){box, tree->order + now.first, now.count, axis < 0 ? 0 : axis, axis < 0},
            half);
        later[depth++] = (struct range_of_frames){now.first + half, now.count - half};
        now.count = half;
    }
}

static void set_leaf(const struct fmb_tree *tree, struct fmb_tree_node *node)
{
    const unsigned end = node->first + node->count;
    node->box = tree->boxes[node->first].box;
    node->last = tree->order[node->first];
    for (unsigned k = node->first + 1; k < end; k++) {
        node->box = swept_hull(node->box, tree->boxes[k].box);
        node->last = tree->order[k] > node->last ? tree->order[k] : node->last;
    }
}

/* From the boxes of the frames: children stand behind their parents. */
static void set_boxes(const struct fmb_tree *tree)
{
    for (size_t at = tree->node_count; at-- > 0;) {
        struct fmb_tree_node *node = &tree->nodes[at];
        if (node->count) {
            set_leaf(tree, node);
            continue;
        }
        const struct fmb_tree_node *first = node + 1, *second = &tree->nodes[first->skip];
        node->box = swept_hull(first->box, second->box);
        node->last = first->last > second->last ? first->last : second->last;
    }
}

/* ---- The door ---- */

static int dimension_of(const struct fmb_prepared *frame)
{
    return prepared_kind(frame) & PREPARED_SPACE ? 3 : 2;
}

static enum fmb_status check(const struct fmb_prepared *frames, size_t count, double duration)
{
    unsigned all = PREPARED_GOOD, different = 0;
    if (!prepared_is_duration(duration))
        return FMB_BAD_DURATION;
    for (size_t i = 0; i < count; i++) {
        all &= prepared_kind(&frames[i]);
        different |= prepared_kind(&frames[i]) ^ prepared_kind(&frames[0]);
    }
    return !(all & PREPARED_GOOD)       ? FMB_NOT_FINITE
           : different & PREPARED_SPACE ? FMB_DIMENSIONS_DIFFER
                                        : FMB_OK;
}

static void lay_out(void *memory, size_t count, struct fmb_tree *out)
{
    char *at = memory;
    at += -(uintptr_t) at % CACHE_LINE;
    out->frame_count = count;
    out->node_count = nodes_of(count);
    out->nodes = (void *) at;
    at += out->node_count * sizeof *out->nodes;
    out->boxes = (void *) at;
    at += count * sizeof *out->boxes;
    out->order = (void *) at;
}

enum fmb_status fmb_tree_build(const struct fmb_prepared *frames, size_t count, double duration,
                               void *memory, struct fmb_tree *out)
{
    memset(out, 0, sizeof *out);
    const enum fmb_status status =
        count < UINT_MAX ? check(frames, count, duration) : FMB_OVER_LIMIT;
    if (status != FMB_OK || count == 0)
        return status;
    lay_out(memory, count, out);
    out->dim = dimension_of(frames);
    out->duration = duration;
    for (size_t i = 0; i < count; i++) {
        out->boxes[i].box = swept_of(&frames[i], duration);
        out->order[i] = (unsigned) i;
    }
    set_nodes(out);
    set_boxes(out);
    return FMB_OK;
}

enum fmb_status fmb_tree_refit(struct fmb_tree *tree, const struct fmb_prepared *frames,
                               double duration)
{
    const enum fmb_status status = check(frames, tree->frame_count, duration);
    if (status != FMB_OK || tree->frame_count == 0)
        return status;
    tree->dim = dimension_of(frames);
    tree->duration = duration;
    for (size_t k = 0; k < tree->frame_count; k++)
        tree->boxes[k].box = swept_of(&frames[tree->order[k]], duration);
    set_boxes(tree);
    return FMB_OK;
}

/* ---- Asking ---- */

static void sort_few(unsigned *number, size_t count)
{
    for (size_t i = 1; i < count; i++) {
        const unsigned x = number[i];
        size_t to = i;
        for (; to > 0 && number[to - 1] > x; to--)
            number[to] = number[to - 1];
        number[to] = x;
    }
}

/* Those without the bit before those with it; returns how many are before. */
static size_t part_by_bit(unsigned *number, size_t count, unsigned bit)
{
    size_t before = 0;
    for (size_t i = 0; i < count; i++) {
        const unsigned x = number[i];
        number[i] = number[before];
        number[before] = x;
        before += !(x & bit);
    }
    return before;
}

/* In place and in bounded time: by one bit after the other, from the highest on, below most. */
static void sort(unsigned *number, size_t count, unsigned most)
{
    struct {
        unsigned *number;
        size_t count;
        unsigned bit;
    } later[DEPTH_MAX];
    size_t depth = 0;
    unsigned bit = 1;
    while (bit <= most / 2)
        bit *= 2;
    for (;;) {
        if (count > 24 && bit) {
            const size_t before = part_by_bit(number, count, bit);
            bit /= 2;
            later[depth].number = number + before;
            later[depth].count = count - before;
            later[depth++].bit = bit;
            count = before;
            continue;
        }
        sort_few(number, count);
        if (depth == 0)
            return;
        number = later[--depth].number;
        count = later[depth].count;
        bit = later[depth].bit;
    }
}

enum fmb_status fmb_tree_ask(const struct fmb_tree *tree, const struct fmb_prepared *frame,
                             unsigned from, unsigned *out, size_t *count)
{
    *count = 0;
    if (!(prepared_kind(frame) & PREPARED_GOOD))
        return FMB_NOT_FINITE;
    if (tree->frame_count == 0)
        return FMB_OK;
    if (dimension_of(frame) != tree->dim)
        return FMB_DIMENSIONS_DIFFER;
    const struct swept box = swept_of(frame, tree->duration);
    *count = tree_walk(tree, &box, from, out, NULL);
    sort(out, *count, (unsigned) tree->frame_count);
    return FMB_OK;
}
