/* Broad phase: a binary tree of axis-aligned boxes that finds the pairs that may meet.
 *
 *   In     boxes of frames, over a window
 *   Out    the indices of frames, or pairs of them, whose boxes overlap
 *   Build  set_nodes() divides the boxes from the root on, by split(); set_boxes() computes the
 *          boxes of the nodes from the leaves up
 *   Query  tree_query_unsorted() (tree.h), then tree_sort() for ascending indices
 *   Pairs  each leaf of one tree against the leaves of the other: pairs_of_leaves()
 *
 * Method. split() divides the boxes of a node in two by their centres on the axis of axis_of(). It
 * first partitions them by the median of a sample. It keeps the result if each side has more than a
 * quarter of the boxes; otherwise select_first() divides them at the middle. A node of FEW boxes or
 * fewer is divided so that all its leaves are full except the last one. This bounds the number of
 * nodes and the depth for any boxes.
 *
 * Time: a bounded number of passes over the boxes a level (select_first() derives the bound),
 * nearly always one.
 *
 * Correctness: no pair can be lost. A node's box contains the boxes below it, exactly. Centres and
 * axes may be rounded or not a number: they only determine how good the tree is. Tests compare the
 * results with those of all pairs (tests/unit/test_engine_tree.c). */
#include "tree.h"

#include "motion.h"

#include <float.h>
#include <limits.h>
#include <stdint.h>
#include <string.h>

/* DEPTH_MAX: log 2^32 / log(4/3) is 77.1. */
enum { CACHE_LINE = 64, FEW = 64, DEPTH_MAX = 78 };

_Static_assert(sizeof(struct fmb_tree_node) == CACHE_LINE, "a node is a cache line");
_Static_assert(TREE_LEAF *TREE_LEAF == FMB_TREE_CAPACITY_MIN,
               "there is capacity for all pairs of two leaves");

static size_t leaves_of(size_t frames)
{
    return frames / TREE_LEAF + (frames % TREE_LEAF != 0);
}

/* Bounds the number of nodes. A node of few boxes has at least FEW / 4 of them, unless the tree has
 * fewer in all, and one leaf more than it fills. */
static size_t nodes_max(size_t frames)
{
    return 2 * (frames / TREE_LEAF + frames / (FEW / 4)) + 3;
}

size_t fmb_tree_bytes(size_t count)
{
    /* A frame needs less than half a node. */
    const size_t each = sizeof(struct fmb_tree_box) + sizeof(unsigned);
    if (count >= UINT_MAX || count > (SIZE_MAX - 4 * CACHE_LINE) / (each + CACHE_LINE / 2))
        return SIZE_MAX;
    return CACHE_LINE + count * each + nodes_max(count) * sizeof(struct fmb_tree_node);
}

/* ---- Centres ---- */

/* Returns the centre of a box on an axis; it may be infinite. Returns 0 for a box without ends. */
static inline double centre_of(const struct fmb_tree_box *box, int axis)
{
    const lanes end = box->box.end[axis];
    const double centre = end[0] * 0.5 - end[1] * 0.5;
    return centre == centre ? centre : 0;
}

/* Properties of many boxes are estimated from a sample: at most SAMPLES of them, evenly spaced in
 * their order. */
enum { SAMPLES = 16 };

static size_t stride_of(size_t count)
{
    return (count + SAMPLES - 1) / SAMPLES;
}

/* Returns the least and the greatest centre of a sample on each axis, as a box: {least, -greatest}.
 */
static struct aabb centre_bounds(const struct fmb_tree_box *box, size_t count)
{
    const size_t stride = stride_of(count);
    struct aabb out;
    UNROLL(3)
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out.end[axis] = lanes_of(INFINITY);
    for (size_t i = 0; i < count; i += stride) {
        UNROLL(3)
        for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
            const lanes half = box[i].box.end[axis] * 0.5;
            const lanes centre = half - (lanes){half[1], half[0]};
            out.end[axis] = lanes_min(centre, out.end[axis]); /* the second, if the first is NaN */
        }
    }
    return out;
}

/* Returns the extent of the centres on an axis; finite. */
static double extent_of(lanes centres)
{
    const lanes ends = lanes_max(centres, lanes_of(-DBL_MAX / 4));
    const double reach = -ends[0] - ends[1];
    return reach > 0 ? reach : 0;
}

