/* What a tree of boxes holds, and how it is walked.
 *
 * Nodes stand in the order in which they are visited if none is left out: a node, all below its
 * first child, all below its second. One that is left out tells where to go on, so a walk is one
 * loop and needs no stack. The boxes of the frames stand in the order of the leaves.
 *
 * The walk is here and inline so that what it costs can be counted where it is tested. */
#ifndef FMB_TREE_H
#define FMB_TREE_H

#include "swept.h"

/* Frames of a leaf; all leaves but the last are full. */
enum { TREE_LEAF = 8 };

/* One cache line. */
struct fmb_tree_node {
    struct swept box;
    unsigned skip;  /* the node to go on with where this one is left out */
    unsigned first; /* of a leaf: its first frame, in the order of the leaves */
    unsigned count; /* of frames of a leaf; 0: not a leaf */
    unsigned last;  /* the largest index of a frame below */
};

struct fmb_tree_box {
    struct swept box;
};

/* The next leaf that may meet a box, of which against is the other side, and may have an index that
 * is not below from; or NULL. at: the node to go on with, 0 to begin with. visits counts nodes, or
 * is NULL. */
INLINE const struct fmb_tree_node *tree_next(const struct fmb_tree *tree,
                                             const struct swept *against, unsigned from,
                                             unsigned *at, size_t *visits)
{
    while (*at < tree->node_count) {
        const struct fmb_tree_node *node = &tree->nodes[*at];
        const bool enter = (int) swept_meet(&node->box, against) & (node->last >= from);
        if (visits)
            ++*visits;
        *at = enter ? *at + 1 : node->skip;
        if (enter && node->count)
            return node;
    }
    return NULL;
}

/* Puts the indices of the frames that may meet a box and are not below from into out, as they come,
 * and returns how many. */
INLINE size_t tree_walk(const struct fmb_tree *tree, const struct swept *box, unsigned from,
                        unsigned *out, size_t *visits)
{
    const struct swept against = swept_against(box);
    const struct fmb_tree_node *leaf;
    unsigned at = 0;
    size_t found = 0;
    while ((leaf = tree_next(tree, &against, from, &at, visits))) {
        const unsigned end = leaf->first + leaf->count;
        for (unsigned k = leaf->first; k < end; k++) {
            /* There is room for this one, and it is written over if it is not one of them. */
            const unsigned index = tree->order[k];
            out[found] = index;
            found += (int) swept_meet(&tree->boxes[k].box, &against) & (index >= from);
        }
    }
    return found;
}

/* Sorts numbers up to most, in place and in bounded time. */
void tree_sort(unsigned *number, size_t count, unsigned most);

/* The same in ascending order: fmb_tree_ask() for a box. */
size_t tree_find(const struct fmb_tree *tree, const struct swept *box, unsigned from,
                 unsigned *out);

#endif
