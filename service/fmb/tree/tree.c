/* Which pairs may meet: a binary tree of boxes.
 *
 * Method. The boxes of many frames are parted in two, along an axis and by their centres, near the
 * middle: neither side has less than a quarter of them. Of those of FEW frames and less the halves
 * are full leaves but for the last one. That bounds how many nodes there are and how deep, whatever
 * the boxes are. Time: a bounded number of passes over the boxes a level, which select_first()
 * tells; nearly always one.
 *
 * Nothing here can lose a pair: centres and axes are rounded, or no number at all, and only make a
 * tree good or bad. */
#include "tree.h"

#include <float.h>
#include <limits.h>
#include <stdint.h>
#include <string.h>

/* DEPTH_MAX: log 2^32 / log(4/3) is 77.1. */
enum { CACHE_LINE = 64, FEW = 64, DEPTH_MAX = 78 };

_Static_assert(sizeof(struct fmb_tree_node) == CACHE_LINE, "a node is a cache line");
_Static_assert(TREE_LEAF *TREE_LEAF == FMB_TREE_ROOM, "there is room for all pairs of two leaves");

static size_t leaves_of(size_t frames)
{
    return frames / TREE_LEAF + (frames % TREE_LEAF != 0);
}

/* At most. Those of whom there are few are at least FEW / 4 if not all there are, and have one leaf
 * more than they fill. */
static size_t most_nodes(size_t frames)
{
    return 2 * (frames / TREE_LEAF + frames / (FEW / 4)) + 3;
}

static size_t bytes_without_nodes(size_t count)
{
    return CACHE_LINE + count * (sizeof(struct fmb_tree_box) + sizeof(unsigned));
}

size_t fmb_tree_bytes(size_t count)
{
    /* A frame has less than half a node. */
    const size_t each = sizeof(struct fmb_tree_box) + sizeof(unsigned) + CACHE_LINE / 2;
    if (count >= UINT_MAX || count > (SIZE_MAX - 4 * CACHE_LINE) / each)
        return SIZE_MAX;
    return bytes_without_nodes(count) + most_nodes(count) * sizeof(struct fmb_tree_node);
}

/* ---- Centres ---- */

/* Of an axis, or 0 of a box without ends; may be infinite. */
static inline double centre_of(const struct fmb_tree_box *box, int axis)
{
    const lanes end = box->box.end[axis];
    const double centre = end[0] * 0.5 - end[1] * 0.5;
    return centre == centre ? centre : 0;
}

/* Some boxes of many, as far apart in their order: no more of them are asked what they are like. */
enum { ASKED = 16 };

static size_t stride_of(size_t count)
{
    return (count + ASKED - 1) / ASKED;
}

