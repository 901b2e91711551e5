/* The pairs of bodies of a scene, in the order of their numbers: those that are listed; or, of all
 * and across, those whose boxes meet and that are not ignored. */
#ifndef FMB_SCENE_PAIRS_H
#define FMB_SCENE_PAIRS_H

#include "scene_frames.h"

/* Filled in by scene_pairs_begin(). */
struct scene_pairs {
    const struct fmb_scene *scene;
    unsigned long long next; /* FMB_PAIRS_LISTED: the pair */
    /* All and across: a and the first found_count of found[] may meet; given of these pairs have
     * been enumerated. The tree holds the placements from first on. */
    const struct swept *box; /* [placement] */
    struct fmb_tree tree;
    unsigned a, first;
    size_t found_count, given;
    unsigned *found; /* in space, or in partner */
    int searches;    /* reset by the caller */
    unsigned *space; /* [placement] */
    /* All, where there are no more than so many pairs: listed, partner[start[a]] to
     * partner[start[a + 1] - 1] are those of a, ascending. */
    bool listed;
    unsigned *start;     /* [placement + 2] */
    unsigned *partner;   /* [scene_pairs_room()] */
    unsigned (*pair)[2]; /* [scene_pairs_room()], scratch */
    /* Ignored pairs as lists by the lower index: entries are positions in ignored + 1, 0 ends. */
    unsigned *head; /* [placement] */
    unsigned *link; /* [ignored] */
    unsigned *mark; /* [placement]: a + 1 where its pair with a is ignored */
};

/* Pairs that are found at once, of so many placements; of more, those of one placement after the
 * other. */
static inline size_t scene_pairs_room(size_t placements)
{
    return 8 * placements + FMB_TREE_ROOM;
}

/* Number of pairs, whether they can meet or not. */
unsigned long long scene_pairs_total(const struct fmb_scene *scene);

/* In: the scene, checked; the arrays of pairs; tree: fmb_tree_bytes() of the
 * placements; box: those of the placements, which may be NULL with FMB_PAIRS_LISTED. All are needed
 * until the last pair. Begins with first_pair. */
void scene_pairs_begin(struct scene_pairs *pairs, const struct fmb_scene *scene,
                       const struct swept *box, void *tree);

/* The next pairs, at most max, in out. Returns how many; 0 also after several searches. */
size_t scene_pairs_next(struct scene_pairs *pairs, unsigned (*out)[2], size_t max);

/* The number of the pair that comes next: all before it have been enumerated, or cannot meet, or
 * are ignored. The total: there are no more. */
unsigned long long scene_pairs_position(const struct scene_pairs *pairs);

/* The number of a pair. In: not FMB_PAIRS_LISTED; a pair that was enumerated. */
unsigned long long scene_pairs_number(const struct fmb_scene *scene, unsigned a, unsigned b);

#endif
