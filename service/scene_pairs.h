/* The pairs that a scene query asks for, one block after the other: those listed, or of all and
 * across those that can meet at all, in the order of (a, b). */
#ifndef SCENE_PAIRS_H
#define SCENE_PAIRS_H

#include "query.h"

/* Filled in by scene_pairs_begin(); to be kept in one place meanwhile. */
struct scene_pairs {
    const struct scene_query *query;
    int32_t listed; /* the next one of these */
    /* All and across: what of frame a was found so far to meet, and is not given yet. */
    struct fmb_tree tree;
    const struct fmb_prepared *frame;
    unsigned a;
    size_t found_count, given;
    unsigned found[QUERY_FRAMES_MAX];
};

/* How many pairs the query asks for, whether they can meet or not. */
int32_t scene_pairs_total(const struct scene_query *query);

/* On input: a query that has been checked, its frames, all prepared, and
 * fmb_tree_bytes(QUERY_FRAMES_MAX) bytes; all are needed until the last block. Begins with
 * first_pair. */
void scene_pairs_begin(struct scene_pairs *pairs, const struct scene_query *query,
                       const struct fmb_prepared *frame, void *memory);

/* The next block, of max pairs or less, in *out: in room, or where the query lists them. Returns
 * how many; 0 after the last one. */
size_t scene_pairs_next(struct scene_pairs *pairs, unsigned (*room)[2], size_t max,
                        const unsigned (**out)[2]);

/* The number of pair k of such a block among all that the query asks for. */
int32_t scene_pairs_number(const struct scene_query *query, const unsigned (*pair)[2], size_t k);

#endif
