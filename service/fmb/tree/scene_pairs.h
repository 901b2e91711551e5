/* Enumerates the pairs of bodies of a scene, in the order of their numbers: all listed pairs; or,
 * with FMB_PAIRS_ALL and FMB_PAIRS_ACROSS, those whose boxes overlap, and that are neither ignored
 * nor within a group. */
#ifndef FMB_SCENE_PAIRS_H
#define FMB_SCENE_PAIRS_H

#include "ignored.h"
#include "scene_frames.h"

/* Up to SCENE_FEW placements are tested all against all: building a tree would take longer. */
enum { SCENE_FEW = 128, SCENE_FEW_BLOCK = 32 };

/* Filled in by scene_pairs_begin(). */
struct scene_pairs {
    const struct fmb_scene *scene;
    unsigned long long next; /* FMB_PAIRS_LISTED: the pair */
    /* FMB_PAIRS_ALL and FMB_PAIRS_ACROSS: the partners of a are found[0] to found[found_count - 1];
     * given of these pairs have been enumerated. Unless the placements are few, the tree contains
     * those from first on. */
    const struct aabb *box; /* [placement] */
    struct fmb_tree tree;
    unsigned a, first;
    unsigned rows; /* a is below it: of all later ones, none has a partner that is decided */
    size_t found_count, given;
    unsigned *found; /* in space, or in partner */
    int searches;    /* reset by the caller */
    unsigned *space; /* [placement] */
    /* FMB_PAIRS_ALL, if all pairs fit scene_pairs_capacity(): listed is set, and the partners of a
     * are partner[start[a]] to partner[start[a + 1] - 1], ascending. */
    bool listed;
    unsigned *start;     /* [placement + 2] */
    unsigned *partner;   /* [scene_pairs_capacity()] */
    unsigned (*pair)[2]; /* [scene_pairs_capacity()], scratch */
    bool few;            /* at most SCENE_FEW placements: no tree */
    /* If few: the first two axes of each box, {low, -high}, rounded; NAN after the last one. */
    float rough[2][2][SCENE_FEW + SCENE_FEW_BLOCK]; /* [axis][end][placement] */
    struct ignored ignored;
    unsigned *ignored_memory; /* [ignored_capacity()] */
};

/* The number of pairs that may be found in one search, for so many placements. If there are more,
 * those of one placement are found at a time. */
static inline size_t scene_pairs_capacity(size_t placements)
{
    return 8 * placements + FMB_TREE_CAPACITY_MIN;
}

/* Begins an enumeration with first_pair.
 *
 * In: a checked scene; pairs with its arrays set; tree: fmb_tree_bytes() of the placements; box:
 * those of the placements, which may be NULL with FMB_PAIRS_LISTED. All must stay valid until the
 * last pair. moved: all placements; or, after another enumeration of the scene, those from 0 on
 * whose boxes may have changed since. */
void scene_pairs_begin(struct scene_pairs *pairs, const struct fmb_scene *scene,
                       const struct aabb *box, void *tree, size_t moved);

/* Writes the next pairs, at most max, to out. Returns how many; 0 also after several searches. */
size_t scene_pairs_next(struct scene_pairs *pairs, unsigned (*out)[2], size_t max);

/* Returns the number of the next pair: all before it have been enumerated, cannot meet or are
 * ignored. Equals the total number if there are no more pairs. */
unsigned long long scene_pairs_position(const struct scene_pairs *pairs);

#endif