/* ---- The axis ---- */

/* Estimates the fraction of boxes that would be in both halves: the mean size of a sample relative
 * to the extent of the centres, each at most 1. It is at least 1/64: below that it is taken as
 * none, since query boxes are often larger. */
static double share_in_both(const struct fmb_tree_box *box, size_t count, int axis, double reach)
{
    const double inverse = 1 / reach; /* infinite for subnormal extents: all boxes are then large */
    double sum = 0, samples = 0;
    for (size_t i = 0; i < count; i += stride_of(count), samples++) {
        const lanes end = box[i].box.end[axis];
        const double size = (-end[0] - end[1]) * inverse;
        sum += size < 1 ? size : 1;
    }
    return sum > samples / 64 ? sum / samples : 1.0 / 64;
}

/* Returns the axis on which the two halves share the fewest boxes, the longest of several such
 * axes; -1 if all centres of the sample are equal. */
static int axis_of(const struct fmb_tree_box *box, size_t count)
{
    const struct aabb centres = centre_bounds(box, count);
    double best = INFINITY, longest = 0;
    int out = -1;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        const double reach = extent_of(centres.end[axis]);
        if (reach == 0)
            continue;
        const double share = share_in_both(box, count, axis, reach);
        if (share < best || (share == best && reach > longest)) {
            best = share;
            longest = reach;
            out = axis;
        }
    }
    return out;
}

/* ---- Halves ---- */

