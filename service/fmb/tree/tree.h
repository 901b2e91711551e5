/* The nodes of a tree of boxes, and the query loop.
 *
 * Nodes are stored in depth-first order: a node, all nodes below its first child, all nodes below
 * its second child. Each node has the index of the node that follows its subtree, so a query is a
 * single loop without a stack. The boxes of the frames are stored in the order of the leaves.
 *
 * The query is inline here, so that tests can count the nodes that it visits. */
#ifndef FMB_TREE_H
#define FMB_TREE_H

#include "aabb.h"

/* Frames in a leaf; all leaves of a node of few boxes are full except the last one. */
enum { TREE_LEAF = 8 };

/* One cache line. */
struct fmb_tree_node {
    struct aabb box;
    unsigned skip;  /* the next node if this one is rejected */
    unsigned first; /* leaf: its first frame, in the order of the leaves */
    unsigned count; /* leaf: its number of frames; 0: not a leaf */
    unsigned last;  /* the largest index of a frame in this subtree */
};

struct fmb_tree_box {
    struct aabb box;
};

/* Returns the next leaf whose box overlaps the query box and that may contain an index >= from;
 * NULL if there are no more. against: aabb_probe() of the query box. *at: the next node to
 * visit, 0 at first. *visits, if not NULL, is incremented for each node visited. */
INLINE const struct fmb_tree_node *tree_next_leaf(const struct fmb_tree *tree,
                                                  const struct aabb *against, unsigned from,
                                                  unsigned *at, size_t *visits)
{
    while (*at < tree->node_count) {
        const struct fmb_tree_node *node = &tree->nodes[*at];
        const bool enter = (int) aabb_overlaps(&node->box, against) & (node->last >= from);
        if (visits)
            ++*visits;
        *at = enter ? *at + 1 : node->skip;
        if (enter && node->count)
            return node;
    }
    return NULL;
}

/* Writes the indices >= from of the frames whose boxes overlap the query box to out, in the order
 * of the leaves, and returns how many. out has capacity for all frames of the tree. */
INLINE size_t tree_query_unsorted(const struct fmb_tree *tree, const struct aabb *box,
                                  unsigned from, unsigned *out, size_t *visits)
{
    const struct aabb against = aabb_probe(box);
    const struct fmb_tree_node *leaf;
    unsigned at = 0;
    size_t found = 0;
    while ((leaf = tree_next_leaf(tree, &against, from, &at, visits))) {
        const unsigned end = leaf->first + leaf->count;
        for (unsigned k = leaf->first; k < end; k++) {
            /* Always written; overwritten by the next index if rejected. */
            const unsigned index = tree->order[k];
            out[found] = index;
            found += (int) aabb_overlaps(&tree->boxes[k].box, &against) & (index >= from);
        }
    }
    return found;
}

/* Sorts numbers of at most most in ascending order, in place and in bounded time. */
void tree_sort(unsigned *number, size_t count, unsigned most);

/* tree_query_unsorted() with the indices in ascending order. */
size_t tree_query(const struct fmb_tree *tree, const struct aabb *box, unsigned from,
                  unsigned *out);

#endif