/* The least and the greatest centre of some boxes on each axis; as a box, {least, -greatest}. */
static struct swept centres_of(const struct fmb_tree_box *box, size_t count)
{
    const size_t stride = stride_of(count);
    struct swept out;
    UNROLL(3)
    for (int axis = 0; axis < FMB_DIM_MAX; axis++)
        out.end[axis] = lanes_of(INFINITY);
    for (size_t i = 0; i < count; i += stride) {
        UNROLL(3)
        for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
            const lanes half = box[i].box.end[axis] * 0.5;
            const lanes centre = half - (lanes){half[1], half[0]};
            out.end[axis] = lanes_least(centre, out.end[axis]); /* that, where it is no number */
        }
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

/* How large some boxes are against the reach of their centres, each at most 1: the part of them
 * that would be in both halves. Few enough are none: what is asked about is often larger. */
static double share_in_both(const struct fmb_tree_box *box, size_t count, int axis, double reach)
{
    const double inverse =
        1 / reach; /* of the least doubles it is infinite, and so all are large */
    double sum = 0, asked = 0;
    for (size_t i = 0; i < count; i += stride_of(count), asked++) {
        const lanes end = box[i].box.end[axis];
        const double size = (-end[0] - end[1]) * inverse;
        sum += size < 1 ? size : 1;
    }
    return sum > asked / 64 ? sum / asked : 1.0 / 64;
}

/* The axis on which halves have the fewest boxes in common, of equal ones the longest; -1 if all
 * centres that are asked are the same. */
static int axis_of(const struct fmb_tree_box *box, size_t count)
{
    const struct swept centres = centres_of(box, count);
    double best = INFINITY, longest = 0;
    int out = -1;
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        const double reach = reach_of(centres.end[axis]);
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

/* Those that are on the wrong side change places. */
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

/* Few of them. How many come before each is counted, equal ones in the order they are in. */
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
            before -= swept_at_most(key[k], lanes_of(x));
        for (size_t k = i / 2 + 1; k < (items->count + 1) / 2; k++)
            before -= ~swept_at_most(lanes_of(x), key[k]);
        const int beside = i % 2 ? key[i / 2][0] <= x : key[i / 2][1] < x;
        rank[i] = (unsigned char) (before[0] + before[1] + beside);
    }
    swap_wrong(items, rank, target);
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

/* The middle one of some. */
static double middle_key(const struct items *items)
{
    double key[ASKED];
    size_t asked = 0;
    for (size_t i = 0; i < items->count; i += stride_of(items->count), asked++) {
        const double x = key_of(items, i);
        size_t to = asked;
        for (; to > 0 && key[to - 1] > x; to--)
            key[to] = key[to - 1];
        key[to] = x;
    }
    return key[asked / 2];
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

static void keys_between(const struct items *items, double *least, double *greatest)
{
    *least = INFINITY;
    *greatest = -INFINITY;
    for (size_t i = 0; i < items->count; i++) {
        const double key = key_of(items, i);
        *least = key < *least ? key : *least;
        *greatest = key > *greatest ? key : *greatest;
    }
}

/* With as many doubles to either side; below the greatest. */
static double halfway(double least, double greatest)
{
    const int64_t from = ordered(least), to = ordered(greatest);
    return from_ordered((from >> 1) + (to >> 1) + (from & to & 1));
}

/* Puts the first target of them, by their keys, before the others. A pass halves the doubles that
 * are left between the least and the greatest, which are below 2^64; once these are neighbours, it
 * leaves them all the same, or halves those that are the least. */
static void select_first(struct items items, size_t target)
{
    while (items.count > FEW) {
        double least, greatest;
        keys_between(&items, &least, &greatest);
        if (target == 0 || target == items.count || least == greatest)
            return;
        const size_t before = part(&items, halfway(least, greatest));
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

/* Puts those of one child before those of the other, and returns how many they are. */
static size_t split(const struct fmb_tree *tree, size_t first, size_t count)
{
    struct items items = {tree->boxes + first, tree->order + first, count, 0, false};
    items.axis = axis_of(items.box, count);
    if (items.axis < 0) {
        items.axis = 0;
        items.by_end = true;
    }
    if (count > FEW) {
        const size_t before = part(&items, middle_key(&items));
        if (before >= count / 4 + 1 && count - before >= count / 4 + 1)
            return before;
    }
    const size_t half = leaves_of(count) / 2 * TREE_LEAF;
    select_first(items, half);
    return half;
}

struct pending {
    size_t first, count;
};

/* Which frames are below which node, from the root on; the boxes are put in order. */
static void set_nodes(struct fmb_tree *tree)
{
    struct pending later[DEPTH_MAX], now = {0, tree->frame_count};
    size_t depth = 0, at = 0;
    for (;; at++) {
        struct fmb_tree_node *node = &tree->nodes[at];
        node->first = (unsigned) now.first;
        node->count = now.count <= TREE_LEAF ? (unsigned) now.count : 0;
        if (!node->count) {
            const size_t before = split(tree, now.first, now.count);
            later[depth++] = (struct pending){now.first + before, now.count - before};
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
            node->skip = (unsigned) at + 1;
            set_leaf(tree, node);
            continue;
        }
        const struct fmb_tree_node *first = node + 1, *second = &tree->nodes[first->skip];
        node->skip = second->skip;
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

/* Each at a multiple of what its numbers need: the nodes, the boxes, the order. On output: a tree
 * whose boxes are to be set. */
static void lay_out(void *memory, size_t count, int dim, double duration, struct fmb_tree *out)
{
    char *at = memory;
    at += -(uintptr_t) at % CACHE_LINE;
    out->frame_count = count;
    out->dim = dim;
    out->duration = duration;
    out->nodes = (void *) at;
    at += most_nodes(count) * sizeof *out->nodes;
    out->boxes = (void *) at;
    at += count * sizeof *out->boxes;
    out->order = (void *) at;
    for (size_t i = 0; i < count; i++)
        out->order[i] = (unsigned) i;
}

/* On input: all boxes, in the order of the frames. */
static void grow(struct fmb_tree *tree)
{
    set_nodes(tree);
    set_boxes(tree);
}

enum fmb_status fmb_tree_build(const struct fmb_prepared *frames, size_t count, double duration,
                               void *memory, struct fmb_tree *out)
{
    memset(out, 0, sizeof *out);
    const enum fmb_status status =
        count < UINT_MAX ? check(frames, count, duration) : FMB_OVER_LIMIT;
    if (status != FMB_OK || count == 0)
        return status;
    lay_out(memory, count, dimension_of(frames), duration, out);
    for (size_t i = 0; i < count; i++)
        out->boxes[i].box = swept_of(&frames[i], duration);
    grow(out);
    return FMB_OK;
}

static struct swept swept_box(const struct fmb_boxes *boxes, unsigned index, double duration)
{
    struct swept out = {{{0}}};
    double box[2][FMB_DIM_MAX];
    boxes->at(boxes->context, index, box);
    for (int axis = 0; axis < boxes->dim; axis++) {
        out.end[axis] = (lanes){box[0][axis], -box[1][axis]};
        if (boxes->velocity)
            out.end[axis] = swept_along(out.end[axis], boxes->velocity[axis], duration);
    }
    return out;
}

enum fmb_status fmb_tree_build_boxes(const struct fmb_boxes *boxes, size_t count, double duration,
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
        out->boxes[i].box = swept_box(boxes, (unsigned) i, duration);
    grow(out);
    return FMB_OK;
}

void fmb_box_of(const struct fmb_prepared *frame, double duration, double box[2][FMB_DIM_MAX])
{
    const struct swept swept = swept_of(frame, duration);
    for (int axis = 0; axis < FMB_DIM_MAX; axis++) {
        box[0][axis] = swept.end[axis][0];
        box[1][axis] = 0 - swept.end[axis][1];
    }
}

/* Both of its cache lines. */
static void prefetch(const struct fmb_prepared *frame)
{
    __builtin_prefetch(frame);
    __builtin_prefetch((const char *) frame + CACHE_LINE);
}

enum fmb_status fmb_tree_refit(struct fmb_tree *tree, const struct fmb_prepared *frames,
                               double duration)
{
    const enum fmb_status status = check(frames, tree->frame_count, duration);
    if (status != FMB_OK || tree->frame_count == 0)
        return status;
    tree->dim = dimension_of(frames);
    tree->duration = duration;
    for (size_t k = 0; k < tree->frame_count; k++) {
        const size_t ahead = k + 8 < tree->frame_count ? k + 8 : k;
        prefetch(&frames[tree->order[ahead]]);
        tree->boxes[k].box = swept_of(&frames[tree->order[k]], duration);
    }
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

/* By one bit after the other, from the highest on. */
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

size_t tree_find(const struct fmb_tree *tree, const struct swept *box, unsigned from, unsigned *out)
{
    const size_t count = tree_walk(tree, box, from, out, NULL);
    tree_sort(out, count, (unsigned) tree->frame_count);
    return count;
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
    *count = tree_find(tree, &box, from, out);
    return FMB_OK;
}

/* ---- Pairs ---- */

/* A leaf, with what the boxes of its frames are held against. */
struct asking {
    const struct fmb_tree *tree;
    const struct fmb_tree_node *leaf;
    struct swept all, one[TREE_LEAF];
};

static void set_asking(const struct fmb_tree *tree, const struct fmb_tree_node *leaf,
                       struct asking *out)
{
    out->tree = tree;
    out->leaf = leaf;
    out->all = swept_against(&leaf->box);
    for (unsigned k = 0; k < leaf->count; k++)
        out->one[k] = swept_against(&tree->boxes[leaf->first + k].box);
}

static inline void put_pair(unsigned first, unsigned second, bool ordered, unsigned out[2])
{
    const bool swapped = (int) ordered & (first > second);
    out[0] = swapped ? second : first;
    out[1] = swapped ? first : second;
}

/* The pairs of a frame of the one leaf and one of the other, of a leaf with itself each once. There
 * is room for all of them: each is written, and written over if it is not one. */
static size_t pairs_of_leaves(const struct asking *asking, const struct fmb_tree *tree,
                              const struct fmb_tree_node *leaf, unsigned (*out)[2])
{
    const bool same_tree = asking->tree == tree;
    const unsigned end = leaf->first + leaf->count;
    size_t found = 0;
    for (unsigned k = 0; k < asking->leaf->count; k++) {
        const unsigned index = asking->tree->order[asking->leaf->first + k];
        if (!swept_meet(&leaf->box, &asking->one[k]))
            continue;
        for (unsigned m = leaf->first + (leaf == asking->leaf ? k + 1 : 0); m < end; m++) {
            put_pair(index, tree->order[m], same_tree, out[found]);
            found += swept_meet(&tree->boxes[m].box, &asking->one[k]);
        }
    }
    return found;
}

static enum fmb_status check_pairs(const struct fmb_tree *a, const struct fmb_tree *b, size_t room)
{
    if (a->frame_count == 0 || b->frame_count == 0)
        return FMB_OK;
    return a->dim != b->dim             ? FMB_DIMENSIONS_DIFFER
           : a->duration != b->duration ? FMB_BAD_DURATION
           : room < FMB_TREE_ROOM       ? FMB_OVER_LIMIT
                                        : FMB_OK;
}

/* Each leaf of the first tree walks through the second; in its own tree from itself on, so that it
 * meets every other leaf once. */
enum fmb_status fmb_tree_pairs(const struct fmb_tree *a, const struct fmb_tree *b,
                               struct fmb_tree_place *place, unsigned (*out)[2], size_t room,
                               size_t *count)
{
    const enum fmb_status status = check_pairs(a, b, room);
    *count = 0;
    if (status != FMB_OK || b->frame_count == 0)
        return status;
    for (; place->leaf < a->node_count; place->leaf++, place->inside = false) {
        struct asking asking;
        const struct fmb_tree_node *leaf = &a->nodes[place->leaf];
        if (!leaf->count)
            continue;
        set_asking(a, leaf, &asking);
        unsigned at = place->inside ? place->node : a == b ? place->leaf : 0;
        while ((leaf = tree_next(b, &asking.all, 0, &at, NULL))) {
            *count += pairs_of_leaves(&asking, b, leaf, out + *count);
            if (room - *count >= FMB_TREE_ROOM)
                continue;
            place->node = at;
            place->inside = true;
            return FMB_OK;
        }
    }
    return FMB_OK;
}