/* A range of boxes with the indices of their frames, and the key that orders them. */
struct items {
    struct fmb_tree_box *box; /* [count] */
    unsigned *order;          /* [count] */
    size_t count;
    int axis;
    bool by_end; /* the key is the lower end: all centres are equal */
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

/* Exchanges the boxes that are on the wrong side of target: rank below target belongs before it. */
static void swap_wrong(const struct items *items, const unsigned char rank[], size_t target)
{
    unsigned char left[FEW], right[FEW];
    size_t wrong = 0, others = 0;
    for (size_t i = 0; i < target; i++) {
        left[wrong] = (unsigned char) i;
        wrong += rank[i] >= target;
    }
    for (size_t i = target; i < items->count; i++) {
        right[others] = (unsigned char) i;
        others += rank[i] < target;
    }
    for (size_t i = 0; i < wrong; i++)
        swap_items(items, left[i], right[i]);
}

/* select_first() for at most FEW boxes. The rank of a box is the number of boxes before it; equal
 * keys keep their order. */
static void select_few(const struct items *items, size_t target)
{
    lanes key[FEW / 2];
    unsigned char rank[FEW];
    for (size_t i = 0; i < items->count; i++)
        key[i / 2][i % 2] = key_of(items, i);
    if (items->count % 2)
        key[items->count / 2][1] = INFINITY;
    for (size_t i = 0; i < items->count; i++) {
        const double x = key[i / 2][i % 2];
        lanes_mask before = {0};
        for (size_t k = 0; k < i / 2; k++)
            before -= aabb_at_most(key[k], lanes_of(x));
        for (size_t k = i / 2 + 1; k < (items->count + 1) / 2; k++)
            before -= ~aabb_at_most(lanes_of(x), key[k]);
        const int beside = i % 2 ? key[i / 2][0] <= x : key[i / 2][1] < x;
        rank[i] = (unsigned char) (before[0] + before[1] + beside);
    }
    swap_wrong(items, rank, target);
}

/* The range that is not partitioned yet: [first, end). */
struct unpartitioned {
    size_t first, end;
};

/* Partitions blocks from both ends until fewer than two of them are left. The positions of boxes on
 * the wrong side are recorded first and exchanged afterwards, so that no branch depends on a key.
 */
static struct unpartitioned partition_blocks(const struct items *items, double pivot)
{
    enum { BLOCK = 64 };
    unsigned char left[BLOCK], right[BLOCK];
    size_t left_count = 0, right_count = 0, left_done = 0, right_done = 0;
    struct unpartitioned middle = {0, items->count};
    while (middle.end - middle.first >= 2 * BLOCK) {
        if (left_done == left_count) {
            left_done = left_count = 0;
            for (size_t i = 0; i < BLOCK; i++) {
                left[left_count] = (unsigned char) i;
                left_count += key_of(items, middle.first + i) >= pivot;
            }
        }
        if (right_done == right_count) {
            right_done = right_count = 0;
            for (size_t i = 0; i < BLOCK; i++) {
                right[right_count] = (unsigned char) i;
                right_count += key_of(items, middle.end - 1 - i) <= pivot;
            }
        }
        while (left_done < left_count && right_done < right_count)
            swap_items(items, middle.first + left[left_done++],
                       middle.end - 1 - right[right_done++]);
        middle.first += left_done == left_count ? BLOCK : 0;
        middle.end -= right_done == right_count ? BLOCK : 0;
    }
    return middle;
}

/* Moves keys <= pivot before keys >= pivot, and returns how many come before. Neither side is empty
 * if least <= pivot <= greatest: equal keys go to both sides. */
static size_t partition(const struct items *items, double pivot)
{
    struct unpartitioned middle = partition_blocks(items, pivot);
    for (;; middle.first++, middle.end--) {
        while (middle.first < middle.end && key_of(items, middle.first) < pivot)
            middle.first++;
        while (middle.first < middle.end && key_of(items, middle.end - 1) > pivot)
            middle.end--;
        if (middle.end - middle.first <=
            1) /* none left, or one equal to the pivot, which may be on either side */
            return middle.end < items->count ? middle.end : middle.first;
        swap_items(items, middle.first, middle.end - 1);
    }
}

/* Returns the median key of a sample. */
static double middle_key(const struct items *items)
{
    double key[SAMPLES];
    size_t samples = 0;
    for (size_t i = 0; i < items->count; i += stride_of(items->count), samples++) {
        const double x = key_of(items, i);
        size_t to = samples;
        for (; to > 0 && key[to - 1] > x; to--)
            key[to] = key[to - 1];
        key[to] = x;
    }
    return key[samples / 2];
}

/* Maps doubles to integers in the same order. */
static int64_t order_key(double x)
{
    int64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits < 0 ? INT64_MIN - bits : bits;
}

static double from_order_key(int64_t bits)
{
    double x;
    bits = bits < 0 ? INT64_MIN - bits : bits;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static void key_bounds(const struct items *items, double *least, double *greatest)
{
    *least = INFINITY;
    *greatest = -INFINITY;
    for (size_t i = 0; i < items->count; i++) {
        const double key = key_of(items, i);
        *least = key < *least ? key : *least;
        *greatest = key > *greatest ? key : *greatest;
    }
}

/* Returns the double with equally many doubles between it and each limit; less than the greatest.
 */
static double halfway(double least, double greatest)
{
    const int64_t from = order_key(least), to = order_key(greatest);
    return from_order_key((from >> 1) + (to >> 1) + (from & to & 1));
}

/* Quickselect: moves the target smallest keys to the front.
 *
 * A pass halves the number of doubles between the least and the greatest key, which is below 2^64.
 * Once these two are adjacent doubles, a pass either leaves keys that are all equal, or halves the
 * number of boxes of the least key. So there are at most some 64 + log2(count) passes. */
static void select_first(struct items items, size_t target)
{
    while (items.count > FEW) {
        double least, greatest;
        key_bounds(&items, &least, &greatest);
        if (target == 0 || target == items.count || least == greatest)
            return;
        const size_t before = partition(&items, halfway(least, greatest));
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

/* Moves the boxes of the first child before those of the second, and returns how many they are. */
static size_t split(const struct fmb_tree *tree, size_t first, size_t count)
{
    struct items items = {tree->boxes + first, tree->order + first, count, 0, false};
    items.axis = axis_of(items.box, count);
    if (items.axis < 0) {
        items.axis = 0;
        items.by_end = true;
    }
    if (count > FEW) {
        const size_t before = partition(&items, middle_key(&items));
        if (before >= count / 4 + 1 && count - before >= count / 4 + 1)
            return before;
    }
    const size_t half = leaves_of(count) / 2 * TREE_LEAF;
    select_first(items, half);
    return half;
}

struct subtree {
    size_t first, count;
};

/* Divides the frames among the nodes, from the root on, and sorts the boxes into the order of the
 * leaves. */
static void set_nodes(struct fmb_tree *tree)
{
    struct subtree later[DEPTH_MAX], now = {0, tree->frame_count};
    size_t depth = 0, at = 0;
    for (;; at++) {
        struct fmb_tree_node *node = &tree->nodes[at];
        node->first = (unsigned) now.first;
        node->count = now.count <= TREE_LEAF ? (unsigned) now.count : 0;
        if (!node->count) {
            const size_t before = split(tree, now.first, now.count);
            later[depth++] = (struct subtree){now.first + before, now.count - before};
            now.count = before;
        } else if (depth) {
            now = later[--depth];
        } else {
            break;
        }
    }
    tree->node_count = at + 1;
}

static void set_leaf(const struct fmb_tree *tree, struct fmb_tree_node *node)
{
    const unsigned end = node->first + node->count;
    node->box = tree->boxes[node->first].box;
    node->last = tree->order[node->first];
    for (unsigned k = node->first + 1; k < end; k++) {
        node->box = aabb_union(node->box, tree->boxes[k].box);
        node->last = tree->order[k] > node->last ? tree->order[k] : node->last;
    }
}

/* Computes the boxes of all nodes from those of the frames. Children come after their parents, so
 * the nodes are processed in descending order. */
static void set_boxes(const struct fmb_tree *tree)
{
    for (size_t at = tree->node_count; at-- > 0;) {
        struct fmb_tree_node *node = &tree->nodes[at];
        if (node->count) {
            node->skip = (unsigned) at + 1;
            set_leaf(tree, node);
            continue;
        }
        const struct fmb_tree_node *first = node + 1, *second = &tree->nodes[first->skip];
        node->skip = second->skip;
        node->box = aabb_union(first->box, second->box);
        node->last = first->last > second->last ? first->last : second->last;
    }
}

/* ---- Building ---- */

/* Lays out the nodes, the boxes and the order in memory, each aligned as its type requires. The
 * boxes are still to be set. */
static void lay_out(void *memory, size_t count, int dim, double duration, struct fmb_tree *out)
{
    char *at = memory;
    at += -(uintptr_t) at % CACHE_LINE;
    out->frame_count = count;
    out->dim = dim;
    out->duration = duration;
    out->nodes = (void *) at;
    at += nodes_max(count) * sizeof *out->nodes;
    out->boxes = (void *) at;
    at += count * sizeof *out->boxes;
    out->order = (void *) at;
    for (size_t i = 0; i < count; i++)
        out->order[i] = (unsigned) i;
}

static struct aabb aabb_of_box(const struct fmb_boxes *boxes, unsigned index, double duration)
{
    struct aabb out = {{{0}}};
    double box[2][FMB_DIM_MAX];
    boxes->at(boxes->context, index, box);
    for (int axis = 0; axis < boxes->dim; axis++) {
        out.end[axis] = (lanes){box[0][axis], -box[1][axis]};
        if (boxes->velocity)
            out.end[axis] = aabb_sweep_axis(out.end[axis], boxes->velocity[axis], duration);
    }
    return out;
}

enum fmb_status fmb_tree_build(const struct fmb_boxes *boxes, size_t count, double duration,
                               void *memory, struct fmb_tree *out)
{
    memset(out, 0, sizeof *out);
    if (count >= UINT_MAX || !prepared_is_duration(duration))
        return count >= UINT_MAX ? FMB_OVER_LIMIT : FMB_BAD_DURATION;
    if (boxes->dim != 2 && boxes->dim != 3)
        return FMB_WRONG_DIMENSION;
    if (count == 0)
        return FMB_OK;
    lay_out(memory, count, boxes->dim, duration, out);
    for (size_t i = 0; i < count; i++)
        out->boxes[i].box = aabb_of_box(boxes, (unsigned) i, duration);
    set_nodes(out);
    set_boxes(out);
    return FMB_OK;
}

void fmb_box_of(const struct fmb_prepared *frame, double duration, double box[2][FMB_DIM_MAX])
{
    const bool turns = prepared_has_end(frame) && duration > 0;
    const struct aabb aabb = turns ? motion_box_of(frame) : aabb_of(frame, duration);
    aabb_get_ends(&aabb, box);
}

/* ---- Queries ---- */

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

/* Moves numbers without the bit before those with it; returns how many come before. */
static size_t partition_by_bit(unsigned *number, size_t count, unsigned bit)
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

/* Radix sort by bits, from the highest one. */
void tree_sort(unsigned *number, size_t count, unsigned most)
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
            const size_t before = partition_by_bit(number, count, bit);
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

size_t tree_query(const struct fmb_tree *tree, const struct aabb *box, unsigned from, unsigned *out)
{
    const size_t count = tree_query_unsorted(tree, box, from, out, NULL);
    tree_sort(out, count, (unsigned) tree->frame_count);
    return count;
}

/* ---- Pairs ---- */

/* A leaf, with its boxes in the form that aabb_overlaps() tests against. */
struct leaf_query {
    const struct fmb_tree *tree;
    const struct fmb_tree_node *leaf;
    struct aabb all, one[TREE_LEAF];
};

static void set_leaf_query(const struct fmb_tree *tree, const struct fmb_tree_node *leaf,
                           struct leaf_query *out)
{
    out->tree = tree;
    out->leaf = leaf;
    out->all = aabb_probe(&leaf->box);
    for (unsigned k = 0; k < leaf->count; k++)
        out->one[k] = aabb_probe(&tree->boxes[leaf->first + k].box);
}

static inline void put_pair(unsigned first, unsigned second, bool ordered, unsigned out[2])
{
    const bool swapped = (int) ordered & (first > second);
    out[0] = swapped ? second : first;
    out[1] = swapped ? first : second;
}

/* Writes the pairs of a frame of each leaf whose boxes overlap; for a leaf with itself, each pair
 * once. out has capacity for all pairs of the leaves: each candidate is written, and overwritten if
 * it is rejected. */
static size_t pairs_of_leaves(const struct leaf_query *query, const struct fmb_tree *tree,
                              const struct fmb_tree_node *leaf, unsigned (*out)[2])
{
    const bool same_tree = query->tree == tree;
    const unsigned end = leaf->first + leaf->count;
    size_t found = 0;
    for (unsigned k = 0; k < query->leaf->count; k++) {
        const unsigned index = query->tree->order[query->leaf->first + k];
        if (!aabb_overlaps(&leaf->box, &query->one[k]))
            continue;
        for (unsigned m = leaf->first + (leaf == query->leaf ? k + 1 : 0); m < end; m++) {
            put_pair(index, tree->order[m], same_tree, out[found]);
            found += aabb_overlaps(&tree->boxes[m].box, &query->one[k]);
        }
    }
    return found;
}

static enum fmb_status check_pairs(const struct fmb_tree *a, const struct fmb_tree *b,
                                   size_t capacity)
{
    if (a->frame_count == 0 || b->frame_count == 0)
        return FMB_OK;
    return a->dim != b->dim                   ? FMB_DIMENSIONS_DIFFER
           : a->duration != b->duration       ? FMB_BAD_DURATION
           : capacity < FMB_TREE_CAPACITY_MIN ? FMB_OVER_LIMIT
                                              : FMB_OK;
}

/* Each leaf of the first tree is tested against the second tree. Within one tree it is tested from
 * itself on, so that each pair of leaves is tested once. */
enum fmb_status fmb_tree_pairs(const struct fmb_tree *a, const struct fmb_tree *b,
                               struct fmb_tree_cursor *cursor, unsigned (*out)[2], size_t capacity,
                               size_t *count)
{
    const enum fmb_status status = check_pairs(a, b, capacity);
    *count = 0;
    if (status != FMB_OK || b->frame_count == 0)
        return status;
    for (; cursor->leaf < a->node_count; cursor->leaf++, cursor->inside = false) {
        struct leaf_query query;
        const struct fmb_tree_node *leaf = &a->nodes[cursor->leaf];
        if (!leaf->count)
            continue;
        set_leaf_query(a, leaf, &query);
        unsigned at = cursor->inside ? cursor->node : a == b ? cursor->leaf : 0;
        while ((leaf = tree_next_leaf(b, &query.all, 0, &at, NULL))) {
            *count += pairs_of_leaves(&query, b, leaf, out + *count);
            if (capacity - *count >= FMB_TREE_CAPACITY_MIN)
                continue;
            cursor->node = at;
            cursor->inside = true;
            return FMB_OK;
        }
    }
    return FMB_OK;
}
